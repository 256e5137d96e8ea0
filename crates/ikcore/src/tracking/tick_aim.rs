//! What a tick is to achieve: the target of the only tip, or those of several.

use crate::objective::Linearization;
use crate::problem::Problem;
use crate::robot::Robot;
use crate::task::{Assessment, Criterion, Target, TipAims};

/// The target of the only tip with its criterion, or those of several tips.
#[derive(Debug, Clone, Copy)]
pub(super) enum TickAim<'a> {
    Tip { target: &'a Target, criterion: &'a Criterion },
    Tips(TipAims<'a>),
}

impl<'a> TickAim<'a> {
    /// Those of several tips.
    pub fn tips(&self) -> Option<&TipAims<'a>> {
        match self {
            Self::Tip { .. } => None,
            Self::Tips(aims) => Some(aims),
        }
    }

    /// The assessment of `q`.
    pub fn assess(&self, robot: &Robot, q: &[f64]) -> Assessment {
        match self {
            Self::Tip { target, criterion } => target.assess_tip(&robot.tip(q), criterion),
            Self::Tips(aims) => aims.assess(robot, q),
        }
    }

    /// The assessment of `q`, with residuals and Jacobians.
    #[inline]
    pub fn linearize(&self, robot: &Robot, q: &[f64], out: &mut Linearization) -> Assessment {
        match self {
            Self::Tip { target, criterion } => target.linearize(robot, q, criterion, &mut out.first),
            Self::Tips(aims) => aims.linearize(robot, q, out, |_| ()),
        }
    }

    /// The problem of achieving it.
    pub fn problem(&self, robot: &'a Robot) -> Problem<'a> {
        match *self {
            Self::Tip { target, criterion } => Problem::new(robot, target, *criterion),
            Self::Tips(aims) => Problem::of_moving_tips(robot, aims),
        }
    }
}
