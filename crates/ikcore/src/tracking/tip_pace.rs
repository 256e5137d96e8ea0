//! Limits of tips of a tracked arm: of its speed and turn speed in every tick, and in the stop after each command.
//!
//! A command that exceeds one is moved towards the command that brakes, which is certified with the command before. Certified are the straight
//! line of the joints in each tick and, for an arm whose velocity may not jump, the spline that it follows. In a stop, most ticks are passed over:
//! the speed of a tip cannot change faster than its acceleration allows.

use super::around_arm::require_constant;
use super::commanded_motion::segment;
use super::safety_filter::SafetyFilter;
use super::step_context::StepContext;
use crate::constraint::{JointSpan, TipRates};
use crate::error::Result;
use crate::limits::{Limits, ROUNDING, TipField};
use crate::math::vector::write_within;
use crate::message::Message;
use crate::objective::Point;
use crate::obstacle::JointMotion;
use crate::robot::Robot;
use crate::trajectory::polynomial;

/// Limits that are kept.
const KEPT: [TipField; 2] = [TipField::Speed, TipField::TurnSpeed];

/// Number of fractions of a command tried.
const TRIES: usize = 4;
/// Relative distance from a limit at which the search ends.
const NEAR: f64 = 1e-3;

/// Ticks by which the straight line of a tick and the spline may be apart.
const APART: f64 = 2.0;

/// Certificate of the speeds of tips; owns its scratch.
#[derive(Debug)]
pub(super) struct TipPace {
    rates: TipRates,
    at: JointSpan,
    /// Commands from two ticks before this one to two ticks after the stop, one after another.
    rows: Vec<f64>,
    /// Largest step and change of each joint (rad, m per tick and per tick^2).
    most: [Vec<f64>; 2],
}

impl TipPace {
    /// The limits of the tips of `robot` in the call `method`; `None` without any.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`](crate::Error::UnsupportedLimit) for limits that vary over time and could push a tip beyond its speed, and for
    /// a tip that a rotation vector carries.
    pub fn new(method: &Message, robot: &Robot, limits: &Limits) -> Result<Option<Box<Self>>> {
        let Some(rates) = TipRates::new(robot, limits.tips(), method.clone())? else { return Ok(None) };
        require_constant(
            limits,
            "tracking with limits of tips",
            "limits that vary can push a tip beyond its own; give numbers",
        )?;
        let most = [(); 2].map(|()| vec![0.0; robot.dof()]);
        Ok(Some(Box::new(Self { at: JointSpan::new(robot), rates, rows: vec![], most })))
    }

    /// Moves the command `q` towards the braking one until it and the stop after it keep the limits and, under acceleration limits, `safety`
    /// allows them. Returns whether it did.
    pub fn keep(&mut self, context: &StepContext<'_>, mut safety: Option<&mut SafetyFilter>, q: &mut Point) -> bool {
        let mut above = (1.0, self.factor(context, q));
        if above.1 <= 1.0 {
            return false;
        }
        let (brake, wanted) = (context.braking(), q.clone());
        let mut below = (0.0, if context.limited.is_some() { self.factor(context, &brake).min(1.0) } else { 0.0 });
        q.copy_from_slice(&brake);
        let mut tried = q.clone();
        for _ in 0..TRIES {
            if below.1 > 1.0 - NEAR {
                break;
            }
            // The speed at a fraction of the command is about convex in it, and so below the line between two of them.
            let part = below.0 + (above.0 - below.0) * (1.0 - ROUNDING - below.1).max(0.0) / (above.1 - below.1);
            write_within(&brake, &wanted, part, &mut tried);
            let factor = self.factor(context, &tried);
            let is_allowed = |tried: &[f64]| match safety.as_deref_mut() {
                Some(safety) if context.limited.is_some() => safety.allows_command(context, tried),
                _ => true,
            };
            if factor <= 1.0 && { is_allowed }(&tried) {
                q.copy_from_slice(&tried);
                below = (part, factor);
            } else {
                above = (part, factor.max(1.0 + NEAR));
            }
        }
        true
    }

    /// Whether the command `q` and the stop after it keep the limits.
    pub fn allows(&mut self, context: &StepContext<'_>, q: &[f64]) -> bool {
        self.factor(context, q) <= 1.0
    }

    /// Upper bound of the factor by which tips are too fast in the command `q` and its stop; beyond 1, that of the part examined.
    fn factor(&mut self, context: &StepContext<'_>, q: &[f64]) -> f64 {
        let motion = context.stop_after(q);
        if !motion.is_spline() {
            return self.line([context.q, q], context.dt);
        }
        let (n, last) = (q.len(), motion.end_tick().ceil() as usize);
        self.write_rows(&motion, n, last);
        let growth = self.growth(q, context.dt);
        let (mut tick, mut largest) = (0, 0.0_f64);
        while tick <= last + 1 {
            let factor = self.tick(tick, n, context.dt);
            largest = largest.max(factor);
            if largest > 1.0 {
                return largest;
            }
            // Of an arm at rest the factor does not grow: all ticks that are left are free.
            let free = (1.0 - factor) / growth - APART;
            tick += 1 + (free.max(0.0) as usize).min(last);
        }
        largest
    }

    /// Writes the commands, and the largest steps and changes of the joints.
    fn write_rows(&mut self, motion: &impl JointMotion, n: usize, last: usize) {
        let Self { rows, most: [steps, changes], .. } = self;
        rows.resize((last + 5) * n, 0.0);
        for (row, q) in rows.chunks_exact_mut(n).enumerate() {
            motion.write((row as f64 - 2.0).min(last as f64), q);
        }
        let at = |row: usize, j: usize| rows[row * n + j];
        for j in 0..n {
            (steps[j], changes[j]) = (0.0, 0.0);
            for row in 1..last + 5 {
                let step = at(row, j) - at(row - 1, j);
                steps[j] = steps[j].max(step.abs());
                if row > 1 {
                    changes[j] = changes[j].max((step - (at(row - 1, j) - at(row - 2, j))).abs());
                }
            }
        }
    }

    /// Largest growth of the factor in a tick.
    fn growth(&mut self, q: &[f64], dt: f64) -> f64 {
        let robot = self.rates.robot();
        self.at.set(robot, q.iter().map(|q| polynomial([*q])), [0.0, 1.0]);
        let [steps, changes] = &self.most;
        self.rates.growth(
            &self.at,
            |j| [steps[j] / dt, changes[j] / (dt * dt)],
            dt * (self.rows.len() / q.len()) as f64,
        ) * dt
    }

    /// The factor in a tick, 0 for the one before the command: on the spline and, from the command on, on the straight line.
    fn tick(&mut self, tick: usize, n: usize, dt: f64) -> f64 {
        let row = |row: usize| &self.rows[(tick + row) * n..(tick + row + 1) * n];
        let [before, from, to, after] = [row(0), row(1), row(2), row(3)];
        let joints = (0..n).map(|j| segment([before[j], from[j], to[j], after[j]], 1.0));
        self.at.set(self.rates.robot(), joints, [0.5, 0.5]);
        let on_spline = self.rates.factor(&self.at, 0.5 * dt, &KEPT);
        if tick == 0 {
            return on_spline;
        }
        let joints = from.iter().zip(to).map(|(from, to)| polynomial([*from, to - from]));
        self.at.set(self.rates.robot(), joints, [0.5, 0.5]);
        on_spline.max(self.rates.factor(&self.at, 0.5 * dt, &KEPT))
    }

    /// The factor on the straight line of the joints between two configurations, in a tick.
    fn line(&mut self, [from, to]: [&[f64]; 2], dt: f64) -> f64 {
        let joints = from.iter().zip(to).map(|(from, to)| polynomial([*from, to - from]));
        self.at.set(self.rates.robot(), joints, [0.5, 0.5]);
        self.rates.factor(&self.at, 0.5 * dt, &KEPT)
    }
}
