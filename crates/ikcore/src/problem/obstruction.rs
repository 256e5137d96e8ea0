//! Reasons for a miss: target out of reach, tip blocked by its region, or joints at their limits.

use super::inverse_kinematics::Problem;
use crate::kinematics::ReachShortfall;
use crate::objective::Bounds;
use crate::task::{Criterion, Subject, Target};

/// Largest number of joints that a message names; further ones are counted.
const MOST_NAMED: usize = 3;

impl Problem<'_> {
    /// Distance of the target beyond the reach within `bounds`; `None` unless it is certain.
    pub(crate) fn reach_shortfall(&self, bounds: &Bounds) -> Option<ReachShortfall> {
        self.first_shortfall(bounds).map(|(_, shortfall)| shortfall)
    }

    /// Shortfall and number of the first tip whose target is beyond its reach.
    fn first_shortfall(&self, bounds: &Bounds) -> Option<(usize, ReachShortfall)> {
        let is_only = self.only_target().is_some();
        self.aims().iter().find_map(|(task, target)| match task.subject {
            // The tool of a task for several tips hides the target of the tip itself, unless the target is a pose.
            Subject::Tip(tip) if is_only || task.criterion.fixes_pose(target) => {
                let target = task.without_tool(target);
                Some((tip, self.shortfall_of(tip, &target, &task.criterion, bounds)?))
            }
            _ => None,
        })
    }

    fn shortfall_of(
        &self,
        tip: usize,
        target: &Target,
        criterion: &Criterion,
        bounds: &Bounds,
    ) -> Option<ReachShortfall> {
        if criterion.components.is_some() {
            return None; // component weights and tolerances may leave the unreachable part free
        }
        let aim = criterion.aim(target);
        let orientation = match &aim {
            Target::Pose(frame) | Target::Orientation(frame) => Some(frame),
            Target::Position(_) | Target::Pointing { .. } => None,
        };
        let tolerance = [criterion.tolerance.position, criterion.tolerance.rotation];
        let reach = self.robot().reach_of(tip, bounds.lower(), bounds.upper());
        reach.shortfall(aim.position().as_ref(), orientation, tolerance)
    }

    /// Describes the obstruction between the tip and the target at `q`; empty if none is known.
    pub(crate) fn obstruction(&self, bounds: &Bounds, q: &[f64]) -> String {
        let reach = self.first_shortfall(bounds).map(|(tip, shortfall)| match self.only_target() {
            Some(_) => shortfall.to_string(),
            None => format!("tip '{}': {shortfall}", self.robot().tips().nth(tip).unwrap_or_default()),
        });
        let reasons = reach.into_iter().chain(self.outside_region(q)).chain(self.joints_at_limits(bounds, q));
        reasons.collect::<Vec<_>>().join("; ")
    }

    fn outside_region(&self, q: &[f64]) -> Option<String> {
        let (_, criterion) = self.only_target()?;
        let (region, tip) = (criterion.region.as_ref()?, self.robot().tip_position(q));
        (!region.contains(&tip))
            .then(|| format!("the tip is outside its region, which requires {}", region.violated_faces(&tip)))
    }

    fn joints_at_limits(&self, bounds: &Bounds, q: &[f64]) -> Option<String> {
        let side = |j: usize| match (q[j] == bounds.lower()[j], q[j] == bounds.upper()[j]) {
            (true, true) => Some("locked by equal limits"),
            (true, false) => Some("at its lower limit"),
            (false, true) => Some("at its upper limit"),
            (false, false) => None,
        };
        let joints = self.robot().joints();
        let stuck: Vec<_> = (0..q.len()).filter_map(|j| Some((&joints[j].name, side(j)?))).collect();
        let named: Vec<_> = stuck
            .iter()
            .take(MOST_NAMED)
            .map(|(name, side)| format!("joint '{name}' {side}"))
            .chain(
                (stuck.len() > MOST_NAMED).then(|| format!("{} more joints at their limits", stuck.len() - MOST_NAMED)),
            )
            .collect();
        (!named.is_empty()).then(|| named.join(", "))
    }
}
