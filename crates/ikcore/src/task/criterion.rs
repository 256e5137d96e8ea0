//! Criterion for reaching a target.

use serde::{Deserialize, Serialize};

use super::components::Components;
use super::region::{Outside, Region};
use super::target::Target;
use super::tip_error::Tolerance;
use crate::error::Result;

/// Largest margin (m) between the tip and the faces of its region, however wide the tolerance.
const WIDEST_MARGIN: f64 = 1e-3;

/// Criterion for reaching a target, and the weights of its components.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Criterion {
    /// Largest distance and angle.
    pub tolerance: Tolerance,
    /// Weights and tolerances component by component. `None` means equal weights.
    pub components: Option<Components>,
    /// Region of the tip. `None` means unrestricted.
    pub region: Option<Region>,
    /// Value of a tip outside its region.
    pub outside: Outside,
    /// Whether the value is the excess over the tolerances, instead of the whole error.
    #[serde(skip)]
    pub beyond: bool,
}

impl From<Tolerance> for Criterion {
    fn from(tolerance: Tolerance) -> Self {
        Self { tolerance, ..Self::default() }
    }
}

impl Criterion {
    /// Checks tolerances and weights.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names the entry.
    pub fn validate(&self) -> Result<()> {
        self.tolerance.validate()?;
        self.components.as_ref().map_or(Ok(()), Components::validate)
    }

    /// Criterion whose value is the whole error, without a region.
    pub(crate) fn exact(self) -> Self {
        Self { beyond: false, region: None, ..self }
    }

    /// Multiplies all tolerances by `fraction`.
    pub(crate) fn narrow(&mut self, fraction: f64) {
        let Tolerance { position, rotation } = &mut self.tolerance;
        let of_components = self.components.iter_mut().filter_map(|components| components.tolerance.as_mut());
        of_components.flatten().chain([position, rotation]).for_each(|tolerance| *tolerance *= fraction);
    }

    /// Whether `target` fixes a whole pose under this criterion.
    pub(crate) fn fixes_pose(&self, target: &Target) -> bool {
        matches!(target, Target::Pose(_)) && self.components.is_none() && self.region.is_none()
    }

    /// Whether components are assessed separately, so that the distance alone does not decide.
    #[inline(always)]
    pub(super) fn is_componentwise(&self) -> bool {
        self.components.is_some() || self.region.is_some() || self.beyond
    }

    /// Margin (m) that the tip keeps from the faces.
    pub(super) fn margin(&self) -> f64 {
        let within = match self.components.and_then(|components| Some((components.weights, components.tolerance?))) {
            Some((weights, tolerance)) => {
                (0..3).filter(|k| weights[*k] != 0.0).map(|k| tolerance[k]).fold(f64::INFINITY, f64::min)
            }
            None => self.tolerance.position,
        };
        (0.5 * within).min(WIDEST_MARGIN)
    }

    /// Target of the search: `target` itself, or the nearest position in the region, within the tolerances if there is one.
    pub(crate) fn aim(&self, target: &Target) -> Target {
        let Some(region) = &self.region else { return *target };
        self.aim_within(region, target, self.position_within_both(region, target))
    }

    /// Target of the search in `region`, with what [`position_within_both`](Self::position_within_both) returned.
    pub(super) fn aim_within(&self, region: &Region, target: &Target, both: Option<[f64; 3]>) -> Target {
        target.with_position(|wanted| both.unwrap_or_else(|| region.nearest(wanted, self.margin())))
    }

    /// Coordinates of the tip that `target` leaves free.
    pub(super) fn free(&self, target: &Target) -> [bool; 3] {
        match (target, &self.components) {
            (Target::Orientation(_), _) => [true; 3],
            (_, Some(components)) => std::array::from_fn(|k| components.weights[k] == 0.0),
            _ => [false; 3],
        }
    }
}
