//! What a configuration is to achieve: the target of the only tip, or those of several.

use crate::task::{Criterion, Target, TipAims};

/// The target of the only tip with its criterion, or those of several tips.
#[derive(Debug, Clone, Copy)]
pub(super) enum Aim<'a> {
    Tip(&'a Target, Criterion),
    Tips(TipAims<'a>),
}
