//! The fastest smooth motion along straight lines in joint space within velocity, acceleration and jerk limits.

use super::constant_limits::ConstantLimits;
use super::polyline::JointPolyline;
use super::quintic::quintic;
use super::time_optimal::{TimingOptions, time};
use super::time_scaling::{CAUTION, within_limits};
use crate::error::{Error, Result};
use crate::math::one_joint::{JointProfile, MotionState, Rates, Transfer};
use crate::math::vector::point_between;
use crate::trajectory::{Trajectory, polynomial};

/// Largest acceleration of a blend, relative to change of velocity / duration.
const BLEND_ACCELERATION: f64 = 1.5;
/// Largest jerk of a blend, relative to change of velocity / duration^2.
const BLEND_JERK: f64 = 6.0;

/// Fraction by which a blend may be shorter than needed.
const TOO_SHORT: f64 = 1e-9;

/// Maximum number of rounds in which blends and velocities are adjusted to each other.
const ROUNDS: usize = 200;

/// Durations of a motion with blends (s): of the lines as if there were no blends, and of the blends.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct BlendTimes {
    lines: Vec<f64>,
    blends: Vec<f64>,
}

impl BlendTimes {
    /// Duration of the motion (s): the first and the last blend take half of their time from their line.
    pub(crate) fn total(&self) -> f64 {
        self.lines.iter().sum::<f64>() + 0.5 * (self.blends[0] + self.blends[self.blends.len() - 1])
    }
}

/// A motion within limits of tips and torques.
#[derive(Debug)]
pub(crate) struct Paced {
    pub motion: Trajectory,
    /// Whether it keeps them: a joint that cannot hold the arm exceeds its limit however slow the motion is.
    pub is_kept: bool,
}

impl JointPolyline {
    /// Returns the faster of the motions with stops and with blends.
    pub(crate) fn fastest(&self, limits: &ConstantLimits, fractions: &[f64]) -> Result<Paced> {
        let stopping = self.stopping(limits)?;
        let Some(blended) = self.with_free_blends(limits, fractions).transpose()? else {
            return self.paced(stopping, limits);
        };
        let blended = self.paced(blended, limits)?;
        // Limits of tips and torques can only slow the other one down.
        if blended.motion.duration() < stopping.duration() {
            return Ok(blended);
        }
        let stopping = self.paced(stopping, limits)?;
        Ok(if blended.motion.duration() < stopping.motion.duration() { blended } else { stopping })
    }

    /// Returns the faster of the motions with stops and with blends, without regard to limits of tips and torques.
    pub(crate) fn fastest_of_joints(&self, limits: &ConstantLimits, fractions: &[f64]) -> Result<Trajectory> {
        let stopping = self.stopping(limits)?;
        let blended = self.with_free_blends(limits, fractions).transpose()?;
        Ok(blended.filter(|blended| blended.duration() < stopping.duration()).unwrap_or(stopping))
    }

    /// Moves from rest to rest along each line, stopping at every point: by a quintic, or as fast as jerk limits allow.
    pub(crate) fn with_stops(&self, limits: &ConstantLimits) -> Result<Paced> {
        self.paced(self.stopping(limits)?, limits)
    }

    /// [`with_stops`](Self::with_stops) without regard to tips and torques.
    fn stopping(&self, limits: &ConstantLimits) -> Result<Trajectory> {
        if limits.limit_jerk() { self.with_stops_and_jerk(limits) } else { self.with_quintics(limits) }
    }

    /// Returns `motion`, made for these lines, within the limits of tips and torques: slowed down as a whole or, if accelerations may jump, the fastest motion
    /// along the lines, which slows down where they bind. Neither is faster than `motion`, so that looser limits are never slower.
    fn paced(&self, motion: Trajectory, limits: &ConstantLimits) -> Result<Paced> {
        if limits.keep_whole(&motion) {
            return Ok(Paced { motion, is_kept: true });
        }
        let may_jump = !limits.limit_jerk() && limits.require_accelerations("lines").is_ok();
        // Along a single line no motion is faster than the fastest along it.
        let as_a_whole = if may_jump && self.0.len() == 2 { None } else { limits.slowed_if_held(&motion)? };
        let duration = as_a_whole.as_ref().map_or(f64::INFINITY, Trajectory::duration);
        let may_be_faster = may_jump && duration > self.least_with_stops(limits);
        let along = if may_be_faster { self.along(limits, motion.duration())? } else { None };
        let paced = along.filter(|along| along.duration() < duration).or(as_a_whole);
        let is_kept = paced.is_some();
        Ok(Paced { motion: paced.unwrap_or(motion), is_kept })
    }

    /// The fastest motion along the lines, which stops at each point, but none faster than `least` (s); `None` if a joint cannot hold the arm.
    fn along(&self, limits: &ConstantLimits, least: f64) -> Result<Option<Trajectory>> {
        let along = match time(&self.as_path(limits.joint_names()), limits, &TimingOptions::default()) {
            Err(Error::Infeasible { .. }) if limits.limit_torque() => return Ok(None),
            other => other?,
        };
        let ahead = least / along.duration();
        Ok(Some(if ahead > 1.0 { along.slowed(ahead)? } else { along }))
    }

    /// Lower bound (s) of the duration of any motion with stops at all points.
    fn least_with_stops(&self, limits: &ConstantLimits) -> f64 {
        self.0.windows(2).map(|line| line_profile(line, limits).duration).sum()
    }

    /// Moves from rest to rest along each line by a quintic.
    fn with_quintics(&self, limits: &ConstantLimits) -> Result<Trajectory> {
        let (mut knots, mut coefficients) = (vec![0.0], vec![]);
        let mut time = 0.0;
        for line in self.0.windows(2) {
            let displacement = |j: usize| line[1][j] - line[0][j];
            let h = CAUTION * limits.quintic_duration((0..limits.dof()).map(displacement));
            time += h;
            knots.push(time);
            coefficients.extend((0..limits.dof()).map(|j| quintic(line[0][j], displacement(j), h)));
        }
        Trajectory::from_phases(limits.joint_names(), knots, coefficients)
    }

    /// Moves from rest to rest along each line as fast as the limits up to jerk allow.
    fn with_stops_and_jerk(&self, limits: &ConstantLimits) -> Result<Trajectory> {
        let (mut knots, mut coefficients) = (vec![0.0], vec![]);
        for line in self.0.windows(2) {
            let begin = knots[knots.len() - 1];
            let fractions = line_profile(line, limits);
            let starts = fractions.segments.iter().skip(1).map(|segment| begin + segment.time);
            knots.extend(starts.chain([begin + fractions.duration]));
            for segment in &fractions.segments {
                let MotionState { q, v, a } = segment.state;
                let fraction = [q, v, 0.5 * a, segment.jerk / 6.0];
                coefficients.extend(line[0].iter().zip(&line[1]).map(|(from, to)| {
                    let [c0, c1, c2, c3] = fraction.map(|c| c * (to - from));
                    polynomial([from + c0, c1, c2, c3])
                }));
            }
        }
        let motion = Trajectory::from_phases(limits.joint_names(), knots, coefficients)?;
        within_limits(motion, limits)
    }

    /// Moves at constant velocity along the lines, with smooth blends at the points. `fractions[i]` in (0, 1] is the
    /// fraction of the shorter adjacent line that the blend of point i may take. `None` if a joint has no velocity
    /// limit.
    ///
    /// In a blend the velocity changes from that of one line to that of the next with an acceleration of shape 6 s (1 -
    /// s): continuous, never beyond either velocity, and inside the triangle that the lines span.
    pub(crate) fn with_blends(&self, limits: &ConstantLimits, fractions: &[f64]) -> Option<Result<Trajectory>> {
        let motion = self.with_free_blends(limits, fractions)?;
        Some(motion.and_then(|motion| limits.slowed_as_a_whole(motion)))
    }

    /// [`with_blends`](Self::with_blends) without regard to tips and torques.
    fn with_free_blends(&self, limits: &ConstantLimits, fractions: &[f64]) -> Option<Result<Trajectory>> {
        let times = self.blend_times(limits, fractions)?;
        let motion = self.blended(limits, &times);
        // A blend that is just too short exceeds a jerk limit by twice as much.
        let excess = if limits.limit_jerk() { 2.0 * TOO_SHORT } else { 0.0 };
        Some(if excess > 0.0 { motion.and_then(|motion| motion.slowed(1.0 + excess)) } else { motion })
    }

    /// The times of the motion with blends.
    pub(crate) fn blend_times(&self, limits: &ConstantLimits, fractions: &[f64]) -> Option<BlendTimes> {
        let mut lines: Vec<f64> = self.0.windows(2).map(|line| line_duration(line, limits)).collect();
        if lines.iter().any(|duration| !duration.is_finite() || *duration <= 0.0) {
            return None;
        }
        let mut blends = vec![0.0; self.0.len()];
        for _ in 0..ROUNDS {
            let mut settled = true;
            for (i, blend) in blends.iter_mut().enumerate() {
                let (before, after) = (i.checked_sub(1), (i < lines.len()).then_some(i));
                let beside = before.into_iter().chain(after);
                let room = fractions[i] * beside.clone().map(|line| lines[line]).fold(f64::INFINITY, f64::min);
                let needed = (0..limits.dof()).map(|j| {
                    let change = self.velocity(after, j, &lines) - self.velocity(before, j, &lines);
                    let by_acceleration = BLEND_ACCELERATION * change.abs() / limits.acceleration[j];
                    by_acceleration.max((BLEND_JERK * change.abs() / limits.jerk[j]).sqrt())
                });
                let needed = CAUTION * needed.fold(0.0, f64::max);
                // A blend from or to rest costs time, so it is no longer than the acceleration limits require.
                let at_end = before.is_none() || after.is_none();
                *blend = if at_end && needed > 0.0 { needed.min(room) } else { room };
                if needed > room * (1.0 + TOO_SHORT) {
                    // Half the speed takes a quarter of the acceleration and an eighth of the jerk.
                    let slower = (needed / room).sqrt().min(2.0) * CAUTION;
                    beside.for_each(|line| lines[line] *= slower);
                    settled = false;
                }
            }
            if settled {
                return Some(BlendTimes { lines, blends });
            }
        }
        None
    }

    /// Ends of the blend of inner point `i` if it takes this fraction of the shorter adjacent line.
    pub(crate) fn blend_ends(&self, limits: &ConstantLimits, i: usize, fraction: f64) -> [Vec<f64>; 2] {
        let lines = [[i, i - 1], [i, i + 1]].map(|[corner, other]| [&self.0[corner], &self.0[other]]);
        let durations = [line_duration(&self.0[i - 1..=i], limits), line_duration(&self.0[i..=i + 1], limits)];
        let blend = fraction * durations[0].min(durations[1]);
        std::array::from_fn(|side| {
            let ([corner, other], part) = (lines[side], 0.5 * blend / durations[side]);
            point_between(corner, other, part).collect()
        })
    }

    /// Velocity of joint `j` on a line; zero if there is none.
    fn velocity(&self, line: Option<usize>, j: usize, durations: &[f64]) -> f64 {
        line.map_or(0.0, |line| (self.0[line + 1][j] - self.0[line][j]) / durations[line])
    }

    fn blended(&self, limits: &ConstantLimits, BlendTimes { lines, blends }: &BlendTimes) -> Result<Trajectory> {
        let n = limits.dof();
        let (mut knots, mut coefficients) = (vec![0.0], vec![]);
        let mut time = 0.0;
        for (i, &blend) in blends.iter().enumerate() {
            let (before, after) = (i.checked_sub(1), (i < lines.len()).then_some(i));
            time += blend;
            knots.push(time);
            coefficients.extend((0..n).map(|j| {
                let (from, to) = (self.velocity(before, j, lines), self.velocity(after, j, lines));
                let change = to - from;
                let begin = self.0[i][j] - 0.5 * blend * from;
                polynomial([begin, from, 0.0, change / (blend * blend), -0.5 * change / blend.powi(3)])
            }));
            let Some(line) = after else { break };
            let rest = lines[line] - 0.5 * (blend + blends[i + 1]);
            if rest > 1e-9 * lines[line] {
                time += rest;
                knots.push(time);
                coefficients.extend((0..n).map(|j| {
                    let velocity = self.velocity(after, j, lines);
                    polynomial([self.0[i][j] + 0.5 * blend * velocity, velocity])
                }));
            }
        }
        Trajectory::from_phases(limits.joint_names(), knots, coefficients)
    }
}

/// The shortest time (s) for a line at constant velocity.
fn line_duration(line: &[Vec<f64>], limits: &ConstantLimits) -> f64 {
    let of_joint = |j: usize| {
        let size = (line[1][j] - line[0][j]).abs();
        if size == 0.0 { 0.0 } else { size / limits.velocity[j] }
    };
    let fastest = CAUTION * (0..limits.dof()).map(of_joint).fold(0.0, f64::max);
    if fastest > 0.0 {
        return fastest;
    }
    // Without velocity limits only the acceleration limits matter.
    0.5 * limits.quintic_duration((0..limits.dof()).map(|j| line[1][j] - line[0][j]))
}

/// The fastest motion from 0 to 1 along a line, as a fraction of it.
fn line_profile(line: &[Vec<f64>], limits: &ConstantLimits) -> JointProfile {
    let fraction = |all: &[f64]| {
        let of_joint = |j: usize| {
            let size = (line[1][j] - line[0][j]).abs();
            if size == 0.0 { f64::INFINITY } else { all[j] / size }
        };
        (0..limits.dof()).map(of_joint).fold(f64::INFINITY, f64::min) / CAUTION
    };
    let rates = Rates {
        velocity: fraction(&limits.velocity),
        acceleration: fraction(&limits.acceleration),
        jerk: fraction(&limits.jerk),
    };
    let transfer = Transfer::new(MotionState::rest(0.0), MotionState::rest(1.0), &rates);
    transfer.motion(transfer.duration(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::{Field, Limits, Profile};
    use crate::robot::Robot;

    fn limits(velocity: f64, acceleration: f64) -> ConstantLimits {
        let robot = Robot::planar(&[1.0, 1.0]).unwrap();
        let all = |value: f64| vec![Profile::Constant(value)];
        let limits = Limits::of(&robot).replace(Field::Velocity, all(velocity)).unwrap();
        let limits = limits.replace(Field::Acceleration, all(acceleration)).unwrap();
        ConstantLimits::for_robot(&robot, Some(&limits), "this test").unwrap()
    }

    impl ConstantLimits {
        fn with_jerk(mut self, jerk: f64) -> Self {
            self.jerk = vec![jerk; self.dof()];
            self
        }
    }

    fn corner() -> JointPolyline {
        JointPolyline(vec![vec![0.0, 0.0], vec![1.0, 0.2], vec![1.2, 1.4], vec![0.3, 1.0]])
    }

    /// Position, velocity and acceleration of both joints.
    fn state(motion: &Trajectory, t: f64) -> [[f64; 2]; 3] {
        let mut state = [[0.0; 2]; 3];
        let [q, qd, qdd] = &mut state;
        motion.at(t, q, qd, qdd).unwrap();
        state
    }

    /// One, two and five times powers of ten.
    fn round_numbers() -> impl Iterator<Item = f64> + Clone {
        (-3..=3).flat_map(|power| [1.0, 2.0, 5.0].map(|digit| digit * 10.0_f64.powi(power)))
    }

    #[test]
    fn round_limits_that_tie_are_kept_and_reached() {
        for velocity in round_numbers() {
            for acceleration in round_numbers() {
                for tie in [1.0, 0.5, 2.0] {
                    let jerk = tie * acceleration * acceleration / velocity;
                    let limits = limits(velocity, acceleration).with_jerk(jerk);
                    let motion = corner().with_stops(&limits).unwrap().motion;
                    let reached = [motion.max_velocity(), motion.max_acceleration(), motion.max_jerk()];
                    let parts = reached.map(|reached| reached.into_iter().fold(0.0, f64::max));
                    for (part, limit) in parts.iter().zip([velocity, acceleration, jerk]) {
                        assert!(*part <= limit * (1.0 + 1e-8), "{part} of {limit}: {velocity}, {acceleration}, {jerk}");
                    }
                    assert!(parts[2] > 0.999 * jerk, "{}: {velocity}, {acceleration}, {jerk}", parts[2]);
                }
            }
        }
    }

    #[test]
    fn one_line_takes_the_time_of_its_tightest_limit() {
        let line = JointPolyline(vec![vec![0.0, 0.0], vec![0.5, -1.0]]);
        // By speed: 15/8 of the mean speed; by acceleration: 10 / sqrt(3) of displacement / duration^2.
        for (velocity, acceleration, expected) in [(0.5, 1e3, 3.75), (1e3, 2.0, (10.0 / 3.0_f64.sqrt() / 2.0).sqrt())] {
            let limits = limits(velocity, acceleration);
            let motion = line.with_stops(&limits).unwrap().motion;
            assert!((motion.duration() - expected).abs() < 1e-9, "{}", motion.duration());
            assert_eq!(limits.violations(&motion), []);
            let reach = limits.quintic_reach(1, motion.duration());
            assert!((reach - 1.0).abs() < 1e-9, "{reach}");
        }
    }

    #[test]
    fn motions_keep_the_limits_and_one_of_them_is_reached() {
        for (velocity, acceleration) in [(1.0, 4.0), (1.0, 0.5), (3.0, 1.0)] {
            let limits = limits(velocity, acceleration);
            let stopping = corner().with_stops(&limits).unwrap().motion;
            let blended = corner().with_blends(&limits, &[1.0; 4]).unwrap().unwrap();
            for motion in [&stopping, &blended] {
                assert_eq!(limits.violations(motion), []);
                let fastest = motion.max_velocity().into_iter().fold(0.0, f64::max) / velocity;
                let hardest = motion.max_acceleration().into_iter().fold(0.0, f64::max) / acceleration;
                assert!(fastest.max(hardest) > 0.99, "{fastest} and {hardest}");
            }
            assert!(blended.duration() < stopping.duration());
        }
    }

    #[test]
    fn blends_are_smooth_and_begin_and_end_at_rest() {
        let motion = corner().with_blends(&limits(1.0, 2.0), &[1.0, 0.5, 1.0, 1.0]).unwrap().unwrap();
        for &t in motion.knots() {
            let [before, after] = [state(&motion, t - 1e-9), state(&motion, t + 1e-9)];
            for (before, after) in before.iter().flatten().zip(after.iter().flatten()) {
                assert!((before - after).abs() < 1e-6, "{before} and {after} at {t}");
            }
        }
        for t in [0.0, motion.duration()] {
            assert!(state(&motion, t)[1..].iter().flatten().all(|x| x.abs() < 1e-9));
        }
    }

    #[test]
    fn a_smaller_fraction_keeps_a_blend_nearer_to_its_corner() {
        let miss = |fraction: f64| {
            let motion = corner().with_blends(&limits(1.0, 50.0), &[1.0, fraction, 1.0, 1.0]).unwrap().unwrap();
            let away = |i: usize| {
                let [q, ..] = state(&motion, motion.duration() * i as f64 / 2000.0);
                (q[0] - 1.0).hypot(q[1] - 0.2)
            };
            (0..=2000).map(away).fold(f64::INFINITY, f64::min)
        };
        assert!(miss(0.1) < 0.5 * miss(1.0), "{} and {}", miss(0.1), miss(1.0));
    }
}
