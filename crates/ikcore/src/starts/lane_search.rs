//! Nearest neighbours by a scan of some blocks of entries, eight entries at a time.

#[cfg(target_arch = "x86_64")]
use crate::math::arithmetic::has_fused;

/// Entries compared side by side, and neighbours that a search finds.
pub(crate) const LANES: usize = 8;

/// One number of eight entries.
pub(crate) type Row = [f32; LANES];

/// How far the eight entries of a block are from what is searched for. A trait where a closure would do: only a method
/// can be told to be compiled into its caller, and so with its caller's instructions.
pub(crate) trait Distance {
    /// The distances, or anything that grows with them, lane by lane.
    fn of(&self, block: &[Row]) -> Row;
}

/// The nearest entry of each lane in `blocks`, the nearest of all first. `rows` holds blocks of `width` rows; entry
/// `LANES * b + i` is lane i of block b.
///
/// Only the first is sure to be among the eight nearest; the others are the nearest of an eighth of the entries each. To
/// start from they are as good, and no order has to be kept during the scan.
pub(crate) fn nearest_by_lane(
    rows: &[Row],
    width: usize,
    blocks: impl Iterator<Item = usize>,
    distance: &impl Distance,
) -> [usize; LANES] {
    let (distances, blocks) = scan(rows, width, blocks, distance);
    let mut sorted = [0; LANES];
    for lane in 0..LANES {
        // Sorted by counting, without a branch: of equals the first comes first.
        let nearer = |other: &usize| distances[*other] < distances[lane];
        let first = (0..lane).filter(|other| nearer(other) || distances[*other] == distances[lane]).count();
        let place = first + (lane + 1..LANES).filter(nearer).count();
        sorted[place] = blocks[lane] as usize * LANES + lane;
    }
    sorted
}

/// For each lane the smallest distance, and the first block that has it.
fn scan(
    rows: &[Row],
    width: usize,
    blocks: impl Iterator<Item = usize>,
    distance: &impl Distance,
) -> (Row, [u32; LANES]) {
    #[cfg(target_arch = "x86_64")]
    if has_fused() {
        // SAFETY: the instructions were found.
        return unsafe { scan_avx2(rows, width, blocks, distance) };
    }
    scan_body(rows, width, blocks, distance)
}

/// [`scan_body`] with registers as wide as a row; the same bits.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn scan_avx2(
    rows: &[Row],
    width: usize,
    blocks: impl Iterator<Item = usize>,
    distance: &impl Distance,
) -> (Row, [u32; LANES]) {
    scan_body(rows, width, blocks, distance)
}

#[inline(always)]
fn scan_body(
    rows: &[Row],
    width: usize,
    blocks: impl Iterator<Item = usize>,
    distance: &impl Distance,
) -> (Row, [u32; LANES]) {
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
