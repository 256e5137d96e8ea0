//! Improvement of a plan until the budget is spent.

use super::end_pair::EndPair;
use super::path_search::{Best, PathSearch};
use super::refinement::BlendedPath;
use crate::error::Result;
use crate::objective::Point;
use crate::rng::{self, LazyRng};
use crate::solver::Monitor;

/// Number of changes after which a path is judged again.
const CHANGES: usize = 200;
/// Cost relative to the best at which a new path is dropped, after each number of refinements.
const WORTHWHILE: [f64; 5] = [1.2, 1.17, 1.14, 1.11, 1.08];
/// First stream of random numbers that no path search draws from.
const STREAM: u64 = 1 << 32;

impl PathSearch<'_, '_> {
    /// Searches for more paths, refines those that are nearly as good as the best one, and that one further. `stream` is the last
    /// stream of random numbers in use.
    pub(super) fn improve(
        &mut self,
        open: &[EndPair],
        starts: &[Point],
        (best, mut stream): (&mut Best, u64),
        monitor: &mut dyn Monitor,
    ) -> Result<()> {
        let mut incumbent: Option<BlendedPath> = None;
        let mut rng = rng::stream(self.search.seed, STREAM);
        for start in starts.iter().cycle() {
            stream += 1;
            let most = incumbent.as_ref().map_or(f64::INFINITY, |path| path.cost);
            let mut drawn = rng::stream(self.search.seed, stream);
            let Ok(paths) = self.paths(open, (start, most), &mut drawn, monitor) else { break };
            for mut path in paths {
                let is_better = self.overtakes(&mut path, incumbent.as_ref(), &mut rng, monitor);
                if is_better && self.can_be_certified(&path, best)? {
                    incumbent = Some(path);
                }
            }
            if let Some(path) = &mut incumbent {
                let mut refined = path.clone();
                let measure = self.measure();
                self.trees.refine(&mut refined, (&measure, CHANGES), &mut rng, monitor);
                if refined.cost < path.cost && self.can_be_certified(&refined, best)? {
                    *path = refined;
                }
            }
            monitor.progress(self.trees.check.examined(), self.trees.budget);
        }
        Ok(())
    }

    /// Refines a path as long as it is worthwhile; returns whether it is better than the best one in the end.
    fn overtakes(
        &mut self,
        path: &mut BlendedPath,
        incumbent: Option<&BlendedPath>,
        rng: &mut LazyRng,
        monitor: &mut dyn Monitor,
    ) -> bool {
        let (measure, least) = (self.measure(), incumbent.map_or(f64::INFINITY, |path| path.cost));
        for more in WORTHWHILE {
            self.trees.refine(path, (&measure, CHANGES), rng, monitor);
            if path.cost > more * least {
                return false;
            }
        }
        path.cost < least
    }
}
