//! Rank of the tip Jacobian by task: the number of directions in which the tip can move, almost everywhere.

use super::chain::Chain;
use super::kernels::Kernels;
use crate::math::Columns;
use crate::math::singular_values::SingularValues;
use crate::rng;

/// Rank of the Jacobian at non-singular configurations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TaskRank {
    /// Rank of all six rows.
    pub pose: usize,
    /// Rank of the linear rows, at most 3.
    pub position: usize,
    /// Rank of the angular rows, at most 3.
    pub rotation: usize,
}

/// Singular values below this fraction of the largest count as zero.
const NEGLIGIBLE: f64 = 1e-9;

/// Number of random configurations; one is enough with probability 1.
const DRAWS: u64 = 3;

impl TaskRank {
    /// Returns the largest ranks at random configurations within `ranges`, one per joint.
    pub(crate) fn of(chain: &Chain, kernels: &Kernels, ranges: &[(f64, f64)]) -> Self {
        let mut most = Self { pose: 0, position: 0, rotation: 0 };
        for draw in 0..DRAWS {
            let mut rng = rng::stream(0, draw);
            let q: Vec<f64> = ranges.iter().map(|(lower, upper)| rng.uniform_in(*lower, *upper)).collect();
            let mut columns = Columns::default();
            (kernels.jacobian)(chain, &q, &mut columns);
            let columns = &columns[..q.len()];
            most.pose = most.pose.max(rank(columns));
            most.position = most.position.max(rank(&rows(columns, 0)));
            most.rotation = most.rotation.max(rank(&rows(columns, 3)));
        }
        most
    }
}

/// Extracts three rows, from row `first` on, and fills the others with zeros.
fn rows(columns: &[[f64; 6]], first: usize) -> Vec<[f64; 6]> {
    columns.iter().map(|c| [c[first], c[first + 1], c[first + 2], 0.0, 0.0, 0.0]).collect()
}

fn rank(columns: &[[f64; 6]]) -> usize {
    let SingularValues { lengths, .. } = SingularValues::of(columns);
    lengths.iter().filter(|length| **length > NEGLIGIBLE * lengths[0]).count()
}
