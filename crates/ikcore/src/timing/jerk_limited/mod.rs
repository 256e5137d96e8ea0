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

mod barrier;
mod clock;
mod constraints;
mod rate_spline;
mod readings;

use barrier::fastest_rate;
use clock::Clock;
use constraints::Constraints;
use rate_spline::RateSpline;
use readings::Readings;

use super::constant_limits::ConstantLimits;
use super::joint_path::JointPath;
use super::reachability::SpeedProfile;
use crate::error::{Error, Result};
use crate::interrupt::checkpoint_at;
use crate::limits::ROUNDING;
use crate::trajectory::Trajectory;

/// Largest slowdown of quintics between knots, relative to the need at the knots. Beyond it the intervals are halved, at most
/// `HALVINGS` times.
const FAITHFUL: f64 = 1.002;
const HALVINGS: u32 = 2;

/// Returns the fastest motion along `path`; `profile` is the fastest one without jerk limits.
///
/// # Errors
/// [`Error::UnsupportedLimit`] if the curvature of the path jumps; [`Error::Interrupted`].
pub(super) fn fastest(path: &JointPath, profile: &SpeedProfile, limits: &ConstantLimits) -> Result<Trajectory> {
    if (1..path.pieces()).any(|piece| path.has_curvature_jump_after(piece - 1)) {
        return Err(Error::UnsupportedLimit {
            field: "jerk".into(),
            method: "time_optimal on a polyline".into(),
            remedy: "its curvature jumps; use a spline".into(),
        });
    }
    let clock = Clock::new(path);
    let Readings { knots, step } = Readings::new(&clock, path, profile, limits);
    let mut rate = RateSpline::new(knots);
    let constraints = Constraints::new(&clock, &rate, limits, step);
    fastest_rate(&mut rate, constraints)?;
    let played = Played { path, clock, rate };
    let mut parts = 1;
    loop {
        let motion = played.interpolated(parts)?;
        let slowdown = limits.slowdown(&motion);
        if slowdown <= FAITHFUL || parts >= 1 << HALVINGS {
            return motion.slowed(slowdown * (1.0 + ROUNDING));
        }
        parts *= 2;
    }
}

/// A path passed at a rate of its clock.
struct Played<'a> {
    path: &'a JointPath,
    clock: Clock<'a>,
    rate: RateSpline,
}

impl Played<'_> {
    /// Returns quintics with the positions, velocities and accelerations at the knots of the rate, each interval cut in `parts`.
    fn interpolated(&self, parts: usize) -> Result<Trajectory> {
        let n = self.path.joints().len();
        let intervals = self.rate.intervals();
        let [mut q, mut qd, mut qdd] = [(); 3].map(|()| Vec::with_capacity((intervals * parts + 1) * n));
        let mut times = vec![0.0];
        let mut push = |interval: usize, fraction: f64| {
            let [y, slope, _] = self.rate.at(interval, fraction);
            let at = self.clock.at(self.rate.reading(interval, fraction), self.rate.reading(interval, 0.5));
            for joint in 0..n {
                let [position, first, second, _] = at.joint(joint);
                q.push(position);
                qd.push(first * y.sqrt());
                qdd.push(second * y + 0.5 * first * slope);
            }
        };
        push(0, 0.0);
        for interval in 0..intervals {
            checkpoint_at(interval)?;
            for part in 0..parts {
                let ends = [part, part + 1].map(|part| part as f64 / parts as f64);
                times.push(times[times.len() - 1] + self.rate.duration(interval, ends));
                push(interval, ends[1]);
            }
        }
        Trajectory::from_samples(self.path.joints().to_vec(), &times, &q, Some(&qd), Some(&qdd))
    }
}
