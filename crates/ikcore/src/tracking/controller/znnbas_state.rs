//! ZNNBAS tick by tick: Algorithm 1.

use super::control_tick::{ControlTick, RunningController, TickProgress};
use super::znnbas::{Antenna, Delay, UpdateRule, Znnbas};
use crate::math::comparison::sign;
use crate::objective::Point;
use crate::rng::LazyRng;
use crate::tracking::tip_pose::TipPose;

/// Longest adaptive antenna (rad).
const LONGEST: f64 = 0.5;

/// State of the controller between ticks.
#[derive(Debug)]
pub(super) struct ZnnbasState {
    /// Gain per tick, k dt.
    gain: f64,
    antenna: Antenna,
    delay: Delay,
    accept: UpdateRule,
    /// Integrator state theta.
    theta: Point,
    /// Tip at the last measured theta.
    tip_at_theta: TipPose,
    /// Last command theta'.
    sent: Point,
    /// Last measurement, its command, and its error h.
    tip: TipPose,
    measured_command: Point,
    value: f64,
    delay_line: DelayLine,
    history: MeasurementHistory,
}

/// Ring buffer of commands and targets that a delayed sensor has not measured yet.
#[derive(Debug)]
struct DelayLine {
    sent: Vec<f64>,
    targets: Vec<TipPose>,
    /// Target of the command being measured.
    due: TipPose,
    ticks: usize,
}

/// Ring buffer of the measurements of the last `delay_steps` ticks.
#[derive(Debug)]
struct MeasurementHistory {
    sent: Vec<f64>,
    values: Vec<f64>,
    ticks: usize,
}

impl RunningController for ZnnbasState {
    fn begin(&mut self, target: &TipPose, tip: &TipPose) {
        self.tip.clone_from(tip);
        self.tip_at_theta.clone_from(tip);
        self.value = tip.squared_error(target);
        // Until the first measurement arrives, the arm is at the start.
        self.delay_line.targets.fill(target.clone());
    }

    fn choose_command(&mut self, tick: ControlTick<'_>, rng: &mut LazyRng) {
        let Self { theta, sent, antenna, .. } = self;
        rng.symmetric(sent); // b, line 14
        let error = match self.accept {
            UpdateRule::Always => self.value,
            UpdateRule::Improving => self.tip_at_theta.squared_error(tick.target),
        };
        let lengths = match antenna {
            Antenna::Constant(lengths) => &lengths[..],
            Antenna::Adaptive { c1 } => &[(*c1 * error.sqrt()).min(LONGEST)], // (16)
        };
        for (j, (sent, theta)) in sent.iter_mut().zip(theta).enumerate() {
            *sent = *theta + lengths[if lengths.len() == 1 { 0 } else { j }] * *sent; // (10)
        }
        tick.bounds.clip(sent); // (11)
    }

    fn sent(&self) -> &[f64] {
        &self.sent
    }

    fn observe(&mut self, tick: ControlTick<'_>, tip: &TipPose) -> TickProgress {
        self.tip.clone_from(tip);
        self.measured_command.copy_from_slice(&self.sent);
        let target = self.delay_line.swap(&mut self.measured_command, tick.target);
        self.value = tip.squared_error(target); // h of (12)
        match self.accept {
            UpdateRule::Always => self.move_theta(),
            UpdateRule::Improving if tip.squared_error(tick.target) < self.tip_at_theta.squared_error(tick.target) => {
                self.theta.copy_from_slice(&self.measured_command);
                self.tip_at_theta.clone_from(tip);
            }
            UpdateRule::Improving => {}
        }
        // A limit may have closed in since the command.
        tick.bounds.clip(&mut self.theta);
        self.history.push(&self.measured_command, self.value);
        TickProgress::TickOver
    }

    fn accepted(&self) -> &[f64] {
        &self.theta
    }

    fn measured(&self) -> (&[f64], &TipPose) {
        (&self.measured_command, &self.tip)
    }
}

impl ZnnbasState {
    pub(super) fn new(options: &Znnbas, start: &[f64], dt: f64) -> Self {
        let (n, delay) = (start.len(), options.delay_steps);
        Self {
            gain: options.gain * dt,
            antenna: options.antenna.clone(),
            delay: options.delay,
            accept: options.accept,
            theta: start.into(),
            tip_at_theta: TipPose::UNKNOWN,
            sent: start.into(),
            tip: TipPose::UNKNOWN,
            measured_command: start.into(),
            value: f64::INFINITY,
            delay_line: DelayLine {
                sent: start.repeat(options.sensor_delay),
                targets: vec![TipPose::UNKNOWN; options.sensor_delay],
                due: TipPose::UNKNOWN,
                ticks: 0,
            },
            history: MeasurementHistory { sent: vec![0.0; delay * n], values: vec![0.0; delay], ticks: 0 },
        }
    }

    /// One Euler step of eq. (14).
    fn move_theta(&mut self) {
        let Self { theta, measured_command, history, .. } = self;
        let slot = match self.delay {
            _ if history.ticks < history.values.len() => return,
            Delay::Sliding => history.slot(),
            Delay::Held => 0,
        };
        let step = self.gain * sign(self.value - history.values[slot]);
        let before = &history.sent[slot * theta.len()..][..theta.len()];
        for ((theta, now), before) in theta.iter_mut().zip(measured_command).zip(before) {
            *theta -= step * (*now - before);
        }
    }
}

impl DelayLine {
    /// Stores the newest command with its target, and returns the command and target that the sensor measures now.
    fn swap<'a>(&'a mut self, command: &mut [f64], target: &'a TipPose) -> &'a TipPose {
        if self.targets.is_empty() {
            return target;
        }
        let slot = self.ticks % self.targets.len();
        self.ticks += 1;
        self.sent[slot * command.len()..][..command.len()].swap_with_slice(command);
        self.due.clone_from(&self.targets[slot]);
        self.targets[slot].clone_from(target);
        &self.due
    }
}

impl MeasurementHistory {
    /// Slot of the measurement `delay` ticks earlier, which the current tick overwrites.
    fn slot(&self) -> usize {
        self.ticks % self.values.len()
    }

    fn push(&mut self, command: &[f64], value: f64) {
        let slot = self.slot();
        self.values[slot] = value;
        self.sent[slot * command.len()..][..command.len()].copy_from_slice(command);
        self.ticks += 1;
    }
}
