//! Branch flips: the same tip pose by another branch of three joints in a row.
//!
//! Three joints whose axes intersect at right angles, as in a shoulder or a wrist, reach every orientation twice: turn the
//! first and the last joint by half a turn and mirror the middle one. If the axes nearly intersect, a flip comes near a
//! solution.

use std::f64::consts::PI;

use crate::kinematics::Screw;
use crate::math::so3::cross;
use crate::math::vector::dot;
use crate::objective::Point;
use crate::robot::Robot;

/// Largest cosine of perpendicular axes, and largest deviation of a unit length.
const ACROSS: f64 = 1e-6;

/// Returns the branch flips of `q`.
pub(super) fn flips(robot: &Robot, q: &[f64]) -> Vec<Point> {
    let screws = robot.screws(q);
    screws.windows(3).filter_map(|three| flip(three, q)).collect()
}

fn flip(three: &[Screw], q: &[f64]) -> Option<Point> {
    let [a, b, c] = three else { return None };
    let turns = |screw: &Screw| screw.slide == [0.0; 3] && (dot(&screw.turn, &screw.turn) - 1.0).abs() < ACROSS;
    let across = dot(&a.turn, &b.turn).abs() < ACROSS && dot(&b.turn, &c.turn).abs() < ACROSS;
    if !(turns(a) && turns(b) && turns(c) && across) {
        return None;
    }
    // Angle by which the middle joint has turned the last axis away from the first.
    let away = f64::atan2(dot(&cross(&a.turn, &c.turn), &b.turn), dot(&a.turn, &c.turn));
    let mut flipped = Point::from_slice(q);
    flipped[a.joint] += PI;
    flipped[b.joint] -= 2.0 * away;
    flipped[c.joint] += PI;
    Some(flipped)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::so3::rotation_between;
    use crate::rng;

    fn moved(robot: &Robot, q: &[f64]) -> Vec<f64> {
        let here = robot.tip(q);
        let miss = |flipped: &Point| {
            let there = robot.tip(flipped);
            let turned = rotation_between(&here, &there);
            let apart = (0..3).map(|k| (there.origin[k] - here.origin[k]).powi(2) + turned[k].powi(2)).sum::<f64>();
            apart.sqrt()
        };
        flips(robot, q).iter().map(miss).collect()
    }

    #[test]
    fn shoulder_elbow_and_wrist_of_a_human_like_arm_flip_exactly() {
        let arm = Robot::named("iiwa14").unwrap();
        for q in arm.random_configurations(5, &mut rng::stream(2, 0)).unwrap().chunks(7) {
            let moved = moved(&arm, q);
            let exact: Vec<usize> = (0..moved.len()).filter(|i| moved[*i] < 1e-12).collect();
            assert_eq!((moved.len(), exact), (5, vec![0, 2, 4]), "{moved:?}");
        }
    }

    #[test]
    fn parallel_axes_do_not_flip() {
        assert!(moved(&Robot::planar(&[1.0; 3]).unwrap(), &[0.1, 0.2, 0.3]).is_empty());
    }
}
