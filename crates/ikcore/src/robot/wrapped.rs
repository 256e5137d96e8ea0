//! Whole turns of joints: the same posture inside the limits, or near another one.

use super::joint::{limit_rounding, outside_limits, play, position_unit, way_inside};
use super::model::Robot;
use crate::error::{Error, Result};
use crate::math::sampling_range;
use crate::message::message;
use crate::wording::number;

impl Robot {
    /// The posture `q` (n,) at whole turns of its joints that are inside the limits, and nearest to `near` (n,). Without one, a joint
    /// inside its limits keeps its turn, and a joint without limits comes to (-pi, pi]. A joint that no turn brings inside may be outside
    /// by 5 degrees, as a start may. Joints that slide stay where they are, outside by 5 mm at most.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::NotFinite`]; [`Error::OutsideLimits`] names a joint that is farther out at every turn.
    pub fn wrap(&self, q: &[f64], near: Option<&[f64]>) -> Result<Vec<f64>> {
        self.check("q", q)?;
        near.map_or(Ok(()), |near| self.check("near", near))?;
        let turned = |(j, value): (usize, &f64)| {
            let joint = &self.joints()[j];
            let limits = sampling_range::opened(joint.lower, joint.upper).into();
            let near = near.map(|near| near[j]);
            self.turned_near(j, *value, near, limits).ok_or_else(|| self.no_turn(j, *value, limits))
        };
        q.iter().enumerate().map(turned).collect()
    }

    /// The configurations `qs` (m, n), row-major, each as by [`wrap`](Self::wrap).
    ///
    /// # Errors
    /// As [`wrap`](Self::wrap); [`Error::WrongLength`] for values that are no rows of joints.
    pub fn wrap_all(&self, qs: &[f64], near: Option<&[f64]>) -> Result<Vec<f64>> {
        let mut wrapped = Vec::with_capacity(qs.len());
        for q in self.rows(qs)? {
            wrapped.extend(self.wrap(q, near)?);
        }
        Ok(wrapped)
    }

    /// As [`turned_inside`](Self::turned_inside); where no turn is inside, at one that is outside by the play of a start.
    pub(crate) fn turned_near(&self, j: usize, value: f64, near: Option<f64>, limits: [f64; 2]) -> Option<f64> {
        let play = play(Some(self.joints()[j].kind));
        let widened = [limits[0] - play, limits[1] + play];
        self.turned_inside(j, value, near, limits).or_else(|| self.turned_inside(j, value, near, widened))
    }

    /// Value of joint `j` at the whole turn inside `limits` (rad, m) nearest to `near`; `None` where there is none. Rounding beyond a
    /// limit is clamped.
    pub(crate) fn turned_inside(&self, j: usize, value: f64, near: Option<f64>, limits: [f64; 2]) -> Option<f64> {
        let [lower, upper] = limits;
        let rounding = limit_rounding(lower, upper);
        let is_inside = lower - rounding <= value && value <= upper + rounding;
        let Some(period) = self.turn_period(j).filter(|_| self.joints()[j].kind.turns()) else {
            return is_inside.then(|| value.clamp(lower, upper));
        };
        let is_nearest = near.is_none_or(|near| 2.0 * (near - value).abs() <= period);
        match near {
            None if lower == f64::NEG_INFINITY && upper == f64::INFINITY => return Some(principal(value, period)),
            _ if is_inside && is_nearest => return Some(value.clamp(lower, upper)),
            _ => {}
        }
        // The remainder is exact, so that large angles lose no digits.
        let base = value % period;
        let turns = ((near.unwrap_or(value) - base) / period).round();
        let (fewest, most) =
            (((lower - rounding - base) / period).ceil(), ((upper + rounding - base) / period).floor());
        (fewest <= most).then(|| (base + turns.max(fewest).min(most) * period).clamp(lower, upper))
    }

    /// Shifts the joints of `q` that turn without limits in `lower` and `upper` (n,) to the whole turns nearest to `near` (n,).
    pub(crate) fn turn_near(&self, [lower, upper]: [&[f64]; 2], near: &[f64], q: &mut [f64]) {
        for (j, value) in q.iter_mut().enumerate() {
            if self.turns_freely(j, [lower[j], upper[j]]) {
                let without = [f64::NEG_INFINITY, f64::INFINITY];
                *value = self.turned_inside(j, *value, Some(near[j]), without).unwrap_or(*value);
            }
        }
    }

    /// Whether joint `j` turns without limits in `lower` and `upper` (rad), and repeats its pose after some turn.
    pub(crate) fn turns_freely(&self, j: usize, [lower, upper]: [f64; 2]) -> bool {
        let is_open = sampling_range::opened(lower, upper) == (f64::NEG_INFINITY, f64::INFINITY);
        is_open && self.joints()[j].kind.turns() && self.turn_period(j).is_some()
    }

    /// The error for joint `j`, which no whole turn brings inside its limits.
    fn no_turn(&self, j: usize, value: f64, [lower, upper]: [f64; 2]) -> Error {
        let joint = &self.joints()[j];
        let unit = position_unit(Some(joint.kind));
        let outside = |value: f64| (lower - value).max(value - upper);
        let period = self.turn_period(j).filter(|_| joint.kind.turns());
        let beyond = period.map_or(outside(value), |period| {
            let above = value + ((lower - value) / period).ceil() * period;
            outside(above).min(outside(above - period))
        });
        let why = match period {
            Some(_) => format!("no whole turn brings it inside, the nearest is {} {unit} beyond; ", number(beyond)),
            None => "whole turns do not apply to it; ".into(),
        };
        let named = (joint.name.as_str(), Some(joint.kind));
        outside_limits("q", named, value, [lower, upper], message![why, way_inside(Some(joint.kind), beyond)])
    }
}

/// Angle of the same turn in (-period / 2, period / 2].
fn principal(value: f64, period: f64) -> f64 {
    let (base, half) = (value % period, 0.5 * period);
    let turned = if base > half + limit_rounding(-half, half) {
        base - period
    } else if base <= -half {
        base + period
    } else {
        base
    };
    turned.min(half)
}
