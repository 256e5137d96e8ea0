//! What slows the tip on a move, and when.

use super::timing::PathTime;
use super::tool_path::ToolPath;
use crate::error::Result;
use crate::math::Columns;
use crate::math::polynomial::evaluate;
use crate::math::so3::norm;
use crate::plan::SpeedBound;
use crate::robot::Robot;
use crate::timing::ConstantLimits;
use crate::trajectory::{Coefficients, Trajectory};

/// Shortfall of the speed, as a fraction of the one asked for, that counts as none.
const SHORT: f64 = 1e-3;

/// Largest speed of the tip on move `index` of a path (m/s), between its corners.
pub(super) fn speed_on(path: &ToolPath, index: usize, times: &[PathTime]) -> f64 {
    let is_on_it = |at: &&PathTime| {
        let piece = &path.pieces[path.piece_at(at.s)];
        piece.index == index && !piece.is_corner()
    };
    times.iter().filter(is_on_it).map(|at| at.rate).fold(0.0, f64::max)
}

/// What keeps the tip below the speed asked for on move `index`, between its corners.
pub(super) fn bounds_on(
    path: &ToolPath,
    index: usize,
    (motion, times, begin): (&Trajectory, &[PathTime], f64),
    limits: &ConstantLimits,
) -> Vec<SpeedBound> {
    let mut bounds: Vec<SpeedBound> = vec![];
    let Some((piece, asked)) = path.pieces.iter().enumerate().find_map(|(i, piece)| {
        let is_it = piece.index == index && !piece.is_corner();
        piece.speed.filter(|_| is_it).map(|speed| (i, speed))
    }) else {
        return bounds;
    };
    let [from, to] = [path.breaks[piece], path.breaks[piece + 1]];
    let mut is_slow_before = false;
    for (i, at) in times.iter().enumerate() {
        if at.s < from || at.s > to {
            continue;
        }
        let is_slow = at.rate < asked * (1.0 - SHORT);
        // A span reaches to the next sample on both sides, so that nothing slow is outside of it.
        let [before, after] = [i.saturating_sub(1), (i + 1).min(times.len() - 1)].map(|i| begin + times[i].t);
        if is_slow {
            let (joint, limit) = tightest(motion, at.t, limits);
            match bounds.last_mut() {
                Some(bound) if is_slow_before && bound.joint == joint && bound.limit == limit => bound.end = after,
                _ => bounds.push(SpeedBound { joint: joint.into(), limit: limit.into(), start: before, end: after }),
            }
        }
        is_slow_before = is_slow;
    }
    for i in 1..bounds.len() {
        let start = bounds[i].start;
        bounds[i - 1].end = bounds[i - 1].end.min(start.max(bounds[i - 1].start));
    }
    bounds
}

/// The joint and the limit that leave the least room at `t`.
fn tightest<'a>(motion: &Trajectory, t: f64, limits: &'a ConstantLimits) -> (&'a str, &'static str) {
    let n = limits.dof();
    let segment = motion.knots().partition_point(|knot| *knot <= t).clamp(1, motion.knots().len() - 1) - 1;
    let elapsed = t - motion.knots()[segment];
    let mut best = (f64::NEG_INFINITY, 0, "velocity");
    for joint in 0..n {
        let polynomial = &motion.coefficients()[segment * n + joint];
        let [_, velocity, acceleration] = evaluate(polynomial, elapsed);
        let used = [
            (velocity, limits.velocity[joint], "velocity"),
            (acceleration, limits.acceleration[joint], "acceleration"),
            (jerk(polynomial, elapsed), limits.jerk[joint], "jerk"),
        ];
        for (value, limit, name) in used {
            let share = value.abs() / limit;
            if share > best.0 {
                best = (share, joint, name);
            }
        }
    }
    (limits.joint_name(best.1), best.2)
}

/// Third derivative of a polynomial at `s`.
fn jerk(polynomial: &Coefficients, s: f64) -> f64 {
    polynomial
        .iter()
        .enumerate()
        .skip(3)
        .rev()
        .fold(0.0, |sum, (power, c)| sum * s + (power * (power - 1) * (power - 2)) as f64 * c)
}

/// Largest speed of the tip along a joint move (m/s), between these times of a motion (s).
///
/// # Errors
/// None in practice: the joints are those of the robot.
pub(super) fn tip_speed(robot: &Robot, motion: &Trajectory, [start, end]: [f64; 2]) -> Result<f64> {
    let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; robot.dof()]);
    let mut columns = Columns::default();
    let mut largest: f64 = 0.0;
    for ends in motion.knots().windows(2) {
        for t in [ends[0], 0.5 * (ends[0] + ends[1])].into_iter().filter(|t| start <= *t && *t <= end) {
            motion.at(t, &mut q, &mut qd, &mut qdd)?;
            robot.tip_and_jacobian(&q, &mut columns);
            let speed =
                [0, 1, 2].map(|k| qd.iter().zip(columns.iter()).map(|(qd, column)| qd * column[k]).sum::<f64>());
            largest = largest.max(norm(&speed));
        }
    }
    Ok(largest)
}
