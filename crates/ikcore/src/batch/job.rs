//! Work of a batch: rows, and the threads that solve groups of rows.
//!
//! Items share no mutable state: each draws from the stream of its row and writes to its own row. The bits of an item therefore
//! depend neither on the number of threads nor on the other items.

use std::borrow::Cow;

use rayon::ThreadPool;
use rayon::prelude::*;

use super::batch_options::BatchOptions;
use super::results::Batch;
use super::targets::Targets;
use super::workers;
use crate::error::{Error, Result};
use crate::ik::{Query, SolveContext, SolveReport, solve_query};
use crate::robot::Robot;
use crate::solver::{Monitor, Status, Stopwatch};
use crate::task::TargetRow;

/// Data shared by all threads.
pub(super) struct Job<'a> {
    context: SolveContext<'a>,
    targets: Targets<'a>,
    starts: Option<&'a [f64]>,
    common_start: Option<Vec<f64>>,
    first_row: usize,
    dof: usize,
    rows_are_checked: bool,
}

/// Rows checked between two polls of the monitor: about 100 microseconds.
const CHECKED_AT_ONCE: usize = 1024;

/// Targets that a thread takes at once, enough to make the overhead of scheduling negligible.
const GROUP: usize = 16;

impl<'a> Job<'a> {
    pub fn new(robot: &'a Robot, targets: Targets<'a>, options: &'a BatchOptions<'a>) -> Result<Self> {
        targets.require_even()?;
        let (dof, rows) = (robot.dof(), targets.len());
        if let Some(starts) = options.starts
            && starts.len() != rows * dof
        {
            let expected = format!("{} numbers, {rows} rows (one per target) of {dof} joints", rows * dof);
            return Err(Error::WrongLength { what: "starts".into(), expected, got: starts.len() });
        }
        if options.first_row > isize::MAX as usize {
            return Err(Error::out_of_range("first_row", "below 2^63", options.first_row as f64));
        }
        let context = SolveContext::new(robot, &options.each)?;
        let common_start = options.each.start.as_deref().map(|q| context.hint(q).map(Cow::into_owned)).transpose()?;
        context.require_reference(options.starts.or(common_start.as_deref()))?;
        let BatchOptions { starts, first_row, .. } = *options;
        Ok(Self { context, targets, starts, common_start, first_row, dof, rows_are_checked: false })
    }

    /// Checks all rows before any is solved.
    pub fn check_rows(&mut self, monitor: &mut dyn Monitor) -> Result<()> {
        for row in 0..self.targets.len() {
            if row.is_multiple_of(CHECKED_AT_ONCE) && !monitor.keep_going() {
                return Ok(());
            }
            self.check(row).map_err(|error| Error::InRow { row: self.first_row + row, error: Box::new(error) })?;
        }
        self.rows_are_checked = true;
        Ok(())
    }

    fn check(&self, i: usize) -> Result<()> {
        self.targets.check(i)?;
        if i == 0 || matches!(self.targets, Targets::Tips(_)) {
            // Checks that the task supports this kind of target, and that targets of several tips agree.
            self.context.reduce(&mut self.targets.read(i))?;
        }
        self.own_start(i).map_or(Ok(()), |start| self.context.check_hint(start))
    }

    /// Returns target `i` and its start, validated.
    fn read(&self, i: usize) -> Result<(TargetRow, Option<Cow<'_, [f64]>>)> {
        if !self.rows_are_checked {
            self.check(i)?;
        }
        let mut targets = self.targets.read(i);
        self.context.reduce(&mut targets)?;
        let own = self.own_start(i).map(|start| self.context.hint(start)).transpose()?;
        Ok((targets, own.or_else(|| self.common_start.as_deref().map(Cow::Borrowed))))
    }

    /// Start given for target `i` alone.
    fn own_start(&self, i: usize) -> Option<&'a [f64]> {
        self.starts.map(|starts| &starts[i * self.dof..(i + 1) * self.dof])
    }

    /// Solves the targets from index `first` on, one per entry of `items`, and calls `done` after each.
    fn solve_rows(
        &self,
        first: usize,
        qs: &mut [f64],
        items: &mut [SolveReport],
        monitor: &mut dyn Monitor,
        mut done: impl FnMut(&mut dyn Monitor),
    ) {
        // Polls here too, since solves may be too short to poll.
        if !monitor.keep_going() {
            return;
        }
        // One clock reading per target: each target starts when the previous one ends.
        let mut stopwatch = Stopwatch::start();
        for ((row, item), q) in items.iter_mut().enumerate().zip(qs.chunks_mut(self.dof)) {
            *item = match self.read(first + row) {
                Err(_) => SolveReport::unsolved(Status::Invalid),
                Ok((targets, start)) => {
                    let start = start.as_deref();
                    let query =
                        Query { targets: &targets, start, stream: (self.first_row + first + row) as u64, stopwatch };
                    let solution = solve_query(&self.context, &query, monitor);
                    q.copy_from_slice(&solution.q);
                    stopwatch = stopwatch.started_later(solution.elapsed);
                    solution.report
                }
            };
            done(monitor);
        }
    }

    pub fn run_here(&self, batch: &mut Batch, monitor: &mut dyn Monitor) {
        let (mut done, total) = (0, batch.items.len());
        let groups = batch.q.chunks_mut(GROUP * self.dof).zip(batch.items.chunks_mut(GROUP)).enumerate();
        for (i, (qs, items)) in groups {
            self.solve_rows(i * GROUP, qs, items, monitor, |monitor| {
                done += 1;
                monitor.progress(done, total);
            });
        }
    }

    pub fn run_on(&self, pool: &ThreadPool, batch: &mut Batch, monitor: &mut dyn Monitor) {
        let total = batch.items.len();
        let groups = batch.q.par_chunks_mut(GROUP * self.dof).zip(batch.items.par_chunks_mut(GROUP)).enumerate();
        workers::run_on(pool, total, monitor, |shared| {
            groups.for_each(|(i, (qs, items))| {
                self.solve_rows(i * GROUP, qs, items, &mut shared.monitor(), |_| shared.count(1));
            });
        });
    }
}
