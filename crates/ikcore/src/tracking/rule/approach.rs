//! Approach to a target farther away than one tick can reach: all joints move in proportion to their displacements.
//!
//! The step that lowers the error most within the box of a tick drives every joint to its limit, and back in the next tick if
//! that lowers the error more. The displacement to the target is therefore computed within the position limits only, without
//! the box, and a tick covers the largest fraction of it that the limits of all joints allow. A moving target is followed by
//! its own motion plus a fraction of the remaining displacement.

use super::tick::Tick;
use crate::math::Columns;
use crate::math::Frame;
use crate::math::box_step::least_damping;
use crate::objective::{Point, TaskBlock};
use crate::solver::LevenbergMarquardt;
use crate::task::Target;
use crate::tracking::step_context::StepContext;

/// Largest fraction of a velocity limit that following a slow target takes.
const SLOW: f64 = 0.5;

/// Fraction of the displacement within one tick from which a fast target counts as near. The step that brings the tip nearest
/// in this tick is then better than an approach that never ends.
const NEAR: f64 = 0.5;

/// Joint displacement (n,) (rad, m) to a target that the arm lags behind.
pub(super) struct Approach {
    /// Remaining displacement to the target at the start of the tick.
    catch_up: Point,
    /// Displacement that follows the target's own motion.
    keep_up: Point,
    /// Threshold of `within_reach` below which the target is far.
    far_below: f64,
    /// Largest fraction of `catch_up` that the box of the tick allows.
    within_reach: f64,
}

impl Approach {
    /// Approach from `q`. `tip` and `columns` belong to `near`, the configuration nearest to `q` in the box of the tick.
    pub(super) fn new(near: &[f64], tip: &Frame, columns: &Columns, tick: &Tick<'_>) -> Self {
        let StepContext { q, tick_box, dt, .. } = tick.context;
        let to = |target: &Target| -> Point {
            let end = destination(target, near, tip, columns, tick);
            end.iter().zip(q).map(|(end, q)| end - q).collect()
        };
        let whole = to(tick.target);
        let mut catch_up = to(&tick.motion().begin);
        let mut keep_up: Point = whole.iter().zip(&catch_up).map(|(whole, catch_up)| whole - catch_up).collect();
        let takes = |fraction: f64| {
            keep_up.iter().zip(&tick_box.velocity).all(|(step, limit)| step.abs() <= fraction * limit * dt)
        };
        let far_below = if takes(SLOW) { 1.0 } else { NEAR };
        // A target faster than the arm is treated like a jump.
        if !takes(1.0) {
            catch_up = whole;
            keep_up.fill(0.0);
        }
        let mut approach = Self { catch_up, keep_up, far_below, within_reach: 1.0 };
        approach.find_fraction(tick);
        approach
    }

    fn find_fraction(&mut self, tick: &Tick<'_>) {
        let (q, [lower, upper]) = (tick.context.q, tick.context.ends());
        for (j, (catch_up, keep_up)) in self.catch_up.iter().zip(&self.keep_up).enumerate() {
            let end = if *catch_up > 0.0 { upper[j] } else { lower[j] };
            let reach = (end - q[j] - keep_up) / catch_up;
            // A joint that still moves the other way reverses as fast as it may, without slowing the other joints down.
            if reach > 0.0 {
                self.within_reach = self.within_reach.min(reach);
            }
        }
    }

    /// Whether the target is far, so that the joints should move in proportion.
    pub(super) fn is_far(&self) -> bool {
        self.within_reach < self.far_below
    }

    /// Moves `q` by one tick.
    pub(super) fn advance(&self, q: &mut [f64], tick: &Tick<'_>) {
        for (q, (catch_up, keep_up)) in q.iter_mut().zip(self.catch_up.iter().zip(&self.keep_up)) {
            *q += keep_up + self.within_reach * catch_up;
        }
        tick.bounds().clip(q);
    }
}

/// Returns the configuration within the position limits that meets the `target`, linearised at `q`. The step is damped as in a
/// descent from `q`, since far from the target the linearisation gives little more than a direction.
fn destination(target: &Target, q: &[f64], tip: &Frame, columns: &Columns, tick: &Tick<'_>) -> Point {
    let n = q.len();
    let mut at = TaskBlock { columns: columns.clone(), ..TaskBlock::default() };
    let value = target.linearize_tip(tip, n, tick.criterion, &mut at).score.value;
    let positions = tick.context.positions();
    let lambda = least_damping(&at.columns[..n]).max(LevenbergMarquardt::default().initial_damping * value);
    let mut end = Point::from_slice(q);
    at.write_step(lambda, q, &positions, &mut end);
    end
}
