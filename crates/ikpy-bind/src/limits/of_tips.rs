//! Limits of tips in `Limits`, as given: a number for all tips, or a dict by tip.

use ikcore::limits::TipField;
use ikcore::robot::Robot;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyString};

use crate::convert::summary;
use crate::error::{invalid, limit_error, raise};
use crate::options::Shown;

/// A number for all tips, or numbers by tip, in the order of their names.
#[derive(Debug, Clone, PartialEq)]
pub enum GivenTips {
    All(f64),
    Each(Vec<(String, f64)>),
}

/// Keyword of a limit of tips.
pub fn keyword(field: TipField) -> String {
    field.to_string().replace(' ', "_")
}

impl GivenTips {
    pub fn read(field: TipField, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        let keyword = keyword(field);
        let Ok(dict) = value.cast::<PyDict>() else {
            return positive(&keyword, value).map(Self::All);
        };
        if dict.is_empty() {
            return Err(invalid(format!("{keyword}: the dict is empty; name one tip at least")));
        }
        let entry = |(key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
            let Ok(name) = key.cast::<PyString>() else {
                return Err(invalid(format!("keys of {keyword} are names of tips, got {}", summary(&key))));
            };
            let name = name.to_str()?.to_owned();
            let limit = positive(&format!("{keyword} of tip '{name}'"), &value)?;
            Ok((name, limit))
        };
        let mut each: Vec<(String, f64)> = dict.iter().map(entry).collect::<PyResult<_>>()?;
        each.sort_by(|one, other| one.0.cmp(&other.0));
        Ok(Self::Each(each))
    }

    /// The numbers for the core: one, or one per tip of `robot`; as given without a robot.
    pub fn values(&self, robot: Option<&Robot>) -> PyResult<Vec<f64>> {
        match (self, robot) {
            (Self::All(limit), _) => Ok(vec![*limit]),
            (Self::Each(each), None) => Ok(each.iter().map(|(_, limit)| *limit).collect()),
            (Self::Each(each), Some(robot)) => {
                let mut values = vec![f64::INFINITY; robot.tip_count()];
                for (name, limit) in each {
                    values[robot.tip_number(name).map_err(raise)?] = *limit;
                }
                Ok(values)
            }
        }
    }

    pub fn show<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match self {
            Self::All(limit) => Ok(PyFloat::new(py, *limit).into_any()),
            Self::Each(each) => {
                let dict = PyDict::new(py);
                each.iter().try_for_each(|(name, limit)| dict.set_item(name, limit))?;
                Ok(dict.into_any())
            }
        }
    }

    pub fn repr(&self) -> String {
        match self {
            Self::All(limit) => limit.text(),
            Self::Each(each) => {
                let entries: Vec<String> =
                    each.iter().map(|(name, limit)| format!("'{name}': {}", limit.text())).collect();
                format!("{{{}}}", entries.join(", "))
            }
        }
    }
}

fn positive(what: &str, value: &Bound<'_, PyAny>) -> PyResult<f64> {
    let Ok(limit) = value.extract::<f64>() else {
        return Err(invalid(format!("{what} must be a number, or a dict of numbers by tip, got {}", summary(value))));
    };
    if limit > 0.0 {
        return Ok(limit);
    }
    Err(limit_error(format!("{what} is {limit}: it must be positive; None means no limit")))
}
