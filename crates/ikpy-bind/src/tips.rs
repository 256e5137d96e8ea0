//! Targets of several tips: dicts by [`TipKeys`].

use ikcore::ik::SolveOptions;
use ikcore::robot::Robot;
use ikcore::stored::{from_bytes, to_bytes};
use ikcore::task::{NamedTask, Subject, TargetRow, Task, TipError, Tolerance};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::error::{invalid, raise};
use crate::pickling;
use crate::robot::PyRobot;
use crate::task::read_task;
use crate::tip_keys::{TipKey, TipKeys, in_words, key_object, read_key, subject, tips_in_words};

/// A target for the only tip, or one for each of some tips.
pub enum Asked<T> {
    One(T),
    Tips { keys: TipKeys, subjects: Vec<Subject>, values: Vec<T> },
}

impl<T> Asked<T> {
    /// Reads the target of the only tip, or a dict of targets; `read` gets the name for errors and the value of each.
    pub fn read<'py>(
        what: &str,
        robot: &PyRobot,
        value: &Bound<'py, PyAny>,
        read: impl Fn(&str, &Bound<'py, PyAny>) -> PyResult<T>,
    ) -> PyResult<Self> {
        let core = &*robot.core;
        let Ok(dict) = value.cast::<PyDict>() else {
            if core.tip_count() == 1 {
                return read(what, value).map(Self::One);
            }
            let (name, tips) = (core.name(), tips_in_words(core));
            return Err(invalid(format!(
                "{what}: robot '{name}' has several tips, {tips}: give a dict, such as {{'{}': {what}}}",
                core.tips().next().unwrap_or_default()
            )));
        };
        if dict.is_empty() {
            return Err(invalid(format!("{what}: the dict is empty; name one tip at least: {}", tips_in_words(core))));
        }
        let mut keys = vec![];
        let (mut subjects, mut values) = (vec![], vec![]);
        for (key, value) in dict {
            let key = read_key(what, &key)?;
            subjects.push(subject(core, &key)?);
            values.push(read(&format!("{what} of {}", in_words(&key)), &value)?);
            keys.push(key);
        }
        match (core.tip_count(), values.pop()) {
            (1, Some(only)) => Ok(Self::One(only)),
            (_, last) => {
                values.extend(last);
                Ok(Self::Tips { keys: TipKeys(keys.into()), subjects, values })
            }
        }
    }

    /// Returns the keys of the targets.
    pub fn keys<'a>(&'a self, robot: &'a PyRobot) -> &'a TipKeys {
        match self {
            Self::One(_) => &robot.tips,
            Self::Tips { keys, .. } => keys,
        }
    }

    /// Returns the values, each with its subject.
    pub fn iter(&self) -> impl Iterator<Item = (Subject, &T)> {
        let subjects: &[Subject] = match self {
            Self::One(_) => &[Subject::Tip(0)],
            Self::Tips { subjects, .. } => subjects,
        };
        subjects.iter().copied().zip(self.values())
    }

    /// Returns the values, in the order of their keys.
    pub fn values(&self) -> &[T] {
        match self {
            Self::One(one) => std::slice::from_ref(one),
            Self::Tips { values, .. } => values,
        }
    }
}

/// Reads the value for the only tip of a robot: plain, or in a dict under its name.
pub fn read_only<'py, T>(
    what: &str,
    robot: &PyRobot,
    value: &Bound<'py, PyAny>,
    read: impl Fn(&str, &Bound<'py, PyAny>) -> PyResult<T>,
) -> PyResult<T> {
    match Asked::read(what, robot, value, read)? {
        Asked::One(one) => Ok(one),
        Asked::Tips { .. } => Err(invalid(format!("{what}: expected one for the only tip"))),
    }
}

/// A tolerance for all tips, or a dict by tip.
pub enum ToleranceArgument<'py> {
    All(f64),
    Each(Bound<'py, PyDict>),
}

/// Reads a tolerance.
pub fn read_tolerance<'py>(value: &Bound<'py, PyAny>) -> PyResult<ToleranceArgument<'py>> {
    match value.cast::<PyDict>() {
        Ok(dict) => Ok(ToleranceArgument::Each(dict.clone())),
        Err(_) => value.extract().map(ToleranceArgument::All),
    }
}

/// Arguments for task and tolerances, of one tip or several.
pub struct TaskArguments<'a, 'py> {
    pub task: Option<&'a Bound<'py, PyAny>>,
    pub position_tolerance: &'a ToleranceArgument<'py>,
    pub rotation_tolerance: &'a ToleranceArgument<'py>,
}

impl TaskArguments<'_, '_> {
    /// Reads task and tolerances before the targets are known.
    pub fn read(&self, robot: &PyRobot) -> PyResult<TipSettings> {
        let robot = &*robot.core;
        let dict = self.task.and_then(|task| task.cast::<PyDict>().ok());
        let task = match dict {
            Some(dict) => Each::read("task", robot, dict, None, |task| read_task(Some(task)))?,
            None => Each { keys: vec![], others: read_task(self.task)? },
        };
        let tolerance = |what: &str, given: &ToleranceArgument<'_>| match given {
            ToleranceArgument::All(all) => Ok(Each { keys: vec![], others: *all }),
            ToleranceArgument::Each(dict) => {
                Each::read(what, robot, dict, Tolerance::default().position, |value| value.extract())
            }
        };
        let position = tolerance("position_tolerance", self.position_tolerance)?;
        let rotation = tolerance("rotation_tolerance", self.rotation_tolerance)?;
        Ok(TipSettings { task, position, rotation })
    }

    /// Reads task and tolerances for the targets `asked`; an error for a tip without a target.
    pub fn read_for<T>(&self, robot: &PyRobot, asked: &Asked<T>) -> PyResult<TipSettings> {
        let (settings, keys) = (self.read(robot)?, asked.keys(robot));
        settings.task.require_targets("task", keys)?;
        settings.position.require_targets("position_tolerance", keys)?;
        settings.rotation.require_targets("rotation_tolerance", keys)?;
        Ok(settings)
    }
}

/// Reads the `task` of a call that plans for several tips: one for all of them, or a dict by tip.
pub fn read_tip_tasks(robot: &PyRobot, value: Option<&Bound<'_, PyAny>>) -> PyResult<(Option<Task>, Vec<TipTask>)> {
    let Some(dict) = value.and_then(|value| value.cast::<PyDict>().ok()) else {
        return Ok((read_task(value)?, vec![]));
    };
    let tasks = Each::read("task", &robot.core, dict, None, |task| read_task(Some(task)))?;
    let of_tip = |(key, task): &(TipKey, Option<Task>)| match subject(&robot.core, key)? {
        Subject::Tip(tip) => Ok((tip, *task)),
        _ => Err(invalid(format!("task of {}: moves lead single tips, {}", in_words(key), tips_in_words(&robot.core)))),
    };
    Ok((None, tasks.keys.iter().map(of_tip).collect::<PyResult<_>>()?))
}

/// The number of a tip, and its task.
type TipTask = (usize, Option<Task>);

/// Task and tolerances by tip.
#[derive(Debug)]
pub struct TipSettings {
    task: Each<Option<Task>>,
    position: Each<f64>,
    rotation: Each<f64>,
}

/// Values of some keys, and one value for all others.
#[derive(Debug)]
struct Each<T> {
    keys: Vec<(TipKey, T)>,
    others: T,
}

impl<T: Copy> Each<T> {
    fn of(&self, key: &TipKey) -> T {
        self.keys.iter().find(|(known, _)| known == key).map_or(self.others, |(_, value)| *value)
    }

    /// Returns an error for values of tips that are not among `keys`, the keys of the targets.
    fn require_targets(&self, what: &str, keys: &TipKeys) -> PyResult<()> {
        let stranger = self.keys.iter().find(|(name, _)| !keys.iter().any(|key| key == name));
        stranger
            .map_or(Ok(()), |(name, _)| Err(invalid(format!("{what} names {}, which has no target", in_words(name)))))
    }

    /// Reads a dict, each value by `read`.
    fn read<'py>(
        what: &str,
        robot: &Robot,
        dict: &Bound<'py, PyDict>,
        others: T,
        read: impl Fn(&Bound<'py, PyAny>) -> PyResult<T>,
    ) -> PyResult<Self> {
        let one = |(key, value): (Bound<'py, PyAny>, Bound<'py, PyAny>)| {
            let key = read_key(what, &key)?;
            subject(robot, &key)?;
            Ok((key, read(&value)?))
        };
        Ok(Self { keys: dict.iter().map(one).collect::<PyResult<_>>()?, others })
    }
}

impl TipSettings {
    /// Returns task and tolerance of the only tip of a robot; the defaults for several tips.
    pub fn of_only(&self, robot: &PyRobot) -> (Option<Task>, Tolerance) {
        if robot.core.tip_count() == 1 { self.of(&robot.tips.0[0]) } else { Default::default() }
    }

    /// Returns the tasks of the targets `asked` of several tips; empty for the only tip.
    pub fn tasks<T>(&self, asked: &Asked<T>) -> Vec<NamedTask> {
        let Asked::Tips { keys, subjects, .. } = asked else { return vec![] };
        let task = |(key, subject): (_, &Subject)| {
            let (task, tolerance) = self.of(key);
            NamedTask { subject: *subject, task, tolerance }
        };
        keys.iter().zip(subjects).map(task).collect()
    }

    fn of(&self, key: &TipKey) -> (Option<Task>, Tolerance) {
        (self.task.of(key), Tolerance { position: self.position.of(key), rotation: self.rotation.of(key) })
    }
}

/// Computes the errors of the targets `asked` at the configurations `qs` (m, n); `targets` gives the targets of each
/// row.
pub fn tip_errors<T>(
    robot: &PyRobot,
    asked: &Asked<T>,
    targets: impl Fn(usize) -> TargetRow,
    options: &SolveOptions,
    qs: &[f64],
) -> PyResult<TipErrors> {
    let errors = match asked {
        Asked::One(_) => vec![],
        Asked::Tips { .. } => ikcore::ik::tip_errors(&robot.core, targets, options, qs).map_err(raise)?,
    };
    Ok(TipErrors { keys: asked.keys(robot).clone(), errors })
}

/// Keys of the targets, and their errors.
#[derive(Debug, Clone)]
pub struct TipErrors {
    pub keys: TipKeys,
    /// Errors by key, row by row; empty for the only tip, whose errors the result itself has.
    pub errors: Vec<TipError>,
}

impl TipErrors {
    /// Keeps the key of the only tip, whose errors the result itself has.
    pub fn of_one(keys: TipKeys) -> Self {
        Self { keys, errors: vec![] }
    }

    /// Keeps a default key, for the only tip of an arm without a model.
    pub fn unnamed() -> Self {
        Self::of_one(TipKeys([vec!["tip".to_owned()]].into()))
    }

    /// Selects `rows`.
    pub fn select(&self, rows: &[usize]) -> Self {
        let count = self.keys.0.len();
        let errors = match self.errors[..] {
            [] => vec![],
            _ => rows.iter().flat_map(|row| self.errors[row * count..(row + 1) * count].iter().copied()).collect(),
        };
        Self { keys: self.keys.clone(), errors }
    }

    /// Makes a dict from each key to `value` of its errors, row by row; `only` gives the errors of the only tip.
    pub fn dict<'py, V: IntoPyObject<'py>>(
        &self,
        py: Python<'py>,
        only: impl Iterator<Item = TipError> + Clone,
        value: impl Fn(&mut dyn Iterator<Item = TipError>) -> V,
    ) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (i, key) in self.keys.iter().enumerate() {
            let value = match self.errors[..] {
                [] => value(&mut only.clone()),
                _ => value(&mut self.errors.iter().skip(i).step_by(self.keys.0.len()).copied()),
            };
            dict.set_item(key_object(py, key)?, value)?;
        }
        Ok(dict)
    }

    /// Makes a dict from each key to `value` of its column in `table`, which has one entry per key in each row.
    pub fn columns<'py, T: Copy, V: IntoPyObject<'py>>(
        &self,
        py: Python<'py>,
        table: &[T],
        value: impl Fn(&mut dyn Iterator<Item = T>) -> V,
    ) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (i, key) in self.keys.iter().enumerate() {
            let mut rows = table.iter().skip(i).step_by(self.keys.0.len()).copied();
            dict.set_item(key_object(py, key)?, value(&mut rows))?;
        }
        Ok(dict)
    }

    /// Converts keys and errors to bytes, for pickling.
    pub fn bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let keys: Vec<&TipKey> = self.keys.iter().collect();
        pickling::bytes(py, to_bytes("errors of tips", &(keys, &self.errors)))
    }

    /// Restores keys and errors from bytes; None: a result stored before robots could have several tips.
    pub fn restored(bytes: Option<&[u8]>) -> PyResult<Self> {
        let Some(bytes) = bytes else { return Ok(Self::unnamed()) };
        let (keys, errors): (Vec<TipKey>, Vec<TipError>) = from_bytes("errors of tips", bytes).map_err(raise)?;
        Ok(Self { keys: TipKeys(keys.into()), errors })
    }
}
