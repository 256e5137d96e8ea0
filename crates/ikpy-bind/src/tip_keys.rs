//! Keys of dicts for several tips: names of tips, or pairs of them.

use std::sync::Arc;

use ikcore::robot::Robot;
use ikcore::task::Subject;
use pyo3::prelude::*;
use pyo3::types::{PyString, PyTuple};

use crate::convert::summary;
use crate::error::{invalid, raise};

/// The name of a tip, or of a tip and the one that is seen from it.
pub type TipKey = Vec<String>;

/// What the targets of a call are for.
#[derive(Debug, Clone)]
pub struct TipKeys(pub Arc<[TipKey]>);

impl TipKeys {
    /// The tips of a robot.
    pub fn of(robot: &Robot) -> Self {
        Self(robot.tips().map(|tip| vec![tip.to_owned()]).collect())
    }

    /// Each key.
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

/// The pose that a key stands for.
pub fn subject(robot: &Robot, key: &TipKey) -> PyResult<Subject> {
    let number = |name: &String| robot.tip_number(name).map_err(raise);
    match &key[..] {
        [tip] => number(tip).map(Subject::Tip),
        [from, of, ..] => Ok(Subject::Pair { from: number(from)?, of: number(of)? }),
        [] => Err(invalid("a key without a tip".into())),
    }
}

/// The key as Python has it.
pub fn key_object<'py>(py: Python<'py>, key: &TipKey) -> PyResult<Bound<'py, PyAny>> {
    match &key[..] {
        [tip] => Ok(PyString::new(py, tip).into_any()),
        names => Ok(PyTuple::new(py, names)?.into_any()),
    }
}

/// The key in messages.
pub fn in_words(key: &TipKey) -> String {
    match &key[..] {
        [tip] => format!("'{tip}'"),
        names => format!("('{}')", names.join("', '")),
    }
}

/// The tips of a robot in messages.
pub fn tips_in_words(robot: &Robot) -> String {
    robot.tips().map(|tip| format!("'{tip}'")).collect::<Vec<_>>().join(", ")
}
