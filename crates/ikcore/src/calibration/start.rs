//! Closed-form starts for base and tool, which may be anywhere: the frame of a tracker, the pose of a camera.

use nalgebra::{Matrix3, Rotation3, SMatrix, SVD, Translation3, Vector3};

use crate::math::Pose;

/// Similarity of two sets of points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Alignment {
    /// Pose that maps the first points to the second.
    pub pose: Pose,
    /// Root mean square of the distances left (m).
    pub rms: f64,
    /// The same if a mirror image may be taken.
    pub mirrored_rms: f64,
    /// Spread of the second points over that of the first.
    pub scale: f64,
    /// Similarity of the shapes, whatever their sizes: 1 if one is the other, turned and scaled.
    pub likeness: f64,
    /// Smallest spread of the first points over the largest: 0 in a plane.
    pub flatness: f64,
}

/// Aligns points with others (Kabsch 1976, Umeyama 1991).
pub(super) fn aligned(from: &[Vector3<f64>], to: &[Vector3<f64>]) -> Alignment {
    let count = from.len() as f64;
    let mean = |points: &[Vector3<f64>]| points.iter().sum::<Vector3<f64>>() / count;
    let (from_mean, to_mean) = (mean(from), mean(to));
    let mut covariance = Matrix3::zeros();
    let mut spread = Matrix3::zeros();
    let [mut from_square, mut to_square] = [0.0; 2];
    for (a, b) in from.iter().zip(to) {
        let (a, b) = (a - from_mean, b - to_mean);
        covariance += b * a.transpose();
        spread += a * a.transpose();
        from_square += a.norm_squared();
        to_square += b.norm_squared();
    }
    let rotation = nearest_rotation(&covariance);
    let values = covariance.singular_values();
    let sign = if covariance.determinant() < 0.0 { -1.0 } else { 1.0 };
    let left = |smallest: f64| {
        let kept = values[0] + values[1] + smallest * values[2];
        ((from_square + to_square - 2.0 * kept).max(0.0) / count).sqrt()
    };
    let extents = spread.symmetric_eigenvalues();
    Alignment {
        pose: Pose::from_parts(Translation3::from(to_mean - rotation * from_mean), rotation),
        rms: left(sign),
        mirrored_rms: left(-sign),
        scale: (to_square / from_square.max(f64::MIN_POSITIVE)).sqrt(),
        likeness: (values[0] + values[1] + sign * values[2]) / (from_square * to_square).sqrt().max(f64::MIN_POSITIVE),
        flatness: (extents.min().max(0.0) / extents.max().max(f64::MIN_POSITIVE)).sqrt(),
    }
}

/// Rotation nearest to a matrix.
pub(super) fn nearest_rotation(matrix: &Matrix3<f64>) -> Rotation3<f64> {
    let svd = matrix.svd(true, true);
    let (Some(mut u), Some(v_t)) = (svd.u, svd.v_t) else { return Rotation3::identity() };
    if (u * v_t).determinant() < 0.0 {
        let last = svd.singular_values.imin();
        u.column_mut(last).neg_mut();
    }
    Rotation3::from_matrix_unchecked(u * v_t)
}

/// Poses X and Z with Z F_i X = M_i for all i, by the Kronecker product (Shah 2013): rotations from the leading singular vectors of
/// the sum of M_i (x) F_i, translations by linear least squares. `arm` are F_i, `measured` M_i. Returns Z and X.
pub(super) fn both_ends(arm: &[Pose], measured: &[Pose]) -> [Pose; 2] {
    let mut sum = SMatrix::<f64, 9, 9>::zeros();
    for (f, m) in arm.iter().zip(measured) {
        sum += m.rotation.matrix().kronecker(f.rotation.matrix());
    }
    // R_Z F R_X = M: in columns of rows, vec(R_Z) is mapped to vec(R_X') by each factor M (x) F.
    let svd = SVD::new(sum, true, true);
    let (Some(u), Some(v_t)) = (svd.u, svd.v_t) else { return [Pose::identity(); 2] };
    let first = svd.singular_values.imax();
    let of = |entry: &dyn Fn(usize) -> f64| Matrix3::from_fn(|row, column| entry(3 * row + column));
    // M_i R_X' = R_Z F_i: row by row, (M (x) F) vec(R_X') = vec(R_Z).
    let (z, x_back) = (of(&|k| u[(k, first)]), of(&|k| v_t[(first, k)]));
    let sign = if z.determinant() < 0.0 { -1.0 } else { 1.0 };
    let (z, x) = (nearest_rotation(&(sign * z)), nearest_rotation(&(sign * x_back)).inverse());
    let mut normal = SMatrix::<f64, 6, 6>::zeros();
    let mut right = SMatrix::<f64, 6, 1>::zeros();
    for (f, m) in arm.iter().zip(measured) {
        // R_Z (R_F t_X + t_F) + t_Z = t_M.
        let turned = z * f.rotation;
        let mut rows = SMatrix::<f64, 3, 6>::zeros();
        rows.fixed_view_mut::<3, 3>(0, 0).copy_from(turned.matrix());
        rows.fixed_view_mut::<3, 3>(0, 3).fill_with_identity();
        let known = m.translation.vector - z * f.translation.vector;
        normal += rows.transpose() * rows;
        right += rows.transpose() * known;
    }
    let solved = normal.pseudo_inverse(1e-9 * normal.amax()).map_or(right * 0.0, |inverse| inverse * right);
    let at = |k: usize| Translation3::new(solved[k], solved[k + 1], solved[k + 2]);
    [Pose::from_parts(at(3), z), Pose::from_parts(at(0), x)]
}

/// Pose Z nearest to M_i F_i' for all i: the base if the tool is known.
pub(super) fn first_end(arm: &[Pose], measured: &[Pose]) -> Pose {
    let sum: Matrix3<f64> =
        arm.iter().zip(measured).map(|(f, m)| m.rotation.matrix() * f.rotation.matrix().transpose()).sum();
    let rotation = nearest_rotation(&sum);
    let apart: Vector3<f64> =
        arm.iter().zip(measured).map(|(f, m)| m.translation.vector - rotation * f.translation.vector).sum();
    Pose::from_parts(Translation3::from(apart / arm.len() as f64), rotation)
}
