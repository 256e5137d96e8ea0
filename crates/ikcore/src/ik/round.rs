//! Once round the self-motion of a solution, through the joint limits.
//!
//! An arm with one joint more than its task needs moves along closed curves, which its limits cut into arcs. The best
//! posture may be on an arc so short that no random start finds it; but it is on the curve of one that is found. The
//! curve is followed as if there were no limits, in long steps; between two of them, joints follow cubics.

use std::f64::consts::TAU;

use smallvec::SmallVec;

use super::self_motion::difference;
use crate::math::MAX_DOF;
use crate::math::box_step::{box_step, box_step_near, least_damping};
use crate::math::vector::{dot, norm};
use crate::objective::{Bounds, LeastSquares, Linearization, Point};
use crate::problem::Problem;
use crate::robot::Robot;
use crate::task::Goals;

/// Longest step (rad, m), and the first.
const LONGEST: f64 = 0.2;
/// Shortest step: below, the curve has a corner, which is a singular posture.
const SHORTEST: f64 = 0.01;
/// Cosine of the angle by which a step may turn the curve's direction; beyond, it is halved.
const SHARPEST: f64 = 0.94;
/// Cosine above which the next step is twice as long.
const STRAIGHT: f64 = 0.985;
/// Places looked at along a step: an arc that is shorter than their distance may be missed.
const LOOKS: usize = 32;
/// Steps after which a curve that has not closed is left.
const MOST_STEPS: usize = 400;
/// A solution nearer to the chord of a step than this share of its length is on that curve.
const ON_CURVE: f64 = 0.1;
/// Places of a curve to go on from, the best first.
const PLACES: usize = 16;
/// A place is left out where its cost is above the best by more than this share of what the cost spans along the curve.
const WORSE: f64 = 0.25;

/// The curves followed so far.
pub(super) struct Round<'a> {
    robot: &'a Robot,
    bounds: &'a Bounds,
    middle: Point,
    /// Which joints repeat themselves after a turn.
    repeats: SmallVec<[bool; MAX_DOF]>,
    /// Where all steps began, and how far each led.
    passed: Vec<(Point, Point)>,
    evaluations: usize,
}

/// What a visit to a curve brings.
pub(super) enum Visit {
    /// It was followed before.
    Known,
    /// Places within the limits, or nearly so, and nearly on the curve, where the goals are best along it.
    Curve(Vec<Point>),
    /// The task leaves no freedom, or more than that of a curve.
    NoCurve,
}

/// A place on a curve, and the curve's direction there.
#[derive(Clone)]
struct Place {
    q: Point,
    along: Point,
}

impl<'a> Round<'a> {
    pub fn new(robot: &'a Robot, bounds: &'a Bounds) -> Self {
        let middle = bounds.ranges().map(|(lower, upper)| 0.5 * (lower + upper)).collect();
        let repeats = (0..robot.dof()).map(|j| robot.repeats_every_turn(j)).collect();
        Self { robot, bounds, middle, repeats, passed: Vec::new(), evaluations: 0 }
    }

    /// What there is to know of the curve through the solution `q`, at the cost of `most` evaluations at most.
    pub fn visit(&mut self, problem: &mut Problem<'_>, goals: &mut Goals, q: &[f64], most: usize) -> Visit {
        if self.knows(q) {
            return Visit::Known;
        }
        self.follow(problem, goals, q, most).map_or(Visit::NoCurve, Visit::Curve)
    }

    /// Evaluations of the forward kinematics since they were taken last.
    pub fn take_evaluations(&mut self) -> usize {
        std::mem::take(&mut self.evaluations)
    }

    /// Whether `q` lies on a curve that was followed.
    fn knows(&self, q: &[f64]) -> bool {
        // No step leads as far in any joint: most are told by the first.
        let may_reach =
            |(begin, _): &&(Point, Point)| (0..q.len()).all(|j| self.turned(j, q[j] - begin[j]).abs() < 2.0 * LONGEST);
        self.passed.iter().filter(may_reach).any(|(begin, chord)| {
            let there = self.apart(q, begin);
            let share = (dot(&there, chord) / dot(chord, chord)).clamp(0.0, 1.0);
            let aside: Point = there.iter().zip(chord).map(|(there, chord)| there - share * chord).collect();
            norm(&aside) < ON_CURVE * norm(chord)
        })
    }

    /// Follows the curve through the solution `q`: places within the limits where, along it, `goals` are best. None where
    /// the task leaves no freedom, or more than that of a curve.
    fn follow(&mut self, problem: &mut Problem<'_>, goals: &mut Goals, q: &[f64], most: usize) -> Option<Vec<Point>> {
        let begin = self.enter(problem, q)?;
        let mut arcs = Arcs::default();
        let (mut here, mut length) = (begin.clone(), LONGEST);
        for step in 0..MOST_STEPS {
            let there = self.step(problem, &here, length);
            let cosine = dot(&here.along, &there.along);
            if cosine < SHARPEST && length > SHORTEST {
                length *= 0.5;
                continue;
            }
            self.look(length, &here, &there, goals, &mut arcs);
            self.passed.push((here.q.clone(), difference(&there.q, &here.q)));
            if step > 2 && norm(&self.apart(&there.q, &begin.q)) < 0.6 * length {
                break;
            }
            if cosine > STRAIGHT {
                length = (2.0 * length).min(LONGEST);
            }
            if self.evaluations + 2 > most {
                break;
            }
            here = there;
        }
        Some(arcs.best())
    }

    /// `q` with the direction of the only curve through it.
    fn enter(&mut self, problem: &mut Problem<'_>, q: &[f64]) -> Option<Place> {
        let mut at = Linearization::default();
        self.linearize(problem, q, &mut at);
        let mut along = Point::new();
        let (mut freedom, mut longest) = (0.0, 0.0);
        for j in 0..q.len() {
            let mut unit = Point::from_elem(0.0, q.len());
            unit[j] = 1.0;
            let free = tangent(&at, q, &unit);
            // The trace of the projection on what the task leaves free is the dimension of that.
            freedom += free[j];
            let length = norm(&free);
            if length > longest {
                (longest, along) = (length, free);
            }
        }
        let is_curve = (freedom - 1.0_f64).abs() < 0.5;
        is_curve.then(|| Place { q: q.into(), along: normalized(along) })
    }

    /// A step along the curve and back to it.
    fn step(&mut self, problem: &mut Problem<'_>, here: &Place, length: f64) -> Place {
        let mut at = Linearization::default();
        let mut q: Point = here.q.iter().zip(&here.along).map(|(q, along)| q + length * along).collect();
        for _ in 0..2 {
            self.linearize(problem, &q, &mut at);
            back_to_task(&at, &mut q);
        }
        let along = normalized(tangent(&at, &q, &here.along));
        Place { q, along }
    }

    /// Looks from `here` to `there` for what the limits leave.
    fn look(&self, step: f64, here: &Place, there: &Place, goals: &mut Goals, arcs: &mut Arcs) {
        let n = here.q.len();
        let length = norm(&difference(&there.q, &here.q));
        if !(0.7 * step..1.4 * step).contains(&length) {
            // Past a corner another curve may have been caught: what lies between is not known.
            arcs.close(|q| goals.cost(self.robot, q, &mut Point::from_slice(q)));
            (arcs.inside, arcs.last) = (false, Point::new());
            return;
        }
        let (mut q, mut gradient) = (here.q.clone(), here.q.clone());
        for look in 0..LOOKS {
            // Most places are outside, by their first joints.
            let share = look as f64 / LOOKS as f64;
            let inside = (0..n).all(|j| {
                let slopes = [here.along[j], there.along[j]].map(|slope| length * slope);
                q[j] = self.turned_to_middle(j, cubic(share, [here.q[j], there.q[j]], slopes));
                self.bounds.lower()[j] <= q[j] && q[j] <= self.bounds.upper()[j]
            });
            if inside && (look == 0 || !arcs.inside) {
                arcs.add(goals.cost(self.robot, &q, &mut gradient), &q);
            } else if !inside {
                arcs.close(|q| goals.cost(self.robot, q, &mut gradient));
            }
            (arcs.inside, arcs.last) = (inside, if inside { q.clone() } else { Point::new() });
        }
    }

    fn linearize(&mut self, problem: &mut Problem<'_>, q: &[f64], out: &mut Linearization) {
        self.evaluations += 1;
        problem.linearize(q, out);
    }

    /// a - b, whole turns aside.
    fn apart(&self, a: &[f64], b: &[f64]) -> Point {
        (0..a.len()).map(|j| self.turned(j, a[j] - b[j])).collect()
    }

    /// `angle` of joint `j`, brought near zero by whole turns.
    fn turned(&self, j: usize, angle: f64) -> f64 {
        if self.repeats[j] { angle - TAU * (angle / TAU).round() } else { angle }
    }

    /// The angle of joint `j`, by whole turns as near as it can be to the middle of its limits.
    fn turned_to_middle(&self, j: usize, angle: f64) -> f64 {
        let turns = if self.repeats[j] { ((angle - self.middle[j]) / TAU).round() } else { 0.0 };
        angle - TAU * turns
    }
}

/// The arcs met so far, as the places asked on them.
#[derive(Default)]
struct Arcs {
    /// Cost and place, arc after arc; None between two arcs.
    asked: Vec<Option<(f64, Point)>>,
    /// The last place looked at, if inside.
    last: Point,
    inside: bool,
}

impl Arcs {
    fn add(&mut self, cost: f64, q: &[f64]) {
        self.asked.push(Some((cost, q.into())));
    }

    /// Ends an arc, if one is open, with the last place that was inside.
    fn close(&mut self, mut cost: impl FnMut(&[f64]) -> f64) {
        if self.inside {
            let last = std::mem::take(&mut self.last);
            self.asked.push(Some((cost(&last), last)));
            self.asked.push(None);
        }
    }

    /// The places that are better than their neighbours, the best first.
    fn best(self) -> Vec<Point> {
        let cost = |i: Option<usize>| match i.and_then(|i| self.asked.get(i)) {
            Some(Some((cost, _))) => *cost,
            _ => f64::INFINITY,
        };
        let mut best: Vec<(f64, &Point)> = Vec::new();
        for (i, place) in self.asked.iter().enumerate() {
            if let Some((here, q)) = place
                && *here <= cost(i.checked_sub(1))
                && *here < cost(Some(i + 1))
            {
                best.push((*here, q));
            }
        }
        best.sort_by(|a, b| a.0.total_cmp(&b.0));
        let costs = || self.asked.iter().flatten().map(|(cost, _)| *cost);
        let least = costs().fold(f64::INFINITY, f64::min);
        let enough = least + WORSE * (costs().fold(f64::NEG_INFINITY, f64::max) - least);
        best.into_iter().take(PLACES).filter(|(cost, _)| *cost <= enough).map(|(_, q)| q.clone()).collect()
    }
}

const NOWHERE: [f64; MAX_DOF] = [f64::NEG_INFINITY; MAX_DOF];
const ANYWHERE: [f64; MAX_DOF] = [f64::INFINITY; MAX_DOF];

/// What of `direction` the linearised task leaves free.
fn tangent(at: &Linearization, q: &[f64], direction: &[f64]) -> Point {
    let n = q.len();
    let wished: Point = q.iter().zip(direction).map(|(q, along)| q + along).collect();
    let mut out = wished.clone();
    let damping = least_damping(&at.columns[..n]);
    box_step_near(&at.columns, &[0.0; 6], damping, q, &wished, &NOWHERE[..n], &ANYWHERE[..n], &mut out);
    difference(&out, q)
}

/// A Gauss-Newton step.
fn back_to_task(at: &Linearization, q: &mut Point) {
    let (n, from) = (q.len(), q.clone());
    let damping = least_damping(&at.columns[..n]);
    box_step(&at.columns, &at.residual, damping, &from, &NOWHERE[..n], &ANYWHERE[..n], q);
}

/// The cubic after a `share` of the way between two values with these slopes.
fn cubic(share: f64, [from, to]: [f64; 2], [left, right]: [f64; 2]) -> f64 {
    let chord = to - from;
    let (second, third) = (3.0 * chord - 2.0 * left - right, left + right - 2.0 * chord);
    from + share * (left + share * (second + share * third))
}

fn normalized(vector: Point) -> Point {
    let length = norm(&vector);
    vector.into_iter().map(|entry| entry / length).collect()
}
