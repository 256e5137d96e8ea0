//! Readings of a session between its ticks.

use std::sync::Arc;

use super::Session;
use crate::constraint::Keep;
use crate::limits::{JointOutside, Limits};
use crate::message::Message;
use crate::objective::Point;
use crate::obstacle::{ClearSpace, Surroundings};
use crate::robot::Robot;
use crate::task::TipError;
use crate::tracking::kept::Kept;
use crate::tracking::record::Accepted;
use crate::tracking::safety_filter::FilterWork;

impl Session {
    /// Accepted configuration (n,).
    pub fn q(&self) -> &[f64] {
        &self.arm.q
    }

    /// Velocity of the last tick (n,) (rad/s, m/s); zero before the first.
    pub fn qd(&self) -> Point {
        self.arm.q.iter().zip(&self.arm.before).map(|(q, before)| (q - before) / self.arm.dt).collect()
    }

    /// Time of the accepted configuration (s).
    pub fn time(&self) -> f64 {
        self.arm.time()
    }

    /// Limits in force.
    pub fn limits(&self) -> &Limits {
        &self.arm.limits
    }

    /// Names the joints that cannot move because of limits of zero, with the remedy; `None` without such limits.
    pub fn lock(&self) -> Option<&Arc<Message>> {
        self.arm.lock.as_ref()
    }

    /// Joints that began outside their position limits; empty once all are inside.
    pub fn start_outside(&self) -> &[JointOutside] {
        self.arm.outside.as_ref().map_or(&[], |outside| &outside.joints)
    }

    /// Time step (s).
    pub fn dt(&self) -> f64 {
        self.arm.dt
    }

    /// Velocity limits of the last tick (n,) (rad/s, m/s).
    pub fn velocity_limit(&self) -> &[f64] {
        &self.arm.tick_box.velocity
    }

    /// Errors of each target of several tips; empty before targets arrive, and for one tip.
    pub fn tip_errors(&self) -> Vec<TipError> {
        if self.arm.has_one_tip() { vec![] } else { self.arm.aims().errors(&self.arm.robot, &self.arm.q).to_vec() }
    }

    /// Which levels of the targets are met, and which are not, by tip; `None` for targets without an order.
    pub fn levels_in_words(&self) -> Option<String> {
        Some(self.arm.levels()?.in_words(&self.arm.robot, &self.arm.q))
    }

    /// Positions (m) of the tips that have targets, in the order of the targets; for pairs, in the frame of the first tip.
    pub(in crate::tracking) fn tip_positions(&self) -> Vec<[f64; 3]> {
        let mut positions = vec![];
        self.arm.aims().positions(&self.arm.robot, &self.arm.q, |position| positions.push(position));
        positions
    }

    /// Configuration and box of the last tick.
    pub(in crate::tracking) fn accepted(&self) -> Accepted<'_> {
        let clearance = self.space().map(|space| space.clearance(&self.arm.q));
        let nearest = clearance.as_ref().and_then(|clearance| clearance.nearest.as_ref());
        Accepted {
            q: &self.arm.q,
            tick_box: &self.arm.tick_box,
            measured: nearest.and_then(|nearest| nearest.contact.measured()),
            clearance: clearance.map_or(f64::NAN, |clearance| clearance.distance),
        }
    }

    /// The tracked robot.
    pub fn robot(&self) -> &Robot {
        &self.arm.robot
    }

    /// Clear space of the arm, if collisions are avoided.
    pub fn space(&self) -> Option<&Arc<ClearSpace<'static>>> {
        self.safety.as_ref().and_then(|safety| safety.space())
    }

    /// Work of the safety filter since it began, with the first obstacles or pairs of tips; zero without either.
    pub fn filter_work(&self) -> FilterWork {
        self.safety.as_ref().map_or_else(FilterWork::default, |safety| safety.work())
    }

    /// Constraints at every instant.
    pub fn keeps(&self) -> &[Keep] {
        self.safety.as_ref().and_then(|safety| safety.kept()).map_or(&[], Kept::keeps)
    }

    /// The constraint nearest to its tolerance, in words; `None` without constraints.
    pub fn tightest(&self) -> Option<String> {
        self.safety.as_ref()?.kept()?.tightest_at(&self.arm.q)
    }

    /// Whether torques are limited.
    pub(in crate::tracking) fn limits_torque(&self) -> bool {
        self.torques.is_some()
    }

    /// The torque limit that holds the arm back, in words; `None` if none does.
    pub fn held_by_torque(&self) -> Option<String> {
        self.torques.as_ref()?.held_in_words(&self.arm.given)
    }

    /// Velocities of the obstacles (m/s); empty if all are at rest.
    pub fn obstacle_velocities(&self) -> &[[f64; 3]] {
        self.safety.as_ref().map_or(&[], |safety| safety.velocities())
    }

    /// Obstacles, margin and choice of self-collision.
    pub fn surroundings(&self) -> &Surroundings {
        &self.surroundings
    }
}
