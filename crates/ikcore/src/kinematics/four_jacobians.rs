//! Forward kinematics and Jacobian of four configurations at once, lane by lane to the bits of
//! [`jacobian`](super::jacobian).

use super::chain::Chain;
use super::four_forward_pass::{RunningFrames, four_forward_pass};
use crate::math::Frame;
use crate::math::arithmetic::Arithmetic;
use crate::math::f64x4::F64x4;
use crate::math::real::{Four, Real};
use crate::math::vec3::Vec3;

/// Four Jacobians: lane l of every number belongs to configuration l.
pub type FourColumns = [[F64x4; 6]];

/// Writes the Jacobians at `qs`, one entry per independent joint, into `columns` and returns the tips' frames.
#[inline(always)]
pub(super) fn four_jacobians<A: Arithmetic, const N: usize>(
    chain: &Chain,
    qs: &[F64x4],
    columns: &mut FourColumns,
) -> Frame<F64x4> {
    let (mut axes, mut origins) = ([[F64x4::ZERO; 3]; N], [[F64x4::ZERO; 3]; N]);
    let last = four_forward_pass::<A, N>(chain, qs, |i, frame| {
        (axes[i], origins[i]) = (frame.z.stored(), frame.origin.stored());
    });
    let tip = last.then(RunningFrames::splat(&chain.tip));
    columns.fill([F64x4::ZERO; 6]);
    for (i, motion) in chain.motions[..N].iter().enumerate() {
        let axis = Vec3::of(&axes[i]);
        let lever = tip.origin - Vec3::of(&origins[i]);
        let turn = Four::splat(motion.turn_scale);
        let linear = axis.cross_fma(lever).mul_add(turn, axis * Four::splat(motion.slide_scale));
        let angular = axis * turn;
        // Several stages may share a joint (mimics), so columns are summed.
        let [lx, ly, lz, ax, ay, az] = columns[motion.joint];
        let [lx, ly, lz] = (Vec3::of(&[lx, ly, lz]) + linear).stored();
        let [ax, ay, az] = (Vec3::of(&[ax, ay, az]) + angular).stored();
        columns[motion.joint] = [lx, ly, lz, ax, ay, az];
    }
    tip.stored()
}
