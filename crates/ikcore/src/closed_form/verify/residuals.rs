//! Forward kinematics of several candidates in SIMD lanes.

use super::stiffness::{column, compliance, stiffness};
use crate::closed_form::axis_chain::AxisChain;
use crate::closed_form::branches::{BranchFit, Candidates};
use crate::math::Frame;
use crate::math::arithmetic::Arithmetic;
use crate::math::arithmetic::Baseline;
use crate::math::f64x4::F64x4;
use crate::math::real::{Four, Real};
use crate::math::vector3::{Vector, across};

/// Number of candidates checked together.
pub const LANES: usize = 8;

type Lanes = [f64; LANES];

/// Chain in which every joint turns about its own z axis: constant frames before each joint, and the tip frame after the
/// last.
#[derive(Debug, Clone, Copy)]
pub struct FixedFrames<const N: usize> {
    before: [Frame; N],
    tip: Frame,
}

impl<const N: usize> FixedFrames<N> {
    pub fn new(chain: &AxisChain<N>) -> Self {
        let at = chain.joints.map(|joint| along(&joint.axis, &joint.point));
        let before = std::array::from_fn(|k| if k == 0 { at[0] } else { at[k - 1].inverse().then::<Baseline>(&at[k]) });
        Self { before, tip: at[N - 1].inverse().then::<Baseline>(&chain.tip) }
    }
}

/// Pose errors of eight candidates.
#[derive(Debug, Clone, Copy)]
pub struct Residuals {
    /// Largest entry of the differences in position, x axis and z axis.
    pub worst: Lanes,
    position: Lanes,
    rotation: Lanes,
    compliance: Lanes,
}

impl Residuals {
    /// Returns the errors and the stiffness of one candidate.
    #[inline(always)]
    pub fn fit(&self, lane: usize) -> BranchFit {
        BranchFit {
            position: self.position[lane].sqrt(),
            rotation: self.rotation[lane].sqrt(),
            stiffness: stiffness(self.compliance[lane]),
        }
    }
}

/// Computes the residuals of eight candidates from `first` on.
///
/// The recursion runs from tip to base and carries only the three vectors to be compared.
#[inline(always)]
pub fn residuals<A: Arithmetic, const N: usize>(
    frames: &FixedFrames<N>,
    slides: &[bool; N],
    target: &Frame,
    candidates: &Candidates,
    first: usize,
) -> Residuals {
    let tip = &frames.tip;
    let mut carried = [tip.origin, tip.axes[0], tip.axes[2]].map(|v| v.map(|entry| [entry; LANES]));
    let mut columns = [[[Four::<A>::splat(0.0); 6]; N]; 2];
    let halves = if candidates.count - first > 4 { 2 } else { 1 };
    for k in (0..N).rev() {
        let (mut cos, mut sin) = ([0.0; LANES], [0.0; LANES]);
        cos.copy_from_slice(&candidates.cos[k][first..first + LANES]);
        sin.copy_from_slice(&candidates.sin[k][first..first + LANES]);
        if slides[k] {
            for w in 0..LANES {
                carried[0][2][w] += sin[w];
            }
        } else {
            for v in &mut carried {
                turn::<A>(v, &cos, &sin);
            }
        }
        if N <= 6 {
            for (half, columns) in columns.iter_mut().enumerate().take(halves) {
                columns[k] = column(&carried.map(|v| v.map(|entry| four::<A>(&entry, half))), slides[k]);
            }
        }
        let frame = &frames.before[k];
        carried[0] = turned::<A>(frame, &carried[0], &frame.origin);
        carried[1] = turned::<A>(frame, &carried[1], &[0.0; 3]);
        carried[2] = turned::<A>(frame, &carried[2], &[0.0; 3]);
    }
    let mut residuals = compared(&mut carried, target);
    if N <= 6 {
        for (half, columns) in columns.iter().enumerate().take(halves) {
            residuals.compliance[4 * half..4 * half + 4].copy_from_slice(&compliance(columns).stored().0);
        }
    }
    residuals
}

/// Returns the first or second four of eight lanes.
#[inline(always)]
fn four<A: Arithmetic>(lanes: &Lanes, half: usize) -> Four<A> {
    Four::of(F64x4(std::array::from_fn(|w| lanes[4 * half + w])))
}

/// Subtracts the target from position, x axis and z axis.
#[inline(always)]
fn compared(carried: &mut [[Lanes; 3]; 3], target: &Frame) -> Residuals {
    let mut worst = [0.0; LANES];
    let mut squares = [[0.0; LANES]; 3];
    let mut about_y = [0.0; LANES];
    for ((v, goal), square) in
        carried.iter_mut().zip([&target.origin, &target.axes[0], &target.axes[2]]).zip(&mut squares)
    {
        for k in 0..3 {
            for w in 0..LANES {
                v[k][w] -= goal[k];
                square[w] += v[k][w] * v[k][w];
                let off = v[k][w].abs();
                worst[w] = if off > worst[w] { off } else { worst[w] };
            }
        }
    }
    let [position, of_x, of_z] = squares;
    let mut rotation = [0.0; LANES];
    for w in 0..LANES {
        // Small rotation w: x moves by w cross x. The component about y moves both axes and must count once.
        about_y[w] = (0..3).map(|k| carried[2][k][w] * target.axes[0][k]).sum();
        let square = of_x[w] + of_z[w] - about_y[w] * about_y[w];
        rotation[w] = if square > 0.0 { square } else { 0.0 };
        // NaN fails every comparison; the candidate must be rejected.
        let sum = position[w] + of_x[w] + of_z[w];
        worst[w] = if sum.is_finite() { worst[w] } else { f64::INFINITY };
    }
    Residuals { worst, position, rotation, compliance: [f64::INFINITY; LANES] }
}

/// Returns a frame at `point` whose z axis is `axis`.
fn along(axis: &Vector, point: &Vector) -> Frame {
    Frame { axes: across(axis), origin: *point }
}

#[inline(always)]
fn turn<A: Arithmetic>(v: &mut [Lanes; 3], cos: &Lanes, sin: &Lanes) {
    for w in 0..LANES {
        let (x, y) = (v[0][w], v[1][w]);
        v[0][w] = A::mul_add(cos[w], x, -(sin[w] * y));
        v[1][w] = A::mul_add(sin[w], x, cos[w] * y);
    }
}

/// Returns R v + origin.
#[inline(always)]
fn turned<A: Arithmetic>(frame: &Frame, v: &[Lanes; 3], origin: &[f64; 3]) -> [Lanes; 3] {
    let mut out = [[0.0; LANES]; 3];
    for k in 0..3 {
        let (a, b, c, o) = (frame.axes[0][k], frame.axes[1][k], frame.axes[2][k], origin[k]);
        for w in 0..LANES {
            out[k][w] = A::mul_add(a, v[0][w], A::mul_add(b, v[1][w], A::mul_add(c, v[2][w], o)));
        }
    }
    out
}

/// Returns the largest difference of the entries of position and axes of two frames; infinite if `a` is not finite.
pub fn difference(a: &Frame, b: &Frame) -> f64 {
    let entry = |p: &[f64; 3], q: &[f64; 3]| (0..3).fold(0.0, |most: f64, k| most.max((p[k] - q[k]).abs()));
    let sum: f64 = a.axes.as_flattened().iter().chain(&a.origin).sum();
    if !sum.is_finite() {
        // NaN fails every comparison; the frame must be rejected.
        return f64::INFINITY;
    }
    (0..3).fold(entry(&a.origin, &b.origin), |most, k| most.max(entry(&a.axes[k], &b.axes[k])))
}
