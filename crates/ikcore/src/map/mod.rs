//! Maps of what an arm reaches: space in voxels, the same orientations at the centre of each, and a bit for every pair.
//!
//! A `MapGrid` says which poses a map has: voxels (`voxel_grid`), whose chunks are computed one by one, and orientations
//! (`orientation_set`). Where the first axis is vertical, the orientations turn with the azimuth of the voxel: then all voxels at one
//! distance from the axis and one height ask the same, but for the limits of the first joint, and `rings` collects them. A `MapTest`
//! (`map_test`) answers for one pose and many azimuths, by the closed form where there is one; where that leaves a pose open, `second_look`
//! descends from solutions of near orientations; `map_looks` calls both. `map_chunk` holds the results. Threads are
//! in [`batch`](crate::batch).

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
