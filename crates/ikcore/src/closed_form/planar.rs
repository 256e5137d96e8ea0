//! Three parallel revolute joints, optionally with a prismatic joint along their axes: planar arms and SCARA
//! (subproblems 1 and 3).

use crate::closed_form::angle::Angle;
use crate::closed_form::axis_chain::{AxisChain, AxisKind};
use crate::closed_form::branches::{Branches, Candidates};
use crate::closed_form::structure::{EXACT, Pair, three_parallel};
use crate::closed_form::subproblem::{subproblem1, subproblem3};
use crate::closed_form::verify::Verifier;
use crate::math::Frame;
use crate::math::arithmetic::Baseline;
use crate::math::vector3::{Vector, add, cross, dot, norm, perpendicular, scaled, sub};

/// Closed form of such a chain: N = 3, or 4 with the prismatic joint at any position.
#[derive(Debug, Clone, Copy)]
pub struct Planar<const N: usize> {
    chain: AxisChain<N>,
    /// Indices of the revolute joints, in order, and of the prismatic joint.
    turning: [usize; 3],
    sliding: Option<usize>,
    /// Signs, 1 or -1: rotation of the second and the third joint relative to the first, and direction of the prismatic
    /// joint.
    senses: [f64; 2],
    along: f64,
    mark: Vector,
    back: Frame,
    floor: f64,
    verifier: Verifier<N>,
}

impl<const N: usize> Planar<N> {
    /// Returns `None` if the chain is not of this kind.
    pub fn new(chain: &AxisChain<N>) -> Option<Self> {
        let mut turning = [0; 3];
        let mut sliding = None;
        let mut count = 0;
        for (k, joint) in chain.joints.iter().enumerate() {
            match joint.motion {
                AxisKind::Turns if count < 3 => {
                    turning[count] = k;
                    count += 1;
                }
                AxisKind::Slides if sliding.is_none() => sliding = Some(k),
                _ => return None,
            }
        }
        let size = chain.size();
        let three = turning.map(|k| chain.joints[k]);
        if count < 3 || !three_parallel(&three, size, EXACT) {
            return None;
        }
        if let Some(k) = sliding
            && Pair::of(&three[0], &chain.joints[k], size, EXACT) != Pair::Parallel
        {
            return None;
        }
        let axis = three[0].axis;
        let senses = [1, 2].map(|k| dot(&axis, &three[k].axis).signum());
        let along = sliding.map_or(1.0, |k| dot(&axis, &chain.joints[k].axis).signum());
        let (mark, floor, verifier) = (perpendicular(&axis), 1e-11 * size, Verifier::new(chain, 1e-3));
        Some(Self { chain: *chain, turning, sliding, senses, along, mark, back: chain.tip.inverse(), floor, verifier })
    }

    /// Returns all joint values that bring the tip to `target`; none if the target is out of reach, off the plane or tilted.
    pub fn solve(&self, target: &Frame) -> Branches<N> {
        let goal = target.then::<Baseline>(&self.back);
        let [first, second, third] = self.turning.map(|k| self.chain.joints[k]);
        let axis = &first.axis;
        let sum = subproblem1(axis, &self.mark, &goal.turn::<Baseline>(&self.mark));
        let moved = sub(&goal.transform::<Baseline>(&third.point), &third.point);
        let slide = self.along * dot(axis, &moved);
        // Projection onto the plane perpendicular to the axes.
        let flat = |v: &Vector| cross(axis, v);
        let links = [flat(&sub(&second.point, &first.point)), flat(&sub(&third.point, &second.point))];
        let reached = flat(&sub(&goal.transform::<Baseline>(&third.point), &first.point));
        let square = dot(&reached, &reached);
        let floor = self.floor * norm(&links[0]);
        let mut candidates = Candidates::new();
        let bends = subproblem3(&second.axis, &links[1], &scaled(&links[0], -1.0), square, floor);
        (candidates.singular, candidates.doubt) = (bends.free, bends.doubt);
        for q2 in bends.iter() {
            let q1 = subproblem1(axis, &add(&links[0], &q2.about(&second.axis, &links[1])), &reached);
            let q3 = sum.and(q1.back()).and(q2.signed(-self.senses[0])).signed(self.senses[1]);
            let mut turns = [Angle::NONE; N];
            for (k, turn) in self.turning.iter().zip([q1, *q2, q3]) {
                turns[*k] = turn;
            }
            if let Some(k) = self.sliding {
                turns[k] = Angle { cos: 1.0, sin: slide };
            }
            candidates.push(&turns);
        }
        self.verifier.verified(target, &candidates)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::closed_form::axis_chain::JointAxis;
    use crate::closed_form::branches::Doubt;
    use crate::rng;

    fn random<const N: usize>(seed: u64) -> Vec<[f64; N]> {
        let mut rng = rng::stream(seed, 0);
        (0..200).map(|_| std::array::from_fn(|_| rng.uniform_in(-PI, PI))).collect()
    }

    fn near(a: &[f64], b: &[f64]) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-7)
    }

    #[test]
    fn a_planar_arm_has_two_branches_in_its_plane_and_none_above() {
        let chain = AxisChain::of_rows(&[[0.5, 0.0, 0.0, 0.0], [0.4, 0.0, 0.0, 0.0], [0.2, 0.0, 0.0, 0.0]]);
        let method = Planar::new(&chain).expect("planar");
        for q in random::<3>(32) {
            let target = chain.tip_at(&q);
            let found = method.solve(&target);
            assert!(found.len() == 2 && found.doubt == Doubt::None && found.iter().any(|b| near(b, &q)));
            let lifted = Frame { origin: add(&target.origin, &[0.0, 0.0, 0.01]), ..target };
            assert!(method.solve(&lifted).is_empty());
        }
    }

    #[test]
    fn a_scara_has_two_branches_wherever_its_slide_is() {
        let turning = |x: f64, sense: f64| JointAxis::turning([0.0, 0.0, sense], [x, 0.0, 0.3]);
        let slide = JointAxis::sliding([0.0, 0.0, -1.0]);
        let (a, b, c) = (turning(0.0, 1.0), turning(0.35, 1.0), turning(0.6, -1.0));
        let tip = Frame { axes: [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]], origin: [0.65, 0.02, 0.1] };
        for joints in [[a, b, slide, c], [a, b, c, slide], [slide, a, b, c]] {
            let chain = AxisChain { joints, tip };
            let method = Planar::new(&chain).expect("a SCARA");
            for q in random::<4>(33) {
                let found = method.solve(&chain.tip_at(&q));
                assert!(found.len() == 2 && found.iter().any(|b| near(b, &q)), "{q:?}");
            }
        }
        assert!(Planar::new(&AxisChain { joints: [a, b, JointAxis::sliding([0.0, 1.0, 0.0]), c], tip }).is_none());
    }
}
