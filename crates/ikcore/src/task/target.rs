//! Where the tip is to be, and how far a tip is from there.

use super::residual::{orientation, pointing, pose, position};
use super::{Assessment, Criterion, SquaredError};
use crate::error::{Result, require_finite};
use crate::math::box_step::ROWS;
use crate::math::real::Real;
use crate::math::so3::axes_of;
use crate::math::{Frame, Pose};
use crate::objective::Linearization;
use crate::robot::Robot;

/// Where the tip is to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// A position (m), the orientation left free.
    Position([f64; 3]),
    /// A full pose.
    Pose(Frame),
    /// The orientation of a frame, the position left free.
    Orientation(Frame),
    /// The position of a frame, and the direction that `axis` has in it; the spin about that is left free.
    Pointing {
        /// Where the tip would be if its spin mattered too.
        frame: Frame,
        /// Of unit length, in the tip's own coordinates.
        axis: [f64; 3],
    },
}

impl From<&Pose> for Target {
    fn from(pose: &Pose) -> Self {
        Self::Pose(Frame::from(pose))
    }
}

impl Target {
    /// Checks that every number is finite.
    ///
    /// # Errors
    /// [`Error::NotFinite`](crate::Error::NotFinite).
    pub fn validate(&self) -> Result<()> {
        let frame = match self {
            Self::Position(position) => return check_point(position),
            Self::Pose(frame) | Self::Orientation(frame) | Self::Pointing { frame, .. } => frame,
        };
        check_point(&frame.origin)?;
        require_finite("target", frame.axes.as_flattened(), |i| format!("rotation entry {i}"))
    }

    /// The position asked for (m), if any.
    pub fn position(&self) -> Option<[f64; 3]> {
        match self {
            Self::Position(position) => Some(*position),
            Self::Pose(frame) | Self::Pointing { frame, .. } => Some(frame.origin),
            Self::Orientation(_) => None,
        }
    }

    /// The assessment of the tip of `robot` at `q`, by `criterion`.
    #[inline]
    pub fn assess(&self, robot: &Robot, q: &[f64], criterion: &Criterion) -> Assessment {
        match (self, criterion.is_componentwise()) {
            (Self::Position(target), false) => position_alone(target, &robot.tip_position(q), criterion),
            _ => self.assess_tip(&robot.tip(q), criterion),
        }
    }

    /// Hands the [assessments](Self::assess) of the configurations stored one after another to `keep`, in order; several at a time
    /// where only positions matter.
    #[inline]
    pub fn assess_all(&self, robot: &Robot, qs: &[f64], criterion: &Criterion, mut keep: impl FnMut(Assessment)) {
        match (self, criterion.is_componentwise()) {
            (Self::Position(target), false) => {
                robot.tip_positions(qs, |tip| keep(position_alone(target, &tip, criterion)));
            }
            _ => qs.chunks(robot.dof()).for_each(|q| keep(self.assess(robot, q, criterion))),
        }
    }

    /// The assessment of `tip`, by `criterion`.
    #[inline]
    pub fn assess_tip(&self, tip: &Frame, criterion: &Criterion) -> Assessment {
        if let Some(region) = &criterion.region {
            return self.assess_tip_within(region, tip, criterion);
        }
        let (error, value) = self.error(tip);
        match &criterion.components {
            None => criterion.assess_unweighted(error, value),
            Some(components) => criterion.assess_components(components, self, &self.residual(tip), error),
        }
    }

    /// Weighted residual and Jacobian at `q`, and the assessment by `criterion`.
    #[inline]
    pub fn linearize(&self, robot: &Robot, q: &[f64], criterion: &Criterion, out: &mut Linearization) -> Assessment {
        let tip = robot.tip_and_jacobian(q, &mut out.columns);
        self.linearize_tip(&tip, q.len(), criterion, out)
    }

    /// The same from a tip and its geometric Jacobian, which stands in the first `dof` columns of `out`.
    #[inline]
    pub fn linearize_tip(&self, tip: &Frame, dof: usize, criterion: &Criterion, out: &mut Linearization) -> Assessment {
        if let Some(region) = &criterion.region {
            return self.linearize_tip_within(region, tip, dof, criterion, out);
        }
        let (error, value) = self.linearize_unweighted(tip, dof, out);
        let Some(components) = &criterion.components else { return criterion.assess_unweighted(error, value) };
        let assessment = criterion.assess_components(components, self, &out.residual, error);
        components.apply(self, dof, out);
        assessment
    }

    /// Unweighted residual and Jacobian, in base coordinates; the errors and r'r.
    #[inline]
    fn linearize_unweighted(&self, tip: &Frame, dof: usize, out: &mut Linearization) -> (SquaredError, f64) {
        match self {
            Self::Pose(target) => summed(pose::linearize(target, tip, dof, out)),
            Self::Position(target) => {
                position::linearize(target, &tip.origin, dof, out);
                self.error(tip)
            }
            Self::Pointing { frame, axis } => pointing::linearize(frame, axis, tip, dof, out),
            Self::Orientation(target) => {
                out.residual[..3].fill(0.0);
                out.columns[..dof].iter_mut().for_each(|column| column[..3].fill(0.0));
                let Linearization { residual, columns } = out;
                let (target, tip) = (axes_of(target), axes_of(tip));
                let rotation = orientation::linearize(&target, &tip, residual, &mut columns[..dof]);
                summed(SquaredError { position: None, rotation: Some(rotation.stored()) })
            }
        }
    }

    /// The errors and r'r.
    #[inline]
    fn error(&self, tip: &Frame) -> (SquaredError, f64) {
        match self {
            Self::Pose(target) => summed(pose::error(target, tip)),
            Self::Position(target) => {
                summed(SquaredError { position: Some(position::error(target, &tip.origin)), rotation: None })
            }
            Self::Pointing { frame, axis } => pointing::error(frame, axis, tip),
            Self::Orientation(target) => {
                summed(SquaredError { position: None, rotation: Some(orientation::error(target, tip)) })
            }
        }
    }

    fn residual(&self, tip: &Frame) -> [f64; ROWS] {
        let mut out = Linearization::default();
        self.linearize_unweighted(tip, 0, &mut out);
        out.residual
    }
}

#[inline(always)]
fn position_alone(target: &[f64; 3], tip: &[f64; 3], criterion: &Criterion) -> Assessment {
    let squared = position::error(target, tip);
    criterion.assess_unweighted(SquaredError { position: Some(squared), rotation: None }, squared)
}

/// Errors whose squares are those of the residual.
#[inline(always)]
fn summed(error: SquaredError) -> (SquaredError, f64) {
    (error, error.sum())
}

fn check_point(point: &[f64; 3]) -> Result<()> {
    require_finite("target", point, |i| format!("coordinate {}", ["x", "y", "z"][i]))
}
