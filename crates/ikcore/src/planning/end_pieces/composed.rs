//! A motion of several pieces: out of a contact, a straight line from the start, the way to a straight line to the end, and that
//! line. Each begins and ends at rest.

use std::time::Duration;

use super::line_candidates::{LineSearch, Side};
use super::out_of_contact::{LEEWAY, way_out};
use super::piece_space::PieceSpace;
use super::straight_line::StraightLine;
use super::straight_tip::StraightTip;
use crate::error::{Error, Result};
use crate::planning::collision_checks::{RESERVE, configuration_at, refuse_collision};
use crate::planning::endpoint::{EndName, no_usable_end};
use crate::planning::joined::{MeasuredMotion, joined};
use crate::planning::plan::Freed;
use crate::planning::{Endpoint, MotionLimits, Plan, PointToPointOptions, minmax};
use crate::robot::Robot;
use crate::solver::{Monitor, Stop, Stopwatch};

/// Straight lines to the ends that are planned to, shared between all ends.
const LINES: usize = 24;
/// At least so many for each end.
const LINES_OF_EACH: usize = 2;

const METHOD: &str = "method=\"minmax\"";

/// Plans with the pieces that the options ask for.
pub(in crate::planning) fn composed(
    robot: &Robot,
    start: &Endpoint,
    ends: &[Endpoint],
    options: &PointToPointOptions,
    monitor: &mut dyn Monitor,
) -> Result<Plan> {
    let stopwatch = Stopwatch::start();
    let limits = MotionLimits::new(robot, options.limits.as_ref(), METHOD)?;
    minmax::require_pace(robot, &limits)?;
    let space = PieceSpace::new(robot, options)?;
    let mut pieces = Pieces { robot, options, limits: &limits, space: space.as_ref(), evaluations: 0 };
    let freed = if options.free_start { pieces.freed(start)? } else { None };
    let freed_start = freed.as_ref().map(|(_, q)| Endpoint::Configuration(q.clone()));
    let start = freed_start.as_ref().unwrap_or(start);
    let retreat = options.retreat.as_ref().map(|line| pieces.retreat(line, start, monitor)).transpose()?;
    let retreated = retreat.as_ref().map(|(_, q)| Endpoint::Configuration(q.clone()));
    let start = retreated.as_ref().unwrap_or(start);
    let mut approaches = match &options.approach {
        None => None,
        Some(line) => Some(pieces.approaches(line, start, ends, monitor)?),
    };
    let meeting: Option<Vec<Endpoint>> = approaches
        .as_ref()
        .map(|each| each.iter().map(|(_, _, meets)| Endpoint::Configuration(meets.clone())).collect());
    let evaluations = pieces.evaluations;
    let rest = PointToPointOptions {
        approach: None,
        retreat: None,
        free_start: false,
        task: if meeting.is_some() { None } else { options.task },
        stop: options.stop.map(|stop| {
            let left = |time: Duration| time.saturating_sub(stopwatch.elapsed());
            Stop { max_time: stop.max_time.map(left), ..stop }
        }),
        ..options.clone()
    };
    let mut plan = minmax::point_to_point(robot, start, meeting.as_deref().unwrap_or(ends), &rest, monitor)?;
    plan.evaluations += evaluations;
    let mut last = None;
    if let (Some(approaches), Some(taken)) = (&mut approaches, plan.chosen_end) {
        let (chosen, motion, _) = approaches.swap_remove(taken);
        plan.chosen_end = Some(chosen);
        last = Some(motion);
    }
    let plan = joined(robot, retreat.map(|(motion, _)| motion), plan, last)?;
    let freed_from = freed.as_ref().map(|(out, _)| out.freed);
    let plan = joined(robot, freed.map(|(out, _)| out.motion), plan, None)?;
    Ok(Plan { freed: freed_from, elapsed: stopwatch.elapsed(), ..plan })
}

/// What all pieces share.
struct Pieces<'a> {
    robot: &'a Robot,
    options: &'a PointToPointOptions,
    limits: &'a MotionLimits,
    space: Option<&'a PieceSpace>,
    evaluations: usize,
}

/// A way out of a contact.
struct WayOut {
    motion: MeasuredMotion,
    freed: Freed,
}

impl<'a> Pieces<'a> {
    /// The way out of a contact at the start, and where it ends; `None` if the start is clear or not given.
    fn freed(&self, start: &Endpoint) -> Result<Option<(WayOut, Vec<f64>)>> {
        let Endpoint::Configuration(q) = start else { return Ok(None) };
        let Some(space) = self.space.map_or(Ok(None), PieceSpace::clear)? else { return Ok(None) };
        if space.holds(q) {
            return Ok(None);
        }
        let margin = space.margin() - RESERVE;
        let clearance = space.nearest(q).map_or(f64::INFINITY, |nearest| nearest.contact.distance);
        let Some(out) = way_out(&space, self.limits, q)? else {
            // Names the two bodies.
            refuse_collision("start", space.scene(), q, margin)?;
            return Ok(None);
        };
        let freed = Freed { clearance, until: out.duration() };
        let last = configuration_at(&out, out.duration())?;
        let lines = out.knots().len() - 1;
        let motion = MeasuredMotion::new(out, Some(space.scene()), clearance - lines as f64 * LEEWAY)?;
        Ok(Some((WayOut { motion, freed }, last)))
    }

    /// What a straight line keeps clear of.
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

    /// A straight line from the start, and where it ends.
    fn retreat(
        &mut self,
        line: &StraightLine,
        start: &Endpoint,
        monitor: &mut dyn Monitor,
    ) -> Result<(MeasuredMotion, Vec<f64>)> {
        let along_line = self.along_line(line);
        let mut search = self.search(line, Side::Retreat, along_line.as_ref(), None)?;
        let found = search.candidates(EndName::Start, start, 1, monitor)?;
        let evaluations = search.evaluations;
        self.evaluations += evaluations;
        let candidate = found.into_iter().next().ok_or(Error::Interrupted)?;
        Ok((candidate.motion, candidate.meets))
    }

    /// Straight lines to the ends: the index of the end, the motion, and where it begins.
    fn approaches(
        &mut self,
        line: &StraightLine,
        start: &Endpoint,
        ends: &[Endpoint],
        monitor: &mut dyn Monitor,
    ) -> Result<Vec<(usize, MeasuredMotion, Vec<f64>)>> {
        let near = if let Endpoint::Configuration(q) = start { Some(q.clone()) } else { None };
        let along_line = self.along_line(line);
        let mut search = self.search(line, Side::Approach, along_line.as_ref(), near)?;
        let count = LINES.div_ceil(ends.len()).max(LINES_OF_EACH);
        let (mut found, mut problems) = (vec![], vec![]);
        for (i, end) in ends.iter().enumerate() {
            match search.candidates(EndName::of(i, ends.len()), end, count, monitor) {
                Ok(lines) => found.extend(lines.into_iter().map(|line| (i, line.motion, line.meets))),
                Err(problem) => problems.push(problem),
            }
        }
        let evaluations = search.evaluations;
        self.evaluations += evaluations;
        if found.is_empty() { Err(no_usable_end(ends.len(), problems)) } else { Ok(found) }
    }
}
