//! Accuracy with which the rows of a path determine the curve that they were taken from.

use nalgebra::{UnitQuaternion, Vector3};

use super::corners::CORNER;
use super::segment_geometry::turn;
use super::tip_curve::TipPath;
use crate::math::vector::distance;
use crate::task::Target;

impl TipPath {
    /// Estimated distance (m) of the segments from the sampled curve: the rise of a circular arc with their lengths and
    /// angles.
    pub fn coarseness(&self) -> f64 {
        let smooth = |row: &usize| self.corners.binary_search(row).is_err();
        let rise = |row: usize| {
            let [before, here, after] = [row - 1, row, row + 1].map(|i| self.positions[i]);
            let chord = distance(&before, &here).max(distance(&here, &after));
            0.5 * chord * (0.25 * turn(before, here, after)).tan()
        };
        (1..self.positions.len() - 1).filter(smooth).map(rise).fold(0.0, f64::max)
    }

    /// The same curve as a sampled one, whose orientations are known between the rows no better than the samples determine them.
    pub(crate) fn into_sampled(mut self) -> Self {
        self.open_turn = self.turn_coarseness();
        self
    }

    /// Angle (rad) that the orientations leave open between the rows; 0 for a curve that is taken literally.
    pub(crate) fn open_turn(&self) -> f64 {
        self.open_turn
    }

    /// Estimated angle (rad) of the turns between rows from the sampled orientations, as [`coarseness`](Self::coarseness) of positions.
    pub(crate) fn turn_coarseness(&self) -> f64 {
        let Some(rotations) = &self.rotations else { return 0.0 };
        let axis = match self.target(0.0) {
            Target::Pointing { axis, .. } => Some(Vector3::from(axis)),
            _ => None,
        };
        let step = |pair: &[UnitQuaternion<f64>]| {
            axis.map_or_else(|| pair[0].rotation_to(&pair[1]).scaled_axis(), |axis| pair[1] * axis - pair[0] * axis)
        };
        let turned = rotations.windows(2).map(step).collect::<Vec<_>>();
        let rise = |pair: &[Vector3<f64>]| {
            let bend = (pair[1] - pair[0]).norm();
            let is_smooth = bend < CORNER * pair[0].norm().max(pair[1].norm());
            if is_smooth { 0.125 * bend } else { 0.0 }
        };
        turned.windows(2).map(rise).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Rotation3;

    use super::*;
    use crate::path::Waypoints;

    /// A straight way whose orientation turns by these steps (rad) about one axis.
    fn turned_by(steps: &[f64]) -> TipPath {
        let mut angle = 0.0;
        let turned = std::iter::once(0.0).chain(steps.iter().map(|step| {
            angle += step;
            angle
        }));
        let (positions, rotations): (Vec<_>, Vec<_>) = turned
            .enumerate()
            .map(|(row, angle)| {
                let rotation = Rotation3::from_axis_angle(&Vector3::z_axis(), angle).into_inner();
                ([0.1 * row as f64, 0.0, 0.0], rotation)
            })
            .unzip();
        TipPath::through(&Waypoints::new(positions, Some(rotations)).unwrap()).unwrap()
    }

    #[test]
    fn coarse_samples_leave_the_turn_between_them_open_and_corners_do_not() {
        // A parabola with the second difference h rises h / 8 above its chord.
        assert!((turned_by(&[0.10, 0.11, 0.12, 0.13]).turn_coarseness() - 0.01 / 8.0).abs() < 1e-12);
        for steps in [[0.1, 0.1, 0.1, 0.1], [0.0, 0.0, 0.1, 0.1], [0.0, 0.0, 0.0, 0.0]] {
            assert!(turned_by(&steps).turn_coarseness() < 1e-12, "{steps:?}");
        }
    }

    #[test]
    fn a_path_is_taken_literally_unless_its_rows_are_samples() {
        let literal = turned_by(&[0.10, 0.11, 0.12, 0.13]);
        assert_eq!(literal.open_turn(), 0.0);
        let sampled = literal.into_sampled();
        assert_eq!(sampled.open_turn(), sampled.turn_coarseness());
        assert_eq!(sampled.part(0.1, 0.9).unwrap().open_turn(), sampled.open_turn());
    }
}
