//! Reachability maps of an arm: space in voxels, the same orientations at the centre of each, and a bit for every pair.
//!
//! A `MapGrid` defines the poses of a map: voxels (`voxel_grid`), computed in chunks, and orientations (`orientation_set`). If
//! the first axis is vertical, the orientations rotate with the azimuth of the voxel: all voxels at one distance from the axis
//! and one height are then equivalent except for the limits of the first joint, and form one of the `rings`. A `MapTest`
//! (`map_test`) tests one pose at many azimuths, by the closed form if there is one; if that leaves a pose open, `second_look`
//! descends from solutions of nearby orientations; `map_looks` calls both. `map_chunk` holds the results. Threads are in
//! [`batch`](crate::batch).

mod map_chunk;
mod map_grid;
mod map_looks;
mod map_options;
mod map_test;
mod mapped_joint;
mod orientation_set;
mod rings;
mod second_look;
mod voxel_grid;

pub use map_chunk::MapChunk;
pub use map_grid::{MapGrid, MapLayout};
pub(crate) use map_looks::MapLooks;
pub use map_options::MapOptions;
pub(crate) use map_test::MapRobots;
pub(crate) use rings::rings_of;
