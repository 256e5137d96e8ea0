//! The motion of a whole program, step by step.

use super::around::{ADVICE_HOLD, MoveSurroundings};
use super::moves_options::MovesOptions;
use super::moving_tip::{MovingTip, led_by};
use super::outline::{Stage, StageKind};
use super::program::Move;
use super::report::{bounds_on, speed_on, tip_speed};
use super::run::{Run, RunPart};
use super::rung::Rung;
use super::timing::{PathTime, path_times, time_at, timed, times_between};
use crate::error::{Error, Result};
use crate::free_path;
use crate::math::vector::largest_difference;
use crate::message::Message;
use crate::plan::{EndTurns, Endpoint, MoveCourse, MoveReport, PointToPointOptions, SpeedBound};
use crate::solver::Monitor;
use crate::timing::JointPath;
use crate::trajectory::{Trajectory, polynomial};
use crate::wording::number;

/// Number of intervals of each piece of a path in the search for a place where a joint cannot hold the arm.
const SAMPLES: usize = 8;

/// Joint difference (rad, m) below which a joint move does not move.
const NOTHING: f64 = 1e-9;

/// The motion so far, and its moves.
pub(super) struct Assembly<'a> {
    around: MoveSurroundings<'a>,
    tips: &'a [MovingTip<'a>],
    moves: &'a [Move],
    options: &'a MovesOptions,
    /// Configuration at the end.
    q: Vec<f64>,
    motion: Option<Trajectory>,
    reports: Vec<MoveReport>,
}

impl<'a> Assembly<'a> {
    pub fn new(
        around: MoveSurroundings<'a>,
        tips: &'a [MovingTip<'a>],
        moves: &'a [Move],
        options: &'a MovesOptions,
        start: &[f64],
    ) -> Self {
        Self { around, tips, moves, options, q: start.to_vec(), motion: None, reports: vec![] }
    }

    /// Adds all stages: joint moves to the starts of `rungs` but the first, and the joint `paths` of the moves of the tip.
    ///
    /// # Errors
    /// Those of timings; [`Error::NotFound`] where an obstacle or a constraint is in the way.
    pub fn add_all(
        &mut self,
        stages: &'a [Stage],
        rungs: &[Rung],
        paths: Vec<JointPath>,
        monitor: &mut dyn Monitor,
    ) -> Result<()> {
        let (mut starts, mut paths) = (rungs.iter().skip(1), paths.into_iter());
        let (mut parts, mut radii): (Vec<RunPart<'a>>, Vec<f64>) = (vec![], vec![]);
        for Stage { kind, blend } in stages {
            match kind {
                StageKind::Rest(index, seconds) => self.rest(*index, *seconds)?,
                StageKind::Joints(index) => {
                    let Some(rung) = starts.next() else { continue };
                    let from = parts.last().map_or_else(|| self.q.clone(), end_of);
                    let is_still = largest_difference(&from, &rung.q) <= NOTHING;
                    if is_still && parts.is_empty() && *blend == 0.0 {
                        self.rest(*index, 0.0)?;
                        continue;
                    }
                    if is_still {
                        return Err(self.without_room(*index, parts.last()));
                    }
                    let path =
                        JointPath::polyline(self.around.limits.joint_names(), &[&from[..], &rung.q].concat(), 0.0)?;
                    let tips = led_by(self.tips, &self.moves[*index]);
                    parts.push(RunPart { index: *index, tips, tool_path: None, path });
                }
                StageKind::Along(tool_path) => {
                    let Some(path) = paths.next() else { continue };
                    let (index, tips) = (tool_path.pieces[0].index, &self.tips[tool_path.tip..=tool_path.tip]);
                    parts.push(RunPart { index, tips, tool_path: Some(tool_path), path });
                }
            }
            if *blend > 0.0 {
                radii.push(*blend);
            } else if !parts.is_empty() {
                self.go(std::mem::take(&mut parts), std::mem::take(&mut radii), monitor)?;
            }
        }
        Ok(())
    }

    /// Adds parts with rounded corners between them where that is possible and clear, else with stops.
    fn go(&mut self, parts: Vec<RunPart<'a>>, radii: Vec<f64>, monitor: &mut dyn Monitor) -> Result<()> {
        if !radii.is_empty()
            && let Some(run) = Run::rounded(self.tips, self.around.limits, &parts, &radii)?
        {
            let motion = self.timed_where_held(&run.path)?;
            let is_better = |motion: &Trajectory| match self.around.is_free() {
                true => Ok(!self.stops_are_faster(&parts, motion.duration())?),
                false => Ok::<_, Error>(self.around.fault_on(motion)?.is_none()),
            };
            if let Ok(motion) = motion
                && is_better(&motion)?
            {
                return self.add(&run, motion);
            }
        }
        for part in parts {
            if part.tool_path.is_none() && !self.goes_straight(&part) {
                self.way_around(&part, monitor)?;
                continue;
            }
            let run = Run::of(part);
            let motion = self.timed_where_held(&run.path)?.map_err(|problem| self.too_heavy(&run.parts[0], problem))?;
            if !self.around.is_free()
                && let Some(fault) = self.around.fault_on(&motion)?
            {
                return Err(self.not_found(run.parts[0].index, fault.into()));
            }
            self.add(&run, motion)?;
        }
        Ok(())
    }

    /// Whether a joint move may take the straight line: nothing can be in the way, and joints can hold the arm on all of it.
    fn goes_straight(&self, part: &RunPart<'_>) -> bool {
        self.around.is_free() && self.around.can_hold_along(&start_of(part), &end_of(part))
    }

    /// The fastest motion along a path; why there is none within torque limits.
    ///
    /// # Errors
    /// Those of timings.
    fn timed_where_held(&self, path: &JointPath) -> Result<Result<Trajectory, Message>> {
        match timed(path, self.around.limits) {
            Err(Error::Infeasible { problem }) if self.around.limits.limit_torque() => Ok(Err(problem)),
            other => other.map(Ok),
        }
    }

    /// The error for a part that cannot be timed for this `problem`: where a joint cannot hold the arm, which one, and what it needs.
    fn too_heavy(&self, part: &RunPart<'_>, problem: Message) -> Error {
        let (path, limits) = (&part.path, self.around.limits);
        let mut q = self.q.clone();
        let fractions = || (0..=SAMPLES).map(|k| k as f64 / SAMPLES as f64);
        let places = path.breaks().windows(2).flat_map(|ends| fractions().map(|x| ends[0] + x * (ends[1] - ends[0])));
        let heavy = |s: f64| {
            path.position(s, &mut q);
            Some((s, limits.too_heavy(&q)?))
        };
        let Some((s, heavy)) = { places }.find_map(heavy) else { return self.not_found(part.index, problem) };
        let (index, place) = match part.tool_path {
            Some(tool_path) => {
                let (index, along) = tool_path.place_on_move(s);
                (index, format!("{} m along it", number(along)))
            }
            None => (part.index, "on the straight way of the joints".into()),
        };
        self.not_found(index, format!("{place}, {heavy}; {ADVICE_HOLD}").into())
    }

    /// Whether the parts, with a stop after each, are faster than a duration (s): a tight corner may take longer than a stop.
    fn stops_are_faster(&self, parts: &[RunPart<'a>], than: f64) -> Result<bool> {
        let mut duration = 0.0;
        for part in parts {
            let Ok(motion) = self.timed_where_held(&part.path)? else { return Ok(false) };
            duration += motion.duration();
            if duration >= than {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Adds a run and the reports of its moves.
    fn add(&mut self, run: &Run<'a>, motion: Trajectory) -> Result<()> {
        let begin = self.now();
        let times = path_times(&run.path, &motion, self.around.limits)?;
        let mut start = begin;
        for (i, (part, window)) in run.parts.iter().zip(&run.windows).enumerate() {
            // A corner belongs to its two parts by halves.
            let end_of_part = match run.windows.get(i + 1) {
                Some(next) => begin + time_at(&times, 0.5 * (window.end() + next.begin)),
                None => begin + motion.duration(),
            };
            let Some(tool_path) = part.tool_path else {
                // Corners may take all of it.
                let between_corners = [window.begin, window.end()].map(|s| time_at(&times, s));
                let has_way = window.to > window.from;
                let speed = has_way.then(|| tip_speed(part.tips, &motion, between_corners)).transpose()?;
                self.report(part.index, [start, end_of_part], speed, vec![]);
                start = end_of_part;
                continue;
            };
            let own = |at: PathTime| PathTime { s: window.from + at.s - window.begin, ..at };
            let on_it = times_between(&times, [window.begin, window.end()]);
            let on_it: Vec<PathTime> = on_it.into_iter().map(own).collect();
            for (index, s) in tool_path.ends_of_moves() {
                let is_last = s >= window.to;
                let end = if is_last { end_of_part } else { begin + time_at(&on_it, s) };
                let bounds = bounds_on(tool_path, index, (&motion, &on_it, begin), self.around.limits);
                self.report(index, [start, end], speed_on(tool_path, index, &on_it), bounds);
                start = end;
            }
        }
        self.push(motion)
    }

    /// The motion and the reports of its moves.
    ///
    /// # Errors
    /// [`Error::InvalidMove`] if nothing moves and nothing takes time.
    pub fn finish(self) -> Result<(Trajectory, Vec<MoveReport>)> {
        let still = || Error::InvalidMove {
            what: "the program".into(),
            problem: "it takes no time: all its moves end where the arm is".into(),
        };
        Ok((self.motion.ok_or_else(still)?, self.reports))
    }

    fn now(&self) -> f64 {
        self.motion.as_ref().map_or(0.0, Trajectory::duration)
    }

    fn push(&mut self, next: Trajectory) -> Result<()> {
        self.q = next.end();
        self.motion = Some(match self.motion.take() {
            None => next,
            Some(motion) => motion.then(&next, 0.0)?,
        });
        Ok(())
    }

    /// Reports a move with this speed of the tip (m/s) between its blends; `None` where they take all of it.
    fn report(&mut self, index: usize, [start, end]: [f64; 2], speed: Option<f64>, bound_by: Vec<SpeedBound>) {
        let name = self.moves[index].name.clone();
        let (course, speed) = speed.map_or((MoveCourse::Blends, 0.0), |speed| (MoveCourse::Way, speed));
        self.reports.push(MoveReport { name, start, end, course, speed, bound_by });
    }

    fn rest(&mut self, index: usize, seconds: f64) -> Result<()> {
        let start = self.now();
        if seconds > 0.0 {
            let still = self.q.iter().map(|q| polynomial([*q])).collect();
            self.push(Trajectory::new(self.around.limits.joint_names(), vec![0.0, seconds], still)?)?;
        }
        let (name, end) = (self.moves[index].name.clone(), self.now());
        self.reports.push(MoveReport { name, start, end, course: MoveCourse::Rest, speed: 0.0, bound_by: vec![] });
        Ok(())
    }

    /// Adds a planned motion to the end of a joint move, one that is clear and keeps all constraints.
    fn way_around(&mut self, part: &RunPart<'_>, monitor: &mut dyn Monitor) -> Result<()> {
        let MovesOptions { surroundings, keeps, limits, stop, seed, .. } = self.options;
        let limits = match part.tips {
            [tip] if self.tips.len() > 1 => {
                Some(tip.limits_with_others_at(&self.q, limits.as_ref(), self.around.limits)?)
            }
            _ => limits.clone(),
        };
        let options = PointToPointOptions {
            end_turns: EndTurns::AsGiven,
            surroundings: surroundings.clone(),
            keeps: keeps.clone(),
            limits,
            stop: *stop,
            seed: *seed,
            ..PointToPointOptions::default()
        };
        let [start, end] = [self.q.clone(), end_of(part)].map(Endpoint::Configuration);
        let MoveSurroundings { robot, space, .. } = self.around;
        let plan = free_path::point_to_point(robot, &start, &[end], space, &options, monitor)?;
        let fault = if plan.violations.is_empty() && plan.obstruction.is_none() {
            self.around.fault_on(&plan.trajectory)?.map(Into::into)
        } else {
            Some(plan.message())
        };
        if let Some(problem) = fault {
            return Err(self.not_found(part.index, problem));
        }
        let (start, duration) = (self.now(), plan.trajectory.duration());
        let speed = tip_speed(part.tips, &plan.trajectory, [0.0, duration])?;
        self.push(plan.trajectory)?;
        self.report(part.index, [start, self.now()], Some(speed), vec![]);
        Ok(())
    }

    fn not_found(&self, index: usize, problem: Message) -> Error {
        Error::NotFound { what: format!("a motion along {}", self.moves[index].named(index)), problem }
    }

    fn without_room(&self, index: usize, before: Option<&RunPart<'_>>) -> Error {
        let with_blend = if before.is_some() { index - 1 } else { index };
        let still = self.moves[index].named(index);
        let problem =
            format!("its blend has no room, because {still} ends where it begins: leave that out, or give no blend");
        Error::InvalidMove { what: self.moves[with_blend].named(with_blend), problem: problem.into() }
    }
}

/// Joint positions at the start of a part.
fn start_of(part: &RunPart<'_>) -> Vec<f64> {
    at(part, part.path.breaks()[0])
}

/// Joint positions at the end of a part.
fn end_of(part: &RunPart<'_>) -> Vec<f64> {
    at(part, part.path.breaks()[part.path.pieces()])
}

fn at(part: &RunPart<'_>, s: f64) -> Vec<f64> {
    let mut q = vec![0.0; part.path.joints().len()];
    part.path.position(s, &mut q);
    q
}
