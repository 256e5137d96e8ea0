//! Motion of a target during a tick, for rules that work with velocities.

use super::target::Target;
use crate::math::Frame;
use crate::math::hermite::Cubic;
use crate::math::so3::{rotated, rotation_between};

/// Motion of a target from the start of a tick to its end. Positions follow the cubic that meets both velocities, or a straight
/// line if these are unknown; orientations rotate at constant speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TargetMotion {
    /// Target at the start.
    pub begin: Target,
    /// Target at the end, of the same kind.
    pub end: Target,
    /// Velocities (m/s) at start and end.
    pub velocities: Option<[[f64; 3]; 2]>,
    /// Length of the tick (s).
    pub dt: f64,
}

/// Velocity (m/s) and angular velocity (rad/s) of a target, in base coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Twist {
    /// Linear velocity (m/s).
    pub linear: [f64; 3],
    /// Angular velocity (rad/s).
    pub angular: [f64; 3],
}

impl TargetMotion {
    /// Target and twist at `fraction` of the tick, from 0 to 1.
    pub fn at(&self, fraction: f64) -> (Target, Twist) {
        let (from, to) = (self.begin.position().unwrap_or_default(), self.end.position().unwrap_or_default());
        let straight: [f64; 3] = std::array::from_fn(|k| (to[k] - from[k]) / self.dt);
        let [v0, v1] = self.velocities.unwrap_or([straight; 2]);
        let entry = |k: usize| Cubic::new([from[k], to[k]], [self.dt * v0[k], self.dt * v1[k]]);
        let position = std::array::from_fn(|k| entry(k).at(fraction));
        let linear = std::array::from_fn(|k| entry(k).slope(fraction) / self.dt);
        let turn = match (self.begin.frame(), self.end.frame()) {
            (Some(begin), Some(end)) => rotation_between(begin, end),
            _ => [0.0; 3],
        };
        let target = self.begin.turned_at(position, turn.map(|entry| fraction * entry));
        (target, Twist { linear, angular: turn.map(|entry| entry / self.dt) })
    }
}

impl Target {
    /// Target after moving with `twist` for `time` (s).
    pub fn moved(&self, twist: &Twist, time: f64) -> Self {
        let position = self.position().unwrap_or_default();
        let there = std::array::from_fn(|k| position[k] + time * twist.linear[k]);
        self.turned_at(there, twist.angular.map(|entry| time * entry))
    }

    /// Target moved to `origin` (m) and rotated by the rotation vector `turn` (rad).
    fn turned_at(&self, origin: [f64; 3], turn: [f64; 3]) -> Self {
        let turned = |frame: &Frame| Frame { axes: frame.axes.map(|axis| rotated(&axis, &turn)), origin };
        match self {
            Self::Position(_) => Self::Position(origin),
            Self::Pose(frame) => Self::Pose(turned(frame)),
            Self::Orientation(frame) => Self::Orientation(turned(frame)),
            Self::Pointing { frame, axis } => Self::Pointing { frame: turned(frame), axis: *axis },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ends_and_their_velocities_are_met() {
        let (from, to) = ([1.0, -2.0, 0.5], [1.3, -1.0, 0.0]);
        let velocities = [[0.2, 4.0, -1.0], [3.0, 0.0, -0.4]];
        let motion = TargetMotion {
            begin: Target::Position(from),
            end: Target::Position(to),
            velocities: Some(velocities),
            dt: 0.25,
        };
        for (fraction, position, velocity) in [(0.0, from, velocities[0]), (1.0, to, velocities[1])] {
            let (Target::Position(found), twist) = motion.at(fraction) else { panic!("a position stays a position") };
            assert!((0..3).all(|k| (found[k] - position[k]).abs() < 1e-15));
            assert!((0..3).all(|k| (twist.linear[k] - velocity[k]).abs() < 1e-14));
        }
        let ((Target::Position(before), _), (Target::Position(after), _)) = (motion.at(0.4999), motion.at(0.5001))
        else {
            panic!("a position stays a position")
        };
        let (_, twist) = motion.at(0.5);
        assert!((0..3).all(|k| ((after[k] - before[k]) / (0.0002 * 0.25) - twist.linear[k]).abs() < 1e-6));
    }

    #[test]
    fn orientations_turn_at_constant_speed() {
        let begin = Frame { axes: [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], origin: [0.1, 0.2, 0.3] };
        let turn = [0.3, -0.8, 0.5];
        let end = Frame { axes: begin.axes.map(|axis| rotated(&axis, &turn)), origin: [0.3, 0.2, 0.1] };
        let motion = TargetMotion { begin: Target::Pose(begin), end: Target::Pose(end), velocities: None, dt: 0.5 };
        let (Target::Pose(half), twist) = motion.at(0.5) else { panic!("a pose stays a pose") };
        assert!((0..3).all(|k| (rotation_between(&begin, &half)[k] - 0.5 * turn[k]).abs() < 1e-15));
        assert!((0..3).all(|k| (twist.angular[k] - 2.0 * turn[k]).abs() < 1e-14 && half.origin[1] == 0.2));
        let Target::Pose(there) = motion.begin.moved(&twist, 0.5) else { panic!("a pose stays a pose") };
        assert!((0..3).all(
            |k| rotation_between(&end, &there)[k].abs() < 1e-14 && (there.origin[k] - end.origin[k]).abs() < 1e-15
        ));
    }
}
