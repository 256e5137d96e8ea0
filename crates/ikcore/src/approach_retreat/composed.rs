//! A motion of several pieces: out of a contact, a straight line from the start, the way to a straight line to the end, and that
//! line. Each begins and ends at rest.

use std::time::Duration;

use super::line_search::{LineSearch, Side};
use super::out_of_contact::{ALLOWED_LOSS, way_out};
use super::piece_space::PieceSpace;
use super::straight_tip::StraightTip;
use crate::error::{Error, Result};
use crate::free_path;
use crate::obstacle::{ClearanceSweep, kept_margin};
use crate::plan::{
    END_RESERVE, EndName, Endpoint, Freed, Plan, PointToPointOptions, StraightLine, TimedMotion, configuration_at,
    joined, nearest_at, no_usable_end, refuse_collision,
};
use crate::robot::Robot;
use crate::solver::{Monitor, Stop, Stopwatch};
use crate::timing::ConstantLimits;
use crate::trajectory::Trajectory;

/// Number of straight lines to the ends, shared between all ends.
const LINES: usize = 24;
/// Fewest lines for each end.
const LINES_OF_EACH: usize = 2;

/// Largest duration of a line, relative to the fastest one.
const SLOWEST: f64 = 2.0;

const METHOD: &str = "method=\"minmax\"";

/// Plans with the pieces that the options ask for.
pub(crate) fn composed(
    robot: &Robot,
    start: &Endpoint,
    ends: &[Endpoint],
    options: &PointToPointOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let stopwatch = Stopwatch::start();
    let limits = ConstantLimits::for_robot(robot, options.limits.as_ref(), METHOD)?;
    free_path::require_pace(robot, &limits)?;
    let space = PieceSpace::new(robot, options)?;
    let mut pieces = Pieces { robot, options, limits: &limits, space: space.as_ref(), evaluations: 0 };
    let way_out = if options.free_start { pieces.way_out(start)? } else { None };
    let freed = way_out.as_ref().map(|(out, _)| Endpoint::at_end_of(out)).transpose()?;
    let start = freed.as_ref().unwrap_or(start);
    let retreat = options.retreat.as_ref().map(|line| pieces.retreat(line, start, monitor)).transpose()?;
    let retreated = retreat.as_ref().map(Endpoint::at_end_of).transpose()?;
    let start = retreated.as_ref().unwrap_or(start);
    let approaches = match &options.approach {
        None => None,
        Some(line) => Some(pieces.approaches(line, start, ends, monitor)?),
    };
    let meeting = |(_, line): &(usize, Trajectory)| configuration_at(line, 0.0).map(Endpoint::Configuration);
    let meetings = approaches.as_ref().map(|each| each.iter().map(meeting).collect::<Result<Vec<_>>>()).transpose()?;
    let rest = pieces.rest(stopwatch);
    let mut plan = free_path::point_to_point(robot, start, meetings.as_deref().unwrap_or(ends), &rest, monitor)?;
    plan.evaluations += pieces.evaluations;
    let mut last = None;
    if let (Some(mut approaches), Some(taken)) = (approaches, plan.chosen_end) {
        let (chosen, motion) = approaches.swap_remove(taken);
        plan.chosen_end = Some(chosen);
        last = Some(motion);
    }
    pieces.note_clearance(&mut plan, way_out.as_ref(), [retreat.as_ref(), last.as_ref()])?;
    let plan = joined(robot, retreat.as_ref(), plan, last.as_ref())?;
    let plan = joined(robot, way_out.as_ref().map(|(out, _)| out), plan, None)?;
    Ok(Plan { freed: way_out.map(|(_, freed)| freed), elapsed: stopwatch.elapsed(), ..plan })
}

/// Robot, options and space that all pieces share.
struct Pieces<'a> {
    robot: &'a Robot,
    options: &'a PointToPointOptions,
    limits: &'a ConstantLimits,
    space: Option<&'a PieceSpace>,
    evaluations: usize,
}

impl<'a> Pieces<'a> {
    /// The way out of a contact at the start; `None` if the start is clear or not given.
    fn way_out(&self, start: &Endpoint) -> Result<Option<(Trajectory, Freed)>> {
        let Endpoint::Configuration(q) = start else { return Ok(None) };
        let around = self.around_start();
        let Some(space) = around.as_ref().map_or(Ok(None), PieceSpace::clear)? else { return Ok(None) };
        if space.holds(q) {
            return Ok(None);
        }
        let clearance = space.nearest(q).map_or(f64::INFINITY, |nearest| nearest.contact.distance);
        let Some(out) = way_out(&space, self.limits, q)? else {
            // Names the two bodies.
            refuse_collision("start", space.scene(), q, space.margin() - END_RESERVE)?;
            return Ok(None);
        };
        let freed = Freed { clearance, until: out.duration() };
        Ok(Some((out, freed)))
    }

    /// Space of the way out of a contact, with the contacts that the retreat allows.
    fn around_start(&self) -> Option<PieceSpace> {
        match &self.options.retreat {
            Some(line) => self.along_line(line),
            None => self.space.cloned(),
        }
    }

    /// The options of the motion between the pieces.
    fn rest(&self, stopwatch: Stopwatch) -> PointToPointOptions {
        let left = |time: Duration| time.saturating_sub(stopwatch.elapsed());
        PointToPointOptions {
            approach: None,
            retreat: None,
            free_start: false,
            // The lines end at configurations.
            task: self.options.task.filter(|_| self.options.approach.is_none()),
            stop: self.options.stop.map(|stop| Stop { max_time: stop.max_time.map(left), ..stop }),
            ..self.options.clone()
        }
    }

    /// Notes the smallest distance of a plan and its pieces. All keep the margin, except where contacts are allowed on
    /// one piece alone: then it is computed at once, because the surroundings of the whole motion do not contain it.
    fn note_clearance(
        &self,
        plan: &mut Plan,
        way_out: Option<&(Trajectory, Freed)>,
        lines: [Option<&Trajectory>; 2],
    ) -> Result<()> {
        let Some(space) = self.space else { return Ok(()) };
        let margin = kept_margin(self.options.margin)?;
        let asked = [&self.options.retreat, &self.options.approach];
        let touches = asked.iter().any(|line| line.as_ref().is_some_and(|line| !line.touch.is_empty()));
        if plan.surroundings.is_some() && plan.nearest.is_none() && way_out.is_none() && !touches {
            plan.clearance = plan.clearance.map(|clearance| clearance.min(margin));
            return Ok(());
        }
        let mut least = plan.least_distance(self.robot)?;
        let mut offer = |motion: &Trajectory, space: &PieceSpace, kept: f64| -> Result<()> {
            let Some(clear) = space.clear()? else { return Ok(()) };
            let whole = [0.0, motion.duration()];
            let Some(near) = ClearanceSweep::new(clear.scene()).smallest(&TimedMotion::new(motion), whole) else {
                return Ok(());
            };
            let distance = near.contact.distance.max(kept);
            if least.as_ref().is_none_or(|(least, _)| distance < *least) {
                least = Some((distance, nearest_at(clear.scene(), motion, near.at)?));
            }
            Ok(())
        };
        for (line, motion) in asked.into_iter().zip(lines) {
            if let (Some(line), Some(motion)) = (line, motion) {
                offer(motion, &space.among(line.obstacles(&self.options.obstacles)), margin)?;
            }
        }
        if let (Some((out, freed)), Some(space)) = (way_out, self.around_start()) {
            let lines = out.knots().len() - 1;
            offer(out, &space, freed.clearance - lines as f64 * ALLOWED_LOSS)?;
        }
        (plan.clearance, plan.nearest) = least.map_or((None, None), |(least, nearest)| (Some(least), nearest));
        plan.surroundings = None;
        Ok(())
    }

    /// Space of a straight line.
    fn along_line(&self, line: &StraightLine) -> Option<PieceSpace> {
        self.space.map(|space| space.among(line.obstacles(&self.options.obstacles)))
    }

    fn search<'s>(
        &self,
        line: &'s StraightLine,
        side: Side,
        along_line: Option<&'s PieceSpace>,
        near: Option<Vec<f64>>,
    ) -> Result<LineSearch<'s>>
    where
        'a: 's,
    {
        let clear = along_line.map_or(Ok(None), PieceSpace::clear)?;
        Ok(LineSearch {
            options: self.options,
            line,
            side,
            tip: StraightTip::new(self.robot, self.limits, self.options.task)?,
            position_limits: self.limits.position_limits(self.robot)?,
            along_line: along_line.zip(clear),
            beyond: self.space.map_or(Ok(None), PieceSpace::clear)?,
            near,
            evaluations: 0,
        })
    }

    /// Returns a straight line from the start.
    fn retreat(&mut self, line: &StraightLine, start: &Endpoint, monitor: &mut dyn Monitor) -> Result<Trajectory> {
        let along_line = self.along_line(line);
        let mut search = self.search(line, Side::Retreat, along_line.as_ref(), None)?;
        let found = search.lines(EndName::Start, start, 1, monitor)?;
        let evaluations = search.evaluations;
        self.evaluations += evaluations;
        found.into_iter().next().ok_or(Error::Interrupted)
    }

    /// Returns straight lines to the ends, each with the index of its end.
    fn approaches(
        &mut self,
        line: &StraightLine,
        start: &Endpoint,
        ends: &[Endpoint],
        monitor: &mut dyn Monitor,
    ) -> Result<Vec<(usize, Trajectory)>> {
        let near = if let Endpoint::Configuration(q) = start { Some(q.clone()) } else { None };
        let along_line = self.along_line(line);
        let mut search = self.search(line, Side::Approach, along_line.as_ref(), near)?;
        let count = LINES.div_ceil(ends.len()).max(LINES_OF_EACH);
        let (mut found, mut problems) = (vec![], vec![]);
        for (i, end) in ends.iter().enumerate() {
            match search.lines(EndName::of(i, ends.len()), end, count, monitor) {
                Ok(lines) => found.extend(lines.into_iter().map(|line| (i, line))),
                Err(problem) => problems.push(problem),
            }
        }
        let evaluations = search.evaluations;
        self.evaluations += evaluations;
        if found.is_empty() {
            return Err(no_usable_end(ends.len(), problems));
        }
        let quickest = found.iter().map(|(_, line)| line.duration()).fold(f64::INFINITY, f64::min);
        found.retain(|(_, line)| line.duration() <= SLOWEST * quickest);
        Ok(found)
    }
}
