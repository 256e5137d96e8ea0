//! Spherical-wrist arms with one or three prismatic joints among the first three: Stanford arm, cylindrical arms, gantries.

use crate::closed_form::angle::Angle;
use crate::closed_form::axis_chain::{AxisKind, JointAxis};
use crate::closed_form::branches::Doubt;
use crate::closed_form::position::ThreeJointSolutions;
use crate::closed_form::structure::Pair;
use crate::closed_form::subproblem::{CLAMP, NEARLY_DOUBLE, subproblem1, subproblem2, subproblem3};
use crate::math::vector3::{Vector, add, add_scaled, cross, dot, scaled, sub};

/// Precomputed first three joints.
#[derive(Debug, Clone, Copy)]
pub struct SlidingArm {
    axes: [Vector; 3],
    points: [Vector; 3],
    case: Case,
    /// True if the prismatic joint is the first: solved from the far end.
    mirrored: bool,
    floor: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Case {
    /// Two revolute joints with intersecting axes, then a prismatic joint.
    MeetThenSlide,
    /// Two revolute joints with parallel axes, then a prismatic joint not perpendicular to them.
    ParallelThenSlide,
    /// Three prismatic joints that span space.
    ThreeSlides,
}

impl SlidingArm {
    /// Returns `None` if no method fits; `size` is a characteristic length of the arm (m).
    pub fn new(joints: &[JointAxis; 3], size: f64, tolerance: f64) -> Option<Self> {
        let floor = 1e-11 * size;
        let mut axes = joints.map(|joint| joint.axis);
        let mut points = joints.map(|joint| joint.point);
        use AxisKind::{Slides, Turns};
        let mirrored = match joints.map(|joint| joint.motion) {
            [Turns, Turns, Slides] => false,
            [Slides, Turns, Turns] => true,
            [Slides, Slides, Slides] => {
                let spans = dot(&axes[0], &cross(&axes[1], &axes[2])).abs() > 1e-6;
                return spans.then_some(Self { axes, points, case: Case::ThreeSlides, mirrored: false, floor });
            }
            _ => return None,
        };
        if mirrored {
            axes = [scaled(&axes[2], -1.0), scaled(&axes[1], -1.0), scaled(&axes[0], -1.0)];
            points.reverse();
        }
        let turning = if mirrored { [&joints[2], &joints[1]] } else { [&joints[0], &joints[1]] };
        let case = match Pair::of(turning[0], turning[1], size, tolerance) {
            Pair::Meet(at) => {
                (points[0], points[1]) = (at, at);
                Case::MeetThenSlide
            }
            Pair::Parallel if dot(&axes[0], &axes[2]).abs() > 1e-6 => Case::ParallelThenSlide,
            _ => return None,
        };
        Some(Self { axes, points, case, mirrored, floor })
    }

    /// Returns all joint values that carry `point` to `goal`. A prismatic displacement is stored in the sine.
    pub fn reach(&self, point: &Vector, goal: &Vector) -> ThreeJointSolutions {
        let (point, goal) = if self.mirrored { (goal, point) } else { (point, goal) };
        let [p1, p2, _] = &self.points;
        // Equation to solve: rot1 (b + rot2 (u + d h3)) = a.
        let (a, b, u) = (sub(goal, p1), sub(p2, p1), sub(point, p2));
        let mut arms = match self.case {
            Case::MeetThenSlide => self.meeting(&a, &u),
            Case::ParallelThenSlide => self.parallel(&a, &b, &u),
            Case::ThreeSlides => self.slides(&sub(goal, point)),
        };
        if self.mirrored {
            arms.reverse();
        }
        arms
    }

    /// Solves intersecting axes: the distance from their intersection gives the prismatic displacement, subproblem 2 the angles.
    fn meeting(&self, a: &Vector, u: &Vector) -> ThreeJointSolutions {
        let [h1, h2, h3] = &self.axes;
        let mut arms = ThreeJointSolutions::NONE;
        // Quadratic equation d^2 + 2 d u'h3 + |u|^2 = |a|^2, in terms of the component perpendicular to the slide.
        let across = cross(h3, u);
        let (middle, distance) = (-dot(u, h3), dot(a, a));
        let radicand = distance - dot(&across, &across);
        if radicand < -CLAMP * distance {
            return arms;
        }
        if radicand < NEARLY_DOUBLE * distance {
            arms.doubt.add(Doubt::Nearby);
        }
        let root = radicand.max(0.0).sqrt();
        for slide in [middle + root, middle - root] {
            let reached = add_scaled(u, h3, slide);
            let (q2, back) = subproblem2(h2, &reached, h1, a, self.floor);
            arms.add_doubt(&q2);
            for (q2, back) in q2.iter().zip(&back) {
                arms.push([back.back(), *q2, slid(slide)]);
            }
        }
        arms
    }

    /// Solves parallel axes: the height along them gives the prismatic displacement, subproblems 3 and 1 the angles.
    fn parallel(&self, a: &Vector, b: &Vector, u: &Vector) -> ThreeJointSolutions {
        let [h1, h2, h3] = &self.axes;
        let mut arms = ThreeJointSolutions::NONE;
        let slide = dot(h1, &sub(&sub(a, b), u)) / dot(h1, h3);
        let reached = add_scaled(u, h3, slide);
        let flat = |v: &Vector| cross(h1, v);
        let (flat_a, flat_b) = (flat(a), flat(b));
        let floor = self.floor * dot(&flat_b, &flat_b).sqrt();
        let q2 = subproblem3(h2, &flat(&reached), &scaled(&flat_b, -1.0), dot(&flat_a, &flat_a), floor);
        arms.add_doubt(&q2);
        for q2 in q2.iter() {
            arms.push([subproblem1(h1, &add(b, &q2.about(h2, &reached)), a), *q2, slid(slide)]);
        }
        arms
    }

    /// Solves three prismatic joints by Cramer's rule.
    fn slides(&self, way: &Vector) -> ThreeJointSolutions {
        let [h1, h2, h3] = &self.axes;
        let mut arms = ThreeJointSolutions::NONE;
        let inverse = 1.0 / dot(h1, &cross(h2, h3));
        let values = [dot(way, &cross(h2, h3)), dot(h1, &cross(way, h3)), dot(h1, &cross(h2, way))];
        arms.push(values.map(|value| slid(inverse * value)));
        arms
    }
}

/// Returns a prismatic displacement in the form of candidates.
fn slid(value: f64) -> Angle {
    Angle { cos: 1.0, sin: value }
}
