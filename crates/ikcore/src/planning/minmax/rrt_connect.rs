//! RRT-Connect (Kuffner and LaValle, ICRA 2000): two trees grow towards each other until they form a clear path through joint
//! space. Edges are examined at closely spaced configurations; what becomes of the path is certified afterwards.

use super::configuration_tree::ConfigurationTree;
use super::line_timing::JointPolyline;
use crate::obstacle::{LineCheck, Scene};
use crate::planning::MotionLimits;
use crate::planning::deadline::Deadline;
use crate::rng::LazyRng;
use crate::solver::Monitor;

/// How the search for a path ended.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Connection {
    /// A clear path.
    Found(JointPolyline),
    /// The budget was spent before the trees met.
    NotFound,
    /// The caller's monitor asked to stop.
    Interrupted,
}

/// Length of an edge while a tree grows (rad, m).
const STRIDE: f64 = 1.0;

/// Comparisons of nodes for each configuration of the budget: about as much work again.
const COMPARISONS: usize = 500;

/// The search: lines, ranges and budgets.
pub(super) struct TreeSearch<'a> {
    pub check: LineCheck<'a>,
    /// Lowest and highest value of each joint.
    pub ranges: Vec<(f64, f64)>,
    /// Total number of configurations that may be examined.
    pub budget: usize,
    /// Time that the search may take.
    pub deadline: Deadline,
    /// The least that ever lay between the trees (rad, m).
    pub gap: f64,
    /// Nodes compared with a goal to find the nearest.
    compared: usize,
}

impl<'a> TreeSearch<'a> {
    pub(super) fn new(
        scene: &'a Scene<'a>,
        limits: &MotionLimits,
        margin: f64,
        budget: usize,
        deadline: Deadline,
    ) -> Self {
        let joints = scene.robot().joints().iter().enumerate();
        let ranges = joints.map(|(j, joint)| joint.sampling_range_within(limits.lower[j], limits.upper[j])).collect();
        Self { check: LineCheck::new(scene, margin), ranges, budget, deadline, gap: f64::INFINITY, compared: 0 }
    }

    /// Whether a budget is spent. Comparisons of nodes have their own: large trees that cannot grow spend their time on them.
    pub(super) fn is_spent(&self) -> bool {
        let comparisons = self.budget.saturating_mul(COMPARISONS);
        self.check.examined() >= self.budget || self.compared >= comparisons || self.deadline.is_over()
    }

    /// A path from `start` to any of `ends`, all of them clear.
    pub(super) fn connect(
        &mut self,
        start: &[f64],
        ends: &[Vec<f64>],
        rng: &mut LazyRng,
        monitor: &mut dyn Monitor,
    ) -> Connection {
        let n = start.len();
        let mut growing = ConfigurationTree::rooted(n, [start]);
        let mut other = ConfigurationTree::rooted(n, ends.iter().map(Vec::as_slice));
        let mut from_start = true;
        let (mut sample, mut next) = (vec![0.0; n], vec![0.0; n]);
        while !self.is_spent() {
            if !monitor.keep_going() {
                return Connection::Interrupted;
            }
            // The smaller tree grows.
            if growing.len() > other.len() {
                std::mem::swap(&mut growing, &mut other);
                from_start = !from_start;
            }
            for (sample, (lower, upper)) in sample.iter_mut().zip(&self.ranges) {
                *sample = rng.uniform_in(*lower, *upper);
            }
            self.compared += growing.len();
            let Some((near, distance)) = growing.nearest(&sample) else { break };
            if !growing.is_in_domain(near, distance) {
                continue;
            }
            step_towards(growing.node(near), &sample, STRIDE / distance, &mut next);
            let grew = self.check.is_clear(growing.node(near), &next);
            growing.note(near, grew);
            if !grew {
                continue;
            }
            let reached = growing.add(&next, Some(near));
            if let Some(meeting) = self.reach(&mut other, &next) {
                let (mut path, mut rest) = (growing.path_from_root(reached), other.path_from_root(meeting));
                rest.reverse();
                path.extend(rest);
                if !from_start {
                    path.reverse();
                }
                path.dedup();
                return Connection::Found(JointPolyline(path));
            }
        }
        Connection::NotFound
    }

    /// Grows `tree` towards `goal` stride by stride; returns the node from which a clear line leads there.
    fn reach(&mut self, tree: &mut ConfigurationTree, goal: &[f64]) -> Option<usize> {
        self.compared += tree.len();
        let (mut at, mut distance) = tree.nearest(goal)?;
        let mut next = goal.to_vec();
        while distance > STRIDE {
            step_towards(tree.node(at), goal, STRIDE / distance, &mut next);
            if self.is_spent() || !self.check.is_clear(tree.node(at), &next) {
                self.gap = self.gap.min(distance);
                return None;
            }
            at = tree.add(&next, Some(at));
            distance -= STRIDE;
        }
        let met = self.check.is_clear(tree.node(at), goal);
        self.gap = self.gap.min(if met { 0.0 } else { distance });
        met.then_some(at)
    }
}

/// Writes the configuration at `share` of the way, or the goal if that is past it.
fn step_towards(from: &[f64], goal: &[f64], share: f64, next: &mut [f64]) {
    let share = share.min(1.0);
    for (next, (from, goal)) in next.iter_mut().zip(from.iter().zip(goal)) {
        *next = if share < 1.0 { from + share * (goal - from) } else { *goal };
    }
}
