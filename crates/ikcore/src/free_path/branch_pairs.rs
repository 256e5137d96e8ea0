//! Pairs of all inverse kinematics branches of both ends; joints are shifted by whole turns to be nearest to the other
//! end.

use super::end_pair::EndPair;
use super::pair_search::PairSearch;
use crate::error::Result;
use crate::ik::{AllOptions, SolveOptions, bring_near, solve_all};
use crate::objective::{Bounds, Point};
use crate::plan::Endpoint;
use crate::solver::Monitor;

/// Maximum number of configurations of an end: all of them for a non-redundant arm, a sample for others.
const BRANCHES: usize = 40;

impl PairSearch<'_> {
    /// Returns the `count` quickest pairs of configurations of the start and of end `chosen`, the quickest first.
    ///
    /// # Errors
    /// None if both ends have a configuration.
    pub(super) fn branches(&mut self, chosen: usize, count: usize, monitor: &mut dyn Monitor) -> Result<Vec<EndPair>> {
        let (given_start, given_end) = (self.start, &self.ends[chosen]);
        let starts = self.configurations(given_start, monitor)?;
        let ends = self.configurations(given_end, monitor)?;
        let bounds = Bounds::from_ranges(self.limits.lower.iter().copied().zip(self.limits.upper.iter().copied()));
        let start_is_free = matches!(given_start, Endpoint::Targets { .. });
        let mut pairs = Vec::with_capacity(starts.len() * ends.len());
        for start in &starts {
            for end in &ends {
                let (mut start, mut end) = (start.clone(), end.clone());
                match given_end {
                    Endpoint::Targets { .. } => bring_near(self.robot, &bounds, &start, &mut end),
                    Endpoint::Configuration(_) if start_is_free => bring_near(self.robot, &bounds, &end, &mut start),
                    Endpoint::Configuration(_) => {}
                }
                pairs.push(self.pair(start, end, chosen));
            }
        }
        pairs.sort_by(|one, other| one.duration.total_cmp(&other.duration));
        pairs.truncate(count);
        Ok(pairs)
    }

    fn configurations(&mut self, end: &Endpoint, monitor: &mut dyn Monitor) -> Result<Vec<Point>> {
        let target = match end {
            Endpoint::Configuration(q) => return Ok(vec![q.as_slice().into()]),
            Endpoint::Targets { targets, .. } => &targets[0],
        };
        let each = SolveOptions { whole_only: true, ..self.solve_options() };
        let options = AllOptions { each, limit: Some(BRANCHES), redundancy: 0, ..AllOptions::default() };
        let found = solve_all(self.robot, target, &options, monitor)?;
        self.evaluations += found.evaluations;
        Ok(found.solutions.iter().map(|solution| Point::from_slice(solution.q)).collect())
    }
}
