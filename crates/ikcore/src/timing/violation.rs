//! Violations of bounds by a planned trajectory.

use std::borrow::Cow;
use std::fmt;

use serde::{Deserialize, Serialize};

use super::constant_limits::ConstantLimits;
use crate::constraint::{TipExcess, TorqueExcess};
use crate::limits::ROUNDING;
use crate::trajectory::Trajectory;
use crate::wording::number;

/// A bound that a trajectory violates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Violation {
    /// The quantity, for example "velocity of joint 'elbow'".
    pub what: String,
    /// Extreme value of the quantity, in `unit`.
    pub value: f64,
    /// The bound, in `unit`.
    pub bound: f64,
    /// The unit, for example "rad/s".
    pub unit: Cow<'static, str>,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, value, bound, unit } = self;
        let [shown, allowed] = [number(*value), number(*bound)];
        if shown == allowed {
            let beyond = number((value - bound).abs());
            return write!(f, "{what} is {beyond} {unit} beyond the {allowed} {unit} allowed");
        }
        write!(f, "{what} is {shown} {unit}, allowed {allowed} {unit}")
    }
}

impl ConstantLimits {
    /// Returns the limits that `trajectory` violates, by the exact extremes of its polynomials. A joint that begins outside its
    /// position limits may return from there.
    pub(crate) fn violations(&self, trajectory: &Trajectory) -> Vec<Violation> {
        let [velocity, acceleration, jerk] =
            [trajectory.max_velocity(), trajectory.max_acceleration(), trajectory.max_jerk()];
        // Rounding of the times of the trajectory: a velocity may be off by its change in that time, and so on.
        let resolution = 4.0 * f64::EPSILON * trajectory.duration();
        let mut found = vec![];
        let start = trajectory.start();
        for (j, (lowest, highest)) in trajectory.position_range().into_iter().enumerate() {
            let units = self.units(j);
            // A start outside the limits was taken by the gate; the motion may not go farther out.
            let (lower, upper) = (self.lower[j].min(start[j]), self.upper[j].max(start[j]));
            let checks = [
                ("lowest position", lowest, lower, lower - lowest, units[0]),
                ("highest position", highest, upper, highest - upper, units[0]),
                ("velocity", velocity[j], self.velocity[j], velocity[j] - self.velocity[j], units[1]),
                (
                    "acceleration",
                    acceleration[j],
                    self.acceleration[j],
                    acceleration[j] - self.acceleration[j],
                    units[2],
                ),
                ("jerk", jerk[j], self.jerk[j], jerk[j] - self.jerk[j], units[3]),
            ];
            for (quantity, value, bound, excess, unit) in checks {
                let changes = match quantity {
                    "velocity" => self.acceleration[j],
                    "acceleration" => self.jerk[j],
                    _ => 0.0,
                };
                let unresolved = if changes.is_finite() { resolution * changes } else { 0.0 };
                if excess > ROUNDING * bound.abs().max(1.0) + unresolved {
                    let what = format!("{quantity} of joint '{}'", self.joint_name(j));
                    found.push(Violation { what, value, bound, unit: unit.into() });
                }
            }
        }
        found.extend(self.whole_violations(trajectory));
        found
    }

    /// The limits of tips and torques that `trajectory` exceeds.
    pub(crate) fn whole_violations(&self, trajectory: &Trajectory) -> Vec<Violation> {
        let of_tips = self.tips.iter().flat_map(|tips| tips.excesses(trajectory));
        let of_tips =
            of_tips.map(|TipExcess { what, value, bound, unit }| Violation { what, value, bound, unit: unit.into() });
        let of_torques = self.torques.iter().flat_map(|torques| torques.excesses(trajectory));
        let of_torques = of_torques.map(|TorqueExcess { joint, value, bound }| Violation {
            what: format!("torque of joint '{}'", self.joint_name(joint)),
            value,
            bound,
            unit: self.torque_unit(joint).into(),
        });
        of_tips.chain(of_torques).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(value: f64, bound: f64) -> String {
        Violation { what: "velocity of joint 'a'".into(), value, bound, unit: "rad/s".into() }.to_string()
    }

    #[test]
    fn a_violation_names_value_and_bound_or_what_rounding_would_hide() {
        assert_eq!(shown(2.5, 2.0), "velocity of joint 'a' is 2.500 rad/s, allowed 2.000 rad/s");
        assert_eq!(shown(2.00001, 2.0), "velocity of joint 'a' is 1.000e-5 rad/s beyond the 2.000 rad/s allowed");
    }
}
