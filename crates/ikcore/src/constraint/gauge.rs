//! One error of a task: its value, and its bound between two configurations.
//!
//! Distances, coordinates and the chords of angles are convex functions of where a point or a unit vector is. So between two
//! configurations they exceed the larger of their values there by no more than the [`TipBend`]. Entries of a rotation vector are not
//! convex; the bound of their second derivative is at [`turned`]. The same holds for all configurations between the control points of a
//! spline, where the bend is that of a motion that reaches across all of them.

use std::f64::consts::{PI, SQRT_2};

use super::drift::SeenRates;
use super::tip_bend::TipBend;
use crate::math::Frame;
use crate::math::arithmetic::NoFma;
use crate::math::so3::{norm, rotation_between};
use crate::math::vector::dot;
use crate::task::{Criterion, Region, Target};
use crate::wording::number;

/// Angle (rad) of a rotation beyond which no bound of its vector is sought on a whole interval.
const MOST_TURNED: f64 = 4.0;

/// Fraction by which rounding may exceed a tolerance.
const ROUNDING: f64 = 1e-9;
/// Value (m, rad) whose rounding is added to every tolerance, for those of zero.
const LEAST: f64 = 1e-3;

/// An error that stays within its tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Gauge {
    kind: Kind,
    /// Entry of the task that it bounds.
    pub entry: usize,
    /// Largest value (m, rad).
    pub tolerance: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// Distance from the target (m).
    Distance,
    /// Coordinate (m) relative to the target, without its sign.
    Coordinate(usize),
    /// Angle to the target's orientation (rad).
    Turn,
    /// Entry of the rotation vector from the target (rad), without its sign.
    TurnAbout(usize),
    /// Angle between an axis and that of the target (rad).
    Tilt,
    /// Distance (m) above or below a face of a region, which holds where it is not positive.
    Face { coordinate: usize, at: f64, above: bool },
}

/// A subject as its target sees it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    /// Position (m).
    origin: [f64; 3],
    /// Position relative to the target (m), along the axes of the target, or of the base if it has none.
    offset: [f64; 3],
    /// Rotation vector from the target (rad), along the same axes.
    turn: [f64; 3],
    /// Length of the difference of both axes of a pointing target.
    axis_chord: f64,
}

impl Seen {
    /// Sees the subject at `frame` from `target`.
    pub fn from(target: &Target, frame: &Frame) -> Self {
        let wanted = target.position().unwrap_or(frame.origin);
        let apart = std::array::from_fn(|k| frame.origin[k] - wanted[k]);
        let nowhere = Self { origin: frame.origin, offset: apart, turn: [0.0; 3], axis_chord: 0.0 };
        match target {
            Target::Position(_) => nowhere,
            Target::Pose(to) | Target::Orientation(to) => {
                let turn = to.turn_back(&rotation_between(to, frame));
                Self { offset: to.turn_back(&apart), turn, ..nowhere }
            }
            Target::Pointing { frame: to, axis } => {
                let [one, other] = [frame, to].map(|frame| frame.turn::<NoFma>(axis));
                let axis_chord = norm(&std::array::from_fn(|k| one[k] - other[k]));
                Self { offset: to.turn_back(&apart), axis_chord, ..nowhere }
            }
        }
    }
}

impl Gauge {
    /// The errors that `criterion` bounds for `target`.
    pub fn all(target: &Target, criterion: &Criterion) -> Vec<Self> {
        let has_position = !matches!(target, Target::Orientation(_));
        let mut gauges = match &criterion.components {
            None => Self::whole(target, criterion, has_position),
            Some(components) => {
                let default = |row: usize| [criterion.tolerance.position, criterion.tolerance.rotation][row / 3];
                let tolerance = |row: usize| match components.weights[row] {
                    0.0 => f64::INFINITY,
                    _ => components.tolerance.map_or(default(row), |tolerance| tolerance[row]),
                };
                Self::by_component(target, tolerance, has_position)
            }
        };
        gauges.extend(criterion.region.iter().flat_map(Self::faces));
        gauges.retain(|gauge| gauge.tolerance < f64::INFINITY);
        gauges
    }

    fn whole(target: &Target, criterion: &Criterion, has_position: bool) -> Vec<Self> {
        let distance = Self { kind: Kind::Distance, entry: 0, tolerance: criterion.tolerance.position };
        let angle = |kind| Self { kind, entry: usize::from(has_position), tolerance: criterion.tolerance.rotation };
        let angle = match target {
            Target::Position(_) => None,
            Target::Pointing { .. } => Some(angle(Kind::Tilt)),
            Target::Pose(_) | Target::Orientation(_) => Some(angle(Kind::Turn)),
        };
        has_position.then_some(distance).into_iter().chain(angle).collect()
    }

    fn by_component(target: &Target, tolerance: impl Fn(usize) -> f64, has_position: bool) -> Vec<Self> {
        let rotation = if has_position { 3 } else { 0 };
        let position = (0..rotation).map(|k| Self { kind: Kind::Coordinate(k), entry: k, tolerance: tolerance(k) });
        let angles: Vec<Self> = match target {
            Target::Position(_) => vec![],
            Target::Pointing { .. } => vec![Self { kind: Kind::Tilt, entry: 3, tolerance: tolerance(3) }],
            Target::Pose(_) | Target::Orientation(_) => {
                let about = |k| Self { kind: Kind::TurnAbout(k), entry: rotation + k, tolerance: tolerance(3 + k) };
                (0..3).map(about).collect()
            }
        };
        position.chain(angles).collect()
    }

    fn faces(region: &Region) -> Vec<Self> {
        let face = |coordinate: usize, at: f64, above: bool| Self {
            kind: Kind::Face { coordinate, at, above },
            entry: coordinate,
            tolerance: if at.is_finite() { 0.0 } else { f64::INFINITY },
        };
        let both = |k: usize| [face(k, region.lower()[k], false), face(k, region.upper()[k], true)];
        (0..3).flat_map(both).collect()
    }

    /// Whether it measures an entry of the task; a face of a region is none.
    pub fn is_of_task(&self) -> bool {
        !matches!(self.kind, Kind::Face { .. })
    }

    /// Names the measured quantity.
    pub fn named(&self) -> String {
        let axis = |k: usize| ["x", "y", "z"][k];
        match self.kind {
            Kind::Distance => "distance".into(),
            Kind::Coordinate(k) => format!("deviation in {}", axis(k)),
            Kind::Turn => "angle".into(),
            Kind::TurnAbout(k) => format!("rotation about {}", axis(k)),
            Kind::Tilt => "tilt".into(),
            Kind::Face { coordinate, at, above } => {
                format!("distance {} {} = {} m", if above { "above" } else { "below" }, axis(coordinate), number(at))
            }
        }
    }

    /// Unit of the value.
    pub fn unit(&self) -> &'static str {
        match self.kind {
            Kind::Turn | Kind::TurnAbout(_) | Kind::Tilt => "rad",
            _ => "m",
        }
    }

    /// The largest value that counts as within the tolerance, with rounding.
    pub fn most(&self) -> f64 {
        self.tolerance * (1.0 + ROUNDING) + ROUNDING * LEAST
    }

    /// A value and its tolerance, in words.
    pub fn in_words(&self, value: f64) -> String {
        let (named, unit) = (self.named(), self.unit());
        match self.kind {
            Kind::Face { .. } => format!("{named}: {} {unit}", number(value)),
            _ => {
                let (shown, most) = (number(value), number(self.tolerance));
                let by =
                    if shown == most { format!(", more by {:.1e}", value - self.tolerance) } else { String::new() };
                format!("{named} {shown} {unit} of at most {most}{by}")
            }
        }
    }

    /// The value at a configuration.
    pub fn value(&self, seen: &Seen) -> f64 {
        match self.kind {
            Kind::Distance => norm(&seen.offset),
            Kind::Coordinate(k) => seen.offset[k].abs(),
            Kind::Turn => norm(&seen.turn),
            Kind::TurnAbout(k) => seen.turn[k].abs(),
            Kind::Tilt => angle_of_chord(seen.axis_chord),
            Kind::Face { coordinate, at, above } => (seen.origin[coordinate] - at) * if above { 1.0 } else { -1.0 },
        }
    }

    /// The derivative of the value, by a joint that moves the subject like this.
    pub fn slope(&self, seen: &Seen, drift: &SeenRates) -> f64 {
        let along = |vector: &[f64; 3], rate: &[f64; 3]| match norm(vector) {
            0.0 => 0.0,
            length => dot(vector, rate) / length,
        };
        match self.kind {
            Kind::Distance => along(&seen.offset, &drift.offset),
            Kind::Coordinate(k) => seen.offset[k].signum() * drift.offset[k],
            Kind::Turn => along(&seen.turn, &drift.spin),
            Kind::TurnAbout(k) => seen.turn[k].signum() * drift.turn[k],
            Kind::Tilt => drift.tilt,
            Kind::Face { coordinate, above, .. } => drift.origin[coordinate] * if above { 1.0 } else { -1.0 },
        }
    }

    /// A bound of the value on all configurations between these; infinite if none is known.
    pub fn bound<'s>(&self, points: impl Iterator<Item = &'s Seen> + Clone, bend: &TipBend) -> f64 {
        match self.kind {
            Kind::Distance | Kind::Coordinate(_) | Kind::Face { .. } => {
                highest(points.map(|seen| self.value(seen)), bend.point, bend)
            }
            Kind::Tilt => angle_of_chord(highest(points.map(|seen| seen.axis_chord), bend.direction, bend)),
            Kind::Turn => {
                // The three axes together, as one vector of length sqrt(3): its chord is 2 sqrt(2) sin(angle / 2).
                let chord = |seen: &Seen| 2.0 * SQRT_2 * (0.5 * norm(&seen.turn)).sin();
                angle_of_chord(highest(points.map(chord), 3_f64.sqrt() * bend.direction, bend) / SQRT_2)
            }
            Kind::TurnAbout(k) => turned(points.map(|seen| &seen.turn), k, bend),
        }
    }
}

/// A bound of a function between points where it has these values. It exceeds the mean of the values, weighted like the points, by
/// `excess` at most.
///
/// Without motion off the line, the excess is also at most 4 `excess` times the weights of all points but one, whichever that is. So the
/// function does not exceed the largest value where all others are lower by 4 `excess`: an error at its tolerance can be left.
fn highest(values: impl Iterator<Item = f64>, excess: f64, bend: &TipBend) -> f64 {
    let [mut first, mut second] = [f64::NEG_INFINITY; 2];
    for value in values {
        (first, second) = if value > first { (value, first) } else { (first, second.max(value)) };
    }
    let left = if bend.is_straight { first.max(second + 4.0 * excess) } else { f64::INFINITY };
    left.min(first + excess)
}

/// The angle (rad) between two unit vectors with this difference.
fn angle_of_chord(chord: f64) -> f64 {
    2.0 * (0.5 * chord).min(1.0).asin()
}

/// A bound of entry `k` of the rotation vector phi between two of its values.
///
/// With J the inverse left Jacobian of SO(3), phi' = J(phi) w. Its norm is c = (t / 2) / sin(t / 2) at the angle t = |phi|, and that of
/// its derivative is d = 1/2 - cot(t / 2) / 2 + t / (4 sin(t / 2)^2) at most; both grow with t. The angular velocity is T at most and
/// its derivative T^2 / 2, where T is the angle that all joints turn by. So |phi''| <= c (1/2 + d) T^2, and phi is within an eighth of
/// that of its chord.
///
/// A rotation by more than half a turn is one by less about the opposite axis, with entries that are no larger: the bound counts
/// them beyond half a turn, where they go on smoothly.
fn turned<'s>(vectors: impl Iterator<Item = &'s [f64; 3]> + Clone, k: usize, bend: &TipBend) -> f64 {
    let most = vectors.clone().map(norm).fold(0.0, f64::max) + bend.turn + bend.turn_off_line;
    if most > MOST_TURNED {
        return f64::INFINITY;
    }
    let beyond = |angle: f64| if 2.0 * PI - angle <= most { 2.0 * PI / angle - 1.0 } else { 1.0 };
    let values = vectors.map(|vector| vector[k].abs() * beyond(norm(vector)));
    let (sine, cosine) = (0.5 * most).sin_cos();
    let stretch = if most < 1e-3 { 1.0 + 0.05 * most } else { 0.5 * most / sine };
    let change = if most < 1e-3 { 0.5 + 0.5 * most } else { 0.5 - 0.5 * cosine / sine + 0.25 * most / (sine * sine) };
    highest(values, stretch * ((0.5 + change) * bend.turn * bend.turn / 8.0 + bend.turn_off_line), bend)
}
