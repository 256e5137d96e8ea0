//! The derivatives of the path over one segment, as Bernstein coefficients: a polynomial lies between the smallest and
//! the largest of its Bernstein coefficients, so a bound on them holds at every point of the segment.

use super::grid::Segment;
use super::joint_path::JointPath;

/// Derivatives of each joint over one segment: the quadratic dq/ds and the linear d2q/ds2.
#[derive(Debug)]
pub(super) struct PathDerivatives {
    /// Bernstein coefficients of dq/ds: at the start, in the middle, at the end.
    pub first: [Vec<f64>; 3],
    /// d2q/ds2 at the start and at the end.
    pub second: [Vec<f64>; 2],
}

impl PathDerivatives {
    pub(super) fn new(joints: usize) -> Self {
        Self { first: [(); 3].map(|()| vec![0.0; joints]), second: [(); 2].map(|()| vec![0.0; joints]) }
    }

    /// Computes the derivatives of `path` over `segment`.
    pub(super) fn fill(&mut self, path: &JointPath, segment: &Segment) {
        let Segment { piece, from, length, .. } = *segment;
        let [_, c1, c2, c3] = path.powers(piece);
        let n = c1.len();
        let [d0, d1, d2] = self.first.each_mut().map(|row| &mut row[..n]);
        let [e0, e1] = self.second.each_mut().map(|row| &mut row[..n]);
        for j in 0..n {
            e0[j] = 2.0 * c2[j] + 6.0 * c3[j] * from;
            e1[j] = e0[j] + 6.0 * c3[j] * length;
            d0[j] = c1[j] + from * (2.0 * c2[j] + from * 3.0 * c3[j]);
            d1[j] = d0[j] + 0.5 * length * e0[j];
            d2[j] = d1[j] + 0.5 * length * e1[j];
        }
    }
}
