//! Dynamics: masses of a robot, and torques, mass matrices and accelerations of one configuration or many.

use ikcore::dynamics::Inertia;
use ikcore::robot::{LinkInertia, Motions, Robot};
use ikcore::units;
use numpy::{PyArray1, PyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;

use super::PyRobot;
use super::inertia::{self, PyInertia};
use crate::convert::{Numbers, Rows, array, copied, own, point, row, shape_text, table};
use crate::error::{invalid, raise};
use crate::joint_order::{joint_rows, rate_rows};
use crate::monitor::long_call;
use crate::units::doubt;

#[pymethods]
impl PyRobot {
    /// Inertias of the links that have one, a list of `Inertia`, in the order of the file; payloads are not among them.
    #[getter]
    fn inertias<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyInertia>>> {
        inertia::shown(py, self.core.inertias())
    }

    /// Payloads, a list of `Inertia`, each in the frame of the link that carries it.
    #[getter]
    fn payloads<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyInertia>>> {
        inertia::shown(py, self.core.payloads())
    }

    /// Acceleration of free fall (3,) in the frame of the base (m/s^2): (0, 0, -9.81) unless `with_gravity` has changed it.
    #[getter]
    fn gravity<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        copied(py, &self.core.gravity())
    }

    /// Whether `torques`, `mass_matrix`, `accelerations` and `center_of_mass` can be computed: the masses of the links are known and
    /// possible, and every joint moves some. The errors of these calls say what is missing.
    #[getter]
    fn has_dynamics(&self) -> bool {
        self.core.dynamics().is_ok()
    }

    /// Torque limits (n,) (N m, N): the effort of a file; inf where there is none, or an effort of zero. No call uses them unless
    /// they are passed as limits.
    #[getter]
    fn torque_limit<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        row(py, self.core.joints().iter().map(|joint| joint.rated_torque).collect())
    }

    /// Returns a copy with these inertias of links: a dict {link: Inertia} or a list of `Inertia`; those of other links stay.
    ///
    /// Raises:
    ///     UnknownNameError: no link of that name; the message lists them.
    fn with_inertias(&self, inertias: &Bound<'_, PyAny>) -> PyResult<Self> {
        let given = inertia::inertias(inertias)?;
        let given = given.iter().map(|LinkInertia { link, inertia }| (link.as_str(), *inertia));
        self.core.with_inertias(given).map(Self::from).map_err(raise)
    }

    /// Returns a copy that carries a payload, in place of one that the same link carries already. A mass of 0 takes it off. For what
    /// a payload looks like, and may collide with, see `with_attached`.
    ///
    /// Args:
    ///     mass: mass (kg).
    ///     center: centre of mass (3,) (m).
    ///     matrix: inertia matrix (3, 3) about the centre (kg m^2); None: a point.
    ///     link: the link that carries it, in whose frame center and matrix are; None: the tip, tool included.
    ///
    /// Raises:
    ///     UnknownNameError: no link of that name; the message lists them.
    ///     InvalidInputError: a mass or matrix that no body has; several tips and no link.
    #[pyo3(signature = (mass, *, center=None, matrix=None, link=None))]
    fn with_payload(
        &self,
        mass: f64,
        center: Option<&Bound<'_, PyAny>>,
        matrix: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = crate::convert::optional_text)] link: Option<&str>,
    ) -> PyResult<Self> {
        let payload: Inertia = inertia::inertia(mass, center, matrix)?;
        doubt(units::of_offset(&self.core, "center", &payload.center))?;
        self.core.with_payload(link, payload).map(Self::from).map_err(raise)
    }

    /// Returns a copy under another acceleration of free fall (3,) (m/s^2), in the frame of the base.
    fn with_gravity(&self, gravity: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.core.with_gravity(point("gravity", gravity)?).map(Self::from).map_err(raise)
    }

    /// Returns the joint torques (n,) (N m; N for prismatic joints) that cause a motion, by inverse dynamics; (m, n) for q (m, n). At
    /// rest they hold the arm up.
    ///
    /// Friction and rotors of a file count; a joint at rest has no dry friction. With a floating base, its first six entries are the
    /// force on it in the frame of the base, and what is conjugate to the rates of its rotation vector.
    ///
    /// Args:
    ///     q: positions (n,) or (m, n).
    ///     qd: velocities (rad/s, m/s), of the shape of q; None: at rest.
    ///     qdd: accelerations (rad/s^2, m/s^2), of the shape of q; None: zero.
    ///     wrench: force (N) and moment (N m) that the surroundings exert on the tip, (6,) in the axes of the base, at the tip; (m, 6)
    ///         for each motion; (tips, 6) or (m, tips, 6) with several tips.
    ///
    /// Raises:
    ///     InvalidInputError: a robot without dynamics; the message says which link or joint lacks a mass, or has an impossible one.
    #[pyo3(signature = (q, qd=None, qdd=None, *, wrench=None))]
    fn torques<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: Option<&Bound<'py, PyAny>>,
        qdd: Option<&Bound<'py, PyAny>>,
        wrench: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let robot = &*self.core;
        let q = configurations(robot, q)?;
        let rows = q.count();
        let qd = rates(robot, "joint velocities", qd, rows)?;
        let qdd = rates(robot, "joint accelerations", qdd, rows)?;
        let wrenches = wrench.map(|wrench| wrenches(robot, wrench, rows)).transpose()?;
        let motions = Motions {
            q: q.numbers().as_slice()?,
            qd: qd.as_deref_numbers()?,
            qdd: qdd.as_deref_numbers()?,
            wrenches: wrenches.as_deref_numbers()?,
        };
        shaped(py, rows, &[robot.dof()], || robot.torques_all(&motions))
    }

    /// Returns the mass matrix (n, n) at q (n,), (m, n, n) for q (m, n), rotors included: kg m^2; rows and columns of prismatic joints
    /// kg m and kg. The kinetic energy is half of qd' M qd.
    ///
    /// Raises:
    ///     InvalidInputError: a robot without dynamics.
    fn mass_matrix<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let (robot, n) = (&*self.core, self.core.dof());
        let q = configurations(robot, q)?;
        let numbers = q.numbers().as_slice()?;
        shaped(py, q.count(), &[n, n], || robot.mass_matrix_all(numbers))
    }

    /// Returns the joint accelerations (n,) (rad/s^2, m/s^2) that torques (N m, N) cause, by forward dynamics: the inverse of
    /// `torques`. All three arguments are (n,) or (m, n).
    ///
    /// Raises:
    ///     InvalidInputError: a robot without dynamics, or a singular mass matrix.
    fn accelerations<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        torques: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let robot = &*self.core;
        let q = configurations(robot, q)?;
        let rows = q.count();
        let qd = rate_rows(robot, "joint velocities", qd, rows)?;
        let torques = rate_rows(robot, "joint torques", torques, rows)?;
        let (q, qd, torques) = (q.numbers().as_slice()?, qd.as_slice()?, torques.as_slice()?);
        shaped(py, rows, &[robot.dof()], || robot.accelerations_all(q, qd, torques))
    }

    /// Returns the centre of all masses (3,) at q (n,), (m, 3) for q (m, n), in the frame of the base (m). Links that stand still and
    /// payloads count.
    ///
    /// Raises:
    ///     InvalidInputError: a robot without dynamics.
    fn center_of_mass<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let robot = &*self.core;
        let q = configurations(robot, q)?;
        let numbers = q.numbers().as_slice()?;
        shaped(py, q.count(), &[3], || robot.center_of_mass_all(numbers))
    }
}

/// Reads configurations; a single one has n entries.
fn configurations<'py>(robot: &Robot, q: &Bound<'py, PyAny>) -> PyResult<Rows<'py>> {
    let q = joint_rows(robot, "joint angles", q)?;
    if let Rows::One(q) = &q {
        robot.check("joint angles", q.as_slice()?).map_err(raise)?;
    }
    Ok(q)
}

/// Numbers of an optional argument.
trait OptionalNumbers {
    fn as_deref_numbers(&self) -> PyResult<Option<&[f64]>>;
}

impl OptionalNumbers for Option<Numbers<'_>> {
    fn as_deref_numbers(&self) -> PyResult<Option<&[f64]>> {
        Ok(self.as_ref().map(Numbers::as_slice).transpose()?)
    }
}

fn rates<'py>(
    robot: &Robot,
    what: &str,
    value: Option<&Bound<'py, PyAny>>,
    rows: Option<usize>,
) -> PyResult<Option<Numbers<'py>>> {
    value.map(|value| rate_rows(robot, what, value, rows)).transpose()
}

/// Reads the wrenches at the tips: of all motions, or of each.
fn wrenches<'py>(robot: &Robot, value: &Bound<'py, PyAny>, rows: Option<usize>) -> PyResult<Numbers<'py>> {
    let numbers = array("wrench", value)?;
    let one: Vec<usize> = if robot.tip_count() > 1 { vec![robot.tip_count(), 6] } else { vec![6] };
    let each: Option<Vec<usize>> = rows.map(|m| [vec![m], one.clone()].concat());
    let shape = numbers.shape();
    if shape == one || each.as_ref().is_some_and(|each| shape == each) {
        return Ok(numbers);
    }
    let expected = match each {
        None => shape_text(&one),
        Some(each) => format!("{} or {}", shape_text(&one), shape_text(&each)),
    };
    Err(invalid(format!("wrench of robot '{}': expected shape {expected}, got {}", robot.name(), shape_text(shape))))
}

/// Runs `work`, and gives its numbers this shape for each row. One row takes microseconds, and keeps the interpreter.
fn shaped<'py>(
    py: Python<'py>,
    rows: Option<usize>,
    shape: &[usize],
    work: impl FnOnce() -> ikcore::Result<Vec<f64>> + Send,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    match rows {
        None => table(py, work().map_err(raise)?, shape).map(own),
        Some(m) => table(py, long_call(py, work)?, &[&[m], shape].concat()).map(own),
    }
}
