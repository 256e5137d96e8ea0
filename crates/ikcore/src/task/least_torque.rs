//! Cost of holding a configuration: the squares of the torques that hold the arm up.

use crate::dynamics::DynamicsScratch;
use crate::error::{Error, Result};
use crate::objective::Point;
use crate::robot::Robot;

/// The number of coordinates of a floating base, which has no motors.
const FLOATING: usize = 6;

/// Sum of stiffness * torque^2 over the joints, with the torques at rest.
#[derive(Debug, Clone)]
pub(super) struct LeastTorque {
    stiffness: Vec<f64>,
    scratch: DynamicsScratch,
    torques: Point,
}

const SCALE: &str = "relative_to of the goal LeastTorque";

/// Checks numbers that torques are compared with: positive ones, of which one is finite.
pub(super) fn check_numbers(scale: &[f64]) -> Result<()> {
    if let Some(j) = scale.iter().position(|torque| !(*torque > 0.0)) {
        let what = format!("{SCALE}, entry {j},");
        return Err(Error::out_of_range(what, "positive, infinite for a joint that does not count", scale[j]));
    }
    if scale.iter().all(|torque| torque.is_infinite()) {
        return Err(Error::Contradiction {
            problem: format!("{SCALE} is infinite for all joints: none would count").into(),
        });
    }
    Ok(())
}

/// Checks that `robot` has torques, and as many joints as there are numbers.
pub(super) fn check_torque_scale(robot: &Robot, relative_to: Option<&[f64]>) -> Result<()> {
    robot.dynamics()?;
    let Some(scale) = relative_to else { return Ok(()) };
    if scale.len() != robot.dof() {
        let expected = format!("{} (one per joint)", robot.dof());
        return Err(Error::WrongLength { what: SCALE.into(), expected, got: scale.len() });
    }
    Ok(())
}

impl LeastTorque {
    /// Compiles the cost for a robot that has dynamics.
    pub(super) fn new(robot: &Robot, relative_to: Option<&[f64]>, weight: f64) -> Option<Self> {
        let dynamics = robot.dynamics().ok()?;
        let rated: Vec<f64> = robot.joints().iter().map(|joint| joint.rated_torque).collect();
        let scale = match relative_to {
            Some(scale) => scale.to_vec(),
            None if rated.iter().any(|torque| torque.is_finite()) => rated,
            // Any number would do: it is the same for all joints. This one has the size of their torques.
            None => vec![dynamics.carried_weight(); robot.dof()],
        };
        let driven = |joint: usize| !(robot.is_floating() && joint < FLOATING);
        let stiffness = |(joint, torque): (usize, &f64)| {
            if driven(joint) && *torque > 0.0 && torque.is_finite() { weight / (torque * torque) } else { 0.0 }
        };
        Some(Self {
            stiffness: scale.iter().enumerate().map(stiffness).collect(),
            scratch: robot.dynamics_scratch(dynamics),
            torques: Point::from_elem(0.0, robot.dof()),
        })
    }

    /// Adds the gradient at `q` to `gradient`, and returns the cost.
    pub(super) fn add(&mut self, robot: &Robot, q: &[f64], gradient: &mut [f64]) -> f64 {
        let Self { stiffness, scratch, torques } = self;
        let Ok(dynamics) = robot.dynamics() else { return 0.0 };
        robot.write_frames(q, &mut scratch.frames);
        dynamics.holding(scratch, torques);
        let mut cost = 0.0;
        for (torque, stiffness) in torques.iter_mut().zip(stiffness) {
            cost += *stiffness * *torque * *torque;
            *torque *= 2.0 * *stiffness;
        }
        dynamics.add_holding_slope(scratch, torques, gradient);
        cost
    }
}
