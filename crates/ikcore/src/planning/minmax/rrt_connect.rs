//! RRT-Connect (Kuffner and LaValle, ICRA 2000): two trees grow towards each other until they form a collision-free
//! path through joint space. Every edge is certified along its whole length.

use super::line_timing::JointPolyline;
use crate::obstacle::{Edge, Scene, Sweep};
use crate::planning::MotionLimits;
use crate::planning::deadline::Deadline;
use crate::rng::LazyRng;
use crate::solver::Monitor;

/// How the search for a path ended.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Connection {
    /// A collision-free path.
    Found(JointPolyline),
    /// The budget was spent before the trees met.
    NotFound,
    /// The caller's monitor asked to stop.
    Interrupted,
}

/// Length of an edge while a tree grows: the norm of the joint displacements, relative to their ranges.
const STRIDE: f64 = 0.08;

/// Comparisons of nodes for each configuration of the budget: about as much work again.
const COMPARISONS: usize = 500;

/// The search: scene, margin, ranges and budgets.
pub(super) struct TreeSearch<'a> {
    pub scene: &'a Scene<'a>,
    pub sweep: Sweep<'a>,
    /// Distance to keep (m).
    pub margin: f64,
    /// Lowest and highest value of each joint.
    pub ranges: Vec<(f64, f64)>,
    /// Total number of configurations that may be examined.
    pub budget: usize,
    /// Time that the search may take.
    pub deadline: Deadline,
    /// Ends of edges refused before the edge was examined.
    refused: usize,
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
        Self { scene, sweep: Sweep::new(scene), margin, ranges, budget, deadline, refused: 0, compared: 0 }
    }

    /// Whether the straight line is collision-free.
    pub(super) fn is_clear(&mut self, from: &[f64], to: &[f64]) -> bool {
        if !self.scene.is_clear(to, self.margin) {
            self.refused += 1;
            return false;
        }
        self.sweep.check(&Edge { from, to }, [0.0, 1.0], self.margin).is_ok()
    }

    /// Whether a budget is spent. Refused ends have their own: if nothing is clear, no edge is ever examined. So do
    /// comparisons of nodes, on which large trees that cannot grow spend their time.
    fn is_spent(&self) -> bool {
        let comparisons = self.budget.saturating_mul(COMPARISONS);
        let counts =
            self.sweep.examined() >= self.budget || self.refused >= self.budget || self.compared >= comparisons;
        counts || self.deadline.is_over()
    }

    /// Squared distance, with joint displacements relative to their ranges.
    fn squared_distance(&self, a: &[f64], b: &[f64]) -> f64 {
        let share = |j: usize| (a[j] - b[j]) / (self.ranges[j].1 - self.ranges[j].0).max(1e-9);
        (0..a.len()).map(|j| share(j) * share(j)).sum()
    }

    /// A path from `start` to any of `ends`.
    pub(super) fn connect(
        &mut self,
        start: &[f64],
        ends: &[Vec<f64>],
        rng: &mut LazyRng,
        monitor: &mut dyn Monitor,
    ) -> Connection {
        let mut growing = Tree::rooted(&[start.to_vec()]);
        let mut other = Tree::rooted(ends);
        let mut from_start = true;
        while !self.is_spent() {
            if !monitor.keep_going() {
                return Connection::Interrupted;
            }
            let sample: Vec<f64> = self.ranges.iter().map(|(lower, upper)| rng.uniform_in(*lower, *upper)).collect();
            if let Some(reached) = self.grow(&mut growing, &sample, 1) {
                let goal = growing.nodes[reached].clone();
                let meeting = self.grow(&mut other, &goal, usize::MAX);
                if let Some(meeting) = meeting.filter(|node| other.nodes[*node] == goal) {
                    let (mut path, mut rest) = (growing.path_from_root(reached), other.path_from_root(meeting));
                    rest.reverse();
                    path.extend(rest.into_iter().skip(1));
                    if !from_start {
                        path.reverse();
                    }
                    return Connection::Found(JointPolyline(path));
                }
            }
            std::mem::swap(&mut growing, &mut other);
            from_start = !from_start;
        }
        Connection::NotFound
    }

    /// Grows `tree` towards `goal` by up to `strides` edges; returns the last node reached, `None` if it cannot grow.
    fn grow(&mut self, tree: &mut Tree, goal: &[f64], strides: usize) -> Option<usize> {
        self.compared += tree.nodes.len();
        let distances = tree.nodes.iter().map(|node| self.squared_distance(node, goal)).enumerate();
        let (mut at, _) = distances.min_by(|one, other| one.1.total_cmp(&other.1))?;
        let mut reached = None;
        for _ in 0..strides {
            let here = &tree.nodes[at];
            if here == goal {
                return Some(at);
            }
            let share = STRIDE / self.squared_distance(here, goal).sqrt();
            let next: Vec<f64> = if share >= 1.0 {
                goal.to_vec()
            } else {
                here.iter().zip(goal).map(|(here, goal)| here + share * (goal - here)).collect()
            };
            if self.is_spent() || !self.is_clear(&tree.nodes[at], &next) {
                break;
            }
            at = tree.add(next, at);
            reached = Some(at);
        }
        reached
    }

    /// Shortens a path: removes unnecessary points, then tries random shortcuts. Takes only what `shortens` an old stretch of
    /// points by a new one with the same ends.
    pub(super) fn shorten(
        &mut self,
        path: JointPolyline,
        shortens: Shortens<'_>,
        rng: &mut LazyRng,
        monitor: &mut dyn Monitor,
    ) -> JointPolyline {
        let mut points = self.with_longest_lines(path.0, shortens);
        for _ in 0..SHORTCUTS {
            if points.len() < 3 || self.is_spent() || !monitor.keep_going() {
                break;
            }
            let (first, second, lines) = (rng.uniform(), rng.uniform(), (points.len() - 1) as f64);
            let (i, from) = along(&points, first.min(second) * lines);
            let (k, to) = along(&points, first.max(second) * lines);
            if i == k {
                continue;
            }
            let mut old = vec![from.clone()];
            old.extend_from_slice(&points[i + 1..=k]);
            old.push(to.clone());
            if shortens(&old, &[from.clone(), to.clone()]) && self.is_clear(&from, &to) {
                points.splice(i + 1..=k, [from, to]);
                points.dedup();
            }
        }
        JointPolyline(self.with_longest_lines(points, shortens))
    }

    /// Connects each point to the farthest one that a straight line can reach.
    fn with_longest_lines(&mut self, points: Vec<Vec<f64>>, shortens: Shortens<'_>) -> Vec<Vec<f64>> {
        let last = points.len() - 1;
        let (mut i, mut kept) = (0, vec![points[0].clone()]);
        while i < last {
            let is_shorter = |k: usize| shortens(&points[i..=k], &[points[i].clone(), points[k].clone()]);
            let mut ends = (i + 2..=last).rev();
            let farthest =
                ends.find(|k| !self.deadline.is_over() && is_shorter(*k) && self.is_clear(&points[i], &points[*k]));
            i = farthest.unwrap_or(i + 1);
            kept.push(points[i].clone());
        }
        kept.dedup();
        kept
    }
}

/// Whether a new stretch of points is shorter than an old one with the same ends.
type Shortens<'f> = &'f dyn Fn(&[Vec<f64>], &[Vec<f64>]) -> bool;

/// Number of random shortcuts tried.
const SHORTCUTS: usize = 60;

/// The line on which `place` lies (counted in lines), and the point there.
fn along(points: &[Vec<f64>], place: f64) -> (usize, Vec<f64>) {
    let line = (place as usize).min(points.len() - 2);
    let share = place - line as f64;
    (line, points[line].iter().zip(&points[line + 1]).map(|(a, b)| a + share * (b - a)).collect())
}

/// Configurations, each joined to its parent by a clear straight line.
struct Tree {
    nodes: Vec<Vec<f64>>,
    parents: Vec<Option<usize>>,
}

impl Tree {
    fn rooted(roots: &[Vec<f64>]) -> Self {
        Self { nodes: roots.to_vec(), parents: vec![None; roots.len()] }
    }

    fn add(&mut self, node: Vec<f64>, parent: usize) -> usize {
        self.nodes.push(node);
        self.parents.push(Some(parent));
        self.nodes.len() - 1
    }

    fn path_from_root(&self, node: usize) -> Vec<Vec<f64>> {
        let line = std::iter::successors(Some(node), |node| self.parents[*node]);
        let mut path: Vec<Vec<f64>> = line.map(|node| self.nodes[node].clone()).collect();
        path.reverse();
        path
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng;
    use crate::robot::Robot;
    use crate::shape::Shape;
    use crate::solver::Unattended;

    const MARGIN: f64 = 0.01;

    fn arm() -> Robot {
        Robot::planar(&[1.0, 1.0]).unwrap().with_capsules_along_links(0.02).unwrap()
    }

    /// Searches with `budget` from `start` to `end`; returns what was found, and how many configurations it examined.
    fn connect(obstacle: Shape, budget: usize, monitor: &mut dyn Monitor) -> (Connection, usize) {
        let (robot, obstacles) = (arm(), [obstacle]);
        let limits = MotionLimits::new(&robot, None, "this test").unwrap();
        let scene = Scene::new(&robot, &obstacles).unwrap().without_self_collision();
        let mut search = TreeSearch::new(&scene, &limits, MARGIN, budget, Deadline::start(None));
        let (start, end) = ([-0.8, 0.0], [0.8, 0.0]);
        let mut rng = rng::stream(1, 0);
        let found = search.connect(&start, &[end.to_vec()], &mut rng, monitor);
        if let Connection::Found(path) = &found {
            assert_eq!((&path.0[0][..], &path.0[path.0.len() - 1][..]), (&start[..], &end[..]));
            let length = |path: &JointPolyline| -> f64 {
                path.0.windows(2).map(|line| search.squared_distance(&line[0], &line[1]).sqrt()).sum()
            };
            let before = length(path);
            let shorter = search.shorten(path.clone(), &|_, _| true, &mut rng, &mut Unattended);
            for line in path.0.windows(2).chain(shorter.0.windows(2)) {
                for i in 0..=200 {
                    let at = |j: usize| line[0][j] + f64::from(i) / 200.0 * (line[1][j] - line[0][j]);
                    let clearance = scene.clearance(&[at(0), at(1)]).unwrap();
                    assert!(clearance >= MARGIN, "{clearance} m");
                }
            }
            let length = |path: &JointPolyline| -> f64 {
                path.0.windows(2).map(|line| search.squared_distance(&line[0], &line[1]).sqrt()).sum()
            };
            assert!(length(&shorter) <= before + 1e-12);
        }
        (found, search.sweep.examined())
    }

    #[test]
    fn a_path_round_an_obstacle_is_clear_and_shortened() {
        let (found, _) = connect(Shape::sphere([1.6, 0.0, 0.0], 0.2).unwrap(), 50_000, &mut Unattended);
        assert!(matches!(found, Connection::Found(_)), "{found:?}");
    }

    #[test]
    fn the_budget_ends_a_search_without_a_way() {
        let wall = Shape::cuboid([1.05, 0.0, 0.0], [1.9, 0.02, 1.0], None).unwrap();
        let (found, examined) = connect(wall, 2000, &mut Unattended);
        assert_eq!(found, Connection::NotFound);
        assert!(examined < 2200, "{examined}"); // an edge that was begun is examined to its end
    }

    #[test]
    fn a_search_without_a_single_clear_step_ends_too() {
        let everywhere = Shape::sphere([0.0, 0.0, 0.0], 0.5).unwrap();
        assert_eq!(connect(everywhere, 2000, &mut Unattended), (Connection::NotFound, 0));
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
