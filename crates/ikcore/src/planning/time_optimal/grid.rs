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

/// Cuts the path into about `wanted` segments of equal length, so that no segment reaches over a break and a piece that
/// begins or ends at rest has one to speed up and one to slow down.
pub(super) fn cut(path: &JointPath, wanted: usize) -> Vec<Segment> {
    let last = path.pieces() - 1;
    let total = path.breaks()[last + 1] - path.breaks()[0];
    let mut segments = Vec::with_capacity(wanted + 2 * path.pieces());
    for piece in 0..=last {
        let length = path.length(piece);
        let stops = piece == 0 || piece == last || path.has_corner_after(piece - 1) || path.has_corner_after(piece);
        // A little less than the quotient, lest rounding adds one to each piece.
        let count = (wanted as f64 * length / total - 1e-6).ceil() as usize;
        let count = count.max(if stops { 2 } else { 1 });
        let step = length / count as f64;
        segments.extend((0..count).map(|i| Segment { piece, from: i as f64 * step, length: step }));
    }
    segments
}
