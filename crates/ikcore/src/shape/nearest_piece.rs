//! Search for the piece of a shape nearest to a segment, among thousands.

use nalgebra::Vector3;

use super::bounding_tree::{BoundingTree, SegmentQuery};
use super::segment_lanes::{NearestFraction, TOUCHING};
use crate::math::arithmetic::{Arithmetic, by_instructions};
use crate::math::real::{Four, Real};

/// Four pieces of a shape, one per SIMD lane.
pub(super) trait PieceLanes {
    /// Finds the point of the segment from `start` along `along` nearest to each piece.
    fn nearest<A: Arithmetic>(&self, start: &[f64; 3], along: &[f64; 3]) -> NearestFraction<Four<A>>;
}

/// Piece nearest to a segment.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearestPiece {
    /// Squared distance (m^2).
    pub squared: f64,
    /// Fraction of the segment's length.
    pub fraction: f64,
    /// Index of the piece; `None` if none is within the bound.
    pub index: Option<usize>,
}

/// Returns the squared search radius for pieces nearer than `enough` (m), rounded up so that its root is at least `enough`.
pub(super) fn squared_bound(enough: f64) -> f64 {
    let enough = enough.max(0.0) * (1.0 + 4.0 * f64::EPSILON);
    enough * enough
}

impl<L> BoundingTree<L> {
    /// Visits all pieces in boxes within `reach` (m) of a segment, and possibly others; `visit` returns the new reach.
    pub fn each_near(&self, segment: &[Vector3<f64>; 2], reach: f64, visit: &mut dyn FnMut(usize) -> f64) {
        each_near(self, segment, reach, visit);
    }
}

impl<L: PieceLanes> BoundingTree<L> {
    /// Finds the piece nearest to a segment within the square root of `bound`; calls `touching` with the pieces that the
    /// segment touches.
    pub fn nearest(&self, segment: &[Vector3<f64>; 2], bound: f64, touching: &mut dyn FnMut(usize)) -> NearestPiece {
        nearest(self, segment, bound, touching)
    }
}

by_instructions! {
    fn each_near<L>(
        tree: &BoundingTree<L>,
        segment: &[Vector3<f64>; 2],
        reach: f64,
        visit: &mut dyn FnMut(usize) -> f64,
    ) {
        tree.search::<A>(&SegmentQuery::new(segment), squared_bound(reach), |leaf, bound| {
            leaf.pieces().fold(bound, |_, piece| squared_bound(visit(piece)))
        });
    }
}

by_instructions! {
    fn nearest<L: PieceLanes>(
        tree: &BoundingTree<L>,
        segment: &[Vector3<f64>; 2],
        bound: f64,
        touching: &mut dyn FnMut(usize),
    ) -> NearestPiece {
        let [start, along] = [segment[0].into(), (segment[1] - segment[0]).into()];
        let mut best = NearestPiece { squared: bound, fraction: 0.0, index: None };
        tree.search::<A>(&SegmentQuery::new(segment), bound, |leaf, bound| {
            let nearest = leaf.lanes.nearest::<A>(&start, &along);
            let squared = nearest.squared.stored().0;
            for lane in 0..4 {
                let Some(index) = leaf.piece(lane) else { continue };
                if squared[lane] <= TOUCHING {
                    touching(index);
                }
                if squared[lane] < best.squared || (squared[lane] <= bound && best.index.is_none()) {
                    best = NearestPiece { squared: squared[lane], fraction: nearest.fraction.lane(lane), index: Some(index) };
                }
            }
            best.squared
        });
        best
    }
}
