//! `Trajectory`.

use ikcore::interrupt::checkpoint_at;
use ikcore::limits::JointOutside;
use ikcore::robot::{Motions, Robot};
use ikcore::trajectory::{Coefficients, POWERS, Trajectory};
use numpy::{PyArray1, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::IntoPyDict;

use crate::convert::{
    Array, array, copied, counted, is_list, own, row, shape_text, shortened, summary, table, times, vector,
};
use crate::error::{invalid, misfit, raise};
use crate::hash::content_hash;
use crate::monitor::long_call;
use crate::options::NewArguments;
use crate::python_calls;
use crate::robot::PyRobot;
use crate::start_gate::{Outside, plain};

/// A joint trajectory of polynomial segments between knots: q_j(t) = sum over p of coefficients[i, j, p] (t - time[i])^p.
///
/// Args:
///     time: the knots (k,) (s), starting at 0.
///     coefficients: (k - 1, n, degree + 1), in ascending powers; the degree is at most 6.
///     joint_names: n names; None: "q1", "q2" and so on.
///     start_outside: joints that begin outside their limits, each (joint, value, limit), as the attribute says.
///
/// For example:
///
///     >>> motion = bik.Trajectory.from_samples([0.0, 1.0, 2.0], [[0.0], [0.5], [0.0]])
///     >>> q, qd, qdd = motion.at(0.5)
///     >>> float(q[0]), float(qd[0])
///     (0.25, 0.5)
#[pyclass(name = "Trajectory", module = "beetle_ik", frozen, eq)]
#[derive(Debug)]
pub struct PyTrajectory {
    core: Trajectory,
    start_outside: Vec<Outside>,
}

impl From<Trajectory> for PyTrajectory {
    fn from(core: Trajectory) -> Self {
        Self { core, start_outside: vec![] }
    }
}

/// The motion alone counts: files do not hold where its limits are.
impl PartialEq for PyTrajectory {
    fn eq(&self, other: &Self) -> bool {
        self.core == other.core
    }
}

impl PyTrajectory {
    /// Motion that leads the joints `outside` their limits inside.
    pub fn led(core: Trajectory, outside: &[JointOutside]) -> Self {
        Self { core, start_outside: plain(outside) }
    }

    pub fn core(&self) -> &Trajectory {
        &self.core
    }
}

/// Returns the given names of `n` joints; by default "q1", "q2" and so on.
pub fn names(given: Option<Vec<String>>, n: usize) -> PyResult<Vec<String>> {
    match given {
        None => Ok((1..=n).map(|i| format!("q{i}")).collect()),
        Some(names) if names.len() == n => Ok(names),
        Some(names) => Err(invalid(format!("joint_names: expected {n}, one for each joint, got {}", names.len()))),
    }
}

#[pymethods]
impl PyTrajectory {
    #[new]
    #[pyo3(signature = (time, coefficients, *, joint_names=None, start_outside=None))]
    fn new(
        time: &Bound<'_, PyAny>,
        coefficients: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = crate::convert::optional_texts)] joint_names: Option<Vec<String>>,
        start_outside: Option<Vec<Outside>>,
    ) -> PyResult<Self> {
        let values = array("coefficients", coefficients)?;
        let &[_, n, powers @ 1..=POWERS] = values.shape() else {
            let got = shape_text(values.shape());
            return Err(invalid(format!(
                "coefficients: expected shape (k - 1, n, degree + 1), degree at most 6, got {got}"
            )));
        };
        let padded = values.as_slice()?.chunks_exact(powers).map(|given| {
            let mut polynomial: Coefficients = [0.0; POWERS];
            polynomial[..powers].copy_from_slice(given);
            polynomial
        });
        let (joints, knots, coefficients) = (names(joint_names, n)?, vector("time", time)?, padded.collect());
        let core = long_call(time.py(), || Trajectory::new(joints, knots, coefficients))?;
        Ok(Self { core, start_outside: start_outside.unwrap_or_default() })
    }

    /// Makes a trajectory through samples q (k, n) at `time` (k,) (s). Segments are linear; cubic if velocities qd (k, n)
    /// are given, quintic if accelerations qdd (k, n) are given too. A table of pandas gives its columns as `joint_names`.
    #[staticmethod]
    #[pyo3(signature = (time, q, *, qd=None, qdd=None, joint_names=None))]
    fn from_samples(
        time: &Bound<'_, PyAny>,
        q: &Bound<'_, PyAny>,
        qd: Option<&Bound<'_, PyAny>>,
        qdd: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = crate::convert::optional_texts)] joint_names: Option<Vec<String>>,
    ) -> PyResult<Self> {
        let (py, time) = (time.py(), vector("time", time)?);
        let named = if is_list(q) { None } else { python_calls::labelled(q)? };
        let (columns, q) = named.map_or_else(|| (None, q.clone()), |(columns, q)| (Some(columns), q));
        let read = |what: &str, value: &Bound<'_, PyAny>| {
            let values = array(what, value)?;
            match values.shape() {
                [k, n] if *k == time.len() => Ok((values.as_slice()?.to_vec(), *n)),
                shape => {
                    let (k, got) = (time.len(), shape_text(shape));
                    Err(invalid(format!("{what}: expected shape ({k}, n), a row for each time, got {got}")))
                }
            }
        };
        let (q, n) = read("q", &q)?;
        let qd = qd.map(|value| read("qd", value)).transpose()?.map(|(values, _)| values);
        let qdd = qdd.map(|value| read("qdd", value)).transpose()?.map(|(values, _)| values);
        let joints = names(joint_names.or(columns), n)?;
        long_call(py, || Trajectory::from_samples(joints, &time, &q, qd.as_deref(), qdd.as_deref())).map(Self::from)
    }

    /// The knots (k,) (s).
    #[getter]
    fn time<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        copied(py, self.core.knots())
    }

    /// Coefficients (k - 1, n, degree + 1), in ascending powers of the time since the knot.
    #[getter]
    fn coefficients<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        let (polynomials, n) = (self.core.coefficients(), self.core.joints().len());
        let powers = self.core.degree() + 1;
        let used = polynomials.iter().flat_map(|polynomial| polynomial[..powers].iter().copied()).collect();
        table(py, used, &[polynomials.len() / n, n, powers])
    }

    /// Positions at the knots (k, n) (rad, m).
    #[getter]
    fn q<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        Ok(self.at_times(py, self.core.knots(), false)?.0)
    }

    /// Velocities at the knots (k, n) (rad/s, m/s), of the segment that begins there.
    #[getter]
    fn qd<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        Ok(self.at_times(py, self.core.knots(), false)?.1)
    }

    /// Accelerations at the knots (k, n) (rad/s^2, m/s^2), of the segment that begins there.
    #[getter]
    fn qdd<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        Ok(self.at_times(py, self.core.knots(), false)?.2)
    }

    /// Duration (s).
    #[getter]
    fn duration(&self) -> f64 {
        self.core.duration()
    }

    /// Names of the joints, in the order of q.
    #[getter]
    fn joint_names(&self) -> Vec<String> {
        self.core.joints().to_vec()
    }

    /// Joints that begin outside their limits and are led inside, each (joint, value, limit) (rad, m): of the motions of
    /// `state_to_state`, `time_optimal` and plans. Files do not hold them.
    #[getter]
    fn start_outside(&self) -> Vec<Outside> {
        self.start_outside.clone()
    }

    /// Returns the largest speed of each joint (n,) (rad/s, m/s), exact over all times.
    fn max_velocity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(own(row(py, long_call(py, || Ok(self.core.max_velocity()))?)))
    }

    /// Returns the largest acceleration of each joint (n,) (rad/s^2, m/s^2), exact within the segments. Jumps of the
    /// velocity at knots are not included.
    fn max_acceleration<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(own(row(py, long_call(py, || Ok(self.core.max_acceleration()))?)))
    }

    /// Returns the largest jerk of each joint (n,) (rad/s^3, m/s^3), exact within the segments. Jumps of the acceleration
    /// at knots are not included.
    fn max_jerk<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(own(row(py, long_call(py, || Ok(self.core.max_jerk()))?)))
    }

    /// Returns (q, qd, qdd) at t (s): (n,) each for a number, (k, n) for t (k,). Times outside the trajectory are clamped.
    fn at<'py>(&self, py: Python<'py>, t: &Bound<'py, PyAny>) -> PyResult<(Array<'py>, Array<'py>, Array<'py>)> {
        let (times, single) = times(t)?;
        self.at_times(py, &times, single)
    }

    /// Returns (time, q, qd, qdd) every `dt` (s) and at the end: (k,), and (k, n) each.
    #[allow(clippy::type_complexity)]
    fn sample<'py>(
        &self,
        py: Python<'py>,
        dt: &Bound<'py, PyAny>,
    ) -> PyResult<(Bound<'py, PyArray1<f64>>, Array<'py>, Array<'py>, Array<'py>)> {
        let dt: f64 = dt.extract().map_err(|_| {
            misfit(format!(
                "dt must be a number of seconds, got {}; at(t) gives the motion at given times",
                summary(dt)
            ))
        })?;
        let times = self.core.sample_times(dt).map_err(raise)?;
        let (q, qd, qdd) = self.at_times(py, &times, false)?;
        Ok((own(row(py, times)), q, qd, qdd))
    }

    /// Returns the joint torques (k, n) (N m; N for prismatic joints) that cause this motion of `robot` at t (k,) (s), (n,) for a number,
    /// as `robot.torques` does. Times outside the trajectory are clamped.
    ///
    /// Raises:
    ///     InvalidInputError: a robot without dynamics, or with another number of joints.
    fn torques<'py>(&self, py: Python<'py>, robot: PyRef<'_, PyRobot>, t: &Bound<'py, PyAny>) -> PyResult<Array<'py>> {
        self.torques_of(py, &robot.core, t)
    }

    /// Returns this trajectory followed by a rest of `pause` (s) and by `motion`, which must begin where this one ends.
    #[pyo3(signature = (motion, *, pause=0.0))]
    fn then(&self, py: Python<'_>, motion: &Self, pause: f64) -> PyResult<Self> {
        let core = long_call(py, || self.core.then(&motion.core, pause))?;
        Ok(Self { core, start_outside: self.start_outside() })
    }

    /// Writes samples as CSV: every `dt` (s) and at the end; None: at the knots. The file appears complete or not at all.
    #[pyo3(signature = (file, *, dt=None))]
    fn to_csv(slf: Bound<'_, Self>, file: Bound<'_, PyAny>, dt: Option<f64>) -> PyResult<()> {
        python_calls::write(slf.py(), "to_csv", (&slf, file, dt))
    }

    /// Writes knots and coefficients as npz. The file appears complete or not at all; a name without ending gets ".npz", as by
    /// `numpy.savez`.
    fn to_npz(slf: Bound<'_, Self>, file: Bound<'_, PyAny>) -> PyResult<()> {
        python_calls::write(slf.py(), "to_npz", (&slf, file))
    }

    /// Reads a file that `to_csv` wrote, or any CSV with a column `time` and one column per joint.
    #[staticmethod]
    fn from_csv<'py>(file: Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        python_calls::read("from_csv", file)
    }

    /// Reads a file that `to_npz` wrote.
    #[staticmethod]
    fn from_npz<'py>(file: Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        python_calls::read("from_npz", file)
    }

    /// Draws positions, velocities and accelerations; returns a matplotlib figure.
    fn plot<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        python_calls::plot(slf.into_any(), "trajectory")
    }

    fn _repr_html_<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        python_calls::html(slf.into_any(), "trajectory")
    }

    fn __repr__(&self) -> String {
        let led: Vec<String> = self.start_outside.iter().map(|(joint, ..)| format!("'{joint}'")).collect();
        let led = if led.is_empty() { String::new() } else { format!(", leads {} inside", led.join(" and ")) };
        format!(
            "<Trajectory of {}, {} s, {} knots{led}>",
            counted(self.core.joints().len(), "joint"),
            shortened(self.core.duration()),
            self.core.knots().len()
        )
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<NewArguments<'py>> {
        let arguments = (self.time(py), self.coefficients(py)?).into_pyobject(py)?;
        let named = [("joint_names", self.joint_names())].into_py_dict(py)?;
        if !self.start_outside.is_empty() {
            named.set_item("start_outside", self.start_outside())?;
        }
        Ok((arguments, named))
    }
}

impl PyTrajectory {
    /// Returns the torques that cause this motion of `robot` at `t`.
    pub fn torques_of<'py>(&self, py: Python<'py>, robot: &Robot, t: &Bound<'py, PyAny>) -> PyResult<Array<'py>> {
        let (n, joints) = (robot.dof(), self.core.joints().len());
        if n != joints {
            let (name, theirs, ours) = (robot.name(), counted(n, "joint"), counted(joints, "joint"));
            return Err(invalid(format!("robot '{name}' has {theirs}, and the trajectory {ours}")));
        }
        let (times, single) = times(t)?;
        let (q, qd, qdd) = self.at_times(py, &times, single)?;
        let (q, qd, qdd) = (q.to_vec()?, qd.to_vec()?, qdd.to_vec()?);
        let motions = Motions { q: &q, qd: Some(&qd), qdd: Some(&qdd), wrenches: None };
        let torques = long_call(py, || robot.torques_all(&motions))?;
        let shape = if single { vec![n] } else { vec![times.len(), n] };
        table(py, torques, &shape).map(own)
    }

    fn at_times<'py>(
        &self,
        py: Python<'py>,
        times: &[f64],
        single: bool,
    ) -> PyResult<(Array<'py>, Array<'py>, Array<'py>)> {
        let n = self.core.joints().len();
        let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; times.len() * n]);
        let mut fill = || {
            for (i, t) in times.iter().enumerate() {
                checkpoint_at(i)?;
                let row = i * n..(i + 1) * n;
                self.core.at(*t, &mut q[row.clone()], &mut qd[row.clone()], &mut qdd[row])?;
            }
            Ok(())
        };
        if single {
            fill().map_err(raise)?
        } else {
            long_call(py, fill)?
        }
        let shape = if single { vec![n] } else { vec![times.len(), n] };
        let made = |values| table(py, values, &shape).map(own);
        Ok((made(q)?, made(qd)?, made(qdd)?))
    }
}
