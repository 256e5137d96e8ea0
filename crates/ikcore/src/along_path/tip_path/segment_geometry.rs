//! Straight segments between positions (m).

use crate::math::so3::{cross, norm};
use crate::math::vector::{dot, squared_distance};

/// Change of direction (rad) at the middle one of three positions; 0 without a direction.
pub(super) fn turn(before: [f64; 3], here: [f64; 3], after: [f64; 3]) -> f64 {
    let (u, v) = (way(before, here), way(here, after));
    norm(&cross(&u, &v)).atan2(dot(&u, &v))
}

/// The squared distance of a position from the segment between two others.
pub(super) fn squared_distance_to_segment(position: [f64; 3], from: [f64; 3], to: [f64; 3]) -> f64 {
    let along = way(from, to);
    let squared = dot(&along, &along);
    let part = if squared > 0.0 { (dot(&way(from, position), &along) / squared).clamp(0.0, 1.0) } else { 0.0 };
    let nearest: [f64; 3] = std::array::from_fn(|k| from[k] + part * along[k]);
    squared_distance(&position, &nearest)
}

fn way(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| b[k] - a[k])
}
