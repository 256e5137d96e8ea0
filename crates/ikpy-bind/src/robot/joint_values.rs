//! Joint values as controllers, messages and files deliver them.

use numpy::PyArrayDyn;
use pyo3::prelude::*;

use super::PyRobot;
use crate::convert::{Rows, own, summary, table};
use crate::error::{invalid, raise};
use crate::joint_order::{joint_rows, joint_vector, q_from};
use crate::monitor::{QUICK_ROWS, in_pieces};
use crate::python_calls;

#[pymethods]
impl PyRobot {
    /// Moves each joint of q to its nearest position limit if it is outside: (n,) for q (n,), (m, n) for q (m, n). This changes the
    /// pose of the tip; `wrap` takes off whole turns, which does not.
    fn clip<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let n = self.core.dof();
        match joint_rows(&self.core, "joint angles", q)? {
            Rows::One(q) => {
                self.core.check("joint angles", q.as_slice()?).map_err(raise)?;
                table(py, self.core.clip_all(q.as_slice()?).map_err(raise)?, &[n]).map(own)
            }
            Rows::Many(q, m) => {
                let (robot, q) = (&*self.core, q.as_slice()?);
                table(py, in_pieces(py, q, n, QUICK_ROWS, |q| robot.clip_all(q))?, &[m, n]).map(own)
            }
        }
    }

    /// Returns the same posture with whole turns added to or taken off its joints, so that q is inside the position limits: (n,) for
    /// q (n,), (m, n) for q (m, n). Poses of all links stay the same.
    ///
    /// Controllers that report angles from 0 to 360 degrees, or count turns, become usable this way. A joint inside its limits
    /// stays where it is, one outside takes the fewest turns, and a joint without limits comes to (-pi, pi]; with `near`, each
    /// takes the turn nearest to it. Rounding beyond a limit is taken off. A joint that no turn brings inside may be outside by
    /// 5 degrees, as the start of a motion may. Joints that slide stay as they are, outside by 5 mm at most.
    ///
    /// Args:
    ///     q: joint positions (n,) or (m, n) (rad, m).
    ///     near: configuration (n,) to which the result is as near as possible; None: see above.
    ///
    /// Raises:
    ///     LimitError: a joint is farther outside its limits at every whole turn, or a joint that slides is (an
    ///         `InvalidInputError`).
    ///
    /// For example:
    ///
    ///     >>> panda = bik.Robot.named("panda")
    ///     >>> panda.wrap([6.0, 0.2, 0.0, 4.7, 0.0, 1.6, 0.8]).round(2).tolist()
    ///     [-0.28, 0.2, 0.0, -1.58, 0.0, 1.6, 0.8]
    #[pyo3(signature = (q, *, near=None))]
    fn wrap<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        near: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let (robot, n) = (&*self.core, self.core.dof());
        let near = near.map(|near| joint_vector(robot, "near", near)).transpose()?;
        let near = near.as_deref();
        match joint_rows(robot, "q", q)? {
            Rows::One(q) => table(py, robot.wrap(q.as_slice()?, near).map_err(raise)?, &[n]).map(own),
            Rows::Many(q, m) => {
                table(py, in_pieces(py, q.as_slice()?, n, QUICK_ROWS, |q| robot.wrap_all(q, near))?, &[m, n]).map(own)
            }
        }
    }

    /// Returns joint positions by name in the order of q, (n,) or (m, n), from a message, a dict or a table.
    ///
    /// Args:
    ///     names: names of the joints, in any order. Alone: values with names, such as a dict, a `sensor_msgs/JointState`, a
    ///         row or table of pandas, or a structured array; of columns named "q:joint", these alone are taken.
    ///     values: (k,) or (m, k), one column per name (rad, m).
    ///     degrees: whether joints that turn are in degrees.
    ///     ignore_extra: whether to pass over names of other joints, such as those of a gripper.
    ///
    /// Raises:
    ///     UnknownNameError: a name that is no joint of q; the message lists these.
    ///     InvalidInputError: a joint that is missing or there twice, wrong shape, or NaN.
    ///
    /// For example:
    ///
    ///     >>> arm = bik.Robot.planar([1.0, 1.0])
    ///     >>> arm.q_from(["joint_2", "joint_1"], [90.0, 0.0], degrees=True).round(2).tolist()
    ///     [0.0, 1.57]
    #[pyo3(signature = (names, values=None, *, degrees=false, ignore_extra=false))]
    fn q_from<'py>(
        &self,
        names: &Bound<'py, PyAny>,
        values: Option<&Bound<'py, PyAny>>,
        degrees: bool,
        ignore_extra: bool,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        if let Some(values) = values {
            let wrong = |_| invalid(format!("names must be a list of joint names, got {}", summary(names)));
            let names: Vec<String> = names.extract().map_err(wrong)?;
            return q_from(&self.core, &names, values, degrees, ignore_extra);
        }
        match python_calls::labelled(names)? {
            Some((names, values)) => q_from(&self.core, &names, &values, degrees, ignore_extra),
            None => Err(invalid(format!(
                "values are missing: give names and values, or values with names (a dict, a JointState, a table), got {}",
                summary(names)
            ))),
        }
    }
}
