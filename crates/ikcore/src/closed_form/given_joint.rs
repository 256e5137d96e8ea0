//! Seven joints with the first or the last given: the other six solve the remaining pose.

use crate::closed_form::angle::Angle;
use crate::closed_form::angle_range::AngleRange;
use crate::closed_form::axis_chain::{AxisChain, AxisKind, JointAxis};
use crate::closed_form::branches::{Branches, Candidates, FixedJoint};
use crate::closed_form::six::{ClosedForm, Structure};
use crate::math::Frame;
use crate::math::arithmetic::Baseline;

/// Given joint and the closed form of the other six.
#[derive(Debug, Clone)]
pub struct GivenJoint {
    /// Index of the given joint: 0 or 6.
    axis: usize,
    joint: JointAxis,
    others: ClosedForm,
}

impl GivenJoint {
    /// Chooses the given joint that leaves six joints with the better method, the last in a tie; `None` if joints are
    /// prismatic and no method fits.
    pub fn new(chain: &AxisChain<7>) -> Option<Self> {
        let (last, first) = (Self::at(6, chain), Self::at(0, chain));
        match (last.rank(), first.rank()) {
            (Some(of_last), of_first) if of_first.is_none_or(|of_first| of_last <= of_first) => Some(last),
            (_, Some(_)) => Some(first),
            _ => None,
        }
    }

    fn at(axis: usize, chain: &AxisChain<7>) -> Self {
        let joints = std::array::from_fn(|k| chain.joints[if k < axis { k } else { k + 1 }]);
        // Identity tip, since the tip frame is part of the displacement. Speed matters more than a few solutions lost near folds:
        // only samples of the parameter are solved.
        let others = ClosedForm::structured(&AxisChain { joints, tip: Frame::IDENTITY });
        Self { axis, joint: chain.joints[axis], others }
    }

    /// Ranks the method of the other six joints, best first.
    fn rank(&self) -> Option<u8> {
        match self.others.structure() {
            Structure::ThreeMeet { nearly: false, .. } => Some(0),
            Structure::ThreeParallel { nearly: false, .. } => Some(1),
            Structure::ThreeMeet { nearly: true, .. } => Some(2),
            Structure::ThreeParallel { nearly: true, .. } => Some(3),
            Structure::General => Some(4),
            Structure::Unsolved => None,
        }
    }

    /// Returns the index of the given joint: 0 or 6.
    pub fn axis(&self) -> usize {
        self.axis
    }

    /// Returns the structure of the other six joints.
    pub fn structure(&self) -> Structure {
        self.others.structure()
    }

    /// Returns all joint values, angles in (-pi, pi], whose displacements make `goal` with the given joint at `value` (rad,
    /// m).
    pub fn solve(&self, goal: &Frame, value: f64) -> Branches<7> {
        let rest = self.remaining_displacement(goal, self.joint.turn(value));
        let six = self.others.solve_displacement(&rest, &rest);
        let mut seven = Branches::none();
        (seven.doubt, seven.singular, seven.evaluations) = (six.doubt, six.singular, six.evaluations);
        let turns = self.joint.motion == AxisKind::Turns;
        let value = if turns { Angle::by(value).angle() } else { value };
        for ([a, b, c, d, e, f], error) in six.iter().copied().zip(six.errors()) {
            let set = if self.axis == 0 { [value, a, b, c, d, e, f] } else { [a, b, c, d, e, f, value] };
            seven.push(set, *error);
        }
        seven
    }

    /// Adds candidates whose displacements make `goal` with the given joint at `value` (rad, m), as far as `ranges` may hold
    /// them.
    pub fn add_candidates(&self, goal: &Frame, value: f64, ranges: &[AngleRange; 7], found: &mut Candidates) {
        let turn = self.joint.turn(value);
        let [a, b, c, d, e, f, g] = *ranges;
        let (joint, ranges) = match self.axis {
            0 => (FixedJoint::First(turn), [b, c, d, e, f, g]),
            _ => (FixedJoint::Last(turn), [a, b, c, d, e, f]),
        };
        found.fix_joint(joint);
        self.others.add_candidates(&self.remaining_displacement(goal, turn), &ranges, found);
    }

    /// Returns the displacement left for the other six joints: E2 ... E7 = E1^-1 goal, or E1 ... E6 = goal E7^-1.
    #[inline]
    fn remaining_displacement(&self, goal: &Frame, turn: Angle) -> Frame {
        let back = self.joint.displacement_by(turn.back());
        if self.axis == 0 { back.then::<Baseline>(goal) } else { goal.then::<Baseline>(&back) }
    }
}
