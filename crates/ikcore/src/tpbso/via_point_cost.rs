//! Point-to-point motion through a via point: the decision vector of Wang et al. (2019), section III-A, and its cost.

use super::collision_constraint::CollisionTest;
use super::end_configurations::EndConfigurations;
use super::penalties::{BROKEN_LIMIT, NO_CONFIGURATION};
use super::rest_segment::{Extremes, RestSegment, ViaPoint, quartic, quintic};
use crate::error::Result;
use crate::math::MAX_DOF;
use crate::objective::{Bounds, Objective, Score};
use crate::plan::Cost;
use crate::robot::Robot;
use crate::timing::ConstantLimits;
use crate::trajectory::{Trajectory, polynomial};

/// Samples of each segment, at which the tip and collisions are evaluated.
const SAMPLES: usize = 50;

/// Shortest duration of a segment, relative to the time of the slowest joint through its range.
const SHORTEST: f64 = 0.05;

/// Longest duration, relative to the same time.
const LONGEST: f64 = 4.0;

/// The cost F of eq. (15), as a function of \[theta_m (n), its rate (n), phi_s, phi_f, t1, t2\].
#[derive(Debug, Clone)]
pub(super) struct ViaPointCost<'a> {
    robot: &'a Robot,
    limits: &'a ConstantLimits,
    start: EndConfigurations,
    end: EndConfigurations,
    cost: Cost,
    scale: f64,
    collisions: Option<&'a CollisionTest<'a>>,
}

/// The parts of a decision vector.
struct Decision<'x> {
    position: &'x [f64],
    velocity: &'x [f64],
    start: &'x [f64],
    end: &'x [f64],
    t1: f64,
    t2: f64,
}

/// Configurations of both ends; the first n entries are in use.
type Ends = [[f64; MAX_DOF]; 2];

impl<'a> ViaPointCost<'a> {
    /// The cost of motions of `robot` between these ends within `limits`, whose velocities are finite.
    pub(super) fn new(
        robot: &'a Robot,
        limits: &'a ConstantLimits,
        [start, end]: [EndConfigurations; 2],
        cost: Cost,
        collisions: Option<&'a CollisionTest<'a>>,
    ) -> Self {
        Self { scale: cost.scale(robot, limits), robot, limits, start, end, cost, collisions }
    }

    /// The range of the decision vector.
    pub(super) fn bounds(&self) -> Bounds {
        let n = self.robot.dof();
        let positions = (0..n).map(|j| self.limits.finite_range(j));
        let velocities = self.limits.velocity.iter().map(|limit| (-limit, *limit));
        let redundancy = [&self.start, &self.end].into_iter().flat_map(|end| vec![end.range(); end.dimension()]);
        let whole_range = self.limits.whole_range_time();
        let times = [(SHORTEST * whole_range, LONGEST * whole_range); 2];
        Bounds::from_ranges(positions.chain(velocities).chain(redundancy).chain(times))
    }

    /// The motion of decision vector `x`; `None` if an end has no configuration.
    pub(super) fn trajectory(&self, x: &[f64]) -> Option<Result<Trajectory>> {
        let decision = self.take_apart(x);
        let [start, end] = self.ends(&decision).ok()?;
        let (mut first, mut second) = (vec![], vec![]);
        for j in 0..self.robot.dof() {
            let via = decision.via(j);
            let acceleration = RestSegment::leaving(start[j], via, decision.t1).final_acceleration();
            first.push(quartic(start[j], via, decision.t1));
            second.push(polynomial(quintic(via, acceleration, end[j], decision.t2)));
        }
        first.append(&mut second);
        let knots = vec![0.0, decision.t1, decision.t1 + decision.t2];
        Some(Trajectory::from_phases(self.limits.joint_names(), knots, first))
    }

    fn take_apart<'x>(&self, x: &'x [f64]) -> Decision<'x> {
        let n = self.robot.dof();
        let (position, rest) = x.split_at(n);
        let (velocity, rest) = rest.split_at(n);
        let (start, rest) = rest.split_at(self.start.dimension());
        let (end, times) = rest.split_at(self.end.dimension());
        Decision { position, velocity, start, end, t1: times[0], t2: times[1] }
    }

    /// Returns the configurations of both ends, or max(|k_s|, 1) + max(|k_f|, 1): eq. (13) read with |k|, since below
    /// -1 there is no angle either, and so that one term cannot lower the other by its sign.
    fn ends(&self, decision: &Decision<'_>) -> Result<Ends, f64> {
        let n = self.robot.dof();
        let mut ends = [[0.0; MAX_DOF]; 2];
        let found = [
            self.start.configuration(decision.start, &mut ends[0][..n]),
            self.end.configuration(decision.end, &mut ends[1][..n]),
        ];
        let excess = |end: &Result<(), f64>| end.err().map_or(1.0, f64::abs);
        match found {
            [Ok(()), Ok(())] => Ok(ends),
            [start, end] => Err(excess(&start) + excess(&end)),
        }
    }

    /// F of eq. (15).
    fn value(&self, x: &[f64]) -> f64 {
        let decision = self.take_apart(x);
        let [start, end] = match self.ends(&decision) {
            Ok(ends) => ends,
            Err(excess) => return NO_CONFIGURATION * self.scale * excess,
        };
        let (mut travel, mut broken) = (0.0, 0.0);
        let mut segments = [[RestSegment::STILL; MAX_DOF]; 2];
        for j in 0..self.robot.dof() {
            let via = decision.via(j);
            let first = RestSegment::leaving(start[j], via, decision.t1);
            let second = RestSegment::arriving(via, first.final_acceleration(), end[j], decision.t2);
            for extremes in [first.extremes(), second.extremes()] {
                travel += extremes.travel;
                broken += self.broken(j, &extremes);
            }
            (segments[0][j], segments[1][j]) = (first, second);
        }
        let cost = match self.cost {
            Cost::Time => decision.t1 + decision.t2,
            Cost::JointTravel => travel,
            Cost::TipTravel => self.tip_travel(&segments, &decision),
        };
        if let Some(collisions) = self.collisions {
            self.samples(&segments, &decision, |q| broken += collisions.touching(q));
        }
        cost + BROKEN_LIMIT * self.scale * broken
    }

    /// g_1 and g_2 of eq. (15), from the exact extremes relative to the limits. An extreme that violates its limit
    /// counts in full, not only its excess, which a search would trade for cost. Position limits, which the paper does
    /// not have, count likewise.
    fn broken(&self, j: usize, extremes: &Extremes) -> f64 {
        let fraction = |value: f64, limit: f64| if value > limit { value / limit } else { 0.0 };
        let (lower, upper) = (self.limits.lower[j], self.limits.upper[j]);
        let beyond = (lower - extremes.lowest).max(extremes.highest - upper);
        let outside = if beyond > 0.0 { 1.0 + beyond } else { 0.0 };
        fraction(extremes.speed, self.limits.velocity[j])
            + fraction(extremes.acceleration, self.limits.acceleration[j])
            + outside
    }

    /// F_d of eq. (10): chords between samples.
    fn tip_travel(&self, segments: &[[RestSegment; MAX_DOF]; 2], decision: &Decision<'_>) -> f64 {
        let mut last: Option<[f64; 3]> = None;
        let mut travel = 0.0;
        self.samples(segments, decision, |q| {
            let tip = self.robot.tip_position(q);
            let chord = |last: [f64; 3]| (0..3).map(|k| (tip[k] - last[k]) * (tip[k] - last[k])).sum::<f64>().sqrt();
            travel += last.map_or(0.0, chord);
            last = Some(tip);
        });
        travel
    }

    /// Calls `visit` with the configurations at [`SAMPLES`] instants of each segment, in order.
    fn samples(&self, segments: &[[RestSegment; MAX_DOF]; 2], decision: &Decision<'_>, mut visit: impl FnMut(&[f64])) {
        let n = self.robot.dof();
        let mut q = [0.0; MAX_DOF];
        for i in 0..=2 * SAMPLES {
            let (segment, s) = match i.checked_sub(SAMPLES) {
                None => (0, decision.t1 * i as f64 / SAMPLES as f64),
                Some(i) => (1, decision.t2 * (SAMPLES - i) as f64 / SAMPLES as f64),
            };
            (0..n).for_each(|j| q[j] = segments[segment][j].position(s));
            visit(&q[..n]);
        }
    }
}

impl Decision<'_> {
    fn via(&self, joint: usize) -> ViaPoint {
        ViaPoint { position: self.position[joint], velocity: self.velocity[joint] }
    }
}

impl Objective for ViaPointCost<'_> {
    fn dimension(&self) -> usize {
        2 * self.robot.dof() + self.start.dimension() + self.end.dimension() + 2
    }

    /// Never solved: no cost is small enough to stop at.
    fn evaluate(&mut self, x: &[f64]) -> Score {
        Score { value: self.value(x), solved: false }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::{Field, Limits, Profile};

    #[test]
    fn the_cost_is_that_of_the_trajectory_until_it_breaks_a_limit() {
        let robot = Robot::planar(&[1.0, 1.0]).unwrap();
        let all = |value: f64| vec![Profile::Constant(value)];
        let limits = Limits::of(&robot).replace(Field::Velocity, all(1.0)).unwrap();
        let limits = limits.replace(Field::Acceleration, all(2.0)).unwrap();
        let limits = ConstantLimits::for_robot(&robot, Some(&limits), "this test").unwrap();
        for objective in [Cost::Time, Cost::JointTravel] {
            let ends = [vec![0.0, 0.0], vec![0.5, -0.4]].map(EndConfigurations::Fixed);
            let mut cost = ViaPointCost::new(&robot, &limits, ends, objective, None);
            assert_eq!((cost.dimension(), cost.bounds().lower().len()), (6, 6));
            let slow = [0.25, -0.2, 0.1, -0.1, 3.0, 3.0];
            let motion = cost.trajectory(&slow).unwrap().unwrap();
            assert_eq!(limits.violations(&motion), []);
            let (value, exact) = (cost.evaluate(&slow).value, objective.of(&robot, &motion));
            assert!((value - exact).abs() < 1e-9, "{objective}: {value} for {exact}");
            let hasty = [0.25, -0.2, 0.1, -0.1, 0.2, 0.2];
            assert!(!limits.violations(&cost.trajectory(&hasty).unwrap().unwrap()).is_empty());
            let penalty = BROKEN_LIMIT * objective.scale(&robot, &limits);
            assert!(cost.evaluate(&hasty).value > penalty, "{objective}");
        }
    }
}
