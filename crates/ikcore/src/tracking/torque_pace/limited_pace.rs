//! Pace of an arm with torque limits: keeps them in each tick, and says what holds the arm back.

use super::other_limits::OtherLimits;
use crate::error::{Error, Result};
use crate::limits::{Field, Limits};
use crate::message::{Message, Setting, message};
use crate::objective::Point;
use crate::robot::{JointKind, Robot};
use crate::tracking::around_arm::require_constant;
use crate::tracking::constrained_step::ConstrainedStep;
use crate::tracking::stop_torques::{Overload, StopTorques};
use crate::tracking::tracked_arm::TrackedArm;
use crate::wording::number;

/// Used fraction of the torque limits below which a harder stop is tried in each tick.
const AMPLE: f64 = 0.75;

/// Number of ticks after which a harder stop is tried in any case.
const NOW_AND_THEN: usize = 8;

/// Fraction of a command above which a torque limit only slows it.
pub(super) const SLOWED: f64 = 0.1;

/// Time after which a limit no longer counts as holding the arm (s).
const HELD: f64 = 0.1;

/// Relative decrease of the error per second below which the arm counts as held.
const CREEPING: f64 = 0.05;

/// Torque limits of an arm, and what of them holds it back.
#[derive(Debug)]
pub(in crate::tracking) struct TorquePace {
    pub(super) stop: StopTorques,
    pub(super) rows: ConstrainedStep,
    pub(super) held_by: Option<Overload>,
    /// Time since it last changed a command (s).
    free_for: f64,
    /// What is known of the stop after the last command.
    pub(super) known: KnownStop,
}

/// What is known of a stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum KnownStop {
    /// It is within the torque limits.
    Certified,
    /// It was chosen, though none was found that is within them.
    Chosen,
    /// It exceeds the limits by no more than holding the arm takes; the arm moves to where it can be held.
    Leaving,
    /// Nothing, since masses have changed or the arm was put elsewhere.
    Nothing,
}

impl TorquePace {
    /// The torque limits of `robot`; `None` without any.
    ///
    /// # Errors
    /// [`Error::NoDynamics`]; [`Error::UnsupportedLimit`] for joints without an acceleration limit, for limits that vary over time, and for a
    /// base that floats.
    pub fn new(method: &Message, robot: &Robot, limits: &Limits) -> Result<Option<Box<Self>>> {
        let Some(stop) = StopTorques::new(method, robot, limits)? else { return Ok(None) };
        let accelerations = limits.field(Field::Acceleration).unwrap_or_default();
        let is_free = |j: usize| accelerations.get(j).is_none_or(|limit| limit.at(0.0) == f64::INFINITY);
        if let Some(joint) = (0..limits.dof()).find(|j| is_free(*j)) {
            let remedy = message![
                format!(
                    "joint '{}' may change its velocity at once, which takes any torque: give ",
                    limits.joint_name(joint)
                ),
                Setting::Limit("acceleration"),
            ];
            return Err(Error::UnsupportedLimit { field: "torque".into(), method: method.clone(), remedy });
        }
        require_constant(
            limits,
            "tracking with torque limits",
            "limits that vary can ask for more torque than there is; give numbers",
        )?;
        let rows = ConstrainedStep::with_room(limits.dof(), limits.dof());
        Ok(Some(Box::new(Self { stop, rows, held_by: None, free_for: 0.0, known: KnownStop::Certified })))
    }

    /// Checks that the joints can hold the arm at `q`, the argument `what`.
    ///
    /// # Errors
    /// [`Error::Infeasible`] names joint, torque and limit.
    pub fn require_held(&mut self, what: &str, q: &[f64], robot: &Robot) -> Result<()> {
        self.stop.too_heavy(q).map_or(Ok(()), |overload| {
            let needed = overload.in_words("needs", robot);
            let problem =
                format!("at {what} {needed}: begin elsewhere, lighten the payload, or raise the torque limit");
            Err(Error::Infeasible { problem: problem.into() })
        })
    }

    /// Carries the masses of `robot` from now on: no stop is certified for them yet.
    ///
    /// # Errors
    /// [`Error::NoDynamics`]; nothing has changed then.
    pub fn carry(&mut self, robot: &Robot, limits: &Limits) -> Result<()> {
        if let Some(stop) = StopTorques::new(&Setting::Session.into(), robot, limits)? {
            self.stop = stop;
        }
        self.restart();
        Ok(())
    }

    /// Forgets what held the arm, and the stop.
    pub fn restart(&mut self) {
        (self.held_by, self.known) = (None, KnownStop::Nothing);
    }

    /// Whether the stop after the last command is certified.
    pub fn is_certified(&self) -> bool {
        self.known == KnownStop::Certified
    }

    /// Looks whether the rest of a chosen stop, which begins with the command `q`, is within the limits. Returns false if nothing was chosen.
    pub fn goes_on_with_stop(&mut self, arm: &TrackedArm, q: &[f64]) -> bool {
        if matches!(self.known, KnownStop::Chosen | KnownStop::Leaving) && self.within(arm, q).is_ok() {
            self.known = KnownStop::Certified;
        }
        self.known != KnownStop::Nothing
    }

    /// What holds the arm back, in words.
    pub fn held_in_words(&self, robot: &Robot) -> Option<String> {
        let verb = if self.is_certified() { "would need" } else { "needs" };
        let more = if self.known == KnownStop::Leaving { "; the arm goes to where it needs less" } else { "" };
        self.held_by.as_ref().map(|overload| overload.in_words(verb, robot) + more)
    }

    /// Whether a limit holds an arm back whose squared error was `last` in the tick before and is `value` after one of `dt` (s).
    pub fn holds(&self, last: f64, value: f64, dt: f64) -> bool {
        self.holds_lately() && value >= last * (1.0 - 2.0 * CREEPING * dt)
    }

    /// Whether a limit has held the arm back a moment ago.
    pub fn holds_lately(&self) -> bool {
        self.held_by.is_some()
    }

    /// Whether the joints can hold the arm at `q`.
    pub fn can_hold(&mut self, q: &[f64]) -> bool {
        self.stop.too_heavy(q).is_none()
    }

    /// Replaces the command `q`, which `others` allow, by one that keeps the torque limits together with its stop; a `settled` arm is held by
    /// what held it before. Returns whether it did.
    pub fn keep(&mut self, arm: &mut TrackedArm, mut others: OtherLimits<'_>, settled: bool, q: &mut Point) -> bool {
        match self.within(arm, q) {
            Ok(_) if self.known == KnownStop::Leaving && self.leaves_on(arm, &mut others, q) => true,
            Ok(used) => {
                self.known = KnownStop::Certified;
                self.free_for += arm.dt;
                if !settled && self.free_for > HELD {
                    self.held_by = None;
                }
                if arm.braking_part() < 1.0 && (used < AMPLE || arm.ticks.is_multiple_of(NOW_AND_THEN)) {
                    self.stop_harder(arm, &mut others, q);
                }
                false
            }
            Err(failed) => {
                let wanted = q.clone();
                let part = self.replace(arm, &mut others, failed, q);
                if let Some(overload) = failed.filter(|overload| overload.is_at_rest || part < SLOWED) {
                    (self.held_by, self.free_for) =
                        (self.held_by.filter(|_| !self.is_certified()).or(Some(overload)), 0.0);
                }
                *q != wanted
            }
        }
    }
}

impl Overload {
    /// The joint, its torque and its limit in words; `verb` is what the joint does about the torque.
    fn in_words(&self, verb: &str, robot: &Robot) -> String {
        let joint = &robot.joints()[self.joint];
        let unit = if joint.kind == JointKind::Prismatic { "N" } else { "N m" };
        let [torque, limit] = [self.torque.abs(), self.limit].map(number);
        let what = match self.is_at_rest {
            true if self.torque.abs() < self.limit => "hold the arm, which leaves too little to move it",
            true => "hold the arm",
            false => "move the arm",
        };
        format!("joint '{}' {verb} {torque} {unit} to {what}, its limit is {limit} {unit}", joint.name)
    }
}
