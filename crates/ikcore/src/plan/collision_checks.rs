//! Shared by planners with obstacles: the robot's shape, collision errors, and trajectories as certifiable motions.

use std::ops::RangeInclusive;
use std::sync::Arc;

use super::planar_arm::PlanarArm;
use crate::error::{Error, Result};
use crate::math::polynomial::evaluate;
use crate::message::{Message, message};
use crate::obstacle::{ClearSpace, Clearance, ClearanceSweep, Contact, JointMotion, Surroundings, TooNear};
use crate::robot::Robot;
use crate::timing::Violation;
use crate::trajectory::{Coefficients, POWERS, Trajectory};

/// Distance added to the margin at end configurations (m), so that motions to them can be certified.
pub(crate) const END_RESERVE: f64 = 2e-6;

/// Name of a given configuration at the start in errors.
const START: &str = "start_q";

/// The space that `surroundings` leave to a motion of `robot` from point to point; `None` if nothing can collide: without obstacles,
/// by default, an arm without bodies cannot.
///
/// A planar arm without bodies gets a line for every link, as in Wang et al. (2019), unless links must not touch each other. Lines may
/// cross each other: they have no thickness.
///
/// # Errors
/// Those of [`Surroundings::clear_space`].
pub(crate) fn motion_space<'a>(surroundings: &Surroundings, robot: &'a Robot) -> Result<Option<ClearSpace<'a>>> {
    let [no_bodies, all_read] = [robot.capsules().is_empty(), robot.unread_collision_shapes().is_empty()];
    let self_collision = surroundings.self_collision;
    if surroundings.obstacles().is_empty() && !self_collision.unwrap_or(!no_bodies && all_read) {
        return Ok(None);
    }
    let obstacles = Some(surroundings.obstacles.clone().unwrap_or_default());
    let among = |self_collision| Surroundings { obstacles, margin: surroundings.margin, self_collision };
    if no_bodies && all_read && self_collision != Some(true) && PlanarArm::of(robot).is_some() {
        return among(Some(false)).clear_space(&Arc::new(robot.with_capsules_along_links(0.0)?));
    }
    among(self_collision).clear_space(robot)
}

/// Checks that a configuration keeps the margin; `what` names it in the error.
///
/// # Errors
/// [`Error::InCollision`].
pub(crate) fn refuse_collision(what: &str, space: &ClearSpace<'_>, q: &[f64]) -> Result<()> {
    let (scene, kept) = (space.scene(), space.margin() + END_RESERVE);
    match scene.nearest(q)? {
        Some(contact) if contact.distance < kept => {
            let (other, depth) = (contact.other.to_string(), contact.depth(kept));
            // The robot is at the start, perhaps not at an end.
            let remedy = match contact.measured().filter(|_| what == START) {
                Some(measured) => message!["; ", measured.advice()],
                None if scene.contact_at_rest(q, kept).as_ref() == Some(&contact) => message!["; ", contact.remedy()],
                None => Message::default(),
            };
            Err(Error::InCollision { what: what.into(), link: contact.link, other, depth, remedy })
        }
        _ => Ok(()),
    }
}

/// Certifies that everything stays `margin` (m) apart on a motion, between samples too.
///
/// # Errors
/// [`TooNear`]: the first place that is nearer.
pub(crate) fn certify(sweep: &mut ClearanceSweep<'_>, motion: &Trajectory, margin: f64) -> Result<(), Box<TooNear>> {
    sweep.check(&TimedMotion::new(motion), [0.0, motion.duration()], margin)
}

/// The smallest clearance on a motion, and the contact there; `None` if nothing can touch. `certified` is a distance (m) that it is
/// known to keep: that may be more than the search for the smallest one proves.
///
/// # Errors
/// None in practice: the joints are those of the robot.
pub(crate) fn least_clearance(
    sweep: &mut ClearanceSweep<'_>,
    motion: &Trajectory,
    certified: Option<f64>,
) -> Result<Option<(Clearance, Contact)>> {
    let least = sweep.smallest(&TimedMotion::new(motion), [0.0, motion.duration()]);
    let Some(TooNear { at, contact }) = least else { return Ok(None) };
    let nearest = sweep.scene().nearest_contact(&configuration_at(motion, at)?)?;
    let distance = certified.map_or(contact.distance, |certified| contact.distance.max(certified));
    Ok(Some((Clearance { distance, nearest }, contact)))
}

/// The configuration of a motion at the time `t` (s).
///
/// # Errors
/// [`Error::NotFinite`] for a time that is not finite.
pub(crate) fn configuration_at(motion: &Trajectory, t: f64) -> Result<Vec<f64>> {
    let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; motion.joints().len()]);
    motion.at(t, &mut q, &mut qd, &mut qdd)?;
    Ok(q)
}

/// Returns the violation for a distance below the margin.
pub(crate) fn too_near(contact: &Contact, margin: f64) -> Violation {
    let what = format!("distance of link '{}' from {}", contact.link, contact.other);
    Violation { what, value: contact.distance, bound: margin, unit: "m".into() }
}

/// A trajectory as a motion that can be certified; its parameter is time (s).
#[derive(Debug, Clone, Copy)]
pub(crate) struct TimedMotion<'a> {
    trajectory: &'a Trajectory,
    /// Whether no velocity jumps.
    smooth: bool,
}

/// A velocity that jumps by less (rad/s, m/s) does so by rounding.
const JUMP: f64 = 1e-9;

impl<'a> TimedMotion<'a> {
    /// The motion along `trajectory`.
    pub fn new(trajectory: &'a Trajectory) -> Self {
        let (knots, polynomials, n) = (trajectory.knots(), trajectory.coefficients(), trajectory.joints().len());
        let jumps = |i: usize| {
            let (before, after) = (&polynomials[i], &polynomials[i + n]);
            let (piece, last) = (i / n, evaluate(before, knots[i / n + 1] - knots[i / n])[1]);
            piece + 2 < knots.len() && (last - after[1]).abs() > JUMP * (1.0 + last.abs())
        };
        let inner = polynomials.len() - n;
        Self { trajectory, smooth: !(0..inner).any(jumps) }
    }

    /// The piece in which a time is; the later one at a knot.
    fn piece_of(&self, t: f64) -> usize {
        let knots = self.trajectory.knots();
        knots.partition_point(|knot| *knot <= t).saturating_sub(1).min(knots.len() - 2)
    }

    /// The pieces of an interval.
    fn pieces(&self, from: f64, to: f64) -> RangeInclusive<usize> {
        let (first, last) = (self.piece_of(from), self.piece_of(to));
        // One that begins where the interval ends does not count.
        first..=if last > first && self.trajectory.knots()[last] >= to { last - 1 } else { last }
    }
}

impl JointMotion for TimedMotion<'_> {
    fn write(&self, at: f64, q: &mut [f64]) {
        let (piece, n) = (self.piece_of(at), q.len());
        let (s, polynomials) = (at - self.trajectory.knots()[piece], self.trajectory.coefficients());
        for (q, polynomial) in q.iter_mut().zip(&polynomials[piece * n..]) {
            *q = value(polynomial, s);
        }
    }

    fn write_off_line(&self, from: f64, to: f64, off_line: &mut [f64]) {
        let (knots, polynomials, n) = (self.trajectory.knots(), self.trajectory.coefficients(), off_line.len());
        let pieces = self.pieces(from, to);
        if !self.smooth && pieces.end() > pieces.start() {
            // Divided at its knots, it is smooth.
            return off_line.fill(f64::INFINITY);
        }
        let fraction = (to - from).powi(2) / 8.0;
        for piece in pieces {
            let (begin, end) = (knots[piece].max(from), knots[piece + 1].min(to));
            let (middle, half) = (0.5 * (begin + end) - knots[piece], 0.5 * (end - begin).max(0.0));
            for (off_line, polynomial) in off_line.iter_mut().zip(&polynomials[piece * n..]) {
                *off_line = off_line.max(fraction * largest_acceleration(polynomial, middle, half));
            }
        }
    }

    fn middle(&self, from: f64, to: f64) -> Option<f64> {
        let (knots, pieces) = (self.trajectory.knots(), self.pieces(from, to));
        let middle = 0.5 * (from + to);
        let distance = |knot: &f64| (knot - middle).abs();
        let inner = knots[pieces.start() + 1..=*pieces.end()].iter().copied();
        let nearest = inner.min_by(|one, other| distance(one).total_cmp(&distance(other)));
        Some(nearest.unwrap_or(middle)).filter(|middle| from < *middle && *middle < to)
    }
}

/// The value of a polynomial at `s`.
fn value(polynomial: &Coefficients, s: f64) -> f64 {
    polynomial.iter().rev().fold(0.0, |sum, c| sum * s + c)
}

/// A bound on the second derivative of a polynomial within `half` of `middle`.
fn largest_acceleration(polynomial: &Coefficients, middle: f64, half: f64) -> f64 {
    if polynomial[2..].iter().all(|c| *c == 0.0) {
        return 0.0;
    }
    // Taylor's series about the middle ends, so that its terms bound it.
    let local = shifted(polynomial, middle);
    (2..POWERS).rev().fold(0.0, |sum, power| sum * half + (power * (power - 1)) as f64 * local[power].abs())
}

/// The same polynomial in powers of s - `by`, by repeated synthetic division.
fn shifted(coefficients: &Coefficients, by: f64) -> Coefficients {
    let mut c = *coefficients;
    for low in 0..POWERS - 1 {
        for power in (low..POWERS - 1).rev() {
            c[power] += by * c[power + 1];
        }
    }
    c
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vector::between;
    use crate::rng;
    use crate::shape::Shape;
    use crate::trajectory::polynomial;

    /// Two polynomials that meet at 0.8 s, with a velocity jump there or without.
    fn motion(jump: f64) -> Trajectory {
        let mut rng = rng::stream(1, 0);
        let mut draw = || polynomial([(); 5].map(|()| rng.uniform_in(-1.0, 1.0)));
        let (first, second) = (draw(), draw());
        let [q, qd, _] = evaluate(&first, 0.8);
        let second =
            Coefficients::from(std::array::from_fn(|k| [q, qd + jump, second[2], second[3], second[4], 0.0, 0.0][k]));
        Trajectory::new(vec!["a".into()], vec![0.0, 0.8, 2.0], vec![first, second]).unwrap()
    }

    #[test]
    fn no_joint_gets_farther_off_the_line_than_the_bound() {
        let motion = motion(0.0);
        let timed = TimedMotion::new(&motion);
        for (from, to) in [(0.0, 2.0), (0.1, 0.5), (0.7, 0.9), (1.2, 1.3), (0.4, 0.8), (0.8, 1.1)] {
            let (mut ends, mut off_line) = ([[0.0]; 2], [0.0]);
            timed.write(from, &mut ends[0]);
            timed.write(to, &mut ends[1]);
            timed.write_off_line(from, to, &mut off_line);
            let mut largest: f64 = 0.0;
            for i in 1..500 {
                let fraction = f64::from(i) / 500.0;
                let mut q = [0.0];
                timed.write(between(from, to, fraction), &mut q);
                let off = (q[0] - ends[0][0] - fraction * (ends[1][0] - ends[0][0])).abs();
                assert!(
                    off <= 4.0 * fraction * (1.0 - fraction) * off_line[0] + 1e-12,
                    "[{from}, {to}] at {fraction}: {off}"
                );
                largest = largest.max(off);
            }
            assert!(to - from > 0.25 || off_line[0] <= 2.0 * largest + 1e-12, "[{from}, {to}]: {off_line:?} is loose");
        }
    }

    #[test]
    fn a_motion_with_a_jump_is_divided_there() {
        let motion = motion(0.5);
        let timed = TimedMotion::new(&motion);
        let off_line = |from: f64, to: f64| {
            let mut off_line = [0.0];
            timed.write_off_line(from, to, &mut off_line);
            off_line[0]
        };
        assert_eq!(off_line(0.7, 0.9), f64::INFINITY);
        assert!(off_line(0.7, 0.8).is_finite() && off_line(0.8, 0.9).is_finite());
        assert_eq!(
            (timed.middle(0.0, 2.0), timed.middle(0.8, 1.0), timed.middle(0.8, 0.8)),
            (Some(0.8), Some(0.9), None)
        );
    }

    #[test]
    fn an_arm_without_obstacles_collides_only_with_a_known_shape() {
        let bare = Robot::planar(&[1.0, 1.0]).unwrap();
        let thick = bare.with_capsules_along_links(0.1).unwrap();
        let ball = Shape::sphere([3.0, 0.0, 0.0], 0.1).unwrap();
        let with = |obstacles: &[&Shape], self_collision| Surroundings {
            obstacles: Some(obstacles.iter().map(|shape| (*shape).clone()).collect()),
            self_collision,
            ..Surroundings::default()
        };
        let (empty, obstructed) = (with(&[], None), with(&[&ball], None));
        let space = |surroundings: &Surroundings, robot| motion_space(surroundings, robot).map(|space| space.is_some());
        assert!(!space(&empty, &bare).unwrap() && space(&obstructed, &bare).unwrap() && space(&empty, &thick).unwrap());
        assert!(space(&with(&[], Some(true)), &bare).is_err() && !space(&with(&[], Some(false)), &thick).unwrap());
        assert!(space(&with(&[&ball], Some(false)), &thick).unwrap());
        assert!(motion_space(&obstructed, &bare).unwrap().unwrap().robot().capsules().len() == 2);
        assert!(space(&obstructed, &Robot::named("panda").unwrap()).is_err());
    }
}
