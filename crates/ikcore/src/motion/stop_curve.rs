//! The fastest stop of a joint, tick by tick in closed form.

use super::braking::{Braking, StopPhases, fade_out};

/// Position of a joint during its fastest stop.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StopCurve {
    /// Direction of the stop: 1 if it ends upwards, else -1.
    sign: f64,
    first: f64,
    /// The braking at the beginning.
    braking: f64,
    /// Growth of the braking per tick.
    jerk: f64,
    /// States at which the braking stops growing and begins to fade.
    built_up: StopPhases,
    fading: StopPhases,
    /// The deceleration between the two.
    most: f64,
    /// Number of ticks in which it fades, and the first deceleration of these.
    fade: (f64, f64),
}

impl StopCurve {
    /// The stop after a tick with this step and change.
    pub fn new(limits: &Braking, step: f64, change: f64) -> Self {
        let Braking { acceleration: most, jerk } = *limits;
        let sign = limits.direction(step, change);
        let (first, braking) = (sign * step, -sign * change);
        let mut phases = StopPhases::begin(first);
        if step == 0.0 && change.abs() <= jerk {
            return Self { sign, first, braking, jerk, built_up: phases, fading: phases, most, fade: (0.0, 0.0) };
        }
        let reached = limits.build_up(braking, &mut phases);
        let built_up = phases;
        limits.brake_fully(reached, &mut phases);
        let fade = if phases.step <= 0.0 {
            (0.0, 0.0)
        } else if jerk == f64::INFINITY {
            (1.0, phases.step)
        } else {
            fade_out(phases.step, jerk)
        };
        Self { sign, first, braking, jerk, built_up, fading: phases, most, fade }
    }

    /// Number of ticks until the joint is at rest.
    pub fn ticks(&self) -> f64 {
        self.fading.ticks + self.fade.0
    }

    /// Ticks at which the deceleration is built up, begins to fade, and has faded. In between, its changes are equal.
    pub fn phase_ends(&self) -> [f64; 3] {
        [self.built_up.ticks, self.fading.ticks, self.ticks()]
    }

    /// Displacement after this many ticks.
    pub fn at(&self, ticks: f64) -> f64 {
        self.sign * self.along(ticks.min(self.ticks()))
    }

    /// Displacement at rest.
    pub fn end(&self) -> f64 {
        self.at(f64::INFINITY)
    }

    /// Largest displacement on the way, less the smallest.
    pub fn range(&self) -> f64 {
        let end = self.along(self.ticks());
        end.max(0.0) - end.min(self.fading.lowest)
    }

    fn along(&self, ticks: f64) -> f64 {
        if ticks <= self.built_up.ticks {
            return if ticks == 0.0 {
                0.0
            } else {
                ticks * (self.first - (ticks + 1.0) * (0.5 * self.braking + self.jerk * (ticks + 2.0) / 6.0))
            };
        }
        if ticks <= self.fading.ticks {
            let StopPhases { step, displacement, ticks: begin, .. } = self.built_up;
            let k = ticks - begin;
            return displacement + k * (step - 0.5 * self.most * (k + 1.0));
        }
        let StopPhases { step, displacement, ticks: begin, .. } = self.fading;
        let k = ticks - begin;
        // A deceleration that fades within a tick has no next value.
        let fading = if k > 1.0 { self.jerk * (k - 1.0) * k * (k + 1.0) / 6.0 } else { 0.0 };
        displacement + k * step - 0.5 * k * (k + 1.0) * self.fade.1 + fading
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn it_is_driven_tick_by_tick(
            jerk in -2.5_f64..0.5, limited in any::<bool>(), step in -40.0..40.0, change in -1.0..1.0,
        ) {
            let jerk = if limited { 10.0_f64.powf(jerk) } else { f64::INFINITY };
            let limits = Braking { acceleration: 1.0, jerk };
            let curve = StopCurve::new(&limits, step, change);
            let (mut q, mut speed, mut change) = (0.0, step, change);
            let scale = 1e-9 * (1.0 + curve.end().abs());
            for tick in 0..=curve.ticks() as usize + 1 {
                let there = curve.at(tick as f64);
                prop_assert!((there - q).abs() < scale, "tick {tick}: {there} {q}, {curve:?}");
                change = limits.first_change(speed, change);
                speed += change;
                q += speed;
            }
        }

        #[test]
        fn it_ends_where_the_stop_does(jerk in -2.5_f64..0.5, step in -40.0..40.0, change in -1.0..1.0) {
            let limits = Braking { acceleration: 1.0, jerk: 10.0_f64.powf(jerk) };
            let (curve, stop) = (StopCurve::new(&limits, step, change), limits.stop(step, change));
            prop_assert!((curve.end() - stop.end).abs() <= 1e-12 * (1.0 + stop.end.abs()));
            prop_assert!((curve.range() - (stop.highest - stop.lowest)).abs() <= 1e-12 * (1.0 + curve.range()));
            prop_assert_eq!(curve.ticks(), stop.ticks);
        }
    }
}
