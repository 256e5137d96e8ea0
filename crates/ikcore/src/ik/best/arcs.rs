//! Arcs: the parts of a curve of solutions within the joint limits, and the candidate minima of the goals on them.
//!
//! Between two points of a walk, joints follow cubics. The cost of the goals is approximated by a cubic from its values and
//! slopes at both ends; the minimum of that cubic is a candidate.

use smallvec::SmallVec;

use crate::ik::self_motion::{CurvePoint, WrappedLimits};
use crate::math::MAX_DOF;
use crate::math::hermite::Cubic;
use crate::math::vector::{between, dot};
use crate::objective::Point;
use crate::robot::Robot;
use crate::task::Goals;

/// Slack on the predicted decrease of a cost, as a fraction of it.
const DOUBT: f64 = 0.1;

/// Candidate minimum: a configuration nearly on a curve and within the limits, with an optimistic estimate of its cost.
pub(super) struct Candidate {
    pub cost: f64,
    pub q: Point,
}

/// Arcs of the curves within the limits, and their candidate minima.
pub(super) struct Arcs<'r, 'a> {
    robot: &'a Robot,
    limits: &'r WrappedLimits<'a>,
    goals: &'r mut Goals,
    /// Cost and gradient at the end of the last step, if within the limits.
    last: Option<GoalValue>,
    candidates: Vec<Candidate>,
}

/// Cost of the goals at a configuration, and its gradient.
struct GoalValue {
    cost: f64,
    gradient: Point,
}

impl<'r, 'a> Arcs<'r, 'a> {
    pub fn new(robot: &'a Robot, limits: &'r WrappedLimits<'a>, goals: &'r mut Goals) -> Self {
        Self { robot, limits, goals, last: None, candidates: Vec::new() }
    }

    /// Returns the candidates in ascending order of cost.
    pub fn into_candidates(mut self) -> Vec<Candidate> {
        self.candidates.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        self.candidates
    }

    /// Separates the next step from the end of the last one.
    pub fn interrupt(&mut self) {
        self.last = None;
    }

    /// Adds the candidates of the step from `begin` to `end`, whose chord is `length` long.
    pub fn add_step(&mut self, begin: &CurvePoint, end: &CurvePoint, length: f64) {
        let ways: SmallVec<[Cubic; MAX_DOF]> = (0..begin.q.len())
            .map(|j| {
                let from = self.limits.near_middle(j, begin.q[j]);
                let slopes = [begin.along[j], end.along[j]].map(|slope| length * slope);
                Cubic::new([from, from + end.q[j] - begin.q[j]], slopes)
            })
            .collect();
        let mut last = self.last.take();
        for [from, to] in self.limits.pieces(&ways) {
            let before = last.take().filter(|_| from == 0.0);
            let values = [before.unwrap_or_else(|| self.evaluate(&ways, from)), self.evaluate(&ways, to)];
            self.add_candidate(&ways, [from, to], &values);
            let [_, after] = values;
            self.last = (to == 1.0).then_some(after);
        }
    }

    /// Adds the minimum of the cubic through the costs at both ends of a piece.
    fn add_candidate(&mut self, ways: &[Cubic], [from, to]: [f64; 2], values: &[GoalValue; 2]) {
        let slope = |end: &GoalValue, fraction: f64| -> f64 {
            let along: Point = ways.iter().map(|way| way.slope(fraction)).collect();
            (to - from) * dot(&along, &end.gradient)
        };
        let [left, right] = values;
        let cost = Cubic::new([left.cost, right.cost], [slope(left, from), slope(right, to)]);
        let lowest = cost.lowest();
        let fall = left.cost.min(right.cost) - cost.at(lowest);
        let q = self.place(ways, between(from, to, lowest));
        self.candidates.push(Candidate { cost: cost.at(lowest) - DOUBT * fall, q });
    }

    fn evaluate(&mut self, ways: &[Cubic], fraction: f64) -> GoalValue {
        let q = self.place(ways, fraction);
        let mut gradient = Point::from_elem(0.0, q.len());
        GoalValue { cost: self.goals.cost(self.robot, None, &q, &mut gradient), gradient }
    }

    fn place(&self, ways: &[Cubic], fraction: f64) -> Point {
        ways.iter().enumerate().map(|(j, way)| self.limits.near_middle(j, way.at(fraction))).collect()
    }
}
