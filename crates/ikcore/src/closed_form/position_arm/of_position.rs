//! Arm of three to five revolute joints whose first three carry the tip to a position.

use super::scan::MOST;
use crate::closed_form::angle::Angle;
use crate::closed_form::angle_range::AngleRange;
use crate::closed_form::arm::{axes_of, drives_of};
use crate::closed_form::axis_chain::{AxisChain, AxisKind, JointAxis};
use crate::closed_form::configurations::Drives;
use crate::closed_form::position::ThreeAxes;
use crate::closed_form::structure::{EXACT, Pair};
use crate::kinematics::chain::Chain;
use crate::math::Frame;
use crate::math::vector3::{Vector, across, add, sub};

/// Arm whose first three joints carry the tip to a position.
#[derive(Debug, Clone)]
pub(crate) struct PositionArm {
    pub(super) joints: [JointAxis; MOST],
    pub(super) count: usize,
    pub(super) tip: Frame,
    pub(super) three: ThreeAxes,
    pub(super) drives: Drives,
    pub(super) size: f64,
    /// Two vectors across the last axis, and the axis.
    pub(super) basis: [Vector; 3],
}

impl PositionArm {
    /// Returns `None` unless three to five joints drive one revolute axis each, and the first three carry the tip anywhere.
    pub fn new(chain: &Chain, joints: usize) -> Option<Self> {
        if !(3..=MOST).contains(&joints) || chain.vector.is_some() {
            return None;
        }
        let drives = drives_of(chain);
        let each_once =
            (0..joints).all(|joint| (0..drives.len()).filter(|axis| drives.joint(*axis) == joint).count() == 1);
        if drives.len() != joints || !each_once {
            return None;
        }
        let axes = axes_of::<MOST>(chain);
        if axes.joints[..joints].iter().any(|joint| joint.motion == AxisKind::Slides) {
            return None;
        }
        let AxisChain { joints: all, tip } = axes;
        let size = match joints {
            3 => AxisChain { joints: [all[0], all[1], all[2]], tip }.size(),
            4 => AxisChain { joints: [all[0], all[1], all[2], all[3]], tip }.size(),
            _ => axes.size(),
        };
        let pair = |k: usize| Pair::of(&all[k], &all[k + 1], size, EXACT);
        let three = ThreeAxes::new(&[all[0], all[1], all[2]], pair(0), pair(1), size);
        let basis = across(&all[joints - 1].axis);
        let arm = Self { joints: all, count: joints, tip, three, drives, size, basis };
        arm.finds_samples().then_some(arm)
    }

    /// Whether the first three joints find the position of a few configurations.
    pub(super) fn finds_samples(&self) -> bool {
        (0..6).all(|k| {
            let q: [f64; MOST] = std::array::from_fn(|j| 0.4 + 0.7 * (k as f64) + 1.1 * (j as f64) * (k as f64 + 0.6));
            let turns = q.map(Angle::by);
            let wrist = self.wrist(&self.tip.origin, turns[3], turns[4]);
            let goal = (0..3).rev().fold(wrist, |at, j| self.moved(j, turns[j], &at));
            let found = self.three.reach(&wrist, &goal, &[AngleRange::ANY; 3]);
            found.iter().any(|set| set.iter().zip(&turns).all(|(a, b)| (a.cos - b.cos).hypot(a.sin - b.sin) < 1e-6))
        })
    }

    /// Point `tip` moved by the joints after the third.
    pub(super) fn wrist(&self, tip: &Vector, fourth: Angle, fifth: Angle) -> Vector {
        let turns = [fourth, fifth];
        (3..self.count).rev().fold(*tip, |at, j| self.moved(j, turns[j - 3], &at))
    }

    pub(super) fn moved(&self, joint: usize, turn: Angle, point: &Vector) -> Vector {
        let JointAxis { axis, point: on_axis, .. } = &self.joints[joint];
        add(on_axis, &turn.about(axis, &sub(point, on_axis)))
    }
}
