//! Bound on the motion of a link's body for given joint motions.

use nalgebra::Vector3;

use crate::kinematics::chain::{StageAxis, Transmission};
use crate::kinematics::restored;
use crate::math::Frame;
use crate::robot::Robot;
use crate::shape::PosedBody;

/// A bound (m) on how much the distance of `body`, carried by frame number `frame` of `robot`, from anything fixed to frame number
/// `below` can change, while each joint changes by up to `reach` (rad, m) from the configuration of `frames` and `body`. Of a
/// capsule only the axis counts: turning leaves the ball that is swept along it as it is.
///
/// Let the elements move one after the other, the outermost first. Each then rotates the body about an axis that has not
/// moved yet. A point moves along an arc no longer than the angle times its distance from that axis, which is its distance now
/// plus what the elements behind have added; and its chord is no longer than twice that distance.
pub(super) fn displacement(
    robot: &Robot,
    frames: &[Frame],
    body: &PosedBody,
    [below, frame]: [usize; 2],
    reach: &[f64],
) -> f64 {
    let [start, end] = body.axis;
    let beside_axis = if body.solid.is_some() { body.radius } else { 0.0 };
    let mut moved = 0.0;
    for (number, motion) in robot.carriers(frame, below) {
        let ([turn, slide], axis) = (motion.travel(reach), &frames[number]);
        // The distance from an axis is convex: largest at an end.
        let lever = lever(motion, axis, start).max(lever(motion, axis, end)) + beside_axis + moved;
        moved += turn.min(2.0) * lever + slide;
    }
    moved
}

/// A bound (m) on how far any point of `body` gets from the straight line between its places at both ends of a joint motion, from the
/// configuration of `frames` and `body` on. The joints change by `change` (rad, m) in all, and get off the straight line between both
/// configurations by `off_line` at most.
pub(super) fn sagitta(robot: &Robot, frames: &[Frame], body: &PosedBody, frame: usize, change: [&[f64]; 2]) -> f64 {
    let [start, end] = body.axis;
    let beside_axis = if body.solid.is_some() { body.radius } else { 0.0 };
    let farthest = |motion: &Transmission, axis: &Frame| lever(motion, axis, start).max(lever(motion, axis, end));
    sagitta_by(robot.carriers(frame, 0), |motion, number| farthest(motion, &frames[number]) + beside_axis, change)
}

/// [`sagitta`] of `point` (m), carried by these elements, the outermost first, each with the number of its frame.
pub(crate) fn sagitta_along<'a>(
    carriers: impl Iterator<Item = (usize, &'a Transmission)>,
    frames: &[Frame],
    point: &[f64; 3],
    change: [&[f64]; 2],
) -> f64 {
    let point = Vector3::from(*point);
    sagitta_by(carriers, |motion, number| lever(motion, &frames[number], &point), change)
}

/// Along a straight line in joint space, p(s) with s from 0 to 1, a rotation by t_k about axis k accelerates a point at distance l_k
/// from it by t_k^2 l_k, and the rotation by t_i about an axis i nearer to the base turns its velocity t_k l_k by t_i: once on either
/// side. A curve with |p''| <= b is within b / 8 of its chord. A rotation vector that changes by t accelerates a point at distance l
/// from its origin by |t|^2 l at most, which is no more. A polynomial coupling adds its own second derivative.
fn sagitta_by<'a>(
    carriers: impl Iterator<Item = (usize, &'a Transmission)>,
    lever: impl Fn(&Transmission, usize) -> f64,
    [change, off_line]: [&[f64]; 2],
) -> f64 {
    let (mut moved, mut outer_velocity, mut bend, mut off) = (0.0, 0.0, 0.0, 0.0);
    for (number, motion) in carriers {
        let ([turn, slide], [off_turn, off_slide]) = (motion.travel(change), motion.travel(off_line));
        let lever = lever(motion, number) + moved;
        let [bent_turn, bent_slide] = motion.bent(change);
        bend += turn * (turn * lever + 2.0 * outer_velocity) + bent_turn * lever + bent_slide;
        off += off_turn * lever + off_slide;
        outer_velocity += turn * lever + slide;
        moved += (turn + off_turn).min(2.0) * lever + slide + off_slide;
    }
    bend / 8.0 + off
}

/// The distance of `point` from the axis of an element at `frame`; from its origin if the axis moves with the joint.
fn lever(motion: &Transmission, frame: &Frame, point: &Vector3<f64>) -> f64 {
    let from_origin = point - Vector3::from(frame.origin);
    match motion.axis {
        StageAxis::Own => from_origin.cross(&Vector3::from(frame.axes[2])).norm(),
        StageAxis::OfVector => from_origin.norm(),
        StageAxis::OfCurve => from_origin.cross(&Vector3::from(restored(frame).axes[2])).norm(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::pose;
    use crate::rng;
    use crate::robot::{ChainBuilder, Drive, Element, Joint, JointKind};
    use crate::shape::Shape;

    #[test]
    fn no_point_of_a_link_moves_farther_than_the_bound() {
        require_bounds(&Robot::named("panda").unwrap(), 2.5);
        require_bounds(&bent_arm(), 4.0);
    }

    /// An arm of three joints, and of two that follow the second one by polynomials, of which one slides.
    fn bent_arm() -> Robot {
        let mut arm = ChainBuilder::new("bent", "base");
        let joints =
            ["a", "b", "c"].map(|name| arm.add_joint(Joint::new(name, JointKind::Revolute).with_range(-1.5, 1.5)));
        let curved = |axis, turns, polynomial| Element::Curved { axis, turns, joint: joints[1], polynomial };
        arm.moving(joints[0], JointKind::Revolute, Vector3::z(), Drive::DIRECT);
        arm.fixed(pose::translation(0.1, 0.0, 0.3));
        arm.moving(joints[1], JointKind::Revolute, Vector3::y(), Drive::DIRECT);
        arm.fixed(pose::translation(0.0, 0.0, 0.3));
        arm.push(curved(Vector3::y(), true, [0.1, 0.4, -0.5, -0.3, 0.2]));
        arm.fixed(pose::translation(0.0, 0.1, 0.3));
        arm.moving(joints[2], JointKind::Revolute, Vector3::x(), Drive::DIRECT);
        arm.push(curved(Vector3::x(), false, [0.02, 0.0, 0.1, 0.0, 0.0]));
        arm.link("end");
        arm.build().unwrap()
    }

    /// Checks the bounds at drawn configurations; the tightest is below `loosest`, since a bound that any value keeps would prove
    /// nothing.
    fn require_bounds(robot: &Robot, loosest: f64) {
        let mut rng = rng::stream(1, 0);
        let (mut frames, mut moved) = (robot.frame_buffer(), robot.frame_buffer());
        let mut tightest = f64::INFINITY;
        for _ in 0..200 {
            let q = robot.random_configurations(1, &mut rng).unwrap();
            let reach: Vec<f64> = (0..q.len()).map(|_| rng.uniform_in(0.0, 0.3)).collect();
            let other: Vec<f64> = q.iter().zip(&reach).map(|(q, reach)| q + rng.uniform_in(-*reach, *reach)).collect();
            robot.write_frames(&q, &mut frames);
            robot.write_frames(&other, &mut moved);
            let last = robot.frame_of_tip(0);
            let ends = [[0.0, 0.0, 0.0], [0.1, -0.05, 0.2]];
            let place = |frame: &Frame, p: &[f64; 3]| {
                Vector3::from(frame.origin) + (0..3).map(|k| p[k] * Vector3::from(frame.axes[k])).sum::<Vector3<f64>>()
            };
            let axis = ends.map(|end| place(&frames[last], &end));
            let ball = Shape::sphere([0.0; 3], 1.0).unwrap();
            let bound = |solid| {
                let body = PosedBody { axis: &axis, radius: 0.1, solid };
                displacement(robot, &frames, &body, [0, last], &reach)
            };
            // A body that is no capsule may turn: points beside the axis move too.
            let (rod, solid) = (bound(None), bound(Some((&ball, Frame::IDENTITY))));
            let beside = [0.0, 0.1, 0.2].map(|z| [0.05, -0.025 + 0.1, z]);
            for (points, bound) in [(&ends[..], rod), (&beside[..], solid)] {
                for point in points {
                    let way = (place(&moved[last], point) - place(&frames[last], point)).norm();
                    assert!(way <= bound, "moved {way} m, bound {bound} m");
                    tightest = tightest.min(bound / way.max(1e-12));
                }
            }
            // Halfway along the straight line in joint space, and a little beside it.
            let change: Vec<f64> = q.iter().zip(&other).map(|(q, other)| (other - q).abs()).collect();
            let off_line: Vec<f64> = reach.iter().map(|reach| 0.05 * reach).collect();
            let fraction = rng.uniform_in(0.0, 1.0);
            let halfway: Vec<f64> = (0..q.len())
                .map(|j| q[j] + fraction * (other[j] - q[j]) + rng.uniform_in(-off_line[j], off_line[j]))
                .collect();
            let mut between = robot.frame_buffer();
            robot.write_frames(&halfway, &mut between);
            for (points, solid) in [(&ends[..], None), (&beside[..], Some((&ball, Frame::IDENTITY)))] {
                let body = PosedBody { axis: &axis, radius: 0.1, solid };
                let bound = sagitta(robot, &frames, &body, last, [&change, &off_line]);
                for point in points {
                    let [from, to] = [&frames, &moved].map(|frames| place(&frames[last], point));
                    let way = (place(&between[last], point) - (from + fraction * (to - from))).norm();
                    assert!(way <= bound, "{way} m off the line, bound {bound} m");
                    tightest = tightest.min(bound / way.max(1e-12));
                }
            }
            let still = PosedBody { axis: &axis, radius: 0.1, solid: None };
            assert_eq!(displacement(robot, &frames, &still, [0, last], &vec![0.0; robot.dof()]), 0.0);
        }
        assert!(tightest < loosest, "{tightest}");
    }
}
