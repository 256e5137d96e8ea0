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
use crate::timing::{ConstantLimits, JointPath, coarse_duration, rough_duration, time_all};
use crate::trajectory::Trajectory;
use crate::wording::number;

const METHOD: Setting = Setting::Method("timed");

/// Segments of the timing per piece of the spline when the alternatives at corners are compared.
const SEGMENTS_A_PIECE: usize = 4;

/// Accuracies for which corners are rounded, each half of the one before.
const ACCURACIES: u32 = 5;

/// The part of the accuracy that a rounded corner uses; the rest is for the spline along it.
const ROUNDING_SHARE: f64 = 0.8;

/// An alternative at corners that takes longer than another by this factor is not tried on further motions.
const MUCH_SLOWER: f64 = 1.05;

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
    /// The same path with rounded corners; empty where it has none.
    rounded: Vec<RoundedPath>,
    /// Constraints at every instant.
    pub keeps: PathKeeps<'a>,
    /// The options of the call, with a start that the gate has taken.
    pub options: &'a AlongPathOptions,
    /// Stopwatch of the call.
    pub stopwatch: Stopwatch,
}

/// A path with rounded corners.
struct RoundedPath {
    path: TipPath,
    /// Largest distance from the path with corners (m, rad).
    off: f64,
    /// The accuracy that it is made for.
    most: f64,
}

impl RoundedPath {
    /// Rounded paths for accuracies that are powers of two, so that a wider accuracy has those of a tighter one.
    fn all(tip_path: &TipPath, accuracy: f64) -> Vec<Self> {
        let widest = accuracy.log2().floor();
        let of = |most: f64| {
            let off = ROUNDING_SHARE * most;
            tip_path.rounded(off).map(|path| Self { path, off, most })
        };
        let narrower = (1..ACCURACIES).map(|halvings| (widest - f64::from(halvings)).exp2());
        std::iter::once(accuracy).chain([widest.exp2()]).chain(narrower).map_while(of).collect()
    }
}

/// Alternatives at the corners of a path that took much longer than others on an earlier motion along it.
#[derive(Debug, Default)]
pub(super) struct SlowCorners {
    /// Whether stopping did.
    stopped: bool,
    /// Number of the first rounded path that did, if any: it and narrower ones are not tried again.
    rounded: Option<usize>,
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
        let rounded = RoundedPath::all(tip_path, accuracy);
        Ok(Self { robot, tip_path, limits, accuracy, rounded, keeps, options, stopwatch })
    }

    /// Decides whether the arm stops at corners, passes them or rounds them (only where `may_round`): whichever motion through `nominal`
    /// is the fastest. Returns the waypoints with the knots that this motion needs, and its rough duration (s).
    ///
    /// # Errors
    /// None in practice: waypoints that differ define a spline.
    pub(crate) fn corners_of(
        &'a self,
        nominal: &JointWaypoints,
        accuracy: f64,
        may_round: bool,
    ) -> Result<(Interpolation<'a>, JointWaypoints, f64)> {
        self.quick_corners_of(nominal, accuracy, may_round, &mut SlowCorners::default())
    }

    /// [`corners_of`](Self::corners_of) without the alternatives that were slow on earlier motions along the path.
    ///
    /// # Errors
    /// As [`corners_of`](Self::corners_of).
    pub(super) fn quick_corners_of(
        &'a self,
        nominal: &JointWaypoints,
        accuracy: f64,
        may_round: bool,
        slow: &mut SlowCorners,
    ) -> Result<(Interpolation<'a>, JointWaypoints, f64)> {
        let Self { robot, keeps, .. } = self;
        let on = |tip_path: &'a TipPath, corners: Corners, accuracy: f64| Interpolation {
            robot,
            tip_path,
            keeps: *keeps,
            corners,
            accuracy,
        };
        let mut quickest: Option<(f64, Interpolation, JointWaypoints)> = None;
        let mut timed = |interpolation: Interpolation<'a>, start: JointWaypoints| -> Result<f64> {
            let waypoints = interpolation.refined(start)?;
            let least = quickest.as_ref().map_or(f64::INFINITY, |(least, ..)| *least);
            let duration = self.duration(&interpolation, &waypoints, least)?;
            if quickest.as_ref().is_none_or(|(least, ..)| duration < *least) {
                quickest = Some((duration, interpolation, waypoints));
            }
            Ok(duration)
        };
        let (mut of_wider, mut of_stopped, mut ended) = (f64::INFINITY, 0.0, None);
        for corners in Corners::on(self.tip_path) {
            let stops = *corners == Corners::Stopped;
            if stops && slow.stopped {
                continue;
            }
            let duration = timed(on(self.tip_path, *corners, accuracy), nominal.clone())?;
            of_stopped = if stops { duration } else { of_stopped };
            of_wider = of_wider.min(duration);
        }
        let tried = &self.rounded[..slow.rounded.unwrap_or(self.rounded.len())];
        for (number, rounded) in tried.iter().enumerate().filter(|(_, it)| may_round && it.off < accuracy) {
            let interpolation = on(&rounded.path, Corners::Passed, accuracy.min(rounded.most) - rounded.off);
            let Some(start) = interpolation.moved(nominal.clone()) else { continue };
            let duration = timed(interpolation, start)?;
            // The narrower, the slower: one slower than the one before ends the search.
            if duration > of_wider {
                ended = Some((number, duration));
                break;
            }
            of_wider = duration;
        }
        let least = quickest.as_ref().map_or(f64::INFINITY, |(least, ..)| MUCH_SLOWER * least);
        slow.stopped |= of_stopped > least;
        slow.rounded = ended.filter(|(_, duration)| *duration > least).map(|(number, _)| number).or(slow.rounded);
        let stopping = || (on(self.tip_path, Corners::Stopped, accuracy), nominal.clone(), f64::INFINITY);
        Ok(quickest.map_or_else(stopping, |(duration, interpolation, waypoints)| (interpolation, waypoints, duration)))
    }

    /// Duration (s) of a motion: roughly, without jerk limits or where it is above `least` even without them.
    fn duration(&self, interpolation: &Interpolation<'_>, waypoints: &JointWaypoints, least: f64) -> Result<f64> {
        let path = interpolation.path(waypoints)?;
        let roughly = coarse_duration(&path, &self.limits, SEGMENTS_A_PIECE * path.pieces())?;
        if !self.limits.limit_jerk() || self.rounded.is_empty() || roughly > least {
            return Ok(roughly);
        }
        rough_duration(&interpolation.stretches(waypoints)?, &self.limits)
    }

    /// Duration (s) of a motion without jerk limits on a grid half as fine as that of its rough duration.
    pub(super) fn coarser_duration(
        &self,
        interpolation: &Interpolation<'_>,
        waypoints: &JointWaypoints,
    ) -> Result<f64> {
        let path = interpolation.path(waypoints)?;
        coarse_duration(&path, &self.limits, SEGMENTS_A_PIECE / 2 * path.pieces())
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
    pub(crate) fn motion(&self, interpolation: &Interpolation<'_>, waypoints: JointWaypoints) -> Result<FollowedPath> {
        let mut waypoints = interpolation.refined(waypoints)?;
        if self.options.start.is_none() {
            interpolation.draw_inside(&mut waypoints)?;
        }
        let stretches = interpolation.stretches(&waypoints)?;
        let path = interpolation.path(&waypoints)?;
        let trajectory = time_all(&stretches, &self.limits)?;
        Ok(FollowedPath { waypoints, stretches, path, trajectory })
    }

    /// [`motion`](Self::motion), or the reason why a joint cannot hold the arm on it.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub(crate) fn motion_if_held(
        &self,
        interpolation: &Interpolation<'_>,
        waypoints: JointWaypoints,
    ) -> Result<Result<FollowedPath>> {
        match self.motion(interpolation, waypoints) {
            Err(heavy @ Error::Infeasible { .. }) if self.limits.limit_torque() => Ok(Err(heavy)),
            other => other.map(Ok),
        }
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
