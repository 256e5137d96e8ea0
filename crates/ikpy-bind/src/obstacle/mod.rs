//! Obstacles: shapes, distances and `bik.obstacles`.

mod argument;
mod arrays;
mod body;
mod clearance;
mod from_core;
mod large;
mod moving;
mod nearest;
mod shapes;
mod touch;

use pyo3::prelude::*;

use argument::PyPreparedObstacles;
pub use argument::{GivenObstacles, MovingObstacles, read_surroundings};
pub use body::PyObstacle;
pub use from_core::wrapped;
use large::{PyGrid, PyMesh, PyPointCloud};
use moving::PyMoving;
pub use nearest::PyNearest;
use shapes::{PyBox, PyCapsule, PyConvexMesh, PyCylinder, PyEllipse, PyEllipsoid, PyHalfSpace, PySphere};
pub use touch::{Touch, read_touch};

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PyObstacle>()?;
    module.add_class::<PySphere>()?;
    module.add_class::<PyBox>()?;
    module.add_class::<PyCapsule>()?;
    module.add_class::<PyCylinder>()?;
    module.add_class::<PyHalfSpace>()?;
    module.add_class::<PyEllipsoid>()?;
    module.add_class::<PyEllipse>()?;
    module.add_class::<PyConvexMesh>()?;
    module.add_class::<PyMesh>()?;
    module.add_class::<PyPointCloud>()?;
    module.add_class::<PyGrid>()?;
    module.add_class::<PyMoving>()?;
    module.add_class::<PyPreparedObstacles>()?;
    module.add_class::<PyNearest>()?;
    module.add_function(wrap_pyfunction!(nearest::nearest, module)?)?;
    module.add_function(wrap_pyfunction!(clearance::clearance, module)?)
}
