//! `state_to_state`.

use ikcore::limits::{Limits, StartSlack};
use ikcore::motion::{self, ArmState};
use ikcore::planning::EndTurns;
use pyo3::prelude::*;

use crate::convert::vector;
use crate::error::{invalid, raise};
use crate::joint_order::joint_vector;
use crate::limits::{Sampling, limits_of_call, required_limits};
use crate::robot::PyRobot;
use crate::start_gate::read_slack;
use crate::trajectory::{PyTrajectory, names};

/// Computes the fastest joint motion from one state to another; all joints arrive together.
///
/// The limits hold at every instant. With jerk limits the acceleration is continuous; without them it jumps, and
/// start_qdd and end_qdd have no effect. A joint with velocity limits alone moves at constant velocity, and start_qd and
/// end_qd have no effect. A joint that begins outside its velocity or acceleration limits, or about to leave them, first
/// returns inside them as quickly as its limits allow. The joint that needs longest moves as fast as it can; the others
/// spread their motion over the same time (Berscheid and Kroeger 2021 treat the same problem).
///
/// Args:
///     start_q, end_q: positions at the start and at the end (n,) (rad, m).
///     limits: constant limits; each joint needs one of `velocity`, `acceleration` and `jerk`. Missing fields are unlimited.
///     start_qd, end_qd: velocities (n,) (rad/s, m/s); None: zero.
///     start_qdd, end_qdd: accelerations (n,) (rad/s^2, m/s^2); None: zero.
///     joint_names: n names; None: "q1", "q2" and so on, or those of the robot.
///     robot: the arm whose joints these are: position and velocity limits left out are then its own, and joints that turn without
///         limits go the short way round.
///     start_slack: how far start_q may be outside its position limits (rad, m), a number or (n,); the motion then begins
///         there and goes inside. None: 5 degrees, 5 mm for joints of the robot that slide. Rounding is taken off in any case.
///     end_turns: "nearest": joints of the robot that turn without limits end at the whole turn of end_q nearest to start_q;
///         "as_given": at end_q.
///
/// Returns:
///     A `Trajectory` of cubic segments. Its `start_outside` names the joints of start_q that it leads inside.
///
/// Raises:
///     TypeError: limits that are no `Limits`.
///     InvalidInputError: wrong shape, NaN, limits that are not positive, or two equal states.
///     LimitError: start_q farther outside its limits than start_slack, or end_q outside them.
///     InfeasibleError: a final state that cannot be reached inside the limits, or a motion that would leave the position
///         limits.
///     UnsupportedLimit: limits that vary in time.
///
/// For example:
///
///     >>> limits = bik.Limits(velocity=2.0, acceleration=5.0)
///     >>> motion = bik.state_to_state([0.0, 0.0], [1.0, -0.5], limits)
///     >>> round(motion.duration, 3)
///     0.9
#[pyfunction]
#[pyo3(signature = (start_q, end_q, limits, *, start_qd=None, start_qdd=None, end_qd=None, end_qdd=None, joint_names=None,
                    robot=None, start_slack=None, end_turns="nearest"))]
#[allow(clippy::too_many_arguments)]
pub fn state_to_state(
    py: Python<'_>,
    start_q: &Bound<'_, PyAny>,
    end_q: &Bound<'_, PyAny>,
    limits: &Bound<'_, PyAny>,
    start_qd: Option<&Bound<'_, PyAny>>,
    start_qdd: Option<&Bound<'_, PyAny>>,
    end_qd: Option<&Bound<'_, PyAny>>,
    end_qdd: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = crate::convert::optional_texts)] joint_names: Option<Vec<String>>,
    robot: Option<&PyRobot>,
    start_slack: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = crate::convert::text)] end_turns: &str,
) -> PyResult<PyTrajectory> {
    let mut from = read_state(robot, ("start_q", start_q), [("start_qd", start_qd), ("start_qdd", start_qdd)])?;
    let mut to = read_state(robot, ("end_q", end_q), [("end_qd", end_qd), ("end_qdd", end_qdd)])?;
    let (given, mut slack) = (required_limits(limits)?, read_slack(start_slack)?);
    let end_turns: EndTurns = end_turns.parse().map_err(raise)?;
    let limits = match robot {
        None => given.for_joints(py, &names(joint_names, from.q.len())?)?,
        Some(_) if joint_names.is_some() => {
            return Err(invalid("robot has joint_names of its own: leave one out".into()));
        }
        Some(robot) => {
            robot.core.check("start_q", &from.q).and_then(|()| robot.core.check("end_q", &to.q)).map_err(raise)?;
            let (_, resolved) = limits_of_call(py, Some(given), robot, &Sampling::once())?;
            let limits = resolved.unwrap_or_else(|| Limits::of(&robot.core));
            from.q = limits.admit_start(Some(&robot.core), "start_q", &from.q, &slack).map_err(raise)?.q;
            to.q = limits.admit(Some(&robot.core), "end_q", &to.q).map_err(raise)?;
            slack = StartSlack::any();
            if end_turns == EndTurns::Nearest {
                limits.turn_near(&robot.core, &from.q, &mut to.q).map_err(raise)?;
            }
            limits
        }
    };
    let core = motion::state_to_state_from(&from, &to, &limits, &slack).map_err(raise)?;
    // The motion was found, so its start is taken.
    let led = limits.admit_start(robot.map(|robot| &*robot.core), "start_q", &from.q, &slack).map_err(raise)?;
    Ok(PyTrajectory::led(core, &led.outside))
}

/// Reads a state; velocities and accelerations that are not given are zero.
fn read_state(
    robot: Option<&PyRobot>,
    (name, q): (&str, &Bound<'_, PyAny>),
    rates: [(&str, Option<&Bound<'_, PyAny>>); 2],
) -> PyResult<ArmState> {
    let q = robot.map_or_else(|| vector(name, q), |robot| joint_vector(&robot.core, name, q))?;
    let read = |(name, value): (&str, Option<&Bound<'_, PyAny>>)| match value {
        Some(value) => vector(name, value),
        None => Ok(vec![0.0; q.len()]),
    };
    let [qd, qdd] = [read(rates[0])?, read(rates[1])?];
    Ok(ArmState { q, qd, qdd })
}
