//! Which of several configurations to take: the nearest to the start or, without a start, the most central one.

use smallvec::SmallVec;

use super::context::SolveContext;
use crate::objective::Point;

/// A joint that is outside its limits by less (rad, m) is at its limit: rounding.
pub(super) const AT_LIMIT: f64 = 1e-9;

/// A reference configuration within limits.
pub(super) struct Preference(SmallVec<[JointPreference; 8]>);

/// The preferred value of a joint.
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
    pub fn new(context: &SolveContext<'_>, start: Option<&[f64]>) -> Self {
        let (robot, bounds) = (context.robot(), context.bounds());
        let of_joint = |j: usize| {
            let (lower, upper) = (bounds.lower()[j], bounds.upper()[j]);
            let (reference, weight) = match start {
                Some(start) => (start[j], 1.0),
                None => {
                    let (low, high) = robot.joints()[j].sampling_range_within(lower, upper);
                    let range = high - low;
                    (0.5 * (low + high), if range > 0.0 { 1.0 / (range * range) } else { 0.0 })
                }
            };
            let period = robot.turn_period(j).unwrap_or(f64::INFINITY);
            JointPreference { lower, upper, reference, weight, period }
        };
        Self((0..robot.dof()).map(of_joint).collect())
    }

    /// The reference configuration.
    pub fn reference(&self) -> Point {
        self.0.iter().map(|joint| joint.reference).collect()
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
        self.0.iter().zip(best?).map(|(joint, q)| joint.turned(*q)).collect()
    }

    /// Those of `configurations` that are inside the limits, at their whole turns nearest to the reference, preferred ones first.
    pub fn ordered<'q>(&self, configurations: impl Iterator<Item = &'q [f64]>) -> SmallVec<[Point; 8]> {
        let inside = configurations.filter_map(|q| self.cost(q).map(|cost| (cost, q)));
        let mut inside: SmallVec<[(f64, &[f64]); 16]> = inside.collect();
        inside.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let turned = |q: &[f64]| self.0.iter().zip(q).map(|(joint, q)| joint.turned(*q)).collect::<Option<Point>>();
        inside.iter().filter_map(|(_, q)| turned(q)).collect()
    }

    /// The weighted squared distance from the reference; None outside the limits.
    #[inline]
    fn cost(&self, q: &[f64]) -> Option<f64> {
        let mut sum = 0.0;
        for (joint, q) in self.0.iter().zip(q) {
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
