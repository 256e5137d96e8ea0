//! Starts near one target: entries of the robot's index, their first and last joint turned towards it.

use super::index::{AXIS_WEIGHT, SeedIndex, between_joints, turned_about_base_z};
use super::lane_search::LANES;
use crate::math::Frame;
use crate::math::arithmetic::Separate;
use crate::robot::{Joint, Robot};

/// Indexed configurations that bring the tip near one target, the nearest first.
#[derive(Debug, Clone, Copy)]
pub struct Seeds<'a> {
    index: &'a SeedIndex,
    joints: &'a [Joint],
    wanted: Wanted,
    entries: [usize; LANES],
    used: usize,
}

/// The target as the index sees it: from the frame of the first joint.
#[derive(Debug, Clone, Copy)]
enum Wanted {
    /// The frame of the last joint.
    Frame(Frame),
    /// The tip's `place`; `tip` is where the last joint holds it.
    Point { place: [f64; 3], tip: [f64; 3] },
}

impl Robot {
    /// Configurations to start from when the tip is to reach `pose`. The first call on a robot builds its index, which
    /// copies with another base or tool share.
    pub fn seeds_near_pose(&self, pose: &Frame) -> Seeds<'_> {
        let wanted = between_joints(self.chain(), pose);
        self.seeds(Wanted::Frame(wanted), self.seed_index().near_frame(&wanted))
    }

    /// The same when only the tip's `position` (m) matters.
    pub fn seeds_near_position(&self, position: &[f64; 3]) -> Seeds<'_> {
        let place = self.chain().stages.frame(0).inverse().place::<Separate>(position);
        let tip = self.chain().tip.origin;
        // What the tip is off the last axis would need the x axis, which the index does not keep for every robot.
        self.seeds(Wanted::Point { place, tip }, self.seed_index().near_point(place, tip[2]))
    }

    fn seeds(&self, wanted: Wanted, entries: [usize; LANES]) -> Seeds<'_> {
        Seeds { index: self.seed_index(), joints: self.joints(), wanted, entries, used: 0 }
    }
}

impl Seeds<'_> {
    /// Writes the next one that lies in the box \[`lower`, `upper`\] into `q`; false when there are no more.
    pub fn write_next(&mut self, lower: &[f64], upper: &[f64], q: &mut [f64]) -> bool {
        while self.used < LANES {
            self.write(self.entries[self.used], lower, upper, q);
            self.used += 1;
            if q.iter().zip(lower).zip(upper).all(|((q, lower), upper)| lower <= q && q <= upper) {
                return true;
            }
        }
        false
    }

    fn write(&self, entry: usize, lower: &[f64], upper: &[f64], q: &mut [f64]) {
        let (configuration, frame) = self.index.entry(entry);
        q.copy_from_slice(configuration);
        let range = |i: usize| self.joints[i].sampling_range_within(lower[i], upper[i]);
        let mut frame = *frame;
        if let Some(first) = self.index.first {
            let (sine, cosine) = self.turn_of_first(&frame);
            q[first.joint] = first.turned(q[first.joint], f64::atan2(sine, cosine), range(first.joint));
            frame = turned_about_base_z(&frame, sine, cosine);
        }
        if let (Some(last), Wanted::Frame(wanted)) = (self.index.last, &self.wanted) {
            q[last.joint] = last.turned(q[last.joint], spin(&frame, wanted), range(last.joint));
        }
    }

    /// Sine and cosine of the turn about the base's z axis that brings `frame` nearest to what is wanted.
    fn turn_of_first(&self, frame: &Frame) -> (f64, f64) {
        match &self.wanted {
            Wanted::Point { place, tip } => turn_between(&[(1.0, frame.place::<Separate>(tip), *place)]),
            Wanted::Frame(wanted) => {
                let z = AXIS_WEIGHT * AXIS_WEIGHT;
                let x = if self.index.last.is_some() { 0.0 } else { z };
                turn_between(&[
                    (1.0, frame.origin, wanted.origin),
                    (z, frame.axes[2], wanted.axes[2]),
                    (x, frame.axes[0], wanted.axes[0]),
                ])
            }
        }
    }
}

/// Sine and cosine of the turn about z that minimises the weighted squared distances of the pairs (weight, from, to).
fn turn_between(pairs: &[(f64, [f64; 3], [f64; 3])]) -> (f64, f64) {
    let (mut sine, mut cosine) = (0.0, 0.0);
    for (weight, from, to) in pairs {
        sine += weight * (from[0] * to[1] - from[1] * to[0]);
        cosine += weight * (from[0] * to[0] + from[1] * to[1]);
    }
    let size = (sine * sine + cosine * cosine).sqrt();
    if size > 0.0 { (sine / size, cosine / size) } else { (0.0, 1.0) }
}

/// The turn of `frame` about its own z axis (rad) that brings its x and y axes nearest to those of `wanted`.
fn spin(frame: &Frame, wanted: &Frame) -> f64 {
    let dot = |i: usize, j: usize| -> f64 { (0..3).map(|k| frame.axes[i][k] * wanted.axes[j][k]).sum() };
    f64::atan2(dot(1, 0) - dot(0, 1), dot(0, 0) + dot(1, 1))
}
