//! Equation a cos q + b sin q = c: the intersection of a line with the unit circle. Subproblems 2, 3 and 4 reduce to it.

use super::{Angles, CLAMP, NEAR_MISS, NEARLY_DOUBLE, SMALL_LEVER};
use crate::closed_form::angle::Angle;
use crate::closed_form::branches::Doubt;

/// Solves a cos q + b sin q = c for the angle.
///
/// If a and b are both below `floor`, the angle is free if c is below it too, and there is no solution otherwise.
#[inline(always)]
pub fn line_on_circle(a: f64, b: f64, c: f64, floor: f64) -> Angles<2> {
    let square = a * a + b * b;
    if square <= floor * floor {
        return match c.abs() {
            c if c <= floor => Angles::FREE,
            c if c <= SMALL_LEVER * floor => Angles { doubt: Doubt::Anywhere, ..Angles::NONE },
            _ => Angles::NONE,
        };
    }
    // Factored form (r - c) (r + c), since r^2 - c^2 cancels where the line touches the circle.
    let radius = square.sqrt();
    let mut turns = with_radicand(a, b, c, (radius - c) * (radius + c));
    let small = SMALL_LEVER * floor;
    if radius <= small && c.abs() <= radius + small {
        turns.doubt = if turns.is_empty() { Doubt::Anywhere } else { Doubt::Nearby };
    }
    turns
}

/// Solves a cos q + b sin q = c, given a `radicand` r^2 - c^2 more accurate than the subtraction, with r^2 = a^2 + b^2.
#[inline(always)]
pub fn with_radicand(a: f64, b: f64, c: f64, radicand: f64) -> Angles<2> {
    let square = a * a + b * b;
    let mut turns = Angles::NONE;
    if radicand < -CLAMP * square {
        turns.near_miss = radicand > -NEAR_MISS * square;
        return turns;
    }
    if radicand < NEARLY_DOUBLE * square {
        turns.doubt = Doubt::Nearby;
    }
    // Division by the hypotenuse in `towards` puts a clamped root on the circle.
    if radicand <= 0.0 {
        turns.push(Angle::towards(a * c, b * c));
        return turns;
    }
    let (root, inverse) = (radicand.sqrt(), 1.0 / square);
    turns.push(Angle { cos: (a * c - b * root) * inverse, sin: (b * c + a * root) * inverse });
    turns.push(Angle { cos: (a * c + b * root) * inverse, sin: (b * c - a * root) * inverse });
    turns
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_angles_on_the_line() {
        for k in 0..98 {
            let angle = 0.0628 * f64::from(k) - 3.0;
            let (a, b) = (0.7, -1.9);
            let c = a * angle.cos() + b * angle.sin();
            let found = line_on_circle(a, b, c, 1e-12);
            assert_eq!(found.len(), 2);
            assert!(found.iter().all(|t| (a * t.cos + b * t.sin - c).abs() < 1e-15 * 10.0));
            assert!(found.iter().any(|t| (t.angle() - angle).abs() < 1e-7));
        }
    }

    #[test]
    fn a_line_just_outside_touches_once_and_one_far_outside_never() {
        assert_eq!(line_on_circle(1.0, 0.0, 1.0 + 1e-5, 1e-12).len(), 1);
        assert_eq!(line_on_circle(1.0, 0.0, 1.0 + 1e-3, 1e-12).len(), 0);
        assert!(line_on_circle(1e-14, 0.0, 1e-14, 1e-12).free);
        assert_eq!(line_on_circle(1e-14, 0.0, 1.0, 1e-12).len(), 0);
    }
}
