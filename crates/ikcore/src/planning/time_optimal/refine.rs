//! A grid that is fine where it matters.

use super::grid::{MAX_GRIDPOINTS, Segment};
use super::reachability::SpeedProfile;
use crate::error::Result;

/// Refined until halving segments saves no more than this share of the duration. The error falls with their length, so
/// that about as much remains.
const CONVERGED: f64 = 5e-4;

/// A segment is halved again where halving it saved more than this share of what it may contribute.
const WORTHWHILE: f64 = 0.2;

/// The fastest profile on a grid that begins with `segments` and is halved where halving saves time.
pub(super) fn refine(
    segments: Vec<Segment>,
    fastest: impl Fn(Vec<Segment>) -> Result<SpeedProfile>,
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

/// The segments, those marked cut in two.
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

/// Which of the finer segments to halve next: those that came out of a halving which saved more than `threshold` (s).
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
