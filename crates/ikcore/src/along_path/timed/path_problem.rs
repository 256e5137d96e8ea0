//! A path, and the limits and accuracy of the motion along it.

use super::interpolation::{Corners, Interpolation, JointWaypoints};
use super::projection::PathKeeps;
use crate::along_path::deviation::TipDeviation;
use crate::along_path::tip_path::TipPath;
use crate::constraint::{KeepSweep, refuse_broken};
use crate::error::{Error, Result, require_positive};
use crate::message::Setting;
use crate::plan::{AlongPathOptions, TimedMotion};
use crate::robot::Robot;
use crate::solver::Stopwatch;
use crate::timing::{ConstantLimits, JointPath, coarse_duration, time_all};
use crate::trajectory::Trajectory;
use crate::wording::number;

const METHOD: Setting = Setting::Method("timed");

/// Segments of the timing per piece of the spline when the alternatives at corners are compared.
const SEGMENTS_A_PIECE: usize = 4;

/// A path with checked options.
pub(crate) struct PathProblem<'a> {
    /// The robot, with the position limits to keep.
    pub robot: Robot,
    /// The path of its tip.
    pub tip_path: &'a TipPath,
    /// Limits to keep.
    pub limits: ConstantLimits,
    /// Allowed distance of the tip from the path (m) and angle from its orientation (rad).
    pub accuracy: f64,
    /// What holds at every instant.
    pub keeps: PathKeeps<'a>,
    /// The options of the call, with a start that the gate has taken.
    pub options: &'a AlongPathOptions,
    /// Stopwatch of the call.
    pub stopwatch: Stopwatch,
}

/// A path that the tip follows, as joint motion.
pub(crate) struct FollowedPath {
    /// The configurations that it passes.
    pub waypoints: JointWaypoints,
    /// The joint paths between stops.
    pub stretches: Vec<JointPath>,
    /// Concatenation of these paths.
    pub path: JointPath,
    /// Fastest timing of these paths.
    pub trajectory: Trajectory,
}

impl<'a> PathProblem<'a> {
    /// # Errors
    /// Those of the limits; [`Error::OutOfRange`] for the accuracy; [`Error::Infeasible`] for a start that is not on the path;
    /// [`Error::Contradiction`] for one at which something does not hold that is to be kept.
    pub(crate) fn new(
        robot: &Robot,
        tip_path: &'a TipPath,
        keeps: PathKeeps<'a>,
        options: &'a AlongPathOptions,
    ) -> Result<Self> {
        let stopwatch = Stopwatch::start();
        let limits = ConstantLimits::for_robot(keeps.robot, options.limits.as_ref(), METHOD)?;
        limits.require_accelerations(METHOD)?;
        let accuracy = options.accuracy.unwrap_or_else(|| tip_path.default_accuracy());
        require_positive("accuracy", accuracy)?;
        if let Some(q) = &options.start {
            require_on_path(robot, q, tip_path, accuracy)?;
            refuse_broken("start_q", keeps.keeps, keeps.robot, q)?;
        }
        let robot = limits.applied_to(robot)?;
        Ok(Self { robot, tip_path, limits, accuracy, keeps, options, stopwatch })
    }

    /// Decides whether the arm stops at corners, depending on which motion through `nominal` is faster. Returns the waypoints
    /// with the knots that this motion needs.
    ///
    /// # Errors
    /// None in practice: waypoints that differ define a spline.
    pub(crate) fn corners_of(
        &'a self,
        nominal: &JointWaypoints,
        accuracy: f64,
    ) -> Result<(Interpolation<'a>, JointWaypoints)> {
        let Self { robot, tip_path, limits, keeps, .. } = self;
        let mut quickest: Option<(f64, Interpolation, JointWaypoints)> = None;
        for corners in Corners::on(tip_path) {
            let interpolation = Interpolation { robot, tip_path, keeps: *keeps, corners: *corners };
            let waypoints = interpolation.refined(nominal.clone(), accuracy)?;
            let path = interpolation.path(&waypoints)?;
            let duration = coarse_duration(&path, limits, SEGMENTS_A_PIECE * path.pieces())?;
            if quickest.as_ref().is_none_or(|(least, ..)| duration < *least) {
                quickest = Some((duration, interpolation, waypoints));
            }
        }
        let stopped = Interpolation { robot, tip_path, keeps: *keeps, corners: Corners::Stopped };
        let stopping = || (stopped, nominal.clone());
        Ok(quickest.map_or_else(stopping, |(_, interpolation, waypoints)| (interpolation, waypoints)))
    }

    /// Whether everything that is to be kept is certified to hold along a motion.
    pub(crate) fn is_kept(&self, motion: &Trajectory) -> bool {
        let PathKeeps { robot, keeps } = self.keeps;
        let whole = [0.0, motion.duration()];
        keeps.is_empty() || KeepSweep::new(robot, keeps).check(&TimedMotion::new(motion), whole).is_ok()
    }

    /// Returns the fastest motion through `waypoints`, with knots added as its accuracy requires.
    ///
    /// # Errors
    /// None in practice, as for [`corners_of`](Self::corners_of).
    pub(crate) fn motion(
        &self,
        interpolation: &Interpolation<'_>,
        waypoints: JointWaypoints,
        accuracy: f64,
    ) -> Result<FollowedPath> {
        let mut waypoints = interpolation.refined(waypoints, accuracy)?;
        if self.options.start.is_none() {
            interpolation.draw_inside(&mut waypoints)?;
        }
        let stretches = interpolation.stretches(&waypoints)?;
        let path = interpolation.path(&waypoints)?;
        let trajectory = time_all(&stretches, &self.limits)?;
        Ok(FollowedPath { waypoints, stretches, path, trajectory })
    }
}

/// Checks that at `q` the tip is at the start of the path, within its tolerance and `accuracy`.
fn require_on_path(robot: &Robot, q: &[f64], tip_path: &TipPath, accuracy: f64) -> Result<()> {
    let configurations = |_: f64, out: &mut [f64]| out.copy_from_slice(q);
    let [distance, angle] = TipDeviation { robot, tip_path, configurations }.parts_at(0.0);
    let (what, value, unit) = if distance > accuracy {
        ("has the tip", distance, "m")
    } else if angle > accuracy {
        ("turns the tip", angle, "rad")
    } else {
        return Ok(());
    };
    let tolerance_band = if tip_path.has_tolerance() { ", beyond its tolerance," } else { "" };
    let (value, accuracy) = (number(value), number(accuracy));
    let problem =
        format!("start_q {what} {value} {unit}{tolerance_band} from the path's first point, allowed {accuracy} {unit}");
    Err(Error::Infeasible { problem: problem.into() })
}
