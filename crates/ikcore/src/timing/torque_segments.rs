//! The limits of joint torques over the segments of a grid, in the plane of x = (ds/dt)^2 and u = d2s/dt2.
//!
//! Along a path the torque of a joint is a(s) u + b(s) x + g(s), where x grows by 2 u s. Over a segment a, b and g are parabolas up to rests; so the
//! torque is a cubic, and bounds on its four Bernstein coefficients bound it at every point.

use std::collections::HashMap;
use std::rc::Rc;

use super::bounding_line::{Line, NEGLIGIBLE_SLOPE};
use super::constant_limits::ConstantLimits;
use super::grid::Segment;
use super::joint_path::JointPath;
use crate::constraint::{
    BendScratch, Drag, JointTorques, Rest, TIGHT, TooHeavy, TorquePoint, TorqueTerms, control_points,
};
use crate::error::{Error, Result};
use crate::interrupt::checkpoint_at;
use crate::math::majorant::Majorant;
use crate::trajectory::{derivative_bounds, polynomial};
use crate::wording::number;

/// A segment is halved until the rests are at most this part of a limit: so small that a finer grid, on which they are smaller, saves no time by them.
const NEGLIGIBLE: f64 = 3e-4;

/// Most halvings of a segment: for small rests, and where a joint can hardly hold the arm.
const DEEP: usize = 5;
const DEEPEST: usize = 12;

/// A half-plane a u + b x <= c, with positive c.
type HalfPlane = [f64; 3];

/// Torques over a part of a segment.
#[derive(Debug)]
struct Part {
    /// Start and length, in the parameter since the start of the segment.
    from: f64,
    length: f64,
    /// At the start, in the middle and at the end.
    terms: [TorqueTerms; 3],
    /// By joint.
    rests: Vec<Rest>,
    /// Friction against positive and against negative torques, by joint.
    drags: Vec<[Drag; 2]>,
}

/// Bounds on u over a segment where x grows by 2 u from its start on.
#[derive(Debug)]
pub(super) struct TorqueBounds {
    /// From above and from below.
    pub lines: [Vec<Line>; 2],
    /// The bound on x from half-planes that do not bound u.
    pub largest_x: f64,
}

/// Segments that were met before, by piece, start, length and largest x: a grid that is refined keeps most of them.
pub(super) type KnownTorques = HashMap<(usize, [u64; 3]), Rc<TorqueBounds>>;

/// A part that is not finished: its ends, and the terms there.
struct Open {
    ends: [f64; 2],
    terms: [TorqueTerms; 2],
    halvings: usize,
}

/// Path, limits and scratch memory.
struct Builder<'a> {
    path: &'a JointPath,
    limits: &'a ConstantLimits,
    torques: &'a JointTorques,
    point: TorquePoint,
    bend: BendScratch,
    /// Where the last segment ends, in a piece, and the terms there.
    last: Option<(usize, f64, TorqueTerms)>,
}

/// Returns the bounds by joint torques over these segments of `path`, at whose ends x is at most that of `curve`; none without limits.
///
/// # Errors
/// [`Error::Infeasible`] where a joint cannot hold the arm; [`Error::Interrupted`].
pub(super) fn torque_bounds(
    path: &JointPath,
    segments: &[Segment],
    curve: &[f64],
    limits: &ConstantLimits,
    known: &mut KnownTorques,
) -> Result<Vec<Rc<TorqueBounds>>> {
    let Some(torques) = &limits.torques else { return Ok(vec![]) };
    let (point, bend) = (torques.point(), torques.bend_scratch());
    let mut builder = Builder { path, limits, torques, point, bend, last: None };
    let mut all = Vec::with_capacity(segments.len());
    for (i, segment) in segments.iter().enumerate() {
        checkpoint_at(i)?;
        let largest_x = curve[i].max(curve[i + 1]);
        let key = (segment.piece, [segment.from, segment.length, largest_x].map(f64::to_bits));
        let bounds = match known.get(&key) {
            Some(bounds) => Rc::clone(bounds),
            None => {
                let bounds = Rc::new(builder.bounds(segment, largest_x)?);
                known.insert(key, Rc::clone(&bounds));
                bounds
            }
        };
        all.push(bounds);
    }
    Ok(all)
}

impl TorqueBounds {
    /// Bounds inside these half-planes. Those that hold for all u and x up to these are left out.
    fn new(half_planes: impl Iterator<Item = HalfPlane>, [largest_u, largest_x]: [f64; 2]) -> Self {
        let binds = |[a, b, c]: &HalfPlane| !(a.abs() * largest_u + b.max(0.0) * largest_x <= *c);
        let binding: Vec<HalfPlane> = half_planes.filter(binds).collect();
        let steepest = binding.iter().fold(0.0_f64, |largest, [a, ..]| largest.max(a.abs()));
        let mut bounds = Self { lines: [vec![], vec![]], largest_x: f64::INFINITY };
        for [a, b, c] in binding {
            if a.abs() <= NEGLIGIBLE_SLOPE * steepest {
                bounds.largest_x = bounds.largest_x.min(if b > 0.0 { c / b } else { f64::INFINITY });
            } else {
                bounds.lines[usize::from(a < 0.0)].push(Line { offset: c / a, slope: b / a });
            }
        }
        bounds
    }
}

impl Part {
    /// The half-planes in which a joint keeps its limit.
    fn half_planes(&self, joint: usize, limit: f64) -> impl Iterator<Item = HalfPlane> + use<> {
        let of =
            |term: fn(&TorqueTerms) -> &[f64]| control_points(self.terms.each_ref().map(|terms| term(terms)[joint]));
        let [a, b, g] = [of(|terms| &terms.of_change), of(|terms| &terms.of_square), of(|terms| &terms.hold)];
        let [rest_a, rest_b, rest_g] = self.rests[joint];
        let to = self.from + self.length;
        // x(s) = x + 2 u s, and s times a parabola is a cubic.
        let (a, b, g, slope) = (raised(a), raised(b), raised(g), times_parameter(b, [self.from, to]));
        let rest_a = rest_a + 2.0 * to * rest_b;
        let drags = self.drags[joint];
        // Friction counts (ds/dt)^2 = x + 2 u s as x and as u.
        (0..4).flat_map(move |i| {
            let (a, b, g) = (a[i] + 2.0 * slope[i], b[i], g[i]);
            [1.0, -1.0].into_iter().zip(drags).flat_map(move |(side, drag)| {
                let c = limit - side * g - rest_g - drag.at_rest;
                let rest_a = rest_a + 2.0 * to * drag.per_square;
                [rest_a, -rest_a].map(|rest| [side * a + rest, side * b + rest_b + drag.per_square, c])
            })
        })
    }
}

impl Builder<'_> {
    fn bounds(&mut self, segment: &Segment, largest_x: f64) -> Result<TorqueBounds> {
        let start = match self.last.take() {
            Some((piece, from, terms)) if piece == segment.piece && from == segment.from => terms,
            _ => self.terms(segment, 0.0)?,
        };
        let end = self.terms(segment, segment.length)?;
        self.last = Some((segment.piece, segment.from + segment.length, end.clone()));
        let terms = [start, end];
        let most = [self.largest_u(segment, largest_x), largest_x];
        let mut parts = Vec::with_capacity(1);
        self.push(segment, most, Open { ends: [0.0, segment.length], terms, halvings: 0 }, &mut parts)?;
        let limited = self.torques.limits().iter().enumerate().filter(|(_, limit)| limit.is_finite());
        let half_planes = limited.flat_map(|(joint, limit)| {
            parts.iter().flat_map(move |part| part.half_planes(joint, limit * (1.0 - TIGHT)))
        });
        Ok(TorqueBounds::new(half_planes, most))
    }

    /// A bound of u by the acceleration limits at the start of a segment: |q' u + q'' x| is at most the acceleration.
    fn largest_u(&self, segment: &Segment, largest_x: f64) -> f64 {
        let of_joint = |joint: usize| {
            let [_, first, second] = self.path.joint_at(segment.piece, segment.from, joint);
            (self.limits.acceleration[joint] + second.abs() * largest_x) / first.abs()
        };
        (0..self.torques.dof()).map(of_joint).filter(|u| !u.is_nan()).fold(f64::INFINITY, f64::min)
    }

    fn push(&mut self, segment: &Segment, fastest: [f64; 2], open: Open, parts: &mut Vec<Part>) -> Result<()> {
        let Open { ends: [from, to], terms: [start, end], halvings } = open;
        let half = from + 0.5 * (to - from);
        let middle = self.terms(segment, half)?;
        let rests = self.rests(segment, [from, to]);
        let (mut holds, mut is_tight) = (true, true);
        for (joint, limit) in self.torques.limits().iter().enumerate().filter(|(_, limit)| limit.is_finite()) {
            let hold = control_points([&start, &middle, &end].map(|terms| terms.hold[joint]));
            let largest = hold.into_iter().fold(0.0_f64, |largest, hold| largest.max(hold.abs()));
            let [of_change, of_square, of_hold] = rests[joint];
            holds &= largest + of_hold + self.torques.friction(joint).dry < limit * (1.0 - 2.0 * TIGHT);
            let rest = of_change * fastest[0] + of_square * fastest[1] + of_hold;
            is_tight &= !(rest > NEGLIGIBLE * limit);
        }
        if holds && (is_tight || halvings >= DEEP) {
            let drags = self.drags(segment, [from, to], fastest[1], ([&start, &middle, &end], &rests));
            parts.push(Part { from, length: to - from, terms: [start, middle, end], rests, drags });
            return Ok(());
        }
        if halvings == DEEPEST {
            return Err(self.too_heavy(segment, from, None));
        }
        let halvings = halvings + 1;
        self.push(segment, fastest, Open { ends: [from, half], terms: [start, middle.clone()], halvings }, parts)?;
        self.push(segment, fastest, Open { ends: [half, to], terms: [middle, end], halvings }, parts)
    }

    /// The terms at a point of a segment.
    fn terms(&mut self, segment: &Segment, at: f64) -> Result<TorqueTerms> {
        let Self { path, torques, point, .. } = self;
        for joint in 0..torques.dof() {
            [point.q[joint], point.first[joint], point.second[joint]] =
                path.joint_at(segment.piece, segment.from + at, joint);
        }
        let mut terms = torques.terms();
        torques.write_terms(point, &mut terms);
        match torques.beyond(&terms.hold) {
            None => Ok(terms),
            Some(found) => Err(self.too_heavy(segment, at, Some(found))),
        }
    }

    /// The rests over a part of a segment.
    fn rests(&mut self, segment: &Segment, [from, to]: [f64; 2]) -> Vec<Rest> {
        let Self { path, torques, bend, .. } = self;
        let half = 0.5 * (to - from);
        // The polynomial of a joint on [-1, 1].
        let cubic = |joint: usize| {
            let [c0, c1, c2] = path.joint_at(segment.piece, segment.from + from + half, joint);
            [c0, half * c1, 0.5 * half * half * c2, half.powi(3) * path.powers(segment.piece)[3][joint]]
        };
        let rates = |joint: usize| Majorant::of(derivative_bounds::<3>(&polynomial(cubic(joint))));
        let farthest = |joint: usize| cubic(joint).iter().map(|c| c.abs()).sum();
        let mut rests = vec![[0.0; 3]; torques.dof()];
        torques.rests(rates, farthest, bend, &mut rests);
        // Derivatives by s, not by x.
        rests.iter().map(|[a, b, g]| [a / half, b / (half * half), *g]).collect()
    }

    /// Friction over a part of a segment on which (ds/dt)^2 is at most `square`.
    fn drags(
        &self,
        segment: &Segment,
        [from, to]: [f64; 2],
        square: f64,
        (terms, rests): ([&TorqueTerms; 3], &[Rest]),
    ) -> Vec<[Drag; 2]> {
        let half = 0.5 * (to - from);
        let of_joint = |(joint, limit): (usize, &f64)| {
            let [_, first, second] = self.path.joint_at(segment.piece, segment.from + from + half, joint);
            let third = 6.0 * self.path.powers(segment.piece)[3][joint];
            let most = (half * second).abs() + (0.5 * half * half * third).abs();
            let hold = control_points(terms.map(|terms| terms.hold[joint]));
            let largest = hold.into_iter().fold(0.0_f64, |largest, hold| largest.max(hold.abs()));
            let friction = self.torques.friction(joint);
            let room = limit - largest - rests[joint][2];
            [first + most, most - first].map(|rate| friction.drag(rate, room, square))
        };
        self.torques.limits().iter().enumerate().map(of_joint).collect()
    }

    fn too_heavy(&self, segment: &Segment, at: f64, found: Option<TooHeavy>) -> Error {
        let s = number(self.path.breaks()[segment.piece] + segment.from + at);
        let Some(TooHeavy { joint, torque, limit }) = found else {
            let problem =
                format!("at s = {s} of the path a joint can hardly hold the arm, or not move it against its friction");
            return Error::Infeasible { problem: problem.into() };
        };
        let [torque, limit] = [torque.abs(), limit].map(number);
        let unit = self.limits.torque_unit(joint);
        let name = self.limits.joint_name(joint);
        let problem = format!(
            "at s = {s} of the path joint '{name}' needs {torque} {unit} to hold the arm, its limit is {limit} {unit}"
        );
        Error::Infeasible { problem: problem.into() }
    }
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
