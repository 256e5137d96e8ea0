//! `planar_posture`, `PlanarPosture` and `CircleSwarm`.

use ikcore::posture::{CircleSwarm, Posture, PostureOptions, Rectangle, best_posture};
use ikcore::stored::{from_bytes, to_bytes};
use numpy::{PyArray1, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::convert::{array, count, point, row, shape_text};
use crate::error::{invalid, raise};
use crate::limits::PyLimits;
use crate::monitor::watched;
use crate::options::options;
use crate::outcome::outcome;
use crate::pickling::{self, Reduced};
use crate::robot::PyRobot;
use crate::traversal::traversed;

/// The particle swarm of "Trajectory tracking of redundant manipulator based on PSO algorithm optimization": particles
/// are joint positions on circles; with a constriction factor (eq. 17, 18).
///
/// Args:
///     population: number of particles.
///     generations: number of generations, the initial one included.
///     c1, c2: attraction to the particle's own best point and to the swarm's; their sum must be above 4.
///     velocity_limit: largest velocity of a coordinate (m per generation); the paper does not give one.
///     signed: draw random factors from [-1, 1], as printed, instead of [0, 1].
#[pyclass(name = "CircleSwarm", module = "beetle_ik", frozen, eq)]
#[derive(Debug, PartialEq)]
pub struct PyCircleSwarm(CircleSwarm);

#[pymethods]
impl PyCircleSwarm {
    #[new]
    #[pyo3(signature = (*, population=5, generations=10, c1=2.05, c2=2.05, velocity_limit=0.2, signed=false))]
    fn new(population: i128, generations: i128, c1: f64, c2: f64, velocity_limit: f64, signed: bool) -> PyResult<Self> {
        let (population, generations) = (count("population", population)?, count("generations", generations)?);
        let swarm = CircleSwarm { population, generations, c1, c2, velocity_limit, signed };
        swarm.validate().map_err(raise)?;
        Ok(Self(swarm))
    }
}

options! {
    PyCircleSwarm, "CircleSwarm" {
        /// Number of particles.
        population: usize,
        /// Number of generations, the initial one included.
        generations: usize,
        /// Attraction to the particle's own best point.
        c1: f64,
        /// Attraction to the swarm's best point.
        c2: f64,
        /// Largest velocity of a coordinate (m per generation).
        velocity_limit: f64,
        /// Whether random factors are drawn from [-1, 1].
        signed: bool,
    }
}

/// The best posture of a planar arm for a tip position.
#[pyclass(name = "PlanarPosture", module = "beetle_ik", frozen)]
pub struct PyPlanarPosture {
    core: Posture,
    /// The limits in force: the robot's.
    #[pyo3(get)]
    limits: Py<PyLimits>,
}

traversed!(PyPlanarPosture: limits);

outcome! {
    PyPlanarPosture = |result|
    /// Whether a posture was found.
    success,
    /// Reason why the search ended, a `Status`.
    status: result.core.status,
    message: result.core.message(),
    /// Number of postures evaluated.
    evaluations: result.core.evaluations,
    elapsed: result.core.elapsed,
}

#[pymethods]
impl PyPlanarPosture {
    /// The configuration (n,) (rad). If no posture was found, the configuration that brings the tip nearest to the
    /// target.
    #[getter]
    fn q<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.core.q.clone())
    }

    /// Manipulability of the posture: `Robot.manipulability(q, motion="position")`, or for measure "overall" the sum of
    /// `Robot.link_manipulability(q)`. NaN if no posture was found.
    #[getter]
    fn index(&self) -> f64 {
        self.core.index
    }

    /// The best index after each generation of a `CircleSwarm` (generations,); empty for the default search.
    #[getter]
    fn history<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.core.history.clone())
    }

    /// Distance of the tip from the target (m).
    #[getter]
    fn position_error(&self) -> f64 {
        self.core.error.position
    }

    fn __repr__(&self) -> String {
        format!("<PlanarPosture {}: {}>", self.core.status.name(), self.message())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let core = pickling::bytes(py, to_bytes("posture", &self.core))?;
        pickling::restored_from::<Self>(py, (core, &self.limits))
    }

    /// Restores a pickled value.
    #[staticmethod]
    fn _restore(bytes: &[u8], limits: Py<PyLimits>) -> PyResult<Self> {
        Ok(Self { core: from_bytes("posture", bytes).map_err(raise)?, limits })
    }
}

/// Finds the posture of a planar arm with the best manipulability for a tip position: the global optimum.
///
/// For other arms, and for poses, use `solve(robot, target, goals=goals.Manipulability(...), prefer="best")`.
///
/// Args:
///     robot: an arm of 3 or more revolute joints about z in one plane, for example `Robot.planar([...])`.
///     target: position of the tip (3,) (m).
///     measure: "tip": Yoshikawa's index of the tip; "overall": the sum of the indices of all links.
///     region: (2, 2) (m), lower and upper corner (x, y) of a rectangle for the joint positions; None: no restriction.
///     swarm: a `CircleSwarm`, the published search; None: differential evolution over the link directions.
///     seed: seed of the random draws; the same seed gives the same bits.
///
/// Returns:
///     A `PlanarPosture`. A target out of reach is a status, not an error.
///
/// Raises:
///     InvalidInputError: an arm that is not planar or has fewer than 3 links; wrong shape; NaN.
#[pyfunction]
#[pyo3(signature = (robot, target, *, measure="tip", region=None, swarm=None, seed=0))]
pub fn planar_posture(
    py: Python<'_>,
    robot: &PyRobot,
    target: &Bound<'_, PyAny>,
    #[pyo3(from_py_with = crate::convert::text)] measure: &str,
    region: Option<&Bound<'_, PyAny>>,
    swarm: Option<&PyCircleSwarm>,
    seed: i128,
) -> PyResult<PyPlanarPosture> {
    let target = point("target", target)?;
    let options = PostureOptions {
        measure: measure.parse().map_err(raise)?,
        region: region.map(read_region).transpose()?,
        swarm: swarm.map(|swarm| swarm.0),
        seed: count("seed", seed)?,
    };
    let core = watched(py, None, |watcher| best_posture(&robot.core, &target, &options, watcher))?;
    Ok(PyPlanarPosture { core, limits: robot.limits(py)? })
}

/// Reads the corners of a rectangle, (2, 2).
fn read_region(value: &Bound<'_, PyAny>) -> PyResult<Rectangle> {
    let numbers = array("region", value)?;
    match (numbers.shape(), numbers.as_slice()?) {
        ([2, 2], &[x, y, to_x, to_y]) => Ok(Rectangle { lower: [x, y], upper: [to_x, to_y] }),
        (shape, _) => Err(invalid(format!("region: expected shape (2, 2), got {}", shape_text(shape)))),
    }
}
