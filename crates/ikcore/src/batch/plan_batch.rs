//! Many motions from point to point.

use std::sync::Arc;

use rayon::prelude::*;

use super::monitors::Quiet;
use super::{pool, workers};
use crate::error::{Error, Result};
use crate::planning::{Endpoint, Plan, PointToPointOptions, check_point_to_point, plan_point_to_point};
use crate::robot::Robot;
use crate::solver::{Monitor, Status};

/// The arguments of one [`plan_point_to_point`].
#[derive(Debug, Clone)]
pub struct PlanProblem {
    /// The start.
    pub start: Endpoint,
    /// The possible ends.
    pub ends: Vec<Endpoint>,
    /// The options, which problems may share.
    pub options: Arc<PointToPointOptions>,
}

/// Plans all `problems`; item i is the result of [`plan_point_to_point`] for problem i, whatever the others are and however
/// many threads there are (`None`: one per core).
///
/// The monitor is called only from the calling thread. Problems that it leaves undone are [`Error::Interrupted`].
///
/// # Errors
/// [`Error::InProblem`] for wrong input of a problem, before any is planned; [`Error::OutOfRange`] or [`Error::NoThreads`] for
/// the threads. What only a planner finds out, such as [`Error::Unreachable`], is the result of its problem alone.
pub fn plan_batch(
    robot: &Robot,
    problems: &[PlanProblem],
    threads: Option<usize>,
    monitor: &mut dyn Monitor,
) -> Result<Vec<Result<Plan>>> {
    let threads = pool::thread_count(threads)?;
    for (index, PlanProblem { start, ends, options }) in problems.iter().enumerate() {
        check_point_to_point(robot, start, ends, options)
            .map_err(|error| Error::InProblem { index, error: Box::new(error) })?;
    }
    let planned = |problem: &PlanProblem, monitor: &mut dyn Monitor| {
        if !monitor.keep_going() {
            return Err(Error::Interrupted);
        }
        plan_point_to_point(robot, &problem.start, &problem.ends, &problem.options, monitor)
    };
    if threads == 1 || problems.len() <= 1 {
        let each = problems.iter().zip(1..).map(|(problem, done)| {
            let result = planned(problem, &mut Quiet(monitor));
            monitor.progress(done, problems.len());
            result
        });
        return Ok(each.collect());
    }
    let mut results = vec![];
    workers::run_on(&*pool::pool(threads)?, problems.len(), monitor, |shared| {
        let each = problems.par_iter().with_max_len(1).map(|problem| {
            let result = shared.interruptible(|| planned(problem, &mut shared.monitor()));
            shared.count();
            result
        });
        each.collect_into_vec(&mut results);
    });
    Ok(results)
}

/// How the planning of a problem ended.
pub fn plan_status(result: &Result<Plan>) -> Status {
    match result {
        Ok(plan) => plan.status,
        Err(Error::Interrupted) => Status::Interrupted,
        Err(Error::Unreachable { .. } | Error::NoUsableEnd { .. }) => Status::OutOfReach,
        Err(Error::NotFound { .. }) => Status::Stalled,
        Err(Error::InCollision { .. }) => Status::InCollision,
        Err(_) => Status::Invalid,
    }
}
