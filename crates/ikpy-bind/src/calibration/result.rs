//! `Calibration` and `Identifiability`.

use ikcore::calibration::{Calibration, Findings, FittedParameter, Identifiability, RowErrors};
use ikcore::math::Pose;
use ikcore::stored::{from_bytes, to_bytes};
use numpy::{PyArray1, PyArray2, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::convert::{copied, counted, path_or_text, pose_array, row, table};
use crate::error::raise;
use crate::pickling::{self, Reduced};
use crate::robot::PyRobot;
use crate::traversal::traversed;
use crate::wording::said;

/// Identifiability of the parameters of a calibration.
#[pyclass(name = "Identifiability", module = "beetle_ik", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyIdentifiability(Identifiability);

#[pymethods]
impl PyIdentifiability {
    /// Number of independent combinations of parameters that the measurements determine.
    #[getter]
    fn rank(&self) -> usize {
        self.0.rank
    }

    /// Number that configurations all over the joint ranges would determine. The rest has no effect on such measurements at any
    /// configuration; of all models that differ in it alone, the one nearest to the given robot is taken.
    #[getter]
    fn possible(&self) -> usize {
        self.0.possible
    }

    /// Largest over smallest singular value of the combinations determined. Below some hundreds the configurations are well chosen.
    #[getter]
    fn condition(&self) -> f64 {
        self.0.condition
    }

    /// Singular values of the weighted Jacobian (p,), largest first: the usual deviation of a combination over its standard deviation
    /// here.
    #[getter]
    fn singular_values<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.0.singular_values.clone())
    }

    /// Combinations that the measurements leave open and other configurations would tell, by their main parameters.
    #[getter]
    fn unknown(&self) -> Vec<String> {
        self.0.unknown.clone()
    }

    fn __repr__(&self) -> String {
        let Identifiability { rank, possible, condition, .. } = &self.0;
        format!("<Identifiability: {rank} of {possible}, condition {condition:.3e}>")
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        pickling::restored_from::<Self>(py, (pickling::bytes(py, to_bytes("identifiability", &self.0))?,))
    }

    /// Restores a pickled value.
    #[staticmethod]
    fn _restore(bytes: &[u8]) -> PyResult<Self> {
        from_bytes("identifiability", bytes).map(Self).map_err(raise)
    }
}

/// The arm as it is built, and the results of the fit. Errors of image points are in pixels, others in m.
#[pyclass(name = "Calibration", module = "beetle_ik", frozen)]
pub struct PyCalibration {
    core: Findings,
    /// The robot with the geometry, base and tool that were found. It keeps joints, limits and collision shapes.
    #[pyo3(get)]
    robot: Py<PyRobot>,
    dof: usize,
    /// Whether each measurement has two configurations.
    pairs: bool,
}

traversed!(PyCalibration: robot);

impl PyCalibration {
    pub fn new(py: Python<'_>, found: Calibration, dof: usize, pairs: bool) -> PyResult<Self> {
        Ok(Self { core: found.findings, robot: Py::new(py, PyRobot::from(found.robot))?, dof, pairs })
    }

    fn errors<'py>(&self, py: Python<'py>, of: impl Fn(&RowErrors) -> f64) -> Bound<'py, PyArray1<f64>> {
        row(py, self.core.errors.iter().map(of).collect())
    }

    fn by_name<'py>(&self, py: Python<'py>, of: impl Fn(&FittedParameter) -> f64) -> PyResult<Bound<'py, PyDict>> {
        let values = PyDict::new(py);
        self.core.parameters.iter().try_for_each(|parameter| values.set_item(&parameter.name, of(parameter)))?;
        Ok(values)
    }
}

fn optional<'py>(py: Python<'py>, pose: Option<&Pose>) -> Option<Bound<'py, PyArray2<f64>>> {
    pose.map(|pose| pose_array(py, pose))
}

#[pymethods]
impl PyCalibration {
    /// Whether the descent ended at an optimum.
    #[getter]
    fn success(&self) -> bool {
        self.core.converged
    }

    /// A sentence that says how good the result is, what is not known, and what to try.
    #[getter]
    fn message(&self) -> String {
        said(&self.core.message())
    }

    /// Deviations from the model by name, in the order of `covariance` (m, rad): "offset JOINT" is added to the joint's angle; "link
    /// JOINT x" to "rz" are translation and rotation vector of the correction of the transform before the joint, in the frame of the
    /// joint; "base x" and so on likewise of base and tool, of camera and board, centre and plane.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.by_name(py, |parameter| parameter.value)
    }

    /// Standard deviations of `parameters` by name (m, rad).
    #[getter]
    fn deviations<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.by_name(py, |parameter| parameter.deviation)
    }

    /// Covariance of `parameters` (p, p) (m, rad). Along combinations that the measurements leave open it is that of the prior: how far
    /// arms usually are from their models.
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let size = self.core.parameters.len();
        table(py, self.core.covariance.as_slice().to_vec(), &[size, size])
    }

    /// Unit of the errors: "m", or "pixels" for image points.
    #[getter]
    fn unit(&self) -> &'static str {
        if self.core.in_pixels { "pixels" } else { "m" }
    }

    /// Root mean square of the errors of the robot as it was given. All errors leave out `outliers`.
    #[getter]
    fn rms_before(&self) -> f64 {
        self.core.before.length
    }

    /// The same with only base and tool fitted, as far as they are to be.
    #[getter]
    fn rms_placed(&self) -> f64 {
        self.core.placed.length
    }

    /// The same of the calibrated robot.
    #[getter]
    fn rms_after(&self) -> f64 {
        self.core.after.length
    }

    /// The same of measurements held out one at a time: what to expect of new ones.
    #[getter]
    fn rms_held_out(&self) -> f64 {
        self.core.held_out.length
    }

    /// Root mean square of the rotation errors of the robot as it was given (rad); NaN without orientations.
    #[getter]
    fn rotation_rms_before(&self) -> f64 {
        self.core.before.rotation
    }

    /// The same of the calibrated robot (rad).
    #[getter]
    fn rotation_rms_after(&self) -> f64 {
        self.core.after.rotation
    }

    /// The same of measurements held out one at a time (rad).
    #[getter]
    fn rotation_rms_held_out(&self) -> f64 {
        self.core.held_out.rotation
    }

    /// Error of each measurement (m,) with the robot as it was given.
    #[getter]
    fn errors_before<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.errors(py, |row| row.before.length)
    }

    /// Error of each measurement (m,) with the calibrated robot.
    #[getter]
    fn errors_after<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.errors(py, |row| row.after.length)
    }

    /// Rows of measurements that do not belong with the others and were left out.
    #[getter]
    fn outliers(&self) -> Vec<usize> {
        self.core.outliers.clone()
    }

    /// Noise of a measurement: as given, for the first row, or estimated from the residuals (length, angle (rad)); the angle is NaN without
    /// orientations.
    #[getter]
    fn sigma(&self) -> (f64, f64) {
        (self.core.noise.length, self.core.noise.rotation)
    }

    /// Identifiability of the parameters.
    #[getter]
    fn identifiable(&self) -> PyIdentifiability {
        PyIdentifiability(self.core.identifiability.clone())
    }

    /// Pose of the robot's base (4, 4) in the frame of the measurements, for `Robot.with_base`.
    #[getter]
    fn base<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        pose_array(py, self.robot.get().core.base())
    }

    /// Pose of the tool (4, 4) in the frame of the tip link, for `Robot.with_tool`.
    #[getter]
    fn tool<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        pose_array(py, self.robot.get().core.tool())
    }

    /// Pose of the camera (4, 4): in the frame of the robot's base if it is fixed, in that of the tip if it is on the arm; None without.
    #[getter]
    fn camera<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray2<f64>>> {
        optional(py, self.core.camera.as_ref())
    }

    /// Pose of the board (4, 4): in the frame of the tip if the camera is fixed, else in that of the robot's base; None without a camera.
    #[getter]
    fn board<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray2<f64>>> {
        optional(py, self.core.board.as_ref())
    }

    /// Centre of the ball bar (3,) (m) in the frame of the robot's base; None without.
    #[getter]
    fn center<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.core.centre.as_ref().map(|centre| copied(py, centre))
    }

    /// Plane (nx, ny, nz, h) (4,) in the frame of the robot's base; None without.
    #[getter]
    fn plane<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.core.plane.as_ref().map(|([x, y, z], height)| copied(py, &[*x, *y, *z, *height]))
    }

    /// Configurations to measure too, the ones that would tell most (k, n), or (k, 2, n) for distances of pairs (rad, m).
    #[getter]
    fn suggested<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let values = self.core.suggested.clone();
        let width = self.dof * if self.pairs { 2 } else { 1 };
        let count = values.len() / width.max(1);
        if self.pairs { table(py, values, &[count, 2, self.dof]) } else { table(py, values, &[count, self.dof]) }
    }

    /// Returns a URDF with the geometry of `robot`: `path_or_xml`, which the model was loaded from, with the origins of the joints that
    /// changed, and every other byte as it was. The zero of a joint becomes a part of its origin. No URDF has base and tool: give them to
    /// the loaded robot by `with_base(c.base)` and `with_tool(c.tool)`.
    ///
    /// Args:
    ///     path_or_xml: the file, or its text.
    ///
    /// Raises:
    ///     UrdfError: the text of another robot, or no URDF.
    fn to_urdf(&self, path_or_xml: &Bound<'_, PyAny>) -> PyResult<String> {
        self.robot.get().core.urdf_with_geometry(&path_or_text("path_or_xml", path_or_xml)?).map_err(raise)
    }

    /// Steps of the descent.
    #[getter]
    fn iterations(&self) -> usize {
        self.core.iterations
    }

    fn __repr__(&self) -> String {
        let Findings { before, after, errors, .. } = &self.core;
        let measurements = counted(errors.len(), "measurement");
        let unit = self.unit();
        format!("<Calibration: {measurements}, error {:.3e} {unit} before, {:.3e} after>", before.length, after.length)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let core = pickling::bytes(py, to_bytes("calibration", &self.core))?;
        pickling::restored_from::<Self>(py, (core, &self.robot, self.dof, self.pairs))
    }

    /// Restores a pickled value.
    #[staticmethod]
    fn _restore(bytes: &[u8], robot: Py<PyRobot>, dof: usize, pairs: bool) -> PyResult<Self> {
        Ok(Self { core: from_bytes("calibration", bytes).map_err(raise)?, robot, dof, pairs })
    }
}
