//! Joint motions that move the tip along a straight line with constant orientation, from rest to rest.

use std::borrow::Cow;

use crate::error::Result;
use crate::math::cubic_spline::{CubicSpline, SplineEnds};
use crate::math::so3::norm;
use crate::math::vector::{distance, largest_difference};
use crate::math::vector3::direction;
use crate::objective::Linearization;
use crate::plan::configuration_at;
use crate::robot::Robot;
use crate::task::{Criterion, Target, Task, TaskKind, TipError};
use crate::timing::{ConstantLimits, scaled, unit_quintic};
use crate::trajectory::Trajectory;
use crate::wording::number;

/// Minimum and maximum number of intervals of the line between solved configurations; more where the tip leaves it in between.
const INTERVALS: [usize; 2] = [16, 128];
/// Distance of the tip from the line (m) and angle from its orientation (rad) between them.
const OFF_LINE: f64 = 1e-4;
/// Gauss-Newton steps for each configuration.
const STEPS: usize = 12;
/// Longest step of a joint (rad, m) between neighbouring configurations: a longer one is a jump to another branch.
const LONGEST: f64 = 0.5;
/// Inset of configurations from the limits, as a multiple of the excess of a joint that swings beyond a limit between
/// them.
const OVERSHOOT: f64 = 2.0;
/// Growth of that inset where it was too small.
const GROWTH: f64 = 4.0;
/// Largest distance from the limits (rad, m).
const LARGEST_INSET: f64 = 0.01;
/// Number of instants of each interval at which the distance from the line is measured.
const MEASURED: usize = 3;

/// Straight motions of the tip of an arm.
pub(super) struct StraightTip<'a> {
    bare: &'a Robot,
    /// The robot with the tool of the task, if there is one.
    robot: Cow<'a, Robot>,
    limits: &'a ConstantLimits,
    /// Task whose part of the orientation is kept.
    task: Option<Task>,
}

/// Reason, in words, why there is no motion along a line.
pub(super) type Hindrance = String;

impl<'a> StraightTip<'a> {
    /// # Errors
    /// As [`Task::robot`].
    pub(super) fn new(robot: &'a Robot, limits: &'a ConstantLimits, task: Option<Task>) -> Result<Self> {
        let with_tool = task.map_or(Ok(None), |task| task.robot(robot))?;
        Ok(Self { bare: robot, robot: with_tool.map_or(Cow::Borrowed(robot), Cow::Owned), limits, task })
    }

    /// The arm without the tool.
    pub(super) fn bare_robot(&self) -> &Robot {
        self.bare
    }

    /// The arm with the tool.
    pub(super) fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Returns the motion that begins at `q` (n,) and displaces the tip by `along` (m). `place` names the line in
    /// messages, as in "before it".
    ///
    /// # Errors
    /// Of the trajectory, none in practice.
    pub(super) fn from(&self, q: &[f64], along: [f64; 3], place: &str) -> Result<Result<Trajectory, Hindrance>> {
        let mut intervals = INTERVALS[0];
        let (mut inset, mut beyond) = (0.0, None);
        loop {
            let rows = match self.solved(q, along, intervals, (place, inset)) {
                Ok(rows) => rows,
                Err(hindrance) => return Ok(Err(beyond.unwrap_or(hindrance))),
            };
            let motion = scaled(&self.timed(&rows)?, self.limits)?;
            let violations = self.limits.violations(&motion);
            if let Some(violation) = violations.first() {
                let (excess, hindrance) =
                    (self.excess(q, &motion), beyond.get_or_insert_with(|| violation.to_string()));
                inset = (OVERSHOOT * excess).max(GROWTH * inset);
                if excess <= 0.0 || inset > LARGEST_INSET {
                    return Ok(Err(hindrance.clone()));
                }
                continue;
            }
            if self.is_straight(&motion, along, intervals)? {
                return Ok(Ok(motion));
            }
            intervals *= 2;
            if intervals > INTERVALS[1] {
                return Ok(Err("the tip cannot keep to the line".into()));
            }
        }
    }

    /// Largest excess of a joint over its position limits, or its start `q` outside them, between configurations (rad, m).
    fn excess(&self, q: &[f64], motion: &Trajectory) -> f64 {
        let ranges = motion.position_range().into_iter().enumerate();
        let of_joint = |(j, (low, high)): (usize, (f64, f64))| {
            (self.limits.lower[j].min(q[j]) - low).max(high - self.limits.upper[j].max(q[j]))
        };
        ranges.map(of_joint).fold(0.0, f64::max)
    }

    /// The target at a fraction of the line.
    fn target(&self, q: &[f64], along: [f64; 3], fraction: f64) -> Target {
        let mut frame = self.robot.tip(q);
        for (origin, along) in frame.origin.iter_mut().zip(along) {
            *origin += fraction * along;
        }
        match self.task.map(|task| task.kind) {
            Some(TaskKind::Position) => Target::Position(frame.origin),
            Some(TaskKind::Pointing { axis }) => Target::Pointing { frame, axis: direction(&axis) },
            _ => Target::Pose(frame),
        }
    }

    /// Configurations at even distances along the line, row by row; all but the first keep `inset` (rad, m) from the limits.
    fn solved(
        &self,
        q: &[f64],
        along: [f64; 3],
        intervals: usize,
        (place, inset): (&str, f64),
    ) -> Result<Vec<f64>, Hindrance> {
        let [mut lower, mut upper] = self.limits.inset_positions(inset);
        let mut rows = q.to_vec();
        let mut here = q.to_vec();
        let mut linearization = Linearization::default();
        for i in 1..=intervals {
            let fraction = i as f64 / intervals as f64;
            let target = self.target(q, along, fraction);
            let before = here.clone();
            // A joint that begins outside its limits may stay there, but goes no farther out.
            for j in (0..here.len()).filter(|j| here[*j] < self.limits.lower[*j] || here[*j] > self.limits.upper[*j]) {
                (lower[j], upper[j]) = (lower[j].min(here[j]), upper[j].max(here[j]));
            }
            let solved = linearization.project(&mut here, [&lower[..], &upper[..]], STEPS, |q, at| {
                let there = target.linearize(&self.robot, q, &Criterion::default(), &mut at.first);
                (!there.score.solved).then(|| at.least_damping(q.len()))
            });
            if !solved || largest_difference(&before, &here) > LONGEST {
                let at = number(fraction * norm(&along));
                return Err(format!(
                    "{at} m {place} the arm is singular, at its joint limits or at the edge of its reach"
                ));
            }
            rows.extend_from_slice(&here);
        }
        Ok(rows)
    }

    /// The motion through configurations at even distances: the distance follows a quintic in time.
    fn timed(&self, rows: &[f64]) -> Result<Trajectory> {
        let n = self.limits.dof();
        let intervals = rows.len() / n - 1;
        let breaks: Vec<f64> = (0..=intervals).map(|i| i as f64 / intervals as f64).collect();
        let spline = CubicSpline::over(breaks.clone(), SplineEnds::NotAKnot);
        let [mut q, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; rows.len()]);
        let [mut values, mut curvatures] = [(); 2].map(|()| vec![0.0; intervals + 1]);
        for j in 0..n {
            values.iter_mut().zip(rows.chunks_exact(n)).for_each(|(value, row)| *value = row[j]);
            spline.curvatures(&values, &mut curvatures);
            for (i, t) in breaks.iter().enumerate() {
                let [fraction, speed, acceleration] = unit_quintic(*t);
                let piece = ((fraction * intervals as f64) as usize).min(intervals - 1);
                let [c0, c1, c2, c3] = spline.piece(piece, &values, &curvatures).coefficients();
                let s = fraction - breaks[piece];
                let [slope, curvature] = [c1 + s * (2.0 * c2 + 3.0 * s * c3), 2.0 * c2 + 6.0 * s * c3];
                q[i * n + j] = c0 + s * (c1 + s * (c2 + s * c3));
                qd[i * n + j] = slope * speed;
                qdd[i * n + j] = slope * acceleration + curvature * speed * speed;
            }
        }
        // The ends exactly: the motion is joined to others there.
        q[..n].copy_from_slice(&rows[..n]);
        q[intervals * n..].copy_from_slice(&rows[intervals * n..]);
        Trajectory::from_samples(self.limits.joint_names(), &breaks, &q, Some(&qd), Some(&qdd))
    }

    /// Whether the tip keeps to the line between the configurations too.
    fn is_straight(&self, motion: &Trajectory, along: [f64; 3], intervals: usize) -> Result<bool> {
        let first = configuration_at(motion, 0.0)?;
        let length = norm(&along);
        let direction = along.map(|entry| entry / length);
        let begin = self.robot.tip(&first);
        let instants = MEASURED * intervals;
        for i in 0..=instants {
            let q = configuration_at(motion, motion.duration() * i as f64 / instants as f64)?;
            let tip = self.robot.tip(&q).origin;
            let travelled: f64 = (0..3).map(|k| (tip[k] - begin.origin[k]) * direction[k]).sum();
            let nearest: [f64; 3] = std::array::from_fn(|k| begin.origin[k] + travelled * direction[k]);
            let target = self.target(&first, along, travelled / length);
            let error = TipError::from(target.assess(&self.robot, &q, &Criterion::default()).error);
            if distance(&tip, &nearest) > OFF_LINE || error.rotation > OFF_LINE {
                return Ok(false);
            }
        }
        Ok(true)
    }
}
