//! New samples of a polynomial on an interval where it is small.

use super::basis::{DEGREE, chebyshev_in_bernstein};
use super::interval::{Interval, half_angle};
use crate::closed_form::angle::Angle;

/// Number of samples of an interval: three more than the degree needs.
const SAMPLES: usize = DEGREE + 4;
/// Largest number of resampled intervals.
pub(super) const MOST_SAMPLED: usize = 40;
/// Coefficients below this multiple of their noise are near it.
const NEAR_NOISE: f64 = 300.0;
/// Width (in x) below which an interval with sign changes holds a double zero.
const NARROW: f64 = 1e-6;

/// Resamples intervals where the polynomial is too small to locate its zeros.
pub(super) struct Sampler<'a> {
    pub value: &'a mut dyn FnMut(Angle) -> f64,
    pub left: usize,
}

impl Sampler<'_> {
    /// Resamples an interval if it is wide, all its coefficients are near their noise, and the new noise is smaller.
    ///
    /// Chebyshev interpolation with more samples than the degree needs: the coefficients beyond the degree estimate the
    /// noise.
    #[cold]
    pub fn sampled(&mut self, here: &Interval, middle: Angle) -> Option<Interval> {
        let largest = here.coefficients.iter().fold(0.0, |most: f64, b| most.max(b.abs()));
        if self.left == 0 || largest > NEAR_NOISE * here.noise || here.to - here.from < NARROW {
            return None;
        }
        self.left -= 1;
        let (centre, half) = (0.5 * (here.from + here.to), 0.5 * (here.to - here.from));
        let mut series = [0.0; SAMPLES];
        let mut size: f64 = 0.0;
        for j in 0..SAMPLES {
            let u = (std::f64::consts::PI * (j as f64 + 0.5) / SAMPLES as f64).cos();
            let x = centre + half * u;
            let value = (self.value)(middle.and(half_angle(x))) * (1.0 + x * x).powi(DEGREE as i32 / 2);
            size = size.max(value.abs());
            let (mut last, mut next) = (1.0, u);
            for term in &mut series {
                *term += 2.0 / SAMPLES as f64 * value * last;
                (last, next) = (next, 2.0 * u * next - last);
            }
        }
        series[0] *= 0.5;
        let beyond = series[DEGREE + 1..].iter().fold(0.0, |most: f64, a| most.max(a.abs()));
        let rounding = (8.0 * beyond).max(1e-15 * size);
        let table = const { chebyshev_in_bernstein() };
        let mut sampled = Interval { coefficients: [0.0; DEGREE + 1], noise: 4.0 * rounding, sampled: true, ..*here };
        for (a, row) in series.iter().zip(&table) {
            // Terms below the rounding error would add only noise.
            if a.abs() <= rounding {
                continue;
            }
            sampled.noise += rounding * row.iter().fold(0.0, |most: f64, b| most.max(b.abs()));
            (0..=DEGREE).for_each(|j| sampled.coefficients[j] += a * row[j]);
        }
        (sampled.noise < 0.1 * here.noise).then_some(sampled)
    }
}
