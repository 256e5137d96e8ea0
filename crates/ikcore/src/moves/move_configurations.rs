//! Configurations in which the tip meets a pose of a program.

use super::follower::Follower;
use super::moving_tip::MovingTip;
use crate::error::Result;
use crate::ik::{AllOptions, SolveOptions, solve, solve_all};
use crate::math::vector::{largest_difference, squared_distance};
use crate::math::{Frame, Pose};
use crate::message::Message;
use crate::objective::Point;
use crate::solver::{Monitor, Status};
use crate::task::Target;

/// Number of redundancy values at which a pose is solved.
const REDUNDANCY: usize = 16;
/// The same for each pose, where the task leaves several.
const REDUNDANCY_OF_EACH: usize = 4;

/// Configurations of a search, where there is no closed form.
const SEARCHED: usize = 16;

/// Joint difference below which two configurations are one.
const SAME: f64 = 1e-6;

/// The source of configurations.
pub(super) struct MoveConfigurations<'s, 'a> {
    pub tip: &'a MovingTip<'a>,
    /// Options of searches for the robot that [`MovingTip::solved`] gives.
    pub each: &'s SolveOptions,
    pub follower: &'s mut Follower<'a>,
}

impl MoveConfigurations<'_, '_> {
    /// Configurations of the whole robot that meet the task at a pose, with all joints but the tip's own at `reference`; those nearest to it
    /// first. Otherwise why there are none.
    ///
    /// # Errors
    /// Those of `solve_all`.
    pub fn at(
        &mut self,
        pose: &Pose,
        reference: &[f64],
        monitor: &mut dyn Monitor,
    ) -> Result<Result<Vec<Point>, Message>> {
        let (seen, own) = (self.tip.seen(pose, reference), self.tip.own(reference));
        let is_whole = self.tip.task.is_whole();
        let found =
            if is_whole { self.of_whole_pose(&seen, &own, monitor) } else { self.of_part(&seen, &own, monitor) };
        let mut found = match found? {
            Ok(found) => self.wholes(&found, reference),
            Err(why) => return Ok(Err(why)),
        };
        // A search ends within its tolerance, and a path begins on its pose: after the moves of other tips, this one is still there.
        let place = Frame::from(pose);
        found.retain_mut(|q| self.meet(&place, q) || is_whole);
        if is_whole {
            return Ok(Ok(found));
        }
        found.sort_by(|one, other| squared_distance(one, reference).total_cmp(&squared_distance(other, reference)));
        found.dedup_by(|one, other| largest_difference(one, other) < SAME);
        let none = "the search ended near the pose, but no configuration inside the limits meets it";
        Ok(if found.is_empty() { Err(none.into()) } else { Ok(found) })
    }

    /// Moves `q` to the nearest configuration that meets the task at `place`, if there is one. Returns whether there is.
    fn meet(&mut self, place: &Frame, q: &mut Point) -> bool {
        let mut nearest = q.clone();
        let is_met = self.follower.meet(place, &mut nearest);
        if is_met {
            *q = nearest;
        }
        is_met
    }

    /// Configurations of the whole robot, with all joints but the tip's own at `reference`.
    fn wholes(&self, found: &[Point], reference: &[f64]) -> Vec<Point> {
        found.iter().map(|own| self.tip.whole(own, reference)).collect()
    }

    /// Configurations that meet a partial task near a pose.
    fn of_part(
        &self,
        pose: &Pose,
        reference: &[f64],
        monitor: &mut dyn Monitor,
    ) -> Result<Result<Vec<Point>, Message>> {
        let mut found = vec![];
        let nearest = SolveOptions { start: Some(reference.to_vec()), ..self.searched() };
        let nearest = solve(self.tip.solved(), &Target::from(pose), &nearest, monitor)?;
        if nearest.status == Status::Solved {
            found.push(nearest.q);
        }
        if self.tip.solved().solves_at_once() == Some(true) {
            found.extend(self.by_closed_form(pose, reference, monitor)?);
        }
        if found.len() < 2 {
            let options = AllOptions { each: self.searched(), limit: Some(SEARCHED), ..AllOptions::default() };
            let all = solve_all(self.tip.solved(), &Target::from(pose), &options, monitor)?;
            if found.is_empty() && all.solutions.is_empty() {
                return Ok(Err(all.message()));
            }
            found.extend(all.solutions.iter().map(|solution| Point::from_slice(solution.q)));
        }
        Ok(Ok(found))
    }

    fn of_whole_pose(
        &self,
        pose: &Pose,
        reference: &[f64],
        monitor: &mut dyn Monitor,
    ) -> Result<Result<Vec<Point>, Message>> {
        let each = SolveOptions { start: Some(reference.to_vec()), ..self.each.clone() };
        let options = AllOptions { each, redundancy: REDUNDANCY, ..AllOptions::default() };
        let found = solve_all(self.tip.solved(), &Target::from(pose), &options, monitor)?;
        if found.solutions.is_empty() {
            return Ok(Err(found.message()));
        }
        Ok(Ok(found.solutions.iter().map(|solution| Point::from_slice(solution.q)).collect()))
    }

    /// Configurations at poses that are spread over what the task leaves free.
    fn by_closed_form(&self, pose: &Pose, reference: &[f64], monitor: &mut dyn Monitor) -> Result<Vec<Point>> {
        let poses = self.tip.task.spread(pose);
        let redundancy = if poses.len() > 1 { REDUNDANCY_OF_EACH } else { REDUNDANCY };
        let each = SolveOptions { start: Some(reference.to_vec()), ..self.each.clone() };
        let options = AllOptions { each, redundancy, ..AllOptions::default() };
        let mut found = vec![];
        for pose in poses {
            let all = solve_all(self.tip.solved(), &Target::from(&pose), &options, monitor)?;
            found.extend(all.solutions.iter().map(|solution| Point::from_slice(solution.q)));
        }
        Ok(found)
    }

    /// Options of a search for the task.
    fn searched(&self) -> SolveOptions {
        SolveOptions { task: self.tip.task.searched(), ..self.each.clone() }
    }
}
