//! Limits of the speed, acceleration and turn speed of tips, and their certificate over a motion.
//!
//! Over an interval a [`TipJet`](super::tip_jet::TipJet) bounds all three. Where a bound is too large, the interval is halved, until the largest is
//! known to 1e-6 or is within the limit.

use std::sync::Arc;

use super::tip_jet::{TipElements, TipJet};
use crate::error::{Error, Result};
use crate::kinematics::link_tree::FrameBuffer;
use crate::limits::{ROUNDING, TipField, TipLimits};
use crate::math::vector3::norm;
use crate::message::{Message, message};
use crate::robot::Robot;
use crate::trajectory::{Coefficients, POWERS, Trajectory};

/// Relative accuracy of the largest rate of a motion that exceeds its limit, and the room left below the limit.
pub(crate) const TIGHT: f64 = 1e-6;

/// Intervals examined before bounds are taken as they are.
const MOST_INTERVALS: usize = 100_000;

/// Most halvings of a segment.
const DEEPEST: usize = 40;

/// Robot and limits of its tips.
#[derive(Debug, Clone)]
pub(crate) struct TipRates {
    robot: Arc<Robot>,
    tips: Vec<LimitedTip>,
    /// As given.
    limits: TipLimits,
}

/// A tip and its limits, infinite where it has none.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LimitedTip {
    pub elements: TipElements,
    name: String,
    /// By [`TipField`].
    limits: [f64; 3],
}

/// A rate beyond its limit.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TipExcess {
    /// The quantity, for example "speed of tip 'tool0'".
    pub what: String,
    pub value: f64,
    pub bound: f64,
    pub unit: &'static str,
}

impl PartialEq for TipRates {
    fn eq(&self, other: &Self) -> bool {
        self.tips == other.tips
    }
}

impl TipRates {
    /// The limits of the tips of `robot`; `None` without finite ones. `method` names the call in errors.
    ///
    /// # Errors
    /// [`Error::UnsupportedLimit`] where a rotation vector carries a tip.
    pub fn new(robot: &Robot, limits: &TipLimits, method: impl Into<Message>) -> Result<Option<Self>> {
        let mut tips = vec![];
        for (tip, name) in robot.tips().enumerate() {
            let of_tip = TipField::ALL.map(|field| limits.at(field, tip));
            let Some(first) = TipField::ALL.into_iter().find(|field| limits.at(*field, tip).is_finite()) else {
                continue;
            };
            let Some(elements) = TipElements::of(robot, tip) else {
                let remedy = message!["a base that floats turns by a rotation vector; leave out ", first.setting()];
                return Err(Error::UnsupportedLimit { field: first.to_string(), method: method.into(), remedy });
            };
            tips.push(LimitedTip { elements, name: name.to_owned(), limits: of_tip });
        }
        Ok((!tips.is_empty()).then(|| Self { robot: Arc::new(robot.clone()), tips, limits: limits.clone() }))
    }

    /// The robot.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// The limits, as given.
    pub fn limits(&self) -> &TipLimits {
        &self.limits
    }

    /// The tips that have limits.
    pub fn tips(&self) -> &[LimitedTip] {
        &self.tips
    }

    /// Whether any tip has an acceleration limit.
    pub fn limit_acceleration(&self) -> bool {
        self.tips.iter().any(|tip| tip.limit(TipField::Acceleration).is_finite())
    }

    /// Factor by which `motion` must be slowed down to keep the limits, or a bound of it up to `enough`. A larger one is at most
    /// [`TIGHT`] too large.
    pub fn slowdown(&self, motion: &Trajectory, enough: f64) -> f64 {
        self.largest(motion, &[TipField::Speed, TipField::Acceleration, TipField::TurnSpeed], None, enough)
    }

    /// Rates of `motion` beyond their limits.
    pub fn excesses(&self, motion: &Trajectory) -> Vec<TipExcess> {
        let enough = 1.0 + ROUNDING;
        if self.slowdown(motion, enough) <= enough {
            return vec![];
        }
        let each = (0..self.tips.len()).flat_map(|tip| TipField::ALL.map(|field| (tip, field)));
        let excess = |(tip, field): (usize, TipField)| {
            let LimitedTip { name, limits, .. } = &self.tips[tip];
            let (factor, bound) = (self.largest(motion, &[field], Some(tip), enough), limits[field as usize]);
            let value = bound * if field == TipField::Acceleration { factor * factor } else { factor };
            (factor > enough).then(|| TipExcess { what: field.of_tip(name), value, bound, unit: field.unit() })
        };
        each.filter_map(excess).collect()
    }

    fn largest(&self, motion: &Trajectory, fields: &[TipField], only: Option<usize>, enough: f64) -> f64 {
        let of = only.map_or(&self.tips[..], |tip| &self.tips[tip..=tip]);
        // A rate far below its limit may be any; so a tip that stays in place needs no short intervals.
        let enough = enough.max(1e-9);
        let mut walk =
            Walk { at: Interval::new(&self.robot), of, fields, enough, seen: 0.0, proven: 0.0, intervals: 0 };
        let n = motion.joints().len();
        let segments = || motion.coefficients().chunks_exact(n).zip(motion.knots().windows(2));
        for (polynomials, ends) in segments() {
            walk.see(&self.robot, polynomials, [0.0, ends[1] - ends[0]]);
        }
        for (polynomials, ends) in segments() {
            walk.halve(&self.robot, polynomials, [0.0, ends[1] - ends[0]], 0);
        }
        walk.proven
    }
}

impl LimitedTip {
    /// The limit of one kind.
    pub fn limit(&self, field: TipField) -> f64 {
        self.limits[field as usize]
    }

    /// Factor by which the motion of `jet`, over an interval of twice `half` (s), must be slowed down in its middle, and a bound of it.
    fn factor(&self, jet: &TipJet, half: f64, field: TipField) -> [f64; 2] {
        let limit = self.limit(field);
        if limit == f64::INFINITY {
            return [0.0; 2];
        }
        match field {
            TipField::Speed => [norm(&jet.velocity.middle()), jet.velocity.bound()].map(|rate| rate / half / limit),
            TipField::TurnSpeed => [norm(&jet.turn.middle()), jet.turn.bound()].map(|rate| rate / half / limit),
            TipField::Acceleration => {
                let change = jet.velocity.derivative();
                [norm(&change.middle()), change.bound()].map(|rate| (rate / limit).sqrt() / half)
            }
        }
    }
}

/// An interval of a joint motion: its polynomials on \[-1, 1\], and the moving elements in its middle. Reused for any number of them.
#[derive(Debug, Clone)]
pub(crate) struct Interval {
    joints: Vec<Coefficients>,
    q: Vec<f64>,
    frames: FrameBuffer,
}

impl Interval {
    /// An interval of a motion of `robot`.
    pub fn new(robot: &Robot) -> Self {
        let n = robot.dof();
        Self { joints: vec![[0.0; POWERS]; n], q: vec![0.0; n], frames: robot.frame_buffer() }
    }

    /// Becomes the interval around `middle`, `half` to either side, of these polynomials.
    pub fn set(&mut self, robot: &Robot, polynomials: impl Iterator<Item = Coefficients>, [middle, half]: [f64; 2]) {
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
        robot.write_frames(&self.q, &mut self.frames);
    }

    /// The motion of a tip.
    pub fn jet(&self, robot: &Robot, tip: &LimitedTip) -> TipJet {
        tip.elements.jet(robot, &self.frames, &self.joints)
    }
}

/// A search for the largest factor of a motion.
struct Walk<'a> {
    at: Interval,
    of: &'a [LimitedTip],
    fields: &'a [TipField],
    enough: f64,
    /// Largest factor at a point.
    seen: f64,
    /// Largest bound that was taken.
    proven: f64,
    intervals: usize,
}

impl Walk<'_> {
    /// Bounds the factor over an interval, and notes the one in its middle.
    fn see(&mut self, robot: &Robot, polynomials: &[Coefficients], [from, to]: [f64; 2]) -> f64 {
        let half = 0.5 * (to - from);
        self.at.set(robot, polynomials.iter().copied(), [from + half, half]);
        let mut bound = 0.0_f64;
        for tip in self.of {
            let jet = self.at.jet(robot, tip);
            for field in self.fields {
                let [seen, at_most] = tip.factor(&jet, half, *field);
                self.seen = self.seen.max(seen);
                bound = bound.max(at_most);
            }
        }
        bound
    }

    fn halve(&mut self, robot: &Robot, polynomials: &[Coefficients], [from, to]: [f64; 2], depth: usize) {
        self.intervals += 1;
        let bound = self.see(robot, polynomials, [from, to]);
        let most = if self.seen > self.enough { self.seen * (1.0 + TIGHT) } else { self.enough };
        if bound <= most.max(self.proven) || depth == DEEPEST || self.intervals > MOST_INTERVALS {
            self.proven = self.proven.max(bound);
            return;
        }
        let middle = 0.5 * (from + to);
        self.halve(robot, polynomials, [from, middle], depth + 1);
        self.halve(robot, polynomials, [middle, to], depth + 1);
    }
}
