//! Polynomials: roots and extrema against dense sampling and against roots chosen beforehand.

use ikcore::math::polynomial::{derivative, evaluate, largest_magnitude, roots};
use proptest::prelude::*;

/// Coefficients of the product of (x - root).
fn with_roots(roots: &[f64]) -> Vec<f64> {
    let mut product = vec![1.0];
    for root in roots {
        let mut next = vec![0.0; product.len() + 1];
        for (power, c) in product.iter().enumerate() {
            next[power + 1] += c;
            next[power] -= root * c;
        }
        product = next;
    }
    product
}

#[test]
fn value_and_derivatives_by_hand() {
    // 1 - 2 x + 3 x^3 at x = 2.
    assert_eq!(evaluate(&[1.0, -2.0, 0.0, 3.0], 2.0), [21.0, 34.0, 36.0]);
    assert_eq!(evaluate(&[], 2.0), [0.0; 3]);
    assert_eq!(derivative(&[1.0, -2.0, 0.0, 3.0]).as_slice(), [-2.0, 0.0, 9.0]);
    assert!(derivative(&[5.0]).is_empty());
}

#[test]
fn special_cases_have_the_roots_they_should() {
    for (coefficients, expected) in [
        (vec![5.0], vec![]),
        (vec![-1.0, 2.0], vec![0.5]),
        (vec![-1.0, 2.0, 0.0, 0.0], vec![0.5]),
        // Two equal roots, three equal roots, no root, roots at both ends.
        (vec![0.25, -1.0, 1.0], vec![0.5]),
        (with_roots(&[0.5, 0.5, 0.5]), vec![0.5]),
        (vec![1.0, 0.0, 1.0], vec![]),
        (with_roots(&[0.0, 1.0]), vec![0.0, 1.0]),
        // Outside the interval.
        (with_roots(&[-0.5, 1.5]), vec![]),
        // The zero polynomial is told by its ends.
        (vec![0.0, 0.0], vec![0.0, 1.0]),
    ] {
        assert_eq!(roots(&coefficients, 0.0, 1.0).as_slice(), expected, "{coefficients:?}");
    }
}

#[test]
fn scales_far_apart_are_no_obstacle() {
    for scale in [1e-150, 1e150] {
        let cubic: Vec<f64> = with_roots(&[0.25, 0.5, 0.875]).iter().map(|c| c * scale).collect();
        assert_eq!(roots(&cubic, 0.0, 1.0).len(), 3);
    }
    assert_eq!(roots(&with_roots(&[1e-9, 0.5, 1e6]), 0.0, 1e7).len(), 3);
}

proptest! {
    #[test]
    fn chosen_roots_are_found(mut chosen in prop::collection::vec(-1.0..1.0_f64, 1..4), scale in 1e-3..1e3_f64) {
        chosen.sort_by(f64::total_cmp);
        prop_assume!(chosen.windows(2).all(|pair| pair[1] - pair[0] > 1e-3));
        let coefficients: Vec<f64> = with_roots(&chosen).iter().map(|c| c * scale).collect();
        let found = roots(&coefficients, -1.0, 1.0);
        prop_assert_eq!(found.len(), chosen.len());
        for (found, chosen) in found.iter().zip(&chosen) {
            prop_assert!((found - chosen).abs() < 1e-9, "{} instead of {}", found, chosen);
        }
    }

    #[test]
    fn no_sample_exceeds_the_largest_magnitude(
        coefficients in prop::collection::vec(-5.0..5.0_f64, 1..6), lower in -2.0..0.0_f64, span in 0.01..3.0_f64,
    ) {
        let largest = largest_magnitude(&coefficients, lower, lower + span);
        let samples = (0..=2000).map(|i| evaluate(&coefficients, lower + span * f64::from(i) / 2000.0)[0].abs());
        let sampled = samples.fold(0.0, f64::max);
        prop_assert!(sampled <= largest * (1.0 + 1e-14));
        // Halfway between samples a parabola rises over them by at most bend h^2 / 8.
        prop_assert!(largest - sampled < 1e-3 * (1.0 + largest));
    }
}
