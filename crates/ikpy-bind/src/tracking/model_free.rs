//! `track_model_free` and `ModelFreeResult`.

use ikcore::path::Reference;
use ikcore::stored::{from_bytes, to_bytes};
use ikcore::tracking::{self, ModelFreeOptions, ModelFreeRecord};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;

use super::control::controller;
use super::plant::{PyKinematicPlant, PythonPlant};
use super::record::{Columns, record};
use crate::convert::{count, table, vector};
use crate::error::raise;
use crate::limits::{PyLimits, Sampling, limits_without_robot};
use crate::monitor::{Watcher, attended};
use crate::outcome::outcome;
use crate::path::PyPath;
use crate::pickling::{self, Reduced};
use crate::python_calls;

/// The record of a track without a model: k rows, row 0 the start at t = 0, row i the tick that ends at t_i = i dt; fewer than
/// the path has where the plant failed.
#[pyclass(name = "ModelFreeResult", module = "beetle_ik", frozen)]
pub struct PyModelFreeResult {
    core: ModelFreeRecord,
    columns: Columns,
    /// The command at which each row's position was measured (k, n) (rad, m): q itself for `BroydenBAS`, an antenna away
    /// from it for `ZNNBAS`.
    #[pyo3(get)]
    command: Py<PyArrayDyn<f64>>,
    /// The limits in force.
    #[pyo3(get)]
    limits: Py<PyLimits>,
    exception: Option<PyErr>,
}

record! {
    PyModelFreeResult = |result| result.core.track,
    /// Configurations that the controller accepted (k, n) (rad, m).
    q,
    /// Positions of the tip as measured (k, 3) (m).
    position,
    /// Measurements of the plant in each step (k,).
    step_evaluations,
    /// Largest excess of a command over a limit (rad, m), probes included; 0 within rounding.
    max_violation,
}

outcome! {
    PyModelFreeResult = |result|
    /// Whether the tip came into the error band and stayed there.
    success,
    /// SOLVED as `success`; LOST if the tip left its band again; PLANT_FAILED where the plant ended the run; else how the last
    /// step ended.
    status: result.core.track.status,
    message: result.core.message(),
    /// Measurements of the plant in all.
    evaluations: result.core.track.evaluations(),
    elapsed: result.core.track.elapsed,
}

#[pymethods]
impl PyModelFreeResult {
    /// Root mean square of the measured error over the second half of the rows (m).
    #[getter]
    fn settled_error(&self) -> f64 {
        self.core.settled_error()
    }

    /// What the plant raised, if it did.
    #[getter]
    fn exception<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyAny>> {
        self.exception.as_ref().map(|error| error.value(py).clone().into_any())
    }

    /// A matplotlib figure: the tip's path, the error, joint angles, measurements.
    fn plot<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        python_calls::plot(slf.into_any(), "model_free")
    }

    fn __repr__(&self) -> String {
        let track = &self.core.track;
        format!("<ModelFreeResult {}: {} rows, {}>", track.status.name(), track.rows(), self.core.message())
    }

    /// What the plant raised goes along as far as it pickles itself.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let core = pickling::bytes(py, to_bytes("track without a model", &self.core))?;
        pickling::restored_from::<Self>(py, (core, self.limits.clone_ref(py), self.exception(py)))
    }

    /// What pickle stored.
    #[staticmethod]
    #[pyo3(signature = (bytes, limits, exception))]
    fn _restore(
        py: Python<'_>,
        bytes: &[u8],
        limits: Py<PyLimits>,
        exception: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let core = from_bytes("track without a model", bytes).map_err(raise)?;
        Self::new(py, core, limits, exception.map(PyErr::from_value))
    }
}

impl PyModelFreeResult {
    fn new(py: Python<'_>, core: ModelFreeRecord, limits: Py<PyLimits>, exception: Option<PyErr>) -> PyResult<Self> {
        let (k, n) = (core.track.rows(), core.track.dof);
        let command = table(py, core.command.clone(), &[k, n])?.unbind();
        Ok(Self { columns: Columns::new(py, &core.track)?, command, limits, exception, core })
    }
}

/// Follows `path` with whatever `plant` moves, knowing nothing of it but what it returns.
///
/// Args:
///     plant: a callable q (n,) -> position of the tip (3,) (m), an object with move(q) that returns one, or a
///         `KinematicPlant`, which needs no Python in the loop. One that raises, or returns what is no position, ends
///         the run with what was recorded (at the very start, where nothing was: its exception comes out).
///     path: positions over time.
///     start: (n,), configuration at t = 0 (rad, m).
///     dt: time step (s). Where it does not divide the path's duration, the last step ends after it, at its end.
///     controller: `BroydenBAS` (None) or `ZNNBAS`.
///     limits: lower, upper and velocity, kept by every command, probes included: all commands of a step lie within reach of
///         the configuration accepted at its start. Fields left None do not limit: there is no robot whose they could be.
///     position_tolerance: the error band (m).
///     seed: of the controller's random draws: the same seed, the same bits.
///     progress: True for a bar on the terminal, or a callable of (done, total).
///
/// Returns:
///     A `ModelFreeResult`. A path that cannot be followed is a status, not an error.
///
/// Raises:
///     InvalidInputError: wrong shape, NaN, dt not positive, a delay longer than the run.
///     LimitError: a start outside the limits, a limit below zero.
///     UnsupportedLimit: acceleration or jerk limits, which no controller keeps.
#[pyfunction]
#[pyo3(signature = (plant, path, start, *, dt, controller=None, limits=None, position_tolerance=1e-9, seed=0, progress=None))]
#[allow(clippy::too_many_arguments)]
pub fn track_model_free(
    py: Python<'_>,
    plant: &Bound<'_, PyAny>,
    path: &PyPath,
    start: &Bound<'_, PyAny>,
    dt: f64,
    controller: Option<&Bound<'_, PyAny>>,
    limits: Option<&PyLimits>,
    position_tolerance: f64,
    seed: i128,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<PyModelFreeResult> {
    let reference = path.reference(py, dt)?;
    let start = vector("start", start)?;
    let sampling = Sampling::of_ticks(dt, reference.len() - 1);
    let (in_force, limits) = limits_without_robot(py, limits, start.len(), &sampling)?;
    let options = ModelFreeOptions {
        controller: self::controller(controller)?,
        limits: Some(limits),
        tolerance: position_tolerance,
        seed: count("seed", seed)?,
    };
    let (core, exception) = attended(py, progress, |watcher| run(plant, &reference, &start, &options, watcher))?;
    PyModelFreeResult::new(py, core, in_force, exception)
}

/// The record, and what a plant of Python's raised. The interpreter is kept where the plant needs it.
fn run(
    plant: &Bound<'_, PyAny>,
    reference: &Reference,
    start: &[f64],
    options: &ModelFreeOptions,
    watcher: &mut Watcher,
) -> PyResult<(ModelFreeRecord, Option<PyErr>)> {
    if let Ok(plant) = plant.cast::<PyKinematicPlant>() {
        let mut fresh = plant.get().fresh(start)?;
        let record = plant.py().detach(|| tracking::track_model_free(&mut fresh, reference, start, options, watcher));
        return Ok((record.map_err(raise)?, None));
    }
    let mut plant = PythonPlant::new(plant)?;
    let record = tracking::track_model_free(&mut plant, reference, start, options, watcher);
    if let Some(interrupt) = plant.take_interrupt() {
        return Err(interrupt);
    }
    match record {
        Ok(record) => Ok((record, plant.exception)),
        // Nothing was recorded: what the plant raised says more than we could.
        Err(error) => Err(plant.exception.unwrap_or_else(|| raise(error))),
    }
}
