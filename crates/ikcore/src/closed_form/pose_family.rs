//! Configurations of a redundant arm for one pose, as a function of the self-motion parameter.

use crate::closed_form::angle::Angle;
use crate::closed_form::angle_range::AngleRange;
use crate::closed_form::arm_angle::{ArmAngle, ArmAnglePose};
use crate::closed_form::arm_angle_limits::{Decisive, Values};
use crate::closed_form::arm_branches::ArmBranches;
use crate::closed_form::axis_chain::AxisKind;
use crate::closed_form::branches::{Branches, Candidates};
use crate::closed_form::configurations::ArmConfigurations;
use crate::closed_form::parameter_arcs::ParameterArcs;
use crate::closed_form::redundant::{FamilyLimits, Method, Parameter, Redundant};
use crate::closed_form::six::Structure;
use crate::closed_form::verify::{LANES, verified, write_values};
use crate::math::Frame;
use crate::math::arithmetic::{Baseline, by_instructions};

/// Redundant arm with a pose.
#[derive(Debug, Clone)]
pub(crate) struct PoseFamily<'a> {
    arm: &'a Redundant,
    /// Displacement that all joints together must produce.
    goal: Frame,
    by_arm_angle: Option<(&'a ArmAngle, ArmAnglePose)>,
}

impl<'a> PoseFamily<'a> {
    /// Returns the family of configurations with the tip of the chain at `target`.
    #[inline]
    pub fn new(arm: &'a Redundant, target: &Frame) -> Self {
        let goal = target.then::<Baseline>(&arm.back);
        let by_arm_angle = match &arm.method {
            Method::ArmAngle(method) => Some((&**method, method.pose(&goal))),
            Method::Given(_) => None,
        };
        Self { arm, goal, by_arm_angle }
    }

    /// Prepares the limits `lower` and `upper` (n,) (rad, m).
    pub fn limits(&self, lower: &[f64], upper: &[f64]) -> FamilyLimits {
        self.arm.limits(lower, upper)
    }

    /// Returns arcs of the parameter (rad, m) outside which joint 4 or the parameter's own joint violates its limits. Arcs may
    /// also hold values without a configuration within limits, so they must be searched.
    ///
    /// The ends are exact, so that an arc of zero length, with joint 4 at its limit, is not lost between samples.
    pub fn arcs(&self, limits: &FamilyLimits) -> ParameterArcs {
        let FamilyLimits { axes, distances, .. } = limits;
        match (self.arm.parameter(), &self.arm.distance) {
            (Parameter::ArmAngle, Some(distance)) => distance.arm_angles(&self.goal, *distances),
            (Parameter::ArmAngle, None) => ParameterArcs::CIRCLE,
            (Parameter::Axis(axis), _) if self.arm.chain.joints[axis].motion == AxisKind::Slides => {
                ParameterArcs::one(axes[axis])
            }
            (Parameter::Axis(axis), Some(distance)) => distance.angles(&self.goal, *distances).within(axes[axis]),
            (Parameter::Axis(axis), None) => ParameterArcs::CIRCLE.within(axes[axis]),
        }
    }

    /// Whether the limits provably exclude every configuration, although [`Self::arcs`] leaves `arcs`. False proves nothing.
    pub fn is_excluded(&self, limits: &FamilyLimits, arcs: &ParameterArcs) -> bool {
        match &self.by_arm_angle {
            Some((method, pose)) => method.is_excluded(pose, &limits.axes, &limits.ranges[3]),
            None => self.open_values(limits, arcs, 1, |_| false).is_some_and(|open| open.is_empty()),
        }
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
        let proof = self.arm.proof.as_deref()?;
        Some(proof.open_values(&self.goal, arcs, &limits.axes, most, &mut visit))
    }

    /// Returns parameter values (rad, m) that decide whether any configuration lies within limits; `None` if no such set is
    /// known.
    pub fn decisive(&self, limits: &FamilyLimits) -> Option<Decisive> {
        let (method, pose) = self.by_arm_angle.as_ref()?;
        Some(method.decisive(pose, &self.goal, &limits.axes, &limits.ranges[3]))
    }

    /// Whether the parameter is the arm angle: then every branch exists at every value.
    pub fn is_by_arm_angle(&self) -> bool {
        self.by_arm_angle.is_some()
    }

    /// Whether [`Self::arcs`] end exactly where the branches end, so that no branch is lost there. Otherwise solutions may
    /// hide near folds.
    pub fn is_sure_of_arcs(&self) -> bool {
        self.arm.distance.is_some() && self.arm.is_exact()
    }

    /// Returns all configurations with the parameter at `value`.
    pub fn branches_at(&self, value: f64) -> ArmBranches {
        ArmBranches::of(&self.solve(value), &self.arm.drives)
    }

    /// Returns all axis values, angles in (-pi, pi], with the parameter at `value` (rad, m).
    pub(super) fn solve(&self, value: f64) -> Branches<7> {
        match &self.arm.method {
            Method::Given(given) => given.solve(&self.goal, value),
            Method::ArmAngle(_) => {
                let mut candidates = Candidates::new();
                self.add_candidates(value, &[AngleRange::ANY; 7], &mut candidates);
                verified(&self.arm.verifier, &self.goal, &candidates)
            }
        }
    }

    /// Finds configurations with the parameter at `value` that bring the tip to the pose, to be confirmed by forward
    /// kinematics; cheaper than [`Self::branches_at`]. The result includes every configuration within the limits.
    #[inline]
    pub fn likely_at(&self, value: f64, limits: &FamilyLimits, found: &mut ArmConfigurations) {
        if self.arm.is_exact() {
            self.candidates_at(value, limits, found);
        } else {
            *found = self.branches_at(value).configurations();
        }
    }

    /// Whether the structure of the arm holds only approximately, so that [`Self::candidates_at`] yields configurations near
    /// the solutions.
    pub fn is_approximate(&self) -> bool {
        self.arm.structure().is_some_and(Structure::is_nearly)
    }

    /// Finds the candidates of the closed form within the limits, with the parameter at `value`; none for the general method.
    #[inline]
    pub fn candidates_at(&self, value: f64, limits: &FamilyLimits, found: &mut ArmConfigurations) {
        let mut candidates = Candidates::new();
        self.add_candidates(value, &limits.ranges, &mut candidates);
        let write = |columns: &mut _| write_values(&self.arm.verifier, &candidates, columns);
        found.replace(&self.arm.drives, candidates.count, write);
    }

    /// Adds candidates with the parameter at `value` (rad, m), as far as `ranges` may hold them.
    fn add_candidates(&self, value: f64, ranges: &[AngleRange; 7], found: &mut Candidates) {
        match (&self.arm.method, &self.by_arm_angle) {
            (Method::Given(given), _) => given.add_candidates(&self.goal, value, ranges, found),
            (_, Some((method, pose))) => arm_angle_candidates(method, pose, Angle::by(value), ranges, found),
            (Method::ArmAngle(_), None) => {}
        }
    }

    /// Calls `visit` with the configurations at each of `values`, several values at a time, until it returns false. The
    /// configurations include every one within the limits.
    pub fn visit_within(
        &self,
        limits: &FamilyLimits,
        values: impl Iterator<Item = f64>,
        mut visit: impl FnMut(&ArmBranches) -> bool,
    ) {
        if !self.arm.is_exact() {
            values.map(|value| self.branches_at(value)).all(|branches| visit(&branches));
            return;
        }
        let mut candidates = Candidates::new();
        for value in values {
            self.add_candidates(value, &limits.ranges, &mut candidates);
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
        let verified = ArmBranches::of(&verified(&self.arm.verifier, &self.goal, candidates), &self.arm.drives);
        let count = candidates.count;
        candidates.count = all;
        candidates.remove_first(count);
        verified
    }
}

by_instructions! {
    fn arm_angle_candidates(
        method: &ArmAngle,
        pose: &ArmAnglePose,
        arm_angle: Angle,
        ranges: &[AngleRange; 7],
        found: &mut Candidates,
    ) {
        method.solve(pose, arm_angle, ranges, found);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_form::axis_chain::AxisChain;
    use crate::closed_form::configurations::Drives;
    use crate::closed_form::seven_joint_arms::{IIWA14, PANDA, random_angles};

    const LIMITS: [[f64; 7]; 2] = [[-2.9, -1.8, -2.9, -3.07, -2.9, -0.1, -2.9], [2.9, 1.8, 2.9, -0.07, 2.9, 3.75, 2.9]];

    fn arm_of(chain: &AxisChain<7>, [lower, upper]: [[f64; 7]; 2]) -> Redundant {
        let drives = Drives::new((0..7).map(|joint| (joint, 1.0)));
        Redundant::new(chain, &drives, [&lower, &upper]).expect("a method")
    }

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
            let arm = arm_of(&chain, LIMITS);
            let limits = arm.limits(&LIMITS[0], &LIMITS[1]);
            let mut inside = 0;
            for mut q in random_angles(50) {
                (0..7).for_each(|k| q[k] = q[k].clamp(LIMITS[0][k], LIMITS[1][k]));
                let family = PoseFamily::new(&arm, &chain.tip_at(&q));
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
        let arm = arm_of(&chain, LIMITS);
        let mut decided = [0, 0];
        for (trial, q) in random_angles(400).into_iter().enumerate() {
            // Ranges around another configuration, some wide and some narrow, some with a joint exactly at its limit.
            let half = 0.3 + 0.3 * (trial % 9) as f64;
            let middle: [f64; 7] = std::array::from_fn(|k| q[(k + 2) % 7] * 0.5 + q[k] * 0.5);
            let mut limits = [middle.map(|m| m - half), middle.map(|m| m + half)];
            if trial % 4 == 0 {
                (limits[0][0], limits[1][4]) = (q[0], q[4]);
            }
            let all = arm.limits(&limits[0], &limits[1]);
            let family = PoseFamily::new(&arm, &chain.tip_at(&q));
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
        let arm = arm_of(&chain, LIMITS);
        let limits = arm.limits(&[-3.2; 7], &[3.2; 7]);
        let family = PoseFamily::new(&arm, &chain.tip_at(&[0.4; 7]));
        let mut visits = 0;
        family.visit_within(&limits, (0..100).map(|k| 0.06 * f64::from(k)), |_| {
            visits += 1;
            visits < 3
        });
        assert_eq!(visits, 3);
    }
}
