//! Jerk limits, by smoothing the fastest motion in time.
//!
//! The path parameter of the fastest motion is averaged over a moving window. The joints stay on the path and their
//! jerk becomes finite; the wider the window, the smaller the jerk. The result is then scaled in time to be as fast as
//! all limits allow, and the window is chosen to minimise the duration. So every limit holds, but this is a smoothed
//! optimum, not the optimum under jerk limits.

use super::constant_limits::ConstantLimits;
use super::joint_path::JointPath;
use super::reachability::SpeedProfile;
use crate::error::{Error, Result};
use crate::interrupt::checkpoint_at;
use crate::limits::ROUNDING;
use crate::trajectory::Trajectory;

/// Narrowest and widest window, relative to the duration.
const WINDOWS: [f64; 2] = [1e-3, 2.0];
/// Number of windows tried over that range, in geometric steps.
const SCANNED: usize = 18;
/// Steps of the search around the best window after that; each keeps two thirds of the interval.
const CUTS: usize = 10;
/// Knots closer than this fraction of the duration are merged: a third derivative over a shorter span is dominated by
/// rounding.
const SMALLEST_SPAN: f64 = 3e-4;
/// Number of uniform knots, in addition to those where the jerk changes.
const EVEN_KNOTS: usize = 500;
/// Largest slowdown of quintics, relative to the need at their knots. Beyond it they oscillate between knots, whose
/// intervals are then halved, at most `HALVINGS` times.
const FAITHFUL: f64 = 1.03;
const HALVINGS: usize = 2;

/// Returns the motion of `profile` along `path`, smoothed until it also keeps the jerk limits.
///
/// # Errors
/// [`Error::UnsupportedLimit`] if the curvature of the path jumps.
pub(super) fn smooth(path: &JointPath, profile: &SpeedProfile, limits: &ConstantLimits) -> Result<Trajectory> {
    if (1..path.pieces()).any(|piece| path.has_curvature_jump_after(piece - 1)) {
        return Err(Error::UnsupportedLimit {
            field: "jerk".into(),
            method: "time_optimal on a polyline".into(),
            remedy: "its curvature jumps; use a spline".into(),
        });
    }
    let clock = Clock::new(path, profile);
    let played = |window: f64| {
        let smoothed = Smoothed { path, clock: &clock, window };
        Ok((clock.duration() + window) * smoothed.stretch(limits)?)
    };
    let window = shortest(played, clock.duration())?;
    Smoothed { path, clock: &clock, window }.trajectory(limits)
}

/// Returns the window with approximately the smallest duration `played`.
fn shortest(played: impl Fn(f64) -> Result<f64>, duration: f64) -> Result<f64> {
    let [narrowest, widest] = WINDOWS.map(f64::ln);
    let step = (widest - narrowest) / (SCANNED - 1) as f64;
    let window = |logarithm: f64| duration * logarithm.exp();
    let mut best = (f64::INFINITY, narrowest);
    for i in 0..SCANNED {
        let logarithm = narrowest + i as f64 * step;
        let duration = played(window(logarithm))?;
        if duration < best.0 {
            best = (duration, logarithm);
        }
    }
    let [mut lower, mut upper] = [best.1 - step, best.1 + step];
    for _ in 0..CUTS {
        let third = (upper - lower) / 3.0;
        if played(window(lower + third))? < played(window(upper - third))? {
            upper -= third;
        } else {
            lower += third;
        }
    }
    Ok(window(0.5 * (lower + upper)))
}

/// The path parameter s over time, with its integral; s is constant before and after.
struct Clock {
    times: Vec<f64>,
    /// s, its rate, half its acceleration, and the integral of s from the start: at the start of each segment, and at
    /// the end of the last.
    states: Vec<[f64; 4]>,
}

impl Clock {
    fn new(path: &JointPath, profile: &SpeedProfile) -> Self {
        let mut clock = Self { times: vec![0.0], states: Vec::with_capacity(profile.segments.len() + 1) };
        let mut integral = 0.0;
        for (i, (segment, span)) in profile.segments.iter().zip(profile.spans()).enumerate() {
            let [x0, x1] = [profile.squared_speeds[i], profile.squared_speeds[i + 1]];
            let s = path.breaks()[segment.piece] + segment.from;
            let (v, w) = (x0.sqrt(), 0.25 * (x1 - x0) / segment.length);
            clock.states.push([s, v, w, integral]);
            clock.times.push(clock.times[i] + span);
            integral += span * (s + span * (v / 2.0 + span * w / 3.0));
        }
        clock.states.push([path.breaks()[path.pieces()], 0.0, 0.0, integral]);
        clock
    }

    fn duration(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// Returns the integral of s, s, its rate, and its acceleration at `t`; at a knot, those of the next segment.
    fn at(&self, t: f64) -> [f64; 4] {
        if t < 0.0 {
            let s = self.states[0][0];
            return [s * t, s, 0.0, 0.0];
        }
        let i = self.times.partition_point(|time| *time <= t) - 1;
        let [s, v, w, integral] = self.states[i];
        let h = t - self.times[i];
        [integral + h * (s + h * (v / 2.0 + h * w / 3.0)), s + h * (v + h * w), v + 2.0 * h * w, 2.0 * w]
    }
}

/// The motion with its path parameter averaged over the last `window` seconds.
struct Smoothed<'a> {
    path: &'a JointPath,
    clock: &'a Clock,
    window: f64,
}

impl Smoothed<'_> {
    /// s, its rate, acceleration and jerk at `t`.
    fn parameter(&self, t: f64) -> [f64; 4] {
        let [now, before] = [self.clock.at(t), self.clock.at(t - self.window)];
        [0, 1, 2, 3].map(|i| (now[i] - before[i]) / self.window)
    }

    /// Times at which the jerk of the parameter changes (where the clock's acceleration changes, now or a window ago),
    /// and times in between, because one segment may cover much of the path.
    fn knots(&self) -> Vec<f64> {
        let times = &self.clock.times;
        let evenly = (0..EVEN_KNOTS).map(|i| (self.clock.duration() + self.window) * i as f64 / EVEN_KNOTS as f64);
        let late = times.iter().map(|time| time + self.window);
        let mut knots: Vec<f64> = times.iter().copied().chain(late).chain(evenly).collect();
        knots.sort_by(f64::total_cmp);
        let end = knots[knots.len() - 1];
        knots.dedup_by(|later, earlier| *later - *earlier < SMALLEST_SPAN * end);
        // The end itself stays, even if another knot is close before it.
        knots.pop();
        knots.push(end);
        knots
    }

    /// Factor by which the motion must be slowed down to keep all limits at its knots; below 1 it can be faster.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    fn stretch(&self, limits: &ConstantLimits) -> Result<f64> {
        let mut largest = 0.0_f64;
        for (i, t) in self.knots().into_iter().enumerate() {
            checkpoint_at(i)?;
            let [s, rate, acceleration, change] = self.parameter(t);
            let (piece, from) = self.path.locate(s);
            for j in 0..limits.dof() {
                let [_, first, second] = self.path.joint_at(piece, from, j);
                let third = 6.0 * self.path.powers(piece)[3][j];
                let derivatives = [
                    first * rate,
                    second * rate * rate + first * acceleration,
                    third * rate.powi(3) + 3.0 * second * rate * acceleration + first * change,
                ];
                largest = largest.max(limits.joint_slowdown(j, derivatives));
            }
        }
        Ok(largest)
    }

    /// Returns the motion as quintics, as fast as their exact extremes allow.
    fn trajectory(&self, limits: &ConstantLimits) -> Result<Trajectory> {
        let expected = self.stretch(limits)?;
        let mut knots = self.knots();
        for _ in 0..HALVINGS {
            let (played, stretch) = self.interpolated(&knots, limits)?;
            if stretch <= FAITHFUL * expected {
                return played.slowed(stretch * (1.0 + ROUNDING));
            }
            knots = with_midpoints(&knots);
        }
        let (played, stretch) = self.interpolated(&knots, limits)?;
        played.slowed(stretch * (1.0 + ROUNDING))
    }

    /// Returns the quintics between `knots`, and the factor by which they must be slowed down.
    fn interpolated(&self, knots: &[f64], limits: &ConstantLimits) -> Result<(Trajectory, f64)> {
        let n = limits.dof();
        let [mut q, mut qd, mut qdd] = [(); 3].map(|()| Vec::with_capacity(knots.len() * n));
        for (i, t) in knots.iter().enumerate() {
            checkpoint_at(i)?;
            let [s, rate, acceleration, _] = self.parameter(*t);
            let (piece, from) = self.path.locate(s);
            for j in 0..n {
                let [position, first, second] = self.path.joint_at(piece, from, j);
                q.push(position);
                qd.push(first * rate);
                qdd.push(second * rate * rate + first * acceleration);
            }
        }
        let played = Trajectory::from_samples(self.path.joints().to_vec(), knots, &q, Some(&qd), Some(&qdd))?;
        let stretch = limits.slowdown(&played);
        Ok((played, stretch))
    }
}

fn with_midpoints(knots: &[f64]) -> Vec<f64> {
    let mut finer: Vec<f64> = knots.windows(2).flat_map(|pair| [pair[0], 0.5 * (pair[0] + pair[1])]).collect();
    finer.extend(knots.last());
    finer
}
