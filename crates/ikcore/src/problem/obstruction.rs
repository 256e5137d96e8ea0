//! Explains why a target was missed: out of reach, blocked by its region, or joints at their limits.

use super::aim::Aim;
use super::inverse_kinematics::Problem;
use crate::kinematics::ReachShortfall;
use crate::objective::Bounds;
use crate::task::{Criterion, Subject, Target, TipAims};

/// Largest number of joints that a message names; the others are counted.
const MOST_NAMED: usize = 3;

impl Problem<'_> {
    /// How far the target is beyond the reach within `bounds`; `None` unless that is certain.
    pub(crate) fn reach_shortfall(&self, bounds: &Bounds) -> Option<ReachShortfall> {
        match self.aim() {
            Aim::Tip(target, criterion) => self.shortfall_of(0, target, criterion, bounds),
            Aim::Tips(aims) => self.shortfall_of_tips(aims, bounds).map(|(_, shortfall)| shortfall),
        }
    }

    /// That of the first tip whose target is beyond its reach, and the number of the tip.
    fn shortfall_of_tips(&self, aims: &TipAims<'_>, bounds: &Bounds) -> Option<(usize, ReachShortfall)> {
        aims.iter().find_map(|(task, target)| match task.subject {
            Subject::Tip(tip) if task.criterion.fixes_pose(target) => {
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

    /// Describes the obstruction between the tip and the target at `q`; empty if nothing is known.
    pub(crate) fn obstruction(&self, bounds: &Bounds, q: &[f64]) -> String {
        let reach = match self.aim() {
            Aim::Tip(..) => self.reach_shortfall(bounds).map(|shortfall| shortfall.to_string()),
            Aim::Tips(aims) => self.shortfall_of_tips(aims, bounds).map(|(tip, shortfall)| {
                format!("tip '{}': {shortfall}", self.robot().tips().nth(tip).unwrap_or_default())
            }),
        };
        let reasons = reach.into_iter().chain(self.outside_region(q)).chain(self.joints_at_limits(bounds, q));
        reasons.collect::<Vec<_>>().join("; ")
    }

    fn outside_region(&self, q: &[f64]) -> Option<String> {
        let Aim::Tip(_, criterion) = self.aim() else { return None };
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
