//! Checks of numbers that many calls share; each error names the argument.

use super::{Error, Result};
use crate::message::Message;

/// Checks that every entry is finite; `name(i)` names the offending entry.
pub(crate) fn require_finite(what: impl Into<Message>, values: &[f64], name: impl Fn(usize) -> String) -> Result<()> {
    match values.iter().position(|v| !v.is_finite()) {
        None => Ok(()),
        Some(i) => Err(Error::NotFinite { what: what.into(), place: name(i), value: values[i] }),
    }
}

/// Checks that `value` is finite and above zero.
pub(crate) fn require_positive(what: &str, value: f64) -> Result<()> {
    if value.is_finite() && value > 0.0 { Ok(()) } else { Err(Error::out_of_range(what, "positive and finite", value)) }
}

/// Checks that `value` is finite and not negative.
pub(crate) fn require_not_negative(what: &str, value: f64) -> Result<()> {
    let holds = value.is_finite() && value >= 0.0;
    if holds { Ok(()) } else { Err(Error::out_of_range(what, "zero or more and finite", value)) }
}

/// Checks that `value` is above 0 and at most 1.
pub(crate) fn require_factor(what: &str, value: f64) -> Result<()> {
    let holds = value > 0.0 && value <= 1.0;
    if holds { Ok(()) } else { Err(Error::out_of_range(what, "above 0 and at most 1", value)) }
}

/// Checks that `value` is between 0 and 1.
pub(crate) fn require_fraction(what: &str, value: f64) -> Result<()> {
    if (0.0..=1.0).contains(&value) { Ok(()) } else { Err(Error::out_of_range(what, "between 0 and 1", value)) }
}

/// Checks that `value` is at least 0 and below 1.
pub(crate) fn require_proper_fraction(what: &str, value: f64) -> Result<()> {
    if (0.0..1.0).contains(&value) { Ok(()) } else { Err(Error::out_of_range(what, "at least 0 and below 1", value)) }
}

/// Checks that `count` is not zero.
pub(crate) fn require_at_least_one(what: &str, count: usize) -> Result<()> {
    if count > 0 { Ok(()) } else { Err(Error::out_of_range(what, "at least 1", 0.0)) }
}
