//! Real zeros of a trigonometric polynomial of low degree, and whether the list is provably complete.
//!
//! With the tangent x of half the angle from the middle of a quarter circle, a trigonometric polynomial of degree n becomes
//! an ordinary polynomial of degree 2n over (1 + x^2)^n. By Descartes' rule its Bernstein coefficients on an interval change
//! sign at least as often as it vanishes there: no change means no zero, one change exactly one zero. Intervals with more
//! changes are halved (de Casteljau).

mod basis;
mod interval;
mod sampler;

use crate::closed_form::angle::Angle;
use basis::{Basis, DEGREE, QUARTER};
use interval::{Interval, bracketed_by_coefficients, half_angle, halves, variations};
use sampler::{MOST_SAMPLED, Sampler};

/// Largest number of halvings of an initial interval.
const HALVINGS: u32 = 26;
/// Largest number of intervals examined.
const MOST_INTERVALS: usize = 600;
/// Width (rad) over which rounding may spread a double zero.
const SPREAD: f64 = 1e-5;

/// Zeros of a trigonometric polynomial.
#[derive(Debug, Clone, Copy)]
pub struct Zeros<const M: usize> {
    turns: [Angle; M],
    count: usize,
    /// Last double zero.
    double: Option<Angle>,
    /// Largest number of zeros that the listed angles can represent; a double zero counts twice.
    pub possible: usize,
    /// True if there are provably no other zeros.
    pub settled: bool,
}

impl<const M: usize> Zeros<M> {
    /// Iterates over the angles.
    pub fn iter(&self) -> std::slice::Iter<'_, Angle> {
        self.turns[..self.count].iter()
    }

    /// Adds a double zero unless it equals the last one: a double zero may spread over neighbouring intervals.
    fn push_double(&mut self, turn: Angle) {
        let apart = |last: Angle| (last.cos - turn.cos).abs() + (last.sin - turn.sin).abs();
        if self.double.is_some_and(|last| apart(last) < SPREAD) {
            self.double = Some(turn);
            return;
        }
        self.double = Some(turn);
        self.push(turn, 2);
    }

    fn push(&mut self, turn: Angle, multiplicity: usize) {
        self.possible += multiplicity;
        if self.count < M {
            self.turns[self.count] = turn;
            self.count += 1;
        } else {
            self.settled = false;
        }
    }
}

/// Trigonometric polynomial: sum over k of cosines\[k\] cos k q + sines\[k\] sin k q, with at most M = 2 (TERMS - 1) zeros.
#[derive(Debug, Clone, Copy)]
pub struct Polynomial<const TERMS: usize> {
    /// Cosine coefficients, from k = 0.
    pub cosines: [f64; TERMS],
    /// Sine coefficients; the first is unused.
    pub sines: [f64; TERMS],
}

impl<const TERMS: usize> Polynomial<TERMS> {
    /// Returns the sum of the absolute coefficients, an upper bound on the polynomial.
    pub fn size(&self) -> f64 {
        (1..TERMS).fold(self.cosines[0].abs(), |sum, k| sum + self.cosines[k].abs() + self.sines[k].abs())
    }

    /// Finds the zeros of a polynomial whose values are uncertain by `noise`; lists at most `M` angles.
    pub fn zeros<const M: usize>(&self, noise: f64) -> Zeros<M> {
        self.all_zeros(noise, None)
    }

    /// Finds the zeros of a polynomial of degree eight, and samples the function it represents anew where it is small.
    pub fn zeros_by_samples<const M: usize>(&self, noise: f64, value: &mut dyn FnMut(Angle) -> f64) -> Zeros<M> {
        self.all_zeros(noise, Some(Sampler { value, left: MOST_SAMPLED }))
    }

    fn all_zeros<const M: usize>(&self, noise: f64, mut sampler: Option<Sampler>) -> Zeros<M> {
        let mut found = Zeros { turns: [Angle::NONE; M], count: 0, double: None, possible: 0, settled: true };
        if !(self.size() > noise) || !self.size().is_finite() {
            found.settled = false;
            return found;
        }
        let mut budget = MOST_INTERVALS;
        let mut quarter = self.seen_from(START);
        for middle in QUARTERS {
            let coefficients = quarter.bernstein();
            let first = Interval { coefficients, from: -QUARTER, to: QUARTER, depth: 0, noise, sampled: false };
            quarter.search(first, START.and(middle), &mut sampler, &mut budget, &mut found);
            quarter = quarter.advanced();
        }
        found
    }

    /// Shifts the origin of the angle to `start`.
    fn seen_from(&self, start: Angle) -> Self {
        let mut seen = *self;
        let mut multiple = Angle::NONE;
        for k in 1..TERMS {
            multiple = multiple.and(start);
            seen.cosines[k] = self.cosines[k] * multiple.cos + self.sines[k] * multiple.sin;
            seen.sines[k] = self.sines[k] * multiple.cos - self.cosines[k] * multiple.sin;
        }
        seen
    }

    /// Shifts the origin of the angle by a quarter turn.
    fn advanced(&self) -> Self {
        let mut advanced = *self;
        for k in 1..TERMS {
            let (a, b) = (self.cosines[k], self.sines[k]);
            (advanced.cosines[k], advanced.sines[k]) = [(a, b), (b, -a), (-a, -b), (-b, a)][k % 4];
        }
        advanced
    }

    #[inline(always)]
    fn bernstein(&self) -> [f64; DEGREE + 1] {
        let basis = const { Basis::<TERMS>::VALUES };
        let mut sum = [0.0; DEGREE + 1];
        for k in 0..TERMS {
            for j in 0..=2 * (TERMS - 1) {
                sum[j] += self.cosines[k] * basis.cosines[k][j] + self.sines[k] * basis.sines[k][j];
            }
        }
        sum
    }

    /// Lists the zeros on a quarter circle centred at the origin of the angle.
    fn search<const M: usize>(
        &self,
        first: Interval,
        middle: Angle,
        sampler: &mut Option<Sampler>,
        budget: &mut usize,
        found: &mut Zeros<M>,
    ) {
        let degree = 2 * (TERMS - 1);
        let mut waiting = [first; HALVINGS as usize + 2];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let here = waiting[count];
            let at = |x: f64| middle.and(half_angle(x));
            let (variations, flat) = variations(&here.coefficients[..=degree], here.noise);
            if variations > 0
                && degree == DEGREE
                && let Some(sampler) = sampler
                && let Some(sampled) = sampler.sampled(&here, middle)
            {
                waiting[count] = sampled;
                count += 1;
                continue;
            }
            if *budget == 0 || flat || here.depth == HALVINGS {
                // Zero to within the noise: a double zero, or worse if the interval is still wide.
                found.settled &= *budget > 0 && here.depth > 10;
                found.push_double(at(0.5 * (here.from + here.to)));
                continue;
            }
            *budget -= 1;
            match variations {
                0 => {}
                1 if here.sampled => found.push(at(bracketed_by_coefficients(&here)), 1),
                1 => found.push(at(self.bracketed(&here)), 1),
                _ => {
                    let (low, high) = halves(&here, degree);
                    (waiting[count], waiting[count + 1]) = (high, low);
                    count += 2;
                }
            }
        }
    }

    /// Finds the zero between two ends of different sign: Newton's method, with halving where a step leaves the interval.
    fn bracketed(&self, interval: &Interval) -> f64 {
        let degree = 2 * (TERMS - 1);
        let (mut from, mut to) = (interval.from, interval.to);
        let (first, last) = (interval.coefficients[0], interval.coefficients[degree]);
        let rising = first < last;
        let mut x = from + (to - from) * (first / (first - last)).clamp(0.1, 0.9);
        for _ in 0..60 {
            let (value, slope) = self.value(half_angle(x));
            if (value < 0.0) == rising {
                from = x;
            } else {
                to = x;
            }
            // Chain rule: dq = 2 dx/(1 + x^2).
            let step = -0.5 * value / slope * (1.0 + x * x);
            if step.abs() <= 1e-16 {
                return x + step;
            }
            let next = x + step;
            x = if from < next && next < to { next } else { 0.5 * (from + to) };
            if to - from <= 1e-16 {
                break;
            }
        }
        x
    }

    /// Returns value and slope.
    #[inline(always)]
    fn value(&self, turn: Angle) -> (f64, f64) {
        let (mut value, mut slope) = (self.cosines[0], 0.0);
        let mut multiple = Angle::NONE;
        for k in 1..TERMS {
            multiple = multiple.and(turn);
            value += self.cosines[k] * multiple.cos + self.sines[k] * multiple.sin;
            slope += k as f64 * (self.sines[k] * multiple.cos - self.cosines[k] * multiple.sin);
        }
        (value, slope)
    }
}

/// Middle of the first quarter circle, chosen so that no interval ends at the round angles at which zeros of robots often
/// lie.
const START: Angle = Angle { cos: 0.9518135943318746, sin: 0.30667716192282335 };

/// Middles of the quarter circles.
const QUARTERS: [Angle; 4] = [
    Angle { cos: 1.0, sin: 0.0 },
    Angle { cos: 0.0, sin: 1.0 },
    Angle { cos: -1.0, sin: 0.0 },
    Angle { cos: 0.0, sin: -1.0 },
];

#[cfg(test)]
mod tests {
    use super::basis::chebyshev_in_bernstein;
    use super::*;

    /// Samples the product of sin((q - angle)/2) over an even number of `angles`.
    fn with_zeros<const TERMS: usize>(angles: &[f64]) -> Polynomial<TERMS> {
        let value = |q: f64| angles.iter().map(|a| (0.5 * (q - a)).sin()).product::<f64>();
        let mut polynomial = Polynomial { cosines: [0.0; TERMS], sines: [0.0; TERMS] };
        for j in 0..32 {
            let q = std::f64::consts::TAU * f64::from(j) / 32.0;
            for k in 0..TERMS {
                let weight = if k == 0 { 1.0 } else { 2.0 } / 32.0;
                polynomial.cosines[k] += weight * value(q) * (k as f64 * q).cos();
                polynomial.sines[k] += weight * value(q) * (k as f64 * q).sin();
            }
        }
        polynomial
    }

    #[test]
    fn bernstein_ends_are_values() {
        let polynomial = Polynomial { cosines: [0.3, -1.0, 0.7], sines: [0.0, 0.2, 0.9] };
        let coefficients = polynomial.bernstein();
        let scale = (1.0 + QUARTER * QUARTER).powi(2);
        for (end, sign) in [(0, -1.0), (4, 1.0)] {
            let (value, _) = polynomial.value(Angle::by(sign * std::f64::consts::FRAC_PI_4));
            assert!((coefficients[end] - scale * value).abs() < 1e-15);
        }
    }

    #[test]
    fn finds_the_zeros_it_was_made_of() {
        let angles = [-3.0, -1.1, 0.3, 0.5, 1.9, 2.4, 2.8, 3.1];
        let found = with_zeros::<5>(&angles).zeros::<8>(1e-15);
        assert!(found.settled && found.possible == 8);
        for angle in angles {
            assert!(found.iter().any(|t| (t.angle() - angle).abs() < 1e-10), "{angle}");
        }
    }

    #[test]
    fn near_pairs() {
        let near = [0.7, 0.7 + 1e-5, -2.0, 1.0];
        let found = with_zeros::<3>(&near).zeros::<4>(1e-16);
        assert_eq!(found.possible, 4);
        for angle in near {
            assert!(found.iter().any(|t| (t.angle() - angle).abs() < 1e-7), "{angle}");
        }
    }

    #[test]
    fn zeros_at_the_ends_of_quarters_are_not_lost() {
        let ends = [std::f64::consts::FRAC_PI_4, 3.0 * std::f64::consts::FRAC_PI_4, 0.0, 2.0];
        let found = with_zeros::<3>(&ends).zeros::<8>(1e-15);
        for angle in ends {
            assert!(found.iter().any(|t| (t.angle() - angle).abs() < 1e-7), "{angle}");
        }
    }

    #[test]
    fn a_double_zero_counts_twice() {
        let found = with_zeros::<3>(&[0.7, 0.7, -2.0, 1.0]).zeros::<4>(1e-14);
        assert_eq!((found.iter().count(), found.possible, found.settled), (3, 4, true));
        assert!(found.iter().any(|t| (t.angle() - 0.7).abs() < 1e-6));
    }

    #[test]
    fn chebyshev_polynomials_at_the_ends_and_between() {
        for (k, row) in chebyshev_in_bernstein().iter().enumerate() {
            let mut interval =
                Interval { coefficients: *row, from: -1.0, to: 1.0, depth: 0, noise: 0.0, sampled: false };
            for (part, u) in [(0, -0.5), (1, -0.75)] {
                let (low, _) = halves(&interval, DEGREE);
                interval = low;
                let middle = halves(&interval, DEGREE).1.coefficients[0];
                assert!((middle - (k as f64 * f64::acos(u)).cos()).abs() < 1e-11, "{k} {part}");
            }
        }
    }

    #[test]
    fn zeros_where_the_polynomial_is_tiny() {
        // Ten zeros within a tenth of a radian: the polynomial is 1e-17 of its size there.
        let angles: [f64; 16] =
            std::array::from_fn(|k| if k < 10 { 1.0 + 0.01 * k as f64 } else { -2.0 + 0.1 * k as f64 });
        let exact = |turn: Angle| angles.iter().map(|a| (0.5 * (turn.angle() - a)).sin()).product::<f64>();
        let polynomial = with_zeros::<9>(&angles);
        let blind = polynomial.zeros::<16>(1e-15 * polynomial.size());
        assert!(!blind.settled || blind.possible > 16);
        let found = polynomial.zeros_by_samples::<16>(1e-15 * polynomial.size(), &mut |turn| exact(turn));
        assert_eq!((found.possible, found.settled), (16, true));
        for angle in angles {
            assert!(found.iter().any(|t| (t.angle() - angle).abs() < 1e-7), "{angle}");
        }
    }

    #[test]
    fn none_where_the_polynomial_never_vanishes() {
        let never = Polynomial { cosines: [2.0, 0.5, 0.5], sines: [0.0, 0.3, 0.1] };
        assert!(never.zeros::<4>(1e-12).iter().count() == 0 && never.zeros::<4>(1e-12).settled);
        assert!(!Polynomial { cosines: [0.0; 3], sines: [0.0; 3] }.zeros::<4>(1e-12).settled);
    }
}
