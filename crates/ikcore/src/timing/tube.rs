//! Smooth paths in a tube around a given one: of least bending among cubic splines that stay within a tolerance of it.
//!
//! The bound is imposed at samples by weights, which grow where the spline leaves the tube and fall where it is inside
//! (iteratively reweighted least squares, as C. L. Lawson, 1961), and is then checked on the whole path.

use super::constant_limits::ConstantLimits;
use super::joint_path::{JointPath, POWERS};
use crate::error::Result;
use crate::interrupt::{checkpoint, checkpoint_at};
use crate::math::banded::{self, Band};
use crate::math::cubic_bspline::{BASIS, CubicBasis};
use crate::math::polynomial::largest_magnitude;

/// Smallest number of samples of the path; each piece has at least `SAMPLES_PER_PIECE`.
const SAMPLES: usize = 300;
const SAMPLES_PER_PIECE: usize = 2;

/// Weight of a sample against bending at which a spline is almost a least-squares fit, and the factor between weights tried.
const LARGEST_WEIGHT: f64 = 1e10;
const SMALLEST_WEIGHT: f64 = 1e-10;
const WEIGHT_STEP: f64 = 10.0;
/// Largest part of the tolerance by which a least-squares fit may miss the tube for reweighting to bring it inside.
const HOPELESS: f64 = 4.0;
/// Number of times that the weights are adapted, and the range of one change.
const REWEIGHTINGS: usize = 20;
const SMALLEST_CHANGE: f64 = 0.3;
const LARGEST_CHANGE: f64 = 3.0;
/// Deviation aimed at, as a fraction of the tolerance: reweighting approaches its bound from outside.
const AIM: f64 = 0.97;
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
    /// joint; also their number. `None` if more pieces than samples would be needed, or if nothing is left of the motion.
    ///
    /// # Errors
    /// [`crate::Error::Interrupted`].
    pub(super) fn smoothest(&self, tolerance: &[f64], mut pieces: usize) -> Result<Option<(JointPath, usize)>> {
        while pieces <= self.at.len() / 2 {
            if let Some(smooth) = self.with_pieces(tolerance, pieces)? {
                return Ok((!is_a_point(&smooth)).then_some((smooth, pieces)));
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

fn is_a_point(path: &JointPath) -> bool {
    (0..path.joints().len()).all(|joint| {
        let [lowest, highest] = path.range(joint);
        highest - lowest <= 1e-12 * lowest.abs().max(1.0)
    })
}

fn local(coefficients: &[f64], piece: usize) -> [f64; BASIS] {
    [0, 1, 2, 3].map(|i| coefficients[piece + i])
}

/// Weighted fits of splines to samples.
struct Fit {
    basis: CubicBasis,
    /// Basis functions at each sample, and the piece that it is on.
    values: Vec<(usize, [f64; BASIS])>,
    /// The integral of the squared second derivative, as a quadratic form of the coefficients, with mean one on its diagonal.
    bending: Band,
}

impl Fit {
    fn new(basis: CubicBasis, at: &[f64]) -> Self {
        let of_sample = |u: &f64| (basis.piece_of(*u), basis.values(basis.piece_of(*u), *u));
        Self { basis, values: at.iter().map(of_sample).collect(), bending: bending(basis) }
    }

    /// Returns the coefficients of least bending inside `bounds` (middle and half width at each sample), ends at the middle;
    /// `None` if there seem to be none.
    fn least_bending(&self, bounds: &[[f64; 2]]) -> Option<Vec<f64>> {
        if bounds.iter().any(|[_, half]| !(*half > 0.0)) {
            return None;
        }
        let mut weight = LARGEST_WEIGHT;
        let mut fitted = self.weighted(bounds, &vec![weight; bounds.len()]);
        if self.excess(&fitted, bounds) > HOPELESS {
            return None;
        }
        let mut best = None;
        while self.excess(&fitted, bounds) <= 1.0 && weight > SMALLEST_WEIGHT {
            weight /= WEIGHT_STEP;
            best = Some((self.roughness(&fitted), fitted));
            fitted = self.weighted(bounds, &vec![weight; bounds.len()]);
        }
        let mut weights = vec![weight; bounds.len()];
        for _ in 0..REWEIGHTINGS {
            self.adapt(&mut weights, &fitted, bounds);
            fitted = self.weighted(bounds, &weights);
            if self.excess(&fitted, bounds) <= 1.0 {
                let roughness = self.roughness(&fitted);
                if best.as_ref().is_none_or(|(least, _)| roughness < *least) {
                    best = Some((roughness, fitted.clone()));
                }
            }
        }
        best.map(|(_, coefficients)| coefficients)
    }

    /// Multiplies each weight by the deviation of its sample from the middle, in parts of the half width aimed at.
    fn adapt(&self, weights: &mut [f64], coefficients: &[f64], bounds: &[[f64; 2]]) {
        for ((weight, sample), [middle, half]) in weights.iter_mut().zip(&self.values).zip(bounds) {
            let deviation = (value(sample, coefficients) - middle).abs() / (AIM * half);
            *weight *= deviation.clamp(SMALLEST_CHANGE, LARGEST_CHANGE);
        }
        let least = 1e-10 * weights.iter().copied().fold(0.0, f64::max);
        weights.iter_mut().for_each(|weight| *weight = weight.max(least));
    }

    /// Coefficients that minimise the bending plus the weighted squared deviations, the first and the last one fixed.
    fn weighted(&self, bounds: &[[f64; 2]], weights: &[f64]) -> Vec<f64> {
        let (mut band, mut right) = (self.bending.clone(), vec![0.0; self.basis.coefficients()]);
        for ((sample, [middle, _]), weight) in self.values.iter().zip(bounds).zip(weights) {
            let (piece, values) = sample;
            for i in 0..BASIS {
                let weighted = weight * values[i];
                right[piece + i] += weighted * middle;
                for j in i..BASIS {
                    band[piece + i][j - i] += weighted * values[j];
                }
            }
        }
        fix_ends(&mut band, &mut right, [bounds[0][0], bounds[bounds.len() - 1][0]]);
        banded::solve(&mut band, &mut right);
        right
    }

    /// Largest deviation from the middle, in parts of the half width.
    fn excess(&self, coefficients: &[f64], bounds: &[[f64; 2]]) -> f64 {
        let parts = self.values.iter().zip(bounds);
        parts.map(|(sample, [middle, half])| (value(sample, coefficients) - middle).abs() / half).fold(0.0, f64::max)
    }

    /// The integral of the squared second derivative, up to a factor.
    fn roughness(&self, coefficients: &[f64]) -> f64 {
        let of_piece = |piece| {
            let [a, b] = self.basis.bends(piece, local(coefficients, piece));
            a * a + a * b + b * b
        };
        (0..self.basis.pieces).map(of_piece).sum()
    }
}

fn value((piece, values): &(usize, [f64; BASIS]), coefficients: &[f64]) -> f64 {
    values.iter().zip(&coefficients[*piece..]).map(|(value, coefficient)| value * coefficient).sum()
}

/// Sets the first and the last unknown to these values.
fn fix_ends(band: &mut Band, right: &mut [f64], ends: [f64; 2]) {
    let last = right.len() - 1;
    for below in 1..=banded::SIDE_DIAGONALS.min(last) {
        right[below] -= band[0][below] * ends[0];
        right[last - below] -= band[last - below][below] * ends[1];
        band[last - below][below] = 0.0;
    }
    (band[0], band[last]) = ([1.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]);
    (right[0], right[last]) = (ends[0], ends[1]);
}

/// The bending of splines as a quadratic form: on a piece the second derivative is linear, from a to b, and the integral of
/// its square is proportional to a^2 + a b + b^2.
fn bending(basis: CubicBasis) -> Band {
    let mut band = vec![[0.0; BASIS]; basis.coefficients()];
    for piece in 0..basis.pieces {
        let ends = [0, 1, 2, 3].map(|i| {
            let mut unit = [0.0; BASIS];
            unit[i] = 1.0;
            basis.bends(piece, unit)
        });
        for i in 0..BASIS {
            for j in i..BASIS {
                let ([a, b], [c, d]) = (ends[i], ends[j]);
                band[piece + i][j - i] += a * c + b * d + 0.5 * (a * d + b * c);
            }
        }
    }
    let mean = band.iter().map(|row| row[0]).sum::<f64>() / band.len() as f64;
    band.iter_mut().flatten().for_each(|entry| *entry /= mean);
    band
}
