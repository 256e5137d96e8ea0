//! Loading of robots: URDF files, Denavit-Hartenberg tables, link lengths of planar arms, and built-in robots by name; also
//! the meshes named in robot files.
//!
//! Each loader adds a constructor to [`Robot`](crate::robot::Robot): `from_urdf`, `from_dh`, `planar`, `named`.

mod catalog;
mod cover_cache;
mod dh;
mod mesh;
mod planar;
mod urdf;

pub use cover_cache::covered_mesh;
pub use dh::{Dh, DhTable};
pub use mesh::{parse_mesh, read_link_mesh, read_mesh};
pub use urdf::{CollisionShapes, UrdfOptions};
