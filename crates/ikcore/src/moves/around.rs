//! Checks of a program: collisions, constraints, and torques that hold the arm.

use crate::constraint::{Keep, refuse_broken};
use crate::error::Result;
use crate::obstacle::{ClearSpace, ClearanceSweep};
use crate::plan::{broken_along, certify, refuse_collision};
use crate::robot::Robot;
use crate::timing::ConstantLimits;
use crate::trajectory::Trajectory;

/// Advice where a move collides.
const ADVICE: &str = "move the path or what is in the way, or lower the margin";

/// Obstacles, links, constraints, and limits of torques.
#[derive(Clone, Copy)]
pub(super) struct MoveSurroundings<'a> {
    pub robot: &'a Robot,
    pub limits: &'a ConstantLimits,
    pub space: Option<&'a ClearSpace<'a>>,
    pub keeps: &'a [Keep],
}

impl MoveSurroundings<'_> {
    /// Whether nothing can be in the way of a motion.
    pub fn is_free(&self) -> bool {
        self.space.is_none() && self.keeps.is_empty()
    }

    /// Whether any configuration is as good as another.
    pub fn admits_all(&self) -> bool {
        self.is_free() && !self.limits.limit_torque()
    }

    /// Whether joints can hold the arm all along a straight line in joint space.
    pub fn can_hold_along(&self, from: &[f64], to: &[f64]) -> bool {
        self.limits.hold_check().is_none_or(|mut check| check.holds_along(from, to))
    }

    /// Checks a configuration that the caller gave.
    ///
    /// # Errors
    /// [`InCollision`](crate::Error::InCollision), [`Contradiction`](crate::Error::Contradiction), [`Infeasible`](crate::Error::Infeasible)
    /// for one in which a joint cannot hold the arm.
    pub fn refuse(&self, what: &str, q: &[f64]) -> Result<()> {
        self.space.map_or(Ok(()), |space| refuse_collision(what, space, q))?;
        refuse_broken(what, self.keeps, self.robot, q)?;
        self.limits.refuse_too_heavy(what, q)
    }

    /// Returns the first violation at a configuration, in words.
    pub fn fault_at(&self, q: &[f64]) -> Option<String> {
        if let Some(space) = self.space
            && !space.holds(q)
        {
            let nearest = space.clearance(q).nearest;
            let said =
                nearest.map_or_else(|| "something is too near".into(), |near| near.contact.in_words(space.margin()));
            return Some(format!("{said}; {ADVICE}"));
        }
        if let Some(broken) = self.keeps.iter().find_map(|keep| keep.broken_at(self.robot, q)) {
            return Some(format!("what is to be kept does not hold: {broken}; {ADVICE_KEEP}"));
        }
        self.limits.too_heavy(q).map(|heavy| format!("{heavy}; {ADVICE_HOLD}"))
    }

    /// Returns the first collision or broken constraint on a motion, at any instant, in words.
    ///
    /// # Errors
    /// None in practice: the joints are those of the robot.
    pub fn fault_on(&self, motion: &Trajectory) -> Result<Option<String>> {
        if let Some(space) = self.space
            && let Err(near) = certify(&mut ClearanceSweep::new(space.scene()), motion, space.margin())
        {
            return Ok(Some(format!("{}; {ADVICE}", near.contact.in_words(space.margin()))));
        }
        let broken = broken_along(self.robot, self.keeps, motion)?;
        Ok(broken.map(|violation| format!("what is to be kept does not hold: {violation}; {ADVICE_KEEP}")))
    }
}

/// Advice where a move breaks a constraint.
const ADVICE_KEEP: &str = "move the path, or widen the tolerance";

/// Advice where a move leads to where a joint cannot hold the arm.
pub(super) const ADVICE_HOLD: &str = "move the path, lighten the payload, or raise the torque limit";
