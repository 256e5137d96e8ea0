//! What a motion costs.

use crate::math::polynomial::{derivative, evaluate, roots};
use crate::planning::Cost;
use crate::robot::Robot;
use crate::trajectory::Trajectory;

/// Chords that a piece of the tip's way is measured by; on smooth pieces good to six digits.
const CHORDS: usize = 256;

impl Cost {
    /// Its value on `trajectory` (s, rad or m).
    pub(in crate::planning) fn of(self, robot: &Robot, trajectory: &Trajectory) -> f64 {
        match self {
            Self::Time => trajectory.duration(),
            Self::JointTravel => joint_travel(trajectory),
            Self::TipTravel => tip_travel(robot, trajectory),
        }
    }
}

/// How far all joints together travel: exact, from turning point to turning point.
fn joint_travel(trajectory: &Trajectory) -> f64 {
    let (knots, n) = (trajectory.knots(), trajectory.joints().len());
    let of_piece = |(i, polynomial): (usize, &[f64; crate::trajectory::POWERS])| {
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

fn tip_travel(robot: &Robot, trajectory: &Trajectory) -> f64 {
    let n = trajectory.joints().len();
    let pieces = trajectory.knots().windows(2).zip(trajectory.coefficients().chunks(n));
    let of_piece = |(ends, polynomials): (&[f64], &[[f64; crate::trajectory::POWERS]])| {
        let at = |i: usize| {
            let s = (ends[1] - ends[0]) * i as f64 / CHORDS as f64;
            let q: Vec<f64> = polynomials.iter().map(|polynomial| evaluate(polynomial, s)[0]).collect();
            robot.tip_position(&q)
        };
        let mut last = at(0);
        let mut travel = 0.0;
        for i in 1..=CHORDS {
            let next = at(i);
            travel += (0..3).map(|k| (next[k] - last[k]).powi(2)).sum::<f64>().sqrt();
            last = next;
        }
        travel
    };
    pieces.map(of_piece).sum()
}
