//! The motion of a tracked arm that keeps to what comes first: distances from what is around it, and pairs of tips that are held.
//!
//! Where the arm would come to rest if it braked now is known to be clear. Near pairs of bodies there are rows: how far the place of
//! rest may move towards them. The command is the one nearest to what the rule wants, measured by its effect on the task, that keeps
//! these rows and the box of the tick. It is sent if the command together with the stop after it is certified clear, between ticks too;
//! otherwise a part of it is, and in the end the stop goes on that was certified before.
//!
//! What comes nearer is given way to before it is near. Rows of its closest approach lead the arm aside, out of its way; those of where it
//! is now would only drive the arm ahead of it, into a corner. They are wishes, softer than the rows of what stands still.
//!
//! Pairs of tips that are where they are to be stay there: they are equations beside the rows, and the stop keeps to them as well.

use std::sync::Arc;

use super::held_stop::HeldStop;
use super::row_motion::{Beside, RowMotion, Towards};
use super::stop_motion::StopMotion;
use super::tick_aim::TickAim;
use super::wish::Wish;
use crate::error::{Error, Result, require_finite};
use crate::limits::{Field, Limits};
use crate::math::MAX_DOF;
use crate::math::row_step::{Row, SOFTNESS};
use crate::math::vector::{between, dot, norm};
use crate::objective::{Bounds, Point};
use crate::obstacle::{
    ChordCheck, ClearSpace, Coming, ComingRows, JointMotion, KeptDistance, MOST_COMING, MOST_ROWS, NearRow, NearRows,
};
use crate::robot::Robot;
use crate::task::TipAims;

/// Kept beyond the margin where the arm comes to rest (m), in time and at once: room for the certificate.
const ROOM: f64 = 2e-4;
const LEAST_ROOM: f64 = 2e-5;

/// Least distance beyond the margin at which a pair becomes a row (m), and largest.
const NEAR: [f64; 2] = [0.03, 0.2];

/// Time in which an arm gets out of the way of an obstacle that comes nearer (s).
const WARNING: f64 = 0.2;

/// What comes is given way to so early that this speed is enough (m/s), as far as it is foreseen (s).
const GIVING_WAY: f64 = 0.05;
const FORESEEN: f64 = 3.0;

/// Kept beyond the margin, in time, by an arm that has to give way and cannot change its velocity at once (m): close to an obstacle the
/// certificate of a motion between ticks would refuse to let it start.
const ROOM_TO_START: f64 = 3e-3;

/// Softness of rows of what moves, and of what is wanted in time: they give way to what stands still.
const MOVING: f64 = 1e-7;
const WISHED: f64 = 1e-5;

/// Time in which a distance that is wanted, but not needed, comes about (s).
const PACE: f64 = 0.1;

/// Parts of a command that are tried if the whole is not certified.
const PARTS: [f64; 2] = [0.5, 0.125];

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

/// What a goal configuration is to meet.
pub(super) struct GoalToClear<'a> {
    pub robot: &'a Robot,
    pub aim: TickAim<'a>,
    pub positions: &'a Bounds,
}

/// What is around an arm.
#[derive(Debug)]
struct Around {
    space: Arc<ClearSpace<'static>>,
    obstacles: ObstacleMotion,
    /// Time since the obstacles were where they are said to be (s).
    since: f64,
    /// Near pairs where the arm comes to rest if it brakes now.
    near: NearRows,
    /// Where it would come to rest after the command.
    after: NearRows,
    /// What comes too near where the arm comes to rest.
    coming: ComingRows,
    check: ChordCheck,
}

/// Keeps an arm clear and pairs of tips held, tick by tick.
#[derive(Debug)]
pub(super) struct KeptMotion {
    around: Option<Around>,
    rows: RowMotion,
    /// The stop of an arm that holds pairs, after its last command; empty if it holds none.
    stop: HeldStop,
    /// That of the command in question.
    next_stop: HeldStop,
    /// Rows keep the last goal from its target.
    goal_is_held: bool,
}

/// What became of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Kept {
    /// Whether it was changed.
    pub changed: bool,
    /// Whether it was because of what is around the arm.
    pub by_obstacles: bool,
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

impl Around {
    /// # Errors
    /// [`Error::UnsupportedLimit`](crate::Error::UnsupportedLimit) for limits that vary over time and could push the arm into an
    /// obstacle.
    fn new(space: ClearSpace<'static>, limits: &Limits) -> Result<Self> {
        for field in [Field::Lower, Field::Upper, Field::Acceleration, Field::Jerk] {
            let remedy = "limits that vary can carry the arm into an obstacle; give numbers, or leave obstacles= out";
            if limits.field(field).is_some() {
                limits.constants(field, "tracking among obstacles", remedy)?;
            }
        }
        Ok(Self {
            near: space.near_rows(),
            after: space.near_rows(),
            coming: space.coming_rows(),
            check: space.chord_check(),
            space: Arc::new(space),
            obstacles: ObstacleMotion::default(),
            since: 0.0,
        })
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
        let reach: f64 = wish.lower().iter().zip(wish.upper()).map(|(lower, upper)| upper - lower).sum();
        let far = self.obstacles.fastest() * (self.since + WARNING);
        let up_to = self.space.margin() + reach.clamp(NEAR[0], NEAR[1]) + 2.0 * far;
        self.space.find_rows(rest, up_to, &mut self.near);
        self.find_coming(rest);
    }

    /// Finds what comes too near to an arm at `q`.
    fn find_coming(&mut self, q: &[f64]) {
        let (velocities, since) = (&self.obstacles.velocities[..], self.since);
        let margin = self.space.margin() + ROOM;
        let coming = Coming { velocities, since, horizon: FORESEEN, margin, pace: GIVING_WAY };
        self.space.find_coming(q, &coming, &mut self.coming);
    }

    /// Whether the obstacle of a pair moves.
    fn is_moving(&self, near: &NearRow) -> bool {
        near.obstacle().and_then(|i| self.obstacles.speeds.get(i)).is_some_and(|speed| *speed > 0.0)
    }

    /// What an arm keeps beyond the margin, in time (m).
    fn room(&self, limited: bool) -> f64 {
        if limited && self.obstacles.fastest() > 0.0 { ROOM_TO_START } else { ROOM }
    }

    /// Whether a motion until `end` (ticks) is certainly clear.
    fn certifies(&mut self, motion: &impl JointMotion, end: f64, dt: f64) -> bool {
        let kept = KeptDistance {
            margin: self.space.margin(),
            speeds: &self.obstacles.speeds,
            since: self.since,
            dt,
            at_rest: self.near.rows(),
            leeway: ROOM,
            only_parts: true,
        };
        self.space.is_kept_by(motion, end, &kept, &mut self.check)
    }

    /// Sets the rows of a command that ends in `rest` after `stop_ticks`; what overlaps there is wanted to part. Returns whether
    /// `command` breaks one.
    fn set_rows(
        &self,
        wish: &Wish<'_>,
        (rest, stop_ticks): (&[f64], f64),
        command: &[f64],
        RowMotion { rows, wanted, .. }: &mut RowMotion,
    ) -> bool {
        if self.near.rows().is_empty() && self.coming.rows().is_empty() {
            return false;
        }
        let response = Response::new(wish, rest);
        let stop_time = wish.dt * stop_ticks;
        let pace = (wish.dt / PACE).min(1.0);
        for near in self.near.rows() {
            // The obstacle moves on while the command is carried out.
            let [until_rest, while_leaving] = self.approach_of(near, wish.dt + stop_time);
            let missing = self.space.margin() + until_rest - near.distance;
            let whole = missing + self.room(wish.limited.is_some()) + while_leaving;
            // What is wanted but not needed comes in time, so that it does not rival what is needed. An arm that cannot change its
            // velocity at once also comes nearer in time, so that it can give way.
            let paced = if whole > 0.0 || wish.limited.is_some() { pace * whole } else { whole };
            if near.distance < 0.0 {
                // The deepest counts most: bodies on both sides of an obstacle want opposite ways out.
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
            let paced = if coming.short > 0.0 || wish.limited.is_some() { pace * coming.short } else { coming.short };
            let row = response.row(&coming.gradient, paced + GIVING_WAY * wish.dt);
            rows.push(Row { softness: WISHED, ..row });
        }
        rows.iter().chain(&*wanted).any(|row| dot(&row.gradient, command) < row.least)
    }

    /// Sets the rows of the place where the arm comes to rest after the command `q`: they bend on the way there.
    fn set_rows_after(&mut self, wish: &Wish<'_>, (rest, stop_ticks): (&[f64], f64), q: &[f64], rows: &mut Vec<Row>) {
        let slope = Response::new(wish, rest).slope;
        self.space.find_rows(rest, self.space.margin() + NEAR[0], &mut self.after);
        for near in self.after.rows().iter().filter(|near| near.distance >= 0.0) {
            let [until_rest, _] = self.approach_of(near, wish.dt * stop_ticks);
            let least = self.space.margin() + until_rest + LEAST_ROOM - near.distance;
            let mut row = Row { gradient: [0.0; MAX_DOF], least, softness: SOFTNESS };
            (0..q.len()).for_each(|j| row.gradient[j] = near.gradient[j] * slope[j]);
            row.least += dot(&row.gradient[..q.len()], q);
            rows.push(row);
        }
    }

    /// Sets the rows of a goal configuration at `q`. Returns whether it keeps them.
    fn set_goal_rows(&mut self, q: &[f64], rows: &mut Vec<Row>) -> bool {
        let far = self.obstacles.fastest() * (self.since + WARNING);
        self.space.find_rows(q, self.space.margin() + NEAR[0] + 2.0 * far, &mut self.near);
        rows.clear();
        for near in self.near.rows() {
            // A goal keeps a little more than the arm that is to get there; goals are pursued under acceleration limits alone.
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

impl KeptMotion {
    /// Of an arm with these limits, in `space` if there is something to keep clear of.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`](crate::Error::UnsupportedLimit) for limits that vary over time and could push the arm into an
    /// obstacle.
    pub fn new(space: Option<ClearSpace<'static>>, limits: &Limits) -> Result<Self> {
        Ok(Self {
            around: space.map(|space| Around::new(space, limits)).transpose()?,
            rows: RowMotion::with_room(limits.dof(), 2 * MOST_ROWS + MOST_COMING),
            stop: HeldStop::default(),
            next_stop: HeldStop::default(),
            goal_is_held: false,
        })
    }

    /// The space to stay in.
    pub fn space(&self) -> Option<&Arc<ClearSpace<'static>>> {
        self.around.as_ref().map(|around| &around.space)
    }

    /// Velocities of the obstacles (m/s); empty if all are at rest.
    pub fn velocities(&self) -> &[[f64; 3]] {
        self.around.as_ref().map_or(&[], |around| &around.obstacles.velocities)
    }

    /// Replaces what is around the arm: `space` with the obstacles where they are now, and how they move.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn replace(
        &mut self,
        space: Option<ClearSpace<'static>>,
        obstacles: ObstacleMotion,
        limits: &Limits,
    ) -> Result<()> {
        match (space, &mut self.around) {
            (Some(space), Some(around)) => {
                (around.space, around.obstacles, around.since) = (Arc::new(space), obstacles, 0.0);
            }
            (Some(space), none) => *none = Some(Around { obstacles, ..Around::new(space, limits)? }),
            (None, around) => *around = None,
        }
        Ok(())
    }

    /// Forgets the stop, because the arm is not where it was.
    pub fn forget(&mut self) {
        self.stop.clear();
    }

    /// Changes the command `q` that the rule has found to one that keeps the arm clear and pairs of tips held. Pairs that cannot be held
    /// are tasks like others, until they are where they are to be.
    pub fn keep(&mut self, wish: &Wish<'_>, q: &mut Point) -> Kept {
        let wanted = q.clone();
        let pairs = wish.aim.as_ref().and_then(TickAim::tips).filter(|aims| aims.has_pairs());
        let by_obstacles = pairs.and_then(|aims| self.keep_held(wish, aims, q)).unwrap_or_else(|| {
            self.stop.clear();
            q.copy_from_slice(&wanted);
            self.keep_clear(wish, q)
        });
        if let Some(around) = &mut self.around {
            around.since += wish.dt;
        }
        Kept { changed: *q != wanted, by_obstacles }
    }

    /// Changes the command `q` to one that keeps the arm clear. Returns whether it had to.
    fn keep_clear(&mut self, wish: &Wish<'_>, q: &mut Point) -> bool {
        if self.around.is_none() {
            return false;
        }
        let brake = braking(wish);
        let limited = wish.limited.map(|limited| (limited.braking(), limited.state()));
        let stop = StopMotion::new(wish.q, &brake, limited);
        let rest: Point = (0..wish.q.len()).map(|j| stop.end(j)).collect();
        let wanted = q.clone();
        let mut may_stay = false;
        if self.set_rows(wish, (&rest, stop.ticks_to_stop()), &wanted) {
            may_stay = wish.limited.is_none() && self.rows.are_kept_at(&brake) && self.rows.wanted.is_empty();
            self.step_beside_rows(wish, q);
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
        // Otherwise an arm that is held could swing along its self-motion for ever.
        let stays = may_stay && gets_farther(wish, &brake, q) && self.certifies(wish, &brake);
        if stays || !certified {
            q.copy_from_slice(&brake);
        }
        *q != wanted
    }

    /// Changes the command `q` to one that holds the pairs and keeps the arm clear. Returns whether what is around the arm made it
    /// another; None if pairs cannot be held.
    fn keep_held(&mut self, wish: &Wish<'_>, aims: &TipAims<'_>, q: &mut Point) -> Option<bool> {
        let mut brake = self.stop.next().cloned().unwrap_or_else(|| braking(wish));
        wish.tick_box.bounds.clip(&mut brake);
        let rest = self.stop.rest().cloned().unwrap_or_else(|| brake.clone());
        let wanted = q.clone();
        let mut blocked = self.set_rows(wish, (&rest, self.stop.ticks_to_stop()), &wanted);
        if blocked {
            self.step_beside_rows(wish, q);
        }
        let best = q.clone();
        for part in [1.0].into_iter().chain(PARTS) {
            between(&brake, &best, part, q);
            if !(self.rows.hold(&beside(wish, Towards::Start), q) && self.finds_stop(wish, q)) {
                continue;
            }
            let (stop, dt) = (&self.next_stop, wish.dt);
            let end = 1.0 + stop.ticks_to_stop();
            if self.around.as_mut().is_none_or(|around| around.certifies(stop, end, dt)) {
                std::mem::swap(&mut self.stop, &mut self.next_stop);
                return Some(blocked);
            }
            blocked = true;
        }
        if !aims.pairs_are_held(wish.robot, &brake) {
            return None;
        }
        q.copy_from_slice(&brake);
        self.stop.pass();
        Some(blocked)
    }

    /// Finds the stop after the command `q`, beside no rows: these are for the command.
    fn finds_stop(&mut self, wish: &Wish<'_>, q: &[f64]) -> bool {
        let Self { rows, next_stop, .. } = self;
        let [near, wanted] = [&mut rows.rows, &mut rows.wanted].map(std::mem::take);
        let found = next_stop.find(wish, q, rows);
        (rows.rows, rows.wanted) = (near, wanted);
        found
    }

    /// Whether the command `q` and the stop after it are certainly clear.
    fn certifies(&mut self, wish: &Wish<'_>, q: &[f64]) -> bool {
        let limited = wish.limited.map(|limited| (limited.braking(), limited.state()));
        let motion = StopMotion::new(wish.q, q, limited);
        self.around.as_mut().is_none_or(|around| around.certifies(&motion, motion.end_tick(), wish.dt))
    }

    /// Moves the command `q` to one that keeps the rows of the place where the arm would come to rest after it.
    fn correct(&mut self, wish: &Wish<'_>, q: &mut Point) {
        let limited = wish.limited.map(|limited| (limited.braking(), limited.state()));
        let stop = StopMotion::new(wish.q, q, limited);
        let rest: Point = (0..q.len()).map(|j| stop.end(j)).collect();
        self.rows.rows.clear();
        if let Some(around) = &mut self.around {
            around.set_rows_after(wish, (&rest, stop.ticks_to_stop()), q, &mut self.rows.rows);
        }
        let start = q.clone();
        // The effect on the tip itself counts, whatever the task.
        let aim = wish.aim.as_ref().filter(|aim| aim.tips().is_some());
        // An arm that gives way is corrected by as little as possible, lest the joints that the task leaves free take a leap that no
        // certificate allows.
        let gives_way = self.around.as_ref().is_some_and(|around| around.obstacles.fastest() > 0.0);
        let towards = if gives_way { Towards::Joints } else { Towards::Start };
        self.rows.write(&Beside { aim, ..beside(wish, towards) }, &start, q);
    }

    /// Moves `sample`, a configuration that meets a target, to one that keeps the margin too, if it does not: by Gauss-Newton steps
    /// beside the rows, beginning at `from`.
    pub fn clear_goal(&mut self, goal: &GoalToClear<'_>, from: &[f64], sample: &mut Point) {
        let Self { around: Some(around), rows, goal_is_held, .. } = self else { return };
        rows.wanted.clear();
        *goal_is_held = !around.set_goal_rows(sample, &mut rows.rows);
        if !*goal_is_held {
            return;
        }
        sample.copy_from_slice(from);
        goal.positions.clip(sample);
        for _ in 0..STEPS {
            around.set_goal_rows(sample, &mut rows.rows);
            let start = sample.clone();
            let ends = start.iter().zip(goal.positions.lower().iter().zip(goal.positions.upper()));
            let near = ends.map(|(q, (lower, upper))| ((q - TRUSTED).max(*lower), (q + TRUSTED).min(*upper)));
            let near = Bounds::from_ranges(near);
            let (robot, aim, lower, upper) = (goal.robot, Some(&goal.aim), near.lower(), near.upper());
            let step = Beside { robot, aim, lower, upper, towards: Towards::Target, holds_pairs: true };
            rows.write(&step, &start, sample);
        }
    }

    /// Whether obstacles changed the last goal.
    pub fn goal_is_held(&self) -> bool {
        self.goal_is_held
    }

    /// Sets the rows of the command. Returns whether `command` breaks one.
    fn set_rows(&mut self, wish: &Wish<'_>, (rest, stop_ticks): (&[f64], f64), command: &[f64]) -> bool {
        let Self { around, rows, .. } = self;
        rows.rows.clear();
        rows.wanted.clear();
        around.as_mut().is_some_and(|around| {
            around.find_near(wish, rest);
            around.set_rows(wish, (rest, stop_ticks), command, rows)
        })
    }

    /// Moves `q` to the command that keeps the rows and disturbs the task least.
    fn step_beside_rows(&mut self, wish: &Wish<'_>, q: &mut Point) {
        // What the rule wants under acceleration limits is not the target itself, but on the way there. A target far away must not
        // rival bodies that are to part.
        let at_once = wish.limited.is_none() && self.rows.wanted.is_empty();
        let (towards, steps) = if at_once { (Towards::Target, STEPS) } else { (Towards::Start, 1) };
        for _ in 0..steps {
            let start = q.clone();
            self.rows.write(&beside(wish, towards), &start, q);
        }
    }
}

/// A step in the box of a tick.
fn beside<'a>(wish: &'a Wish<'a>, towards: Towards) -> Beside<'a> {
    let (lower, upper) = (wish.lower(), wish.upper());
    Beside { robot: wish.robot, aim: wish.aim.as_ref(), lower, upper, towards, holds_pairs: true }
}

/// Whether the command `q` leaves the task less done than `from` does.
fn gets_farther(wish: &Wish<'_>, from: &[f64], q: &[f64]) -> bool {
    wish.aim.as_ref().is_some_and(|aim| {
        let [before, after] = [from, q].map(|q| aim.assess(wish.robot, q).score);
        !after.solved && after.value > before.value
    })
}

/// The command of the fastest stop.
fn braking(wish: &Wish<'_>) -> Point {
    let mut brake = wish.limited.map_or_else(|| Point::from_slice(wish.q), |limited| limited.stopping(wish.q));
    wish.tick_box.bounds.clip(&mut brake);
    brake
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
        let [lower, upper] = [wish.lower(), wish.upper()];
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
        let mut row = Row { gradient: [0.0; MAX_DOF], least, softness: SOFTNESS };
        for (j, (slope, offset)) in self.slope.iter().zip(&self.offset).enumerate() {
            row.gradient[j] = gradient[j] * slope;
            row.least -= gradient[j] * offset;
        }
        row
    }
}
