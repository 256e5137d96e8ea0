//! A chain as data: the axes of its joints in the zero configuration and the tip frame there (product of exponentials).

use crate::closed_form::angle::Angle;
use crate::closed_form::vector::{Vector, add_scaled, dot, norm, scaled, sub};
use crate::math::Frame;
use crate::math::arithmetic::Baseline;

/// How a joint moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AxisKind {
    /// It turns about its axis (rad).
    Turns,
    /// It slides along its axis (m).
    Slides,
}

/// A joint in the zero configuration, seen from the base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointAxis {
    /// Unit vector along the axis.
    pub axis: Vector,
    /// A point on the axis (m).
    pub point: Vector,
    /// How it moves.
    pub motion: AxisKind,
}

impl JointAxis {
    /// A joint that turns about the line through `point` along `axis`.
    pub fn turning(axis: Vector, point: Vector) -> Self {
        Self { axis, point, motion: AxisKind::Turns }
    }

    /// A joint that slides along `axis`.
    pub fn sliding(axis: Vector) -> Self {
        Self { axis, point: [0.0; 3], motion: AxisKind::Slides }
    }

    /// The same joint seen from where `frame` moves it.
    pub fn moved(&self, frame: &Frame) -> Self {
        Self {
            axis: frame.turn::<Baseline>(&self.axis),
            point: frame.place::<Baseline>(&self.point),
            motion: self.motion,
        }
    }

    /// The displacement by `value` (rad or m).
    pub fn displacement(&self, value: f64) -> Frame {
        self.displacement_by(self.turn(value))
    }

    /// `value` (rad or m) as candidates hold it: a slide in the sine.
    #[inline]
    pub fn turn(&self, value: f64) -> Angle {
        match self.motion {
            AxisKind::Turns => Angle::by(value),
            AxisKind::Slides => Angle { cos: 1.0, sin: value },
        }
    }

    /// The displacement by a [`Self::turn`].
    #[inline]
    pub fn displacement_by(&self, turn: Angle) -> Frame {
        match self.motion {
            AxisKind::Turns => turn.about_line(&self.axis, &self.point),
            AxisKind::Slides => Frame { origin: scaled(&self.axis, turn.sin), ..Frame::IDENTITY },
        }
    }

    /// The point of the axis nearest to `other`.
    pub fn nearest_to(&self, other: &Vector) -> Vector {
        add_scaled(&self.point, &self.axis, dot(&self.axis, &sub(other, &self.point)))
    }
}

/// N joints from base to tip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisChain<const N: usize> {
    /// The joints, base first.
    pub joints: [JointAxis; N],
    /// The tip in the zero configuration.
    pub tip: Frame,
}

impl<const N: usize> AxisChain<N> {
    /// The tip at joint values `q`.
    pub fn tip_at(&self, q: &[f64; N]) -> Frame {
        let displacement = self
            .joints
            .iter()
            .zip(q)
            .fold(Frame::IDENTITY, |sum, (joint, q)| sum.then::<Baseline>(&joint.displacement(*q)));
        displacement.then::<Baseline>(&self.tip)
    }

    /// A length of the size of the arm (m): the sum of the distances between neighbouring axes that turn, along the chain.
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

    /// The loop opened after the first `count` joints: those joints follow the last one, carried there by the inverse of
    /// `displacement`, and the product of all displacements stays the same.
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
    /// An arm from rows (a, alpha, d, theta) of a standard Denavit-Hartenberg table.
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
