//! The motion of a tracked arm among obstacles.
//!
//! Where the arm would come to rest if it braked now is known to be clear. Near pairs there are rows: how far the place of rest may
//! move towards them. The command is the one nearest to what the rule wants, measured by its effect on the task, that keeps these rows
//! and the box of the tick. It is sent if the command together with the stop after it is certified clear, between ticks too; otherwise
//! a part of it is, and in the end the stop goes on that was certified before.

use std::sync::Arc;

use super::limited_motion::LimitedMotion;
use super::stop_motion::StopMotion;
use crate::error::{Error, Result, require_finite};
use crate::limits::{Field, Limits};
use crate::math::MAX_DOF;
use crate::math::box_step::ROWS;
use crate::math::row_step::{Row, RowSolver, RowStep};
use crate::math::vector::{between, dot, norm, squared_size};
use crate::objective::{Bounds, Point, TaskBlock};
use crate::obstacle::{ChordCheck, ClearSpace, KeptDistance, MOST_ROWS, NearRow, NearRows};
use crate::robot::Robot;
use crate::task::{Criterion, Target};

/// Kept beyond the margin where the arm comes to rest (m), in time and at once: room for the certificate.
const ROOM: f64 = 2e-4;
const LEAST_ROOM: f64 = 2e-5;

/// Least distance beyond the margin at which a pair becomes a row (m), and largest.
const NEAR: [f64; 2] = [0.03, 0.2];

/// Time in which an arm gets out of the way of an obstacle that comes nearer (s).
const WARNING: f64 = 0.4;

/// Time in which a distance that is wanted, but not needed, comes about (s).
const PACE: f64 = 0.1;

/// Parts of a command that are tried if the whole is not certified.
const PARTS: [f64; 2] = [0.5, 0.125];

/// Damping of the joints beside the task, relative to the squared size of the Jacobian.
const DAMPING: f64 = 1e-5;

/// Gauss-Newton steps towards the target along the rows.
const STEPS: usize = 3;

/// Rows of a goal are trusted for joint motions up to this (rad, m).
const TRUSTED: f64 = 0.05;

/// What an obstacle may do between two calls that say where it is.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct ObstacleMotion {
    /// Velocity of each obstacle (m/s); empty if all are at rest.
    pub velocities: Vec<[f64; 3]>,
    speeds: Vec<f64>,
}

/// What a command is found from.
pub(super) struct Wish<'a> {
    pub robot: &'a Robot,
    pub q: &'a [f64],
    pub bounds: &'a Bounds,
    pub limited: Option<&'a LimitedMotion>,
    pub target: Option<&'a Target>,
    pub criterion: &'a Criterion,
    pub dt: f64,
}

/// What a goal configuration is to meet.
pub(super) struct GoalToClear<'a> {
    pub robot: &'a Robot,
    pub target: &'a Target,
    pub criterion: &'a Criterion,
    pub positions: &'a Bounds,
}

/// Keeps an arm clear, tick by tick.
#[derive(Debug)]
pub(super) struct ClearMotion {
    space: Arc<ClearSpace<'static>>,
    obstacles: ObstacleMotion,
    /// Time since the obstacles were where they are said to be (s).
    since: f64,
    /// Near pairs where the arm comes to rest if it brakes now.
    near: NearRows,
    /// Where it would come to rest after the command.
    after: NearRows,
    rows: Vec<Row>,
    solver: RowSolver,
    check: ChordCheck,
    linearization: Box<TaskBlock>,
    /// Rows keep the last goal from its target.
    goal_is_held: bool,
}

impl ObstacleMotion {
    /// With these velocities (m/s): one for each of the obstacles, of which there are `count`, or none.
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

    fn fastest(&self) -> f64 {
        self.speeds.iter().copied().fold(0.0, f64::max)
    }
}

impl ClearMotion {
    /// In `space`, with these limits.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`](crate::Error::UnsupportedLimit) for limits that vary over time and could push the arm into an
    /// obstacle.
    pub fn new(space: ClearSpace<'static>, limits: &Limits) -> Result<Self> {
        for field in [Field::Lower, Field::Upper, Field::Acceleration, Field::Jerk] {
            let remedy = "limits that vary can carry the arm into an obstacle; give numbers, or leave obstacles= out";
            if limits.field(field).is_some() {
                limits.constants(field, "tracking among obstacles", remedy)?;
            }
        }
        Ok(Self {
            near: space.near_rows(),
            after: space.near_rows(),
            check: space.chord_check(),
            solver: RowSolver::with_room(limits.dof(), MOST_ROWS),
            space: Arc::new(space),
            obstacles: ObstacleMotion::default(),
            since: 0.0,
            rows: Vec::with_capacity(MOST_ROWS),
            linearization: Box::default(),
            goal_is_held: false,
        })
    }

    /// The space to stay in.
    pub fn space(&self) -> &Arc<ClearSpace<'static>> {
        &self.space
    }

    /// Velocities of the obstacles (m/s); empty if all are at rest.
    pub fn velocities(&self) -> &[[f64; 3]] {
        &self.obstacles.velocities
    }

    /// Replaces what is around the arm: `space` with the obstacles where they are now.
    pub fn replace(&mut self, space: ClearSpace<'static>, obstacles: ObstacleMotion) {
        (self.space, self.obstacles, self.since) = (Arc::new(space), obstacles, 0.0);
    }

    /// Sets how the obstacles move.
    pub fn set_motion(&mut self, obstacles: ObstacleMotion) {
        self.obstacles = obstacles;
    }

    /// Changes the command `q` that the rule has found to one that keeps the arm clear. Returns whether it had to.
    pub fn keep(&mut self, wish: &Wish<'_>, q: &mut Point) -> bool {
        let limited = wish.limited.map(|limited| (limited.braking(), limited.state()));
        let mut brake = wish.limited.map_or_else(|| Point::from_slice(wish.q), |limited| limited.stopping(wish.q));
        wish.bounds.clip(&mut brake);
        let stop = StopMotion::new(wish.q, &brake, limited);
        let rest: Point = (0..wish.q.len()).map(|j| stop.end(j)).collect();
        let wanted = q.clone();
        self.find_near(wish, &rest);
        if self.set_rows(wish, &rest, &stop, &wanted) {
            self.step_beside_rows(wish, &wanted, q);
        }
        let certified = self.certifies(wish, q) || {
            self.correct(wish, q);
            self.certifies(wish, q)
        };
        let best = q.clone();
        let mut parts = PARTS.into_iter();
        let certified = certified
            || parts.any(|part| {
                between(&brake, &best, part, q);
                self.certifies(wish, q)
            });
        if !certified {
            q.copy_from_slice(&brake);
        }
        self.since += wish.dt;
        *q != wanted
    }

    /// Whether the command `q` and the stop after it are certainly clear.
    fn certifies(&mut self, wish: &Wish<'_>, q: &[f64]) -> bool {
        let limited = wish.limited.map(|limited| (limited.braking(), limited.state()));
        let motion = StopMotion::new(wish.q, q, limited);
        let kept = KeptDistance {
            margin: self.space.margin(),
            speeds: &self.obstacles.speeds,
            since: self.since,
            dt: wish.dt,
            at_rest: self.near.rows(),
            leeway: ROOM,
        };
        self.space.is_kept_by(&motion, motion.end_tick(), &kept, &mut self.check)
    }

    /// Moves the command `q` to one that keeps the rows of the place where the arm would come to rest after it: they bend on the way.
    fn correct(&mut self, wish: &Wish<'_>, q: &mut Point) {
        let limited = wish.limited.map(|limited| (limited.braking(), limited.state()));
        let stop = StopMotion::new(wish.q, q, limited);
        let (n, rest): (usize, Point) = (q.len(), (0..q.len()).map(|j| stop.end(j)).collect());
        let stop_time = wish.dt * stop.ticks_to_stop();
        let slope = Response::new(wish, &rest).slope;
        self.space.find_rows(&rest, self.space.margin() + NEAR[0], &mut self.after);
        self.rows.clear();
        for near in self.after.rows() {
            let [until_rest, _] = self.approach_of(near, stop_time);
            let mut row =
                Row { gradient: [0.0; MAX_DOF], least: self.space.margin() + until_rest + LEAST_ROOM - near.distance };
            (0..n).for_each(|j| row.gradient[j] = near.gradient[j] * slope[j]);
            row.least += dot(&row.gradient[..n], q);
            self.rows.push(row);
        }
        let start = q.clone();
        wish.robot.tip_and_jacobian(&start, &mut self.linearization.columns);
        let (columns, residual) = (&self.linearization.columns, &[0.0; ROWS]);
        let (lower, upper, lambda) = (wish.bounds.lower(), wish.bounds.upper(), damping(&columns[..n]));
        let step = RowStep { columns, residual, lambda, start: &start, lower, upper, rows: &self.rows };
        self.solver.write(&step, q);
    }

    /// Moves `sample`, a configuration that meets a target, to one that keeps the margin too, if it does not: by Gauss-Newton steps
    /// beside the rows, beginning at `from`.
    pub fn clear_goal(&mut self, goal: &GoalToClear<'_>, from: &[f64], sample: &mut Point) {
        self.goal_is_held = !self.set_goal_rows(sample);
        if !self.goal_is_held {
            return;
        }
        let n = sample.len();
        sample.copy_from_slice(from);
        goal.positions.clip(sample);
        for _ in 0..STEPS {
            self.set_goal_rows(sample);
            let start = sample.clone();
            let ends = start.iter().zip(goal.positions.lower().iter().zip(goal.positions.upper()));
            let near = ends.map(|(q, (lower, upper))| ((q - TRUSTED).max(*lower), (q + TRUSTED).min(*upper)));
            let near = Bounds::from_ranges(near);
            let tip = goal.robot.tip_and_jacobian(&start, &mut self.linearization.columns);
            goal.target.linearize_tip(&tip, n, goal.criterion, &mut self.linearization);
            let TaskBlock { columns, residual } = &*self.linearization;
            let (lower, upper, lambda) = (near.lower(), near.upper(), damping(&columns[..n]));
            let step = RowStep { columns, residual, lambda, start: &start, lower, upper, rows: &self.rows };
            self.solver.write(&step, sample);
        }
    }

    /// Sets the rows of a goal configuration at `q`. Returns whether it keeps them.
    fn set_goal_rows(&mut self, q: &[f64]) -> bool {
        let far = self.obstacles.fastest() * (self.since + WARNING);
        self.space.find_rows(q, self.space.margin() + NEAR[0] + 2.0 * far, &mut self.near);
        self.rows.clear();
        for near in self.near.rows() {
            let kept = self.space.margin() + 2.0 * ROOM + self.approach_of(near, 0.0).iter().sum::<f64>();
            let least = kept - near.distance + dot(&near.gradient[..q.len()], q);
            self.rows.push(Row { gradient: near.gradient, least });
        }
        self.rows.iter().all(|row| dot(&row.gradient, q) >= row.least)
    }

    /// Whether obstacles changed the last goal.
    pub fn goal_is_held(&self) -> bool {
        self.goal_is_held
    }

    /// How far an obstacle gets until the arm is at rest in `stop_time` (s), and how much nearer it comes while the arm gets out of
    /// its way (m).
    fn approach_of(&self, near: &NearRow, stop_time: f64) -> [f64; 2] {
        let Some(velocity) = near.obstacle().and_then(|i| self.obstacles.velocities.get(i)) else { return [0.0; 2] };
        let approach = dot(velocity, near.normal.as_slice()).max(0.0);
        [norm(velocity) * (self.since + stop_time), approach * WARNING]
    }

    /// Finds the pairs near the place of rest.
    fn find_near(&mut self, wish: &Wish<'_>, rest: &[f64]) {
        let reach: f64 = wish.bounds.lower().iter().zip(wish.bounds.upper()).map(|(lower, upper)| upper - lower).sum();
        let far = self.obstacles.fastest() * (self.since + WARNING);
        let up_to = self.space.margin() + reach.clamp(NEAR[0], NEAR[1]) + 2.0 * far;
        self.space.find_rows(rest, up_to, &mut self.near);
    }

    /// Sets the rows of the command. Returns whether `wanted` breaks one.
    fn set_rows(&mut self, wish: &Wish<'_>, rest: &[f64], stop: &StopMotion<'_>, wanted: &[f64]) -> bool {
        self.rows.clear();
        if self.near.rows().is_empty() {
            return false;
        }
        let response = Response::new(wish, rest);
        let stop_time = wish.dt * stop.ticks_to_stop();
        let pace = (wish.dt / PACE).min(1.0);
        for near in self.near.rows() {
            let [until_rest, while_leaving] = self.approach_of(near, stop_time);
            let missing = self.space.margin() + until_rest - near.distance;
            let wanted = missing + ROOM + while_leaving;
            // What is wanted but not needed comes in time, so that it does not rival what is needed. An arm that cannot change its
            // velocity at once also comes nearer in time, so that it can give way.
            let paced = if wanted > 0.0 || wish.limited.is_some() { pace * wanted } else { wanted };
            self.rows.push(response.row(&near.gradient, paced.max(missing + LEAST_ROOM)));
        }
        self.rows.iter().any(|row| dot(&row.gradient, wanted) < row.least)
    }

    /// Moves `q` to the command that keeps the rows and disturbs the task least.
    fn step_beside_rows(&mut self, wish: &Wish<'_>, wanted: &[f64], q: &mut [f64]) {
        let n = wanted.len();
        let (lower, upper) = (wish.bounds.lower(), wish.bounds.upper());
        let mut start = Point::from_slice(wanted);
        for _ in 0..STEPS {
            let tip = wish.robot.tip_and_jacobian(&start, &mut self.linearization.columns);
            let mut residual = [0.0; ROWS];
            if let Some(target) = wish.target {
                target.linearize_tip(&tip, n, wish.criterion, &mut self.linearization);
                // What the rule wants under acceleration limits is not the target itself, but on the way there.
                if wish.limited.is_none() {
                    residual = self.linearization.residual;
                }
            }
            let columns = &self.linearization.columns;
            let lambda = damping(&columns[..n]);
            let step = RowStep { columns, residual: &residual, lambda, start: &start, lower, upper, rows: &self.rows };
            self.solver.write(&step, q);
            if wish.limited.is_some() {
                return;
            }
            start.copy_from_slice(q);
        }
    }
}

/// The damping for the Jacobian with these columns.
fn damping(columns: &[[f64; ROWS]]) -> f64 {
    (DAMPING * squared_size(columns)).max(f64::MIN_POSITIVE.sqrt())
}

/// How the place of rest follows the command x: r_j(x) = rest_j + slope_j x_j + offset_j, the secant over the box.
struct Response {
    slope: Point,
    offset: Point,
}

impl Response {
    fn new(wish: &Wish<'_>, rest: &[f64]) -> Self {
        let at_once =
            Self { slope: Point::from_elem(1.0, rest.len()), offset: rest.iter().map(|rest| -rest).collect() };
        let Some(limited) = wish.limited else { return at_once };
        let (braking, state) = (limited.braking(), limited.state());
        let Self { mut slope, mut offset } = at_once;
        let [lower, upper] = [wish.bounds.lower(), wish.bounds.upper()];
        let [low, high] = [lower, upper].map(|command| StopMotion::new(wish.q, command, Some((braking, state))));
        for j in 0..rest.len() {
            let width = upper[j] - lower[j];
            if width > 0.0 && braking[j].acceleration < f64::INFINITY {
                slope[j] = (high.end(j) - low.end(j)) / width;
                offset[j] = low.end(j) - slope[j] * lower[j] - rest[j];
            }
        }
        Self { slope, offset }
    }

    /// The row of the command with which gradient'(r(x) - rest) >= `least`.
    fn row(&self, gradient: &[f64; MAX_DOF], least: f64) -> Row {
        let mut row = Row { gradient: [0.0; MAX_DOF], least };
        for (j, (slope, offset)) in self.slope.iter().zip(&self.offset).enumerate() {
            row.gradient[j] = gradient[j] * slope;
            row.least -= gradient[j] * offset;
        }
        row
    }
}
