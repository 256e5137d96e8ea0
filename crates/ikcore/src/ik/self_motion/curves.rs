//! All curves of configurations that keep the tip at a target: `self_motion`.

use super::crossings::{beside, crossings};
use super::curve::SelfMotion;
use super::cut::parts;
use super::seeds::{Seeds, by_closed_form};
use super::trace::{TracedCurve, traced};
use super::unwrapping::{EXACT, unwrapped};
use super::wrapped_limits::WrappedLimits;
use crate::error::{Error, Result};
use crate::ik::attempt::Attempt;
use crate::ik::context::SolveContext;
use crate::ik::first_branch::by_closed_form as solved_by_closed_form;
use crate::ik::solve_options::SolveOptions;
use crate::limits::Limits;
use crate::math::vector::{distance, norm};
use crate::objective::{Bounds, Point};
use crate::rng;
use crate::robot::Robot;
use crate::solver::{LevenbergMarquardt, Monitor, Status};
use crate::task::Target;

/// Number of parameter values of a closed form that are searched for curves.
const VALUES: usize = 64;

/// Distance from a curve (rad, m) within which a configuration is on it.
const ON_CURVE: f64 = 0.01;

/// Consecutive solutions on known curves after which the search ends.
const PATIENCE: usize = 40;

/// Largest number of curves whose crossings with others are looked for.
const MOST_CROSSED: usize = 64;

/// Smallest and largest spacing of points (rad, m).
const SPACINGS: [f64; 2] = [1e-3, 0.5];

/// Points brought to the target between two polls of the monitor.
const POINTS_BETWEEN_LOOKS: usize = 64;

/// Options of [`self_motion`].
#[derive(Debug, Clone)]
pub struct SelfMotionOptions {
    /// Reference (n,): curves are sorted by their distance from it. `None` means by length, the longest first.
    pub start: Option<Vec<f64>>,
    /// Largest distance |q - q'| of consecutive points (rad, m).
    pub spacing: f64,
    /// Position limits to keep. `None` means the robot's.
    pub limits: Option<Limits>,
    /// Seed of the random draws of a search.
    pub seed: u64,
}

impl Default for SelfMotionOptions {
    fn default() -> Self {
        Self { start: None, spacing: 0.05, limits: None, seed: 0 }
    }
}

/// Returns all self-motion curves of an arm with one joint more than the task needs: seven joints and a pose, four and a
/// position.
///
/// The closed form, at 64 values of its parameter, or a search from random starts finds a point of each curve; the curve is
/// then traced in short steps, past the joint limits, which cut it afterwards. So are curves that cross these, as at singular
/// poses, and the one through a start that reaches the target. A solution through which no curve can be followed is returned as
/// a curve of one configuration, so that there is always a curve where a solution is known.
///
/// # Errors
/// Any [`enum@Error`] for wrong input; [`Error::Contradiction`] for an arm without one joint more than the task needs.
pub fn self_motion(
    robot: &Robot,
    target: &Target,
    options: &SelfMotionOptions,
    monitor: &mut dyn Monitor,
) -> Result<Vec<SelfMotion>> {
    robot.require_one_tip("self_motion")?;
    let SelfMotionOptions { start, spacing, limits, seed } = options;
    let [least, most] = SPACINGS;
    if !(least..=most).contains(spacing) {
        return Err(Error::out_of_range("spacing", format!("from {least} to {most}"), *spacing));
    }
    let each = SolveOptions { limits: limits.clone(), seed: *seed, ..SolveOptions::default() };
    let context = SolveContext::new(robot, &each)?;
    let targets = context.read(std::slice::from_ref(target))?;
    require_curves(robot, &targets[0])?;
    start.as_ref().map_or(Ok(()), |q| robot.check("start_q", q))?;
    let mut problem = context.problem(&targets);
    let mut rng = rng::stream(*seed, 0);
    let mut attempt = Attempt::new(&context, &mut problem, &mut rng, monitor);
    let limits = WrappedLimits::new(robot, context.bounds());
    let limits = match start {
        Some(start) => limits.around(start),
        None => limits,
    };
    let mut search = CurveSearch { limits: &limits, spacing: *spacing, start: start.as_deref(), curves: Vec::new() };
    let (mut found, complete) = search.all(robot, &mut attempt);
    found.iter_mut().for_each(|curve| curve.complete = complete);
    sort(&mut found, start.as_deref());
    Ok(found)
}

/// Search for the curves of one target.
struct CurveSearch<'c> {
    limits: &'c WrappedLimits<'c>,
    spacing: f64,
    start: Option<&'c [f64]>,
    /// Curves found, past the joint limits.
    curves: Vec<TracedCurve>,
}

impl CurveSearch<'_> {
    /// Finds the curves inside the limits, and whether there are provably no others.
    fn all(&mut self, robot: &Robot, attempt: &mut Attempt<'_, '_>) -> (Vec<SelfMotion>, bool) {
        let mut complete = match by_closed_form(robot, attempt, VALUES) {
            Some(Seeds { seeds, complete }) => {
                seeds.iter().for_each(|seed| self.add_through(seed, attempt));
                complete
            }
            None => {
                self.search(attempt);
                false
            }
        };
        let start = self.start.filter(|q| attempt.problem.assess(q).score.solved).and_then(|q| exact(q, attempt));
        if let Some(start) = &start {
            self.add_known(start, attempt);
        }
        complete &= !self.add_crossing(attempt);
        let mut found = self.inside(0, attempt);
        if found.is_empty()
            && attempt.monitor.keep_going()
            && let Some(known) = solved(attempt)
        {
            complete = false;
            found = self.through_known(&known, attempt);
        }
        if let Some(start) = &start
            && !self.passes_inside(&found, start)
        {
            complete = false;
            found.extend(self.through_known(start, attempt));
        }
        (found, complete)
    }

    /// Traces the curve through the solution `seed`, unless it is known.
    fn add_through(&mut self, seed: &[f64], attempt: &mut Attempt<'_, '_>) {
        if !self.knows(seed) && attempt.monitor.keep_going() {
            self.add(seed, None, attempt);
        }
    }

    /// Traces the curve through the solution `q`; where several cross, those that solutions beside it are on.
    fn add_known(&mut self, q: &[f64], attempt: &mut Attempt<'_, '_>) {
        if self.knows(q) || !attempt.monitor.keep_going() || self.add(q, None, attempt) {
            return;
        }
        for there in beside(q, attempt, self.limits) {
            if !self.knows(&there) && attempt.monitor.keep_going() {
                let along = self.limits.apart(&there, q);
                self.add(q, Some(&along), attempt);
            }
        }
    }

    fn knows(&self, q: &[f64]) -> bool {
        self.curves.iter().any(|curve| curve.passes(self.limits, q, ON_CURVE, self.spacing))
    }

    /// Traces a curve. Returns whether there is one.
    fn add(&mut self, q: &[f64], along: Option<&[f64]>, attempt: &mut Attempt<'_, '_>) -> bool {
        let curve = traced(attempt.problem, self.limits, q, along, self.spacing, attempt.monitor);
        let Some(curve) = curve.filter(|curve| curve.points.len() > 1) else { return false };
        attempt.budget.evaluations += curve.evaluations;
        self.curves.push(curve);
        true
    }

    /// Traces the curves that cross known ones. Returns whether any curve crosses another.
    fn add_crossing(&mut self, attempt: &mut Attempt<'_, '_>) -> bool {
        let (mut next, mut any) = (0, false);
        while next < self.curves.len() && next < MOST_CROSSED && attempt.monitor.keep_going() {
            let places = crossings(&self.curves[next], self.spacing, attempt);
            any |= !places.is_empty();
            for place in places {
                beside(&place, attempt, self.limits).iter().for_each(|seed| self.add_through(seed, attempt));
            }
            next += 1;
        }
        any || next < self.curves.len()
    }

    /// Traces the curves through solutions from random starts, until [`PATIENCE`] consecutive solutions are on known curves.
    fn search(&mut self, attempt: &mut Attempt<'_, '_>) {
        let mut x0 = attempt.first_start(None);
        let mut known = 0;
        while known < PATIENCE && !attempt.budget.is_spent() && attempt.monitor.keep_going() {
            let solution = attempt.solve_from(&x0);
            if solution.status != Status::Solved {
                break;
            }
            let is_known = self.knows(&solution.q) || !self.add(&solution.q, None, attempt);
            known = if is_known { known + 1 } else { 0 };
            attempt.next_start(&mut x0);
        }
    }

    /// Curves through the solution `q` inside the limits; `q` alone if none could be followed there.
    fn through_known(&mut self, q: &[f64], attempt: &mut Attempt<'_, '_>) -> Vec<SelfMotion> {
        let known = self.curves.len();
        self.add_known(q, attempt);
        let mut found = self.inside(known, attempt);
        if !self.passes_inside(&found, q) {
            found.push(SelfMotion::single(q));
        }
        found
    }

    /// Parts inside the limits of the curves from number `first` on.
    fn inside(&mut self, first: usize, attempt: &mut Attempt<'_, '_>) -> Vec<SelfMotion> {
        let mut found = Vec::new();
        for curve in &mut self.curves[first..] {
            make_exact(curve, attempt);
            for part in parts(curve, self.limits) {
                found.extend(unwrapped(part, self.spacing, attempt, self.limits, self.start));
            }
        }
        found
    }

    /// Whether one of the curves `found` passes `q`.
    fn passes_inside(&self, found: &[SelfMotion], q: &[f64]) -> bool {
        let near = self.spacing + ON_CURVE;
        found.iter().flat_map(SelfMotion::iter).any(|at| norm(&self.limits.apart(at, q)) < near)
    }
}

/// A solution of the target, as `solve` finds it.
fn solved(attempt: &mut Attempt<'_, '_>) -> Option<Point> {
    let solution = solved_by_closed_form(attempt, None).unwrap_or_else(|| {
        let x0 = attempt.first_start(None);
        attempt.solve_from(&x0)
    });
    if solution.status == Status::Solved { exact(&solution.q, attempt) } else { None }
}

/// The solution `q` as exact as the points of curves; `None` if the limits do not allow it.
fn exact(q: &[f64], attempt: &mut Attempt<'_, '_>) -> Option<Point> {
    let bounds = attempt.context.bounds();
    let mut inside = Point::from_slice(q);
    bounds.clip(&mut inside);
    let q = attempt.descend_beyond(&LevenbergMarquardt::default(), inside, EXACT, bounds);
    let error = attempt.problem.assess(&q).error;
    let missed = error.position.unwrap_or(0.0).max(error.rotation.unwrap_or(0.0));
    (missed <= 4.0 * EXACT * EXACT).then_some(q)
}

fn require_curves(robot: &Robot, target: &Target) -> Result<()> {
    let rank = robot.task_rank();
    let needed = match target {
        Target::Position(_) => rank.position,
        _ => rank.pose,
    };
    if robot.dof() == needed + 1 {
        return Ok(());
    }
    Err(Error::Contradiction {
        problem: format!(
            "self_motion needs one joint more than the target: robot '{}' has {} joints, and this target takes {needed}",
            robot.name(),
            robot.dof()
        ).into(),
    })
}

/// Projects the points of a curve onto the target.
fn make_exact(curve: &mut TracedCurve, attempt: &mut Attempt<'_, '_>) {
    let descent = LevenbergMarquardt::default();
    let anywhere = Bounds::from_ranges(
        curve.points.first().map_or(0..0, |point| 0..point.q.len()).map(|_| (f64::NEG_INFINITY, f64::INFINITY)),
    );
    for (k, point) in curve.points.iter_mut().enumerate() {
        if k % POINTS_BETWEEN_LOOKS == 0 && !attempt.monitor.keep_going() {
            break;
        }
        point.q = attempt.descend_beyond(&descent, point.q.clone(), EXACT, &anywhere);
    }
}

/// Sorts by the distance from `start`, or by length.
fn sort(curves: &mut [SelfMotion], start: Option<&[f64]>) {
    match start {
        Some(start) => {
            let nearest = |curve: &SelfMotion| curve.iter().map(|q| distance(q, start)).fold(f64::INFINITY, f64::min);
            curves.sort_by(|a, b| nearest(a).total_cmp(&nearest(b)));
        }
        None => curves.sort_by(|a, b| b.length().total_cmp(&a.length())),
    }
}
