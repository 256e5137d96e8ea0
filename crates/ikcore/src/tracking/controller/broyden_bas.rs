//! [`BroydenBas`] as a controller: the Jacobian estimate is carried along the path.
//!
//! A sensor is noisy, and some measurements are outliers, so a measurement that differs strongly from the prediction is
//! repeated before it is used. If the second measurement agrees with the first, the Jacobian is wrong: it is updated and, if
//! that does not help, estimated again from antennae. If the second measurement agrees with the prediction, the first was an
//! outlier. If it agrees with neither, the difference is noise and gives its level: steps below that level do not update the
//! Jacobian, and the tick ends there. Larger steps update the Jacobian only by the change above the noise level, and an error
//! below that level does not put out antennae. The initial noise level comes from three measurements at the start.
//!
//! With a delayed sensor every further step costs the whole delay. The first step of a tick therefore also corrects the
//! prediction error of the last tick's first step, which changes little along a smooth path.

use super::control_tick::{ControlTick, RunningController, TickProgress};
use super::noise::Noise;
use crate::math::box_step::{LEAST_DAMPING, ROWS};
use crate::math::secant::{Secant, antenna};
use crate::math::vector::norm;
use crate::objective::Point;
use crate::rng::LazyRng;
use crate::solver::BroydenBas;
use crate::solver::broyden_bas::{FIRST_DAMPING, LARGEST_DAMPING, SLOW_STEPS};
use crate::task::Tolerance;
use crate::tracking::tip_pose::TipPose;

/// Relative prediction error beyond which a measurement is repeated.
const SURPRISING: f64 = 1.0;

/// Multiple of the noise level below which an error is indistinguishable from noise: another step would follow the noise.
const NEAR_ENOUGH: f64 = 1.25;

/// Consecutive steps without improvement before antennae are put out again. Antennae shake the tool.
const FAILED_STEPS: usize = 2;

/// State of the controller between measurements.
#[derive(Debug)]
pub(super) struct BroydenBasState {
    options: BroydenBas,
    tolerance: Tolerance,
    jacobian: Secant,
    /// Accepted configuration and the tip measured there.
    q: Point,
    tip: TipPose,
    /// Earlier measurements of a repeated command.
    earlier: [TipPose; 2],
    /// Last command and its purpose.
    sent: Point,
    purpose: Purpose,
    /// Purpose of the next command.
    next: Purpose,
    damping: f64,
    /// Consecutive steps that left more than half of the error, and that did not reduce it.
    slow: usize,
    failed: usize,
    /// Whether no step was accepted since the antennae were last put out.
    fresh: bool,
    noise: Noise,
    /// Remaining repetitions of the last command, for a sensor with delay.
    repetitions_left: usize,
    /// Prediction error of the last tick's first step (m, rad), and whether the next step is the first of its tick; for a
    /// sensor with delay.
    first_step_error: [f64; ROWS],
    first_step: bool,
    /// Measurements in this tick.
    measurements: usize,
}

/// Purpose of a command.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Purpose {
    /// Repeated measurement at the start, `measured` once or twice before.
    RepeatStart { measured: usize },
    /// Measurement at the accepted configuration, before antennae are put out.
    Remeasure,
    /// Antenna of a joint. As `next`: of this joint or, if it has no room, of the next joint that has.
    Antenna { joint: usize },
    /// Step towards the target.
    Step,
    /// Repetition of the step, because its measurement missed the prediction.
    RepeatStep,
}

impl RunningController for BroydenBasState {
    fn begin(&mut self, _target: &TipPose, tip: &TipPose) {
        self.tip.clone_from(tip);
        self.earlier[0].clone_from(tip);
        self.next = Purpose::RepeatStart { measured: 1 };
    }

    fn choose_command(&mut self, tick: ControlTick<'_>, _rng: &mut LazyRng) {
        if self.repetitions_left > 0 {
            tick.bounds.clip(&mut self.sent);
            return;
        }
        self.repetitions_left = 1 + self.options.sensor_delay;
        self.return_to_box(tick);
        self.sent.copy_from_slice(&self.q);
        self.purpose = match self.next {
            Purpose::Antenna { joint } => self.put_out_antenna(joint, tick),
            Purpose::Step | Purpose::RepeatStep => {
                self.step(tick);
                self.next
            }
            measuring @ (Purpose::RepeatStart { .. } | Purpose::Remeasure) => measuring,
        };
    }

    fn sent(&self) -> &[f64] {
        &self.sent
    }

    fn observe(&mut self, tick: ControlTick<'_>, tip: &TipPose) -> TickProgress {
        self.measurements += 1;
        let spent = self.measurements >= self.options.max_evaluations_per_step;
        self.repetitions_left -= 1;
        let verdict = if self.repetitions_left == 0 { self.learn(tick, tip) } else { TickProgress::GoOn };
        if spent || verdict == TickProgress::TickOver {
            (self.measurements, self.first_step) = (0, true);
            return TickProgress::TickOver;
        }
        TickProgress::GoOn
    }

    fn accepted(&self) -> &[f64] {
        &self.q
    }

    fn measured(&self) -> (&[f64], &TipPose) {
        (&self.q, &self.tip)
    }
}

impl BroydenBasState {
    pub(super) fn new(options: BroydenBas, start: &[f64], tolerance: Tolerance) -> Self {
        Self {
            options,
            tolerance,
            jacobian: Secant::default(),
            q: start.into(),
            tip: TipPose::UNKNOWN,
            earlier: [const { TipPose::UNKNOWN }; 2],
            sent: start.into(),
            purpose: Purpose::Remeasure,
            next: Purpose::Antenna { joint: 0 },
            damping: LEAST_DAMPING,
            slow: 0,
            failed: 0,
            fresh: false,
            noise: Noise::default(),
            repetitions_left: 0,
            first_step_error: [0.0; ROWS],
            first_step: true,
            measurements: 0,
        }
    }

    /// Clips the accepted configuration to the box, where a limit may have closed in on it, and has it measured again.
    fn return_to_box(&mut self, tick: ControlTick<'_>) {
        if !tick.bounds.contains(&self.q) {
            tick.bounds.clip(&mut self.q);
            self.next = Purpose::Remeasure;
        }
    }

    /// Puts out the first antenna with room, from `joint` on; takes the first step if none has room.
    fn put_out_antenna(&mut self, joint: usize, tick: ControlTick<'_>) -> Purpose {
        let (lower, upper) = (tick.bounds.lower(), tick.bounds.upper());
        for j in joint..self.q.len() {
            let length = antenna(self.q[j], self.options.antenna_length, lower[j], upper[j]);
            if length != 0.0 {
                self.sent[j] += length;
                return Purpose::Antenna { joint: j };
            }
        }
        self.antennae_are_out();
        self.step(tick);
        Purpose::Step
    }

    fn antennae_are_out(&mut self) {
        (self.next, self.slow, self.failed, self.fresh) = (Purpose::Step, 0, 0, true);
    }

    fn step(&mut self, tick: ControlTick<'_>) {
        let mut residual = self.tip.residual(tick.target);
        if self.first_step {
            residual.iter_mut().zip(&self.first_step_error).for_each(|(r, error)| *r += error);
        }
        let bounds = [tick.bounds.lower(), tick.bounds.upper()];
        self.jacobian.step(&residual, self.damping(), &self.q, bounds, &mut self.sent);
    }

    /// Adds damping for noise, so that the noise in a small column is not taken for a direction of motion.
    fn damping(&self) -> f64 {
        let doubt = self.noise.level() / self.options.antenna_length;
        if doubt == 0.0 {
            return self.damping;
        }
        self.damping + doubt * doubt / self.jacobian.size(self.q.len()).max(f64::MIN_POSITIVE)
    }

    /// Processes the measurement `tip` of the last command.
    fn learn(&mut self, tick: ControlTick<'_>, tip: &TipPose) -> TickProgress {
        let verdict = match self.purpose {
            Purpose::RepeatStart { measured: 1 } => {
                self.earlier[1].clone_from(tip);
                self.next = Purpose::RepeatStart { measured: 2 };
                TickProgress::GoOn
            }
            Purpose::RepeatStart { .. } => {
                let [first, second] = &self.earlier;
                self.know_start([first.clone(), second.clone(), tip.clone()]);
                TickProgress::GoOn
            }
            Purpose::Remeasure => {
                self.tip.clone_from(tip);
                self.next = Purpose::Antenna { joint: 0 };
                TickProgress::GoOn
            }
            Purpose::Antenna { joint } => {
                self.set_column(joint, tip);
                TickProgress::GoOn
            }
            Purpose::Step | Purpose::RepeatStep if tip.is_oriented() => self.process_step::<6>(tick, tip),
            Purpose::Step | Purpose::RepeatStep => self.process_step::<3>(tick, tip),
        };
        let near_enough = self.tolerance.at_least(NEAR_ENOUGH * self.noise.level());
        let arrived = self.next == Purpose::Step && self.tip.error(tick.target).within(&near_enough);
        if arrived { TickProgress::TickOver } else { verdict }
    }

    /// Estimates tip and noise level at the start from three measurements, one of which may be an outlier.
    fn know_start(&mut self, measurements: [TipPose; 3]) {
        self.tip = TipPose::median(&measurements);
        self.noise.note_three(&measurements);
        self.next = Purpose::Antenna { joint: 0 };
    }

    fn set_column(&mut self, joint: usize, tip: &TipPose) {
        self.jacobian.set_column(joint, self.sent[joint] - self.q[joint], &tip.residual(&self.tip));
        self.next = Purpose::Antenna { joint: joint + 1 };
        if joint + 1 == self.q.len() {
            self.antennae_are_out();
        }
    }

    /// Processes the measurement of a step, possibly a repeated one. The residual has `R` rows, three for positions.
    fn process_step<const R: usize>(&mut self, tick: ControlTick<'_>, tip: &TipPose) -> TickProgress {
        let repeated = self.purpose == Purpose::RepeatStep;
        let Self { q, sent, jacobian, .. } = self;
        let dq = || sent.iter().zip(q.iter()).map(|(to, from)| to - from);
        let predicted = jacobian.predict::<R>(dq());
        let seen = tip.residual(&self.tip);
        let surprise: [f64; R] = std::array::from_fn(|k| seen[k] - predicted[k]);
        let (motion, miss) = (norm(&predicted), norm(&surprise));
        let surprising = miss > SURPRISING * motion;
        self.next = Purpose::Step;
        let mut noisy = self.noise.explains(motion);
        if surprising && !repeated && !noisy {
            self.earlier[0].clone_from(tip);
            self.next = Purpose::RepeatStep;
            return TickProgress::GoOn;
        }
        if surprising && repeated {
            let apart = tip.distance(&self.earlier[0]);
            if apart > 0.5 * miss {
                self.noise.note(apart);
                noisy = true;
            }
        }
        if self.first_step && self.options.sensor_delay > 0 {
            self.first_step_error = [0.0; ROWS];
            if !noisy && !surprising {
                let fraction = self.noise.fraction(miss);
                self.first_step_error[..R].copy_from_slice(&surprise.map(|missed| fraction * missed));
            }
        }
        self.first_step = false;
        if !noisy {
            jacobian.learn(dq(), &surprise, self.noise.fraction(miss));
        }
        self.judge(tick, tip, noisy)
    }

    /// Accepts a step that reduced the error. Otherwise raises the damping or puts out antennae, unless the cause is
    /// noise.
    fn judge(&mut self, tick: ControlTick<'_>, tip: &TipPose, noisy: bool) -> TickProgress {
        let (before, after) = (self.tip.squared_error(tick.target), tip.squared_error(tick.target));
        if after < before {
            self.q.copy_from_slice(&self.sent);
            self.tip.clone_from(tip);
            self.damping = (self.damping * 0.1).max(LEAST_DAMPING);
            (self.fresh, self.failed) = (false, 0);
            let slow = after > 0.25 * before && !noisy && !self.noise.explains(after.sqrt());
            self.slow = if slow { self.slow + 1 } else { 0 };
            if self.slow >= SLOW_STEPS {
                self.next = Purpose::Remeasure;
            }
            return TickProgress::GoOn;
        }
        if noisy {
            return TickProgress::TickOver;
        }
        self.failed += 1;
        if !self.fresh {
            // The first failure has updated the Jacobian and may have been noise.
            if self.failed >= FAILED_STEPS {
                self.next = Purpose::Remeasure;
            }
            return TickProgress::GoOn;
        }
        self.damping = (self.damping * 10.0).max(FIRST_DAMPING);
        if self.damping <= LARGEST_DAMPING {
            return TickProgress::GoOn;
        }
        // Further steps do not improve this tick; the next one starts with the same damping.
        self.damping = FIRST_DAMPING;
        TickProgress::TickOver
    }
}
