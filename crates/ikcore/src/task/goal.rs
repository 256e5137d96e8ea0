//! Secondary goals: costs on the joints in the null space of the task.

use super::least_torque::{LeastTorque, check_numbers, check_torque_scale};
use crate::error::{Error, Result, require_positive};
use crate::manipulability::{Manipulability, Motion};
use crate::message::{Setting, message};
use crate::objective::{Bounds, Point};
use crate::obstacle::ClearSpace;
use crate::robot::Robot;

/// Cost to minimise along the self-motion. Positive weights balance several goals.
#[derive(Debug, Clone, PartialEq)]
pub enum Goal {
    /// Distance from a posture: |q - posture|^2.
    Posture {
        /// Posture (n,) (rad, m).
        posture: Vec<f64>,
        /// Weight among several goals.
        weight: f64,
    },
    /// Distance from a posture in which joints count differently: the sum of (weight * (q - posture))^2.
    WeightedPosture {
        /// Posture (n,) (rad, m).
        posture: Vec<f64>,
        /// Weight of each joint's distance (n,): its cost of moving, compared with other joints.
        weights: Vec<f64>,
    },
    /// Distance from the middle of the limits: the sum of ((q - middle) / range)^2 over the joints that have limits.
    Centring {
        /// Weight among several goals.
        weight: f64,
    },
    /// Avoidance of singularities: -ln w, with w Yoshikawa's index.
    Manipulability {
        /// Motion of the tip that counts.
        motion: Motion,
        /// Name of the tip; `None` for the only one.
        tip: Option<String>,
        /// Weight among several goals.
        weight: f64,
    },
    /// Avoidance of singularities by the whole arm: -ln of the sum of the indices of all links
    /// ([`Manipulability::link_indices`]).
    LinkManipulability {
        /// Motion of the links' tips that counts.
        motion: Motion,
        /// Weight among several goals.
        weight: f64,
    },
    /// Distance from near bodies: the sum of ((up_to - d) / up_to)^2 over all pairs of bodies whose distance d is below
    /// `up_to`.
    Clearance {
        /// Distance beyond which a pair no longer counts (m).
        up_to: f64,
        /// Weight among several goals.
        weight: f64,
    },
    /// Torques that hold the arm up, payloads included: the sum of (torque / scale)^2 over the joints.
    LeastTorque {
        /// Torque (n,) (N m, N) that the torque of each joint is divided by; a joint with infinity does not count. `None`: the rated torques;
        /// where no joint has one, all joints count alike.
        relative_to: Option<Vec<f64>>,
        /// Weight among several goals.
        weight: f64,
    },
}

/// Goals compiled for one robot and its limits.
#[derive(Debug, Clone)]
pub struct Goals {
    terms: Vec<Term>,
    gradient: Point,
}

/// Goal compiled for evaluation.
#[derive(Debug, Clone)]
enum Term {
    /// Sum of stiffness * (q - rest)^2.
    Springs { stiffness: Vec<f64>, rest: Vec<f64> },
    /// Logarithm of an index: -weight * ln(index).
    Manipulability { measure: Manipulability, of: Part, weight: f64 },
    /// Nearness of bodies, times `weight`.
    Clearance { up_to: f64, weight: f64 },
    /// Torques at rest.
    Torque(Box<LeastTorque>),
}

/// Part of the arm that an index measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    Tip,
    AllLinks,
}

/// Smallest index used: the logarithm of a singular posture's index would be infinite.
const SINGULAR: f64 = 1e-12;

impl Goal {
    /// Weight among several goals; the largest of a joint where each has its own.
    pub fn weight(&self) -> f64 {
        match self {
            Self::WeightedPosture { weights, .. } => weights.iter().copied().fold(0.0, f64::max),
            Self::Posture { weight, .. }
            | Self::Centring { weight }
            | Self::Manipulability { weight, .. }
            | Self::LinkManipulability { weight, .. }
            | Self::Clearance { weight, .. }
            | Self::LeastTorque { weight, .. } => *weight,
        }
    }

    /// Checks the numbers of the goal.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a weight, a distance or a torque that is not positive; of the weights of joints, one must be.
    /// [`Error::Contradiction`] for torques of which none is finite.
    pub fn validate_numbers(&self) -> Result<()> {
        if let Self::WeightedPosture { weights, .. } = self
            && let Some(j) = weights.iter().position(|weight| !(*weight >= 0.0 && weight.is_finite()))
        {
            return Err(Error::out_of_range(format!("weight[{j}] of a goal"), "zero or more, and finite", weights[j]));
        }
        require_positive("weight of a goal", self.weight())?;
        match self {
            Self::Clearance { up_to, .. } => require_positive("up_to", *up_to),
            Self::LeastTorque { relative_to: Some(scale), .. } => check_numbers(scale),
            _ => Ok(()),
        }
    }

    /// Checks the goal against the robot; `among_obstacles` is true if collisions are checked.
    ///
    /// # Errors
    /// As [`validate_numbers`](Self::validate_numbers) and, for the posture, [`Robot::check`]; [`Error::Contradiction`] for a
    /// clearance goal without collision checks, and for goals that a floating base or a polynomial coupling excludes; [`Error::NoDynamics`], [`Error::WrongLength`] and [`Error::OutOfRange`] for torques.
    pub fn validate(&self, robot: &Robot, among_obstacles: bool) -> Result<()> {
        self.validate_numbers()?;
        match self {
            Self::Posture { posture, .. } => robot.check("posture", posture),
            Self::WeightedPosture { posture, weights } => {
                robot.check("posture", posture)?;
                robot.check("weight of a goal", weights)
            }
            Self::Clearance { .. } if !among_obstacles => Err(Error::Contradiction {
                problem: message!["the goal Clearance is for calls with ", Setting::Surroundings],
            }),
            // The gradient assumes that each axis is carried along by the joints before it, unlike the axes of a rotation
            // vector.
            Self::Manipulability { .. } | Self::LinkManipulability { .. } if robot.is_floating() => {
                let problem = "the goals Manipulability and LinkManipulability are not for robots on a floating base";
                Err(Error::Contradiction { problem: problem.into() })
            }
            // So does that of the torques, and both assume axes of constant length.
            Self::Manipulability { .. } | Self::LinkManipulability { .. } | Self::LeastTorque { .. }
                if robot.curve_leader().is_some() =>
            {
                robot.require_linear_couplings("a goal of manipulability or torques")
            }
            Self::Manipulability { tip: Some(tip), .. } => robot.tip_number(tip).map(|_| ()),
            Self::Manipulability { tip: None, .. } => {
                robot.require_one_tip(message!["the goal Manipulability without ", Setting::Tip])
            }
            Self::LinkManipulability { .. } => robot.require_one_tip("the goal LinkManipulability"),
            Self::LeastTorque { relative_to, .. } => check_torque_scale(robot, relative_to.as_deref()),
            _ => Ok(()),
        }
    }

    fn term(&self, robot: &Robot, bounds: &Bounds) -> Option<Term> {
        Some(match self {
            Self::Posture { posture, weight } => {
                Term::Springs { stiffness: vec![*weight; posture.len()], rest: posture.clone() }
            }
            Self::WeightedPosture { posture, weights } => {
                let stiffness = weights.iter().map(|weight| weight * weight).collect();
                Term::Springs { stiffness, rest: posture.clone() }
            }
            Self::Centring { weight } => {
                let ranges = bounds.lower().iter().zip(bounds.upper());
                // A joint without limits, or without range, has no middle.
                let springs = ranges.map(|(lower, upper)| match upper - lower {
                    range if range.is_finite() && range > 0.0 => (weight / (range * range), 0.5 * (lower + upper)),
                    _ => (0.0, 0.0),
                });
                let (stiffness, rest) = springs.unzip();
                Term::Springs { stiffness, rest }
            }
            Self::Manipulability { motion, tip, weight } => {
                let tip = tip.as_ref().and_then(|tip| robot.tip_number(tip).ok()).unwrap_or(0);
                let measure = Manipulability::of_tip(robot, tip, *motion);
                Term::Manipulability { measure, of: Part::Tip, weight: *weight }
            }
            Self::LinkManipulability { motion, weight } => Term::Manipulability {
                measure: Manipulability::of(robot, *motion),
                of: Part::AllLinks,
                weight: *weight,
            },
            Self::Clearance { up_to, weight } => Term::Clearance { up_to: *up_to, weight: *weight },
            Self::LeastTorque { relative_to, weight } => {
                Term::Torque(Box::new(LeastTorque::new(robot, relative_to.as_deref(), *weight)?))
            }
        })
    }
}

impl Goals {
    /// Compiles validated `goals` for `robot` within `bounds`.
    pub fn new(goals: &[Goal], robot: &Robot, bounds: &Bounds) -> Self {
        let terms = goals.iter().filter_map(|goal| goal.term(robot, bounds)).collect();
        Self { terms, gradient: Point::from_elem(0.0, robot.dof()) }
    }

    /// Whether there are no goals.
    pub fn is_empty(&self) -> bool {
        self.terms.is_empty()
    }

    /// Writes the gradient at `q` into `gradient`, and returns the cost. Clearances are measured in `space`.
    pub fn cost(&mut self, robot: &Robot, space: Option<&ClearSpace<'_>>, q: &[f64], gradient: &mut [f64]) -> f64 {
        gradient.fill(0.0);
        let one = &mut self.gradient;
        self.terms.iter_mut().map(|term| term.add(robot, space, q, one, gradient)).sum()
    }
}

impl Term {
    /// Adds the gradient at `q` to `gradient`, and returns the cost; `one` is scratch.
    fn add(
        &mut self,
        robot: &Robot,
        space: Option<&ClearSpace<'_>>,
        q: &[f64],
        one: &mut [f64],
        gradient: &mut [f64],
    ) -> f64 {
        match self {
            Self::Springs { stiffness, rest } => {
                let mut cost = 0.0;
                for (j, slope) in gradient.iter_mut().enumerate() {
                    let offset = q[j] - rest[j];
                    *slope += 2.0 * stiffness[j] * offset;
                    cost += stiffness[j] * offset * offset;
                }
                cost
            }
            Self::Manipulability { measure, of, weight } => {
                let index = match of {
                    Part::Tip => measure.gradient(robot, q, one),
                    Part::AllLinks => measure.overall_gradient(robot, q, one),
                };
                let index = index.max(SINGULAR);
                for (slope, one) in gradient.iter_mut().zip(one) {
                    *slope -= *weight * *one / index;
                }
                -*weight * index.ln()
            }
            Self::Clearance { up_to, weight } => {
                space.map_or(0.0, |space| *weight * space.nearness(q, *up_to, *weight, gradient))
            }
            Self::Torque(torque) => torque.add(robot, q, gradient),
        }
    }
}
