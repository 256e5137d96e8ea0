//! Batch solver, in the calling thread or on a pool.

use super::batch_options::{BatchOptions, OnInvalid};
use super::job::Job;
use super::pool;
use super::results::Batch;
use super::targets::Targets;
use crate::error::Result;
use crate::robot::Robot;
use crate::solver::{Monitor, Stopwatch};

/// Solves every target of `targets`. Item i is the solution of [`solve`](crate::ik::solve) with stream `first_row + i` of the
/// seed.
///
/// The monitor is called only from the calling thread.
///
/// # Errors
/// Any [`Error`](enum@crate::Error) for wrong input; [`Error::InRow`](crate::Error::InRow) for an invalid target or start,
/// unless invalid rows are skipped. A target that is not reached is a status, not an error.
pub fn solve_batch(
    robot: &Robot,
    targets: Targets<'_>,
    options: &BatchOptions<'_>,
    monitor: &mut dyn Monitor,
) -> Result<Batch> {
    let stopwatch = Stopwatch::start();
    let mut job = Job::new(robot, targets, options)?;
    let threads = pool::thread_count(options.threads)?;
    if options.on_invalid == OnInvalid::Raise {
        job.check_rows(monitor)?;
    }
    let mut batch = Batch::untouched(robot.dof(), targets.len());
    if threads == 1 || targets.len() <= 1 {
        job.run_here(&mut batch, monitor);
    } else {
        job.run_on(&*pool::pool(threads)?, &mut batch, monitor);
    }
    batch.elapsed = stopwatch.elapsed();
    Ok(batch)
}
