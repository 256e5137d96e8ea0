//! The results of a chunk.

use super::map_grid::MapGrid;
use super::rings::Ring;

/// What an arm reaches in the voxels of a chunk, in C order.
#[derive(Debug, Clone, PartialEq)]
pub struct MapChunk {
    /// Number of voxels along x, y and z.
    pub shape: [usize; 3],
    /// A bit for each orientation of each voxel, the lowest first.
    pub reached: Vec<u8>,
    /// Largest manipulability of a configuration found in each voxel, NaN where there is none; empty unless asked for.
    pub manipulability: Vec<f32>,
    /// Largest clearance (m), likewise.
    pub clearance: Vec<f32>,
}

/// The results of a ring, one after another for each of its voxels.
#[derive(Debug, Clone)]
pub(crate) struct RingResult {
    pub reached: Vec<u8>,
    /// Manipulability and clearance; empty unless asked for.
    pub quality: [Vec<f32>; 2],
}

impl RingResult {
    /// Nothing reached yet.
    pub fn new(ring: &Ring, bytes: usize, quality: bool) -> Self {
        let of_each = || if quality { vec![f32::NAN; ring.voxels.len()] } else { vec![] };
        Self { reached: vec![0; ring.voxels.len() * bytes], quality: [of_each(), of_each()] }
    }
}

impl MapChunk {
    /// Collects the results of the rings of a chunk.
    pub(crate) fn collected(grid: &MapGrid, ranges: [[usize; 2]; 3], rings: &[Ring], results: &[RingResult]) -> Self {
        let (shape, bytes) = (ranges.map(|[start, end]| end - start), grid.bytes());
        let count: usize = shape.iter().product();
        let asked = results.first().is_some_and(|result| !result.quality[0].is_empty());
        let of_each = || if asked { vec![f32::NAN; count] } else { vec![] };
        let mut reached = vec![0; count * bytes];
        let mut quality = [of_each(), of_each()];
        for (ring, result) in rings.iter().zip(results) {
            for (voxel, bits) in ring.voxels.iter().zip(result.reached.chunks_exact(bytes)) {
                reached[voxel * bytes..(voxel + 1) * bytes].copy_from_slice(bits);
            }
            for (all, own) in quality.iter_mut().zip(&result.quality) {
                ring.voxels.iter().zip(own).for_each(|(voxel, value)| all[*voxel] = *value);
            }
        }
        let [manipulability, clearance] = quality;
        Self { shape, reached, manipulability, clearance }
    }
}
