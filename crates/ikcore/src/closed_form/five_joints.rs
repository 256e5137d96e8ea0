//! Arms of five revolute joints: all branches for the poses that they reach.
//!
//! A virtual sixth joint is added after the last joint or before the first, so that a method for six joints applies. Branches
//! that leave the virtual joint at zero are solutions; a pose without such a branch is out of reach.

use crate::closed_form::angle::Angle;
use crate::closed_form::axis_chain::{AxisChain, AxisKind, JointAxis};
use crate::closed_form::branches::{Branches, Doubt};
use crate::closed_form::six::{ClosedForm, Structure, samples};
use crate::closed_form::structure::{EXACT, Pair};
use crate::closed_form::verify::Verifier;
use crate::math::Frame;
use crate::math::vector3::{Vector, add, cross, perpendicular, scaled, unit};

/// Largest angle of the virtual joint (rad) at which it is left out without a look at the error.
const NEAR_ZERO: f64 = 1e-4;

/// Largest pose error without the virtual joint (m, rad) from which Newton's method is tried. Near a double root of the six
/// joints, a pose that five joints miss by a tolerance turns the virtual joint by its square root.
const WORTH_POLISHING: f64 = 1e-2;

/// Closed form of five revolute joints.
#[derive(Debug, Clone)]
pub struct FiveJoints {
    six: ClosedForm,
    /// True if the virtual joint is the first.
    before: bool,
    verifier: Verifier<5>,
}

impl FiveJoints {
    /// Adds the virtual joint that gives the best structure; `None` if a joint is prismatic.
    pub fn new(chain: &AxisChain<5>) -> Option<Self> {
        if chain.joints.iter().any(|joint| joint.motion == AxisKind::Slides) {
            return None;
        }
        let with = |joint: JointAxis, before: bool| {
            let mut joints = [joint; 6];
            joints[usize::from(before)..][..5].copy_from_slice(&chain.joints);
            let six = ClosedForm::new(&AxisChain { joints, tip: chain.tip });
            Self { six, before, verifier: Verifier::new(chain, WORTH_POLISHING) }
        };
        let [first, second, .., fourth, fifth] = &chain.joints;
        let size = chain.size();
        let virtual_joints = [
            across(fourth, fifth, size).map(|joint| (joint, false)),
            across(second, first, size).map(|joint| (joint, true)),
            Some((aside(fifth, size), false)),
            Some((aside(first, size), true)),
        ];
        let mut forms: Vec<Self> =
            virtual_joints.into_iter().flatten().map(|(joint, before)| with(joint, before)).collect();
        forms.sort_by_key(|form| match form.structure() {
            Structure::ThreeMeet { nearly: false, .. } | Structure::ThreeParallel { nearly: false, .. } => 0,
            Structure::General => 1,
            _ => 2,
        });
        // Degenerate chains, for example with an axis that coincides with the virtual one, defeat the method.
        forms.into_iter().find(|form| form.finds_samples(chain))
    }

    /// Returns the structure including the virtual joint.
    pub fn structure(&self) -> Structure {
        self.six.structure()
    }

    /// Whether the method reproduces a set of evenly spread configurations.
    fn finds_samples(&self, chain: &AxisChain<5>) -> bool {
        samples().all(|[q @ .., _]| {
            let near = |set: &[f64; 5]| set.iter().zip(&q).all(|(a, b)| (Angle::by(a - b).cos - 1.0).abs() < 1e-6);
            self.solve(&chain.tip_at(&q)).iter().any(near)
        })
    }

    /// Returns all joint angles, in (-pi, pi], that bring the tip to `target`; none if five joints cannot reach it.
    pub fn solve(&self, target: &Frame) -> Branches<5> {
        let six = self.six.solve(target);
        let mut found = Branches::none();
        let without = |set: &[f64; 6]| -> (f64, [f64; 5]) {
            let (added, first) = if self.before { (set[0], 1) } else { (set[5], 0) };
            (added, std::array::from_fn(|k| set[first + k]))
        };
        for set in six.iter() {
            let (added, set) = without(set);
            if added.abs() < NEAR_ZERO {
                self.verifier.add_near(target, set, &mut found);
            } else {
                // A straight wrist lets the joint on its other side turn instead of the virtual one.
                let partner = if self.before { 1 } else { 3 };
                for turn in [0.0, added, -added] {
                    let mut set = set;
                    set[partner] += turn;
                    if self.verifier.residual(target, &set) < WORTH_POLISHING {
                        self.verifier.add_near(target, set, &mut found);
                    }
                }
            }
        }
        // Further solutions may exist in two cases: a family of six-joint solutions has only one representative, and near a
        // double root the virtual joint is poorly determined.
        let is_settled = six.doubt == Doubt::None && !six.singular || !found.is_empty() && found.len() >= six.len();
        (found.doubt, found.singular) = (if is_settled { six.doubt } else { Doubt::Anywhere }, six.singular);
        found.evaluations += six.evaluations;
        six.near_misses().iter().for_each(|set| found.push_near_miss(without(set).1));
        found
    }
}

/// Returns a joint through the intersection of two neighbouring axes, perpendicular to both: the three form a spherical
/// wrist.
fn across(inner: &JointAxis, outer: &JointAxis, size: f64) -> Option<JointAxis> {
    match Pair::of(inner, outer, size, EXACT) {
        Pair::Meet(at) => Some(JointAxis::turning(unit(&cross(&inner.axis, &outer.axis)), at)),
        _ => None,
    }
}

/// Returns a joint that meets the axis at a slant, a little further along it.
fn aside(joint: &JointAxis, size: f64) -> JointAxis {
    let slanted: Vector = add(&scaled(&joint.axis, 0.3), &perpendicular(&joint.axis));
    JointAxis::turning(unit(&slanted), add(&joint.point, &scaled(&joint.axis, 0.4 * size)))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2 as Q, PI, TAU};

    use super::*;
    use crate::math::arithmetic::Baseline;
    use crate::rng;

    const YOUBOT: [[f64; 4]; 5] = [
        [0.033, Q, 0.147, 0.0],
        [0.155, 0.0, 0.0, Q],
        [0.135, 0.0, 0.0, 0.0],
        [0.0, Q, 0.0, Q],
        [0.0, 0.0, 0.2175, 0.0],
    ];
    const LAST_TWO_MEET: [[f64; 4]; 5] =
        [[0.1, 1.2, 0.3, 0.0], [0.3, 0.4, 0.1, 0.0], [0.2, -1.0, 0.2, 0.0], [0.0, 0.9, 0.3, 0.0], [0.0, 0.0, 0.1, 0.0]];
    const RIGHT_ANGLE: [[f64; 4]; 5] =
        [[0.1, 1.2, 0.3, 0.0], [0.3, 0.4, 0.1, 0.0], [0.2, -1.0, 0.2, 0.0], [0.0, Q, 0.3, 0.0], [0.0, 0.0, 0.1, 0.0]];
    const WRIST: [[f64; 4]; 5] =
        [[0.3, 0.0, 0.0, 0.0], [0.4, 0.7, 0.1, 0.0], [0.0, 1.1, 0.0, 0.0], [0.0, 0.9, 0.0, 0.0], [0.0, 0.0, 0.1, 0.0]];
    const GENERAL: [[f64; 4]; 5] = [
        [0.1, 1.2, 0.3, 0.0],
        [0.3, 0.4, 0.1, 0.0],
        [0.2, -1.0, 0.2, 0.0],
        [0.15, 0.9, 0.3, 0.0],
        [0.1, 0.3, 0.1, 0.0],
    ];

    #[test]
    fn five_joints_reach_their_own_poses_and_no_tilted_ones() {
        let mut rng = rng::stream(31, 0);
        for rows in [YOUBOT, LAST_TWO_MEET, RIGHT_ANGLE, WRIST, GENERAL] {
            let chain = AxisChain::of_rows(&rows);
            let method = FiveJoints::new(&chain).expect("a method");
            assert_eq!(method.structure() == Structure::General, rows == GENERAL);
            for draw in 0..if rows == GENERAL { 40 } else { 200 } {
                let mut q: [f64; 5] = std::array::from_fn(|_| rng.uniform_in(-PI, PI));
                // Straight or nearly straight wrists, with the virtual joint.
                if rows != GENERAL && draw % 4 == 0 {
                    q[4] = [Q, -Q, Q + 1e-9, Q - 1e-6][draw / 4 % 4];
                }
                let target = chain.tip_at(&q);
                let near =
                    |b: &[f64; 5]| b.iter().zip(&q).all(|(b, q)| ((b - q + PI).rem_euclid(TAU) - PI).abs() < 1e-4);
                assert!(method.solve(&target).iter().any(near), "{rows:?} {q:?}");
                let axis = unit(&[0.4, 0.7, -0.5]);
                let tilted = target.then::<Baseline>(&Angle::by(0.03).about_line(&axis, &[0.0; 3]));
                assert!(method.solve(&tilted).is_empty());
            }
        }
    }
}
