//! Polynomials of a segment of length h (s) that meet given values at both ends: Hermite interpolation in the time
//! since its start, as trajectories store it. For the normalised parameter 0 to 1 see
//! [`Cubic`](crate::math::hermite::Cubic).

use super::coefficients::{Coefficients, polynomial};

/// The line through two positions.
pub(super) fn line(h: f64, [q0, q1]: [f64; 2]) -> Coefficients {
    polynomial([q0, (q1 - q0) / h])
}

/// The cubic with these positions and velocities at its ends.
pub(super) fn cubic(h: f64, [q0, q1]: [f64; 2], [v0, v1]: [f64; 2]) -> Coefficients {
    let slope = (q1 - q0) / h;
    polynomial([q0, v0, (3.0 * slope - 2.0 * v0 - v1) / h, (v0 + v1 - 2.0 * slope) / (h * h)])
}

/// The quintic with these positions, velocities and accelerations at its ends.
pub(super) fn quintic(h: f64, [q0, q1]: [f64; 2], [v0, v1]: [f64; 2], [a0, a1]: [f64; 2]) -> Coefficients {
    // Remaining differences at the end after coasting with the acceleration of the start.
    let position = q1 - (q0 + h * (v0 + 0.5 * h * a0));
    let velocity = h * (v1 - (v0 + h * a0));
    let acceleration = h * h * (a1 - a0);
    polynomial([
        q0,
        v0,
        0.5 * a0,
        (10.0 * position - 4.0 * velocity + 0.5 * acceleration) / h.powi(3),
        (-15.0 * position + 7.0 * velocity - acceleration) / h.powi(4),
        (6.0 * position - 3.0 * velocity + 0.5 * acceleration) / h.powi(5),
    ])
}
