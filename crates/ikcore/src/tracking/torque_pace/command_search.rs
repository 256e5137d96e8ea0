//! Search for a command that keeps the torque limits together with its stop, near the one asked for.

use super::limited_pace::{KnownStop, SLOWED, TorquePace};
use super::other_limits::OtherLimits;
use super::stop_choice::LEAST_PART;
use crate::math::MAX_DOF;
use crate::math::row_step::{Row, SOFTNESS};
use crate::math::vector::{dot, write_within};
use crate::objective::Point;
use crate::task::Aims;
use crate::tracking::around_arm::Response;
use crate::tracking::constrained_step::{StepRequest, Towards};
use crate::tracking::step_context::StepContext;
use crate::tracking::stop_torques::Overload;
use crate::tracking::tracked_arm::TrackedArm;

/// Commands tried in a tick beside the one asked for.
const TRIES: usize = 4;

/// Smallest fraction of a command that is sent; below it the arm brakes.
const SHORTEST: f64 = 1e-3;

/// Fraction of the acceleration limits with which an arm brakes where hardly any torque is left to do so.
pub(super) const GENTLE: f64 = 0.01;

impl TorquePace {
    /// Replaces the command `q`, which `failed`, by one that is certified or the one that brakes. Returns the part of the command that is left.
    pub(super) fn replace(
        &mut self,
        arm: &mut TrackedArm,
        others: &mut OtherLimits<'_>,
        mut failed: Option<Overload>,
        q: &mut Point,
    ) -> f64 {
        let stop_part = arm.braking_part();
        if failed.is_some_and(|overload| overload.is_at_rest) {
            self.lead_aside(&arm.context(), q);
            failed = match self.check(arm, others, q) {
                Ok(()) => {
                    self.known = KnownStop::Certified;
                    return 1.0;
                }
                Err(found) => found,
            };
        }
        let (wanted, brake) = (q.clone(), arm.context().braking());
        let mut part = self.shorten(arm, others, failed, &wanted, q);
        if part < SLOWED && GENTLE < stop_part && self.stop.strains_after(&arm.context(), &brake) {
            // Where little torque is left to brake with, the arm creeps unless it brakes gently.
            let (found, found_stop) = (q.clone(), arm.braking_part());
            let gently = self.nearest(arm, others, GENTLE, &wanted, q);
            if gently > part {
                part = gently;
            } else {
                q.copy_from_slice(&found);
                arm.set_braking_part(found_stop);
            }
        }
        if part > 0.0 {
            self.known = KnownStop::Certified;
            return part;
        }
        arm.set_braking_part(stop_part);
        q.copy_from_slice(&arm.context().braking());
        if !(self.is_certified() || self.cannot_stay(arm) && self.unload(arm, others, &wanted, q)) {
            self.stop_somehow(arm, others, q);
        }
        0.0
    }

    /// Writes the command nearest to `wanted` into `q` that is certified with a stop of this part of the acceleration limits, or a milder one.
    /// Returns the part of it that is left; 0 if none is found.
    pub(super) fn nearest(
        &mut self,
        arm: &mut TrackedArm,
        others: &mut OtherLimits<'_>,
        stop_part: f64,
        wanted: &[f64],
        q: &mut Point,
    ) -> f64 {
        arm.set_braking_part(stop_part);
        q.copy_from_slice(wanted);
        match self.check(arm, others, q) {
            Ok(()) => 1.0,
            Err(failed) => self.shorten(arm, others, failed, wanted, q),
        }
    }

    /// Shortens the command `wanted`, which `failed`, until it is certified, and brakes more mildly after it where that helps. Returns the part
    /// of it that is left in `q`; 0 if none is found.
    fn shorten(
        &mut self,
        arm: &mut TrackedArm,
        others: &mut OtherLimits<'_>,
        mut failed: Option<Overload>,
        wanted: &[f64],
        q: &mut Point,
    ) -> f64 {
        let mut part = 1.0;
        let brake = arm.context().braking();
        for _ in 0..TRIES {
            let milder =
                failed.map_or(0.0, |found| if found.tick > 0 { found.easing * arm.braking_part() } else { 0.0 });
            match failed {
                Some(_) if milder >= LEAST_PART => arm.set_braking_part(milder),
                Some(found) => part *= self.stop.part_within(&arm.context(), &brake, found.tick),
                None => part *= 0.5,
            }
            if part < SHORTEST {
                break;
            }
            write_within(&brake, wanted, part, q);
            failed = match self.check(arm, others, q) {
                Ok(()) => return part,
                Err(found) => found,
            };
        }
        0.0
    }

    /// Moves the command `q` to the nearest one, by its effect on the task, after which joints can hold the arm at rest, to first order.
    fn lead_aside(&mut self, context: &StepContext<'_>, q: &mut Point) {
        let (rest, start) = (context.stop_after(q).rest(), q.clone());
        let slope = Response::new(context, &rest).slope;
        let rows = &mut self.rows.rows;
        rows.clear();
        self.stop.each_hold(&rest, |_, beyond, gradient| {
            let mut row = Row { gradient: [0.0; MAX_DOF], least: beyond, softness: SOFTNESS };
            (0..q.len()).for_each(|j| row.gradient[j] = -gradient[j] * slope[j]);
            row.least += dot(&row.gradient[..q.len()], q);
            rows.push(row);
        });
        let aims = if context.robot.tip_count() > 1 { context.aims } else { Aims::default() };
        self.rows.write(&StepRequest { aims, ..context.request(Towards::Start) }, &start, q);
    }

    /// Checks a command and the stop after it; the error is the torque beyond its limit, or none if something else forbids them.
    pub(super) fn check(
        &mut self,
        arm: &TrackedArm,
        others: &mut OtherLimits<'_>,
        q: &[f64],
    ) -> Result<(), Option<Overload>> {
        self.within(arm, q)?;
        if others.allow(&arm.context(), q) { Ok(()) } else { Err(None) }
    }

    /// Checks torques, and the position limits of a stop that does not brake with the full acceleration. Returns the largest used part of a torque
    /// limit in the stop.
    pub(super) fn within(&mut self, arm: &TrackedArm, q: &[f64]) -> Result<f64, Option<Overload>> {
        if arm.limited.as_ref().is_none_or(|limited| limited.stops_inside(&arm.q, q, &arm.tick_box)) {
            self.stop.check(&arm.context(), q).map_err(Some)
        } else {
            Err(None)
        }
    }
}
