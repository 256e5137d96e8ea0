//! Limits that slow the tip on a move, and when.

use super::moving_tip::MovingTip;
use super::timing::PathTime;
use super::tool_path::ToolPath;
use crate::error::Result;
use crate::math::Columns;
use crate::math::so3::norm;
use crate::plan::SpeedBound;
use crate::timing::{ConstantLimits, OneLimit};
use crate::trajectory::Trajectory;

/// Tolerated shortfall of the rate of the path, as a fraction of the requested speed: that of the tip is then below 1e-3.
const SHORT: f64 = 8e-4;

/// Fraction of the tightest limit's share above which the limit before is still named, so that names do not alternate between joints.
const STILL: f64 = 0.95;

/// Substitute for the tightest limit of an arm without joints.
const NO_LIMIT: (OneLimit, f64) = (OneLimit::Joint(0, "velocity"), 0.0);

/// Largest speed of the tip on move `index` of a path (m/s), between its corners; `None` where they take all of it.
pub(super) fn speed_on(path: &ToolPath, index: usize, times: &[PathTime]) -> Option<f64> {
    let is_on_it = |at: &&PathTime| {
        let piece = &path.pieces[path.piece_at(at.s)];
        piece.index == index && !piece.is_corner()
    };
    times.iter().filter(is_on_it).map(|at| at.rate).reduce(f64::max)
}

/// Limits that keep the tip below the requested speed on move `index`, between its corners.
pub(super) fn bounds_on(
    path: &ToolPath,
    index: usize,
    (motion, times, begin): (&Trajectory, &[PathTime], f64),
    limits: &ConstantLimits,
) -> Vec<SpeedBound> {
    let Some((piece, asked)) = path.pieces.iter().enumerate().find_map(|(i, piece)| {
        let is_it = piece.index == index && !piece.is_corner();
        piece.speed.filter(|_| is_it).map(|speed| (i, speed))
    }) else {
        return vec![];
    };
    let [from, to] = [path.breaks[piece], path.breaks[piece + 1]];
    let mut spans: Vec<(OneLimit, [f64; 2])> = vec![];
    let mut binding = None;
    for (i, at) in times.iter().enumerate().filter(|(_, at)| from <= at.s && at.s <= to) {
        let is_slow = at.rate < asked * (1.0 - SHORT);
        let limit = is_slow.then(|| tightest(motion, at.t, limits, binding));
        if let Some(limit) = limit {
            // A span reaches to the next sample on both sides, so that nothing slow is outside of it.
            let [before, after] = [i.saturating_sub(1), (i + 1).min(times.len() - 1)].map(|i| begin + times[i].t);
            match spans.last_mut() {
                Some((_, [_, end])) if binding == Some(limit) => *end = after,
                _ => spans.push((limit, [before, after])),
            }
        }
        binding = limit;
    }
    for i in 1..spans.len() {
        let start = spans[i].1[0];
        let [begin, end] = spans[i - 1].1;
        spans[i - 1].1 = [begin, end.min(start.max(begin))];
    }
    let bound = |(limit, [start, end]): (OneLimit, [f64; 2])| {
        let [limit, of] = limits.names(limit);
        SpeedBound { limit, of, start, end }
    };
    spans.into_iter().map(bound).collect()
}

/// The limit that leaves the least room at `t`; still the one `before` where that leaves hardly more.
fn tightest(motion: &Trajectory, t: f64, limits: &ConstantLimits, before: Option<OneLimit>) -> OneLimit {
    let shares = limits.shares(motion, t);
    let share = |limit: OneLimit| shares.iter().find(|(one, _)| *one == limit).map_or(0.0, |(_, share)| *share);
    let (tightest, most) = shares.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or(NO_LIMIT);
    before.filter(|before| share(*before) >= STILL * most).unwrap_or(tightest)
}

/// Largest speed of any of these tips along a joint move (m/s), between these times of a motion (s).
///
/// # Errors
/// None in practice: the joints are those of the robot.
pub(super) fn tip_speed(tips: &[MovingTip<'_>], motion: &Trajectory, [start, end]: [f64; 2]) -> Result<f64> {
    let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; motion.joints().len()]);
    let mut columns = Columns::default();
    let mut largest: f64 = 0.0;
    for ends in motion.knots().windows(2) {
        for t in [ends[0], 0.5 * (ends[0] + ends[1])].into_iter().filter(|t| start <= *t && *t <= end) {
            motion.at(t, &mut q, &mut qd, &mut qdd)?;
            for tip in tips {
                tip.frame_and_jacobian(&q, &mut columns);
                let speed =
                    [0, 1, 2].map(|k| qd.iter().zip(columns.iter()).map(|(qd, column)| qd * column[k]).sum::<f64>());
                largest = largest.max(norm(&speed));
            }
        }
    }
    Ok(largest)
}
