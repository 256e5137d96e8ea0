//! An option that is a number or "auto".

use std::fmt;

use pyo3::prelude::*;

use crate::convert::summary;
use crate::error::invalid;

/// What Python shows of the option.
#[derive(IntoPyObject)]
pub enum Rate {
    Number(f64),
    Word(&'static str),
}

impl From<Option<f64>> for Rate {
    fn from(number: Option<f64>) -> Self {
        number.map_or(Self::Word("auto"), Self::Number)
    }
}

impl fmt::Display for Rate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number:?}"),
            Self::Word(word) => write!(f, "'{word}'"),
        }
    }
}

/// The number; None for "auto", or where nothing was given. `what` names the option in errors.
pub fn number_or_auto(what: &str, value: Option<&Bound<'_, PyAny>>) -> PyResult<Option<f64>> {
    let Some(value) = value else { return Ok(None) };
    if let Ok(number) = value.extract::<f64>() {
        return Ok(Some(number));
    }
    match value.extract::<String>() {
        Ok(word) if word == "auto" => Ok(None),
        _ => Err(invalid(format!("{what} must be a number or 'auto', got {}", summary(value)))),
    }
}
