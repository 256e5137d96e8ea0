//! Zeros of increasing functions.

/// Number of iterations, enough to bisect down to rounding.
const ITERATIONS: usize = 60;

/// Iterations between bisections, so that the bracket shrinks for any function.
const BISECT_EVERY: usize = 4;

/// Number of iterations after which all bisect: the function jumps at its zero.
const SECANTS: usize = 16;

/// Final width of a bracket, as a fraction of its first width.
const NARROW: f64 = 1e-11;

/// Largest value that counts as zero, as a fraction of the values at the ends.
const ZERO: f64 = 1e-12;

/// The largest x from `least` on at which the increasing `function` is not positive, to rounding; `None` if it is positive
/// at `least`. At `most` it has the positive value `at_most`.
pub(super) fn largest_not_positive(
    least: f64,
    [most, at_most]: [f64; 2],
    function: impl Fn(f64) -> f64,
) -> Option<f64> {
    let mut at_high = at_most;
    let mut at_low = function(least);
    if !(at_low <= 0.0) {
        return None;
    }
    let (mut low, mut high) = (least, most);
    let (zero, narrow) = (-ZERO * at_high.max(-at_low), NARROW * (most - least));
    if at_low >= zero {
        return Some(low);
    }
    let mut lower_side = None;
    for i in 0..ITERATIONS {
        // From an end that is zero but for rounding, a secant would not move on: it then aims a little below.
        let aim = if at_high <= -zero { 0.5 * zero } else { 0.0 };
        let [above, below] = [at_high - aim, at_low - aim];
        let secant = (low * above - high * below) / (above - below);
        let bisect = i > SECANTS || i % BISECT_EVERY == BISECT_EVERY - 1 || !(low < secant && secant < high);
        let middle = if bisect { 0.5 * (low + high) } else { secant };
        if middle <= low || middle >= high || high - low <= narrow {
            break;
        }
        let there = function(middle);
        let is_below = there <= 0.0;
        // An end that stays twice counts half (Illinois).
        let again = lower_side == Some(is_below);
        if is_below {
            (low, at_low) = (middle, there);
            at_high *= if again { 0.5 } else { 1.0 };
            if there >= zero {
                break;
            }
        } else {
            (high, at_high) = (middle, there);
            at_low *= if again { 0.5 } else { 1.0 };
        }
        lower_side = Some(is_below);
    }
    Some(low)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_are_approached_from_below() {
        let largest = |function: fn(f64, f64) -> f64, zero: f64| {
            largest_not_positive(0.0, [1.0, function(1.0, zero)], |x| function(x, zero))
        };
        for zero in [0.1_f64, 0.5, 0.999] {
            let found = largest(|x, zero| x.powi(3) - zero.powi(3), zero).unwrap();
            assert!(found <= zero && zero - found < 1e-10, "{found} {zero}");
        }
        let jump = largest(|x, zero| if x < zero { -1.0 } else { 1e9 }, 0.25).unwrap();
        assert!(jump < 0.25 && jump > 0.25 - 1e-9, "{jump}");
        assert_eq!(largest(|x, zero| x - zero, -2.0), None);
    }
}
