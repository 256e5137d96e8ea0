//! Landmarks of measurements without poses: the centre of a ball bar, and a plane that is touched.

use nalgebra::{Rotation3, Unit, Vector3};

/// Something fixed in the frame of the base that the tip is measured against.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Landmark {
    Nothing,
    /// Fixed end of a ball bar (m).
    Centre(Vector3<f64>),
    /// Plane of the points p with normal . p = height (m).
    Plane {
        normal: Unit<Vector3<f64>>,
        height: f64,
    },
}

impl Landmark {
    /// Names of its parameters, and whether each is an angle.
    pub fn parameters(&self) -> &'static [(&'static str, bool)] {
        match self {
            Self::Nothing => &[],
            Self::Centre(_) => &[("centre x", false), ("centre y", false), ("centre z", false)],
            Self::Plane { .. } => &[("plane height", false), ("plane tilt 1", true), ("plane tilt 2", true)],
        }
    }

    /// Copy with one parameter changed.
    pub fn moved(&self, entry: usize, change: f64) -> Self {
        match self {
            Self::Nothing => Self::Nothing,
            Self::Centre(centre) => Self::Centre(centre + change * Vector3::ith(entry, 1.0)),
            Self::Plane { normal, height } if entry == 0 => Self::Plane { normal: *normal, height: height + change },
            Self::Plane { normal, height } => {
                let turn = Rotation3::new(change * tangents(normal)[entry - 1]);
                Self::Plane { normal: Unit::new_normalize(turn * normal.into_inner()), height: *height }
            }
        }
    }

    /// Parameters that lead from `start` to this one.
    pub fn displacement(&self, start: &Self) -> [f64; 3] {
        match (start, self) {
            (Self::Centre(from), Self::Centre(to)) => (to - from).into(),
            (Self::Plane { normal: from, height: low }, Self::Plane { normal: to, height }) => {
                let turn = Rotation3::rotation_between(from, to).map_or(Vector3::zeros(), |turn| turn.scaled_axis());
                let [first, second] = tangents(from);
                [height - low, first.dot(&turn), second.dot(&turn)]
            }
            _ => [0.0; 3],
        }
    }
}

/// Two unit vectors that make a right-handed frame with the normal.
pub(super) fn tangents(normal: &Unit<Vector3<f64>>) -> [Vector3<f64>; 2] {
    let least = normal.iamin();
    let first = normal.cross(&Vector3::ith(least, 1.0)).normalize();
    [first, normal.cross(&first)]
}
