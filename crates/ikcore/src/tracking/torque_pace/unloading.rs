//! Way of an arm out of where its joints cannot hold it, since it has grasped too much.
//!
//! On the way a joint needs its limit at most or, where that is more, what holds the arm and a little beyond it to move; and each command makes
//! the arm easier to hold.

use super::command_search::GENTLE;
use super::limited_pace::{KnownStop, TorquePace};
use super::other_limits::OtherLimits;
use crate::objective::Point;
use crate::tracking::step_context::StepContext;
use crate::tracking::tracked_arm::TrackedArm;

impl TorquePace {
    /// Leads an arm on that has left where it cannot be held, until it can also move well. Returns whether it did.
    pub(super) fn leaves_on(&mut self, arm: &mut TrackedArm, others: &mut OtherLimits<'_>, q: &mut Point) -> bool {
        let wanted = q.clone();
        self.stop.strains_after(&arm.context(), q) && self.unload(arm, others, &wanted, q)
    }

    /// Whether a chosen stop ends where the joints cannot hold the arm.
    pub(super) fn cannot_stay(&mut self, arm: &TrackedArm) -> bool {
        let context = arm.context();
        self.known != KnownStop::Nothing && !self.can_hold(&context.stop_after(&context.braking()).rest())
    }

    /// Leads an arm that cannot be held where its stop ends to where it is easier to hold: the quickest way, by the command `wanted`, or as it
    /// moves already. Returns whether there is such a command, in `q`.
    pub(super) fn unload(
        &mut self,
        arm: &mut TrackedArm,
        others: &mut OtherLimits<'_>,
        wanted: &[f64],
        q: &mut Point,
    ) -> bool {
        let (stop_part, brake) = (arm.braking_part(), arm.context().braking());
        let rest = arm.context().stop_after(&brake).rest();
        let easier = self.easier(&arm.context(), &rest);
        self.stop.allow_holding(&arm.q, &rest);
        let found = [GENTLE.min(stop_part), stop_part].into_iter().any(|part| {
            arm.set_braking_part(part);
            let on = arm.context().braking();
            [&easier[..], wanted, &on].into_iter().any(|wanted| self.nearest(arm, others, part, wanted, q) > 0.0)
        });
        if found {
            self.stop_hardest(arm, others, q);
        }
        self.stop.allow_limits();
        if found {
            self.held_by = self.stop.too_heavy(&rest).or(self.held_by);
            self.known = KnownStop::Leaving;
        } else {
            arm.set_braking_part(stop_part);
            q.copy_from_slice(&brake);
        }
        found
    }

    /// The command in the box of the tick after which the arm, which would come to `rest`, is easier to hold by the most, to first order and
    /// relative to what each joint can change.
    fn easier(&mut self, context: &StepContext<'_>, rest: &[f64]) -> Point {
        let [lower, upper] = context.ends();
        let room = |j: usize| 0.5 * (upper[j] - lower[j]);
        let mut slope = Point::from_slice(rest);
        self.stop.write_strain_gradient(rest, &mut slope);
        let steepest = (0..rest.len()).map(|j| (slope[j] * room(j)).abs()).fold(f64::MIN_POSITIVE, f64::max);
        let mut q = context.braking();
        for (j, q) in q.iter_mut().enumerate() {
            let farthest = if slope[j] > 0.0 { lower[j] } else { upper[j] };
            *q += (slope[j] * room(j)).abs() / steepest * (farthest - *q);
        }
        q
    }
}
