//! Six revolute joints of which the second to fourth are parallel: UR, Techman and their like, at most eight solutions.
//!
//! The direction h of the three and the line of axis 6 give two equations in q1 and q5 alone; then a planar arm of two links is
//! left. With n and p6 the direction of axis 6 and a point on it, H the displacement asked for:
//!
//! h'rot1' R_H n = h'rot5 n,   h'rot1' (H p6 - p1) = h'(p5 - p1) + h'rot5 (p6 - p5)

use crate::closed_form::angle::Angle;
use crate::closed_form::axis_chain::JointAxis;
use crate::closed_form::branches::Candidates;
use crate::closed_form::structure::Pair;
use crate::closed_form::subproblem::{
    Linear, angle_to_plane, distance_to_point, line_on_circle, onto_point, two_linear_equations,
};
use crate::closed_form::vector::{Vector, add, cross, dot, norm, perpendicular, scaled, sub};
use crate::closed_form::wrist::{ALIGNED, Bend};
use crate::math::Frame;
use crate::math::arithmetic::Baseline;

/// An arm with three parallel axes, prepared.
#[derive(Debug, Clone, Copy)]
pub struct ThreeParallel {
    axes: [Vector; 6],
    points: [Vector; 6],
    last: Last,
    bend: Bend,
    /// 1 or -1: whether axes 3 and 4 point as axis 2 does.
    senses: [f64; 2],
    /// A unit vector across the three axes.
    mark: Vector,
    floor: f64,
}

/// How axes 5 and 6 lie, which decides how q1 and q5 come apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Last {
    /// A point on both gives q1, the direction of axis 6 then q5.
    Meet,
    /// The direction of axis 6 gives q1, its distance q5.
    Parallel,
    /// Both equations at once (subproblem 6).
    Skew,
}

impl ThreeParallel {
    /// For joints of which numbers 2 to 4 are parallel; `size` is a length of the size of the arm (m).
    pub fn new(joints: &[JointAxis; 6], size: f64, tolerance: f64) -> Self {
        let axes = joints.map(|joint| joint.axis);
        let mut points = joints.map(|joint| joint.point);
        let last = match Pair::of(&joints[4], &joints[5], size, tolerance) {
            Pair::Meet(at) => {
                (points[4], points[5]) = (at, at);
                Last::Meet
            }
            Pair::Parallel => Last::Parallel,
            Pair::Skew => Last::Skew,
        };
        let senses = [2, 3].map(|k| dot(&axes[1], &axes[k]).signum());
        let bend = Bend::new(&axes[1], &axes[4], &axes[5]);
        Self { axes, points, last, bend, senses, mark: perpendicular(&axes[1]), floor: 1e-11 * size }
    }

    /// All joint angles whose displacements make `goal`.
    #[inline(always)]
    pub fn solve(&self, goal: &Frame, found: &mut Candidates<6>) {
        let [h1, h, _, _, h5, h6] = &self.axes;
        let [p1, _, _, _, p5, p6] = &self.points;
        let (n, a) = (goal.turn::<Baseline>(h6), sub(&goal.place::<Baseline>(p6), p1));
        let offset = dot(h, &sub(p5, p1));
        match self.last {
            Last::Meet => {
                let q1 = angle_to_plane(h, &scaled(h1, -1.0), &a, offset, self.floor);
                found.singular |= q1.free;
                for q1 in q1.iter() {
                    let (q5, _) = self.bend.angles(&q1.back().about(h1, &n));
                    for q5 in q5.iter() {
                        self.wrist(goal, *q1, *q5, found);
                    }
                }
            }
            Last::Parallel => {
                let q1 = angle_to_plane(h, &scaled(h1, -1.0), &n, dot(h, h6), 1e-11);
                found.singular |= q1.free;
                for q1 in q1.iter() {
                    let height = dot(h, &q1.back().about(h1, &a)) - offset;
                    for q5 in angle_to_plane(h, h5, &sub(p6, p5), height, self.floor).iter() {
                        self.wrist(goal, *q1, *q5, found);
                    }
                }
            }
            Last::Skew => self.both(goal, &n, &a, offset, found),
        }
    }

    /// q1 and q5 from both equations together.
    fn both(&self, goal: &Frame, n: &Vector, a: &Vector, offset: f64, found: &mut Candidates<6>) {
        let [h1, h, _, _, h5, h6] = &self.axes;
        let lever = sub(&self.points[5], &self.points[4]);
        // h'rot(axis, q) v as constant, factor of the cosine, factor of the sine.
        let parts = |axis: &Vector, v: &Vector| -> Linear {
            let across = cross(axis, v);
            [dot(h, axis) * dot(axis, v), dot(&cross(axis, h), &across), dot(h, &across)]
        };
        let (of_n, of_lever) = (parts(h5, h6), parts(h5, &lever));
        let back = scaled(h1, -1.0);
        let (mut r1, mut r2) = (parts(&back, n), parts(&back, a));
        r1[0] -= of_n[0];
        r2[0] -= offset + of_lever[0];
        let m = [[of_n[1], of_n[2]], [of_lever[1], of_lever[2]]];
        let Some((q1, q5)) = two_linear_equations(&m, &[r1, r2]) else {
            found.unsettled = true;
            return;
        };
        found.unsettled |= q1.free;
        for (q1, q5) in q1.iter().zip(&q5) {
            self.wrist(goal, *q1, *q5, found);
        }
    }

    /// q6, the sum of the three parallel joints, and their planar arm.
    #[inline(always)]
    fn wrist(&self, goal: &Frame, q1: Angle, q5: Angle, found: &mut Candidates<6>) {
        let [h1, h, _, _, h5, h6] = &self.axes;
        let seen = q5.back().about(h5, h);
        let across = cross(h6, &seen);
        if dot(&across, &across) < ALIGNED * ALIGNED {
            return self.wrist_aligned(goal, q1, q5, found);
        }
        let q6 = onto_point(h6, &goal.turn_back(&q1.about(h1, h)), &seen);
        self.planar(goal, q1, q5, q6, found);
    }

    /// q2, q3, q4 by the two links between axes 2, 3 and 4.
    #[inline(always)]
    fn planar(&self, goal: &Frame, q1: Angle, q5: Angle, q6: Angle, found: &mut Candidates<6>) {
        let [h1, h, h3, _, h5, h6] = &self.axes;
        let [_, p2, p3, p4, ..] = &self.points;
        // The sum of the three turns a vector across h as rot1' R_H rot6' rot5' does.
        let undo = |v: &Vector| q6.back().about(h6, &q5.back().about(h5, v));
        let sum = onto_point(h, &self.mark, &q1.back().about(h1, &goal.turn::<Baseline>(&undo(&self.mark))));
        let reached = self.wrist_from_axis_2(goal, q1, q5, q6);
        let (first, second) = (sub(p3, p2), sub(p4, p3));
        let flat = |v: &Vector| cross(h, v);
        let (flat_first, flat_second, flat_reached) = (flat(&first), flat(&second), flat(&reached));
        let square = dot(&flat_reached, &flat_reached);
        let q3 =
            distance_to_point(h3, &flat_second, &scaled(&flat_first, -1.0), square, self.floor * norm(&flat_first));
        for q3 in q3.iter() {
            let elbow = add(&flat_first, &q3.about(h3, &flat_second));
            let q2 = onto_point(h, &elbow, &flat_reached);
            let q4 = sum.and(q2.back()).and(q3.signed(-self.senses[0])).signed(self.senses[1]);
            found.push(&[q1, q2, *q3, q4, q5, q6]);
        }
    }

    /// Where p4 lies, seen from axis 2 with joint 1 undone: rot1' (H rot6' rot5' p4 - p1) - (p2 - p1).
    #[inline(always)]
    fn wrist_from_axis_2(&self, goal: &Frame, q1: Angle, q5: Angle, q6: Angle) -> Vector {
        let [p1, p2, _, p4, p5, p6] = &self.points;
        let [h1, _, _, _, h5, h6] = &self.axes;
        let back5 = add(p5, &q5.back().about(h5, &sub(p4, p5)));
        let back6 = add(p6, &q6.back().about(h6, &sub(&back5, p6)));
        sub(&q1.back().about(h1, &sub(&goal.place::<Baseline>(&back6), p1)), &sub(p2, p1))
    }

    /// Axis 6 parallel to the three: q6 is free as far as the planar arm reaches. The middle of the reach stands for all.
    #[cold]
    fn wrist_aligned(&self, goal: &Frame, q1: Angle, q5: Angle, found: &mut Candidates<6>) {
        let h = &self.axes[1];
        let [_, p2, p3, p4, ..] = &self.points;
        let flat_norm = |v: &Vector| norm(&cross(h, v));
        let (first, second) = (flat_norm(&sub(p3, p2)), flat_norm(&sub(p4, p3)));
        // The squared distance of axis 4 from axis 2 is base + a cos q6 + b sin q6.
        let square = |q6: Angle| {
            let flat = cross(h, &self.wrist_from_axis_2(goal, q1, q5, q6));
            dot(&flat, &flat)
        };
        let quarter = |cos: f64, sin: f64| square(Angle { cos, sin });
        let base = 0.5 * (quarter(1.0, 0.0) + quarter(-1.0, 0.0));
        let (a, b) = (quarter(1.0, 0.0) - base, quarter(0.0, 1.0) - base);
        let (least, most) = ((first - second).powi(2), (first + second).powi(2));
        let swing = a.hypot(b);
        let (low, high) = (least.max(base - swing), most.min(base + swing));
        if low > high + 1e-9 * most {
            return;
        }
        found.singular = true;
        for q6 in line_on_circle(a, b, 0.5 * (low + high) - base, 1e-12 * most).iter().take(1) {
            self.planar(goal, q1, q5, *q6, found);
        }
    }
}
