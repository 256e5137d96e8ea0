//! Majorants: numbers that bound the Taylor coefficients of a function at every point of an interval. Those of sums, products and
//! solutions of linear equations follow from those of their parts.

/// Number of coefficients.
const ORDER: usize = 6;

/// Bounds of the sizes of the Taylor coefficients of a number or vector, from the value on. Each derivative and integral knows one coefficient
/// less or more; those above are zero and mean nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Majorant([f64; ORDER]);

impl Majorant {
    /// That of zero.
    pub const ZERO: Self = Self([0.0; ORDER]);

    /// A function whose first coefficients have these bounds, and whose others are zero.
    pub fn of<const N: usize>(bounds: [f64; N]) -> Self {
        let mut coefficients = [0.0; ORDER];
        coefficients[..N].copy_from_slice(&bounds);
        Self(coefficients)
    }

    /// A vector of this size that changes by y' = w y + `more`, with the majorant `w` of a rate.
    #[inline]
    pub fn carried(w: &Self, size: f64, more: &Self) -> Self {
        let mut y = [size, 0.0, 0.0, 0.0, 0.0, 0.0];
        for k in 0..ORDER - 1 {
            let product: f64 = (0..=k).map(|i| w.0[i] * y[k - i]).sum();
            y[k + 1] = (product + more.0[k]) / (k + 1) as f64;
        }
        Self(y)
    }

    /// The bound of coefficient `k`.
    #[inline]
    pub fn coefficient(&self, k: usize) -> f64 {
        self.0[k]
    }

    /// Of the sum.
    #[inline]
    pub fn plus(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }

    /// Of the product; of the cross product or dot product of vectors too.
    #[inline]
    pub fn times(&self, other: &Self) -> Self {
        let mut product = [0.0; ORDER];
        for (i, one) in self.0.iter().enumerate() {
            for (sum, other) in product[i..].iter_mut().zip(&other.0) {
                *sum += one * other;
            }
        }
        Self(product)
    }

    /// Of a multiple.
    #[inline]
    pub fn scaled(&self, factor: f64) -> Self {
        Self(self.0.map(|c| c * factor))
    }

    /// Of the derivative.
    #[inline]
    pub fn derivative(&self) -> Self {
        let mut coefficients = [0.0; ORDER];
        for k in 0..ORDER - 1 {
            coefficients[k] = (k + 1) as f64 * self.0[k + 1];
        }
        Self(coefficients)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_carried_vector_and_its_products_are_bounded() {
        // y = exp(2 x) with y' = 2 y; y^2 = exp(4 x), and the derivative of it 4 exp(4 x).
        let y = Majorant::carried(&Majorant::of([2.0]), 1.0, &Majorant::ZERO);
        let square = y.times(&y).derivative();
        let mut factorial = 1.0;
        for k in 0..ORDER {
            factorial *= k.max(1) as f64;
            assert!((y.coefficient(k) - 2.0_f64.powi(k as i32) / factorial).abs() < 1e-14);
            if k + 1 < ORDER {
                assert!((square.coefficient(k) - 4.0 * 4.0_f64.powi(k as i32) / factorial).abs() < 1e-12);
            }
        }
    }
}
