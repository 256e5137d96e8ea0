//! Three revolute joints that carry a point to a given point: the arm before a spherical wrist (Pieper 1968).

use crate::closed_form::angle::Angle;
use crate::closed_form::angle_range::AngleRange;
use crate::closed_form::axis_chain::{JointAxis, reversed};
use crate::closed_form::branches::Doubt;
use crate::closed_form::structure::Pair;
use crate::closed_form::subproblem::{
    Angles, Linear, QuadraticForm, solved, subproblem1, subproblem2, subproblem3, subproblem4,
};
use crate::math::vector3::{Vector, add, cross, dot, norm, perpendicular, scaled, sub};

/// Length of the common normal of two axes times the sine of their angle, as a multiple of its rounding error, below which
/// the axes nearly meet or are nearly parallel.
pub const NEARLY_JOINED: f64 = 1e8;

/// Angles of three joints.
pub type Three = [Angle; 3];

/// At most four solutions of three angles.
#[derive(Debug, Clone, Copy)]
pub struct ThreeJointSolutions {
    sets: [Three; 4],
    count: usize,
    /// True if at least one solution has a free joint.
    pub free: bool,
    /// Doubt about further solutions.
    pub doubt: Doubt,
}

impl ThreeJointSolutions {
    /// Empty set.
    pub const NONE: Self = Self { sets: [[Angle::NONE; 3]; 4], count: 0, free: false, doubt: Doubt::None };

    /// Adds a solution; ignored when full.
    #[inline(always)]
    pub fn push(&mut self, set: Three) {
        if self.count < 4 {
            self.sets[self.count] = set;
            self.count += 1;
        }
    }

    /// Merges the doubt about the angles of one joint.
    #[inline(always)]
    pub fn add_doubt(&mut self, turns: &Angles<2>) {
        self.free |= turns.free;
        if turns.near_miss {
            self.doubt.add_dead_end();
        }
        self.doubt.add(turns.doubt);
    }

    /// Reverses the order of the joints.
    #[inline(always)]
    pub fn reverse(&mut self) {
        self.sets[..self.count].iter_mut().for_each(|set| set.reverse());
    }
}

impl std::ops::Deref for ThreeJointSolutions {
    type Target = [Three];

    #[inline(always)]
    fn deref(&self) -> &[Three] {
        &self.sets[..self.count]
    }
}

/// Three axes, classified by how two neighbours lie.
#[derive(Debug, Clone, Copy)]
pub struct ThreeAxes {
    axes: [Vector; 3],
    /// Points on the axes; axes that meet share their point.
    points: [Vector; 3],
    case: Case,
    /// True if solved from the far end: the inverse motion carries the goal to the point.
    mirrored: bool,
    /// Length (m) below which a lever arm counts as zero.
    floor: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Case {
    FirstTwoParallel,
    FirstTwoMeet,
    General,
}

impl ThreeAxes {
    /// Selects the method by how neighbouring axes lie; `size` is a characteristic length of the arm (m).
    pub fn new(joints: &[JointAxis; 3], first: Pair, last: Pair, size: f64) -> Self {
        let (case, mirrored) = match (first, last) {
            (_, Pair::Parallel) => (Case::FirstTwoParallel, true),
            (Pair::Parallel, _) => (Case::FirstTwoParallel, false),
            (Pair::Meet(_), _) => (Case::FirstTwoMeet, false),
            (_, Pair::Meet(_)) => (Case::FirstTwoMeet, true),
            _ => (Case::General, false),
        };
        let (joints, first) = if mirrored { (reversed(joints), last) } else { (*joints, first) };
        let mut points = joints.map(|joint| joint.point);
        if let Pair::Meet(at) = first {
            (points[0], points[1]) = (at, at);
        }
        Self { axes: joints.map(|joint| joint.axis), points, case, mirrored, floor: 1e-11 * size }
    }

    /// Returns all angles that carry `point` to `goal`; solutions outside `ranges` may be left out.
    #[inline(always)]
    pub fn reach(&self, point: &Vector, goal: &Vector, ranges: &[AngleRange; 3]) -> ThreeJointSolutions {
        let (point, goal, of_q3) = if self.mirrored { (goal, point, &ranges[0]) } else { (point, goal, &ranges[2]) };
        let [p1, p2, p3] = &self.points;
        // Equation to solve: rot1 (b + rot2 (c + rot3 w)) = a.
        let (a, b, c, w) = (sub(goal, p1), sub(p2, p1), sub(p3, p2), sub(point, p3));
        let mut arms = match self.case {
            Case::FirstTwoParallel => self.parallel(&a, &b, &c, &w, of_q3),
            Case::FirstTwoMeet => self.meeting(&a, &c, &w, of_q3),
            Case::General => self.general(&a, &b, &c, &w),
        };
        if self.mirrored {
            arms.reverse();
        }
        arms
    }

    /// Solves parallel axes 1 and 2: the height along the axes gives q3 (subproblem 4), the distance q2 (subproblem 3), and
    /// subproblem 1 gives q1.
    #[inline(always)]
    fn parallel(&self, a: &Vector, b: &Vector, c: &Vector, w: &Vector, of_q3: &AngleRange) -> ThreeJointSolutions {
        let [h1, h2, h3] = &self.axes;
        let mut arms = ThreeJointSolutions::NONE;
        let height = dot(h1, &sub(&sub(a, b), c));
        let q3 = subproblem4(h1, h3, w, height, self.floor);
        arms.add_doubt(&q3);
        for q3 in q3.iter().filter(|q3| of_q3.may_hold(q3)) {
            let u = add(c, &q3.about(h3, w));
            // Projection onto the plane perpendicular to the axes, where heights cannot disturb the distance.
            let (flat_a, flat_b, flat_u) = (cross(h1, a), cross(h1, b), cross(h1, &u));
            let lever = norm(b);
            let q2 = subproblem3(h2, &flat_u, &scaled(&flat_b, -1.0), dot(&flat_a, &flat_a), self.floor * lever);
            arms.add_doubt(&q2);
            for q2 in q2.iter() {
                let v = add(b, &q2.about(h2, &u));
                arms.push([subproblem1(h1, &v, a), *q2, *q3]);
            }
        }
        arms
    }

    /// Solves intersecting axes 1 and 2 (b = 0): the distance from their intersection gives q3 (subproblem 3), subproblem 2
    /// the other angles.
    #[inline(always)]
    fn meeting(&self, a: &Vector, c: &Vector, w: &Vector, of_q3: &AngleRange) -> ThreeJointSolutions {
        let [h1, h2, h3] = &self.axes;
        let mut arms = ThreeJointSolutions::NONE;
        let q3 = subproblem3(h3, w, &scaled(c, -1.0), dot(a, a), self.floor * norm(c));
        arms.add_doubt(&q3);
        for q3 in q3.iter().filter(|q3| of_q3.may_hold(q3)) {
            let u = add(c, &q3.about(h3, w));
            // Remaining equation: rot2 u = rot1' a.
            let (q2, back) = subproblem2(h2, &u, h1, a, self.floor);
            arms.add_doubt(&q2);
            for (q2, back) in q2.iter().zip(&back) {
                arms.push([back.back(), *q2, *q3]);
            }
        }
        arms
    }

    /// Solves skew axes 1 and 2 (subproblem 5): distance and height are linear in rot2 u, so that its length is a quadratic
    /// form in q3.
    fn general(&self, a: &Vector, b: &Vector, c: &Vector, w: &Vector) -> ThreeJointSolutions {
        let [h1, h2, h3] = &self.axes;
        let mut arms = ThreeJointSolutions::NONE;
        let (e1, e2) = (perpendicular(h2), cross(h2, &perpendicular(h2)));
        // Vector u = c + rot3 w, as constant + cosine cos q3 + sine sin q3.
        let along = scaled(h3, dot(h3, w));
        let (constant, cosine, sine) = (add(c, &along), sub(w, &along), cross(h3, w));
        let component = |n: &Vector| -> Linear { [dot(n, &constant), dot(n, &cosine), dot(n, &sine)] };
        let z = component(h2);
        // Square of u, also linear: |u|^2 = |c|^2 + |w|^2 + 2 c'rot3 w.
        let square: Linear = [dot(c, c) + dot(w, w) + 2.0 * dot(c, &along), 2.0 * dot(c, &cosine), 2.0 * dot(c, &sine)];
        // Two equations, b'rot2 u = (|a|^2 - |b|^2 - |u|^2)/2 and h1'rot2 u = h1'(a - b), without their parts along h2.
        let (bz, hz) = (dot(b, h2), dot(h1, h2));
        let k1: Linear = std::array::from_fn(|k| {
            let one = if k == 0 { 0.5 * (dot(a, a) - dot(b, b)) } else { 0.0 };
            one - 0.5 * square[k] - bz * z[k]
        });
        let k2: Linear = std::array::from_fn(|k| if k == 0 { dot(h1, &sub(a, b)) } else { 0.0 } - hz * z[k]);
        let m = [[dot(b, &e1), dot(b, &e2)], [dot(h1, &e1), dot(h1, &e2)]];
        let ([y1, y2], determinant) = solved(&m, &[k1, k2]);
        let mut form = QuadraticForm::default();
        form.add_product(1.0, &y1, &y1);
        form.add_product(1.0, &y2, &y2);
        form.add_product(1.0, &z, &z);
        form.add_linear(&square.map(|s| -s));
        let zeros = form.zeros();
        // Axes that nearly meet, or are nearly parallel, amplify rounding.
        arms.doubt = if determinant.abs() > NEARLY_JOINED * self.floor { zeros.doubt } else { Doubt::Anywhere };
        for q3 in zeros.iter() {
            let at = |p: &Linear| p[0] + p[1] * q3.cos + p[2] * q3.sin;
            let u = add(c, &q3.about(h3, w));
            let reached = add(&scaled(&e1, at(&y1)), &scaled(&e2, at(&y2)));
            let q2 = subproblem1(h2, &u, &reached);
            arms.push([subproblem1(h1, &add(b, &q2.about(h2, &u)), a), q2, *q3]);
        }
        arms
    }
}
