//! Configurations of an end of a motion, as a function of the parameters that a search chooses.

use std::f64::consts::PI;

use crate::error::{Error, Result};
use crate::ik::{Query, Solution, SolveContext, SolveOptions, solve_query};
use crate::math::vector::largest_difference;
use crate::plan::{ELBOW_LINKS, Elbow, Endpoint, PlanarArm, PlanarTarget};
use crate::rng;
use crate::robot::Robot;
use crate::solver::{Monitor, Status, Stopwatch};
use crate::task::Target;
use crate::timing::ConstantLimits;

/// The configurations of one end.
#[derive(Debug, Clone)]
pub(super) enum EndConfigurations {
    /// A single configuration.
    Fixed(Vec<f64>),
    /// A planar arm: the absolute orientations phi of the links from the third on are free.
    Planar {
        /// The arm.
        arm: PlanarArm,
        /// The target of its tip.
        place: PlanarTarget,
        /// Elbow of the arm.
        elbow: Elbow,
    },
    /// Any arm: one of these configurations, found by inverse kinematics and ordered so that similar ones are
    /// neighbours.
    OneOf(Vec<Vec<f64>>),
}

/// Random starts of the inverse kinematics that fills [`EndConfigurations::OneOf`].
const STARTS: usize = 48;

/// Failed starts after which a target counts as out of reach; each is itself a multi-start search.
const FUTILE_STARTS: usize = 3;

/// Solutions nearer to each other than this in every joint count as one (rad or m).
const DISTINCT: f64 = 1e-3;

impl EndConfigurations {
    /// The configurations of `end`; `what` names it in errors.
    ///
    /// # Errors
    /// [`Error::OutsideLimits`] for a configuration outside its limits, [`Error::Unreachable`] for a target out of
    /// reach.
    pub(super) fn new(
        what: &str,
        end: &Endpoint,
        robot: &Robot,
        limits: &ConstantLimits,
        elbow: Elbow,
        seed: u64,
        monitor: &mut dyn Monitor,
    ) -> Result<Self> {
        let target = match end {
            Endpoint::Configuration(q) => return Ok(Self::Fixed(q.clone())),
            Endpoint::Targets { targets, .. } => &targets[0],
        };
        if let Some((arm, place)) = planar(robot, target) {
            if let Some(problem) = arm.problem(&place) {
                return Err(Error::Unreachable { what: what.into(), problem: problem.into() });
            }
            return Ok(Self::Planar { arm, place, elbow });
        }
        solutions(what, target, &limits.applied_to(robot)?, seed, monitor).map(Self::OneOf)
    }

    /// Number of parameters.
    pub(super) fn dimension(&self) -> usize {
        match self {
            Self::Fixed(_) => 0,
            Self::Planar { arm, place, .. } => arm.dof() - ELBOW_LINKS - usize::from(place.orientation.is_some()),
            Self::OneOf(solutions) => usize::from(solutions.len() > 1),
        }
    }

    /// The range of each parameter.
    pub(super) fn range(&self) -> (f64, f64) {
        match self {
            Self::Fixed(_) | Self::Planar { .. } => (-PI, PI),
            Self::OneOf(_) => (0.0, 1.0),
        }
    }

    /// Writes the configuration of these parameters.
    ///
    /// # Errors
    /// The infeasible cosine of eq. (1), if a planar arm has no solution for these parameters.
    pub(super) fn configuration(&self, parameters: &[f64], q: &mut [f64]) -> Result<(), f64> {
        match self {
            Self::Fixed(fixed) => q.copy_from_slice(fixed),
            Self::Planar { arm, place, elbow } => match place.orientation {
                None => arm.solve(place.position, parameters, *elbow, q)?,
                Some(orientation) => {
                    let mut orientations = crate::objective::Point::from_slice(parameters);
                    orientations.push(orientation);
                    arm.solve(place.position, &orientations, *elbow, q)?;
                }
            },
            Self::OneOf(solutions) => {
                let fraction = parameters.first().copied().unwrap_or_default();
                let index = ((fraction * solutions.len() as f64) as usize).min(solutions.len() - 1);
                q.copy_from_slice(&solutions[index]);
            }
        }
        Ok(())
    }
}

/// Returns the planar arm and its target if the closed form applies.
fn planar(robot: &Robot, target: &Target) -> Option<(PlanarArm, PlanarTarget)> {
    let arm = PlanarArm::of(robot)?;
    let place = arm.planar_target(target)?;
    (arm.dof() >= ELBOW_LINKS + usize::from(place.orientation.is_some())).then_some((arm, place))
}

/// Returns distinct solutions for `target`, each followed by the nearest of the remaining ones.
fn solutions(
    what: &str,
    target: &Target,
    robot: &Robot,
    seed: u64,
    monitor: &mut dyn Monitor,
) -> Result<Vec<Vec<f64>>> {
    let options = SolveOptions { seed, ..SolveOptions::default() };
    let context = SolveContext::new(robot, &options)?;
    let starts = robot.random_configurations(STARTS, &mut rng::stream(seed, 0))?;
    let mut found: Vec<Vec<f64>> = vec![];
    let mut nearest: Option<Solution> = None;
    for (i, start) in starts.chunks_exact(robot.dof()).enumerate() {
        let query = Query {
            targets: std::slice::from_ref(target),
            start: Some(start),
            stream: i as u64 + 1,
            stopwatch: Stopwatch::start(),
        };
        let solution = solve_query(&context, &query, monitor);
        if solution.status == Status::Solved {
            if found.iter().all(|other| largest_difference(other, &solution.q) > DISTINCT) {
                found.push(solution.q.to_vec());
            }
        } else if nearest.is_none() {
            nearest = Some(solution);
        }
        if found.is_empty() && i + 1 == FUTILE_STARTS {
            break;
        }
    }
    match nearest {
        Some(missed) if found.is_empty() => {
            let problem = format!("the nearest that the tip came is {} away", missed.error);
            Err(Error::Unreachable { what: what.into(), problem: problem.into() })
        }
        _ => Ok(chained(found)),
    }
}

/// Orders by nearest neighbours, so that similar parameters mean similar configurations.
fn chained(mut rest: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let mut chain: Vec<Vec<f64>> = rest.pop().into_iter().collect();
    while let Some(last) = chain.last() {
        let next = (0..rest.len())
            .min_by(|i, j| largest_difference(last, &rest[*i]).total_cmp(&largest_difference(last, &rest[*j])));
        match next {
            Some(next) => chain.push(rest.swap_remove(next)),
            None => break,
        }
    }
    chain
}
