//! Local search around a clear path: moves, adds and removes corners as long as the motion improves.

use std::ops::Range;

use super::certified_timing::clear_fraction;
use super::line_check::LineCheck;
use super::rrt_connect::TreeSearch;
use super::shortening::along;
use crate::math::vector::{distance, point_between};
use crate::plan::{Cost, tip_travel_along};
use crate::rng::LazyRng;
use crate::robot::Robot;
use crate::solver::Monitor;
use crate::timing::{ConstantLimits, JointPolyline};

/// Initial distance by which a corner is moved (rad, m).
const FIRST: f64 = 0.1;
/// Largest distance by which a corner is moved (rad, m).
const FARTHEST: f64 = 0.5;
/// Smallest distance (rad, m); below it, the search begins again with the initial one.
const LEAST: f64 = 2e-3;
/// Factor on that distance on success, balanced with the next at 1 success in 20.
const LONGER: f64 = 1.5;
/// Factor on that distance on failure.
const SHORTER: f64 = 0.98;

/// Probability that a change moves a corner; the rest after the next two is that of a shortcut.
const MOVES: f64 = 0.7;
/// Probability that a change adds a corner.
const ADDS: f64 = 0.15;
/// Probability that a change leaves out a corner.
const LEAVES_OUT: f64 = 0.05;

/// Tie-breaking weights of duration and length in the cost.
const OF_LENGTH: f64 = 0.01; // s/rad, in a duration
const OF_DURATION: f64 = 0.1; // rad/s, in a joint travel
const OF_TIP: f64 = 0.02; // m/s, in a tip travel

/// Measure by which paths are compared.
#[derive(Debug, Clone, Copy)]
pub(super) struct PathMeasure<'a> {
    pub robot: &'a Robot,
    pub limits: &'a ConstantLimits,
    pub objective: Cost,
}

impl PathMeasure<'_> {
    /// The cost of a motion along a path with these blends, whose cut corners are not counted; infinite if there is
    /// none.
    fn of(&self, path: &JointPolyline, fractions: &[f64]) -> f64 {
        let by_lines =
            |size: fn(&[f64], &[f64]) -> f64| path.0.windows(2).map(|line| size(&line[0], &line[1])).sum::<f64>();
        let duration = path.blend_times(self.limits, fractions).map_or(f64::INFINITY, |times| times.total());
        match self.objective {
            Cost::Time => duration + OF_LENGTH * by_lines(distance),
            Cost::JointTravel => by_lines(travel) + OF_DURATION * duration,
            Cost::TipTravel => tip_travel_along(self.robot, &path.0) + OF_TIP * duration,
        }
    }

    /// Lower bound of the cost of any motion between two configurations.
    pub(super) fn least(&self, from: &[f64], to: &[f64]) -> f64 {
        match self.objective {
            Cost::Time => (0..to.len()).map(|j| (to[j] - from[j]).abs() / self.limits.velocity[j]).fold(0.0, f64::max),
            Cost::JointTravel => travel(from, to),
            Cost::TipTravel => 0.0,
        }
    }
}

/// Travel of all joints on a line (rad, m).
fn travel(from: &[f64], to: &[f64]) -> f64 {
    from.iter().zip(to).map(|(from, to)| (to - from).abs()).sum()
}

/// A clear path with blends.
#[derive(Debug, Clone)]
pub(super) struct BlendedPath {
    pub path: JointPolyline,
    /// The fraction of the shorter adjacent line that each blend takes.
    pub fractions: Vec<f64>,
    /// Cost by the measure of the search.
    pub cost: f64,
    /// Present distance by which its corners are moved (rad, m).
    step: f64,
}

impl BlendedPath {
    /// A clear path with blends as wide as seems clear.
    pub(super) fn new(path: JointPolyline, measure: &PathMeasure, check: &mut LineCheck) -> Self {
        let mut fractions = vec![1.0; path.0.len()];
        for (i, fraction) in fractions.iter_mut().enumerate().skip(1).take(path.0.len() - 2) {
            *fraction = clear_fraction(&path, i, measure.limits, check);
        }
        let cost = measure.of(&path, &fractions);
        Self { path, fractions, cost, step: FIRST }
    }

    /// Returns the path with one random change, not yet examined.
    fn varied(&self, limits: &ConstantLimits, rng: &mut LazyRng) -> Variation {
        let mut points = self.path.0.clone();
        let (lines, kind) = (points.len() - 1, rng.uniform());
        let new = if kind < MOVES && lines > 1 {
            let i = 1 + rng.below(lines - 1);
            let pull = rng.uniform() * rng.uniform();
            points[i] = displaced(pulled(&points[i - 1..=i + 1], pull), self.step, limits, rng);
            i..i + 1
        } else if kind < MOVES + ADDS || lines < 2 {
            let (i, at) = along(&points, rng.uniform() * lines as f64);
            points.insert(i + 1, displaced(at, self.step, limits, rng));
            i + 1..i + 2
        } else if kind < MOVES + ADDS + LEAVES_OUT {
            let i = 1 + rng.below(lines - 1);
            points.remove(i);
            i..i
        } else {
            let (first, second) = (rng.uniform(), rng.uniform());
            let (i, from) = along(&points, first.min(second) * lines as f64);
            let (k, to) = along(&points, first.max(second) * lines as f64);
            points.splice(i + 1..=k, [from, to]);
            i + 1..i + 3
        };
        Variation { path: JointPolyline(points), new }
    }
}

/// A path that differs from another one by one change.
struct Variation {
    path: JointPolyline,
    /// Points that the other path lacks; none if a point was removed.
    new: Range<usize>,
}

impl Variation {
    /// Inner points whose blends change: the new points and their neighbours.
    fn touched(&self) -> Range<usize> {
        (self.new.start - 1).max(1)..(self.new.end + 1).min(self.path.0.len() - 1)
    }

    /// Fractions of the blends: of the other path, but 1 at touched points.
    fn fractions(&self, others: &[f64]) -> Vec<f64> {
        let touched = self.touched();
        let (before, after) = (&others[..touched.start], &others[others.len() - (self.path.0.len() - touched.end)..]);
        [before, &vec![1.0; touched.len()], after].concat()
    }

    /// Returns the path with blends as wide as seems clear, if it is clear and better than `best`.
    fn improvement_of(
        mut self,
        best: &BlendedPath,
        measure: &PathMeasure,
        check: &mut LineCheck,
    ) -> Option<BlendedPath> {
        let mut fractions = self.fractions(&best.fractions);
        // Narrower blends only cost more.
        if measure.of(&self.path, &fractions) >= best.cost {
            return None;
        }
        if !self.path.0[self.new.clone()].iter_mut().all(|point| check.bring(point)) {
            return None;
        }
        let changed = &self.path.0[self.new.start - 1..=self.new.end];
        if !changed.windows(2).all(|line| check.is_clear(&line[0], &line[1])) {
            return None;
        }
        for i in self.touched() {
            fractions[i] = clear_fraction(&self.path, i, measure.limits, check);
        }
        let cost = measure.of(&self.path, &fractions);
        (cost < best.cost).then_some(BlendedPath { path: self.path, fractions, cost, step: best.step })
    }
}

impl TreeSearch<'_> {
    /// Tries `changes` of a path, and keeps the better ones.
    pub(super) fn refine(
        &mut self,
        best: &mut BlendedPath,
        (measure, tries): (&PathMeasure, usize),
        rng: &mut LazyRng,
        monitor: &mut dyn Monitor,
    ) {
        for _ in 0..tries {
            if self.is_spent() || !monitor.keep_going() {
                break;
            }
            let variation = best.varied(measure.limits, rng);
            let improved = variation.improvement_of(best, measure, &mut self.check);
            let step = best.step * if improved.is_some() { LONGER } else { SHORTER };
            if let Some(improved) = improved {
                *best = improved;
            }
            best.step = if step < LEAST { FIRST } else { step.min(FARTHEST) };
        }
    }
}

/// Returns the corner, moved by a fraction of the way towards the line between its neighbours.
fn pulled(beside: &[Vec<f64>], fraction: f64) -> Vec<f64> {
    let (before, corner, after) = (&beside[0], &beside[1], &beside[2]);
    let lengths = [distance(before, corner), distance(corner, after)];
    let part = lengths[0] / (lengths[0] + lengths[1]).max(f64::MIN_POSITIVE);
    let on_line: Vec<f64> = point_between(before, after, part).collect();
    point_between(corner, &on_line, fraction).collect()
}

/// Returns a random configuration at most `step` away (rad, m), within the limits.
fn displaced(mut q: Vec<f64>, step: f64, limits: &ConstantLimits, rng: &mut LazyRng) -> Vec<f64> {
    let mut direction = vec![0.0; q.len()];
    rng.direction(&mut direction);
    let distance = step * rng.uniform();
    for (j, q) in q.iter_mut().enumerate() {
        *q = (*q + distance * direction[j]).clamp(limits.lower[j], limits.upper[j]);
    }
    q
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::{Field, Limits, Profile};
    use crate::obstacle::Scene;
    use crate::plan::Deadline;
    use crate::rng;
    use crate::shape::Shape;
    use crate::solver::Unattended;

    const START: [f64; 2] = [-0.8, 0.0];
    const END: [f64; 2] = [0.8, 0.0];

    fn limits(robot: &Robot) -> ConstantLimits {
        let limits = Limits::of(robot).replace(Field::Velocity, vec![Profile::Constant(1.0)]).unwrap();
        let limits = limits.replace(Field::Acceleration, vec![Profile::Constant(5.0)]).unwrap();
        ConstantLimits::for_robot(robot, Some(&limits), "this test").unwrap()
    }

    /// Refines a path that bends more than it has to, past a sphere; returns both.
    fn refined(objective: Cost, tries: usize) -> [BlendedPath; 2] {
        let robot = Robot::planar(&[1.0, 1.0]).unwrap().with_capsules_along_links(0.02).unwrap();
        let obstacles = [Shape::sphere([1.6, 0.0, 0.0], 0.2).unwrap()];
        let limits = limits(&robot);
        let scene = Scene::new(&robot, &obstacles).unwrap().without_self_collision();
        let ranges = TreeSearch::ranges(&robot, &limits, std::iter::empty());
        let mut search = TreeSearch::new(&scene, ranges, 0.01, 1_000_000, Deadline::start(None));
        let corners = [[-0.8, -2.2], [2.2, -2.2], [2.2, -0.5]];
        let points = [START, corners[0], corners[1], corners[2], END];
        let path = JointPolyline(points.iter().map(|q| q.to_vec()).collect());
        let measure = PathMeasure { robot: &robot, limits: &limits, objective };
        let first = BlendedPath::new(path, &measure, &mut search.check);
        let mut best = first.clone();
        search.refine(&mut best, (&measure, tries), &mut rng::stream(1, 0), &mut Unattended);
        for line in best.path.0.windows(2) {
            assert!(search.check.is_clear(&line[0], &line[1]), "{line:?}");
        }
        [first, best]
    }

    #[test]
    fn refinement_makes_every_cost_smaller_and_keeps_ends_and_obstacles() {
        for objective in [Cost::Time, Cost::JointTravel, Cost::TipTravel] {
            let [first, best] = refined(objective, 2000);
            assert!(best.cost < 0.95 * first.cost, "{objective:?}: {} of {}", best.cost, first.cost);
            let points = &best.path.0;
            assert_eq!((&points[0][..], &points[points.len() - 1][..]), (&START[..], &END[..]));
            assert_eq!(best.fractions.len(), points.len());
        }
    }

    #[test]
    fn refined_fractions_are_those_that_seem_clear() {
        let robot = Robot::planar(&[1.0, 1.0]).unwrap();
        let limits = limits(&robot);
        let [_, best] = refined(Cost::JointTravel, 500);
        let mut rng = rng::stream(3, 0);
        for _ in 0..200 {
            let variation = best.varied(&limits, &mut rng);
            let fractions = variation.fractions(&best.fractions);
            assert_eq!(fractions.len(), variation.path.0.len());
            for (i, fraction) in fractions.iter().enumerate().filter(|(i, _)| !variation.touched().contains(i)) {
                let same = best.path.0.iter().position(|q| *q == variation.path.0[i]);
                assert_eq!(same.map(|at| best.fractions[at]), Some(*fraction), "point {i}");
            }
        }
    }

    #[test]
    fn no_motion_costs_less_than_the_least() {
        for objective in [Cost::Time, Cost::JointTravel, Cost::TipTravel] {
            let robot = Robot::planar(&[1.0, 1.0]).unwrap();
            let limits = limits(&robot);
            let measure = PathMeasure { robot: &robot, limits: &limits, objective };
            let path = JointPolyline(vec![START.to_vec(), vec![0.3, 1.0], END.to_vec()]);
            let least: f64 = path.0.windows(2).map(|line| measure.least(&line[0], &line[1])).sum();
            assert!(least <= measure.of(&path, &[1.0; 3]), "{objective:?}");
        }
    }
}
