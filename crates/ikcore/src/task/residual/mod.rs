//! Residuals and their derivatives, one kind of target per file; `entrywise` is the smooth error of APPS.

pub mod entrywise;
pub mod orientation;
pub mod pointing;
pub mod pose;
pub mod position;
