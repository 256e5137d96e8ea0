//! Where a course has corners.

use super::Course;
use super::stroke::turn;

/// Turning by more than this (rad) within a short stretch is a corner; by less, a curve.
const CORNER: f64 = 0.5;

/// Half that stretch, as a share of the way. In it there is one corner at the most, and noise of measured points is none.
const NEAR: f64 = 0.005;

impl Course {
    /// Rows at which the direction turns more than anywhere near, and by enough for a corner.
    pub(super) fn sharpest_turns(&self) -> Vec<usize> {
        let shares = &self.shares;
        let turn_at = |row: usize| {
            turn(self.position(shares[row] - NEAR), self.positions[row], self.position(shares[row] + NEAR))
        };
        // Nearer to its ends than that, the course has no direction that could be told from noise.
        let inner = (1..shares.len() - 1).filter(|row| NEAR <= shares[*row] && shares[*row] <= 1.0 - NEAR);
        let turns = inner.map(|row| (row, turn_at(row)));
        let sharp: Vec<(usize, f64)> = turns.filter(|(_, turn)| *turn > CORNER).collect();
        let near = |row: usize| {
            let begin = sharp.partition_point(|(other, _)| shares[*other] < shares[row] - NEAR);
            let end = sharp.partition_point(|(other, _)| shares[*other] <= shares[row] + NEAR);
            &sharp[begin..end]
        };
        let is_sharpest = |(row, turn): &&(usize, f64)| {
            near(*row).iter().all(|(other, another)| another < turn || (another == turn && other >= row))
        };
        sharp.iter().filter(is_sharpest).map(|(row, _)| *row).collect()
    }
}
