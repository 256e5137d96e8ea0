//! Whether a posture on the path is clear, and whether the arm gets from one to the next.

use crate::along_path::timed::{NEAR_ENOUGH, PathProblem, approach, project, strays};
use crate::math::vector::largest_difference;
use crate::objective::{Bounds, Linearization, Point};
use crate::obstacle::ClearSpace;

/// A step that moves a joint farther (rad, m) is halved before it is checked.
const FINE: f64 = 0.15;

/// How often, at the most.
const HALVINGS: usize = 3;

/// Distance that postures keep beyond the margin (m), since the arm is not certified between them.
const RESERVE: f64 = 5e-5;

/// Postures stay this far from their limits where a motion has left them, relative to the range.
const INSET: f64 = 1e-3;

/// A point on the path, and the posture there.
pub(super) type PathPosture<'q> = (f64, &'q [f64]);

/// More clearance around a point on the path.
#[derive(Debug, Clone, Copy)]
struct Extra {
    fraction: f64,
    reach: f64,
    distance: f64,
}

/// The postures that keep the margin on a path.
pub(super) struct Passage<'a> {
    pub problem: &'a PathProblem<'a>,
    /// `None`: nothing is checked.
    space: Option<&'a ClearSpace<'a>>,
    limits: Bounds,
    /// The limits, or wider ones while whole turns are left open.
    bounds: Bounds,
    extras: Vec<Extra>,
    scratch: Linearization,
}

impl<'a> Passage<'a> {
    pub fn new(problem: &'a PathProblem<'a>, space: Option<&'a ClearSpace<'a>>) -> Self {
        let limits = Bounds::from_ranges(problem.robot.joints().iter().map(|joint| (joint.lower, joint.upper)));
        Self { problem, space, bounds: limits.clone(), limits, extras: vec![], scratch: Linearization::default() }
    }

    /// Keeps this much more than the margin (m) around a point.
    pub fn keep_more(&mut self, fraction: f64, reach: f64, distance: f64) {
        self.extras.push(Extra { fraction, reach, distance });
    }

    /// Keeps away from the limits a little: splines swing out between the postures.
    pub fn stay_inside(&mut self) {
        let ranges = self.problem.robot.joints().iter().enumerate().map(|(j, joint)| {
            let (lower, upper) = self.problem.limits.finite_range(j);
            let inset = INSET * (upper - lower);
            (joint.lower + inset, joint.upper - inset)
        });
        self.limits = Bounds::from_ranges(ranges);
        self.bounds = self.limits.clone();
    }

    /// Lets joints that turn round once or more within their limits turn on and on.
    pub fn open_turns(&mut self) {
        let range = |j: usize| {
            let (lower, upper) = (self.limits.lower()[j], self.limits.upper()[j]);
            let turns = self.problem.robot.turn_period(j).is_some_and(|period| upper - lower >= period);
            if turns { (f64::NEG_INFINITY, f64::INFINITY) } else { (lower, upper) }
        };
        self.bounds = Bounds::from_ranges((0..self.problem.robot.dof()).map(range));
    }

    /// Holds all joints inside their limits again.
    pub fn close_turns(&mut self) {
        self.bounds = self.limits.clone();
    }

    /// Shifts each joint of a sequence by whole turns into its limits; false if one winds too far.
    pub fn shift_inside(&self, sequence: &mut [Point]) -> bool {
        (0..self.problem.robot.dof()).all(|j| {
            let (lower, upper) = (self.limits.lower()[j], self.limits.upper()[j]);
            let values = || sequence.iter().map(|q| q[j]);
            let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
            let fits = |shift: f64| lower <= low + shift && high + shift <= upper;
            if fits(0.0) {
                return true;
            }
            let Some(period) = self.problem.robot.turn_period(j) else { return false };
            let shift = ((0.5 * (lower + upper - low - high)) / period).round() * period;
            sequence.iter_mut().for_each(|q| q[j] += shift);
            fits(shift)
        })
    }

    /// What is kept beyond the margin at a point (m).
    pub fn kept_beyond_margin(&self, fraction: f64) -> f64 {
        let near = self.extras.iter().filter(|extra| (extra.fraction - fraction).abs() <= extra.reach);
        near.map(|extra| extra.distance).fold(RESERVE, f64::max)
    }

    /// Whether the posture `q` keeps clear there.
    pub fn is_clear(&self, fraction: f64, q: &[f64]) -> bool {
        self.space.is_none_or(|space| space.keeps(q, self.kept_beyond_margin(fraction)))
    }

    /// The posture on the path nearest to `guess`, if there is one inside the limits.
    pub fn on_path(&mut self, fraction: f64, guess: &[f64]) -> Option<Point> {
        let mut q = Point::from_slice(guess);
        self.bounds.clip(&mut q);
        let PathProblem { robot, tip_path, .. } = self.problem;
        let missed = project(robot, &tip_path.path_target(fraction), &self.bounds, &mut q, &mut self.scratch);
        (missed == 0.0).then_some(q)
    }

    /// The same, if it is clear.
    pub fn clear_on_path(&mut self, fraction: f64, guess: &[f64]) -> Option<Point> {
        self.on_path(fraction, guess).filter(|q| self.is_clear(fraction, q))
    }

    /// The clear posture nearest to `guess` that has the tip near the path, by a part of the accuracy: one on the path may be far where
    /// the arm is singular.
    pub fn clear_near_path(&mut self, fraction: f64, guess: &[f64]) -> Option<Point> {
        let mut q = Point::from_slice(guess);
        self.bounds.clip(&mut q);
        let PathProblem { robot, tip_path, accuracy, .. } = self.problem;
        let (target, within) = (tip_path.path_target(fraction), NEAR_ENOUGH * accuracy);
        let is_near = approach(robot, &target, &self.bounds, &mut q, &mut self.scratch, within);
        (is_near && self.is_clear(fraction, &q)).then_some(q)
    }

    /// Whether `q` is inside the limits.
    pub fn is_within_limits(&self, q: &[f64]) -> bool {
        (0..q.len()).all(|j| self.bounds.lower()[j] <= q[j] && q[j] <= self.bounds.upper()[j])
    }

    /// Whether the arm can move along the path between two clear postures: those between are near, and clear.
    pub fn leads(&mut self, from: PathPosture<'_>, to: PathPosture<'_>) -> bool {
        self.leads_by(from, to, HALVINGS)
    }

    fn leads_by(&mut self, from: PathPosture<'_>, to: PathPosture<'_>, halvings: usize) -> bool {
        let fraction = 0.5 * (from.0 + to.0);
        let middle: Point = from.1.iter().zip(to.1).map(|(from, to)| 0.5 * (from + to)).collect();
        let apart = largest_difference(from.1, to.1);
        let between = self.clear_on_path(fraction, &middle).filter(|q| !strays(q, &middle, apart));
        let near_path = || self.clear_near_path(fraction, &middle).filter(|q| !strays(q, &middle, apart));
        let Some(between) = between.or_else(near_path) else { return false };
        let between = (fraction, &between[..]);
        apart <= FINE
            || halvings == 0
            || (self.leads_by(from, between, halvings - 1) && self.leads_by(between, to, halvings - 1))
    }
}
