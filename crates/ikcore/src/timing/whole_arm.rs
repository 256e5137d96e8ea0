//! Limits on the motion of the arm as a whole: on its tips, and on the torques of its joints.

use std::borrow::Cow;

use super::constant_limits::ConstantLimits;
use crate::constraint::{HoldCheck, TIGHT, TooHeavy};
use crate::error::{Error, Result};
use crate::limits::ROUNDING;
use crate::trajectory::Trajectory;
use crate::wording::number;

impl ConstantLimits {
    /// Whether the motion of the robot as a whole is limited: that of its tips, or the torques of its joints.
    pub(crate) fn limit_whole(&self) -> bool {
        self.tips.is_some() || self.torques.is_some()
    }

    /// These limits without those of torques.
    pub(super) fn without_torque(&self) -> Cow<'_, Self> {
        if self.torques.is_none() { Cow::Borrowed(self) } else { Cow::Owned(Self { torques: None, ..self.clone() }) }
    }

    /// Whether `motion` keeps the limits of torques.
    pub(crate) fn keep_torque(&self, motion: &Trajectory) -> bool {
        self.torques.as_ref().is_none_or(|torques| torques.keeps(motion))
    }

    /// Whether `motion` keeps the limits of tips and of torques.
    pub(crate) fn keep_whole(&self, motion: &Trajectory) -> bool {
        let most = 1.0 + ROUNDING;
        self.tips.as_ref().is_none_or(|tips| tips.slowdown(motion, most) <= most) && self.keep_torque(motion)
    }

    /// Factor by which `motion` must be slowed down to keep the limits of tips and of torques, or a bound of it up to `enough`; infinite where
    /// a joint cannot hold the arm.
    pub(super) fn whole_slowdown(&self, motion: &Trajectory, enough: f64) -> f64 {
        let of_tips = self.tips.as_ref().map_or(0.0, |tips| tips.slowdown(motion, enough));
        let of_torques = self.torques.as_ref().map_or(0.0, |torques| torques.slowdown(motion, enough.max(of_tips)));
        of_tips.max(of_torques)
    }

    /// Slows `motion` down as a whole where it exceeds the limits of tips or of torques. One on which a joint cannot hold the arm stays as it is.
    pub(super) fn slowed_as_a_whole(&self, motion: Trajectory) -> Result<Trajectory> {
        if self.tips.is_none() && self.keep_torque(&motion) {
            return Ok(motion);
        }
        Ok(self.slowed_if_held(&motion)?.unwrap_or(motion))
    }

    /// [`slowed_as_a_whole`](Self::slowed_as_a_whole); `None` where a joint cannot hold the arm.
    pub(super) fn slowed_if_held(&self, motion: &Trajectory) -> Result<Option<Trajectory>> {
        let factor = self.whole_slowdown(motion, 1.0);
        if factor.is_infinite() {
            return Ok(None);
        }
        let motion = motion.clone();
        if factor <= 1.0 { Ok(Some(motion)) } else { motion.slowed(factor * (1.0 + TIGHT)).map(Some) }
    }

    /// Slows `motion` down as a whole where it exceeds the limits of tips.
    pub(super) fn slowed_for_tips(&self, motion: Trajectory) -> Result<Trajectory> {
        let factor = self.tips.as_ref().map_or(0.0, |tips| tips.slowdown(&motion, 1.0));
        if factor <= 1.0 { Ok(motion) } else { motion.slowed(factor * (1.0 + TIGHT)) }
    }

    /// Checks whether joints can hold the arm along lines; `None` without torque limits.
    pub(crate) fn hold_check(&self) -> Option<HoldCheck<'_>> {
        self.torques.as_ref().map(HoldCheck::new)
    }

    /// Returns why a joint cannot hold the arm at `q` (n,), if one cannot.
    pub(crate) fn too_heavy(&self, q: &[f64]) -> Option<String> {
        let torques = self.torques.as_ref()?;
        torques.too_heavy(&mut torques.point(), q).map(|found| self.heavy_in_words(found))
    }

    /// Checks that the joints can hold the arm at `q`, which `what` names.
    ///
    /// # Errors
    /// [`Error::Infeasible`] names joint, torque and limit.
    pub(crate) fn refuse_too_heavy(&self, what: &str, q: &[f64]) -> Result<()> {
        match self.too_heavy(q) {
            None => Ok(()),
            Some(heavy) => Err(Error::Infeasible { problem: format!("at {what} {heavy}").into() }),
        }
    }

    /// Says which joint cannot hold the arm, and why.
    pub(super) fn heavy_in_words(&self, TooHeavy { joint, torque, friction, limit }: TooHeavy) -> String {
        let (name, unit) = (self.joint_name(joint), self.torque_unit(joint));
        let [torque, against, limit] = [torque, friction, limit].map(number);
        if friction > 0.0 {
            let needs = format!("joint '{name}' needs {torque} {unit} to hold the arm");
            return format!("{needs} and {against} {unit} against its dry friction, its limit is {limit} {unit}");
        }
        if torque == limit {
            return format!("joint '{name}' needs all of its limit of {limit} {unit} to hold the arm");
        }
        format!("joint '{name}' needs {torque} {unit} to hold the arm, its limit is {limit} {unit}")
    }

    /// Checks that a slowdown is finite.
    pub(super) fn require_holdable(&self, factor: f64) -> Result<()> {
        if factor.is_finite() {
            return Ok(());
        }
        let problem = "a joint cannot hold the arm on the way, however slowly it moves".into();
        Err(Error::Infeasible { problem })
    }
}
