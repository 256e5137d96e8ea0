//! Towards a target that is farther away than a tick reaches: all joints at once, in proportion to their parts of the way.
//!
//! The step that lowers the error most within the box of a tick drives every joint to its limit, and in the next tick the other
//! way if that serves the error better. So the whole way is taken by the model, between the position limits, and a tick
//! covers the largest share of it that no joint's limit forbids. Where accelerations are limited, no joint goes faster than
//! it can brake before its part of the way ends. A target that moves is caught up with on top of its own motion.

use super::Tick;
use crate::math::box_step::{box_step, least_damping};
use crate::math::{Frame, MAX_DOF};
use crate::objective::{Linearization, Point};
use crate::robot::Columns;
use crate::solver::LevenbergMarquardt;
use crate::task::Target;

/// A target is slow that takes up no more than this share of any velocity limit.
const SLOW: f64 = 0.5;

/// What a tick covers of the way to a target that is not slow, where it is all but followed: whatever gets the tip nearest to
/// it in this tick is then better than a way that has no end.
const NEAR: f64 = 0.5;

/// What lies before an arm that is behind its target (n,) (rad, m).
pub(super) struct Way {
    /// What the joints have to catch up with.
    catch_up: Point,
    /// What they do beside that, to keep up with the target's own motion.
    keep_up: Point,
    /// Below which share of the way in reach the target counts as far.
    far_below: f64,
    /// The largest share of `catch_up` that the tick's box allows.
    within_reach: f64,
    /// The largest share after which every joint can still stop in time.
    within_braking: f64,
}

impl Way {
    /// The way from `q`. Tip and Jacobian are those at `near`, the configuration of the tick's box that is nearest to `q`.
    pub fn new(q: &[f64], near: &[f64], tip: &Frame, columns: &Columns, tick: &Tick<'_>) -> Self {
        let to = |target: &Target| -> Point {
            let end = destination(target, near, tip, columns, tick);
            end.iter().zip(q).map(|(end, q)| end - q).collect()
        };
        let whole = to(tick.target);
        let mut catch_up = to(&tick.motion.begin);
        let mut keep_up: Point = whole.iter().zip(&catch_up).map(|(whole, catch_up)| whole - catch_up).collect();
        let takes = |share: f64| {
            keep_up.iter().zip(tick.velocity_limit).all(|(step, limit)| step.abs() <= share * limit * tick.dt)
        };
        let far_below = if takes(SLOW) { 1.0 } else { NEAR };
        // A target that outruns the arm has jumped, as far as the arm can tell.
        if !takes(1.0) {
            catch_up = whole;
            keep_up.fill(0.0);
        }
        let mut way = Self { catch_up, keep_up, far_below, within_reach: 1.0, within_braking: 1.0 };
        way.find_shares(q, tick);
        way
    }

    fn find_shares(&mut self, q: &[f64], tick: &Tick<'_>) {
        let (lower, upper) = (tick.tick_box.lower(), tick.tick_box.upper());
        for (j, (catch_up, keep_up)) in self.catch_up.iter().zip(&self.keep_up).enumerate() {
            let end = if *catch_up > 0.0 { upper[j] } else { lower[j] };
            let reach = (end - q[j] - keep_up) / catch_up;
            // A joint that still goes the other way turns round as fast as it may, and holds up no other.
            if reach > 0.0 {
                self.within_reach = self.within_reach.min(reach);
            }
            let distance = catch_up.abs();
            let step = tick.limits.longest_step_before(j, distance, [tick.time, tick.time + tick.dt]);
            if step < distance {
                self.within_braking = self.within_braking.min(step / distance);
            }
        }
    }

    /// Whether the target is so far away that joints are better moved in proportion.
    pub fn is_long(&self) -> bool {
        self.within_reach < self.far_below
    }

    /// Whether an arm that went straight to the target could not stop there.
    pub fn needs_braking(&self) -> bool {
        self.within_braking < 1.0
    }

    /// Moves `q` by one tick on the way.
    pub fn walk(&self, q: &mut [f64], tick: &Tick<'_>) {
        let share = self.within_reach.min(self.within_braking);
        for (q, (catch_up, keep_up)) in q.iter_mut().zip(self.catch_up.iter().zip(&self.keep_up)) {
            *q += keep_up + share * catch_up;
        }
        tick.tick_box.clip(q);
    }
}

/// Where the `target`, linearised at `q`, is met between the position limits. Damped as a descent from there would be: far
/// away it gives little more than a direction.
fn destination(target: &Target, q: &[f64], tip: &Frame, columns: &Columns, tick: &Tick<'_>) -> Point {
    let n = q.len();
    let mut at = Linearization { columns: *columns, ..Linearization::default() };
    let value = target.complete(tip, n, tick.criterion, &mut at).score.value;
    let (mut lower, mut upper) = ([0.0; MAX_DOF], [0.0; MAX_DOF]);
    for j in 0..n {
        [lower[j], upper[j]] = tick.limits.position_range(j, tick.time, tick.time + tick.dt);
    }
    let damping = least_damping(&at.columns[..n]).max(LevenbergMarquardt::default().initial_damping * value);
    let mut end = Point::from_slice(q);
    box_step(&at.columns, &at.residual, damping, q, &lower[..n], &upper[..n], &mut end);
    end
}
