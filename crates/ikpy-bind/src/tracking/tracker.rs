//! `Tracker`.

use std::cell::Cell;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, OnceLock};

use ikcore::obstacle::Surroundings;
use ikcore::robot::Robot;
use ikcore::solver::{Status, Stopwatch, Unattended};
use ikcore::task::TargetRow;
use ikcore::tracking::{Arrival, Session, TickRule, TrackOptions};
use ikcore::units::UnitDoubt;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use super::arguments::{TrackArguments, tick_rule};
use super::filters::read_filter;
use super::session::in_progress;
use super::step::{PyStep, Remarks};
use crate::convert::{copied, drifted_rows, point, summary, vector};
use crate::error::{invalid, misfit, raise};
use crate::ik::read_target_by;
use crate::joint_order::{joint_numbers, joint_vector};
use crate::keep::{PyKeep, read_keeps};
use crate::limits::{PyLimits, Sampling, limits_of_call};
use crate::monitor::watched_with_interpreter;
use crate::obstacle::MovingObstacles;
use crate::pickling;
use crate::robot::PyRobot;
use crate::start_gate::{Outside, plain};
use crate::tip_keys::TipKeys;
use crate::tips::{Asked, TaskArguments, TipErrors, TipSettings, ToleranceArgument, read_tolerance};
use crate::traversal::traversed;
use crate::units;

/// Tracks targets that arrive one at a time, one call per tick, otherwise like `track`.
///
/// A target may jump farther than one tick can reach: the model-based rule moves all joints in proportion, with one at a
/// limit. Under acceleration or jerk limits every command leaves a full stop inside all limits, the arm brakes in time, and
/// noise of the targets is recognised and not followed; a smooth target without noise is followed without lag.
///
/// Args:
///     robot: the arm.
///     start_q: (n,), configuration at t = 0.
///     dt: time step (s).
///     task: as in `track`; it may also name tips that get their targets later.
///     solver: a solver or `WeightedPseudoInverse`, which runs in each step; None: the model-based rule.
///     limits: numbers and `Sinusoid`s; None: the robot's. Each joint needs a velocity, acceleration or jerk limit;
///         `Limits(velocity=np.inf)` says that jumps are meant. Callables cannot be used: there is no end time up to which to
///         sample them. With `torque`, which needs acceleration limits, a command is sent only if it and the stop after it are within the
///         torques at every tick, with what the arm carries; see `Tracker.robot`.
///     goals, joint_weights: as in `track`.
///     position_tolerance: largest position error (m); for several tips also a dict.
///     rotation_tolerance: largest rotation error (rad); for several tips also a dict.
///     obstacles, margin, self_collision: as in `track`; obstacles may also be `obstacles.Moving`, and may be replaced between
///         ticks: `tracker.obstacles = [...]`.
///     keep: a `Keep`, for example from `upright`, or several, as in `track`. The stop after each command keeps them too.
///     seed: seed of the random draws.
///     limit_at: as in `track`.
///     target_filter: `filters.OneEuro` or `filters.LowPass`, applied to the targets as they arrive; None: none.
///     timeout: time without a new target after which the arm stops (s); None: never.
///     start_slack: how far start_q, and q of `reset`, may be outside the position limits (rad, m), a number or (n,); the arm then begins
///         there and is led inside within its limits, see `Tracker.start_outside`. None: 5 degrees, 5 mm for joints that slide.
///         Rounding is taken off in any case.
///     recover: whether an arm that comes no nearer to its target, at a joint limit or in a singular configuration, goes to a
///         configuration on the target if one is known: by a motion of the joints inside all limits and, with obstacles, along
///         a clear line. It is for the model-based rule, and tasks without a region. False: the arm stays, and `message` says so.
///
/// For example:
///
///     >>> robot = bik.Robot.named("ur5e")
///     >>> tracker = bik.Tracker(robot, [0.0, -1.5, 1.5, -1.5, -1.5, 0.0], dt=0.01)
///     >>> step = tracker.step([0.45, 0.13, 0.47])
///     >>> step.q.shape, step.inside_limits
///     ((6,), True)
#[pyclass(name = "Tracker", module = "beetle_ik", frozen)]
pub struct PyTracker {
    session: Mutex<Session>,
    /// Task and tolerances of each tip.
    settings: TipSettings,
    /// Keys of the last targets.
    keys: Mutex<TipKeys>,
    /// Whether a step has said that the rotation of a target had drifted.
    drifted: AtomicBool,
    /// Whether a doubt about a unit was raised in a tick; there would be one in each.
    doubted: AtomicBool,
    /// Whether a solver of any budget runs in each step; other rules take microseconds.
    runs_solver: bool,
    /// The robot as first given, whose links all later ones have.
    first: Py<PyRobot>,
    /// The robot that carries other masses since; `None` for the first.
    carrying: Mutex<Option<Py<PyRobot>>>,
    /// The limits in force.
    #[pyo3(get)]
    limits: Py<PyLimits>,
}

traversed!(PyTracker: first, carrying, limits);

in_progress!(PyTracker, Session);

#[pymethods]
impl PyTracker {
    #[new]
    #[pyo3(signature = (robot, start_q, *, dt, task=None, solver=None, limits=None, goals=None, joint_weights=None,
                        position_tolerance=ToleranceArgument::All(1e-6), rotation_tolerance=ToleranceArgument::All(1e-6), obstacles=None,
                        margin=None, self_collision=None, keep=None, seed=0, limit_at="interval", target_filter=None, timeout=None,
                        start_slack=None, recover=true),
           text_signature = "(robot, start_q, *, dt, task=None, solver=None, limits=None, goals=None, joint_weights=None, position_tolerance=1e-06, rotation_tolerance=1e-06, obstacles=None, margin=None, self_collision=None, keep=None, seed=0, limit_at='interval', target_filter=None, timeout=None, start_slack=None, recover=True)")]
    #[allow(clippy::too_many_arguments)]
    fn new(
        robot: &Bound<'_, PyRobot>,
        start_q: &Bound<'_, PyAny>,
        dt: f64,
        task: Option<&Bound<'_, PyAny>>,
        solver: Option<&Bound<'_, PyAny>>,
        limits: Option<&PyLimits>,
        goals: Option<&Bound<'_, PyAny>>,
        joint_weights: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = read_tolerance)] position_tolerance: ToleranceArgument<'_>,
        #[pyo3(from_py_with = read_tolerance)] rotation_tolerance: ToleranceArgument<'_>,
        obstacles: Option<&Bound<'_, PyAny>>,
        margin: Option<f64>,
        self_collision: Option<bool>,
        keep: Option<&Bound<'_, PyAny>>,
        seed: i128,
        #[pyo3(from_py_with = crate::convert::text)] limit_at: &str,
        target_filter: Option<&Bound<'_, PyAny>>,
        timeout: Option<f64>,
        start_slack: Option<&Bound<'_, PyAny>>,
        recover: bool,
    ) -> PyResult<Self> {
        let (py, arm) = (robot.py(), &robot.get().core);
        limits.map_or(Ok(()), |limits| limits.require_no_functions("Tracker", "track"))?;
        let (in_force, resolved) = limits_of_call(py, limits, robot.get(), &Sampling::once())?;
        let rule = tick_rule(solver)?;
        let runs_solver = matches!(rule, TickRule::Solver(_));
        let given = obstacles.map(MovingObstacles::read).transpose()?;
        let shapes = given.as_ref().map(|given| given.shapes.clone());
        let surroundings = Surroundings { obstacles: shapes, margin, self_collision };
        let (position_tolerance, rotation_tolerance) = (&position_tolerance, &rotation_tolerance);
        let settings = TaskArguments { task, position_tolerance, rotation_tolerance }.read(robot.get())?;
        let only = settings.of_only(robot.get());
        let keeps = read_keeps(robot.get(), keep)?;
        let joint_weights = joint_weights.map(|weights| joint_numbers(arm, "joint_weights", weights)).transpose()?;
        let asked = TrackArguments {
            rule,
            only,
            goals,
            joint_weights,
            surroundings,
            keeps,
            recover,
            seed,
            limit_at,
            start_slack,
        };
        let target_filter = read_filter(target_filter)?;
        let options = TrackOptions { target_filter, timeout, ..asked.read(resolved)? };
        let mut session = Session::new(arm, &joint_vector(arm, "start_q", start_q)?, dt, &options).map_err(raise)?;
        units::doubt(options.surroundings.obstacles.as_ref().and_then(|all| units::of_obstacles(arm, all)))?;
        if let Some(MovingObstacles { shapes, velocities }) = given.filter(|given| !given.velocities.is_empty()) {
            session.set_obstacles(Some(shapes), velocities).map_err(raise)?;
        }
        let (session, keys) = (Mutex::new(session), Mutex::new(robot.get().tips.clone()));
        let [drifted, doubted] = [(); 2].map(|()| AtomicBool::new(false));
        Ok(Self {
            session,
            settings,
            keys,
            drifted,
            doubted,
            runs_solver,
            first: robot.clone().unbind(),
            carrying: Mutex::new(None),
            limits: in_force,
        })
    }

    /// Moves the arm by one tick towards `target`, a pose (4, 4) or a position (3,) (m), inside the limits. For a robot
    /// with several `tips`, `target` is a dict, for example {"left_tool": T}; a tip left out is free. The key
    /// ("left_tool", "right_tool") gives the second tip in the frame of the first, "center_of_mass" is the centre of
    /// all masses. A pair that has reached its target is held there, with priority over all other targets.
    ///
    /// Targets may come more rarely than ticks: `step(None)` means that there is no new target. Under acceleration or
    /// jerk limits the model-based rule then follows the motion of the last targets, for two of their intervals at
    /// most, and stops smoothly; otherwise the arm goes on towards the last target. A loop may also pass the last
    /// target again in each tick until the next one comes: in a stream of 10 Hz or more, a repeated target counts as
    /// None for two intervals. A target that is not finite raises an error and leaves the tracker unchanged. A rotation that
    /// has drifted, R'R by up to 0.25 from the identity, is taken as the nearest rotation, and the message of the first such
    /// step says so.
    ///
    /// Args:
    ///     target: target of the tip, or of several tips, at the end of the tick; None: no new target.
    ///     velocity: (3,) (m/s), velocity of the target at the end of the tick, which only `WeightedPseudoInverse` uses;
    ///         None: from the difference to the previous target.
    ///     stamp: time at which the target was measured, on the tracker's own clock, `time` (s); None: the end of the
    ///         tick. The model-based rule follows the motion of the targets up to now, over 0.25 s at most, under
    ///         acceleration or jerk limits; without these a stamp is refused. A target whose stamp is not after the last
    ///         one is ignored; the message says so, and the step is solved only if the arm meets this target as well.
    #[pyo3(signature = (target, *, velocity=None, stamp=None))]
    fn step(
        &self,
        py: Python<'_>,
        target: Option<&Bound<'_, PyAny>>,
        velocity: Option<&Bound<'_, PyAny>>,
        stamp: Option<f64>,
    ) -> PyResult<PyStep> {
        let drift = Cell::new(None);
        let read = |what: &str, value: &Bound<'_, PyAny>| {
            read_target_by(what, value, |rows| {
                let (pose, found) = drifted_rows(what, rows)?;
                drift.set(found.or(drift.get()));
                Ok(pose)
            })
        };
        let target = target.map(|target| Asked::read("target", self.first.get(), target, read)).transpose()?;
        self.doubt_once(|robot| {
            target.as_ref()?.iter().find_map(|(subject, target)| units::of_target(robot, "target", subject, target))
        })?;
        let velocity = velocity.map(|velocity| point("velocity", velocity)).transpose()?;
        if target.is_none() && (velocity.is_some() || stamp.is_some()) {
            return Err(invalid("velocity and stamp belong to a target; leave them out in step(None)".into()));
        }
        let (watch, mut session) = (Stopwatch::start(), self.session());
        let arrival = match &target {
            Some(Asked::Tips { .. }) if velocity.is_some() => {
                return Err(invalid("velocity is for the target of one tip: leave it out".into()));
            }
            Some(asked) => {
                let tips = self.settings.tasks(asked);
                Some(Arrival { tips, targets: TargetRow::from_slice(asked.values()), velocity, stamp })
            }
            None => None,
        };
        let outside = session.start_outside().to_vec();
        let core = if self.runs_solver {
            watched_with_interpreter(py, None, |watcher| session.advance(arrival, watcher).map_err(raise))?
        } else {
            session.advance(arrival, &mut Unattended).map_err(raise)?
        };
        if let Some(Asked::Tips { keys, .. }) = target {
            *self.keys() = keys;
        }
        let names = || session.robot().joints().iter().map(|joint| joint.name.clone()).collect();
        let joints = if core.away.is_some() { names() } else { vec![] };
        let drift = drift.get().filter(|_| !self.drifted.swap(true, Ordering::Relaxed));
        let held_by = match core.status {
            Status::HeldByConstraint => session.tightest(),
            Status::HeldByTorque => session.held_by_torque(),
            Status::LevelGivenUp | Status::Capped if core.idle.is_none() => session.levels_in_words(),
            _ => None,
        };
        let drift = drift.map(|drift| drift.to_string());
        Ok(PyStep {
            core,
            q: copied(py, session.q()).unbind(),
            qd: copied(py, &session.qd()).unbind(),
            limits: self.limits.clone_ref(py),
            elapsed: watch.elapsed(),
            tips: TipErrors { keys: self.keys().clone(), errors: session.tip_errors() },
            remarks: Remarks { outside, joints, lock: session.lock().cloned(), held_by, drift },
            among: session.space().map(|space| (space.clone(), session.q().to_vec())),
            around: OnceLock::new(),
        })
    }

    /// Starts the stop, as fast as the limits allow: each following `step(None)` is a tick of it, until a target
    /// arrives. Held pairs of tips stay held. The stop is the one that was certified with the last command: the arm
    /// does not give way to moving obstacles, and stays at rest afterwards.
    ///
    /// Returns:
    ///     Duration of the stop (s), to within a tick; 0 without acceleration and jerk limits.
    fn stop(&self) -> f64 {
        self.session().stop()
    }

    /// Resets to q (n,) and t = 0, at rest or in motion. Like the start, q may be outside the position limits by `start_slack`.
    ///
    /// Args:
    ///     q: configuration (n,) (rad, m).
    ///     qd: velocities (n,) (rad/s, m/s): (q - q before) / dt; None: zero.
    ///     qdd: accelerations (n,) (rad/s^2, m/s^2): differences of these velocities / dt; None: zero.
    #[pyo3(signature = (q, qd=None, qdd=None))]
    fn reset(
        &self,
        q: &Bound<'_, PyAny>,
        qd: Option<&Bound<'_, PyAny>>,
        qdd: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let read = |name: &str, value: Option<&Bound<'_, PyAny>>| value.map(|value| vector(name, value)).transpose();
        let arm = &self.first.get().core;
        let (q, qd, qdd) = (joint_vector(arm, "q", q)?, read("qd", qd)?, read("qdd", qdd)?);
        self.session().reset(&q, qd.as_deref(), qdd.as_deref()).map_err(raise)
    }

    /// Joints that began outside their position limits, each (joint, value, limit) (rad, m); empty once all are inside.
    #[getter]
    fn start_outside(&self) -> Vec<Outside> {
        plain(self.session().start_outside())
    }

    /// Obstacles that the arm keeps clear of, a tuple; None: no check. Assign their present positions between ticks. If
    /// new obstacles are in the way, the arm carries on with the stop certified before.
    #[getter]
    fn obstacles<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyTuple>>> {
        let session = self.session();
        let shapes = session.surroundings().obstacles.as_deref();
        let tuple = |shapes| PyTuple::new(py, MovingObstacles::objects(py, shapes, session.obstacle_velocities())?);
        shapes.map(tuple).transpose()
    }

    #[setter]
    fn set_obstacles(&self, obstacles: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let given = obstacles.map(MovingObstacles::read).transpose()?;
        self.doubt_once(|robot| units::of_obstacles(robot, &given.as_ref()?.shapes))?;
        let (shapes, velocities) = given.map_or((None, vec![]), |given| (Some(given.shapes), given.velocities));
        self.session().set_obstacles(shapes, velocities).map_err(raise)
    }

    /// The robot. Assign it with another payload, other masses or another gravity when what it carries changes:
    /// `tracker.robot = robot.with_payload(2.0)`. The next command and its stop are checked with these. If the present motion is then beyond a
    /// torque limit, the arm brakes as well as it can, and the status is HELD_BY_TORQUE. A robot that differs in anything else is refused.
    #[getter]
    fn robot(&self, py: Python<'_>) -> Py<PyRobot> {
        self.carrying().as_ref().unwrap_or(&self.first).clone_ref(py)
    }

    #[setter]
    fn set_robot(&self, robot: &Bound<'_, PyAny>) -> PyResult<()> {
        let wrong =
            |_| misfit(format!("robot must be a Robot, such as tracker.robot.with_payload(2), got {}", summary(robot)));
        let robot = robot.cast::<PyRobot>().map_err(wrong)?;
        self.session().set_robot(&robot.get().core).map_err(raise)?;
        *self.carrying() = Some(robot.clone().unbind());
        Ok(())
    }

    /// Constraints at every instant, a tuple of `Keep`.
    #[getter]
    fn keep<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let (session, robot) = (self.session(), &self.first.get().core);
        PyTuple::new(py, session.keeps().iter().map(|keep| PyKeep::from_core(keep, robot)))
    }

    /// Names the way to another tracker in the same state.
    fn __reduce__(&self) -> PyResult<()> {
        Err(pickling::in_progress("Tracker", "make another one, then reset it to q and qd of the last step"))
    }

    fn __repr__(&self) -> String {
        let session = self.session();
        format!("<Tracker of '{}' at t = {} s, dt = {} s>", session.robot().name(), session.time(), session.dt())
    }
}

impl PyTracker {
    /// Warns of the first doubt of all ticks.
    fn doubt_once(&self, find: impl FnOnce(&Robot) -> Option<UnitDoubt>) -> PyResult<()> {
        if self.doubted.load(Ordering::Relaxed) {
            return Ok(());
        }
        let found = find(&self.first.get().core);
        self.doubted.store(found.is_some(), Ordering::Relaxed);
        units::doubt(found)
    }

    /// Locks the robot that carries other masses.
    fn carrying(&self) -> std::sync::MutexGuard<'_, Option<Py<PyRobot>>> {
        self.carrying.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }

    /// Locks the keys of the last targets.
    fn keys(&self) -> std::sync::MutexGuard<'_, TipKeys> {
        self.keys.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }
}
