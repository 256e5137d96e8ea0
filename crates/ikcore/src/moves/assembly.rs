//! The motion of a whole program, step by step.

use super::ladder::Rung;
use super::outline::Step;
use super::program::Move;
use super::report::{bounds_on, speed_on, tip_speed};
use super::timing::{PathTime, path_times, time_at, timed};
use super::tool_path::ToolPath;
use crate::error::{Error, Result};
use crate::math::vector::largest_difference;
use crate::plan::MoveReport;
use crate::robot::Robot;
use crate::timing::{ConstantLimits, JointPath, time_all};
use crate::trajectory::{Trajectory, polynomial};

/// Joint difference (rad, m) below which a joint move does not move.
const NOTHING: f64 = 1e-9;

/// The motion so far, and its moves.
pub(super) struct Assembly<'a> {
    robot: &'a Robot,
    limits: &'a ConstantLimits,
    moves: &'a [Move],
    /// Configuration at the end.
    q: Vec<f64>,
    motion: Option<Trajectory>,
    reports: Vec<MoveReport>,
}

impl<'a> Assembly<'a> {
    pub fn new(robot: &'a Robot, limits: &'a ConstantLimits, moves: &'a [Move], start: &[f64]) -> Self {
        Self { robot, limits, moves, q: start.to_vec(), motion: None, reports: vec![] }
    }

    /// Adds all steps: joint moves to the starts of `rungs` but the first, and the joint `paths` of the moves of the tip.
    ///
    /// # Errors
    /// Those of timings.
    pub fn add_all(&mut self, steps: &[Step], rungs: &[Rung], paths: Vec<JointPath>) -> Result<()> {
        let (mut starts, mut paths) = (rungs.iter().skip(1), paths.into_iter());
        for step in steps {
            match step {
                Step::Rest(index, seconds) => self.rest(*index, *seconds)?,
                Step::Joints(index) => {
                    if let Some(rung) = starts.next() {
                        self.joint_move(*index, &rung.q)?;
                    }
                }
                Step::Along(tool_path) => {
                    if let Some(path) = paths.next() {
                        self.along(tool_path, &path)?;
                    }
                }
            }
        }
        Ok(())
    }

    /// The motion and the reports of its moves.
    ///
    /// # Errors
    /// [`Error::InvalidMove`] if nothing moves and nothing takes time.
    pub fn finish(self) -> Result<(Trajectory, Vec<MoveReport>)> {
        let still = || Error::InvalidMove {
            what: "the program".into(),
            problem: "it takes no time: all its moves end where the arm is".into(),
        };
        Ok((self.motion.ok_or_else(still)?, self.reports))
    }

    fn now(&self) -> f64 {
        self.motion.as_ref().map_or(0.0, Trajectory::duration)
    }

    fn push(&mut self, next: Trajectory) -> Result<()> {
        self.q = next.end();
        self.motion = Some(match self.motion.take() {
            None => next,
            Some(motion) => motion.then(&next, 0.0)?,
        });
        Ok(())
    }

    fn report(&mut self, index: usize, start: f64, speed: f64) {
        let name = self.moves[index].name.clone();
        self.reports.push(MoveReport { name, start, end: self.now(), speed, bound_by: vec![] });
    }

    fn rest(&mut self, index: usize, seconds: f64) -> Result<()> {
        let start = self.now();
        if seconds > 0.0 {
            let still = self.q.iter().map(|q| polynomial([*q])).collect();
            self.push(Trajectory::new(self.limits.joint_names(), vec![0.0, seconds], still)?)?;
        }
        self.report(index, start, 0.0);
        Ok(())
    }

    fn joint_move(&mut self, index: usize, to: &[f64]) -> Result<()> {
        if largest_difference(&self.q, to) <= NOTHING {
            return self.rest(index, 0.0);
        }
        let start = self.now();
        let ends = [&self.q[..], to].concat();
        let line = JointPath::polyline(self.limits.joint_names(), &ends, 0.0)?;
        let motion = time_all(&[line], self.limits)?;
        let speed = tip_speed(self.robot, &motion)?;
        self.push(motion)?;
        self.report(index, start, speed);
        Ok(())
    }

    fn along(&mut self, tool_path: &ToolPath, path: &JointPath) -> Result<()> {
        let begin = self.now();
        let motion = timed(path, self.limits)?;
        let times: Vec<PathTime> = path_times(path, &motion)?;
        let mut start = begin;
        for (index, s) in tool_path.ends_of_moves() {
            let end = if s < tool_path.length() { begin + time_at(&times, s) } else { begin + motion.duration() };
            self.reports.push(MoveReport {
                name: self.moves[index].name.clone(),
                start,
                end,
                speed: speed_on(tool_path, index, &times),
                bound_by: bounds_on(tool_path, index, (&motion, &times, begin), self.limits),
            });
            start = end;
        }
        self.push(motion)
    }
}
