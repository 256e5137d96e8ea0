//! core
pub mod error;
