//! The path cut into segments, in each of which the acceleration along the path is constant.

use super::joint_path::JointPath;
use crate::error::{Error, Result};

/// A stretch of one piece of the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Segment {
    /// The piece.
    pub piece: usize,
    /// Where in the piece it begins (path parameter).
    pub from: f64,
    /// How long it is (path parameter).
    pub length: f64,
}

/// More grid points than this are taken for a mistake: a tenth of a second of work.
pub(super) const MAX_GRIDPOINTS: usize = 200_000;

/// Err for a grid too coarse to start and stop on, or too fine to be meant.
///
/// # Errors
/// [`Error::OutOfRange`].
pub(super) fn check_gridpoints(gridpoints: usize) -> Result<()> {
    if (3..=MAX_GRIDPOINTS).contains(&gridpoints) {
        return Ok(());
    }
    Err(Error::out_of_range("gridpoints", &format!("from 3 to {MAX_GRIDPOINTS}"), gridpoints as f64))
}

/// Where the motion begins or ends at rest, a segment is halved so often at the most: at full acceleration the speed
/// limit is soon reached, and on the segment to there the mean speed is half of it.
const HALVINGS: usize = 5;

/// At most one in this many of a piece's segments is spent on halvings.
const SHARE: usize = 4;

/// Cuts the path into about `wanted` segments, so that no segment reaches over a break and a piece that begins or ends at
/// rest has one to speed up and one to slow down. They are of equal length, except towards rest.
pub(super) fn cut(path: &JointPath, wanted: usize) -> Vec<Segment> {
    let last = path.pieces() - 1;
    let total = path.breaks()[last + 1] - path.breaks()[0];
    let mut segments = Vec::with_capacity(wanted + 2 * path.pieces());
    let mut rests_before = true;
    for piece in 0..=last {
        let length = path.length(piece);
        let rests_after = piece == last || path.has_corner_after(piece);
        // A little less than the quotient, lest rounding adds one to each piece.
        let count = (wanted as f64 * length / total - 1e-6).ceil() as usize;
        let count = count.max(if rests_before || rests_after { 2 } else { 1 });
        let halvings = |rests: bool| if rests { HALVINGS.min(count / SHARE) } else { 0 };
        cut_piece(piece, length, count, [halvings(rests_before), halvings(rests_after)], &mut segments);
        rests_before = rests_after;
    }
    segments
}

/// Cuts a piece into `count` segments, of which the first and the last are halved so often towards its ends.
fn cut_piece(piece: usize, length: f64, count: usize, [before, after]: [usize; 2], segments: &mut Vec<Segment>) {
    let even = count - before - after;
    let step = length / even as f64;
    let share = |halvings: usize| step * 0.5_f64.powi(halvings as i32);
    let near_begin = (1..=before).rev().map(share);
    let between = (0..=even).map(|i| i as f64 * step);
    let near_end = (1..=after).map(|halvings| length - share(halvings));
    let mut from = 0.0;
    let ends = near_begin.chain(between.skip(1).take(even - 1)).chain(near_end).chain([length]);
    for to in ends {
        segments.push(Segment { piece, from, length: to - from });
        from = to;
    }
}
