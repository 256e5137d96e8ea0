//! Product-of-exponentials model of a chain: joint axes and tip frame in the zero configuration.

use crate::closed_form::angle::Angle;
use crate::math::Frame;
use crate::math::arithmetic::Baseline;
use crate::math::vector3::{Vector, add_scaled, dot, norm, scaled, sub};

/// Type of joint motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AxisKind {
    /// Rotation about the axis (rad).
    Turns,
    /// Translation along the axis (m).
    Slides,
}

/// Joint axis in the zero configuration, in base coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointAxis {
    /// Unit vector along the axis.
    pub axis: Vector,
    /// Point on the axis (m).
    pub point: Vector,
    /// Revolute or prismatic.
    pub motion: AxisKind,
}

impl JointAxis {
    /// Returns a revolute joint about the line through `point` along `axis`.
    pub fn turning(axis: Vector, point: Vector) -> Self {
        Self { axis, point, motion: AxisKind::Turns }
    }

    /// Returns a prismatic joint along `axis`.
    pub fn sliding(axis: Vector) -> Self {
        Self { axis, point: [0.0; 3], motion: AxisKind::Slides }
    }

    /// Returns the joint axis moved by the rigid motion `frame`.
    pub fn moved(&self, frame: &Frame) -> Self {
        Self {
            axis: frame.turn::<Baseline>(&self.axis),
            point: frame.transform::<Baseline>(&self.point),
            motion: self.motion,
        }
    }

    /// Returns the displacement by `value` (rad or m).
    pub fn displacement(&self, value: f64) -> Frame {
        self.displacement_by(self.turn(value))
    }

    /// Converts `value` (rad or m) to the form used in candidates: a prismatic displacement is stored in the sine.
    #[inline]
    pub fn turn(&self, value: f64) -> Angle {
        match self.motion {
            AxisKind::Turns => Angle::by(value),
            AxisKind::Slides => Angle { cos: 1.0, sin: value },
        }
    }

    /// Returns the displacement by a [`Self::turn`].
    #[inline]
    pub fn displacement_by(&self, turn: Angle) -> Frame {
        match self.motion {
            AxisKind::Turns => turn.about_line(&self.axis, &self.point),
            AxisKind::Slides => Frame { origin: scaled(&self.axis, turn.sin), ..Frame::IDENTITY },
        }
    }

    /// Returns the point of the axis nearest to `other`.
    pub fn nearest_to(&self, other: &Vector) -> Vector {
        add_scaled(&self.point, &self.axis, dot(&self.axis, &sub(other, &self.point)))
    }
}

/// Chain of N joints from base to tip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisChain<const N: usize> {
    /// Joints, base first.
    pub joints: [JointAxis; N],
    /// Tip frame in the zero configuration.
    pub tip: Frame,
}

/// Returns the joints of the chain from tip to base: in reverse order, with reversed axes.
pub fn reversed<const N: usize>(joints: &[JointAxis; N]) -> [JointAxis; N] {
    let mut joints = joints.map(|joint| JointAxis { axis: scaled(&joint.axis, -1.0), ..joint });
    joints.reverse();
    joints
}

impl<const N: usize> AxisChain<N> {
    /// Returns the tip frame at joint values `q`.
    pub fn tip_at(&self, q: &[f64; N]) -> Frame {
        let displacement = self
            .joints
            .iter()
            .zip(q)
            .fold(Frame::IDENTITY, |sum, (joint, q)| sum.then::<Baseline>(&joint.displacement(*q)));
        displacement.then::<Baseline>(&self.tip)
    }

    /// Returns a characteristic length of the arm (m): the sum of the distances between neighbouring revolute axes.
    pub fn size(&self) -> f64 {
        let mut turning = self.joints.iter().filter(|joint| joint.motion == AxisKind::Turns);
        let Some(first) = turning.next() else { return 1.0 };
        let mut at = first.point;
        let mut sum = 0.0;
        for joint in turning {
            let next = joint.nearest_to(&at);
            sum += norm(&sub(&next, &at));
            at = next;
        }
        if sum > 0.0 { sum } else { 1.0 }
    }

    /// Opens the loop after the first `count` joints: these are moved behind the last joint by the inverse of `displacement`,
    /// so that the product of all displacements stays the same.
    pub fn rotated(joints: &[JointAxis; N], displacement: &Frame, count: usize) -> [JointAxis; N] {
        let back = displacement.inverse();
        std::array::from_fn(|k| match k + count {
            at if at < N => joints[at],
            at => joints[at - N].moved(&back),
        })
    }
}

#[cfg(test)]
impl<const N: usize> AxisChain<N> {
    /// Builds an arm from rows (a, alpha, d, theta) of a standard Denavit-Hartenberg table.
    pub fn of_rows(rows: &[[f64; 4]; N]) -> Self {
        let mut at = Frame::IDENTITY;
        let joints = rows.map(|[a, alpha, d, theta]| {
            let joint = JointAxis::turning(at.axes[2], at.origin);
            let (sine, cosine) = alpha.sin_cos();
            let link =
                Frame { axes: [[1.0, 0.0, 0.0], [0.0, cosine, sine], [0.0, -sine, cosine]], origin: [a, 0.0, d] };
            at = at.turned::<Baseline>(theta.sin(), theta.cos()).then::<Baseline>(&link);
            joint
        });
        Self { joints, tip: at }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loop_opened_elsewhere_has_the_same_product() {
        let joints = [
            JointAxis::turning([0.0, 0.0, 1.0], [0.1, 0.0, 0.0]),
            JointAxis::turning([0.0, 1.0, 0.0], [0.0, 0.2, 0.3]),
            JointAxis::sliding([1.0, 0.0, 0.0]),
        ];
        let q = [0.4, -1.1, 0.2];
        let product =
            |joints: &[JointAxis; 3], q: [f64; 3]| AxisChain { joints: *joints, tip: Frame::IDENTITY }.tip_at(&q);
        let displacement = product(&joints, q);
        let rotated = product(&AxisChain::rotated(&joints, &displacement, 2), [q[2], q[0], q[1]]);
        for (a, b) in rotated.axes.iter().flatten().zip(displacement.axes.iter().flatten()) {
            assert!((a - b).abs() < 1e-15);
        }
        assert!(norm(&sub(&rotated.origin, &displacement.origin)) < 1e-15);
    }
}
