//! Adaptive refinement of the grid.

use super::grid::{MAX_GRIDPOINTS, Segment};
use super::reachability::SpeedProfile;
use crate::error::Result;

/// The grid is refined until halving segments saves no more than this fraction of the duration. The error is
/// proportional to their length, so about as much remains.
const CONVERGED: f64 = 5e-4;

/// A segment is halved again if halving it saved more than this fraction of its part of the allowed error.
const WORTHWHILE: f64 = 0.2;

/// Returns the fastest profile on a grid that starts with `segments` and is halved wherever that saves time.
pub(super) fn refine(
    segments: Vec<Segment>,
    mut fastest: impl FnMut(Vec<Segment>) -> Result<SpeedProfile>,
) -> Result<SpeedProfile> {
    let mut halve = vec![true; segments.len()];
    let mut profile = fastest(segments)?;
    loop {
        let count = profile.segments.len() + halve.iter().filter(|halve| **halve).count();
        if count == profile.segments.len() || count >= MAX_GRIDPOINTS {
            return Ok(profile);
        }
        let finer = fastest(halved(&profile.segments, &halve))?;
        let duration = finer.duration();
        if profile.duration() - duration <= CONVERGED * duration {
            return Ok(finer);
        }
        halve = worthwhile(&profile, &halve, &finer, WORTHWHILE * CONVERGED * duration / count as f64);
        profile = finer;
    }
}

/// Returns the segments, with the marked ones cut in two.
fn halved(segments: &[Segment], halve: &[bool]) -> Vec<Segment> {
    let mut finer = Vec::with_capacity(2 * segments.len());
    for (segment, halve) in segments.iter().zip(halve) {
        if *halve {
            let length = 0.5 * segment.length;
            finer.push(Segment { length, ..*segment });
            finer.push(Segment { length, from: segment.from + length, ..*segment });
        } else {
            finer.push(*segment);
        }
    }
    finer
}

/// Returns which of the finer segments to halve next: those from a halving that saved more than `threshold` (s).
fn worthwhile(coarse: &SpeedProfile, halve: &[bool], finer: &SpeedProfile, threshold: f64) -> Vec<bool> {
    let mut spans = finer.spans();
    let mut next = Vec::with_capacity(finer.segments.len());
    for (span, halve) in coarse.spans().zip(halve) {
        let parts = if *halve { 2 } else { 1 };
        let now: f64 = spans.by_ref().take(parts).sum();
        next.extend((0..parts).map(|_| *halve && (span - now).abs() > threshold));
    }
    next
}
