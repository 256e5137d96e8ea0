//! Batch planning of motions from point to point.

use std::sync::Arc;

use rayon::prelude::*;

use super::monitors::Quiet;
use super::{pool, workers};
use crate::error::{Error, Result};
use crate::planning::{Endpoint, Plan, PointToPointOptions, check_point_to_point, plan_point_to_point};
use crate::robot::Robot;
use crate::solver::{Monitor, Status};

/// Arguments of one [`plan_point_to_point`].
#[derive(Debug, Clone)]
pub struct PlanProblem {
    /// Start of the motion.
    pub start: Endpoint,
    /// Possible ends of the motion.
    pub ends: Vec<Endpoint>,
    /// Options, which problems may share.
    pub options: Arc<PointToPointOptions>,
}

/// Plans all `problems`. Item i is the result of [`plan_point_to_point`] for problem i, independent of the other problems and
/// of the number of threads (`None` means one per core).
///
/// The monitor is called only from the calling thread. Problems left undone after an interruption are [`Error::Interrupted`].
///
/// # Errors
/// [`Error::InProblem`] for wrong input of a problem, before any is planned; [`Error::OutOfRange`] or [`Error::NoThreads`] for
/// the threads. Errors of a planner, for example [`Error::Unreachable`], are the result of their problem only.
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
            shared.count(1);
            result
        });
        each.collect_into_vec(&mut results);
    });
    Ok(results)
}

/// Status at the end of the planning of a problem.
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
