//! Six revolute joints of which the second to fourth are parallel: UR, Techman and their like, at most eight solutions.
//!
//! The direction h of the three and the line of axis 6 give two equations in q1 and q5 alone; then a planar arm of two links is
//! left. With n and p6 the direction of axis 6 and a point on it, H the displacement asked for:
//!
//! h'rot1' R_H n = h'rot5 n,   h'rot1' (H p6 - p1) = h'(p5 - p1) + h'rot5 (p6 - p5)

use crate::closed_form::angle::Angle;
use crate::closed_form::axis_chain::JointAxis;
use crate::closed_form::branches::Candidates;
use crate::closed_form::orbit::{Orbit, about_z, seen};
use crate::closed_form::structure::Pair;
use crate::closed_form::subproblem::{Linear, angle_to_plane, line_on_circle, two_linear_equations};
use crate::closed_form::vector::{Vector, across, cross, dot, scaled, sub};
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
    /// Two unit vectors across the three axes, and h.
    flat: [Vector; 3],
    /// Two unit vectors across axis 6, and that axis.
    end: [Vector; 3],
    /// Seen along `end`, by q5: where the first of `flat` and h are turned back to, and p4 from p6.
    mark: Orbit,
    seen: Orbit,
    wrist: Orbit,
    /// The links from axis 2 to 3 and from 3 to 4, in the plane across them.
    links: [[f64; 2]; 2],
    floor: f64,
}

/// Joint 1 at one of its angles.
#[derive(Debug, Clone, Copy)]
struct Shoulder {
    q1: Angle,
    /// The vectors of `flat`, seen from the tip along `end`.
    axes: [Vector; 3],
    /// Where p6 lies in the plane across the three axes, from axis 2.
    offset: [f64; 2],
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
        let (flat, end) = (across(&axes[1]), across(&axes[5]));
        let circle = |v: &Vector| Orbit::of(&scaled(&axes[4], -1.0), v).seen(&end);
        let wrist = circle(&sub(&points[3], &points[4])).moved(&seen(&end, &sub(&points[4], &points[5])));
        let in_plane = |v: &Vector| [dot(&flat[0], v), dot(&flat[1], v)];
        let links = [1, 2].map(|k| in_plane(&sub(&points[k + 1], &points[k])));
        let (mark, seen) = (circle(&flat[0]), circle(&flat[2]));
        Self { axes, points, last, bend, senses, flat, end, mark, seen, wrist, links, floor: 1e-11 * size }
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
                    let shoulder = self.shoulder(goal, *q1);
                    let (q5, _) = self.bend.angles(&q1.back().about(h1, &n));
                    for q5 in q5.iter() {
                        self.wrist(&shoulder, *q5, found);
                    }
                }
            }
            Last::Parallel => {
                let q1 = angle_to_plane(h, &scaled(h1, -1.0), &n, dot(h, h6), 1e-11);
                found.singular |= q1.free;
                for q1 in q1.iter() {
                    let shoulder = self.shoulder(goal, *q1);
                    let height = dot(h, &q1.back().about(h1, &a)) - offset;
                    for q5 in angle_to_plane(h, h5, &sub(p6, p5), height, self.floor).iter() {
                        self.wrist(&shoulder, *q5, found);
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
            self.wrist(&self.shoulder(goal, *q1), *q5, found);
        }
    }

    #[inline(always)]
    fn shoulder(&self, goal: &Frame, q1: Angle) -> Shoulder {
        let [p1, p2, .., p6] = &self.points;
        let [x, y, h] = self.flat.map(|v| q1.about(&self.axes[0], &v));
        let axes = [x, y, h].map(|v| seen(&self.end, &goal.turn_back(&v)));
        // rot1' (H p6 - p1) - (p2 - p1).
        let (from_p1, second) = (sub(&goal.place::<Baseline>(p6), p1), sub(p2, p1));
        let offset = [dot(&x, &from_p1) - dot(&self.flat[0], &second), dot(&y, &from_p1) - dot(&self.flat[1], &second)];
        Shoulder { q1, axes, offset }
    }

    /// q6, the sum of the three parallel joints, and their planar arm.
    #[inline(always)]
    fn wrist(&self, shoulder: &Shoulder, q5: Angle, found: &mut Candidates<6>) {
        let seen = self.seen.at(q5);
        if seen[0] * seen[0] + seen[1] * seen[1] < ALIGNED * ALIGNED {
            return self.wrist_aligned(shoulder, q5, found);
        }
        let [.., up] = &shoulder.axes;
        let q6 = Angle::towards(up[0] * seen[0] + up[1] * seen[1], up[0] * seen[1] - up[1] * seen[0]);
        self.planar(shoulder, q5, q6, found);
    }

    /// q2, q3, q4 by the two links between axes 2, 3 and 4.
    #[inline(always)]
    fn planar(&self, shoulder: &Shoulder, q5: Angle, q6: Angle, found: &mut Candidates<6>) {
        let [x, y, _] = &shoulder.axes;
        // The sum of the three turns a vector across h as rot1' R_H rot6' rot5' does.
        let mark = about_z(q6.back(), &self.mark.at(q5));
        let sum = Angle::towards(dot(x, &mark), dot(y, &mark));
        let [rx, ry] = self.reached(shoulder, q5, q6);
        let [[ax, ay], [bx, by]] = self.links;
        // |a + rot3 b| = |reached|.
        let sense = self.senses[0];
        let product = 0.5 * (rx * rx + ry * ry - (ax * ax + ay * ay) - (bx * bx + by * by));
        let floor = self.floor * (ax * ax + ay * ay).sqrt();
        for q3 in line_on_circle(ax * bx + ay * by, sense * (ay * bx - ax * by), product, floor).iter() {
            let (cos, sin) = (q3.cos, sense * q3.sin);
            let (ex, ey) = (ax + cos * bx - sin * by, ay + sin * bx + cos * by);
            let q2 = Angle::towards(ex * rx + ey * ry, ex * ry - ey * rx);
            let q4 = sum.and(q2.back()).and(q3.signed(-sense)).signed(self.senses[1]);
            found.push(&[shoulder.q1, q2, *q3, q4, q5, q6]);
        }
    }

    /// Where p4 lies in the plane across the three axes, from axis 2: rot1' (H rot6' rot5' p4 - p1) - (p2 - p1).
    #[inline(always)]
    fn reached(&self, shoulder: &Shoulder, q5: Angle, q6: Angle) -> [f64; 2] {
        let Shoulder { axes: [x, y, _], offset, .. } = shoulder;
        let wrist = about_z(q6.back(), &self.wrist.at(q5));
        [dot(x, &wrist) + offset[0], dot(y, &wrist) + offset[1]]
    }

    /// Axis 6 parallel to the three: q6 is free as far as the planar arm reaches. The middle of the reach stands for all.
    #[cold]
    fn wrist_aligned(&self, shoulder: &Shoulder, q5: Angle, found: &mut Candidates<6>) {
        let [first, second] = self.links.map(|[x, y]| x.hypot(y));
        // The squared distance of axis 4 from axis 2 is base + a cos q6 + b sin q6.
        let quarter = |cos: f64, sin: f64| {
            let [x, y] = self.reached(shoulder, q5, Angle { cos, sin });
            x * x + y * y
        };
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
            self.planar(shoulder, q5, *q6, found);
        }
    }
}
