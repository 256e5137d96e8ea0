//! Configurations of an end of a motion from which the tip moves along a straight line.

use super::straight_tip::{Hindrance, StraightTip};
use crate::error::{Error, Result};
use crate::ik::{AllOptions, SolutionSet, SolveOptions, solve, solve_all};
use crate::limits::Limits;
use crate::obstacle::{ClearSpace, ClearanceSweep, NearestContact};
use crate::plan::{
    END_RESERVE, EndName, Endpoint, PointToPointOptions, StraightLine, broken_along, certify, configuration_at,
};
use crate::solver::{Monitor, Status};
use crate::trajectory::Trajectory;
use crate::wording::number;

/// Number of configurations of a target that are tried.
const TRIED: usize = 32;
/// Number of values of the parameter of a redundant arm at which its closed form is evaluated.
const REDUNDANCY: usize = 16;

/// End of the motion at which a line is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    /// After the start.
    Retreat,
    /// Before the end.
    Approach,
}

impl Side {
    /// The name of the line.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Retreat => "retreat",
            Self::Approach => "approach",
        }
    }

    /// The place of a point of the line, seen from the end of the motion.
    fn place(self) -> &'static str {
        match self {
            Self::Retreat => "after it",
            Self::Approach => "before it",
        }
    }
}

/// Search for straight lines at an end of a motion.
pub(super) struct LineSearch<'a> {
    pub options: &'a PointToPointOptions,
    pub line: &'a StraightLine,
    pub side: Side,
    pub tip: StraightTip<'a>,
    pub position_limits: Limits,
    /// Space that the line keeps clear of; `None` if nothing can collide.
    pub along_line: Option<&'a ClearSpace<'a>>,
    /// Where the line meets the rest of the motion no contact is allowed.
    pub beyond: Option<&'a ClearSpace<'a>>,
    /// Configurations of the targets near this one come first (n,).
    pub near: Option<Vec<f64>>,
    /// Evaluations so far.
    pub evaluations: usize,
}

impl LineSearch<'_> {
    /// Returns up to `count` clear motions along the line at one end of the motion: from the start away, or to the end.
    ///
    /// # Errors
    /// [`Error::Unreachable`] if there is none: why the best one is none; errors of the surroundings.
    pub(super) fn lines(
        &mut self,
        name: EndName,
        end: &Endpoint,
        count: usize,
        monitor: &mut dyn Monitor,
    ) -> Result<Vec<Trajectory>> {
        let mut found = vec![];
        let mut hindrance: Option<(f64, Hindrance)> = None;
        for q in self.configurations(name, end, monitor)? {
            if found.len() == count || !monitor.keep_going() {
                break;
            }
            match self.from(&q)? {
                Ok(candidate) => found.push(candidate),
                Err((reached, why)) if hindrance.as_ref().is_none_or(|(most, _)| reached > *most) => {
                    hindrance = Some((reached, why));
                }
                Err(_) => {}
            }
        }
        if found.is_empty() {
            let Some((_, why)) = hindrance else { return Err(Error::Interrupted) };
            let (what, side, distance) = (name.of_given(end), self.side.name(), number(self.line.distance));
            let problem = format!("no straight {side} of {distance} m: {why}").into();
            return Err(Error::Unreachable { what, problem });
        }
        Ok(found)
    }

    /// Returns the configurations of an end; clear ones if it is a target.
    fn configurations(&mut self, name: EndName, end: &Endpoint, monitor: &mut dyn Monitor) -> Result<Vec<Vec<f64>>> {
        let target = match end {
            Endpoint::Configuration(q) => {
                if name != EndName::Start {
                    self.position_limits.admit(Some(self.tip.robot()), &name.of_configuration(), q)?;
                }
                return Ok(vec![q.clone()]);
            }
            Endpoint::Targets { targets, .. } => &targets[0],
        };
        let space = self.along_line;
        let each = SolveOptions {
            task: self.options.task,
            start: self.near.clone(),
            limits: Some(self.position_limits.clone()),
            surroundings: space.map(|space| space.surroundings()).unwrap_or_default(),
            seed: self.options.seed,
            whole_only: true,
            ..SolveOptions::default()
        };
        let all =
            AllOptions { each: each.clone(), limit: Some(TRIED), redundancy: REDUNDANCY, ..AllOptions::default() };
        let robot = space.map_or(self.tip.bare_robot(), |space| space.robot());
        let set = solve_all(robot, target, &all, monitor)?;
        self.evaluations += set.evaluations;
        if set.solutions.is_empty() {
            if self.options.task.is_some_and(|task| task.first.is_some()) {
                let in_order = solve(robot, target, &SolveOptions { whole_only: false, ..each }, monitor)?;
                self.evaluations += in_order.evaluations;
                if in_order.status.is_given_up() {
                    return Ok(vec![in_order.q.to_vec()]);
                }
            }
            return Err(Error::Unreachable { what: name.of_target(), problem: why_none(&set).into() });
        }
        Ok(set.solutions.iter().map(|solution| solution.q.to_vec()).collect())
    }

    /// Returns the motion along the line from or to `q`, or the length reached (m) and the hindrance.
    fn from(&self, q: &[f64]) -> Result<Result<Trajectory, (f64, Hindrance)>> {
        let (frame, place) = (self.tip.robot().tip(q), self.side.place());
        // Always found from the end of the motion away, and reversed for an approach.
        let away = match self.side {
            Side::Retreat => self.line.displacement(&frame, -1.0),
            Side::Approach => self.line.displacement(&frame, 1.0).map(|entry| -entry),
        };
        let outward = match self.tip.from(q, away, place)? {
            Ok(motion) => motion,
            Err(why) => return Ok(Err((0.0, why))),
        };
        if let Some(broken) = broken_along(self.tip.robot(), &self.options.keeps, &outward)? {
            return Ok(Err((0.0, format!("what is to be kept on the way does not hold on it: {broken}"))));
        }
        let margin = self.along_line.map_or(0.0, |space| space.margin() - END_RESERVE);
        let checked = self.along_line.map(|space| certify(&mut ClearanceSweep::new(space.scene()), &outward, margin));
        if let Some(Err(near)) = checked {
            let reached = self.line.distance * near.at / outward.duration();
            let contact = near.contact.in_words(margin);
            let why = if reached > 0.0 { format!("{} m {place} {contact}", number(reached)) } else { contact };
            return Ok(Err((reached, why)));
        }
        let meets = configuration_at(&outward, outward.duration())?;
        if let Some(beyond) = self.beyond
            && let Some(NearestContact { contact, .. }) = beyond.clearance(&meets).nearest
            && contact.distance < beyond.margin()
        {
            let (reached, contact) = (self.line.distance, contact.in_words(beyond.margin()));
            let why = format!("at its other end {contact}: give a longer line");
            return Ok(Err((reached, why)));
        }
        Ok(Ok(if self.side == Side::Approach { reversed(&outward)? } else { outward }))
    }
}

/// Why a target has no clear configuration.
fn why_none(set: &SolutionSet) -> String {
    match (&set.obstruction, &set.miss) {
        (Some(obstruction), _) => obstruction.to_string(),
        (None, Some(miss)) if miss.status == Status::InCollision => miss.obstruction.clone(),
        (None, Some(miss)) => format!("the nearest configuration found stays {} away", miss.error),
        (None, None) => set.message().to_string(),
    }
}

/// Returns the motion reversed in time.
fn reversed(motion: &Trajectory) -> Result<Trajectory> {
    let (duration, n) = (motion.duration(), motion.joints().len());
    let times: Vec<f64> = motion.knots().iter().rev().map(|t| duration - t).collect();
    let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; times.len() * n]);
    for (i, t) in motion.knots().iter().rev().enumerate() {
        let row = i * n..(i + 1) * n;
        motion.at(*t, &mut q[row.clone()], &mut qd[row.clone()], &mut qdd[row])?;
    }
    qd.iter_mut().for_each(|speed| *speed = -*speed);
    Trajectory::from_samples(motion.joints().to_vec(), &times, &q, Some(&qd), Some(&qdd))
}
