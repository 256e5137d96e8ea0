//! Forward kinematics: the tip frame, and the tip position alone at one or several configurations.

use super::chain::Chain;
use super::forward_pass::{forward_pass, stage_motions};
use crate::math::Frame;
use crate::math::arithmetic::Arithmetic;
use crate::math::sincos::sincos_by_column;

/// Returns the tip frame.
#[inline(always)]
pub(super) fn tip<A: Arithmetic, const N: usize, const L: usize>(chain: &Chain, q: &[f64]) -> Frame {
    forward_pass::<A, N, L>(chain, q, |_, _| ()).into()
}

/// Returns the tip position (m), computed from the tip back to the base: half the work of [`tip`].
#[inline(always)]
pub(super) fn tip_position<A: Arithmetic, const N: usize, const L: usize>(chain: &Chain, q: &[f64]) -> [f64; 3] {
    let (sines, cosines, slides) = stage_motions::<A, L>(chain, q);
    let mut point = chain.tip.origin;
    for i in (0..N).rev() {
        // Rotating the frame instead of the point keeps the rotation off the critical path from point to point.
        let stage = chain.stages.frame(i).turned::<A>(sines[i], cosines[i]);
        point = stage.transform::<A>(&[point[0], point[1], point[2] + slides[i]]);
    }
    point
}

/// Computes [`tip_position`] at W configurations, by coordinate: lane w of every array belongs to configuration w.
#[inline(always)]
pub(super) fn tip_positions<A: Arithmetic, const N: usize, const L: usize, const W: usize>(
    chain: &Chain,
    qs: &[f64],
) -> [[f64; W]; 3] {
    let n = qs.len() / W;
    let rows: [&[f64]; W] = std::array::from_fn(|w| &qs[w * n..(w + 1) * n]);
    let (mut angles, mut slides) = ([[0.0; W]; L], [[0.0; W]; L]);
    for (i, motion) in chain.motions[..L].iter().enumerate() {
        for w in 0..W {
            let value = rows[w][motion.joint];
            angles[i][w] = A::mul_add(motion.turn_scale, value, motion.turn_offset);
            slides[i][w] = A::mul_add(motion.slide_scale, value, motion.slide_offset);
        }
    }
    let (mut sines, mut cosines) = ([[0.0; W]; L], [[0.0; W]; L]);
    sincos_by_column::<A, W>(&angles, &mut sines, &mut cosines);
    let mut point = chain.tip.origin.map(|coordinate| [coordinate; W]);
    for i in (0..N).rev() {
        let (sine, cosine, stage) = (&sines[i], &cosines[i], chain.stages.frame(i));
        let [x, y, z] = &stage.axes;
        let [px, py, pz] = point;
        let slid: [f64; W] = std::array::from_fn(|w| pz[w] + slides[i][w]);
        for k in 0..3 {
            let new_x: [f64; W] = std::array::from_fn(|w| A::mul_add(sine[w], y[k], cosine[w] * x[k]));
            let new_y: [f64; W] = std::array::from_fn(|w| A::mul_add(-sine[w], x[k], cosine[w] * y[k]));
            let first: [f64; W] = std::array::from_fn(|w| A::mul_add(new_x[w], px[w], stage.origin[k]));
            let rest: [f64; W] = std::array::from_fn(|w| A::mul_add(new_y[w], py[w], z[k] * slid[w]));
            point[k] = std::array::from_fn(|w| first[w] + rest[w]);
        }
    }
    point
}
