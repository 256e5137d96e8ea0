//! Starts near one target, from the robot's index.

use super::seed_index::{LANES, SeedIndex, between_joints};
use super::{Joint, Robot};
use crate::math::Frame;

/// The stored configurations whose tips come nearest to one pose, the nearest first.
#[derive(Debug, Clone, Copy)]
pub struct Seeds<'a> {
    index: &'a SeedIndex,
    joints: &'a [Joint],
    wanted: Frame,
    entries: [usize; LANES],
    used: usize,
}

impl Robot {
    /// Configurations to start from when the tip is to reach `pose`. The first call builds the robot's index.
    pub fn seeds_near(&self, pose: &Frame) -> Seeds<'_> {
        let index = self.seed_index();
        let wanted = between_joints(self.chain(), pose);
        Seeds { index, joints: self.joints(), wanted, entries: index.nearest(&wanted), used: 0 }
    }
}

impl Seeds<'_> {
    /// Writes the next into `q`, inside the box; false when there are no more.
    pub fn write_next(&mut self, lower: &[f64], upper: &[f64], q: &mut [f64]) -> bool {
        let Some(entry) = self.entries.get(self.used) else { return false };
        let range = |i: usize| self.joints[i].sampling_range_within(lower[i], upper[i]);
        self.index.adapted(*entry, &self.wanted, range, q);
        self.used += 1;
        true
    }
}
