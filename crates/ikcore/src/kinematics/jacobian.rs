//! Geometric Jacobian at the tip: one column per joint, from the axes and origins of the stages.

use super::chain::Chain;
use super::forward_pass::forward_pass;
use crate::math::arithmetic::Arithmetic;
use crate::math::f64x4::F64x4;
use crate::math::{Columns, Frame};

/// Writes the Jacobian in world axes into `columns`, linear rows before angular rows, and returns the tip frame.
#[inline(always)]
pub(super) fn jacobian<A: Arithmetic, const N: usize, const L: usize>(
    chain: &Chain,
    q: &[f64],
    columns: &mut Columns,
) -> Frame {
    let (mut axes, mut origins) = ([F64x4::ZERO; N], [F64x4::ZERO; N]);
    let tip = forward_pass::<A, N, L>(chain, q, |i, frame| {
        axes[i] = frame.axes[2];
        origins[i] = frame.origin;
    });
    columns.fit(q.len());
    let columns = &mut **columns;
    columns[..N].fill([0.0; 6]);
    for (i, motion) in chain.motions[..N].iter().enumerate() {
        let (axis, lever) = (axes[i], A::sub_x4(tip.origin, origins[i]));
        let moment = A::cross_x4(axis, lever);
        let [turn, slide] = [motion.turn_scale, motion.slide_scale].map(F64x4::splat);
        let linear = A::mul_add_x4(turn, moment, A::mul_x4(slide, axis)).vector();
        let angular = A::mul_x4(turn, axis).vector();
        // Columns are summed, since several stages may share a joint (mimics).
        let column = &mut columns[motion.joint];
        for k in 0..3 {
            column[k] += linear[k];
            column[3 + k] += angular[k];
        }
    }
    tip.into()
}
