//! Piecewise polynomials, one per segment and joint.

use serde::{Deserialize, Serialize};

use super::coefficients::{Coefficients, POWERS, nth_derivative, shifted};
use super::hermite_segment;
use crate::error::{Error, Result, require_finite, require_positive};
use crate::interrupt::checkpoint_at;
use crate::math::Knots;
use crate::math::polynomial::{bound, evaluate, largest_magnitude, range, value};
use crate::math::ticks::ticks;

/// Largest jump of a joint at a knot (rad or m, relative beyond 1); stored or computed coefficients meet only up to
/// rounding.
const CONTINUITY_TOLERANCE: f64 = 1e-6;

/// Rounding error of a polynomial, relative to the sum of its terms.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Shortest segment, relative to the duration: times in double precision do not resolve a shorter one.
const SHORTEST: f64 = 16.0 * f64::EPSILON;

/// The motion of all joints in time: piecewise polynomials between common knots, continuous in position.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "(Vec<String>, Knots, Vec<Coefficients>)")]
pub struct Trajectory {
    joints: Vec<String>,
    knots: Knots,
    /// Polynomials by segment, then by joint.
    coefficients: Vec<Coefficients>,
}

/// Checks stored trajectories again.
impl TryFrom<(Vec<String>, Knots, Vec<Coefficients>)> for Trajectory {
    type Error = Error;

    fn try_from((joints, knots, coefficients): (Vec<String>, Knots, Vec<Coefficients>)) -> Result<Self> {
        Self::new(joints, knots.times().to_vec(), coefficients)
    }
}

impl Trajectory {
    /// Name of a motion in messages.
    pub(crate) const WHAT: &str = "trajectory";

    /// The motion of these `joints` (names) with these `coefficients`, by segment and then by joint, between `knots`
    /// (s) that start at zero and increase.
    ///
    /// # Errors
    /// [`Error::InvalidTrajectory`] without joints or if a joint jumps at a knot, [`Error::WrongLength`],
    /// [`Error::NotFinite`], [`Error::OutOfRange`] if the first knot is not zero, [`Error::NotIncreasing`].
    pub fn new(joints: Vec<String>, knots: Vec<f64>, coefficients: Vec<Coefficients>) -> Result<Self> {
        if joints.is_empty() {
            return Err(Error::InvalidTrajectory { problem: "it needs at least 1 joint".into() });
        }
        let knots = Knots::new(&format!("{} times", Self::WHAT), knots)?;
        let (n, segments) = (joints.len(), knots.segments());
        if coefficients.len() != segments * n {
            let what = "trajectory coefficients".into();
            let expected = format!("{} polynomials ({segments} segments of {n} joints)", segments * n);
            return Err(Error::WrongLength { what, expected, got: coefficients.len() });
        }
        require_finite("trajectory coefficients", coefficients.as_flattened(), |i| {
            let (segment, joint, power) = (i / POWERS / n, i / POWERS % n, i % POWERS);
            format!("power {power} of joint '{}' in segment {segment}", joints[joint])
        })?;
        let trajectory = Self { joints, knots, coefficients };
        trajectory.check_continuity()?;
        Ok(trajectory)
    }

    /// The motion of phases, of which some may last no time: as [`new`](Self::new), with knots that need not increase.
    ///
    /// A joint that reaches two limits at once has a phase of no length between them, and round limits often coincide. So
    /// phases that the times cannot resolve are left out here, for all computed motions.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub(crate) fn from_phases(joints: Vec<String>, knots: Vec<f64>, coefficients: Vec<Coefficients>) -> Result<Self> {
        let duration = knots.last().copied().unwrap_or(0.0);
        let shortest = SHORTEST * duration;
        if knots.windows(2).all(|ends| ends[1] - ends[0] > shortest) {
            return Self::new(joints, knots, coefficients);
        }
        let (mut kept_knots, mut kept) = (vec![0.0], Vec::with_capacity(coefficients.len()));
        for (ends, phase) in knots.windows(2).zip(coefficients.chunks(joints.len().max(1))) {
            let begin = kept_knots[kept_knots.len() - 1];
            if ends[1] - begin > shortest {
                kept_knots.push(ends[1]);
                kept.extend(phase.iter().map(|polynomial| shifted(*polynomial, begin - ends[0])));
            }
        }
        if let [_, .., last] = &mut kept_knots[..] {
            *last = duration;
        }
        Self::new(joints, kept_knots, kept)
    }

    /// The motion through `q` (rad or m, one row of all joints per time) at `times` (s) that start at zero and
    /// increase. It is piecewise linear, so the velocity jumps at the samples; with velocities `qd` it is cubic, with
    /// accelerations `qdd` too it is quintic, and meets them at the samples.
    ///
    /// # Errors
    /// As [`new`](Self::new); [`Error::InvalidTrajectory`] for accelerations without velocities.
    pub fn from_samples(
        joints: Vec<String>,
        times: &[f64],
        q: &[f64],
        qd: Option<&[f64]>,
        qdd: Option<&[f64]>,
    ) -> Result<Self> {
        let n = joints.len();
        if qdd.is_some() && qd.is_none() {
            return Err(Error::InvalidTrajectory { problem: "accelerations need velocities too".into() });
        }
        let given = [(Some(q), "trajectory samples"), (qd, "velocity samples"), (qdd, "acceleration samples")];
        for (samples, what) in given.into_iter().filter_map(|(samples, what)| Some((samples?, what))) {
            if samples.len() != times.len() * n {
                let expected = format!("{} numbers ({} times of {n} joints)", times.len() * n, times.len());
                return Err(Error::WrongLength { what: what.into(), expected, got: samples.len() });
            }
            require_finite(what, samples, |i| format!("joint '{}' of row {}", joints[i % n], i / n))?;
        }
        let mut coefficients = Vec::with_capacity(q.len());
        for (row, ends) in times.windows(2).enumerate() {
            checkpoint_at(row)?;
            let h = ends[1] - ends[0];
            for i in row * n..(row + 1) * n {
                let pair = |samples: &[f64]| [samples[i], samples[i + n]];
                coefficients.push(match (qd, qdd) {
                    (None, _) => hermite_segment::line(h, pair(q)),
                    (Some(qd), None) => hermite_segment::cubic(h, pair(q), pair(qd)),
                    (Some(qd), Some(qdd)) => hermite_segment::quintic(h, pair(q), pair(qd), pair(qdd)),
                });
            }
        }
        Self::new(joints, times.to_vec(), coefficients)
    }

    /// Names of the joints, in the order of q.
    pub fn joints(&self) -> &[String] {
        &self.joints
    }

    /// Times at which the segments begin, and the end of the last one (s).
    pub fn knots(&self) -> &[f64] {
        self.knots.times()
    }

    /// The polynomials, by segment and then by joint.
    pub fn coefficients(&self) -> &[Coefficients] {
        &self.coefficients
    }

    /// The largest power of time with a nonzero coefficient.
    pub fn degree(&self) -> usize {
        let used = |coefficients: &Coefficients| coefficients.iter().rposition(|c| *c != 0.0).unwrap_or(0);
        self.coefficients.iter().map(used).max().unwrap_or(0)
    }

    /// Duration of the motion (s).
    pub fn duration(&self) -> f64 {
        self.knots.duration()
    }

    /// Writes position, velocity and acceleration of all joints (rad or m, and per s and s^2) at time `t` (s, clamped
    /// to `[0, duration]`). At a knot they are those of the next segment.
    ///
    /// # Errors
    /// [`Error::WrongLength`] for a slice whose length is not the number of joints.
    pub fn at(&self, t: f64, q: &mut [f64], qd: &mut [f64], qdd: &mut [f64]) -> Result<()> {
        let n = self.joints.len();
        if let Some(got) = [q.len(), qd.len(), qdd.len()].into_iter().find(|&length| length != n) {
            let what = "state of the trajectory".into();
            return Err(Error::WrongLength { what, expected: format!("{n} joints"), got });
        }
        let (segment, elapsed) = self.knots.locate(t);
        for (joint, coefficients) in self.segment(segment).iter().enumerate() {
            [q[joint], qd[joint], qdd[joint]] = evaluate(coefficients, elapsed);
        }
        Ok(())
    }

    /// Writes the accelerations of all joints (rad/s^2 or m/s^2) at both ends of a segment.
    pub(crate) fn end_accelerations(&self, segment: usize, start: &mut [f64], end: &mut [f64]) {
        for (joint, polynomial) in self.segment(segment).iter().enumerate() {
            start[joint] = 2.0 * polynomial[2];
            end[joint] = evaluate(polynomial, self.knots.span(segment))[2];
        }
    }

    /// The exact largest speed of each joint (rad/s or m/s).
    pub fn max_velocity(&self) -> Vec<f64> {
        self.largest(1)
    }

    /// The exact largest acceleration of each joint within the segments (rad/s^2 or m/s^2). Jumps of the velocity at
    /// knots are not included.
    pub fn max_acceleration(&self) -> Vec<f64> {
        self.largest(2)
    }

    /// The exact largest jerk of each joint within the segments (rad/s^3 or m/s^3). Jumps of the acceleration at knots
    /// are not included.
    pub fn max_jerk(&self) -> Vec<f64> {
        self.largest(3)
    }

    /// The same motion, slower by `factor`.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] unless `factor` is positive and finite.
    pub fn slowed(&self, factor: f64) -> Result<Self> {
        require_positive("factor", factor)?;
        let knots = self.knots().iter().map(|time| time * factor).collect();
        let slow = |given: &Coefficients| {
            let (mut scale, mut slowed) = (1.0, *given);
            for c in &mut slowed {
                *c *= scale;
                scale /= factor;
            }
            slowed
        };
        Self::from_phases(self.joints.clone(), knots, self.coefficients.iter().map(slow).collect())
    }

    /// The configuration at the start (n,) (rad or m).
    pub(crate) fn start(&self) -> Vec<f64> {
        self.segment(0).iter().map(|polynomial| polynomial[0]).collect()
    }

    /// The configuration at the end (n,) (rad or m).
    pub(crate) fn end(&self) -> Vec<f64> {
        let last = self.knots.segments() - 1;
        self.segment(last).iter().map(|polynomial| value(polynomial, self.knots.span(last))).collect()
    }

    /// The exact lowest and highest position of each joint (rad or m).
    pub fn position_range(&self) -> Vec<(f64, f64)> {
        let mut ranges = vec![(f64::INFINITY, f64::NEG_INFINITY); self.joints.len()];
        for segment in 0..self.knots.segments() {
            for ((lowest, highest), position) in ranges.iter_mut().zip(self.segment(segment)) {
                let span = self.knots.span(segment);
                let moved = span * bound(&position[1..], span);
                if position[0] - moved < *lowest || position[0] + moved > *highest {
                    let (low, high) = range(position, 0.0, span);
                    (*lowest, *highest) = (lowest.min(low), highest.max(high));
                }
            }
        }
        ranges
    }

    /// The times i `dt` (s) from 0 on, followed by the duration.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for `dt` not positive, or so small that more than 10 million ticks would result.
    pub fn sample_times(&self, dt: f64) -> Result<Vec<f64>> {
        let steps = ticks(self.duration(), dt)?;
        Ok((0..steps).map(|i| i as f64 * dt).chain([self.duration()]).collect())
    }

    /// The polynomials of one segment, joint by joint.
    fn segment(&self, segment: usize) -> &[Coefficients] {
        let n = self.joints.len();
        &self.coefficients[segment * n..(segment + 1) * n]
    }

    /// Returns for each joint the largest magnitude over all segments of the derivative of this order of its position.
    fn largest(&self, order: usize) -> Vec<f64> {
        let mut largest = vec![0.0_f64; self.joints.len()];
        for segment in 0..self.knots.segments() {
            if checkpoint_at(segment).is_err() {
                break; // the interrupted caller discards the result
            }
            for (largest, position) in largest.iter_mut().zip(self.segment(segment)) {
                let (of_order, span) = (nth_derivative(*position, order), self.knots.span(segment));
                let values = &of_order[..POWERS - order];
                if bound(values, span) > *largest {
                    *largest = largest.max(largest_magnitude(values, 0.0, span));
                }
            }
        }
        largest
    }

    /// Checks that every segment starts where the previous one ends.
    fn check_continuity(&self) -> Result<()> {
        for next in 1..self.knots.segments() {
            checkpoint_at(next)?;
            let span = self.knots.span(next - 1);
            let polynomials = self.segment(next - 1).iter().zip(self.segment(next));
            for (name, (before, after)) in self.joints.iter().zip(polynomials) {
                let (left, right) = (value(before, span), after[0]);
                let jump = (left - right).abs();
                let meets = jump <= CONTINUITY_TOLERANCE * right.abs().max(1.0)
                    || jump <= ROUNDING * value(&before.map(f64::abs), span);
                if !meets {
                    let time = self.knots.times()[next];
                    let problem = format!("joint '{name}' jumps from {left} to {right} at t = {time} s");
                    return Err(Error::InvalidTrajectory { problem });
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trajectory::polynomial;

    /// A motion at 1 rad/s with these knots.
    fn steady(knots: &[f64]) -> Result<Trajectory> {
        let coefficients = knots[1..].iter().zip(knots).map(|(_, start)| polynomial([*start, 1.0])).collect();
        Trajectory::from_phases(vec!["a".into()], knots.to_vec(), coefficients)
    }

    #[test]
    fn phases_of_no_length_are_left_out_wherever_they_are() {
        let tiny = f64::EPSILON;
        for (knots, kept) in [
            (vec![0.0, 0.0, 1.0], vec![0.0, 1.0]),
            (vec![0.0, tiny, 1.0], vec![0.0, 1.0]),
            (vec![0.0, 1.0, 1.0], vec![0.0, 1.0]),
            (vec![0.0, 0.5, 0.5, 0.5 + tiny, 0.5, 1.0, 1.0 - tiny, 1.0], vec![0.0, 0.5, 1.0]),
            (vec![0.0, 0.5, 1.0], vec![0.0, 0.5, 1.0]),
        ] {
            let motion = steady(&knots).unwrap();
            assert_eq!(motion.knots(), kept, "{knots:?}");
            let range = motion.position_range()[0];
            assert!(range.0 == 0.0 && (range.1 - 1.0).abs() < 1e-15, "{range:?}");
        }
    }

    #[test]
    fn many_tiny_phases_are_not_left_out_together() {
        let knots: Vec<f64> = (0..=1000).map(|i| f64::from(i) * f64::EPSILON).chain([1.0]).collect();
        let motion = steady(&knots).unwrap();
        assert!(motion.knots().len() > 50, "{}", motion.knots().len());
        let jump = |i: usize| (motion.coefficients()[i][0] - motion.knots()[i]).abs();
        assert!((0..motion.knots().len() - 1).all(|i| jump(i) < 1e-14));
    }

    #[test]
    fn a_motion_of_no_duration_is_an_error() {
        assert_eq!(steady(&[0.0, 0.0]).unwrap_err().to_string(), "trajectory times: expected at least 2, got 1");
    }
}
