//! Every way in which an arm can take its ends: pairs over all branches of inverse kinematics, at whole turns that are near.

use super::ends::{Pair, Search};
use crate::error::Result;
use crate::ik::{AllOptions, SolveOptions, bring_near, solve_all};
use crate::objective::{Bounds, Point};
use crate::planning::End;
use crate::solver::Monitor;

/// Configurations of an end at most: of an arm without self-motion that is all, of others a sample.
const BRANCHES: usize = 40;

impl Search<'_> {
    /// The `count` quickest pairs of any configurations of both ends, the quickest first.
    ///
    /// # Errors
    /// None for ends that have a configuration.
    pub(super) fn branches(&mut self, count: usize, monitor: &mut dyn Monitor) -> Result<Vec<Pair>> {
        let [starts, ends] = [self.configurations(0, monitor)?, self.configurations(1, monitor)?];
        let bounds = Bounds::from_ranges(self.limits.lower.iter().copied().zip(self.limits.upper.iter().copied()));
        let start_is_free = matches!(self.ends[0], End::Target(_));
        let mut pairs = Vec::with_capacity(starts.len() * ends.len());
        for start in &starts {
            for end in &ends {
                let (mut start, mut end) = (start.clone(), end.clone());
                match self.ends[1] {
                    End::Target(_) => bring_near(self.robot, &bounds, &start, &mut end),
                    End::Configuration(_) if start_is_free => bring_near(self.robot, &bounds, &end, &mut start),
                    End::Configuration(_) => {}
                }
                pairs.push(self.pair(start, end));
            }
        }
        pairs.sort_by(|one, other| one.duration.total_cmp(&other.duration));
        pairs.truncate(count);
        Ok(pairs)
    }

    fn configurations(&mut self, end: usize, monitor: &mut dyn Monitor) -> Result<Vec<Point>> {
        let target = match self.ends[end] {
            End::Configuration(q) => return Ok(vec![q.as_slice().into()]),
            End::Target(target) => target,
        };
        let each =
            SolveOptions { limits: Some(self.position_limits.clone()), seed: self.seed, ..SolveOptions::default() };
        let options = AllOptions { each, limit: BRANCHES, ..AllOptions::default() };
        let found = solve_all(self.robot, target, &options, monitor)?;
        self.evaluations += found.evaluations;
        Ok(found.solutions.into_iter().map(|solution| solution.q).collect())
    }
}
