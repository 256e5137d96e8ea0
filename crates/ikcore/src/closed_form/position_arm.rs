//! Arms of three to five revolute joints whose first three carry the tip to a position: seeds for the nearest orientation there.
//!
//! A position takes three joints; the others are parameters. The fourth joint is scanned, and for each of its values the first
//! three follow in closed form, on all branches. The fifth joint turns the hand: its best value for the orientation is known in
//! closed form where the tip is on its axis, and approached by one alternation where it is not. The seeds are the least angles
//! along the scan.

use std::f64::consts::TAU;

use smallvec::SmallVec;

use super::angle::Angle;
use super::angle_range::{AngleRange, may_hold};
use super::arm::{axes_of, drives_of};
use super::axis_chain::{AxisChain, AxisKind, JointAxis};
use super::configurations::Drives;
use super::position::{ThreeAxes, ThreeJointSolutions};
use super::structure::{EXACT, Pair};
use crate::closed_form::branches::MOST_JOINTS;
use crate::kinematics::chain::Chain;
use crate::math::Frame;
use crate::math::arithmetic::Baseline;
use crate::math::vector3::{Vector, add, cross, dot, norm, sub};

/// Largest number of joints.
const MOST: usize = 5;

/// Distance (rad) between two values of the scan.
const SPACING: f64 = 0.15;

/// Largest number of values of the scan.
const VALUES: usize = 64;

/// Solutions for each value of the scan.
const BRANCHES: usize = 4;

/// Turns of the fifth joint that the scan begins with, where the tip is off its axis.
const TURNS: usize = 4;

/// Columns of a row of the scan.
const COLUMNS: usize = BRANCHES * TURNS;

/// Largest excess over the limits (rad) of a seed, which is moved inside.
const SLACK: f64 = 0.5;

/// Largest 1 - cos(angle) above the least of the scan at which a seed may lead to the least.
const WORSE: f64 = 0.1;

/// Largest number of seeds.
pub(crate) const SEEDS: usize = 8;

/// Values of one joint (rad).
type Values = SmallVec<[f64; VALUES]>;

/// Configuration at or near the target position.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seed {
    /// Values of the joints (rad); the first as many as the arm has are valid.
    pub q: [f64; MOST_JOINTS],
}

/// Arm whose first three joints carry the tip to a position.
#[derive(Debug, Clone)]
pub(crate) struct PositionArm {
    joints: [JointAxis; MOST],
    count: usize,
    tip: Frame,
    three: ThreeAxes,
    drives: Drives,
    size: f64,
}

/// Solution of the scan.
#[derive(Debug, Clone, Copy)]
struct Sample {
    /// 1 - cos of the angle to the target orientation; infinite without a solution.
    value: f64,
    /// Number among the solutions at the same value of the fourth joint.
    index: usize,
}

impl Sample {
    const NONE: Self = Self { value: f64::INFINITY, index: 0 };
}

/// Goal of one query, in the frame of the first link.
struct Goal<'a> {
    position: Vector,
    /// Target orientation times the inverse of the tip's in the zero configuration.
    turned: Frame,
    /// Tip in the zero configuration.
    tip: Vector,
    limits: &'a [[f64; 2]; MOST_JOINTS],
    ranges: [AngleRange; 3],
    /// Whether no joint after the fourth moves the tip.
    is_on_axis: bool,
}

impl PositionArm {
    /// Returns `None` unless three to five joints drive one revolute axis each, and the first three carry the tip anywhere.
    pub fn new(chain: &Chain, joints: usize) -> Option<Self> {
        if !(3..=MOST).contains(&joints) || chain.vector.is_some() {
            return None;
        }
        let drives = drives_of(chain);
        let each_once =
            (0..joints).all(|joint| (0..drives.len()).filter(|axis| drives.joint(*axis) == joint).count() == 1);
        if drives.len() != joints || !each_once {
            return None;
        }
        let axes = axes_of::<MOST>(chain);
        if axes.joints[..joints].iter().any(|joint| joint.motion == AxisKind::Slides) {
            return None;
        }
        let AxisChain { joints: all, tip } = axes;
        let size = match joints {
            3 => AxisChain { joints: [all[0], all[1], all[2]], tip }.size(),
            4 => AxisChain { joints: [all[0], all[1], all[2], all[3]], tip }.size(),
            _ => axes.size(),
        };
        let pair = |k: usize| Pair::of(&all[k], &all[k + 1], size, EXACT);
        let three = ThreeAxes::new(&[all[0], all[1], all[2]], pair(0), pair(1), size);
        let arm = Self { joints: all, count: joints, tip, three, drives, size };
        arm.finds_samples().then_some(arm)
    }

    /// Whether the first three joints find the position of a few configurations.
    fn finds_samples(&self) -> bool {
        (0..6).all(|k| {
            let q: [f64; MOST] = std::array::from_fn(|j| 0.4 + 0.7 * (k as f64) + 1.1 * (j as f64) * (k as f64 + 0.6));
            let turns = q.map(Angle::by);
            let wrist = self.wrist(&self.tip.origin, turns[3], turns[4]);
            let goal = (0..3).rev().fold(wrist, |at, j| self.moved(j, turns[j], &at));
            let found = self.three.reach(&wrist, &goal, &[AngleRange::ANY; 3]);
            found.iter().any(|set| set.iter().zip(&turns).all(|(a, b)| (a.cos - b.cos).hypot(a.sin - b.sin) < 1e-6))
        })
    }

    /// Writes seeds for the pose `target` of `tool`, in the frame of the flange, within the limits `lower` and `upper` (rad). The
    /// best come first.
    pub fn seeds(
        &self,
        target: &Frame,
        tool: &Frame,
        [lower, upper]: [&[f64]; 2],
        found: &mut SmallVec<[Seed; SEEDS]>,
    ) {
        found.clear();
        let tip = self.tip.then::<Baseline>(tool);
        let limits = self.drives.of_axes(lower, upper);
        let back = Frame { origin: [0.0; 3], ..tip }.inverse();
        let goal = Goal {
            position: target.origin,
            turned: Frame { origin: [0.0; 3], ..*target }.then::<Baseline>(&back),
            tip: tip.origin,
            limits: &limits,
            ranges: std::array::from_fn(|j| AngleRange::of(limits[j])),
            is_on_axis: self.count < MOST || self.is_on_last_axis(&tip.origin),
        };
        let values = self.scanned(&goal);
        let turns = self.first_turns(&goal);
        let mut scan = [[Sample::NONE; COLUMNS]; VALUES];
        let mut last = [[Angle::NONE; 3]; COLUMNS];
        for (row, value) in values.iter().enumerate() {
            let (before, rows) = (if row > 0 { scan[row - 1] } else { [Sample::NONE; COLUMNS] }, &mut scan[row]);
            let mut next = last;
            self.visit(&goal, *value, &turns, |index, turns| {
                let set = [turns[0], turns[1], turns[2]];
                let column = continued(index / BRANCHES, &set, &last, &before, rows);
                rows[column] = Sample { value: self.angle_value(&goal, turns), index };
                next[column] = set;
            });
            last = next;
        }
        for (place, index) in least_of(&scan[..values.len()]) {
            self.visit(&goal, values[place], &turns, |at, turns| {
                if at == index {
                    found.extend(self.seed(&goal, turns));
                }
            });
        }
        for seed in found {
            self.drives.joints_of(&mut seed.q);
        }
    }

    /// Values of the fourth joint (rad).
    fn scanned(&self, goal: &Goal<'_>) -> Values {
        if self.count < 4 {
            return SmallVec::from_elem(0.0, 1);
        }
        spread(goal.limits[3], SPACING, VALUES)
    }

    /// Whether `tip` is on the axis of the fifth joint.
    fn is_on_last_axis(&self, tip: &Vector) -> bool {
        let last = &self.joints[MOST - 1];
        norm(&sub(tip, &last.nearest_to(tip))) <= EXACT * self.size
    }

    /// Values of the fifth joint that the scan begins with (rad).
    fn first_turns(&self, goal: &Goal<'_>) -> Values {
        if goal.is_on_axis { SmallVec::from_elem(0.0, 1) } else { spread(goal.limits[MOST - 1], 0.0, TURNS) }
    }

    /// Calls `keep` with the number and the angles of each solution at `value` of the fourth joint.
    fn visit(&self, goal: &Goal<'_>, value: f64, turns: &[f64], mut keep: impl FnMut(usize, &[Angle; MOST])) {
        let fourth = Angle::by(value);
        for (number, turn) in turns.iter().enumerate() {
            let turn = Angle::by(*turn);
            for (branch, set) in self.reached(goal, fourth, turn).iter().enumerate() {
                let column = number * BRANCHES + branch;
                let best = if self.count < MOST { Angle::NONE } else { self.best_turn(goal, set, fourth) };
                let again = if goal.is_on_axis { None } else { self.reached(goal, fourth, best).get(branch).copied() };
                let [a, b, c] = again.unwrap_or(*set);
                if may_hold(&goal.ranges, &[a, b, c]) {
                    keep(column, &[a, b, c, fourth, best]);
                }
            }
        }
    }

    /// Angles of the first three joints that carry the tip to the goal; all of them, if the turn of the fifth joint changes them.
    fn reached(&self, goal: &Goal<'_>, fourth: Angle, fifth: Angle) -> ThreeJointSolutions {
        let ranges = if goal.is_on_axis { &goal.ranges } else { &[AngleRange::ANY; 3] };
        self.three.reach(&self.wrist(&goal.tip, fourth, fifth), &goal.position, ranges)
    }

    /// Point `tip` moved by the joints after the third.
    fn wrist(&self, tip: &Vector, fourth: Angle, fifth: Angle) -> Vector {
        let turns = [fourth, fifth];
        (3..self.count).rev().fold(*tip, |at, j| self.moved(j, turns[j - 3], &at))
    }

    fn moved(&self, joint: usize, turn: Angle, point: &Vector) -> Vector {
        let JointAxis { axis, point: on_axis, .. } = &self.joints[joint];
        add(on_axis, &turn.about(axis, &sub(point, on_axis)))
    }

    /// Turn of the fifth joint, within its limits, that brings the orientation nearest to the goal's. With C = K'G and the axis a,
    /// the trace to maximise is a'C a + (tr C - a'C a) cos + (a . v) sin.
    fn best_turn(&self, goal: &Goal<'_>, set: &[Angle; 3], fourth: Angle) -> Angle {
        let axis = &self.joints[MOST - 1].axis;
        let turns = [set[0], set[1], set[2], fourth];
        let turned = |v: &Vector| (0..4).rev().fold(*v, |v, j| turns[j].about(&self.joints[j].axis, &v));
        let [k1, k2, k3] = &goal.turned.axes;
        let [x, y, _] = &Frame::IDENTITY.axes;
        let (g1, g2) = (&turned(x), &turned(y));
        let g3 = &cross(g1, g2);
        let trace = dot(k1, g1) + dot(k2, g2) + dot(k3, g3);
        let v = [dot(k2, g3) - dot(k3, g2), dot(k3, g1) - dot(k1, g3), dot(k1, g2) - dot(k2, g1)];
        let carried = Frame { axes: [*g1, *g2, *g3], origin: [0.0; 3] }.turn::<Baseline>(axis);
        let along = dot(&goal.turned.turn::<Baseline>(axis), &carried);
        let best = Angle::towards(trace - along, dot(axis, &v)).angle();
        let (inside, _) = placed(best, goal.limits[MOST - 1]);
        Angle::by(inside)
    }

    /// Value 1 - cos of the angle to the goal's orientation.
    fn angle_value(&self, goal: &Goal<'_>, turns: &[Angle; MOST]) -> f64 {
        let turned = |v: &Vector| (0..self.count).rev().fold(*v, |v, j| turns[j].about(&self.joints[j].axis, &v));
        let [x, y, _] = &Frame::IDENTITY.axes;
        let (first, second) = (turned(x), turned(y));
        let [k1, k2, k3] = &goal.turned.axes;
        0.5 * (3.0 - dot(&first, k1) - dot(&second, k2) - dot(&cross(&first, &second), k3))
    }

    /// Seed inside the limits; `None` too far outside them.
    fn seed(&self, goal: &Goal<'_>, turns: &[Angle; MOST]) -> Option<Seed> {
        let mut q = [0.0; MOST_JOINTS];
        for j in 0..self.count {
            let (inside, excess) = placed(turns[j].angle(), goal.limits[j]);
            if excess > SLACK {
                return None;
            }
            q[j] = inside;
        }
        Some(Seed { q })
    }
}

/// Returns values between these limits, or over a turn, no farther apart than `spacing`, at most `most`; `most` of them if
/// `spacing` is zero.
fn spread([lower, upper]: [f64; 2], spacing: f64, most: usize) -> Values {
    let (begin, width) = if upper - lower < TAU { (lower, upper - lower) } else { (-0.5 * TAU, TAU) };
    let count = if spacing > 0.0 { ((width / spacing).ceil() as usize + 1).min(most) } else { most };
    if count == 1 || width == 0.0 {
        return SmallVec::from_elem(begin + 0.5 * width, 1);
    }
    (0..count).map(|k| begin + width * k as f64 / (count - 1) as f64).collect()
}

/// Returns the value of `angle` at a whole turn inside the limits, or at the nearer limit, and its excess over it (rad).
fn placed(angle: f64, [lower, upper]: [f64; 2]) -> (f64, f64) {
    if !lower.is_finite() || !upper.is_finite() {
        return (angle.clamp(lower, upper), 0.0);
    }
    let above = angle + TAU * ((lower - angle) / TAU).ceil();
    if above <= upper {
        return (above, 0.0);
    }
    let (over, under) = (above - upper, lower - (above - TAU));
    if over <= under { (upper, over) } else { (lower, under) }
}

/// Returns the free column of the turn `number` whose solution at the value before is nearest to `set`, so that a column follows one
/// branch.
fn continued(
    number: usize,
    set: &[Angle; 3],
    last: &[[Angle; 3]; COLUMNS],
    before: &[Sample; COLUMNS],
    now: &[Sample; COLUMNS],
) -> usize {
    let columns = number * BRANCHES..(number + 1) * BRANCHES;
    let likeness = |column: usize| {
        let known = &last[column];
        let cosine = |k: usize| set[k].cos * known[k].cos + set[k].sin * known[k].sin;
        if before[column].value.is_finite() { cosine(0) + cosine(1) + cosine(2) } else { -4.0 }
    };
    let free = columns.clone().filter(|column| now[*column].value.is_infinite());
    free.max_by(|a, b| likeness(*a).total_cmp(&likeness(*b))).unwrap_or(columns.start)
}

/// Rows and solutions of the least values along each column of the scan, the least of all first.
fn least_of(scan: &[[Sample; COLUMNS]]) -> SmallVec<[(usize, usize); SEEDS]> {
    let at = |row: Option<usize>, column: usize| {
        row.and_then(|row| scan.get(row)).map_or(f64::INFINITY, |row| row[column].value)
    };
    let mut found: SmallVec<[(f64, usize, usize); SEEDS]> = SmallVec::new();
    for (row, samples) in scan.iter().enumerate() {
        for (column, Sample { value, index }) in samples.iter().enumerate() {
            let is_least = *value <= at(row.checked_sub(1), column) && *value < at(Some(row + 1), column);
            if !value.is_finite() || !is_least {
                continue;
            }
            let place = found.iter().position(|(other, ..)| value < other).unwrap_or(found.len());
            if place < SEEDS {
                found.truncate(SEEDS - 1);
                found.insert(place, (*value, row, *index));
            }
        }
    }
    let least = found.first().map_or(0.0, |(value, ..)| *value);
    found.into_iter().filter(|(value, ..)| *value <= least + WORSE).map(|(_, row, index)| (row, index)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng;

    /// Arm of these axes with plain drives.
    fn arm(joints: &[([f64; 3], [f64; 3])], tip: [f64; 3]) -> PositionArm {
        let turning = |k: usize| {
            joints.get(k).map_or(JointAxis::sliding([0.0, 0.0, 1.0]), |(axis, point)| JointAxis::turning(*axis, *point))
        };
        let all: [JointAxis; MOST] = std::array::from_fn(turning);
        let size = 0.5;
        let pair = |k: usize| Pair::of(&all[k], &all[k + 1], size, EXACT);
        let three = ThreeAxes::new(&[all[0], all[1], all[2]], pair(0), pair(1), size);
        let drives = Drives::new((0..joints.len()).map(|joint| (joint, 1.0)));
        let tip = Frame { origin: tip, ..Frame::IDENTITY };
        PositionArm { joints: all, count: joints.len(), tip, three, drives, size }
    }

    #[test]
    fn seeds_are_at_the_place_and_near_the_turn_of_a_pose_of_the_arm() {
        let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
        let five = [
            (z, [0.0; 3]),
            (y, [0.03, 0.0, 0.1]),
            (y, [0.06, 0.0, 0.22]),
            (y, [0.19, 0.0, 0.22]),
            (x, [0.25, 0.0, 0.22]),
        ];
        let mut rng = rng::stream(3, 0);
        for count in 3..=5 {
            let arm = arm(&five[..count], [0.35, 0.0, 0.22]);
            assert!(arm.finds_samples());
            let limits = [[-2.0; 5], [2.0; 5]];
            for _ in 0..200 {
                let q: [f64; 5] = std::array::from_fn(|_| rng.uniform_in(-1.9, 1.9));
                let motion =
                    (0..count).fold(Frame::IDENTITY, |at, j| at.then::<Baseline>(&arm.joints[j].displacement(q[j])));
                let target = motion.then::<Baseline>(&arm.tip);
                let mut seeds = SmallVec::new();
                arm.seeds(&target, &Frame::IDENTITY, [&limits[0][..count], &limits[1][..count]], &mut seeds);
                let is_near = |seed: &Seed| {
                    let joints = arm.joints.iter().zip(&seed.q).take(count);
                    let moved =
                        joints.fold(Frame::IDENTITY, |at, (joint, q)| at.then::<Baseline>(&joint.displacement(*q)));
                    let tip = moved.then::<Baseline>(&arm.tip);
                    let away = norm(&sub(&tip.origin, &target.origin));
                    away < 1e-6 && norm(&crate::math::so3::rotation_between(&target, &tip)) < 0.4
                };
                assert!(seeds.iter().any(is_near), "{count} joints at {q:?}: {seeds:?}");
            }
        }
    }
}
