//! Constraints on the command of a tracked arm, from the bodies around it.
//!
//! Each near pair of bodies limits how far the rest configuration may move towards the other body. A moving body acts before it
//! is near: rows at its closest approach lead the arm aside, out of its path; rows at its present pose would only drive the arm
//! ahead of it, into a corner. Constraints from moving bodies are soft, those from static ones are hard.

use std::sync::Arc;

use super::constrained_step::ConstrainedStep;
use super::step_context::StepContext;
use crate::error::{Error, Result, require_finite};
use crate::limits::{Field, Limits};
use crate::math::MAX_DOF;
use crate::math::row_step::{Row, SOFTNESS};
use crate::math::vector::{dot, norm};
use crate::objective::Point;
use crate::obstacle::{
    ClearSpace, Coming, ComingRows, Edge, JointMotion, MotionCertificate, NearRow, NearRows, RequiredDistance,
};

/// Desired clearance beyond the margin at the rest configuration (m), as room for the certificate.
const ROOM: f64 = 2e-4;
/// Required clearance beyond the margin at the rest configuration (m).
const LEAST_ROOM: f64 = 2e-5;

/// Smallest and largest distance beyond the margin at which a pair becomes a row (m).
const NEAR: [f64; 2] = [0.03, 0.2];

/// Time for evading an approaching obstacle (s).
const WARNING: f64 = 0.2;

/// Evasion speed (m/s), which determines how early the arm starts to evade.
const GIVING_WAY: f64 = 0.05;
/// Prediction horizon (s).
const FORESEEN: f64 = 3.0;

/// Desired clearance beyond the margin (m) of an arm that has to evade and has limited acceleration: closer to an obstacle, the
/// certificate of the motion between ticks would refuse to let it start.
const ROOM_TO_START: f64 = 3e-3;

/// Compliance of rows of moving bodies, which yield to rows of static bodies.
const MOVING: f64 = 1e-7;
/// Compliance of desired rows, which yield to both.
const WISHED: f64 = 1e-5;

/// Time constant with which a desired distance is restored (s).
pub(super) const PACE: f64 = 0.1;

/// Velocities of the obstacles between two updates of their poses.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct ObstacleVelocities {
    /// Velocity of each obstacle (m/s); empty if all are at rest.
    pub velocities: Vec<[f64; 3]>,
    speeds: Vec<f64>,
}

/// Obstacles and links around an arm, with the constraint rows that they impose.
#[derive(Debug)]
pub(super) struct Around {
    pub space: Arc<ClearSpace<'static>>,
    pub obstacles: ObstacleVelocities,
    /// Time since the last update of the obstacles (s).
    pub since: f64,
    /// Near pairs at the rest configuration if the arm brakes now.
    near: NearRows,
    /// Near pairs at the rest configuration after the command.
    after: NearRows,
    /// Bodies that will come too near to the rest configuration.
    coming: ComingRows,
    check: MotionCertificate,
}

impl ObstacleVelocities {
    /// Velocities (m/s) of `count` obstacles; empty means that all are at rest.
    ///
    /// # Errors
    /// [`Error::WrongLength`] or [`Error::NotFinite`].
    pub fn new(velocities: Vec<[f64; 3]>, count: usize) -> Result<Self> {
        if !velocities.is_empty() && velocities.len() != count {
            let what = "velocities".into();
            return Err(Error::WrongLength { what, expected: format!("{count} obstacles"), got: velocities.len() });
        }
        require_finite("velocities", velocities.as_flattened(), |k| format!("obstacle {}", k / 3))?;
        let speeds = velocities.iter().map(|velocity| norm(velocity)).collect();
        Ok(Self { velocities, speeds })
    }

    /// Speed of the fastest obstacle (m/s).
    pub fn fastest(&self) -> f64 {
        self.speeds.iter().copied().fold(0.0, f64::max)
    }
}

impl Around {
    /// Surroundings of an arm with these limits: the bodies in `space`, moving like `obstacles`.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`](crate::Error::UnsupportedLimit) for limits that vary over time and could push the arm into an
    /// obstacle.
    pub fn new(space: ClearSpace<'static>, obstacles: ObstacleVelocities, limits: &Limits) -> Result<Self> {
        let remedy = "limits that vary can carry the arm into an obstacle; give numbers, or leave the obstacles out";
        require_constant(limits, "tracking among obstacles", remedy)?;
        Ok(Self {
            near: NearRows::new(space.scene()),
            after: NearRows::new(space.scene()),
            coming: ComingRows::new(space.scene()),
            check: MotionCertificate::new(space.scene()),
            space: Arc::new(space),
            obstacles,
            since: 0.0,
        })
    }

    /// Distances (m) that an obstacle covers until the arm is at rest in `stop_time` (s), and by which it approaches while the
    /// arm evades.
    fn approach_of(&self, near: &NearRow, stop_time: f64) -> [f64; 2] {
        let Some(velocity) = near.obstacle().and_then(|i| self.obstacles.velocities.get(i)) else { return [0.0; 2] };
        let approach = dot(velocity, near.normal.as_slice()).max(0.0);
        [norm(velocity) * (self.since + stop_time), approach * WARNING]
    }

    /// Finds the pairs near the rest configuration.
    pub fn find_near(&mut self, context: &StepContext<'_>, rest: &[f64]) {
        let [lower, upper] = context.ends();
        let reach: f64 = lower.iter().zip(upper).map(|(lower, upper)| upper - lower).sum();
        let far = self.obstacles.fastest() * (self.since + WARNING);
        let up_to = self.space.margin() + reach.clamp(NEAR[0], NEAR[1]) + 2.0 * far;
        self.near.find(self.space.scene(), rest, up_to);
        self.find_coming(rest);
    }

    /// Whether a body is nearer than the margin at the rest configuration.
    pub fn is_too_near(&self) -> bool {
        self.near.rows().iter().any(|near| near.distance < self.space.margin())
    }

    /// Finds the bodies that will come too near to an arm at `q`.
    fn find_coming(&mut self, q: &[f64]) {
        let (velocities, since) = (&self.obstacles.velocities[..], self.since);
        let margin = self.space.margin() + ROOM;
        let coming = Coming { velocities, since, horizon: FORESEEN, margin, pace: GIVING_WAY };
        self.coming.find(self.space.scene(), q, &coming);
    }

    /// Whether the obstacle of a pair moves.
    fn is_moving(&self, near: &NearRow) -> bool {
        near.obstacle().and_then(|i| self.obstacles.speeds.get(i)).is_some_and(|speed| *speed > 0.0)
    }

    /// Desired clearance beyond the margin (m).
    fn room(&self, limited: bool) -> f64 {
        if limited && self.obstacles.fastest() > 0.0 { ROOM_TO_START } else { ROOM }
    }

    /// Intervals that certificates have examined so far.
    pub fn intervals(&self) -> usize {
        self.check.intervals()
    }

    /// Whether the motion until `end` (ticks) is certified clear.
    pub fn certifies(&mut self, motion: &impl JointMotion, end: f64, dt: f64) -> bool {
        let kept = RequiredDistance {
            margin: self.space.margin(),
            speeds: &self.obstacles.speeds,
            since: self.since,
            dt,
            at_rest: self.near.rows(),
            tolerance_band: ROOM,
            only_parts: true,
        };
        self.check.is_clear(self.space.scene(), motion, end, &kept)
    }

    /// Whether the straight line of the joints between two configurations is certified clear of everything where it is now.
    pub fn certifies_line(&mut self, from: &[f64], to: &[f64]) -> bool {
        let kept = RequiredDistance {
            at_rest: self.near.rows(),
            tolerance_band: ROOM,
            only_parts: true,
            ..RequiredDistance::constant(self.space.margin())
        };
        self.check.is_clear(self.space.scene(), &Edge { from, to }, 1.0, &kept)
    }

    /// Sets the rows of a command that ends in `rest` after `stop_ticks`; overlapping pairs become rows to separate them.
    /// Returns whether `command` violates a row.
    pub fn set_rows(
        &self,
        context: &StepContext<'_>,
        (rest, stop_ticks): (&[f64], f64),
        command: &[f64],
        ConstrainedStep { rows, wanted, .. }: &mut ConstrainedStep,
    ) -> bool {
        if self.near.rows().is_empty() && self.coming.rows().is_empty() {
            return false;
        }
        let response = Response::new(context, rest);
        let stop_time = context.dt * stop_ticks;
        let pace = (context.dt / PACE).min(1.0);
        for near in self.near.rows() {
            // The obstacle keeps moving while the command is carried out.
            let [until_rest, while_leaving] = self.approach_of(near, context.dt + stop_time);
            let missing = self.space.margin() + until_rest - near.distance;
            let whole = missing + self.room(context.limited.is_some()) + while_leaving;
            // Desired clearance is restored gradually, so that it does not compete with required clearance. An arm with limited
            // acceleration also approaches gradually, so that it can still evade.
            let paced = if whole > 0.0 || context.limited.is_some() { pace * whole } else { whole };
            if near.distance < 0.0 {
                // The deepest overlap counts most: bodies on both sides of an obstacle demand opposite ways out.
                let weight = (near.distance / self.near.rows()[0].distance).powi(2);
                wanted.push(response.row(&near.gradient.map(|entry| weight * entry), weight * paced));
            } else {
                let needed = missing + LEAST_ROOM;
                let row = response.row(&near.gradient, paced.max(needed));
                if self.is_moving(near) {
                    rows.push(Row { softness: MOVING, ..response.row(&near.gradient, needed) });
                    rows.push(Row { softness: WISHED, ..row });
                } else {
                    rows.push(row);
                }
            }
        }
        for coming in self.coming.rows() {
            let paced =
                if coming.short > 0.0 || context.limited.is_some() { pace * coming.short } else { coming.short };
            let row = response.row(&coming.gradient, paced + GIVING_WAY * context.dt);
            rows.push(Row { softness: WISHED, ..row });
        }
        rows.iter().chain(&*wanted).any(|row| dot(&row.gradient, command) < row.least)
    }

    /// Sets the rows at the rest configuration after the command `q`, where the gradients differ from those before it.
    pub fn set_rows_after(
        &mut self,
        context: &StepContext<'_>,
        (rest, stop_ticks): (&[f64], f64),
        q: &[f64],
        rows: &mut Vec<Row>,
    ) {
        let slope = Response::new(context, rest).slope;
        self.after.find(self.space.scene(), rest, self.space.margin() + NEAR[0]);
        for near in self.after.rows().iter().filter(|near| near.distance >= 0.0) {
            let [until_rest, _] = self.approach_of(near, context.dt * stop_ticks);
            let least = self.space.margin() + until_rest + LEAST_ROOM - near.distance;
            let mut row = Row { gradient: [0.0; MAX_DOF], least, softness: SOFTNESS };
            (0..q.len()).for_each(|j| row.gradient[j] = near.gradient[j] * slope[j]);
            row.least += dot(&row.gradient[..q.len()], q);
            rows.push(row);
        }
    }

    /// Sets the rows of a goal configuration at `q`. Returns whether `q` satisfies them.
    pub fn set_goal_rows(&mut self, q: &[f64], rows: &mut Vec<Row>) -> bool {
        let far = self.obstacles.fastest() * (self.since + WARNING);
        self.near.find(self.space.scene(), q, self.space.margin() + NEAR[0] + 2.0 * far);
        rows.clear();
        for near in self.near.rows() {
            // A goal keeps slightly more clearance than the arm that pursues it; goals are pursued under acceleration limits
            // only.
            let room = self.room(true) + ROOM;
            let kept = self.space.margin() + room + self.approach_of(near, 0.0).iter().sum::<f64>();
            let least = kept - near.distance + dot(&near.gradient[..q.len()], q);
            rows.push(Row { gradient: near.gradient, least, softness: SOFTNESS });
        }
        self.find_coming(q);
        for coming in self.coming.rows() {
            let least = coming.short + ROOM + dot(&coming.gradient[..q.len()], q);
            rows.push(Row { gradient: coming.gradient, least, softness: WISHED });
        }
        rows.iter().all(|row| dot(&row.gradient, q) >= row.least)
    }
}

/// Checks that the limits that decide where an arm can stop are constant.
///
/// # Errors
/// [`Error::UnsupportedLimit`](crate::Error::UnsupportedLimit) with the `method` that needs this, and the remedy.
pub(super) fn require_constant(limits: &Limits, method: &'static str, remedy: &'static str) -> Result<()> {
    let fields = [Field::Lower, Field::Upper, Field::Acceleration, Field::Jerk].into_iter();
    let mut given = fields.filter(|field| limits.field(*field).is_some());
    given.try_for_each(|field| limits.constants(field, method, remedy).map(|_| ()))
}

/// Secant model of the rest configuration over the box of commands x: r_j(x) = rest_j + slope_j x_j + offset_j.
pub(super) struct Response {
    pub slope: Point,
    offset: Point,
}

impl Response {
    pub fn new(context: &StepContext<'_>, rest: &[f64]) -> Self {
        let at_once =
            Self { slope: Point::from_elem(1.0, rest.len()), offset: rest.iter().map(|rest| -rest).collect() };
        let Some(limited) = context.limited else { return at_once };
        let braking = limited.braking();
        let Self { mut slope, mut offset } = at_once;
        let [lower, upper] = context.ends();
        let [low, high] = [lower, upper].map(|command| context.stop_after(command));
        for j in 0..rest.len() {
            let width = upper[j] - lower[j];
            if width > 0.0 && braking[j].acceleration < f64::INFINITY {
                slope[j] = (high.end(j) - low.end(j)) / width;
                offset[j] = low.end(j) - slope[j] * lower[j] - rest[j];
            }
        }
        Self { slope, offset }
    }

    /// Row of the command for gradient'(r(x) - rest) >= `least`.
    pub fn row(&self, gradient: &[f64; MAX_DOF], least: f64) -> Row {
        let mut row = Row { gradient: [0.0; MAX_DOF], least, softness: SOFTNESS };
        for (j, (slope, offset)) in self.slope.iter().zip(&self.offset).enumerate() {
            row.gradient[j] = gradient[j] * slope;
            row.least -= gradient[j] * offset;
        }
        row
    }
}
