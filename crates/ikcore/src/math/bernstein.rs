//! Bernstein coefficients: a polynomial on an interval lies between the smallest and the largest of them.

/// Factors from powers of x on \[-1, 1\] to Bernstein coefficients of degree N - 1.
struct Basis<const N: usize>;

impl<const N: usize> Basis<N> {
    /// By power, then by coefficient.
    const OF_POWERS: [[f64; N]; N] = {
        let mut factors = [[0.0; N]; N];
        let mut power = 0;
        while power < N {
            let mut i = 0;
            while i < N {
                factors[power][i] = blossom(power, i, N - 1 - i);
                i += 1;
            }
            power += 1;
        }
        factors
    };
}

/// The polar form of x^`power` at `ones` ones and `minus_ones` minus ones.
const fn blossom(power: usize, ones: usize, minus_ones: usize) -> f64 {
    let (mut sum, mut of_ones) = (0.0, 0);
    while of_ones <= power {
        let rest = power - of_ones;
        let sign = if rest.is_multiple_of(2) { 1.0 } else { -1.0 };
        sum += sign * (choose(ones, of_ones) * choose(minus_ones, rest)) as f64;
        of_ones += 1;
    }
    sum / choose(ones + minus_ones, power) as f64
}

/// Number of ways to choose `k` of `n`.
pub const fn choose(n: usize, k: usize) -> usize {
    if k > n {
        return 0;
    }
    let (mut ways, mut i) = (1, 0);
    while i < k {
        ways = ways * (n - i) / (i + 1);
        i += 1;
    }
    ways
}

/// The Bernstein coefficients on \[-1, 1\] of the polynomial with these coefficients of powers of x.
#[inline]
pub fn bernstein<const N: usize>(powers: &[f64; N]) -> [f64; N] {
    let mut coefficients = [0.0; N];
    for (power, factors) in powers.iter().zip(&Basis::<N>::OF_POWERS) {
        coefficients.iter_mut().zip(factors).for_each(|(coefficient, factor)| *coefficient += power * factor);
    }
    coefficients
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_give_back_the_polynomial() {
        let powers = [0.3, -1.0, 2.0, 0.5, -0.7];
        let coefficients = bernstein(&powers);
        for i in 0..=20 {
            let x = f64::from(i) / 10.0 - 1.0;
            let t = 0.5 * (x + 1.0);
            let term =
                |(k, c): (usize, &f64)| c * choose(4, k) as f64 * t.powi(k as i32) * (1.0 - t).powi(4 - k as i32);
            let value: f64 = coefficients.iter().enumerate().map(term).sum();
            let expected = powers.iter().rev().fold(0.0, |sum, c| sum * x + c);
            assert!((value - expected).abs() < 1e-14, "{value} {expected} at {x}");
        }
    }
}
