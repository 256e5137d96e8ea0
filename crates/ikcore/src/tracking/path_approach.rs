//! An approach from rest onto a moving path, within acceleration and jerk limits.

use std::collections::VecDeque;

use super::session::Session;
use super::tip_paths::TipPaths;
use super::track_options::{TRACK, TrackOptions};
use crate::constraint::TipRates;
use crate::error::{Error, Result};
use crate::limits::{Field, Limits, Profile};
use crate::message::{Setting, message};
use crate::motion::{ArmState, meet};
use crate::objective::Point;
use crate::robot::Robot;
use crate::solver::{Monitor, Status};
use crate::trajectory::Trajectory;

/// Window of consecutive configurations for central differences: before, at and after the meeting tick.
const AROUND: usize = 3;

/// Approach trajectory and its length in ticks.
pub(super) struct PathApproach {
    pub ticks: usize,
    trajectory: Trajectory,
}

impl PathApproach {
    /// Finds the earliest approach of an arm at rest at `start`. Follows the path without acceleration and jerk limits until a
    /// motion within them meets it; `None` if none does before the path ends.
    ///
    /// # Errors
    /// [`Error::Contradiction`] without acceleration and jerk limits; errors of a [`Session`].
    pub(super) fn find(
        robot: &Robot,
        asked: &TipPaths<'_>,
        start: &[f64],
        options: &TrackOptions,
        monitor: &mut dyn Monitor,
    ) -> Result<Option<Self>> {
        let limits = options.limits_for(robot, &TRACK.into())?;
        if ![Field::Acceleration, Field::Jerk].into_iter().any(|field| limits.is_finite(field)) {
            let problem = message![
                Setting::Ease,
                " is an approach under acceleration or jerk limits, and there are none: give ",
                Setting::Limit("acceleration"),
            ];
            return Err(Error::Contradiction { problem });
        }
        let tips = TipRates::new(robot, limits.tips(), TRACK)?;
        let dt = asked.paths[0].dt();
        let mut session = Session::begun_by(&TRACK.into(), robot, start, dt, &without_rates(&limits, options)?)?;
        session.begin(asked.arrival(0))?;
        let mut around: VecDeque<Option<Point>> = VecDeque::from([None]);
        for i in 1..asked.len() {
            let step = session.advance(Some(asked.arrival(i)), monitor)?;
            if step.interrupted {
                return Ok(None);
            }
            around.push_back((step.status == Status::Solved).then(|| session.q().into()));
            if around.len() > AROUND {
                around.pop_front();
            }
            if let [Some(before), Some(there), Some(after)] = around.make_contiguous() {
                let ticks = i - 1;
                let met = moving(before, there, after, dt);
                let time = asked.time(ticks);
                let within = limits.narrowest(0.0, time)?.of_joint_motion();
                if let Some(trajectory) = meet(&ArmState::at_rest(start), &met, &within, time)
                    && tips.as_ref().is_none_or(|tips| tips.slowdown(&trajectory, 1.0) <= 1.0)
                {
                    return Ok(Some(Self { ticks, trajectory }));
                }
            }
        }
        Ok(None)
    }

    /// The configuration at time `t` (s).
    ///
    /// # Errors
    /// None in practice: the buffers have the length of the trajectory.
    pub(super) fn at(&self, t: f64) -> Result<Vec<f64>> {
        let n = self.trajectory.joints().len();
        let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; n]);
        self.trajectory.at(t, &mut q, &mut qd, &mut qdd)?;
        Ok(q)
    }
}

/// Copy of the options without acceleration and jerk limits.
fn without_rates(limits: &Limits, options: &TrackOptions) -> Result<TrackOptions> {
    let none = || vec![Profile::Constant(f64::INFINITY)];
    let velocity = limits.field(Field::Velocity).unwrap_or_default().to_vec();
    let limits = limits.clone().replace(Field::Velocity, velocity)?;
    let limits = limits.replace(Field::Acceleration, none())?.replace(Field::Jerk, none())?;
    Ok(TrackOptions { limits: Some(limits), ..options.clone() })
}

/// Position, velocity and acceleration at the middle of three ticks, by central differences.
fn moving(before: &[f64], there: &[f64], after: &[f64], dt: f64) -> ArmState {
    let joints = || before.iter().zip(after).zip(there);
    ArmState {
        q: there.to_vec(),
        qd: joints().map(|((before, after), _)| (after - before) / (2.0 * dt)).collect(),
        qdd: joints().map(|((before, after), there)| (after - 2.0 * there + before) / (dt * dt)).collect(),
    }
}
