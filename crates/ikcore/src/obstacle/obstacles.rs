//! Obstacles, prepared once for any number of calls and robots.

use std::ops::Deref;
use std::sync::Arc;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::shape::{BoundingBall, Shape, ShapeIndex};

/// What the distance of two balls may lose to rounding (m).
const BALL_ROUNDING: f64 = 1e-9;

/// What it may lose relative to the coordinates and radius of one.
const BALL_ROUNDING_RELATIVE: f64 = 1e-12;

/// Shapes to keep clear of, with a ball around each and, where there are many, a tree to find the near ones. Clones share all of it.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(from = "Vec<Shape>", into = "Vec<Shape>")]
pub struct Obstacles(Arc<Prepared>);

#[derive(Debug)]
struct Prepared {
    shapes: Vec<Shape>,
    /// Centre and radius, infinite for a half-space and for what is too large for squares.
    balls: Vec<(Vector3<f64>, f64)>,
    index: Option<ShapeIndex>,
    /// Those that some links may touch.
    touched: Vec<usize>,
    first_flat: Option<usize>,
    first_open_mesh: Option<usize>,
}

impl Obstacles {
    /// Centre and radius (m) of a ball around an obstacle.
    pub(super) fn ball(&self, obstacle: usize) -> (Vector3<f64>, f64) {
        self.0.balls[obstacle]
    }

    /// Finds the obstacles near a ball, if there are many.
    pub(super) fn index(&self) -> Option<&ShapeIndex> {
        self.0.index.as_ref()
    }

    /// Calls `visit` with each obstacle that may be within `radius` (m) of `center`, and some others.
    pub(super) fn each_near(&self, center: &Vector3<f64>, radius: f64, mut visit: impl FnMut(usize)) {
        match &self.0.index {
            Some(index) => index.near_ball(center, radius, visit),
            None => {
                for (obstacle, (middle, own)) in self.0.balls.iter().enumerate() {
                    // What is not a number is near.
                    if !((middle - center).norm() > radius + own + BALL_ROUNDING) {
                        visit(obstacle);
                    }
                }
            }
        }
    }

    /// Those that some links may touch ([`Shape::touch`]).
    pub(super) fn touched(&self) -> &[usize] {
        &self.0.touched
    }

    /// The first that lies in the plane z = 0.
    pub(super) fn first_flat(&self) -> Option<usize> {
        self.0.first_flat
    }

    /// The first that is a mesh which is not closed.
    pub(super) fn first_open_mesh(&self) -> Option<usize> {
        self.0.first_open_mesh
    }
}

impl From<Vec<Shape>> for Obstacles {
    fn from(shapes: Vec<Shape>) -> Self {
        let ball = |shape: &Shape| {
            let BoundingBall { center, radius } = shape.bounding_ball();
            let center = Vector3::from(center);
            let radius = if shape.is_huge() { f64::INFINITY } else { radius };
            (center, radius + BALL_ROUNDING_RELATIVE * (radius + center.amax()))
        };
        Self(Arc::new(Prepared {
            balls: shapes.iter().map(ball).collect(),
            index: ShapeIndex::of_many(&shapes),
            touched: (0..shapes.len()).filter(|i| !shapes[*i].touch().is_empty()).collect(),
            first_flat: shapes.iter().position(Shape::is_flat),
            first_open_mesh: shapes.iter().position(Shape::is_open_mesh),
            shapes,
        }))
    }
}

impl From<&[Shape]> for Obstacles {
    fn from(shapes: &[Shape]) -> Self {
        shapes.to_vec().into()
    }
}

impl<const N: usize> From<&[Shape; N]> for Obstacles {
    fn from(shapes: &[Shape; N]) -> Self {
        shapes.to_vec().into()
    }
}

impl From<&Vec<Shape>> for Obstacles {
    fn from(shapes: &Vec<Shape>) -> Self {
        shapes.clone().into()
    }
}

impl From<&Obstacles> for Obstacles {
    fn from(obstacles: &Obstacles) -> Self {
        obstacles.clone()
    }
}

impl From<Obstacles> for Vec<Shape> {
    fn from(obstacles: Obstacles) -> Self {
        obstacles.to_vec()
    }
}

impl FromIterator<Shape> for Obstacles {
    fn from_iter<I: IntoIterator<Item = Shape>>(shapes: I) -> Self {
        Vec::from_iter(shapes).into()
    }
}

impl Default for Obstacles {
    fn default() -> Self {
        Vec::new().into()
    }
}

impl PartialEq for Obstacles {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0.shapes == other.0.shapes
    }
}

impl Deref for Obstacles {
    type Target = [Shape];

    #[inline]
    fn deref(&self) -> &[Shape] {
        &self.0.shapes
    }
}
