//! Limits other than those of torques that a command and its stop keep: distances from obstacles, and the pace of tips.

use crate::tracking::safety_filter::SafetyFilter;
use crate::tracking::step_context::StepContext;
use crate::tracking::tip_pace::TipPace;

/// What else a command has to satisfy.
pub(in crate::tracking) struct OtherLimits<'a> {
    pub safety: Option<&'a mut SafetyFilter>,
    pub pace: Option<&'a mut TipPace>,
}

impl OtherLimits<'_> {
    /// Whether the command `q` and the stop after it satisfy all others.
    pub(super) fn allow(&mut self, context: &StepContext<'_>, q: &[f64]) -> bool {
        self.pace.as_mut().is_none_or(|pace| pace.allows(context, q))
            && self.safety.as_mut().is_none_or(|safety| safety.allows_command(context, q))
    }
}
