//! Orientations spread evenly: directions of an axis of the tip, and rolls about it.

use std::f64::consts::{PI, TAU};

use serde::{Deserialize, Serialize};

use crate::math::Frame;
use crate::math::arithmetic::NoFma;

/// Angle between neighbours of a spherical Fibonacci set, about its axis (rad).
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Orientations of a map, each direction with all rolls.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OrientationSet {
    /// Polar angle and azimuth of each direction (rad).
    directions: Vec<[f64; 2]>,
    rolls: usize,
    /// Reference rotation: `spread` applied to the frame `rest` has the axis along z.
    rest: Rotation,
    /// Rotation from z to the only direction in the base, about which rolls turn.
    base: Rotation,
    /// Whether the tip cannot leave its only direction.
    is_fixed: bool,
}

type Rotation = [[f64; 3]; 3];

const AS_IT_IS: Rotation = Frame::IDENTITY.axes;

impl OrientationSet {
    /// Set of one orientation, for positions.
    pub(super) fn single() -> Self {
        Self { directions: vec![[0.0; 2]], rolls: 1, rest: AS_IT_IS, base: AS_IT_IS, is_fixed: false }
    }

    /// Set of `directions` of the spherical Fibonacci set for the unit vector `axis` of the tip, each with `rolls`.
    pub(super) fn spread(directions: usize, rolls: usize, axis: [f64; 3]) -> Self {
        let direction = |i: usize| {
            let height = 1.0 - (2.0 * i as f64 + 1.0) / directions as f64;
            [height.acos(), (i as f64 * GOLDEN_ANGLE).rem_euclid(TAU)]
        };
        let directions = (0..directions).map(direction).collect();
        Self { directions, rolls, rest: transposed(&towards(axis)), base: AS_IT_IS, is_fixed: false }
    }

    /// Set of `rolls` about the fixed direction `base` of a tip; `tip` is the same direction in the tip frame.
    pub(super) fn fixed(rolls: usize, base: [f64; 3], tip: [f64; 3]) -> Self {
        Self { directions: vec![[0.0; 2]], rolls, rest: transposed(&towards(tip)), base: towards(base), is_fixed: true }
    }

    /// Number of orientations.
    pub fn count(&self) -> usize {
        self.directions.len() * self.rolls
    }

    /// Number of rolls of each direction.
    pub fn rolls(&self) -> usize {
        self.rolls
    }

    /// Axes of orientation number `i` at azimuth 0.
    pub(super) fn axes(&self, i: usize) -> Rotation {
        let [polar, azimuth] = self.directions[i / self.rolls];
        let roll = TAU * (i % self.rolls) as f64 / self.rolls as f64;
        let spread = product(&product(&about_z(azimuth), &about_y(polar)), &about_z(roll));
        product(&product(&self.base, &spread), &self.rest)
    }

    /// Number of the orientation nearest to `axes`: by direction, then by roll. `None` for a direction that the tip cannot
    /// have.
    pub(super) fn nearest(&self, axes: &Rotation) -> Option<usize> {
        // Decomposition base' R rest' = Rz(azimuth) Ry(polar) Rz(roll).
        let spread = product(&product(&transposed(&self.base), axes), &transposed(&self.rest));
        let [_, _, axis] = spread;
        if self.is_fixed && axis[2].clamp(-1.0, 1.0).acos() > PI / self.rolls as f64 {
            return None;
        }
        let mut best = (f64::NEG_INFINITY, 0);
        for (number, [polar, azimuth]) in self.directions.iter().enumerate() {
            let (sine, cosine) = polar.sin_cos();
            let (east, north) = (azimuth.cos(), azimuth.sin());
            let near = sine * (east * axis[0] + north * axis[1]) + cosine * axis[2];
            if near > best.0 {
                best = (near, number);
            }
        }
        let [polar, azimuth] = self.directions[best.1];
        let [x, y, _] = product(&transposed(&product(&about_z(azimuth), &about_y(polar))), &spread);
        let roll = (x[1] - y[0]).atan2(x[0] + y[1]);
        let number = (roll / TAU * self.rolls as f64).round().rem_euclid(self.rolls as f64) as usize;
        Some(best.1 * self.rolls + number % self.rolls)
    }
}

/// Rotates orientations by an azimuth (rad) about z.
pub(super) fn turned(axes: &Rotation, azimuth: f64) -> Rotation {
    product(&about_z(azimuth), axes)
}

/// Matrix product a b, as columns.
fn product(a: &Rotation, b: &Rotation) -> Rotation {
    let a = Frame { axes: *a, origin: [0.0; 3] };
    b.map(|column| a.turn::<NoFma>(&column))
}

fn transposed(a: &Rotation) -> Rotation {
    std::array::from_fn(|row| std::array::from_fn(|column| a[column][row]))
}

fn about_z(angle: f64) -> Rotation {
    let (sine, cosine) = angle.sin_cos();
    [[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]]
}

fn about_y(angle: f64) -> Rotation {
    let (sine, cosine) = angle.sin_cos();
    [[cosine, 0.0, -sine], [0.0, 1.0, 0.0], [sine, 0.0, cosine]]
}

/// Rotation from z to the unit vector `v`.
fn towards(v: [f64; 3]) -> Rotation {
    product(&about_z(v[1].atan2(v[0])), &about_y(v[0].hypot(v[1]).atan2(v[2])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::so3::{cross, norm};

    fn sets() -> [OrientationSet; 4] {
        let slanted = [0.36, -0.48, 0.8];
        [
            OrientationSet::spread(50, 6, [0.0, 0.0, 1.0]),
            OrientationSet::spread(7, 1, slanted),
            OrientationSet::fixed(8, [0.0, 0.0, -1.0], slanted),
            OrientationSet::single(),
        ]
    }

    #[test]
    fn each_orientation_is_the_nearest_to_itself() {
        for set in sets() {
            for i in 0..set.count() {
                let axes = set.axes(i);
                let [x, y, z] = axes;
                assert!(norm(&std::array::from_fn(|k| cross(&x, &y)[k] - z[k])) < 1e-14, "right-handed");
                assert_eq!(set.nearest(&axes), Some(i));
                let near = product(&axes, &about_y(1e-3));
                assert_eq!(set.nearest(&near), Some(i));
            }
        }
    }

    #[test]
    fn directions_are_spread_evenly() {
        let set = OrientationSet::spread(200, 1, [0.0, 0.0, 1.0]);
        let axes: Vec<_> = (0..200).map(|i| set.axes(i)[2]).collect();
        let sum: [f64; 3] = std::array::from_fn(|k| axes.iter().map(|axis| axis[k]).sum());
        assert!(norm(&sum) < 1.0, "{sum:?}");
        let nearest = |a: &[f64; 3]| {
            let apart = |b: &[f64; 3]| norm(&cross(a, b)).atan2((0..3).map(|k| a[k] * b[k]).sum());
            axes.iter().filter(|b| *b != a).map(apart).fold(f64::INFINITY, f64::min)
        };
        // Caps of equal area have a radius of 0.14 rad for 200 directions.
        assert!(axes.iter().all(|axis| (0.17..0.29).contains(&nearest(axis))));
    }

    #[test]
    fn a_fixed_direction_has_no_other() {
        let set = OrientationSet::fixed(8, [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]);
        assert_eq!(set.nearest(&about_z(0.8)), Some(1));
        assert_eq!(set.nearest(&about_y(0.8)), None);
    }
}
