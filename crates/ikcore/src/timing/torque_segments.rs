//! The limits of joint torques over the segments of a grid, in the plane of x = (ds/dt)^2 and u = d2s/dt2.
//!
//! Along a path the torque of a joint is a(s) u + b(s) x + g(s), where x grows by 2 u s. Over a segment a, b and g are parabolas up to rests; so the
//! torque is a cubic, and bounds on its four Bernstein coefficients bound it at every point.

use std::rc::Rc;

use super::bounding_line::{Line, NEGLIGIBLE_SLOPE};
use super::constant_limits::ConstantLimits;
use super::grid::Segment;
use super::joint_path::JointPath;
use crate::constraint::{
    ALL_FACTORS, BendScratch, Drag, JointTorques, Rest, TIGHT, TooHeavy, TorquePoint, TorqueTerms, control_points,
};
use crate::error::{Error, Result};
use crate::interrupt::checkpoint_at;
use crate::math::majorant::Majorant;
use crate::trajectory::{derivative_bounds, polynomial};
use crate::wording::number;

/// On a grid that stays as it is, a segment is halved until the rests are at most this part of a limit. On one that is refined they fall with it.
const NEGLIGIBLE: f64 = 3e-4;

/// Most halvings of a segment: for small rests, and where a joint can hardly hold the arm.
const DEEP: usize = 5;
const DEEPEST: usize = 12;

/// Bounds hold for u and x beyond what the segment allows by this factor, so that they serve its parts too.
const ROOM: f64 = 1.25;

/// A half-plane a u + b x <= c, with positive c.
type HalfPlane = [f64; 3];

/// Bounds on u over a segment where x grows by 2 u from its start on.
#[derive(Debug)]
pub(super) struct TorqueBounds {
    /// From above and from below.
    pub lines: [Vec<Line>; 2],
    /// The bound on x from half-planes that do not bound u.
    pub largest_x: f64,
}

/// Torques over one segment.
#[derive(Debug)]
pub(super) struct SegmentTorques {
    segment: Segment,
    pub bounds: TorqueBounds,
    /// Largest u and x for which the bounds hold.
    most: [f64; 2],
    /// At the start, in the middle and at the end.
    nodes: [Node; 3],
    /// Where the rests over a part of unit length are.
    rests: RestsAt,
}

/// A point whose terms are known: an index.
type Node = usize;

/// Index of the first joint's rests.
type RestsAt = usize;

/// Torques over the segments of a grid, and of grids that refine it.
#[derive(Debug)]
pub(super) struct TorqueSegments<'a> {
    path: &'a JointPath,
    limits: &'a ConstantLimits,
    torques: &'a JointTorques,
    /// The rests that are not worth halving a segment for, as a part of a limit.
    negligible: f64,
    point: TorquePoint,
    bend: BendScratch,
    /// Terms at all points so far.
    terms: Vec<TorqueTerms>,
    /// Rests over parts of unit length, by joint; those of all segments so far, one after the other.
    rests: Vec<Rest>,
    /// Those of the last grid; one without bounds may stand for several segments.
    last: Vec<Rc<SegmentTorques>>,
}

/// A part of a segment.
#[derive(Clone, Copy)]
struct Part {
    /// In the parameter since the start of the segment.
    ends: [f64; 2],
    nodes: [Node; 3],
    halvings: usize,
}

impl SegmentTorques {
    /// Whether the segment ends before the middle of `other`.
    fn is_before(&self, other: &Segment) -> bool {
        let Segment { piece, from, length } = self.segment;
        (piece, from + length) < (other.piece, other.from + 0.5 * other.length)
    }

    /// Whether this is all that is needed of a segment inside this one, up to these u and x.
    fn serve(&self, segment: &Segment, most: [f64; 2]) -> bool {
        let is_within = most[0] <= self.most[0] && most[1] <= self.most[1];
        is_within && (self.segment == *segment || self.bounds.are_none())
    }

    /// The node at a place in a piece, if there is one.
    fn node(&self, piece: usize, s: f64) -> Option<Node> {
        let Segment { from, length, .. } = self.segment;
        let places = [from, from + 0.5 * length, from + length];
        let k = places.iter().position(|place| *place == s && piece == self.segment.piece)?;
        Some(self.nodes[k])
    }
}

impl<'a> TorqueSegments<'a> {
    /// The torques along `path` on grids that are refined, or on one that is not; `None` without limits.
    pub(super) fn new(path: &'a JointPath, limits: &'a ConstantLimits, is_refined: bool) -> Option<Self> {
        let torques = limits.torques.as_ref()?;
        let negligible = if is_refined { f64::INFINITY } else { NEGLIGIBLE };
        let (point, bend) = (torques.point(), torques.bend_scratch());
        Some(Self { path, limits, torques, negligible, point, bend, terms: vec![], rests: vec![], last: vec![] })
    }

    /// Returns the torques over these segments, at whose ends x is at most that of `curve`.
    ///
    /// # Errors
    /// [`Error::Infeasible`] where a joint cannot hold the arm; [`Error::Interrupted`].
    pub(super) fn over(&mut self, segments: &[Segment], curve: &[f64]) -> Result<&[Rc<SegmentTorques>]> {
        let coarse = std::mem::take(&mut self.last);
        let mut all: Vec<Rc<SegmentTorques>> = Vec::with_capacity(segments.len());
        let mut k = 0;
        for (i, (segment, curve)) in segments.iter().zip(curve.windows(2)).enumerate() {
            checkpoint_at(i)?;
            while coarse.get(k).is_some_and(|coarse| coarse.is_before(segment)) {
                k += 1;
            }
            let largest_x = curve[0].max(curve[1]);
            let most = [self.largest_u(segment, largest_x), largest_x];
            all.push(match coarse.get(k) {
                Some(coarse) if coarse.serve(segment, most) => Rc::clone(coarse),
                coarse => Rc::new(self.of_segment(segment, most, [coarse, all.last()])?),
            });
        }
        self.last = all;
        Ok(&self.last)
    }

    /// The torques over a segment where u and x are at most `most`, by what is known of one that contains it and of the one before.
    fn of_segment(
        &mut self,
        segment: &Segment,
        most: [f64; 2],
        known: [Option<&Rc<SegmentTorques>>; 2],
    ) -> Result<SegmentTorques> {
        let mut node = |at: f64| {
            let same = known.iter().flatten().find_map(|known| known.node(segment.piece, segment.from + at));
            same.map_or_else(|| self.node_at(segment, at), Ok)
        };
        let nodes = [node(0.0)?, node(0.5 * segment.length)?, node(segment.length)?];
        let rests = known[0].map_or_else(|| self.add_rests(segment), |coarse| coarse.rests);
        let most = most.map(|most| ROOM * most);
        let whole = Part { ends: [0.0, segment.length], nodes, halvings: 0 };
        let mut half_planes = vec![];
        self.push((segment, most, rests), whole, &mut half_planes)?;
        Ok(SegmentTorques { segment: *segment, bounds: TorqueBounds::new(half_planes), most, nodes, rests })
    }

    /// A bound of u by the acceleration limits at the start of a segment: |q' u + q'' x| is at most the acceleration.
    fn largest_u(&self, segment: &Segment, largest_x: f64) -> f64 {
        let of_joint = |joint: usize| {
            let [_, first, second] = self.path.joint_at(segment.piece, segment.from, joint);
            (self.limits.acceleration[joint] + second.abs() * largest_x) / first.abs()
        };
        (0..self.torques.dof()).map(of_joint).filter(|u| !u.is_nan()).fold(f64::INFINITY, f64::min)
    }

    /// Adds the half-planes in which the torques over a part of a segment are kept while u and x are at most `most`.
    fn push(
        &mut self,
        (segment, most, rests): (&Segment, [f64; 2], RestsAt),
        part: Part,
        half_planes: &mut Vec<HalfPlane>,
    ) -> Result<()> {
        let Part { ends: [from, to], nodes, halvings } = part;
        // Rests grow with the third power of the length.
        let cube = (to - from).powi(3);
        let rest_of = |joint: usize| self.rests[rests + joint].map(|rest| rest * cube);
        let terms = nodes.map(|node| &self.terms[node]);
        let (mut holds, mut is_tight) = (true, true);
        for (joint, limit) in self.limited() {
            let [of_hold, of_square, of_change] = rest_of(joint);
            let largest = largest(terms.map(|terms| terms.hold[joint])) + of_hold;
            holds &= largest + self.torques.friction(joint).dry < limit * (1.0 - 2.0 * TIGHT);
            is_tight &= !(of_change * most[0] + of_square * most[1] + of_hold > self.negligible * limit);
        }
        if holds && (is_tight || halvings >= DEEP) {
            for (joint, limit) in self.limited() {
                let kept = KeptTorque {
                    ends: [from, to],
                    limit: limit * (1.0 - TIGHT),
                    rest: rest_of(joint),
                    drags: self.drags(segment, part, (joint, limit - rest_of(joint)[0]), most[1]),
                };
                kept.push(terms, joint, most, half_planes);
            }
            return Ok(());
        }
        if halvings == DEEPEST {
            return Err(self.too_heavy(segment, from, None));
        }
        let halvings = halvings + 1;
        let half = 0.5 * (to - from);
        for (ends, [start, end]) in
            [([from, from + half], [nodes[0], nodes[1]]), ([from + half, to], [nodes[1], nodes[2]])]
        {
            let middle = self.node_at(segment, ends[0] + 0.5 * half)?;
            self.push((segment, most, rests), Part { ends, nodes: [start, middle, end], halvings }, half_planes)?;
        }
        Ok(())
    }

    /// Joints with a limit, and their limits.
    fn limited(&self) -> impl Iterator<Item = (usize, f64)> + use<'a> {
        self.torques.limits().iter().copied().enumerate().filter(|(_, limit)| limit.is_finite())
    }

    /// A new node at a point of a segment.
    fn node_at(&mut self, segment: &Segment, at: f64) -> Result<Node> {
        let Self { path, torques, point, .. } = self;
        path.write(segment.piece, segment.from + at, [&mut point.q, &mut point.first, &mut point.second]);
        let node = self.terms.len();
        self.terms.push(torques.terms());
        torques.write_terms(point, &mut self.terms[node]);
        match torques.beyond(&self.terms[node].hold) {
            None => Ok(node),
            Some(found) => Err(self.too_heavy(segment, at, Some(found))),
        }
    }

    /// Adds the rests over a segment, divided by the third power of its length.
    fn add_rests(&mut self, segment: &Segment) -> RestsAt {
        let Self { path, torques, bend, rests, .. } = self;
        let half = 0.5 * segment.length;
        // The polynomial of a joint on [-1, 1].
        let cubic = |joint: usize| {
            let [c0, c1, c2] = path.joint_at(segment.piece, segment.from + half, joint);
            [c0, half * c1, 0.5 * half * half * c2, half.powi(3) * path.powers(segment.piece)[3][joint]]
        };
        let rates = |joint: usize| Majorant::of(derivative_bounds::<3>(&polynomial(cubic(joint))));
        let farthest = |joint: usize| cubic(joint).iter().map(|c| c.abs()).sum();
        let first = rests.len();
        rests.resize(first + torques.dof(), [0.0; 3]);
        let rests = &mut rests[first..];
        torques.rests::<ALL_FACTORS>(rates, farthest, bend, rests);
        let by_length = segment.length.powi(-3);
        // Derivatives by s, not by x.
        rests.iter_mut().for_each(|rest| {
            let [g, b, a] = *rest;
            *rest = [g, b / (half * half), a / half].map(|rest| rest * by_length);
        });
        first
    }

    /// Friction of a joint over a part of a segment against positive and against negative torques, where (ds/dt)^2 is at most `square` and
    /// the torque that holds it up may be as large as `limit`.
    fn drags(&self, segment: &Segment, part: Part, (joint, limit): (usize, f64), square: f64) -> [Drag; 2] {
        let friction = self.torques.friction(joint);
        if friction.damping == 0.0 {
            return [friction.drag(0.0, 0.0, 0.0); 2];
        }
        let half = 0.5 * (part.ends[1] - part.ends[0]);
        let [_, first, second] = self.path.joint_at(segment.piece, segment.from + part.ends[0] + half, joint);
        let third = 6.0 * self.path.powers(segment.piece)[3][joint];
        let most = (half * second).abs() + (0.5 * half * half * third).abs();
        let room = limit - largest(part.nodes.map(|node| self.terms[node].hold[joint]));
        [first + most, most - first].map(|rate| friction.drag(rate, room, square))
    }

    fn too_heavy(&self, segment: &Segment, at: f64, found: Option<TooHeavy>) -> Error {
        let s = number(self.path.breaks()[segment.piece] + segment.from + at);
        let problem = match found {
            Some(found) => self.limits.heavy_in_words(found),
            None => "a joint can hardly hold the arm, or not move it against its friction".into(),
        };
        Error::Infeasible { problem: format!("at s = {s} of the path {problem}").into() }
    }
}

impl TorqueBounds {
    /// Bounds inside these half-planes.
    fn new(half_planes: Vec<HalfPlane>) -> Self {
        let steepest = half_planes.iter().fold(0.0_f64, |largest, [a, ..]| largest.max(a.abs()));
        let mut bounds = Self { lines: [vec![], vec![]], largest_x: f64::INFINITY };
        for [a, b, c] in half_planes {
            if a.abs() <= NEGLIGIBLE_SLOPE * steepest {
                bounds.largest_x = bounds.largest_x.min(if b > 0.0 { c / b } else { f64::INFINITY });
            } else {
                bounds.lines[usize::from(a < 0.0)].push(Line { offset: c / a, slope: b / a });
            }
        }
        bounds
    }

    fn are_none(&self) -> bool {
        self.largest_x == f64::INFINITY && self.lines.iter().all(Vec::is_empty)
    }
}

/// The limit of a joint's torque over a part of a segment.
struct KeptTorque {
    ends: [f64; 2],
    limit: f64,
    rest: Rest,
    /// Friction against positive and against negative torques.
    drags: [Drag; 2],
}

impl KeptTorque {
    /// Adds the half-planes in which it is kept, but for those that hold for all u and x up to `most`.
    fn push(&self, nodes: [&TorqueTerms; 3], joint: usize, most: [f64; 2], half_planes: &mut Vec<HalfPlane>) {
        let Self { ends: [from, to], limit, rest: [rest_g, rest_b, rest_a], drags } = *self;
        // The most that it can be, quickly: few joints come near their limit.
        let friction = drags.map(|drag| drag.at_rest + drag.per_square * most[1]);
        let of_square = largest(nodes.map(|terms| terms.of_square[joint])) + rest_b;
        let of_change = largest(nodes.map(|terms| terms.of_change[joint])) + rest_a;
        let hold = largest(nodes.map(|terms| terms.hold[joint])) + rest_g;
        let viscous = drags.map(|drag| 2.0 * to * drag.per_square * most[0]);
        let inertial = of_change * most[0] + of_square * (most[1] + 2.0 * to * most[0]);
        if inertial + hold + friction[0].max(friction[1]) + viscous[0].max(viscous[1]) <= limit {
            return;
        }
        let a = control_points(nodes.map(|terms| terms.of_change[joint]));
        let b = control_points(nodes.map(|terms| terms.of_square[joint]));
        let g = control_points(nodes.map(|terms| terms.hold[joint]));
        // x(s) = x + 2 u s, and s times a parabola is a cubic.
        let (a, b, g, slope) = (raised(a), raised(b), raised(g), times_parameter(b, [from, to]));
        for i in 0..4 {
            let (a, b, g) = (a[i] + 2.0 * slope[i], b[i], g[i]);
            for (side, drag) in [1.0, -1.0].into_iter().zip(drags) {
                let c = limit - side * g - rest_g - drag.at_rest;
                // Friction counts (ds/dt)^2 = x + 2 u s as x and as u.
                let rest_a = rest_a + 2.0 * to * (rest_b + drag.per_square);
                let b = side * b + rest_b + drag.per_square;
                let both = [side * a + rest_a, side * a - rest_a];
                let binds = |a: &f64| !(a.abs() * most[0] + b.max(0.0) * most[1] <= c);
                half_planes.extend(both.into_iter().filter(binds).map(|a| [a, b, c]));
            }
        }
    }
}

/// The largest size of the parabola with these values at the start, in the middle and at the end.
fn largest(values: [f64; 3]) -> f64 {
    let [start, middle, end] = control_points(values).map(f64::abs);
    start.max(middle).max(end)
}

/// The Bernstein coefficients of a parabola as those of a cubic.
fn raised([start, middle, end]: [f64; 3]) -> [f64; 4] {
    [start, (start + 2.0 * middle) / 3.0, (2.0 * middle + end) / 3.0, end]
}

/// The Bernstein coefficients of a parabola times the parameter, from one value to another.
fn times_parameter([start, middle, end]: [f64; 3], [from, to]: [f64; 2]) -> [f64; 4] {
    [from * start, (2.0 * from * middle + to * start) / 3.0, (from * end + 2.0 * to * middle) / 3.0, to * end]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::{DynamicState, Inertia};
    use crate::limits::{Field, Limits, Profile};
    use crate::math::cubic_spline::SplineEnds;
    use crate::rng::{self, LazyRng};
    use crate::robot::Robot;
    use crate::timing::{TimingOptions, time_optimal};
    use crate::trajectory::Trajectory;

    /// A Panda whose links weigh a few kilograms each.
    fn heavy() -> Robot {
        let robot = Robot::named("panda").unwrap();
        let names: Vec<String> = robot.link_names().map(str::to_owned).collect();
        let inertia = |i: usize| Inertia {
            mass: 3.0 / (1.0 + 0.3 * i as f64),
            center: [0.01 * i as f64, -0.04, 0.05],
            matrix: [[0.03, 0.001, 0.0], [0.001, 0.025, 0.002], [0.0, 0.002, 0.012]],
        };
        robot.with_inertias(names.iter().enumerate().map(|(i, name)| (name.as_str(), inertia(i)))).unwrap()
    }

    const MOTORS: [f64; 7] = [50.0, 60.0, 40.0, 40.0, 8.0, 8.0, 4.0];

    fn limits(robot: &Robot, torque: &[f64], jerk: Option<f64>) -> ConstantLimits {
        let all = |value: f64| vec![Profile::Constant(value)];
        let mut limits = Limits::of(robot).replace(Field::Acceleration, all(20.0)).unwrap();
        if let Some(jerk) = jerk {
            limits = limits.replace(Field::Jerk, all(jerk)).unwrap();
        }
        let limits = limits.with_torque_limit(torque.to_vec()).unwrap();
        ConstantLimits::of_path(robot, &limits, "this test").unwrap()
    }

    fn path(robot: &Robot, rng: &mut LazyRng) -> JointPath {
        let names = robot.joints().iter().map(|joint| joint.name.clone()).collect();
        let mut rows = vec![];
        for _ in 0..5 {
            rows.extend(robot.joints().iter().map(|joint| rng.uniform_in(0.6 * joint.lower, 0.6 * joint.upper)));
        }
        JointPath::spline(names, &rows, None, SplineEnds::Natural).unwrap()
    }

    /// The largest part of a limit that the motion uses at many instants.
    fn largest_share(robot: &Robot, motion: &Trajectory, torque: &[f64]) -> f64 {
        let n = robot.dof();
        let [mut q, mut qd, mut qdd, mut torques] = [(); 4].map(|()| vec![0.0; n]);
        let dynamics = robot.dynamics().unwrap();
        let mut scratch = robot.dynamics_scratch(dynamics);
        let mut largest = 0.0_f64;
        for i in 0..=10_000 {
            motion.at(motion.duration() * f64::from(i) / 1e4, &mut q, &mut qd, &mut qdd).unwrap();
            let state = DynamicState { q: &q, qd: &qd, qdd: &qdd };
            robot.write_frames(&q, &mut scratch.frames);
            dynamics.inverse_without_friction(&state, &[], &mut scratch, &mut torques);
            for (torque, limit) in torques.iter().zip(torque) {
                largest = largest.max(torque.abs() / limit);
            }
        }
        largest
    }

    #[test]
    fn torques_are_kept_at_every_instant_and_reached() {
        let robot = heavy();
        let mut rng = rng::stream(7, 0);
        for (round, jerk) in [None, None, None, None, Some(500.0), Some(2000.0)].into_iter().enumerate() {
            let path = path(&robot, &mut rng);
            let free =
                time_optimal(&path, &limits(&robot, &[f64::INFINITY; 7], jerk), &TimingOptions::default()).unwrap();
            let limits = limits(&robot, &MOTORS, jerk);
            let motion = match time_optimal(&path, &limits, &TimingOptions::default()) {
                Ok(motion) => motion,
                Err(error) => {
                    assert!(error.to_string().contains("to hold the arm"), "{error}");
                    continue;
                }
            };
            let share = largest_share(&robot, &motion, &MOTORS);
            println!("{round}: {share}, {} of {}", motion.duration(), free.duration());
            assert!(share <= 1.0 + 1e-9, "{share}");
            assert!(share > 0.98 || motion.duration() < free.duration() * 1.01, "{share}");
            assert_eq!(limits.violations(&motion), []);
        }
    }
}
