//! How far the capsule of a link can move while the joints move by so much.

use nalgebra::Vector3;

use super::segment_distance::Segment;
use crate::math::{Frame, MAX_DOF};
use crate::robot::Robot;

/// Frames reached after 0, 1, 2, ... moving elements.
pub(super) type Frames = [Frame; MAX_DOF + 1];

/// A bound (m) on how far any point of `segment`, carried by the moving elements `stages` of `robot`, can move relative to what
/// lies before them, while each joint changes by up to `reach` (rad, m) from the configuration of `frames` and `segment`.
///
/// Let the elements move one after the other, the outermost first. Each then rotates the segment about an axis that has not
/// moved yet. A point moves along an arc no longer than the angle times its distance from that axis, which is its distance now
/// plus what the elements behind have added; and its chord is no longer than twice that distance.
pub(super) fn displacement(
    robot: &Robot,
    frames: &Frames,
    segment: &Segment,
    stages: std::ops::Range<usize>,
    reach: &[f64],
) -> f64 {
    let mut moved = 0.0;
    for stage in stages.rev() {
        let [turn, slide] = robot.stage_travel(stage, reach);
        let axis = &frames[stage + 1];
        // The distance from an axis is convex: largest at an end.
        let lever = distance_to_axis(axis, &segment[0]).max(distance_to_axis(axis, &segment[1])) + moved;
        moved += turn.min(2.0) * lever + slide;
    }
    moved
}

fn distance_to_axis(frame: &Frame, point: &Vector3<f64>) -> f64 {
    (point - Vector3::from(frame.origin)).cross(&Vector3::from(frame.axes[2])).norm()
}
