//! Reachability test of a pose, at several azimuths at once.

use super::map_chunk::RingResult;
use super::map_grid::MapGrid;
use super::map_options::MapOptions;
use super::mapped_joint::MappedJoint;
use super::rings::Ring;
use crate::closed_form::{ArmBranches, FamilyLimits, PoseFamily};
use crate::error::{Error, Result};
use crate::ik::{Query, Solution, SolveContext, SolveOptions, solve_query};
use crate::kinematics::Reach;
use crate::manipulability::{Manipulability, Motion};
use crate::math::Frame;
use crate::robot::{Joint, Robot, UprightAxis};
use crate::solver::{Monitor, Status, Stop, Stopwatch};
use crate::task::{Target, Tolerance};

/// Evaluation budget of a descent from a nearby solution.
const DESCENT: usize = 40;

/// Largest number of solutions of an orientation that are kept as starts for others.
const KEPT: usize = 4;

/// Parameter values of a redundant arm before testing whether the limits exclude all: most poses have a solution earlier.
const VALUES_BEFORE_DOUBT: usize = 16;

/// Reachability test of the poses of a map. Shared by all threads.
pub(crate) struct MapTest<'a> {
    pub(super) grid: &'a MapGrid,
    /// Solve context with the limits of the robot.
    own: SolveContext<'a>,
    /// Solve context with the first joint free to turn, if azimuths are equivalent.
    pub(super) turning: Option<(UprightAxis, SolveContext<'a>)>,
    method: Method,
    reach: Reach,
    pub(super) ranges: Vec<MappedJoint>,
    options: &'a MapOptions,
    measure: Manipulability,
}

/// Method of finding solutions.
enum Method {
    /// Closed form with all branches.
    Branches,
    /// Closed form at parameter values of a redundant arm, within these limits.
    Family(Box<FamilyLimits>),
    /// Numerical search.
    Search,
}

/// Robots of a [`MapTest`], and the options of their solves.
pub(crate) struct MapRobots {
    pub(super) own: Robot,
    pub(super) turning: Option<(UprightAxis, Robot)>,
    each: SolveOptions,
    /// Options of descents from nearby solutions. Collisions are checked afterwards.
    pub(super) brief: SolveOptions,
}

impl MapRobots {
    pub fn new(robot: &Robot, grid: &MapGrid, options: &MapOptions) -> Result<Self> {
        robot.require_one_tip("reachability")?;
        options.validate()?;
        let free = |axis: UprightAxis| {
            let freed = robot.with_limits(|index, joint| {
                if index == axis.joint {
                    (joint.lower, joint.upper) = (f64::NEG_INFINITY, f64::INFINITY);
                }
            })?;
            Ok::<_, Error>((axis, freed))
        };
        let alike = grid.treats_azimuths_alike();
        let turning = robot.upright_axis().filter(|_| alike).map(free).transpose()?;
        let each = SolveOptions {
            task: options.task,
            surroundings: options.surroundings.clone(),
            stop: Stop { max_evaluations: options.evaluations, ..Stop::default() },
            whole_only: true,
            ..SolveOptions::default()
        };
        let stop = Stop { max_evaluations: DESCENT, ..Stop::default() };
        let brief = SolveOptions { task: options.task, stop, whole_only: true, ..SolveOptions::default() };
        Ok(Self { own: robot.clone(), turning, each, brief })
    }
}

impl<'a> MapTest<'a> {
    /// Checks robot and options for a grid.
    ///
    /// # Errors
    /// Any [`Error`] for wrong options.
    pub fn new(robots: &'a MapRobots, grid: &'a MapGrid, options: &'a MapOptions) -> Result<Self> {
        let own = SolveContext::new(&robots.own, &robots.each)?;
        let turning = match &robots.turning {
            Some((axis, robot)) => Some((*axis, SolveContext::new(robot, &robots.each)?)),
            None => None,
        };
        let robot = turning.as_ref().map_or(&own, |(_, context)| context).robot();
        let (lower, upper): (Vec<f64>, Vec<f64>) =
            robot.joints().iter().map(|joint| (joint.lower, joint.upper)).unzip();
        let any = Frame::IDENTITY;
        // A task may leave a part of the pose free.
        let asked = own.read(&[Target::Pose(any)])?;
        let at_once = robot.solves_at_once() == Some(true) && own.asks_for_pose(&asked[0]);
        let (low, high): (Vec<f64>, Vec<f64>) = robot.joints().iter().map(|joint| joint.sampling_range()).unzip();
        let method = match robot.family(&any) {
            _ if !at_once => Method::Search,
            Some(family) => Method::Family(Box::new(family.limits(&low, &high))),
            None => Method::Branches,
        };
        let range = |(j, joint): (usize, &Joint)| MappedJoint {
            lower: joint.lower,
            upper: joint.upper,
            period: robot.turn_period(j),
        };
        let ranges = own.robot().joints().iter().enumerate().map(range).collect();
        let reach = robot.reach(&lower, &upper);
        let measure = Manipulability::of(own.robot(), Motion::Pose);
        Ok(Self { grid, own, turning, method, reach, ranges, options, measure })
    }

    /// Whether a pose may be reachable although no solution was found.
    pub(super) fn leaves_poses_open(&self) -> bool {
        !matches!(self.method, Method::Branches)
    }

    /// Whether the reach of the tip includes the position of a ring.
    pub(super) fn may_reach(&self, ring: &Ring) -> bool {
        self.reach.excess(&ring.point) <= Tolerance::default().position
    }

    /// Result of a ring with nothing reached.
    pub(super) fn empty_result(&self, ring: &Ring) -> RingResult {
        RingResult::new(ring, self.grid.bytes(), self.options.quality)
    }

    /// Azimuth at which the orientations of a ring are solved.
    pub(super) fn azimuth(&self, ring: &Ring) -> f64 {
        if self.turning.is_some() { 0.0 } else { ring.azimuths[0] }
    }

    /// Tests orientation `i` of a ring in the first pass.
    pub(super) fn first_look(
        &self,
        ring: &Ring,
        i: usize,
        result: &mut RingResult,
        monitor: &mut dyn Monitor,
    ) -> OrientationResult {
        let pose = self.grid.pose(ring.point, self.azimuth(ring), i);
        let mut found = self.found(ring, OrientationResult::default(), result);
        match &self.method {
            Method::Branches => {
                if let Some(branches) = self.robot().branches(&pose) {
                    found.take_branches(&branches);
                }
            }
            Method::Family(limits) => {
                if let Some(family) = self.robot().family(&pose) {
                    found.take_family(&family, limits, self.options.evaluations);
                }
            }
            Method::Search => {
                let stream = ring.stream.wrapping_mul(self.grid.orientations().count() as u64).wrapping_add(i as u64);
                found.search(&pose, stream, monitor);
            }
        }
        found.seen
    }

    /// Continues the test of an orientation of a ring from what has been `seen`.
    pub(super) fn found<'t>(
        &'t self,
        ring: &'t Ring,
        seen: OrientationResult,
        result: &'t mut RingResult,
    ) -> OrientationTest<'t, 'a> {
        OrientationTest { test: self, azimuths: &ring.azimuths, seen, quality: &mut result.quality }
    }

    /// Robot that solutions are found for.
    fn robot(&self) -> &Robot {
        self.turning.as_ref().map_or(&self.own, |(_, context)| context).robot()
    }

    /// Whether `q` is clear and inside the limits of all joints except the one that turns the arm.
    fn holds(&self, q: &[f64]) -> bool {
        let turning = self.turning.as_ref().map(|(axis, _)| axis.joint);
        let mut joints = self.ranges.iter().zip(q).enumerate();
        joints.all(|(j, (range, value))| turning == Some(j) || range.holds(*value))
            && self.own.space().is_none_or(|space| space.holds(q))
    }
}

/// Results for an orientation of a ring.
#[derive(Debug, Clone, Default)]
pub(super) struct OrientationResult {
    /// Azimuths at which the orientation is reached, one bit each.
    pub reached: u64,
    /// Some solutions of the orientation.
    pub solutions: Vec<Vec<f64>>,
    /// Whether it is proven that there are no solutions.
    pub is_excluded: bool,
}

/// Test of one orientation of a ring, which collects its solutions.
pub(super) struct OrientationTest<'t, 'a> {
    test: &'t MapTest<'a>,
    azimuths: &'t [f64],
    pub seen: OrientationResult,
    /// Manipulability and clearance of the best configuration at each azimuth.
    quality: &'t mut [Vec<f32>; 2],
}

impl OrientationTest<'_, '_> {
    pub fn is_everywhere(&self) -> bool {
        self.seen.reached == u64::MAX >> (64 - self.azimuths.len())
    }

    /// Takes the branches that are solutions. Returns whether azimuths are left.
    fn take_branches(&mut self, branches: &ArmBranches) -> bool {
        for (q, _) in branches.iter() {
            if self.test.options.quality || !self.is_everywhere() {
                self.take(q);
            }
        }
        !self.is_everywhere()
    }

    /// Takes the solutions at `count` values of the parameter of a redundant arm, or at fewer if none can exist.
    fn take_family(&mut self, family: &PoseFamily<'_>, limits: &FamilyLimits, count: usize) {
        let arcs = family.arcs(limits);
        let mut values = arcs.scattered(count);
        if !self.take_values(family, limits, values.by_ref().take(VALUES_BEFORE_DOUBT)) {
            return;
        }
        self.seen.is_excluded = arcs.is_empty() || (self.seen.reached == 0 && family.is_excluded(limits, &arcs));
        if !self.seen.is_excluded {
            self.take_values(family, limits, values);
        }
    }

    /// Takes the solutions at these values. Returns false if no further values matter.
    fn take_values(
        &mut self,
        family: &PoseFamily<'_>,
        limits: &FamilyLimits,
        values: impl Iterator<Item = f64>,
    ) -> bool {
        let mut wants_more = true;
        family.visit_within(limits, values, |branches| {
            wants_more = self.take_branches(branches);
            wants_more
        });
        wants_more
    }

    /// Takes a configuration with the pose, at the azimuths at which it is a solution.
    pub fn take(&mut self, q: &[f64]) {
        if !self.test.holds(q) {
            return;
        }
        match &self.test.turning {
            None => self.keep(q, 1),
            Some((axis, _)) => {
                let range = self.test.ranges[axis.joint];
                let bit = |(index, azimuth): (usize, &f64)| {
                    u64::from(range.holds(q[axis.joint] + azimuth * axis.per_turn)) << index
                };
                self.keep(q, self.azimuths.iter().enumerate().map(bit).sum());
            }
        }
    }

    /// Records `q`, a solution at azimuth 0 except for its first joint, as a solution at these azimuths.
    fn keep(&mut self, q: &[f64], at: u64) {
        if at & !self.seen.reached != 0 && self.seen.solutions.len() < KEPT {
            self.seen.solutions.push(q.to_vec());
        }
        self.seen.reached |= at;
        if self.test.options.quality {
            self.measure(q, at);
        }
    }

    #[cold]
    fn measure(&mut self, q: &[f64], at: u64) {
        let MapTest { own, measure, .. } = self.test;
        let index = measure.index(own.robot(), q);
        let clearance =
            own.space().and_then(|space| space.clearance(q).nearest).map_or(f64::NAN, |near| near.contact.distance);
        for (all, value) in self.quality.iter_mut().zip([index, clearance]) {
            for (index, best) in all.iter_mut().enumerate() {
                if at >> index & 1 == 1 {
                    // Takes the larger value, and never NaN if one is a number.
                    *best = best.max(value as f32);
                }
            }
        }
    }

    /// Takes the solution of a search. If the limits of the first joint exclude it at an azimuth, searches again there.
    fn search(&mut self, pose: &Frame, stream: u64, monitor: &mut dyn Monitor) {
        let MapTest { own, turning, .. } = self.test;
        let Some((axis, context)) = turning else {
            if let Some(solution) = solved(own, pose, None, stream, monitor) {
                self.take(&solution.q);
            }
            return;
        };
        let Some(solution) = solved(context, pose, None, stream, monitor) else { return };
        self.take(&solution.q);
        for index in 0..self.azimuths.len() {
            if self.seen.reached >> index & 1 == 0
                && let Some(solution) = solved(own, &axis.turned(pose, self.azimuths[index]), None, stream, monitor)
            {
                self.take_at(index, &solution.q);
            }
        }
    }

    /// Takes a solution at one azimuth.
    pub fn take_at(&mut self, index: usize, q: &[f64]) {
        let mut q = q.to_vec();
        if let Some((axis, _)) = &self.test.turning {
            q[axis.joint] -= self.azimuths[index] * axis.per_turn;
        }
        self.take(&q);
    }
}

/// Searches for a solution of a pose, from `start` if there is one.
pub(super) fn solved(
    context: &SolveContext<'_>,
    pose: &Frame,
    start: Option<&[f64]>,
    stream: u64,
    monitor: &mut dyn Monitor,
) -> Option<Solution> {
    let targets = context.read(&[Target::Pose(*pose)]).ok()?;
    let solution =
        solve_query(context, &Query { targets: &targets, start, stream, stopwatch: Stopwatch::start() }, monitor);
    (solution.status == Status::Solved).then_some(solution)
}
