//! Fraction of each limit that a motion uses at an instant.

use super::constant_limits::ConstantLimits;
use crate::limits::TipField;
use crate::math::polynomial::{derivative, evaluate};
use crate::trajectory::Trajectory;

/// One limit of a motion: a joint or a tip, by index, and which.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum OneLimit {
    Joint(usize, &'static str),
    Tip(usize, TipField),
}

impl ConstantLimits {
    /// The parts of all limits that `motion` uses at `t` (s).
    pub(crate) fn shares(&self, motion: &Trajectory, t: f64) -> Vec<(OneLimit, f64)> {
        let n = self.dof();
        let segment = motion.knots().partition_point(|knot| *knot <= t).clamp(1, motion.knots().len() - 1) - 1;
        let elapsed = t - motion.knots()[segment];
        let polynomials = &motion.coefficients()[segment * n..(segment + 1) * n];
        let mut shares = vec![];
        for (joint, polynomial) in polynomials.iter().enumerate() {
            let [_, velocity, acceleration] = evaluate(polynomial, elapsed);
            let [.., jerk] = evaluate(&derivative(polynomial), elapsed);
            let uses = [
                ("velocity", velocity, self.velocity[joint]),
                ("acceleration", acceleration, self.acceleration[joint]),
                ("jerk", jerk, self.jerk[joint]),
            ];
            shares.extend(uses.map(|(name, value, limit)| (OneLimit::Joint(joint, name), value.abs() / limit)));
        }
        if let Some(torques) = &self.torques {
            let of_joints = torques.shares(polynomials, elapsed).into_iter().enumerate();
            shares.extend(of_joints.map(|(joint, used)| (OneLimit::Joint(joint, "torque"), used)));
        }
        if let Some(tips) = &self.tips {
            shares
                .extend(tips.shares(polynomials, elapsed).map(|(tip, field, used)| (OneLimit::Tip(tip, field), used)));
        }
        shares
    }

    /// The name of a limit, and of the joint or tip that it is of.
    pub(crate) fn names(&self, limit: OneLimit) -> [String; 2] {
        match limit {
            OneLimit::Joint(joint, name) => [name.into(), self.joint_name(joint).into()],
            OneLimit::Tip(tip, field) => {
                [field.to_string(), self.tips.as_ref().map_or_else(String::new, |tips| tips.name(tip).into())]
            }
        }
    }
}
