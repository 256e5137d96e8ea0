//! The chain in the form that the kernels run through: per moving element one constant frame, then a turn about and a
//! slide along its own z axis. Constant transforms and the directions of axes are folded in when the robot is built.

use nalgebra::{Matrix3, Vector3};

use super::dispatch::Kernels;
use super::reach::Reach;
use super::stages::Stages;
use crate::math::{Frame, Pose, pose};
use crate::robot::Element;

/// What drives a stage: turn = turn_scale * q\[joint\] + turn_offset, and likewise the slide. One of the scales is zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Motion {
    pub joint: usize,
    pub turn_scale: f64,
    pub turn_offset: f64,
    pub slide_scale: f64,
    pub slide_offset: f64,
}

impl Motion {
    const NONE: Self = Self { joint: 0, turn_scale: 0.0, turn_offset: 0.0, slide_scale: 0.0, slide_offset: 0.0 };
}

/// Where a link sits: after so many stages, at a constant frame from there.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LinkFrame {
    pub name: String,
    pub stages: usize,
    pub offset: Frame,
}

/// The folded chain.
#[derive(Debug, Clone)]
pub(crate) struct Chain {
    /// How many elements move; the rest of the stages is padding.
    pub moving: usize,
    /// One per moving element.
    pub stages: Stages,
    /// One per moving element, then padding that moves nothing.
    pub motions: Vec<Motion>,
    pub tip: Frame,
    pub links: Vec<LinkFrame>,
    /// How far the tip can be from the first joint, sliding aside.
    pub stretched: Reach,
    pub kernels: Kernels,
}

/// Numbers of stages that kernels are compiled for. Chains are padded up to the next one.
pub(crate) const SIZES: [usize; 8] = [4, 5, 6, 7, 8, 12, 16, 32];

/// Sines are taken four at a time: a remainder of one to three costs as much as all the rest (measured).
const LANES: usize = 4;

impl Chain {
    /// Folds `elements` between `base` and `tool`. The number of moving elements has been checked.
    pub fn new(elements: &[Element], base: &Pose, tool: &Pose) -> Self {
        let (mut stages, mut motions, mut links) = (vec![], vec![], vec![]);
        // Constant transform since the last moving element, already in that element's z-aligned frame.
        let mut constant = *base;
        for element in elements {
            match element {
                Element::Fixed(transform) => constant *= transform,
                Element::Link(name) => {
                    let offset = Frame::from(&constant);
                    links.push(LinkFrame { name: name.clone(), stages: stages.len(), offset });
                }
                Element::Moving { axis, turns, joint, scale, offset } => {
                    let aligned = pose::from_parts([0.0; 3], basis_with_z_along(axis));
                    stages.push(Frame::from(&(constant * aligned)));
                    motions.push(if *turns {
                        Motion { joint: *joint, turn_scale: *scale, turn_offset: *offset, ..Motion::NONE }
                    } else {
                        Motion { joint: *joint, slide_scale: *scale, slide_offset: *offset, ..Motion::NONE }
                    });
                    constant = aligned.inverse();
                }
            }
        }
        let tip = Frame::from(&(constant * tool));
        let moving = stages.len();
        let padded = SIZES.into_iter().find(|size| *size >= moving).unwrap_or(moving);
        motions.resize(padded.next_multiple_of(LANES), Motion::NONE);
        Self {
            moving,
            stretched: Reach::of_links(&stages, &motions, &tip),
            stages: Stages::new(&stages),
            motions,
            tip,
            links,
            kernels: Kernels::for_stages(padded),
        }
    }
}

/// A rotation whose z axis is `axis`; exact where the axis is a coordinate axis.
fn basis_with_z_along(axis: &Vector3<f64>) -> Matrix3<f64> {
    let helper = if axis.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
    let x = (helper - axis * axis.dot(&helper)).normalize();
    Matrix3::from_columns(&[x, axis.cross(&x), *axis])
}
