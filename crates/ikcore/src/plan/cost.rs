//! The objective of a plan.

use serde::{Deserialize, Serialize};

use crate::math::polynomial::{derivative, evaluate, roots};
use crate::math::vector::distance;
use crate::math::vector::point_between;
use crate::robot::Robot;
use crate::timing::ConstantLimits;
use crate::trajectory::{Coefficients, Trajectory};
use crate::wording::words;

/// Chords per piece of the tip's curve; accurate to six digits on smooth pieces.
const CHORDS: usize = 256;

/// Quantity that a plan minimises (Wang et al. 2019, eq. 8-10).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Cost {
    /// Duration of the motion (s): eq. (8) and (19).
    #[default]
    Time,
    /// Total travel of all joints (rad, m): eq. (9) and (20).
    JointTravel,
    /// Travel of the tip (m): eq. (10).
    TipTravel,
}

words!("objective": Cost { Time => "time", JointTravel => "joint_travel", TipTravel => "tip_travel" });

impl Cost {
    /// The name of the objective in messages.
    pub fn noun(self) -> &'static str {
        match self {
            Self::Time => "a duration",
            Self::JointTravel => "a joint travel",
            Self::TipTravel => "a tip travel",
        }
    }

    /// The unit of the objective. Metres of prismatic joints are added to radians of the others.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Time => "s",
            Self::JointTravel => "rad",
            Self::TipTravel => "m",
        }
    }

    /// The value of the objective on `trajectory` (s, rad or m).
    pub(crate) fn of(self, robot: &Robot, trajectory: &Trajectory) -> f64 {
        match self {
            Self::Time => trajectory.duration(),
            Self::JointTravel => joint_travel(trajectory),
            Self::TipTravel => tip_travel(robot, trajectory),
        }
    }

    /// A large value of the objective for `robot` under `limits`, which scales penalties.
    pub(crate) fn scale(self, robot: &Robot, limits: &ConstantLimits) -> f64 {
        let ranges = (0..limits.dof()).map(|j| limits.finite_range(j));
        match self {
            Self::Time => limits.whole_range_time(),
            Self::JointTravel => ranges.map(|(lower, upper)| upper - lower).sum(),
            Self::TipTravel => chain_length(robot),
        }
    }
}

/// Length of the chain from link to link (m).
fn chain_length(robot: &Robot) -> f64 {
    let poses = robot.link_poses(&vec![0.0; robot.dof()]).unwrap_or_default();
    poses.windows(2).map(|ends| (ends[1].translation.vector - ends[0].translation.vector).norm()).sum()
}

/// Returns the joint travel, computed exactly from turning point to turning point.
fn joint_travel(trajectory: &Trajectory) -> f64 {
    let (knots, n) = (trajectory.knots(), trajectory.joints().len());
    let of_piece = |(i, polynomial): (usize, &Coefficients)| {
        let span = knots[i / n + 1] - knots[i / n];
        let turns = roots(&derivative(polynomial), 0.0, span);
        let mut last = evaluate(polynomial, 0.0)[0];
        let mut travel = 0.0;
        for s in turns.into_iter().chain([span]) {
            let next = evaluate(polynomial, s)[0];
            travel += (next - last).abs();
            last = next;
        }
        travel
    };
    trajectory.coefficients().iter().enumerate().map(of_piece).sum()
}

/// Chords per line of a joint polyline, for comparing paths.
const CHORDS_A_LINE: usize = 32;

/// Returns the tip travel (m) along straight lines in joint space, measured by chords.
pub(crate) fn tip_travel_along(robot: &Robot, points: &[Vec<f64>]) -> f64 {
    let of_line = |ends: &[Vec<f64>]| {
        let at = |i: usize| {
            let fraction = i as f64 / CHORDS_A_LINE as f64;
            robot.tip_position(&point_between(&ends[0], &ends[1], fraction).collect::<Vec<_>>())
        };
        (1..=CHORDS_A_LINE).map(|i| distance(&at(i), &at(i - 1))).sum::<f64>()
    };
    points.windows(2).map(of_line).sum()
}

/// Returns the tip travel, measured by chords.
fn tip_travel(robot: &Robot, trajectory: &Trajectory) -> f64 {
    let n = trajectory.joints().len();
    let pieces = trajectory.knots().windows(2).zip(trajectory.coefficients().chunks(n));
    let of_piece = |(ends, polynomials): (&[f64], &[Coefficients])| {
        let at = |i: usize| {
            let s = (ends[1] - ends[0]) * i as f64 / CHORDS as f64;
            let q: Vec<f64> = polynomials.iter().map(|polynomial| evaluate(polynomial, s)[0]).collect();
            robot.tip_position(&q)
        };
        let mut last = at(0);
        let mut travel = 0.0;
        for i in 1..=CHORDS {
            let next = at(i);
            travel += distance(&next, &last);
            last = next;
        }
        travel
    };
    pieces.map(of_piece).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trajectory::polynomial;

    /// Joint 1 goes out by 1 rad and back, joint 2 by -0.5 rad, in 2 s.
    fn out_and_back() -> Trajectory {
        let pieces = vec![polynomial([0.0, 2.0, -1.0]), polynomial([0.3, -0.25])];
        Trajectory::new(vec!["a".into(), "b".into()], vec![0.0, 2.0], pieces).unwrap()
    }

    #[test]
    fn travel_counts_the_way_back_too() {
        let robot = Robot::planar(&[1.0, 0.5]).unwrap();
        let motion = out_and_back();
        assert_eq!(Cost::Time.of(&robot, &motion), 2.0);
        assert!((Cost::JointTravel.of(&robot, &motion) - 2.5).abs() < 1e-12);
    }

    #[test]
    fn the_tip_of_one_turning_link_travels_along_its_arc() {
        let robot = Robot::planar(&[1.0, 0.5]).unwrap();
        let pieces = vec![polynomial([0.2, 0.7]), polynomial([0.0])];
        let motion = Trajectory::new(vec!["a".into(), "b".into()], vec![0.0, 2.0], pieces).unwrap();
        assert!((Cost::TipTravel.of(&robot, &motion) - 1.5 * 1.4).abs() < 1e-5);
    }
}
