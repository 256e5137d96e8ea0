//! Position residual of the tip: r = p - p_d, dr/dq = linear rows of the geometric Jacobian.

use crate::objective::TaskBlock;

/// Residual p - p_d (m).
#[inline(always)]
pub(crate) fn residual(target: &[f64; 3], tip: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| tip[k] - target[k])
}

/// Squared distance.
#[inline(always)]
pub(crate) fn error(target: &[f64; 3], tip: &[f64; 3]) -> f64 {
    let [x, y, z] = residual(target, tip);
    x * x + y * y + z * z
}

/// Writes residual and derivative from the tip's geometric Jacobian, given in `out`; sets the angular rows to zero.
#[inline]
pub(crate) fn linearize(target: &[f64; 3], tip: &[f64; 3], dof: usize, out: &mut TaskBlock) {
    let [x, y, z] = residual(target, tip);
    out.residual = [x, y, z, 0.0, 0.0, 0.0];
    for column in &mut out.columns[..dof] {
        column[3..].fill(0.0);
    }
}
