//! Relations between neighbouring axes of a chain, found once from its geometry: parallel, intersecting or skew.

use crate::closed_form::axis_chain::{AxisKind, JointAxis};
use crate::math::vector3::{Vector, add, add_scaled, cross, dot, norm, scaled, sub};

/// Tolerance for parallel (rad) and for intersecting axes (as a fraction of the arm's size).
///
/// Robot descriptions print angles with about eleven digits; polishing removes the remaining error.
pub const EXACT: f64 = 1e-9;

/// Tolerance for exact relations. Relations that hold to [`EXACT`] but not to this leave rounding too large for a proof.
const SHARP: f64 = 2e-11;

/// Tolerance for arms that were decomposable before calibration; their closed form only gives starting points.
pub const NEARLY: f64 = 5e-3;

/// Relation between two axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pair {
    /// Parallel or antiparallel axes.
    Parallel,
    /// Axes that meet at this point.
    Meet(Vector),
    /// Skew axes.
    Skew,
}

impl Pair {
    /// Classifies the axes of two revolute joints; lengths are relative to `size` (m).
    pub fn of(first: &JointAxis, second: &JointAxis, size: f64, tolerance: f64) -> Self {
        let normal = cross(&first.axis, &second.axis);
        let sine = norm(&normal);
        if sine <= tolerance {
            return Self::Parallel;
        }
        let between = sub(&second.point, &first.point);
        if dot(&between, &normal).abs() > tolerance * size * sine {
            return Self::Skew;
        }
        // Feet of the common normal, or their midpoint if they differ by rounding.
        let foot = |joint: &JointAxis, other: &JointAxis, from: &Vector| {
            let along = cross(&other.axis, &normal);
            add_scaled(&joint.point, &joint.axis, dot(from, &along) / dot(&joint.axis, &along))
        };
        let feet = [foot(first, second, &between), foot(second, first, &scaled(&between, -1.0))];
        Self::Meet(scaled(&add(&feet[0], &feet[1]), 0.5))
    }
}

/// Returns the point where three consecutive axes meet, if they do.
pub fn three_meet(joints: &[JointAxis], size: f64, tolerance: f64) -> Option<Vector> {
    let [first, second, third] = joints else { return None };
    let Pair::Meet(point) = Pair::of(first, second, size, tolerance) else { return None };
    let parallel = Pair::of(second, third, size, tolerance) == Pair::Parallel;
    let off = norm(&sub(&third.nearest_to(&point), &point));
    (!parallel && off <= tolerance * size).then_some(point)
}

/// Whether each relation between consecutive axes either holds to rounding or clearly fails, as a proof requires.
pub fn are_sharp(joints: &[JointAxis], size: f64) -> bool {
    let pair_is_sharp = |pair: &[JointAxis]| {
        let [exact, sharp] = [EXACT, SHARP].map(|tolerance| Pair::of(&pair[0], &pair[1], size, tolerance));
        // Prismatic joints have no meaningful axis point.
        let turning = pair.iter().all(|joint| joint.motion == AxisKind::Turns);
        let same = (exact == Pair::Parallel) == (sharp == Pair::Parallel);
        same && (!turning || (exact == Pair::Skew) == (sharp == Pair::Skew))
    };
    let three_are_sharp = |three: &[JointAxis]| {
        let [exact, sharp] = [EXACT, SHARP].map(|tolerance| three_meet(three, size, tolerance).is_some());
        exact == sharp
    };
    joints.windows(2).all(pair_is_sharp) && joints.windows(3).all(three_are_sharp)
}

/// Whether three consecutive axes are parallel, and no two of them coincide.
pub fn three_parallel(joints: &[JointAxis], size: f64, tolerance: f64) -> bool {
    let parallel = |a: &JointAxis, b: &JointAxis| Pair::of(a, b, size, tolerance) == Pair::Parallel;
    let apart = |a: &JointAxis, b: &JointAxis| norm(&sub(&b.nearest_to(&a.point), &a.point)) > 1e-3 * size;
    let [first, second, third] = joints else { return false };
    parallel(first, second)
        && parallel(second, third)
        && parallel(first, third)
        && apart(first, second)
        && apart(second, third)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joint(axis: Vector, point: Vector) -> JointAxis {
        JointAxis::turning(crate::math::vector3::unit(&axis), point)
    }

    #[test]
    fn pairs_by_their_numbers() {
        let first = joint([0.0, 0.0, 1.0], [0.0; 3]);
        let meets = joint([0.0, 1.0, 1.0], [0.0, 0.5, 1.5]);
        match Pair::of(&first, &meets, 1.0, EXACT) {
            Pair::Meet(at) => assert!(norm(&sub(&at, &[0.0, 0.0, 1.0])) < 1e-15),
            other => panic!("{other:?}"),
        }
        assert_eq!(Pair::of(&first, &joint([0.0, 1.0, 1.0], [1e-6, 0.5, 1.5]), 1.0, EXACT), Pair::Skew);
        assert!(matches!(Pair::of(&first, &joint([0.0, 1.0, 1.0], [1e-6, 0.5, 1.5]), 1.0, NEARLY), Pair::Meet(_)));
        assert_eq!(Pair::of(&first, &joint([0.0, 0.0, -1.0], [1.0, 0.5, 1.5]), 1.0, EXACT), Pair::Parallel);
    }

    #[test]
    fn a_wrist_and_a_bundle() {
        let at = [0.3, 0.1, 0.9];
        let wrist = [joint([1.0, 0.2, 0.0], at), joint([0.0, 1.0, 0.0], at), joint([0.3, 0.0, 1.0], at)];
        let found = three_meet(&wrist, 1.0, EXACT).expect("they meet");
        assert!(norm(&sub(&found, &at)) < 1e-15);
        let bundle = [0.0, 0.5, 1.1].map(|x| joint([0.0, 1.0, 0.0], [x, 0.0, 0.0]));
        assert!(three_parallel(&bundle, 1.0, EXACT) && !three_parallel(&wrist, 1.0, EXACT));
    }

    #[test]
    fn relations_hold_to_rounding_or_not_at_all() {
        let at = [0.3, 0.1, 0.9];
        for (off, sharp) in [(0.0, true), (1e-12, true), (1e-10, false), (5e-10, false), (1e-6, true)] {
            let aside = [0.3, 0.1 + off, 0.9];
            let wrist = [joint([1.0, 0.0, 0.0], at), joint([0.0, 0.0, 1.0], at), joint([1.0, 0.0, 0.0], aside)];
            assert_eq!(are_sharp(&wrist, 1.0), sharp, "axes that miss each other by {off}");
            let tilted = [joint([1.0, 0.0, 0.0], at), joint([1.0, off, 0.0], [0.3, 0.5, 0.9])];
            assert_eq!(are_sharp(&tilted, 1.0), sharp, "axes that are parallel to {off}");
        }
    }
}
