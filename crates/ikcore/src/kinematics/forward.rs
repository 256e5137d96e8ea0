//! Forward kinematics and Jacobian: one pass from base to tip, in plain arrays, without allocation.
//!
//! Each kernel has one straight-line body over N stages, their sines padded to L; [`dispatch`](super::dispatch) holds
//! its compilations.

use super::chain::Chain;
use super::four_jacobians::FourColumns;
use crate::math::Frame;
use crate::math::MAX_DOF;
use crate::math::arithmetic::{Arithmetic, Separate};
use crate::math::four_frames::FourFrames;
use crate::math::quad::Quad;
use crate::math::sincos::{sincos, sincos_by_column};
use crate::math::wide_frame::WideFrame;

/// Columns of a 6 x n matrix, one per joint: linear rows (m per rad or m), then angular rows; the first n are in use.
pub type Columns = [[f64; 6]; MAX_DOF];

/// A force (N) at the tip and a moment (N m) about it, in the base's axes: what a tip that moves linearly or turns works
/// against.
pub type Wrench = [f64; 6];

/// Frames reached after 0, 1, 2, ... stages.
pub(crate) type StageFrames = [Frame; MAX_DOF + 1];

impl Chain {
    /// The tip's frame. `q` has one finite entry per independent joint.
    #[inline]
    pub fn tip(&self, q: &[f64]) -> Frame {
        (self.kernels.tip)(self, q)
    }

    /// The tip's position (m): from the tip back to the base, half the work of [`tip`](Self::tip).
    #[inline]
    pub fn tip_position(&self, q: &[f64]) -> [f64; 3] {
        (self.kernels.tip_position)(self, q)
    }

    /// Hands the tip's positions (m) at configurations of `n` entries, stored one after another, to `visit`, in order:
    /// four side by side as long as there are four, then two; the same bits as [`tip_position`](Self::tip_position).
    #[inline]
    pub fn tip_positions(&self, mut qs: &[f64], n: usize, mut visit: impl FnMut([f64; 3])) {
        while let Some((group, rest)) = qs.split_at_checked(4 * n) {
            transposed((self.kernels.tip_four)(self, group)).into_iter().for_each(&mut visit);
            qs = rest;
        }
        if let Some((group, rest)) = qs.split_at_checked(2 * n) {
            transposed((self.kernels.tip_pair)(self, group)).into_iter().for_each(&mut visit);
            qs = rest;
        }
        if qs.len() == n {
            visit(self.tip_position(qs));
        }
    }

    /// The tip's frame and the geometric Jacobian at the tip, world axes, linear rows before angular rows.
    #[inline]
    pub fn jacobian(&self, q: &[f64], columns: &mut Columns) -> Frame {
        (self.kernels.jacobian)(self, q, columns)
    }

    /// [`jacobian`](Self::jacobian) of four configurations side by side, to the same bits; as many `columns` as joints.
    #[inline]
    pub fn jacobian_four(&self, qs: &[Quad], columns: &mut FourColumns) -> FourFrames {
        (self.kernels.jacobian_four)(self, qs, columns)
    }

    /// The tip's frame, and into `torques` what each joint feels of the wrench that `pull` says of it.
    #[inline]
    pub fn torques(&self, q: &[f64], pull: &dyn Fn(&Frame) -> Wrench, torques: &mut [f64]) -> Frame {
        (self.kernels.torques)(self, q, pull, torques)
    }

    /// The frame of every link, in the order of `links`.
    pub fn link_frames(&self, q: &[f64]) -> Vec<Frame> {
        let mut reached = [Frame::IDENTITY; MAX_DOF + 1];
        (self.kernels.stage_frames)(self, q, &mut reached);
        self.links.iter().map(|link| reached[link.stages].then::<Separate>(&link.offset)).collect()
    }
}

/// Point by point what is given coordinate by coordinate. Kept out of the kernels: there it makes the compiler vectorise
/// along coordinates instead of lanes (27 ns a configuration instead of 17).
#[inline]
fn transposed<const W: usize>(coordinates: [[f64; W]; 3]) -> [[f64; 3]; W] {
    std::array::from_fn(|w| coordinates.map(|coordinate| coordinate[w]))
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
    let (mut sines, mut cosines) = ([0.0; L], [0.0; L]);
    sincos::<A>(&angles, &mut sines, &mut cosines);
    (sines, cosines, slides)
}

/// Walks the chain from the base; `visit(i, frame)` sees the frame that stage i moves: its origin lies on the stage's axis, its z axis is
/// the axis. Returns the tip's frame.
#[inline(always)]
fn pass<A: Arithmetic, const N: usize, const L: usize>(
    chain: &Chain,
    q: &[f64],
    mut visit: impl FnMut(usize, &WideFrame),
) -> WideFrame {
    let (sines, cosines, slides) = motions::<A, L>(chain, q);
    let stages = chain.stages.moved::<A, L>(&sines, &cosines, &slides);
    let mut frame = WideFrame::from(&stages.frame(0));
    visit(0, &frame);
    for i in 1..N {
        frame = frame.then::<A>(&stages.frame(i));
        visit(i, &frame);
    }
    frame.then::<A>(&chain.tip)
}

#[inline(always)]
pub(crate) fn tip<A: Arithmetic, const N: usize, const L: usize>(chain: &Chain, q: &[f64]) -> Frame {
    pass::<A, N, L>(chain, q, |_, _| ()).into()
}

#[inline(always)]
pub(crate) fn tip_position<A: Arithmetic, const N: usize, const L: usize>(chain: &Chain, q: &[f64]) -> [f64; 3] {
    let (sines, cosines, slides) = motions::<A, L>(chain, q);
    let mut point = chain.tip.origin;
    for i in (0..N).rev() {
        // Turning the frame instead of the point keeps the turn off the critical path from point to point.
        let stage = chain.stages.frame(i).turned::<A>(sines[i], cosines[i]);
        point = stage.place::<A>(&[point[0], point[1], point[2] + slides[i]]);
    }
    point
}

/// [`tip_position`] for W configurations at once, coordinate by coordinate: lane w of every array is configuration w.
#[inline(always)]
pub(crate) fn side_by_side<A: Arithmetic, const N: usize, const L: usize, const W: usize>(
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

#[inline(always)]
pub(crate) fn jacobian<A: Arithmetic, const N: usize, const L: usize>(
    chain: &Chain,
    q: &[f64],
    columns: &mut Columns,
) -> Frame {
    let (mut axes, mut origins) = ([Quad::ZERO; N], [Quad::ZERO; N]);
    let tip = pass::<A, N, L>(chain, q, |i, frame| {
        axes[i] = frame.axes[2];
        origins[i] = frame.origin;
    });
    columns[..N].fill([0.0; 6]);
    for (i, motion) in chain.motions[..N].iter().enumerate() {
        let (axis, lever) = (axes[i], A::sub_quad(tip.origin, origins[i]));
        let moment = axis.cross::<A>(lever);
        let [turn, slide] = [motion.turn_scale, motion.slide_scale].map(Quad::splat);
        let linear = A::mul_add_quad(turn, moment, A::mul_quad(slide, axis)).vector();
        let angular = A::mul_quad(turn, axis).vector();
        // Several stages may share a joint (mimics), so columns are summed.
        let column = &mut columns[motion.joint];
        for k in 0..3 {
            column[k] += linear[k];
            column[3 + k] += angular[k];
        }
    }
    tip.into()
}

/// J'w without J: of the wrench w at the tip, each axis feels the moment about itself and the force along itself.
#[inline(always)]
pub(crate) fn torques<A: Arithmetic, const N: usize, const L: usize>(
    chain: &Chain,
    q: &[f64],
    pull: &dyn Fn(&Frame) -> Wrench,
    torques: &mut [f64],
) -> Frame {
    let (mut axes, mut origins) = ([[0.0; 3]; N], [[0.0; 3]; N]);
    let tip = Frame::from(pass::<A, N, L>(chain, q, |i, frame| {
        axes[i] = frame.axes[2].vector();
        origins[i] = frame.origin.vector();
    }));
    let [fx, fy, fz, mx, my, mz] = pull(&tip);
    torques.fill(0.0);
    for (i, motion) in chain.motions[..N].iter().enumerate() {
        let [lx, ly, lz]: [f64; 3] = std::array::from_fn(|k| tip.origin[k] - origins[i][k]);
        let [ax, ay, az] = axes[i];
        let about = [
            A::mul_add(ly, fz, A::mul_add(-lz, fy, mx)),
            A::mul_add(lz, fx, A::mul_add(-lx, fz, my)),
            A::mul_add(lx, fy, A::mul_add(-ly, fx, mz)),
        ];
        let turning = A::mul_add(ax, about[0], A::mul_add(ay, about[1], az * about[2]));
        let sliding = A::mul_add(ax, fx, A::mul_add(ay, fy, az * fz));
        // Several stages may share a joint (mimics), so shares are summed.
        torques[motion.joint] += A::mul_add(motion.turn_scale, turning, motion.slide_scale * sliding);
    }
    tip
}

#[inline(always)]
pub(crate) fn stage_frames<A: Arithmetic, const N: usize, const L: usize>(
    chain: &Chain,
    q: &[f64],
    reached: &mut StageFrames,
) {
    pass::<A, N, L>(chain, q, |i, frame| reached[i + 1] = Frame::from(*frame));
}
