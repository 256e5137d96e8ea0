//! Shortest duration in which an extremal motion reaches a position.

use super::extremal::Extremal;
use super::phases::Durations;

/// Largest number of durations tried: those at which the profile changes its shape, then ever longer ones.
const TRIES: usize = 400;

/// Largest number of steps of the root search; bisection alone takes fewer.
const STEPS: usize = 200;

/// Returns the first duration between `start` and `end` in which the extremal motion reaches `goal`; `error` is the
/// displacement minus the goal at `start`.
pub(super) fn first_passing(extremal: &Extremal, goal: f64, [start, end]: [f64; 2], error: f64) -> Option<f64> {
    let beyond = |t: f64| extremal.displacement(t) - goal;
    let mut pauses = if extremal.rises_from(start) { Durations::new() } else { extremal.critical_durations() };
    pauses.push(extremal.full_speed_duration());
    pauses.sort_unstable_by(f64::total_cmp);
    let (mut last, mut before) = (start, error);
    let mut next = pauses.into_iter().filter(|t| start < *t && *t < end);
    let mut step: f64 = 1e-9;
    for _ in 0..TRIES {
        let (t, is_last) = match next.next() {
            Some(t) => (t, false),
            None if end.is_finite() => (end, true),
            None => (last + step.max(last), false),
        };
        step *= 2.0;
        let error = beyond(t);
        if error >= 0.0 {
            return Some(root(beyond, [last, t], [before, error]));
        }
        if is_last {
            return None;
        }
        (last, before) = (t, error);
    }
    None
}

/// Finds the point between `ends` at which `error` changes sign, or the nearest point after it; `values` are the errors at
/// the ends. Uses the Anderson-Björck method, and bisection where that is slow.
fn root(error: impl Fn(f64) -> f64, ends: [f64; 2], values: [f64; 2]) -> f64 {
    let ([mut lower, mut upper], [mut left, mut right]) = (ends, values);
    let (sign, mut last, mut width) = (left.signum(), 0.0, upper - lower);
    for step in 1..=STEPS {
        let secant = upper - right * (upper - lower) / (right - left);
        let slow = step % 3 == 0 && upper - lower > 0.5 * width;
        if step % 3 == 0 {
            width = upper - lower;
        }
        let t = if !slow && lower < secant && secant < upper { secant } else { 0.5 * (lower + upper) };
        if !(lower < t && t < upper) || upper - lower <= f64::EPSILON * upper {
            break;
        }
        let value = error(t);
        if value == 0.0 {
            return t;
        }
        let damped = |value: f64, before: f64| if value / before < 1.0 { 1.0 - value / before } else { 0.5 };
        if value.signum() == sign {
            right *= if last == sign { damped(value, left) } else { 1.0 };
            (lower, left) = (t, value);
        } else {
            left *= if last == -sign { damped(value, right) } else { 1.0 };
            (upper, right) = (t, value);
        }
        last = value.signum();
    }
    upper
}
