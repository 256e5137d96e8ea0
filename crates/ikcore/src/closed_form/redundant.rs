//! Seven joints and a pose: the one parameter of the self-motion, and all branches for a value of it.
//!
//! The parameter is the first or the last joint, whichever leaves six joints with the better method, or the arm angle where the
//! first and the last three axes meet (shoulder and wrist of an SRS arm): the angle of the elbow's axis about the line from shoulder
//! to wrist.

use crate::closed_form::angle::Angle;
use crate::closed_form::arm_angle::ArmAngle;
use crate::closed_form::axis_chain::{AxisChain, AxisMotion};
use crate::closed_form::branches::{Branches, Candidates};
use crate::closed_form::parameter_arcs::{ParameterArcs, Wave};
use crate::closed_form::six::{ClosedForm, Structure};
use crate::closed_form::structure::{EXACT, Pair, three_meet};
use crate::closed_form::vector::{Vector, dot, sub};
use crate::closed_form::verify::{Verifier, verified_seven};
use crate::math::Frame;
use crate::math::arithmetic::Baseline;

/// What is given besides the pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parameter {
    /// The value of this axis (rad, m), counted from 0.
    Axis(usize),
    /// The angle of the elbow's axis about the line from shoulder to wrist (rad).
    ArmAngle,
}

/// The method for a chain of seven joints.
#[derive(Debug, Clone)]
pub struct Redundant {
    chain: AxisChain<7>,
    back: Frame,
    method: Method,
    distance: Option<Distance>,
}

#[derive(Debug, Clone)]
enum Method {
    /// The first joint is given: the others see the target from where it puts them.
    First(Box<ClosedForm>),
    /// The last joint is given: it moves the tip.
    Last(Box<ClosedForm>),
    ArmAngle(Box<(ArmAngle, Verifier<7>)>),
}

/// Shoulder and a point on axes 5 and 6: their distance determines joint 4, given joint 7 or a spherical wrist.
#[derive(Debug, Clone, Copy)]
struct Distance {
    shoulder: Vector,
    wrist: Vector,
}

impl Redundant {
    /// Chooses the parameter; `None` where joints slide and no method fits.
    pub fn new(chain: &AxisChain<7>) -> Option<Self> {
        let (mut distance, back) = (None, chain.tip.inverse());
        let method = match ArmAngle::new(chain) {
            Some(method) => {
                distance = Distance::of(chain);
                let untipped = AxisChain { tip: Frame::IDENTITY, ..*chain };
                Method::ArmAngle(Box::new((method, Verifier::new(&untipped, 1e-3))))
            }
            None => {
                let (last, first) = (six_without(chain, 6), six_without(chain, 0));
                match (rank(&last), rank(&first)) {
                    (Some(of_last), of_first) if of_first.is_none_or(|of_first| of_last <= of_first) => {
                        distance = Distance::of(chain);
                        Method::Last(Box::new(last))
                    }
                    (_, Some(_)) => Method::First(Box::new(first)),
                    _ => return None,
                }
            }
        };
        Some(Self { chain: *chain, back, method, distance })
    }

    /// What the value in [`Self::solve`] means.
    pub fn parameter(&self) -> Parameter {
        match self.method {
            Method::First(_) => Parameter::Axis(0),
            Method::Last(_) => Parameter::Axis(6),
            Method::ArmAngle(_) => Parameter::ArmAngle,
        }
    }

    /// The structure of the six joints that are left with the parameter given; `None` for the arm angle.
    pub fn structure(&self) -> Option<Structure> {
        match &self.method {
            Method::First(form) | Method::Last(form) => Some(form.structure()),
            Method::ArmAngle(_) => None,
        }
    }

    /// What the joints together must do to bring the tip to `target`: the product of their displacements.
    pub fn displacement(&self, target: &Frame) -> Frame {
        target.then::<Baseline>(&self.back)
    }

    /// All joint values, angles in (-pi, pi], that together displace by `goal` with the parameter at `value` (rad, m).
    pub fn solve(&self, goal: &Frame, value: f64) -> Branches<7> {
        let [first, .., last] = &self.chain.joints;
        match &self.method {
            // E2 ... E7 = E1^-1 goal.
            Method::First(form) => {
                let left = first.displacement(-value).then::<Baseline>(goal);
                self.inserted(&form.solve_displacement(&left, &left), 0, value)
            }
            // E1 ... E6 = goal E7^-1.
            Method::Last(form) => {
                let left = goal.then::<Baseline>(&last.displacement(-value));
                self.inserted(&form.solve_displacement(&left, &left), 6, value)
            }
            Method::ArmAngle(prepared) => {
                let (method, verifier) = &**prepared;
                let mut candidates = Candidates::new();
                method.solve(goal, Angle::by(value), &mut candidates);
                let mut found = verified_seven(verifier, goal, &candidates);
                found.complete = true;
                found
            }
        }
    }

    /// The values of the parameter outside which joint 4 or the parameter's own joint cannot be within limits, given by axis (rad,
    /// m).
    ///
    /// Exact, so that an arc shrunk to a point, with joint 4 at its limit, is not lost between samples.
    pub fn arcs(&self, goal: &Frame, limits: &[[f64; 2]; 7]) -> ParameterArcs {
        let Parameter::Axis(axis) = self.parameter() else { return self.arm_angles(goal, limits[3]) };
        if self.chain.joints[axis].motion == AxisMotion::Slides {
            return ParameterArcs::one(limits[axis]);
        }
        let reached = match &self.distance {
            Some(distance) => self.arcs_by_distance(distance, goal, limits[3]),
            None => ParameterArcs::CIRCLE,
        };
        reached.within(limits[axis])
    }

    /// All arm angles, or none: the distance of shoulder and wrist alone determines joint 4.
    fn arm_angles(&self, goal: &Frame, limits: [f64; 2]) -> ParameterArcs {
        let Some(Distance { shoulder, wrist }) = &self.distance else { return ParameterArcs::CIRCLE };
        let square = |from_tip: &Frame| squared_distance(&from_tip.place::<Baseline>(wrist), shoulder);
        let reached = square(goal);
        let by_joint_4 = Wave::of(|q| square(&self.chain.joints[3].displacement(q)));
        Wave::of(|_| reached).arcs_between(by_joint_4.range(limits))
    }

    fn arcs_by_distance(&self, distance: &Distance, goal: &Frame, limits: [f64; 2]) -> ParameterArcs {
        let Distance { shoulder, wrist } = distance;
        let square = |from_tip: &Frame| squared_distance(&from_tip.place::<Baseline>(wrist), shoulder);
        let by_joint_4 = |q: f64| square(&self.chain.joints[3].displacement(q));
        let by_joint_7 = |q: f64| square(&goal.then::<Baseline>(&self.chain.joints[6].displacement(-q)));
        Wave::of(by_joint_7).arcs_between(Wave::of(by_joint_4).range(limits))
    }

    /// The branches of six joints with the value of one more.
    fn inserted(&self, six: &Branches<6>, joint: usize, value: f64) -> Branches<7> {
        let mut seven = Branches::none();
        (seven.complete, seven.singular, seven.evaluations) = (six.complete, six.singular, six.evaluations);
        seven.nearly = six.nearly;
        let turns = self.chain.joints[joint].motion == AxisMotion::Turns;
        let value = if turns { Angle::by(value).angle() } else { value };
        for (set, error) in six.iter().zip(six.errors()) {
            let values = std::array::from_fn(|k| match k {
                k if k < joint => set[k],
                k if k == joint => value,
                k => set[k - 1],
            });
            seven.push(values, *error);
        }
        seven
    }
}

fn squared_distance(a: &Vector, b: &Vector) -> f64 {
    let way = sub(a, b);
    dot(&way, &way)
}

/// The closed form of the chain without one joint; its tip is the displacement of the others.
fn six_without(chain: &AxisChain<7>, skipped: usize) -> ClosedForm {
    let joints = std::array::from_fn(|k| chain.joints[if k < skipped { k } else { k + 1 }]);
    // A few solutions lost beside folds matter less than the time where only samples are asked for.
    ClosedForm::structured(&AxisChain { joints, tip: Frame::IDENTITY })
}

/// How good a method is, best first.
fn rank(form: &ClosedForm) -> Option<u8> {
    match form.structure() {
        Structure::ThreeMeet { nearly: false, .. } => Some(0),
        Structure::ThreeParallel { nearly: false, .. } => Some(1),
        Structure::ThreeMeet { nearly: true, .. } => Some(2),
        Structure::ThreeParallel { nearly: true, .. } => Some(3),
        Structure::General => Some(4),
        Structure::Unsolved => None,
    }
}

impl Distance {
    /// Where the first three axes meet and axes 5 and 6 do, joint 7 given.
    fn of(chain: &AxisChain<7>) -> Option<Self> {
        if chain.joints.iter().any(|joint| joint.motion != AxisMotion::Turns) {
            return None;
        }
        let size = chain.size();
        let shoulder = three_meet(&chain.joints[..3], size, EXACT)?;
        match Pair::of(&chain.joints[4], &chain.joints[5], size, EXACT) {
            Pair::Meet(wrist) => Some(Self { shoulder, wrist }),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2 as Q, PI, TAU};

    use super::*;
    use crate::closed_form::axis_chain::JointAxis;
    use crate::closed_form::vector::norm;
    use crate::rng;

    const PANDA: [[f64; 4]; 7] = [
        [0.0, -Q, 0.333, 0.0],
        [0.0, Q, 0.0, 0.0],
        [0.0825, Q, 0.316, 0.0],
        [-0.0825, -Q, 0.0, 0.0],
        [0.0, Q, 0.384, 0.0],
        [0.088, Q, 0.0, 0.0],
        [0.0, 0.0, 0.107, 0.0],
    ];
    const IIWA14: [[f64; 4]; 7] = [
        [0.0, -Q, 0.36, 0.0],
        [0.0, Q, 0.0, 0.0],
        [0.0, Q, 0.42, 0.0],
        [0.0, -Q, 0.0, 0.0],
        [0.0, -Q, 0.4, 0.0],
        [0.0, Q, 0.0, 0.0],
        [0.0, 0.0, 0.126, 0.0],
    ];
    const GEN3: [[f64; 4]; 7] = [
        [0.0, Q, -0.2848, 0.0],
        [0.0, Q, -0.0118, PI],
        [0.0, Q, -0.4208, PI],
        [0.0, Q, -0.0128, PI],
        [0.0, Q, -0.3143, PI],
        [0.0, Q, 0.0, PI],
        [0.0, PI, -0.1674, PI],
    ];
    const XARM7: [[f64; 4]; 7] = [
        [0.0, -Q, 0.267, 0.0],
        [0.0, Q, 0.0, 0.0],
        [0.0525, Q, 0.293, 0.0],
        [0.0775, Q, 0.0, 0.0],
        [0.0, Q, 0.3425, 0.0],
        [0.076, -Q, 0.0, 0.0],
        [0.0, 0.0, 0.097, 0.0],
    ];
    const SAWYER: [[f64; 4]; 7] = [
        [0.081, -Q, 0.317, 0.0],
        [0.0, Q, 0.1925, Q],
        [0.0, -Q, 0.4, 0.0],
        [0.0, Q, -0.1685, 0.0],
        [0.0, -Q, 0.4, 0.0],
        [0.0, Q, 0.1366, 0.0],
        [0.0, 0.0, 0.13375, 0.0],
    ];
    const BAXTER: [[f64; 4]; 7] = [
        [0.069, -Q, 0.27035, 0.0],
        [0.0, Q, 0.0, Q],
        [0.069, -Q, 0.36435, 0.0],
        [0.0, Q, 0.0, 0.0],
        [0.01, -Q, 0.37429, 0.0],
        [0.0, Q, 0.0, 0.0],
        [0.0, 0.0, 0.229525, 0.0],
    ];

    /// The public URDF: axes 1 and 2, and 3 and 4, miss each other by 0.436 mm.
    fn iiwa14_of_urdf() -> [[f64; 4]; 7] {
        let mut rows = IIWA14;
        (rows[0][0], rows[2][0]) = (-0.00043624, 0.00043624);
        rows
    }

    fn random_angles(count: usize) -> Vec<[f64; 7]> {
        let mut rng = rng::stream(21, 0);
        (0..count).map(|_| std::array::from_fn(|_| rng.uniform_in(-PI, PI))).collect()
    }

    /// Largest difference of angles, whole turns aside.
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
                let found = method.solve(&method.displacement(&target), q[axis]);
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
                let found = method.solve(&method.displacement(&target), angle);
                assert!(found.len() == 8 && found.complete);
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
            let all = angles.flat_map(|angle| method.solve(&method.displacement(&target), angle).to_vec());
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
            let arcs = method.arcs(&method.displacement(&target), &limits);
            assert!(arcs.iter().any(|[a, b]| a - 1e-6 <= q[6] && q[6] <= b + 1e-6), "{q:?} {arcs:?}");
            narrowed += usize::from(arcs.length() < 5.0);
            for [a, b] in arcs.iter() {
                for part in [0.02, 0.5, 0.98] {
                    let found = method.solve(&method.displacement(&target), a + part * (b - a));
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
            assert!(method.solve(&method.displacement(&target), q[0]).iter().any(|b| apart(b, &q) < 1e-5), "{q:?}");
            assert_eq!(*method.arcs(&method.displacement(&target), &[[-1.0, 2.0]; 7]), [[-1.0, 2.0]]);
        }
    }
}
