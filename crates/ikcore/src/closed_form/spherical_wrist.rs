//! Six joints, the last three of which form a spherical wrist: the wrist centre gives the first three joints, the remaining
//! rotation the last three. At most eight solutions (Pieper 1968).

use crate::closed_form::angle::Angle;
use crate::closed_form::angle_range::{AngleRange, may_hold};
use crate::closed_form::axis_chain::{AxisKind, JointAxis, reversed};
use crate::closed_form::branches::Candidates;
use crate::closed_form::position::{Three, ThreeAxes};
use crate::closed_form::sliding_arm::SlidingArm;
use crate::closed_form::structure::Pair;
use crate::closed_form::wrist::{Wrist, WristDirections};
use crate::math::Frame;
use crate::math::arithmetic::Baseline;
use crate::math::vector3::Vector;

/// First three joints.
#[derive(Debug, Clone, Copy)]
enum Arm {
    Turning(ThreeAxes),
    Sliding(SlidingArm),
}

/// Precomputed arm with a spherical wrist.
#[derive(Debug, Clone, Copy)]
pub struct SphericalWrist {
    arm: Arm,
    wrist: Wrist,
    axes: [Vector; 3],
    slides: [bool; 3],
    centre: Vector,
    /// True if the chain is taken from tip to base: its first three axes meet.
    reversed: bool,
}

impl SphericalWrist {
    /// Prepares an arm whose last three axes meet at `centre`; `size` is a characteristic length of the arm (m).
    pub fn new(joints: &[JointAxis; 6], centre: &Vector, size: f64, tolerance: f64) -> Self {
        let [a, b, c, d, e, f] = *joints;
        let pair = |first: &JointAxis, second: &JointAxis| Pair::of(first, second, size, tolerance);
        Self {
            arm: Arm::Turning(ThreeAxes::new(&[a, b, c], pair(&a, &b), pair(&b, &c), size)),
            wrist: Wrist::new(&[d.axis, e.axis, f.axis]),
            axes: [a.axis, b.axis, c.axis],
            slides: [a, b, c].map(|joint| joint.motion == AxisKind::Slides),
            centre: *centre,
            reversed: false,
        }
    }

    /// Prepares an arm with prismatic joints before the wrist; `None` if no method fits.
    pub fn sliding(joints: &[JointAxis; 6], centre: &Vector, size: f64, tolerance: f64) -> Option<Self> {
        let arm = SlidingArm::new(&[joints[0], joints[1], joints[2]], size, tolerance)?;
        Some(Self { arm: Arm::Sliding(arm), ..Self::new(joints, centre, size, tolerance) })
    }

    /// Prepares an arm whose first three axes meet at `centre`, by taking the chain from tip to base.
    pub fn shoulder(joints: &[JointAxis; 6], centre: &Vector, size: f64, tolerance: f64) -> Self {
        Self { reversed: true, ..Self::new(&reversed(joints), centre, size, tolerance) }
    }

    /// Adds candidates whose displacements make `goal`, as far as `ranges` may hold them.
    #[inline(always)]
    pub fn solve(&self, goal: &Frame, ranges: &[AngleRange; 6], found: &mut Candidates) {
        let [a, b, c, d, e, f] = *ranges;
        // Reversed loop: E6^-1 ... E1^-1 = H^-1, and a negative axis turns E^-1 into E.
        if self.reversed {
            self.solve_forward(&goal.inverse(), [&[f, e, d], &[c, b, a]], found, |arm, wrist| {
                [wrist[2], wrist[1], wrist[0], arm[2], arm[1], arm[0]]
            });
        } else {
            self.solve_forward(goal, [&[a, b, c], &[d, e, f]], found, |arm, wrist| {
                [arm[0], arm[1], arm[2], wrist[0], wrist[1], wrist[2]]
            });
        }
    }

    #[inline(always)]
    fn solve_forward(
        &self,
        goal: &Frame,
        [of_arm, of_wrist]: [&[AngleRange; 3]; 2],
        found: &mut Candidates,
        order: impl Fn(&Three, &Three) -> [Angle; 6],
    ) {
        let reached = goal.transform::<Baseline>(&self.centre);
        let arms = match &self.arm {
            Arm::Turning(arm) => arm.reach(&self.centre, &reached, of_arm),
            Arm::Sliding(arm) => arm.reach(&self.centre, &reached),
        };
        found.singular |= arms.free;
        found.doubt.add(arms.doubt);
        let pointing = self.wrist.pointing(goal);
        for arm in arms.iter().filter(|arm| may_hold(of_arm, *arm)) {
            let left = WristDirections { end: self.undone(arm, &pointing.end), mark: self.undone(arm, &pointing.mark) };
            let wrists = self.wrist.turns(&left, of_wrist);
            found.singular |= wrists.aligned;
            if wrists.near_miss {
                found.doubt.add_dead_end();
            }
            found.doubt.add(wrists.doubt);
            for wrist in wrists.sets[..wrists.count].iter().filter(|wrist| may_hold(of_wrist, *wrist)) {
                found.push_six(&order(arm, wrist));
            }
        }
    }

    /// Returns rot3' rot2' rot1' v.
    #[inline(always)]
    fn undone(&self, arm: &Three, v: &Vector) -> Vector {
        let mut v = *v;
        for ((turn, axis), slides) in arm.iter().zip(&self.axes).zip(self.slides) {
            if slides {
                continue;
            }
            v = turn.back().about(axis, &v);
        }
        v
    }
}
