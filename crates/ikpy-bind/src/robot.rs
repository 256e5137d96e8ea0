//! `Robot` and `pose`.

use std::path::PathBuf;
use std::sync::Arc;

use ikcore::manipulability::{self, Motion};
use ikcore::rng;
use ikcore::robot::{Dh, DhTable, Joint, JointKind, LinkCapsule, Robot};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBytes, PyTuple};

use crate::chain;
use crate::convert::{self, Rows, count, pose_array, row, rows, table, vector};
use crate::error::{invalid, raise};
use crate::limits::PyLimits;
use crate::manipulability::PyVelocityEllipsoid;

/// Link, a (3,), b (3,) and radius (m).
type Capsule<'py> = (String, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, f64);

/// A robot arm: the chain of joints from a base link to a tip link. Immutable; make one with `from_urdf`, `from_dh`,
/// `planar` or `named`.
///
/// Joint vectors hold the n independent joints in chain order (rad, m); mimic joints follow theirs. Poses are 4x4
/// matrices in the frame of the robot's base.
#[pyclass(name = "Robot", module = "beetle_ik", frozen, eq)]
pub struct PyRobot {
    pub core: Arc<Robot>,
    /// Made when it is first asked for: most results only carry it along.
    limits: PyOnceLock<Py<PyLimits>>,
}

impl PartialEq for PyRobot {
    fn eq(&self, other: &Self) -> bool {
        self.core == other.core
    }
}

impl From<Robot> for PyRobot {
    fn from(robot: Robot) -> Self {
        Self { core: Arc::new(robot), limits: PyOnceLock::new() }
    }
}

/// Numbers for n joints: one for all of them, or one each.
fn per_joint(what: &str, value: &Bound<'_, PyAny>, n: usize) -> PyResult<Vec<f64>> {
    let (values, _) = convert::scalar_or_vector(what, value)?;
    match values.len() {
        1 => Ok(vec![values[0]; n]),
        got if got == n => Ok(values),
        got => Err(invalid(format!("{what}: expected a number or {n} values (one per joint), got {got}"))),
    }
}

#[pymethods]
impl PyRobot {
    /// A robot from a URDF, read from a file or from a string of XML.
    ///
    /// Args:
    ///     path_or_xml: file, or text that contains "<".
    ///     base: link in whose frame everything is expressed; None takes the root. It need not be an ancestor of `tip`.
    ///     tip: link that is to be moved; None takes the only leaf.
    ///
    /// Revolute, continuous, prismatic, fixed and mimic joints are understood; collision shapes of spheres, cylinders,
    /// capsules and boxes become `capsules` that hold them; visuals, meshes and unknown tags are passed over. A missing velocity limit is infinite, a zero one locks the joint; `safety_controller` is ignored.
    ///
    /// Raises:
    ///     UrdfError: not XML, no joint, a cycle, two roots, a zero axis, several leaves and no `tip`.
    ///     UnknownNameError: no link of that name; the message lists them.
    #[staticmethod]
    #[pyo3(signature = (path_or_xml, *, base=None, tip=None))]
    fn from_urdf(path_or_xml: &Bound<'_, PyAny>, base: Option<&str>, tip: Option<&str>) -> PyResult<Self> {
        let source = match path_or_xml.extract::<String>() {
            Ok(text) => text,
            Err(_) => path_or_xml.extract::<PathBuf>()?.to_string_lossy().into_owned(),
        };
        Robot::from_urdf(&source, base, tip).map(Self::from).map_err(raise)
    }

    /// A robot from Denavit-Hartenberg parameters, one row per joint.
    ///
    /// Args:
    ///     a, alpha, d: link length (m), twist (rad), offset (m), each (n,).
    ///     theta: constant offset of a revolute joint, fixed angle of a prismatic one (rad), (n,); None: zeros.
    ///     kinds: "revolute", "continuous" or "prismatic" per joint; None: all revolute.
    ///     convention: "modified" (Craig: a and alpha of the link before) or "standard".
    ///     lower, upper, velocity: limits (rad, m; rad/s, m/s), a number or (n,); None: no limit.
    ///     base, tool: poses (4, 4) before the first and behind the last frame.
    ///     name: the robot's name.
    #[staticmethod]
    #[pyo3(signature = (*, a, alpha, d, theta=None, kinds=None, convention="modified", lower=None, upper=None,
                        velocity=None, base=None, tool=None, name=None))]
    #[allow(clippy::too_many_arguments)]
    fn from_dh(
        a: &Bound<'_, PyAny>,
        alpha: &Bound<'_, PyAny>,
        d: &Bound<'_, PyAny>,
        theta: Option<&Bound<'_, PyAny>>,
        kinds: Option<Vec<String>>,
        convention: &str,
        lower: Option<&Bound<'_, PyAny>>,
        upper: Option<&Bound<'_, PyAny>>,
        velocity: Option<&Bound<'_, PyAny>>,
        base: Option<&Bound<'_, PyAny>>,
        tool: Option<&Bound<'_, PyAny>>,
        name: Option<&str>,
    ) -> PyResult<Self> {
        let convention: Dh = convention.parse().map_err(raise)?;
        let mut table = DhTable::new(convention, vector("a", a)?, vector("alpha", alpha)?, vector("d", d)?);
        let n = table.a.len();
        if let Some(theta) = theta {
            table.theta = vector("theta", theta)?;
        }
        if let Some(kinds) = kinds {
            table.kinds =
                kinds.iter().map(|kind| kind.parse::<JointKind>()).collect::<Result<_, _>>().map_err(raise)?;
        }
        for (what, value, field) in [
            ("lower", lower, &mut table.lower),
            ("upper", upper, &mut table.upper),
            ("velocity", velocity, &mut table.velocity),
        ] {
            if let Some(value) = value {
                *field = per_joint(what, value, n)?;
            }
        }
        if let Some(base) = base {
            table.base = convert::rigid("base", base)?;
        }
        if let Some(tool) = tool {
            table.tool = convert::rigid("tool", tool)?;
        }
        Robot::from_dh(name.unwrap_or("dh"), &table).map(Self::from).map_err(raise)
    }

    /// A planar arm of revolute joints in the x-y plane, its base at the origin.
    ///
    /// Args:
    ///     lengths: link lengths (m), (n,).
    ///     lower, upper, velocity: limits (rad, rad/s), a number or (n,); None: -pi, pi and no velocity limit.
    #[staticmethod]
    #[pyo3(signature = (lengths, *, lower=None, upper=None, velocity=None))]
    fn planar(
        lengths: &Bound<'_, PyAny>,
        lower: Option<&Bound<'_, PyAny>>,
        upper: Option<&Bound<'_, PyAny>>,
        velocity: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let robot = Self::from(Robot::planar(&vector("lengths", lengths)?).map_err(raise)?);
        robot.with_limits(lower, upper, velocity)
    }

    /// A built-in robot; `Robot.names()` lists them.
    ///
    /// Raises:
    ///     UnknownNameError: lists the names and suggests the nearest.
    #[staticmethod]
    fn named(name: &str) -> PyResult<Self> {
        Robot::named(name).map(Self::from).map_err(raise)
    }

    /// The names of the built-in robots.
    #[staticmethod]
    fn names() -> Vec<&'static str> {
        Robot::names().collect()
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

    /// "revolute", "continuous" or "prismatic" per independent joint.
    #[getter]
    fn joint_kinds(&self) -> Vec<&'static str> {
        self.core.joints().iter().map(|joint| joint.kind.name()).collect()
    }

    /// Names of the links along the chain, base first, tip last.
    #[getter]
    fn link_names(&self) -> Vec<&str> {
        self.core.link_names().collect()
    }

    /// Lower position limits (n,) (rad, m); -inf where there is none.
    #[getter]
    fn lower<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.core.joints().iter().map(|joint| joint.lower).collect())
    }

    /// Upper position limits (n,) (rad, m); inf where there is none.
    #[getter]
    fn upper<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.core.joints().iter().map(|joint| joint.upper).collect())
    }

    /// Velocity limits (n,) (rad/s, m/s); inf where unknown, 0 for a locked joint.
    #[getter]
    fn velocity_limit<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.core.joints().iter().map(|joint| joint.velocity).collect())
    }

    /// All limits of the robot.
    #[getter]
    pub fn limits(&self, py: Python<'_>) -> PyResult<Py<PyLimits>> {
        let limits = self.limits.get_or_try_init(py, || Py::new(py, PyLimits::of(&self.core)))?;
        Ok(limits.clone_ref(py))
    }

    /// The same robot with a tool: `tool` (4, 4) is the pose of the new tip in the frame of the tip link.
    fn with_tool(&self, tool: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.core.with_tool(convert::rigid("tool", tool)?).map(Self::from).map_err(raise)
    }

    /// The same robot standing elsewhere: `base` (4, 4) is the pose of its base link.
    fn with_base(&self, base: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.core.with_base(convert::rigid("base", base)?).map(Self::from).map_err(raise)
    }

    /// The same robot with other limits, each a number or (n,) (rad, m; rad/s, m/s); None keeps what it has.
    #[pyo3(signature = (*, lower=None, upper=None, velocity=None))]
    fn with_limits(
        &self,
        lower: Option<&Bound<'_, PyAny>>,
        upper: Option<&Bound<'_, PyAny>>,
        velocity: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let n = self.core.dof();
        let read = |what: &str, value: Option<&Bound<'_, PyAny>>| value.map(|v| per_joint(what, v, n)).transpose();
        let (lower, upper, velocity) = (read("lower", lower)?, read("upper", upper)?, read("velocity", velocity)?);
        let change = |i: usize, joint: &mut Joint| {
            joint.lower = lower.as_ref().map_or(joint.lower, |values| values[i]);
            joint.upper = upper.as_ref().map_or(joint.upper, |values| values[i]);
            joint.velocity = velocity.as_ref().map_or(joint.velocity, |values| values[i]);
        };
        self.core.with_limits(change).map(Self::from).map_err(raise)
    }

    /// The room that the links take up: (link, a, b, radius) each, all points within `radius` (m) of the segment from a
    /// (3,) to b (3,) in the frame of the link. Empty unless given, or fitted to a URDF's collision shapes.
    #[getter]
    fn capsules<'py>(&self, py: Python<'py>) -> Vec<Capsule<'py>> {
        let capsules = self.core.capsules().iter();
        capsules.map(|c| (c.link.clone(), row(py, c.a.to_vec()), row(py, c.b.to_vec()), c.radius)).collect()
    }

    /// The same robot, its links taking up capsules: of this `radius` (m) along every link, or these alone, each (link,
    /// a, b, radius) with its axis from a (3,) to b (3,) in the frame of the link (m). Along the links they end at the
    /// tip: set a tool first. The way that a sliding joint opens between two links is part of neither.
    ///
    /// Raises:
    ///     UnknownNameError: no link of that name; the message lists them.
    #[pyo3(signature = (capsules=None, *, radius=None))]
    fn with_capsules(&self, capsules: Option<Vec<Bound<'_, PyAny>>>, radius: Option<f64>) -> PyResult<Self> {
        let robot = match (capsules, radius) {
            (Some(capsules), None) => {
                let capsules = capsules.iter().enumerate().map(|(i, capsule)| read_capsule(i, capsule));
                self.core.with_capsules(capsules.collect::<PyResult<_>>()?)
            }
            (None, Some(radius)) => self.core.with_capsules_along_links(radius),
            _ => return Err(invalid("with_capsules: give either radius= or a list of (link, a, b, radius)".into())),
        };
        robot.map(Self::from).map_err(raise)
    }

    /// The same robot with errors of manufacture, drawn at random: every constant offset between two joints is longer or
    /// shorter by up to `length` (m), every turning joint's zero is off by up to `angle` (rad). As a `KinematicPlant` it
    /// is an arm whose model is wrong.
    #[pyo3(signature = (*, length=0.0, angle=0.0, seed=0))]
    fn with_errors(&self, length: f64, angle: f64, seed: i128) -> PyResult<Self> {
        let mut rng = rng::stream(count("seed", seed)?, 0);
        self.core.with_errors(length, angle, &mut rng).map(Self::from).map_err(raise)
    }

    /// Forward kinematics: the pose of the tip, (4, 4) for q (n,), (m, 4, 4) for q (m, n).
    fn fk<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        match rows("joint angles", self.core.name(), self.core.dof(), q)? {
            Rows::One(q) => Ok(pose_array(py, &self.core.fk(q.as_slice()?).map_err(raise)?)?.into_any()),
            Rows::Many(q, m) => {
                let (robot, q) = (&*self.core, q.as_slice()?);
                let poses = in_pieces(py, q, robot.dof(), |q| robot.fk_all(q))?;
                Ok(table(py, poses, &[m, 4, 4])?.into_any())
            }
        }
    }

    /// The nearest configuration inside the position limits: each joint brought to the limit that it is beyond. (n,) for q (n,),
    /// (m, n) for q (m, n).
    fn clip<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let n = self.core.dof();
        match rows("joint angles", self.core.name(), n, q)? {
            Rows::One(q) => {
                self.core.check("joint angles", q.as_slice()?).map_err(raise)?;
                table(py, self.core.clip_all(q.as_slice()?).map_err(raise)?, &[n])
            }
            Rows::Many(q, m) => table(py, self.core.clip_all(q.as_slice()?).map_err(raise)?, &[m, n]),
        }
    }

    /// Poses of all links at q (n,), in the order of `link_names`: (links, 4, 4).
    fn link_poses<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let poses = self.core.link_poses(&vector("joint angles", q)?).map_err(raise)?;
        let count = poses.len();
        table(py, poses.iter().flat_map(ikcore::math::pose::rows).collect(), &[count, 4, 4])
    }

    /// Geometric Jacobian at the tip, (6, n) for q (n,), (m, 6, n) for q (m, n): linear rows (m per rad or m), then
    /// angular rows, in the axes of the base.
    fn jacobian<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let n = self.core.dof();
        match rows("joint angles", self.core.name(), n, q)? {
            Rows::One(q) => {
                self.core.check("joint angles", q.as_slice()?).map_err(raise)?;
                table(py, self.core.jacobian_all(q.as_slice()?).map_err(raise)?, &[6, n])
            }
            Rows::Many(q, m) => {
                let (robot, q) = (&*self.core, q.as_slice()?);
                table(py, in_pieces(py, q, n, |q| robot.jacobian_all(q))?, &[m, 6, n])
            }
        }
    }

    /// m configurations drawn uniformly between the limits, (m, n). Without limits: one turn, or 2 m, around zero.
    #[pyo3(signature = (m, seed=0))]
    fn random_configurations<'py>(
        &self,
        py: Python<'py>,
        m: i128,
        seed: i128,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let (m, seed) = (count("m", m)?, count("seed", seed)?);
        table(py, self.core.random_configurations(m, &mut rng::stream(seed, 0)).map_err(raise)?, &[m, self.core.dof()])
    }

    /// Yoshikawa's manipulability at q (n,) or (m, n): sqrt(det(J J')), the product of the singular values of the
    /// Jacobian, one per direction in which the tip can move at all.
    ///
    /// Args:
    ///     motion: what counts, "pose", "position" or "rotation".
    #[pyo3(signature = (q, *, motion="pose"))]
    fn manipulability<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, motion: &str) -> PyResult<Bound<'py, PyAny>> {
        let motion: Motion = motion.parse().map_err(raise)?;
        match rows("joint angles", self.core.name(), self.core.dof(), q)? {
            Rows::One(q) => {
                let value = manipulability::manipulability(&self.core, motion, q.as_slice()?).map_err(raise)?;
                Ok(value.into_pyobject(py)?.into_any())
            }
            Rows::Many(q, _) => {
                let (robot, q) = (&*self.core, q.as_slice()?);
                let values = in_pieces(py, q, robot.dof(), |q| manipulability::manipulability_all(robot, motion, q))?;
                Ok(row(py, values).into_any())
            }
        }
    }

    /// Gradient (n,) of the manipulability at q (n,), exact; `motion` as there.
    #[pyo3(signature = (q, *, motion="pose"))]
    fn manipulability_gradient<'py>(&self, q: &Bound<'py, PyAny>, motion: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        crate::manipulability::gradient(&self.core, q, motion)
    }

    /// Manipulability of the tip of every moving link, moved by the joints before it, times the volume of the unit ball
    /// (pi in the plane): (links,), the last one the tip's. Their sum is a measure of the whole arm.
    ///
    /// Links with fewer joints before them than there are directions have zero. `motion` as in `manipulability`.
    #[pyo3(signature = (q, *, motion="position"))]
    fn link_manipulability<'py>(&self, q: &Bound<'py, PyAny>, motion: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        crate::manipulability::of_links(&self.core, q, motion)
    }

    /// The ellipsoid of tip velocities at q (n,) for unit joint speeds; `motion` as in `manipulability`.
    #[pyo3(signature = (q, *, motion="position"))]
    fn velocity_ellipsoid(&self, q: &Bound<'_, PyAny>, motion: &str) -> PyResult<PyVelocityEllipsoid> {
        crate::manipulability::ellipsoid(&self.core, q, motion)
    }

    /// For `beetle_ik.interop`: (base (4, 4), elements, tool (4, 4)), as in `_from_chain`.
    fn _chain<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let [base, tool] = chain::ends(py, &self.core)?;
        (base, chain::elements(py, &self.core)?, tool).into_pyobject(py)
    }

    /// For `beetle_ik.interop`: joints are (name, kind, lower, upper, velocity), elements ("fixed", pose (4, 4)), ("moving",
    /// joint, turns, axis (3,), scale, offset) or ("link", name).
    #[staticmethod]
    fn _from_chain(
        name: &str,
        base: &str,
        joints: Vec<chain::JointParts>,
        elements: Vec<Bound<'_, PyTuple>>,
    ) -> PyResult<Self> {
        chain::built(name, base, joints, &elements).map(Self::from)
    }

    fn __repr__(&self) -> String {
        format!("<Robot '{}': {} joints, {} to {}>", self.core.name(), self.core.dof(), self.end(true), self.end(false))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let restore = py.get_type::<Self>().getattr("_from_bytes")?;
        Ok((restore, (PyBytes::new(py, &self.core.to_bytes().map_err(raise)?),)))
    }

    /// What pickle stored.
    #[staticmethod]
    fn _from_bytes(bytes: &[u8]) -> PyResult<Self> {
        Robot::from_bytes(bytes).map(Self::from).map_err(raise)
    }
}

/// (link, a, b, radius).
fn read_capsule(i: usize, value: &Bound<'_, PyAny>) -> PyResult<LinkCapsule> {
    type Parts<'py> = (String, Bound<'py, PyAny>, Bound<'py, PyAny>, f64);
    let (link, a, b, radius) = value
        .extract::<Parts<'_>>()
        .map_err(|_| invalid(format!("capsule {i} must be (link, a, b, radius), got {}", convert::summary(value))))?;
    let end = |name: &str, value: &Bound<'_, PyAny>| convert::point(&format!("{name} of capsule {i}"), value);
    Ok(LinkCapsule { link, a: end("a", &a)?, b: end("b", &b)?, radius })
}

/// `work` on whole rows of `n` numbers, without the interpreter, looking for Ctrl-C in between.
fn in_pieces(
    py: Python<'_>,
    rows: &[f64],
    n: usize,
    work: impl Fn(&[f64]) -> ikcore::Result<Vec<f64>> + Sync,
) -> PyResult<Vec<f64>> {
    /// Rows that take some ten milliseconds.
    const PIECE: usize = 1 << 17;
    if rows.len() <= PIECE * n {
        return py.detach(|| work(rows)).map_err(raise);
    }
    let mut results = vec![];
    for piece in rows.chunks(PIECE * n) {
        py.check_signals()?;
        // A wrong row is counted from the first of all rows.
        results.extend(py.detach(|| work(piece).or_else(|_| work(rows))).map_err(raise)?);
    }
    Ok(results)
}

impl PyRobot {
    fn end(&self, base: bool) -> &str {
        let mut links = self.core.link_names();
        if base { links.next() } else { links.last() }.unwrap_or_default()
    }
}
