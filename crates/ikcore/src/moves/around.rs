//! What a program keeps clear of, and what it keeps on the way.

use crate::constraint::{Keep, refuse_broken};
use crate::error::Result;
use crate::obstacle::{ClearSpace, ClearanceSweep};
use crate::plan::{broken_along, certify, refuse_collision};
use crate::robot::Robot;
use crate::trajectory::Trajectory;

/// Advice where a move leads into something.
const ADVICE: &str = "move the path or what is in the way, or lower the margin";

/// Obstacles, links, and what must hold at every instant.
#[derive(Clone, Copy)]
pub(super) struct MoveSurroundings<'a> {
    pub robot: &'a Robot,
    pub space: Option<&'a ClearSpace<'a>>,
    pub keeps: &'a [Keep],
}

impl MoveSurroundings<'_> {
    /// Whether any motion is as good as another.
    pub fn is_free(&self) -> bool {
        self.space.is_none() && self.keeps.is_empty()
    }

    /// Checks a configuration that the caller gave.
    ///
    /// # Errors
    /// [`InCollision`](crate::Error::InCollision), [`Contradiction`](crate::Error::Contradiction).
    pub fn refuse(&self, what: &str, q: &[f64]) -> Result<()> {
        self.space.map_or(Ok(()), |space| refuse_collision(what, space, q))?;
        refuse_broken(what, self.keeps, self.robot, q)
    }

    /// What is wrong at a configuration, in words.
    pub fn fault_at(&self, q: &[f64]) -> Option<String> {
        if let Some(space) = self.space
            && !space.holds(q)
        {
            let nearest = space.clearance(q).nearest;
            let said =
                nearest.map_or_else(|| "something is too near".into(), |near| near.contact.in_words(space.margin()));
            return Some(format!("{said}; {ADVICE}"));
        }
        let broken = self.keeps.iter().find_map(|keep| keep.broken_at(self.robot, q))?;
        Some(format!("what is to be kept does not hold: {broken}; {ADVICE_KEEP}"))
    }

    /// What is wrong on a motion, at any instant, in words.
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

/// Advice where a move breaks what is to be kept.
const ADVICE_KEEP: &str = "move the path, or widen the tolerance";
