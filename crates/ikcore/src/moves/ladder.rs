//! Configurations for a whole program, by dynamic programming.
//!
//! A program is cut into blocks: a joint move, and the paths of the tip after it. All that a block leaves open is the configuration at its
//! start: a branch and whole turns, or also the self-motion of a redundant arm. A configuration from which a joint meets its limit on
//! one of the paths of its block is no candidate. Of the sequences of candidates, the quickest is taken.

use super::around::MoveSurroundings;
use super::follower::{Follower, Lead, Lost, Track};
use super::ladder_block::LadderBlock;
use super::move_configurations::MoveConfigurations;
use super::moving_tip::MovingTip;
use super::program::JointGoal;
use super::rung::{Before, Cause, Dead, Rung, SAME, farther, groups, range};
use super::tool_path::ToolPath;
use crate::error::Result;
use crate::ik::SolveOptions;
use crate::math::Pose;
use crate::math::vector::largest_difference;
use crate::objective::{Bounds, Point};
use crate::robot::limit_rounding;
use crate::solver::Monitor;
use crate::timing::ConstantLimits;

/// Largest number of rungs of a step of the ladder for each tip; the quickest are kept.
const MOST_RUNGS: usize = 24;

/// Maximum number of configurations at a pose that are followed, nearest first.
const MOST_FOLLOWED: usize = 48;
/// Number of successes that ends the search of a redundant arm.
const ENOUGH: usize = 6;
/// The same where the task leaves a part of the pose free: the nearest ones are directions of one branch.
const ENOUGH_FREE: usize = 24;

/// Maximum number of configurations at the end of a lost path that the self-motion is led towards.
const MOST_LED_TO: usize = 12;
/// Maximum number of configurations at a pose that are followed with a lead, where none succeeds without.
const MOST_LED: usize = 4;

/// Decay lengths of a lead, as fractions of the length at which the path was lost.
const LEAD_WITHIN: [f64; 3] = [0.3, 0.1, 1.0];
/// Minimum of that length (m).
const LEAST_LENGTH: f64 = 0.01;

/// Distance (rad, m) from limits within which the path of a redundant arm stays where it can: splines swing a little between knots.
const INSET: f64 = 1e-3;

/// The search for the configurations of a program.
pub(super) struct Ladder<'a> {
    limits: &'a ConstantLimits,
    around: MoveSurroundings<'a>,
    tips: &'a [MovingTip<'a>],
    /// One for each tip.
    followers: Vec<Follower<'a>>,
    /// Options of searches for each tip.
    searches: &'a [SolveOptions],
    /// Evaluations of the kinematics so far.
    pub evaluations: usize,
}

impl<'a> Ladder<'a> {
    pub fn new(around: MoveSurroundings<'a>, tips: &'a [MovingTip<'a>], searches: &'a [SolveOptions]) -> Self {
        let limits = around.limits;
        let follower = |tip: &'a MovingTip<'a>| {
            let bounds = if tip.is_redundant() {
                let [lower, upper] = limits.inset_positions(INSET);
                Bounds::from_ranges(lower.into_iter().zip(upper))
            } else {
                // Whole turns are chosen afterwards, so that one path serves all of them.
                Bounds::from_ranges((0..tip.dof()).map(|_| (f64::NEG_INFINITY, f64::INFINITY)))
            };
            Follower::new(tip, bounds)
        };
        let followers = tips.iter().map(follower).collect();
        Self { limits, around, tips, followers, searches, evaluations: 0 }
    }

    /// The follower of tip number `tip`, for refinement.
    pub fn follower(&mut self, tip: usize) -> &mut Follower<'a> {
        &mut self.followers[tip]
    }

    /// The quickest sequence of rungs from the configuration `start`; the index of a block that has none, and why.
    ///
    /// # Errors
    /// Those of `solve_all`.
    pub fn climb(
        &mut self,
        blocks: &[LadderBlock<'_>],
        start: &[f64],
        monitor: &mut dyn Monitor,
    ) -> Result<Result<Vec<Rung>, (usize, Dead)>> {
        let mut ladder: Vec<Vec<Rung>> = vec![];
        for (i, block) in blocks.iter().enumerate() {
            let found = match (&block.goal, ladder.last()) {
                (Some((_, goal)), Some(before)) => self.rungs(block, goal, before, monitor)?,
                _ => self
                    .tracks_by_any_lead(start, &block.paths, monitor)?
                    .map(|tracks| vec![self.rung(start.into(), tracks)]),
            };
            match found {
                Ok(rungs) => ladder.push(rungs),
                Err(dead) => return Ok(Err((i, dead))),
            }
        }
        let mut chosen = vec![];
        let mut index = 0; // the quickest comes first
        for rungs in ladder.iter_mut().rev() {
            let rung = rungs.swap_remove(index);
            index = rung.before;
            chosen.push(rung);
        }
        chosen.reverse();
        self.evaluations += self.followers.iter().map(|follower| follower.evaluations).sum::<usize>();
        Ok(Ok(chosen))
    }

    /// The rungs of a block that begins with a joint move, after those of the block `before`; the quickest first.
    fn rungs(
        &mut self,
        block: &LadderBlock<'_>,
        goal: &JointGoal,
        before: &[Rung],
        monitor: &mut dyn Monitor,
    ) -> Result<Result<Vec<Rung>, Dead>> {
        let found = match goal {
            JointGoal::Configuration(q) => {
                let before: Vec<Before<'_>> = before.iter().enumerate().collect();
                let tracks = self.tracks_by_any_lead(q, &block.paths, monitor)?;
                tracks.map(|tracks| vec![self.after(&before, q.as_slice().into(), tracks)])
            }
            JointGoal::Pose(pose) => self.rungs_at(pose, block, before, monitor)?,
        };
        Ok(found.map(|mut rungs| {
            rungs.sort_by(|one, other| one.cost.total_cmp(&other.cost));
            rungs.dedup_by(|one, other| largest_difference(&one.q, &other.q) < SAME);
            rungs.truncate(MOST_RUNGS * self.tips.len());
            rungs
        }))
    }

    /// The rungs of a block whose joint move leads a tip to a pose.
    fn rungs_at(
        &mut self,
        pose: &Pose,
        block: &LadderBlock<'_>,
        before: &[Rung],
        monitor: &mut dyn Monitor,
    ) -> Result<Result<Vec<Rung>, Dead>> {
        let (tip, paths) = (&self.tips[block.tip], &block.paths);
        let (mut rungs, mut failed) = (vec![], None);
        let candidates = match self.configurations(tip, pose, before[0].end(), monitor)? {
            Ok(candidates) => candidates,
            Err(why) => return Ok(Err(Dead::Goal(why))),
        };
        let groups = groups(tip, before);
        let enough = if tip.task.is_whole() { ENOUGH } else { ENOUGH_FREE };
        for candidate in candidates.iter().take(MOST_FOLLOWED) {
            if tip.is_redundant() && rungs.len() >= enough {
                break;
            }
            for group in &groups {
                match self.placed(tip, candidate, paths, group) {
                    Ok(more) => rungs.extend(more),
                    Err(dead) => failed = Some(farther(failed, dead)),
                }
            }
        }
        for candidate in candidates.iter().take(MOST_LED) {
            if !tip.is_redundant() || !rungs.is_empty() {
                break;
            }
            let q = self.near(tip, candidate, &groups[0]);
            match self.tracks_by_any_lead(&q, paths, monitor)? {
                Ok(tracks) => rungs.push(self.after(&groups[0], q, tracks)),
                Err(dead) => failed = Some(farther(failed, dead)),
            }
        }
        let none = || Dead::Goal("the arm has no configuration there".into());
        Ok(if rungs.is_empty() { Err(failed.unwrap_or_else(none)) } else { Ok(rungs) })
    }

    /// Configurations at a pose, those nearest to `reference` first; why there are none.
    fn configurations(
        &mut self,
        tip: &'a MovingTip<'a>,
        pose: &Pose,
        reference: &[f64],
        monitor: &mut dyn Monitor,
    ) -> Result<Result<Vec<Point>, crate::message::Message>> {
        let (each, follower) = (&self.searches[tip.number], &mut self.followers[tip.number]);
        MoveConfigurations { tip, each, follower }.at(pose, reference, monitor)
    }

    /// The rungs of one configuration of a tip at the start of a block, at the whole turns that suit each of the rungs before.
    fn placed(
        &mut self,
        tip: &MovingTip<'_>,
        candidate: &[f64],
        paths: &[&ToolPath],
        before: &[Before<'_>],
    ) -> Result<Vec<Rung>, Dead> {
        if tip.is_redundant() {
            let q = self.near(tip, candidate, before);
            let tracks = self.tracks(&q, paths, None)?;
            return Ok(vec![self.after(before, q, tracks)]);
        }
        let candidate = &tip.whole(&tip.own(candidate), before[0].1.end());
        let tracks = self.follow_all(candidate, paths, None)?;
        let mut rungs: Vec<Rung> = vec![];
        for (_, rung) in before {
            let turns = self
                .turns(tip, candidate, &tracks, rung.end())
                .map_err(|(joint, value)| self.beyond(&tracks, joint, value))?;
            let moved = |values: &[f64]| values.iter().zip(&turns).map(|(q, turn)| q + turn).collect::<Point>();
            let q = moved(tracks.first().map_or(candidate, |track| track.row(0)));
            if rungs.iter().all(|known| largest_difference(&known.q, &q) > SAME) {
                let n = tip.dof();
                let tracks = tracks.iter().map(|track| Track {
                    knots: track.knots.clone(),
                    rows: track.rows.chunks_exact(n).flat_map(&moved).collect(),
                });
                let tracks = tracks.collect();
                rungs.push(self.after(before, q, tracks));
            }
        }
        Ok(rungs)
    }

    /// A configuration of a tip at the whole turns nearest to the end of the quickest rung `before`.
    fn near(&self, tip: &MovingTip<'_>, candidate: &[f64], before: &[Before<'_>]) -> Point {
        let end = before[0].1.end();
        tip.near(&tip.whole(&tip.own(candidate), end), &Bounds::from_ranges(self.ranges()), end)
    }

    /// Follows all paths from `q` with the least motion of the joints. Where that leads a redundant arm into a limit, a singularity or an
    /// obstacle, its self-motion leads elsewhere from the start on: to configurations at the end of the path that was lost, and to the
    /// middle of the limits.
    ///
    /// # Errors
    /// Those of `solve_all`.
    fn tracks_by_any_lead(
        &mut self,
        q: &[f64],
        paths: &[&ToolPath],
        monitor: &mut dyn Monitor,
    ) -> Result<Result<Vec<Track>, Dead>> {
        let (dead, path, at) = match self.tracks(q, paths, None) {
            Err(dead @ Dead::Path { path, at, .. }) if self.tips[paths[path].tip].is_redundant() => (dead, path, at),
            other => return Ok(other),
        };
        let tip = &self.tips[paths[path].tip];
        let before = paths[..path].iter().filter(|path| path.tip == tip.number);
        let length = before.map(|path| path.length()).sum::<f64>() + at;
        let end = Pose::from(paths[path].pose(paths[path].length()));
        let mut leads = self.configurations(tip, &end, q, monitor)?.unwrap_or_default();
        leads.truncate(MOST_LED_TO);
        let middle = |((lower, upper), q): ((f64, f64), &f64)| {
            let middle = 0.5 * (lower + upper);
            if middle.is_finite() { middle } else { *q }
        };
        leads.push(self.ranges().zip(q).map(middle).collect());
        let mut failed = dead;
        for part in LEAD_WITHIN {
            for toward in &leads {
                let lead = Lead { tip: tip.number, toward, within: part * length.max(LEAST_LENGTH) };
                match self.tracks(q, paths, Some(&lead)) {
                    Ok(tracks) => return Ok(Ok(tracks)),
                    Err(dead) => failed = farther(Some(failed), dead),
                }
            }
        }
        Ok(Err(failed))
    }

    /// Follows all paths from `q`, and checks limits.
    fn tracks(&mut self, q: &[f64], paths: &[&ToolPath], lead: Option<&Lead<'_>>) -> Result<Vec<Track>, Dead> {
        let tracks = self.follow_all(q, paths, lead)?;
        for joint in 0..q.len() {
            let [lowest, highest] = range(q, &tracks, joint);
            if let Some(value) = self.excess(joint, [lowest, highest]) {
                return Err(self.beyond(&tracks, joint, value));
            }
        }
        Ok(tracks)
    }

    fn follow_all(&mut self, q: &[f64], paths: &[&ToolPath], lead: Option<&Lead<'_>>) -> Result<Vec<Track>, Dead> {
        let mut tracks: Vec<Track> = Vec::with_capacity(paths.len());
        for (i, path) in paths.iter().enumerate() {
            let from = tracks.last().map_or(q, Track::end).to_vec();
            let lost = |Lost { at }| Dead::Path { path: i, at, cause: Cause::OutOfReach };
            let lead = lead.filter(|lead| lead.tip == path.tip);
            tracks.push(self.followers[path.tip].follow(path, &from, lead).map_err(lost)?);
        }
        match self.blocked(q, &tracks) {
            None => Ok(tracks),
            Some(dead) => Err(dead),
        }
    }

    /// The first knot at which something is in the way, or a joint cannot hold the arm.
    fn blocked(&self, q: &[f64], tracks: &[Track]) -> Option<Dead> {
        if self.around.admits_all() {
            return None;
        }
        if tracks.is_empty() {
            return self.around.fault_at(q).map(|fault| Dead::Goal(fault.into()));
        }
        tracks.iter().enumerate().find_map(|(path, track)| {
            let at = |(i, at): (usize, &f64)| {
                let fault = self.around.fault_at(track.row(i))?;
                Some(Dead::Path { path, at: *at, cause: Cause::Blocked(fault) })
            };
            track.knots.iter().enumerate().find_map(at)
        })
    }

    /// Whole turns of each joint (rad) of a tip with which a block stays inside the limits, as near to `reference` at its start as possible;
    /// the joint and its value where none do.
    fn turns(
        &self,
        tip: &MovingTip<'_>,
        q: &[f64],
        tracks: &[Track],
        reference: &[f64],
    ) -> Result<Point, (usize, f64)> {
        let start = tracks.first().map_or(q, |track| track.row(0));
        let of_joint = |joint: usize| {
            let ends = range(start, tracks, joint);
            let Some(period) = tip.turn_period(joint) else {
                return self.excess(joint, ends).map_or(Ok(0.0), |value| Err((joint, value)));
            };
            let [lower, upper] = [self.limits.lower[joint], self.limits.upper[joint]];
            let rounding = limit_rounding(lower, upper);
            let (fewest, most) =
                (((lower - rounding - ends[0]) / period).ceil(), ((upper + rounding - ends[1]) / period).floor());
            if fewest > most {
                let value = self.excess(joint, ends).unwrap_or(ends[1]);
                return Err((joint, value));
            }
            Ok(((reference[joint] - start[joint]) / period).round().clamp(fewest, most) * period)
        };
        (0..q.len()).map(of_joint).collect()
    }

    /// The end of this range that is farther beyond the limits of a joint.
    fn excess(&self, joint: usize, [lowest, highest]: [f64; 2]) -> Option<f64> {
        let (lower, upper) = (self.limits.lower[joint], self.limits.upper[joint]);
        let (below, above) = (lower - lowest, highest - upper);
        (below.max(above) > limit_rounding(lower, upper)).then_some(if below > above { lowest } else { highest })
    }

    /// Returns the place on the paths at which a joint first leaves its limits.
    fn beyond(&self, tracks: &[Track], joint: usize, value: f64) -> Dead {
        let cause = || Cause::Limit { joint, value };
        for (path, track) in tracks.iter().enumerate() {
            for (i, at) in track.knots.iter().enumerate() {
                let q = track.row(i)[joint];
                if self.excess(joint, [q, q]).is_some() {
                    return Dead::Path { path, at: *at, cause: cause() };
                }
            }
        }
        match tracks.last() {
            None => Dead::Goal("a joint would be outside its limits".into()),
            Some(last) => Dead::Path { path: tracks.len() - 1, at: last.knots[last.knots.len() - 1], cause: cause() },
        }
    }

    /// The rung of these tracks from `q`, without the rounding by which joints may be beyond their limits.
    fn rung(&self, mut q: Point, mut tracks: Vec<Track>) -> Rung {
        for row in tracks.iter_mut().flat_map(|track| track.rows.chunks_exact_mut(q.len().max(1))) {
            self.limits.clip(row);
        }
        match tracks.first() {
            Some(track) => q.copy_from_slice(track.row(0)),
            None => self.limits.clip(&mut q),
        }
        Rung { q, tracks, cost: 0.0, before: 0 }
    }

    /// A rung after the quickest of those `before`.
    fn after(&self, before: &[Before<'_>], q: Point, tracks: Vec<Track>) -> Rung {
        let Rung { q, tracks, .. } = self.rung(q, tracks);
        let total = |rung: &Rung| rung.cost + self.joint_time(rung.end(), &q);
        let costs = before.iter().map(|(index, rung)| (*index, total(rung)));
        let (index, cost) = costs.min_by(|one, other| one.1.total_cmp(&other.1)).unwrap_or((0, 0.0));
        let along: f64 = tracks.iter().map(|track| self.track_time(track)).sum();
        Rung { q, tracks, cost: cost + along, before: index }
    }

    /// Least time (s) of a joint move from rest to rest.
    fn joint_time(&self, from: &[f64], to: &[f64]) -> f64 {
        let time = |joint: usize| {
            let way = (to[joint] - from[joint]).abs();
            let (v, a) = (self.limits.velocity[joint], self.limits.acceleration[joint]);
            if way * a < v * v { 2.0 * (way / a).sqrt() } else { way / v + v / a }
        };
        (0..from.len()).map(time).fold(0.0, f64::max)
    }

    /// Least time (s) along a track at full joint speeds.
    fn track_time(&self, track: &Track) -> f64 {
        let between = |i: usize| {
            let pairs = track.row(i).iter().zip(track.row(i + 1)).zip(&self.limits.velocity);
            pairs.map(|((from, to), v)| (to - from).abs() / v).fold(0.0, f64::max)
        };
        (0..track.knots.len() - 1).map(between).sum()
    }

    fn ranges(&self) -> impl Iterator<Item = (f64, f64)> {
        self.limits.lower.iter().copied().zip(self.limits.upper.iter().copied())
    }
}
