//! Reachability of the voxels of a ring, in two passes: a first look at each orientation, and a second one at those left open.

use super::map_chunk::RingResult;
use super::map_grid::MapGrid;
use super::map_options::MapOptions;
use super::map_test::{MapRobots, MapTest, OrientationResult};
use super::rings::Ring;
use super::second_look::SecondLook;
use crate::error::Result;
use crate::solver::Monitor;

/// Both passes over a ring. Shared by all threads.
pub(crate) struct MapLooks<'a> {
    test: MapTest<'a>,
    /// Second pass; `None` if the first one leaves nothing open.
    second_look: Option<SecondLook<'a>>,
}

impl<'a> MapLooks<'a> {
    /// Checks robot and options for a grid.
    ///
    /// # Errors
    /// Any [`Error`](crate::Error) for wrong options.
    pub fn new(robots: &'a MapRobots, grid: &'a MapGrid, options: &'a MapOptions) -> Result<Self> {
        let test = MapTest::new(robots, grid, options)?;
        let second_look = test.leaves_poses_open().then(|| SecondLook::new(robots, grid)).transpose()?;
        Ok(Self { test, second_look })
    }

    /// Computes the reachability of the voxels of a ring.
    pub fn ring(&self, ring: &Ring, monitor: &mut dyn Monitor) -> RingResult {
        let Self { test, second_look } = self;
        let mut result = test.empty_result(ring);
        if !test.may_reach(ring) {
            return result;
        }
        let count = test.grid.orientations().count();
        let mut all: Vec<OrientationResult> = Vec::with_capacity(count);
        for i in 0..count {
            if !monitor.keep_going() {
                return result;
            }
            all.push(test.first_look(ring, i, &mut result, monitor));
        }
        if let Some(second_look) = second_look {
            second_look.complete(test, ring, &mut all, &mut result, monitor);
        }
        for (i, seen) in all.iter().enumerate() {
            for (voxel, bits) in result.reached.chunks_exact_mut(test.grid.bytes()).enumerate() {
                bits[i / 8] |= ((seen.reached >> voxel & 1) as u8) << (i % 8);
            }
        }
        result
    }
}
