//! Step of a tick by the joints that cost least, with weights that do not make ticks overshoot.

use std::borrow::Cow;
use std::sync::Arc;

use crate::math::box_step::ROWS;
use crate::math::overshoot::TickMotion;
use crate::objective::{Bounds, TaskBlock};

/// Step of a tick.
#[derive(Debug, Clone, Copy)]
pub(super) struct SoftStep<'a> {
    /// Linear model of the task.
    pub model: &'a TaskBlock,
    /// Columns of the geometric Jacobian at its start.
    pub columns: &'a [[f64; ROWS]],
    pub lambda: f64,
    pub from: &'a [f64],
    /// Configuration that joints are to be near, where the task leaves them free.
    pub preferred: Option<&'a [f64]>,
}

impl SoftStep<'_> {
    /// Writes the point after the step.
    #[inline]
    pub fn write(&self, bounds: &Bounds, to: &mut [f64]) {
        self.write_within(bounds, to);
        if bounds.weights().is_some() {
            self.soften(bounds, to);
        }
    }

    #[inline]
    fn write_within(&self, bounds: &Bounds, to: &mut [f64]) {
        match self.preferred {
            None => self.model.write_step(self.lambda, self.from, bounds, to),
            Some(preferred) => self.model.write_step_near(preferred, self.lambda, self.from, bounds, to),
        }
    }

    /// Lowers the weights until ticks like this one do not overshoot, at last to none.
    #[cold]
    fn soften(&self, bounds: &Bounds, to: &mut [f64]) {
        let mut bounds = Cow::Borrowed(bounds);
        while let Some(weights) = bounds.weights() {
            let (columns, from) = (self.columns, self.preferred.unwrap_or(self.from));
            let motion = TickMotion { columns, from, to, ends: bounds.ends() };
            let Some(largest) = weights.without_overshoot(&motion) else { return };
            let softer = weights.at_most(largest).map(Arc::new);
            bounds = Cow::Owned(bounds.into_owned().weighted(softer));
            self.write_within(&bounds, to);
        }
    }
}
