//! [`BroydenBas`] as a controller: the Jacobian estimate is carried along the path.
//!
//! A sensor may be noisy, and now and then wrong altogether, so a step that came out quite otherwise than predicted is sent
//! again before it is believed. If the second measurement agrees with the first, the Jacobian is to blame: it learns, and if
//! that does not help antennae are put out again. If it agrees with the prediction, the first was an outlier. If it
//! agrees with neither, this is noise, and how much: nothing is learned from steps below it, and the tick ends there. From
//! other steps only that is learned which noise does not explain, and an error that it explains is no reason to put out
//! antennae. How noisy the sensor is to begin with, three measurements of the start tell.

use super::control_tick::{ControlTick, TickProgress};
use super::noise::Noise;
use crate::math::box_step::LEAST_DAMPING;
use crate::math::secant::{Secant, antenna};
use crate::math::vector::norm;
use crate::objective::Point;
use crate::solver::BroydenBas;
use crate::solver::broyden_bas::{FIRST_DAMPING, LARGEST_DAMPING, SLOW_STEPS};
use crate::task::Tolerance;
use crate::tracking::tip_pose::TipPose;

/// A measurement that misses the prediction by more than this share of the predicted motion is sent for again.
const SURPRISING: f64 = 1.0;

/// An error below this many noise levels cannot be told from noise: another step would follow the noise.
const NEAR_ENOUGH: f64 = 1.25;

/// Steps in a row that came no nearer, before antennae are put out again: they shake the tool.
const FAILED_STEPS: usize = 2;

/// State of the controller between measurements.
#[derive(Debug)]
pub(super) struct BroydenBasState {
    options: BroydenBas,
    tolerance: Tolerance,
    jacobian: Secant,
    /// The accepted configuration, and what was measured there.
    q: Point,
    tip: TipPose,
    /// The last command, and what it was for.
    sent: Point,
    purpose: Purpose,
    /// Purpose of the next command.
    next: Purpose,
    damping: f64,
    /// Steps in a row that left more than half of the error, and steps in a row that came no nearer at all.
    slow: usize,
    failed: usize,
    /// No step was accepted since antennae were out.
    fresh: bool,
    noise: Noise,
    /// How often the last command is still to be sent, for a sensor that is late.
    due: usize,
    /// Measurements in this tick.
    measurements: usize,
}

/// Purpose of a command.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Purpose {
    /// To measure at the start again, which was at `first` before, and then at `second`.
    Repeat { first: TipPose, second: Option<TipPose> },
    /// To measure at the accepted configuration, before antennae are put out.
    Stand,
    /// To put out the antenna of a joint. As a plan: of this one or, where it has no room, of the next that has.
    Antenna { joint: usize },
    /// To come nearer.
    Step,
    /// The same step again, because this measurement surprised.
    Again { first: TipPose },
}

impl BroydenBasState {
    pub(super) fn new(options: BroydenBas, start: &[f64], tolerance: Tolerance) -> Box<Self> {
        Box::new(Self {
            options,
            tolerance,
            jacobian: Secant::default(),
            q: start.into(),
            tip: TipPose::UNKNOWN,
            sent: start.into(),
            purpose: Purpose::Stand,
            next: Purpose::Antenna { joint: 0 },
            damping: LEAST_DAMPING,
            slow: 0,
            failed: 0,
            fresh: false,
            noise: Noise::default(),
            due: 0,
            measurements: 0,
        })
    }

    pub(super) fn begin(&mut self, tip: &TipPose) {
        self.tip = *tip;
        self.next = Purpose::Repeat { first: *tip, second: None };
    }

    pub(super) fn accepted(&self) -> &[f64] {
        &self.q
    }

    pub(super) fn measured(&self) -> (&[f64], &TipPose) {
        (&self.q, &self.tip)
    }

    pub(super) fn sent(&self) -> &[f64] {
        &self.sent
    }

    pub(super) fn choose_command(&mut self, tick: ControlTick<'_>) {
        if self.due > 0 {
            tick.bounds.clip(&mut self.sent);
            return;
        }
        self.due = 1 + self.options.sensor_delay;
        self.return_to_box(tick);
        self.sent.copy_from_slice(&self.q);
        self.purpose = match self.next {
            Purpose::Antenna { joint } => self.put_out_antenna(joint, tick),
            Purpose::Step | Purpose::Again { .. } => {
                self.step(tick);
                self.next
            }
            measuring @ (Purpose::Repeat { .. } | Purpose::Stand) => measuring,
        };
    }

    /// A limit may close in on the accepted configuration: then the arm has to be measured where it may stand.
    fn return_to_box(&mut self, tick: ControlTick<'_>) {
        if !tick.bounds.contains(&self.q) {
            tick.bounds.clip(&mut self.q);
            self.next = Purpose::Stand;
        }
    }

    /// The first antenna, from `joint` on, that has room; the first step where none has.
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
        let residual = self.tip.residual(tick.target);
        let bounds = [tick.bounds.lower(), tick.bounds.upper()];
        self.jacobian.step(&residual, self.damping(), &self.q, bounds, &mut self.sent);
    }

    /// What noise has left of a column in the dark must not be taken for a way to move.
    fn damping(&self) -> f64 {
        let doubt = self.noise.level() / self.options.antenna_length;
        if doubt == 0.0 {
            return self.damping;
        }
        self.damping + doubt * doubt / self.jacobian.size(self.q.len()).max(f64::MIN_POSITIVE)
    }

    pub(super) fn observe(&mut self, tick: ControlTick<'_>, tip: &TipPose) -> TickProgress {
        self.measurements += 1;
        let spent = self.measurements >= self.options.max_evaluations_per_step;
        self.due -= 1;
        let verdict = if self.due == 0 { self.learn(tick, tip) } else { TickProgress::GoOn };
        if spent || verdict == TickProgress::TickOver {
            self.measurements = 0;
            return TickProgress::TickOver;
        }
        TickProgress::GoOn
    }

    /// The answer to the last command was `tip`.
    fn learn(&mut self, tick: ControlTick<'_>, tip: &TipPose) -> TickProgress {
        let verdict = match self.purpose {
            Purpose::Repeat { first, second: None } => {
                self.next = Purpose::Repeat { first, second: Some(*tip) };
                TickProgress::GoOn
            }
            Purpose::Repeat { first, second: Some(second) } => {
                self.know_start([first, second, *tip]);
                TickProgress::GoOn
            }
            Purpose::Stand => {
                (self.tip, self.next) = (*tip, Purpose::Antenna { joint: 0 });
                TickProgress::GoOn
            }
            Purpose::Antenna { joint } => {
                self.feel(joint, tip);
                TickProgress::GoOn
            }
            Purpose::Step => self.believe(tick, tip, None),
            Purpose::Again { first } => self.believe(tick, tip, Some(&first)),
        };
        let near_enough = self.tolerance.at_least(NEAR_ENOUGH * self.noise.level());
        let arrived = self.next == Purpose::Step && self.tip.error(tick.target).within(&near_enough);
        if arrived { TickProgress::TickOver } else { verdict }
    }

    /// Where the start is, and how noisy the sensor: one of the three measurements may be an outlier.
    fn know_start(&mut self, measurements: [TipPose; 3]) {
        self.tip = TipPose::median(measurements);
        self.noise.note_three(measurements);
        self.next = Purpose::Antenna { joint: 0 };
    }

    fn feel(&mut self, joint: usize, tip: &TipPose) {
        self.jacobian.set_column(joint, self.sent[joint] - self.q[joint], &tip.residual(&self.tip));
        self.next = Purpose::Antenna { joint: joint + 1 };
        if joint + 1 == self.q.len() {
            self.antennae_are_out();
        }
    }

    /// A step was measured at `tip`, and if it was sent again, at `first` before.
    fn believe(&mut self, tick: ControlTick<'_>, tip: &TipPose, first: Option<&TipPose>) -> TickProgress {
        let Self { q, sent, jacobian, .. } = self;
        let dq = || sent.iter().zip(q.iter()).map(|(to, from)| to - from);
        let predicted = jacobian.predict(dq());
        let seen = tip.residual(&self.tip);
        let surprise = std::array::from_fn(|k| seen[k] - predicted[k]);
        let (motion, miss) = (norm(&predicted), norm(&surprise));
        let surprising = miss > SURPRISING * motion;
        self.next = Purpose::Step;
        let mut noisy = self.noise.explains(motion);
        match first {
            None if surprising && !noisy => {
                self.next = Purpose::Again { first: *tip };
                return TickProgress::GoOn;
            }
            Some(first) if surprising && tip.distance(first) > 0.5 * miss => {
                self.noise.note(tip.distance(first));
                noisy = true;
            }
            _ => {}
        }
        if !noisy {
            jacobian.learn(dq(), &surprise, self.noise.share(miss));
        }
        self.judge(tick, tip, noisy)
    }

    /// Keeps a step that came nearer; else does something about it, unless noise hides what.
    fn judge(&mut self, tick: ControlTick<'_>, tip: &TipPose, noisy: bool) -> TickProgress {
        let (before, after) = (self.tip.squared_error(tick.target), tip.squared_error(tick.target));
        if after < before {
            self.q.copy_from_slice(&self.sent);
            self.tip = *tip;
            self.damping = (self.damping * 0.1).max(LEAST_DAMPING);
            (self.fresh, self.failed) = (false, 0);
            let slow = after > 0.25 * before && !noisy && !self.noise.explains(after.sqrt());
            self.slow = if slow { self.slow + 1 } else { 0 };
            if self.slow >= SLOW_STEPS {
                self.next = Purpose::Stand;
            }
            return TickProgress::GoOn;
        }
        if noisy {
            return TickProgress::TickOver;
        }
        self.failed += 1;
        if !self.fresh {
            // The first failure has taught the Jacobian something, and may have been noise.
            if self.failed >= FAILED_STEPS {
                self.next = Purpose::Stand;
            }
            return TickProgress::GoOn;
        }
        self.damping = (self.damping * 10.0).max(FIRST_DAMPING);
        if self.damping <= LARGEST_DAMPING {
            return TickProgress::GoOn;
        }
        // Nothing more to gain in this tick; the next one starts as carefully as this one did.
        self.damping = FIRST_DAMPING;
        TickProgress::TickOver
    }
}
