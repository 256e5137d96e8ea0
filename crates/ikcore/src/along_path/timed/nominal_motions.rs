//! Nominal motions to search around: from a few starts, each follows the path from point to point.

use super::elastic_band::ElasticBand;
use super::interpolation::JointWaypoints;
use super::null_space_offsets::travel;
use super::path_problem::PathProblem;
use super::path_walk::{PathWalk, WalkAim};
use super::projection::Projection;
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

/// Number of motions kept, and smallest distance between their starts (rad, m): the shortest is not always the fastest.
const BRANCHES: usize = 8;
const APART: f64 = 0.5;

/// Difference below which motions are the same (rad, m).
const SAME: f64 = 1e-6;

/// Maximum number of halvings of a step from point to point.
const HALVINGS: usize = 10;

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

/// Search for nominal motions.
pub(super) struct NominalMotions<'a> {
    problem: &'a PathProblem<'a>,
    projection: Projection<'a>,
}

impl<'a> NominalMotions<'a> {
    pub fn new(problem: &'a PathProblem<'a>) -> Self {
        Self { problem, projection: Projection::new(&problem.robot, problem.keeps) }
    }

    /// Returns the shortest motions that follow the path, each shortened within the tolerance band; the first also
    /// within parts of the band and unshortened; and motions that keep the parts of the poses that the task ignores.
    /// Empty if each ends on the way.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted).
    pub fn all(mut self) -> Result<Vec<JointWaypoints>> {
        let PathProblem { tip_path, options, .. } = self.problem;
        if let Some(start) = &options.start {
            return self.begun_at(start).map_or(Ok(vec![]), |nominal| self.shortened(nominal, &[]));
        }
        let mut bases = self.shortest(Leading::OnPath)?;
        let mut rungs = &RUNGS[..];
        if bases.is_empty() && tip_path.has_tolerance() {
            (bases, rungs) = (self.shortest(Leading::WithinTolerance)?, &[]);
        }
        let mut bases = bases.into_iter();
        let mut motions = bases.next().map_or(Ok(vec![]), |base| self.shortened(base, rungs))?;
        for base in bases {
            motions.push(self.tightened(base, f64::INFINITY)?);
        }
        if tip_path.ignores_a_part() {
            motions.extend(self.shortest(Leading::WholePose)?);
        }
        Ok(motions)
    }

    /// Returns a motion shortened within the tolerance band, within these parts of it, and as it is.
    fn shortened(&mut self, nominal: JointWaypoints, rungs: &[f64]) -> Result<Vec<JointWaypoints>> {
        let mut motions = vec![self.tightened(nominal.clone(), f64::INFINITY)?];
        for most in rungs.iter().filter(|most| **most < self.problem.tip_path.largest_tolerance()) {
            motions.push(self.tightened(nominal.clone(), *most)?);
        }
        if largest_difference(&motions[0].rows, &nominal.rows) > SAME {
            motions.push(nominal);
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
        let PathProblem { robot, options, .. } = self.problem;
        let mut starts = robot.random_configurations(STARTS, &mut rng::stream(options.seed, 0))?;
        starts.extend(self.branches()?);
        let mut found: Vec<(f64, JointWaypoints)> = vec![];
        for start in starts.chunks_exact(robot.dof()) {
            checkpoint()?;
            let nominal = self.follow(start, leading);
            found.extend(nominal.map(|nominal| (travel(&nominal.rows, robot.dof()), nominal)));
        }
        found.sort_by(|one, other| one.0.total_cmp(&other.0));
        let mut kept: Vec<JointWaypoints> = vec![];
        for (_, nominal) in found {
            let is_known = |other: &JointWaypoints| largest_difference(other.row(0), nominal.row(0)) < APART;
            if kept.len() < BRANCHES && !kept.iter().any(is_known) {
                kept.push(nominal);
            }
        }
        Ok(kept)
    }

    /// Returns the configurations of the closed form at the beginning of the path, if there is one, so that no branch
    /// is missed.
    fn branches(&self) -> Result<Vec<f64>> {
        let PathProblem { robot, tip_path, options, .. } = self.problem;
        let target = tip_path.target(0.0);
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
        let parallel = if in_parallel { self.follow(q, Leading::InParallel) } else { None };
        parallel.or_else(|| self.follow(q, Leading::WithinTolerance))
    }

    /// Follows the path from `start`, each configuration from the one before.
    fn follow(&mut self, start: &[f64], leading: Leading) -> Option<JointWaypoints> {
        let PathProblem { robot, tip_path, options, .. } = self.problem;
        let first = tip_path.path_target(0.0);
        let aim = match leading {
            Leading::OnPath => WalkAim::Displaced(first.on_path().displacement),
            Leading::InParallel => WalkAim::Displaced(first.held_at(|| robot.tip(start)).displacement),
            Leading::WithinTolerance => WalkAim::Displaced(None),
            Leading::WholePose => WalkAim::WholePose,
        };
        let mut walk = PathWalk { tip_path, aim, projection: &mut self.projection };
        let first = if options.start.is_some() { start.to_vec() } else { walk.begun_near(start)? };
        let knots = tip_path.knots(INTERVALS);
        let mut walked = JointWaypoints { knots: vec![knots[0]], rows: first };
        for knot in &knots[1..] {
            walk.on_to(*knot, HALVINGS, &mut walked)?;
        }
        Some(walked)
    }
}
