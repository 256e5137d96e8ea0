//! A line or an arc of the tip, before its corners are rounded.

use std::f64::consts::TAU;

use nalgebra::{Rotation3, Vector3};

use super::move_task::MoveTask;
use super::program::{Move, MoveKind};
use crate::error::{Error, Result};
use crate::math::so3::rotation_between;
use crate::math::{Frame, Pose};

/// Length (m) and angle (rad) below which a move counts as zero.
const NOTHING: f64 = 1e-9;

/// Length (m) for each radian of a turn on the spot, which has no length of its own.
pub(super) const TURN_RADIUS: f64 = 0.1;

/// Sine of the angle between two chords of an arc below which its points count as on a line.
const STRAIGHT: f64 = 1e-6;

/// Position of the tip by its length along a move.
#[derive(Debug, Clone)]
pub(super) enum LegCurve {
    /// From a point along a direction: of unit length, or zero for a turn on the spot.
    Line { from: Vector3<f64>, direction: Vector3<f64> },
    /// About a centre, from the unit vector `x` towards `y`.
    Circle { centre: Vector3<f64>, x: Vector3<f64>, y: Vector3<f64>, radius: f64 },
}

/// The path of one move of the tip.
#[derive(Debug, Clone)]
pub(super) struct Leg {
    /// Index of the move.
    pub index: usize,
    /// Position by length.
    pub curve: LegCurve,
    /// Orientation at the start.
    pub begin: Rotation3<f64>,
    /// Rotation vector per length, in the axes of the base (rad/m).
    pub rate: Vector3<f64>,
    /// Length (m).
    pub length: f64,
    /// Requested speed of the tip (m/s), if any.
    pub speed: Option<f64>,
}

impl Leg {
    /// The leg of a Cartesian move from `start`; `None` if it ends where it starts, as far as `task` can tell.
    ///
    /// # Errors
    /// [`Error::InvalidMove`] for an arc that its points do not define.
    pub fn of(index: usize, each: &Move, start: &Pose, task: &MoveTask) -> Result<Option<Self>> {
        let (curve, length, end) = match &each.kind {
            MoveKind::Line { pose, .. } => {
                let (curve, length) = line(start, pose);
                (curve, length, pose)
            }
            MoveKind::Arc { via, pose, angle, .. } => {
                let (curve, length) = arc(start, via, pose, *angle)
                    .map_err(|problem| Error::InvalidMove { what: each.named(index), problem: problem.into() })?;
                (curve, length, pose)
            }
            MoveKind::Joints(_) | MoveKind::Wait(_) => return Ok(None),
        };
        let [from, to] = [start, end].map(Frame::from);
        let turn = Vector3::from(rotation_between(&from, &to));
        if length <= NOTHING && !task.is_whole() && task.turn_between(&from, &to) <= NOTHING {
            return Ok(None);
        }
        let length = if length > NOTHING { length } else { TURN_RADIUS * turn.norm() };
        if length <= NOTHING * TURN_RADIUS {
            return Ok(None);
        }
        Ok(Some(Self { index, curve, begin: start.rotation, rate: turn / length, length, speed: each.speed() }))
    }

    /// Whether the tip stays where it is, and only turns.
    pub fn turns_on_the_spot(&self) -> bool {
        matches!(&self.curve, LegCurve::Line { direction, .. } if direction.norm_squared() == 0.0)
    }

    /// Position, direction and curvature of the tip at the length `s`.
    pub fn at(&self, s: f64) -> [Vector3<f64>; 3] {
        match &self.curve {
            LegCurve::Line { from, direction } => [from + s * direction, *direction, Vector3::zeros()],
            LegCurve::Circle { centre, x, y, radius } => {
                let (sine, cosine) = (s / radius).sin_cos();
                let outward = cosine * x + sine * y;
                [centre + *radius * outward, cosine * y - sine * x, -outward / *radius]
            }
        }
    }

    /// Orientation of the tip at the length `s`.
    pub fn orientation(&self, s: f64) -> Rotation3<f64> {
        Rotation3::new(s * self.rate) * self.begin
    }

    /// Pose of the tip at the length `s`.
    pub fn pose(&self, s: f64) -> Pose {
        Pose::from_parts(self.at(s)[0].into(), self.orientation(s))
    }

    /// Length along the leg from one of its ends to where it leaves a ball of `radius` about that end; infinite where it never does.
    pub fn length_within(&self, radius: f64) -> f64 {
        match &self.curve {
            LegCurve::Line { .. } if self.turns_on_the_spot() => f64::INFINITY,
            LegCurve::Line { .. } => radius,
            LegCurve::Circle { radius: of_arc, .. } if radius < 2.0 * of_arc => {
                2.0 * of_arc * (0.5 * radius / of_arc).asin()
            }
            LegCurve::Circle { .. } => f64::INFINITY,
        }
    }
}

fn line(start: &Pose, end: &Pose) -> (LegCurve, f64) {
    let from = start.translation.vector;
    let way = end.translation.vector - from;
    let length = way.norm();
    let direction = if length > NOTHING { way / length } else { Vector3::zeros() };
    (LegCurve::Line { from, direction }, length)
}

/// The arc from `start` through `via` to `end`, or until `angle`.
fn arc(start: &Pose, via: &[f64; 3], end: &Pose, angle: Option<f64>) -> Result<(LegCurve, f64), String> {
    let [a, b, c] = [start.translation.vector, Vector3::from(*via), end.translation.vector];
    let (first, second) = (b - a, c - a);
    let normal = first.cross(&second);
    let sizes = [first.norm(), second.norm(), (c - b).norm()];
    if sizes.iter().any(|size| *size <= NOTHING) {
        let [one, other] = match sizes.map(|size| size <= NOTHING) {
            [true, _, _] => ["its start", "via"],
            [_, true, _] => ["its start", "its end"],
            _ => ["via", "its end"],
        };
        return Err(format!(
            "an arc needs three points, and {one} is {other}: for a full circle give another point of it as the end, and the angle"
        ));
    }
    if normal.norm() <= STRAIGHT * sizes[0] * sizes[1] {
        return Err("the three points of the arc are on a line: move via off it, or give a line".into());
    }
    let squared = normal.norm_squared();
    let to_centre =
        (second.norm_squared() * normal.cross(&first) - first.norm_squared() * normal.cross(&second)) / (2.0 * squared);
    let centre = a + to_centre;
    let radius = to_centre.norm();
    let (x, axis) = (-to_centre / radius, normal / squared.sqrt());
    let y = axis.cross(&x);
    let swept = (c - centre).dot(&y).atan2((c - centre).dot(&x)).rem_euclid(TAU);
    Ok((LegCurve::Circle { centre, x, y, radius }, radius * angle.unwrap_or(swept)))
}
