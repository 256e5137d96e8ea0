//! Rungs of the ladder of configurations, and why a block has none.

use super::follower::Track;
use super::moving_tip::MovingTip;
use crate::message::Message;
use crate::objective::Point;

/// Joint difference below which two configurations are one.
pub(super) const SAME: f64 = 1e-6;

/// Configuration at the start of a block, and the joint positions along its paths.
#[derive(Debug, Clone)]
pub(super) struct Rung {
    pub q: Point,
    pub tracks: Vec<Track>,
    /// Estimate of the time up to the end of the block (s).
    pub cost: f64,
    /// The rung of the block before.
    pub before: usize,
}

impl Rung {
    pub fn end(&self) -> &[f64] {
        self.tracks.last().map_or(&self.q, Track::end)
    }
}

/// Reason why a block has no rung.
#[derive(Debug)]
pub(super) enum Dead {
    /// The goal of the joint move has no configuration: why.
    Goal(Message),
    /// A path is lost at this length.
    Path { path: usize, at: f64, cause: Cause },
}

/// Reason why a path is lost.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Cause {
    /// No configuration nearby continues it.
    OutOfReach,
    /// A joint would have to go to this value.
    Limit { joint: usize, value: f64 },
    /// A collision, a broken constraint, or a joint that cannot hold the arm, in words and with advice.
    Blocked(String),
}

/// A rung of the block before, by its index.
pub(super) type Before<'r> = (usize, &'r Rung);

/// The rungs of the block before, by where they leave the joints that do not move this tip alone; the quickest of each come first.
pub(super) fn groups<'r>(tip: &MovingTip<'_>, before: &'r [Rung]) -> Vec<Vec<Before<'r>>> {
    let mut groups: Vec<Vec<Before<'r>>> = vec![];
    for rung in before.iter().enumerate() {
        let is_like = |group: &&mut Vec<Before<'_>>| {
            let pairs = group[0].1.end().iter().zip(rung.1.end());
            pairs.enumerate().all(|(joint, (one, other))| tip.owns(joint) || (one - other).abs() < SAME)
        };
        match groups.iter_mut().find(is_like) {
            Some(group) => group.push(rung),
            None => groups.push(vec![rung]),
        }
    }
    groups
}

/// Smallest and largest value of a joint along tracks that begin at `q`.
pub(super) fn range(q: &[f64], tracks: &[Track], joint: usize) -> [f64; 2] {
    let rows = tracks.iter().flat_map(|track| track.rows.chunks_exact(q.len()));
    rows.map(|row| row[joint]).fold([q[joint]; 2], |[low, high], value| [low.min(value), high.max(value)])
}

/// Returns the reason that occurs later on the way.
pub(super) fn farther(known: Option<Dead>, found: Dead) -> Dead {
    let place = |dead: &Dead| match dead {
        Dead::Goal(_) => (0, 0.0),
        Dead::Path { path, at, .. } => (*path + 1, *at),
    };
    match known {
        Some(known) if place(&known) >= place(&found) => known,
        _ => found,
    }
}
