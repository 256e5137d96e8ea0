//! Quadratic equation in cosine and sine of one angle, to which subproblems 5 and 6 reduce.

use super::{Angles, NEARLY_DOUBLE};
use crate::closed_form::angle::Angle;
use crate::closed_form::branches::Doubt;
use crate::closed_form::trigonometric::Polynomial;

/// Rounding error of the coefficients, relative to the terms that they sum. Zeros that it can hide or merge are listed as
/// one.
const NOISE: f64 = 1e-13;

/// Quadratic form w' F w = 0 for w = (1, cos q, sin q): a conic that meets the unit circle in at most four points.
#[derive(Debug, Clone, Copy, Default)]
pub struct QuadraticForm {
    /// Upper triangle of F: entries 11, 1c, 1s, cc, cs, ss.
    entries: [f64; 6],
    /// Magnitude of the added terms, which sets the rounding error where they cancel.
    scale: f64,
}

/// Linear function constant + cos * cos q + sin * sin q.
pub type Linear = [f64; 3];

impl QuadraticForm {
    /// Adds factor * p * q.
    #[inline(always)]
    pub fn add_product(&mut self, factor: f64, p: &Linear, q: &Linear) {
        let e = &mut self.entries;
        e[0] += factor * (p[0] * q[0]);
        e[1] += factor * (p[0] * q[1] + p[1] * q[0]);
        e[2] += factor * (p[0] * q[2] + p[2] * q[0]);
        e[3] += factor * (p[1] * q[1]);
        e[4] += factor * (p[1] * q[2] + p[2] * q[1]);
        e[5] += factor * (p[2] * q[2]);
        self.scale += factor.abs() * size(p) * size(q);
    }

    /// Adds the linear function p.
    #[inline(always)]
    pub fn add_linear(&mut self, p: &Linear) {
        (0..3).for_each(|k| self.entries[k] += p[k]);
        self.scale += size(p);
    }

    /// Returns the angles of the zeros on the unit circle, double roots included.
    pub fn zeros(&self) -> Angles<4> {
        let [one, c, s, cc, cs, ss] = self.entries;
        // Double-angle formulas: cos^2 = (1 + cos 2q)/2, sin^2 = (1 - cos 2q)/2, cos sin = (sin 2q)/2.
        let cosines = [one + 0.5 * (cc + ss), c, 0.5 * (cc - ss)];
        let polynomial = Polynomial { cosines, sines: [0.0, s, 0.5 * cs] };
        let zeros = polynomial.zeros::<4>(NOISE * self.scale);
        let mut turns = Angles::NONE;
        zeros.iter().for_each(|root| turns.push(*root));
        // Second search with a larger noise: a pose within tolerances perturbs the coefficients by as much.
        let nearby = polynomial.zeros::<4>(NEARLY_DOUBLE * self.scale);
        turns.doubt = match zeros.settled && nearby.settled {
            true if nearby.possible == turns.len() => Doubt::None,
            true if nearby.possible <= turns.len() => Doubt::Nearby,
            // Polynomial that nearly vanishes everywhere, or to a high order, or has zeros nearby.
            _ => Doubt::Anywhere,
        };
        turns
    }
}

/// Bounds |p| up to a constant factor.
#[inline(always)]
fn size(p: &Linear) -> f64 {
    p[0].abs() + p[1].abs() + p[2].abs()
}

/// Solves m y = r for two unknowns that are linear in (1, cos q, sin q) like r; also returns the determinant of m.
#[inline(always)]
pub fn solved(m: &[[f64; 2]; 2], r: &[Linear; 2]) -> ([Linear; 2], f64) {
    let determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    let inverse = 1.0 / determinant;
    let first = std::array::from_fn(|k| inverse * (m[1][1] * r[0][k] - m[0][1] * r[1][k]));
    let second = std::array::from_fn(|k| inverse * (m[0][0] * r[1][k] - m[1][0] * r[0][k]));
    ([first, second], determinant)
}

/// Solves subproblem 6: (x, y) with m (cos y, sin y) = r(x), where both entries of r are linear in (1, cos x, sin x).
///
/// Returns the solutions x, and for each the direction y of m^-1 r(x); `None` if m is singular.
pub fn subproblem6(m: &[[f64; 2]; 2], r: &[Linear; 2]) -> Option<(Angles<4>, [Angle; 4])> {
    let ([cosine, sine], determinant) = solved(m, r);
    if determinant == 0.0 || !determinant.is_finite() {
        return None;
    }
    let mut form = QuadraticForm::default();
    form.add_product(1.0, &cosine, &cosine);
    form.add_product(1.0, &sine, &sine);
    form.add_linear(&[-1.0, 0.0, 0.0]);
    let x = form.zeros();
    let mut y = [Angle::NONE; 4];
    for (x, y) in x.iter().zip(&mut y) {
        let at = |p: &Linear| p[0] + p[1] * x.cos + p[2] * x.sin;
        *y = Angle::towards(at(&cosine), at(&sine));
    }
    Some((x, y))
}
