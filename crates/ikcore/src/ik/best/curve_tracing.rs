//! Tracing of closed self-motion curves past the joint limits.
//!
//! An arm with one joint more than its task needs moves along closed curves, which its limits cut into arcs. The best posture
//! may be on an arc so short that no random start finds it, but on a curve whose other arcs are found. Each curve is traced
//! once, and its [`Arcs`] report their candidate minima.

use super::arcs::{Arcs, Candidate};
use crate::ik::goal_descent::difference;
use crate::ik::self_motion::{LONGEST, StepKind, Walk, WrappedLimits};
use crate::math::vector::{dot, norm};
use crate::objective::{Bounds, Point};
use crate::problem::Problem;
use crate::robot::Robot;
use crate::task::Goals;

/// Largest number of steps on a curve that does not close.
const MOST_STEPS: usize = 150;
/// Steps between two tests whether the curve has joined a known one.
const STEPS_BETWEEN: usize = 8;
/// Distance from the chord of a step (rad, m) within which a configuration is on the curve.
const ON_CURVE: f64 = 0.02;

/// Tracer of curves, with the curves traced so far.
pub(super) struct CurveTracer<'a> {
    robot: &'a Robot,
    limits: WrappedLimits<'a>,
    /// Start and chord of every step.
    passed: Vec<(Point, Point)>,
    evaluations: usize,
}

/// Outcome of a visit to a curve.
pub(super) enum Visit {
    /// A curve traced before.
    Known,
    /// Candidates on a new curve, the most promising first.
    Curve(Vec<Candidate>),
    /// No curve: the task leaves no freedom, or more than one degree of it.
    NoCurve,
}

/// End of a walk.
#[derive(PartialEq, Eq)]
enum End {
    /// At the start of the curve.
    Closed,
    /// On a known curve, after losing its own at a corner.
    Joined,
    /// Out of budget.
    Spent,
}

impl<'a> CurveTracer<'a> {
    pub fn new(robot: &'a Robot, bounds: &'a Bounds) -> Self {
        Self { robot, limits: WrappedLimits::new(robot, bounds), passed: Vec::new(), evaluations: 0 }
    }

    /// Traces the curve through the solution `q`, with at most `most` evaluations.
    pub fn visit(&mut self, problem: &mut Problem<'_>, goals: &mut Goals, q: &[f64], most: usize) -> Visit {
        if knows(&self.limits, &self.passed, q) {
            return Visit::Known;
        }
        let Some(mut walk) = Walk::enter(problem, q, most, LONGEST) else {
            self.evaluations += most.min(1);
            return Visit::NoCurve;
        };
        let begin = walk.here().clone();
        let mut arcs = Arcs::new(self.robot, &self.limits, goals);
        if walk_on(&mut walk, &self.limits, &mut arcs, &mut self.passed) == End::Joined {
            // The rest of the curve lies in the other direction.
            walk.turn_back_at(&begin);
            arcs.interrupt();
            walk_on(&mut walk, &self.limits, &mut arcs, &mut self.passed);
        }
        self.evaluations += walk.evaluations();
        Visit::Curve(arcs.into_candidates())
    }

    /// Returns the evaluations of the forward kinematics since the last call.
    pub fn take_evaluations(&mut self) -> usize {
        std::mem::take(&mut self.evaluations)
    }
}

/// Walks until the curve closes or joins a known one, and collects its arcs.
fn walk_on(
    walk: &mut Walk<'_, '_>,
    limits: &WrappedLimits<'_>,
    arcs: &mut Arcs<'_, '_>,
    passed: &mut Vec<(Point, Point)>,
) -> End {
    let begin = walk.here().clone();
    for count in 1..=MOST_STEPS {
        let Some((from, step)) = walk.step() else { break };
        if step == StepKind::Corner {
            arcs.interrupt();
            continue;
        }
        let there = walk.here();
        let chord = difference(&there.q, &from.q);
        let length = norm(&chord);
        arcs.add_step(&from, there, length);
        passed.push((from.q, chord));
        // Overlap of begin and end, so that no part of the curve is missed.
        if count > 3 && there.has_closed_at(&begin, length, limits) {
            return End::Closed;
        }
        let earlier = passed.len().saturating_sub(STEPS_BETWEEN);
        if count % STEPS_BETWEEN == 0 && knows(limits, &passed[..earlier], &there.q) {
            return End::Joined;
        }
    }
    End::Spent
}

/// Whether `q` lies on one of these steps.
fn knows(limits: &WrappedLimits<'_>, steps: &[(Point, Point)], q: &[f64]) -> bool {
    // Bounding box of a step: it excludes most steps by their first joint.
    let may_reach =
        |(begin, _): &&(Point, Point)| (0..q.len()).all(|j| limits.turned(j, q[j] - begin[j]).abs() < 2.0 * LONGEST);
    steps.iter().filter(may_reach).any(|(begin, chord)| {
        let there = limits.apart(q, begin);
        let fraction = (dot(&there, chord) / dot(chord, chord)).clamp(0.0, 1.0);
        let aside: Point = there.iter().zip(chord).map(|(there, chord)| there - fraction * chord).collect();
        norm(&aside) < ON_CURVE
    })
}
