//! Adaptive refinement of the grid.
//!
//! A profile keeps the limits over whole segments and is therefore slower than the fastest motion. The time that a segment loses is proportional
//! to the square of its length. Comparing a profile with one on halved segments, or with one that keeps limits only on average over each
//! segment, estimates the loss.

use super::grid::{MAX_GRIDPOINTS, Segment};
use super::reachability::SpeedProfile;
use crate::error::Result;

/// Fraction of the allowed loss that a new grid aims at, because losses are estimates.
const AIM: f64 = 0.6;

/// Maximum number of halvings of a segment from one grid to the next.
const MAX_HALVINGS: u32 = 3;

/// Returns the fastest profile on a grid that starts as that of `profile` and is refined where that saves most time, until it loses less than
/// this fraction of the duration. `losses` is what the segments lose (s), where that is known.
pub(super) fn refine(
    mut profile: SpeedProfile,
    losses: Option<Vec<f64>>,
    tolerance: f64,
    mut fastest: impl FnMut(Vec<Segment>) -> Result<SpeedProfile>,
) -> Result<SpeedProfile> {
    let mut halvings = match &losses {
        Some(losses) => for_loss(losses, AIM * tolerance * profile.duration()),
        None => vec![1; profile.segments.len()],
    };
    let mut losses = losses.unwrap_or_else(|| vec![0.0; profile.segments.len()]);
    loop {
        let count: usize = halvings.iter().map(|times| 1 << times).sum();
        if count == halvings.len() || count >= MAX_GRIDPOINTS {
            return Ok(profile);
        }
        let finer = fastest(halved(&profile.segments, &halvings))?;
        losses = left(&losses, [&profile, &finer], &halvings);
        profile = finer;
        let allowed = tolerance * profile.duration();
        if losses.iter().sum::<f64>() <= allowed {
            return Ok(profile);
        }
        halvings = for_loss(&losses, AIM * allowed);
    }
}

/// Returns the segments, each halved as often as `halvings` says.
fn halved(segments: &[Segment], halvings: &[u32]) -> Vec<Segment> {
    let parts_of = |(segment, times): (&Segment, &u32)| {
        let (segment, parts) = (*segment, 1 << times);
        let length = segment.length / f64::from(parts);
        (0..parts).map(move |i| Segment { length, from: segment.from + f64::from(i) * length, ..segment })
    };
    segments.iter().zip(halvings).flat_map(parts_of).collect()
}

/// Returns the time (s) that each segment of the finer profile loses, by what halving saved.
fn left(losses: &[f64], [coarse, finer]: [&SpeedProfile; 2], halvings: &[u32]) -> Vec<f64> {
    let mut spans = finer.spans();
    let mut left = Vec::with_capacity(finer.segments.len());
    for ((before, times), loss) in coarse.spans().zip(halvings).zip(losses) {
        let parts = 1 << times;
        let now: f64 = spans.by_ref().take(parts).sum();
        let loss = if *times == 0 { *loss } else { (before - now).abs() / ((parts * parts) as f64 - 1.0) };
        left.extend(std::iter::repeat_n(loss / parts as f64, parts));
    }
    left
}

/// Returns how often to halve each segment for the least number of them that together lose about `wanted` (s). Segments in n parts lose
/// the sum of loss / n^2, which is least for n that grow with the cube root of the loss.
fn for_loss(losses: &[f64], wanted: f64) -> Vec<u32> {
    let roots = || losses.iter().map(|loss| loss.cbrt());
    let by_root = (roots().sum::<f64>() / wanted).sqrt();
    roots().map(|root| (by_root * root).log2().round().clamp(0.0, f64::from(MAX_HALVINGS)) as u32).collect()
}
