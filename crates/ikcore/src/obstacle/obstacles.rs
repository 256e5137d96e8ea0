//! Obstacles: shapes and the links that may touch them, prepared once for any number of calls and robots.

use std::ops::Deref;
use std::sync::Arc;

use nalgebra::Vector3;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::bodies::CarriedBody;
use crate::shape::{BoundingBall, Shape, ShapeIndex};

/// Absolute rounding of the distance of two balls (m).
const BALL_ROUNDING: f64 = 1e-9;

/// Rounding of this distance, relative to coordinates and radius of one.
const BALL_ROUNDING_RELATIVE: f64 = 1e-12;

/// A shape to keep clear of, and the links that may touch it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(from = "(Shape, Vec<String>)", into = "(Shape, Vec<String>)")]
pub struct Obstacle {
    /// The shape, in the frame of the robot's base.
    pub shape: Shape,
    /// Sorted names; `None`: no link.
    touch: Option<Arc<[String]>>,
}

/// Obstacles with a bounding ball each and, where there are many, a tree to find the near ones. Clones share all of it.
#[derive(Debug, Clone)]
pub struct Obstacles(Arc<Prepared>);

#[derive(Debug)]
struct Prepared {
    list: Vec<Obstacle>,
    /// Centre and radius, infinite for a half-space and for what is too large for squares.
    balls: Vec<(Vector3<f64>, f64)>,
    index: Option<ShapeIndex>,
    first_flat: Option<usize>,
    first_open_mesh: Option<usize>,
    /// Bodies that the robot must carry, each with its link and its name.
    carried: Vec<[String; 2]>,
}

impl Obstacle {
    /// An obstacle that the links of these names may touch.
    pub fn new(shape: Shape, mut touch: Vec<String>) -> Self {
        touch.sort_unstable();
        touch.dedup();
        Self { shape, touch: (!touch.is_empty()).then(|| touch.into()) }
    }

    /// Names of the links that may touch it, sorted.
    pub fn touch(&self) -> &[String] {
        self.touch.as_deref().unwrap_or_default()
    }
}

impl Obstacle {
    /// The obstacle with another shape, and the same links that may touch it.
    pub(super) fn reshaped(&self, shape: Shape) -> Self {
        Self { shape, touch: self.touch.clone() }
    }
}

impl From<(Shape, Vec<String>)> for Obstacle {
    fn from((shape, touch): (Shape, Vec<String>)) -> Self {
        Self::new(shape, touch)
    }
}

impl From<Obstacle> for (Shape, Vec<String>) {
    fn from(Obstacle { shape, touch }: Obstacle) -> Self {
        (shape, touch.as_deref().unwrap_or_default().to_vec())
    }
}

impl From<Shape> for Obstacle {
    fn from(shape: Shape) -> Self {
        Self { shape, touch: None }
    }
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
                    // A distance that is not a number counts as near.
                    if !((middle - center).norm() > radius + own + BALL_ROUNDING) {
                        visit(obstacle);
                    }
                }
            }
        }
    }

    /// The first body, by link and name, that the robot must carry and that is not among `bodies`.
    pub(super) fn first_not_carried(&self, bodies: &[CarriedBody]) -> Option<&[String; 2]> {
        self.0.carried.iter().find(|[_, name]| bodies.iter().all(|body| body.link != *name))
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

impl<T: Into<Obstacle>> FromIterator<T> for Obstacles {
    fn from_iter<I: IntoIterator<Item = T>>(obstacles: I) -> Self {
        Self::beside_carried(obstacles.into_iter().map(Into::into).collect(), vec![])
    }
}

impl Obstacles {
    /// Obstacles of a scene whose robot carries bodies, each given by its link and its name.
    pub fn beside_carried(list: Vec<Obstacle>, carried: Vec<[String; 2]>) -> Self {
        let ball = |Obstacle { shape, .. }: &Obstacle| {
            let BoundingBall { center, radius } = shape.bounding_ball();
            let center = Vector3::from(center);
            let radius = if shape.is_huge() { f64::INFINITY } else { radius };
            (center, radius + BALL_ROUNDING_RELATIVE * (radius + center.amax()))
        };
        let first = |is_so: fn(&Shape) -> bool| list.iter().position(|obstacle| is_so(&obstacle.shape));
        Self(Arc::new(Prepared {
            balls: list.iter().map(ball).collect(),
            index: ShapeIndex::of_many(list.iter().map(|obstacle| &obstacle.shape)),
            first_flat: first(Shape::is_flat),
            first_open_mesh: first(Shape::is_open_mesh),
            list,
            carried,
        }))
    }
}

impl From<Vec<Shape>> for Obstacles {
    fn from(shapes: Vec<Shape>) -> Self {
        shapes.into_iter().collect()
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

impl Serialize for Obstacles {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.list.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Obstacles {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Vec::<Obstacle>::deserialize(deserializer).map(Self::from_iter)
    }
}

impl Default for Obstacles {
    fn default() -> Self {
        Self::from(vec![])
    }
}

impl PartialEq for Obstacles {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0.list == other.0.list
    }
}

impl Deref for Obstacles {
    type Target = [Obstacle];

    #[inline]
    fn deref(&self) -> &[Obstacle] {
        &self.0.list
    }
}
