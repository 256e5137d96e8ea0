//! Nearest-neighbour scan over blocks of entries, eight entries at once.

use super::arithmetic::by_instructions;

/// Number of entries compared at once, and of neighbours returned by a search.
pub(crate) const LANES: usize = 8;

/// Values of one feature for eight entries.
pub(crate) type LaneRow = [f32; LANES];

/// Distance of the eight entries of a block from a query. A trait instead of a closure, since only a method can be
/// `#[inline(always)]` and so be compiled with the instructions of its caller.
pub(crate) trait Distance {
    /// Returns the distances, or a monotonic function of them, lane by lane.
    fn of(&self, block: &[LaneRow]) -> LaneRow;
}

/// Returns the nearest entry of each lane in `blocks`, nearest first. `rows` holds blocks of `width` rows; entry `LANES * b +
/// i` is lane i of block b.
///
/// Only the first result is certain to be among the eight nearest entries; each further one is the nearest of one eighth of
/// the entries. These are equally good as starts, and the scan needs no sorting.
pub(crate) fn nearest_by_lane(
    rows: &[LaneRow],
    width: usize,
    blocks: impl Iterator<Item = usize>,
    distance: &impl Distance,
) -> [usize; LANES] {
    let (distances, blocks) = scan(rows, width, blocks, distance);
    let mut sorted = [0; LANES];
    for lane in 0..LANES {
        // Branch-free counting sort; equal distances keep their order.
        let nearer = |other: &usize| distances[*other] < distances[lane];
        let first = (0..lane).filter(|other| nearer(other) || distances[*other] == distances[lane]).count();
        let place = first + (lane + 1..LANES).filter(nearer).count();
        sorted[place] = blocks[lane] as usize * LANES + lane;
    }
    sorted
}

by_instructions! {
    /// Returns for each lane the smallest distance and the first block that has it; bit-identical on all machines.
    fn scan(
        rows: &[LaneRow],
        width: usize,
        blocks: impl Iterator<Item = usize>,
        distance: &impl Distance,
    ) -> (LaneRow, [u32; LANES]) {
        let (mut nearest, mut found) = ([f32::INFINITY; LANES], [0; LANES]);
        for block in blocks {
            let distances = distance.of(&rows[block * width..(block + 1) * width]);
            let number = block as u32;
            for lane in 0..LANES {
                let nearer = distances[lane] < nearest[lane];
                nearest[lane] = if nearer { distances[lane] } else { nearest[lane] };
                found[lane] = if nearer { number } else { found[lane] };
            }
        }
        (nearest, found)
    }
}
