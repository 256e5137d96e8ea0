//! A bound that a planned trajectory breaks.

use std::borrow::Cow;
use std::fmt;

use serde::{Deserialize, Serialize};

use crate::wording::number;

/// A bound that a trajectory breaks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Violation {
    /// What breaks it, such as "velocity of joint 'elbow'".
    pub what: String,
    /// How far it goes, in `unit`.
    pub value: f64,
    /// How far it may go, in `unit`.
    pub bound: f64,
    /// "rad/s" and so on.
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
