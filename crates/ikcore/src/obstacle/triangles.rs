//! Surfaces as triangles, for drawing.

use std::f64::consts::{PI, TAU};

use nalgebra::{Point3, Rotation3, Vector3};

use super::shape::{Obstacle, Shape};
use crate::math::Pose;

/// A triangle's corners (m).
pub(super) type Triangle = [[f64; 3]; 3];

/// Number of steps around a round shape; half as many from pole to pole.
const STEPS: usize = 24;

impl Obstacle {
    /// Triangles of the surface (m): exact for flat faces, else with corners on the surface.
    pub fn triangles(&self) -> Vec<Triangle> {
        match self.shape() {
            Shape::Sphere { center, radius } => ball(|u| (Vector3::from(*center) + *radius * u).into()),
            Shape::Capsule { a, b, radius } => {
                let (a, b) = (Vector3::from(*a), Vector3::from(*b));
                let turn = Rotation3::rotation_between(&Vector3::z(), &(b - a)).unwrap_or_else(Rotation3::identity);
                ball(|u| (if u.z > 0.0 { b } else { a } + *radius * (turn * u)).into())
            }
            Shape::Ellipsoid { pose, semi_axes } => ball(|u| placed(pose, u.component_mul(&Vector3::from(*semi_axes)))),
            Shape::Box { pose, size } => cuboid(pose, &(0.5 * Vector3::from(*size))),
            Shape::Ellipse { center, semi_axes, angle } => {
                let rim = |i: usize| {
                    let (sine, cosine) = (TAU * i as f64 / STEPS as f64).sin_cos();
                    let (x, y) = (semi_axes[0] * cosine, semi_axes[1] * sine);
                    let (s, c) = angle.sin_cos();
                    [center[0] + c * x - s * y, center[1] + s * x + c * y, 0.0]
                };
                (0..STEPS).map(|i| [[center[0], center[1], 0.0], rim(i), rim(i + 1)]).collect()
            }
            #[cfg(feature = "convex-mesh")]
            Shape::ConvexMesh(hull) => hull.triangles(),
        }
    }
}

fn placed(pose: &Pose, local: Vector3<f64>) -> [f64; 3] {
    (pose * Point3::from(local)).coords.into()
}

/// Meridians and parallels of the unit sphere, each point moved by `place`.
fn ball(place: impl Fn(Vector3<f64>) -> [f64; 3]) -> Vec<Triangle> {
    let rows = STEPS / 2 + 1; // odd, so that no corner lies on the equator, where a capsule is cut
    let corner = |row: usize, step: usize| {
        let (polar_sine, polar_cosine) = (PI * row as f64 / rows as f64).sin_cos();
        let (sine, cosine) = (TAU * step as f64 / STEPS as f64).sin_cos();
        place(Vector3::new(polar_sine * cosine, polar_sine * sine, polar_cosine))
    };
    let cells = (0..rows).flat_map(|row| (0..STEPS).map(move |step| (row, step)));
    let halves = cells.flat_map(|(row, step)| {
        let [a, b, c, d] = [corner(row, step), corner(row + 1, step), corner(row + 1, step + 1), corner(row, step + 1)];
        [[a, b, c], [a, c, d]]
    });
    halves.collect()
}

fn cuboid(pose: &Pose, half: &Vector3<f64>) -> Vec<Triangle> {
    let faces = (0..3).flat_map(|axis| [-1.0, 1.0].map(|side| (axis, side)));
    let halves = faces.flat_map(|(axis, side)| {
        let corner = |first: f64, second: f64| {
            let mut local = Vector3::zeros();
            local[axis] = side * half[axis];
            local[(axis + 1) % 3] = first * half[(axis + 1) % 3];
            local[(axis + 2) % 3] = second * half[(axis + 2) % 3];
            placed(pose, local)
        };
        let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        [[a, b, c], [a, c, d]]
    });
    halves.collect()
}
