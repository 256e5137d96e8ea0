//! Pose of a board from its image points: linear start, then Gauss-Newton on the image.

use nalgebra::{DMatrix, Matrix3, Matrix6, Rotation3, Translation3, Vector3, Vector6};

use super::camera::PinholeCamera;
use super::start::nearest_rotation;
use crate::math::Pose;

/// Extent of a board across its plane, over the largest, below which it is flat.
const FLAT: f64 = 1e-3;
/// Steps on the image.
const STEPS: usize = 20;

/// A point of the board with its image.
type Seen = (Vector3<f64>, [f64; 2]);

/// Pose of the board in the camera's frame.
pub(super) fn board_pose(board: &[[f64; 3]], seen: &[[f64; 2]], lens: &PinholeCamera) -> Pose {
    let points: Vec<Seen> = board
        .iter()
        .zip(seen)
        .filter(|(_, at)| at[0].is_finite())
        .map(|(point, at)| (Vector3::from(*point), *at))
        .collect();
    let (frame, is_flat) = principal_frame(&points);
    let local: Vec<(Vector3<f64>, [f64; 2])> = points
        .iter()
        .map(|(point, at)| (frame.rotation.inverse() * (point - frame.translation.vector), lens.ray(*at)))
        .collect();
    let start = if is_flat || local.len() < 6 { from_homography(&local) } else { from_projection(&local) };
    refined(start * frame.inverse(), &points, lens)
}

/// Frame at the centre of the points, with z across their plane, and whether they are in a plane.
fn principal_frame(points: &[Seen]) -> (Pose, bool) {
    let centre = points.iter().map(|(point, _)| point).sum::<Vector3<f64>>() / points.len() as f64;
    let spread: Matrix3<f64> = points.iter().map(|(point, _)| (point - centre) * (point - centre).transpose()).sum();
    let eigen = spread.symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let [x, y] = [eigen.eigenvectors.column(order[0]).into_owned(), eigen.eigenvectors.column(order[1]).into_owned()];
    let rotation = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, y, x.cross(&y)]));
    let is_flat = eigen.eigenvalues[order[2]].max(0.0).sqrt() < FLAT * eigen.eigenvalues[order[0]].sqrt();
    (Pose::from_parts(Translation3::from(centre), rotation), is_flat)
}

/// Vector of least image under the rows.
fn null_vector(rows: &[Vec<f64>]) -> Vec<f64> {
    let n = rows[0].len();
    let normal = DMatrix::from_fn(n, n, |i, j| rows.iter().map(|row| row[i] * row[j]).sum());
    let eigen = normal.symmetric_eigen();
    eigen.eigenvectors.column(eigen.eigenvalues.imin()).iter().copied().collect()
}

/// Pose from the homography of the plane z = 0 (Zhang 2000): its columns are the first two axes and the origin.
fn from_homography(points: &[(Vector3<f64>, [f64; 2])]) -> Pose {
    let rows = points.iter().flat_map(|(p, [u, v])| {
        let (x, y) = (p.x, p.y);
        [vec![x, y, 1.0, 0.0, 0.0, 0.0, -u * x, -u * y, -u], vec![0.0, 0.0, 0.0, x, y, 1.0, -v * x, -v * y, -v]]
    });
    let h = Matrix3::from_row_slice(&null_vector(&rows.collect::<Vec<_>>()));
    let size = 0.5 * (h.column(0).norm() + h.column(1).norm());
    // The board is in front of the camera.
    let h = h / if h[(2, 2)] < 0.0 { -size } else { size };
    let (x, y) = (h.column(0).into_owned(), h.column(1).into_owned());
    let rotation = nearest_rotation(&Matrix3::from_columns(&[x, y, x.cross(&y)]));
    Pose::from_parts(Translation3::from(h.column(2).into_owned()), rotation)
}

/// Pose from the projection of six points or more.
fn from_projection(points: &[(Vector3<f64>, [f64; 2])]) -> Pose {
    let rows = points.iter().flat_map(|(p, [u, v])| {
        let (x, y, z) = (p.x, p.y, p.z);
        [
            vec![x, y, z, 1.0, 0.0, 0.0, 0.0, 0.0, -u * x, -u * y, -u * z, -u],
            vec![0.0, 0.0, 0.0, 0.0, x, y, z, 1.0, -v * x, -v * y, -v * z, -v],
        ]
    });
    let p = null_vector(&rows.collect::<Vec<_>>());
    let turn = Matrix3::from_fn(|row, column| p[4 * row + column]);
    let size = turn.determinant().abs().cbrt() * if p[11] < 0.0 { -1.0 } else { 1.0 };
    let shift = Vector3::new(p[3], p[7], p[11]) / size;
    Pose::from_parts(Translation3::from(shift), nearest_rotation(&(turn / size)))
}

/// Gauss-Newton on the image.
fn refined(start: Pose, points: &[Seen], lens: &PinholeCamera) -> Pose {
    let mut pose = start;
    let mut last = f64::INFINITY;
    for _ in 0..STEPS {
        let (mut normal, mut gradient, mut cost) = (Matrix6::zeros(), Vector6::zeros(), 0.0);
        for (point, at) in points {
            let arm = pose.rotation * point;
            let (image, slopes) = lens.image(&(pose.translation.vector + arm));
            for row in 0..2 {
                let slope = slopes.row(row).transpose();
                let turning = arm.cross(&slope);
                let j = Vector6::new(slope.x, slope.y, slope.z, turning.x, turning.y, turning.z);
                let residual = image[row] - at[row];
                normal += j * j.transpose();
                gradient += residual * j;
                cost += residual * residual;
            }
        }
        if !(cost < last * (1.0 - 1e-9)) {
            break;
        }
        last = cost;
        let Some(factor) = normal.cholesky() else { break };
        let step = factor.solve(&-gradient);
        let turn = Rotation3::new(Vector3::new(step[3], step[4], step[5]));
        let moved = pose.translation.vector + Vector3::new(step[0], step[1], step[2]);
        pose = Pose::from_parts(Translation3::from(moved), turn * pose.rotation);
    }
    pose
}
