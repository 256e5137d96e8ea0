//! Closed form of seven joints: chooses the self-motion parameter.
//!
//! The parameter is the arm angle if the first and the last three axes meet (shoulder and wrist of an SRS arm): the angle of
//! the elbow axis about the shoulder-wrist line. Otherwise it is the first or the last joint, whichever leaves six joints
//! with the better method.

use crate::closed_form::angle_range::AngleRange;
use crate::closed_form::arm_angle::ArmAngle;
use crate::closed_form::axis_chain::{AxisChain, AxisKind};
use crate::closed_form::configurations::Drives;
use crate::closed_form::elbow_distance::ElbowDistance;
use crate::closed_form::given_joint::GivenJoint;
use crate::closed_form::limit_proof::LimitProof;
use crate::closed_form::six::Structure;
use crate::closed_form::verify::Verifier;
use crate::math::Frame;

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
    pub(super) chain: AxisChain<7>,
    pub(super) back: Frame,
    pub(super) method: Method,
    pub(super) distance: Option<ElbowDistance>,
    /// Proof of infeasibility, used if the parameter is a joint.
    pub(super) proof: Option<Box<LimitProof>>,
    pub(super) verifier: Verifier<7>,
    pub(super) drives: Drives,
    /// Joint limits of the arm.
    own_limits: FamilyLimits,
}

#[derive(Debug, Clone)]
pub(super) enum Method {
    Given(Box<GivenJoint>),
    ArmAngle(Box<ArmAngle>),
}

/// Limits of the axes of a redundant arm, precomputed for any pose.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FamilyLimits {
    /// Lower and upper limits (rad, m).
    pub(super) axes: [[f64; 2]; 7],
    pub(super) ranges: [AngleRange; 7],
    /// Smallest and largest squared shoulder-wrist distance within the limits of joint 4.
    pub(super) distances: [f64; 2],
}

impl FamilyLimits {
    fn new(chain: &AxisChain<7>, distance: Option<&ElbowDistance>, axes: [[f64; 2]; 7]) -> Self {
        let ranges = std::array::from_fn(|k| match chain.joints[k].motion {
            AxisKind::Turns => AngleRange::of(axes[k]),
            AxisKind::Slides => AngleRange::ANY,
        });
        Self { axes, ranges, distances: distance.map_or([0.0; 2], |distance| distance.range(axes[3])) }
    }
}

impl Redundant {
    /// Chooses the parameter of an arm with these joint limits (rad, m); `None` if joints are prismatic and no method fits.
    pub fn new(chain: &AxisChain<7>, drives: &Drives, [lower, upper]: [&[f64]; 2]) -> Option<Self> {
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
        let own_limits = FamilyLimits::new(chain, distance.as_ref(), drives.of_axes(lower, upper));
        let (chain, back, drives) = (*chain, chain.tip.inverse(), drives.clone());
        Some(Self { chain, back, method, distance, proof, verifier, drives, own_limits })
    }

    /// Returns the self-motion parameter.
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

    /// Whether candidates are solutions up to rounding, and no others exist at a value of the parameter.
    pub fn is_exact(&self) -> bool {
        self.structure().is_none_or(Structure::is_exact)
    }

    /// Prepares joint limits `lower` and `upper` (n,) (rad, m).
    pub fn limits(&self, lower: &[f64], upper: &[f64]) -> FamilyLimits {
        let axes = self.drives.of_axes(lower, upper);
        let is_own = self.own_limits.axes == axes;
        if is_own { self.own_limits } else { FamilyLimits::new(&self.chain, self.distance.as_ref(), axes) }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2 as Q, PI, TAU};

    use super::*;
    use crate::closed_form::axis_chain::JointAxis;
    use crate::closed_form::branches::Doubt;
    use crate::closed_form::pose_family::PoseFamily;
    use crate::closed_form::seven_joint_arms::{
        BAXTER, GEN3, IIWA14, PANDA, SAWYER, XARM7, iiwa14_of_urdf, random_angles,
    };
    use crate::math::vector::between;
    use crate::math::vector3::{norm, sub};

    const FREE: [[f64; 2]; 7] = [[-PI, PI]; 7];

    /// Returns the largest angle difference modulo 2 pi.
    fn apart(a: &[f64; 7], b: &[f64; 7]) -> f64 {
        a.iter().zip(b).map(|(a, b)| ((a - b + PI).rem_euclid(TAU) - PI).abs()).fold(0.0, f64::max)
    }

    /// Returns the closed form of a chain whose joints have these limits.
    fn method_of(chain: &AxisChain<7>, limits: [[f64; 2]; 7]) -> Redundant {
        let drives = Drives::new((0..7).map(|joint| (joint, 1.0)));
        Redundant::new(chain, &drives, [&limits.map(|ends| ends[0]), &limits.map(|ends| ends[1])]).expect("a method")
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
            let method = method_of(&chain, FREE);
            let Parameter::Axis(axis) = method.parameter() else { panic!("{rows:?}") };
            let is_general = general.contains(&rows);
            assert_eq!(method.structure() == Some(Structure::General), is_general);
            assert!(is_general || axis == if by_last.contains(&rows) { 6 } else { 0 });
            for q in random_angles(if is_general { 40 } else { 300 }) {
                let target = chain.tip_at(&q);
                let found = PoseFamily::new(&method, &target).solve(q[axis]);
                assert!(found.iter().all(|b| miss(&chain, b, &target) < 2e-10));
                assert!(found.iter().any(|b| apart(b, &q) < 1e-5), "{rows:?} {q:?}");
            }
        }
    }

    #[test]
    fn an_srs_arm_has_eight_branches_at_every_arm_angle() {
        let chain = AxisChain::of_rows(&IIWA14);
        let method = method_of(&chain, FREE);
        assert_eq!(method.parameter(), Parameter::ArmAngle);
        for q in random_angles(200) {
            let target = chain.tip_at(&q);
            for angle in q {
                let found = PoseFamily::new(&method, &target).solve(angle);
                assert!(found.len() == 8 && found.doubt == Doubt::None);
                assert!(found.iter().all(|b| miss(&chain, b, &target) < 2e-10));
            }
        }
    }

    #[test]
    fn the_arm_angle_passes_every_configuration() {
        let chain = AxisChain::of_rows(&IIWA14);
        let method = method_of(&chain, FREE);
        for q in random_angles(20) {
            let target = chain.tip_at(&q);
            let angles = (0..2000).map(|k| PI * f64::from(k - 1000) / 1000.0);
            let all = angles.flat_map(|angle| PoseFamily::new(&method, &target).solve(angle).to_vec());
            let nearest = all.map(|b| apart(&b, &q)).fold(f64::INFINITY, f64::min);
            assert!(nearest < 0.2, "{nearest}");
        }
    }

    #[test]
    fn the_arcs_hold_every_configuration_within_limits() {
        let chain = AxisChain::of_rows(&PANDA);
        let mut limits = [[-2.8973, 2.8973]; 7];
        limits[3] = [-3.0718, -0.0698];
        let method = method_of(&chain, limits);
        let mut narrowed = 0;
        for (count, mut q) in random_angles(300).into_iter().enumerate() {
            (0..7).for_each(|k| q[k] = q[k].clamp(limits[k][0], limits[k][1]));
            if count % 3 == 0 {
                q[3] = limits[3][count % 2];
            }
            let target = chain.tip_at(&q);
            let arcs = PoseFamily::new(&method, &target).arcs(&method.own_limits);
            assert!(arcs.iter().any(|[a, b]| a - 1e-6 <= q[6] && q[6] <= b + 1e-6), "{q:?} {arcs:?}");
            narrowed += usize::from(arcs.length() < 5.0);
            for [a, b] in arcs.iter() {
                for part in [0.02, 0.5, 0.98] {
                    let found = PoseFamily::new(&method, &target).solve(between(*a, *b, part));
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
        let method = method_of(&chain, [[-1.0, 2.0]; 7]);
        assert_eq!(method.parameter(), Parameter::Axis(0));
        for q in random_angles(100) {
            let target = chain.tip_at(&q);
            assert!(PoseFamily::new(&method, &target).solve(q[0]).iter().any(|b| apart(b, &q) < 1e-5), "{q:?}");
            assert_eq!(*PoseFamily::new(&method, &target).arcs(&method.own_limits), [[-1.0, 2.0]]);
        }
    }
}
