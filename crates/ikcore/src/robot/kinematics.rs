//! Forward kinematics and Jacobian: one pass from base to tip, in plain arrays, without allocation.
//!
//! Each kernel has one body, compiled for every padded number of stages ([`SIZES`](super::chain::SIZES)) and for
//! machines with and without AVX2 and FMA.

use super::MAX_DOF;
use super::chain::Chain;
use crate::math::Frame;
use crate::math::arithmetic::{Arithmetic, Fused, Separate};
use crate::math::sincos::sincos;

/// Columns of a 6 x n matrix, one per joint: linear rows (m per rad or m), then angular rows; the first n are in use.
pub type Columns = [[f64; 6]; MAX_DOF];

/// Calls `$kernel::<A, N, L>` for the chain's padded size, fused where the machine can.
macro_rules! dispatch {
    ($chain:expr, $kernel:ident ( $($argument:expr),* ) $(, $lanes:ident)?) => {{
        macro_rules! by_size {
            ($call:ident) => {
                match $chain.stages.len() {
                    4 => $call!(4, 4), 5 => $call!(5, 8), 6 => $call!(6, 8), 7 => $call!(7, 8), 8 => $call!(8, 8),
                    12 => $call!(12, 12), 16 => $call!(16, 16), _ => $call!(32, 32),
                }
            };
        }
        #[cfg(target_arch = "x86_64")]
        {
            macro_rules! portable { ($n:literal, $l:literal) => { $kernel::<Separate, $n, $l $(, $lanes)?>($($argument),*) }; }
            macro_rules! fused {
                // SAFETY: reached only where `has_fused` found the instructions.
                ($n:literal, $l:literal) => { unsafe { fused::$kernel::<$n, $l $(, $lanes)?>($($argument),*) } };
            }
            if crate::math::arithmetic::has_fused() { by_size!(fused) } else { by_size!(portable) }
        }
        #[cfg(target_arch = "aarch64")]
        {
            macro_rules! native { ($n:literal, $l:literal) => { $kernel::<Fused, $n, $l $(, $lanes)?>($($argument),*) }; }
            by_size!(native)
        }
        #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
        {
            macro_rules! portable { ($n:literal, $l:literal) => { $kernel::<Separate, $n, $l $(, $lanes)?>($($argument),*) }; }
            by_size!(portable)
        }
    }};
}

impl Chain {
    /// The tip's frame. `q` has one finite entry per independent joint.
    #[inline]
    pub fn tip(&self, q: &[f64]) -> Frame {
        dispatch!(self, tip(self, q))
    }

    /// The tip's position (m): from the tip back to the base, a third of the work of [`tip`](Self::tip).
    #[inline]
    pub fn tip_position(&self, q: &[f64]) -> [f64; 3] {
        dispatch!(self, tip_position(self, q))
    }

    /// The tip's positions (m) at `W` configurations side by side; lane by lane the same bits as
    /// [`tip_position`](Self::tip_position).
    #[inline]
    pub fn tip_positions<const W: usize>(&self, qs: &[&[f64]; W]) -> [[f64; 3]; W] {
        dispatch!(self, tip_positions(self, qs), W)
    }

    /// The tip's frame and the geometric Jacobian at the tip, world axes, linear rows before angular rows.
    #[inline]
    pub fn jacobian(&self, q: &[f64], columns: &mut Columns) -> Frame {
        dispatch!(self, jacobian(self, q, columns))
    }

    /// The frame of every link, in the order of `links`.
    pub fn link_frames(&self, q: &[f64]) -> Vec<Frame> {
        let mut reached = [Frame::IDENTITY; MAX_DOF + 1];
        dispatch!(self, stage_frames(self, q, &mut reached));
        self.links.iter().map(|link| reached[link.stages].then::<Separate>(&link.offset)).collect()
    }
}

/// The same kernels, compiled for AVX2 and FMA.
#[cfg(target_arch = "x86_64")]
mod fused {
    use super::{Chain, Columns, Frame, Fused, MAX_DOF};

    #[target_feature(enable = "avx2,fma")]
    pub fn tip<const N: usize, const L: usize>(chain: &Chain, q: &[f64]) -> Frame {
        super::tip::<Fused, N, L>(chain, q)
    }

    #[target_feature(enable = "avx2,fma")]
    pub fn tip_position<const N: usize, const L: usize>(chain: &Chain, q: &[f64]) -> [f64; 3] {
        super::tip_position::<Fused, N, L>(chain, q)
    }

    #[target_feature(enable = "avx2,fma")]
    pub fn tip_positions<const N: usize, const L: usize, const W: usize>(
        chain: &Chain,
        qs: &[&[f64]; W],
    ) -> [[f64; 3]; W] {
        super::tip_positions::<Fused, N, L, W>(chain, qs)
    }

    #[target_feature(enable = "avx2,fma")]
    pub fn jacobian<const N: usize, const L: usize>(chain: &Chain, q: &[f64], columns: &mut Columns) -> Frame {
        super::jacobian::<Fused, N, L>(chain, q, columns)
    }

    #[target_feature(enable = "avx2,fma")]
    pub fn stage_frames<const N: usize, const L: usize>(chain: &Chain, q: &[f64], reached: &mut [Frame; MAX_DOF + 1]) {
        super::stage_frames::<Fused, N, L>(chain, q, reached);
    }
}

/// Sines, cosines and slides (m) of all stages.
#[inline(always)]
fn motions<A: Arithmetic, const L: usize>(chain: &Chain, q: &[f64]) -> ([f64; L], [f64; L], [f64; L]) {
    let (mut angles, mut slides) = ([0.0; L], [0.0; L]);
    for (i, motion) in chain.motions[..L].iter().enumerate() {
        let value = q[motion.joint];
        angles[i] = A::mul_add(motion.turn_scale, value, motion.turn_offset);
        slides[i] = A::mul_add(motion.slide_scale, value, motion.slide_offset);
    }
    let (sines, cosines) = sincos::<A, L>(&angles);
    (sines, cosines, slides)
}

/// Walks the chain from the base; `visit(i, frame)` sees the frame in which stage i moves, slid but not yet turned
/// (its origin lies on the axis, its z axis is the axis). Returns the tip's frame.
#[inline(always)]
fn pass<A: Arithmetic, const N: usize, const L: usize>(
    chain: &Chain,
    q: &[f64],
    mut visit: impl FnMut(usize, &Frame),
) -> Frame {
    let (sines, cosines, slides) = motions::<A, L>(chain, q);
    let mut frame = chain.stages[0];
    for i in 0..N {
        if i > 0 {
            frame = frame.then::<A>(&chain.stages[i]);
        }
        let axis = frame.axes[2];
        frame.origin = std::array::from_fn(|k| A::mul_add(axis[k], slides[i], frame.origin[k]));
        visit(i, &frame);
        frame = frame.turned::<A>(sines[i], cosines[i]);
    }
    frame.then::<A>(&chain.tip)
}

#[inline(always)]
fn tip<A: Arithmetic, const N: usize, const L: usize>(chain: &Chain, q: &[f64]) -> Frame {
    pass::<A, N, L>(chain, q, |_, _| ())
}

#[inline(always)]
fn tip_position<A: Arithmetic, const N: usize, const L: usize>(chain: &Chain, q: &[f64]) -> [f64; 3] {
    let (sines, cosines, slides) = motions::<A, L>(chain, q);
    let mut point = chain.tip.origin;
    for i in (0..N).rev() {
        let [x, y, z] = point;
        let turned = [A::mul_add(cosines[i], x, -sines[i] * y), A::mul_add(sines[i], x, cosines[i] * y), z + slides[i]];
        point = chain.stages[i].place::<A>(&turned);
    }
    point
}

/// [`tip_position`] for `W` configurations at once; every operation is done for all lanes before the next.
#[inline(always)]
fn tip_positions<A: Arithmetic, const N: usize, const L: usize, const W: usize>(
    chain: &Chain,
    qs: &[&[f64]; W],
) -> [[f64; 3]; W] {
    let origin = chain.tip.origin;
    let (mut x, mut y, mut z) = ([origin[0]; W], [origin[1]; W], [origin[2]; W]);
    for i in (0..N).rev() {
        let (motion, stage) = (&chain.motions[i], &chain.stages[i]);
        let value: [f64; W] = std::array::from_fn(|w| qs[w][motion.joint]);
        let angle = value.map(|q| A::mul_add(motion.turn_scale, q, motion.turn_offset));
        let (sine, cosine) = sincos::<A, W>(&angle);
        for w in 0..W {
            let turned = [
                A::mul_add(cosine[w], x[w], -sine[w] * y[w]),
                A::mul_add(sine[w], x[w], cosine[w] * y[w]),
                z[w] + A::mul_add(motion.slide_scale, value[w], motion.slide_offset),
            ];
            [x[w], y[w], z[w]] = stage.place::<A>(&turned);
        }
    }
    std::array::from_fn(|w| [x[w], y[w], z[w]])
}

#[inline(always)]
fn jacobian<A: Arithmetic, const N: usize, const L: usize>(chain: &Chain, q: &[f64], columns: &mut Columns) -> Frame {
    let (mut axes, mut origins) = ([[0.0; 3]; N], [[0.0; 3]; N]);
    let tip = pass::<A, N, L>(chain, q, |i, frame| {
        axes[i] = frame.axes[2];
        origins[i] = frame.origin;
    });
    columns[..q.len()].fill([0.0; 6]);
    for (i, motion) in chain.motions[..N].iter().enumerate() {
        let lever: [f64; 3] = std::array::from_fn(|k| tip.origin[k] - origins[i][k]);
        let [ax, ay, az] = axes[i];
        let moment = [
            A::mul_add(ay, lever[2], -az * lever[1]),
            A::mul_add(az, lever[0], -ax * lever[2]),
            A::mul_add(ax, lever[1], -ay * lever[0]),
        ];
        // Several stages may share a joint (mimics), so columns are summed.
        let column = &mut columns[motion.joint];
        for k in 0..3 {
            let linear = A::mul_add(motion.turn_scale, moment[k], motion.slide_scale * axes[i][k]);
            column[k] += linear;
            column[3 + k] = A::mul_add(motion.turn_scale, axes[i][k], column[3 + k]);
        }
    }
    tip
}

#[inline(always)]
fn stage_frames<A: Arithmetic, const N: usize, const L: usize>(
    chain: &Chain,
    q: &[f64],
    reached: &mut [Frame; MAX_DOF + 1],
) {
    let (sines, cosines, _) = motions::<A, L>(chain, q);
    pass::<A, N, L>(chain, q, |i, frame| reached[i + 1] = frame.turned::<A>(sines[i], cosines[i]));
}
