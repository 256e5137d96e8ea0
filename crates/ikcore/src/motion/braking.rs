//! Braking of a joint in discrete time, and its fastest stop in closed form.
//!
//! The fastest stop is greedy: in every tick the joint brakes as hard as its limits allow, but never so hard that it would
//! reverse before the braking itself has faded out. It has three phases: the braking builds up by `jerk` per tick, stays
//! at `acceleration`, and fades out by `jerk` per tick. The rest of a greedy stop is the greedy stop of the state reached,
//! so a joint that can stop now can still stop one tick later.

/// Limits of a joint from tick to tick: lengths in rad or m, times in ticks. Infinite without a limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Braking {
    /// Largest change of the step.
    pub acceleration: f64,
    /// Largest change of the change.
    pub jerk: f64,
}

/// The fastest stop of a joint, from its position at the start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FastestStop {
    /// Number of ticks until the joint is at rest.
    pub ticks: f64,
    /// Displacement at rest.
    pub end: f64,
    /// Smallest displacement on the way, at most 0.
    pub lowest: f64,
    /// Largest displacement on the way, at least 0.
    pub highest: f64,
}

/// Corrections of a number of ticks that was estimated.
const ADJUSTMENTS: usize = 4;

/// The integer part of a number that is not negative. Without special instructions of the processor, `floor` is a call
/// that takes as long as the rest of a phase.
fn whole(x: f64) -> f64 {
    if x < 1e15 { (x as i64) as f64 } else { x }
}

/// Progress of a stop in the direction in which it ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct StopPhases {
    /// Step of the last tick.
    pub step: f64,
    pub displacement: f64,
    pub lowest: f64,
    pub ticks: f64,
}

impl StopPhases {
    /// The beginning of a stop with this step.
    pub fn begin(step: f64) -> Self {
        Self { step, displacement: 0.0, lowest: 0.0, ticks: 0.0 }
    }
}

/// The largest x such that x, x - `change`, x - 2 `change`, ... sum to at most `total` whatever the number of terms.
///
/// m terms sum to m x - change m (m - 1) / 2, so x <= total / m + change (m - 1) / 2 for every m; the smallest right-hand
/// side is at m near sqrt(2 total / change).
pub(super) fn longest_first(total: f64, change: f64) -> f64 {
    let total = total.max(0.0);
    if change == f64::INFINITY || total == f64::INFINITY || total == 0.0 {
        return total;
    }
    if change == 0.0 {
        return 0.0;
    }
    fade_out(total, change).1
}

/// Number of terms and first term of the sequence x, x - `change`, ... of positive terms that sums to `total`.
pub(super) fn fade_out(total: f64, change: f64) -> (f64, f64) {
    let first = |terms: f64| total / terms + 0.5 * change * (terms - 1.0);
    let terms = whole((2.0 * total / change).sqrt()).max(1.0);
    if first(terms + 1.0) < first(terms) { (terms + 1.0, first(terms + 1.0)) } else { (terms, first(terms)) }
}

impl Braking {
    /// Sum of x, x - jerk, x - 2 jerk, ... down to 0 for a positive `x`; odd.
    fn faded(&self, x: f64) -> f64 {
        if self.jerk == f64::INFINITY || x == 0.0 {
            return x;
        }
        let terms = whole(x.abs() / self.jerk);
        ((terms + 1.0) * (x.abs() - 0.5 * self.jerk * terms)).copysign(x)
    }

    /// The step after `change` has faded out without braking.
    fn coasting(&self, step: f64, change: f64) -> f64 {
        step + self.faded(change) - change
    }

    /// Direction of a stop: 1 if it ends upwards, else -1.
    pub(super) fn direction(&self, step: f64, change: f64) -> f64 {
        if self.coasting(step, change) < 0.0 { -1.0 } else { 1.0 }
    }

    /// The largest step on the way if the joint brakes at once; negative steps count too.
    pub fn fastest(&self, step: f64, change: f64) -> f64 {
        if change > 0.0 { self.coasting(step, change) } else { step }
    }

    /// A bound of the way to rest of a joint with steps up to `most`: while its change fades out, and from the largest step.
    pub fn farthest(&self, most: f64) -> f64 {
        let fading = if self.jerk < f64::INFINITY { self.acceleration.min(most) / self.jerk } else { 0.0 };
        most * (2.0 + fading) + self.stop(most, 0.0).end
    }

    /// A cheap bound of the way of the fastest stop upwards; infinite or NaN without an acceleration limit.
    pub fn at_most_up(&self, step: f64, change: f64) -> f64 {
        let fastest = self.fastest(step, change).max(0.0);
        // The braking builds up, lasts, and fades out.
        fastest * ((change.abs() + 2.0 * self.acceleration) / self.jerk + fastest / self.acceleration + 3.0)
    }

    /// The fastest stop after a tick with this step and change.
    pub fn stop(&self, step: f64, change: f64) -> FastestStop {
        if step.abs() + change.abs() <= self.jerk.min(self.acceleration) {
            // The next tick undoes such a step.
            let ticks = if step == 0.0 { 0.0 } else { 1.0 };
            return FastestStop { ticks, end: 0.0, lowest: 0.0, highest: 0.0 };
        }
        let sign = self.direction(step, change);
        let mut phases = StopPhases::begin(sign * step);
        let braking = self.build_up(-sign * change, &mut phases);
        self.brake_fully(braking, &mut phases);
        self.fade(&mut phases);
        let StopPhases { displacement, lowest, ticks, .. } = phases;
        let (lowest, highest) = (lowest.min(displacement), displacement.max(0.0));
        let [lowest, highest] = if sign > 0.0 { [lowest, highest] } else { [-highest, -lowest] };
        FastestStop { ticks, end: sign * displacement, lowest, highest }
    }

    /// Builds the braking up from `braking` by `jerk` per tick, as long as the joint will not reverse. Returns the braking
    /// reached.
    pub(super) fn build_up(&self, braking: f64, phases: &mut StopPhases) -> f64 {
        let Self { acceleration: most, jerk } = *self;
        if jerk == f64::INFINITY {
            return braking;
        }
        let first = phases.step;
        let step_after = |k: f64| first - k * braking - 0.5 * jerk * k * (k + 1.0);
        let stays = |k: f64| {
            let reached = braking + k * jerk;
            // A change that speeds up fades out in any case.
            reached <= 0.0 || reached <= most && self.faded(reached) <= step_after(k - 1.0)
        };
        // Where the faded braking, about x^2 / (2 jerk) + x / 2, meets the step that is left.
        let peak = (jerk * (first + 0.5 * braking) + 0.5 * braking * braking).max(0.0).sqrt();
        let mut ticks = whole(((peak.min(most) - braking) / jerk).max(0.0));
        // The estimate is off by one at most, more by rounding only.
        for _ in 0..ADJUSTMENTS {
            if stays(ticks + 1.0) {
                ticks += 1.0;
            } else if ticks > 0.0 && !stays(ticks) {
                ticks -= 1.0;
            } else {
                break;
            }
        }
        let displacement_after = |k: f64| k * (first - (k + 1.0) * (0.5 * braking + jerk * (k + 2.0) * (1.0 / 6.0)));
        if first < 0.0 {
            // The joint moves backwards at first, until its steps change sign.
            let slope = -braking - 0.5 * jerk;
            let turn = (slope - (slope * slope + 2.0 * jerk * first).max(0.0).sqrt()) / jerk;
            phases.lowest = displacement_after(whole(turn.clamp(0.0, ticks))).min(0.0);
        }
        phases.displacement = displacement_after(ticks);
        phases.step = step_after(ticks);
        phases.ticks = ticks;
        braking + ticks * jerk
    }

    /// Brakes with the full acceleration, as long as the joint will not reverse, if the `braking` reached allows it.
    pub(super) fn brake_fully(&self, braking: f64, phases: &mut StopPhases) {
        let most = self.acceleration;
        if braking + self.jerk < most {
            return;
        }
        let spare = if most < f64::INFINITY { phases.step - self.faded(most) } else { -1.0 };
        if spare >= 0.0 {
            let ticks = whole(spare / most) + 1.0;
            phases.displacement += ticks * (phases.step - 0.5 * most * (ticks + 1.0));
            phases.step -= ticks * most;
            phases.ticks += ticks;
        }
    }

    /// Fades the remaining braking out, by `jerk` per tick.
    fn fade(&self, phases: &mut StopPhases) {
        let step = phases.step;
        if step <= 0.0 {
            return;
        }
        if self.jerk == f64::INFINITY {
            phases.ticks += 1.0; // its step is 0
            return;
        }
        let (terms, first) = fade_out(step, self.jerk);
        phases.displacement +=
            terms * step - 0.5 * terms * (terms + 1.0) * (first - self.jerk * (terms - 1.0) * (1.0 / 3.0));
        phases.ticks += terms;
    }

    /// The change of the first tick of the fastest stop.
    pub fn first_change(&self, step: f64, change: f64) -> f64 {
        let sign = self.direction(step, change);
        let (step, change) = (sign * step, sign * change);
        let hardest = (change - self.jerk).max(-self.acceleration);
        // A joint that still moves backwards lets its change fade out.
        let wanted = if step > 0.0 { -longest_first(step, self.jerk) } else { (change - self.jerk).max(0.0) };
        sign * wanted.max(hardest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The greedy stop, tick by tick: the smallest change after which the joint does not reverse while its change fades out.
    fn simulated(braking: &Braking, mut step: f64, mut change: f64) -> FastestStop {
        let mut stop = FastestStop { ticks: 0.0, end: 0.0, lowest: 0.0, highest: 0.0 };
        while step.abs() > 1e-13 * braking.acceleration.min(1.0) {
            let sign = if braking.coasting(step, change) < 0.0 { -1.0 } else { 1.0 };
            let [mut low, mut high] = [
                (sign * change - braking.jerk).max(-braking.acceleration),
                (sign * change + braking.jerk).min(braking.acceleration),
            ];
            let keeps_on = |change: f64| braking.coasting(sign * step + change, change) >= 0.0;
            if keeps_on(low) {
                high = low;
            }
            for _ in 0..200 {
                let middle = 0.5 * (low + high);
                (low, high) = if keeps_on(middle) { (low, middle) } else { (middle, high) };
            }
            change = sign * high;
            step += change;
            stop.end += step;
            stop.ticks += 1.0;
            (stop.lowest, stop.highest) = (stop.lowest.min(stop.end), stop.highest.max(stop.end));
        }
        stop
    }

    fn braking() -> impl Strategy<Value = Braking> {
        (-2.5_f64..0.5, any::<bool>()).prop_map(|(jerk, limited)| Braking {
            acceleration: 1.0,
            jerk: if limited { 10.0_f64.powf(jerk) } else { f64::INFINITY },
        })
    }

    proptest! {
        #[test]
        fn the_closed_form_is_the_greedy_stop(braking in braking(), step in -40.0..40.0, change in -1.0..1.0) {
            let (stop, expected) = (braking.stop(step, change), simulated(&braking, step, change));
            let scale = 1e-9 * (1.0 + expected.highest - expected.lowest);
            prop_assert!((stop.end - expected.end).abs() < scale, "{stop:?} {expected:?}");
            prop_assert!((stop.highest - expected.highest).abs() < scale, "{stop:?} {expected:?}");
            prop_assert!((stop.lowest - expected.lowest).abs() < scale, "{stop:?} {expected:?}");
            prop_assert!((stop.ticks - expected.ticks).abs() <= 1.0, "{stop:?} {expected:?}");
        }

        #[test]
        fn the_cheap_bound_holds(braking in braking(), step in -40.0..40.0, change in -1.0..1.0) {
            let (highest, bound) = (braking.stop(step, change).highest, braking.at_most_up(step, change));
            prop_assert!(highest <= bound * (1.0 + 1e-12), "{highest} {bound}");
        }

        #[test]
        fn the_first_change_begins_the_stop(braking in braking(), step in -40.0..40.0, change in -1.0..1.0) {
            let first = braking.first_change(step, change);
            prop_assert!(first.abs() <= 1.0 && (first - change).abs() <= braking.jerk * (1.0 + 1e-12));
            let (whole, rest) = (braking.stop(step, change), braking.stop(step + first, first));
            prop_assert!((whole.end - step - first - rest.end).abs() < 1e-9 * (1.0 + whole.end.abs()));
        }

        #[test]
        fn longest_first_is_used_up(total in 1e-6..30.0, change in 1e-3..1.0) {
            let sum = |first: f64| -> f64 {
                std::iter::successors(Some(first), |x| Some(x - change)).take_while(|x| *x > 0.0).sum()
            };
            let first = longest_first(total, change);
            prop_assert!((sum(first) - total).abs() < 1e-9 * total.max(1.0) && sum(first * (1.0 + 1e-6)) > total);
        }
    }

    #[test]
    fn short_ticks_approach_the_continuous_stop() {
        let (speed, acceleration, jerk, dt) = (1.2_f64, 4.0_f64, 60.0_f64, 1e-5_f64);
        let braking = Braking { acceleration: acceleration * dt.powi(2), jerk: jerk * dt.powi(3) };
        let stop = braking.stop(speed * dt, 0.0);
        // Braking builds up and fades out in a / j each.
        let time = speed / acceleration + acceleration / jerk;
        assert!((stop.ticks * dt - time).abs() < 1e-4 && (stop.end - 0.5 * speed * time).abs() < 1e-4, "{stop:?}");
    }

    #[test]
    fn without_a_limit_the_stop_takes_a_tick() {
        let free = Braking { acceleration: f64::INFINITY, jerk: f64::INFINITY };
        assert_eq!(free.stop(0.3, 0.1), FastestStop { ticks: 1.0, end: 0.0, lowest: 0.0, highest: 0.0 });
        assert_eq!((free.first_change(0.3, 0.1), free.stop(0.0, 0.0).ticks), (-0.3, 0.0));
    }
}
