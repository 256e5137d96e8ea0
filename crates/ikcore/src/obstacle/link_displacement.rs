//! Bound on the motion of a link's capsule for given joint motions.

use nalgebra::Vector3;

use crate::math::Frame;
use crate::robot::Robot;
use crate::shape::LineSegment;

/// A bound (m) on how far any point of `segment`, carried by frame number `frame` of `robot`, can move relative to frame number
/// `below`, while each joint changes by up to `reach` (rad, m) from the configuration of `frames` and `segment`.
///
/// Let the elements move one after the other, the outermost first. Each then rotates the segment about an axis that has not
/// moved yet. A point moves along an arc no longer than the angle times its distance from that axis, which is its distance now
/// plus what the elements behind have added; and its chord is no longer than twice that distance.
pub(super) fn displacement(
    robot: &Robot,
    frames: &[Frame],
    segment: &LineSegment,
    [below, frame]: [usize; 2],
    reach: &[f64],
) -> f64 {
    let mut moved = 0.0;
    for (number, motion) in robot.carriers(frame, below) {
        let ([turn, slide], axis) = (motion.travel(reach), &frames[number]);
        // The distance from an axis is convex: largest at an end.
        let lever = distance_to_axis(axis, &segment[0]).max(distance_to_axis(axis, &segment[1])) + moved;
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
            let at = |frame: &Frame, p: &[f64; 3]| {
                Vector3::from(frame.origin) + (0..3).map(|k| p[k] * Vector3::from(frame.axes[k])).sum::<Vector3<f64>>()
            };
            let segment = ends.map(|end| at(&frames[last], &end));
            let bound = displacement(&robot, &frames, &segment, [0, last], &reach);
            for end in &ends {
                let way = (at(&moved[last], end) - at(&frames[last], end)).norm();
                assert!(way <= bound, "moved {way} m, bound {bound} m");
                tightest = tightest.min(bound / way.max(1e-12));
            }
            assert_eq!(displacement(&robot, &frames, &segment, [0, last], &vec![0.0; last]), 0.0);
        }
        assert!(tightest < 2.5, "{tightest}"); // a bound that any value keeps would prove nothing
    }
}
