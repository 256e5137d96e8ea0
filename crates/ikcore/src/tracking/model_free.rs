//! Tracking without a model: a controller commands a plant and learns from its measurements alone.

use serde::{Deserialize, Serialize};

use super::controller::{ControlSession, Controller};
use super::late_sensor::FirstMeasurements;
use super::plant::{Fault, Plant, check};
use super::record::Record;
use super::step::Step;
use super::tip_pose::TipPose;
use crate::error::{Error, Result};
use crate::limits::{LimitAt, Limits};
use crate::message::{Message, message};
use crate::path::Reference;
use crate::solver::Stopwatch;
use crate::solver::{Monitor, Status};
use crate::task::{TipError, Tolerance};
use crate::wording::time;

/// Options of [`track_model_free`].
#[derive(Debug, Clone)]
pub struct ModelFreeOptions {
    /// The controller.
    pub controller: Controller,
    /// Limits on every command, probes included. `None` means unlimited.
    pub limits: Option<Limits>,
    /// The error band.
    pub tolerance: Tolerance,
    /// Seed of the random draws; the same seed gives the same bits.
    pub seed: u64,
}

impl Default for ModelFreeOptions {
    fn default() -> Self {
        Self {
            controller: Controller::default(),
            limits: None,
            tolerance: Tolerance { position: 1e-9, rotation: 1e-9 },
            seed: 0,
        }
    }
}

/// Record of a track without a model.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ModelFreeRecord {
    /// Rows of the track: `q` is the accepted configuration, `position` the position measured at `command` (m). The violations
    /// cover all commands.
    pub track: Record,
    /// The command at which each row's position was measured (k, n). It differs from `q` for
    /// [`Znnbas`](super::controller::Znnbas), which measures an antenna away from the accepted configuration.
    pub command: Vec<f64>,
    /// Fault of the plant that ended the run.
    pub fault: Option<Fault>,
    /// Delay of the sensor (measurements), if the run failed and the delay clearly differs from the controller's
    /// `sensor_delay`.
    pub sensor_delay: Option<usize>,
}

/// Follows `reference` with the tip of `plant`, from `start` (n,). Row 0 is one measurement at the start.
///
/// # Errors
/// Any [`Error`] for wrong input, and [`Error::PlantFailed`] if the plant fails at the start. A plant that fails later
/// ends the run with [`Status::PlantFailed`]. A path that cannot be followed is a status, not an error.
pub fn track_model_free(
    plant: &mut dyn Plant,
    reference: &Reference,
    start: &[f64],
    options: &ModelFreeOptions,
    monitor: &mut dyn Monitor,
) -> Result<ModelFreeRecord> {
    const METHOD: &str = "track_model_free";
    let stopwatch = Stopwatch::start();
    let ticks = reference.len() - 1;
    check_delay(&options.controller, ticks)?;
    let limits = options.limits.clone().unwrap_or_else(|| Limits::none_for(start.len()));
    limits.validate(reference.dt(), ticks)?;
    let ModelFreeOptions { controller, tolerance, seed, .. } = options;
    let mut session =
        ControlSession::begun_by(METHOD, controller, start, reference.dt(), limits.clone(), (*tolerance, *seed))?;
    let mut track =
        Record::new(start.len(), reference.len(), limits, LimitAt::Interval, (*tolerance).into(), reference.dt());
    track.start_outside = session.start_outside().to_vec();
    let command = Vec::with_capacity(reference.len() * start.len());
    let mut record = ModelFreeRecord { track, command, fault: None, sensor_delay: None };
    let mut first = FirstMeasurements::new(start.len());
    let mut interrupted = false;
    for i in 0..=ticks {
        if i % plant.ticks_between_looks() == 0 {
            interrupted = !monitor.keep_going();
            if interrupted {
                break;
            }
        }
        let target = reference.pose(i).map_or_else(|| reference.position(i).into(), |pose| TipPose::from(&pose));
        match tick(plant, &mut session, &target, &mut record.track, &mut first)? {
            Ok(step) => record.push(&session, reference.position(i), &step),
            Err(fault) if i == 0 => return Err(Error::PlantFailed { problem: fault.0 }),
            Err(fault) => {
                record.fault = Some(fault);
                break;
            }
        }
        monitor.progress(i, ticks);
    }
    record.finish(interrupted, &stopwatch);
    if matches!(record.track.status, Status::Lost | Status::Improved | Status::Capped) {
        record.sensor_delay = first.delay_other_than(controller.sensor_delay());
    }
    Ok(record)
}

fn check_delay(controller: &Controller, ticks: usize) -> Result<()> {
    match controller {
        Controller::Znnbas(znnbas) if znnbas.delay_steps >= ticks => {
            let requirement = format!("less than the {ticks} steps of the run");
            Err(Error::out_of_range("delay_steps", &requirement, znnbas.delay_steps as f64))
        }
        _ => Ok(()),
    }
}

/// Sends commands and takes measurements until the controller ends the tick.
fn tick(
    plant: &mut dyn Plant,
    session: &mut ControlSession,
    target: &TipPose,
    track: &mut Record,
    first: &mut FirstMeasurements,
) -> Result<Result<Step, Fault>> {
    loop {
        let command = session.command(target)?;
        let measured = plant.measure(command);
        if let Ok(tip) = &measured {
            first.note(command, tip);
        }
        if let Some((excess, joint, sent)) = session.excess() {
            track.note_excess(excess, joint, sent, session.time() + session.dt());
        }
        let tip = match &measured {
            Err(fault) => return Ok(Err(fault.clone())),
            Ok(tip) => tip,
        };
        if let Err(fault) = check(tip, target) {
            return Ok(Err(fault));
        }
        if let Some(step) = session.observe(tip)? {
            return Ok(Ok(step));
        }
    }
}

impl ModelFreeRecord {
    fn push(&mut self, session: &ControlSession, reference: [f64; 3], step: &Step) {
        self.track.push(&session.accepted(), reference, step);
        self.command.extend_from_slice(session.measured_command());
    }

    fn finish(&mut self, interrupted: bool, stopwatch: &Stopwatch) {
        self.track.finish(interrupted, stopwatch.elapsed());
        if self.fault.is_some() {
            self.track.status = Status::PlantFailed;
        }
    }

    /// Root mean square of the measured error over the second half of the rows (m).
    pub fn settled_error(&self) -> f64 {
        settled(&self.track.position_error)
    }

    /// Returns a sentence on the outcome, with advice.
    pub fn message(&self) -> Message {
        if let Some(Fault(reason)) = &self.fault {
            let rows = self.track.rows();
            let when = time(rows as f64 * self.track.dt());
            return format!("the plant {reason} at t = {when} s; the {rows} rows before are recorded").into();
        }
        let typical = TipError { position: self.settled_error(), rotation: settled(&self.track.rotation_error) };
        match (self.track.status, self.sensor_delay) {
            (Status::Solved | Status::Interrupted, _) => self.track.message(),
            (_, Some(delay)) => {
                let late = match delay {
                    0 => "not late".into(),
                    1 => "1 measurement late".into(),
                    _ => format!("{delay} measurements late"),
                };
                let advice = format!("the sensor is {late}; give the controller a sensor_delay of {delay}");
                let over = format!(". Over the second half the error was {typical} (root mean square)");
                message![self.track.message_with(advice), over]
            }
            _ => {
                let over = format!(
                    ". Over the second half the error was {typical} (root mean square): a position_tolerance below what the \
                     sensor and the controller can keep is never met; if the sensor is late, give the controller its \
                     sensor_delay"
                );
                message![self.track.message(), over]
            }
        }
    }
}

/// Root mean square over the second half of the rows.
fn settled(errors: &[f64]) -> f64 {
    let late = &errors[errors.len() / 2..];
    (late.iter().map(|error| error * error).sum::<f64>() / late.len() as f64).sqrt()
}
