//! Required distances of pairs during a motion.

use super::near_rows::NearRow;
use crate::bodies::BodyPair;

/// The distances to keep. Obstacles count as moved, in any direction, by as far as their speed takes them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RequiredDistance<'a> {
    /// Distance to keep (m).
    pub margin: f64,
    /// Largest speed of each obstacle (m/s); empty if all are at rest.
    pub speeds: &'a [f64],
    /// Age of the obstacle poses at tick 0 (s).
    pub since: f64,
    /// Length of a tick (s).
    pub dt: f64,
    /// Near pairs where the arm would come to rest if it braked now, the nearest first. A pair that is nearer than it should be even
    /// there need only not come nearer: a motion may end no worse than the stop.
    pub at_rest: &'a [NearRow],
    /// Slack of these (m), since a motion outwards must be certified too.
    pub tolerance_band: f64,
    /// Bodies that overlap at rest need only end no deeper in each other than the deepest of them are there, whatever is in between.
    pub only_parts: bool,
}

impl RequiredDistance<'static> {
    /// One distance (m) from everything, all of it at rest.
    pub fn constant(margin: f64) -> Self {
        Self { margin, speeds: &[], since: 0.0, dt: 0.0, at_rest: &[], tolerance_band: 0.0, only_parts: false }
    }
}

impl RequiredDistance<'_> {
    /// Distance wanted from an obstacle, or from another link, at a tick (m).
    pub fn wanted(&self, obstacle: Option<usize>, tick: f64) -> f64 {
        let speed = obstacle.and_then(|i| self.speeds.get(i)).copied().unwrap_or(0.0);
        if speed == 0.0 { self.margin } else { self.margin + speed * (self.since + tick * self.dt) }
    }

    /// The largest distance wanted from anything.
    pub(super) fn most_wanted(&self, tick: f64) -> f64 {
        let fastest = self.speeds.iter().copied().fold(0.0, f64::max);
        self.margin + if fastest == 0.0 { 0.0 } else { fastest * (self.since + tick * self.dt) }
    }

    /// Distance that a pair must keep at a tick (m).
    pub(super) fn needed(&self, pair: BodyPair, tick: f64) -> f64 {
        let obstacle = if let BodyPair::Obstacle { obstacle, .. } = pair { Some(obstacle) } else { None };
        let wanted = self.wanted(obstacle, tick);
        let mut near = self.at_rest.iter().take_while(|row| row.distance < wanted);
        let Some(row) = near.find(|row| row.pair.order() == pair.order()) else { return wanted };
        let counts = if self.only_parts && row.distance < 0.0 { &self.at_rest[0] } else { row };
        counts.distance - self.tolerance_band
    }
}
