//! Robots from URDF files, Denavit-Hartenberg tables, lengths of planar arms, and by name.

mod catalog;
mod dh;
mod planar;
mod urdf;

pub use dh::{Dh, DhTable};
