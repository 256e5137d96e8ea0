//! Resolved motion rate: joint velocities from the velocity of the target by the weighted pseudo-inverse of the Jacobian,
//! as in "Trajectory tracking of redundant manipulator based on PSO algorithm optimization", eq. (8) to (14), mended:
//!
//! q' = Jw+ (x' + K (x - f(q))) + (I - Jw+ J) q0',  Jw+ = W^-1 J' (J W^-1 J')^-1,  W_i = 1 / (vU_i - vL_i)^2,
//!
//! with q0' down the gradient of the goals (eq. 13 lacks the minus sign), or towards a posture that moves. The paper has
//! no K; without it errors add up. Its q' is the point of the tick's box nearest to q0' in the norm of W that moves the tip
//! as wanted: joints at a limit leave their share to the others, which the plain formula does not.

use std::sync::Arc;

use super::tick::{Tick, TickResult};
use crate::error::{Error, Result, require_finite, require_positive};
use crate::math::MAX_DOF;
use crate::math::box_step::BoxStep;
use crate::math::vector::norm;
use crate::objective::{Linearization, Point};
use crate::robot::Robot;
use crate::trajectory::Trajectory;
use crate::wording::words;

/// How velocities become configurations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Integrator {
    /// The velocity at the tick's beginning: an error of second order a tick.
    #[default]
    Euler,
    /// The classical method of Runge and Kutta: four evaluations, an error of fifth order a tick.
    RungeKutta4,
}

words!("integrator": Integrator { Euler => "euler", RungeKutta4 => "rk4" });

/// The options of the rule.
#[derive(Debug, Clone, PartialEq)]
pub struct WeightedPseudoInverse {
    /// K (1/s): the share of the error that is taken back per second. None: half of it in every tick.
    pub gain: Option<f64>,
    /// How velocities become configurations.
    pub integrator: Integrator,
    /// W (n,), positive: the cost of each joint's squared velocity. None: eq. (11), from the velocity limits of the tick;
    /// joints without one count as fast as the fastest with one.
    pub weights: Option<Vec<f64>>,
    /// Where the joints should be, as far as the target leaves them free.
    pub posture: Option<Arc<Trajectory>>,
    /// The share of the distance from that posture that is taken back per second (1/s).
    pub posture_gain: f64,
    /// Damping over the squared size of the weighted Jacobian; 0 is the pseudo-inverse itself, which near a singular
    /// posture asks for all the speed that there is.
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

/// Share of the error that is taken back in a tick where no gain is given.
const SHARE_A_TICK: f64 = 0.5;

impl WeightedPseudoInverse {
    /// Checks the options that need no robot.
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

    /// Checks them for a robot and ticks of `dt` (s).
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
                return Err(Error::WrongLength { what, expected, got });
            }
        }
        Ok(())
    }
}

/// Scratch of a tick; nothing is kept from tick to tick.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    linearization: Box<Linearization>,
    /// Of the target a little later and a little earlier.
    neighbours: [Box<Linearization>; 2],
}

pub(super) fn advance(
    rule: &WeightedPseudoInverse,
    scratch: &mut Scratch,
    q: &[f64],
    mut tick: Tick<'_>,
) -> TickResult {
    let mut found = TickResult::at(q);
    let mut stage = |from: &[f64], share: f64| {
        found.evaluations += 1;
        displacement(rule, scratch, q, from, share, &mut tick)
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
    tick.tick_box.clip(&mut found.q);
    found.set_tip(&tick.robot.tip(&found.q), tick.target, tick.criterion);
    found.evaluations += 1;
    found.iterations = 1;
    found
}

/// dt q' at the configuration `from` after a `share` of the tick that begins at `q`, such that q + dt q' is in the box.
fn displacement(
    rule: &WeightedPseudoInverse,
    scratch: &mut Scratch,
    q: &[f64],
    from: &[f64],
    share: f64,
    tick: &mut Tick<'_>,
) -> Point {
    let gain = rule.gain.unwrap_or(SHARE_A_TICK / tick.dt);
    let drift = linearize(scratch, from, share, tick);
    let null_space_step = null_space_step(rule, from, share, tick);
    let Linearization { columns, residual } = &mut *scratch.linearization;
    let columns = &mut columns[..q.len()];
    // In units in which the norm of W is the length: y = W^(1/2) q.
    let units = units(rule, tick.velocity_limit);
    for (column, unit) in columns.iter_mut().zip(&units) {
        column.iter_mut().for_each(|entry| *entry *= unit);
    }
    let scaled = |values: &[f64]| -> Point { values.iter().zip(&units).map(|(value, unit)| value / unit).collect() };
    let equations = ScaledEquations {
        // J q' = -K r - dr/dt, times dt.
        residual: std::array::from_fn(|i| tick.dt * (gain * residual[i] + drift[i])),
        lambda: rule.damping * columns.as_flattened().iter().map(|entry| entry * entry).sum::<f64>(),
        columns,
        y: scaled(q),
        lower: scaled(tick.tick_box.lower()),
        upper: scaled(tick.tick_box.upper()),
    };
    let y = equations.solve(&scaled(&null_space_step));
    y.iter().zip(&units).zip(q).map(|((y, unit), q)| y * unit - q).collect()
}

/// The equations of a tick in scaled joint positions: J (y' - y) = -residual, y' in the box.
struct ScaledEquations<'a> {
    columns: &'a [[f64; 6]],
    residual: [f64; 6],
    lambda: f64,
    y: Point,
    lower: Point,
    upper: Point,
}

/// Shares of the null-space step that are tried, one after the other, until the equations are met.
const NULL_SPACE_SHARES: [f64; 5] = [1.0, 0.5, 0.25, 0.125, 0.0];

/// The equations count as met where this share of the residual is left.
const MET: f64 = 1e-9;

impl ScaledEquations<'_> {
    /// The y' nearest to y + `step` that meets the equations. A smaller share of the step is taken where it would drive joints to
    /// their bounds that the tip needs; where no share meets the equations, the one with the smallest residual.
    fn solve(&self, step: &[f64]) -> Point {
        let enough = MET * norm(&self.residual);
        let mut best = (f64::INFINITY, Point::new());
        for share in NULL_SPACE_SHARES {
            let (missed, there) = self.nearest_to(step, share);
            if missed <= enough {
                return there;
            }
            if missed < best.0 {
                best = (missed, there);
            }
        }
        best.1
    }

    /// The y' nearest to y + share * `step`, and the residual that it leaves.
    fn nearest_to(&self, step: &[f64], share: f64) -> (f64, Point) {
        let bounds = self.lower.iter().zip(&self.upper);
        let moved = self.y.iter().zip(step).zip(bounds);
        let begin: Point =
            moved.map(|((y, step), (lower, upper))| (y + share * step).max(*lower).min(*upper)).collect();
        let mut there = begin.clone();
        let (columns, residual, lambda) = (self.columns, &self.residual_at(&begin), self.lambda);
        let (lower, upper) = (&self.lower, &self.upper);
        BoxStep { columns, residual, lambda, x: &begin, lower, upper }.write(&mut there);
        (norm(&self.residual_at(&there)), there)
    }

    /// residual + J (there - y).
    fn residual_at(&self, there: &[f64]) -> [f64; 6] {
        let mut left = self.residual;
        for ((column, there), y) in self.columns.iter().zip(there).zip(&self.y) {
            left.iter_mut().zip(column).for_each(|(sum, entry)| *sum += entry * (there - y));
        }
        left
    }
}

/// Residual and Jacobian at `from` into the scratch; how the residual changes per second by the target's own motion.
fn linearize(scratch: &mut Scratch, from: &[f64], share: f64, tick: &Tick<'_>) -> [f64; 6] {
    let (target, twist) = tick.motion().at(share);
    let n = from.len();
    let tip = tick.robot.tip_and_jacobian(from, &mut scratch.linearization.columns);
    for (neighbour, time) in scratch.neighbours.iter_mut().zip([tick.dt, -tick.dt]) {
        neighbour.columns[..n].copy_from_slice(&scratch.linearization.columns[..n]);
        target.moved(&twist, time).linearize_tip(&tip, n, tick.criterion, neighbour);
    }
    target.linearize_tip(&tip, n, tick.criterion, &mut scratch.linearization);
    let [later, earlier] = &scratch.neighbours;
    std::array::from_fn(|i| (later.residual[i] - earlier.residual[i]) / (2.0 * tick.dt))
}

/// dt q0': what the joints would do if no tip had to be anywhere.
fn null_space_step(rule: &WeightedPseudoInverse, from: &[f64], share: f64, tick: &mut Tick<'_>) -> Point {
    let n = from.len();
    let mut step = Point::from_elem(0.0, n);
    if !tick.goals.is_empty() {
        tick.goals.cost(tick.robot, from, &mut step);
        step.iter_mut().for_each(|slope| *slope *= -tick.dt);
    }
    if let Some(posture) = &rule.posture {
        let (mut q, mut qd, mut qdd) = ([0.0; MAX_DOF], [0.0; MAX_DOF], [0.0; MAX_DOF]);
        // Lengths were checked; a trajectory that is over stands still.
        let time = tick.time + share * tick.dt;
        let known = posture.at(time, &mut q[..n], &mut qd[..n], &mut qdd[..n]);
        if known.is_ok() && time <= posture.duration() {
            step.iter_mut().zip(&qd).for_each(|(step, velocity)| *step += tick.dt * velocity);
        }
        for (j, step) in step.iter_mut().enumerate() {
            *step += tick.dt * rule.posture_gain * (q[j] - from[j]);
        }
    }
    step
}

/// W^(-1/2): eq. (11) up to a common factor, or as given.
fn units(rule: &WeightedPseudoInverse, velocity_limit: &[f64]) -> Point {
    if let Some(weights) = &rule.weights {
        return weights.iter().map(|weight| weight.sqrt().recip()).collect();
    }
    let fastest = velocity_limit.iter().copied().filter(|limit| limit.is_finite()).fold(0.0, f64::max);
    let unit = |limit: &f64| if *limit > 0.0 && limit.is_finite() { limit / fastest } else { 1.0 };
    // A joint that may not move at all is held by the box, whatever its unit.
    velocity_limit.iter().map(unit).collect()
}

/// q + share * step.
fn moved(q: &[f64], step: &[f64], share: f64) -> Point {
    q.iter().zip(step).map(|(q, step)| q + share * step).collect()
}
