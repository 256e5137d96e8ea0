//! `track_model_free` and `ModelFreeResult`.

use ikcore::path::Reference;
use ikcore::stored::{from_bytes, to_bytes};
use ikcore::task::Tolerance;
use ikcore::tracking::{self, ModelFreeOptions, ModelFreeRecord};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::exceptions::PyBaseException;
use pyo3::prelude::*;

use super::control::controller;
use super::plant::{PyKinematicPlant, PythonPlant};
use super::record::{Columns, record};
use crate::convert::{count, table, vector};
use crate::error::raise;
use crate::limits::{PyLimits, Sampling, limits_without_robot};
use crate::monitor::{Watcher, watched_with_interpreter};
use crate::outcome::outcome;
use crate::path::path_argument;
use crate::pickling::{self, Reduced};
use crate::python_calls;
use crate::traversal::traversed;
use crate::wording::said;

/// The record of a track without a model, k rows: row 0 is the start at t = 0, row i the tick that ends at t_i = i dt. If the
/// plant fails, the record ends there.
#[pyclass(name = "ModelFreeResult", module = "beetle_ik", frozen)]
pub struct PyModelFreeResult {
    core: ModelFreeRecord,
    columns: Columns,
    /// Commands at which the positions were measured (k, n) (rad, m): equal to q for `BroydenBAS`, one antenna away
    /// from q for `ZNNBAS`.
    #[pyo3(get)]
    command: Py<PyArrayDyn<f64>>,
    /// The limits in force.
    #[pyo3(get)]
    limits: Py<PyLimits>,
    /// The exception that the plant raised, or None.
    #[pyo3(get)]
    exception: Option<Py<PyBaseException>>,
}

traversed!(PyModelFreeResult: limits, exception);

record! {
    PyModelFreeResult = |result| result.core.track,
    /// Configurations accepted by the controller (k, n) (rad, m).
    q,
    /// Measured positions of the tip (k, 3) (m).
    position,
    /// Measurements of the plant in each step (k,).
    step_evaluations,
    /// Largest excess of a command over a limit (rad, m), probes included; 0 within rounding.
    max_violation,
}

outcome! {
    PyModelFreeResult = |result|
    /// Whether the tip reached the error band and stayed there.
    success,
    /// SOLVED on `success`; LOST if the tip left its band again; PLANT_FAILED if the plant failed; otherwise the status of the
    /// last step.
    status: result.core.track.status,
    message: result.core.message(),
    /// Total number of measurements.
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

    /// Draws the path of the tip, the error, the joint positions and the measurements; returns a matplotlib figure.
    fn plot<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        python_calls::plot(slf.into_any(), "model_free")
    }

    fn __repr__(&self) -> String {
        let track = &self.core.track;
        format!("<ModelFreeResult {}: {} rows, {}>", track.status.name(), track.rows(), self.message())
    }

    /// Keeps the exception of the plant if it can be pickled.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let core = pickling::bytes(py, to_bytes("track without a model", &self.core))?;
        pickling::restored_from::<Self>(py, (core, &self.limits, &self.exception))
    }

    /// Restores a pickled value.
    #[staticmethod]
    #[pyo3(signature = (bytes, limits, exception))]
    fn _restore(
        py: Python<'_>,
        bytes: &[u8],
        limits: Py<PyLimits>,
        exception: Option<Py<PyBaseException>>,
    ) -> PyResult<Self> {
        Self::new(py, from_bytes("track without a model", bytes).map_err(raise)?, limits, exception)
    }
}

impl PyModelFreeResult {
    fn new(
        py: Python<'_>,
        core: ModelFreeRecord,
        limits: Py<PyLimits>,
        exception: Option<Py<PyBaseException>>,
    ) -> PyResult<Self> {
        let (k, n) = (core.track.rows(), core.track.dof);
        let command = table(py, core.command.clone(), &[k, n])?.unbind();
        Ok(Self { columns: Columns::new(py, &core.track)?, command, limits, exception, core })
    }
}

/// Follows a path without a model: the controller commands joint positions and measures the tip.
///
/// If the path has orientations, the controller follows these too, and the plant must measure poses; a radian of error
/// counts as much as a metre. If the path has none, the orientation is free, whatever the plant measures.
///
/// Args:
///     plant: a callable that takes q (n,) and returns the tip position (3,) (m) or its pose (4, 4); an object whose
///         method `move` does so; or a `KinematicPlant`, which runs without Python in the loop. If the plant raises an
///         exception or returns anything else, the run ends with the record so far; on the first measurement, the
///         exception propagates.
///     path: reference positions, or poses, over time.
///     start_q: (n,), configuration at t = 0 (rad, m), up to 0.087 (5 degrees) outside the limits; the arm then begins there and is led
///         inside.
///     dt: time step (s). If it does not divide the path's duration, the last step ends after it, at the path's end.
///     controller: `BroydenBAS` or `ZNNBAS`; None: `BroydenBAS()`.
///     limits: lower, upper and velocity limits, kept by all commands, including probes: each is reachable from the
///         configuration accepted at the start of its step. None means unlimited.
///     position_tolerance: error band (m).
///     rotation_tolerance: error band of orientations (rad).
///     seed: seed of the controller's random draws; the same seed gives the same bits.
///     progress: True shows a progress bar; a callable is called with (done, total).
///
/// Returns:
///     A `ModelFreeResult`. If the path cannot be followed, its status says why; that is not an error.
///
/// Raises:
///     InvalidInputError: wrong shape, NaN, a time step that is not positive, or a delay longer than the run.
///     LimitError: a start more than 5 degrees outside the limits, or a negative limit.
///     UnsupportedLimit: acceleration or jerk limits, which no controller keeps.
///
/// For example:
///
///     >>> arm = bik.Robot.planar([0.5, 0.4, 0.3])
///     >>> path = bik.paths.circle([0.6, 0.3, 0.0], 0.2, 5.0)
///     >>> run = bik.track_model_free(bik.KinematicPlant(arm), path, [0.4, 0.5, 0.6], dt=0.01)
///     >>> run.settled_error < 1e-6
///     True
#[pyfunction]
#[pyo3(signature = (plant, path, start_q, *, dt, controller=None, limits=None, position_tolerance=1e-9,
                    rotation_tolerance=1e-9, seed=0, progress=None))]
#[allow(clippy::too_many_arguments)]
pub fn track_model_free(
    py: Python<'_>,
    plant: &Bound<'_, PyAny>,
    path: &Bound<'_, PyAny>,
    start_q: &Bound<'_, PyAny>,
    dt: f64,
    controller: Option<&Bound<'_, PyAny>>,
    limits: Option<&PyLimits>,
    position_tolerance: f64,
    rotation_tolerance: f64,
    seed: i128,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<PyModelFreeResult> {
    let reference = path_argument(path)?.get().reference(py, dt)?;
    let start = vector("start_q", start_q)?;
    let sampling = Sampling::of_ticks(dt, reference.len() - 1);
    let (in_force, limits) = limits_without_robot(py, limits, start.len(), &sampling)?;
    let options = ModelFreeOptions {
        controller: self::controller(controller)?,
        limits: Some(limits),
        tolerance: Tolerance { position: position_tolerance, rotation: rotation_tolerance },
        seed: count("seed", seed)?,
    };
    let (core, exception) =
        watched_with_interpreter(py, progress, |watcher| run(plant, &reference, &start, &options, watcher))?;
    python_calls::log(py, "track_model_free", &said(&core.message()))?;
    PyModelFreeResult::new(py, core, in_force, exception.map(|error| error.into_value(py)))
}

/// Returns the record, and the exception of a Python plant. Releases the interpreter unless the plant needs it.
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
    let mut plant = PythonPlant::new(plant, reference.rotation(0).is_some())?;
    let record = tracking::track_model_free(&mut plant, reference, start, options, watcher);
    if let Some(interrupt) = plant.take_interrupt() {
        return Err(interrupt);
    }
    match record {
        Ok(record) => Ok((record, plant.exception)),
        // Raises the plant's own exception if nothing was recorded: it is the best message.
        Err(error) => Err(plant.exception.unwrap_or_else(|| raise(error))),
    }
}
