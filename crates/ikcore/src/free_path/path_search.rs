//! The search for the best certified motion between pairs of clear configurations.

use super::certified_timing::{TimedPath, Timing};
use super::end_pair::EndPair;
use super::pair_search::PairSearch;
use super::refinement::{BlendedPath, PathMeasure};
use super::rrt_connect::{Connection, Route, TreeSearch};
use crate::error::Result;
use crate::objective::Point;
use crate::obstacle::ClearanceSweep;
use crate::plan::{Cost, Improvement, tip_travel_along};
use crate::rng::{self, LazyRng};
use crate::solver::{Monitor, Status};
use crate::trajectory::Trajectory;

/// Effort of the search before the first motion is taken.
struct Effort {
    /// Number of paths of which the cheapest is taken, the same number from each start ...
    paths: usize,
    /// ... as long as those after the first one cost no more configurations.
    more: usize,
    /// Number of changes tried on each.
    changes: usize,
}

/// Effort between two given configurations.
const QUICK: Effort = Effort { paths: 2, more: 2000, changes: 60 };
/// Effort where the ends leave a choice: finding them takes longer anyway.
const THOROUGH: Effort = Effort { paths: 4, more: 40_000, changes: 200 };
/// Number of shortcuts tried on each path.
const SHORTCUTS: usize = 20;
/// Maximum number of searches, each with more distance, where no path could be certified.
const ROUNDS: u32 = 4;

/// Distance that paths keep beyond the margin (m), since they are examined at closely spaced configurations alone, and corners are cut.
pub(super) const SEARCH_RESERVE: f64 = 1e-3;

/// The certified motion, or the status without one.
pub(super) enum Certified {
    /// The best motion, and the improvements that led to it.
    Motion(Trajectory, Vec<Improvement>),
    /// Status of a search without a motion.
    Nothing(Status),
}

/// The search.
pub(super) struct PathSearch<'s, 'a> {
    pub trees: &'s mut TreeSearch<'a>,
    pub sweep: &'s mut ClearanceSweep<'a>,
    pub search: &'s PairSearch<'a>,
    pub objective: Cost,
    /// Distance to keep (m).
    pub margin: f64,
    /// Largest distance beyond it that paths can keep (m): that of the ends.
    pub most: f64,
    /// Whether to go on until the budget is spent.
    pub improves: bool,
    /// Whether the ends leave a choice. Then any objective gets the same paths, so that none finds a better one for another.
    pub ends_are_free: bool,
}

/// Whether a search was stopped by the caller.
#[derive(PartialEq, Eq)]
enum Ended {
    Interrupted,
    Done,
}

/// The best certified motion so far.
#[derive(Default)]
pub(super) struct Best {
    found: Option<(f64, Trajectory)>,
    history: Vec<Improvement>,
}

impl Best {
    fn is_at_most(&self, cost: f64) -> bool {
        self.found.as_ref().is_some_and(|(least, _)| *least <= cost)
    }

    fn certified(self, status: Status) -> Certified {
        self.found.map_or(Certified::Nothing(status), |(_, motion)| Certified::Motion(motion, self.history))
    }
}

impl<'a> PathSearch<'_, 'a> {
    /// Returns the cheapest motion found: straight between the first pair of `open`, if that is clear; else the cheapest of the first
    /// clear straight motion and of several paths around obstacles from `starts`. `open` is sorted by the cost of the straight
    /// motions.
    pub(super) fn best(mut self, open: &[EndPair], starts: &[Point], monitor: &mut dyn Monitor) -> Result<Certified> {
        let mut best = Best::default();
        if self.first_straight(open, &mut best)? == Some(0) {
            return Ok(best.certified(Status::Solved));
        }
        let mut stream = 0;
        for round in 0..ROUNDS {
            let (candidates, ended) = self.candidates(open, starts, &mut stream, monitor)?;
            let any = !candidates.is_empty();
            self.keep_best(candidates, &mut best)?;
            let status = match ended {
                Ended::Interrupted => Some(Status::Interrupted),
                Ended::Done if best.found.is_some() => Some(Status::Solved),
                Ended::Done if !any => Some(Status::BudgetSpent),
                Ended::Done => None,
            };
            if let Some(status) = status {
                if status == Status::Solved && self.improves {
                    self.improve(open, starts, (&mut best, stream), monitor)?;
                }
                return Ok(best.certified(status));
            }
            let more = SEARCH_RESERVE * f64::from(2_u32.pow(round + 1));
            self.trees.check.clear.be_stricter(self.margin + more.min(self.most));
        }
        Ok(best.certified(Status::Stalled))
    }

    /// Keeps the first straight motion that is clear; returns the number of its pair.
    fn first_straight(&mut self, open: &[EndPair], best: &mut Best) -> Result<Option<usize>> {
        for (i, pair) in open.iter().enumerate() {
            if self.search.deadline.is_over() {
                break;
            }
            if self.trees.check.is_clear(&pair.start, &pair.end) {
                pair.require_motion()?;
                let line = TimedPath::new(pair.line(), vec![1.0; 2], self.search.limits)?;
                if let Some(motion) = self.timing().certified(line)? {
                    self.keep(motion, best);
                    return Ok(Some(i));
                }
            }
        }
        Ok(None)
    }

    /// Returns several timed paths, cheapest first. `stream` counts the streams of random numbers.
    fn candidates(
        &mut self,
        open: &[EndPair],
        starts: &[Point],
        stream: &mut u64,
        monitor: &mut dyn Monitor,
    ) -> Result<(Vec<(f64, TimedPath)>, Ended)> {
        let Effort { paths: count, more, changes } = if self.ends_are_free { THOROUGH } else { QUICK };
        let whole = self.trees.budget;
        let mut candidates = vec![];
        let mut ended = Ended::Done;
        for start in (0..count.div_ceil(starts.len())).flat_map(|_| starts) {
            *stream += 1;
            let mut rng = rng::stream(self.search.seed, *stream);
            match self.paths(open, (start, f64::INFINITY), &mut rng, monitor) {
                Ok(paths) => {
                    if candidates.is_empty() {
                        self.trees.budget = whole.min(self.trees.check.examined() + more);
                    }
                    let measure = self.measure();
                    for mut path in paths {
                        self.trees.refine(&mut path, (&measure, changes), &mut rng, monitor);
                        candidates.push(self.timed(path)?);
                    }
                }
                Err(Connection::Interrupted) => {
                    ended = Ended::Interrupted;
                    break;
                }
                Err(_) => break,
            }
        }
        self.trees.budget = whole;
        candidates.sort_by(|one, other| one.0.total_cmp(&other.0));
        Ok((candidates, ended))
    }

    /// A path from `start` to the end of any pair that shares it, shortened: by the length of its lines, and where it matters by the
    /// travel of the tip too. Places through which every motion costs more than `most` are left out.
    pub(super) fn paths(
        &mut self,
        open: &[EndPair],
        (start, most): (&Point, f64),
        rng: &mut LazyRng,
        monitor: &mut dyn Monitor,
    ) -> Result<Vec<BlendedPath>, Connection> {
        // Any of the ends will do. Their order is that of no objective.
        let mut sharing: Vec<&EndPair> = open.iter().filter(|pair| pair.start == *start).collect();
        sharing.sort_by(|one, other| one.duration.total_cmp(&other.duration));
        let ends: Vec<Vec<f64>> = sharing.into_iter().map(|pair| pair.end.to_vec()).collect();
        let measure = self.measure();
        let least = |q: &[f64]| {
            let to_end = ends.iter().map(|end| measure.least(q, end)).fold(f64::INFINITY, f64::min);
            measure.least(start, q) + to_end
        };
        let route = Route { start, ends: &ends, is_promising: &|q| least(q) <= most };
        let path = match self.trees.connect(&route, rng, monitor) {
            Connection::Found(path) => path,
            other => return Err(other),
        };
        let mut same = rng.clone();
        let mut paths = vec![self.trees.shorten(path.clone(), (&|_, _| true, SHORTCUTS), rng, monitor)];
        if self.ends_are_free || self.objective == Cost::TipTravel {
            // A line is the shortest way of the joints, and the quickest, but not of the tip.
            let travel = |points: &[Vec<f64>]| tip_travel_along(self.search.robot, points);
            let is_shorter = |old: &[Vec<f64>], new: &[Vec<f64>]| travel(new) <= travel(old);
            paths.push(self.trees.shorten(path, (&is_shorter, SHORTCUTS), &mut same, monitor));
        }
        Ok(paths.into_iter().map(|path| BlendedPath::new(path, &measure, &mut self.trees.check)).collect())
    }

    /// Measure by which paths are compared.
    pub(super) fn measure(&self) -> PathMeasure<'a> {
        let PairSearch { robot, limits, .. } = self.search;
        PathMeasure { robot, limits, objective: self.objective }
    }

    /// A timed path and its cost.
    fn timed(&self, BlendedPath { path, fractions, .. }: BlendedPath) -> Result<(f64, TimedPath)> {
        let timed = TimedPath::new(path, fractions, self.search.limits)?;
        Ok((self.objective.of(self.search.robot, &timed.motion), timed))
    }

    /// Keeps the best of `candidates` that can be certified; they are sorted by cost, which a certified motion may exceed.
    fn keep_best(&mut self, candidates: Vec<(f64, TimedPath)>, best: &mut Best) -> Result<()> {
        for (cost, timed) in candidates {
            if best.is_at_most(cost) {
                break;
            }
            if let Some(motion) = self.timing().certified(timed)? {
                self.keep(motion, best);
            }
        }
        Ok(())
    }

    fn keep(&mut self, motion: Trajectory, best: &mut Best) {
        let cost = self.objective.of(self.search.robot, &motion);
        if !best.is_at_most(cost) {
            best.history.push(Improvement { evaluations: self.search.evaluations + self.trees.check.examined(), cost });
            best.found = Some((cost, motion));
        }
    }

    /// Whether a path can be certified; keeps its motion if that is the best.
    pub(super) fn can_be_certified(&mut self, path: &BlendedPath, best: &mut Best) -> Result<bool> {
        let (_, timed) = self.timed(path.clone())?;
        let motion = self.timing().certified(timed)?;
        let is_certified = motion.is_some();
        motion.into_iter().for_each(|motion| self.keep(motion, best));
        Ok(is_certified)
    }

    fn timing(&mut self) -> Timing<'_, 'a> {
        let Self { trees, search, sweep, margin, .. } = self;
        let kept = trees.check.kept.as_mut();
        Timing { limits: search.limits, sweep, kept, margin: *margin, deadline: search.deadline }
    }
}
