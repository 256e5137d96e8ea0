//! Forward kinematics and Jacobian of four configurations side by side, lane by lane to the bits of
//! [`kinematics`](super::forward).

use super::chain::Chain;
use crate::math::Frame;
use crate::math::arithmetic::Arithmetic;
use crate::math::four_frames::FourFrames;
use crate::math::quad::Quad;
use crate::math::real::{Four, Real};
use crate::math::sincos::sincos_by_column;
use crate::math::triple::Triple;

/// Four Jacobians: each number of a column for all four in one register.
pub type FourColumns = [[Quad; 6]];

/// The tips' frames, and into `columns` the Jacobians at `qs`, one entry per independent joint.
#[inline(always)]
pub(crate) fn jacobian<A: Arithmetic, const N: usize>(
    chain: &Chain,
    qs: &[Quad],
    columns: &mut FourColumns,
) -> FourFrames {
    let (sines, cosines, slides) = motions::<A, N>(chain, qs);
    let (mut axes, mut origins) = ([[Quad::ZERO; 3]; N], [[Quad::ZERO; 3]; N]);
    let stage = |i: usize| Frames::<A>::stage(chain, i, Quad(sines[i]), Quad(cosines[i]), slides[i]);
    let mut frame = stage(0);
    (axes[0], origins[0]) = (frame.z.stored(), frame.origin.stored());
    for i in 1..N {
        frame = frame.then(stage(i));
        (axes[i], origins[i]) = (frame.z.stored(), frame.origin.stored());
    }
    let tip = frame.then(Frames::splat(&chain.tip));
    columns.fill([Quad::ZERO; 6]);
    for (i, motion) in chain.motions[..N].iter().enumerate() {
        let axis = Triple::of(&axes[i]);
        let lever = tip.origin - Triple::of(&origins[i]);
        let turn = Four::splat(motion.turn_scale);
        let linear = axis.cross_fused(lever).mul_add(turn, axis * Four::splat(motion.slide_scale));
        let angular = axis * turn;
        // Several stages may share a joint (mimics), so columns are summed.
        let [lx, ly, lz, ax, ay, az] = columns[motion.joint];
        let [lx, ly, lz] = (Triple::of(&[lx, ly, lz]) + linear).stored();
        let [ax, ay, az] = (Triple::of(&[ax, ay, az]) + angular).stored();
        columns[motion.joint] = [lx, ly, lz, ax, ay, az];
    }
    tip.stored()
}

/// Sines, cosines and slides (m) of all stages.
#[inline(always)]
fn motions<A: Arithmetic, const N: usize>(chain: &Chain, qs: &[Quad]) -> ([[f64; 4]; N], [[f64; 4]; N], [Quad; N]) {
    let (mut angles, mut slides) = ([[0.0; 4]; N], [Quad::ZERO; N]);
    for (i, motion) in chain.motions[..N].iter().enumerate() {
        let value = Four::<A>::of(qs[motion.joint]);
        angles[i] = value.mul_add(Four::splat(motion.turn_scale), Four::splat(motion.turn_offset)).stored().0;
        slides[i] = value.mul_add(Four::splat(motion.slide_scale), Four::splat(motion.slide_offset)).stored();
    }
    let (mut sines, mut cosines) = ([[0.0; 4]; N], [[0.0; 4]; N]);
    sincos_by_column::<A, 4>(&angles, &mut sines, &mut cosines);
    (sines, cosines, slides)
}

/// Four frames while they run along the chain.
#[derive(Clone, Copy)]
struct Frames<A> {
    x: Triple<Four<A>>,
    y: Triple<Four<A>>,
    z: Triple<Four<A>>,
    origin: Triple<Four<A>>,
}

impl<A: Arithmetic> Frames<A> {
    /// The same frame four times.
    #[inline(always)]
    fn splat(frame: &Frame) -> Self {
        let [x, y, z] = &frame.axes;
        Self { x: Triple::splat(x), y: Triple::splat(y), z: Triple::splat(z), origin: Triple::splat(&frame.origin) }
    }

    /// Stage number `i`, slid along and turned about its own z axis.
    #[inline(always)]
    fn stage(chain: &Chain, i: usize, sine: Quad, cosine: Quad, slide: Quad) -> Self {
        let Self { x, y, z, origin } = Self::splat(&chain.stages.frame(i));
        let [sine, cosine, slide] = [Four::of(sine), Four::of(cosine), Four::of(slide)];
        Self { x: y.mul_add(sine, x * cosine), y: x.mul_add(-sine, y * cosine), z, origin: z.mul_add(slide, origin) }
    }

    /// A vector of these frames' coordinates, turned into the base's.
    #[inline(always)]
    fn turn(&self, v: Triple<Four<A>>) -> Triple<Four<A>> {
        self.z.mul_add(v.z, self.y.mul_add(v.y, self.x * v.x))
    }

    /// The frames reached by `next` from here, as [`WideFrame::then`](crate::math::wide_frame::WideFrame::then).
    #[inline(always)]
    fn then(&self, next: Self) -> Self {
        let p = next.origin;
        Self {
            x: self.turn(next.x),
            y: self.turn(next.y),
            z: self.turn(next.z),
            origin: self.x.mul_add(p.x, self.origin) + self.y.mul_add(p.y, self.z * p.z),
        }
    }

    #[inline(always)]
    fn stored(self) -> FourFrames {
        FourFrames { axes: [self.x.stored(), self.y.stored(), self.z.stored()], origin: self.origin.stored() }
    }
}
