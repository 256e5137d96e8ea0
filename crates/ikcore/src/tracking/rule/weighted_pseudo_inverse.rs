//! Resolved motion rate control: joint velocities from the velocity of the target by the weighted pseudo-inverse of the
//! Jacobian, as in "Trajectory tracking of redundant manipulator based on PSO algorithm optimization", eq. (8) to (14),
//! corrected:
//!
//! q' = Jw+ (x' + K (x - f(q))) + (I - Jw+ J) q0',  Jw+ = W^-1 J' (J W^-1 J')^-1,  W_i = 1 / (vU_i - vL_i)^2,
//!
//! with q0' along the negative gradient of the goals (eq. 13 lacks the minus sign), or towards a posture trajectory. The paper
//! has no K; without it errors accumulate. Among the points in the box of the tick that move the tip as required, we take the
//! one nearest to q0' in the norm of W: other joints then take over the motion of a joint at a limit, which the plain formula
//! does not provide.

use std::sync::Arc;

use super::tick::{Tick, TickResult};
use crate::error::{Error, Result, require_finite, require_positive};
use crate::math::MAX_DOF;
use crate::math::box_step::BoxStep;
use crate::math::vector::norm;
use crate::objective::{Point, TaskBlock};
use crate::robot::Robot;
use crate::tracking::step_context::StepContext;
use crate::trajectory::Trajectory;
use crate::wording::words;

/// Integration scheme of joint velocities over a tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Integrator {
    /// Explicit Euler: an error of second order per tick.
    #[default]
    Euler,
    /// Classical Runge-Kutta: four evaluations, an error of fifth order per tick.
    RungeKutta4,
}

words!("integrator": Integrator { Euler => "euler", RungeKutta4 => "rk4" });

/// Options of resolved motion rate control.
#[derive(Debug, Clone, PartialEq)]
pub struct WeightedPseudoInverse {
    /// Gain K (1/s): the fraction of the error corrected per second. `None` means half of the error in every tick.
    pub gain: Option<f64>,
    /// Integration scheme of joint velocities over a tick.
    pub integrator: Integrator,
    /// Weights W (n,), positive: the cost of each joint's squared velocity. `None` means eq. (11), from the velocity limits of
    /// the tick; joints without a limit count like the fastest joint that has one.
    pub weights: Option<Vec<f64>>,
    /// Preferred configuration over time, followed in the null space of the target.
    pub posture: Option<Arc<Trajectory>>,
    /// Gain of the posture (1/s): the fraction of the distance from it corrected per second.
    pub posture_gain: f64,
    /// Damping relative to the squared norm of the weighted Jacobian. 0 gives the plain pseudo-inverse, which near a
    /// singularity demands the highest speeds that the limits allow.
    pub damping: f64,
}

impl Default for WeightedPseudoInverse {
    fn default() -> Self {
        Self {
            gain: None,
            integrator: Integrator::Euler,
            weights: None,
            posture: None,
            posture_gain: 20.0,
            damping: 0.0,
        }
    }
}

/// Fraction of the error corrected in a tick if no gain is given.
const FRACTION_PER_TICK: f64 = 0.5;

impl WeightedPseudoInverse {
    /// Checks the options that do not depend on the robot.
    pub(super) fn validate(&self) -> Result<()> {
        for (what, value) in
            [("gain", self.gain.unwrap_or(0.0)), ("posture_gain", self.posture_gain), ("damping", self.damping)]
        {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(Error::out_of_range(what, "zero or positive, and finite", value));
            }
        }
        let weights = self.weights.as_deref().unwrap_or_default();
        require_finite("weights", weights, |i| format!("entry {i}"))?;
        weights.iter().enumerate().try_for_each(|(i, weight)| require_positive(&format!("weights[{i}]"), *weight))
    }

    /// Checks the options for a robot and ticks of `dt` (s).
    pub(super) fn validate_for(&self, robot: &Robot, dt: f64) -> Result<()> {
        let posture_gain = if self.posture.is_some() { self.posture_gain } else { 0.0 };
        for (what, gain) in [("gain", self.gain.unwrap_or(0.0)), ("posture_gain", posture_gain)] {
            if gain * dt >= 2.0 {
                let requirement = format!("below 2 / dt = {}, beyond which errors grow", 2.0 / dt);
                return Err(Error::out_of_range(what, &requirement, gain));
            }
        }
        let lengths = [
            ("weights", self.weights.as_ref().map(Vec::len)),
            ("posture", self.posture.as_ref().map(|posture| posture.joints().len())),
        ];
        for (what, length) in lengths {
            if let Some(got) = length.filter(|length| *length != robot.dof()) {
                let (what, expected) =
                    (format!("{what} for robot '{}'", robot.name()), format!("{} joints", robot.dof()));
                return Err(Error::WrongLength { what: what.into(), expected, got });
            }
        }
        Ok(())
    }
}

/// Scratch of a tick, without state between ticks.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    linearization: Box<TaskBlock>,
    /// Linearisations of the target one tick later and one earlier.
    neighbours: [Box<TaskBlock>; 2],
}

pub(super) fn advance(rule: &WeightedPseudoInverse, scratch: &mut Scratch, mut tick: Tick<'_>) -> TickResult {
    let StepContext { robot, q, tick_box, .. } = tick.context;
    let mut found = TickResult::at(q);
    let mut stage = |from: &[f64], fraction: f64| {
        found.evaluations += 1;
        displacement(rule, scratch, from, fraction, &mut tick)
    };
    match rule.integrator {
        Integrator::Euler => {
            let k = stage(q, 0.0);
            found.q = moved(q, &k, 1.0);
        }
        Integrator::RungeKutta4 => {
            let k1 = stage(q, 0.0);
            let k2 = stage(&moved(q, &k1, 0.5), 0.5);
            let k3 = stage(&moved(q, &k2, 0.5), 0.5);
            let k4 = stage(&moved(q, &k3, 1.0), 1.0);
            for (j, q) in found.q.iter_mut().enumerate() {
                *q += (k1[j] + 2.0 * (k2[j] + k3[j]) + k4[j]) / 6.0;
            }
        }
    }
    tick_box.bounds.clip(&mut found.q);
    found.set_tip(&robot.tip(&found.q), tick.target, tick.criterion);
    found.evaluations += 1;
    found.iterations = 1;
    found
}

/// Returns dt q' at the configuration `from` and the fraction `fraction` of the tick that starts at `q`, such that q + dt q' is
/// in the box.
fn displacement(
    rule: &WeightedPseudoInverse,
    scratch: &mut Scratch,
    from: &[f64],
    fraction: f64,
    tick: &mut Tick<'_>,
) -> Point {
    let StepContext { q, tick_box, dt, .. } = tick.context;
    let gain = rule.gain.unwrap_or(FRACTION_PER_TICK / dt);
    let drift = linearize(scratch, from, fraction, tick);
    let null_space_step = null_space_step(rule, from, fraction, tick);
    let TaskBlock { columns, residual, .. } = &mut *scratch.linearization;
    let columns = &mut columns[..q.len()];
    // Scaling by y = W^(1/2) q turns the norm of W into the Euclidean norm.
    let units = units(rule, &tick_box.velocity);
    for (column, unit) in columns.iter_mut().zip(&units) {
        column.iter_mut().for_each(|entry| *entry *= unit);
    }
    let scaled = |values: &[f64]| -> Point { values.iter().zip(&units).map(|(value, unit)| value / unit).collect() };
    let equations = ScaledEquations {
        // Task equation, times dt: J q' = -K r - dr/dt.
        residual: std::array::from_fn(|i| dt * (gain * residual[i] + drift[i])),
        lambda: rule.damping * columns.as_flattened().iter().map(|entry| entry * entry).sum::<f64>(),
        columns,
        y: scaled(q),
        lower: scaled(tick_box.bounds.lower()),
        upper: scaled(tick_box.bounds.upper()),
    };
    let y = equations.solve(&scaled(&null_space_step));
    y.iter().zip(&units).zip(q).map(|((y, unit), q)| y * unit - q).collect()
}

/// Equations of a tick in scaled joint positions: J (y' - y) = -residual, y' in the box.
struct ScaledEquations<'a> {
    columns: &'a [[f64; 6]],
    residual: [f64; 6],
    lambda: f64,
    y: Point,
    lower: Point,
    upper: Point,
}

/// Fractions of the null-space step, tried in turn until the equations are met.
const NULL_SPACE_FRACTIONS: [f64; 5] = [1.0, 0.5, 0.25, 0.125, 0.0];

/// Largest fraction of the residual that may remain.
const MET: f64 = 1e-9;

impl ScaledEquations<'_> {
    /// Returns the y' nearest to y + `step` that meets the equations. If the step would drive joints that the tip needs to
    /// their bounds, takes a smaller fraction of it; if no fraction meets the equations, takes the one with the smallest
    /// residual.
    fn solve(&self, step: &[f64]) -> Point {
        let enough = MET * norm(&self.residual);
        let mut best = (f64::INFINITY, Point::new());
        for fraction in NULL_SPACE_FRACTIONS {
            let (missed, there) = self.nearest_to(step, fraction);
            if missed <= enough {
                return there;
            }
            if missed < best.0 {
                best = (missed, there);
            }
        }
        best.1
    }

    /// Returns the y' nearest to y + fraction * `step`, and its residual.
    fn nearest_to(&self, step: &[f64], fraction: f64) -> (f64, Point) {
        let bounds = self.lower.iter().zip(&self.upper);
        let moved = self.y.iter().zip(step).zip(bounds);
        let begin: Point =
            moved.map(|((y, step), (lower, upper))| (y + fraction * step).max(*lower).min(*upper)).collect();
        let mut there = begin.clone();
        let (columns, residual, lambda) = (self.columns, &self.residual_at(&begin), self.lambda);
        let (lower, upper) = (&self.lower, &self.upper);
        BoxStep { columns, residual, lambda, x: &begin, lower, upper }.write(&mut there);
        (norm(&self.residual_at(&there)), there)
    }

    /// Residual at `there`: residual + J (there - y).
    fn residual_at(&self, there: &[f64]) -> [f64; 6] {
        let mut left = self.residual;
        for ((column, there), y) in self.columns.iter().zip(there).zip(&self.y) {
            left.iter_mut().zip(column).for_each(|(sum, entry)| *sum += entry * (there - y));
        }
        left
    }
}

/// Writes residual and Jacobian at `from` to the scratch. Returns the rate of change of the residual due to the target's own
/// motion (1/s).
fn linearize(scratch: &mut Scratch, from: &[f64], fraction: f64, tick: &Tick<'_>) -> [f64; 6] {
    let StepContext { robot, dt, .. } = tick.context;
    let (target, twist) = tick.motion().at(fraction);
    let n = from.len();
    let tip = robot.tip_and_jacobian(from, &mut scratch.linearization.columns);
    for (neighbour, time) in scratch.neighbours.iter_mut().zip([dt, -dt]) {
        neighbour.columns.fit(n);
        neighbour.columns[..n].copy_from_slice(&scratch.linearization.columns[..n]);
        target.moved(&twist, time).linearize_tip(&tip, n, tick.criterion, neighbour);
    }
    target.linearize_tip(&tip, n, tick.criterion, &mut scratch.linearization);
    let [later, earlier] = &scratch.neighbours;
    std::array::from_fn(|i| (later.residual[i] - earlier.residual[i]) / (2.0 * dt))
}

/// Null-space step dt q0': the motion of the joints if the tip were free.
fn null_space_step(rule: &WeightedPseudoInverse, from: &[f64], fraction: f64, tick: &mut Tick<'_>) -> Point {
    let StepContext { robot, time, dt, .. } = tick.context;
    let n = from.len();
    let mut step = Point::from_elem(0.0, n);
    if !tick.goals.is_empty() {
        tick.goals.cost(robot, None, from, &mut step);
        step.iter_mut().for_each(|slope| *slope *= -dt);
    }
    if let Some(posture) = &rule.posture {
        let (mut q, mut qd, mut qdd) = ([0.0; MAX_DOF], [0.0; MAX_DOF], [0.0; MAX_DOF]);
        // Lengths were checked before; after its end the posture trajectory stands still.
        let time = time + fraction * dt;
        let known = posture.at(time, &mut q[..n], &mut qd[..n], &mut qdd[..n]);
        if known.is_ok() && time <= posture.duration() {
            step.iter_mut().zip(&qd).for_each(|(step, velocity)| *step += dt * velocity);
        }
        for (j, step) in step.iter_mut().enumerate() {
            *step += dt * rule.posture_gain * (q[j] - from[j]);
        }
    }
    step
}

/// Scale of each joint, W^(-1/2): eq. (11) up to a common factor, or from the given weights.
fn units(rule: &WeightedPseudoInverse, velocity_limit: &[f64]) -> Point {
    if let Some(weights) = &rule.weights {
        return weights.iter().map(|weight| weight.sqrt().recip()).collect();
    }
    let fastest = velocity_limit.iter().copied().filter(|limit| limit.is_finite()).fold(0.0, f64::max);
    let unit = |limit: &f64| if *limit > 0.0 && limit.is_finite() { limit / fastest } else { 1.0 };
    // The box holds a joint that may not move at all, whatever its scale.
    velocity_limit.iter().map(unit).collect()
}

/// Returns q + fraction * step.
fn moved(q: &[f64], step: &[f64], fraction: f64) -> Point {
    q.iter().zip(step).map(|(q, step)| q + fraction * step).collect()
}
