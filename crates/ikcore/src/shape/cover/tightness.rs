//! Tightness of a cover: its excess volume, and its distance from the mesh.

use std::f64::consts::PI;

use nalgebra::Vector3;

use crate::rng;
use crate::shape::bounding_tree::Aabb;
use crate::shape::checked_shape::Shape;
use crate::shape::geometry::Geometry;
use crate::shape::mesh::Mesh;
use crate::shape::signed_distance::at_right_angles;

/// Number of random points for the volume of the cover.
const DRAWS: usize = 20_000;
/// Absolute accuracy of the largest distance (m).
const ACCURACY: f64 = 2e-4;
/// Accuracy of the largest distance, relative to it.
const RELATIVE_ACCURACY: f64 = 0.05;
/// Accuracy of the largest distance, relative to the meridian of a capsule: it bounds the number of cells of a needle.
const FINEST: f64 = 2.5e-4;

/// Estimates the volume of the union (m^3), to about 1 %.
pub(super) fn volume(shapes: &[Shape]) -> f64 {
    let corners = shapes.iter().flat_map(|shape| {
        let ball = shape.bounding_ball();
        [1.0, -1.0].map(|side| Vector3::from(ball.center).add_scalar(side * ball.radius))
    });
    let Aabb { lower, upper } = Aabb::around(corners);
    let mut rng = rng::stream(0, 0);
    let inside = (0..DRAWS).filter(|_| {
        let point = Vector3::from_fn(|k, _| rng.uniform_in(lower[k], upper[k]));
        shapes.iter().any(|shape| shape.geometry().tangent(&point).value <= 0.0)
    });
    (upper - lower).product() * inside.count() as f64 / DRAWS as f64
}

/// Bounds the distance from the mesh of all points on the surface of the cover.
pub(super) fn largest_distance(mesh: &Mesh, shapes: &[Shape]) -> f64 {
    let surfaces: Vec<(usize, Surface)> =
        shapes.iter().enumerate().filter_map(|(i, shape)| Some((i, Surface::of(shape)?))).collect();
    // Points deep inside another capsule are not on the surface of the cover.
    let depth = |own: usize, point: &Vector3<f64>| {
        let others = shapes.iter().enumerate().filter(|(i, _)| *i != own);
        others.map(|(_, other)| other.geometry().tangent(point).value).fold(f64::INFINITY, f64::min)
    };
    let mut seen = 0.0_f64;
    let mut pending = vec![];
    for (own, surface) in &surfaces {
        for cell in surface.cells() {
            let (point, _) = surface.middle(&cell);
            if depth(*own, &point) > 0.0 {
                seen = seen.max(mesh.tangent(&point).value);
            }
            pending.push((*own, surface, cell));
        }
    }
    let mut proven = 0.0_f64;
    while let Some((own, surface, cell)) = pending.pop() {
        let (point, reach) = surface.middle(&cell);
        let depth = depth(own, &point);
        if depth < -reach {
            continue;
        }
        let distance = mesh.tangent(&point).value;
        if depth > 0.0 {
            seen = seen.max(distance);
        }
        if distance + reach <= seen.max(proven) {
            continue;
        }
        let enough = ACCURACY.max(RELATIVE_ACCURACY * seen).max(FINEST * surface.meridian());
        // NaN where squares of coordinates are infinite.
        if !(reach > enough) {
            proven = proven.max(distance + reach);
        } else {
            pending.extend(cell.quarters().map(|quarter| (own, surface, quarter)));
        }
    }
    seen.max(proven)
}

/// Surface of a capsule, with coordinates: the way from one pole along a meridian (m), and the angle about the axis (rad).
struct Surface {
    pole: Vector3<f64>,
    axes: [Vector3<f64>; 3],
    radius: f64,
    length: f64,
}

/// Cell of the surface: ranges of way and angle.
#[derive(Clone, Copy)]
struct Cell {
    way: [f64; 2],
    turn: [f64; 2],
}

impl Cell {
    fn quarters(&self) -> [Self; 4] {
        let middle = |range: [f64; 2]| 0.5 * (range[0] + range[1]);
        let (way, turn) = (middle(self.way), middle(self.turn));
        let ([first, last], [from, to]) = (self.way, self.turn);
        [
            ([first, way], [from, turn]),
            ([way, last], [from, turn]),
            ([first, way], [turn, to]),
            ([way, last], [turn, to]),
        ]
        .map(|(way, turn)| Self { way, turn })
    }
}

impl Surface {
    /// Returns the length of a meridian from pole to pole (m).
    fn meridian(&self) -> f64 {
        PI * self.radius + self.length
    }

    fn of(shape: &Shape) -> Option<Self> {
        let (a, b, radius) = match shape.geometry() {
            Geometry::Capsule { a, b, radius } => (Vector3::from(*a), Vector3::from(*b), *radius),
            Geometry::Sphere { center, radius } => (Vector3::from(*center), Vector3::from(*center), *radius),
            _ => return None,
        };
        let axis = (b - a).try_normalize(0.0).unwrap_or(Vector3::z());
        let first = at_right_angles(&axis);
        Some(Self { pole: a, axes: [first, axis.cross(&first), axis], radius, length: (b - a).norm() })
    }

    /// Returns cells that make up the whole surface.
    fn cells(&self) -> Vec<Cell> {
        let whole = self.meridian();
        let fraction = |i: usize, all: f64| [i as f64 / 8.0 * all, (i + 1) as f64 / 8.0 * all];
        (0..64).map(|i| Cell { way: fraction(i / 8, whole), turn: fraction(i % 8, 2.0 * PI) }).collect()
    }

    /// Returns the middle of a cell, and the largest distance to any other point of the cell (m).
    fn middle(&self, cell: &Cell) -> (Vector3<f64>, f64) {
        let (way, turn) = (0.5 * (cell.way[0] + cell.way[1]), 0.5 * (cell.turn[0] + cell.turn[1]));
        let quarter = 0.5 * PI * self.radius;
        // First cap, side, or second cap.
        let (height, polar) = match way {
            _ if way < quarter => (0.0, way / self.radius),
            _ if way < quarter + self.length => (way - quarter, 0.5 * PI),
            _ => (self.length, (way - self.length) / self.radius),
        };
        let [first, second, axis] = self.axes;
        let outward = polar.sin() * (turn.cos() * first + turn.sin() * second) - polar.cos() * axis;
        let reach = 0.5 * (cell.way[1] - cell.way[0]) + 0.5 * self.radius * (cell.turn[1] - cell.turn[0]);
        (self.pole + height * axis + self.radius * outward, reach)
    }
}
