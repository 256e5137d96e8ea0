//! Loading of robots: URDF files, Denavit-Hartenberg tables, link lengths of planar arms, and built-in robots by name.
//!
//! Each adds a constructor to [`Robot`](crate::robot::Robot): `from_urdf`, `from_dh`, `planar`, `named`.

mod catalog;
mod dh;
mod planar;
mod urdf;

pub use dh::{Dh, DhTable};
pub use urdf::UrdfOptions;
