//! Six revolute joints with parallel axes 2 to 4, as in UR and Techman arms: at most eight solutions.
//!
//! The direction h of the three axes and the line of axis 6 give two equations in q1 and q5 alone; the rest is a planar arm
//! with two links. With n the direction of axis 6, p6 a point on it, and H the required displacement:
//!
//! h'rot1' R_H n = h'rot5 n,   h'rot1' (H p6 - p1) = h'(p5 - p1) + h'rot5 (p6 - p5)

use crate::closed_form::angle::Angle;
use crate::closed_form::axis_chain::JointAxis;
use crate::closed_form::branches::{Candidates, Doubt};
use crate::closed_form::four_angles::{self, FourAngles};
use crate::closed_form::orbit::{Orbit, about_z, seen};
use crate::closed_form::position::NEARLY_JOINED;
use crate::closed_form::structure::Pair;
use crate::closed_form::subproblem::{Angles, CLAMP, Linear, NEARLY_DOUBLE, line_on_circle, subproblem4, subproblem6};
use crate::closed_form::wrist::{ALIGNED, Bend, NEARLY_ALIGNED};
use crate::math::Frame;
use crate::math::arithmetic::{Arithmetic, Baseline};
use crate::math::f64x4::F64x4;
use crate::math::real::{Four, Real};
use crate::math::vector3::{Vector, across, cross, dot, scaled, sub};

/// Precomputed arm with three parallel axes.
#[derive(Debug, Clone, Copy)]
pub struct ThreeParallel {
    axes: [Vector; 6],
    points: [Vector; 6],
    last: Last,
    bend: Bend,
    /// Signs, 1 or -1: directions of axes 3 and 4 relative to axis 2.
    senses: [f64; 2],
    /// Two unit vectors perpendicular to the three axes, and h.
    flat: [Vector; 3],
    /// Two unit vectors perpendicular to axis 6, and axis 6.
    end: [Vector; 3],
    /// Circles in q5, in coordinates along `end`: the first vector of `flat`, h, and p4 relative to p6, each rotated back by
    /// joint 5.
    mark: Orbit,
    seen: Orbit,
    wrist: Orbit,
    /// Links from axis 2 to 3 and from 3 to 4, in the plane perpendicular to the axes.
    links: [[f64; 2]; 2],
    elbow: Elbow,
    floor: f64,
}

/// Elbow equation a cos q3 + b sin q3 = c (subproblem 3): the sum of the links has the required length.
#[derive(Debug, Clone, Copy)]
struct Elbow {
    a: f64,
    b: f64,
    /// Squared lengths of the links.
    squares: [f64; 2],
    /// Value below which c counts as zero if a and b do.
    floor: f64,
}

/// One solution for joint 1.
#[derive(Debug, Clone, Copy)]
struct Shoulder {
    q1: Angle,
    /// Vectors of `flat`, rotated to the tip and in coordinates along `end`.
    axes: [Vector; 3],
    /// Position of p6 relative to axis 2, in the plane perpendicular to the three axes.
    offset: [f64; 2],
}

/// Shoulder and wrist of up to four branches, in SIMD lanes.
#[derive(Debug, Clone, Copy)]
struct Wrists {
    /// First two vectors of [`Shoulder::axes`].
    x: [F64x4; 3],
    y: [F64x4; 3],
    offset: [F64x4; 2],
    /// Cosines and sines of joints 1, 5 and 6.
    turns: [[F64x4; 2]; 3],
    count: usize,
}

/// Relation of axes 5 and 6, which decides how q1 and q5 separate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Last {
    /// Intersecting axes: their common point gives q1, then the direction of axis 6 gives q5 (subproblem 4 twice).
    Meet,
    /// Parallel axes: the direction of axis 6 gives q1, its distance q5 (subproblem 4 twice).
    Parallel,
    /// Skew axes: both equations are solved together (subproblem 6).
    Skew,
}

impl ThreeParallel {
    /// Prepares joints whose axes 2 to 4 are parallel; `size` is a characteristic length of the arm (m).
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
        let floor = 1e-11 * size;
        let elbow = Elbow::new(&links, senses[0], floor);
        Self { axes, points, last, bend, senses, flat, end, mark, seen, wrist, links, elbow, floor }
    }

    /// Adds all candidates whose displacements make `goal`.
    #[inline(always)]
    pub fn solve<A: Arithmetic>(&self, goal: &Frame, found: &mut Candidates) {
        let mut wrists = Wrists::NONE;
        let [h1, h, _, _, h5, h6] = &self.axes;
        let [p1, _, _, _, p5, p6] = &self.points;
        let (n, a) = (goal.turn::<Baseline>(h6), sub(&goal.transform::<Baseline>(p6), p1));
        let offset = dot(h, &sub(p5, p1));
        match self.last {
            Last::Meet => {
                let q1 = subproblem4(h, &scaled(h1, -1.0), &a, offset, self.floor);
                found.singular |= q1.free;
                found.doubt.add(q1.doubt);
                for q1 in q1.iter() {
                    let shoulder = self.shoulder(goal, *q1);
                    let (q5, _) = self.bend.angles(&q1.back().about(h1, &n));
                    add_doubt(&q5, found);
                    for q5 in q5.iter() {
                        self.wrist::<A>(&shoulder, *q5, &mut wrists, found);
                    }
                }
            }
            Last::Parallel => {
                let q1 = subproblem4(h, &scaled(h1, -1.0), &n, dot(h, h6), 1e-11);
                found.singular |= q1.free;
                found.doubt.add(q1.doubt);
                for q1 in q1.iter() {
                    let shoulder = self.shoulder(goal, *q1);
                    let height = dot(h, &q1.back().about(h1, &a)) - offset;
                    let q5 = subproblem4(h, h5, &sub(p6, p5), height, self.floor);
                    add_doubt(&q5, found);
                    for q5 in q5.iter() {
                        self.wrist::<A>(&shoulder, *q5, &mut wrists, found);
                    }
                }
            }
            Last::Skew => self.both::<A>(goal, &n, &a, offset, &mut wrists, found),
        }
        self.planar::<A>(&mut wrists, found);
    }

    /// Solves both equations together for q1 and q5 (subproblem 6).
    fn both<A: Arithmetic>(
        &self,
        goal: &Frame,
        n: &Vector,
        a: &Vector,
        offset: f64,
        wrists: &mut Wrists,
        found: &mut Candidates,
    ) {
        let [h1, h, _, _, h5, h6] = &self.axes;
        let lever = sub(&self.points[5], &self.points[4]);
        // Constant, cosine and sine parts of h'rot(axis, q) v.
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
        // Axes that nearly meet, or are nearly parallel, amplify rounding.
        if (m[0][0] * m[1][1] - m[0][1] * m[1][0]).abs() <= NEARLY_JOINED * self.floor {
            found.doubt = Doubt::Anywhere;
        }
        let Some((q1, q5)) = subproblem6(&m, &[r1, r2]) else {
            found.doubt = Doubt::Anywhere;
            return;
        };
        found.doubt.add(q1.doubt);
        for (q1, q5) in q1.iter().zip(&q5) {
            self.wrist::<A>(&self.shoulder(goal, *q1), *q5, wrists, found);
        }
    }

    #[inline(always)]
    fn shoulder(&self, goal: &Frame, q1: Angle) -> Shoulder {
        let [p1, p2, .., p6] = &self.points;
        let [x, y, h] = &self.flat;
        let turned = |v: &Vector| q1.about(&self.axes[0], v);
        let (x, y, h) = (turned(x), turned(y), turned(h));
        let from_tip = |v: &Vector| seen(&self.end, &goal.turn_back(v));
        let axes = [from_tip(&x), from_tip(&y), from_tip(&h)];
        // Position of p6: rot1' (H p6 - p1) - (p2 - p1).
        let (from_p1, second) = (sub(&goal.transform::<Baseline>(p6), p1), sub(p2, p1));
        let offset = [dot(&x, &from_p1) - dot(&self.flat[0], &second), dot(&y, &from_p1) - dot(&self.flat[1], &second)];
        Shoulder { q1, axes, offset }
    }

    /// Adds the wrist's q6 for a solution of q1 and q5.
    #[inline(always)]
    fn wrist<A: Arithmetic>(&self, shoulder: &Shoulder, q5: Angle, wrists: &mut Wrists, found: &mut Candidates) {
        if wrists.count == 4 {
            self.planar::<A>(wrists, found);
        }
        let seen = self.seen.at(q5);
        let square = seen[0] * seen[0] + seen[1] * seen[1];
        if square < NEARLY_DOUBLE {
            found.doubt.add(if square < NEARLY_ALIGNED * NEARLY_ALIGNED { Doubt::Anywhere } else { Doubt::Nearby });
            if square < ALIGNED * ALIGNED {
                return self.wrist_aligned(shoulder, q5, wrists, found);
            }
        }
        let [.., up] = &shoulder.axes;
        let q6 = Angle::towards(up[0] * seen[0] + up[1] * seen[1], up[0] * seen[1] - up[1] * seen[0]);
        wrists.push(shoulder, q5, q6);
    }

    /// Solves the planar arm: the sum of the three parallel joints, and q2, q3 and q4 (subproblem 3) from the two links
    /// between axes 2, 3 and 4. Empties `wrists`.
    #[inline(always)]
    fn planar<A: Arithmetic>(&self, wrists: &mut Wrists, found: &mut Candidates) {
        let Wrists { x, y, offset, turns, count } = wrists;
        let four = |stored: &F64x4| Four::<A>::of(*stored);
        let angles = |turn: &[F64x4; 2]| FourAngles { cos: four(&turn[0]), sin: four(&turn[1]) };
        let (x, y) = ([four(&x[0]), four(&x[1]), four(&x[2])], [four(&y[0]), four(&y[1]), four(&y[2])]);
        let (q5, back) = (angles(&turns[1]), angles(&turns[2]).back());
        // Sum of the three parallel joints: it rotates a vector perpendicular to h by rot1' R_H rot6' rot5'.
        let mark = back.about_z(q5.on(&self.mark));
        let sum = FourAngles::towards(four_angles::dot(&x, &mark), four_angles::dot(&y, &mark));
        let wrist = back.about_z(q5.on(&self.wrist));
        let reached =
            [four_angles::dot(&x, &wrist) + four(&offset[0]), four_angles::dot(&y, &wrist) + four(&offset[1])];
        let bends = self.elbow.bends(&reached, *count);
        if bends.near_miss {
            found.doubt.add_dead_end();
        }
        found.doubt.add(bends.doubt);
        let [first, second] = [self.bent(bends.q3[0], sum, &reached), self.bent(bends.q3[1], sum, &reached)];
        for lane in 0..std::mem::take(count) {
            let (q1, q5, q6) = (angles(&turns[0]).lane(lane), q5.lane(lane), back.back().lane(lane));
            for [q2, q3, q4] in &[first, second][..bends.counts[lane]] {
                found.push_six(&[q1, q2.lane(lane), q3.lane(lane), q4.lane(lane), q5, q6]);
            }
        }
    }

    /// Returns q2, q3 and q4, given q3.
    #[inline(always)]
    fn bent<R: Real>(&self, q3: FourAngles<R>, sum: FourAngles<R>, reached: &[R; 2]) -> [FourAngles<R>; 3] {
        let [[ax, ay], [bx, by]] = self.links;
        let (ax, ay, bx, by) = (R::splat(ax), R::splat(ay), R::splat(bx), R::splat(by));
        let [rx, ry] = *reached;
        let sense = self.senses[0];
        let (cos, sin) = (q3.cos, R::splat(sense) * q3.sin);
        let (ex, ey) = (ax + cos * bx - sin * by, ay + sin * bx + cos * by);
        let q2 = FourAngles::towards(ex * rx + ey * ry, ex * ry - ey * rx);
        [q2, q3, sum.and(q2.back()).and(q3.signed(-sense)).signed(self.senses[1])]
    }

    /// Returns the position of p4 relative to axis 2, in the plane perpendicular to the three axes: rot1' (H rot6' rot5' p4 -
    /// p1) - (p2 - p1).
    #[inline(always)]
    fn reached(&self, shoulder: &Shoulder, q5: Angle, q6: Angle) -> [f64; 2] {
        let Shoulder { axes: [x, y, _], offset, .. } = shoulder;
        let wrist = about_z(q6.back(), &self.wrist.at(q5));
        [dot(x, &wrist) + offset[0], dot(y, &wrist) + offset[1]]
    }

    /// Solves axis 6 parallel to the three axes: q6 is free as far as the planar arm reaches, represented by the middle of
    /// the reach.
    #[cold]
    fn wrist_aligned(&self, shoulder: &Shoulder, q5: Angle, wrists: &mut Wrists, found: &mut Candidates) {
        let [first, second] = self.links.map(|[x, y]| x.hypot(y));
        // Squared distance of axis 4 from axis 2: base + a cos q6 + b sin q6.
        let quarter = |cos: f64, sin: f64| {
            let [x, y] = self.reached(shoulder, q5, Angle { cos, sin });
            x * x + y * y
        };
        let base = 0.5 * (quarter(1.0, 0.0) + quarter(-1.0, 0.0));
        let (a, b) = (quarter(1.0, 0.0) - base, quarter(0.0, 1.0) - base);
        let (least, most) = ((first - second).powi(2), (first + second).powi(2));
        let swing = a.hypot(b);
        let (low, high) = (least.max(base - swing), most.min(base + swing));
        if low > high + CLAMP * most {
            return;
        }
        found.singular = true;
        for q6 in line_on_circle(a, b, 0.5 * (low + high) - base, 1e-12 * most).iter().take(1) {
            wrists.push(shoulder, q5, *q6);
        }
    }
}

/// Merges the doubt about the angles of q5 for one value of q1.
#[inline(always)]
fn add_doubt(q5: &Angles<2>, found: &mut Candidates) {
    if q5.near_miss {
        found.doubt.add_dead_end();
    }
    found.doubt.add(q5.doubt);
}

impl Wrists {
    const NONE: Self = Self {
        x: [F64x4::ZERO; 3],
        y: [F64x4::ZERO; 3],
        offset: [F64x4::ZERO; 2],
        turns: [[F64x4::ZERO; 2]; 3],
        count: 0,
    };

    /// Adds a wrist; the capacity is four.
    #[inline(always)]
    fn push(&mut self, shoulder: &Shoulder, q5: Angle, q6: Angle) {
        let Shoulder { q1, axes: [x, y, _], offset } = shoulder;
        let lane = self.count;
        for k in 0..3 {
            self.x[k].0[lane] = x[k];
            self.y[k].0[lane] = y[k];
        }
        (self.offset[0].0[lane], self.offset[1].0[lane]) = (offset[0], offset[1]);
        for (lanes, turn) in self.turns.iter_mut().zip([*q1, q5, q6]) {
            (lanes[0].0[lane], lanes[1].0[lane]) = (turn.cos, turn.sin);
        }
        self.count += 1;
    }
}

/// At most two values of q3 in each of four lanes.
#[derive(Debug, Clone, Copy)]
struct Bends<R> {
    q3: [FourAngles<R>; 2],
    /// Number of valid values in each lane.
    counts: [usize; 4],
    doubt: Doubt,
    /// True if a lane has no value, but a small change of the input would give one.
    near_miss: bool,
}

impl Elbow {
    /// Prepares the elbow equation from the links in the plane perpendicular to the axes; `sense` is the sign of axis 3.
    fn new(links: &[[f64; 2]; 2], sense: f64, floor: f64) -> Self {
        let [[ax, ay], [bx, by]] = *links;
        let squares = [ax * ax + ay * ay, bx * bx + by * by];
        Self { a: ax * bx + ay * by, b: sense * (ay * bx - ax * by), squares, floor: floor * squares[0].sqrt() }
    }

    /// Returns the values of q3 at which the two links reach the point `reached`, as in [`line_on_circle`], for the first
    /// `count` lanes.
    #[inline(always)]
    fn bends<R: Real>(&self, reached: &[R; 2], count: usize) -> Bends<R> {
        let Self { a, b, squares, floor } = *self;
        let [rx, ry] = *reached;
        let c = R::splat(0.5) * (rx * rx + ry * ry - R::splat(squares[0]) - R::splat(squares[1]));
        let square = a * a + b * b;
        let (radius, inverse) = (R::splat(square.sqrt()), R::splat(1.0 / square));
        let radicand = (radius - c) * (radius + c);
        let root = radicand.larger(R::splat(0.0)).sqrt();
        let (ac, bc, to_a, to_b) = (R::splat(a) * c, R::splat(b) * c, R::splat(a) * root, R::splat(b) * root);
        let first = FourAngles { cos: (ac - to_b) * inverse, sin: (bc + to_a) * inverse };
        let second = FourAngles { cos: (ac + to_b) * inverse, sin: (bc - to_a) * inverse };
        let mut bends = Bends { q3: [first, second], counts: [2; 4], doubt: Doubt::None, near_miss: false };
        for lane in 0..count {
            // Fallback if the links are nearly in line or one has no length, or on NaN.
            if !(radicand.lane(lane) > NEARLY_DOUBLE * square) || square <= floor * floor {
                let turns = line_on_circle(a, b, c.lane(lane), floor);
                bends.counts[lane] = turns.len();
                bends.doubt.add(turns.doubt);
                bends.near_miss |= turns.near_miss;
                for (q3, turn) in bends.q3.iter_mut().zip(turns.iter()) {
                    *q3 = q3.with_lane(lane, *turn);
                }
            }
        }
        bends
    }
}
