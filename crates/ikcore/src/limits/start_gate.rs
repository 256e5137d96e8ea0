//! The gate for configurations of a caller: readings of sensors, files and other programs.
//!
//! Rounding beyond a limit is taken as the limit. A start a little beyond is taken as it is, and the motion leads it inside. Anything
//! farther out is refused with the remedy.

use serde::{Deserialize, Serialize};

use super::field::Field;
use super::joint_limits::Limits;
use crate::error::{Error, Result};
use crate::math::sampling_range;
use crate::message::{Message, Setting, message};
use crate::robot::{JointKind, Robot, limit_rounding, outside_limits, play, position_unit, way_inside};
use crate::wording::number;

/// Distance beyond a position limit up to which a start is taken and led inside (rad, m): one number for all joints, or one per joint.
/// `None` means 5 degrees, or 5 mm for joints that slide.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StartSlack(Option<Vec<f64>>);

impl StartSlack {
    /// Only rounding is taken.
    pub const NONE: Self = Self(Some(Vec::new()));

    /// Slack of all joints, one number or one per joint (rad, m).
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for NaN and negative numbers, [`Error::WrongLength`] for no number.
    pub fn new(slack: Vec<f64>) -> Result<Self> {
        if slack.is_empty() {
            let (what, expected) = (Setting::StartSlack.into(), "one number, or one per joint".into());
            return Err(Error::WrongLength { what, expected, got: 0 });
        }
        match slack.iter().find(|slack| !(**slack >= 0.0)) {
            None => Ok(Self(Some(slack))),
            Some(wrong) => Err(Error::out_of_range(Setting::StartSlack, "zero or more", *wrong)),
        }
    }

    /// Any distance is taken: of starts that a gate has taken before.
    pub fn any() -> Self {
        Self(Some(vec![f64::INFINITY]))
    }

    /// Slack of joint `j` (rad, m).
    fn of(&self, j: usize, kind: Option<JointKind>) -> f64 {
        match &self.0 {
            None => play(kind),
            Some(given) => *given.get(j).or(given.first()).unwrap_or(&0.0),
        }
    }

    /// Limits of joint `j`, widened to `start` if it is outside within the slack (rad, m).
    pub(crate) fn reach(&self, j: usize, kind: Option<JointKind>, start: f64, [lower, upper]: [f64; 2]) -> (f64, f64) {
        let slack = self.of(j, kind);
        (
            if lower - start <= slack { lower.min(start) } else { lower },
            if start - upper <= slack { upper.max(start) } else { upper },
        )
    }

    fn require_for(&self, joints: usize) -> Result<()> {
        match &self.0 {
            Some(given) if given.len() > 1 && given.len() != joints => Err(Error::WrongLength {
                what: Setting::StartSlack.into(),
                expected: format!("one number, or {joints} (one per joint)"),
                got: given.len(),
            }),
            _ => Ok(()),
        }
    }
}

/// Joint of a start that is outside its limits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JointOutside {
    /// Name of the joint.
    pub joint: String,
    /// Its value (rad, m).
    pub value: f64,
    /// The limit that it exceeds (rad, m).
    pub limit: f64,
    /// The unit, "rad" or "m".
    pub unit: String,
}

impl JointOutside {
    /// Joint of this kind, if it is known, at `value` beyond `limit` (rad, m).
    pub(crate) fn new(joint: String, kind: Option<JointKind>, value: f64, limit: f64) -> Self {
        Self { joint, value, limit, unit: position_unit(kind).to_owned() }
    }

    /// Joints in words, for the end of a sentence; empty without any.
    pub(crate) fn in_words(outside: &[Self], verb: &str) -> String {
        let joint = |Self { joint, value, limit, unit }: &Self| {
            let (value, beyond, limit) = (number(*value), number((value - limit).abs()), number(*limit));
            format!("joint '{joint}' at {value}, {beyond} {unit} beyond its limit {limit}")
        };
        match outside {
            [] => String::new(),
            [only] => format!("; it {verb} with {}, and leads it inside", joint(only)),
            several => {
                let joints: Vec<String> = several.iter().map(joint).collect();
                format!("; it {verb} with {}, and leads them inside", joints.join(" and "))
            }
        }
    }
}

/// Start as taken by the gate.
#[derive(Debug, Clone, PartialEq)]
pub struct AdmittedStart {
    /// The configuration (n,), rounding beyond limits removed.
    pub q: Vec<f64>,
    /// Joints that are outside their limits.
    pub outside: Vec<JointOutside>,
}

impl Limits {
    /// Takes the start `q` (n,) of a motion at t = 0; `what` names it in the error. Kinds of joints and whole turns are known where
    /// `robot` is.
    ///
    /// # Errors
    /// [`Error::OutsideLimits`] beyond `slack` names the joint, its value, its limits and the remedy; [`Error::WrongLength`] for the
    /// slack.
    pub fn admit_start(
        &self,
        robot: Option<&Robot>,
        what: &str,
        q: &[f64],
        slack: &StartSlack,
    ) -> Result<AdmittedStart> {
        slack.require_for(q.len())?;
        let mut admitted = AdmittedStart { q: q.to_vec(), outside: vec![] };
        for (j, value) in admitted.q.iter_mut().enumerate() {
            let (lower, upper) = sampling_range::opened(self.lower[j].at(0.0), self.upper[j].at(0.0));
            if lower <= *value && *value <= upper {
                continue;
            }
            let limit = if *value < lower { lower } else { upper };
            let beyond = (*value - limit).abs();
            let kind = robot.map(|robot| robot.joints()[j].kind);
            let joint = self.joint_name(j);
            let rounding = limit_rounding(lower, upper);
            if beyond <= rounding {
                *value = limit;
            } else if beyond <= slack.of(j, kind) + rounding {
                admitted.outside.push(JointOutside::new(joint.to_owned(), kind, *value, limit));
            } else {
                let remedy = remedy(robot, j, *value, [lower, upper], slack);
                return Err(outside_limits(what, (joint, kind), *value, [lower, upper], remedy));
            }
        }
        Ok(admitted)
    }

    /// Brings the joints of `robot` that turn without limits to the whole turns of `q` (n,) nearest to `near` (n,).
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`] for position limits that vary over time.
    pub fn turn_near(&self, robot: &Robot, near: &[f64], q: &mut [f64]) -> Result<()> {
        let constants = |field: Field| self.constants(field, "the short way round", "give numbers");
        robot.turn_near([&constants(Field::Lower)?, &constants(Field::Upper)?], near, q);
        Ok(())
    }

    /// Takes a configuration (n,) that must be inside the limits at t = 0, but for rounding; otherwise like
    /// [`admit_start`](Self::admit_start).
    ///
    /// # Errors
    /// [`Error::OutsideLimits`].
    pub fn admit(&self, robot: Option<&Robot>, what: &str, q: &[f64]) -> Result<Vec<f64>> {
        self.admit_start(robot, what, q, &StartSlack::NONE).map(|admitted| admitted.q)
    }
}

/// Advice for a joint outside its limits: whole turns where they help, else the nearest limit and, for a start, more slack.
fn remedy(robot: Option<&Robot>, j: usize, value: f64, limits: [f64; 2], slack: &StartSlack) -> Message {
    let kind = robot.map(|robot| robot.joints()[j].kind);
    if let Some(turned) = robot.and_then(|robot| robot.turned_near(j, value, None, limits)) {
        let beyond = (limits[0] - turned).max(turned - limits[1]);
        if beyond <= 0.0 {
            return Setting::Wrap.into();
        }
        if beyond <= slack.of(j, kind) {
            let play = format!(", but for {} {}, from where a motion may begin", number(beyond), position_unit(kind));
            return message![Setting::Wrap, play];
        }
    }
    let is_start = *slack != StartSlack::NONE;
    match way_inside(kind, (limits[0] - value).max(value - limits[1])) {
        near if is_start && near == message![Setting::Clip] => {
            message![near, "; ", Setting::StartSlack, " takes a start farther out"]
        }
        way => way,
    }
}
