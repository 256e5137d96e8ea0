//! Reading of obstacle arguments.

use ikcore::obstacle::{Obstacle, Obstacles, Surroundings};
use pyo3::exceptions::PyTypeError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};

use super::body::{PyObstacle, not_made_here};
use super::from_core::wrapped;
use super::moving::PyMoving;
use crate::convert::summary;
use crate::error::invalid;
use crate::robot::PyRobot;
use crate::units;

/// The obstacles of a call.
pub struct GivenObstacles {
    /// Obstacles for the core.
    pub core: Obstacles,
    /// Obstacles as given, which results store.
    pub tuple: Py<PyTuple>,
}

impl GivenObstacles {
    /// Reads the obstacles of a call for `robot`; None means no obstacles.
    pub fn read_for(py: Python<'_>, robot: &PyRobot, value: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let given = Self::read(py, value)?;
        doubt_obstacles(robot, Some(&given.core))?;
        Ok(given)
    }

    /// Reads any sequence of obstacles; None means no obstacles.
    fn read(py: Python<'_>, value: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        if let Some(prepared) = value.and_then(prepared) {
            let PyPreparedObstacles { core, tuple } = prepared.get();
            return Ok(Self { core: core.clone(), tuple: tuple.clone_ref(py) });
        }
        let items = value.map_or_else(|| Ok(vec![]), items)?;
        Ok(Self { core: shapes(&items)?, tuple: PyTuple::new(py, items)?.unbind() })
    }
}

/// Doubts the unit of obstacles.
fn doubt_obstacles(robot: &PyRobot, obstacles: Option<&Obstacles>) -> PyResult<()> {
    units::doubt(obstacles.and_then(|obstacles| units::of_obstacles(&robot.core, obstacles)))
}

/// Reads the arguments `obstacles`, `margin` and `self_collision` of a call.
pub fn read_surroundings(
    robot: &PyRobot,
    obstacles: Option<&Bound<'_, PyAny>>,
    margin: Option<f64>,
    self_collision: Option<bool>,
) -> PyResult<Surroundings> {
    let read = |given: &Bound<'_, PyAny>| match prepared(given) {
        Some(prepared) => Ok(prepared.get().core.clone()),
        None => shapes(&items(given)?),
    };
    let obstacles = obstacles.map(read).transpose()?;
    doubt_obstacles(robot, obstacles.as_ref())?;
    Ok(Surroundings { obstacles, margin, self_collision })
}

/// The obstacles of a `Scene`, read and prepared once; `carried` are link and name of each body that the robot carries there.
#[pyclass(name = "PreparedObstacles", module = "beetle_ik._core", frozen)]
pub struct PyPreparedObstacles {
    core: Obstacles,
    tuple: Py<PyTuple>,
}

#[pymethods]
impl PyPreparedObstacles {
    #[new]
    #[pyo3(signature = (obstacles, carried=vec![]))]
    fn new(py: Python<'_>, obstacles: &Bound<'_, PyAny>, carried: Vec<[String; 2]>) -> PyResult<Self> {
        let GivenObstacles { core, tuple } = GivenObstacles::read(py, Some(obstacles))?;
        let core = if carried.is_empty() { core } else { Obstacles::beside_carried(core.to_vec(), carried) };
        Ok(Self { core, tuple })
    }
}

/// Returns the prepared obstacles of a `Scene`; None for other sequences.
fn prepared<'py>(value: &Bound<'py, PyAny>) -> Option<Bound<'py, PyPreparedObstacles>> {
    if value.is_exact_instance_of::<PyList>() || value.is_exact_instance_of::<PyTuple>() {
        return None;
    }
    value.getattr(intern!(value.py(), "_prepared")).ok()?.cast_into().ok()
}

/// Static and moving obstacles: shapes and their velocities (m/s), empty if all are at rest.
pub struct MovingObstacles {
    pub shapes: Obstacles,
    pub velocities: Vec<[f64; 3]>,
}

impl MovingObstacles {
    /// Reads any sequence of obstacles, static or moving.
    pub fn read(value: &Bound<'_, PyAny>) -> PyResult<Self> {
        let all_at_rest = |shapes| Self { shapes, velocities: vec![] };
        if let Some(prepared) = prepared(value) {
            return Ok(all_at_rest(prepared.get().core.clone()));
        }
        let given = items(value)?;
        if given.iter().all(|item| item.cast::<PyMoving>().is_err()) {
            return Ok(all_at_rest(shapes(&given)?));
        }
        let (mut shapes, mut velocities) = (vec![], vec![]);
        for (i, item) in given.iter().enumerate() {
            let (shape, velocity) = match (item.cast::<PyMoving>(), item.cast::<PyObstacle>()) {
                (Ok(moving), _) => (moving.get().obstacle.clone(), moving.get().velocity),
                (_, Ok(obstacle)) => (obstacle.get().core.clone(), [0.0; 3]),
                _ => return Err(not_made_here(&format!("obstacle {i}"), item)),
            };
            shapes.push(shape);
            velocities.push(velocity);
        }
        Ok(Self { shapes: shapes.into_iter().collect(), velocities })
    }

    /// Returns the obstacles as Python objects, moving obstacles as `Moving`.
    pub fn objects(py: Python<'_>, obstacles: &[Obstacle], velocities: &[[f64; 3]]) -> PyResult<Vec<Py<PyAny>>> {
        let object = |(i, obstacle): (usize, &Obstacle)| match velocities.get(i) {
            Some(velocity) if *velocity != [0.0; 3] => {
                Ok(Py::new(py, PyMoving { obstacle: obstacle.clone(), velocity: *velocity })?.into_any())
            }
            _ => wrapped(py, obstacle),
        };
        obstacles.iter().enumerate().map(object).collect()
    }
}

fn items<'py>(value: &Bound<'py, PyAny>) -> PyResult<Vec<Bound<'py, PyAny>>> {
    if value.cast::<PyObstacle>().is_ok() {
        return Err(invalid(format!("obstacles must be a list, got a single one: [{}]", summary(value))));
    }
    let wrong = |error: PyErr| match error.is_instance_of::<PyTypeError>(value.py()) {
        true => not_made_here("obstacles", value),
        false => error,
    };
    value.try_iter().map_err(wrong)?.collect()
}

fn shapes(items: &[Bound<'_, PyAny>]) -> PyResult<Obstacles> {
    let shape = |(i, item): (usize, &Bound<'_, PyAny>)| match item.cast::<PyObstacle>() {
        Ok(obstacle) => Ok(obstacle.get().core.clone()),
        Err(_) if item.cast::<PyMoving>().is_ok() => {
            Err(invalid(format!("obstacle {i} is a Moving; only a Tracker takes obstacles that move: give its shape")))
        }
        Err(_) => Err(not_made_here(&format!("obstacle {i}"), item)),
    };
    items.iter().enumerate().map(shape).collect()
}
