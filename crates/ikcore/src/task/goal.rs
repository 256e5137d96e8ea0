//! Goals beside the task: what the joints should do where the task leaves them free.

use crate::error::{Error, Result};
use crate::manipulability;
use crate::objective::Bounds;
use crate::robot::Robot;

/// One goal, as a cost to be lowered along the self-motion. Weights (positive) compare goals with each other.
#[derive(Debug, Clone, PartialEq)]
pub enum Goal {
    /// Near a posture: |q - posture|^2.
    Posture {
        /// (n,) (rad, m).
        posture: Vec<f64>,
        /// Share among several goals.
        weight: f64,
    },
    /// Away from the limits: the sum of ((q - middle) / range)^2 over the joints that have limits.
    Centring {
        /// Share among several goals.
        weight: f64,
    },
    /// Far from singularities: -ln w, with w Yoshikawa's manipulability.
    Manipulability {
        /// Share among several goals.
        weight: f64,
    },
}

/// Goals for one robot between its limits.
#[derive(Debug, Clone, Copy)]
pub struct Goals<'a> {
    goals: &'a [Goal],
    robot: &'a Robot,
    bounds: &'a Bounds,
}

impl Goal {
    /// Checks the goal against the robot.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a weight that is not positive; as [`Robot::check`] for the posture.
    pub fn validate(&self, robot: &Robot) -> Result<()> {
        let weight = self.weight();
        if !(weight > 0.0 && weight.is_finite()) {
            return Err(Error::out_of_range("weight of a goal", "positive and finite", weight));
        }
        match self {
            Self::Posture { posture, .. } => robot.check("posture", posture),
            Self::Centring { .. } | Self::Manipulability { .. } => Ok(()),
        }
    }

    /// Share among several goals.
    pub fn weight(&self) -> f64 {
        match self {
            Self::Posture { weight, .. } | Self::Centring { weight } | Self::Manipulability { weight } => *weight,
        }
    }

    /// Adds the weighted gradient at `q` to `gradient`; the weighted cost.
    fn add(&self, robot: &Robot, bounds: &Bounds, q: &[f64], gradient: &mut [f64]) -> f64 {
        let weight = self.weight();
        match self {
            Self::Posture { posture, .. } => spring(gradient, q.iter().zip(posture).map(|(q, to)| (weight, q - to))),
            Self::Centring { .. } => {
                let ranges = bounds.lower().iter().zip(bounds.upper());
                spring(
                    gradient,
                    q.iter().zip(ranges).map(|(q, (lower, upper))| {
                        let range = upper - lower;
                        // A joint without an end, or without room, has no middle to go to.
                        let stiffness = if range.is_finite() && range > 0.0 { weight / (range * range) } else { 0.0 };
                        (stiffness, if stiffness > 0.0 { q - 0.5 * (lower + upper) } else { 0.0 })
                    }),
                )
            }
            Self::Manipulability { .. } => manipulability::add_log_gradient(robot, q, -weight, gradient),
        }
    }
}

/// Adds the gradient of the sum of stiffness * offset^2 to `gradient`; that sum.
fn spring(gradient: &mut [f64], springs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let mut cost = 0.0;
    for (gradient, (stiffness, offset)) in gradient.iter_mut().zip(springs) {
        *gradient += 2.0 * stiffness * offset;
        cost += stiffness * offset * offset;
    }
    cost
}

impl<'a> Goals<'a> {
    /// `goals`, which were found in order, for `robot` within `bounds`.
    pub fn new(goals: &'a [Goal], robot: &'a Robot, bounds: &'a Bounds) -> Self {
        Self { goals, robot, bounds }
    }

    /// Writes the gradient at `q` into `gradient` and returns the cost.
    pub fn cost(&self, q: &[f64], gradient: &mut [f64]) -> f64 {
        gradient.fill(0.0);
        self.goals.iter().map(|goal| goal.add(self.robot, self.bounds, q, gradient)).sum()
    }
}
