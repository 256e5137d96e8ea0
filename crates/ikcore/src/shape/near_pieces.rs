//! Points of a cloud and voxels of a grid near a body.

use nalgebra::Vector3;

use super::checked_shape::{LARGEST, ROUNDING, Shape};
use super::geometry::Geometry;
use super::grid::Grid;
use super::point_cloud::PointCloud;
use super::posed_body::PosedBody;
use crate::math::arithmetic::NoFma;

impl Shape {
    /// Returns the number of points of a cloud, or of voxels of a grid; `None` for other shapes.
    pub(crate) fn piece_count(&self) -> Option<usize> {
        match self.geometry() {
            Geometry::PointCloud(cloud) => Some(cloud.points().len()),
            Geometry::Grid(grid) => Some(grid.occupied().len()),
            _ => None,
        }
    }

    /// Marks the points of a cloud, or the occupied voxels of a grid, whose distance from a body is at most `most` (m). A
    /// distance is that of [`distance_to_body`](Self::distance_to_body) for the point or voxel alone; from solids, it is more
    /// accurate by up to 1e-7 m.
    pub(crate) fn mark_near(&self, body: &PosedBody, most: f64, near: &mut [bool]) {
        match self.geometry() {
            Geometry::PointCloud(cloud) => mark_points(cloud, body, most, near),
            Geometry::Grid(grid) => mark_voxels(grid, body, most, near),
            _ => {}
        }
    }
}

fn mark_points(cloud: &PointCloud, body: &PosedBody, most: f64, near: &mut [bool]) {
    let (radius, points) = (cloud.radius(), cloud.points());
    let far = body.axis[0].amax().max(body.axis[1].amax());
    if !(far.max(body.radius) <= LARGEST) {
        // Where such a body is cannot be told.
        return near.fill(true);
    }
    // Distances are less by the rounding that is possible for coordinates as large as these.
    let rounding = |point: &[f64; 3]| {
        let scale = point.iter().fold(1.0 + radius, |scale, x| scale.max(radius + x.abs()));
        ROUNDING * scale.max(far)
    };
    let reach = most + radius + body.radius;
    let reach = reach + 2.0 * ROUNDING * (1.0 + radius + far + reach);
    let back = body.solid.as_ref().map(|(shape, frame)| (*shape, frame.inverse()));
    cloud.each_within(body.axis, reach, &mut |index, squared| {
        if near[index] {
            return;
        }
        let point = &points[index];
        let own = radius + rounding(point);
        let is_near = |distance: f64| !(distance - own > most);
        near[index] = is_near(squared.sqrt() - body.radius)
            && back.as_ref().is_none_or(|(shape, back)| {
                let local = Vector3::from(back.transform::<NoFma>(point));
                is_near(shape.distance_to_segment(&[local; 2], most + own + ROUNDING))
            });
    });
}

fn mark_voxels(grid: &Grid, body: &PosedBody, most: f64, near: &mut [bool]) {
    let size = [grid.voxel(); 3];
    let reach = most + body.radius;
    grid.each_voxel_near(body.axis, reach, &mut |index, center| {
        if near[index] {
            return;
        }
        // Distances of at least `enough` may be rounded down to it.
        let enough = most + 1e-9 * (1.0 + most);
        let is_near = |cube: Shape| !(cube.distance_to_body(body, enough) > most);
        near[index] = Shape::cuboid(center, size, None).is_ok_and(is_near);
    });
}
