//! Tracing of the self-motion of a solution once round, past the joint limits.
//!
//! An arm with one joint more than its task needs moves along closed curves, which its limits cut into arcs. The best
//! posture may be on an arc so short that no random start finds it; but it is on the curve of one that is found. Each curve
//! is walked once, and its [`Arcs`] report their candidate minima.

use super::arcs::{Arcs, Candidate};
use crate::ik::goal_descent::difference;
use crate::ik::self_motion::{LONGEST, StepKind, Walk, WrappedLimits};
use crate::math::vector::{dot, norm};
use crate::objective::{Bounds, Point};
use crate::problem::Problem;
use crate::robot::Robot;
use crate::task::Goals;

/// Steps after which a curve that has not closed is left.
const MOST_STEPS: usize = 150;
/// Every so many steps it is asked whether the curve has joined one that is known.
const STEPS_BETWEEN: usize = 8;
/// A place nearer to the chord of a step (rad, m) is on that curve.
const ON_CURVE: f64 = 0.02;

/// The curves walked so far.
pub(super) struct CurveTracer<'a> {
    robot: &'a Robot,
    limits: WrappedLimits<'a>,
    /// Where all steps began, and how far each led.
    passed: Vec<(Point, Point)>,
    evaluations: usize,
}

/// What a visit to a curve brings.
pub(super) enum Visit {
    /// It was walked before.
    Known,
    /// Places to go on from, the most promising first.
    Curve(Vec<Candidate>),
    /// The task leaves no freedom, or more than that of a curve.
    NoCurve,
}

/// How a walk ends.
#[derive(PartialEq, Eq)]
enum End {
    /// Where it began.
    Closed,
    /// On a curve that is known: it lost its own at a corner.
    Joined,
    /// Nowhere, after as much as may be spent.
    Spent,
}

impl<'a> CurveTracer<'a> {
    pub fn new(robot: &'a Robot, bounds: &'a Bounds) -> Self {
        Self { robot, limits: WrappedLimits::new(robot, bounds), passed: Vec::new(), evaluations: 0 }
    }

    /// What there is to know of the curve through the solution `q`, at the cost of `most` evaluations at most.
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
            // What is left of the curve lies the other way.
            walk.turn_back_at(&begin);
            arcs.interrupt();
            walk_on(&mut walk, &self.limits, &mut arcs, &mut self.passed);
        }
        self.evaluations += walk.evaluations();
        Visit::Curve(arcs.into_candidates())
    }

    /// Evaluations of the forward kinematics since they were taken last.
    pub fn take_evaluations(&mut self) -> usize {
        std::mem::take(&mut self.evaluations)
    }
}

/// Walks until the curve closes or joins one that is known, looking at what the limits leave of it.
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
        arcs.look(&from, there, length);
        passed.push((from.q, chord));
        // Begin and end overlap, so that nothing between them is missed.
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
    // No step leads as far in any joint: most are told by the first.
    let may_reach =
        |(begin, _): &&(Point, Point)| (0..q.len()).all(|j| limits.turned(j, q[j] - begin[j]).abs() < 2.0 * LONGEST);
    steps.iter().filter(may_reach).any(|(begin, chord)| {
        let there = limits.apart(q, begin);
        let fraction = (dot(&there, chord) / dot(chord, chord)).clamp(0.0, 1.0);
        let aside: Point = there.iter().zip(chord).map(|(there, chord)| there - fraction * chord).collect();
        norm(&aside) < ON_CURVE
    })
}
