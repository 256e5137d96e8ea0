//! Cubic voxels in a box, divided into chunks.

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};

/// Largest number of voxels of a map.
const MOST: f64 = 4e9;

/// Distance from a face of the lattice, as a fraction of a voxel, within which a corner is on the face.
const ON_FACE: f64 = 1e-6;

/// Edge of the chunks of a map whose voxels are computed one by one.
const BLOCK: usize = 8;

/// Grid of cubic voxels. Faces are at whole multiples of the edge from an anchor: the first axis of the arm, or the origin of
/// its base.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VoxelGrid {
    /// Common corner of faces (m).
    anchor: [f64; 3],
    /// Lower corner, in voxels from the anchor.
    first: [i64; 3],
    /// Edge of a voxel (m).
    voxel: f64,
    shape: [usize; 3],
    /// Whether orientations rotate with the azimuth about the anchor.
    turns: bool,
    chunk_shape: [usize; 3],
}

impl VoxelGrid {
    /// Grid of all voxels that intersect the box between two corners (m), with `corners[0]` the lower one. With `by_layers`, a
    /// chunk is a layer at one height.
    pub(super) fn new(
        corners: [[f64; 3]; 2],
        voxel: f64,
        anchor: [f64; 3],
        [turns, by_layers]: [bool; 2],
    ) -> Result<Self> {
        let at = |corner: usize, k: usize| (corners[corner][k] - anchor[k]) / voxel;
        let first: [f64; 3] = std::array::from_fn(|k| (at(0, k) + ON_FACE).floor());
        let counts: [f64; 3] = std::array::from_fn(|k| ((at(1, k) - ON_FACE).ceil() - first[k]).max(1.0));
        let total: f64 = counts.iter().product();
        if !(total <= MOST && first.iter().all(|k| k.abs() < MOST)) {
            return Err(Error::out_of_range("voxel", "larger: a map has at most 4e9 voxels; edge (m)", voxel));
        }
        let shape = counts.map(|count| count as usize);
        let chunk_shape = if by_layers { [shape[0], shape[1], 1] } else { shape.map(|count| count.min(BLOCK)) };
        Ok(Self { anchor, first: first.map(|k| k as i64), voxel, shape, turns, chunk_shape })
    }

    /// Edge of a voxel (m).
    pub fn voxel(&self) -> f64 {
        self.voxel
    }

    /// Number of voxels along x, y and z.
    pub fn shape(&self) -> [usize; 3] {
        self.shape
    }

    /// Lower corner (m).
    pub fn origin(&self) -> [f64; 3] {
        std::array::from_fn(|k| self.anchor[k] + self.voxel * self.first[k] as f64)
    }

    /// Point (m) in the plane z = 0 on the vertical axis about which orientations rotate, if they do.
    pub fn axis(&self) -> Option<[f64; 2]> {
        self.turns.then_some([self.anchor[0], self.anchor[1]])
    }

    /// Largest shape of a chunk; chunks at the upper ends are smaller.
    pub fn chunk_shape(&self) -> [usize; 3] {
        self.chunk_shape
    }

    /// Number of chunks along x, y and z.
    pub fn chunks(&self) -> [usize; 3] {
        std::array::from_fn(|k| self.shape[k].div_ceil(self.chunk_shape[k]))
    }

    /// First and last + 1 voxel of a chunk along x, y and z. Chunks are numbered along z first.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a number beyond the last.
    pub fn chunk(&self, number: usize) -> Result<[[usize; 2]; 3]> {
        let [across, along, up] = self.chunks();
        if number >= across * along * up {
            let requirement = format!("below {}, the number of chunks", across * along * up);
            return Err(Error::out_of_range("chunks", &requirement, number as f64));
        }
        let cell = [number / (along * up), number / up % along, number % up];
        Ok(std::array::from_fn(|k| {
            let start = cell[k] * self.chunk_shape[k];
            [start, (start + self.chunk_shape[k]).min(self.shape[k])]
        }))
    }

    /// Centre of a voxel (m).
    pub fn centre(&self, voxel: [usize; 3]) -> [f64; 3] {
        let halves = self.halves(voxel);
        std::array::from_fn(|k| self.anchor[k] + 0.5 * self.voxel * halves[k] as f64)
    }

    /// Centre of a voxel, in half voxels from the anchor.
    pub(super) fn halves(&self, voxel: [usize; 3]) -> [i64; 3] {
        std::array::from_fn(|k| 2 * (self.first[k] + voxel[k] as i64) + 1)
    }

    /// Point (m) on the x side of the axis, at the height of the voxel `up` layers above the lowest, whose squared distance
    /// from the axis is `square` (half voxels squared).
    pub(super) fn point_at(&self, square: i64, up: usize) -> [f64; 3] {
        let [x, y, _] = self.anchor;
        [x + 0.5 * self.voxel * (square as f64).sqrt(), y, self.centre([0, 0, up])[2]]
    }

    /// Azimuth of a voxel about the axis (rad); 0 if orientations do not rotate.
    pub fn azimuth(&self, voxel: [usize; 3]) -> f64 {
        let [x, y, _] = self.halves(voxel);
        if self.turns { (y as f64).atan2(x as f64) } else { 0.0 }
    }

    /// Voxel that contains a point (m).
    pub fn voxel_at(&self, point: &[f64; 3]) -> Option<[usize; 3]> {
        let origin = self.origin();
        let mut voxel = [0; 3];
        for k in 0..3 {
            let number = ((point[k] - origin[k]) / self.voxel).floor();
            // Rejects NaN too.
            if !(number >= 0.0 && number < self.shape[k] as f64) {
                return None;
            }
            voxel[k] = number as usize;
        }
        Some(voxel)
    }
}
