//! A motion of several pieces: out of a contact, a straight line from the start, the way to a straight line to the end, and that
//! line. Each begins and ends at rest.

use std::time::Duration;

use super::line_search::{LineSearch, Side};
use super::out_of_contact::{ALLOWED_LOSS, way_out};
use super::straight_tip::StraightTip;
use crate::error::{Error, Result};
use crate::free_path;
use crate::message::Setting;
use crate::obstacle::{ClearSpace, Clearance, ClearanceSweep};
use crate::plan::{
    END_RESERVE, EndName, EndTurns, Endpoint, Freed, Plan, PointToPointOptions, StraightLine, configuration_at, joined,
    least_clearance, no_usable_end, refuse_collision,
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

const METHOD: Setting = Setting::Method("minmax");

/// Plans with the pieces that the options ask for.
pub(crate) fn composed(
    robot: &Robot,
    start: &Endpoint,
    ends: &[Endpoint],
    space: Option<&ClearSpace<'_>>,
    options: &PointToPointOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let stopwatch = Stopwatch::start();
    let limits = ConstantLimits::for_robot(robot, options.limits.as_ref(), METHOD)?;
    limits.require_pace()?;
    let narrowed = space.map(|space| space.narrowed(END_RESERVE));
    let mut pieces = Pieces { robot, options, limits: &limits, space, narrowed: narrowed.as_ref(), evaluations: 0 };
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
    let mut plan = free_path::point_to_point(robot, start, meetings.as_deref().unwrap_or(ends), space, &rest, monitor)?;
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
    /// Space that the motion keeps clear of, if any.
    space: Option<&'a ClearSpace<'a>>,
    /// The same for its pieces: with the reserve of ends.
    narrowed: Option<&'a ClearSpace<'a>>,
    evaluations: usize,
}

impl<'a> Pieces<'a> {
    /// The way out of a contact at the start; `None` if the start is clear or not given.
    fn way_out(&self, start: &Endpoint) -> Result<Option<(Trajectory, Freed)>> {
        let Endpoint::Configuration(q) = start else { return Ok(None) };
        let Some(space) = self.around_start()? else { return Ok(None) };
        if space.holds(q) {
            return Ok(None);
        }
        let clearance = space.clearance(q).distance;
        let Some(out) = way_out(&space, self.limits, q)? else {
            // Names the two bodies.
            refuse_collision(&EndName::Start.of_configuration(), &space.narrowed(-END_RESERVE), q)?;
            return Ok(None);
        };
        let freed = Freed { clearance, until: out.duration() };
        Ok(Some((out, freed)))
    }

    /// Space that the way out of a contact keeps clear of, without contacts that the retreat allows.
    fn around_start(&self) -> Result<Option<ClearSpace<'a>>> {
        match &self.options.retreat {
            Some(line) => self.along_line(line),
            None => Ok(self.narrowed.cloned()),
        }
    }

    /// The options of the motion between the pieces.
    fn rest(&self, stopwatch: Stopwatch) -> PointToPointOptions {
        let left = |time: Duration| time.saturating_sub(stopwatch.elapsed());
        PointToPointOptions {
            approach: None,
            retreat: None,
            free_start: false,
            // The pieces join at given configurations.
            end_turns: EndTurns::AsGiven,
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
        let margin = space.margin();
        let asked = [&self.options.retreat, &self.options.approach];
        let touches = asked.iter().any(|line| line.as_ref().is_some_and(|line| !line.touch.is_empty()));
        let is_bound = plan.clearance.as_ref().is_none_or(|clearance| clearance.nearest.is_none());
        if plan.surroundings.is_some() && is_bound && way_out.is_none() && !touches {
            let at_least = |clearance: Clearance| Clearance::at_least(clearance.distance.min(margin));
            plan.clearance = plan.clearance.take().map(at_least);
            return Ok(());
        }
        let mut least = plan.least_clearance(self.robot)?;
        let mut offer = |motion: &Trajectory, space: Option<ClearSpace<'_>>, kept: f64| -> Result<()> {
            let Some(space) = space else { return Ok(()) };
            let found = least_clearance(&mut ClearanceSweep::new(space.scene()), motion, Some(kept))?;
            let is_less =
                |(found, _): &(Clearance, _)| least.as_ref().is_none_or(|least| found.distance < least.distance);
            if let Some((clearance, _)) = found.filter(is_less) {
                least = Some(clearance);
            }
            Ok(())
        };
        for (line, motion) in asked.into_iter().zip(lines) {
            if let (Some(line), Some(motion)) = (line, motion) {
                offer(motion, self.along_line(line)?, margin)?;
            }
        }
        if let Some((out, freed)) = way_out {
            let lines = out.knots().len() - 1;
            offer(out, self.around_start()?, freed.clearance - lines as f64 * ALLOWED_LOSS)?;
        }
        plan.clearance = least;
        let around = plan.surroundings.take();
        plan.surroundings_but_for_touch = around.filter(|_| touches);
        Ok(())
    }

    /// Space that a straight line keeps clear of.
    fn along_line(&self, line: &StraightLine) -> Result<Option<ClearSpace<'a>>> {
        self.narrowed.map(|space| space.among(line.obstacles(space.obstacles()))).transpose()
    }

    fn search<'s>(
        &self,
        line: &'s StraightLine,
        side: Side,
        along_line: Option<&'s ClearSpace<'s>>,
        near: Option<Vec<f64>>,
    ) -> Result<LineSearch<'s>>
    where
        'a: 's,
    {
        Ok(LineSearch {
            options: self.options,
            line,
            side,
            tip: StraightTip::new(self.robot, self.limits, self.options.task)?,
            position_limits: self.limits.position_limits(self.robot)?,
            along_line,
            beyond: self.narrowed,
            near,
            evaluations: 0,
        })
    }

    /// Returns a straight line from the start.
    fn retreat(&mut self, line: &StraightLine, start: &Endpoint, monitor: &mut dyn Monitor) -> Result<Trajectory> {
        let along_line = self.along_line(line)?;
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
        let along_line = self.along_line(line)?;
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
