//! `time_optimal`.

use ikcore::limits::Limits;
use ikcore::planning::{
    ConstantLimits, JointPath, SplineEnds, TimingOptions, recorded_noise, time_optimal as fastest, time_optimal_within,
};
use numpy::PyUntypedArrayMethods;
use pyo3::prelude::*;

use crate::convert::{array, optional_count, shape_text, vector};
use crate::error::{invalid, raise};
use crate::limits::{PerJoint, Sampling, limits_of_call, required_limits};
use crate::monitor::long_call;
use crate::python_calls::warn_user;
use crate::robot::PyRobot;
use crate::trajectory::{PyTrajectory, names};
use crate::wording::said;

const METHOD: &str = "time_optimal";

/// Computes the time-optimal motion along a given joint path: the shape is kept, only the timing is optimised.
///
/// The method is reachability analysis (Pham and Pham 2018), with acceleration limits imposed on whole segments instead of
/// only at grid points: velocity and acceleration limits hold at every instant, on any grid. With jerk limits the squared rate
/// of a smooth clock along the path is a spline, and the fastest one within all limits is found by a barrier method, after
/// Debrouwere et al. (2013).
///
/// Args:
///     waypoints_q: (k, n), joint positions of the waypoints (rad, m).
///     limits: constant limits: `acceleration` for all joints; optionally `velocity`, `jerk`, `lower`, `upper`.
///     knots: (k,), increasing path parameters of the waypoints; None: uniform in [0, 1].
///     spline: cubic spline with zero curvature at its ends ("natural"), with the cubic of the neighbouring segment
///         ("not-a-knot") or with zero slope ("clamped"); or straight lines ("polyline"), see `blend`.
///     blend: for a polyline: corners are rounded from this distance before to this distance after them (in joint space, at
///         most half a line); None or 0: the joints stop at each corner.
///     gridpoints: number of points at which the acceleration along the path may change; None: refined until the duration
///         no longer improves. With jerk limits the spline has its own knots.
///     start_speed, end_speed: Euclidean norm of the joint velocity at the ends (rad/s, m/s).
///     joint_names: n names; None: "q1", "q2" and so on.
///     tolerance: a number or (n,): the motion may leave the path by this much in each joint (rad, m), at the same path
///         parameter, and then takes the smooth path in this tube on which it is fastest: noise of a recording inside it
///         is smoothed. A wider tolerance hardly ever takes longer. None or 0: exactly on the path.
///     robot: the robot whose joints these are: fields that `limits` leaves out are then its own, and `tip_speed`, `tip_acceleration` and
///         `tip_turn_speed` of `limits` are kept for its tips, and `torque` for its joints. None: no robot, and no limits of tips or torques.
///
/// Equal consecutive rows, as a recording has at rest, are one waypoint. Where the noise of a recording sets the duration, a `UserWarning`
/// says so: by how much which joint jitters, and the `tolerance` that smooths it.
///
/// Returns:
///     A `Trajectory` exactly on the path, or on the smooth path inside `tolerance`: polynomials of degree 6 between grid
///     points. With jerk limits it consists of quintic segments that meet the path at their ends. A path that begins up to 5 degrees
///     or 5 mm outside its position limits is led inside; `start_outside` names the joints.
///
/// Raises:
///     InvalidInputError: wrong shape, NaN, fewer than two waypoints that differ, or a negative tolerance.
///     InfeasibleError: the path leaves the position limits, needs motion of a locked joint, or the end speeds are too high.
///     UnsupportedLimit: limits that vary in time, no acceleration limit, jerk limits on a polyline without `tolerance`, limits of tips
///         without `robot`, or limits of a tip on a floating base.
///
/// For example:
///
///     >>> limits = bik.Limits(velocity=2.0, acceleration=5.0)
///     >>> motion = bik.time_optimal([[0, 0], [1, 0.5], [0, 1]], limits)
///     >>> round(motion.duration, 1)
///     1.8
#[pyfunction]
#[pyo3(signature = (waypoints_q, limits, *, knots=None, spline="natural", blend=None, gridpoints=None, start_speed=0.0,
                    end_speed=0.0, joint_names=None, tolerance=None, robot=None))]
#[allow(clippy::too_many_arguments)]
pub fn time_optimal(
    py: Python<'_>,
    waypoints_q: &Bound<'_, PyAny>,
    limits: &Bound<'_, PyAny>,
    knots: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = crate::convert::text)] spline: &str,
    blend: Option<f64>,
    gridpoints: Option<i128>,
    start_speed: f64,
    end_speed: f64,
    #[pyo3(from_py_with = crate::convert::optional_texts)] joint_names: Option<Vec<String>>,
    tolerance: Option<&Bound<'_, PyAny>>,
    robot: Option<&PyRobot>,
) -> PyResult<PyTrajectory> {
    let limits = required_limits(limits)?;
    let waypoints = array("waypoints_q", waypoints_q)?;
    let &[_, n @ (1..)] = waypoints.shape() else {
        let got = shape_text(waypoints.shape());
        return Err(invalid(format!("waypoints_q: expected shape (k, n), a row for each waypoint, got {got}")));
    };
    let (joints, limits) = match robot {
        None => {
            let joints = names(joint_names, n)?;
            let limits = limits.for_joints(py, &joints)?;
            (joints, ConstantLimits::new(&limits, METHOD).map_err(raise)?)
        }
        Some(_) if joint_names.is_some() => {
            return Err(invalid("robot has joint_names of its own: leave one out".into()));
        }
        Some(robot) => {
            let core = &robot.core;
            core.check("waypoints_q", &waypoints.as_slice()?[..n.min(waypoints.as_slice()?.len())]).map_err(raise)?;
            let (_, resolved) = limits_of_call(py, Some(limits), robot, &Sampling::once())?;
            let limits = resolved.unwrap_or_else(|| Limits::of(core));
            let joints = core.joints().iter().map(|joint| joint.name.clone()).collect();
            (joints, ConstantLimits::of_path(core, &limits, METHOD).map_err(raise)?)
        }
    };
    let knots = knots.map(|knots| vector("knots", knots)).transpose()?;
    let waypoints = waypoints.as_slice()?;
    let options = TimingOptions { gridpoints: optional_count("gridpoints", gridpoints)?, start_speed, end_speed };
    let path: Box<dyn FnOnce() -> ikcore::Result<JointPath> + Send> = if spline == "polyline" {
        if knots.is_some() {
            return Err(invalid(
                "knots can only be given for a spline: the parameter of a polyline is its length".into(),
            ));
        }
        Box::new(|| JointPath::polyline(joints, waypoints, blend.unwrap_or(0.0)))
    } else {
        let ends = spline.parse::<SplineEnds>().map_err(raise)?;
        if blend.is_some() {
            return Err(invalid(format!("blend can only be given for spline='polyline': '{spline}' has no corners")));
        }
        let knots = knots.as_deref();
        Box::new(move || JointPath::spline(joints, waypoints, knots, ends))
    };
    let tolerance = tolerance.map(|given| PerJoint::read("tolerance", given)).transpose()?;
    let tolerance = tolerance.map(|given| if given.single { vec![given.values[0]; n] } else { given.values });
    let (motion, noise) = long_call(py, || {
        let path = path()?;
        let motion = match &tolerance {
            None => fastest(&path, &limits, &options)?,
            Some(tolerance) => time_optimal_within(&path, tolerance, &limits, &options)?,
        };
        let tolerance = tolerance.unwrap_or_else(|| vec![0.0; n]);
        let noise = recorded_noise(&path, &tolerance, &motion, &limits)?;
        Ok((motion, noise))
    })?;
    if let Some(noise) = noise {
        warn_user(py, &said(&noise.message()))?;
    }
    let outside = limits.start_outside(&motion);
    Ok(PyTrajectory::led(motion, &outside))
}
