//! Targets of several tips: dicts by [`TipKeys`].

use ikcore::ik::SolveOptions;
use ikcore::robot::Robot;
use ikcore::stored::{from_bytes, to_bytes};
use ikcore::task::{Subject, TargetRow, Task, TipError, TipTask, Tolerance};
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
    /// Reads a target of a robot, each by `read`, which gets what to call it in errors.
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

    /// What each is for.
    pub fn keys(&self, robot: &PyRobot) -> TipKeys {
        match self {
            Self::One(_) => robot.tips.clone(),
            Self::Tips { keys, .. } => keys.clone(),
        }
    }

    /// The values, in the order of their keys.
    pub fn values(&self) -> &[T] {
        match self {
            Self::One(one) => std::slice::from_ref(one),
            Self::Tips { values, .. } => values,
        }
    }

    /// The poses that they are for, of several tips.
    pub fn subjects(&self) -> Option<&[Subject]> {
        match self {
            Self::One(_) => None,
            Self::Tips { subjects, .. } => Some(subjects),
        }
    }
}

/// Reads what is for the only tip of a robot: plain, or in a dict with its name.
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

/// A tolerance: one for all, or a dict.
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

/// The task and tolerances of each tip, or of the only one.
pub struct TaskArguments<'a, 'py> {
    pub task: Option<&'a Bound<'py, PyAny>>,
    pub position_tolerance: &'a ToleranceArgument<'py>,
    pub rotation_tolerance: &'a ToleranceArgument<'py>,
}

impl TaskArguments<'_, '_> {
    /// Writes them into `options`, for the targets that were `asked`.
    pub fn write<T>(&self, robot: &PyRobot, asked: &Asked<T>, options: &mut SolveOptions) -> PyResult<()> {
        if let (Asked::One(_), ToleranceArgument::All(position), ToleranceArgument::All(rotation)) =
            (asked, self.position_tolerance, self.rotation_tolerance)
            && !self.task.is_some_and(|task| task.is_instance_of::<PyDict>())
        {
            options.task = read_task(self.task)?;
            options.tolerance = Tolerance { position: *position, rotation: *rotation };
            return Ok(());
        }
        let (robot, keys) = (&*robot.core, asked.keys(robot));
        let tasks = match self.task.map(|task| (task, task.cast::<PyDict>())) {
            Some((_, Ok(dict))) => {
                let each = of_each("task", robot, &keys, dict)?;
                each.iter().map(|task| read_task(task.as_ref())).collect::<PyResult<Vec<_>>>()?
            }
            Some((task, Err(_))) => vec![read_task(Some(task))?; keys.0.len()],
            None => vec![None; keys.0.len()],
        };
        let position = tolerances("position_tolerance", self.position_tolerance, robot, &keys)?;
        let rotation = tolerances("rotation_tolerance", self.rotation_tolerance, robot, &keys)?;
        let tolerance = |i: usize| Tolerance { position: position[i], rotation: rotation[i] };
        match asked.subjects() {
            None => (options.task, options.tolerance) = (tasks[0], tolerance(0)),
            Some(subjects) => {
                let tips = subjects.iter().zip(tasks).enumerate();
                let task = |(i, (subject, task)): (usize, (&Subject, _))| TipTask {
                    subject: *subject,
                    task,
                    tolerance: tolerance(i),
                };
                options.tips = tips.map(task).collect();
            }
        }
        Ok(())
    }
}

/// Task and tolerances by tip, of calls whose targets come later.
#[derive(Debug)]
pub struct TipSettings {
    task: Each<Option<Task>>,
    position: Each<f64>,
    rotation: Each<f64>,
}

/// A value for all keys, or the values of some and the one of the others.
#[derive(Debug)]
struct Each<T> {
    keys: Vec<(TipKey, T)>,
    others: T,
}

impl<T: Copy> Each<T> {
    fn of(&self, key: &TipKey) -> T {
        self.keys.iter().find(|(known, _)| known == key).map_or(self.others, |(_, value)| *value)
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
    /// Reads them.
    pub fn read(robot: &PyRobot, arguments: &TaskArguments<'_, '_>) -> PyResult<Self> {
        let robot = &*robot.core;
        let task = match arguments.task.map(|task| (task, task.cast::<PyDict>())) {
            Some((_, Ok(dict))) => Each::read("task", robot, dict, None, |task| read_task(Some(task)))?,
            Some((task, Err(_))) => Each { keys: vec![], others: read_task(Some(task))? },
            None => Each { keys: vec![], others: None },
        };
        let tolerance = |what: &str, given: &ToleranceArgument<'_>| match given {
            ToleranceArgument::All(all) => Ok(Each { keys: vec![], others: *all }),
            ToleranceArgument::Each(dict) => {
                Each::read(what, robot, dict, Tolerance::default().position, |value| value.extract())
            }
        };
        let position = tolerance("position_tolerance", arguments.position_tolerance)?;
        let rotation = tolerance("rotation_tolerance", arguments.rotation_tolerance)?;
        Ok(Self { task, position, rotation })
    }

    /// Task and tolerance of the only tip of a robot.
    pub fn of_only(&self, robot: &Robot) -> (Option<Task>, Tolerance) {
        self.of(&robot.tips().map(str::to_owned).collect())
    }

    /// The tasks of the targets that were `asked` of several tips; none of one.
    pub fn tasks<T>(&self, asked: &Asked<T>) -> Vec<TipTask> {
        let Asked::Tips { keys, subjects, .. } = asked else { return vec![] };
        let task = |(key, subject): (_, &Subject)| {
            let (task, tolerance) = self.of(key);
            TipTask { subject: *subject, task, tolerance }
        };
        keys.iter().zip(subjects).map(task).collect()
    }

    fn of(&self, key: &TipKey) -> (Option<Task>, Tolerance) {
        (self.task.of(key), Tolerance { position: self.position.of(key), rotation: self.rotation.of(key) })
    }
}

fn tolerances(what: &str, given: &ToleranceArgument<'_>, robot: &Robot, keys: &TipKeys) -> PyResult<Vec<f64>> {
    match given {
        ToleranceArgument::All(all) => Ok(vec![*all; keys.0.len()]),
        ToleranceArgument::Each(dict) => {
            let each = of_each(what, robot, keys, dict)?;
            each.iter()
                .map(|value| value.as_ref().map_or(Ok(Tolerance::default().position), |value| value.extract()))
                .collect()
        }
    }
}

/// The value of `dict` for each of `keys`.
fn of_each<'py>(
    what: &str,
    robot: &Robot,
    keys: &TipKeys,
    dict: &Bound<'py, PyDict>,
) -> PyResult<Vec<Option<Bound<'py, PyAny>>>> {
    let mut each = vec![None; keys.0.len()];
    for (key, value) in dict {
        let key = read_key(what, &key)?;
        subject(robot, &key)?;
        let Some(place) = keys.iter().position(|known| *known == key) else {
            return Err(invalid(format!("{what} names {}, which has no target", in_words(&key))));
        };
        each[place] = Some(value);
    }
    Ok(each)
}

/// The errors of what was `asked` at the configurations `qs` (m, n); `targets` returns those of a row.
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
    Ok(TipErrors { keys: asked.keys(robot), errors })
}

/// What was asked of each tip, and the errors; without errors of each for the only tip.
#[derive(Debug, Clone)]
pub struct TipErrors {
    pub keys: TipKeys,
    /// One for each key, row by row; none for the only tip.
    pub errors: Vec<TipError>,
}

impl TipErrors {
    /// Those of the only tip, whose errors the result itself has.
    pub fn of_one(keys: TipKeys) -> Self {
        Self { keys, errors: vec![] }
    }

    /// Those of the only tip of an arm without a model.
    pub fn unnamed() -> Self {
        Self::of_one(TipKeys([vec!["tip".to_owned()]].into()))
    }

    /// The rows `rows`.
    pub fn select(&self, rows: &[usize]) -> Self {
        let count = self.keys.0.len();
        let errors = match self.errors[..] {
            [] => vec![],
            _ => rows.iter().flat_map(|row| self.errors[row * count..(row + 1) * count].iter().copied()).collect(),
        };
        Self { keys: self.keys.clone(), errors }
    }

    /// A dict with what `value` makes of the errors of each key, row by row; `only` are those of the only tip.
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

    /// A dict with what `value` makes of the rows of each key in `table`, which has a value for each key in each row.
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

    /// For pickling.
    pub fn bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let keys: Vec<&TipKey> = self.keys.iter().collect();
        pickling::bytes(py, to_bytes("errors of tips", &(keys, &self.errors)))
    }

    /// From bytes; before robots had several tips, results were stored without.
    pub fn restored(bytes: Option<&[u8]>) -> PyResult<Self> {
        let Some(bytes) = bytes else { return Ok(Self::unnamed()) };
        let (keys, errors): (Vec<TipKey>, Vec<TipError>) = from_bytes("errors of tips", bytes).map_err(raise)?;
        Ok(Self { keys: TipKeys(keys.into()), errors })
    }
}
