//! Violations of bounds by a planned trajectory.

use std::borrow::Cow;
use std::fmt;

use serde::{Deserialize, Serialize};

use crate::wording::number;

/// A bound that a trajectory violates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Violation {
    /// The quantity, for example "velocity of joint 'elbow'".
    pub what: String,
    /// Extreme value of the quantity, in `unit`.
    pub value: f64,
    /// The bound, in `unit`.
    pub bound: f64,
    /// The unit, for example "rad/s".
    pub unit: Cow<'static, str>,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, value, bound, unit } = self;
        let [shown, allowed] = [number(*value), number(*bound)];
        if shown == allowed {
            let beyond = number((value - bound).abs());
            return write!(f, "{what} is {beyond} {unit} beyond the {allowed} {unit} allowed");
        }
        write!(f, "{what} is {shown} {unit}, allowed {allowed} {unit}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(value: f64, bound: f64) -> String {
        Violation { what: "velocity of joint 'a'".into(), value, bound, unit: "rad/s".into() }.to_string()
    }

    #[test]
    fn a_violation_names_value_and_bound_or_what_rounding_would_hide() {
        assert_eq!(shown(2.5, 2.0), "velocity of joint 'a' is 2.500 rad/s, allowed 2.000 rad/s");
        assert_eq!(shown(2.00001, 2.0), "velocity of joint 'a' is 1.000e-5 rad/s beyond the 2.000 rad/s allowed");
    }
}
