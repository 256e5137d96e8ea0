//! The fastest motion along a path within limits on velocity, acceleration and jerk.
//!
//! The path is passed by a smooth clock u from 0 to 1 ([`Clock`]), and y = (du/dt)^2 is a quadratic spline in u. Then velocities and
//! accelerations are linear in y and its derivatives, and a jerk is sqrt(y) times a linear form, so that its limit bounds a linear form by
//! the convex J / sqrt(y): Debrouwere et al., "Time-optimal path following for robots with convex-concave constraints using sequential convex
//! programming", IEEE Transactions on Robotics 29 (2013), section III. Here a barrier takes the place of the sequence of programs.
//!
//! | file | what |
//! |---|---|
//! | `clock` | the clock: where the path is at each reading |
//! | `readings` | knots of the spline, close together where the motion takes its time |
//! | `rate_spline` | quadratic splines on any knots |
//! | `constraints` | the limits at points of the clock, as rows for y and its derivatives |
//! | `barrier` | the fastest rate within the limits, by Newton's method with a barrier |
//! | `four_points` | its value and derivatives, at four points at a time |
//! | `straight_line` | the fastest motion along a straight line, in closed form |

mod barrier;
mod clock;
mod constraints;
mod four_points;
mod rate_spline;
mod readings;
mod straight_line;

use barrier::{faster_rate, fastest_rate};
use clock::Clock;
use constraints::Constraints;
use rate_spline::RateSpline;
use readings::Readings;
use straight_line::straight_line;

use super::constant_limits::ConstantLimits;
use super::joint_path::JointPath;
use super::reachability::SpeedProfile;
use crate::error::{Error, Result};
use crate::interrupt::checkpoint_at;
use crate::limits::ROUNDING;
use crate::trajectory::Trajectory;

/// Maximum number of knot refinements.
const REFINEMENTS: usize = 6;
/// Relative saving of duration below which refinement ends.
const WORTHWHILE: f64 = 1e-3;
/// Relative saving below which refinement ends even if limits are exceeded between grid points.
const WORTHLESS: f64 = 1e-4;
/// Relative excess over a limit between grid points that calls for another refinement.
const FAITHFUL: f64 = 2e-3;
/// Change of the jerk in an interval or at a knot, as a part of its limit, at which intervals are halved.
const CHANGE: f64 = 0.3;
/// Relative slowdown above which a path with speeds of its own is timed again for higher ones, so that its own are reached.
const SHORT: f64 = 1e-4;
/// Tolerated excess over a position limit (rad, m).
const TOUCHES: f64 = 1e-10;
/// Distance inside a position limit to which the path moves after a larger excess, as a multiple of the excess.
const ROOM: f64 = 2.0;
/// Number of the shortest intervals that a motion may consist of.
const SHORTEST: f64 = 5_000.0;

/// Returns the fastest motion along `path`; `profile` is the fastest one without jerk limits.
///
/// # Errors
/// [`Error::UnsupportedLimit`] if the curvature of the path jumps; [`Error::Interrupted`].
pub(super) fn fastest(path: &JointPath, profile: &SpeedProfile, limits: &ConstantLimits) -> Result<Trajectory> {
    let motion = timed(path, profile, limits, REFINEMENTS)?;
    let Some(inside) = farther_inside(path, &motion, limits) else { return Ok(motion) };
    match timed(&inside, profile, limits, REFINEMENTS) {
        Err(error @ Error::Interrupted) => Err(error),
        // Without a motion farther inside, the first one is kept.
        Err(_) => Ok(motion),
        again => again,
    }
}

/// A path like `path`, whose motion swings beyond position limits that the path keeps: between its samples the motion is near the path, not
/// on it. The path is moved farther inside by twice the swing, but for its ends. `None` where the motion keeps the limits.
fn farther_inside(path: &JointPath, motion: &Trajectory, limits: &ConstantLimits) -> Option<JointPath> {
    let [mut lower, mut upper] = [f64::NEG_INFINITY, f64::INFINITY].map(|bound| vec![bound; path.joints().len()]);
    let mut swings = false;
    for (joint, (lowest, highest)) in motion.position_range().into_iter().enumerate() {
        let swing = [limits.lower[joint] - lowest, highest - limits.upper[joint]];
        if swing.iter().all(|swing| *swing <= TOUCHES) {
            continue;
        }
        let [least, most] = path.range(joint);
        if swing[0] > TOUCHES && least >= limits.lower[joint] - TOUCHES {
            (lower[joint], swings) = (limits.lower[joint] + ROOM * swing[0], true);
        }
        if swing[1] > TOUCHES && most <= limits.upper[joint] + TOUCHES {
            (upper[joint], swings) = (limits.upper[joint] - ROOM * swing[1], true);
        }
    }
    let has_room = lower.iter().zip(&upper).all(|(lower, upper)| lower <= upper);
    (swings && has_room).then(|| path.clone().inside(&lower, &upper))
}

/// Returns a motion along `path` that is hardly slower.
///
/// # Errors
/// As [`fastest`].
pub(super) fn rough(path: &JointPath, profile: &SpeedProfile, limits: &ConstantLimits) -> Result<Trajectory> {
    timed(path, profile, limits, 0)
}

fn timed(path: &JointPath, profile: &SpeedProfile, limits: &ConstantLimits, rounds: usize) -> Result<Trajectory> {
    if (1..path.pieces()).any(|piece| path.has_curvature_jump_after(piece - 1)) {
        return Err(Error::UnsupportedLimit {
            field: "jerk".into(),
            method: "time_optimal on a polyline".into(),
            remedy: "its curvature jumps; use a spline".into(),
        });
    }
    if let Some(motion) = straight_line(path, limits)? {
        return Ok(motion);
    }
    let mut clock = Clock::new(path);
    let Readings { knots, step } = Readings::new(&clock, path, profile, limits);
    let mut rate = RateSpline::new(knots);
    let mut constraints = Constraints::new(&clock, &rate, &vec![step; rate.intervals()], limits);
    fastest_rate(&mut rate, &mut constraints)?;
    let (mut best, mut slowed) = played(path, &clock, &rate, limits)?;
    for _ in 0..rounds {
        let parts = parts(&rate, &constraints, best.duration() / SHORTEST);
        if parts.iter().all(|parts| *parts == 1) {
            break;
        }
        rate = rate.refined(&parts);
        constraints = Constraints::new(&clock, &rate, &rate.durations(), limits);
        faster_rate(&mut rate, &mut constraints)?;
        if !rate.is_finite() {
            return Ok(best);
        }
        let (motion, slowdown) = played(path, &clock, &rate, limits)?;
        let saved = 1.0 - motion.duration() / best.duration();
        slowed = slowdown;
        if saved > 0.0 {
            best = motion;
        }
        if saved < WORTHLESS || saved < WORTHWHILE && slowdown < 1.0 + FAITHFUL {
            break;
        }
    }
    if rounds > 0 && path.has_speeds() && slowed > 1.0 + SHORT {
        // The whole motion was slowed, and with it the speeds that the path has.
        clock.speedup = slowed;
        constraints = Constraints::new(&clock, &rate, &rate.durations(), limits);
        faster_rate(&mut rate, &mut constraints)?;
        if !rate.is_finite() {
            return Ok(best);
        }
        let (motion, _) = played(path, &clock, &rate, limits)?;
        if motion.duration() < best.duration() {
            best = motion;
        }
    }
    Ok(best)
}

/// Parts into which each interval is to be cut: two where the jerk of a joint changes much in it or at its ends, unless it takes less than
/// `shortest` (s).
fn parts(rate: &RateSpline, constraints: &Constraints, shortest: f64) -> Vec<usize> {
    let mut parts = vec![1; rate.intervals()];
    let times = rate.durations();
    for (interval, changes) in constraints.jerk_changes(rate).into_iter().enumerate() {
        let beside = [Some(interval), (interval + 1 < rate.intervals()).then_some(interval + 1)];
        let halved = if changes[1] > CHANGE {
            &beside[..]
        } else if changes[0] > CHANGE {
            &beside[..1]
        } else {
            &[]
        };
        halved.iter().flatten().filter(|i| times[**i] > shortest).for_each(|i| parts[*i] = 2);
    }
    parts
}

/// Quintics with the positions, velocities and accelerations of a path at the knots of the rate of its clock, slowed down as the limits need,
/// and by how much.
fn played(path: &JointPath, clock: &Clock, rate: &RateSpline, limits: &ConstantLimits) -> Result<(Trajectory, f64)> {
    let n = path.joints().len();
    let [mut q, mut qd, mut qdd] = [(); 3].map(|()| Vec::with_capacity((rate.intervals() + 1) * n));
    let mut times = vec![0.0];
    let mut push = |interval: usize, fraction: f64| {
        let [y, slope, _] = rate.at(interval, fraction);
        let at = clock.at(rate.reading(interval, fraction), rate.reading(interval, 0.5));
        for joint in 0..n {
            let [position, first, second, _] = at.joint(joint);
            q.push(position);
            qd.push(first * y.sqrt());
            qdd.push(second * y + 0.5 * first * slope);
        }
    };
    push(0, 0.0);
    for (interval, duration) in rate.durations().into_iter().enumerate() {
        checkpoint_at(interval)?;
        times.push(times[times.len() - 1] + duration);
        push(interval, 1.0);
    }
    let motion = Trajectory::from_samples(path.joints().to_vec(), &times, &q, Some(&qd), Some(&qdd))?;
    // A path with speeds of its own is not passed faster than these.
    let least = if path.has_speeds() { clock.speedup } else { 0.0 };
    let slowdown = limits.slowdown(&motion).max(least);
    Ok((motion.slowed(slowdown * (1.0 + ROUNDING))?, slowdown))
}
