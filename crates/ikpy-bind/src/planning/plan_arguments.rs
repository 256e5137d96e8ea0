//! Reading of the arguments that `plan_point_to_point` and `plan_batch` share.

use std::sync::Arc;

use ikcore::obstacle::Surroundings;
use ikcore::planning::{EndTurns, Endpoint, PointToPointOptions};
use pyo3::conversion::FromPyObjectOwned;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use super::endpoints::{plain, read_ends, read_start};
use super::straight_line::read_line;
use super::tpbso::read_method;
use crate::convert::{count, summary, text, vector};
use crate::error::{invalid, misfit, raise};
use crate::keep::read_keeps;
use crate::limits::{PyLimits, Sampling, limits_of_call};
use crate::obstacle::GivenObstacles;
use crate::python_calls;
use crate::robot::PyRobot;
use crate::solver::PyStop;
use crate::start_gate::read_slack;
use crate::task::read_task;

type Argument<'py> = Option<Bound<'py, PyAny>>;

/// The ends as passed from Python.
#[derive(Default)]
pub struct EndArguments<'py> {
    pub start: Argument<'py>,
    pub end: Argument<'py>,
    pub start_q: Argument<'py>,
    pub end_q: Argument<'py>,
}

impl EndArguments<'_> {
    /// Converts the arguments to the start and the possible ends; `task` applies to targets of several tips.
    pub fn read(&self, robot: &PyRobot, task: &Argument<'_>) -> PyResult<(Endpoint, Vec<Endpoint>)> {
        let start = read_start(robot, self.start.as_ref(), self.start_q.as_ref(), task.as_ref())?;
        Ok((start, read_ends(robot, self.end.as_ref(), self.end_q.as_ref(), task.as_ref())?))
    }
}

/// Arguments of a plan other than its ends, as passed from Python; None: the default.
#[derive(Default, Clone)]
pub struct PlanArguments<'py> {
    pub start_qd: Argument<'py>,
    pub start_slack: Argument<'py>,
    pub end_turns: Argument<'py>,
    pub approach: Argument<'py>,
    pub retreat: Argument<'py>,
    pub free_start: Argument<'py>,
    pub task: Argument<'py>,
    pub keep: Argument<'py>,
    pub limits: Argument<'py>,
    pub method: Argument<'py>,
    pub objective: Argument<'py>,
    pub obstacles: Argument<'py>,
    pub margin: Argument<'py>,
    pub self_collision: Argument<'py>,
    pub stop: Argument<'py>,
    pub seed: Argument<'py>,
}

/// Options of a plan, and the arguments that its result stores.
pub struct ReadOptions {
    pub core: Arc<PointToPointOptions>,
    pub limits: Py<PyLimits>,
    pub obstacles: Py<PyTuple>,
}

impl PlanArguments<'_> {
    /// Converts the arguments to options of the core.
    pub fn read(&self, py: Python<'_>, robot: &PyRobot) -> PyResult<ReadOptions> {
        self.read_among(py, robot, GivenObstacles::read_for(py, robot, self.obstacles.as_ref())?)
    }

    /// Converts the arguments of a problem that may override some of `all`. Common obstacles are not read again.
    pub fn read_over(
        &self,
        py: Python<'_>,
        robot: &PyRobot,
        all: &Self,
        of_all: &ReadOptions,
    ) -> PyResult<ReadOptions> {
        let obstacles = match (&self.obstacles, &all.obstacles) {
            (Some(own), Some(common)) if own.is(common) => {
                let core = of_all.core.surroundings.obstacles.clone().unwrap_or_default();
                GivenObstacles { core, tuple: of_all.obstacles.clone_ref(py) }
            }
            (own, _) => GivenObstacles::read_for(py, robot, own.as_ref())?,
        };
        self.read_among(py, robot, obstacles)
    }

    fn read_among(&self, py: Python<'_>, robot: &PyRobot, obstacles: GivenObstacles) -> PyResult<ReadOptions> {
        let given = self.limits.as_ref().map(|limits| cast::<PyLimits>("limits", limits)).transpose()?;
        let (in_force, limits) = limits_of_call(py, given.as_ref().map(|given| given.get()), robot, &Sampling::once())?;
        let objective = self.objective.as_ref();
        let objective = objective.map(|name| text(name).map_err(|error| in_argument("objective", name, error)));
        let objective = objective.transpose()?;
        let stop = self.stop.as_ref().map(|stop| cast::<PyStop>("stop", stop)).transpose()?;
        let core = PointToPointOptions {
            start_slack: read_slack(self.start_slack.as_ref())?,
            end_turns: self.end_turns()?,
            start_velocity: self.start_qd.as_ref().map(|qd| vector("start_qd", qd)).transpose()?,
            approach: read_line("approach", self.approach.as_ref())?,
            retreat: read_line("retreat", self.retreat.as_ref())?,
            free_start: extracted("free_start", self.free_start.as_ref())?.unwrap_or(false),
            // Tasks of several tips belong to their targets.
            task: match &self.task {
                Some(task) if robot.core.tip_count() == 1 => read_task(Some(&plain("task", robot, task)?))?,
                _ => None,
            },
            keeps: read_keeps(robot, self.keep.as_ref())?,
            method: read_method(self.method.as_ref())?,
            objective: objective.map_or(Ok(Default::default()), str::parse).map_err(raise)?,
            surroundings: Surroundings {
                obstacles: Some(obstacles.core),
                margin: extracted("margin", self.margin.as_ref())?,
                self_collision: extracted("self_collision", self.self_collision.as_ref())?,
            },
            limits,
            stop: stop.map(|stop| stop.get().core()),
            seed: extracted("seed", self.seed.as_ref())?.map_or(Ok(0), |seed: i128| count("seed", seed))?,
        };
        Ok(ReadOptions { core: Arc::new(core), limits: in_force, obstacles: obstacles.tuple })
    }
}

impl PlanArguments<'_> {
    /// The whole turns of end configurations.
    fn end_turns(&self) -> PyResult<EndTurns> {
        let Some(value) = &self.end_turns else { return Ok(EndTurns::default()) };
        let name = text(value).map_err(|error| in_argument("end_turns", value, error))?;
        name.parse().map_err(raise)
    }
}

/// Reads the arguments of one problem from its dict. Missing options come from `common`; the options are None if the
/// dict has none.
pub fn read_problem<'py>(
    problem: &Bound<'py, PyAny>,
    common: &PlanArguments<'py>,
) -> PyResult<(EndArguments<'py>, Option<PlanArguments<'py>>)> {
    let Ok(problem) = problem.cast::<PyDict>() else {
        return Err(invalid(format!("expected a dict of arguments of plan_point_to_point, got {}", summary(problem))));
    };
    let mut ends = EndArguments::default();
    let mut own: Option<PlanArguments<'py>> = None;
    for (key, value) in problem {
        let value = Some(value).filter(|value| !value.is_none());
        let name = key.extract::<String>().unwrap_or_default();
        if let Some(end) = ends.named(&name) {
            *end = value;
        } else if let Some(option) = own.get_or_insert_with(|| common.clone()).named(&name) {
            *option = value;
        } else {
            let known = [EndArguments::NAMES, PlanArguments::NAMES].concat().join(", ");
            return Err(invalid(format!("{} is no argument of a problem; its arguments: {known}", summary(&key))));
        }
    }
    Ok((ends, own))
}

/// Defines access to the fields of a struct of arguments by name.
macro_rules! named {
    ($class:ident: $($field:ident),+) => {
        impl<'py> $class<'py> {
            /// The names of the arguments.
            pub const NAMES: &'static [&'static str] = &[$(stringify!($field)),+];

            /// Returns the argument of this name, if there is one.
            fn named(&mut self, name: &str) -> Option<&mut Argument<'py>> {
                match name {
                    $(stringify!($field) => Some(&mut self.$field),)+
                    _ => None,
                }
            }
        }
    };
}

named!(EndArguments: start, end, start_q, end_q);
named!(
    PlanArguments: start_qd, start_slack, end_turns, approach, retreat, free_start, task, keep, limits, method, objective, obstacles, margin,
    self_collision, stop, seed
);

/// Extracts a number or a truth value; errors name the argument.
fn extracted<T: for<'py> FromPyObjectOwned<'py>>(name: &str, value: Option<&Bound<'_, PyAny>>) -> PyResult<Option<T>> {
    let Some(value) = value else { return Ok(None) };
    value.extract::<T>().map(Some).map_err(|error| in_argument(name, value, error.into()))
}

/// Casts an argument to its class; errors name the argument.
fn cast<'py, T: pyo3::PyTypeInfo>(name: &str, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, T>> {
    value.cast::<T>().cloned().map_err(|error| in_argument(name, value, error.into()))
}

/// Names the argument and its value in an error of its type.
fn in_argument(name: &str, value: &Bound<'_, PyAny>, error: PyErr) -> PyErr {
    if error.is_instance_of::<PyTypeError>(value.py()) {
        return python_calls::misfit(name, value, &error).map_or_else(|other| other, misfit);
    }
    error
}
