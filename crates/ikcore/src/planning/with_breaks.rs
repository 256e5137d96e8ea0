//! Planning along a path that the tool leaves where it must: it draws back, goes another way, comes near again and goes on.

use crate::along_path::TipPath;
use crate::along_path::clear_path::{Stretch, Stretches, along_stretch, stretches};
use crate::along_path::timed::{PathKeeps, PathProblem};
use crate::approach_retreat::composed;
use crate::error::{Error, Result};
use crate::math::vector::largest_difference;
use crate::obstacle::{ClearSpace, Clearance};
use crate::plan::{
    AlongPathOptions, Break, Cost, EndTurns, Endpoint, LineFrame, Plan, PointToPointOptions, StraightLine,
};
use crate::robot::Robot;
use crate::solver::{Monitor, Status, Stop, Stopwatch};

/// Lengths (m) of the straight lines along the axis of the tool by which it leaves the path and comes back, longest first.
const LINES: [Option<f64>; 4] = [Some(0.05), Some(0.02), Some(0.005), None];

/// Maximum number of layers that a stretch gives up at an end that no motion reaches.
const GIVEN_UP: usize = 3;

/// Length of path (m, rad) below which a break skips nothing: the tip keeps to its path no better.
const LEFT_OUT: f64 = 1e-5;

/// Joint difference (rad, m) below which a motion does not move.
const NOTHING: f64 = 1e-9;

/// A path that the tool leaves where it must.
pub(super) struct BrokenPath<'a> {
    /// The arm with the tool of its task.
    pub robot: &'a Robot,
    pub tip_path: &'a TipPath,
    pub keeps: PathKeeps<'a>,
    pub options: &'a AlongPathOptions,
}

/// A part of the motion.
enum Piece {
    Along(Box<Plan>),
    /// Beside the path, from one path parameter to another; no way where the path begins later or ends sooner.
    Beside {
        way: Option<Box<Plan>>,
        places: [f64; 2],
        reason: String,
    },
}

impl BrokenPath<'_> {
    /// Plans with as few breaks as possible; `None` where no part of the path can be followed.
    ///
    /// # Errors
    /// As [`plan_along_path`](super::plan_along_path); [`Error::NotFound`] where no way leads from one part to the next.
    pub fn plan(&self, monitor: &mut dyn Monitor) -> Result<Option<Plan>> {
        let stopwatch = Stopwatch::start();
        let Self { robot, tip_path, keeps, options } = self;
        let space = options.surroundings.clear_space(*robot)?;
        let beside = options.surroundings.clear_space(keeps.robot)?;
        let problem = PathProblem::new(robot, tip_path, *keeps, options)?;
        let Stretches { stretches, reasons } = stretches(&problem, space.as_ref())?;
        let (mut pieces, mut reached) = (vec![], 0.0);
        let mut q = options.start.clone();
        for (stretch, reason) in stretches.into_iter().zip(&reasons) {
            let (plan, ends) = self.along(stretch, problem.accuracy, space.as_ref(), monitor)?;
            let begin = plan.trajectory.start();
            let places = [reached, ends[0]];
            let way = match &q {
                Some(q) if largest_difference(q, &begin) > NOTHING => {
                    Some(Box::new(self.beside([q, &begin], places, beside.as_ref(), monitor)?))
                }
                _ => None,
            };
            if way.is_some() || places[0] < places[1] {
                pieces.push(Piece::Beside { way, places, reason: reason.clone().unwrap_or_default() });
            }
            q = Some(plan.trajectory.end());
            reached = ends[1];
            pieces.push(Piece::Along(Box::new(plan)));
        }
        if reached > 0.0 && reached < 1.0 {
            let reason = reasons.last().cloned().flatten().unwrap_or_default();
            pieces.push(Piece::Beside { way: None, places: [reached, 1.0], reason });
        }
        let plan = self.joined(pieces)?;
        Ok(plan.map(|plan| Plan { elapsed: stopwatch.elapsed(), ..plan }))
    }

    /// The plan along a stretch, or along what is left of it without the layers at its ends, and its ends on the path.
    fn along(
        &self,
        stretch: Stretch,
        accuracy: f64,
        space: Option<&ClearSpace<'_>>,
        monitor: &mut dyn Monitor,
    ) -> Result<(Plan, [f64; 2])> {
        let whole = stretch.ends;
        let (mut first_plan, mut too_heavy) = (None, None);
        for given_up in 0..=GIVEN_UP {
            let is_free = |end: usize| if whole[end] == end as f64 { 0 } else { given_up };
            let Some(shorter) = stretch.clone().without(is_free(0), is_free(1)) else { break };
            let ends = shorter.ends;
            let part = self.tip_path.part(ends[0], ends[1])?;
            let begins_as_given =
                self.options.start.as_ref().is_some_and(|q| ends[0] == 0.0 && shorter.sequence[0][..] == q[..]);
            let start = self.options.start.clone().filter(|_| begins_as_given);
            let options = AlongPathOptions { start, accuracy: Some(accuracy), ..self.options.clone() };
            let problem = PathProblem::new(self.robot, &part, self.keeps, &options)?;
            let plan = match along_stretch(&problem, space, shorter, monitor) {
                Err(heavy @ Error::Infeasible { .. }) if problem.limits.limit_torque() => {
                    too_heavy.get_or_insert(heavy);
                    continue;
                }
                other => other?,
            };
            if plan.violations.is_empty() {
                return Ok((plan, ends));
            }
            first_plan.get_or_insert((plan, ends));
        }
        first_plan.ok_or(too_heavy.unwrap_or(Error::Interrupted))
    }

    /// The way from one configuration to another beside the path: back along the axis of the tool and the same way forth, by lines as long
    /// as there is room for, or else by any clear way.
    fn beside(
        &self,
        [from, to]: [&[f64]; 2],
        places: [f64; 2],
        space: Option<&ClearSpace<'_>>,
        monitor: &mut dyn Monitor,
    ) -> Result<Plan> {
        let mut problem = None;
        for distance in LINES {
            let line = |q: &[f64], along: f64| -> Option<StraightLine> {
                let axis = self.robot.tip(q).axes[2].map(|entry| along * entry);
                distance.map(|distance| StraightLine {
                    distance,
                    direction: Some(axis),
                    frame: LineFrame::Base,
                    touch: vec![],
                })
            };
            let options = PointToPointOptions {
                retreat: line(from, -1.0),
                approach: line(to, 1.0),
                keeps: self.options.keeps.clone(),
                surroundings: self.options.surroundings.clone(),
                limits: self.options.limits.clone(),
                end_turns: EndTurns::AsGiven,
                objective: self.options.objective,
                stop: self
                    .options
                    .stop
                    .and_then(|stop| stop.max_time)
                    .map(|time| Stop { max_time: Some(time), ..Stop::default() }),
                seed: self.options.seed,
                ..PointToPointOptions::default()
            };
            let [start, end] = [from, to].map(|q| Endpoint::Configuration(q.to_vec()));
            match composed(self.keeps.robot, &start, &[end], space, &options, monitor) {
                Ok(plan) if plan.violations.is_empty() => return Ok(plan),
                Ok(plan) => problem = Some(plan.message()),
                Err(Error::Interrupted) => return Err(Error::Interrupted),
                Err(error) => problem = Some(error.to_string().into()),
            }
        }
        let [at, until] = places.map(|place| self.tip_path.point_in_words(place));
        let problem = problem.unwrap_or_default();
        Err(Error::NotFound { what: format!("a way beside the path from {at} to {until}"), problem })
    }

    /// Places as the caller counts; one and the same where less is left out than the tip may be off its path.
    fn named(&self, [at, until]: [f64; 2]) -> [f64; 2] {
        let left_out = (until - at) * self.tip_path.length();
        [at, if left_out < LEFT_OUT { at } else { until }].map(|place| self.tip_path.place(place))
    }

    /// The plan of all pieces.
    fn joined(&self, pieces: Vec<Piece>) -> Result<Option<Plan>> {
        let (mut whole, mut breaks): (Option<Plan>, Vec<Break>) = (None, vec![]);
        let (mut violations, mut evaluations, mut status) = (vec![], 0, Status::Solved);
        let (mut accuracy, mut surroundings, mut obstruction) = (0.0_f64, None, None);
        let mut least: Option<Clearance> = None;
        for piece in pieces {
            let start = whole.as_ref().map_or(0.0, |before| before.trajectory.duration());
            let (plan, place) = match piece {
                Piece::Along(plan) => (Some(plan), None),
                Piece::Beside { way, places, reason } => (way, Some((places, reason))),
            };
            let moved = plan.as_ref().map_or(0.0, |plan| plan.trajectory.duration());
            if let Some((places, reason)) = place {
                let [at, until] = self.named(places);
                breaks.push(Break { at, until, reason, start, end: start + moved });
            }
            let Some(mut plan) = plan else { continue };
            if let Some(before) = &whole {
                plan.trajectory = before.trajectory.then(&plan.trajectory, 0.0)?;
            }
            accuracy = accuracy.max(plan.accuracy.unwrap_or(0.0));
            surroundings = surroundings.or_else(|| plan.surroundings.clone());
            obstruction = obstruction.or_else(|| plan.obstruction.clone());
            if let Some(Clearance { distance, .. }) = plan.clearance {
                least = Some(Clearance::at_least(least.map_or(distance, |least| least.distance.min(distance))));
            }
            if status == Status::Solved {
                status = plan.status;
            }
            violations.append(&mut plan.violations);
            evaluations += plan.evaluations;
            whole = Some(*plan);
        }
        let Some(Plan { trajectory, .. }) = whole else { return Ok(None) };
        let objective: Cost = self.options.objective;
        let cost = objective.of(self.robot, &trajectory);
        Ok(Some(Plan {
            breaks,
            violations,
            evaluations,
            status,
            surroundings,
            obstruction,
            clearance: least,
            accuracy: Some(accuracy),
            reference: Some(self.tip_path.positions().to_vec()),
            ..Plan::of(trajectory, objective, cost)
        }))
    }
}
