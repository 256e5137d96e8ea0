//! Keys of dicts for several tips: names of tips, pairs of them, or the centre of mass.

use std::sync::Arc;

use ikcore::robot::Robot;
use ikcore::task::Subject;
use pyo3::prelude::*;
use pyo3::types::{PyString, PyTuple};

use crate::convert::summary;
use crate::error::{invalid, raise};

/// Key of the centre of mass, unless a tip has this name.
pub const CENTER_OF_MASS: &str = "center_of_mass";

/// Name of a tip, or names of two tips: the second in the frame of the first.
pub type TipKey = Vec<String>;

/// Keys of the targets of a call.
#[derive(Debug, Clone)]
pub struct TipKeys(pub Arc<[TipKey]>);

impl TipKeys {
    /// Returns the names of the tips of a robot as keys.
    pub fn of(robot: &Robot) -> Self {
        Self(robot.tips().map(|tip| vec![tip.to_owned()]).collect())
    }

    /// Iterates over the keys.
    pub fn iter(&self) -> impl Iterator<Item = &TipKey> {
        self.0.iter()
    }
}

/// Reads a key of a dict; `what` names the dict.
pub fn read_key(what: &str, key: &Bound<'_, PyAny>) -> PyResult<TipKey> {
    let names = match (key.cast::<PyString>(), key.cast::<PyTuple>()) {
        (Ok(_), _) => key.extract::<String>().map(|name| vec![name]),
        (_, Ok(pair)) if pair.len() == 2 => pair.extract::<Vec<String>>(),
        _ => Err(invalid(String::new())),
    };
    let wrong =
        |_| invalid(format!("keys of {what} are names of tips, or pairs of them (from, of), got {}", summary(key)));
    names.map_err(wrong)
}

/// Returns what a key selects: a tip, one tip in the frame of another, or the centre of mass.
pub fn subject(robot: &Robot, key: &TipKey) -> PyResult<Subject> {
    let number = |name: &String| robot.tip_number(name).map_err(raise);
    match &key[..] {
        [tip] if tip == CENTER_OF_MASS && robot.tip_number(tip).is_err() => {
            Subject::center_of_mass(robot).map_err(raise)
        }
        [tip] => number(tip).map(Subject::Tip),
        [from, of, ..] => Ok(Subject::Pair { from: number(from)?, of: number(of)? }),
        [] => Err(invalid("a key without a tip".into())),
    }
}

/// Converts a key to a Python object: a name or a pair of names.
pub fn key_object<'py>(py: Python<'py>, key: &TipKey) -> PyResult<Bound<'py, PyAny>> {
    match &key[..] {
        [tip] => Ok(PyString::new(py, tip).into_any()),
        names => Ok(PyTuple::new(py, names)?.into_any()),
    }
}

/// Formats a key for messages.
pub fn in_words(key: &TipKey) -> String {
    match &key[..] {
        [tip] => format!("'{tip}'"),
        names => format!("('{}')", names.join("', '")),
    }
}

/// Formats the names of the tips of a robot for messages.
pub fn tips_in_words(robot: &Robot) -> String {
    robot.tips().map(|tip| format!("'{tip}'")).collect::<Vec<_>>().join(", ")
}
