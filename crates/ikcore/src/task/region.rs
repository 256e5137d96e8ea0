//! A box that the tip is kept in: p_min < p < p_max, eq. (5) of Cheng et al. (2020).
//!
//! The tip is led to the point of the box that is nearest to its target, a margin inside the faces, so that a search that ends
//! within its tolerance ends inside. A coordinate that the task leaves free has its distance to the box for a residual, which is
//! zero inside.

use serde::{Deserialize, Serialize};

use super::{Assessment, Criterion, Target};
use crate::error::{Error, Result};
use crate::math::vector::dot;
use crate::math::{Frame, MAX_DOF};
use crate::objective::Linearization;

/// The names of the coordinates.
const AXES: [&str; 3] = ["x", "y", "z"];

/// The widest margin (m): no tolerance, however wide, keeps the tip farther from the faces.
const WIDEST_MARGIN: f64 = 1e-3;

/// The value of a tip outside its region.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Outside {
    /// Smaller nearer to the target in the region, so that a search that starts outside finds in.
    #[default]
    Graded,
    /// Infinite, so that a search that starts inside stays there.
    Infinite,
}

/// An open box in the frame of the base; infinite where it has no face.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Region {
    lower: [f64; 3],
    upper: [f64; 3],
}

impl Region {
    /// The box between two corners (m); infinite coordinates leave it open.
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

    /// The lower corner (m).
    pub fn lower(&self) -> &[f64; 3] {
        &self.lower
    }

    /// The upper corner (m).
    pub fn upper(&self) -> &[f64; 3] {
        &self.upper
    }

    /// Whether `point` (m) lies inside; the faces are outside.
    #[inline]
    pub fn contains(&self, point: &[f64; 3]) -> bool {
        (0..3).all(|k| self.lower[k] < point[k] && point[k] < self.upper[k])
    }

    /// The nearest point to `point` (m) that is `margin` (m) from every face, or a quarter of the way between two that are
    /// nearer to each other.
    #[inline]
    pub fn nearest(&self, point: &[f64; 3], margin: f64) -> [f64; 3] {
        std::array::from_fn(|k| {
            let margin = margin.min(0.25 * (self.upper[k] - self.lower[k]));
            point[k].max(self.lower[k] + margin).min(self.upper[k] - margin)
        })
    }

    /// Err unless the tip is inside; `what` names the configuration that puts it there.
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

    /// The faces that `point` violates, in words.
    pub(crate) fn violated_faces(&self, point: &[f64; 3]) -> String {
        let face = |k: usize| match point[k] {
            at if at <= self.lower[k] => Some(format!("{} above {}", AXES[k], self.lower[k])),
            at if at >= self.upper[k] => Some(format!("{} below {}", AXES[k], self.upper[k])),
            _ => None,
        };
        (0..3).filter_map(face).collect::<Vec<_>>().join(" and ")
    }
}

impl Criterion {
    /// The distance from the faces at which the tip is led (m).
    fn margin(&self) -> f64 {
        let within = match self.components.and_then(|components| Some((components.weights, components.tolerance?))) {
            Some((weights, tolerance)) => {
                (0..3).filter(|k| weights[*k] != 0.0).map(|k| tolerance[k]).fold(f64::INFINITY, f64::min)
            }
            None => self.tolerance.position,
        };
        (0.5 * within).min(WIDEST_MARGIN)
    }

    /// Where the tip is led: the `target`, or the nearest place that the region allows.
    pub fn aim(&self, target: &Target) -> Target {
        match &self.region {
            Some(region) => target.with_position(|wanted| region.nearest(wanted, self.margin())),
            None => *target,
        }
    }

    /// Why the region keeps the tip from `target`, in words, if it does: where even its nearest point is beyond the tolerance.
    pub fn blocked_by_region(&self, target: &Target) -> Option<String> {
        let (region, wanted) = (self.region.as_ref()?, target.position()?);
        let anywhere = Self { region: None, ..*self };
        let axes = target.frame().map_or(Frame::IDENTITY.axes, |frame| frame.axes);
        let nearest = Frame { axes, origin: region.nearest(&wanted, 0.0) };
        let error = target.assess_tip(&nearest, &anywhere);
        (!error.score.solved).then(|| format!("its region keeps {}", region.violated_faces(&wanted)))
    }

    /// The coordinates of the tip that `target` leaves free.
    fn free(&self, target: &Target) -> [bool; 3] {
        match (target, &self.components) {
            (Target::Orientation(_), _) => [true; 3],
            (_, Some(components)) => std::array::from_fn(|k| components.weights[k] == 0.0),
            _ => [false; 3],
        }
    }
}

impl Target {
    /// The assessment of `tip`, which is to be in `region`.
    pub(super) fn assess_tip_within(&self, region: &Region, tip: &Frame, criterion: &Criterion) -> Assessment {
        let anywhere = Criterion { region: None, ..*criterion };
        let excess = free_excess(region, &tip.origin, criterion, self);
        let led = criterion.aim(self).assess_tip(tip, &anywhere);
        self.assess_led(region, tip, criterion, led.score.value + dot(&excess, &excess))
    }

    /// The same, with residual and Jacobian.
    pub(super) fn linearize_tip_within(
        &self,
        region: &Region,
        tip: &Frame,
        dof: usize,
        criterion: &Criterion,
        out: &mut Linearization,
    ) -> Assessment {
        let anywhere = Criterion { region: None, ..*criterion };
        let mut linear = [[0.0; 3]; MAX_DOF];
        for (linear, [x, y, z, ..]) in linear.iter_mut().zip(&out.columns[..dof]) {
            *linear = [*x, *y, *z];
        }
        let led = criterion.aim(self).linearize_tip(tip, dof, &anywhere, out);
        let excess = free_excess(region, &tip.origin, criterion, self);
        for k in (0..3).filter(|k| excess[*k] != 0.0) {
            out.residual[k] = excess[k];
            out.columns[..dof].iter_mut().zip(&linear).for_each(|(column, linear)| column[k] = linear[k]);
        }
        self.assess_led(region, tip, criterion, led.score.value + dot(&excess, &excess))
    }

    /// The assessment of a tip that is led at this `value`. Its errors are those to the target itself; it is solved inside the
    /// region, as near to the target as that allows.
    fn assess_led(&self, region: &Region, tip: &Frame, criterion: &Criterion, value: f64) -> Assessment {
        let anywhere = &Criterion { region: None, ..*criterion };
        let inside = region.contains(&tip.origin);
        let within = self.with_position(|wanted| region.nearest(wanted, 0.0));
        let mut assessment = self.assess_tip(tip, anywhere);
        assessment.score.value = match criterion.outside {
            Outside::Infinite if !inside => f64::INFINITY,
            _ => value,
        };
        assessment.score.solved = inside && within.assess_tip(tip, anywhere).score.solved;
        assessment
    }

    /// The same target with its position, if it asks for one, replaced.
    fn with_position(&self, replaced: impl Fn(&[f64; 3]) -> [f64; 3]) -> Self {
        let moved = |frame: &Frame| Frame { origin: replaced(&frame.origin), ..*frame };
        match self {
            Self::Position(position) => Self::Position(replaced(position)),
            Self::Pose(frame) => Self::Pose(moved(frame)),
            Self::Pointing { frame, axis } => Self::Pointing { frame: moved(frame), axis: *axis },
            Self::Orientation(_) => *self,
        }
    }
}

/// How far each free coordinate of the tip is outside (m).
fn free_excess(region: &Region, tip: &[f64; 3], criterion: &Criterion, target: &Target) -> [f64; 3] {
    let inside = region.nearest(tip, criterion.margin());
    let free = criterion.free(target);
    std::array::from_fn(|k| if free[k] { tip[k] - inside[k] } else { 0.0 })
}
