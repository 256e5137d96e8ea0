//! Starting points near one target: entries of the index, with first and last joint rotated towards it.

use super::index::{AXIS_WEIGHT, StartIndex, between_joints, turned_about_base_z};
use std::f64::consts::PI;

use crate::kinematics::chain::Chain;
use crate::math::Frame;
use crate::math::arithmetic::NoFma;
use crate::math::nearest_by_lane::LANES;
use crate::math::sampling_range;

/// Indexed configurations with their tip near one target, nearest first.
#[derive(Debug, Clone, Copy)]
pub struct Starts<'a> {
    index: &'a StartIndex,
    wanted: Wanted,
    entries: [usize; LANES],
    used: usize,
}

/// Target in the frame of the first joint.
#[derive(Debug, Clone, Copy)]
enum Wanted {
    /// Frame of the last joint.
    Frame(Frame),
    /// Position of the tip; `tip` is the tip in the frame of the last joint.
    Point { position: [f64; 3], tip: [f64; 3] },
}

impl StartIndex {
    /// Returns starts for `pose` of the tip of `chain`. The chain may have another base and tool than the indexed one.
    pub(crate) fn near_pose(&self, chain: &Chain, pose: &Frame) -> Starts<'_> {
        let wanted = between_joints(chain, pose);
        self.starts(Wanted::Frame(wanted), self.near_frame(&wanted))
    }

    /// Returns starts for `position` (m) of the tip of `chain`. Ignores the offset of the tip from the last axis.
    pub(crate) fn near_position(&self, chain: &Chain, position: &[f64; 3]) -> Starts<'_> {
        let position = chain.stages.frame(0).inverse().transform::<NoFma>(position);
        let tip = chain.tip.origin;
        self.starts(Wanted::Point { position, tip }, self.near_point(position, tip[2]))
    }

    fn starts(&self, wanted: Wanted, entries: [usize; LANES]) -> Starts<'_> {
        Starts { index: self, wanted, entries, used: 0 }
    }
}

impl Starts<'_> {
    /// Writes the next start inside the box \[`lower`, `upper`\] into `q`; returns false when there are no more.
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
        let range = |joint: usize| sampling_range::finite(lower[joint], upper[joint], PI);
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

    /// Returns sine and cosine of the rotation about the base's z axis that brings `frame` nearest to the target.
    fn turn_of_first(&self, frame: &Frame) -> (f64, f64) {
        match &self.wanted {
            Wanted::Point { position, tip } => turn_between(&[(1.0, frame.transform::<NoFma>(tip), *position)]),
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

/// Returns sine and cosine of the rotation about z that minimises the weighted squared distances of the pairs (weight, from,
/// to).
fn turn_between(pairs: &[(f64, [f64; 3], [f64; 3])]) -> (f64, f64) {
    let (mut sine, mut cosine) = (0.0, 0.0);
    for (weight, from, to) in pairs {
        sine += weight * (from[0] * to[1] - from[1] * to[0]);
        cosine += weight * (from[0] * to[0] + from[1] * to[1]);
    }
    let size = (sine * sine + cosine * cosine).sqrt();
    if size > 0.0 { (sine / size, cosine / size) } else { (0.0, 1.0) }
}

/// Returns the rotation of `frame` about its own z axis (rad) that brings its x and y axes nearest to those of `wanted`.
fn spin(frame: &Frame, wanted: &Frame) -> f64 {
    let dot = |i: usize, j: usize| -> f64 { (0..3).map(|k| frame.axes[i][k] * wanted.axes[j][k]).sum() };
    f64::atan2(dot(1, 0) - dot(0, 1), dot(0, 0) + dot(1, 1))
}
