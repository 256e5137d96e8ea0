//! Spatial index that finds the shapes near a ball.

use nalgebra::Vector3;

use super::bounding_tree::{Aabb, BoundingTree};
use super::checked_shape::Shape;

/// Bounding volume hierarchy over the bounding balls of shapes.
#[derive(Debug, Clone)]
pub(crate) struct ShapeIndex {
    tree: BoundingTree<()>,
    /// Unbounded shapes, which are always near.
    unbounded: Vec<usize>,
    /// Index of each bounded shape.
    bounded: Vec<usize>,
}

/// Number of shapes below which a linear scan is as fast.
const FEW: usize = 24;

impl ShapeIndex {
    /// Builds the index; `None` for few shapes.
    pub fn of_many<'a>(shapes: impl Iterator<Item = &'a Shape>) -> Option<Self> {
        let shapes: Vec<&Shape> = shapes.collect();
        let (bounded, unbounded): (Vec<usize>, Vec<usize>) =
            (0..shapes.len()).partition(|i| shapes[*i].bounding_ball().radius.is_finite() && !shapes[*i].is_huge());
        if bounded.len() < FEW {
            return None;
        }
        let around = |i: &usize| {
            let ball = shapes[*i].bounding_ball();
            let (center, reach) = (Vector3::from(ball.center), ball.radius + shapes[*i].rounding(0.0));
            Aabb::around([center.add_scalar(reach), center.add_scalar(-reach)])
        };
        let boxes: Vec<Aabb> = bounded.iter().map(around).collect();
        Some(Self { tree: BoundingTree::new(&boxes, |_| ()), unbounded, bounded })
    }

    /// Visits all shapes within `reach` (m) of `center`, and possibly others.
    pub fn near_ball(&self, center: &Vector3<f64>, reach: f64, mut visit: impl FnMut(usize)) {
        self.unbounded.iter().for_each(|i| visit(*i));
        self.tree.each_near(&[*center; 2], reach, &mut |i| {
            visit(self.bounded[i]);
            reach
        });
    }
}
