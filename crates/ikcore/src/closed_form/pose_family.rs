//! Configurations of a redundant arm for one pose, as a function of the self-motion parameter.

use crate::closed_form::arm_angle_limits::{Decisive, Values};
use crate::closed_form::arm_branches::ArmBranches;
use crate::closed_form::branches::Candidates;
use crate::closed_form::configurations::{ArmConfigurations, Drives};
use crate::closed_form::parameter_arcs::ParameterArcs;
use crate::closed_form::redundant::{AxisLimits, Parameter, Redundant, RedundantPose};
use crate::closed_form::verify::{LANES, values_of_seven};
use crate::math::Frame;

/// Redundant arm with a pose.
#[derive(Debug, Clone)]
pub(crate) struct PoseFamily<'a> {
    redundant: &'a Redundant,
    drives: &'a Drives,
    /// Joint limits of the arm.
    own: &'a FamilyLimits,
    pose: RedundantPose,
}

/// Joint limits of a redundant arm, precomputed for any pose.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FamilyLimits(AxisLimits);

impl FamilyLimits {
    /// Prepares the limits `lower` and `upper` (n,) (rad, m).
    pub fn new(redundant: &Redundant, drives: &Drives, [lower, upper]: [&[f64]; 2]) -> Self {
        Self(redundant.limits(drives.of_axes(lower, upper)))
    }
}

impl<'a> PoseFamily<'a> {
    /// Returns the family of configurations with the tip of the chain at `target`.
    #[inline]
    pub fn new(redundant: &'a Redundant, drives: &'a Drives, own: &'a FamilyLimits, target: &Frame) -> Self {
        Self { redundant, drives, own, pose: redundant.pose(target) }
    }

    /// Prepares the limits `lower` and `upper` (n,) (rad, m).
    pub fn limits(&self, lower: &[f64], upper: &[f64]) -> FamilyLimits {
        let is_own = self.own.0.axes == self.drives.of_axes(lower, upper);
        if is_own { *self.own } else { FamilyLimits::new(self.redundant, self.drives, [lower, upper]) }
    }

    /// Returns arcs of the parameter (rad, m) that contain every configuration within limits. Arcs may also hold values
    /// without such a configuration, so they must be searched.
    pub fn arcs(&self, limits: &FamilyLimits) -> ParameterArcs {
        self.redundant.arcs(&self.pose, &limits.0)
    }

    /// Whether the limits provably exclude every configuration, although [`Self::arcs`] leaves `arcs`. False proves nothing.
    pub fn is_excluded(&self, limits: &FamilyLimits, arcs: &ParameterArcs) -> bool {
        self.redundant.is_excluded(&self.pose, &limits.0, arcs)
    }

    /// Returns the first `most` parameter values (rad) on `arcs` near which a configuration may lie within limits; an empty
    /// list proves that there is none, and `None` means that the method does not apply. Values not yet excluded are offered
    /// to `visit`, which returns true to stop.
    pub fn open_values(
        &self,
        limits: &FamilyLimits,
        arcs: &ParameterArcs,
        most: usize,
        mut visit: impl FnMut(f64) -> bool,
    ) -> Option<Values> {
        self.redundant.open_values(&self.pose, &limits.0, arcs, most, &mut visit)
    }

    /// Returns parameter values (rad, m) that decide whether any configuration lies within limits; `None` if no such set is
    /// known.
    pub fn decisive(&self, limits: &FamilyLimits) -> Option<Decisive> {
        self.redundant.decisive(&self.pose, &limits.0)
    }

    /// Whether the parameter is the arm angle: then every branch exists at every value.
    pub fn is_by_arm_angle(&self) -> bool {
        self.redundant.parameter() == Parameter::ArmAngle
    }

    /// Whether [`Self::arcs`] end exactly where the branches end, so that no branch is lost there. Otherwise solutions may
    /// hide near folds.
    pub fn is_sure_of_arcs(&self) -> bool {
        self.redundant.is_sure_of_arcs()
    }

    /// Returns all configurations with the parameter at `value`.
    pub fn branches_at(&self, value: f64) -> ArmBranches {
        ArmBranches::of(&self.redundant.solve(&self.pose, value), self.drives)
    }

    /// Finds configurations with the parameter at `value` that bring the tip to the pose, to be confirmed by forward
    /// kinematics; cheaper than [`Self::branches_at`]. The result includes every configuration within the limits.
    #[inline]
    pub fn likely_at(&self, value: f64, limits: &FamilyLimits, found: &mut ArmConfigurations) {
        if self.redundant.has_exact_candidates() {
            self.candidates_at(value, limits, found);
        } else {
            *found = self.branches_at(value).configurations();
        }
    }

    /// Whether the structure of the arm holds only approximately, so that [`Self::candidates_at`] yields configurations near
    /// the solutions.
    pub fn is_approximate(&self) -> bool {
        self.redundant.has_approximate_candidates()
    }

    /// Finds the candidates of the closed form within the limits, with the parameter at `value`; none for the general method.
    #[inline]
    pub fn candidates_at(&self, value: f64, limits: &FamilyLimits, found: &mut ArmConfigurations) {
        let mut candidates = Candidates::new();
        self.redundant.add_candidates_within(&self.pose, value, &limits.0, &mut candidates);
        let verifier = self.redundant.verifier();
        found.replace(self.drives, candidates.count, |columns| values_of_seven(verifier, &candidates, columns));
    }

    /// Calls `visit` with the configurations at each of `values`, several values at a time, until it returns false. The
    /// configurations include every one within the limits.
    pub fn visit_within(
        &self,
        limits: &FamilyLimits,
        values: impl Iterator<Item = f64>,
        mut visit: impl FnMut(&ArmBranches) -> bool,
    ) {
        if !self.redundant.has_exact_candidates() {
            values.map(|value| self.branches_at(value)).all(|branches| visit(&branches));
            return;
        }
        let mut candidates = Candidates::new();
        for value in values {
            self.redundant.add_candidates_within(&self.pose, value, &limits.0, &mut candidates);
            // Flush while there is still room for the candidates of one more value.
            if candidates.count > LANES && !visit(&self.first_verified(&mut candidates)) {
                return;
            }
        }
        while candidates.count > 0 && visit(&self.first_verified(&mut candidates)) {}
    }

    /// Removes and verifies the first candidates, one per lane.
    fn first_verified(&self, candidates: &mut Candidates) -> ArmBranches {
        let all = candidates.count;
        candidates.count = all.min(LANES);
        let verified = ArmBranches::of(&self.redundant.verified(&self.pose, candidates), self.drives);
        let count = candidates.count;
        candidates.count = all;
        candidates.remove_first(count);
        verified
    }
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::closed_form::axis_chain::AxisChain;
    use crate::closed_form::seven_joint_arms::{IIWA14, PANDA, random_angles};

    const LIMITS: [[f64; 7]; 2] = [[-2.9, -1.8, -2.9, -3.07, -2.9, -0.1, -2.9], [2.9, 1.8, 2.9, -0.07, 2.9, 3.75, 2.9]];

    fn is_inside(q: &[f64]) -> bool {
        is_within(&LIMITS, q)
    }

    fn is_within([lower, upper]: &[[f64; 7]; 2], q: &[f64]) -> bool {
        q.iter().zip(lower).zip(upper).all(|((q, lower), upper)| {
            let turned = [-1.0, 0.0, 1.0].map(|turn| q + turn * std::f64::consts::TAU);
            turned.iter().any(|q| lower - 1e-7 <= *q && *q <= upper + 1e-7)
        })
    }

    fn sets(all: &ArmConfigurations) -> Vec<[f64; 7]> {
        (0..all.len()).map(|place| std::array::from_fn(|joint| all.columns()[joint][place])).collect()
    }

    fn is_among<'q>(q: &[f64], mut all: impl Iterator<Item = &'q [f64]>) -> bool {
        all.any(|other| q.iter().zip(other).all(|(a, b)| (a - b).abs() < 1e-6))
    }

    #[test]
    fn nothing_within_the_limits_is_lost_and_all_is_verified() {
        for rows in [PANDA, IIWA14] {
            let chain = AxisChain::of_rows(&rows);
            let redundant = Redundant::new(&chain).expect("a method");
            let drives = Drives::new((0..7).map(|joint| (joint, 1.0)));
            let limits = FamilyLimits::new(&redundant, &drives, [&LIMITS[0], &LIMITS[1]]);
            let mut inside = 0;
            for mut q in random_angles(50) {
                (0..7).for_each(|k| q[k] = q[k].clamp(LIMITS[0][k], LIMITS[1][k]));
                let family = PoseFamily::new(&redundant, &drives, &limits, &chain.tip_at(&q));
                let values: Vec<f64> = family.arcs(&limits).spread(16).collect();
                let mut visited = Vec::new();
                family.visit_within(&limits, values.iter().copied(), |branches| {
                    assert!(branches.iter().all(|(_, error)| error.position < 1e-9 && error.rotation < 1e-9));
                    visited.extend(branches.iter().map(|(q, _)| q.to_vec()));
                    true
                });
                for value in values {
                    let (all, mut likely) = (family.branches_at(value), ArmConfigurations::none());
                    family.likely_at(value, &limits, &mut likely);
                    for (q, _) in all.iter().filter(|(q, _)| is_inside(q)) {
                        assert!(is_among(q, visited.iter().map(Vec::as_slice)), "{q:?}");
                        assert!(is_among(q, sets(&likely).iter().map(|row| &row[..])), "{q:?}");
                        inside += 1;
                    }
                }
            }
            assert!(inside > 500, "{inside}");
        }
    }

    #[test]
    fn decisive_values_have_a_configuration_inside_if_any_value_has() {
        let chain = AxisChain::of_rows(&IIWA14);
        let redundant = Redundant::new(&chain).expect("a method");
        let drives = Drives::new((0..7).map(|joint| (joint, 1.0)));
        let mut decided = [0, 0];
        for (trial, q) in random_angles(400).into_iter().enumerate() {
            // Ranges around another configuration, some wide and some narrow, some with a joint exactly at its limit.
            let half = 0.3 + 0.3 * (trial % 9) as f64;
            let middle: [f64; 7] = std::array::from_fn(|k| q[(k + 2) % 7] * 0.5 + q[k] * 0.5);
            let mut limits = [middle.map(|m| m - half), middle.map(|m| m + half)];
            if trial % 4 == 0 {
                (limits[0][0], limits[1][4]) = (q[0], q[4]);
            }
            let all = FamilyLimits::new(&redundant, &drives, [&limits[0], &limits[1]]);
            let family = PoseFamily::new(&redundant, &drives, &all, &chain.tip_at(&q));
            let inside = |value: f64| family.branches_at(value).iter().any(|(found, _)| is_within(&limits, found));
            let by_scan = (0..1500).any(|k| inside(f64::from(k) * (std::f64::consts::TAU / 1500.0)));
            let decisive = family.decisive(&all).expect("the arm has an arm angle");
            let found = decisive.values.iter().any(|value| inside(*value));
            assert!(found || !by_scan, "trial {trial}: {q:?}");
            decided[usize::from(found)] += 1;
        }
        assert!(decided.iter().all(|count| *count > 50), "{decided:?}");
    }

    #[test]
    fn a_visitor_ends_the_visits() {
        let chain = AxisChain::of_rows(&IIWA14);
        let redundant = Redundant::new(&chain).expect("a method");
        let drives = Drives::new((0..7).map(|joint| (joint, 1.0)));
        let limits = FamilyLimits::new(&redundant, &drives, [&[-3.2; 7], &[3.2; 7]]);
        let family = PoseFamily::new(&redundant, &drives, &limits, &chain.tip_at(&[0.4; 7]));
        let mut visits = 0;
        family.visit_within(&limits, (0..100).map(|k| 0.06 * f64::from(k)), |_| {
            visits += 1;
            visits < 3
        });
        assert_eq!(visits, 3);
    }
}
