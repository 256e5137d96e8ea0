//! Doubt about the unit of a value.

use std::f64::consts::TAU;

use crate::message::{Message, Setting, message};
use crate::wording::number;

/// Unit that a value was probably given in.
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// Degrees for radians.
    Degrees,
    /// Degrees per second for radians per second.
    DegreesPerSecond,
    /// Radians that were converted from degrees.
    RadiansAsDegrees,
    /// Millimetres for metres.
    Millimetres,
    /// Millimetres per second for metres per second.
    MillimetresPerSecond,
}

/// Value that looks like another unit.
#[derive(Debug, Clone, PartialEq)]
pub struct UnitDoubt {
    /// What has the value, for example "start: joint 'elbow'".
    pub thing: String,
    /// The value as given, in the SI unit that it was taken in.
    pub value: f64,
    /// The unit that it looks like.
    pub unit: Unit,
    /// Comparison that makes the value implausible, for example "14.3 turns".
    pub against: String,
    /// The remedy.
    pub remedy: Message,
}

impl UnitDoubt {
    /// Angle (rad) that looks like degrees.
    pub(super) fn degrees(thing: impl Into<String>, value: f64, remedy: impl Into<Message>) -> Self {
        let against = format!("{} turns", number(value.abs() / TAU));
        Self { thing: thing.into(), value, unit: Unit::Degrees, against, remedy: remedy.into() }
    }

    /// Angle of a joint (rad) that looks like degrees.
    pub(super) fn joint_degrees(thing: impl Into<String>, value: f64) -> Self {
        Self::degrees(thing, value, Setting::RadiansFromDegrees)
    }

    /// Velocity (rad/s) that looks like degrees per second.
    pub(super) fn degrees_per_second(thing: impl Into<String>, value: f64) -> Self {
        let against = format!("{} turns per second", number(value.abs() / TAU));
        let remedy = message!["limits are in radians per second: ", Setting::RadiansFromDegrees];
        Self { thing: thing.into(), value, unit: Unit::DegreesPerSecond, against, remedy }
    }

    /// Length (m) that looks like millimetres.
    pub(super) fn millimetres(thing: impl Into<String>, value: f64, against: String) -> Self {
        let remedy = "lengths are in metres".into();
        Self { thing: thing.into(), value, unit: Unit::Millimetres, against, remedy }
    }

    /// Speed (m/s) that looks like millimetres per second.
    pub(super) fn millimetres_per_second(thing: impl Into<String>, value: f64, against: &str) -> Self {
        let remedy = "speeds are in metres per second".into();
        Self { thing: thing.into(), value, unit: Unit::MillimetresPerSecond, against: against.into(), remedy }
    }

    /// Returns a sentence with the thing, its value, the value in the other unit, and the remedy.
    pub fn message(&self) -> Message {
        let Self { thing, value, unit, against, remedy } = self;
        let (given, looks, short, meant) = match unit {
            Unit::Degrees => ("rad", "degrees", "degrees", format!("{} rad", number(value.to_radians()))),
            Unit::DegreesPerSecond => {
                ("rad/s", "degrees per second", "degrees/s", format!("{} rad/s", number(value.to_radians())))
            }
            Unit::RadiansAsDegrees => {
                ("rad", "radians read as degrees", "rad", format!("{} degrees", number(value.to_degrees())))
            }
            Unit::MillimetresPerSecond => {
                ("m/s", "millimetres per second", "mm/s", format!("{} m/s", number(1e-3 * value)))
            }
            Unit::Millimetres => ("m", "millimetres", "mm", format!("{} m", number(1e-3 * value))),
        };
        let value = shown(*value);
        message![
            format!("{thing} is {value} {given} ({against}), which looks like {looks}: {value} {short} are {meant}; "),
            remedy
        ]
    }
}

/// Formats a value as given, rounded if it has many digits.
fn shown(value: f64) -> String {
    let whole = value.to_string();
    if whole.len() <= 6 { whole } else { number(value) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_doubt_names_thing_value_both_units_and_the_remedy() {
        let angle = UnitDoubt::joint_degrees("start: joint 'elbow'", 90.0);
        assert_eq!(
            angle.message(),
            "start: joint 'elbow' is 90 rad (14.32 turns), which looks like degrees: 90 degrees are 1.571 rad; \
             convert degrees to radians"
        );
        let rate = UnitDoubt::degrees_per_second("velocity limit of joint 'a'", 180.0);
        assert_eq!(
            rate.message(),
            "velocity limit of joint 'a' is 180 rad/s (28.65 turns per second), which looks like degrees per second: \
             180 degrees/s are 3.142 rad/s; limits are in radians per second: convert degrees to radians"
        );
        let length = UnitDoubt::millimetres("target: x", 412.345678, "the reach is 0.8550 m".into());
        assert_eq!(
            length.message(),
            "target: x is 412.3 m (the reach is 0.8550 m), which looks like millimetres: 412.3 mm are 0.4123 m; \
             lengths are in metres"
        );
    }
}
