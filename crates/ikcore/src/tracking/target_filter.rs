//! Filters of noisy targets, for positions and orientations.
//!
//! A filter trades noise for delay. A low-pass of cutoff f delays a moving target by 1 / (2 pi f). The one-euro filter
//! (Casiez, Roussel and Vogel 2012) raises its cutoff with the speed of the target: little noise at rest, little delay in
//! motion.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::error::{Result, require_finite, require_positive};
use crate::math::so3::norm;
use crate::task::{Target, TargetSegment, Twist};

/// Cutoff of the speed that the one-euro filter adapts to (Hz), as in the paper.
const SPEED_CUTOFF: f64 = 1.0;

/// First-order low-pass.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LowPass {
    /// Cutoff (Hz).
    pub cutoff: f64,
}

/// One-euro filter, with cutoff `min_cutoff` + `beta` speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct OneEuro {
    /// Cutoff at rest (Hz).
    pub min_cutoff: f64,
    /// Increase of the cutoff with speed: Hz per m/s for positions, per rad/s for orientations.
    pub beta: f64,
}

/// Filter of noisy targets.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum TargetFilter {
    /// First-order low-pass.
    LowPass(LowPass),
    /// One-euro filter.
    OneEuro(OneEuro),
}

impl TargetFilter {
    /// Checks the settings.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) for a cutoff that is not positive or a negative `beta`.
    pub fn validate(&self) -> Result<()> {
        match *self {
            Self::LowPass(LowPass { cutoff }) => require_positive("cutoff", cutoff),
            Self::OneEuro(OneEuro { min_cutoff, beta }) => {
                require_positive("min_cutoff", min_cutoff)?;
                require_finite("beta", &[beta], |_| "value".into())?;
                if beta >= 0.0 { Ok(()) } else { Err(crate::Error::out_of_range("beta", "at least 0", beta)) }
            }
        }
    }

    /// Fractions of the distance to a target that the filter covers in `interval` (s), for position and orientation, at these
    /// speeds (m/s, rad/s).
    fn fractions(&self, speeds: [f64; 2], interval: f64) -> [f64; 2] {
        let cutoffs = match *self {
            Self::LowPass(LowPass { cutoff }) => [cutoff; 2],
            Self::OneEuro(OneEuro { min_cutoff, beta }) => speeds.map(|speed| min_cutoff + beta * speed),
        };
        cutoffs.map(|cutoff| fraction(cutoff, interval))
    }
}

/// Fraction of a step that a low-pass covers in `interval` (s).
fn fraction(cutoff: f64, interval: f64) -> f64 {
    1.0 - (-TAU * cutoff * interval).exp()
}

/// Running filter with its state.
#[derive(Debug)]
pub(super) struct RunningFilter {
    settings: TargetFilter,
    /// Last target, raw and filtered.
    last: Option<[Target; 2]>,
    twist: Twist,
}

impl RunningFilter {
    pub fn new(settings: TargetFilter) -> Self {
        Self { settings, last: None, twist: Twist { linear: [0.0; 3], angular: [0.0; 3] } }
    }

    /// Filters the target, received `interval` (s) after the last one. The first target is not filtered.
    pub fn filtered(&mut self, target: &Target, interval: f64) -> Target {
        let same_kind = |[raw, _]: &[Target; 2]| std::mem::discriminant(raw) == std::mem::discriminant(target);
        let Some([raw, filtered]) = self.last.filter(same_kind) else {
            self.last = Some([*target; 2]);
            return *target;
        };
        let motion = |begin: Target| TargetSegment { begin, end: *target, velocities: None, dt: interval };
        let (_, measured) = motion(raw).at(1.0);
        let speed_fraction = fraction(SPEED_CUTOFF, interval);
        let Twist { linear, angular } = &mut self.twist;
        for (smooth, measured) in linear.iter_mut().zip(measured.linear).chain(angular.iter_mut().zip(measured.angular))
        {
            *smooth += speed_fraction * (measured - *smooth);
        }
        let [position, rotation] = self.settings.fractions([norm(linear), norm(angular)], interval);
        let placed = motion(filtered).at(position).0.position();
        let turned = motion(filtered).at(rotation).0;
        let result = turned.with_position(|own| placed.unwrap_or(*own));
        self.last = Some([*target, result]);
        result
    }
}
