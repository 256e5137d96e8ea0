//! `Robot`: its properties.

use std::sync::Arc;

use ikcore::load::read_link_mesh;
use ikcore::nalgebra::{Matrix4, Vector3};
use ikcore::robot::{Robot, Visual, VisualShape};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict, PyString, PyTuple};

use super::body::PyBody;
use super::robot_class::PyRobot;
use crate::convert::{copied, counted, matrix4_array, row, shortened};
use crate::error::{misfit, raise};
use crate::hash::content_hash;
use crate::limits::PyLimits;
use crate::monitor::on_a_thread;
use crate::obstacle::wrapped;
use crate::pickling::{self, Reduced};
use crate::python_calls;

/// Capsule of a link: (link, a (3,), b (3,), radius (m)).
type Capsule<'py> = (String, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, f64);

/// Visual shape: (link, shape or file, placement (4, 4), colour (4,)).
type VisualParts<'py> = (String, Py<PyAny>, Bound<'py, PyArray2<f64>>, Option<Bound<'py, PyArray1<f64>>>);

fn visual_parts<'py>(py: Python<'py>, visual: &Visual) -> PyResult<VisualParts<'py>> {
    let (shape, placement) = match &visual.shape {
        VisualShape::Solid(shape) => (wrapped(py, &shape.clone().into())?, Matrix4::identity()),
        VisualShape::Mesh { path, scale, origin } => {
            let scale = Matrix4::new_nonuniform_scaling(&Vector3::from(*scale));
            (PyString::new(py, path).into_any().unbind(), origin.to_homogeneous() * scale)
        }
    };
    let color = visual.color.map(|color| copied(py, &color));
    Ok((visual.link.clone(), shape, matrix4_array(py, &placement), color))
}

#[pymethods]
impl PyRobot {
    #[new]
    #[pyo3(signature = (*_arguments, **_options))]
    fn new(_arguments: &Bound<'_, PyTuple>, _options: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let ways = "Robot.named(name), Robot.from_urdf(path), Robot.from_dh(...) or Robot.planar(lengths)";
        Err(misfit(format!("a robot is made by {ways}")))
    }

    /// The robot's name.
    #[getter]
    fn name(&self) -> &str {
        self.core.name()
    }

    /// Degrees of freedom, n: the number of independent joints.
    #[getter]
    fn dof(&self) -> usize {
        self.core.dof()
    }

    /// Names of the independent joints, in the order of q.
    #[getter]
    fn joint_names(&self) -> Vec<&str> {
        self.core.joints().iter().map(|joint| joint.name.as_str()).collect()
    }

    /// Kinds of the independent joints: "revolute", "continuous" or "prismatic".
    #[getter]
    fn joint_kinds(&self) -> Vec<&'static str> {
        self.core.joints().iter().map(|joint| joint.kind.name()).collect()
    }

    /// Names of the tips' links, one for a single chain. They are the keys of dicts of targets, tasks, paths and
    /// tolerances, and of `errors` in results.
    #[getter]
    fn tips(&self) -> Vec<&str> {
        self.core.tips().collect()
    }

    /// Returns the names of the links from the base to each tip, for drawings.
    fn _links_to_tips(&self) -> Vec<Vec<&str>> {
        self.core.links_to_tips()
    }

    /// Names of the links along the chain, base first, tip last; with several tips, along the chain to the first.
    #[getter]
    fn link_names(&self) -> Vec<&str> {
        self.core.link_names().collect()
    }

    /// Names of all links: those of the chain as in `link_names`, then those that branch off it.
    #[getter]
    fn all_link_names(&self) -> Vec<&str> {
        self.core.all_link_names().collect()
    }

    /// The joints beside the chain, with the values (rad, m) at which they are held.
    #[getter]
    fn held_joints<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.core.held_joints().iter().map(|held| (held.joint.name.as_str(), held.value)).into_py_dict(py)
    }

    /// Lower position limits (n,) (rad, m); -inf for none.
    #[getter]
    fn lower<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.core.joints().iter().map(|joint| joint.lower).collect())
    }

    /// Upper position limits (n,) (rad, m); inf for none.
    #[getter]
    fn upper<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.core.joints().iter().map(|joint| joint.upper).collect())
    }

    /// Velocity limits (n,) (rad/s, m/s); inf if unknown, 0 for a locked joint.
    #[getter]
    fn velocity_limit<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.core.joints().iter().map(|joint| joint.velocity).collect())
    }

    /// Structure of the arm on which its closed-form inverse kinematics rests, and the largest number of solutions of a
    /// pose, for example "spherical wrist; at most 8 solutions"; or "none: " and the reason. Determined at the first
    /// access.
    #[getter]
    fn closed_form(&self) -> String {
        self.core.closed_form()
    }

    /// All limits of the robot.
    #[getter]
    pub fn limits(&self, py: Python<'_>) -> PyResult<Py<PyLimits>> {
        let limits = self.limits.get_or_try_init(py, || Py::new(py, PyLimits::of(&self.core)))?;
        Ok(limits.clone_ref(py))
    }

    /// The maker's rated limits: `limits`, plus acceleration and jerk limits where the maker publishes them (`panda`
    /// and `fr3`, from the maker's "Robot and interface specifications") or a URDF 1.2 has them. Pass them as `limits=`:
    /// no call uses them by default.
    #[getter]
    fn rated_limits(&self) -> PyLimits {
        PyLimits::rated(&self.core)
    }

    /// Bodies of the links, used for collision tests: given by `with_capsules`, attached by `with_attached`, or read
    /// from the collision shapes of a file.
    #[getter]
    fn bodies(&self) -> Vec<PyBody> {
        self.core.bodies().iter().map(|body| PyBody { core: body.clone() }).collect()
    }

    /// Capsules that enclose the `bodies`, each (link, a, b, radius): all points within the radius (m) of the segment
    /// from a (3,) to b (3,) in the frame of the link. Spheres and capsules are unchanged.
    #[getter]
    fn capsules<'py>(&self, py: Python<'py>) -> Vec<Capsule<'py>> {
        let capsules = self.core.capsules().iter();
        capsules.map(|c| (c.link.clone(), copied(py, &c.a), copied(py, &c.b), c.radius)).collect()
    }

    /// Quality of the capsules fitted to meshes, each (link, file, volume ratio, largest distance): the volume of the
    /// capsules over that of the mesh, NaN for an open mesh, and the largest distance (m) of the capsules from the
    /// mesh.
    #[getter]
    fn mesh_fits(&self) -> Vec<(String, String, f64, f64)> {
        let fits = self.core.mesh_fits().iter();
        fits.map(|fit| (fit.link.clone(), fit.file.clone(), fit.volume_ratio, fit.largest_distance)).collect()
    }

    /// Reads the collision meshes of a robot from a URDF, each (link, `obstacles.Mesh` in the frame of the link). Only
    /// files that were found when the URDF was loaded are read.
    ///
    /// Raises:
    ///     InvalidInputError: a file that is no longer there, or cannot be read.
    fn collision_meshes(&self, py: Python<'_>) -> PyResult<Vec<(String, Py<PyAny>)>> {
        let robot = Arc::clone(&self.core);
        let read =
            on_a_thread(py, move || robot.meshes().iter().map(read_link_mesh).collect::<ikcore::Result<Vec<_>>>())?;
        let links = self.core.meshes().iter().map(|mesh| mesh.link.clone());
        links.zip(read).map(|(link, mesh)| Ok((link, wrapped(py, &mesh.into())?))).collect()
    }

    /// Collision shapes that did not become `bodies`, for example "a mesh of link 'hand'".
    /// `from_urdf(..., collision="fit")` and `"hulls"` read meshes.
    #[getter]
    fn unread_collision_shapes(&self) -> Vec<String> {
        self.core.unread_collision_shapes().to_vec()
    }

    /// Visual shapes of a URDF, each (link, shape, placement (4, 4), colour (4,) or None). The shape is one of
    /// `bik.obstacles`, or the path of a mesh file, as written in the URDF if the file was not found. The placement
    /// maps it to the frame of the link and includes its scale. Colours are red, green, blue and opacity, from 0 to 1;
    /// materials of a mesh file take precedence.
    #[getter]
    fn visuals<'py>(&self, py: Python<'py>) -> PyResult<Vec<VisualParts<'py>>> {
        self.core.visuals().iter().map(|visual| visual_parts(py, visual)).collect()
    }

    /// Pairs of links that are tested against each other, each (link, link). Links fixed to each other are left out.
    /// Without an SRDF and `with_collision_pairs`, three more kinds of pairs are left out: neighbours, links that touch
    /// with all joints in the middle of their ranges or in nearly all of 1,000 random configurations, and links that
    /// come no nearer than 20 mm in 10,000. Determined at the first access, with a fixed seed.
    #[getter]
    fn collision_pairs(&self, py: Python<'_>) -> Vec<(String, String)> {
        let pairs = py.detach(|| self.core.collision_pairs());
        pairs.into_iter().map(|[one, other]| (one.to_owned(), other.to_owned())).collect()
    }

    /// Named configurations (n,) of an SRDF, for example "ready".
    #[getter]
    fn stances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.core.stances().iter().map(|stance| (stance.name.as_str(), row(py, stance.q.clone()))).into_py_dict(py)
    }

    /// Hashes the name, the joints with their limits, and the links.
    fn __hash__(&self) -> u64 {
        content_hash(&(self.core.name(), self.core.joints(), self.core.link_names().collect::<Vec<_>>()))
    }

    fn _repr_html_<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        python_calls::html(slf.into_any(), "robot")
    }

    fn __repr__(&self) -> String {
        let (name, joints) = (self.core.name(), counted(self.core.dof(), "joint"));
        let base = self.core.link_names().next().unwrap_or_default();
        let tips = self.core.tips().collect::<Vec<_>>().join(" and ");
        let held = match self.core.held_joints() {
            [] => String::new(),
            held => format!(", {} held", counted(held.len(), "joint")),
        };
        let payload: f64 = self.core.payloads().iter().map(|payload| payload.inertia.mass).sum();
        let carried = if payload > 0.0 { format!(", carries {} kg", shortened(payload)) } else { String::new() };
        format!("<Robot '{name}': {joints}, {base} to {tips}{held}{carried}>")
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        pickling::restored_from::<Self>(py, (pickling::bytes(py, self.core.to_bytes())?,))
    }

    /// Restores a pickled value.
    #[staticmethod]
    fn _restore(bytes: &[u8]) -> PyResult<Self> {
        Robot::from_bytes(bytes).map(Self::from).map_err(raise)
    }
}
