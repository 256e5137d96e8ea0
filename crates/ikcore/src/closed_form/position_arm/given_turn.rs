//! First four joints of which one is given: three are left, which carry the tip to a position in closed form.
//!
//! The scan gives the fourth. Where a limit cuts a branch off, another of them is at that limit: giving it finds the end of the branch
//! exactly, and so each branch between limits, however short.

use std::f64::consts::TAU;

use super::goal::TurnRange;
use super::of_position::{AtLimit, PositionArm};
use crate::closed_form::angle::Angle;
use crate::closed_form::angle_range::AngleRange;
use crate::closed_form::branches::MOST_JOINTS;
use crate::closed_form::position::{Three, ThreeAxes, ThreeJointSolutions};
use crate::closed_form::structure::{EXACT, Pair};
use crate::math::vector3::Vector;

/// Joint that the scan gives.
const FOURTH: usize = 3;

/// Joint of the first four that is given, and the three that are left.
pub struct GivenTurn<'a> {
    joint: usize,
    turn: Angle,
    three: &'a ThreeAxes,
    /// Two vectors across the last axis, turned by the given joint if it comes after the other three.
    basis: [Vector; 2],
    /// Numbers of the other three.
    left: [usize; 3],
}

impl PositionArm {
    /// The fourth joint at `value` (rad); of an arm with three joints, none.
    pub(super) fn fourth(&self, value: f64) -> GivenTurn<'_> {
        let [x, y, _] = self.basis;
        let turn = if self.count > FOURTH { Angle::by(value) } else { Angle::NONE };
        let axis = &self.joints[FOURTH].axis;
        let basis = [turn.about(axis, &x), turn.about(axis, &y)];
        GivenTurn { joint: FOURTH, turn, three: &self.three, basis, left: left_of(FOURTH) }
    }

    /// Calls `visit` with each of the first three joints at each of its limits (rad).
    pub(super) fn visit_limits(&self, limits: &[[f64; 2]; MOST_JOINTS], mut visit: impl FnMut(&GivenTurn<'_>)) {
        for (joint, limit) in self.cut_at(limits) {
            let made;
            let at = match self.at_limits.iter().find(|at| at.joint == joint && at.limit == limit) {
                Some(at) => at,
                None => {
                    made = self.at_limit(joint, limit);
                    &made
                }
            };
            if let Some(three) = &at.three {
                let [x, y, _] = self.basis;
                visit(&GivenTurn { joint, turn: at.turn, three, basis: [x, y], left: left_of(joint) });
            }
        }
    }

    /// The same joints at the limits (rad) that are usual.
    pub(super) fn prepare(&mut self, limits: &[[f64; 2]; MOST_JOINTS]) {
        self.at_limits = self.cut_at(limits).map(|(joint, limit)| self.at_limit(joint, limit)).collect();
    }

    /// First joints with their limits (rad), where a fourth joint is left to follow.
    fn cut_at(&self, limits: &[[f64; 2]; MOST_JOINTS]) -> impl Iterator<Item = (usize, f64)> + use<> {
        let joints = if self.count > FOURTH { 0..FOURTH } else { 0..0 };
        let limits = *limits;
        let is_limited = move |joint: &usize| limits[*joint][1] - limits[*joint][0] < TAU;
        joints.filter(is_limited).flat_map(move |joint| limits[joint].map(|limit| (joint, limit)))
    }

    fn at_limit(&self, joint: usize, limit: f64) -> AtLimit {
        let turn = Angle::by(limit);
        let displacement = self.joints[joint].displacement_by(turn);
        let axis = |k: usize| if k < joint { self.joints[k] } else { self.joints[k].moved(&displacement) };
        let axes = left_of(joint).map(axis);
        let pairs = [0, 1].map(|k| Pair::of(&axes[k], &axes[k + 1], self.size, EXACT));
        let is_planar = pairs == [Pair::Parallel; 2];
        let three = (!is_planar).then(|| ThreeAxes::new(&axes, pairs[0], pairs[1], self.size));
        AtLimit { joint, limit, turn, three }
    }
}

/// Returns the first four joints without `joint`.
fn left_of(joint: usize) -> [usize; 3] {
    [usize::from(joint == 0), 1 + usize::from(joint <= 1), 2 + usize::from(joint <= 2)]
}

impl GivenTurn<'_> {
    /// Returns all angles of the other three that carry `wrist` to `goal`; some outside `ranges` may be left out.
    #[inline]
    pub fn reach(
        &self,
        arm: &PositionArm,
        wrist: &Vector,
        goal: &Vector,
        ranges: &[AngleRange; 3],
    ) -> ThreeJointSolutions {
        self.three.reach(&arm.moved(self.joint, self.turn, wrist), goal, ranges)
    }

    /// Ranges of the other three, of those of the first four joints.
    #[inline]
    pub fn ranges(&self, all: &[AngleRange; 4]) -> [AngleRange; 3] {
        let [a, b, c] = self.left;
        [all[a], all[b], all[c]]
    }

    /// Whether `set`, for the other three, is inside `ranges`, of the first four joints.
    #[inline]
    pub fn holds(&self, ranges: &[TurnRange; 4], set: &Three) -> bool {
        (0..3).all(|k| ranges[self.left[k]].holds(set[k]))
    }

    /// Angles of the first four joints, for `set` of the other three.
    pub fn all(&self, set: &Three) -> [Angle; 4] {
        let mut all = [self.turn; 4];
        for k in 0..3 {
            all[self.left[k]] = set[k];
        }
        all
    }

    /// Two vectors across the last axis of `arm`, turned by the first four joints at the angles `all`.
    #[inline]
    pub fn turned(&self, arm: &PositionArm, all: &[Angle; 4]) -> [Vector; 2] {
        let joints = if self.joint == FOURTH { FOURTH } else { FOURTH + 1 };
        let mut turned = self.basis;
        for j in (0..joints).rev() {
            let axis = &arm.joints[j].axis;
            turned = [all[j].about(axis, &turned[0]), all[j].about(axis, &turned[1])];
        }
        turned
    }
}
