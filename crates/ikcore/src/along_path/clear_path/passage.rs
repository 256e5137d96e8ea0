//! Whether a posture on the path is clear, and whether the arm gets from one to the next.

use crate::along_path::open_turns::OpenTurns;
use crate::along_path::timed::{NEAR_ENOUGH, PathProblem, Projection, strays};
use crate::math::vector::largest_difference;
use crate::objective::{Bounds, Point};
use crate::obstacle::ClearSpace;

/// Longest step of a joint (rad, m) that is checked without halving it.
const FINE: f64 = 0.15;

/// Maximum number of those halvings.
const HALVINGS: usize = 3;

/// Distance that postures keep beyond the margin (m), since the arm is not certified between them.
const POSTURE_RESERVE: f64 = 5e-5;

/// Inset of the limits after a motion has left them, relative to the range.
const INSET: f64 = 1e-3;

/// A path parameter, and the posture there.
pub(super) type Waypoint<'q> = (f64, &'q [f64]);

/// Additional clearance around a point of the path.
#[derive(Debug, Clone, Copy)]
struct Extra {
    fraction: f64,
    reach: f64,
    distance: f64,
}

/// The postures that keep the margin on a path.
pub(super) struct Passage<'a> {
    pub problem: &'a PathProblem<'a>,
    /// Space of clear postures; `None`: nothing is checked.
    space: Option<&'a ClearSpace<'a>>,
    limits: Bounds,
    /// Projection within these limits, or wider ones while whole turns are left open.
    projection: Projection<'a>,
    extras: Vec<Extra>,
}

impl<'a> Passage<'a> {
    pub fn new(problem: &'a PathProblem<'a>, space: Option<&'a ClearSpace<'a>>) -> Self {
        let projection = Projection::new(&problem.robot, problem.keeps);
        Self { problem, space, limits: projection.bounds.clone(), projection, extras: vec![] }
    }

    /// Requires this `distance` beyond the margin (m) around a path parameter.
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
        self.projection.bounds = self.limits.clone();
    }

    /// Opens the limits of joints that can turn round once or more.
    pub fn open_turns(&mut self) {
        self.projection.bounds = self.turns().bounds();
    }

    /// Closes the limits of all joints again.
    pub fn close_turns(&mut self) {
        self.projection.bounds = self.limits.clone();
    }

    /// Shifts each joint of a sequence by whole turns into its limits; false if one winds too far.
    pub fn shift_inside(&self, sequence: &mut [Point]) -> bool {
        self.turns().shift_inside(sequence)
    }

    /// Whether whole turns bring each joint inside its limits, with these smallest and largest values on its way.
    pub fn fits(&self, [low, high]: &[Point; 2]) -> bool {
        (0..low.len()).all(|j| self.shift(j, low[j], high[j]).is_some())
    }

    /// Whole turns of a joint (rad) that bring what it sweeps inside its limits; `None` if there are none.
    pub fn shift(&self, j: usize, low: f64, high: f64) -> Option<f64> {
        self.turns().shift(j, low, high)
    }

    fn turns(&self) -> OpenTurns<'_> {
        OpenTurns { robot: &self.problem.robot, limits: &self.limits }
    }

    /// Returns the posture on the path nearest to `guess` without regard to limits, if there is one.
    pub fn beyond_limits(&mut self, fraction: f64, guess: &[f64]) -> Option<Point> {
        let everywhere = (0..guess.len()).map(|_| (f64::NEG_INFINITY, f64::INFINITY));
        let bounds = std::mem::replace(&mut self.projection.bounds, Bounds::from_ranges(everywhere));
        let found = self.on_path(fraction, guess);
        self.projection.bounds = bounds;
        found
    }

    /// Distance kept beyond the margin at a path parameter (m).
    pub fn kept_beyond_margin(&self, fraction: f64) -> f64 {
        let near = self.extras.iter().filter(|extra| (extra.fraction - fraction).abs() <= extra.reach);
        near.map(|extra| extra.distance).fold(POSTURE_RESERVE, f64::max)
    }

    /// Whether the posture `q` keeps clear there, and everything else that is to be kept; the joints can hold the arm there.
    pub fn is_clear(&self, fraction: f64, q: &[f64]) -> bool {
        self.problem.keeps.hold(q)
            && self.space.is_none_or(|space| space.keeps(q, self.kept_beyond_margin(fraction)))
            && self.problem.limits.too_heavy(q).is_none()
    }

    /// Returns the posture on the path nearest to `guess`, if there is one inside the limits.
    pub fn on_path(&mut self, fraction: f64, guess: &[f64]) -> Option<Point> {
        let mut q = Point::from_slice(guess);
        self.projection.bounds.clip(&mut q);
        let missed = self.projection.project(&self.problem.tip_path.path_target(fraction), &mut q);
        (missed == 0.0).then_some(q)
    }

    /// Returns that posture if it is clear.
    pub fn clear_on_path(&mut self, fraction: f64, guess: &[f64]) -> Option<Point> {
        self.on_path(fraction, guess).filter(|q| self.is_clear(fraction, q))
    }

    /// Returns the clear posture nearest to `guess` that has the tip near the path, by a part of the accuracy: one on
    /// the path may be far where the arm is singular.
    pub fn clear_near_path(&mut self, fraction: f64, guess: &[f64]) -> Option<Point> {
        let mut q = Point::from_slice(guess);
        self.projection.bounds.clip(&mut q);
        let PathProblem { tip_path, accuracy, .. } = self.problem;
        let is_near = self.projection.approach(&tip_path.path_target(fraction), &mut q, NEAR_ENOUGH * accuracy);
        (is_near && self.is_clear(fraction, &q)).then_some(q)
    }

    /// Whether `q` is inside the limits.
    pub fn is_within_limits(&self, q: &[f64]) -> bool {
        (0..q.len()).all(|j| self.projection.bounds.lower()[j] <= q[j] && q[j] <= self.projection.bounds.upper()[j])
    }

    /// Whether the arm can move along the path between two clear postures: those between are near, and clear.
    pub fn leads(&mut self, from: Waypoint<'_>, to: Waypoint<'_>) -> bool {
        self.leads_by(from, to, HALVINGS)
    }

    fn leads_by(&mut self, from: Waypoint<'_>, to: Waypoint<'_>, halvings: usize) -> bool {
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
