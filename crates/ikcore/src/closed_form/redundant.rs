//! Seven joints and a pose: all branches for a value of the self-motion parameter.
//!
//! The parameter is the arm angle if the first and the last three axes meet (shoulder and wrist of an SRS arm): the angle of
//! the elbow axis about the shoulder-wrist line. Otherwise it is the first or the last joint, whichever leaves six joints
//! with the better method.

use crate::closed_form::angle::Angle;
use crate::closed_form::angle_range::AngleRange;
use crate::closed_form::arm_angle::{ArmAngle, ArmAnglePose};
use crate::closed_form::arm_angle_limits::{Decisive, Values};
use crate::closed_form::axis_chain::{AxisChain, AxisKind};
use crate::closed_form::branches::{Branches, Candidates};
use crate::closed_form::elbow_distance::ElbowDistance;
use crate::closed_form::given_joint::GivenJoint;
use crate::closed_form::limit_proof::LimitProof;
use crate::closed_form::parameter_arcs::ParameterArcs;
use crate::closed_form::six::Structure;
use crate::closed_form::verify::{Verifier, verified_seven};
use crate::math::Frame;
use crate::math::arithmetic::{Baseline, by_instructions};

/// Self-motion parameter of a redundant arm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parameter {
    /// Value of this axis (rad, m), counted from 0.
    Axis(usize),
    /// Angle of the elbow axis about the shoulder-wrist line (rad).
    ArmAngle,
}

/// Closed form of seven joints.
#[derive(Debug, Clone)]
pub struct Redundant {
    chain: AxisChain<7>,
    back: Frame,
    method: Method,
    distance: Option<ElbowDistance>,
    /// Proof of infeasibility, used if the parameter is a joint.
    proof: Option<Box<LimitProof>>,
    verifier: Verifier<7>,
}

#[derive(Debug, Clone)]
enum Method {
    Given(Box<GivenJoint>),
    ArmAngle(Box<ArmAngle>),
}

/// Pose, precomputed for any value of the parameter.
#[derive(Debug, Clone, Copy)]
pub struct RedundantPose {
    /// Displacement that all joints together must produce.
    goal: Frame,
    by_arm_angle: Option<ArmAnglePose>,
}

/// Limits of the axes (rad, m), precomputed for any pose.
#[derive(Debug, Clone, Copy)]
pub struct AxisLimits {
    /// Lower and upper limits.
    pub axes: [[f64; 2]; 7],
    ranges: [AngleRange; 7],
    /// Smallest and largest squared shoulder-wrist distance within the limits of joint 4.
    distances: [f64; 2],
}

impl Redundant {
    /// Chooses the parameter; `None` if joints are prismatic and no method fits.
    pub fn new(chain: &AxisChain<7>) -> Option<Self> {
        let (method, distance, proof) = match ArmAngle::new(chain) {
            Some(method) => (Method::ArmAngle(Box::new(method)), ElbowDistance::by_last(chain), None),
            None => {
                let given = GivenJoint::new(chain)?;
                let by_first = given.axis() == 0;
                let distance = if by_first { ElbowDistance::by_first(chain) } else { ElbowDistance::by_last(chain) };
                let proof = distance.and_then(|_| LimitProof::new(chain, by_first)).map(Box::new);
                (Method::Given(Box::new(given)), distance, proof)
            }
        };
        let verifier = Verifier::new(&AxisChain { tip: Frame::IDENTITY, ..*chain }, 1e-3);
        Some(Self { chain: *chain, back: chain.tip.inverse(), method, distance, proof, verifier })
    }

    /// Returns the parameter that [`Self::solve`] takes.
    pub fn parameter(&self) -> Parameter {
        match &self.method {
            Method::Given(given) => Parameter::Axis(given.axis()),
            Method::ArmAngle(_) => Parameter::ArmAngle,
        }
    }

    /// Returns the structure of the six joints left when the parameter is fixed; `None` for the arm angle.
    pub fn structure(&self) -> Option<Structure> {
        match &self.method {
            Method::Given(given) => Some(given.structure()),
            Method::ArmAngle(_) => None,
        }
    }

    /// Whether [`Self::add_candidates`] finds all configurations up to rounding.
    pub fn has_exact_candidates(&self) -> bool {
        match &self.method {
            Method::Given(given) => given.has_exact_candidates(),
            Method::ArmAngle(_) => true,
        }
    }

    /// Whether [`Self::add_candidates`] finds only approximate configurations, because the structure holds only
    /// approximately.
    pub fn has_approximate_candidates(&self) -> bool {
        self.structure().is_some_and(Structure::is_nearly)
    }

    /// Whether [`Self::arcs`] end exactly where the branches end, so that no branch is lost there.
    pub fn is_sure_of_arcs(&self) -> bool {
        self.distance.is_some() && self.has_exact_candidates()
    }

    /// Prepares the pose that has the tip at `target`.
    pub fn pose(&self, target: &Frame) -> RedundantPose {
        let goal = target.then::<Baseline>(&self.back);
        let by_arm_angle = match &self.method {
            Method::ArmAngle(method) => Some(method.pose(&goal)),
            _ => None,
        };
        RedundantPose { goal, by_arm_angle }
    }

    /// Prepares limits of the axes (rad, m).
    pub fn limits(&self, axes: [[f64; 2]; 7]) -> AxisLimits {
        let ranges = std::array::from_fn(|k| match self.chain.joints[k].motion {
            AxisKind::Turns => AngleRange::of(axes[k]),
            AxisKind::Slides => AngleRange::ANY,
        });
        let distances = self.distance.map_or([0.0; 2], |distance| distance.range(axes[3]));
        AxisLimits { axes, ranges, distances }
    }

    /// Returns all joint values, angles in (-pi, pi], that reach a pose with the parameter at `value` (rad, m).
    pub fn solve(&self, pose: &RedundantPose, value: f64) -> Branches<7> {
        match &self.method {
            Method::Given(given) => given.solve(&pose.goal, value),
            Method::ArmAngle(_) => {
                let mut candidates = Candidates::new();
                self.add_candidates(pose, value, &[AngleRange::ANY; 7], &mut candidates);
                self.verified(pose, &candidates)
            }
        }
    }

    /// Adds candidates that reach a pose with the parameter at `value` (rad, m), as far as `ranges` may hold them.
    fn add_candidates(&self, pose: &RedundantPose, value: f64, ranges: &[AngleRange; 7], found: &mut Candidates) {
        match (&self.method, &pose.by_arm_angle) {
            (Method::Given(given), _) => given.add_candidates(&pose.goal, value, ranges, found),
            (Method::ArmAngle(method), Some(pose)) => {
                arm_angle_candidates(method, pose, Angle::by(value), ranges, found);
            }
            (Method::ArmAngle(_), None) => {}
        }
    }

    /// Adds candidates that reach a pose with the parameter at `value` (rad, m), as far as `limits` may hold them.
    pub fn add_candidates_within(&self, pose: &RedundantPose, value: f64, limits: &AxisLimits, found: &mut Candidates) {
        self.add_candidates(pose, value, &limits.ranges, found);
    }

    /// Verifies candidates by forward kinematics.
    pub fn verified(&self, pose: &RedundantPose, candidates: &Candidates) -> Branches<7> {
        verified_seven(&self.verifier, &pose.goal, candidates)
    }

    /// Returns the verifier, which converts candidates to joint values.
    pub fn verifier(&self) -> &Verifier<7> {
        &self.verifier
    }

    /// Whether the limits provably exclude every value of the parameter, although [`Self::arcs`] leaves `arcs`.
    pub fn is_excluded(&self, pose: &RedundantPose, limits: &AxisLimits, arcs: &ParameterArcs) -> bool {
        match (&self.method, &pose.by_arm_angle) {
            (Method::ArmAngle(method), Some(pose)) => method.is_excluded(pose, &limits.axes, &limits.ranges[3]),
            _ => self.open_values(pose, limits, arcs, 1, &mut |_| false).is_some_and(|open| open.is_empty()),
        }
    }

    /// Returns parameter values (rad) on `arcs` near which a configuration may lie within limits, as in
    /// [`LimitProof::open_values`]; `None` if that proof does not apply.
    pub fn open_values(
        &self,
        pose: &RedundantPose,
        limits: &AxisLimits,
        arcs: &ParameterArcs,
        most: usize,
        visit: &mut dyn FnMut(f64) -> bool,
    ) -> Option<Values> {
        let proof = self.proof.as_deref()?;
        Some(proof.open_values(&pose.goal, arcs, &limits.axes, most, visit))
    }

    /// Returns parameter values that decide whether any configuration lies within limits; `None` if no such set is known.
    pub fn decisive(&self, pose: &RedundantPose, limits: &AxisLimits) -> Option<Decisive> {
        match (&self.method, &pose.by_arm_angle) {
            (Method::ArmAngle(method), Some(by_angle)) => {
                Some(method.decisive(by_angle, &pose.goal, &limits.axes, &limits.ranges[3]))
            }
            _ => None,
        }
    }

    /// Returns arcs of the parameter outside which joint 4 or the parameter's own joint violates its limits.
    ///
    /// The ends are exact, so that an arc of zero length, with joint 4 at its limit, is not lost between samples.
    pub fn arcs(&self, pose: &RedundantPose, limits: &AxisLimits) -> ParameterArcs {
        let AxisLimits { axes, distances, .. } = limits;
        match (self.parameter(), &self.distance) {
            (Parameter::ArmAngle, Some(distance)) => distance.arm_angles(&pose.goal, *distances),
            (Parameter::ArmAngle, None) => ParameterArcs::CIRCLE,
            (Parameter::Axis(axis), _) if self.chain.joints[axis].motion == AxisKind::Slides => {
                ParameterArcs::one(axes[axis])
            }
            (Parameter::Axis(axis), Some(distance)) => distance.angles(&pose.goal, *distances).within(axes[axis]),
            (Parameter::Axis(axis), None) => ParameterArcs::CIRCLE.within(axes[axis]),
        }
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
    use std::f64::consts::{FRAC_PI_2 as Q, PI, TAU};

    use super::*;
    use crate::closed_form::axis_chain::JointAxis;
    use crate::closed_form::branches::Doubt;
    use crate::closed_form::seven_joint_arms::{
        BAXTER, GEN3, IIWA14, PANDA, SAWYER, XARM7, iiwa14_of_urdf, random_angles,
    };
    use crate::closed_form::vector::{norm, sub};
    use crate::math::vector::between;

    /// Returns the largest angle difference modulo 2 pi.
    fn apart(a: &[f64; 7], b: &[f64; 7]) -> f64 {
        a.iter().zip(b).map(|(a, b)| ((a - b + PI).rem_euclid(TAU) - PI).abs()).fold(0.0, f64::max)
    }

    fn miss(chain: &AxisChain<7>, q: &[f64; 7], target: &Frame) -> f64 {
        let tip = chain.tip_at(q);
        (0..3).fold(norm(&sub(&tip.origin, &target.origin)), |most, k| {
            most.max(norm(&sub(&tip.axes[k], &target.axes[k])))
        })
    }

    #[test]
    fn a_known_configuration_is_among_its_branches() {
        let by_last = [PANDA, XARM7];
        let by_first = [GEN3, iiwa14_of_urdf()];
        let general = [SAWYER, BAXTER];
        for rows in by_last.into_iter().chain(by_first).chain(general) {
            let chain = AxisChain::of_rows(&rows);
            let method = Redundant::new(&chain).expect("a method");
            let Parameter::Axis(axis) = method.parameter() else { panic!("{rows:?}") };
            let is_general = general.contains(&rows);
            assert_eq!(method.structure() == Some(Structure::General), is_general);
            assert!(is_general || axis == if by_last.contains(&rows) { 6 } else { 0 });
            for q in random_angles(if is_general { 40 } else { 300 }) {
                let target = chain.tip_at(&q);
                let found = method.solve(&method.pose(&target), q[axis]);
                assert!(found.iter().all(|b| miss(&chain, b, &target) < 2e-10));
                assert!(found.iter().any(|b| apart(b, &q) < 1e-5), "{rows:?} {q:?}");
            }
        }
    }

    #[test]
    fn an_srs_arm_has_eight_branches_at_every_arm_angle() {
        let chain = AxisChain::of_rows(&IIWA14);
        let method = Redundant::new(&chain).expect("a method");
        assert_eq!(method.parameter(), Parameter::ArmAngle);
        for q in random_angles(200) {
            let target = chain.tip_at(&q);
            for angle in q {
                let found = method.solve(&method.pose(&target), angle);
                assert!(found.len() == 8 && found.doubt == Doubt::None);
                assert!(found.iter().all(|b| miss(&chain, b, &target) < 2e-10));
            }
        }
    }

    #[test]
    fn the_arm_angle_passes_every_configuration() {
        let chain = AxisChain::of_rows(&IIWA14);
        let method = Redundant::new(&chain).expect("a method");
        for q in random_angles(20) {
            let target = chain.tip_at(&q);
            let angles = (0..2000).map(|k| PI * f64::from(k - 1000) / 1000.0);
            let all = angles.flat_map(|angle| method.solve(&method.pose(&target), angle).to_vec());
            let nearest = all.map(|b| apart(&b, &q)).fold(f64::INFINITY, f64::min);
            assert!(nearest < 0.2, "{nearest}");
        }
    }

    #[test]
    fn the_arcs_hold_every_configuration_within_limits() {
        let chain = AxisChain::of_rows(&PANDA);
        let method = Redundant::new(&chain).expect("a method");
        let mut limits = [[-2.8973, 2.8973]; 7];
        limits[3] = [-3.0718, -0.0698];
        let mut narrowed = 0;
        for (count, mut q) in random_angles(300).into_iter().enumerate() {
            (0..7).for_each(|k| q[k] = q[k].clamp(limits[k][0], limits[k][1]));
            if count % 3 == 0 {
                q[3] = limits[3][count % 2];
            }
            let target = chain.tip_at(&q);
            let arcs = method.arcs(&method.pose(&target), &method.limits(limits));
            assert!(arcs.iter().any(|[a, b]| a - 1e-6 <= q[6] && q[6] <= b + 1e-6), "{q:?} {arcs:?}");
            narrowed += usize::from(arcs.length() < 5.0);
            for [a, b] in arcs.iter() {
                for part in [0.02, 0.5, 0.98] {
                    let found = method.solve(&method.pose(&target), between(*a, *b, part));
                    let within = |q: f64| limits[3][0] - 1e-4 <= q && q <= limits[3][1] + 1e-4;
                    assert!(found.is_empty() || found.iter().any(|set| within(set[3])), "{q:?}");
                }
            }
        }
        assert!(narrowed > 50, "the limits of joint 4 narrow the arcs of {narrowed} poses");
    }

    #[test]
    fn an_arm_on_a_rail_has_the_rail_as_parameter() {
        let ur10 = AxisChain::of_rows(&[
            [0.0, Q, 0.1273, 0.0],
            [-0.612, 0.0, 0.0, 0.0],
            [-0.5723, 0.0, 0.0, 0.0],
            [0.0, Q, 0.163941, 0.0],
            [0.0, -Q, 0.1157, 0.0],
            [0.0, 0.0, 0.0922, 0.0],
        ]);
        let mut joints = [JointAxis::sliding([1.0, 0.0, 0.0]); 7];
        joints[1..].copy_from_slice(&ur10.joints);
        let chain = AxisChain { joints, tip: ur10.tip };
        let method = Redundant::new(&chain).expect("a method");
        assert_eq!(method.parameter(), Parameter::Axis(0));
        for q in random_angles(100) {
            let target = chain.tip_at(&q);
            assert!(method.solve(&method.pose(&target), q[0]).iter().any(|b| apart(b, &q) < 1e-5), "{q:?}");
            assert_eq!(*method.arcs(&method.pose(&target), &method.limits([[-1.0, 2.0]; 7])), [[-1.0, 2.0]]);
        }
    }
}
