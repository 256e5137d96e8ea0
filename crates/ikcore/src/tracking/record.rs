//! The record of a track: one row per tick, and a summary.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::commanded_motion::{FEWEST, spline};
use super::step::Step;
use crate::error::Result;
use crate::kinematics::ReachShortfall;
use crate::limits::{Field, JointOutside, LimitAt, Limits, ROUNDING, TickBox};
use crate::math::comparison::larger;
use crate::obstacle::Sensed;
use crate::solver::Status;
use crate::task::{Criterion, TipError};
use crate::trajectory::Trajectory;

/// Tolerance for rounding of positions, in units in the last place of q.
const ALLOWED_ULPS: f64 = 4.0;

/// Record of a track with k rows. Row 0 is the start at t = 0; row i is the tick that ends at t_i = i dt. Tables are stored in
/// row-major order.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Record {
    /// Joints per row, n.
    pub dof: usize,
    /// Configurations (k, n) (rad, m).
    pub q: Vec<f64>,
    /// Tip positions (k, 3) (m); for several tips, those of the first target.
    pub position: Vec<[f64; 3]>,
    /// Reference positions (k, 3) (m).
    pub reference: Vec<[f64; 3]>,
    /// Distances from the reference positions (k,) (m).
    pub position_error: Vec<f64>,
    /// Angles from the reference orientations (k,) (rad); NaN where the task has no orientation.
    pub rotation_error: Vec<f64>,
    /// Smallest distances from obstacles and between links (k,) (m); NaN without obstacles and self-collision checks.
    pub clearance: Vec<f64>,
    /// Status of each tick (k,).
    pub step_status: Vec<Status>,
    /// Evaluations of the forward kinematics per tick (k,).
    pub step_evaluations: Vec<usize>,
    /// Iterations per tick (k,); for beetle antennae search, passes.
    pub step_iterations: Vec<usize>,
    /// Largest excess of a displacement over v dt or of a position over its limit (rad, m); 0 if within 4 ulp.
    pub max_violation: f64,
    /// Joint and time (s) of that excess.
    pub worst_violation: Option<(usize, f64)>,
    /// Smallest distance of a speed from its limit (rad/s, m/s); infinite without limits, negative only if
    /// `max_violation` is positive.
    pub limit_margin: f64,
    /// Limits in force.
    pub limits: Limits,
    /// Joints that began outside their position limits, and were led inside.
    pub start_outside: Vec<JointOutside>,
    /// The error band.
    pub criterion: Criterion,
    /// Distance by which the path is provably out of reach, and its time (s). `None` if the track succeeded or nothing is
    /// proven.
    pub out_of_reach: Option<(ReachShortfall, f64)>,
    /// Status of the whole track.
    pub status: Status,
    /// What was measured of the robot itself, if the arm was in collision with it.
    pub own_points: Option<Sensed>,
    /// Time taken.
    pub elapsed: Duration,
    /// Approach at the start, if requested.
    pub(super) ease: Ease,
    limit_at: LimitAt,
    dt: f64,
    /// Results of each target of several tips; empty for one tip. Stored apart.
    #[serde(skip)]
    pub tips: TipTable,
}

/// Results of each target, row by row, in the order of the call.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct TipTable {
    /// Positions (k, targets) (m); for pairs, in the frame of the first tip.
    pub positions: Vec<[f64; 3]>,
    /// Reference positions (k, targets) (m).
    pub references: Vec<[f64; 3]>,
    /// Errors (k, targets).
    pub errors: Vec<TipError>,
}

impl TipTable {
    /// Appends the result of a tick.
    pub(super) fn push(
        &mut self,
        positions: Vec<[f64; 3]>,
        references: impl Iterator<Item = [f64; 3]>,
        errors: Vec<TipError>,
    ) {
        self.positions.extend(positions);
        self.references.extend(references);
        self.errors.extend(errors);
    }
}

/// Approach at the start of a track.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) enum Ease {
    NotAsked,
    /// No motion within the limits meets the path before it ends.
    Impossible,
    /// Length of the approach in ticks.
    Ticks(usize),
}

/// Configuration and box of the last tick.
pub(super) struct Accepted<'a> {
    /// Configuration (n,).
    pub q: &'a [f64],
    /// Limits that `q` is checked against.
    pub tick_box: &'a TickBox,
    /// Smallest distance from obstacles and between links (m).
    pub clearance: f64,
    /// The kind of the nearest obstacle, if a sensor measures it.
    pub measured: Option<Sensed>,
}

impl Record {
    /// An empty record of `dof` joints with room for `rows`.
    pub(super) fn new(
        dof: usize,
        rows: usize,
        limits: Limits,
        limit_at: LimitAt,
        criterion: Criterion,
        dt: f64,
    ) -> Self {
        Self {
            dof,
            q: Vec::with_capacity(rows * dof),
            position: Vec::with_capacity(rows),
            reference: Vec::with_capacity(rows),
            position_error: Vec::with_capacity(rows),
            rotation_error: Vec::with_capacity(rows),
            clearance: Vec::with_capacity(rows),
            step_status: Vec::with_capacity(rows),
            step_evaluations: Vec::with_capacity(rows),
            step_iterations: Vec::with_capacity(rows),
            max_violation: 0.0,
            worst_violation: None,
            limit_margin: f64::INFINITY,
            limits,
            start_outside: vec![],
            criterion,
            out_of_reach: None,
            status: Status::Lost,
            own_points: None,
            elapsed: Duration::ZERO,
            ease: Ease::NotAsked,
            limit_at,
            dt,
            tips: TipTable::default(),
        }
    }

    /// The time step (s).
    pub(super) fn dt(&self) -> f64 {
        self.dt
    }

    /// Marks the ticks so far as an approach of this many `ticks`.
    pub(super) fn note_approach(&mut self, ticks: usize) {
        self.ease = Ease::Ticks(ticks);
    }

    /// Records that no approach meets the path.
    pub(super) fn note_no_approach(&mut self) {
        self.ease = Ease::Impossible;
    }

    /// Appends the result of a tick.
    pub(super) fn push(&mut self, accepted: &Accepted<'_>, reference: [f64; 3], step: &Step) {
        self.note_violations(accepted);
        if step.status == Status::InCollision {
            self.own_points = self.own_points.or(accepted.measured);
        }
        self.q.extend_from_slice(accepted.q);
        self.position.push(step.position);
        self.reference.push(reference);
        self.position_error.push(step.error.position);
        self.rotation_error.push(step.error.rotation);
        self.clearance.push(accepted.clearance);
        self.step_status.push(step.status);
        self.step_evaluations.push(step.evaluations);
        self.step_iterations.push(step.iterations);
    }

    /// Records limit violations of the tick that has just ended.
    fn note_violations(&mut self, accepted: &Accepted<'_>) {
        let rows = self.rows();
        if rows == 0 {
            return;
        }
        let Accepted { q, tick_box: TickBox { velocity, floor, ceiling, .. }, .. } = *accepted;
        let before = &self.q[self.q.len() - q.len()..];
        let (mut fastest, mut farthest) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
        let limits = velocity.iter().zip(floor.iter().zip(ceiling));
        for ((q, before), (velocity, (floor, ceiling))) in q.iter().zip(before).zip(limits) {
            fastest = larger((q - before).abs() - velocity * self.dt, fastest);
            farthest = larger(larger(floor - q, q - ceiling), farthest);
        }
        // Displacements keep the limit to the last bit; velocities would add a rounding error.
        self.limit_margin = self.limit_margin.min(0.0 - fastest / self.dt);
        let limited = self.limits.field(Field::Acceleration).is_some() || self.limits.field(Field::Jerk).is_some();
        if limited || larger(fastest, farthest) > self.max_violation {
            self.find_violations(accepted, self.ends(rows));
        }
    }

    /// Finds limit violations of the joints in the tick from `from` to `to` (s).
    fn find_violations(&mut self, accepted: &Accepted<'_>, [from, to]: [f64; 2]) {
        let Accepted { q, tick_box: TickBox { velocity, floor, ceiling, .. }, .. } = *accepted;
        for j in 0..q.len() {
            let step = q[j] - self.q[self.q.len() - self.dof + j];
            let too_fast = step.abs() - velocity[j] * self.dt;
            let [floor, ceiling] = self.led_range(j, [floor[j], ceiling[j]]);
            let outside = larger(floor - q[j], q[j] - ceiling);
            let excess = larger(too_fast, outside).max(self.too_sudden(j, step, [from, to]));
            self.note_excess(excess, j, q[j], to);
        }
    }

    /// Position limits of joint `j` in a tick; those of a joint that began outside reach to its start.
    fn led_range(&self, j: usize, [floor, ceiling]: [f64; 2]) -> [f64; 2] {
        let start = self.q[j];
        match self.start_outside.iter().any(|outside| outside.joint == self.limits.joint_name(j)) {
            true => [floor.min(start), ceiling.max(start)],
            false => [floor, ceiling],
        }
    }

    /// Records the `excess` (rad, m) over a limit of joint `j`, at `q` and `when` (s), if it is the largest and more than
    /// rounding.
    #[inline]
    pub(super) fn note_excess(&mut self, excess: f64, j: usize, q: f64, when: f64) {
        if excess <= self.max_violation {
            return;
        }
        let rounding = ALLOWED_ULPS * f64::EPSILON * q.abs().max(1.0);
        if excess > rounding {
            self.max_violation = excess;
            self.worst_violation = Some((j, when));
        }
    }

    /// Excess of the displacement `step` of joint `j` over its acceleration or jerk limit, from differences to the
    /// displacements of the previous ticks. The arm starts at rest.
    fn too_sudden(&self, j: usize, step: f64, tick: [f64; 2]) -> f64 {
        let rows = self.rows();
        let q = |ago: usize| self.q[rows.saturating_sub(ago).max(1) * self.dof - self.dof + j];
        let (last, before) = (q(0) - q(1), q(1) - q(2));
        let change = step - last;
        let [acceleration, jerk] =
            [Field::Acceleration, Field::Jerk].map(|field| self.limits.smallest_over(field, j, tick));
        let too_hard = change.abs() - (1.0 + ROUNDING) * acceleration * self.dt.powi(2);
        let too_abrupt = (change - (last - before)).abs() - (1.0 + ROUNDING) * jerk * self.dt.powi(3);
        larger(too_hard, too_abrupt)
    }

    /// Sets the status of the whole track: solved if it stayed in the band from the first tick there on and kept every limit,
    /// or with what it gave up for the part of the pose that comes first; held in its region if at times the region kept it from the band.
    pub(super) fn finish(&mut self, interrupted: bool, elapsed: Duration) {
        self.elapsed = elapsed;
        let last = *self.step_status.last().unwrap_or(&Status::Capped);
        self.status = match self.joined() {
            _ if interrupted => Status::Interrupted,
            Some(_) if self.worst_violation.is_some() => Status::Lost,
            Some(joined) if self.step_status[joined..].iter().all(|s| *s == Status::Solved) => Status::Solved,
            Some(joined) if let Some(part) = self.given_up(joined) => part,
            Some(joined) if self.step_status[joined..].iter().all(is_in_place) => Status::HeldInRegion,
            Some(_) => Status::Lost,
            None => last,
        };
    }

    /// Part or level given up in some steps from row `joined` on, if the other part, or the lowest level, was met in all.
    fn given_up(&self, joined: usize) -> Option<Status> {
        let steps = &self.step_status[joined..];
        let parts = [Status::RotationGivenUp, Status::PositionGivenUp, Status::LevelGivenUp];
        let part = steps.iter().find(|status| parts.contains(status))?;
        steps.iter().all(|status| status == part || *status == Status::Solved).then_some(*part)
    }

    /// Number of rows, k.
    pub fn rows(&self) -> usize {
        self.position.len()
    }

    /// Times (k,) (s).
    pub fn time(&self) -> Vec<f64> {
        (0..self.rows()).map(|row| self.time_of(row)).collect()
    }

    pub(super) fn time_of(&self, row: usize) -> f64 {
        row as f64 * self.dt
    }

    /// Start and end of the tick of row `row` (1 or more) (s).
    fn ends(&self, row: usize) -> [f64; 2] {
        [self.time_of(row - 1), self.time_of(row)]
    }

    /// Velocity limits that the velocities are checked against (k, n); NaN in row 0.
    pub fn velocity_limit(&self) -> Vec<f64> {
        let mut limits = vec![f64::NAN; self.q.len()];
        let ticks = (1..self.q.len() / self.dof).map(|i| self.ends(i));
        let first = self.dof.min(limits.len());
        self.limits.write_velocities(ticks, self.limit_at, &mut limits[first..]);
        limits
    }

    /// Velocities (k, n) (rad/s, m/s): (q_i - q_{i-1}) / dt; zero in row 0.
    pub fn qd(&self) -> Vec<f64> {
        let at_rest = std::iter::repeat_n(0.0, self.dof);
        let moving = self.q.iter().zip(self.q.iter().skip(self.dof)).map(|(before, q)| (q - before) / self.dt);
        at_rest.chain(moving).collect()
    }

    /// Trajectory of joints with these names. Without acceleration and jerk limits it is linear between the ticks, with the
    /// velocities of [`qd`](Self::qd); with them it is a cubic spline that keeps them at every instant and passes each
    /// configuration at a sixth of its acceleration times dt^2.
    ///
    /// # Errors
    /// [`Error::WrongLength`](crate::Error::WrongLength) for a wrong number of names, or for a record of one row.
    pub fn trajectory(&self, joints: Vec<String>) -> Result<Trajectory> {
        let is_smooth = [Field::Acceleration, Field::Jerk].into_iter().any(|field| self.limits.is_finite(field));
        if is_smooth && self.rows() >= FEWEST && joints.len() == self.dof {
            return Trajectory::new(joints, self.time(), spline(&self.q, self.dof, self.dt));
        }
        Trajectory::from_samples(joints, &self.time(), &self.q, None, None)
    }

    /// First row in the band, or as near to it as the region allows; not before the approach has met the path.
    pub fn joined(&self) -> Option<usize> {
        let first = if let Ease::Ticks(ticks) = self.ease { ticks } else { 0 };
        (first..self.rows()).find(|row| is_in_place(&self.step_status[*row]))
    }

    /// Total evaluations of the forward kinematics.
    pub fn evaluations(&self) -> usize {
        self.step_evaluations.iter().sum()
    }
}

/// Whether the tick ended in the band, as near to it as the region allows, or with the part or level that comes first met.
fn is_in_place(status: &Status) -> bool {
    let given_up = [Status::RotationGivenUp, Status::PositionGivenUp, Status::LevelGivenUp];
    matches!(status, Status::Solved | Status::HeldInRegion) || given_up.contains(status)
}
