//! Reading of the arguments that `solve`, `solve_batch` and `solve_all` share.

use ikcore::ik::SolveOptions;
use ikcore::limits::Limits;
use ikcore::solver::Stop;
use pyo3::prelude::*;

use crate::convert::count;
use crate::error::raise;
use crate::goal::read_goals;
use crate::joint_order::joint_numbers;
use crate::obstacle::read_surroundings;
use crate::robot::PyRobot;
use crate::solver::{PyStop, any_solver};
use crate::tips::{Asked, TaskArguments, ToleranceArgument};

/// The arguments as passed from Python.
pub struct SolveArguments<'a, 'py> {
    pub task: Option<&'a Bound<'py, PyAny>>,
    pub solver: Option<&'a Bound<'py, PyAny>>,
    pub position_tolerance: &'a ToleranceArgument<'py>,
    pub rotation_tolerance: &'a ToleranceArgument<'py>,
    pub goals: Option<&'a Bound<'py, PyAny>>,
    pub prefer: &'a str,
    pub joint_weights: Option<&'a Bound<'py, PyAny>>,
    pub obstacles: Option<&'a Bound<'py, PyAny>>,
    pub margin: Option<f64>,
    pub self_collision: Option<bool>,
    pub stop: Option<&'a PyStop>,
    pub seed: i128,
}

impl SolveArguments<'_, '_> {
    /// Converts the arguments to options of the core for the targets `asked`, with the `start` and the `limits` of the
    /// call.
    pub fn read<T>(
        &self,
        robot: &PyRobot,
        asked: &Asked<T>,
        start: Option<Vec<f64>>,
        limits: Option<Limits>,
    ) -> PyResult<SolveOptions> {
        let Self { task, position_tolerance, rotation_tolerance, .. } = *self;
        let settings = TaskArguments { task, position_tolerance, rotation_tolerance }.read_for(robot, asked)?;
        let (task, tolerance) = settings.of_only(robot);
        Ok(SolveOptions {
            task,
            tips: settings.tasks(asked),
            tolerance,
            solver: self.solver.map(any_solver).transpose()?,
            goals: read_goals(self.goals)?,
            prefer: self.prefer.parse().map_err(raise)?,
            joint_weights: self
                .joint_weights
                .map(|weights| joint_numbers(&robot.core, "joint_weights", weights))
                .transpose()?,
            start,
            limits,
            surroundings: read_surroundings(robot, self.obstacles, self.margin, self.self_collision)?,
            stop: self.stop.map_or(Stop::default(), PyStop::core),
            seed: count("seed", self.seed)?,
            ..SolveOptions::default()
        })
    }
}
