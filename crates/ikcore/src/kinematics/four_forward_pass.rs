//! The pass from base to tip for four configurations at once, lane by lane to the bits of
//! [`forward_pass`](super::forward_pass).

use super::chain::Chain;
use crate::math::Frame;
use crate::math::arithmetic::Arithmetic;
use crate::math::f64x4::F64x4;
use crate::math::real::{Four, Real};
use crate::math::sincos::sincos_by_column;
use crate::math::vec3::Vec3;

/// Calls `visit(i, frame)` for each stage from the base on, as [`forward_pass`](super::forward_pass::forward_pass), and returns the
/// last frame. `qs` has one entry per independent joint.
#[inline(always)]
pub(super) fn four_forward_pass<A: Arithmetic, const N: usize>(
    chain: &Chain,
    qs: &[F64x4],
    mut visit: impl FnMut(usize, &RunningFrames<A>),
) -> RunningFrames<A> {
    let (sines, cosines, slides) = stage_motions::<A, N>(chain, qs);
    let stage = |i: usize| RunningFrames::<A>::stage(chain, i, F64x4(sines[i]), F64x4(cosines[i]), slides[i]);
    let mut frame = stage(0);
    visit(0, &frame);
    for i in 1..N {
        frame = frame.then(stage(i));
        visit(i, &frame);
    }
    frame
}

/// Sines, cosines and slides (m) of all stages.
#[inline(always)]
fn stage_motions<A: Arithmetic, const N: usize>(
    chain: &Chain,
    qs: &[F64x4],
) -> ([[f64; 4]; N], [[f64; 4]; N], [F64x4; N]) {
    let (mut angles, mut slides) = ([[0.0; 4]; N], [F64x4::ZERO; N]);
    for (i, motion) in chain.motions[..N].iter().enumerate() {
        let value = Four::<A>::of(qs[motion.joint]);
        angles[i] = value.mul_add(Four::splat(motion.turn_scale), Four::splat(motion.turn_offset)).stored().0;
        slides[i] = value.mul_add(Four::splat(motion.slide_scale), Four::splat(motion.slide_offset)).stored();
    }
    let (mut sines, mut cosines) = ([[0.0; 4]; N], [[0.0; 4]; N]);
    sincos_by_column::<A, 4>(&angles, &mut sines, &mut cosines);
    (sines, cosines, slides)
}

/// Four frames while the pass runs along the chain.
#[derive(Clone, Copy)]
pub(super) struct RunningFrames<A> {
    x: Vec3<Four<A>>,
    y: Vec3<Four<A>>,
    pub z: Vec3<Four<A>>,
    pub origin: Vec3<Four<A>>,
}

impl<A: Arithmetic> RunningFrames<A> {
    /// The same frame four times.
    #[inline(always)]
    pub fn splat(frame: &Frame) -> Self {
        let [x, y, z] = &frame.axes;
        Self { x: Vec3::splat(x), y: Vec3::splat(y), z: Vec3::splat(z), origin: Vec3::splat(&frame.origin) }
    }

    /// Stage number `i`, slid along and turned about its own z axis.
    #[inline(always)]
    fn stage(chain: &Chain, i: usize, sine: F64x4, cosine: F64x4, slide: F64x4) -> Self {
        let Self { x, y, z, origin } = Self::splat(&chain.stages.frame(i));
        let [sine, cosine, slide] = [Four::of(sine), Four::of(cosine), Four::of(slide)];
        Self { x: y.mul_add(sine, x * cosine), y: x.mul_add(-sine, y * cosine), z, origin: z.mul_add(slide, origin) }
    }

    /// Rotates a vector from these frames into the base: R v.
    #[inline(always)]
    fn turn(&self, v: Vec3<Four<A>>) -> Vec3<Four<A>> {
        self.z.mul_add(v.z, self.y.mul_add(v.y, self.x * v.x))
    }

    /// self * next, as [`WideFrame::then`](super::wide_frame::WideFrame::then).
    #[inline(always)]
    pub fn then(&self, next: Self) -> Self {
        let p = next.origin;
        Self {
            x: self.turn(next.x),
            y: self.turn(next.y),
            z: self.turn(next.z),
            origin: self.x.mul_add(p.x, self.origin) + self.y.mul_add(p.y, self.z * p.z),
        }
    }

    #[inline(always)]
    pub fn stored(self) -> Frame<F64x4> {
        Frame { axes: [self.x.stored(), self.y.stored(), self.z.stored()], origin: self.origin.stored() }
    }
}
