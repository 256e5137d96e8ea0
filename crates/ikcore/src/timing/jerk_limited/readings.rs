//! Knots for the rate of the clock.

use super::super::constant_limits::ConstantLimits;
use super::super::joint_path::JointPath;
use super::super::reachability::SpeedProfile;
use super::clock::Clock;

/// Base number of equal time intervals.
const LEAST: f64 = 150.0;
/// Further intervals per piece of the path, if these are fewer than those by ramps.
const PER_PIECE: f64 = 20.0;
/// Further intervals per acceleration ramp, the shortest time in which an acceleration reaches its limit.
const PER_RAMP: f64 = 10.0;
/// Maximum number of intervals.
const MOST: f64 = 20_000.0;

/// Fraction of an interval within which a knot at an equal time is left out beside another knot.
const CLOSE: f64 = 0.3;
/// The same for two breaks or ends of the path.
const CLOSE_BREAKS: f64 = 0.1;

/// Parts into which the intervals at both ends are cut: with limited jerk the motion takes longer there.
const PARTS_AT_ENDS: [usize; 3] = [8, 4, 2];

/// Knots for the rate of a clock.
#[derive(Debug)]
pub(super) struct Readings {
    /// Increasing, from 0 to 1.
    pub knots: Vec<f64>,
    /// Time (s) between two of them, in the fastest motion without jerk limits.
    pub step: f64,
}

impl Readings {
    /// Readings at equal times of `profile`, the fastest motion without jerk limits, and at the breaks of the path, where its third
    /// derivative jumps.
    pub(super) fn new(clock: &Clock, path: &JointPath, profile: &SpeedProfile, limits: &ConstantLimits) -> Self {
        let step = time_step(path, profile.duration(), limits);
        let mut kept = vec![Knot { time: 0.0, s: path.breaks()[0], rank: Rank::End }];
        let (mut time, mut next) = (0.0, 1);
        for (i, (segment, span)) in profile.segments.iter().zip(profile.spans()).enumerate() {
            let begin = path.breaks()[segment.piece] + segment.from;
            if segment.from == 0.0 {
                keep(&mut kept, Knot { time, s: begin, rank: Rank::Break }, step);
            }
            let [v, v_end] = [i, i + 1].map(|point| profile.squared_speeds[point].sqrt());
            while f64::from(next) * step < time + span {
                let t = f64::from(next) * step - time;
                let s = begin + t * (v + 0.5 * t * (v_end - v) / span);
                keep(&mut kept, Knot { time: time + t, s, rank: Rank::Time }, step);
                next += 1;
            }
            time += span;
        }
        keep(&mut kept, Knot { time, s: path.breaks()[path.pieces()], rank: Rank::End }, step);
        let inner = kept[1..kept.len() - 1].iter().map(|knot| clock.reading(knot.s));
        let mut knots: Vec<f64> = std::iter::once(0.0).chain(inner).chain([1.0]).collect();
        knots.dedup_by(|later, earlier| *later <= *earlier);
        Self { knots: cut_at_ends(&knots), step }
    }
}

/// Time (s) between two knots of a motion that takes `duration` without jerk limits.
fn time_step(path: &JointPath, duration: f64, limits: &ConstantLimits) -> f64 {
    let ramps = limits.acceleration.iter().zip(&limits.jerk).map(|(acceleration, jerk)| acceleration / jerk);
    let shortest = ramps.filter(|time| *time > 0.0).fold(f64::INFINITY, f64::min);
    let more = (PER_RAMP * duration / shortest).min(PER_PIECE * path.pieces() as f64);
    duration / (LEAST + more).min(MOST)
}

fn cut_at_ends(knots: &[f64]) -> Vec<f64> {
    let intervals = knots.len() - 1;
    let mut finer = Vec::with_capacity(knots.len() + 2 * PARTS_AT_ENDS.iter().sum::<usize>());
    for (i, ends) in knots.windows(2).enumerate() {
        let parts = PARTS_AT_ENDS.get(i.min(intervals - 1 - i)).copied().unwrap_or(1);
        finer.extend((0..parts).map(|part| ends[0] + (ends[1] - ends[0]) * part as f64 / parts as f64));
    }
    finer.push(knots[intervals]);
    finer
}

struct Knot {
    time: f64,
    s: f64,
    rank: Rank,
}

#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
enum Rank {
    Time,
    Break,
    End,
}

/// Adds a knot, unless the last one is close; a break takes the place of those in time, and the end that of all.
fn keep(knots: &mut Vec<Knot>, knot: Knot, step: f64) {
    while let Some(last) = knots.last() {
        let closeness = if last.rank == Rank::Time || knot.rank == Rank::Time { CLOSE } else { CLOSE_BREAKS };
        if knot.time - last.time >= closeness * step {
            break;
        }
        if knot.rank <= last.rank {
            return;
        }
        knots.pop();
    }
    knots.push(knot);
}
