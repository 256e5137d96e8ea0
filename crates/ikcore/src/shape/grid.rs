//! Occupancy grid whose voxels are merged into blocks.

use std::fmt;

use nalgebra::Vector3;

use super::along_segment::{SegmentDistance, by_tangents};
use super::bounding_tree::{Aabb, BoundingTree};
use super::nearest_piece::{PieceLanes, squared_bound};
use super::segment_lanes::{NearestFraction, TOUCHING, to_box};
use super::tangent::Tangent;
use crate::math::arithmetic::Arithmetic;
use crate::math::f64x4::F64x4;
use crate::math::real::Four;
use crate::math::vec3::Vec3;

/// Occupied voxels of a grid: cubes in rows along x, y and z.
///
/// Neighbouring voxels are merged into blocks as large as possible; penetration depth is measured within a block.
#[derive(Clone)]
pub struct Grid {
    origin: [f64; 3],
    voxel: f64,
    counts: [usize; 3],
    occupied: Vec<bool>,
    blocks: Vec<Aabb>,
    tree: BoundingTree<FourBlocks>,
}

/// Centres and half edges of four blocks, one per lane.
#[derive(Clone)]
struct FourBlocks {
    center: [F64x4; 3],
    half: [F64x4; 3],
}

impl PartialEq for Grid {
    /// Compares the input alone, since it determines all other fields.
    fn eq(&self, other: &Self) -> bool {
        let given = |grid: &Self| (grid.origin, grid.voxel, grid.counts);
        given(self) == given(other) && self.occupied == other.occupied
    }
}

impl fmt::Debug for Grid {
    /// Omits the voxels, which may number thousands.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (counts, blocks) = (self.counts, self.blocks.len());
        write!(f, "Grid {{ origin: {:?}, voxel: {:?}, counts: {counts:?}, {blocks} blocks }}", self.origin, self.voxel)
    }
}

impl Grid {
    /// Builds the grid. `occupied` has an entry per voxel, with z running fastest.
    pub(super) fn new(origin: [f64; 3], voxel: f64, counts: [usize; 3], occupied: Vec<bool>) -> Self {
        let at = |k: usize, i: usize| origin[k] + voxel * i as f64;
        let place = |range: &[[usize; 2]; 3]| Aabb {
            lower: Vector3::from_fn(|k, _| at(k, range[k][0])),
            upper: Vector3::from_fn(|k, _| at(k, range[k][1])),
        };
        let blocks: Vec<Aabb> = joined(counts, &occupied).iter().map(place).collect();
        let tree = BoundingTree::new(&blocks, |lanes| FourBlocks::new(lanes.map(|block| &blocks[block])));
        Self { origin, voxel, counts, occupied, blocks, tree }
    }

    /// Returns the lowest corner of the first voxel (m).
    pub fn origin(&self) -> [f64; 3] {
        self.origin
    }

    /// Returns the edge of a voxel (m).
    pub fn voxel(&self) -> f64 {
        self.voxel
    }

    /// Returns the number of voxels along x, y and z.
    pub fn counts(&self) -> [usize; 3] {
        self.counts
    }

    /// Returns whether each voxel is occupied; z runs fastest.
    pub fn occupied(&self) -> &[bool] {
        &self.occupied
    }

    /// Returns the blocks of voxels.
    pub(super) fn blocks(&self) -> &[Aabb] {
        &self.blocks
    }

    /// Visits all blocks within `reach` (m) of a segment, and possibly others, by their indices; `visit` returns the new
    /// reach.
    pub(super) fn each_near(&self, segment: &[Vector3<f64>; 2], reach: f64, visit: &mut dyn FnMut(usize) -> f64) {
        self.tree.each_near(segment, reach, visit);
    }

    /// Visits the centres of all occupied voxels that meet the box around a segment, enlarged by `reach` (m), with their
    /// indices.
    pub(super) fn each_voxel_near(
        &self,
        [a, b]: &[Vector3<f64>; 2],
        reach: f64,
        visit: &mut dyn FnMut(usize, [f64; 3]),
    ) {
        let [ny, nz] = [self.counts[1], self.counts[2]];
        // One voxel more on each side, because of rounding. Casts saturate.
        let range = |k: usize| {
            let index = |x: f64| ((x - self.origin[k]) / self.voxel).floor();
            let low = (index(a[k].min(b[k]) - reach) - 1.0).max(0.0) as usize;
            low..((index(a[k].max(b[k]) + reach) + 2.0).max(0.0) as usize).min(self.counts[k])
        };
        for x in range(0) {
            for y in range(1) {
                for z in range(2) {
                    let index = (x * ny + y) * nz + z;
                    if self.occupied[index] {
                        let at = [x, y, z];
                        visit(index, std::array::from_fn(|k| self.origin[k] + self.voxel * (at[k] as f64 + 0.5)));
                    }
                }
            }
        }
    }

    /// Returns the signed distance of a point to the nearest block, and its gradient.
    pub(super) fn tangent(&self, point: &Vector3<f64>) -> Tangent {
        let mut deepest: Option<Tangent> = None;
        let nearest = self.tree.nearest(&[*point; 2], f64::INFINITY, &mut |block| {
            let tangent = self.blocks[block].tangent(point);
            if deepest.is_none_or(|deepest| tangent.value < deepest.value) {
                deepest = Some(tangent);
            }
        });
        let of_nearest = |block: usize| self.blocks[block].tangent(point);
        let nothing = Tangent { value: f64::INFINITY, normal: Vector3::x() };
        deepest.or(nearest.index.map(of_nearest)).unwrap_or(nothing)
    }

    /// Returns the signed distance of a segment, exact up to `enough`: inside it is minus the depth of the deepest point in a
    /// block.
    pub(super) fn approach(&self, segment: &[Vector3<f64>; 2], enough: f64) -> SegmentDistance {
        let mut deepest: Option<SegmentDistance> = None;
        let nearest = self.tree.nearest(segment, squared_bound(enough).max(TOUCHING), &mut |block| {
            let inside = by_tangents(segment, |point| self.blocks[block].tangent(point), f64::INFINITY);
            if deepest.is_none_or(|deepest| inside.distance < deepest.distance) {
                deepest = Some(inside);
            }
        });
        deepest.unwrap_or(SegmentDistance { distance: nearest.squared.sqrt(), fraction: nearest.fraction })
    }
}

impl FourBlocks {
    fn new(blocks: [&Aabb; 4]) -> Self {
        let lanes =
            |value: &dyn Fn(&Aabb, usize) -> f64| std::array::from_fn(|k| F64x4(blocks.map(|block| value(block, k))));
        let center = lanes(&|aabb, k| 0.5 * (aabb.lower[k] + aabb.upper[k]));
        Self { center, half: lanes(&|aabb, k| 0.5 * (aabb.upper[k] - aabb.lower[k])) }
    }
}

impl PieceLanes for FourBlocks {
    #[inline(always)]
    fn nearest<A: Arithmetic>(&self, start: &[f64; 3], along: &[f64; 3]) -> NearestFraction<Four<A>> {
        to_box(Vec3::splat(start) - Vec3::of(&self.center), Vec3::splat(along), Vec3::of(&self.half))
    }
}

/// Merges occupied voxels into ranges: each grows along z, then y, then x as long as all its voxels are occupied and unused.
fn joined([nx, ny, nz]: [usize; 3], occupied: &[bool]) -> Vec<[[usize; 2]; 3]> {
    let index = |x: usize, y: usize, z: usize| (x * ny + y) * nz + z;
    let mut free = occupied.to_vec();
    let mut blocks = vec![];
    for x in 0..nx {
        for y in 0..ny {
            for z in 0..nz {
                if !free[index(x, y, z)] {
                    continue;
                }
                let row = |free: &[bool], x: usize, y: usize, end: usize| (z..end).all(|z| free[index(x, y, z)]);
                let z_end = (z..nz).take_while(|z| free[index(x, y, *z)]).count() + z;
                let y_end = (y..ny).take_while(|y| row(&free, x, *y, z_end)).count() + y;
                let slab = |x: &usize| (y..y_end).all(|y| row(&free, *x, y, z_end));
                let x_end = (x..nx).take_while(slab).count() + x;
                for i in x..x_end {
                    for j in y..y_end {
                        free[index(i, j, z)..index(i, j, z_end)].fill(false);
                    }
                }
                blocks.push([[x, x_end], [y, y_end], [z, z_end]]);
            }
        }
    }
    blocks
}

#[cfg(test)]
mod tests {
    use super::super::checked_shape::Shape;
    use super::*;
    use crate::rng::{self, LazyRng};

    fn random_occupancy(rng: &mut LazyRng, counts: [usize; 3], fraction: f64) -> Vec<bool> {
        (0..counts.iter().product()).map(|_| rng.uniform() < fraction).collect()
    }

    #[test]
    fn blocks_hold_the_occupied_voxels_once() {
        let mut rng = rng::stream(1, 0);
        for fraction in [0.05, 0.5, 0.9, 1.0] {
            let counts = [7, 5, 6];
            let occupied = random_occupancy(&mut rng, counts, fraction);
            let mut seen = vec![0; occupied.len()];
            for [x, y, z] in joined(counts, &occupied) {
                for i in x[0]..x[1] {
                    for j in y[0]..y[1] {
                        (z[0]..z[1]).for_each(|k| seen[(i * 5 + j) * 6 + k] += 1);
                    }
                }
            }
            assert!(seen.iter().zip(&occupied).all(|(count, occupied)| *count == i32::from(*occupied)));
            assert!(fraction < 1.0 || joined(counts, &occupied).len() == 1);
        }
    }

    #[test]
    fn a_segment_is_as_far_from_a_grid_as_from_its_nearest_voxel() {
        let mut rng = rng::stream(2, 0);
        let (origin, voxel, counts) = ([-0.5, -0.4, -0.3], 0.1, [10, 8, 6]);
        let occupied = random_occupancy(&mut rng, counts, 0.1);
        let grid = Shape::grid(origin, voxel, counts, occupied.clone()).unwrap();
        let cube = |i: usize| {
            let place = [i / 48, i / 6 % 8, i % 6];
            let center = std::array::from_fn(|k| origin[k] + voxel * (place[k] as f64 + 0.5));
            Shape::cuboid(center, [voxel; 3], None).unwrap()
        };
        let cubes: Vec<Shape> = (0..480).filter(|i| occupied[*i]).map(cube).collect();
        for _ in 0..300 {
            let segment = [(); 2].map(|()| Vector3::from_fn(|_, _| rng.uniform_in(-1.0, 1.0)));
            let exact = cubes.iter().map(|cube| cube.distance_to_segment(&segment, f64::INFINITY));
            let exact = exact.fold(f64::INFINITY, f64::min);
            let found = grid.distance_to_segment(&segment, f64::INFINITY);
            // Blocks may be deeper than their voxels.
            let right = if exact > 0.0 { (found - exact).abs() < 1e-11 } else { found <= exact + 2e-9 };
            assert!(right, "{found} for {exact}");
        }
    }

    #[test]
    fn mistakes_in_a_grid_are_named() {
        let problem = |voxel: f64, count: usize| {
            Shape::grid([0.0; 3], voxel, [2, 1, 1], vec![false; count]).unwrap_err().to_string()
        };
        assert_eq!(problem(0.1, 3), "occupied voxels: expected 2 x 1 x 1 voxels, got 3");
        assert_eq!(problem(0.0, 2), "voxel of the grid must be positive and finite, got 0");
    }
}
