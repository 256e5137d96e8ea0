//! Chunks of a reachability map.

use rayon::prelude::*;

use super::{pool, workers};
use crate::error::{Error, Result};
use crate::map::{MapChunk, MapGrid, MapLooks, MapOptions, MapRobots, rings_of};
use crate::robot::Robot;
use crate::solver::Monitor;

/// Computes the `chunks` of a map, one after another, each on all `threads` (`None` means one per core). The bits of a chunk
/// depend neither on the other chunks nor on the number of threads.
///
/// The monitor is called only from the calling thread; its progress counts voxels.
///
/// # Errors
/// Any [`Error`] for wrong input; [`Error::Interrupted`] if the monitor stops it.
pub fn map_chunks(
    robot: &Robot,
    grid: &MapGrid,
    chunks: &[usize],
    options: &MapOptions,
    threads: Option<usize>,
    monitor: &mut dyn Monitor,
) -> Result<Vec<MapChunk>> {
    let pool = pool::pool(pool::thread_count(threads)?)?;
    let ranges = chunks.iter().map(|chunk| grid.voxels().chunk(*chunk)).collect::<Result<Vec<_>>>()?;
    let size = |ranges: &[[usize; 2]; 3]| ranges.iter().map(|[start, end]| end - start).product::<usize>();
    let robots = MapRobots::new(robot, grid, options)?;
    let looks = MapLooks::new(&robots, grid, options)?;
    let mut computed = Vec::with_capacity(chunks.len());
    workers::run_on(&pool, ranges.iter().map(size).sum(), monitor, |shared| {
        for ranges in &ranges {
            let rings = rings_of(grid, *ranges);
            let results = rings.par_iter().with_max_len(1).map(|ring| {
                let result = looks.ring(ring, &mut shared.monitor());
                shared.count(ring.voxels.len());
                result
            });
            let results: Vec<_> = results.collect();
            if !shared.monitor().keep_going() {
                return;
            }
            computed.push(MapChunk::collected(grid, *ranges, &rings, &results));
        }
    });
    if computed.len() == chunks.len() { Ok(computed) } else { Err(Error::Interrupted) }
}
