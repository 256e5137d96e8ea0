//! The path cut into segments with constant acceleration along the path.

use super::joint_path::JointPath;
use crate::error::{Error, Result};

/// A part of one piece of the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Segment {
    /// The piece.
    pub piece: usize,
    /// Start within the piece (path parameter).
    pub from: f64,
    /// Length (path parameter).
    pub length: f64,
    /// Whether its piece begins at a corner of the path.
    pub is_after_corner: bool,
}

/// Largest number of grid points, which takes a tenth of a second; more count as a mistake.
pub(super) const MAX_GRIDPOINTS: usize = 200_000;

/// A squared path speed that represents no bound; finite, to leave room for arithmetic.
pub(super) const UNLIMITED: f64 = 1e100;

/// Checks that a grid is not too coarse to start and stop on, nor too fine to be intended.
///
/// # Errors
/// [`Error::OutOfRange`].
pub(super) fn check_gridpoints(gridpoints: usize) -> Result<()> {
    if (3..=MAX_GRIDPOINTS).contains(&gridpoints) {
        return Ok(());
    }
    Err(Error::out_of_range("gridpoints", format!("from 3 to {MAX_GRIDPOINTS}"), gridpoints as f64))
}

/// Maximum number of times that a segment is halved where the motion starts or ends at rest: at full acceleration the
/// speed limit is soon reached, and up to there the mean speed is half of it.
const HALVINGS: usize = 5;

/// Largest use of segments for halvings: one in this many segments of a piece is used for halvings.
const SEGMENTS_PER_HALVING: usize = 4;

/// Cuts the path into about `wanted` segments. No segment spans a break, and a piece that starts or ends at rest has
/// one segment to accelerate and one to decelerate. They have equal length, except near rest.
pub(super) fn cut(path: &JointPath, wanted: usize) -> Vec<Segment> {
    let last = path.pieces() - 1;
    let total = path.breaks()[last + 1] - path.breaks()[0];
    let mut segments = Vec::with_capacity(wanted + 2 * path.pieces());
    let mut is_after_corner = false;
    for piece in 0..=last {
        let length = path.length(piece);
        let is_before_corner = piece < last && path.has_corner_after(piece);
        let (rests_before, rests_after) = (piece == 0 || is_after_corner, piece == last || is_before_corner);
        // Slightly less than the quotient, so that rounding does not add one to each piece.
        let count = (wanted as f64 * length / total - 1e-6).ceil() as usize;
        let count = count.max(if rests_before || rests_after { 2 } else { 1 });
        let halvings = |rests: bool| if rests { HALVINGS.min(count / SEGMENTS_PER_HALVING) } else { 0 };
        let whole = Segment { piece, from: 0.0, length, is_after_corner };
        cut_piece(&whole, count, [halvings(rests_before), halvings(rests_after)], &mut segments);
        is_after_corner = is_before_corner;
    }
    segments
}

/// Cuts a piece into `count` segments; the first is halved `before` times and the last `after` times towards the ends
/// of the piece.
fn cut_piece(piece: &Segment, count: usize, [before, after]: [usize; 2], segments: &mut Vec<Segment>) {
    let length = piece.length;
    let even = count - before - after;
    let step = length / even as f64;
    let fraction = |halvings: usize| step * 0.5_f64.powi(halvings as i32);
    let near_begin = (1..=before).rev().map(fraction);
    let between = (0..=even).map(|i| i as f64 * step);
    let near_end = (1..=after).map(|halvings| length - fraction(halvings));
    let mut from = 0.0;
    let ends = near_begin.chain(between.skip(1).take(even - 1)).chain(near_end).chain([length]);
    for to in ends {
        segments.push(Segment { from, length: to - from, ..*piece });
        from = to;
    }
}
