//! Deviation of the tip from its path.

use crate::along_path::tip_path::TipPath;
use crate::math::so3::{norm, rotation_between};
use crate::math::{Frame, MAX_DOF};
use crate::robot::Robot;
use crate::task::{Target, Tolerance};
use crate::timing::{JointPath, Violation};

/// Samples between two knots; the maximum is then refined between the neighbours of the best sample.
const SAMPLES: usize = 10;

/// Steps of that ternary search, each of which keeps two thirds of the interval.
const STEPS: usize = 8;

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

/// The largest deviations of the tip from its path, beyond its tolerance band.
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
        let of = |quantity: &str, largest: Largest, unit: &'static str| {
            let tolerance_band = if tip_path.has_tolerance() { ", beyond its tolerance," } else { "" };
            let what =
                format!("{quantity} of the tip{tolerance_band} from {}", tip_path.point_in_words(largest.fraction));
            let broken = largest.value > accuracy;
            broken.then(|| Violation { what, value: largest.value, bound: accuracy, unit: unit.into() })
        };
        [of("distance", self.distance, "m"), of("turn", self.angle, "rad")].into_iter().flatten()
    }
}

impl<C: Configurations> TipDeviation<'_, C> {
    /// The largest deviations between the first and the last of `knots`.
    pub(crate) fn largest(&self, knots: &[f64]) -> LargestDeviation {
        let distance = |fraction: f64, from: f64, to: f64| self.distance(fraction, from, to);
        let angle = |fraction: f64, _: f64, _: f64| self.angle(fraction);
        LargestDeviation { distance: largest_over(knots, distance), angle: largest_over(knots, angle) }
    }

    /// The distance (m) and the angle (rad) at a path parameter.
    pub(crate) fn parts_at(&self, fraction: f64) -> [f64; 2] {
        [self.distance(fraction, fraction, fraction), self.angle(fraction)]
    }

    /// The larger of the two.
    pub(crate) fn at(&self, fraction: f64) -> f64 {
        let [distance, angle] = self.parts_at(fraction);
        distance.max(angle)
    }

    /// An upper bound of [`at`](Self::at) that is quicker to compute: the distance (m) from the path point at the same
    /// parameter, or the angle (rad) if that is larger.
    pub(crate) fn bound(&self, fraction: f64) -> f64 {
        let mut q = [0.0; MAX_DOF];
        let q = &mut q[..self.robot.dof()];
        (self.configurations)(fraction, q);
        let due = self.tip_path.path_target(fraction);
        if let Some([distance, angle]) = due.excess(|| self.robot.tip(q)) {
            return distance.max(angle);
        }
        let (tip, wanted) = (self.robot.tip_position(q), due.target.position().unwrap_or_default());
        let distance = norm(&std::array::from_fn(|k| tip[k] - wanted[k]));
        distance.max(angle_between(&due.target, || self.robot.tip(q)))
    }

    /// The largest [`at`](Self::at) at `samples` parameters between two path parameters.
    pub(crate) fn between(&self, from: f64, to: f64, samples: usize) -> f64 {
        let at = |i: usize| from + (to - from) * i as f64 / (samples + 1) as f64;
        let off = |fraction: f64| self.distance(fraction, from, to).max(self.angle(fraction));
        (1..=samples).map(|i| off(at(i))).fold(0.0, f64::max)
    }

    /// The distance from the part of the path around `fraction` that extends one interval before `from` and after `to`:
    /// only the position of the tip matters, not its time. With a tolerance band, that from the point at `fraction`.
    fn distance(&self, fraction: f64, from: f64, to: f64) -> f64 {
        if let Some([distance, _]) = self.tip_path.path_target(fraction).excess(|| self.tip(fraction)) {
            return distance;
        }
        let mut q = [0.0; MAX_DOF];
        let q = &mut q[..self.robot.dof()];
        (self.configurations)(fraction, q);
        let length = to - from;
        self.tip_path.distance(self.robot.tip_position(q), from - length, to + length)
    }

    fn angle(&self, fraction: f64) -> f64 {
        let due = self.tip_path.path_target(fraction);
        match due.excess(|| self.tip(fraction)) {
            Some([_, angle]) => angle,
            None => angle_between(&due.target, || self.tip(fraction)),
        }
    }

    fn tip(&self, fraction: f64) -> Frame {
        let mut q = [0.0; MAX_DOF];
        let q = &mut q[..self.robot.dof()];
        (self.configurations)(fraction, q);
        self.robot.tip(q)
    }
}

/// Angle (rad) of the tip from a target's orientation, or from the direction of its axis; 0 for a position.
fn angle_between(target: &Target, tip: impl FnOnce() -> Frame) -> f64 {
    match target {
        Target::Pose(due) => norm(&rotation_between(due, &tip())),
        Target::Pointing { .. } => {
            target.assess_tip(&tip(), &Tolerance::default().into()).error.rotation.map_or(0.0, f64::sqrt)
        }
        Target::Position(_) | Target::Orientation(_) => 0.0,
    }
}

/// The largest `value` of (fraction, from, to) over all intervals \[from, to\] between `knots`.
fn largest_over(knots: &[f64], value: impl Fn(f64, f64, f64) -> f64) -> Largest {
    let none = Largest { value: -1.0, fraction: 0.0 };
    knots.windows(2).fold(none, |largest, ends| {
        let [from, to] = [ends[0], ends[1]];
        peak(from, to, |fraction| value(fraction, from, to)).or_larger(largest)
    })
}

/// The largest value between two path parameters.
fn peak(from: f64, to: f64, value: impl Fn(f64) -> f64) -> Largest {
    let step = (to - from) / SAMPLES as f64;
    let at = |fraction: f64| Largest { value: value(fraction), fraction };
    let best = (1..=SAMPLES).map(|i| at(from + step * i as f64)).fold(at(from), Largest::or_larger);
    let [mut lower, mut upper] = [(best.fraction - step).max(from), (best.fraction + step).min(to)];
    for _ in 0..STEPS {
        let third = (upper - lower) / 3.0;
        if value(lower + third) > value(upper - third) {
            upper -= third;
        } else {
            lower += third;
        }
    }
    at(0.5 * (lower + upper)).or_larger(best)
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
