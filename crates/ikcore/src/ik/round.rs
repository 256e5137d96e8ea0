//! Once round the self-motion of a solution, through the joint limits.
//!
//! An arm with one joint more than its task needs moves along closed curves, which its limits cut into arcs. The best
//! posture may be on an arc so short that no random start finds it; but it is on the curve of one that is found. Each curve
//! is walked once; step by step, of what the limits leave of it, the place is told that promises to be best.

use super::curve::{LONGEST, Place, Step, Walk};
use super::room::Room;
use super::self_motion::difference;
use crate::math::hermite::Cubic;
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
/// By this share of what a cost is hoped to fall below those asked, it may be still lower.
const DOUBT: f64 = 0.1;

/// The curves walked so far.
pub(super) struct Round<'a> {
    robot: &'a Robot,
    room: Room<'a>,
    /// Where all steps began, and how far each led.
    passed: Vec<(Point, Point)>,
    evaluations: usize,
}

/// What a visit to a curve brings.
pub(super) enum Visit {
    /// It was walked before.
    Known,
    /// Places to go on from, the most promising first.
    Curve(Vec<Promise>),
    /// The task leaves no freedom, or more than that of a curve.
    NoCurve,
}

/// A place nearly on a curve, within the limits or nearly so, and a cost of the goals that is hoped for there: hardly more
/// than the least near it.
pub(super) struct Promise {
    pub cost: f64,
    pub q: Point,
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

impl<'a> Round<'a> {
    pub fn new(robot: &'a Robot, bounds: &'a Bounds) -> Self {
        Self { robot, room: Room::new(robot, bounds), passed: Vec::new(), evaluations: 0 }
    }

    /// What there is to know of the curve through the solution `q`, at the cost of `most` evaluations at most.
    pub fn visit(&mut self, problem: &mut Problem<'_>, goals: &mut Goals, q: &[f64], most: usize) -> Visit {
        if knows(&self.room, &self.passed, q) {
            return Visit::Known;
        }
        let Some(mut walk) = Walk::enter(problem, q, most) else { return Visit::NoCurve };
        let begin = walk.here().clone();
        let mut arcs = Arcs { robot: self.robot, room: &self.room, goals, last: None, promises: Vec::new() };
        if walk_on(&mut walk, &mut arcs, &mut self.passed) == End::Joined {
            // What is left of the curve lies the other way.
            walk.turn_back_at(&begin);
            arcs.last = None;
            walk_on(&mut walk, &mut arcs, &mut self.passed);
        }
        self.evaluations += walk.evaluations();
        let mut promises = arcs.promises;
        promises.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        Visit::Curve(promises)
    }

    /// Evaluations of the forward kinematics since they were taken last.
    pub fn take_evaluations(&mut self) -> usize {
        std::mem::take(&mut self.evaluations)
    }
}

/// Walks until the curve closes or joins one that is known, looking at what the limits leave of it.
fn walk_on(walk: &mut Walk<'_, '_>, arcs: &mut Arcs<'_, '_>, passed: &mut Vec<(Point, Point)>) -> End {
    let begin = walk.here().clone();
    for count in 1..=MOST_STEPS {
        let Some((from, step)) = walk.step() else { break };
        let Step::Smooth(there) = step else {
            arcs.last = None;
            continue;
        };
        let chord = difference(&there.q, &from.q);
        let length = norm(&chord);
        arcs.look(&from, &there, length);
        passed.push((from.q, chord));
        let since = arcs.room.apart(&there.q, &begin.q);
        // Begin and end overlap, so that nothing between them is missed.
        if count > 3 && norm(&since) < 1.1 * length && dot(&since, &begin.along) >= 0.0 {
            return End::Closed;
        }
        let earlier = passed.len().saturating_sub(STEPS_BETWEEN);
        if count % STEPS_BETWEEN == 0 && knows(arcs.room, &passed[..earlier], &there.q) {
            return End::Joined;
        }
    }
    End::Spent
}

/// Whether `q` lies on one of these steps.
fn knows(room: &Room<'_>, steps: &[(Point, Point)], q: &[f64]) -> bool {
    // No step leads as far in any joint: most are told by the first.
    let may_reach =
        |(begin, _): &&(Point, Point)| (0..q.len()).all(|j| room.turned(j, q[j] - begin[j]).abs() < 2.0 * LONGEST);
    steps.iter().filter(may_reach).any(|(begin, chord)| {
        let there = room.apart(q, begin);
        let share = (dot(&there, chord) / dot(chord, chord)).clamp(0.0, 1.0);
        let aside: Point = there.iter().zip(chord).map(|(there, chord)| there - share * chord).collect();
        norm(&aside) < ON_CURVE
    })
}

/// What the limits leave of the curves, and what it promises.
struct Arcs<'r, 'a> {
    robot: &'a Robot,
    room: &'r Room<'a>,
    goals: &'r mut Goals,
    /// At the end of the last step, if within the limits.
    last: Option<Asked>,
    promises: Vec<Promise>,
}

/// The goals' cost at a place, and its slope from joint to joint.
struct Asked {
    cost: f64,
    gradient: Point,
}

impl Arcs<'_, '_> {
    /// Looks from `begin` to `end`, the chord between them `length` long.
    fn look(&mut self, begin: &Place, end: &Place, length: f64) {
        let ways: Vec<Cubic> = (0..begin.q.len())
            .map(|j| {
                let from = self.room.near_middle(j, begin.q[j]);
                let slopes = [begin.along[j], end.along[j]].map(|slope| length * slope);
                Cubic::new([from, from + end.q[j] - begin.q[j]], slopes)
            })
            .collect();
        let mut last = self.last.take();
        for [from, to] in self.room.pieces(&ways) {
            let before = last.take().filter(|_| from == 0.0);
            let asked = [before.unwrap_or_else(|| self.ask(&ways, from)), self.ask(&ways, to)];
            self.promise(&ways, [from, to], &asked);
            let [_, after] = asked;
            self.last = (to == 1.0).then_some(after);
        }
    }

    /// Where on a piece the cubic between the costs at its ends is lowest.
    fn promise(&mut self, ways: &[Cubic], [from, to]: [f64; 2], asked: &[Asked; 2]) {
        let slope = |asked: &Asked, share: f64| -> f64 {
            let along = ways.iter().map(|way| way.slope(share));
            (to - from) * along.zip(&asked.gradient).map(|(along, slope)| along * slope).sum::<f64>()
        };
        let [left, right] = asked;
        let cost = Cubic::new([left.cost, right.cost], [slope(left, from), slope(right, to)]);
        let lowest = cost.lowest();
        let fall = left.cost.min(right.cost) - cost.at(lowest);
        self.promises
            .push(Promise { cost: cost.at(lowest) - DOUBT * fall, q: self.place(ways, from + lowest * (to - from)) });
    }

    fn ask(&mut self, ways: &[Cubic], share: f64) -> Asked {
        let q = self.place(ways, share);
        let mut gradient = Point::from_elem(0.0, q.len());
        Asked { cost: self.goals.cost(self.robot, &q, &mut gradient), gradient }
    }

    fn place(&self, ways: &[Cubic], share: f64) -> Point {
        ways.iter().enumerate().map(|(j, way)| self.room.near_middle(j, way.at(share))).collect()
    }
}
