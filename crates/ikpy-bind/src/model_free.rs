//! `track_model_free` and `ModelFreeResult`.

use ikcore::path::Reference;
use ikcore::solver::Status;
use ikcore::stored::{from_bytes, to_bytes};
use ikcore::tracking::{self, ModelFreeOptions, ModelFreeRecord};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;

use crate::control::controller;
use crate::convert::{count, row, table, vector};
use crate::error::raise;
use crate::limits::{PyLimits, Sampling, limits_without_robot};
use crate::monitor::{Progress, Watcher};
use crate::path::PyPath;
use crate::plant::{PyKinematicPlant, PythonPlant};
use crate::solver::status;
use crate::stored::{self, Reduced};
use crate::upward;

/// The record of a track without a model: k rows, row 0 the start at t = 0, row i the tick that ends at t_i = i dt; fewer than
/// the path has where the plant failed.
#[pyclass(name = "ModelFreeResult", module = "beetle_ik", frozen)]
pub struct PyModelFreeResult {
    core: ModelFreeRecord,
    tables: Tables,
    /// The limits in force.
    #[pyo3(get)]
    limits: Py<PyLimits>,
    exception: Option<PyErr>,
}

/// The arrays of a record, made once.
struct Tables {
    time: Py<PyArray1<f64>>,
    q: Py<PyArrayDyn<f64>>,
    qd: Py<PyArrayDyn<f64>>,
    command: Py<PyArrayDyn<f64>>,
    position: Py<PyArrayDyn<f64>>,
    reference: Py<PyArrayDyn<f64>>,
    position_error: Py<PyArray1<f64>>,
    step_status: Py<PyArray1<u8>>,
    step_evaluations: Py<PyArray1<i64>>,
}

impl Tables {
    fn new(py: Python<'_>, record: &ModelFreeRecord) -> PyResult<Self> {
        let track = &record.track;
        let (k, n) = (track.time.len(), track.dof);
        let counts = track.step_evaluations.iter().map(|count| *count as i64).collect();
        Ok(Self {
            time: row(py, track.time.clone()).unbind(),
            q: table(py, track.q.clone(), &[k, n])?.unbind(),
            qd: table(py, track.qd.clone(), &[k, n])?.unbind(),
            command: table(py, record.command.clone(), &[k, n])?.unbind(),
            position: table(py, track.position.as_flattened().to_vec(), &[k, 3])?.unbind(),
            reference: table(py, track.reference.as_flattened().to_vec(), &[k, 3])?.unbind(),
            position_error: row(py, track.position_error.clone()).unbind(),
            step_status: row(py, track.step_status.iter().map(|status| *status as u8).collect()).unbind(),
            step_evaluations: row(py, counts).unbind(),
        })
    }
}

#[pymethods]
impl PyModelFreeResult {
    /// Times (k,) (s).
    #[getter]
    fn time<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.tables.time.bind(py).clone()
    }

    /// Configurations that the controller accepted (k, n) (rad, m).
    #[getter]
    fn q<'py>(&self, py: Python<'py>) -> Bound<'py, PyArrayDyn<f64>> {
        self.tables.q.bind(py).clone()
    }

    /// Velocities (k, n) (rad/s, m/s): (q_i - q_{i-1}) / dt, zero in row 0.
    #[getter]
    fn qd<'py>(&self, py: Python<'py>) -> Bound<'py, PyArrayDyn<f64>> {
        self.tables.qd.bind(py).clone()
    }

    /// The command at which each row's position was measured (k, n) (rad, m): q itself for `BroydenBAS`, an antenna away
    /// from it for `ZNNBAS`.
    #[getter]
    fn command<'py>(&self, py: Python<'py>) -> Bound<'py, PyArrayDyn<f64>> {
        self.tables.command.bind(py).clone()
    }

    /// Positions of the tip as measured (k, 3) (m).
    #[getter]
    fn position<'py>(&self, py: Python<'py>) -> Bound<'py, PyArrayDyn<f64>> {
        self.tables.position.bind(py).clone()
    }

    /// Wanted positions (k, 3) (m).
    #[getter]
    fn reference<'py>(&self, py: Python<'py>) -> Bound<'py, PyArrayDyn<f64>> {
        self.tables.reference.bind(py).clone()
    }

    /// Distances between the two (k,) (m).
    #[getter]
    fn position_error<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.tables.position_error.bind(py).clone()
    }

    /// The error band (m), as asked.
    #[getter]
    fn position_tolerance(&self) -> f64 {
        self.core.track.criterion.tolerance.position
    }

    /// How each step ended (k,), values of `Status`: SOLVED in the band, IMPROVED nearer than the step before, CAPPED
    /// neither.
    #[getter]
    fn step_status<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u8>> {
        self.tables.step_status.bind(py).clone()
    }

    /// Measurements of the plant in each step (k,).
    #[getter]
    fn step_evaluations<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        self.tables.step_evaluations.bind(py).clone()
    }

    /// Largest excess of a command over a limit (rad, m), probes included; 0 within rounding.
    #[getter]
    fn max_violation(&self) -> f64 {
        self.core.track.max_violation
    }

    /// Root mean square of the measured error over the second half of the rows (m).
    #[getter]
    fn settled_error(&self) -> f64 {
        self.core.settled_error()
    }

    /// Whether the tip came into the error band and stayed there.
    #[getter]
    fn success(&self) -> bool {
        self.core.track.status == Status::Solved
    }

    /// SOLVED as `success`; LOST if the tip left its band again; PLANT_FAILED where the plant ended the run; else how the last
    /// step ended.
    #[getter]
    fn status<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        status(py, self.core.track.status)
    }

    /// What happened, and what to try.
    #[getter]
    fn message(&self) -> String {
        self.core.message()
    }

    /// What the plant raised, if it did.
    #[getter]
    fn exception<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyAny>> {
        self.exception.as_ref().map(|error| error.value(py).clone().into_any())
    }

    /// Measurements of the plant in all.
    #[getter]
    fn evaluations(&self) -> usize {
        self.core.track.evaluations()
    }

    /// Time taken (s).
    #[getter]
    fn elapsed(&self) -> f64 {
        self.core.track.elapsed.as_secs_f64()
    }

    /// A matplotlib figure: the tip's path, the error, joint angles, measurements.
    fn plot<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        upward::plot(slf.into_any(), "model_free")
    }

    fn __len__(&self) -> usize {
        self.core.track.time.len()
    }

    fn __repr__(&self) -> String {
        let track = &self.core.track;
        format!("<ModelFreeResult {}: {} rows, {}>", track.status.name(), track.time.len(), self.core.message())
    }

    /// What the plant raised goes along as far as it pickles itself.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let core = stored::bytes(py, to_bytes("track without a model", &self.core))?;
        stored::restored_from::<Self>(py, (core, self.limits.clone_ref(py), self.exception(py)))
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
        Ok(Self { tables: Tables::new(py, &core)?, limits, exception, core })
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
    let progress = progress.map_or(Ok(Progress::default()), Progress::new)?;
    let mut watcher = Watcher::with_progress(progress.update(py));
    let run = run(plant, &reference, &start, &options, &mut watcher);
    progress.close(py)?;
    watcher.finish()?;
    let (core, exception) = run?;
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
    if let Some(wish) = plant.wish_to_stop() {
        return Err(wish);
    }
    match record {
        Ok(record) => Ok((record, plant.exception)),
        // Nothing was recorded: what the plant raised says more than we could.
        Err(error) => Err(plant.exception.unwrap_or_else(|| raise(error))),
    }
}
