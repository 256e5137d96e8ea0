//! Rings of equivalent voxels, at one distance from the first axis and one height.

use super::map_grid::MapGrid;

/// Largest number of voxels of a ring, so that their azimuths fit into the bits of a word.
const MOST: usize = 64;

/// Voxels of a chunk at one distance from the first axis and one height; a single voxel if azimuths differ.
#[derive(Debug, Clone)]
pub(crate) struct Ring {
    /// Position of the tip at azimuth 0 (m).
    pub point: [f64; 3],
    /// Azimuth of each voxel (rad).
    pub azimuths: Vec<f64>,
    /// Number of each voxel in the chunk, in C order.
    pub voxels: Vec<usize>,
    /// Number of the ring within its map, for its random stream.
    pub stream: u64,
}

/// Rings of the voxels of a chunk, given by first and last + 1 along x, y and z.
pub(crate) fn rings_of(grid: &MapGrid, [xs, ys, zs]: [[usize; 2]; 3]) -> Vec<Ring> {
    let voxels = grid.voxels();
    let number = |[x, y, z]: [usize; 3]| ((x - xs[0]) * (ys[1] - ys[0]) + y - ys[0]) * (zs[1] - zs[0]) + z - zs[0];
    let stream = |[x, y, z]: [usize; 3]| ((x * voxels.shape()[1] + y) * voxels.shape()[2] + z) as u64;
    let columns = (xs[0]..xs[1]).flat_map(|x| (ys[0]..ys[1]).map(move |y| [x, y]));
    let mut by_distance: Vec<(i64, [usize; 2])> = columns
        .map(|[x, y]| {
            let [a, b, _] = voxels.halves([x, y, 0]);
            (a * a + b * b, [x, y])
        })
        .collect();
    let mut rings = vec![];
    if !grid.treats_azimuths_alike() {
        for (z, (_, [x, y])) in (zs[0]..zs[1]).flat_map(|z| by_distance.iter().map(move |column| (z, *column))) {
            let (voxel, point) = ([x, y, z], voxels.centre([x, y, z]));
            let azimuths = vec![voxels.azimuth(voxel)];
            rings.push(Ring { point, azimuths, voxels: vec![number(voxel)], stream: stream(voxel) });
        }
        return rings;
    }
    by_distance.sort_unstable();
    for z in zs[0]..zs[1] {
        for same in by_distance.chunk_by(|a, b| a.0 == b.0).flat_map(|same| same.chunks(MOST)) {
            let of_each = || same.iter().map(|(_, [x, y])| [*x, *y, z]);
            let (square, [x, y]) = same[0];
            rings.push(Ring {
                point: voxels.point_at(square, z),
                azimuths: of_each().map(|voxel| voxels.azimuth(voxel)).collect(),
                voxels: of_each().map(number).collect(),
                stream: stream([x, y, z]),
            });
        }
    }
    rings
}
