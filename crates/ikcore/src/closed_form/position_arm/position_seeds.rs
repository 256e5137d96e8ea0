//! Seeds for the nearest orientation at a position.

use std::f64::consts::TAU;

use smallvec::SmallVec;

use super::goal::{PositionGoal, TurnRange};
use super::of_position::PositionArm;
use super::plane_joints::{PLANE_BRANCHES, PlaneJoints};
use super::scan::{MOST, Minima, SEEDS, Scan, ScanMinimum, ScanSample, likeness};
use super::solutions::ScanFrom;
use crate::closed_form::angle::Angle;
use crate::closed_form::angle_range::AngleRange;
use crate::closed_form::branches::MOST_JOINTS;
use crate::closed_form::structure::EXACT;
use crate::math::Frame;
use crate::math::arithmetic::Baseline;
use crate::math::vector3::{Vector, norm, sub};

/// Distance (rad) between two values of the scan.
const SPACING: f64 = 0.15;

/// Largest number of values of the scan.
const VALUES: usize = 64;

/// Distance (rad) between two turns of a scan of the fifth joint.
const TURN_SPACING: f64 = 0.25;
/// Gain assumed between two turns of the scan, as a fraction of the rise to the next.
const GAIN: f64 = 0.25;

/// Turns of the fifth joint that the scan begins with, where the tip is far off its axis.
const TURNS: usize = 4;

/// Distance of the tip from the axis of the fifth joint, relative to the arm's size, up to which it is near.
const NEAR_AXIS: f64 = 0.1;

/// The same, relative to the distance of the goal from the first axis: beside that axis, little turns the arm far.
const NEAR_FIRST: f64 = 0.25;

/// Excess over the limits (rad) at which a solution for a tip near the axis counts: another turn of the fifth joint may bring a joint
/// inside its limits.
const NEAR_LIMITS: f64 = 0.2;

/// Largest excess over the limits (rad) of a seed, which is moved inside.
const SLACK: f64 = 0.5;

/// Difference of the angles (rad) of two seeds that lead to the same optimum.
const SAME: f64 = 1e-4;

/// Minimum gain assumed for a descent from a seed of an arm with parallel middle axes.
const LEAST_RESERVE: f64 = 0.02;

/// Values of one joint (rad).
type Values = SmallVec<[f64; VALUES]>;

/// Configuration at or near the target position.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seed {
    /// Values of the joints (rad); the first as many as the arm has are valid.
    pub q: [f64; MOST_JOINTS],
    /// 1 - cos of the angle to the target orientation.
    pub value: f64,
    /// Least such value that a descent from here can be expected to reach.
    pub least: f64,
}

/// Optima with the value that a descent may gain beyond each, the least first.
type Optima = SmallVec<[(f64, ScanSample); SEEDS]>;

/// Place of the tip, seen from the axis of the fifth joint.
#[derive(Debug, Clone, Copy, PartialEq)]
enum TipPlace {
    /// On the axis, or there is no such joint.
    OnAxis,
    /// Near this point of the axis.
    Near(Vector),
    Off,
}

impl PositionArm {
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
        if !self.moves(&tip.origin) {
            return;
        }
        let limits = self.drives.of_axes(lower, upper);
        let back = Frame { origin: [0.0; 3], ..tip }.inverse();
        let turned = Frame { origin: [0.0; 3], ..*target }.then::<Baseline>(&back);
        let place = self.tip_place(&tip.origin, &target.origin);
        let slack = if let TipPlace::Near(_) = place { NEAR_LIMITS } else { 0.0 };
        let goal = PositionGoal {
            position: target.origin,
            turned,
            wanted: self.basis.map(|vector| turned.turn::<Baseline>(&vector)),
            tip: tip.origin,
            limits: &limits,
            ranges: std::array::from_fn(|j| AngleRange::of([limits[j][0] - slack, limits[j][1] + slack])),
            inside: std::array::from_fn(|j| TurnRange::of(limits[j])),
            last: TurnRange::of(limits[MOST - 1]),
        };
        if !self.write_optima(&goal, place, found) {
            self.write_scanned(&goal, place, found);
        }
        found.sort_by(|a, b| a.value.total_cmp(&b.value));
        for seed in found {
            self.drives.joints_of(&mut seed.q);
        }
    }

    /// Writes the seeds of an arm with parallel axes in the middle; returns whether there are any.
    fn write_optima(&self, goal: &PositionGoal<'_>, place: TipPlace, found: &mut SmallVec<[Seed; SEEDS]>) -> bool {
        let Some(plane) = &self.plane else { return false };
        match place {
            TipPlace::OnAxis => self.write_plane_optima(plane, goal, found),
            TipPlace::Near(_) | TipPlace::Off => self.write_turn_scan(plane, goal, found),
        }
        !found.is_empty()
    }

    /// Writes the optima of a tip on the last axis.
    fn write_plane_optima(&self, plane: &PlaneJoints, goal: &PositionGoal<'_>, found: &mut SmallVec<[Seed; SEEDS]>) {
        let mut optima = Optima::new();
        plane.visit_optima(goal, |sample| insert_least(&mut optima, (0.0, sample)));
        self.write_seeds(goal, &optima, found);
    }

    /// Writes the least values of a scan of the fifth joint, along each branch of the others.
    fn write_turn_scan(&self, plane: &PlaneJoints, goal: &PositionGoal<'_>, found: &mut SmallVec<[Seed; SEEDS]>) {
        let turns = spread(goal.limits[MOST - 1], TURN_SPACING, VALUES);
        let mut rows: SmallVec<[[ScanSample; PLANE_BRANCHES]; 32]> = SmallVec::new();
        let mut least = f64::INFINITY;
        for turn in turns {
            let mut row = [ScanSample::NONE; PLANE_BRANCHES];
            plane.visit_best(goal, Angle::by(turn), least + LEAST_RESERVE, |branch, sample| {
                if sample.value < row[branch].value {
                    row[branch] = sample;
                }
                least = least.min(sample.value);
            });
            rows.push(row);
        }
        let mut optima = Optima::new();
        for branch in 0..PLANE_BRANCHES {
            let value = |k: usize| rows.get(k).map_or(f64::INFINITY, |row| row[branch].value);
            for (k, row) in rows.iter().enumerate() {
                let here = value(k);
                let beside = [value(k.wrapping_sub(1)), value(k + 1)];
                if here < beside[0] && here <= beside[1] {
                    let rise = beside
                        .iter()
                        .filter(|value| value.is_finite())
                        .fold(0.0, |most: f64, value| most.max(value - here));
                    insert_least(&mut optima, (LEAST_RESERVE + GAIN * rise, row[branch]));
                }
            }
        }
        self.write_seeds(goal, &optima, found);
    }

    /// Writes seeds at optima, in order of their values.
    fn write_seeds(&self, goal: &PositionGoal<'_>, optima: &Optima, found: &mut SmallVec<[Seed; SEEDS]>) {
        for (gain, sample) in optima {
            let Some(seed) = self.inside(goal, sample, sample.value - gain) else { continue };
            if !found.iter().any(|other| self.are_same(&seed, other)) {
                found.push(seed);
            }
        }
    }

    /// Writes the seeds of a scan of the fourth joint.
    fn write_scanned(&self, goal: &PositionGoal<'_>, place: TipPlace, found: &mut SmallVec<[Seed; SEEDS]>) {
        let values = self.scanned(goal);
        let mut minima = match place {
            TipPlace::OnAxis => self.minima(goal, &values, &[ScanFrom::OnAxis]),
            TipPlace::Near(on_axis) => self.minima(goal, &values, &[ScanFrom::Near(&goal.seen_from(on_axis))]),
            TipPlace::Off => Minima::new(),
        };
        if minima.is_empty() && place != TipPlace::OnAxis {
            let turns = spread(goal.limits[MOST - 1], 0.0, TURNS).into_iter();
            let firsts: SmallVec<[ScanFrom<'_>; TURNS]> = turns.map(|turn| ScanFrom::Turn(Angle::by(turn))).collect();
            minima = self.minima(goal, &values, &firsts);
        }
        let spacing = if values.len() > 1 { values[1] - values[0] } else { 0.0 };
        for minimum in &minima {
            let sample = self.refined(goal, minimum, spacing, place);
            // Past a fold of its branch, which may lie between two values, a descent gains much: each may lead to the least.
            let Some(seed) = self.inside(goal, &sample, f64::NEG_INFINITY) else { continue };
            if !found.iter().any(|other| self.are_same(&seed, other)) {
                found.push(seed);
            }
        }
    }

    /// Least values of the scan, the least of all first.
    fn minima(&self, goal: &PositionGoal<'_>, values: &[f64], firsts: &[ScanFrom<'_>]) -> Minima {
        let mut scan = Scan::new(firsts.len());
        for value in values {
            let fourth = self.fourth(*value);
            for (number, first) in firsts.iter().enumerate() {
                self.visit(goal, &fourth, first, |sample| scan.add(number, sample));
            }
            scan.end_row(*value);
        }
        if let [first @ ScanFrom::OnAxis] = firsts {
            self.visit_limits(goal.limits, |given| self.visit(goal, given, first, |sample| scan.add_end(sample)));
        }
        scan.finish()
    }

    /// Values of the fourth joint (rad).
    fn scanned(&self, goal: &PositionGoal<'_>) -> Values {
        if self.count < 4 {
            return SmallVec::from_elem(0.0, 1);
        }
        spread(goal.limits[3], SPACING, VALUES)
    }

    /// Where the tip is, seen from the axis of the fifth joint, for a goal at `position`.
    fn tip_place(&self, tip: &Vector, position: &Vector) -> TipPlace {
        if self.count < MOST {
            return TipPlace::OnAxis;
        }
        let on_axis = self.joints[MOST - 1].nearest_to(tip);
        let off = norm(&sub(tip, &on_axis));
        let from_first = norm(&sub(position, &self.joints[0].nearest_to(position)));
        if off <= EXACT * self.size {
            TipPlace::OnAxis
        } else if off <= NEAR_AXIS * self.size && off <= NEAR_FIRST * from_first {
            TipPlace::Near(on_axis)
        } else {
            TipPlace::Off
        }
    }

    /// Seed at a sample, inside the limits; `None` too far outside them.
    fn inside(&self, goal: &PositionGoal<'_>, sample: &ScanSample, least: f64) -> Option<Seed> {
        let mut q = [0.0; MOST_JOINTS];
        for j in 0..self.count {
            let (inside, excess) = placed(sample.turns[j].angle(), goal.limits[j]);
            if excess > SLACK {
                return None;
            }
            q[j] = inside;
        }
        Some(Seed { q, value: sample.value, least })
    }

    /// Solution near the vertex at a minimum of the scan.
    fn refined(&self, goal: &PositionGoal<'_>, minimum: &ScanMinimum, spacing: f64, place: TipPlace) -> ScanSample {
        let sample = &minimum.sample;
        let Some(fourth) = minimum.vertex(spacing) else { return *sample };
        match self.solution_near(goal, sample, fourth, place) {
            Some(nearby) if place != TipPlace::OnAxis || nearby.value <= sample.value => nearby,
            _ => *sample,
        }
    }

    /// Solution at this value of the fourth joint that is most like `sample`.
    fn solution_near(
        &self,
        goal: &PositionGoal<'_>,
        sample: &ScanSample,
        fourth: f64,
        place: TipPlace,
    ) -> Option<ScanSample> {
        let mut found: Option<(f64, ScanSample)> = None;
        let keep = |other: ScanSample| {
            let near = likeness(&other, sample);
            if found.is_none_or(|(nearest, _)| near > nearest) {
                found = Some((near, other));
            }
        };
        let first = match place {
            TipPlace::OnAxis => ScanFrom::OnAxis,
            _ => ScanFrom::Turn(sample.turns[MOST - 1]),
        };
        self.visit(goal, &self.fourth(fourth), &first, keep);
        found.map(|(_, sample)| sample)
    }

    /// Whether two seeds lead to the same optimum.
    fn are_same(&self, a: &Seed, b: &Seed) -> bool {
        (0..self.count).all(|j| (a.q[j] - b.q[j]).abs() < SAME)
    }
}

/// Inserts an optimum in order; the worst is lost where there is no room.
fn insert_least(optima: &mut Optima, new: (f64, ScanSample)) {
    let place = optima.partition_point(|(_, other)| other.value <= new.1.value);
    if place < SEEDS {
        optima.truncate(SEEDS - 1);
        optima.insert(place, new);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_form::axis_chain::JointAxis;
    use crate::closed_form::configurations::Drives;
    use crate::closed_form::position::ThreeAxes;
    use crate::closed_form::structure::Pair;
    use crate::math::vector3::across;
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
        let basis = across(&all[joints.len() - 1].axis);
        let plane = PlaneJoints::new(&all, joints.len(), size);
        let count = joints.len();
        PositionArm { joints: all, count, tip, three, drives, size, basis, at_limits: vec![], plane }
    }

    /// Axes and points on them, in a plane but for the last.
    const FIVE: [([f64; 3], [f64; 3]); 5] = [
        ([0.0, 0.0, 1.0], [0.0; 3]),
        ([0.0, 1.0, 0.0], [0.03, 0.0, 0.1]),
        ([0.0, 1.0, 0.0], [0.06, 0.0, 0.22]),
        ([0.0, -1.0, 0.0], [0.19, 0.0, 0.22]),
        ([1.0, 0.0, 0.0], [0.25, 0.0, 0.22]),
    ];
    const TIP: [f64; 3] = [0.35, 0.0, 0.22];

    #[test]
    fn optima_of_parallel_axes_are_no_worse_than_a_scan() {
        let mut rng = rng::stream(4, 0);
        for count in [4, 5] {
            let arm = arm(&FIVE[..count], TIP);
            let scanned = PositionArm { plane: None, ..arm.clone() };
            let limits = [[-1.2; 5], [1.6; 5]];
            let mut seeds = SmallVec::new();
            for _ in 0..300 {
                let q: [f64; 5] = std::array::from_fn(|_| rng.uniform_in(-1.2, 1.6));
                let motion =
                    (0..count).fold(Frame::IDENTITY, |at, j| at.then::<Baseline>(&arm.joints[j].displacement(q[j])));
                let (axis, turn) = (arm.basis[count % 3], Angle::by(rng.uniform_in(-0.8, 0.8)));
                let tip = motion.then::<Baseline>(&arm.tip);
                let target = Frame { axes: tip.axes.map(|vector| turn.about(&axis, &vector)), ..tip };
                let mut least = |arm: &PositionArm| {
                    arm.seeds(&target, &Frame::IDENTITY, [&limits[0][..count], &limits[1][..count]], &mut seeds);
                    seeds.first().map_or(f64::INFINITY, |seed| seed.value)
                };
                let [optimum, scan] = [least(&arm), least(&scanned)];
                assert!(optimum <= scan + 1e-5, "{count} joints at {q:?}: {optimum} {scan}");
            }
        }
    }

    #[test]
    fn seeds_are_at_the_place_and_near_the_turn_of_a_pose_of_the_arm() {
        let mut rng = rng::stream(3, 0);
        for count in 3..=5 {
            let arm = arm(&FIVE[..count], TIP);
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
