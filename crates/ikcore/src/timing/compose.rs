//! Joint motion from a speed profile.

use super::joint_path::JointPath;
use super::reachability::SpeedProfile;
use crate::error::Result;
use crate::trajectory::{Coefficients, Trajectory};

/// Returns the exact motion along `path` with this speed profile. On each segment s(t) = s_i + v t + w t^2, with v the
/// speed at its start and 2 w its acceleration; a cubic of that is a polynomial of degree 6 in t.
pub(super) fn compose(path: &JointPath, profile: &SpeedProfile) -> Result<Trajectory> {
    let (joints, count) = (path.joints(), profile.segments.len());
    let mut times = Vec::with_capacity(count + 1);
    let mut coefficients = Vec::with_capacity(count * joints.len());
    let mut now = 0.0;
    times.push(now);
    for (i, (segment, span)) in profile.segments.iter().zip(profile.spans()).enumerate() {
        now += span;
        times.push(now);
        let [x0, x1] = [profile.squared_speeds[i], profile.squared_speeds[i + 1]];
        let motion = [x0.sqrt(), 0.25 * (x1 - x0) / segment.length];
        let powers = path.powers(segment.piece);
        coefficients
            .extend((0..joints.len()).map(|j| cubic_of_parabola(powers.map(|power| power[j]), segment.from, motion)));
    }
    Trajectory::from_phases(joints.to_vec(), times, coefficients)
}

/// The coefficients in t of c(from + v t + w t^2).
fn cubic_of_parabola([c0, c1, c2, c3]: [f64; 4], from: f64, [v, w]: [f64; 2]) -> Coefficients {
    let k0 = c0 + from * (c1 + from * (c2 + from * c3));
    let k1 = c1 + from * (2.0 * c2 + from * 3.0 * c3);
    let k2 = c2 + 3.0 * c3 * from;
    [
        k0,
        k1 * v,
        k1 * w + k2 * v * v,
        2.0 * k2 * v * w + c3 * v * v * v,
        k2 * w * w + 3.0 * c3 * v * v * w,
        3.0 * c3 * v * w * w,
        c3 * w * w * w,
    ]
}
