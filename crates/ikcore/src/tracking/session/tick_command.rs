//! Command of a tick, from the rule or the stop, changed until it keeps all promises of a session; and its status.

use super::Session;
use crate::math::vector::write_within;
use crate::objective::Score;
use crate::solver::{Monitor, Status};
use crate::task::Aims;
use crate::tracking::rule::{Tick, TickResult};
use crate::tracking::safety_filter::{FilterOutcome, Holder};
use crate::tracking::step_context::StepContext;
use crate::tracking::torque_pace::OtherLimits;

/// Bisections of a tick that would leave the region; they find the admissible fraction to one thousandth.
const BISECTIONS: usize = 10;

impl Session {
    pub(super) fn run_rule(&mut self, sampled_ago: Option<f64>, monitor: &mut dyn Monitor) -> TickResult {
        let (context, targets) = (self.arm.context(), &self.arm.targets);
        let Some((task, target)) = context.aims.iter().next() else { return TickResult::at(context.q) };
        let (criterion, goals, rng) = (&task.criterion, &mut self.goals, &mut self.rng);
        let most_evaluations = self.way_back.as_ref().map_or(usize::MAX, |way_back| way_back.left_to_rule());
        let tick = Tick { context, target, criterion, goals, targets, most_evaluations, sampled_ago, rng, monitor };
        self.running.advance(tick, self.safety.as_deref_mut())
    }

    /// Moves by one tick of the stop that was certified with the last command.
    pub(super) fn brake(&mut self) -> TickResult {
        let mut found = TickResult::at(&self.arm.q);
        let held =
            self.safety.as_mut().filter(|_| self.stopping.is_some()).and_then(|safety| safety.stop_on(self.arm.dt));
        let fastest = || self.arm.limited.as_ref().map(|limited| limited.stopping(&self.arm.q));
        if let Some(next) = held.or_else(fastest) {
            found.q = next;
        }
        self.arm.tick_box.bounds.clip(&mut found.q);
        self.arm.assess(&mut found);
        found
    }

    /// Changes the command `found` by the rule to one that keeps the arm clear and all constraints, and holds pairs of tips or, for a
    /// `settled` arm, to the braking one. Returns the obstruction that caused the change, unless the pairs did.
    pub(super) fn filter(&mut self, settled: bool, found: &mut TickResult) -> Option<Holder> {
        let Some(safety) = &mut self.safety else {
            if settled {
                found.q = self.arm.context().braking();
                self.note_changed(found);
            }
            return None;
        };
        let context = self.arm.context();
        // On a way back the distance from the target shows no progress: the targets do not judge the commands.
        let is_returning = self.way_back.as_ref().is_some_and(|way_back| way_back.is_returning());
        let context = if is_returning { StepContext { aims: Aims::default(), ..context } } else { context };
        let FilterOutcome { changed, held_by } = safety.filter(&context, settled, &mut found.q);
        if changed {
            self.note_changed(found);
        }
        held_by
    }

    /// Changes the command `found` to one that keeps the limits of tips.
    pub(super) fn keep_pace(&mut self, found: &mut TickResult) {
        let Some(pace) = self.pace.as_mut().filter(|_| !found.interrupted && self.stopping.is_none()) else { return };
        if pace.keep(&self.arm.context(), self.safety.as_deref_mut(), &mut found.q) {
            self.note_changed(found);
        }
    }

    /// Changes the command `found` to one that keeps the torque limits. An arm that stops goes on with its stop, unless masses have changed.
    pub(super) fn keep_torques(&mut self, settled: bool, found: &mut TickResult) {
        let Some(torques) = &mut self.torques else { return };
        if found.interrupted || self.stopping.is_some() && torques.goes_on_with_stop(&self.arm, &found.q) {
            return;
        }
        let others = OtherLimits { safety: self.safety.as_deref_mut(), pace: self.pace.as_deref_mut() };
        if torques.keep(&mut self.arm, others, settled, &mut found.q) {
            self.note_changed(found);
        }
    }

    /// Shortens a tick that would take the tip out of its region. The tick starts inside the region and the box is
    /// convex, so any fraction of the tick ends in the box.
    pub(super) fn keep_in_region(&mut self, found: &mut TickResult) {
        let region = self.arm.tasks.region().filter(|region| !region.contains(&found.position));
        let Some(region) = region.filter(|_| !self.arm.targets.last().is_empty()) else { return };
        let (mut kept, mut past) = (0.0, 1.0);
        let end = found.q.clone();
        for _ in 0..BISECTIONS {
            let fraction = 0.5 * (kept + past);
            write_within(&self.arm.q, &end, fraction, &mut found.q);
            let inside = region.contains(&self.arm.robot.tip_position(&found.q));
            (kept, past) = if inside { (fraction, past) } else { (kept, fraction) };
        }
        write_within(&self.arm.q, &end, kept, &mut found.q);
        found.assess(&self.arm.robot, &self.arm.aims());
        found.evaluations += BISECTIONS + 1;
        self.running.forget();
    }

    /// Assesses a command that is not the one of the rule.
    pub(super) fn note_changed(&mut self, found: &mut TickResult) {
        self.arm.assess(found);
        if self.arm.limited.is_none() {
            self.running.forget();
        }
    }

    /// Whether all bodies keep the margin at `q`; true if collisions are not checked.
    pub(super) fn is_clear(&self, q: &[f64]) -> bool {
        self.space().is_none_or(|space| space.holds(q))
    }

    pub(super) fn status(&self, found: &TickResult, held: Option<Holder>) -> Status {
        let Score { value, solved } = found.assessment.score;
        match self.arm.last_value {
            _ if !self.is_clear(&found.q) => Status::InCollision,
            _ if self.torques.as_ref().is_some_and(|torques| !torques.is_certified()) => Status::HeldByTorque,
            _ if solved && self.arm.is_blocked_by_region() => Status::HeldInRegion,
            _ if solved => Status::Solved,
            _ if let Some(holder) = held.or(self.holds_goal()) => match holder {
                Holder::Body => Status::HeldByObstacle,
                Holder::Constraint => Status::HeldByConstraint,
            },
            Some(last) if self.torques.as_ref().is_some_and(|torques| torques.holds(last, value, self.arm.dt)) => {
                Status::HeldByTorque
            }
            _ if let Some(status) = self.arm.given_up(found) => status,
            Some(last) if value >= last => Status::Capped,
            // Other rules may take steps as short as these.
            _ if self.way_back.is_some() && self.arm.rests_at(&found.q) => Status::Capped,
            _ => Status::Improved,
        }
    }

    /// Obstruction that keeps the goal from its target; `None` while the arm stops.
    pub(super) fn holds_goal(&self) -> Option<Holder> {
        self.safety.as_ref().filter(|_| self.stopping.is_none()).and_then(|safety| safety.holds_goal())
    }
}
