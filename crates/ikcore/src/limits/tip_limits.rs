//! Limits of the motion of tips.

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::message::{Message, Setting, message};
use crate::robot::Robot;
use crate::wording::words;

/// A kind of limit of a tip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TipField {
    /// Speed of its origin (m/s).
    Speed,
    /// Acceleration of its origin (m/s^2).
    Acceleration,
    /// Angular velocity of its frame (rad/s).
    TurnSpeed,
}

words!("kind of tip limit": TipField {
    Speed => "tip speed",
    Acceleration => "tip acceleration",
    TurnSpeed => "tip turn speed",
});

impl TipField {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::Speed, Self::Acceleration, Self::TurnSpeed];

    /// The name of the limit, as a setting.
    pub(crate) fn setting(self) -> Setting {
        Setting::Limit(self.name())
    }

    /// The quantity of a tip.
    pub(crate) fn of_tip(self, tip: &str) -> String {
        let quantity = match self {
            Self::Speed => "speed",
            Self::Acceleration => "acceleration",
            Self::TurnSpeed => "turn speed",
        };
        format!("{quantity} of tip '{tip}'")
    }

    /// Unit of the limit.
    pub(crate) fn unit(self) -> &'static str {
        match self {
            Self::Speed => "m/s",
            Self::Acceleration => "m/s^2",
            Self::TurnSpeed => "rad/s",
        }
    }
}

/// Limits of the motion of tips, by kind: none, one for all tips, or one per tip.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct TipLimits([Vec<f64>; 3]);

impl TipLimits {
    /// Replaces the limits of one kind, with one number for all tips or one per tip; infinite without a limit.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::OutOfRange`] unless they are positive.
    pub fn replace(&mut self, field: TipField, values: Vec<f64>) -> Result<()> {
        if values.is_empty() {
            let what = format!("{field} limit").into();
            return Err(Error::WrongLength { what, expected: "one number, or one per tip".into(), got: 0 });
        }
        if let Some((tip, value)) = values.iter().enumerate().find(|(_, value)| !(**value > 0.0)) {
            let which = if values.len() == 1 { String::new() } else { format!(" of tip {}", tip + 1) };
            return Err(Error::out_of_range(format!("{field} limit{which}"), "positive", *value));
        }
        self.0[field as usize] = values;
        Ok(())
    }

    /// The limits of one kind, as given; empty without any.
    pub fn of(&self, field: TipField) -> &[f64] {
        &self.0[field as usize]
    }

    /// The limit of a tip; infinite without one.
    pub fn at(&self, field: TipField, tip: usize) -> f64 {
        match self.of(field) {
            [] => f64::INFINITY,
            [all] => *all,
            of_each => of_each[tip],
        }
    }

    /// Whether the limit of any tip is finite.
    pub fn is_finite(&self, field: TipField) -> bool {
        self.of(field).iter().any(|limit| limit.is_finite())
    }

    /// Checks that there is one limit per tip of `robot`, or one for all.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn require_for(&self, robot: &Robot) -> Result<()> {
        for field in TipField::ALL {
            let (got, tips) = (self.of(field).len(), robot.tip_count());
            if got > 1 && got != tips {
                let what = format!("{field} limit for robot '{}'", robot.name()).into();
                let expected = format!("one number, or {tips} (one per tip)");
                return Err(Error::WrongLength { what, expected, got });
            }
        }
        Ok(())
    }

    /// Checks that no tip has a finite limit of these kinds, which `method` cannot keep.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`].
    pub fn refuse(&self, fields: &[TipField], method: impl Into<Message>, remedy: impl Into<Message>) -> Result<()> {
        match fields.iter().find(|field| self.is_finite(**field)) {
            None => Ok(()),
            Some(field) => Err(Error::UnsupportedLimit {
                field: field.to_string(),
                method: method.into(),
                remedy: message![remedy.into(), ", or leave out ", field.setting()],
            }),
        }
    }
}
