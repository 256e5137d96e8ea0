//! Changes of a session between its ticks: other masses, other obstacles, a stop, a new start.

use std::sync::Arc;

use super::Session;
use crate::constraint::refuse_broken;
use crate::error::Result;
use crate::obstacle::{Obstacles, Surroundings};
use crate::rng;
use crate::robot::Robot;
use crate::tracking::around_arm::ObstacleVelocities;
use crate::tracking::idle::Idle;
use crate::tracking::limited_state::LimitedState;
use crate::tracking::safety_filter::SafetyFilter;
use crate::tracking::settling::Settling;

impl Session {
    /// Exchanges the masses: `robot` is the one of the session with other masses, payloads or gravity. The next command and its stop are checked
    /// with the new ones.
    ///
    /// # Errors
    /// [`Error::Contradiction`](crate::Error::Contradiction) for a robot that differs in anything else,
    /// [`Error::NoDynamics`](crate::Error::NoDynamics) for one without masses where torques are limited; the session is then as
    /// before.
    pub fn set_robot(&mut self, robot: &Robot) -> Result<()> {
        if *robot == self.arm.given {
            return Ok(());
        }
        robot.require_masses_alone_differ(&self.arm.given)?;
        if let Some(torques) = &mut self.torques {
            torques.carry(robot, &self.arm.limits)?;
        }
        self.arm.robot = Arc::new(self.arm.robot.with_masses_of(robot));
        self.arm.given = robot.clone();
        self.settling.iter_mut().for_each(Settling::restart);
        Ok(())
    }

    /// Replaces the obstacles by these, at their current poses, with their `velocities` (m/s); an empty list means all at rest,
    /// `None` no obstacles. The margin and the choice of self-collision stay.
    ///
    /// # Errors
    /// As [`new`](Self::new); the session is then as before.
    pub fn set_obstacles(&mut self, obstacles: Option<Obstacles>, velocities: Vec<[f64; 3]>) -> Result<()> {
        let rest = velocities.is_empty() && self.obstacle_velocities().is_empty();
        if rest && obstacles == self.surroundings.obstacles {
            return Ok(()); // A loop that gives the same in every tick frees no arm.
        }
        let motion = ObstacleVelocities::new(velocities, obstacles.as_ref().map_or(0, |all| all.len()))?;
        let surroundings = Surroundings { obstacles, ..self.surroundings.clone() };
        // A margin given before is kept for obstacles that may come later.
        let space =
            if surroundings.apply_to(&self.arm.robot) { surroundings.clear_space(&self.arm.robot)? } else { None };
        if space.is_some() || !self.arm.has_one_tip() || !self.keeps().is_empty() {
            let safety = match self.safety.take() {
                Some(safety) => self.safety.insert(safety),
                None => self.safety.insert(Box::new(SafetyFilter::new(None, None, &self.arm.limits)?)),
            };
            safety.replace(space, motion, &self.arm.limits)?;
        } else {
            self.safety = None;
        }
        self.surroundings = surroundings;
        if let Some(way_back) = &mut self.way_back {
            way_back.note_replaced();
        }
        self.settling.iter_mut().for_each(Settling::restart);
        Ok(())
    }

    /// Stops as fast as the limits allow, from the next tick on until a target arrives. Held pairs of tips stay held; the arm
    /// does not evade approaching obstacles, neither while braking nor afterwards. Returns the duration of the stop (s): 0 for
    /// an arm without acceleration limits.
    pub fn stop(&mut self) -> f64 {
        self.begin_stopping(Idle::Stopped);
        let held = self.safety.as_ref().and_then(|safety| safety.ticks_to_stop());
        let fastest = || self.arm.limited.as_ref().map_or(0.0, LimitedState::time_to_stop);
        held.map_or_else(fastest, |ticks| self.arm.dt * ticks)
    }

    /// Resets the session to `q` (n,) at t = 0, with velocities `qd` (n,) (rad/s, m/s) and accelerations `qdd` (n,) (rad/s^2,
    /// m/s^2); `None` means zero. Both are differences of commands in the last tick.
    ///
    /// # Errors
    /// As [`new`](Self::new) for a start; [`Error::Contradiction`](crate::Error::Contradiction) for an arm that could not
    /// stop inside its limits.
    pub fn reset(&mut self, q: &[f64], qd: Option<&[f64]>, qdd: Option<&[f64]>) -> Result<()> {
        if let Some(kept) = self.safety.as_ref().and_then(|safety| safety.kept()) {
            refuse_broken("q", kept.keeps(), kept.robot(), q)?;
        }
        if let Some(torques) = self.torques.as_mut().filter(|_| q.len() == self.arm.q.len()) {
            torques.require_held("q", q, &self.arm.given)?;
        }
        self.arm.reset(q, [qd, qdd])?;
        self.arm.set_braking_part(1.0);
        self.torques.iter_mut().for_each(|torques| torques.restart());
        self.stopping = None;
        if let Some(way_back) = &mut self.way_back {
            way_back.restart();
        }
        self.settling.iter_mut().for_each(Settling::restart);
        self.start_rule();
        if let Some(safety) = &mut self.safety {
            safety.forget();
        }
        self.rng = rng::stream(self.seed, 0).prepared();
        Ok(())
    }
}
