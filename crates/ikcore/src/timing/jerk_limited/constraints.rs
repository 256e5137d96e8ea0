//! The limits at points of the clock, as rows for y = (du/dt)^2 and its derivatives y' and y''.
//!
//! With Q the joint positions over u: the velocity is Q' sqrt(y), the acceleration Q'' y + Q' y' / 2, and the jerk
//! sqrt(y) (Q''' y + 3/2 Q'' y' + 1/2 Q' y'').

use super::super::constant_limits::ConstantLimits;
use super::clock::{Clock, PathPoint};
use super::rate_spline::{RateSpline, Weights};
use crate::constraint::{Drag, JointSpan, JointTorques, TipRates, TorquePoint, TorqueTerms, VectorJet};
use crate::limits::TipField;
use crate::math::vector3::{Vector, norm};

/// Places in each interval where the limits are imposed, and their weights in integrals (Simpson's rule). At both ends, because the jerk
/// jumps at knots.
const PLACES: [[f64; 2]; 3] = [[0.0, 1.0 / 6.0], [0.5, 4.0 / 6.0], [1.0, 1.0 / 6.0]];

/// Rows of all points.
#[derive(Debug)]
pub(super) struct Constraints {
    pub points: Vec<RatePoint>,
    /// By point, then by joint.
    pub(super) rows: Vec<JointRow>,
    pub(super) joints: usize,
    /// By point, then by tip with an acceleration limit.
    tip_rows: Vec<TipRow>,
    tips: usize,
    /// By point, then by joint; empty without torque limits.
    torque_rows: Vec<TorqueRow>,
}

/// One point of the clock, and the limits of tips and torques there.
#[derive(Debug, Clone, Copy)]
pub(super) struct PointRows<'a> {
    pub point: &'a RatePoint,
    pub tips: &'a [TipRow],
    pub torques: &'a [TorqueRow],
}

/// One point of the clock.
#[derive(Debug, Clone, Copy)]
pub(super) struct RatePoint {
    pub interval: usize,
    pub weights: Weights,
    /// Weight in the integral over the clock.
    pub share: f64,
    /// 1 / y where a velocity limit or the largest path speed is reached; zero without.
    pub slowness: f64,
}

/// Limits of one joint at one point.
#[derive(Debug, Clone, Copy)]
pub(super) struct JointRow {
    /// |a . (y, y')| <= 1: the acceleration limit.
    pub acceleration: [f64; 2],
    /// |b . (y, y', y'')| <= 1 / sqrt(y): the jerk limit.
    pub jerk: [f64; 3],
}

/// The acceleration limit of a tip at one point: |a y + b y'| <= 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct TipRow {
    pub of_y: Vector,
    pub of_slope: Vector,
}

/// The torque limit of a joint at one point: |hold + a y + b y'| + friction <= 1, with the friction on the side that it acts on.
#[derive(Debug, Clone, Copy)]
pub(super) struct TorqueRow {
    pub hold: f64,
    pub of_y: f64,
    pub of_slope: f64,
    /// Against positive and against negative torques.
    pub drags: [Drag; 2],
}

impl Constraints {
    /// The limits of a motion at the `rate` of a `clock`, whose intervals take about these times (s).
    pub(super) fn new(clock: &Clock, rate: &RateSpline, times: &[f64], limits: &ConstantLimits) -> Self {
        let mut points = Vec::with_capacity(PLACES.len() * rate.intervals());
        let mut rows = Vec::with_capacity(PLACES.len() * rate.intervals() * limits.dof());
        let mut tips = limits.tips.as_ref().map(TipsAt::new);
        let mut tip_rows = vec![];
        let mut torques = limits.torques.as_ref().map(TorquesAt::new);
        let mut torque_rows = vec![];
        for (interval, time) in times.iter().enumerate() {
            for [place, weight] in PLACES {
                let at = clock.at(rate.reading(interval, place), rate.reading(interval, 0.5));
                let mut slowness = at.slowness();
                if let Some(tips) = &mut tips {
                    slowness = slowness.max(tips.push(&at, &mut tip_rows));
                }
                for joint in 0..limits.dof() {
                    let [_, first, second, third] = at.joint(joint);
                    let [v, a, b] = inverses(limits, joint, *time);
                    slowness = slowness.max((first * v).powi(2));
                    rows.push(JointRow {
                        acceleration: [second * a, 0.5 * first * a],
                        jerk: [third * b, 1.5 * second * b, 0.5 * first * b],
                    });
                }
                if let Some(torques) = &mut torques {
                    torques.push(&at, 1.0 / slowness, &mut torque_rows);
                }
                let weights = rate.weights(interval, place);
                points.push(RatePoint { interval, weights, share: weight * rate.length(interval), slowness });
            }
        }
        let tips = tip_rows.len() / points.len();
        Self { points, rows, joints: limits.dof(), tip_rows, tips, torque_rows }
    }

    /// The largest change of the jerk of a joint in each interval, and at its end to the next, as parts of its limit.
    pub(super) fn jerk_changes(&self, rate: &RateSpline) -> Vec<[f64; 2]> {
        let jerks = self.jerks(rate);
        let of_point = |point: usize| &jerks[point * self.joints..(point + 1) * self.joints];
        let largest = |[one, other]: [usize; 2]| {
            of_point(one).iter().zip(of_point(other)).map(|(one, other)| (other - one).abs()).fold(0.0, f64::max)
        };
        let of_interval = |interval: usize| {
            let first = interval * PLACES.len();
            let last = first + PLACES.len() - 1;
            let inside = (first..last).map(|point| largest([point, point + 1])).fold(largest([first, last]), f64::max);
            [inside, if last + 1 < self.points.len() { largest([last, last + 1]) } else { 0.0 }]
        };
        (0..rate.intervals()).map(of_interval).collect()
    }

    /// The jerks of all joints, by point, as parts of their limits.
    fn jerks(&self, rate: &RateSpline) -> Vec<f64> {
        let of_point = |(point, rows): (usize, &'_ [JointRow])| {
            let y = rate.at(point / PLACES.len(), PLACES[point % PLACES.len()][0]);
            rows.iter().map(|row| y[0].sqrt() * row.used(&y)[1]).collect::<Vec<f64>>()
        };
        self.rows.chunks_exact(self.joints).enumerate().flat_map(of_point).collect()
    }

    /// Each point with the limits of tips and torques; none without such limits.
    pub(super) fn of_whole(&self) -> impl Iterator<Item = PointRows<'_>> {
        let torques = if self.torque_rows.is_empty() { 0 } else { self.joints };
        let points = if self.tips + torques > 0 { &self.points[..] } else { &[] };
        points.iter().enumerate().map(move |(i, point)| {
            let tips = &self.tip_rows[i * self.tips..(i + 1) * self.tips];
            PointRows { point, tips, torques: &self.torque_rows[i * torques..(i + 1) * torques] }
        })
    }

    /// Number of inequalities.
    pub(super) fn count(&self) -> usize {
        self.points.len() + 4 * self.rows.len() + self.tip_rows.len() + 2 * self.torque_rows.len()
    }

    /// Measures the clock so that y = 1 everywhere reaches a limit and violates none. Returns that y in the old measure.
    pub(super) fn normalize(&mut self) -> f64 {
        let of_accelerations = self.rows.iter().map(|row| row.acceleration[0].abs());
        let of_jerk = self.rows.iter().map(|row| row.jerk[0].abs()).fold(0.0, f64::max).powf(2.0 / 3.0);
        let of_speeds = self.points.iter().map(|point| point.slowness);
        let of_tips = self.tip_rows.iter().map(|tip| norm(&tip.of_y));
        let of_torques = self.torque_rows.iter().map(TorqueRow::slowness);
        let y = 1.0 / of_accelerations.chain(of_speeds).chain(of_tips).chain(of_torques).fold(of_jerk, f64::max);
        self.restore(1.0 / y);
        y
    }

    /// Goes back to the measure in which y is this many times larger.
    pub(super) fn restore(&mut self, unit: f64) {
        let y = 1.0 / unit;
        for point in &mut self.points {
            point.slowness *= y;
        }
        for row in &mut self.rows {
            row.acceleration = row.acceleration.map(|a| a * y);
            row.jerk = row.jerk.map(|b| b * y * y.sqrt());
        }
        for tip in &mut self.tip_rows {
            tip.of_y = tip.of_y.map(|a| a * y);
            tip.of_slope = tip.of_slope.map(|b| b * y);
        }
        for row in &mut self.torque_rows {
            (row.of_y, row.of_slope) = (row.of_y * y, row.of_slope * y);
            row.drags.iter_mut().for_each(|drag| drag.per_square *= y);
        }
    }
}

/// The motion of limited tips at a point of the clock.
struct TipsAt<'a> {
    rates: &'a TipRates,
    interval: JointSpan,
}

impl<'a> TipsAt<'a> {
    fn new(rates: &'a TipRates) -> Self {
        Self { rates, interval: JointSpan::new(rates.robot()) }
    }

    /// Adds the rows of acceleration limits; returns 1 / y where a limit of speed or turn speed is reached.
    fn push(&mut self, at: &PathPoint<'_>, rows: &mut Vec<TipRow>) -> f64 {
        let robot = self.rates.robot();
        self.interval.set(robot, (0..robot.dof()).map(|joint| at.expansion(joint)), [0.0, 1.0]);
        let mut slowness = 0.0_f64;
        for tip in self.rates.tips() {
            let jet = self.interval.jet(robot, &tip.elements);
            let part = |rate: &VectorJet, field| (norm(&rate.middle()) / tip.limit(field)).powi(2);
            let speeds = [part(&jet.velocity, TipField::Speed), part(&jet.turn, TipField::TurnSpeed)];
            slowness = speeds.into_iter().fold(slowness, f64::max);
            let limit = tip.limit(TipField::Acceleration);
            if limit.is_finite() {
                let of_y = jet.velocity.derivative().middle().map(|a| a / limit);
                rows.push(TipRow { of_y, of_slope: jet.velocity.middle().map(|v| 0.5 * v / limit) });
            } else if self.rates.limit_acceleration() {
                rows.push(TipRow { of_y: [0.0; 3], of_slope: [0.0; 3] });
            }
        }
        slowness
    }
}

/// The torques of all joints at a point of the clock.
struct TorquesAt<'a> {
    torques: &'a JointTorques,
    at: TorquePoint,
    terms: TorqueTerms,
}

impl<'a> TorquesAt<'a> {
    fn new(torques: &'a JointTorques) -> Self {
        Self { torques, at: torques.point(), terms: torques.terms() }
    }

    /// Adds the rows of a point where y is at most `most`.
    fn push(&mut self, point: &PathPoint<'_>, most: f64, rows: &mut Vec<TorqueRow>) {
        let Self { torques, at, terms } = self;
        for joint in 0..torques.dof() {
            [at.q[joint], at.first[joint], at.second[joint], _] = point.joint(joint);
        }
        torques.write_terms(at, terms);
        rows.extend(torques.limits().iter().enumerate().map(|(joint, limit)| {
            let (hold, rate) = (terms.hold[joint], at.first[joint]);
            let drag = |rate: f64| {
                let Drag { at_rest, per_square } = torques.friction(joint).drag(rate, limit - hold.abs(), most);
                Drag { at_rest: at_rest / limit, per_square: per_square / limit }
            };
            TorqueRow {
                hold: hold / limit,
                of_y: terms.of_square[joint] / limit,
                of_slope: 0.5 * terms.of_change[joint] / limit,
                drags: [rate, -rate].map(drag),
            }
        }));
    }
}

impl TorqueRow {
    /// Remaining torque above and below, as fractions of the limit, and its derivatives by y and y'.
    #[inline]
    pub(super) fn rooms(&self, [y, slope, _]: &[f64; 3]) -> [(f64, [f64; 3]); 2] {
        let torque = self.hold + self.of_y * y + self.of_slope * slope;
        let [above, below] = self.drags;
        let room = |sign: f64, drag: Drag| {
            let left = 1.0 - sign * torque - drag.at_rest - drag.per_square * y;
            (left, [-sign * self.of_y - drag.per_square, -sign * self.of_slope, 0.0])
        };
        [room(1.0, above), room(-1.0, below)]
    }

    /// 1 / y where a steady rate reaches the limit.
    fn slowness(&self) -> f64 {
        let of_side =
            |(sign, drag): (f64, &Drag)| (sign * self.of_y + drag.per_square) / (1.0 - sign * self.hold - drag.at_rest);
        [1.0, -1.0].into_iter().zip(&self.drags).map(of_side).fold(0.0, f64::max)
    }
}

impl TipRow {
    /// The acceleration as a part of its limit.
    #[inline]
    pub(super) fn used(&self, [y, slope, _]: &[f64; 3]) -> Vector {
        std::array::from_fn(|k| self.of_y[k] * y + self.of_slope[k] * slope)
    }
}

impl JointRow {
    /// The linear forms of the acceleration and of the jerk.
    #[inline]
    pub(super) fn used(&self, [y, slope, curvature]: &[f64; 3]) -> [f64; 2] {
        let ([a0, a1], [b0, b1, b2]) = (self.acceleration, self.jerk);
        [a0 * y + a1 * slope, b0 * y + b1 * slope + b2 * curvature]
    }
}

/// Inverses of the limits on velocity, acceleration and jerk of a joint in an interval that takes this time (s); zero without limit. A joint
/// with a limit of zero does not move. A jerk that takes an acceleration from one limit to the other in this time is as good as any higher
/// one: a spline cannot follow it.
fn inverses(limits: &ConstantLimits, joint: usize, time: f64) -> [f64; 3] {
    let inverse = |limit: f64| if limit > 0.0 { 1.0 / limit } else { 0.0 };
    let [velocity, acceleration, jerk] = [limits.velocity[joint], limits.acceleration[joint], limits.jerk[joint]];
    let steepest = if jerk.is_finite() { jerk.min(2.0 * acceleration / time) } else { jerk };
    [velocity, acceleration, steepest].map(inverse)
}
