//! Deviation of the tip from its path.

use crate::along_path::tip_path::{TipPath, angle_between};
use crate::math::MAX_DOF;
use crate::math::vector::distance;
use crate::robot::Robot;
use crate::timing::{JointPath, Violation};

/// Samples between two knots; the maximum is then refined between the neighbours of the best sample.
const SAMPLES: usize = 10;

/// Steps of that ternary search, each of which keeps two thirds of the interval.
const STEPS: usize = 8;

/// Intervals whose best sample is smaller than this fraction of the largest one are not searched: between ten samples nothing rises so far.
const NEAR_PEAK: f64 = 0.8;

/// Joint positions as a function of the path parameter.
pub(crate) trait Configurations: Fn(f64, &mut [f64]) {}
impl<F: Fn(f64, &mut [f64])> Configurations for F {}

/// Deviation of the tip of a robot that moves through these configurations from its path.
pub(crate) struct TipDeviation<'a, C> {
    /// The robot.
    pub robot: &'a Robot,
    /// The path of its tip.
    pub tip_path: &'a TipPath,
    /// Joint positions over the path parameter.
    pub configurations: C,
}

/// The deviation of the tip of `robot` on a joint path over the parameter of `tip_path`.
pub(crate) fn deviation_on<'a>(
    robot: &'a Robot,
    tip_path: &'a TipPath,
    path: &'a JointPath,
) -> TipDeviation<'a, impl Configurations> {
    TipDeviation { robot, tip_path, configurations: |fraction: f64, q: &mut [f64]| path.position(fraction, q) }
}

/// A largest value, and the path parameter at which it occurs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Largest {
    /// The value.
    pub value: f64,
    /// The path parameter.
    pub fraction: f64,
}

impl Largest {
    fn or_larger(self, other: Self) -> Self {
        if other.value > self.value { other } else { self }
    }
}

/// The largest deviations of the tip from its path, beyond its tolerance band and the turn that the path leaves open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LargestDeviation {
    /// Distance from the path (m).
    pub distance: Largest,
    /// Angle between the tip's orientation and that of the path (rad); 0 if the path has no orientation.
    pub angle: Largest,
}

impl LargestDeviation {
    /// Returns the violations for a tip that must stay within `accuracy` (m, rad).
    pub(crate) fn violations(&self, tip_path: &TipPath, accuracy: f64) -> impl Iterator<Item = Violation> {
        let of = |quantity: &str, largest: Largest, open: f64, unit: &'static str| {
            let tolerance_band = if tip_path.has_tolerance() { ", beyond its tolerance," } else { "" };
            let what =
                format!("{quantity} of the tip{tolerance_band} from {}", tip_path.point_in_words(largest.fraction));
            let broken = largest.value > accuracy;
            let [value, bound] = [largest.value, accuracy].map(|off| off + open);
            broken.then(|| Violation { what, value, bound, unit: unit.into() })
        };
        let (distance, angle) =
            (of("distance", self.distance, 0.0, "m"), of("turn", self.angle, tip_path.open_turn(), "rad"));
        [distance, angle].into_iter().flatten()
    }
}

impl<C: Configurations> TipDeviation<'_, C> {
    /// The largest deviations between the first and the last of `knots`.
    pub(crate) fn largest(&self, knots: &[f64]) -> LargestDeviation {
        let samples = |ends: &[f64]| {
            let [from, to] = [ends[0], ends[1]];
            let none = Largest { value: -1.0, fraction: from };
            (0..=SAMPLES).fold([none; 2], |largest, i| {
                let fraction = from + (to - from) * i as f64 / SAMPLES as f64;
                let parts = self.beyond(self.parts_between(fraction, [from, to]));
                std::array::from_fn(|part| largest[part].or_larger(Largest { value: parts[part], fraction }))
            })
        };
        let sampled: Vec<[Largest; 2]> = knots.windows(2).map(samples).collect();
        let [distance, angle] = std::array::from_fn(|part| {
            let most = sampled.iter().map(|largest| largest[part].value).fold(0.0, f64::max);
            let is_near = |largest: &[Largest; 2]| most > 0.0 && largest[part].value >= NEAR_PEAK * most;
            let near = knots.windows(2).zip(&sampled).filter(|(_, largest)| is_near(largest));
            near.fold(sampled[0][part], |largest, (ends, best)| {
                let ends = [ends[0], ends[1]];
                largest
                    .or_larger(peak(ends, best[part], |fraction| self.beyond(self.parts_between(fraction, ends))[part]))
            })
        });
        LargestDeviation { distance, angle }
    }

    /// The distance (m) and the angle (rad) at a path parameter.
    pub(crate) fn parts_at(&self, fraction: f64) -> [f64; 2] {
        self.parts_between(fraction, [fraction; 2])
    }

    /// The larger of the two, beyond the turn that the path leaves open.
    pub(crate) fn at(&self, fraction: f64) -> f64 {
        let [distance, angle] = self.beyond(self.parts_at(fraction));
        distance.max(angle)
    }

    /// An upper bound of [`at`](Self::at) that is quicker to compute: the distance (m) from the path point at the same
    /// parameter, or the angle (rad) if that is larger.
    pub(crate) fn bound(&self, fraction: f64) -> f64 {
        let mut q = [0.0; MAX_DOF];
        let q = &mut q[..self.robot.dof()];
        (self.configurations)(fraction, q);
        let [distance, angle] = self.beyond(self.bounds_of(fraction, q));
        distance.max(angle)
    }

    /// Whether `is_too_much` holds for the configuration and its deviation at one of `samples` parameters between two others. The middle
    /// comes first, where a spline is farthest from its path.
    pub(crate) fn any_between(
        &self,
        [from, to]: [f64; 2],
        samples: usize,
        is_too_much: impl Fn(&[f64], f64) -> bool,
    ) -> bool {
        let mut q = [0.0; MAX_DOF];
        let q = &mut q[..self.robot.dof()];
        let mut visit = |i: usize| {
            let fraction = from + (to - from) * i as f64 / (samples + 1) as f64;
            (self.configurations)(fraction, q);
            let exceeds = |parts: [f64; 2]| {
                let [distance, angle] = self.beyond(parts);
                is_too_much(q, distance.max(angle))
            };
            exceeds(self.bounds_of(fraction, q)) && exceeds(self.parts_of(fraction, q, [from, to]))
        };
        let half = samples.div_ceil(2);
        (half..=samples).chain(1..half).any(&mut visit)
    }

    fn parts_between(&self, fraction: f64, ends: [f64; 2]) -> [f64; 2] {
        let mut q = [0.0; MAX_DOF];
        let q = &mut q[..self.robot.dof()];
        (self.configurations)(fraction, q);
        self.parts_of(fraction, q, ends)
    }

    /// Deviation that counts: the distance, and the angle beyond the turn that the path leaves open.
    fn beyond(&self, [distance, angle]: [f64; 2]) -> [f64; 2] {
        [distance, (angle - self.tip_path.open_turn()).max(0.0)]
    }

    /// Upper bounds of [`parts_of`](Self::parts_of): the distance (m) from the path point at the same parameter, and the angle (rad).
    fn bounds_of(&self, fraction: f64, q: &[f64]) -> [f64; 2] {
        let (due, tip) = (self.tip_path.path_target(fraction), self.robot.tip(q));
        due.excess(|| tip).unwrap_or_else(|| {
            let wanted = due.target.position().unwrap_or_default();
            [distance(&tip.origin, &wanted), angle_between(&due.target, || tip)]
        })
    }

    /// The distance (m) at a configuration from the part of the path around `fraction` that extends one interval before `from` and after
    /// `to`, and the angle (rad): only the position of the tip matters, not its time. With a tolerance band, those from the point at
    /// `fraction`.
    fn parts_of(&self, fraction: f64, q: &[f64], [from, to]: [f64; 2]) -> [f64; 2] {
        let (due, tip) = (self.tip_path.path_target(fraction), self.robot.tip(q));
        due.excess(|| tip).unwrap_or_else(|| {
            let length = to - from;
            let distance = self.tip_path.distance(tip.origin, from - length, to + length);
            [distance, angle_between(&due.target, || tip)]
        })
    }
}

/// The largest value between two path parameters, from the `best` sample there.
fn peak([from, to]: [f64; 2], best: Largest, value: impl Fn(f64) -> f64) -> Largest {
    let step = (to - from) / SAMPLES as f64;
    let [mut lower, mut upper] = [(best.fraction - step).max(from), (best.fraction + step).min(to)];
    for _ in 0..STEPS {
        let third = (upper - lower) / 3.0;
        if value(lower + third) > value(upper - third) {
            upper -= third;
        } else {
            lower += third;
        }
    }
    let fraction = 0.5 * (lower + upper);
    Largest { value: value(fraction), fraction }.or_larger(best)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vector::write_between;
    use crate::path::Waypoints;

    #[test]
    fn the_largest_deviation_is_that_of_dense_samples() {
        let robot = Robot::planar(&[1.0, 1.0]).unwrap();
        let (from, to) = ([0.2, 1.1], [0.9, 0.3]);
        let points = Waypoints::new(vec![robot.tip_position(&from), robot.tip_position(&to)], None).unwrap();
        let tip_path = TipPath::through(&points).unwrap();
        let configurations = |fraction: f64, q: &mut [f64]| write_between(&from, &to, fraction, q);
        let deviation = TipDeviation { robot: &robot, tip_path: &tip_path, configurations };
        let mut dense: f64 = 0.0;
        for i in 0..=4000 {
            let fraction = f64::from(i) / 4000.0;
            let mut q = [0.0; 2];
            configurations(fraction, &mut q);
            let distance = tip_path.distance(robot.tip_position(&q), 0.0, 1.0);
            assert!(distance <= deviation.bound(fraction) + 1e-12);
            dense = dense.max(distance);
        }
        let LargestDeviation { distance, angle } = deviation.largest(&[0.0, 0.3, 1.0]);
        assert!(dense > 0.01 && (distance.value - dense).abs() < 1e-3 * dense, "{} for {dense}", distance.value);
        assert_eq!(angle.value, 0.0);
        let found: Vec<Violation> = LargestDeviation { distance, angle }.violations(&tip_path, 0.5 * dense).collect();
        assert_eq!(found[0].what, "distance of the tip from the path between points 0 and 1");
        assert_eq!((found.len(), found[0].bound), (1, 0.5 * dense));
    }
}
