//! Smooth paths in a tube around a given one: of least bending among cubic splines that stay within a tolerance of it, at
//! samples first, and then checked on the whole path.

use super::constant_limits::ConstantLimits;
use super::joint_path::{JointPath, POWERS};
use super::least_bending::{AIM, Fit, local};
use crate::error::Result;
use crate::interrupt::{checkpoint, checkpoint_at};
use crate::math::cubic_bspline::CubicBasis;
use crate::math::polynomial::largest_magnitude;

/// Minimum number of samples of the path.
const SAMPLES: usize = 300;
/// Minimum number of samples per piece of the path.
const SAMPLES_PER_PIECE: usize = 2;

/// Number of times that the tube is narrowed because the path leaves it between samples.
const NARROWINGS: usize = 2;

/// A path, and samples of it.
pub(super) struct Tube<'a> {
    path: &'a JointPath,
    limits: &'a ConstantLimits,
    /// Path parameters of the samples, scaled to \[0, 1\].
    at: Vec<f64>,
    /// Positions of each joint at the samples.
    positions: Vec<Vec<f64>>,
}

impl<'a> Tube<'a> {
    pub(super) fn new(path: &'a JointPath, limits: &'a ConstantLimits) -> Self {
        let per_piece = SAMPLES_PER_PIECE.max(SAMPLES.div_ceil(path.pieces()));
        let mut tube = Self { path, limits, at: Vec::new(), positions: vec![Vec::new(); path.joints().len()] };
        for piece in 0..path.pieces() {
            // The first sample of a piece is the end of the piece before it.
            for i in 0..per_piece {
                tube.add(piece, path.length(piece) * i as f64 / per_piece as f64);
            }
        }
        tube.add(path.pieces() - 1, path.length(path.pieces() - 1));
        tube
    }

    fn add(&mut self, piece: usize, from: f64) {
        let breaks = self.path.breaks();
        let [begin, end] = [breaks[0], breaks[self.path.pieces()]];
        self.at.push(((breaks[piece] + from - begin) / (end - begin)).clamp(0.0, 1.0));
        for (joint, positions) in self.positions.iter_mut().enumerate() {
            positions.push(self.path.joint_at(piece, from, joint)[0]);
        }
    }

    /// Returns the smooth path with the fewest pieces, doubled from `pieces`, within `tolerance` (rad, m) of the path in each
    /// joint; also their number. `None` if more pieces than samples would be needed.
    ///
    /// # Errors
    /// [`crate::Error::Interrupted`].
    pub(super) fn smoothest(&self, tolerance: &[f64], mut pieces: usize) -> Result<Option<(JointPath, usize)>> {
        while pieces <= self.at.len() / 2 {
            if let Some(smooth) = self.with_pieces(tolerance, pieces)? {
                return Ok(Some((smooth, pieces)));
            }
            pieces *= 2;
        }
        Ok(None)
    }

    fn with_pieces(&self, tolerance: &[f64], pieces: usize) -> Result<Option<JointPath>> {
        let fit = Fit::new(CubicBasis { pieces }, &self.at);
        let mut inner = tolerance.to_vec();
        for _ in 0..=NARROWINGS {
            let mut joints = Vec::with_capacity(inner.len());
            for (joint, tolerance) in inner.iter().enumerate() {
                checkpoint()?;
                match fit.least_bending(&self.bounds(joint, *tolerance)) {
                    Some(coefficients) => joints.push(coefficients),
                    None => return Ok(None),
                }
            }
            let smooth = self.assembled(fit.basis, &joints);
            let deviations = self.deviations(&smooth)?;
            if deviations.iter().zip(tolerance).all(|(deviation, tolerance)| deviation <= tolerance) {
                return Ok(Some(smooth));
            }
            for ((inner, deviation), tolerance) in inner.iter_mut().zip(&deviations).zip(tolerance) {
                *inner *= (AIM * tolerance / deviation).min(1.0);
            }
        }
        Ok(None)
    }

    /// The tube of a joint at the samples, as middle and half width, inside its position limits.
    fn bounds(&self, joint: usize, tolerance: f64) -> Vec<[f64; 2]> {
        let [lower, upper] = [self.limits.lower[joint], self.limits.upper[joint]];
        let of_sample = |q: &f64| {
            let [low, high] = [(q - tolerance).max(lower), (q + tolerance).min(upper)];
            [0.5 * (low + high), 0.5 * (high - low)]
        };
        let mut bounds: Vec<[f64; 2]> = self.positions[joint].iter().map(of_sample).collect();
        // The motion begins and ends where the path does.
        let last = bounds.len() - 1;
        for i in [0, last] {
            bounds[i] = [self.positions[joint][i], tolerance];
        }
        bounds
    }

    /// The splines of all joints over the parameter of the path. A joint at rest stays exactly at rest.
    fn assembled(&self, basis: CubicBasis, joints: &[Vec<f64>]) -> JointPath {
        let [begin, end] = [self.path.breaks()[0], self.path.breaks()[self.path.pieces()]];
        let (n, span) = (joints.len(), end - begin);
        let mut breaks: Vec<f64> = (0..=basis.pieces).map(|i| begin + span * i as f64 / basis.pieces as f64).collect();
        breaks[basis.pieces] = end;
        let lengths = vec![span / basis.pieces as f64; basis.pieces];
        let mut coefficients = vec![0.0; basis.pieces * POWERS * n];
        for (joint, of_joint) in joints.iter().enumerate() {
            let rests = self.positions[joint].iter().all(|q| *q == self.positions[joint][0]);
            for piece in 0..basis.pieces {
                let powers = basis.powers(piece, local(of_joint, piece));
                let powers = if rests { [self.positions[joint][0], 0.0, 0.0, 0.0] } else { powers };
                for (power, coefficient) in powers.into_iter().enumerate() {
                    coefficients[(POWERS * piece + power) * n + joint] = coefficient / span.powi(power as i32);
                }
            }
        }
        JointPath::from_parts(self.path.joints().to_vec(), breaks, lengths, coefficients)
    }

    /// Largest distance of each joint of `smooth` from the path, at the same path parameter.
    fn deviations(&self, smooth: &JointPath) -> Result<Vec<f64>> {
        let mut largest = vec![0.0_f64; self.positions.len()];
        let mut piece = 0;
        for smooth_piece in 0..smooth.pieces() {
            checkpoint_at(smooth_piece)?;
            let [begin, end] = [smooth.breaks()[smooth_piece], smooth.breaks()[smooth_piece + 1]];
            loop {
                let [from, to] = [self.path.breaks()[piece].max(begin), self.path.breaks()[piece + 1].min(end)];
                for (joint, largest) in largest.iter_mut().enumerate() {
                    let given = powers_from(self.path, piece, from, joint);
                    let ours = powers_from(smooth, smooth_piece, from, joint);
                    let difference = [0, 1, 2, 3].map(|power| ours[power] - given[power]);
                    *largest = largest.max(largest_magnitude(&difference, 0.0, to - from));
                }
                if self.path.breaks()[piece + 1] >= end || piece + 1 == self.path.pieces() {
                    break;
                }
                piece += 1;
            }
        }
        Ok(largest)
    }
}

/// Coefficients of the powers of s - `from` of a joint in a piece.
fn powers_from(path: &JointPath, piece: usize, from: f64, joint: usize) -> [f64; POWERS] {
    let [value, first, second] = path.joint_at(piece, from - path.breaks()[piece], joint);
    [value, first, 0.5 * second, path.powers(piece)[3][joint]]
}
