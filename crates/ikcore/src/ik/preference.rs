//! Choice among several configurations: nearest to the start or, without a start, most central.

use smallvec::SmallVec;

use crate::closed_form::{ArmConfigurations, MOST_CONFIGURATIONS, MOVED_BY_POLISHING};
use crate::math::arithmetic::by_instructions;
use crate::math::comparison::{larger, smaller};
use crate::objective::{Bounds, Point};
use crate::robot::Robot;

/// Excess over a limit (rad, m) that counts as rounding: the joint is at its limit.
pub(super) const AT_LIMIT: f64 = 1e-9;

/// Period of a joint without equivalent whole turns.
const NO_PERIOD: f64 = 1e300;

/// Configurations whose costs are computed together.
const LANES: usize = 4;

/// Reason for choosing none of several configurations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Miss {
    /// Polishing may bring one of them to the pose inside the limits.
    Near,
    /// All are outside the limits.
    Far,
}

/// Reference configuration within limits, and the weights of distances from it.
#[derive(Debug, Clone)]
pub(super) struct Preference {
    joints: SmallVec<[JointPreference; 8]>,
    /// Finite ranges inside the limits.
    ranges: [SmallVec<[f64; 8]>; 2],
}

/// Preferred value of a joint.
#[derive(Debug, Clone)]
struct JointPreference {
    lower: f64,
    upper: f64,
    reference: f64,
    /// Weight of the squared distance from the reference.
    weight: f64,
    /// Period of equivalent values; beyond all limits if there is none.
    period: f64,
    /// Turns per rad or m; rounded down, so that half a turn stays in place.
    turns: f64,
}

impl Preference {
    /// Preference for configurations near `start`, by the weights of the box (rad, m); without one, near the middle of
    /// the limits, with joints weighted by their ranges.
    pub fn new(robot: &Robot, bounds: &Bounds, start: Option<&[f64]>) -> Self {
        let mut preference = Self { joints: SmallVec::new(), ranges: Default::default() };
        for (j, joint) in robot.joints().iter().enumerate() {
            let (lower, upper) = (bounds.lower()[j], bounds.upper()[j]);
            let (low, high) = joint.sampling_range_within(lower, upper);
            let (reference, weight) = match start {
                Some(start) => (start[j], bounds.weights().map_or(1.0, |weights| weights.as_slice()[j].powi(2))),
                None => {
                    let range = high - low;
                    (0.5 * (low + high), if range > 0.0 { 1.0 / (range * range) } else { 0.0 })
                }
            };
            let period = robot.turn_period(j).unwrap_or(NO_PERIOD);
            let turns = (1.0 - f64::EPSILON) / period;
            preference.joints.push(JointPreference { lower, upper, reference, weight, period, turns });
            preference.ranges[0].push(low);
            preference.ranges[1].push(high);
        }
        preference
    }

    /// Finite ranges inside the limits for drawing configurations: lower ends and upper ends.
    pub fn ranges(&self) -> [&[f64]; 2] {
        let [lower, upper] = &self.ranges;
        [lower, upper]
    }

    /// Reference configuration.
    pub fn reference(&self) -> Point {
        self.joints.iter().map(|joint| joint.reference).collect()
    }

    /// Returns the preferred one of `configurations`, all brought to the whole turns nearest to the reference, or the reason
    /// why none is chosen.
    pub fn choose(&self, configurations: &mut ArmConfigurations) -> Result<Point, Miss> {
        let costs = turn_inside(&self.joints, configurations);
        let mut best = (f64::INFINITY, 0);
        for (index, cost) in costs[..configurations.len()].iter().enumerate() {
            if *cost < best.0 {
                best = (*cost, index);
            }
        }
        if best.0 < f64::INFINITY { Ok(self.inside(configurations, best.1)) } else { Err(self.miss(configurations)) }
    }

    /// Returns the `configurations` inside the limits in order of preference. All are brought to the whole turns nearest to the
    /// reference.
    pub fn ordered(&self, configurations: &mut ArmConfigurations) -> SmallVec<[Point; 8]> {
        let costs = turn_inside(&self.joints, configurations);
        let inside = (0..configurations.len()).filter(|index| costs[*index] < f64::INFINITY);
        let mut inside: SmallVec<[usize; MOST_CONFIGURATIONS]> = inside.collect();
        inside.sort_by(|a, b| costs[*a].total_cmp(&costs[*b]));
        inside.iter().map(|index| self.inside(configurations, *index)).collect()
    }

    /// Configuration number `index`, clamped to the limits to undo rounding.
    #[inline]
    fn inside(&self, configurations: &ArmConfigurations, index: usize) -> Point {
        let mut q = Point::new();
        for (joint, values) in self.joints.iter().zip(configurations.columns()) {
            q.push(joint.inside(values[index]));
        }
        q
    }

    /// Classifies the miss of `configurations`, all of which are outside the limits.
    #[cold]
    fn miss(&self, configurations: &ArmConfigurations) -> Miss {
        let is_near = |index: usize| {
            let mut values = self.joints.iter().zip(configurations.columns());
            values.all(|(joint, values)| joint.is_near(values[index]))
        };
        if (0..configurations.len()).any(is_near) { Miss::Near } else { Miss::Far }
    }

    /// Returns the `configurations` outside the limits by less than `most` (rad, m): their excess, and the nearest
    /// configuration inside. All are brought to whole turns near the limits.
    pub fn misses(&self, configurations: &mut ArmConfigurations, most: f64) -> impl Iterator<Item = (f64, Point)> {
        let outside = turn_near(&self.joints, configurations);
        let indices = (0..configurations.len()).filter(move |index| outside[*index] < most);
        indices.map(move |index| (outside[index], self.moved_inside(configurations, index)))
    }

    /// Returns the configuration least outside the limits, moved inside. All are brought to whole turns near the limits.
    pub fn nearest_miss(&self, configurations: &mut ArmConfigurations) -> Option<Point> {
        let outside = turn_near(&self.joints, configurations);
        let least = (0..configurations.len()).min_by(|a, b| outside[*a].total_cmp(&outside[*b]))?;
        Some(self.moved_inside(configurations, least)).filter(|q| q.iter().all(|q| q.is_finite()))
    }

    /// Configuration inside the limits nearest to number `index`, which is at whole turns near the limits.
    fn moved_inside(&self, configurations: &ArmConfigurations, index: usize) -> Point {
        let joints = self.joints.iter().zip(configurations.columns());
        joints.map(|(joint, values)| joint.moved_inside(values[index])).collect()
    }

    /// Returns the preferred one of `configurations`, all inside the limits and at the whole turns nearest to the reference.
    pub fn nearest<'q>(&self, configurations: impl Iterator<Item = &'q [f64]>) -> Option<&'q [f64]> {
        let cost = |q: &[f64]| self.joints.iter().zip(q).fold(0.0, |sum, (joint, q)| sum + joint.cost(*q));
        configurations.min_by(|a, b| cost(a).total_cmp(&cost(b)))
    }
}

by_instructions! {
    /// Brings each of `configurations` to the whole turns nearest to the reference. Returns their weighted squared distances
    /// from it, infinite outside the limits.
    fn turn_inside(joints: &[JointPreference], configurations: &mut ArmConfigurations) -> [f64; MOST_CONFIGURATIONS] {
        let count = configurations.len();
        let mut costs = [0.0; MOST_CONFIGURATIONS];
        for (joint, values) in joints.iter().zip(configurations.columns_mut()) {
            for first in (0..count).step_by(LANES) {
                let (mut lanes, mut sums) = ([0.0; LANES], [0.0; LANES]);
                lanes.copy_from_slice(&values[first..first + LANES]);
                sums.copy_from_slice(&costs[first..first + LANES]);
                for w in 0..LANES {
                    lanes[w] = joint.turned(lanes[w]);
                    // Added instead of selected: without branches the compiler vectorises the lanes.
                    let penalty = if joint.is_within(lanes[w], AT_LIMIT) { 0.0 } else { f64::INFINITY };
                    sums[w] += joint.cost(joint.inside(lanes[w])) + penalty;
                }
                values[first..first + LANES].copy_from_slice(&lanes);
                costs[first..first + LANES].copy_from_slice(&sums);
            }
        }
        costs
    }
}

by_instructions! {
    /// Brings each of `configurations` to the whole turns below its upper limits. Returns the excess of each over the limits
    /// (rad, m), there or one turn later, whichever is less.
    fn turn_near(joints: &[JointPreference], configurations: &mut ArmConfigurations) -> [f64; MOST_CONFIGURATIONS] {
        let count = configurations.len();
        let mut most = [0.0; MOST_CONFIGURATIONS];
        for (joint, values) in joints.iter().zip(configurations.columns_mut()) {
            let turns = joint.period < NO_PERIOD;
            for first in (0..count).step_by(LANES) {
                let (mut lanes, mut outside) = ([0.0; LANES], [0.0; LANES]);
                lanes.copy_from_slice(&values[first..first + LANES]);
                outside.copy_from_slice(&most[first..first + LANES]);
                for w in 0..LANES {
                    lanes[w] = if turns { joint.turned(lanes[w]) } else { lanes[w] };
                    outside[w] = larger(outside[w], joint.outside(lanes[w]));
                }
                values[first..first + LANES].copy_from_slice(&lanes);
                most[first..first + LANES].copy_from_slice(&outside);
            }
        }
        most
    }
}

impl JointPreference {
    /// Value `q` at the whole turn nearest to the reference, inside the limits if possible.
    #[inline(always)]
    fn turned(&self, q: f64) -> f64 {
        let fewest = ((self.lower - AT_LIMIT - q) * self.turns).ceil();
        let most = ((self.upper + AT_LIMIT - q) * self.turns).floor();
        let nearest = ((self.reference - q) * self.turns).round_ties_even();
        q + smaller(larger(nearest, fewest), most) * self.period
    }

    #[inline(always)]
    fn is_within(&self, q: f64, slack: f64) -> bool {
        (self.lower - slack <= q) & (q <= self.upper + slack)
    }

    /// Whether polishing may move `q`, or its value one whole turn away, inside the limits.
    fn is_near(&self, q: f64) -> bool {
        [q - self.period, q, q + self.period].iter().any(|q| self.is_within(*q, MOVED_BY_POLISHING))
    }

    /// Excess over the limits of `turned`, from [`Self::turned`], or of its value one turn later, whichever is less.
    #[inline(always)]
    fn outside(&self, turned: f64) -> f64 {
        let nearer = smaller(self.lower - turned, turned + self.period - self.upper);
        larger(0.0, larger(nearer, turned - self.upper))
    }

    /// Value inside the limits nearest to `turned`, or to its value one turn later.
    fn moved_inside(&self, turned: f64) -> f64 {
        let is_later = turned + self.period - self.upper < self.lower - turned;
        self.inside(if is_later { turned + self.period } else { turned })
    }

    /// Value inside the limits nearest to `q`.
    #[inline(always)]
    fn inside(&self, q: f64) -> f64 {
        smaller(larger(q, self.lower), self.upper)
    }

    /// Weighted squared distance of `q` from the reference.
    #[inline(always)]
    fn cost(&self, q: f64) -> f64 {
        let off = q - self.reference;
        off * off * self.weight
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;
    use crate::rng;

    const JOINTS: usize = 6;
    const LOWER: [f64; JOINTS] = [-2.9, -3.2, -7.0, 0.1, -0.4, f64::NEG_INFINITY];
    const UPPER: [f64; JOINTS] = [2.9, 0.3, 7.0, 9.0, -0.3, f64::INFINITY];

    fn preference(reference: &[f64; JOINTS]) -> Preference {
        let joint = |j: usize| {
            // The fifth joint is prismatic.
            let period = if j == 4 { NO_PERIOD } else { TAU };
            let turns = (1.0 - f64::EPSILON) / period;
            let (lower, upper) = (LOWER[j], UPPER[j]);
            JointPreference { lower, upper, reference: reference[j], weight: 1.0 + j as f64, period, turns }
        };
        Preference { joints: (0..JOINTS).map(joint).collect(), ranges: Default::default() }
    }

    /// Finds the nearest of all whole turns inside the limits, and its cost, by enumeration.
    fn by_trying(preference: &Preference, q: &[f64]) -> Option<(f64, Point)> {
        let mut sum = 0.0;
        let turned = preference.joints.iter().zip(q).enumerate().map(|(j, (joint, q))| {
            let turns = if j == 4 { 0..=0 } else { -4..=4 };
            let inside = turns.map(|turn| q + f64::from(turn) * TAU).filter(|q| joint.is_within(*q, 0.0));
            let nearest = inside.min_by(|a, b| joint.cost(*a).total_cmp(&joint.cost(*b)))?;
            sum += joint.cost(nearest);
            Some(nearest)
        });
        let turned: Option<Point> = turned.collect();
        turned.map(|q| (sum, q))
    }

    fn configurations(rng: &mut rng::LazyRng, count: usize) -> (Vec<[f64; 7]>, ArmConfigurations) {
        let draw = |rng: &mut rng::LazyRng, j: usize| {
            if j == 4 { rng.uniform_in(-0.42, -0.28) } else { rng.uniform_in(-PI, PI) }
        };
        let sets: Vec<[f64; 7]> = (0..count).map(|_| std::array::from_fn(|j| draw(rng, j))).collect();
        let all = ArmConfigurations::of_sets(&sets, JOINTS);
        (sets, all)
    }

    #[test]
    fn the_nearest_of_all_whole_turns_is_chosen() {
        let mut rng = rng::stream(5, 0);
        let mut chosen = 0;
        for trial in 0..2000 {
            let reference = std::array::from_fn(|j| rng.uniform_in(LOWER[j].max(-9.0), UPPER[j].min(9.0)));
            let preference = preference(&reference);
            let (sets, mut all) = configurations(&mut rng, 1 + trial % MOST_CONFIGURATIONS);
            let expected = sets.iter().filter_map(|q| by_trying(&preference, &q[..JOINTS]));
            let expected = expected.min_by(|(a, _), (b, _)| a.total_cmp(b));
            let ordered = preference.ordered(&mut all.clone());
            let inside = sets.iter().filter(|q| by_trying(&preference, &q[..JOINTS]).is_some()).count();
            assert_eq!(ordered.len(), inside);
            match (preference.choose(&mut all), expected) {
                (Ok(q), Some((_, expected))) => {
                    chosen += 1;
                    assert!(q.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12), "{q:?} {expected:?}");
                    assert_eq!(ordered[0], q);
                }
                (Err(_), None) => {}
                (found, expected) => panic!("{found:?} {expected:?}"),
            }
        }
        assert!(chosen > 1000, "{chosen}");
    }

    #[test]
    fn half_a_turn_from_the_reference_stays_where_it_is() {
        let preference = preference(&[0.0, 0.0, PI, 0.2, -0.35, 0.0]);
        let q = [0.0, 0.0, 0.0, 0.2, -0.35, PI, 0.0];
        let found = preference.choose(&mut ArmConfigurations::of_sets(&[q], JOINTS)).expect("it is inside");
        assert_eq!(found[..], q[..JOINTS]);
    }

    #[test]
    fn a_miss_tells_whether_polishing_may_help() {
        let preference = preference(&[0.0, 0.0, 0.0, 0.2, -0.35, 0.0]);
        let miss = |q1: f64, q5: f64| {
            let q = [q1, 0.0, 0.0, 0.2, q5, 0.0, 0.0];
            preference.choose(&mut ArmConfigurations::of_sets(&[q], JOINTS)).err()
        };
        assert_eq!(miss(2.9 + 0.5 * AT_LIMIT, -0.35), None);
        assert_eq!(miss(2.91, -0.35), Some(Miss::Near));
        assert_eq!(miss(2.95, -0.35), Some(Miss::Far));
        assert_eq!(miss(2.91, -0.2), Some(Miss::Far));
        assert_eq!(miss(f64::NAN, -0.35), Some(Miss::Far));
    }
}
