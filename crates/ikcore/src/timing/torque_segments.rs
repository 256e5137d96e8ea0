//! The limits of joint torques over the segments of a grid, in the plane of x = (ds/dt)^2 and u = d2s/dt2.
//!
//! A grid that refines another uses what is known of it: the terms at its points, bounds that are none, and rests.

use smallvec::SmallVec;

use super::constant_limits::ConstantLimits;
use super::derivatives::PathDerivatives;
use super::grid::Segment;
use super::joint_path::JointPath;
use super::torque_bounds::{HalfPlane, KeptTorque, TorqueBounds, largest_terms};
use super::torque_nodes::{Node, NodePlace, TorqueNodes};
use crate::constraint::{ALL_FACTORS, BendScratch, Drag, Friction, JointTorques, Rest, TIGHT, TooHeavy};
use crate::error::{Error, Result};
use crate::interrupt::checkpoint_at;
use crate::math::majorant::Majorant;
use crate::wording::number;

/// Remainder, as a fraction of a limit, down to which segments of a fixed grid are halved; on a refined grid it shrinks by itself.
const NEGLIGIBLE: f64 = 3e-4;

/// Maximum number of halvings of a segment for a small remainder.
const DEEP: usize = 5;
/// Maximum number of halvings of a segment where a joint can hardly hold the arm.
const DEEPEST: usize = 12;

/// Number of consecutive segments that share their remainders.
const RUN: usize = 4;

/// Factor on the range of u and x in which bounds hold, so that parts of a segment can reuse them.
const ROOM: f64 = 1.25;

/// Torques over one segment.
#[derive(Debug)]
struct SegmentTorques {
    segment: Segment,
    bounds: TorqueBounds,
    /// Largest u and x for which the bounds hold.
    most: [f64; 2],
    /// At the start, in the middle and at the end.
    nodes: [Node; 3],
    /// Where the rests over a part of unit length are.
    rests: RestsAt,
}

/// Index of the first joint's rests.
type RestsAt = usize;

/// Torques over the segments of a grid, and of grids that refine it.
#[derive(Debug)]
pub(super) struct TorqueSegments<'a> {
    path: &'a JointPath,
    limits: &'a ConstantLimits,
    torques: &'a JointTorques,
    /// Remainder, as a fraction of a limit, down to which a segment is halved.
    negligible: f64,
    limited: Vec<LimitedJoint>,
    nodes: TorqueNodes<'a>,
    derivatives: PathDerivatives,
    bend: BendScratch,
    /// Remainders over parts of unit length, by joint, for all runs of segments so far.
    rests: Vec<Rest>,
    /// Torques over all segments so far.
    known: Vec<SegmentTorques>,
    /// Segments of the last grid, by index; one without bounds may represent several.
    last: Vec<usize>,
}

/// A joint with a limit.
#[derive(Debug, Clone, Copy)]
struct LimitedJoint {
    joint: usize,
    limit: f64,
    friction: Friction,
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
        let Segment { piece, from, length, .. } = self.segment;
        (piece, from + length) < (other.piece, other.from + 0.5 * other.length)
    }

    /// Whether this is all that is needed of a segment inside this one, up to these u and x.
    fn serve(&self, segment: &Segment, most: [f64; 2]) -> bool {
        let is_within = most[0] <= self.most[0] && most[1] <= self.most[1];
        is_within && (self.segment == *segment || self.bounds.are_none())
    }

    /// The node at a place in a piece, if there is one.
    fn node(&self, (piece, s): NodePlace) -> Option<Node> {
        let Segment { from, length, .. } = self.segment;
        let k = [0.0, 0.5, 1.0].iter().position(|part| from + part * length == s && piece == self.segment.piece)?;
        Some(self.nodes[k])
    }
}

impl<'a> TorqueSegments<'a> {
    /// The torques along `path` on grids that are refined, or on one that is not; `None` without limits.
    pub(super) fn new(path: &'a JointPath, limits: &'a ConstantLimits, is_refined: bool) -> Option<Self> {
        let torques = limits.torques.as_ref()?;
        let negligible = if is_refined { f64::INFINITY } else { NEGLIGIBLE };
        let limits_of = torques.limits().iter().enumerate().filter(|(_, limit)| limit.is_finite());
        let limited =
            limits_of.map(|(joint, &limit)| LimitedJoint { joint, limit, friction: torques.friction(joint) }).collect();
        let (nodes, bend) = (TorqueNodes::new(path, torques), torques.bend_scratch());
        let derivatives = PathDerivatives::new(torques.dof());
        let (rests, known, last) = (vec![], vec![], vec![]);
        Some(Self { path, limits, torques, negligible, limited, nodes, derivatives, bend, rests, known, last })
    }

    /// Returns the bounds over these segments, at whose ends x is at most that of `curve`.
    ///
    /// # Errors
    /// [`Error::Infeasible`] where a joint cannot hold the arm; [`Error::Interrupted`].
    pub(super) fn over(&mut self, segments: &[Segment], curve: &[f64]) -> Result<Vec<&TorqueBounds>> {
        let first_new = self.known.len();
        self.enter(segments, curve)?;
        self.find_nodes()?;
        let mut half_planes = vec![];
        for index in first_new..self.known.len() {
            checkpoint_at(index)?;
            let SegmentTorques { segment, most, nodes, rests, .. } = self.known[index];
            let whole = Part { ends: [0.0, segment.length], nodes, halvings: 0 };
            half_planes.clear();
            self.push((&segment, most, rests), whole, &mut half_planes)?;
            self.known[index].bounds = TorqueBounds::new(&half_planes);
        }
        Ok(self.last.iter().map(|index| &self.known[*index].bounds).collect())
    }

    /// Takes these segments as the last grid: known ones where they serve, and new ones, without bounds so far.
    fn enter(&mut self, segments: &[Segment], curve: &[f64]) -> Result<()> {
        let coarse = std::mem::take(&mut self.last);
        self.known.reserve(segments.len());
        self.last.reserve(segments.len());
        let (mut k, mut run) = (0, None);
        for (i, (segment, curve)) in segments.iter().zip(curve.windows(2)).enumerate() {
            checkpoint_at(i)?;
            while coarse.get(k).is_some_and(|coarse| self.known[*coarse].is_before(segment)) {
                k += 1;
            }
            let largest_x = curve[0].max(curve[1]);
            let most = [self.largest_u(segment, largest_x), largest_x];
            let coarse = coarse.get(k).copied();
            if let Some(known) = coarse.filter(|coarse| self.known[*coarse].serve(segment, most)) {
                self.last.push(known);
                continue;
            }
            let rests = match (coarse, run) {
                (Some(coarse), _) => self.known[coarse].rests,
                (None, Some((rests, end))) if i < end => rests,
                (None, _) => {
                    let end = segments.len().min(i + RUN);
                    let rests = self.add_rests(&segments[i..end]);
                    run = Some((rests, end));
                    rests
                }
            };
            let nodes = self.nodes_of(segment, [coarse, self.last.last().copied()]);
            let most = most.map(|most| ROOM * most);
            self.last.push(self.known.len());
            self.known.push(SegmentTorques { segment: *segment, bounds: TorqueBounds::NONE, most, nodes, rests });
        }
        Ok(())
    }

    /// Returns bounds over the segments of the last grid that keep torques on average.
    pub(super) fn averages(&self) -> Vec<TorqueBounds> {
        self.last.iter().map(|index| self.average(&self.known[*index])).collect()
    }

    fn average(&self, SegmentTorques { segment, bounds, most, nodes, .. }: &SegmentTorques) -> TorqueBounds {
        let mut half_planes = vec![];
        if !bounds.are_none() {
            let terms = nodes.map(|node| self.nodes.terms(node));
            let whole = Part { ends: [0.0, segment.length], nodes: *nodes, halvings: 0 };
            for limited @ &LimitedJoint { joint, limit, .. } in &self.limited {
                let largest = largest_terms(terms, joint);
                let drags = self.drags(segment, whole, (limited, limit - largest[0]), most[1]);
                let kept = KeptTorque { ends: whole.ends, limit, rest: [0.0; 3], drags };
                if kept.can_bind(largest, *most) {
                    kept.push_average(terms, joint, &mut half_planes);
                }
            }
        }
        TorqueBounds::new(&half_planes)
    }

    /// Returns the nodes of a segment: known ones of that which contains it and of the one before, and new ones.
    fn nodes_of(&mut self, segment: &Segment, [coarse, before]: [Option<usize>; 2]) -> [Node; 3] {
        let [coarse, before] = [coarse, before].map(|index| index.map(|index| &self.known[index]));
        let joined = before.filter(|before| segment.from == 0.0 && before.segment.piece + 1 == segment.piece);
        let start =
            joined.filter(|before| self.path.continues_after(before.segment.piece)).map(|before| before.nodes[2]);
        [0.0, 0.5, 1.0].map(|part| {
            let place = (segment.piece, segment.from + part * segment.length);
            let known = [coarse, before].into_iter().flatten().find_map(|known| known.node(place));
            let known = known.or(start.filter(|_| part == 0.0));
            known.unwrap_or_else(|| self.nodes.ask(place))
        })
    }

    fn find_nodes(&mut self) -> Result<()> {
        self.nodes.find().map_err(|(place, found)| self.too_heavy(place, Some(found)))
    }

    /// A bound of u by the acceleration limits at the start of a segment: |q' u + q'' x| is at most the acceleration.
    fn largest_u(&self, segment: &Segment, largest_x: f64) -> f64 {
        let n = self.torques.dof();
        let [_, c1, c2, c3] = self.path.powers(segment.piece).map(|power| &power[..n]);
        let (from, acceleration) = (segment.from, &self.limits.acceleration[..n]);
        let of_joint = |joint: usize| {
            let first = c1[joint] + from * (2.0 * c2[joint] + from * 3.0 * c3[joint]);
            let second = 2.0 * c2[joint] + 6.0 * from * c3[joint];
            (acceleration[joint] + second.abs() * largest_x) / first.abs()
        };
        // The minimum passes over what is not a number.
        (0..n).map(of_joint).fold(f64::INFINITY, f64::min)
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
        let terms = nodes.map(|node| self.nodes.terms(node));
        let (mut holds, mut is_tight) = (true, true);
        let mut near = SmallVec::<[(usize, KeptTorque); 2]>::new();
        for limited @ &LimitedJoint { joint, limit, friction } in &self.limited {
            let rest = rest_of(joint);
            let [of_hold, of_square, of_change] = rest;
            let largest = largest_terms(terms, joint);
            holds &= largest[0] + of_hold + friction.dry < limit * (1.0 - 2.0 * TIGHT);
            is_tight &= !(of_change * most[0] + of_square * most[1] + of_hold > self.negligible * limit);
            let drags = self.drags(segment, part, (limited, limit - of_hold - largest[0]), most[1]);
            let kept = KeptTorque { ends: [from, to], limit: limit * (1.0 - TIGHT), rest, drags };
            // Few joints come near their limits.
            if kept.can_bind(largest, most) {
                near.push((joint, kept));
            }
        }
        if holds && (is_tight || halvings >= DEEP) {
            near.iter().for_each(|(joint, kept)| kept.push(terms, *joint, most, half_planes));
            return Ok(());
        }
        if halvings == DEEPEST {
            return Err(self.too_heavy((segment.piece, segment.from + from), None));
        }
        let halvings = halvings + 1;
        let half = 0.5 * (to - from);
        let middles = [0.5, 1.5].map(|halves| self.nodes.ask((segment.piece, segment.from + from + halves * half)));
        self.find_nodes()?;
        for (ends, [start, middle, end]) in [
            ([from, from + half], [nodes[0], middles[0], nodes[1]]),
            ([from + half, to], [nodes[1], middles[1], nodes[2]]),
        ] {
            self.push((segment, most, rests), Part { ends, nodes: [start, middle, end], halvings }, half_planes)?;
        }
        Ok(())
    }

    /// Adds the rests over parts of unit length of these segments.
    fn add_rests(&mut self, segments: &[Segment]) -> RestsAt {
        let Self { path, torques, derivatives, bend, rests, .. } = self;
        let n = torques.dof();
        // Bounds of the positions, and of the Taylor coefficients of their derivatives.
        let mut bounds = vec![[0.0_f64; 4]; n];
        for segment in segments {
            derivatives.fill(path, segment);
            let ([d0, d1, d2], [e0, e1]) = (&derivatives.first, &derivatives.second);
            let [c0, c1, c2, c3] = path.powers(segment.piece);
            for (joint, [q, first, second, third]) in bounds.iter_mut().enumerate() {
                let largest = d0[joint].abs().max(d1[joint].abs()).max(d2[joint].abs());
                let start =
                    c0[joint] + segment.from * (c1[joint] + segment.from * (c2[joint] + segment.from * c3[joint]));
                *q = q.max(start.abs() + segment.length * largest);
                *first = first.max(largest);
                *second = second.max(e0[joint].abs()).max(e1[joint].abs());
                *third = third.max(3.0 * c3[joint].abs());
            }
        }
        let first = rests.len();
        rests.resize(first + n, [0.0; 3]);
        let rests = &mut rests[first..];
        let rates = |joint: usize| Majorant::of([bounds[joint][1], bounds[joint][2], bounds[joint][3]]);
        torques.rests::<ALL_FACTORS>(rates, |joint| bounds[joint][0], bend, rests);
        // Over \[-1, 1\], which is twice as long.
        rests.iter_mut().for_each(|rest| *rest = rest.map(|rest| 0.125 * rest));
        first
    }

    /// Friction of a joint over a part of a segment against positive and against negative torques, where (ds/dt)^2 is at most `square` and
    /// the torque that holds it up leaves this `room`.
    #[inline]
    fn drags(&self, segment: &Segment, part: Part, (of, room): (&LimitedJoint, f64), square: f64) -> [Drag; 2] {
        let friction = of.friction;
        if friction.damping == 0.0 {
            return [Drag { at_rest: friction.dry, per_square: 0.0 }; 2];
        }
        self.viscous_drags(segment, part, (of, room), square)
    }

    /// [`drags`](Self::drags) of a joint with viscous friction.
    fn viscous_drags(&self, segment: &Segment, part: Part, (of, room): (&LimitedJoint, f64), square: f64) -> [Drag; 2] {
        let LimitedJoint { joint, friction, .. } = *of;
        let half = 0.5 * (part.ends[1] - part.ends[0]);
        let [_, first, second] = self.path.joint_at(segment.piece, segment.from + part.ends[0] + half, joint);
        let third = 6.0 * self.path.powers(segment.piece)[3][joint];
        let most = (half * second).abs() + (0.5 * half * half * third).abs();
        [first + most, most - first].map(|rate| friction.drag(rate, room, square))
    }

    fn too_heavy(&self, (piece, from): NodePlace, found: Option<TooHeavy>) -> Error {
        let s = number(self.path.breaks()[piece] + from);
        let problem = match found {
            Some(found) => self.limits.heavy_in_words(found),
            None => "a joint can hardly hold the arm, or not move it against its friction".into(),
        };
        Error::Infeasible { problem: format!("at s = {s} of the path {problem}").into() }
    }
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
    fn a_motion_takes_hardly_longer_than_on_a_fine_grid() {
        let robot = heavy();
        let mut rng = rng::stream(8, 0);
        let limits = limits(&robot, &MOTORS.map(|torque| 1.5 * torque), None);
        let mut timed = 0;
        for _ in 0..12 {
            let path = path(&robot, &mut rng);
            let Ok(motion) = time_optimal(&path, &limits, &TimingOptions::default()) else { continue };
            let fine = TimingOptions { gridpoints: Some(20_000), ..TimingOptions::default() };
            let least = time_optimal(&path, &limits, &fine).unwrap().duration();
            let ratio = motion.duration() / least;
            assert!((1.0 - 1e-9..1.003).contains(&ratio), "{ratio}");
            timed += 1;
        }
        assert!(timed > 4, "{timed}");
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
