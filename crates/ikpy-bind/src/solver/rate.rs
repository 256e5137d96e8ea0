//! Options that are a number or "auto".

use ikcore::solver::{LearningRate, StepSize};
use pyo3::prelude::*;

use crate::convert::summary;
use crate::error::invalid;
use crate::options::Shown;

/// The option as a Python value.
#[derive(IntoPyObject)]
pub enum Rate {
    Number(f64),
    Word(&'static str),
}

/// Implements `Shown` for options with these values.
macro_rules! rates {
    ($($option:ident),*) => {$(
        impl Shown for $option {
            type Value = Rate;
            fn value(&self) -> Rate {
                match self {
                    Self::Auto => Rate::Word("auto"),
                    Self::Fixed(number) => Rate::Number(*number),
                }
            }
            fn text(&self) -> String {
                match self {
                    Self::Auto => "'auto'".into(),
                    Self::Fixed(number) => number.text(),
                }
            }
        }
    )*};
}

rates!(LearningRate, StepSize);

/// Reads the number; None for "auto" or a missing argument. `what` names the option in errors.
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
