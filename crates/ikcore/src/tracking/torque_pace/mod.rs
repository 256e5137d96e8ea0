//! Torque limits of a tracked arm: in every command, and in the stop after it.
//!
//! A stop brakes with a part of the acceleration limits, the same for all joints: what the motors can give there. A command that is not
//! certified is tried with a milder stop, or moved towards the command that brakes, which was certified with the command before. Where there
//! is room, the stop becomes harder again. Where the joints could not hold the arm at rest after a command, it is led aside first.

mod unloading;

use crate::error::{Error, Result};
use crate::limits::{Field, Limits};
use crate::math::MAX_DOF;
use crate::math::row_step::{Row, SOFTNESS};
use crate::math::vector::{dot, write_within};
use crate::message::{Message, Setting, message};
use crate::objective::Point;
use crate::robot::{JointKind, Robot};
use crate::task::Aims;
use crate::tracking::around_arm::{Response, require_constant};
use crate::tracking::constrained_step::{ConstrainedStep, StepRequest, Towards};
use crate::tracking::safety_filter::SafetyFilter;
use crate::tracking::step_context::StepContext;
use crate::tracking::stop_torques::{Overload, StopTorques};
use crate::tracking::tip_pace::TipPace;
use crate::tracking::tracked_arm::TrackedArm;
use crate::wording::number;

/// Commands tried in a tick beside the one asked for.
const TRIES: usize = 4;

/// Smallest part of the acceleration limits of a stop, and the largest change of that part which a single tick makes.
const LEAST_PART: f64 = 0.05;
const HARDER: f64 = 1.25;

/// Used part of the torque limits below which a harder stop is tried in each tick, and the ticks after which it is tried anyway.
const AMPLE: f64 = 0.75;
const NOW_AND_THEN: usize = 8;

/// Part of a command below which the arm rather brakes.
const SHORTEST: f64 = 1e-3;

/// Parts of the acceleration limits tried by an arm whose stop is no longer certified.
const OTHER_PARTS: [f64; 5] = [1.0, 0.5, 0.25, 0.1, LEAST_PART];

/// Ratio of the torques of two stops that are not certified below which the milder one is taken, and the mildest of these.
const CLEARLY_LESS: f64 = 0.97;
const MILDEST: f64 = 0.25;

/// Part of the acceleration limits with which an arm brakes where hardly any torque is left to do so.
const GENTLE: f64 = 0.01;

/// Part of a command above which a torque limit only slows it.
const SLOWED: f64 = 0.1;

/// Time for which a limit counts as what holds the arm (s), and the largest decrease of the error of an arm that is held, per second.
const HELD: f64 = 0.1;
const CREEPING: f64 = 0.05;

/// Torque limits of an arm, and what of them holds it back.
#[derive(Debug)]
pub(super) struct TorquePace {
    stop: StopTorques,
    rows: ConstrainedStep,
    held_by: Option<Overload>,
    /// Time since it last changed a command (s).
    free_for: f64,
    /// What is known of the stop after the last command.
    known: Known,
}

/// What is known of a stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Known {
    /// It is within the torque limits.
    Certified,
    /// It was chosen, though none was found that is within them.
    Chosen,
    /// No torque in it is notably beyond its limit and what holds the arm, which goes to where it can be held.
    Leaving,
    /// Nothing, since masses have changed or the arm was put elsewhere.
    Nothing,
}

/// What else a command has to satisfy.
pub(super) struct OtherLimits<'a> {
    pub safety: Option<&'a mut SafetyFilter>,
    pub pace: Option<&'a mut TipPace>,
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
        Ok(Some(Box::new(Self { stop, rows, held_by: None, free_for: 0.0, known: Known::Certified })))
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
        (self.held_by, self.known) = (None, Known::Nothing);
    }

    /// Whether the stop after the last command is certified.
    pub fn is_certified(&self) -> bool {
        self.known == Known::Certified
    }

    /// Chooses the stop of an arm that begins to stop, if nothing is known of the one after its last command: then it takes the time that it
    /// says from the first tick on.
    pub fn choose_stop(&mut self, arm: &mut TrackedArm, mut others: OtherLimits<'_>) {
        if self.known == Known::Nothing {
            let mut brake = arm.context().braking();
            self.stop_somehow(arm, &mut others, &mut brake);
        }
    }

    /// Looks whether the rest of a chosen stop, which begins with the command `q`, is within the limits. Returns false if nothing was chosen.
    pub fn goes_on_with_stop(&mut self, arm: &TrackedArm, q: &[f64]) -> bool {
        if matches!(self.known, Known::Chosen | Known::Leaving) && self.within(arm, q).is_ok() {
            self.known = Known::Certified;
        }
        self.known != Known::Nothing
    }

    /// What holds the arm back, in words.
    pub fn held_in_words(&self, robot: &Robot) -> Option<String> {
        let verb = if self.is_certified() { "would need" } else { "needs" };
        let more = if self.known == Known::Leaving { "; the arm goes to where it needs less" } else { "" };
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

    /// Changes the command `q`, which `others` allow, to one that keeps the limits with the stop after it; a `settled` arm is held by what held
    /// it before. Returns whether it did.
    pub fn keep(&mut self, arm: &mut TrackedArm, mut others: OtherLimits<'_>, settled: bool, q: &mut Point) -> bool {
        match self.within(arm, q) {
            Ok(_) if self.known == Known::Leaving && self.leaves_on(arm, &mut others, q) => true,
            Ok(used) => {
                self.known = Known::Certified;
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

    /// Replaces the command `q`, which `failed`, by one that is certified or the one that brakes. Returns the part of the command that is left.
    fn replace(
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
                    self.known = Known::Certified;
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
            self.known = Known::Certified;
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
    fn nearest(
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

    /// Finds a stop for an arm that has none: the hardest that is certified or, failing that, the one that asks for clearly the least torque.
    fn stop_somehow(&mut self, arm: &mut TrackedArm, others: &mut OtherLimits<'_>, q: &mut Point) {
        let (before, mut least) = (arm.braking_part(), None);
        for part in OTHER_PARTS {
            arm.set_braking_part(part);
            let brake = arm.context().braking();
            match self.check(arm, others, &brake) {
                Ok(()) => {
                    self.known = Known::Certified;
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
        self.known = Known::Chosen;
        self.held_by = least.map(|(.., overload)| overload);
    }

    /// Makes the stop after the command `q` harder, if that is certified too.
    fn stop_harder(&mut self, arm: &mut TrackedArm, others: &mut OtherLimits<'_>, q: &[f64]) {
        let before = arm.braking_part();
        arm.set_braking_part((HARDER * before).min(1.0));
        if self.check(arm, others, q).is_err() {
            arm.set_braking_part(before);
        }
    }

    /// Checks a command and the stop after it; the error is the torque beyond its limit, or none if something else forbids them.
    fn check(
        &mut self,
        arm: &TrackedArm,
        others: &mut OtherLimits<'_>,
        q: &[f64],
    ) -> std::result::Result<(), Option<Overload>> {
        self.within(arm, q)?;
        if others.allow(&arm.context(), q) { Ok(()) } else { Err(None) }
    }

    /// Checks torques, and the position limits of a stop that does not brake with the full acceleration. Returns the largest used part of a torque
    /// limit in the stop.
    fn within(&mut self, arm: &TrackedArm, q: &[f64]) -> std::result::Result<f64, Option<Overload>> {
        if arm.limited.as_ref().is_none_or(|limited| limited.stops_inside(&arm.q, q, &arm.tick_box)) {
            self.stop.check(&arm.context(), q).map_err(Some)
        } else {
            Err(None)
        }
    }
}

impl OtherLimits<'_> {
    /// Whether the command `q` and the stop after it satisfy all others.
    fn allow(&mut self, context: &StepContext<'_>, q: &[f64]) -> bool {
        self.pace.as_mut().is_none_or(|pace| pace.allows(context, q))
            && self.safety.as_mut().is_none_or(|safety| safety.allows_command(context, q))
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
