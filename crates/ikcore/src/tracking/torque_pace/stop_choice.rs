//! Choice of how hard a stop brakes, as a fraction of the acceleration limits.

use super::limited_pace::{KnownStop, TorquePace};
use super::other_limits::OtherLimits;
use crate::objective::Point;
use crate::tracking::tracked_arm::TrackedArm;

/// Smallest fraction of the acceleration limits with which a stop brakes, unless hardly any torque is left.
pub(super) const LEAST_PART: f64 = 0.05;

/// Largest factor by which a stop becomes harder in a tick.
const HARDER: f64 = 1.25;

/// Fractions of the acceleration limits that are tried where the stop is no longer certified, or could be harder.
const OTHER_PARTS: [f64; 5] = [1.0, 0.5, 0.25, 0.1, LEAST_PART];

/// Ratio of the torques of two stops that are not certified below which the milder one is taken.
const CLEARLY_LESS: f64 = 0.97;

/// Smallest fraction of the acceleration limits with which a stop that is not certified brakes.
const MILDEST: f64 = 0.25;

impl TorquePace {
    /// Chooses a stop if none is known, so that the announced stop time holds from the first tick.
    pub fn choose_stop(&mut self, arm: &mut TrackedArm, mut others: OtherLimits<'_>) {
        if self.known == KnownStop::Nothing {
            let mut brake = arm.context().braking();
            self.stop_somehow(arm, &mut others, &mut brake);
        }
    }

    /// Finds a stop for an arm that has none: the hardest that is certified or, failing that, the one that asks for clearly the least torque.
    pub(super) fn stop_somehow(&mut self, arm: &mut TrackedArm, others: &mut OtherLimits<'_>, q: &mut Point) {
        let (before, mut least) = (arm.braking_part(), None);
        for part in OTHER_PARTS {
            arm.set_braking_part(part);
            let brake = arm.context().braking();
            match self.check(arm, others, &brake) {
                Ok(()) => {
                    self.known = KnownStop::Certified;
                    q.copy_from_slice(&brake);
                    return;
                }
                Err(Some(overload)) if part >= MILDEST && others.allow(&arm.context(), &brake) => {
                    let used = self.stop.largest(&arm.context(), &brake);
                    if least.is_none_or(|(_, least, _)| used < CLEARLY_LESS * least) {
                        least = Some((part, used, overload));
                    }
                }
                Err(_) => {}
            }
        }
        arm.set_braking_part(least.map_or(before, |(part, ..)| part));
        q.copy_from_slice(&arm.context().braking());
        self.known = KnownStop::Chosen;
        self.held_by = least.map(|(.., overload)| overload);
    }

    /// Makes the stop after the command `q` harder, if that is certified too.
    pub(super) fn stop_harder(&mut self, arm: &mut TrackedArm, others: &mut OtherLimits<'_>, q: &[f64]) {
        let before = arm.braking_part();
        arm.set_braking_part((HARDER * before).min(1.0));
        if self.check(arm, others, q).is_err() {
            arm.set_braking_part(before);
        }
    }

    /// Makes the stop after the command `q` as hard as is certified.
    pub(super) fn stop_hardest(&mut self, arm: &mut TrackedArm, others: &mut OtherLimits<'_>, q: &[f64]) {
        let before = arm.braking_part();
        let is_certified = |part: &f64| {
            arm.set_braking_part(*part);
            self.check(arm, others, q).is_ok()
        };
        let harder = OTHER_PARTS.into_iter().filter(|part| *part > before).find(is_certified);
        arm.set_braking_part(harder.unwrap_or(before));
    }
}
