//! Surfaces as triangles, for drawing.

use std::f64::consts::{PI, TAU};

use nalgebra::{Point3, Rotation3, Vector3};

use super::bounding_tree::Aabb;
use super::checked_shape::Shape;
use super::geometry::Geometry;
use super::signed_distance::at_right_angles;
use crate::math::Pose;

/// Corners of a triangle (m).
pub(super) type Triangle = [[f64; 3]; 3];

/// Edge of the square drawn for a half-space (m).
const SQUARE: f64 = 4.0;
/// Largest number of points of a cloud that are drawn.
const MOST_POINTS: usize = 2000;
/// Number of steps around a round shape; half as many from pole to pole.
const STEPS: usize = 24;

impl Shape {
    /// Returns triangles of the surface (m): exact for flat faces, else with corners on the surface. A half-space is drawn as
    /// a square, a point cloud as octahedra about at most 2,000 of its points, a grid as its blocks.
    pub fn triangles(&self) -> Vec<Triangle> {
        match self.geometry() {
            Geometry::Sphere { center, radius } => ball(|u| (Vector3::from(*center) + *radius * u).into()),
            Geometry::Capsule { a, b, radius } => {
                let (a, b) = (Vector3::from(*a), Vector3::from(*b));
                let turn = Rotation3::rotation_between(&Vector3::z(), &(b - a)).unwrap_or_else(Rotation3::identity);
                ball(|u| (if u.z > 0.0 { b } else { a } + *radius * (turn * u)).into())
            }
            Geometry::Ellipsoid { pose, semi_axes } => {
                ball(|u| placed(pose, u.component_mul(&Vector3::from(*semi_axes))))
            }
            Geometry::Box { pose, size } => cuboid(pose, &(0.5 * Vector3::from(*size))),
            Geometry::Ellipse { center, semi_axes, angle } => {
                let rim = |i: usize| {
                    let (sine, cosine) = (TAU * i as f64 / STEPS as f64).sin_cos();
                    let (x, y) = (semi_axes[0] * cosine, semi_axes[1] * sine);
                    let (s, c) = angle.sin_cos();
                    [center[0] + c * x - s * y, center[1] + s * x + c * y, 0.0]
                };
                (0..STEPS).map(|i| [[center[0], center[1], 0.0], rim(i), rim(i + 1)]).collect()
            }
            Geometry::Cylinder { center, axis, radius, length } => {
                cylinder(&Vector3::from(*center), &Vector3::from(*axis), *radius, 0.5 * length)
            }
            Geometry::HalfSpace { normal, offset } => square(&Vector3::from(*normal), *offset),
            Geometry::ConvexMesh(hull) => hull.triangles(),
            Geometry::Mesh(mesh) => {
                let corners = |i: usize| mesh.triangle(i).map(<[f64; 3]>::from);
                (0..mesh.faces().len()).map(corners).collect()
            }
            Geometry::PointCloud(cloud) => {
                let step = cloud.points().len().div_ceil(MOST_POINTS).max(1);
                cloud.points().iter().step_by(step).flat_map(|p| octahedron(p, cloud.radius())).collect()
            }
            Geometry::Grid(grid) => grid.blocks().iter().flat_map(of_block).collect(),
        }
    }
}

fn placed(pose: &Pose, local: Vector3<f64>) -> [f64; 3] {
    (pose * Point3::from(local)).coords.into()
}

/// Returns the unit sphere in meridians and parallels, with each point mapped by `place`.
fn ball(place: impl Fn(Vector3<f64>) -> [f64; 3]) -> Vec<Triangle> {
    let rows = STEPS / 2 + 1; // odd, so that no corner lies on the equator, where a capsule is cut
    let corner = |row: usize, step: usize| {
        // Shared corners are equal to the bit, so that the surface is closed.
        let (polar_sine, polar_cosine) = (PI * row as f64 / rows as f64).sin_cos();
        let polar_sine = if row == rows { 0.0 } else { polar_sine };
        let (sine, cosine) = (TAU * (step % STEPS) as f64 / STEPS as f64).sin_cos();
        place(Vector3::new(polar_sine * cosine, polar_sine * sine, polar_cosine))
    };
    let cells = (0..rows).flat_map(|row| (0..STEPS).map(move |step| (row, step)));
    let halves = cells.flat_map(|(row, step)| {
        let [a, b, c, d] = [corner(row, step), corner(row + 1, step), corner(row + 1, step + 1), corner(row, step + 1)];
        [[a, b, c], [a, c, d]]
    });
    // Corners coincide at the poles.
    halves.filter(|[a, b, c]| a != b && b != c && c != a).collect()
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
        let [a, b, c, d] = [corner(-1.0, -side), corner(1.0, -side), corner(1.0, side), corner(-1.0, side)];
        [[a, b, c], [a, c, d]]
    });
    halves.collect()
}

fn cylinder(center: &Vector3<f64>, axis: &Vector3<f64>, radius: f64, half: f64) -> Vec<Triangle> {
    let first = at_right_angles(axis);
    let second = axis.cross(&first);
    let rim = |step: usize, height: f64| {
        let (sine, cosine) = (TAU * (step % STEPS) as f64 / STEPS as f64).sin_cos();
        (center + height * axis + radius * (cosine * first + sine * second)).into()
    };
    let middle = |height: f64| (center + height * axis).into();
    let slices = (0..STEPS).flat_map(|step| {
        let [a, b, c, d] = [rim(step, -half), rim(step + 1, -half), rim(step + 1, half), rim(step, half)];
        [[a, b, c], [a, c, d], [b, a, middle(-half)], [d, c, middle(half)]]
    });
    slices.collect()
}

fn square(normal: &Vector3<f64>, offset: f64) -> Vec<Triangle> {
    let (middle, first) = (offset * normal, at_right_angles(normal));
    let second = normal.cross(&first);
    let corner = |u: f64, v: f64| (middle + 0.5 * SQUARE * (u * first + v * second)).into();
    let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    vec![[a, b, c], [a, c, d]]
}

fn octahedron(center: &[f64; 3], radius: f64) -> Vec<Triangle> {
    let corner = |k: usize, sign: f64| std::array::from_fn(|i| center[i] + if i == k { sign * radius } else { 0.0 });
    let eighths = (0..8).map(|bits: u32| {
        let sign = |k: u32| if bits >> k & 1 == 0 { 1.0 } else { -1.0 };
        [corner(0, sign(0)), corner(1, sign(1)), corner(2, sign(2))]
    });
    eighths.collect()
}

fn of_block(block: &Aabb) -> Vec<Triangle> {
    let pose = Pose::translation(
        0.5 * (block.lower.x + block.upper.x),
        0.5 * (block.lower.y + block.upper.y),
        0.5 * (block.lower.z + block.upper.z),
    );
    cuboid(&pose, &(0.5 * (block.upper - block.lower)))
}
