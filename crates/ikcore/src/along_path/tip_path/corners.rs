//! The corners of a path.

use super::segment_geometry::turn;
use super::tip_curve::TipPath;

/// A change of direction above this (rad) within a short part of the path is a corner; below it, a bend.
pub(super) const CORNER: f64 = 0.5;

/// Half the length of that part, relative to the path. It contains one corner at most, and is long enough that noise in
/// measured points does not count as one.
const NEAR: f64 = 0.005;

impl TipPath {
    /// Rows at which the direction changes more than at all rows nearby, and enough for a corner.
    pub(super) fn sharpest_turns(&self) -> Vec<usize> {
        let fractions = &self.fractions;
        let turn_at = |row: usize| {
            turn(self.position(fractions[row] - NEAR), self.positions[row], self.position(fractions[row] + NEAR))
        };
        // Nearer to the ends of the path, changes of direction cannot be distinguished from noise.
        let inner = (1..fractions.len() - 1).filter(|row| NEAR <= fractions[*row] && fractions[*row] <= 1.0 - NEAR);
        let turns = inner.map(|row| (row, turn_at(row)));
        let sharp: Vec<(usize, f64)> = turns.filter(|(_, turn)| *turn > CORNER).collect();
        let near = |row: usize| {
            let begin = sharp.partition_point(|(other, _)| fractions[*other] < fractions[row] - NEAR);
            let end = sharp.partition_point(|(other, _)| fractions[*other] <= fractions[row] + NEAR);
            &sharp[begin..end]
        };
        let is_sharpest = |(row, turn): &&(usize, f64)| {
            near(*row).iter().all(|(other, another)| another < turn || (another == turn && other >= row))
        };
        sharp.iter().filter(is_sharpest).map(|(row, _)| *row).collect()
    }
}
