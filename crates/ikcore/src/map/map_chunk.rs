//! Results of a chunk of a map.

use super::map_grid::MapGrid;
use super::rings::Ring;

/// Reachability of the voxels of a chunk, in C order.
#[derive(Debug, Clone, PartialEq)]
pub struct MapChunk {
    /// Number of voxels along x, y and z.
    pub shape: [usize; 3],
    /// Reached orientations of each voxel, one bit each, the lowest first.
    pub reached: Vec<u8>,
    /// Largest manipulability of a configuration found in each voxel, NaN if there is none; empty unless requested.
    pub manipulability: Vec<f32>,
    /// Largest clearance (m) of a configuration found in each voxel, NaN if there is none; empty unless requested.
    pub clearance: Vec<f32>,
}

/// Results of a ring, stored consecutively for its voxels.
#[derive(Debug, Clone)]
pub(crate) struct RingResult {
    pub reached: Vec<u8>,
    /// Manipulability and clearance; empty unless requested.
    pub quality: [Vec<f32>; 2],
}

impl RingResult {
    /// Result with nothing reached.
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
