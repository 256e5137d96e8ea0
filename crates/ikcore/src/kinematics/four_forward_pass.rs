//! Forward pass from base to tip for four configurations in SIMD lanes, bit-identical to
//! [`forward_pass`](super::forward_pass).

use super::chain::Chain;
use crate::math::Frame;
use crate::math::arithmetic::Arithmetic;
use crate::math::f64x4::F64x4;
use crate::math::real::{Four, Real};
use crate::math::sincos::sincos_by_column;
use crate::math::vec3::Vec3;

/// Calls `visit(i, frame)` for each stage from the base on, as [`forward_pass`](super::forward_pass::forward_pass) does, and
/// returns the last frame. `qs` has one entry per independent joint.
#[inline(always)]
pub(super) fn four_forward_pass<A: Arithmetic, const N: usize>(
    chain: &Chain,
    qs: &[F64x4],
    mut visit: impl FnMut(usize, &RunningFrames<Four<A>>),
) -> RunningFrames<Four<A>> {
    let (sines, cosines, slides) = stage_motions::<A, N>(chain, qs);
    let mut frame = stage::<A>(&chain.stages.frame(0), sines[0], cosines[0], slides[0]);
    visit(0, &frame);
    for i in 1..N {
        frame = frame.then(stage::<A>(&chain.stages.frame(i), sines[i], cosines[i], slides[i]));
        visit(i, &frame);
    }
    frame
}

/// Returns the frames that a stage moves, relative to the one before. A function: a closure would be compiled without the instructions of the
/// calling kernel.
#[inline(always)]
fn stage<A: Arithmetic>(frame: &Frame, sines: [f64; 4], cosines: [f64; 4], slides: F64x4) -> RunningFrames<Four<A>> {
    RunningFrames::splat(frame).moved(Four::of(F64x4(sines)), Four::of(F64x4(cosines)), Four::of(slides))
}

/// Computes sines, cosines and translations (m) of all stages.
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

/// Frames of the current stage during the forward pass, one per lane.
#[derive(Clone, Copy)]
pub(super) struct RunningFrames<R> {
    x: Vec3<R>,
    y: Vec3<R>,
    pub z: Vec3<R>,
    pub origin: Vec3<R>,
}

impl<R: Real> RunningFrames<R> {
    /// Broadcasts a frame to all lanes.
    #[inline(always)]
    pub fn splat(frame: &Frame) -> Self {
        let [x, y, z] = &frame.axes;
        Self { x: Vec3::splat(x), y: Vec3::splat(y), z: Vec3::splat(z), origin: Vec3::splat(&frame.origin) }
    }

    /// Loads the frames.
    #[inline(always)]
    pub fn of(frames: &Frame<R::Stored>) -> Self {
        let [x, y, z] = &frames.axes;
        Self { x: Vec3::of(x), y: Vec3::of(y), z: Vec3::of(z), origin: Vec3::of(&frames.origin) }
    }

    /// Translates the frames along their own z axes and rotates them about these.
    #[inline(always)]
    pub fn moved(self, sine: R, cosine: R, slide: R) -> Self {
        let Self { x, y, z, origin } = self;
        Self { x: y.mul_add(sine, x * cosine), y: x.mul_add(-sine, y * cosine), z, origin: z.mul_add(slide, origin) }
    }

    /// Rotates a vector from these frames into the base: R v.
    #[inline(always)]
    pub fn turn(&self, v: Vec3<R>) -> Vec3<R> {
        self.z.mul_add(v.z, self.y.mul_add(v.y, self.x * v.x))
    }

    /// Returns self * next, in the order of operations of [`WideFrame::then`](super::wide_frame::WideFrame::then).
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

    /// Stores the frames.
    #[inline(always)]
    pub fn stored(self) -> Frame<R::Stored> {
        Frame { axes: [self.x.stored(), self.y.stored(), self.z.stored()], origin: self.origin.stored() }
    }
}
