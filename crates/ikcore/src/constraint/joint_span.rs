//! Intervals of joint motions.

use super::tip_jet::{TipElements, TipJet};
use crate::kinematics::link_tree::FrameBuffer;
use crate::math::Frame;
use crate::math::bernstein::bernstein;
use crate::math::majorant::Majorant;
use crate::robot::Robot;
use crate::trajectory::{Coefficients, POWERS, derivative_bounds};

/// Number of coefficients of a rate that bounds of torques use.
const RATES: usize = 5;

/// An interval of a joint motion: its polynomials on \[-1, 1\], and the moving elements in its middle. Reused for any number of them.
#[derive(Debug, Clone)]
pub(crate) struct JointSpan {
    joints: Vec<Coefficients>,
    q: Vec<f64>,
    frames: FrameBuffer,
}

impl JointSpan {
    /// An interval of a motion of `robot`.
    pub fn new(robot: &Robot) -> Self {
        let n = robot.dof();
        Self { joints: vec![[0.0; POWERS]; n], q: vec![0.0; n], frames: robot.frame_buffer() }
    }

    /// Becomes the interval around `middle`, `half` to either side, of these polynomials.
    pub fn set(&mut self, robot: &Robot, polynomials: impl Iterator<Item = Coefficients>, interval: [f64; 2]) {
        self.set_joints(polynomials, interval);
        robot.write_frames(&self.q, &mut self.frames);
    }

    /// [`set`](Self::set) for the joints alone: the moving elements stay where they were.
    pub fn set_joints(&mut self, polynomials: impl Iterator<Item = Coefficients>, [middle, half]: [f64; 2]) {
        for ((joint, q), polynomial) in self.joints.iter_mut().zip(&mut self.q).zip(polynomials) {
            *joint = polynomial;
            for first in 0..POWERS - 1 {
                for power in (first..POWERS - 1).rev() {
                    joint[power] += middle * joint[power + 1];
                }
            }
            let mut scale = 1.0;
            for c in joint.iter_mut() {
                *c *= scale;
                scale *= half;
            }
            *q = joint[0];
        }
    }

    /// The motion of the tip that these elements carry.
    pub fn jet(&self, robot: &Robot, elements: &TipElements) -> TipJet {
        elements.jet(robot, &self.frames, &self.joints)
    }

    /// Writes the positions of the joints and their first two derivatives by x, at x on \[-1, 1\].
    pub fn write(&self, x: f64, [q, first, second]: [&mut [f64]; 3]) {
        for (((polynomial, q), first), second) in self.joints.iter().zip(q).zip(first).zip(second) {
            [*q, *first, *second] = [0.0; 3];
            for c in polynomial.iter().rev() {
                *second = *second * x + 2.0 * *first;
                *first = *first * x + *q;
                *q = *q * x + c;
            }
        }
    }

    /// The derivative of a joint by x, at x on \[-1, 1\].
    pub fn rate(&self, joint: usize, x: f64) -> f64 {
        self.rate_powers(joint).iter().rev().fold(0.0, |sum, c| sum * x + c)
    }

    /// A range that holds the derivative of a joint by x everywhere on \[-1, 1\].
    pub fn rate_range(&self, joint: usize) -> [f64; 2] {
        let points = bernstein(&self.rate_powers(joint));
        [points.into_iter().fold(f64::INFINITY, f64::min), points.into_iter().fold(f64::NEG_INFINITY, f64::max)]
    }

    fn rate_powers(&self, joint: usize) -> [f64; POWERS - 1] {
        std::array::from_fn(|k| (k + 1) as f64 * self.joints[joint][k + 1])
    }

    /// Bounds of the Taylor coefficients of the derivative of a joint, at every point of the interval.
    pub fn rates(&self, joint: usize) -> Majorant {
        Majorant::of(derivative_bounds::<RATES>(&self.joints[joint]))
    }

    /// The largest distance of a joint from zero.
    pub fn farthest(&self, joint: usize) -> f64 {
        self.joints[joint].iter().map(|c| c.abs()).sum()
    }

    /// The moving elements in the middle.
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }
}
