//! Which of several configurations to take: the nearest to the start or, without a start, the most central one.

use smallvec::SmallVec;

use crate::objective::{Bounds, Point};
use crate::robot::Robot;

/// A joint that is outside its limits by less (rad, m) is at its limit: rounding.
pub(super) const AT_LIMIT: f64 = 1e-9;

/// A reference configuration within limits.
#[derive(Debug, Clone)]
pub(super) struct Preference {
    joints: SmallVec<[JointPreference; 8]>,
    /// The finite ranges inside the limits.
    ranges: [SmallVec<[f64; 8]>; 2],
}

/// The preferred value of a joint.
#[derive(Debug, Clone)]
struct JointPreference {
    lower: f64,
    upper: f64,
    reference: f64,
    /// What its distance from the reference counts.
    weight: f64,
    /// Infinite if no whole turn leads to the same pose.
    period: f64,
}

impl Preference {
    /// Near `start`, all joints counted the same (rad, m); without one near the middle of the limits, joints counted in their
    /// ranges.
    pub fn new(robot: &Robot, bounds: &Bounds, start: Option<&[f64]>) -> Self {
        let mut preference = Self { joints: SmallVec::new(), ranges: Default::default() };
        for (j, joint) in robot.joints().iter().enumerate() {
            let (lower, upper) = (bounds.lower()[j], bounds.upper()[j]);
            let (low, high) = joint.sampling_range_within(lower, upper);
            let (reference, weight) = match start {
                Some(start) => (start[j], 1.0),
                None => {
                    let range = high - low;
                    (0.5 * (low + high), if range > 0.0 { 1.0 / (range * range) } else { 0.0 })
                }
            };
            let period = robot.turn_period(j).unwrap_or(f64::INFINITY);
            preference.joints.push(JointPreference { lower, upper, reference, weight, period });
            preference.ranges[0].push(low);
            preference.ranges[1].push(high);
        }
        preference
    }

    /// The finite ranges inside the limits that configurations are drawn from: their lower ends, and their upper ones.
    pub fn ranges(&self) -> [&[f64]; 2] {
        let [lower, upper] = &self.ranges;
        [lower, upper]
    }

    /// The reference configuration.
    pub fn reference(&self) -> Point {
        self.joints.iter().map(|joint| joint.reference).collect()
    }

    /// The preferred one of `configurations`, at its whole turns nearest to the reference; None if none is inside the limits.
    pub fn choose<'q>(&self, configurations: impl Iterator<Item = &'q [f64]>) -> Option<Point> {
        let mut least = f64::INFINITY;
        let mut best = None;
        for q in configurations {
            if let Some(cost) = self.cost(q)
                && cost < least
            {
                (least, best) = (cost, Some(q));
            }
        }
        self.joints.iter().zip(best?).map(|(joint, q)| joint.turned(*q)).collect()
    }

    /// Those of `configurations` that are inside the limits, at their whole turns nearest to the reference, preferred ones first.
    pub fn ordered<'q>(&self, configurations: impl Iterator<Item = &'q [f64]>) -> SmallVec<[Point; 8]> {
        let inside = configurations.filter_map(|q| self.cost(q).map(|cost| (cost, q)));
        let mut inside: SmallVec<[(f64, &[f64]); 16]> = inside.collect();
        inside.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let turned =
            |q: &[f64]| self.joints.iter().zip(q).map(|(joint, q)| joint.turned(*q)).collect::<Option<Point>>();
        inside.iter().filter_map(|(_, q)| turned(q)).collect()
    }

    /// The weighted squared distance from the reference; None outside the limits.
    #[inline]
    fn cost(&self, q: &[f64]) -> Option<f64> {
        let mut sum = 0.0;
        for (joint, q) in self.joints.iter().zip(q) {
            let off = joint.turned(*q)? - joint.reference;
            sum += off * off * joint.weight;
        }
        Some(sum)
    }
}

impl JointPreference {
    /// The value `q` at the whole turn nearest to the reference inside the limits; None if there is none.
    #[inline]
    fn turned(&self, q: f64) -> Option<f64> {
        let q =
            if (self.reference - q).abs() > 0.5 * self.period || self.is_outside(q) { self.nearest_turn(q) } else { q };
        (!self.is_outside(q)).then(|| q.clamp(self.lower, self.upper))
    }

    #[inline]
    fn is_outside(&self, q: f64) -> bool {
        !(self.lower - AT_LIMIT <= q && q <= self.upper + AT_LIMIT)
    }

    #[cold]
    fn nearest_turn(&self, q: f64) -> f64 {
        let Self { lower, upper, reference, period, .. } = *self;
        if period == f64::INFINITY {
            return q;
        }
        let (fewest, most) = (((lower - AT_LIMIT - q) / period).ceil(), ((upper + AT_LIMIT - q) / period).floor());
        q + ((reference - q) / period).round().max(fewest).min(most) * period
    }
}
