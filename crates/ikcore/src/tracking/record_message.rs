//! Outcome of a track in a sentence, with advice.

use super::record::{Ease, Record};
use crate::limits::{Field, JointOutside};
use crate::message::{Message, Setting, message};
use crate::obstacle::Sensed;
use crate::solver::Status;
use crate::task::{Criterion, TipError};
use crate::wording::{number, time};

impl Record {
    /// Returns a sentence on the outcome, with advice.
    pub fn message(&self) -> Message {
        let advice = match &self.out_of_reach {
            None if self.ease == Ease::Impossible => {
                "no motion within the limits meets the path before it ends: slow it down or raise the limits".into()
            }
            None if self.was_held_back() => self.held_back(),
            None if self.count_of(Status::HeldByConstraint) > 0 => self.held_by_constraint(),
            None if let Some(lock) = self.limits.lock() => message![lock, "; or ", Status::Lost.advice()],
            None if self.starts_too_fast() => message![
                "the path moves at its start, where the arm is at rest: ",
                Setting::Ease,
                " begins with an approach within the limits",
            ],
            None => Status::Lost.advice(),
            Some((beyond, when)) => {
                message![format!("the path is {beyond} at t = {} s: ", time(*when)), Status::OutOfReach.advice()]
            }
        };
        message![self.message_with(advice), JointOutside::in_words(&self.start_outside, "begins")]
    }

    /// Whether obstacles or other links held the arm back.
    fn was_held_back(&self) -> bool {
        self.step_status.iter().any(|status| matches!(status, Status::InCollision | Status::HeldByObstacle))
    }

    /// Describes how obstacles held the arm back, with advice.
    fn held_back(&self) -> Message {
        let (status, phrase) = match self.count_of(Status::InCollision) {
            0 => (Status::HeldByObstacle, "an obstacle or another link held the arm back"),
            _ => (Status::InCollision, "an obstacle or another link was nearer than the margin"),
        };
        let advice = self.own_points.map_or_else(|| status.advice(), Sensed::advice);
        message![format!("in {} steps {phrase}: ", self.count_of(status)), advice]
    }

    /// Says in how many steps constraints held the arm back, with advice.
    fn held_by_constraint(&self) -> Message {
        let status = Status::HeldByConstraint;
        let steps = self.count_of(status);
        message![format!("in {steps} steps what is to be kept held the arm back: "), status.advice()]
    }

    /// Number of steps with a status.
    fn count_of(&self, wanted: Status) -> usize {
        self.step_status.iter().filter(|status| **status == wanted).count()
    }

    /// Whether the arm starts on the path and loses it at once because its acceleration is limited.
    fn starts_too_fast(&self) -> bool {
        let limited = [Field::Acceleration, Field::Jerk].into_iter().any(|field| self.limits.is_finite(field));
        let lost_at_once = self.joined() == Some(0) && self.step_status.get(1) != Some(&Status::Solved);
        let eases = self.ease == Ease::NotAsked && self.clearance[0].is_nan();
        limited && lost_at_once && eases
    }

    /// Returns [`message`](Self::message) with this `advice` if the track failed.
    pub(super) fn message_with(&self, advice: impl Into<Message>) -> Message {
        if self.status == Status::Interrupted {
            let when = time(self.time_of(self.rows() - 1));
            return message![format!("interrupted at t = {when} s: "), Status::Interrupted.advice()];
        }
        if let Some((joint, when)) = self.worst_violation {
            return self.beyond_limits(joint, when);
        }
        let Some(joined) = self.joined() else { return self.never_in_band(advice) };
        match self.status {
            Status::Solved => self.stayed_in_band(joined),
            Status::HeldInRegion => self.held_in_region(joined),
            Status::LevelGivenUp => self.level_given_up(joined),
            Status::RotationGivenUp => self.rotation_given_up(joined),
            Status::PositionGivenUp => self.position_given_up(joined),
            _ => self.left_band(joined, advice),
        }
    }

    /// Says by how much a joint is beyond its limits, and `when` (s).
    fn beyond_limits(&self, joint: usize, when: f64) -> Message {
        let (joint, excess) = (self.limits.joint_name(joint), number(self.max_violation));
        format!(
            "joint '{joint}' is {excess} (rad or m) beyond its limits at t = {} s: a limit closes in faster than \
             the joint may move; slow it down, raise the velocity or acceleration limit, or start farther inside",
            time(when)
        )
        .into()
    }

    /// Says how near the arm came to a band that it never reached.
    fn never_in_band(&self, advice: impl Into<Message>) -> Message {
        let nearest = self.in_words(smallest(&self.position_error), smallest(&self.rotation_error));
        message![format!("never came within {} (nearest {nearest}): ", self.band()), advice]
    }

    /// Describes a track that stayed in its band from row `joined` on.
    fn stayed_in_band(&self, joined: usize) -> Message {
        let (band, since, worst) = (self.band(), self.since(joined), self.worst_in_words(joined));
        format!("in the band of {band} from t = {since} s on; worst error there {worst}").into()
    }

    /// Says in how many steps from row `joined` on its region kept the tip from the band, and by how much.
    fn held_in_region(&self, joined: usize) -> Message {
        let (band, since, worst) = (self.band(), self.since(joined), self.worst_in_words(joined));
        let held = self.share(joined, |status| status == Status::HeldInRegion);
        let except = format!(
            "in the band of {band} from t = {since} s on, except in {held}, in which its region held the tip \
             up to {worst} away: "
        );
        message![except, self.status.advice()]
    }

    /// Says in how many steps from row `joined` on a higher level was given up, and by how much.
    fn level_given_up(&self, joined: usize) -> Message {
        let (since, worst) = (self.since(joined), self.worst_in_words(joined));
        let steps = self.share(joined, |status| status == Status::LevelGivenUp);
        let sentence =
            format!("the lowest level met from t = {since} s on; a higher one given up in {steps}, by up to {worst}: ");
        message![sentence, self.status.advice()]
    }

    /// Says in how many steps from row `joined` on the rotation was given up, and by how much.
    fn rotation_given_up(&self, joined: usize) -> Message {
        let [position, rotation] = self.worst_errors(joined);
        let (met, off, since) = (self.in_words(position, f64::NAN), number(rotation), self.since(joined));
        let steps = self.share(joined, |status| status == Status::RotationGivenUp);
        let sentence =
            format!("position met to {met} from t = {since} s on; rotation given up in {steps}, by up to {off} rad: ");
        message![sentence, self.status.advice()]
    }

    /// Says in how many steps from row `joined` on the position was given up, and by how much.
    fn position_given_up(&self, joined: usize) -> Message {
        let [position, rotation] = self.worst_errors(joined);
        let (met, off, since) = (self.in_words(f64::NAN, rotation), number(position), self.since(joined));
        let steps = self.share(joined, |status| status == Status::PositionGivenUp);
        let sentence =
            format!("rotation met to {met} from t = {since} s on; position given up in {steps}, by up to {off} m: ");
        message![sentence, self.status.advice()]
    }

    /// Says in how many steps from row `joined` on the arm was outside the band, and by how much.
    fn left_band(&self, joined: usize, advice: impl Into<Message>) -> Message {
        let (band, since, worst) = (self.band(), self.since(joined), self.worst_in_words(joined));
        let outside = self.share(joined, |status| status != Status::Solved);
        let sentence = format!(
            "joined the path at t = {since} s, then outside the band of {band} in {outside}, by up to {worst}: "
        );
        message![sentence, advice]
    }

    /// Names the error band.
    fn band(&self) -> String {
        let Criterion { tolerance, components, .. } = self.criterion;
        match components.and_then(|components| components.tolerance) {
            Some(_) => "its tolerance in each component".into(),
            None => self.in_words(tolerance.position, tolerance.rotation),
        }
    }

    /// Time of row `joined` (s), rounded for a message.
    fn since(&self, joined: usize) -> f64 {
        time(self.time_of(joined))
    }

    /// Counts the steps from row `joined` on that end in such a status, among all of the track.
    fn share(&self, joined: usize, counts: impl Fn(Status) -> bool) -> String {
        let steps = self.step_status[joined..].iter().filter(|status| counts(**status)).count();
        format!("{steps} of {} steps", self.rows() - 1)
    }

    /// Largest errors of position (m) and rotation (rad) from row `joined` on.
    fn worst_errors(&self, joined: usize) -> [f64; 2] {
        [largest(&self.position_error[joined..]), largest(&self.rotation_error[joined..])]
    }

    /// The same with their units.
    fn worst_in_words(&self, joined: usize) -> String {
        let [position, rotation] = self.worst_errors(joined);
        self.in_words(position, rotation)
    }

    /// Formats errors (m, rad) with their units, without components that the task leaves free.
    fn in_words(&self, position: f64, rotation: f64) -> String {
        let asked =
            |errors: &[f64], value: f64| if errors.iter().any(|error| !error.is_nan()) { value } else { f64::NAN };
        let position = asked(&self.position_error, position);
        TipError { position, rotation: asked(&self.rotation_error, rotation) }.to_string()
    }
}

/// Smallest error; NaN (not part of the task) is ignored.
fn smallest(errors: &[f64]) -> f64 {
    errors.iter().copied().fold(f64::INFINITY, f64::min)
}

/// Largest error; NaN (not part of the task) is ignored.
fn largest(errors: &[f64]) -> f64 {
    errors.iter().copied().fold(0.0, f64::max)
}
