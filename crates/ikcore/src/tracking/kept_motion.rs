//! The motion of a tracked arm that keeps to what comes first: distances from what is around it, and pairs of tips that are held.
//!
//! Where the arm would come to rest if it braked now is known to be clear. Near pairs of bodies there are rows: how far the place of
//! rest may move towards them. The command is the one nearest to what the rule wants, measured by its effect on the task, that keeps
//! these rows and the box of the tick. It is sent if the command together with the stop after it is certified clear, between ticks too;
//! otherwise a part of it is, and in the end the stop goes on that was certified before.
//!
//! Pairs of tips that are where they are to be stay there: they are equations beside the rows, and the stop keeps to them as well.

use std::sync::Arc;

use super::around_arm::{Around, ObstacleMotion, Response};
use super::held_stop::HeldStop;
use super::progress::{ArmProgress, Pace, is_nearer};
use super::row_motion::{Beside, Resting, RowMotion, Towards};
use super::stop_motion::StopMotion;
use super::tick_aim::TickAim;
use super::wish::Wish;
use crate::error::Result;
use crate::limits::Limits;
use crate::math::vector::between;
use crate::objective::{Bounds, Point};
use crate::obstacle::{ClearSpace, MOST_COMING, MOST_ROWS};
use crate::robot::Robot;
use crate::task::TipAims;

/// Parts of a command that are tried if the whole is not certified.
const PARTS: [f64; 2] = [0.5, 0.125];

/// Gauss-Newton steps towards the target along the rows.
const STEPS: usize = 3;

/// Rows of a goal are trusted for joint motions up to this (rad, m).
const TRUSTED: f64 = 0.05;

/// What a goal configuration is to meet.
pub(super) struct GoalToClear<'a> {
    pub robot: &'a Robot,
    pub aim: TickAim<'a>,
    pub positions: &'a Bounds,
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
    progress: ArmProgress,
}

/// What became of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Kept {
    /// Whether it was changed.
    pub changed: bool,
    /// Whether it was because of what is around the arm.
    pub by_obstacles: bool,
}

impl KeptMotion {
    /// Of an arm with these limits, in `space` if there is something to keep clear of.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`](crate::Error::UnsupportedLimit) for limits that vary over time and could push the arm into an
    /// obstacle.
    pub fn new(space: Option<ClearSpace<'static>>, limits: &Limits) -> Result<Self> {
        Ok(Self {
            around: space.map(|space| Around::new(space, ObstacleMotion::default(), limits)).transpose()?,
            rows: RowMotion::with_room(limits.dof(), 2 * MOST_ROWS + MOST_COMING),
            stop: HeldStop::default(),
            next_stop: HeldStop::default(),
            goal_is_held: false,
            progress: ArmProgress::new(limits),
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
        self.progress.note_replaced();
        match (space, &mut self.around) {
            (Some(space), Some(around)) => {
                (around.space, around.obstacles, around.since) = (Arc::new(space), obstacles, 0.0);
            }
            (Some(space), none) => *none = Some(Around::new(space, obstacles, limits)?),
            (None, around) => (*around, self.goal_is_held) = (None, false),
        }
        Ok(())
    }

    /// Forgets the stop, because the arm is not where it was.
    pub fn forget(&mut self) {
        self.stop.clear();
        self.progress.restart();
    }

    /// Moves on by one tick, of `dt` (s), of the stop after the last command. Returns its next configuration if pairs are held;
    /// otherwise each joint stops as fast as it may.
    pub fn stop_on(&mut self, dt: f64) -> Option<Point> {
        self.progress.restart();
        if let Some(around) = &mut self.around {
            around.since += dt;
        }
        let next = self.stop.next().cloned();
        self.stop.pass();
        next
    }

    /// Ticks until an arm that holds pairs is at rest if it stops now; `None` if it holds none.
    pub fn ticks_to_stop(&self) -> Option<f64> {
        self.stop.rest().map(|_| self.stop.ticks_to_stop())
    }

    /// Changes the command `q` that the rule has found to one that keeps the arm clear and pairs of tips held. Pairs that cannot be held
    /// are tasks like others, until they are where they are to be.
    pub fn keep(&mut self, wish: &Wish<'_>, q: &mut Point) -> Kept {
        let wanted = q.clone();
        match (wish.error_after, wish.error()) {
            (Some(after), Some(now)) => self.progress.begin_tick([after, now], wish.dt),
            _ => self.progress.restart(),
        }
        let pairs = wish.aim.as_ref().and_then(TickAim::tips).filter(|aims| aims.has_pairs());
        let by_obstacles = pairs.and_then(|aims| self.keep_held(wish, aims, q)).unwrap_or_else(|| {
            self.stop.clear();
            q.copy_from_slice(&wanted);
            self.keep_clear(wish, q)
        });
        if let Some(around) = &mut self.around {
            around.since += wish.dt;
        }
        if by_obstacles || self.goal_is_held {
            self.progress.note_held();
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
        let rest = stop.rest();
        let wanted = q.clone();
        let blocked = self.set_rows(wish, (&rest, stop.ticks_to_stop()), &wanted);
        let pace = self.pace(&brake);
        self.move_beside_rows(wish, (pace, blocked), [&rest, &brake], q);
        let nearer_than = (pace != Pace::Free).then_some(&rest);
        let allowed = pace != Pace::Rest
            && (self.allows(wish, nearer_than, q) || {
                self.correct(wish, q);
                self.allows(wish, nearer_than, q)
            });
        let best = q.clone();
        let mut parts = PARTS.into_iter().filter(|_| pace != Pace::Rest);
        let allowed = allowed
            || parts.any(|part| {
                between(&brake, &best, part, q);
                self.allows(wish, nearer_than, q)
            });
        if !allowed {
            q.copy_from_slice(&brake);
        }
        if pace == Pace::Free {
            return *q != wanted;
        }
        let nearer_than = self.progress.is_freed_nearer().then_some(&rest);
        blocked || !self.allows(wish, nearer_than, &wanted)
    }

    /// Changes the command `q` to one that holds the pairs and keeps the arm clear. Returns whether what is around the arm made it
    /// another; None if pairs cannot be held.
    fn keep_held(&mut self, wish: &Wish<'_>, aims: &TipAims<'_>, q: &mut Point) -> Option<bool> {
        let mut brake = self.stop.next().cloned().unwrap_or_else(|| braking(wish));
        wish.tick_box.bounds.clip(&mut brake);
        let rest = self.stop.rest().cloned().unwrap_or_else(|| brake.clone());
        let wanted = q.clone();
        let mut blocked = self.set_rows(wish, (&rest, self.stop.ticks_to_stop()), &wanted);
        let pace = self.pace(&brake);
        self.move_beside_rows(wish, (pace, blocked), [&rest, &brake], q);
        let best = q.clone();
        for part in [1.0].into_iter().chain(PARTS).filter(|_| pace != Pace::Rest) {
            between(&brake, &best, part, q);
            if !(self.rows.hold(&beside(wish, Towards::Start), q) && self.finds_stop(wish, q)) {
                continue;
            }
            let (stop, dt) = (&self.next_stop, wish.dt);
            if pace == Pace::Nearer && !stop.rest().is_some_and(|to| is_nearer(wish, &rest, to)) {
                continue;
            }
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

    /// How the arm moves, which brakes by the command `brake`. Where bodies are too near or it has to give way, it moves in any case.
    fn pace(&mut self, brake: &[f64]) -> Pace {
        if self.rows.ask_to_move(brake) || self.around.as_ref().is_some_and(Around::is_too_near) {
            self.progress.restart();
        }
        self.progress.pace()
    }

    /// Moves the command `q` to one beside the rows: the nearest, or the one after which the arm rests nearest to the target. It would
    /// rest at `rest` after the command `brake`.
    fn move_beside_rows(
        &mut self,
        wish: &Wish<'_>,
        (pace, blocked): (Pace, bool),
        [rest, brake]: [&[f64]; 2],
        q: &mut Point,
    ) {
        match pace {
            Pace::Free if blocked => self.step_beside_rows(wish, q),
            Pace::Free | Pace::Rest => {}
            Pace::Nearer => {
                let slope = Response::new(wish, rest).slope;
                let resting = Resting { rest, slope: &slope, command: brake };
                self.rows.write_resting(&beside(wish, Towards::Target), &resting, q);
            }
        }
    }

    /// Finds the stop after the command `q`, beside no rows: these are for the command.
    fn finds_stop(&mut self, wish: &Wish<'_>, q: &[f64]) -> bool {
        let Self { rows, next_stop, .. } = self;
        let [near, wanted] = [&mut rows.rows, &mut rows.wanted].map(std::mem::take);
        let found = next_stop.find(wish, q, rows);
        (rows.rows, rows.wanted) = (near, wanted);
        found
    }

    /// Whether the command `q` and the stop after it are certainly clear and, of an arm that has to come nearer than it would at
    /// `rest`, whether it does.
    fn allows(&mut self, wish: &Wish<'_>, rest: Option<&Point>, q: &[f64]) -> bool {
        let limited = wish.limited.map(|limited| (limited.braking(), limited.state()));
        let motion = StopMotion::new(wish.q, q, limited);
        let comes_nearer = |rest: &Point| is_nearer(wish, rest, &motion.rest());
        rest.is_none_or(comes_nearer)
            && self.around.as_mut().is_none_or(|around| around.certifies(&motion, motion.end_tick(), wish.dt))
    }

    /// Moves the command `q` to one that keeps the rows of the place where the arm would come to rest after it.
    fn correct(&mut self, wish: &Wish<'_>, q: &mut Point) {
        let limited = wish.limited.map(|limited| (limited.braking(), limited.state()));
        let stop = StopMotion::new(wish.q, q, limited);
        let rest = stop.rest();
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

/// The command of the fastest stop.
fn braking(wish: &Wish<'_>) -> Point {
    let mut brake = wish.limited.map_or_else(|| Point::from_slice(wish.q), |limited| limited.stopping(wish.q));
    wish.tick_box.bounds.clip(&mut brake);
    brake
}
