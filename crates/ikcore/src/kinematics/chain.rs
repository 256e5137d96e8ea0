//! Serial chain in the form used by the kernels. Each moving element (a *stage*) has one constant frame, followed by a
//! rotation about and a translation along its own z axis; constant transforms and axis directions are folded in when the
//! chain is built.

use nalgebra::{Matrix3, Vector3};

use super::joint_curve::{CurvedStage, CurvedStages, JointCurve};
use super::rotation_vector::RotationVector;
use super::stages::Stages;
use crate::math::vector3::{add_scaled, cross, scaled, sub};
use crate::math::{Frame, Pose, pose};

/// Motion of a stage: a rotation by turn_scale * q\[joint\] + turn_offset (rad) and a translation of the same form (m). One
/// of the two scales is zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Transmission {
    pub joint: usize,
    pub turn_scale: f64,
    pub turn_offset: f64,
    pub slide_scale: f64,
    pub slide_offset: f64,
    /// Axis of the motion in the frame after the stage.
    pub axis: StageAxis,
    /// Bound of the second derivative by q of the rotation or translation of a curve, rounded up; zero for others.
    pub bend: f32,
}

/// Axis of a stage: the z axis of the frame after it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum StageAxis {
    /// Of unit length, and fixed to the element before.
    Own,
    /// Entry of a [`RotationVector`], whose axis moves with all three entries.
    OfVector,
    /// Fixed to the element before, and as long as the slope of a [`JointCurve`] relative to the largest one, which is the scale.
    OfCurve,
}

impl Transmission {
    /// Moves nothing.
    pub(super) const NONE: Self = Self {
        joint: 0,
        turn_scale: 0.0,
        turn_offset: 0.0,
        slide_scale: 0.0,
        slide_offset: 0.0,
        axis: StageAxis::Own,
        bend: 0.0,
    };

    /// Returns a rotation by `scale * q[joint] + offset` (rad).
    pub fn turn(joint: usize, scale: f64, offset: f64) -> Self {
        Self { joint, turn_scale: scale, turn_offset: offset, ..Self::NONE }
    }

    /// Returns a translation by `scale * q[joint] + offset` (m).
    pub fn slide(joint: usize, scale: f64, offset: f64) -> Self {
        Self { joint, slide_scale: scale, slide_offset: offset, ..Self::NONE }
    }

    /// Returns a rotation by entry `joint` of a rotation vector.
    fn vector_entry(joint: usize) -> Self {
        Self { axis: StageAxis::OfVector, ..Self::turn(joint, 1.0, 0.0) }
    }

    /// Returns a motion along a curve; the scale is its largest slope.
    pub(super) fn curved(joint: usize, turns: bool, curve: &JointCurve) -> Self {
        let [steepest, bend] = curve.largest();
        let motion = if turns { Self::turn } else { Self::slide };
        Self { axis: StageAxis::OfCurve, bend: (bend as f32).next_up(), ..motion(joint, steepest, 0.0) }
    }

    /// Whether it is an entry of a rotation vector.
    #[inline]
    pub fn is_of_vector(&self) -> bool {
        self.axis == StageAxis::OfVector
    }

    /// Whether it is a multiple of the joint plus a constant, about or along one axis.
    #[inline]
    pub fn is_linear(&self) -> bool {
        self.axis == StageAxis::Own
    }

    /// The rotation (rad) or translation (m) per unit of the joint.
    #[inline]
    pub fn scale(&self) -> f64 {
        if self.turn_scale == 0.0 { self.slide_scale } else { self.turn_scale }
    }

    /// Returns the velocity of `point` per unit joint speed, for a point fixed in this element's frame `moved`.
    pub fn velocity(&self, moved: &Frame, point: &[f64; 3]) -> [f64; 3] {
        let Frame { axes: [_, _, axis], origin } = moved;
        add_scaled(&scaled(&cross(axis, &sub(point, origin)), self.turn_scale), axis, self.slide_scale)
    }

    /// Adds the linear and angular velocity of `point` per unit joint speed, as [`Self::velocity`], to a column of a Jacobian.
    pub fn add_to_column(&self, moved: &Frame, point: &[f64; 3], column: &mut [f64; 6]) {
        let velocity = self.velocity(moved, point);
        for k in 0..3 {
            column[k] += velocity[k];
            column[3 + k] += self.turn_scale * moved.axes[2][k];
        }
    }

    /// Returns the largest rotation (rad) and translation (m) if each joint changes by up to `reach`.
    #[inline]
    pub fn travel(&self, reach: &[f64]) -> [f64; 2] {
        [self.turn_scale, self.slide_scale].map(|scale| scale.abs() * reach[self.joint])
    }

    /// Returns bounds of the second derivatives of rotation (rad) and translation (m) by the share of a straight line of length `change`
    /// in joint space.
    #[inline]
    pub fn bent(&self, change: &[f64]) -> [f64; 2] {
        let bent = f64::from(self.bend) * change[self.joint] * change[self.joint];
        if self.turn_scale == 0.0 { [0.0, bent] } else { [bent, 0.0] }
    }
}

/// Constant frame of a link, relative to the frame after `stages` stages.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LinkFrame {
    pub stages: usize,
    pub offset: Frame,
}

/// Chain with its constant transforms folded in.
#[derive(Debug, Clone)]
pub(crate) struct Chain {
    /// Number of moving elements; the remaining stages are padding.
    pub moving: usize,
    /// Constant frames, one per moving element.
    pub stages: Stages,
    /// Motions, one per moving element, then padding that moves nothing.
    pub motions: Vec<Transmission>,
    /// Tip frame relative to the last stage.
    pub tip: Frame,
    pub links: Vec<LinkFrame>,
    /// Rotation vector, whose stages do not turn about axes of their own.
    pub vector: Option<RotationVector>,
    /// First stages of polynomial couplings.
    pub curves: CurvedStages,
}

/// Stage counts for which kernels are compiled; chains are padded to the next one.
pub(super) const SIZES: [usize; 8] = [4, 5, 6, 7, 8, 12, 16, 32];

/// Number of sines computed together: a remainder of one to three costs as much as all the rest (measured).
const LANES: usize = 4;

impl Chain {
    /// Returns the number of stages with padding: one of [`SIZES`].
    pub(super) fn padded_stages(&self) -> usize {
        padded(self.moving)
    }

    /// Iterates over the constant frames of the moving elements, each relative to the previous one.
    pub fn moving_frames(&self) -> impl Iterator<Item = Frame> {
        (0..self.moving).map(|stage| self.stages.frame(stage))
    }
}

fn padded(moving: usize) -> usize {
    SIZES.into_iter().find(|size| *size >= moving).unwrap_or(moving)
}

/// Builder that folds the elements of a chain, added from base to tip.
pub(crate) struct ChainFolder {
    /// Constant transform since the last moving element, from that element's z-aligned frame.
    constant: Pose,
    frames: Vec<Frame>,
    motions: Vec<Transmission>,
    links: Vec<LinkFrame>,
    vector: Option<RotationVector>,
    curves: CurvedStages,
}

impl ChainFolder {
    /// Creates an empty chain that starts at `base`.
    pub fn new(base: &Pose) -> Self {
        let curves = CurvedStages::default();
        Self { constant: *base, frames: vec![], motions: vec![], links: vec![], vector: None, curves }
    }

    /// Appends a constant transform.
    pub fn fixed(&mut self, transform: &Pose) {
        self.constant *= transform;
    }

    /// Makes the current frame the frame of the next link.
    pub fn link(&mut self) {
        self.links.push(LinkFrame { stages: self.frames.len(), offset: Frame::from(&self.constant) });
    }

    /// Appends a motion about or along the unit vector `axis`.
    pub fn moving(&mut self, axis: &Vector3<f64>, motion: Transmission) {
        let aligned = pose::from_parts([0.0; 3], basis_with_z_along(axis));
        self.frames.push(Frame::from(&(self.constant * aligned)));
        self.motions.push(motion);
        self.constant = aligned.inverse();
    }

    /// Appends a motion about or along the unit vector `axis`, along a curve.
    pub fn curved(&mut self, axis: &Vector3<f64>, joint: usize, turns: bool, curve: &JointCurve) {
        self.curves.push(CurvedStage::new(self.frames.len(), *curve, turns));
        let aligned = pose::from_parts([0.0; 3], basis_with_z_along(axis));
        self.frames.extend([Frame::from(&(self.constant * aligned)), Frame::IDENTITY]);
        self.motions.extend([Transmission::curved(joint, turns, curve), Transmission::NONE]);
        self.constant = aligned.inverse();
    }

    /// Appends a rotation vector, stored in q from entry `joint` on. A chain has at most one.
    pub fn rotation_vector(&mut self, joint: usize) {
        let start = Frame::from(&self.constant);
        self.vector = Some(RotationVector { first: self.frames.len(), joint, start });
        self.frames.extend(RotationVector::at_zero(&start));
        self.motions.extend((0..3).map(|entry| Transmission::vector_entry(joint + entry)));
        self.motions.push(Transmission::NONE);
        self.constant = Pose::identity();
    }

    /// Returns the chain with its tip moved by `tool`. The chain must have at least one moving element and at most
    /// [`MAX_DOF`](crate::math::MAX_DOF).
    pub fn finish(self, tool: &Pose) -> Chain {
        let Self { constant, frames, mut motions, links, vector, curves } = self;
        let moving = frames.len();
        motions.resize(padded(moving).next_multiple_of(LANES), Transmission::NONE);
        let tip = Frame::from(&(constant * tool));
        Chain { moving, stages: Stages::new(&frames), motions, tip, links, vector, curves }
    }
}

/// Returns a rotation whose z axis is `axis`; exact if the axis is a coordinate axis.
pub(super) fn basis_with_z_along(axis: &Vector3<f64>) -> Matrix3<f64> {
    let helper = if axis.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
    let x = (helper - axis * axis.dot(&helper)).normalize();
    Matrix3::from_columns(&[x, axis.cross(&x), *axis])
}
