//! A smooth clock that starts and stops a path: the path parameter is s = 10 u^3 - 15 u^4 + 6 u^5 of its length.
//!
//! With limited jerk a motion leaves rest as t^3, and s leaves its start as u^3. So the rate du/dt of a motion from rest to rest is smooth and
//! positive everywhere.

use super::super::joint_path::JointPath;
use crate::trajectory::{Coefficients, polynomial};

/// Bisections after which a root is known to its last digits.
const BISECTIONS: usize = 60;

/// The clock of a path.
#[derive(Debug, Clone, Copy)]
pub(super) struct Clock<'a> {
    path: &'a JointPath,
    /// Factor of the largest path speeds.
    pub speedup: f64,
}

/// Where the path is at a reading of the clock.
#[derive(Debug, Clone, Copy)]
pub(super) struct PathPoint<'a> {
    path: &'a JointPath,
    /// Factor of the largest path speeds.
    speedup: f64,
    piece: usize,
    from: f64,
    /// Derivatives of the path parameter by the clock.
    rates: [f64; 3],
}

impl<'a> Clock<'a> {
    pub(super) fn new(path: &'a JointPath) -> Self {
        Self { path, speedup: 1.0 }
    }

    /// Path parameter of the start, and the length of the path.
    fn extent(&self) -> [f64; 2] {
        let breaks = self.path.breaks();
        [breaks[0], breaks[self.path.pieces()] - breaks[0]]
    }

    /// The reading at the path parameter `s`.
    pub(super) fn reading(&self, s: f64) -> f64 {
        let [begin, length] = self.extent();
        let fraction = ((s - begin) / length).clamp(0.0, 1.0);
        let [mut low, mut high] = [0.0, 1.0];
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            if passed(middle) < fraction {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }

    /// Where the path is at the reading `u`. At a break it is in the piece of the reading `beside`.
    pub(super) fn at(&self, u: f64, beside: f64) -> PathPoint<'a> {
        let [begin, length] = self.extent();
        let parameter = |u: f64| begin + length * passed(u);
        let s = parameter(u);
        let (piece, _) = self.path.locate(parameter(beside));
        let [from, end] = [self.path.breaks()[piece], self.path.breaks()[piece + 1]];
        let rounding = 1e-12 * length;
        let is_inside = from - rounding <= s && s <= end + rounding;
        let (piece, from) =
            if is_inside { (piece, (s - from).clamp(0.0, self.path.length(piece))) } else { self.path.locate(s) };
        let left = 1.0 - u;
        let rates = [30.0 * (u * left).powi(2), 60.0 * u * left * (left - u), 60.0 * (1.0 - 6.0 * u * left)];
        PathPoint { path: self.path, speedup: self.speedup, piece, from, rates: rates.map(|rate| length * rate) }
    }
}

impl PathPoint<'_> {
    /// 1 / (du/dt)^2 where the path has its largest speed; zero without one.
    pub(super) fn slowness(&self) -> f64 {
        (self.rates[0] / (self.speedup * self.path.largest_speed(self.piece))).powi(2)
    }

    /// Position of a joint, and its first three derivatives by the clock.
    pub(super) fn joint(&self, joint: usize) -> [f64; 4] {
        let [position, first, second] = self.path.joint_at(self.piece, self.from, joint);
        let third = 6.0 * self.path.powers(self.piece)[3][joint];
        let [s1, s2, s3] = self.rates;
        [position, first * s1, second * s1 * s1 + first * s2, third * s1.powi(3) + 3.0 * second * s1 * s2 + first * s3]
    }

    /// Position of a joint as a polynomial in the distance of the clock from here, up to the third power.
    pub(super) fn expansion(&self, joint: usize) -> Coefficients {
        let [position, first, second, third] = self.joint(joint);
        polynomial([position, first, second / 2.0, third / 6.0])
    }
}

/// Fraction of the path that is passed at a reading.
fn passed(u: f64) -> f64 {
    // From the nearer end, so that a small rest keeps its digits.
    let from_start = |u: f64| u * u * u * (10.0 + u * (6.0 * u - 15.0));
    if u < 0.5 { from_start(u) } else { 1.0 - from_start(1.0 - u) }
}
