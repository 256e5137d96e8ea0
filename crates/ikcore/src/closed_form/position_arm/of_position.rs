//! Arm of three to five revolute joints whose first three carry the tip to a position.

use super::plane_joints::PlaneJoints;
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
use crate::math::vector3::{Vector, across, add, norm, sub};

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
    /// The first three joints at the limits of the arm.
    pub(super) at_limits: Vec<AtLimit>,
    /// The second to fourth joint, if their axes are parallel.
    pub(super) plane: Option<PlaneJoints>,
}

/// One of the first three joints at a limit (rad).
#[derive(Debug, Clone)]
pub(super) struct AtLimit {
    pub joint: usize,
    pub limit: f64,
    pub turn: Angle,
    /// The other three of the first four; `None` where they only move a point in a plane.
    pub three: Option<ThreeAxes>,
}

impl PositionArm {
    /// Returns `None` unless three to five joints drive one revolute axis each, and the first three carry the tip anywhere. Queries
    /// within the limits `lower` and `upper` (rad) take least time.
    pub fn new(chain: &Chain, [lower, upper]: [&[f64]; 2]) -> Option<Self> {
        let joints = lower.len();
        if !(3..=MOST).contains(&joints) || chain.vector.is_some() || !chain.curves.is_empty() {
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
        let limits = drives.of_axes(lower, upper);
        let plane = PlaneJoints::new(&all, joints, size);
        let mut arm = Self { joints: all, count: joints, tip, three, drives, size, basis, at_limits: vec![], plane };
        arm.prepare(&limits);
        arm.finds_samples().then_some(arm)
    }

    /// Whether the last of three joints moves the point `tip`: without it the others do not carry the point anywhere.
    pub(super) fn moves(&self, tip: &Vector) -> bool {
        let away = || norm(&sub(tip, &self.joints[2].nearest_to(tip)));
        self.count > 3 || away() > EXACT * self.size
    }

    /// Whether the first three joints find the position of a few configurations. Three of them alone may need a tool for that, which
    /// is as long here as the arm.
    pub(super) fn finds_samples(&self) -> bool {
        let tip = &self.tip.origin;
        let tool = [0.31, 0.23, 0.17].map(|part| part * self.size);
        let tip = if self.moves(tip) { *tip } else { add(tip, &tool) };
        (0..6).all(|k| {
            let q: [f64; MOST] = std::array::from_fn(|j| 0.4 + 0.7 * (k as f64) + 1.1 * (j as f64) * (k as f64 + 0.6));
            let turns = q.map(Angle::by);
            let wrist = self.wrist(&tip, turns[3], turns[4]);
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
