//! Region of the tip, a box p_min < p < p_max: eq. (5) of Cheng et al. (2020).

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};

/// Names of the coordinates.
const AXES: [&str; 3] = ["x", "y", "z"];

/// Value of a tip outside its region.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Outside {
    /// Finite and decreasing towards the region, so that a search that starts outside finds its way in.
    #[default]
    Graded,
    /// Infinite, so that a search that starts inside stays there.
    Infinite,
}

/// Open box in the base frame; infinite where it has no face.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Region {
    lower: [f64; 3],
    upper: [f64; 3],
}

impl Region {
    /// Box between two corners (m); infinite coordinates leave it open.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a NaN, or a lower corner that is not below the upper one.
    pub fn new(lower: [f64; 3], upper: [f64; 3]) -> Result<Self> {
        for k in 0..3 {
            let requirement = match (lower[k], upper[k]) {
                (low, high) if low < high && low < f64::INFINITY && high > f64::NEG_INFINITY => continue,
                (_, high) if high.is_nan() => {
                    return Err(Error::out_of_range(format!("upper {} of region", AXES[k]), "a number", high));
                }
                (_, high) => format!("below its upper one, {high}"),
            };
            return Err(Error::out_of_range(format!("lower {} of region", AXES[k]), &requirement, lower[k]));
        }
        Ok(Self { lower, upper })
    }

    /// Lower corner (m).
    pub fn lower(&self) -> &[f64; 3] {
        &self.lower
    }

    /// Upper corner (m).
    pub fn upper(&self) -> &[f64; 3] {
        &self.upper
    }

    /// Whether `point` (m) is inside; the faces are outside.
    #[inline]
    pub fn contains(&self, point: &[f64; 3]) -> bool {
        (0..3).all(|k| self.lower[k] < point[k] && point[k] < self.upper[k])
    }

    /// Point nearest to `point` (m) with a distance of `margin` (m) from every face, or of a quarter of the distance of two
    /// close faces.
    #[inline]
    pub fn nearest(&self, point: &[f64; 3], margin: f64) -> [f64; 3] {
        std::array::from_fn(|k| {
            let margin = margin.min(0.25 * (self.upper[k] - self.lower[k]));
            point[k].max(self.lower[k] + margin).min(self.upper[k] - margin)
        })
    }

    /// Checks that the tip is inside; `what` names its configuration in the error.
    ///
    /// # Errors
    /// [`Error::OutsideRegion`] names the coordinate, its value and its range.
    pub fn require_inside(&self, what: &str, tip: &[f64; 3]) -> Result<()> {
        match (0..3).find(|k| !(self.lower[*k] < tip[*k] && tip[*k] < self.upper[*k])) {
            None => Ok(()),
            Some(k) => Err(Error::OutsideRegion {
                what: what.into(),
                coordinate: AXES[k].into(),
                value: tip[k],
                lower: self.lower[k],
                upper: self.upper[k],
            }),
        }
    }

    /// Describes the faces that `point` violates.
    pub(crate) fn violated_faces(&self, point: &[f64; 3]) -> String {
        let face = |k: usize| match point[k] {
            at if at <= self.lower[k] => Some(format!("{} above {}", AXES[k], self.lower[k])),
            at if at >= self.upper[k] => Some(format!("{} below {}", AXES[k], self.upper[k])),
            _ => None,
        };
        (0..3).filter_map(face).collect::<Vec<_>>().join(" and ")
    }
}
