//! Secondary goals: costs on the joints in the null space of the task.

use crate::error::{Result, require_positive};
use crate::manipulability::{Manipulability, Motion};
use crate::objective::{Bounds, Point};
use crate::robot::Robot;

/// A cost to minimise along the self-motion. Positive weights balance several goals.
#[derive(Debug, Clone, PartialEq)]
pub enum Goal {
    /// Distance from a posture: |q - posture|^2.
    Posture {
        /// (n,) (rad, m).
        posture: Vec<f64>,
        /// Weight among several goals.
        weight: f64,
    },
    /// Distance from the middle of the limits: the sum of ((q - middle) / range)^2 over the joints that have limits.
    Centring {
        /// Weight among several goals.
        weight: f64,
    },
    /// Avoidance of singularities: -ln w, with w Yoshikawa's index.
    Manipulability {
        /// The motion of the tip that counts.
        motion: Motion,
        /// Weight among several goals.
        weight: f64,
    },
    /// Avoidance of singularities by the whole arm: -ln of the sum of the indices of all links
    /// ([`Manipulability::link_indices`]).
    LinkManipulability {
        /// The motion of the links' tips that counts.
        motion: Motion,
        /// Weight among several goals.
        weight: f64,
    },
}

/// Goals compiled for one robot and its limits.
#[derive(Debug, Clone, PartialEq)]
pub struct Goals {
    terms: Vec<Term>,
    gradient: Point,
}

/// A goal in its computed form.
#[derive(Debug, Clone, PartialEq)]
enum Term {
    /// The sum of stiffness * (q - rest)^2.
    Springs { stiffness: Vec<f64>, rest: Vec<f64> },
    /// -weight * ln of an index.
    Manipulability { measure: Manipulability, of: Part, weight: f64 },
}

/// The part of the arm that an index measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    Tip,
    AllLinks,
}

/// Smallest index used: the logarithm of a singular posture's index would be infinite.
const SINGULAR: f64 = 1e-12;

impl Goal {
    /// Weight among several goals.
    pub fn weight(&self) -> f64 {
        match self {
            Self::Posture { weight, .. }
            | Self::Centring { weight }
            | Self::Manipulability { weight, .. }
            | Self::LinkManipulability { weight, .. } => *weight,
        }
    }

    /// Checks the weight.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) for a weight that is not positive.
    pub fn validate_weight(&self) -> Result<()> {
        require_positive("weight of a goal", self.weight())
    }

    /// Checks the goal against the robot.
    ///
    /// # Errors
    /// As [`validate_weight`](Self::validate_weight) and, for the posture, [`Robot::check`].
    pub fn validate(&self, robot: &Robot) -> Result<()> {
        self.validate_weight()?;
        match self {
            Self::Posture { posture, .. } => robot.check("posture", posture),
            Self::Centring { .. } | Self::Manipulability { .. } | Self::LinkManipulability { .. } => Ok(()),
        }
    }

    fn term(&self, robot: &Robot, bounds: &Bounds) -> Term {
        match self {
            Self::Posture { posture, weight } => {
                Term::Springs { stiffness: vec![*weight; posture.len()], rest: posture.clone() }
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
            Self::Manipulability { motion, weight } => {
                Term::Manipulability { measure: Manipulability::of(robot, *motion), of: Part::Tip, weight: *weight }
            }
            Self::LinkManipulability { motion, weight } => Term::Manipulability {
                measure: Manipulability::of(robot, *motion),
                of: Part::AllLinks,
                weight: *weight,
            },
        }
    }
}

impl Goals {
    /// Compiles validated `goals` for `robot` within `bounds`.
    pub fn new(goals: &[Goal], robot: &Robot, bounds: &Bounds) -> Self {
        let terms = goals.iter().map(|goal| goal.term(robot, bounds)).collect();
        Self { terms, gradient: Point::from_elem(0.0, robot.dof()) }
    }

    /// Whether there are no goals.
    pub fn is_empty(&self) -> bool {
        self.terms.is_empty()
    }

    /// Writes the gradient at `q` into `gradient` and returns the cost.
    pub fn cost(&mut self, robot: &Robot, q: &[f64], gradient: &mut [f64]) -> f64 {
        gradient.fill(0.0);
        let one = &mut self.gradient;
        self.terms.iter().map(|term| term.add(robot, q, one, gradient)).sum()
    }
}

impl Term {
    /// Adds the gradient at `q` to `gradient` and returns the cost; `one` is scratch.
    fn add(&self, robot: &Robot, q: &[f64], one: &mut [f64], gradient: &mut [f64]) -> f64 {
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
                    *slope -= weight * *one / index;
                }
                -weight * index.ln()
            }
        }
    }
}
