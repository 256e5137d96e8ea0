//! `bik.obstacles`.

mod argument;
mod body;
mod clearance;
mod shapes;

use pyo3::prelude::*;

pub use argument::Obstacles;
use body::PyObstacle;
use shapes::{PyBox, PyCapsule, PyConvexMesh, PyEllipse, PyEllipsoid, PySphere};

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PyObstacle>()?;
    module.add_class::<PySphere>()?;
    module.add_class::<PyBox>()?;
    module.add_class::<PyCapsule>()?;
    module.add_class::<PyEllipsoid>()?;
    module.add_class::<PyEllipse>()?;
    module.add_class::<PyConvexMesh>()?;
    module.add_function(wrap_pyfunction!(clearance::clearance, module)?)
}
