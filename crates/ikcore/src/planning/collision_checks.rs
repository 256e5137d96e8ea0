//! Shared by planners with obstacles: the robot's shape, collision errors, and trajectories as certifiable motions.

use super::planar_arm::PlanarArm;
use super::planner_options::PointToPointOptions;
use super::violation::Violation;
use crate::error::{Error, Result};
use crate::math::polynomial::evaluate;
use crate::obstacle::{Contact, JointMotion, NearestContact, Scene};
use crate::robot::Robot;
use crate::trajectory::{Coefficients, POWERS, Trajectory};

/// Distance added to the margin at end configurations and on straight lines (m), so that their timed motion can be
/// certified too.
pub(super) const RESERVE: f64 = 5e-5;

/// Whether `robot` can collide: with an obstacle, or with itself where that is asked for, or by default if its shape is
/// known.
pub(super) fn can_collide(robot: &Robot, options: &PointToPointOptions) -> bool {
    let shape_known = !robot.capsules().is_empty() && robot.unread_collision_shapes().is_empty();
    !options.obstacles.is_empty() || options.self_collision.unwrap_or(shape_known)
}

/// `robot` with a line for every link if it is a planar arm without a shape, as in Wang et al. (2019); `None` for any
/// other robot, or if links must not touch each other.
///
/// # Errors
/// As [`Robot::with_capsules_along_links`].
pub(super) fn as_lines(robot: &Robot, options: &PointToPointOptions) -> Result<Option<Robot>> {
    let no_shape = robot.capsules().is_empty() && robot.unread_collision_shapes().is_empty();
    let may_cross = options.self_collision != Some(true);
    let is_planar = || PlanarArm::of(robot).is_some();
    if no_shape && may_cross && is_planar() { robot.with_capsules_along_links(0.0).map(Some) } else { Ok(None) }
}

/// The scene of `robot`, or of its `lines` if it has no shape, among the obstacles. Lines may cross each other: they have
/// no thickness.
///
/// # Errors
/// As [`Scene::new`].
pub(super) fn scene<'a>(
    robot: &'a Robot,
    lines: Option<&'a Robot>,
    options: &'a PointToPointOptions,
) -> Result<Scene<'a>> {
    let scene = Scene::new(lines.unwrap_or(robot), &options.obstacles)?;
    let may_cross = lines.is_some() || options.self_collision == Some(false);
    Ok(if may_cross { scene.without_self_collision() } else { scene })
}

/// Checks that a configuration keeps the margin; `what` names it in the error.
///
/// # Errors
/// [`Error::InCollision`].
pub(super) fn refuse_collision(what: &str, scene: &Scene, q: &[f64], margin: f64) -> Result<()> {
    let kept = margin + RESERVE;
    match scene.nearest(q)? {
        Some(contact) if contact.distance < kept => {
            let (other, depth) = (contact.other.to_string(), contact.depth(kept));
            let remedy = if scene.contact_at_rest(q, kept).as_ref() == Some(&contact) {
                format!("; {}", contact.remedy())
            } else {
                String::new()
            };
            Err(Error::InCollision { what: what.into(), link: contact.link, other, depth, remedy })
        }
        _ => Ok(()),
    }
}

/// The nearest two bodies on a motion at the time `at` (s).
///
/// # Errors
/// None in practice: the joints are those of the robot.
pub(super) fn nearest_at(scene: &Scene, motion: &Trajectory, at: f64) -> Result<Option<NearestContact>> {
    scene.nearest_contact(&configuration_at(motion, at)?)
}

/// The configuration of a motion at the time `t` (s).
///
/// # Errors
/// [`Error::NotFinite`] for a time that is not finite.
pub(super) fn configuration_at(motion: &Trajectory, t: f64) -> Result<Vec<f64>> {
    let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; motion.joints().len()]);
    motion.at(t, &mut q, &mut qd, &mut qdd)?;
    Ok(q)
}

/// Returns the violation for a distance below the margin.
pub(super) fn too_near(contact: &Contact, margin: f64) -> Violation {
    let what = format!("distance of link '{}' from {}", contact.link, contact.other);
    Violation { what, value: contact.distance, bound: margin, unit: "m".into() }
}

/// A trajectory as a motion that can be certified; its parameter is time (s).
pub(super) struct TimedMotion<'a>(pub &'a Trajectory);

impl JointMotion for TimedMotion<'_> {
    fn around(&self, from: f64, to: f64, middle: &mut [f64], reach: &mut [f64]) {
        let (knots, polynomials) = (self.0.knots(), self.0.coefficients());
        let n = middle.len();
        let last = knots.len() - 2;
        let piece_of = |t: f64| knots.partition_point(|knot| *knot <= t).saturating_sub(1).min(last);
        let center = 0.5 * (from + to);
        let home = piece_of(center);
        for j in 0..n {
            middle[j] = evaluate(&polynomials[home * n + j], center - knots[home])[0];
        }
        reach.fill(0.0);
        for piece in piece_of(from)..=piece_of(to) {
            let (begin, end) = (knots[piece].max(from), knots[piece + 1].min(to));
            let half = 0.5 * (end - begin).max(0.0);
            for j in 0..n {
                let local = shifted(&polynomials[piece * n + j], 0.5 * (begin + end) - knots[piece]);
                // Taylor's series about the middle of the piece ends, so that its terms bound it.
                let swing = local[1..].iter().rev().fold(0.0, |sum, c| (sum + c.abs()) * half);
                reach[j] = reach[j].max((local[0] - middle[j]).abs() + swing);
            }
        }
    }
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
    use crate::rng;
    use crate::shape::Shape;
    use crate::trajectory::polynomial;

    #[test]
    fn no_joint_leaves_the_range_around_the_middle_of_an_interval() {
        let mut rng = rng::stream(1, 0);
        let mut draw = || polynomial([(); 5].map(|()| rng.uniform_in(-1.0, 1.0)));
        let (first, second) = (draw(), draw());
        let meeting = evaluate(&first, 0.8)[0];
        let second = Coefficients::from(std::array::from_fn(|k| if k == 0 { meeting } else { second[k] }));
        let motion = Trajectory::new(vec!["a".into()], vec![0.0, 0.8, 2.0], vec![first, second]).unwrap();
        for (from, to) in [(0.0, 2.0), (0.1, 0.5), (0.7, 0.9), (1.2, 1.3), (0.8, 0.8)] {
            let (mut middle, mut reach) = ([0.0], [0.0]);
            TimedMotion(&motion).around(from, to, &mut middle, &mut reach);
            let mut largest: f64 = 0.0;
            for i in 0..=500 {
                let (mut q, mut qd, mut qdd) = ([0.0], [0.0], [0.0]);
                motion.at(from + (to - from) * f64::from(i) / 500.0, &mut q, &mut qd, &mut qdd).unwrap();
                largest = largest.max((q[0] - middle[0]).abs());
            }
            assert!(largest <= reach[0] + 1e-12, "[{from}, {to}]: {largest} beyond {}", reach[0]);
            assert!(to - from > 0.5 || reach[0] <= 1.5 * largest + 1e-12, "[{from}, {to}]: {} is loose", reach[0]);
        }
    }

    #[test]
    fn an_arm_without_obstacles_collides_only_with_a_known_shape() {
        let bare = Robot::planar(&[1.0, 1.0]).unwrap();
        let thick = bare.with_capsules_along_links(0.1).unwrap();
        let ball = Shape::sphere([3.0, 0.0, 0.0], 0.1).unwrap();
        let with = |obstacles: &[&Shape], self_collision| PointToPointOptions {
            obstacles: obstacles.iter().map(|shape| (*shape).clone()).collect(),
            self_collision,
            ..PointToPointOptions::default()
        };
        let (empty, obstructed) = (with(&[], None), with(&[&ball], None));
        assert!(!can_collide(&bare, &empty) && can_collide(&bare, &obstructed) && can_collide(&thick, &empty));
        assert!(can_collide(&bare, &with(&[], Some(true))) && !can_collide(&thick, &with(&[], Some(false))));
        assert!(can_collide(&thick, &with(&[&ball], Some(false))));
        assert!(
            as_lines(&bare, &empty).unwrap().is_some() && as_lines(&bare, &with(&[], Some(true))).unwrap().is_none()
        );
        assert!(as_lines(&Robot::named("panda").unwrap(), &empty).unwrap().is_none());
    }
}
