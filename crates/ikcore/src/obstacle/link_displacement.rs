//! Bound on the motion of a link's body for given joint motions.

use nalgebra::Vector3;

use crate::math::Frame;
use crate::robot::Robot;
use crate::shape::PlacedBody;

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
    body: &PlacedBody,
    [below, frame]: [usize; 2],
    reach: &[f64],
) -> f64 {
    let [start, end] = body.axis;
    let beside_axis = if body.solid.is_some() { body.radius } else { 0.0 };
    let mut moved = 0.0;
    for (number, motion) in robot.carriers(frame, below) {
        let ([turn, slide], axis) = (motion.travel(reach), &frames[number]);
        // The distance from an axis is convex: largest at an end.
        let lever = distance_to_axis(axis, start).max(distance_to_axis(axis, end)) + beside_axis + moved;
        moved += turn.min(2.0) * lever + slide;
    }
    moved
}

fn distance_to_axis(frame: &Frame, point: &Vector3<f64>) -> f64 {
    (point - Vector3::from(frame.origin)).cross(&Vector3::from(frame.axes[2])).norm()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng;
    use crate::shape::Shape;

    #[test]
    fn no_point_of_a_link_moves_farther_than_the_bound() {
        let robot = Robot::named("panda").unwrap();
        let mut rng = rng::stream(1, 0);
        let (mut frames, mut moved) = (robot.frame_buffer(), robot.frame_buffer());
        let mut tightest = f64::INFINITY;
        for _ in 0..200 {
            let q = robot.random_configurations(1, &mut rng).unwrap();
            let reach: Vec<f64> = (0..q.len()).map(|_| rng.uniform_in(0.0, 0.3)).collect();
            let other: Vec<f64> = q.iter().zip(&reach).map(|(q, reach)| q + rng.uniform_in(-*reach, *reach)).collect();
            robot.write_frames(&q, &mut frames);
            robot.write_frames(&other, &mut moved);
            let last = q.len();
            let ends = [[0.0, 0.0, 0.0], [0.1, -0.05, 0.2]];
            let place = |frame: &Frame, p: &[f64; 3]| {
                Vector3::from(frame.origin) + (0..3).map(|k| p[k] * Vector3::from(frame.axes[k])).sum::<Vector3<f64>>()
            };
            let axis = ends.map(|end| place(&frames[last], &end));
            let ball = Shape::sphere([0.0; 3], 1.0).unwrap();
            let bound = |solid| {
                let body = PlacedBody { axis: &axis, radius: 0.1, solid };
                displacement(&robot, &frames, &body, [0, last], &reach)
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
            let still = PlacedBody { axis: &axis, radius: 0.1, solid: None };
            assert_eq!(displacement(&robot, &frames, &still, [0, last], &vec![0.0; last]), 0.0);
        }
        assert!(tightest < 2.5, "{tightest}"); // a bound that any value keeps would prove nothing
    }
}
