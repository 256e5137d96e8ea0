//! Forward kinematics and Jacobians, for one configuration or many.

use ikcore::math::pose;
use ikcore::rng;
use ikcore::robot::Robot;
use numpy::PyArrayDyn;
use pyo3::prelude::*;

use super::PyRobot;
use crate::convert::{Rows, count, own, pose_array, table};
use crate::error::raise;
use crate::joint_order::{joint_rows, joint_vector};
use crate::monitor::{QUICK_ROWS, in_pieces, long_call};

#[pymethods]
impl PyRobot {
    /// Returns the pose of the tip by forward kinematics: (4, 4) for q (n,), (m, 4, 4) for q (m, n). A robot with
    /// several tips gives the poses of all, (tips, 4, 4) or (m, tips, 4, 4), in the order of `tips`. With `link`,
    /// returns the pose of any link of the robot; `all_link_names` lists them.
    ///
    /// Raises:
    ///     UnknownNameError: no link of that name; the message lists them.
    #[pyo3(signature = (q, *, link=None))]
    fn fk<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = crate::convert::optional_text)] link: Option<&str>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robot = &*self.core;
        if robot.tip_count() > 1 && link.is_none() {
            return self.of_all_tips(py, q, &[4, 4], Robot::tips_fk_all).map(Bound::into_any);
        }
        match joint_rows(robot, "joint angles", q)? {
            Rows::One(q) => {
                let q = q.as_slice()?;
                let pose = link.map_or_else(|| robot.fk(q), |link| robot.link_fk(link, q)).map_err(raise)?;
                Ok(own(pose_array(py, &pose)).into_any())
            }
            Rows::Many(q, m) => {
                let poses = in_pieces(py, q.as_slice()?, robot.dof(), QUICK_ROWS, |q| match link {
                    None => robot.fk_all(q),
                    Some(link) => robot.link_fk_all(link, q),
                })?;
                Ok(own(table(py, poses, &[m, 4, 4])?).into_any())
            }
        }
    }

    /// Returns the poses of the links of the chain at q (n,), in the order of `link_names`: (links, 4, 4).
    fn link_poses<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let poses = self.core.link_poses(&joint_vector(&self.core, "joint angles", q)?).map_err(raise)?;
        let count = poses.len();
        table(py, poses.iter().flat_map(pose::rows).collect(), &[count, 4, 4]).map(own)
    }

    /// Returns the poses of all links at q (n,), in the order of `all_link_names`: (links, 4, 4).
    fn all_link_poses<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let poses = self.core.all_link_poses(&joint_vector(&self.core, "joint angles", q)?).map_err(raise)?;
        let count = poses.len();
        table(py, poses.iter().flat_map(pose::rows).collect(), &[count, 4, 4]).map(own)
    }

    /// Returns the geometric Jacobian at the tip, (6, n) for q (n,), (m, 6, n) for q (m, n): linear rows (m per rad or
    /// m), then angular rows, along the axes of the base. A robot with several tips gives the Jacobians of all, (tips,
    /// 6, n) or (m, tips, 6, n). With `link`, returns the Jacobian at the origin of any link of the robot;
    /// `all_link_names` lists them.
    ///
    /// Raises:
    ///     UnknownNameError: no link of that name; the message lists them.
    #[pyo3(signature = (q, *, link=None))]
    fn jacobian<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = crate::convert::optional_text)] link: Option<&str>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let (robot, n) = (&*self.core, self.core.dof());
        if robot.tip_count() > 1 && link.is_none() {
            return self.of_all_tips(py, q, &[6, n], Robot::tips_jacobian_all);
        }
        let jacobians = |q: &[f64]| match link {
            None => robot.jacobian_all(q),
            Some(link) => robot.link_jacobian_all(link, q),
        };
        match joint_rows(robot, "joint angles", q)? {
            Rows::One(q) => {
                robot.check("joint angles", q.as_slice()?).map_err(raise)?;
                table(py, jacobians(q.as_slice()?).map_err(raise)?, &[6, n]).map(own)
            }
            Rows::Many(q, m) => table(py, in_pieces(py, q.as_slice()?, n, QUICK_ROWS, jacobians)?, &[m, 6, n]).map(own),
        }
    }

    /// Draws m configurations uniformly within the limits, (m, n); joints without limits within one turn, or 2 m,
    /// around zero.
    #[pyo3(signature = (m, seed=0))]
    fn random_configurations<'py>(
        &self,
        py: Python<'py>,
        m: i128,
        seed: i128,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let (m, seed) = (count("m", m)?, count("seed", seed)?);
        let drawn = long_call(py, || self.core.random_configurations(m, &mut rng::stream(seed, 0)))?;
        table(py, drawn, &[m, self.core.dof()]).map(own)
    }
}

impl PyRobot {
    /// Returns matrices of this `shape`, one for each of several tips, at one configuration or many.
    fn of_all_tips<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        shape: &[usize; 2],
        each: impl Fn(&Robot, &[f64]) -> ikcore::Result<Vec<f64>> + Sync,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let (robot, n, tips) = (&*self.core, self.core.dof(), self.core.tip_count());
        match joint_rows(robot, "joint angles", q)? {
            Rows::One(q) => {
                robot.check("joint angles", q.as_slice()?).map_err(raise)?;
                table(py, each(robot, q.as_slice()?).map_err(raise)?, &[tips, shape[0], shape[1]]).map(own)
            }
            Rows::Many(q, m) => {
                let all = in_pieces(py, q.as_slice()?, n, QUICK_ROWS / tips, |q| each(robot, q))?;
                table(py, all, &[m, tips, shape[0], shape[1]]).map(own)
            }
        }
    }
}
