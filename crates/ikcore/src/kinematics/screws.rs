//! Screws of a chain at a configuration: the velocity that each moving element imparts to everything after it.

use super::chain::{Chain, Transmission};
use crate::math::arithmetic::NoFma;
use crate::math::vector3::{cross, scaled, sub};
use crate::math::{Frame, MAX_DOF};

/// Screw of a moving element in base axes, per unit speed of its joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Screw {
    /// Index in q of the joint that drives the element.
    pub joint: usize,
    /// Angular velocity.
    pub turn: [f64; 3],
    /// Linear velocity of the points on the axis.
    pub slide: [f64; 3],
    /// Point on the axis (m).
    pub origin: [f64; 3],
    /// Origin of the next moving element, or the tip for the last one (m).
    pub end: [f64; 3],
}

impl Screw {
    const NONE: Self = Self { joint: 0, turn: [0.0; 3], slide: [0.0; 3], origin: [0.0; 3], end: [0.0; 3] };

    /// Returns the linear and angular velocity of a point after this element: its contribution to the Jacobian column of its
    /// joint.
    pub fn column(&self, point: &[f64; 3]) -> [f64; 6] {
        let [x, y, z] = cross(&self.turn, &sub(point, &self.origin));
        let ([sx, sy, sz], [wx, wy, wz]) = (self.slide, self.turn);
        [x + sx, y + sy, z + sz, wx, wy, wz]
    }
}

/// Screws of a chain, base to tip.
#[derive(Debug, Clone)]
pub struct Screws {
    all: [Screw; MAX_DOF],
    count: usize,
}

impl std::ops::Deref for Screws {
    type Target = [Screw];

    fn deref(&self) -> &[Screw] {
        &self.all[..self.count]
    }
}

impl Screws {
    /// Returns the screws of `chain` with its stages at `reached`, mimics included.
    pub(crate) fn of(chain: &Chain, reached: &[Frame]) -> Self {
        // Padding is dropped. A mimic of factor zero moves nothing either, but moving elements may follow it.
        let count = chain.motions.iter().rposition(moves).map_or(0, |last| last + 1);
        let mut screws = Self { all: [Screw::NONE; MAX_DOF], count };
        for (i, screw) in screws.all[..count].iter_mut().enumerate() {
            let (motion, Frame { axes: [_, _, axis], origin }) = (&chain.motions[i], reached[i + 1]);
            let end = if i + 1 < count { chain.stages.frame(i + 1).origin } else { chain.tip.origin };
            *screw = Screw {
                joint: motion.joint,
                turn: scaled(&axis, motion.turn_scale),
                slide: scaled(&axis, motion.slide_scale),
                origin,
                end: reached[i + 1].transform::<NoFma>(&end),
            };
        }
        screws
    }
}

fn moves(motion: &Transmission) -> bool {
    motion.turn_scale != 0.0 || motion.slide_scale != 0.0
}
