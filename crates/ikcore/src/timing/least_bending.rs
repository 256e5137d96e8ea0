//! Cubic splines of least bending that stay within bounds at samples.
//!
//! Weights of the samples grow where the spline is out of bounds and fall where it is inside: iteratively reweighted least
//! squares, after C. L. Lawson (1961).

use crate::math::banded::{self, Band};
use crate::math::cubic_bspline::{BASIS, CubicBasis};

/// Weight of a sample against bending at which a spline is almost a least-squares fit.
const LARGEST_WEIGHT: f64 = 1e10;
/// Smallest weight of a sample before reweighting.
const SMALLEST_WEIGHT: f64 = 1e-10;
/// Factor between the weights tried.
const WEIGHT_STEP: f64 = 10.0;
/// Largest part of the tolerance by which a least-squares fit may miss the tube for reweighting to bring it inside.
const HOPELESS: f64 = 4.0;
/// Number of times that the weights are adapted.
const REWEIGHTINGS: usize = 20;
/// Smallest factor on a weight in one adaptation.
const SMALLEST_CHANGE: f64 = 0.3;
/// Largest factor on a weight in one adaptation.
const LARGEST_CHANGE: f64 = 3.0;
/// Smallest weight, as a fraction of the largest.
const SMALLEST_PART: f64 = 1e-10;
/// Deviation aimed at, as a fraction of the tolerance: reweighting approaches its bound from outside.
pub(super) const AIM: f64 = 0.97;

/// The four coefficients of a piece.
pub(super) fn local(coefficients: &[f64], piece: usize) -> [f64; BASIS] {
    [0, 1, 2, 3].map(|i| coefficients[piece + i])
}

/// Weighted fits of splines to samples.
pub(super) struct Fit {
    pub basis: CubicBasis,
    /// Basis functions at each sample, and the piece that it is on.
    values: Vec<(usize, [f64; BASIS])>,
    /// The integral of the squared second derivative, as a quadratic form of the coefficients, with mean one on its diagonal.
    bending: Band,
}

impl Fit {
    pub(super) fn new(basis: CubicBasis, at: &[f64]) -> Self {
        let of_sample = |u: &f64| (basis.piece_of(*u), basis.values(basis.piece_of(*u), *u));
        Self { basis, values: at.iter().map(of_sample).collect(), bending: bending(basis) }
    }

    /// Returns the coefficients of least bending inside `bounds` (middle and half width at each sample), ends at the middle;
    /// `None` if there seem to be none.
    pub(super) fn least_bending(&self, bounds: &[[f64; 2]]) -> Option<Vec<f64>> {
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
        let least = SMALLEST_PART * weights.iter().copied().fold(0.0, f64::max);
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
