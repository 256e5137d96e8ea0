//! Conversion tables to the Bernstein basis, computed at compile time.

/// Largest degree of the ordinary polynomial.
pub(super) const DEGREE: usize = 16;
/// Half-angle tangent at the ends of a quarter circle: tan(pi/8).
pub(super) const QUARTER: f64 = 0.414_213_562_373_095_03;

/// Bernstein coefficients of (1 + x^2)^n cos k q and (1 + x^2)^n sin k q on the quarter circle round zero.
pub(super) struct Basis<const TERMS: usize> {
    pub cosines: [[f64; DEGREE + 1]; TERMS],
    pub sines: [[f64; DEGREE + 1]; TERMS],
}

impl<const TERMS: usize> Basis<TERMS> {
    pub const VALUES: Self = Self::new();

    /// Computes the table: exp(i k q) (1 + x^2)^n is the product of n + k factors 1 + ix and n - k factors 1 - ix, and
    /// multiplying polynomials convolves their Bernstein coefficients times binomials.
    const fn new() -> Self {
        let mut basis = Self { cosines: [[0.0; DEGREE + 1]; TERMS], sines: [[0.0; DEGREE + 1]; TERMS] };
        let mut k = 0;
        while k < TERMS {
            let (mut real, mut imaginary) = ([0.0; DEGREE + 1], [0.0; DEGREE + 1]);
            real[0] = 1.0;
            let mut factor = 0;
            while factor < 2 * (TERMS - 1) {
                // Factor 1 + ix runs from 1 - it to 1 + it; its conjugate runs the other way.
                let end = if factor < TERMS - 1 + k { QUARTER } else { -QUARTER };
                let mut j = factor + 1;
                loop {
                    let (re, im) = (real[j], imaginary[j]);
                    let (mut new_re, mut new_im) = (re + end * im, im - end * re);
                    if j > 0 {
                        let (re, im) = (real[j - 1], imaginary[j - 1]);
                        new_re += re - end * im;
                        new_im += im + end * re;
                    }
                    (real[j], imaginary[j]) = (new_re, new_im);
                    if j == 0 {
                        break;
                    }
                    j -= 1;
                }
                factor += 1;
            }
            let (mut j, mut binomial) = (0, 1.0);
            while j <= 2 * (TERMS - 1) {
                basis.cosines[k][j] = real[j] / binomial;
                basis.sines[k][j] = imaginary[j] / binomial;
                binomial = binomial * (2 * (TERMS - 1) - j) as f64 / (j + 1) as f64;
                j += 1;
            }
            k += 1;
        }
        basis
    }
}

/// Computes the Bernstein coefficients of degree [`DEGREE`] of Chebyshev's polynomials: (-1)^(k-i) binomial(2k,
/// 2i)/binomial(k, i), then degree elevation.
pub(super) const fn chebyshev_in_bernstein() -> [[f64; DEGREE + 1]; DEGREE + 1] {
    let mut table = [[0.0; DEGREE + 1]; DEGREE + 1];
    let mut k = 0;
    while k <= DEGREE {
        let row = &mut table[k];
        let (mut i, mut ratio) = (0, 1.0);
        while i <= k {
            row[i] = if (k - i) % 2 == 0 { ratio } else { -ratio };
            // Ratio of consecutive coefficients: binomial(2k, 2i + 2)/binomial(2k, 2i) over binomial(k, i + 1)/binomial(k,
            // i).
            let (j, m) = (i as f64, k as f64);
            ratio *= (2.0 * m - 2.0 * j) * (2.0 * m - 2.0 * j - 1.0) / ((2.0 * j + 1.0) * (2.0 * j + 2.0));
            ratio *= (j + 1.0) / if i < k { m - j } else { 1.0 };
            i += 1;
        }
        let mut degree = k;
        while degree < DEGREE {
            let mut i = degree + 1;
            while i > 0 {
                let fraction = i as f64 / (degree + 1) as f64;
                let own = if i <= degree { row[i] } else { 0.0 };
                row[i] = fraction * row[i - 1] + (1.0 - fraction) * own;
                i -= 1;
            }
            degree += 1;
        }
        k += 1;
    }
    table
}
