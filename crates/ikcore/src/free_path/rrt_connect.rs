//! RRT-Connect (Kuffner and LaValle, ICRA 2000): two trees grow towards each other until they form a clear path through joint
//! space. Edges are examined at closely spaced configurations; what becomes of the path is certified afterwards.
//!
//! A tree whose nodes are all in narrow places hardly grows towards samples of the whole space: nearly every line is blocked. Half
//! of the attempts therefore start from a node that few attempts started from, as in expansive-space trees (Hsu, Latombe and
//! Motwani, ICRA 1997), in a random direction by a random length, and move all joints or one group of them: an arm of two can
//! leave a shelf while the other stays.

use super::configuration_tree::ConfigurationTree;
use super::joint_groups::joint_groups;
use super::line_check::LineCheck;
use crate::math::vector::{distance, write_between};
use crate::objective::Point;
use crate::obstacle::{SampledLine, Scene};
use crate::plan::Deadline;
use crate::rng::LazyRng;
use crate::robot::{Joint, Robot};
use crate::solver::Monitor;
use crate::timing::{ConstantLimits, JointPolyline};

/// Outcome of the search for a path.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Connection {
    /// A clear path.
    Found(JointPolyline),
    /// The budget was spent before the trees met.
    NotFound,
    /// The caller's monitor asked to stop.
    Interrupted,
}

/// Length of an edge while a tree grows towards a sample (rad, m).
const STRIDE: f64 = 1.0;
/// Largest length of an edge in a random direction (rad, m).
const FARTHEST: f64 = 3.0;
/// Factor on both lengths under constraints, which long lines would violate.
const WITHIN: f64 = 0.5;
/// Fraction of a stride by which one at least brings a tree nearer to its goal.
const LEAST_GAIN: f64 = 0.1;

/// Budget of node comparisons per configuration of the budget: up to twice its work again.
const COMPARISONS: usize = 300;
/// Cost of drawing a sample, in comparisons.
const SAMPLE: usize = 10;
/// Cost of a sample that no constraint admits, in comparisons.
const PROJECTION: usize = 300;

/// Number of draws after which a sample is taken even if it is not promising.
const DRAWS: usize = 1000;

/// A search for a path: its ends and its number.
pub(super) struct Route<'r> {
    pub start: &'r [f64],
    /// Alternative ends.
    pub ends: &'r [Vec<f64>],
    /// Whether a path through a configuration can be good enough.
    pub is_promising: &'r dyn Fn(&[f64]) -> bool,
}

/// The search: lines, ranges and budgets.
pub(super) struct TreeSearch<'a> {
    pub check: LineCheck<'a>,
    /// Lowest and highest value of each joint.
    pub ranges: Vec<(f64, f64)>,
    /// Total number of configurations that may be examined.
    pub budget: usize,
    /// Time that the search may take.
    pub deadline: Deadline,
    /// Smallest distance between the trees so far (rad, m).
    pub gap: f64,
    /// Nodes compared with a goal to find the nearest.
    compared: usize,
    /// Sets of joints that an edge in a random direction moves: all joints, then each independent group.
    moves: Vec<Vec<usize>>,
}

impl<'a> TreeSearch<'a> {
    pub(super) fn new(
        scene: &'a Scene<'a>,
        ranges: Vec<(f64, f64)>,
        margin: f64,
        budget: usize,
        deadline: Deadline,
    ) -> Self {
        let check = LineCheck { clear: SampledLine::new(scene, margin), kept: None, held: None };
        let groups = Some(joint_groups(scene.robot())).filter(|groups| groups.len() > 1);
        let all = (0..ranges.len()).collect();
        let moves = [all].into_iter().chain(groups.into_iter().flatten()).collect();
        Self { check, ranges, budget, deadline, gap: f64::INFINITY, compared: 0, moves }
    }

    /// Ranges of the joints of `robot` for a search between configurations `ends`: that of a joint without limits contains all of
    /// its values there.
    pub(super) fn ranges<'e>(
        robot: &Robot,
        limits: &ConstantLimits,
        ends: impl Iterator<Item = &'e Point>,
    ) -> Vec<(f64, f64)> {
        let within = |(j, joint): (usize, &Joint)| joint.sampling_range_within(limits.lower[j], limits.upper[j]);
        let mut ranges: Vec<(f64, f64)> = robot.joints().iter().enumerate().map(within).collect();
        for end in ends {
            for (j, (range, q)) in ranges.iter_mut().zip(end).enumerate() {
                let ((lower, upper), beside) = (limits.open_range(j), 0.5 * (range.1 - range.0));
                if *q < range.0 {
                    range.0 = lower.max(q - beside).min(range.0);
                } else if *q > range.1 {
                    range.1 = upper.min(q + beside).max(range.1);
                }
            }
        }
        ranges
    }

    /// Whether a budget is spent. Comparisons of nodes have their own: large trees that cannot grow spend their time on them.
    pub(super) fn is_spent(&self) -> bool {
        let comparisons = self.budget.saturating_mul(COMPARISONS);
        self.check.examined() >= self.budget || self.compared >= comparisons || self.deadline.is_over()
    }

    /// Searches for a path between clear ends.
    pub(super) fn connect(&mut self, route: &Route, rng: &mut LazyRng, monitor: &mut dyn Monitor) -> Connection {
        let n = route.start.len();
        let mut growing = ConfigurationTree::rooted(n, [route.start]);
        let mut other = ConfigurationTree::rooted(n, route.ends.iter().map(Vec::as_slice));
        let mut from_start = true;
        let mut next = vec![0.0; n];
        while !self.is_spent() {
            if !monitor.keep_going() {
                return Connection::Interrupted;
            }
            // The smaller tree grows.
            if growing.len() > other.len() {
                std::mem::swap(&mut growing, &mut other);
                from_start = !from_start;
            }
            let grown = if rng.uniform() < 0.5 {
                self.grow_towards_sample(&mut growing, route, rng, &mut next)
            } else {
                self.grow_anywhere(&mut growing, route, rng, &mut next)
            };
            let Some(reached) = grown else { continue };
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

    /// A length of an edge (rad, m), shorter within constraints.
    fn shortened(&self, length: f64) -> f64 {
        if self.check.kept.is_some() { WITHIN * length } else { length }
    }

    /// Grows `tree` by a stride from its nearest node towards a sample; writes the new configuration to `next`.
    fn grow_towards_sample(
        &mut self,
        tree: &mut ConfigurationTree,
        route: &Route,
        rng: &mut LazyRng,
        next: &mut [f64],
    ) -> Option<usize> {
        self.draw(route, rng, next);
        if !self.check.bring(next) {
            self.compared += PROJECTION;
            return None;
        }
        self.compared += tree.len();
        let (near, distance) = tree.nearest(next)?;
        let stride = self.shortened(STRIDE);
        if distance > stride {
            let sample = Point::from_slice(next);
            step_towards(tree.node(near), &sample, stride / distance, next);
        }
        let is_open = self.check.bring(next) && self.check.is_clear(tree.node(near), next);
        is_open.then(|| tree.add(next, Some(near)))
    }

    /// Grows `tree` from a node with few attempts, in a random direction; writes the new configuration to `next`.
    fn grow_anywhere(
        &mut self,
        tree: &mut ConfigurationTree,
        route: &Route,
        rng: &mut LazyRng,
        next: &mut [f64],
    ) -> Option<usize> {
        self.compared += SAMPLE;
        let node = tree.little_tried(rng);
        next.copy_from_slice(tree.node(node));
        let moved = &self.moves[rng.below(self.moves.len())];
        let length = self.shortened(FARTHEST) * rng.uniform();
        let mut direction = Point::from_elem(0.0, moved.len());
        rng.direction(&mut direction);
        for (j, part) in moved.iter().zip(&direction) {
            let (lower, upper) = self.ranges[*j];
            next[*j] = (next[*j] + length * part).max(lower).min(upper);
        }
        let is_open =
            (route.is_promising)(next) && self.check.bring(next) && self.check.is_clear(tree.node(node), next);
        is_open.then(|| tree.add(next, Some(node)))
    }

    /// Draws a configuration that is promising, if possible.
    fn draw(&mut self, route: &Route, rng: &mut LazyRng, sample: &mut [f64]) {
        for _ in 0..DRAWS {
            self.compared += SAMPLE;
            for (sample, (lower, upper)) in sample.iter_mut().zip(&self.ranges) {
                *sample = rng.uniform_in(*lower, *upper);
            }
            if (route.is_promising)(sample) {
                break;
            }
        }
    }

    /// Grows `tree` towards `goal` stride by stride; returns the node from which a clear line leads there.
    fn reach(&mut self, tree: &mut ConfigurationTree, goal: &[f64]) -> Option<usize> {
        self.compared += tree.len();
        let (mut at, mut left) = tree.nearest(goal)?;
        let mut next = goal.to_vec();
        let stride = self.shortened(STRIDE);
        while left > stride {
            step_towards(tree.node(at), goal, stride / left, &mut next);
            let is_open = !self.is_spent() && self.check.bring(&mut next) && self.check.is_clear(tree.node(at), &next);
            // Constraints may lead a step aside, or back.
            let after = distance(&next, goal);
            if !is_open || after > left - LEAST_GAIN * stride {
                self.gap = self.gap.min(left);
                return None;
            }
            at = tree.add(&next, Some(at));
            left = after;
        }
        let met = self.check.is_clear(tree.node(at), goal);
        self.gap = self.gap.min(if met { 0.0 } else { left });
        met.then_some(at)
    }
}

/// Writes the configuration at `fraction` of the way, or the goal if that is past it.
fn step_towards(from: &[f64], goal: &[f64], fraction: f64, next: &mut [f64]) {
    if fraction < 1.0 {
        write_between(from, goal, fraction, next);
    } else {
        next.copy_from_slice(goal);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vector::{between, distance};
    use crate::rng;
    use crate::robot::Robot;
    use crate::shape::Shape;
    use crate::solver::Unattended;

    const MARGIN: f64 = 0.01;

    /// Searches with `budget` from [-0.8, 0] to [0.8, 0]; returns what was found, and how many configurations were examined.
    fn connect(obstacle: Shape, budget: usize, monitor: &mut dyn Monitor) -> (Connection, usize) {
        let robot = Robot::planar(&[1.0, 1.0]).unwrap().with_capsules_along_links(0.02).unwrap();
        let obstacles = [obstacle];
        let limits = ConstantLimits::for_robot(&robot, None, "this test").unwrap();
        let scene = Scene::new(&robot, &obstacles).unwrap().without_self_collision();
        let ranges = TreeSearch::ranges(&robot, &limits, std::iter::empty());
        let mut search = TreeSearch::new(&scene, ranges, MARGIN, budget, Deadline::start(None));
        let (start, end) = ([-0.8, 0.0], [0.8, 0.0]);
        let mut rng = rng::stream(1, 0);
        let route = Route { start: &start, ends: &[end.to_vec()], is_promising: &|_| true };
        let found = search.connect(&route, &mut rng, monitor);
        if let Connection::Found(path) = &found {
            let length =
                |path: &JointPolyline| -> f64 { path.0.windows(2).map(|line| distance(&line[0], &line[1])).sum() };
            let shorter = search.shorten(path.clone(), (&|_, _| true, 60), &mut rng, &mut Unattended);
            assert!(length(&shorter) <= length(path) + 1e-12);
            for path in [path, &shorter] {
                assert_eq!((&path.0[0][..], &path.0[path.0.len() - 1][..]), (&start[..], &end[..]));
                for line in path.0.windows(2) {
                    for i in 0..=200 {
                        let at = |j: usize| between(line[0][j], line[1][j], f64::from(i) / 200.0);
                        let clearance = scene.clearance(&[at(0), at(1)]).unwrap();
                        // Between two configurations that were examined a body may come a little nearer.
                        assert!(clearance >= 0.5 * MARGIN, "{clearance} m");
                    }
                }
            }
        }
        (found, search.check.examined())
    }

    #[test]
    fn a_path_round_an_obstacle_is_clear_and_shortened() {
        let (found, _) = connect(Shape::sphere([1.6, 0.0, 0.0], 0.2).unwrap(), 50_000, &mut Unattended);
        assert!(matches!(found, Connection::Found(_)), "{found:?}");
    }

    #[test]
    fn the_budget_ends_a_search_without_a_way() {
        let wall = Shape::cuboid([0.0, 0.0, 0.0], [4.0, 0.02, 1.0], None).unwrap();
        let (found, examined) = connect(wall, 2000, &mut Unattended);
        assert_eq!(found, Connection::NotFound);
        assert!((2000..2200).contains(&examined), "{examined}"); // a line that was begun is examined to its end
    }

    #[test]
    fn a_search_without_a_single_clear_step_ends_too() {
        let everywhere = Shape::sphere([0.0, 0.0, 0.0], 0.5).unwrap();
        let (found, examined) = connect(everywhere, 2000, &mut Unattended);
        assert!(found == Connection::NotFound && examined < 2200, "{examined}");
    }

    #[test]
    fn a_monitor_interrupts_the_search() {
        struct Impatient;
        impl Monitor for Impatient {
            fn keep_going(&mut self) -> bool {
                false
            }
        }
        let (found, _) = connect(Shape::sphere([1.6, 0.0, 0.0], 0.2).unwrap(), 50_000, &mut Impatient);
        assert_eq!(found, Connection::Interrupted);
    }
}
