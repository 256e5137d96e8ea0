//! The motion of a given duration that takes a joint as far as possible in the positive direction, under a jerk limit.
//!
//! The acceleration rises to a peak, is held there if the peak is its limit, falls to a trough, is held there likewise,
//! and rises to its final value. If the velocity would exceed its limit between peak and trough, it cruises at the limit.
//!
//! With J the jerk, c = v - a^2 / (2 J) is constant while the acceleration rises. Let c1 be its value at the start and c3
//! at the end, K = J (c3 - c1), and S = (J T + a0 - a3) / 2 for the duration T. Without holds, the phases last T if
//! peak - trough = S, and change the velocity as required if peak^2 - trough^2 = K.

use std::cmp::Ordering;

use super::motion_state::{MotionState, Rates};
use super::phases::{Durations, Phase, Phases, Possible};

#[derive(Debug, Clone, Copy)]
pub(super) struct JerkLimited {
    from: MotionState,
    to: MotionState,
    rates: Rates,
    c1: f64,
    c3: f64,
    k: f64,
}

/// Peak and trough of the acceleration, how long they are held (s), and how long the velocity limit is kept between (s).
struct Shape {
    peak: f64,
    peak_hold: f64,
    cruise: f64,
    trough: f64,
    trough_hold: f64,
}

/// Differences of accelerations that count as rounding, relative to their size.
const ROUNDING: f64 = 1e-13;

impl JerkLimited {
    pub(super) fn new(from: MotionState, to: MotionState, rates: Rates) -> Self {
        let c = |state: &MotionState| state.v - 0.5 * state.a * state.a / rates.jerk;
        let (c1, c3) = (c(&from), c(&to));
        // J (c3 - c1), with fewer roundings.
        let k = rates.jerk * (to.v - from.v) + 0.5 * (from.a - to.a) * (from.a + to.a);
        Self { from, to, rates, c1, c3, k }
    }

    /// The shape for the duration `t` (s); `None` if no motion of that duration meets both velocities and accelerations.
    #[inline]
    fn shape(&self, t: f64) -> Option<Shape> {
        let shape = self.unlimited(0.5 * (self.rates.jerk * t + self.from.a - self.to.a))?;
        let rounding = ROUNDING * (shape.peak.abs() + shape.trough.abs() + self.from.a.abs() + self.to.a.abs());
        if shape.peak < self.from.a - rounding || shape.trough > self.to.a + rounding {
            return None;
        }
        if shape.peak > 0.0 && shape.trough < 0.0 && self.top_speed(&shape) > self.rates.velocity {
            return Some(self.cruising(t));
        }
        Some(shape)
    }

    /// The distance covered in the duration `t` (s).
    pub(super) fn displacement(&self, t: f64) -> Option<f64> {
        let Self { from, to, c1, c3, rates: Rates { velocity, jerk, .. }, .. } = *self;
        let Shape { peak, peak_hold, cruise, trough, trough_hold } = self.shape(t)?;
        // A ramp from x to y along which the velocity is c + a^2 / (2 J).
        let ramp = |c: f64, x: f64, y: f64| (y - x) * (c + (x * x + x * y + y * y) / (6.0 * jerk)) / jerk;
        let half = 0.5 / jerk;
        let [before_hold, after_hold] = [c1 + half * peak * peak, c3 + half * trough * trough];
        let top = before_hold + peak * peak_hold + half * peak * peak;
        let holds = peak_hold * (before_hold + 0.5 * peak * peak_hold)
            + trough_hold * (after_hold - 0.5 * trough * trough_hold);
        let fall = if cruise > 0.0 {
            cruise * velocity + ramp(-velocity, peak, 0.0) + ramp(-velocity, 0.0, trough)
        } else {
            ramp(-top, peak, trough)
        };
        Some(ramp(c1, from.a, peak) + holds + fall + ramp(c3, trough, to.a))
    }

    /// The phases for the duration `t` (s).
    pub(super) fn phases(&self, t: f64) -> Option<Phases> {
        let Shape { peak, peak_hold, cruise, trough, trough_hold } = self.shape(t)?;
        let j = self.rates.jerk;
        let ramp = |from: f64, to: f64| Phase {
            duration: ((to - from).abs() / j).max(0.0),
            acceleration: from,
            jerk: if to < from { -j } else { j },
        };
        let hold = |acceleration: f64, duration: f64| Phase { duration: duration.max(0.0), acceleration, jerk: 0.0 };
        let between = if cruise > 0.0 {
            [ramp(peak, 0.0), hold(0.0, cruise), ramp(0.0, trough)]
        } else {
            [ramp(peak, trough), Phase::default(), Phase::default()]
        };
        let [fall, still, fall_on] = between;
        let phases = [
            ramp(self.from.a, peak.max(self.from.a)),
            hold(peak, peak_hold),
            fall,
            still,
            fall_on,
            hold(trough, trough_hold),
            ramp(trough.min(self.to.a), self.to.a),
        ];
        Some(Phases { velocity: self.from.v, phases })
    }

    /// The shape without a velocity limit.
    fn unlimited(&self, s: f64) -> Option<Shape> {
        let Self { k, rates: Rates { acceleration: limit, jerk, .. }, .. } = *self;
        if !(s > 0.0) {
            return None;
        }
        let free =
            Shape { peak: 0.5 * (k / s + s), peak_hold: 0.0, cruise: 0.0, trough: 0.5 * (k / s - s), trough_hold: 0.0 };
        if free.peak <= limit && free.trough >= -limit {
            return Some(free);
        }
        if free.peak > limit {
            let fall = (2.0 * limit * s - k).max(0.0).sqrt();
            if fall <= 2.0 * limit {
                return Some(Shape { peak: limit, peak_hold: 2.0 * (s - fall) / jerk, trough: limit - fall, ..free });
            }
        }
        if free.trough < -limit {
            let fall = (2.0 * limit * s + k).max(0.0).sqrt();
            if fall <= 2.0 * limit {
                return Some(Shape {
                    peak: fall - limit,
                    trough: -limit,
                    trough_hold: 2.0 * (s - fall) / jerk,
                    ..free
                });
            }
        }
        let (sum, difference) = ((2.0 * s - 4.0 * limit) / jerk, k / (limit * jerk));
        (sum >= difference.abs()).then_some(Shape {
            peak: limit,
            peak_hold: 0.5 * (sum + difference),
            trough: -limit,
            trough_hold: 0.5 * (sum - difference),
            ..free
        })
    }

    /// The velocity between peak and trough where the acceleration is zero.
    fn top_speed(&self, shape: &Shape) -> f64 {
        self.c1 + shape.peak * (shape.peak / self.rates.jerk + shape.peak_hold)
    }

    /// The shape that reaches the velocity limit.
    fn cruising(&self, t: f64) -> Shape {
        let shape = self.at_top_speed();
        Shape { cruise: (t - self.duration(&shape)).max(0.0), ..shape }
    }

    /// The shape that just reaches the velocity limit.
    fn at_top_speed(&self) -> Shape {
        let Rates { velocity, acceleration: limit, jerk } = self.rates;
        let side = |c: f64| {
            let peak = (jerk * (velocity - c)).max(0.0).sqrt();
            if peak <= limit { (peak, 0.0) } else { (limit, (velocity - c) / limit - limit / jerk) }
        };
        let ((peak, peak_hold), (depth, trough_hold)) = (side(self.c1), side(self.c3));
        Shape { peak, peak_hold, cruise: 0.0, trough: -depth, trough_hold }
    }

    fn duration(&self, shape: &Shape) -> f64 {
        let ramps = (shape.peak - self.from.a) + (shape.peak - shape.trough) + (self.to.a - shape.trough);
        ramps / self.rates.jerk + shape.peak_hold + shape.trough_hold
    }

    /// Where motions of this duration begin to exist, or cease to (s): pairs, in order.
    pub(super) fn possible(&self, found: &mut Possible) {
        let Self { from, to, k, rates: Rates { acceleration: limit, .. }, .. } = *self;
        // The peak would be below the initial acceleration, or the trough above the final one.
        let excluded = |a: f64, k: f64| {
            let [shorter, longer] = both(a, -k)?;
            let longer = if longer - a > limit { 0.5 * ((limit + a) * (limit + a) - k) / limit } else { longer };
            (longer > 0.0).then_some([shorter.max(0.0), longer])
        };
        let mut start = 0.0;
        let mut excluded = [excluded(from.a, k), excluded(-to.a, -k)];
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

    /// The duration that belongs to S.
    fn duration_of(&self, s: f64) -> f64 {
        ((2.0 * s - self.from.a + self.to.a) / self.rates.jerk).max(0.0)
    }

    /// Durations (s) at which the phases change their kind, or the distance turns: it is monotone in between.
    pub(super) fn critical_durations(&self, found: &mut Durations) {
        let Self { c1, c3, k, rates: Rates { acceleration: limit, jerk, .. }, .. } = *self;
        let mut add = |s: f64| {
            if s > 0.0 {
                found.push(self.duration_of(s));
            }
        };
        // Without holds the distance is a multiple of S^3 / 4 + J (c1 + c3) S - K^2 / (4 S), up to a constant.
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
            // Both held: the distance turns where the velocity between them is -A^2 / J.
            let peak_hold = (-limit * limit / jerk - c1) / limit - 0.5 * limit / jerk;
            add(2.0 * limit + peak_hold * jerk - 0.5 * k / limit);
        }
    }

    /// The shortest duration (s) in which the motion reaches the velocity limit; infinite without one.
    pub(super) fn full_speed_duration(&self) -> f64 {
        if self.rates.velocity.is_finite() { self.duration(&self.at_top_speed()) } else { f64::INFINITY }
    }

    /// Whether all motions longer than `t` (s) get farther, since they can spend the rest of the time at a velocity that
    /// is not negative.
    pub(super) fn rises_from(&self, t: f64) -> bool {
        let passes_zero = |shape: &Shape| shape.peak > 0.0 && shape.trough < 0.0;
        self.shape(t).is_some_and(|shape| passes_zero(&shape) && self.top_speed(&shape) >= 0.0)
    }
}

/// The real solutions of x^2 - 2 half x = rest, the smaller first.
fn both(half: f64, rest: f64) -> Option<[f64; 2]> {
    let discriminant = half * half + rest;
    if !(discriminant >= 0.0) {
        return None;
    }
    // Without cancellation: the product of both is -rest.
    let outer = half + discriminant.sqrt().copysign(half);
    let inner = if outer == 0.0 { 0.0 } else { -rest / outer };
    Some([outer.min(inner), outer.max(inner)])
}
