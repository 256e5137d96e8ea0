//! Nominal motions to search around: from a few starts, each follows the path from point to point.

use super::elastic_band::ElasticBand;
use super::interpolation::JointWaypoints;
use super::null_space_offsets::travel;
use super::path_problem::PathProblem;
use super::path_walk::{PathWalk, WalkAim};
use super::projection::Projection;
use crate::along_path::open_turns::OpenTurns;
use crate::along_path::tip_path::PathTarget;
use crate::error::Result;
use crate::ik::{AllOptions, SolveOptions, solve_all};
use crate::interrupt::checkpoint;
use crate::math::vector::largest_difference;
use crate::rng;
use crate::solver::Unattended;
use crate::task::Target;

/// Intervals between the points of a motion, apart from corners: half of the published planner's.
const INTERVALS: usize = 25;

/// Starts tried.
const STARTS: usize = 16;

/// Parts of the tolerance band that a motion may use (m, rad): a wide one is not always used well.
const RUNGS: [f64; 4] = [1e-2, 1e-3, 1e-4, 0.0];

/// Values of the redundancy at which the closed form gives further starts.
const REDUNDANCY: usize = 4;

/// Maximum number of motions kept: the shortest is not always the fastest.
const BRANCHES: usize = 8;
/// Smallest distance between the starts or ends of two of them (rad, m).
const APART: f64 = 0.5;

/// Difference below which motions are the same (rad, m).
const SAME: f64 = 1e-6;

/// Curve that a motion follows.
#[derive(Debug, Clone, Copy)]
enum Leading {
    /// The path itself.
    OnPath,
    /// The path, displaced as the start is.
    InParallel,
    /// The nearest pose within the tolerance band.
    WithinTolerance,
    /// The path, including the parts of its poses that the task ignores.
    WholePose,
}

/// A motion to search around.
pub(super) struct NominalMotion {
    pub waypoints: JointWaypoints,
    /// The unshortened motion, if it and its shortenings within parts of the tolerance band are not tried yet.
    pub base: Option<JointWaypoints>,
}

impl NominalMotion {
    fn whole(waypoints: JointWaypoints) -> Self {
        Self { waypoints, base: None }
    }
}

/// Search for nominal motions.
pub(super) struct NominalMotions<'a> {
    problem: &'a PathProblem<'a>,
    projection: Projection<'a>,
    /// Whether the last walk came to a fork, and whether any did.
    forks: bool,
    has_forked: bool,
}

impl<'a> NominalMotions<'a> {
    pub fn new(problem: &'a PathProblem<'a>) -> Self {
        Self { problem, projection: Projection::new(&problem.robot, problem.keeps), forks: false, has_forked: false }
    }

    /// Returns the shortest motions that follow the path, each shortened within the tolerance band; the first also
    /// within parts of the band and unshortened; and motions that keep the parts of the poses that the task ignores.
    /// Empty if each ends on the way.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted).
    pub fn all(&mut self) -> Result<Vec<NominalMotion>> {
        let PathProblem { tip_path, options, .. } = self.problem;
        if let Some(start) = &options.start {
            return self.begun_at(start).map_or(Ok(vec![]), |nominal| self.shortened(nominal, false));
        }
        let mut bases = self.shortest(Leading::OnPath)?;
        let mut has_parts = true;
        if bases.is_empty() && tip_path.has_tolerance() {
            (bases, has_parts) = (self.shortest(Leading::WithinTolerance)?, false);
        }
        let mut bases = bases.into_iter();
        let mut motions = bases.next().map_or(Ok(vec![]), |base| self.shortened(base, has_parts))?;
        for base in bases {
            let waypoints = self.tightened(base.clone(), f64::INFINITY)?;
            motions.push(NominalMotion { waypoints, base: Some(base).filter(|_| has_parts) });
        }
        if tip_path.ignores_a_part() {
            motions.extend(self.shortest(Leading::WholePose)?.into_iter().map(NominalMotion::whole));
        }
        Ok(motions)
    }

    /// Returns a motion shortened within parts of the tolerance band, and as it is.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted).
    pub fn within_parts(&mut self, base: JointWaypoints) -> Result<Vec<NominalMotion>> {
        let mut motions = vec![];
        for most in RUNGS.into_iter().filter(|most| *most < self.problem.tip_path.largest_tolerance()) {
            motions.push(NominalMotion::whole(self.tightened(base.clone(), most)?));
        }
        motions.push(NominalMotion::whole(base));
        Ok(motions)
    }

    /// Returns a motion shortened within the tolerance band and, if that changes it, within `parts` of the band and as it is.
    fn shortened(&mut self, nominal: JointWaypoints, parts: bool) -> Result<Vec<NominalMotion>> {
        let widest = self.tightened(nominal.clone(), f64::INFINITY)?;
        let is_shorter = largest_difference(&widest.rows, &nominal.rows) > SAME;
        let mut motions = vec![NominalMotion::whole(widest)];
        match (is_shorter, parts) {
            (false, _) => {}
            (true, false) => motions.push(NominalMotion::whole(nominal)),
            (true, true) => motions.extend(self.within_parts(nominal)?),
        }
        Ok(motions)
    }

    /// Returns a motion shortened within the tolerance band, or `most` of it (m, rad).
    fn tightened(&mut self, mut nominal: JointWaypoints, most: f64) -> Result<JointWaypoints> {
        let PathProblem { tip_path, options, .. } = self.problem;
        let due = |knot: &f64| tip_path.path_target(*knot).at_most(most);
        let targets: Vec<PathTarget> = nominal.knots.iter().map(due).collect();
        let starts_as_given = options.start.is_some();
        ElasticBand { projection: &mut self.projection, targets: &targets, starts_as_given }.tighten(&mut nominal)?;
        Ok(nominal)
    }

    /// Returns the motions of least joint travel from several starts, each on another branch.
    fn shortest(&mut self, leading: Leading) -> Result<Vec<JointWaypoints>> {
        let PathProblem { robot, tip_path, options, .. } = self.problem;
        let mut starts = robot.random_configurations(STARTS, &mut rng::stream(options.seed, 0))?;
        starts.extend(self.branches(0.0)?);
        // Starts midway too: where the path begins at a singularity, the closed form returns one configuration of a family.
        let knots = tip_path.knots(INTERVALS);
        let middle = knots[knots.len() / 2];
        let midway = self.branches(middle)?;
        let mut found: Vec<(f64, JointWaypoints)> = vec![];
        let mut add = |start: (f64, &[f64])| -> Result<()> {
            checkpoint()?;
            let passes = |motion: &JointWaypoints| {
                let knot = motion.knots.iter().position(|knot| *knot == start.0);
                knot.is_some_and(|i| largest_difference(motion.row(i), start.1) < SAME)
            };
            if self.has_forked || !found.iter().any(|(_, motion)| passes(motion)) {
                let motions = self.each_way(start, leading);
                found.extend(motions.map(|motion| (travel(&motion.rows, robot.dof()), motion)));
            }
            Ok(())
        };
        starts.chunks_exact(robot.dof()).try_for_each(|start| add((0.0, start)))?;
        midway.chunks_exact(robot.dof()).try_for_each(|start| add((middle, start)))?;
        found.sort_by(|one, other| one.0.total_cmp(&other.0));
        Ok(self.different(found.into_iter().map(|(_, motion)| motion)))
    }

    /// Returns the first motions whose ends are apart by more than whole turns.
    fn different(&self, motions: impl Iterator<Item = JointWaypoints>) -> Vec<JointWaypoints> {
        let turns = OpenTurns { robot: &self.problem.robot, limits: &self.projection.bounds };
        let mut kept: Vec<JointWaypoints> = vec![];
        for motion in motions {
            let is_same = |other: &JointWaypoints| {
                let ends = [(0, 0), (motion.knots.len() - 1, other.knots.len() - 1)];
                let is_near = |one: &[f64], other: &[f64]| {
                    largest_difference(one, other) < APART || turns.difference(one, other) < SAME
                };
                ends.into_iter().all(|(i, k)| is_near(motion.row(i), other.row(k)))
            };
            if kept.len() < BRANCHES && !kept.iter().any(is_same) {
                kept.push(motion);
            }
        }
        kept
    }

    /// Returns the configurations of the closed form at a place of the path, if there is one, so that no branch is
    /// missed.
    fn branches(&self, fraction: f64) -> Result<Vec<f64>> {
        let PathProblem { robot, tip_path, options, .. } = self.problem;
        let target = tip_path.target(fraction);
        if !matches!(target, Target::Pose(_)) || robot.solves_at_once().is_none() {
            return Ok(vec![]);
        }
        let each = SolveOptions { seed: options.seed, ..SolveOptions::default() };
        let all = AllOptions { each, redundancy: REDUNDANCY, ..AllOptions::default() };
        let found = solve_all(robot, &target, &all, &mut Unattended)?;
        Ok(found.solutions.iter().flat_map(|solution| solution.q).copied().collect())
    }

    /// Returns the motion from a given start: parallel to the path if the start is within its tolerance band, or else
    /// near it.
    fn begun_at(&mut self, q: &[f64]) -> Option<JointWaypoints> {
        let PathProblem { robot, tip_path, .. } = self.problem;
        let excess = tip_path.path_target(0.0).excess(|| robot.tip(q));
        let in_parallel = excess.is_none_or(|excess| excess == [0.0; 2]);
        let mut follow = |leading| {
            let motions = self.each_way((0.0, q), leading);
            motions.min_by(|one, other| travel(&one.rows, q.len()).total_cmp(&travel(&other.rows, q.len())))
        };
        let parallel = if in_parallel { follow(Leading::InParallel) } else { None };
        parallel.or_else(|| follow(Leading::WithinTolerance))
    }

    /// The motions that follow the path through near `start`, a path parameter and a configuration there: back from a
    /// singularity, and through it where it forks.
    fn each_way(&mut self, start: (f64, &[f64]), leading: Leading) -> impl Iterator<Item = JointWaypoints> + use<> {
        self.forks = false;
        let back = self.walked(start, leading, false);
        self.has_forked |= self.forks;
        let through = if self.forks { self.walked(start, leading, true) } else { None };
        back.into_iter().chain(through)
    }

    /// Follows the path through near `start`, whatever whole turns of the joints fit.
    fn walked(&mut self, start: (f64, &[f64]), leading: Leading, straight_on: bool) -> Option<JointWaypoints> {
        let walked = self.follow(start, leading, straight_on);
        let limits = self.projection.bounds.clone();
        let turns = OpenTurns { robot: &self.problem.robot, limits: &limits };
        let opened = turns.bounds();
        if walked.is_some() || self.problem.options.start.is_some() || opened == limits {
            return walked;
        }
        self.projection.bounds = opened;
        let walked = self.follow(start, leading, straight_on);
        let shifted = walked.and_then(|mut motion| {
            let mut rows: Vec<&mut [f64]> = motion.rows.chunks_exact_mut(self.problem.robot.dof()).collect();
            turns.shift_inside(&mut rows).then_some(motion)
        });
        self.projection.bounds = limits;
        shifted
    }

    /// Follows the path through `start`, each configuration the nearest to the one before, or `straight_on` where it
    /// forks.
    fn follow(&mut self, (from, start): (f64, &[f64]), leading: Leading, straight_on: bool) -> Option<JointWaypoints> {
        let PathProblem { robot, tip_path, options, .. } = self.problem;
        let first = tip_path.path_target(from);
        let aim = match leading {
            Leading::OnPath => WalkAim::Displaced(first.on_path().displacement),
            Leading::InParallel => WalkAim::Displaced(first.held_at(|| robot.tip(start)).displacement),
            Leading::WithinTolerance => WalkAim::Displaced(None),
            Leading::WholePose => WalkAim::WholePose,
        };
        let (projection, forks) = (&mut self.projection, &mut self.forks);
        let mut walk = PathWalk { tip_path, aim, projection, straight_on, forks };
        let knots = tip_path.knots(INTERVALS);
        match options.start {
            Some(_) => walk.on_from(&knots, from, start.to_vec()),
            None => walk.along(&knots, from, start),
        }
    }
}
