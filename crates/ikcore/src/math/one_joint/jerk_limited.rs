//! Extremal motion of one joint under a jerk limit: the largest displacement in a given duration.
//!
//! The acceleration rises to a peak, falls to a trough, and rises to its final value; peak and trough are held where they
//! equal the acceleration limit. If the velocity would exceed its limit between peak and trough, the motion cruises at the
//! limit.
//!
//! With J the jerk, c = v - a^2 / (2 J) is constant while the acceleration rises. Let c1 be its value at the start and c3 at
//! the end, K = J (c3 - c1), and S = (J T + a0 - a3) / 2 for the duration T. Without holds, the phases last T if peak -
//! trough = S, and change the velocity as required if peak^2 - trough^2 = K.
//!
//! Borderline motions are common: states at a limit, or a final state on the ramp through the initial state. Phases with
//! negative duration by rounding therefore get zero duration, and every possible duration has a shape.

use std::cmp::Ordering;

use super::motion_state::{MotionState, Rates};
use super::phases::{Durations, Phase, Phases, Possible, ROUNDING};
use crate::math::comparison::{larger, smaller};

#[derive(Debug, Clone, Copy)]
pub(super) struct JerkLimited {
    from: MotionState,
    to: MotionState,
    rates: Rates,
    c1: f64,
    c3: f64,
    k: f64,
    /// Value of K for the motion with the axis reversed, negated: zero if a falling ramp joins the states.
    fall: f64,
}

/// Shape of the profile: peak and trough of the acceleration, their hold times (s), and the cruise time at the velocity limit
/// (s).
struct Shape {
    peak: f64,
    peak_hold: f64,
    cruise: f64,
    trough: f64,
    trough_hold: f64,
}

impl JerkLimited {
    pub(super) fn new(from: MotionState, to: MotionState, rates: Rates) -> Self {
        let c = |state: &MotionState| state.v - 0.5 * state.a * state.a / rates.jerk;
        let (c1, c3) = (c(&from), c(&to));
        // Difference J (c3 - c1), with fewer roundings.
        let (change, ramp) = (rates.jerk * (to.v - from.v), 0.5 * (to.a - from.a) * (to.a + from.a));
        let size = rates.jerk * from.v.abs().max(to.v.abs()) + 0.5 * (from.a * from.a + to.a * to.a);
        let (k, fall) = match [change - ramp, change + ramp].map(|rest| rest.abs() <= ROUNDING * size) {
            [true, _] => (0.0, 2.0 * ramp),
            [_, true] => (-2.0 * ramp, 0.0),
            _ => (change - ramp, change + ramp),
        };
        Self { from, to, rates, c1, c3, k, fall }
    }

    /// Returns the shape for a possible duration `t` (s).
    #[inline]
    fn shape(&self, t: f64) -> Shape {
        let shape = self.unlimited(larger(0.5 * (self.rates.jerk * t + self.from.a - self.to.a), 0.0));
        if shape.peak > 0.0 && shape.trough < 0.0 && self.top_speed(&shape) > self.rates.velocity {
            return self.cruising(t);
        }
        shape
    }

    /// Returns the displacement in the duration `t` (s).
    pub(super) fn displacement(&self, t: f64) -> f64 {
        let Self { from, to, c1, c3, rates: Rates { velocity, jerk, .. }, .. } = *self;
        let Shape { peak, peak_hold, cruise, trough, trough_hold } = self.shape(t);
        // Displacement on a ramp from x to y with velocity c + a^2 / (2 J).
        let inverse = 1.0 / jerk;
        let [half, sixth] = [0.5 * inverse, inverse / 6.0];
        let ramp = |c: f64, x: f64, y: f64| (y - x) * inverse * (c + (x * x + x * y + y * y) * sixth);
        let [before_hold, after_hold] = [c1 + half * peak * peak, c3 + half * trough * trough];
        let top = before_hold + peak * peak_hold + half * peak * peak;
        let holds = peak_hold * (before_hold + 0.5 * peak * peak_hold)
            + trough_hold * (after_hold - 0.5 * trough * trough_hold);
        let fall = if cruise > 0.0 {
            cruise * velocity + ramp(-velocity, peak, 0.0) + ramp(-velocity, 0.0, trough)
        } else {
            ramp(-top, peak, trough)
        };
        ramp(c1, from.a, peak) + holds + fall + ramp(c3, trough, to.a)
    }

    /// Returns the phases for the duration `t` (s).
    pub(super) fn phases(&self, t: f64) -> Phases {
        let Shape { peak, peak_hold, cruise, trough, trough_hold } = self.shape(t);
        let j = self.rates.jerk;
        let ramp = |from: f64, to: f64| Phase {
            duration: (to - from).abs() / j,
            acceleration: from,
            jerk: if to < from { -j } else { j },
        };
        let hold = |acceleration: f64, duration: f64| Phase { duration, acceleration, jerk: 0.0 };
        let [fall, still, fall_on] = if cruise > 0.0 {
            [ramp(peak, 0.0), hold(0.0, cruise), ramp(0.0, trough)]
        } else {
            [ramp(peak, trough), Phase::default(), Phase::default()]
        };
        let phases = [
            ramp(self.from.a, peak),
            hold(peak, peak_hold),
            fall,
            still,
            fall_on,
            hold(trough, trough_hold),
            ramp(trough, self.to.a),
        ];
        Phases { velocity: self.from.v, phases }
    }

    /// Returns the shape without a velocity limit. Despite rounding, its phases last the duration given by `s`.
    fn unlimited(&self, s: f64) -> Shape {
        let Self { from, to, k, rates: Rates { acceleration: limit, jerk, .. }, .. } = *self;
        let between = |x: f64, least: f64, most: f64| larger(smaller(x, most), least);
        // A ramp that rises throughout (s = 0 and k = 0) has its peak and trough at every point.
        let ratio = if k == 0.0 { 0.0 } else { k / s };
        let peak = between(0.5 * (ratio + s), from.a, to.a + s);
        let free = Shape { peak, peak_hold: 0.0, cruise: 0.0, trough: peak - s, trough_hold: 0.0 };
        if free.peak <= limit && free.trough >= -limit {
            return free;
        }
        if free.peak > limit {
            let fall = between((2.0 * limit * s - k).max(0.0).sqrt(), limit - to.a, s);
            if fall <= 2.0 * limit {
                return Shape { peak: limit, peak_hold: 2.0 * (s - fall) / jerk, trough: limit - fall, ..free };
            }
        }
        if free.trough < -limit {
            let fall = between((2.0 * limit * s + k).max(0.0).sqrt(), limit + from.a, s);
            if fall <= 2.0 * limit {
                return Shape { peak: fall - limit, trough: -limit, trough_hold: 2.0 * (s - fall) / jerk, ..free };
            }
        }
        let sum = ((2.0 * s - 4.0 * limit) / jerk).max(0.0);
        let difference = between(k / (limit * jerk), -sum, sum);
        Shape {
            peak: limit,
            peak_hold: 0.5 * (sum + difference),
            trough: -limit,
            trough_hold: 0.5 * (sum - difference),
            ..free
        }
    }

    /// Returns the velocity between peak and trough at which the acceleration is zero.
    fn top_speed(&self, shape: &Shape) -> f64 {
        self.c1 + shape.peak * (shape.peak / self.rates.jerk + shape.peak_hold)
    }

    /// Returns the shape that cruises at the velocity limit.
    fn cruising(&self, t: f64) -> Shape {
        let shape = self.at_top_speed();
        Shape { cruise: (t - self.duration(&shape)).max(0.0), ..shape }
    }

    /// Returns the shape that just reaches the velocity limit.
    fn at_top_speed(&self) -> Shape {
        let Rates { velocity, acceleration: limit, jerk } = self.rates;
        let side = |c: f64, least: f64| {
            let peak = larger(larger(jerk * (velocity - c), 0.0).sqrt(), least);
            if peak <= limit { (peak, 0.0) } else { (limit, larger((velocity - c) / limit - limit / jerk, 0.0)) }
        };
        let ((peak, peak_hold), (depth, trough_hold)) = (side(self.c1, self.from.a), side(self.c3, -self.to.a));
        Shape { peak, peak_hold, cruise: 0.0, trough: -depth, trough_hold }
    }

    fn duration(&self, shape: &Shape) -> f64 {
        let ramps = (shape.peak - self.from.a) + (shape.peak - shape.trough) + (self.to.a - shape.trough);
        ramps / self.rates.jerk + shape.peak_hold + shape.trough_hold
    }

    /// Lists intervals of possible durations (s), in order.
    pub(super) fn possible(&self, found: &mut Possible) {
        let Self { from, to, k, fall, rates: Rates { acceleration: limit, .. }, .. } = *self;
        let [a0, a1] = [from.a, to.a];
        // Discriminants, which vanish for states on one ramp: formed from the smaller terms to limit rounding.
        let [before, after] =
            if k.abs() < fall.abs() { [a0 * a0 - k, a1 * a1 + k] } else { [a1 * a1 - fall, a0 * a0 + fall] };
        // Excluded interval: the peak would be below the initial acceleration, or the trough above the final one.
        let excluded = |a: f64, k: f64, discriminant: f64| {
            let [shorter, longer] = sum_and_product(a, k, discriminant)?;
            let longer = if longer - a > limit { 0.5 * ((limit + a) * (limit + a) - k) / limit } else { longer };
            Some([shorter, longer])
        };
        let mut start = (a0 - a1).max(0.0);
        if a0 < a1 && k == 0.0 || a0 > a1 && fall == 0.0 {
            // Single ramp: slightly longer motions may not exist.
            found.push([self.duration_of(start); 2]);
        }
        let mut excluded = [excluded(a0, k, before), excluded(-a1, -k, after)];
        excluded
            .sort_unstable_by(|one, two| one.map(|e| e[0]).partial_cmp(&two.map(|e| e[0])).unwrap_or(Ordering::Equal));
        for [from, to] in excluded.into_iter().flatten() {
            if from > start {
                found.push([self.duration_of(start), self.duration_of(from)]);
            }
            start = to.max(start);
        }
        found.push([self.duration_of(start), f64::INFINITY]);
    }

    /// Returns the duration for a value of S.
    fn duration_of(&self, s: f64) -> f64 {
        ((2.0 * s - self.from.a + self.to.a) / self.rates.jerk).max(0.0)
    }

    /// Lists durations (s) at which the profile changes its shape or the displacement has an extremum; the displacement is
    /// monotone in between.
    pub(super) fn critical_durations(&self, found: &mut Durations) {
        let Self { c1, c3, k, rates: Rates { acceleration: limit, jerk, .. }, .. } = *self;
        let mut add = |s: f64| {
            if s > 0.0 {
                found.push(self.duration_of(s));
            }
        };
        // Displacement without holds: a multiple of S^3 / 4 + J (c1 + c3) S - K^2 / (4 S), up to a constant.
        let half = -2.0 / 3.0 * jerk * (c1 + c3);
        both(half, -k * k / 3.0).into_iter().flatten().map(f64::sqrt).for_each(&mut add);
        if limit.is_finite() {
            both(limit, -k).into_iter().chain(both(limit, k)).flatten().for_each(&mut add);
            add(2.0 * limit + 0.5 * k / limit);
            add(2.0 * limit - 0.5 * k / limit);
            let peak_held = |trough: f64| 0.5 * ((limit - trough) * (limit - trough) + k) / limit;
            let trough_held = |peak: f64| 0.5 * ((limit + peak) * (limit + peak) - k) / limit;
            both(0.25 * limit, -jerk * c3).into_iter().flatten().map(peak_held).for_each(&mut add);
            both(-0.25 * limit, -jerk * c1).into_iter().flatten().map(trough_held).for_each(&mut add);
            // Both accelerations held: the displacement has an extremum where the velocity in between is -A^2 / J.
            let peak_hold = (-limit * limit / jerk - c1) / limit - 0.5 * limit / jerk;
            add(2.0 * limit + peak_hold * jerk - 0.5 * k / limit);
        }
    }

    /// Returns the shortest duration (s) in which the motion reaches the velocity limit; infinite without a limit.
    pub(super) fn full_speed_duration(&self) -> f64 {
        if self.rates.velocity.is_finite() { self.duration(&self.at_top_speed()) } else { f64::INFINITY }
    }

    /// Whether every motion longer than `t` (s) goes farther: it can spend the additional time at a nonnegative velocity.
    pub(super) fn rises_from(&self, t: f64) -> bool {
        let passes_zero = |shape: &Shape| shape.peak >= 0.0 && shape.trough <= 0.0;
        let shape = self.shape(t);
        passes_zero(&shape) && self.top_speed(&shape) >= 0.0
    }
}

/// Returns the real solutions of x^2 - 2 half x = rest, the smaller first.
fn both(half: f64, rest: f64) -> Option<[f64; 2]> {
    sum_and_product(half, -rest, half * half + rest)
}

/// Returns two real numbers with this half-sum and product, the smaller first; `discriminant` is half^2 - product.
fn sum_and_product(half: f64, product: f64, discriminant: f64) -> Option<[f64; 2]> {
    if !(discriminant >= 0.0) {
        return None;
    }
    // Form without cancellation.
    let outer = half + discriminant.sqrt().copysign(half);
    let inner = if outer == 0.0 { 0.0 } else { product / outer };
    Some([outer.min(inner), outer.max(inner)])
}
