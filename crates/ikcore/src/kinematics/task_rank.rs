//! In how many directions a tip can move: the rank that its Jacobian has almost everywhere.

use super::Columns;
use crate::math::MAX_DOF;
use crate::math::singular::SingularValues;
use crate::rng;
use crate::robot::{Joint, Robot};

/// Directions in which a tip can move at postures that are not singular.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Directions {
    /// Of velocity and angular velocity together, at most 6.
    pub pose: usize,
    /// Of velocity, at most 3.
    pub position: usize,
    /// Of angular velocity, at most 3.
    pub rotation: usize,
}

/// Singular values below this share of the largest are no direction of motion.
const RANK: f64 = 1e-9;

/// Postures looked at; one of them would do but for an unlucky draw.
const DRAWS: u64 = 3;

impl Directions {
    pub(crate) fn of(robot: &Robot) -> Self {
        let mut most = Self { pose: 0, position: 0, rotation: 0 };
        for draw in 0..DRAWS {
            let mut rng = rng::stream(0, draw);
            let ranges = robot.joints().iter().map(Joint::sampling_range);
            let q: Vec<f64> = ranges.map(|(lower, upper)| rng.uniform_in(lower, upper)).collect();
            let mut columns: Columns = [[0.0; 6]; MAX_DOF];
            robot.tip_and_jacobian(&q, &mut columns);
            let columns = &columns[..q.len()];
            most.pose = most.pose.max(rank(columns));
            most.position = most.position.max(rank(&rows(columns, 0)));
            most.rotation = most.rotation.max(rank(&rows(columns, 3)));
        }
        most
    }
}

/// The three rows from `first` on, the others empty.
fn rows(columns: &[[f64; 6]], first: usize) -> Vec<[f64; 6]> {
    columns.iter().map(|c| [c[first], c[first + 1], c[first + 2], 0.0, 0.0, 0.0]).collect()
}

fn rank(columns: &[[f64; 6]]) -> usize {
    let SingularValues { lengths, .. } = SingularValues::of(columns);
    lengths.iter().filter(|length| **length > RANK * lengths[0]).count()
}
