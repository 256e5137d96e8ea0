//! `time_optimal`.

use ikcore::planning::{JointPath, SplineEnds, TimingLimits, TimingOptions, time_optimal as fastest};
use numpy::PyUntypedArrayMethods;
use pyo3::prelude::*;

use crate::convert::{array, optional_count, shape_text, vector};
use crate::error::{invalid, raise};
use crate::limits::PyLimits;
use crate::trajectory::{PyTrajectory, names};

/// The fastest motion through waypoints on a given path: its shape is kept, its timing is found.
///
/// By reachability analysis (Pham and Pham 2018), with acceleration limits imposed on whole segments instead of grid
/// points alone: velocity and acceleration limits hold at every instant, on any grid. Jerk limits, where there are any, are
/// kept by smoothing the fastest motion in time: all limits hold, but it is no longer the fastest of all.
///
/// Args:
///     waypoints_q: (k, n), joint positions to pass (rad, m).
///     limits: constant ones: `acceleration` for all joints; `velocity`, `jerk`, `lower`, `upper` as wanted.
///     knots: (k,), the path parameter of each waypoint, increasing; None: uniform in [0, 1].
///     spline: how the path's ends are shaped: "natural" without curvature, "not-a-knot" as their neighbours, "clamped"
///         without slope; "polyline": straight lines, see `blend`.
///     blend: of a polyline: its corners are rounded from so far before to so far after them (distance in joint space, at
///         most half a line); None or 0: the joints stop at each corner.
///     gridpoints: where the acceleration along the path may change; None refines until it makes no difference.
///     start_speed, end_speed: Euclidean length of the joint velocity at the ends (rad/s, m/s).
///     joint_names: n names; None: "q1", "q2", ...
///
/// Returns:
///     A `Trajectory`, exactly on the path: a polynomial of degree 6 between grid points. With jerk limits quintic pieces
///     that meet the path at their ends.
///
/// Raises:
///     InvalidInputError: wrong shape, NaN, fewer than two waypoints, a waypoint that repeats the one before it.
///     InfeasibleError: the path leaves the position limits, a joint must move that may not, too high speeds at the ends.
///     UnsupportedLimit: limits that vary in time, no acceleration limit, jerk limits on a polyline.
#[pyfunction]
#[pyo3(signature = (waypoints_q, limits, *, knots=None, spline="natural", blend=None, gridpoints=None, start_speed=0.0,
                    end_speed=0.0, joint_names=None))]
#[allow(clippy::too_many_arguments)]
pub fn time_optimal(
    py: Python<'_>,
    waypoints_q: &Bound<'_, PyAny>,
    limits: &PyLimits,
    knots: Option<&Bound<'_, PyAny>>,
    spline: &str,
    blend: Option<f64>,
    gridpoints: Option<i128>,
    start_speed: f64,
    end_speed: f64,
    joint_names: Option<Vec<String>>,
) -> PyResult<PyTrajectory> {
    let waypoints = array("waypoints_q", waypoints_q)?;
    let &[_, n] = waypoints.shape() else {
        let got = shape_text(waypoints.shape());
        return Err(invalid(format!("waypoints_q: expected shape (k, n), a row for each waypoint, got {got}")));
    };
    let joints = names(joint_names, n)?;
    let limits = limits.for_joints(py, &joints)?;
    let knots = knots.map(|knots| vector("knots", knots)).transpose()?;
    let waypoints = waypoints.as_slice()?;
    let path = if spline == "polyline" {
        if knots.is_some() {
            return Err(invalid("knots belong to a spline: the parameter of a polyline is its length".into()));
        }
        JointPath::polyline(joints, waypoints, blend.unwrap_or(0.0))
    } else {
        let ends = spline.parse::<SplineEnds>().map_err(raise)?;
        if blend.is_some() {
            return Err(invalid(format!("blend rounds the corners of spline='polyline', and '{spline}' has none")));
        }
        JointPath::spline(joints, waypoints, knots.as_deref(), ends)
    };
    let path = path.map_err(raise)?;
    let options = TimingOptions { gridpoints: optional_count("gridpoints", gridpoints)?, start_speed, end_speed };
    let limits = TimingLimits::new(&limits, "time_optimal").map_err(raise)?;
    py.detach(|| fastest(&path, &limits, &options)).map(PyTrajectory::from).map_err(raise)
}
