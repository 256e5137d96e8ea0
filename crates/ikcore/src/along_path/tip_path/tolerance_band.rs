//! Tolerance band of the tip around its path, component by component.

use crate::error::{Error, Result};
use crate::math::Frame;
use crate::math::arithmetic::NoFma;
use crate::math::box_step::ROWS;
use crate::math::so3::norm;
use crate::objective::TaskBlock;
use crate::task::{Components, Criterion, Target, Tolerance};
use crate::wording::number;

/// Target depth inside the band (m, rad) of a configuration sought from outside, so that the search ends. Small,
/// because configurations that follow one another along the border are not to differ for it.
const INSIDE: f64 = 1e-6;

/// Displacement of the tip from a target, along its axes: x, y, z (m) and the rotation vector (rad), or the difference
/// of the axes of a pointing target.
pub(crate) type Displacement = [f64; ROWS];

/// Largest displacement of each component of the tip: x, y, z (m) and the rotation vector (rad), along the axes of the
/// target. For a pointing target the fourth is the angle between the axes.
///
/// It is the tolerance of the task, less the accuracy: what the tip strays between points is within the tolerance too.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ToleranceBand {
    allowed: [f64; ROWS],
}

/// Borders of the tolerance band, to which components are drawn while a configuration is sought: a sign each, or 0.
///
/// A component that has been beyond stays drawn to its border, or else the next step could undo what the last one did.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Borders([f64; ROWS]);

impl ToleranceBand {
    /// Returns the band that `components` leave to a motion that strays by `accuracy`.
    ///
    /// # Errors
    /// [`Error::Contradiction`] if that is more than the smallest tolerance.
    pub fn new(components: &Components, accuracy: f64) -> Result<Self> {
        let least = smallest_tolerance(components);
        if accuracy > least {
            let (accuracy, least) = (number(accuracy), number(least));
            let problem = format!("accuracy {accuracy} is more than the smallest tolerance of the task, {least}");
            return Err(Error::Contradiction { problem: problem.into() });
        }
        let allowed = |k: usize| match components.tolerance {
            _ if components.weights[k] == 0.0 => f64::INFINITY,
            Some(tolerance) => tolerance[k] - accuracy,
            None => 0.0,
        };
        Ok(Self { allowed: std::array::from_fn(allowed) })
    }

    /// Returns the band that `components` leave to the orientation of a motion that strays by `accuracy` (rad), with none for the position.
    pub fn of_orientation(components: &Components, accuracy: f64) -> Self {
        let allowed = |k: usize| match components.tolerance {
            _ if k < 3 => 0.0,
            _ if components.weights[k] == 0.0 => f64::INFINITY,
            Some(tolerance) => (tolerance[k] - accuracy).max(0.0),
            None => 0.0,
        };
        Self { allowed: std::array::from_fn(allowed) }
    }

    /// The largest displacement of each component.
    pub fn allowed(&self) -> &[f64; ROWS] {
        &self.allowed
    }

    /// The same band with no component off by more than `most`; free components stay free.
    pub fn at_most(&self, most: f64) -> Self {
        Self { allowed: self.allowed.map(|allowed| if allowed.is_finite() { allowed.min(most) } else { allowed }) }
    }

    /// The largest bound of a component that is not free.
    pub fn largest(&self) -> f64 {
        self.allowed.into_iter().filter(|allowed| allowed.is_finite()).fold(0.0, f64::max)
    }

    /// The criterion whose residual has one row for each component.
    pub fn criterion() -> Criterion {
        let components = Some(Components { weights: [1.0; ROWS], tolerance: None });
        Criterion { components, ..Tolerance::default().into() }
    }

    /// Reduces residual and Jacobian to the excess over the tolerance band; returns the sum of its squares.
    pub fn reduce(&self, target: &Target, borders: &mut Borders, dof: usize, block: &mut TaskBlock) -> f64 {
        let mut squares = 0.0;
        for k in 0..separate_components(target) {
            let (residual, allowed) = (block.residual[k], self.allowed[k]);
            let beyond = (residual.abs() - allowed).max(0.0);
            squares += beyond * beyond;
            if beyond > 0.0 {
                borders.0[k] = residual.signum();
            }
            if allowed == 0.0 {
                continue;
            }
            if borders.0[k] == 0.0 {
                drop_row(k, dof, block);
            } else {
                block.residual[k] -= (allowed - INSIDE).max(0.0) * borders.0[k];
            }
        }
        if is_pointing(target) { squares + self.reduce_angle(borders, dof, block) } else { squares }
    }

    /// Reduces the difference of two axes, of which only the length counts.
    fn reduce_angle(&self, borders: &mut Borders, dof: usize, block: &mut TaskBlock) -> f64 {
        let [_, _, _, difference @ ..] = block.residual;
        let (chord, allowed) = (norm(&difference), chord_of(self.allowed[3]));
        let beyond = (chord - allowed).max(0.0);
        if beyond > 0.0 {
            borders.0[3] = 1.0;
        }
        if allowed > 0.0 {
            let is_drawn = borders.0[3] != 0.0 && chord > 0.0;
            let along = if is_drawn { difference.map(|entry| entry / chord) } else { [0.0; 3] };
            let missing = if is_drawn { chord - (allowed - INSIDE).max(0.0) } else { 0.0 };
            block.residual[3..].copy_from_slice(&[missing, 0.0, 0.0]);
            for column in &mut block.columns[..dof] {
                let slope = (0..3).map(|k| along[k] * column[3 + k]).sum();
                column[3..].copy_from_slice(&[slope, 0.0, 0.0]);
            }
        }
        beyond * beyond
    }

    /// Turns residual and Jacobian into those of a tip that is to be at `displacement`, without free components. Returns the
    /// sum of squares.
    pub fn hold(&self, target: &Target, displacement: &Displacement, dof: usize, block: &mut TaskBlock) -> f64 {
        let mut displacement = *displacement;
        if let Target::Pointing { frame, .. } = target {
            let [_, _, _, difference @ ..] = displacement;
            displacement[3..].copy_from_slice(&frame.turn::<NoFma>(&difference));
        }
        for k in 0..ROWS {
            if self.allowed[k].is_infinite() {
                drop_row(k, dof, block);
            } else {
                block.residual[k] -= displacement[k];
            }
        }
        block.residual.iter().map(|residual| residual * residual).sum()
    }

    /// Displacement of a tip from `target`.
    pub fn displacement_of(target: &Target, tip: &Frame) -> Displacement {
        let mut displacement = target.residual_by_component(tip);
        if let Target::Pointing { frame, .. } = target {
            let [_, _, _, difference @ ..] = displacement;
            displacement[3..].copy_from_slice(&frame.turn_back(&difference));
        }
        displacement
    }

    /// The distance (m) and the angle (rad) of a tip from the nearest pose within the tolerance band of `target`.
    pub fn excess(&self, target: &Target, tip: &Frame) -> [f64; 2] {
        let residual = target.residual_by_component(tip);
        let beyond = |k: usize| (residual[k].abs() - self.allowed[k]).max(0.0);
        let distance = norm(&std::array::from_fn(beyond));
        let angle = match target {
            Target::Pointing { .. } => (angle_of(&residual) - self.allowed[3]).max(0.0),
            _ => norm(&std::array::from_fn(|k| beyond(3 + k))),
        };
        [distance, angle]
    }
}

/// The smallest tolerance (m, rad) of a component that is not free; infinite without one.
pub(crate) fn smallest_tolerance(components: &Components) -> f64 {
    let Some(tolerance) = components.tolerance else { return f64::INFINITY };
    let kept = components.weights.iter().zip(tolerance).filter(|(weight, _)| **weight > 0.0);
    kept.map(|(_, tolerance)| tolerance).fold(f64::INFINITY, f64::min)
}

/// The difference of two axes with an angle (rad) between them.
fn chord_of(angle: f64) -> f64 {
    2.0 * (0.5 * angle.min(std::f64::consts::PI)).sin()
}

/// The angle (rad) between two axes, from their difference in the last three entries.
fn angle_of(residual: &[f64; ROWS]) -> f64 {
    2.0 * (0.5 * norm(&std::array::from_fn(|k| residual[3 + k]))).min(1.0).asin()
}

/// Number of components with a tolerance of their own: of a pointing target x, y and z.
fn separate_components(target: &Target) -> usize {
    if is_pointing(target) { 3 } else { ROWS }
}

fn drop_row(k: usize, dof: usize, block: &mut TaskBlock) {
    block.residual[k] = 0.0;
    block.columns[..dof].iter_mut().for_each(|column| column[k] = 0.0);
}

fn is_pointing(target: &Target) -> bool {
    matches!(target, Target::Pointing { .. })
}
