//! Residuals of the kinds of targets and their derivatives, one kind a file.

pub mod entrywise;
pub mod orientation;
pub mod pointing;
pub mod pose;
pub mod position;
