//! `Body`: a shape fixed to a link.

use ikcore::obstacle::Obstacle;
use ikcore::robot::Body;
use ikcore::stored::{from_bytes, to_bytes};
use pyo3::prelude::*;

use crate::error::raise;
use crate::hash::content_hash;
use crate::obstacle::wrapped;
use crate::pickling::{self, Reduced};

/// A body of a robot: a convex shape fixed to a link, from `Robot.bodies`.
#[pyclass(name = "Body", module = "beetle_ik", frozen, eq)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyBody {
    pub core: Body,
}

#[pymethods]
impl PyBody {
    /// Name of the link that carries the body.
    #[getter]
    fn link(&self) -> &str {
        &self.core.link
    }

    /// The shape, in the frame of the link: a Sphere, Box, Capsule, Cylinder, Ellipsoid or ConvexMesh of `bik.obstacles`.
    #[getter]
    fn shape(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        wrapped(py, &Obstacle::new(self.core.shape.clone(), self.core.touch.clone()))
    }

    /// Origin of the body: "given", "attached", "collision shape" (of a file), or "mesh" and the name of its file.
    #[getter]
    fn source(&self) -> String {
        self.core.source.to_string()
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        pickling::restored_from::<Self>(py, (pickling::bytes(py, to_bytes("body", &self.core))?,))
    }

    /// Restores a pickled value.
    #[staticmethod]
    fn _restore(bytes: &[u8]) -> PyResult<Self> {
        Ok(Self { core: from_bytes("body", bytes).map_err(raise)? })
    }

    fn __repr__(&self) -> String {
        format!("<Body of '{}': {}, {}>", self.core.link, self.core.shape.name(), self.core.source)
    }
}
