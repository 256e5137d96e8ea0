//! Certificate that constraints hold at every instant of a motion, and its largest errors.
//!
//! Errors at both ends of an interval and the bend of the motion between them bound them inside. Where a bound is too large, the
//! interval is halved: it then falls to a quarter. A spline stays between its control points, those just outside of the interval included.

use super::gauge::Seen;
use super::keep::Keep;
use super::tip_bend::TipBend;
use crate::kinematics::link_tree::FrameBuffer;
use crate::math::Frame;
use crate::objective::Point;
use crate::obstacle::JointMotion;
use crate::robot::Robot;

/// Intervals examined before a motion counts as one that breaks a constraint.
const MOST_INTERVALS: usize = 150_000;

/// Fraction of a tolerance by which the largest error found may exceed the true one.
const SLACK: f64 = 0.01;

/// Largest tolerance (m, rad) in the slack; wider ones count as this.
const WIDE: f64 = 0.1;

/// An error beyond its tolerance on a motion, or one that cannot be certified to be within it.
#[derive(Debug, Clone, PartialEq)]
pub struct Broken {
    /// The motion's parameter.
    pub at: f64,
    /// Index of the constraint.
    pub keep: usize,
    /// The error in words, for example "tilt 0.12 rad of at most 0.1".
    pub what: String,
}

/// Checks motions for constraints; owns its scratch.
#[derive(Debug)]
pub struct KeepSweep<'a> {
    robot: &'a Robot,
    keeps: &'a [Keep],
    scratch: KeepScratch,
    intervals: usize,
    most: usize,
}

/// Scratch of a sweep, for those that do not own the robot.
#[derive(Debug, Default)]
pub(crate) struct KeepScratch {
    /// Samples by depth; both ends of the motion first.
    samples: Vec<Sample>,
    /// Control points of a spline just outside of an interval.
    outside: Vec<Sample>,
    change: Point,
    off_line: Point,
}

#[derive(Debug, Clone)]
struct Sample {
    q: Point,
    frames: FrameBuffer,
    /// Origin of each subject (m), in the base, and what its target sees.
    seen: Vec<([f64; 3], Seen)>,
}

/// Stopping rule: bounds up to these values need no closer look, one per gauge of each constraint.
trait Thresholds {
    /// Takes the values at a sample; false ends the walk.
    fn sampled(&mut self, keep: usize, values: &mut dyn Iterator<Item = f64>) -> bool;
    /// Whether a bound of a gauge is small enough.
    fn takes(&mut self, keep: usize, gauge: usize, bound: f64) -> bool;
}

impl<'a> KeepSweep<'a> {
    /// A checker for any number of motions of `robot`.
    pub fn new(robot: &'a Robot, keeps: &'a [Keep]) -> Self {
        Self::with_scratch(robot, keeps, KeepScratch::default())
    }

    /// A checker with the scratch of an earlier one of the same robot and constraints.
    pub(crate) fn with_scratch(robot: &'a Robot, keeps: &'a [Keep], mut scratch: KeepScratch) -> Self {
        [&mut scratch.change, &mut scratch.off_line].into_iter().for_each(|joints| joints.resize(robot.dof(), 0.0));
        Self { robot, keeps, scratch, intervals: 0, most: 0 }
    }

    /// The scratch, for the next one.
    pub(crate) fn into_scratch(self) -> KeepScratch {
        self.scratch
    }

    /// Number of intervals examined so far.
    pub fn intervals(&self) -> usize {
        self.intervals
    }

    /// Certifies that all constraints hold on the motion over \[`from`, `to`\].
    ///
    /// # Errors
    /// [`Broken`]: a place at which one does not, or is too near to its tolerance to tell.
    pub fn check(&mut self, motion: &impl JointMotion, ends: [f64; 2]) -> Result<(), Broken> {
        self.walk(motion, ends, MOST_INTERVALS, &mut Tolerances(self.keeps)).map_err(|(at, keep)| {
            let mut q = Point::from_elem(0.0, self.robot.dof());
            motion.write(at, &mut q);
            let broken = self.keeps[keep].broken_at(self.robot, &q);
            Broken { at, keep, what: broken.unwrap_or_else(|| "an error too near to its tolerance to tell".into()) }
        })
    }

    /// Whether all constraints are certified to hold on the motion over \[`from`, `to`\], in at most `most` intervals.
    pub(crate) fn holds_within(&mut self, motion: &impl JointMotion, ends: [f64; 2], most: usize) -> bool {
        self.walk(motion, ends, most, &mut Tolerances(self.keeps)).is_ok()
    }

    /// Bounds of the largest error of each entry of each constraint on the motion over \[`from`, `to`\], at most a hundredth of the tolerance
    /// too large; infinite for a motion that is too long for that.
    pub(crate) fn largest(&mut self, motion: &impl JointMotion, ends: [f64; 2]) -> Vec<Vec<f64>> {
        let none = |keep: &Keep| vec![f64::NEG_INFINITY; keep.gauges.len()];
        let mut largest = Largest { keeps: self.keeps, seen: self.keeps.iter().map(none).collect(), proven: vec![] };
        largest.proven = largest.seen.clone();
        if self.walk(motion, ends, MOST_INTERVALS, &mut largest).is_err() {
            // The motion after the end of the walk was not examined for any of them.
            largest.proven.iter_mut().for_each(|proven| proven.fill(f64::INFINITY));
        }
        let Largest { seen, proven, .. } = largest;
        let of_keep = |((keep, seen), proven): ((&Keep, Vec<f64>), Vec<f64>)| {
            keep.by_entry(seen.iter().zip(proven).map(|(seen, proven)| seen.max(proven)))
        };
        self.keeps.iter().zip(seen).zip(proven).map(of_keep).collect()
    }

    /// Walks over a motion until all bounds are taken; the place and the constraint where one is not.
    fn walk(
        &mut self,
        motion: &impl JointMotion,
        [from, to]: [f64; 2],
        most: usize,
        thresholds: &mut impl Thresholds,
    ) -> Result<(), (f64, usize)> {
        self.most = self.intervals + most;
        self.sample(0, motion, from, thresholds)?;
        self.sample(1, motion, to, thresholds)?;
        self.halve(motion, [from, to], [0, 1], 2, thresholds)
    }

    fn halve(
        &mut self,
        motion: &impl JointMotion,
        [from, to]: [f64; 2],
        [first, last]: [usize; 2],
        slot: usize,
        thresholds: &mut impl Thresholds,
    ) -> Result<(), (f64, usize)> {
        self.intervals += 1;
        let Some(open) = self.first_open(motion, [from, to], [first, last], thresholds) else { return Ok(()) };
        let middle = motion.middle(from, to).filter(|_| self.intervals < self.most);
        let Some(middle) = middle else { return Err((0.5 * (from + to), open)) };
        self.sample(slot, motion, middle, thresholds)?;
        self.halve(motion, [from, middle], [first, slot], slot + 1, thresholds)?;
        self.halve(motion, [middle, to], [slot, last], slot + 1, thresholds)
    }

    /// Number of the first constraint whose bounds on an interval are not taken.
    fn first_open(
        &mut self,
        motion: &impl JointMotion,
        [from, to]: [f64; 2],
        ends: [usize; 2],
        thresholds: &mut impl Thresholds,
    ) -> Option<usize> {
        let Self { robot, keeps, scratch: KeepScratch { samples, outside, change, off_line }, .. } = self;
        let [first, last] = ends.map(|end| &samples[end]);
        change.iter_mut().zip(first.q.iter().zip(&last.q)).for_each(|(change, (a, b))| *change = (b - a).abs());
        off_line.fill(0.0);
        motion.write_off_line(from, to, off_line);
        let mut beside = &outside[..0];
        if motion.is_spline() {
            write_sample(outside, 0, (robot, keeps), (motion, from - 1.0));
            write_sample(outside, 1, (robot, keeps), (motion, to + 1.0));
            for (control_point, end) in outside.iter().zip([first, last]) {
                let joints = change.iter_mut().zip(control_point.q.iter().zip(&end.q));
                joints.for_each(|(change, (a, b))| *change += (b - a).abs());
            }
            beside = outside;
        }
        let is_open = |(number, keep): &(usize, &Keep)| {
            let (origin, frames) = (&first.seen[*number].0, &first.frames);
            let bend = TipBend::of(robot, keep.subject(), (origin, frames), [change, off_line]);
            // Coinciding places count once: where an arm begins to move from rest, a repeated one would hide that it leaves it.
            let another = (last.q != first.q).then_some(last);
            let beside = beside.iter().filter(|sample| sample.q != first.q && sample.q != last.q);
            let points = std::iter::once(first).chain(another).chain(beside).map(|sample| &sample.seen[*number].1);
            let bounds = keep.gauges.iter().map(|gauge| gauge.bound(points.clone(), &bend));
            !bounds.enumerate().all(|(gauge, bound)| thresholds.takes(*number, gauge, bound))
        };
        keeps.iter().enumerate().find(is_open).map(|(number, _)| number)
    }

    /// Samples the motion into a slot.
    fn sample(
        &mut self,
        slot: usize,
        motion: &impl JointMotion,
        at: f64,
        thresholds: &mut impl Thresholds,
    ) -> Result<(), (f64, usize)> {
        let Self { robot, keeps, scratch, .. } = self;
        write_sample(&mut scratch.samples, slot, (robot, keeps), (motion, at));
        for (number, (keep, seen)) in keeps.iter().zip(&scratch.samples[slot].seen).enumerate() {
            let mut values = keep.gauges.iter().map(|gauge| gauge.value(&seen.1));
            if !thresholds.sampled(number, &mut values) {
                return Err((at, number));
            }
        }
        Ok(())
    }
}

/// Writes a sample of the motion, with all subjects as the constraints see them, into a slot.
fn write_sample(
    samples: &mut Vec<Sample>,
    slot: usize,
    (robot, keeps): (&Robot, &[Keep]),
    (motion, at): (&impl JointMotion, f64),
) {
    if samples.len() == slot {
        let nowhere = keeps.iter().map(|keep| ([0.0; 3], keep.seen(&Frame::IDENTITY))).collect();
        let q = Point::from_elem(0.0, robot.dof());
        samples.push(Sample { q, frames: robot.frame_buffer(), seen: nowhere });
    }
    let Sample { q, frames, seen } = &mut samples[slot];
    motion.write(at, q);
    robot.write_frames(q, frames);
    for (keep, seen) in keeps.iter().zip(seen) {
        let (frame, origin) = keep.place(robot, frames);
        *seen = (origin, keep.seen(&frame));
    }
}

/// The tolerances of all constraints.
struct Tolerances<'a>(&'a [Keep]);

impl Thresholds for Tolerances<'_> {
    fn sampled(&mut self, keep: usize, values: &mut dyn Iterator<Item = f64>) -> bool {
        self.0[keep].gauges.iter().zip(values).all(|(gauge, value)| value <= gauge.most())
    }

    fn takes(&mut self, keep: usize, gauge: usize, bound: f64) -> bool {
        bound <= self.0[keep].gauges[gauge].most()
    }
}

/// The largest values so far, and the largest bounds that were taken.
struct Largest<'a> {
    keeps: &'a [Keep],
    seen: Vec<Vec<f64>>,
    proven: Vec<Vec<f64>>,
}

impl Thresholds for Largest<'_> {
    fn sampled(&mut self, keep: usize, values: &mut dyn Iterator<Item = f64>) -> bool {
        self.seen[keep].iter_mut().zip(values).for_each(|(seen, value)| *seen = seen.max(value));
        true
    }

    fn takes(&mut self, keep: usize, gauge: usize, bound: f64) -> bool {
        let (seen, proven) = (self.seen[keep][gauge], &mut self.proven[keep][gauge]);
        let gauge = &self.keeps[keep].gauges[gauge];
        let is_small = !gauge.is_of_task() || bound <= seen + SLACK * gauge.tolerance.min(WIDE);
        if is_small {
            *proven = proven.max(bound);
        }
        is_small
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::UrdfOptions;
    use crate::math::arithmetic::NoFma;
    use crate::math::pose;
    use crate::math::vector::point_between;
    use crate::obstacle::Edge;
    use crate::rng::{self, LazyRng};
    use crate::task::{NamedTask, Region, Subject, Target, Task, TaskKind, Tolerance};

    /// A robot with a joint in its chest and two arms of three joints, one of them prismatic.
    fn two_arms() -> Robot {
        let mut urdf = String::from(r#"<robot name="pair"><link name="floor"/><link name="chest"/>"#);
        let mut joint = |name: &str, [parent, child]: [&str; 2], [xyz, axis]: [&str; 2], kind: &str| {
            urdf += &format!(
                r#"<link name="{child}"/><joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>
                <origin xyz="{xyz}" rpy="0.1 0.2 0.3"/><axis xyz="{axis}"/><limit lower="-3" upper="3" velocity="1"/></joint>"#
            );
        };
        joint("yaw", ["floor", "torso"], ["0 0 1", "0 0 1"], "revolute");
        for side in ["a", "b"] {
            let link = |i: usize| format!("{side}{i}");
            joint(
                &link(1),
                ["torso", &link(1)],
                [if side == "a" { "0 0.3 0" } else { "0 -0.3 0.1" }, "1 0 0"],
                "revolute",
            );
            joint(&link(2), [&link(1), &link(2)], ["0.3 0 0.1", "0 1 0"], "prismatic");
            joint(&link(3), [&link(2), &link(3)], ["0.2 0.1 0", "0.6 0 0.8"], "revolute");
        }
        let urdf = urdf.replace(r#"<link name="chest"/>"#, "") + "</robot>";
        let tips = vec!["a3".into(), "b3".into()];
        Robot::from_urdf_with(&urdf, &UrdfOptions { tips, ..UrdfOptions::default() }).unwrap()
    }

    fn keep(subject: Subject, task: Option<Task>, tolerance: Tolerance, target: &Target) -> Keep {
        Keep::new(&NamedTask { subject, task, tolerance }, target).unwrap()
    }

    /// One constraint of each kind, about a configuration.
    fn all_kinds(robot: &Robot, subject: Subject, q: &[f64], tolerance: f64, rng: &mut LazyRng) -> Vec<Keep> {
        let mut draw = |most: f64| std::array::from_fn(|_| rng.uniform_in(-most, most));
        let whole = keep(subject, None, Tolerance::default(), &Target::Position([0.0; 3]));
        let here = whole.frame(robot, q);
        let beside = Frame::from(&pose::from_rpy(draw(0.4), draw(0.02)));
        let target = Target::Pose(here.then::<NoFma>(&beside));
        let both = Tolerance { position: tolerance, rotation: tolerance };
        let region = Region::new(here.origin.map(|p| p - tolerance), here.origin.map(|p| p + tolerance)).unwrap();
        let upright = TaskKind::Pointing { axis: [0.0, 0.6, 0.8] };
        let components = |kind, entries: &[f64]| Task::new(kind, None, Some(entries), None).unwrap();
        let (wide, t) = (f64::INFINITY, tolerance);
        let tasks = [
            None,
            Some(components(TaskKind::Pose, &[wide, t, wide, t, wide, wide])),
            Some(components(TaskKind::Pose, &[t, wide, 3.0 * t, wide, t, 3.0])),
            Some(components(TaskKind::Orientation, &[t, t, 3.1])),
            Some(components(TaskKind::Position, &[t, t, wide])),
            Some(components(upright, &[wide, wide, wide, t])),
            Some(TaskKind::Orientation.into()),
            Some(Task::from(TaskKind::Position).within(region).unwrap()),
        ];
        tasks.into_iter().map(|task| keep(subject, task, both, &target)).collect()
    }

    /// What is certified holds at samples; what is refused is broken or nearly so.
    #[test]
    fn certified_lines_keep_everything_between_samples() {
        let mut rng = rng::stream(5, 0);
        let panda = Robot::named("panda").unwrap();
        let arms = two_arms();
        let [alone, one, pair] = [Subject::Tip(0), Subject::Tip(1), Subject::Pair { from: 0, of: 1 }];
        let (mut certified, mut refused) = (0, 0);
        for round in 0..120 {
            for (robot, subject) in
                [(&panda, alone), (&arms, one), (&arms, pair), (&arms, Subject::Pair { from: 1, of: 0 })]
            {
                let q = robot.random_configurations(1, &mut rng).unwrap();
                let size = if round % 3 == 0 { 0.05 } else { 0.4 };
                let [from, to]: [Vec<f64>; 2] =
                    [(); 2].map(|()| q.iter().map(|q| q + rng.uniform_in(-size, size)).collect());
                let tolerance = [0.05, 0.3][round % 2];
                for keep in all_kinds(robot, subject, &q, tolerance, &mut rng) {
                    let keeps = [keep];
                    let found = KeepSweep::new(robot, &keeps).check(&Edge { from: &from, to: &to }, [0.0, 1.0]);
                    let worst = (0..=400).map(|i| {
                        let q: Vec<f64> = point_between(&from, &to, f64::from(i) / 400.0).collect();
                        let seen = keeps[0].seen(&keeps[0].frame(robot, &q));
                        let excess = |gauge: &super::super::gauge::Gauge| gauge.value(&seen) - gauge.most();
                        keeps[0].gauges.iter().map(excess).fold(f64::NEG_INFINITY, f64::max)
                    });
                    let worst = worst.fold(f64::NEG_INFINITY, f64::max);
                    match found {
                        Ok(()) => assert!(worst <= 0.0, "{worst} beyond, {keeps:?}"),
                        Err(broken) => assert!(worst > -1e-3, "{broken:?}, but {worst} within"),
                    }
                    *(if found_ok(worst) { &mut certified } else { &mut refused }) += 1;
                    let largest = KeepSweep::new(robot, &keeps).largest(&Edge { from: &from, to: &to }, [0.0, 1.0]);
                    for i in 0..=50 {
                        let q: Vec<f64> = point_between(&from, &to, f64::from(i) / 50.0).collect();
                        for (error, most) in keeps[0].errors(robot, &q).iter().zip(&largest[0]) {
                            assert!(
                                error.is_nan() == most.is_nan() && !(*error > most + 1e-12),
                                "{error} of at most {most}"
                            );
                        }
                    }
                }
            }
        }
        assert!(certified > 300 && refused > 300, "{certified} {refused}");
    }

    fn found_ok(worst: f64) -> bool {
        worst <= 0.0
    }

    /// A rotation vector jumps at half a turn; the size of its entries does not.
    #[test]
    fn a_free_rotation_passes_half_a_turn() {
        let robot = Robot::named("panda").unwrap();
        let q = [0.0, -0.5, 0.0, -2.0, 0.0, 1.5, 0.0];
        let target = Target::Pose(robot.tip(&q));
        let task = Task::new(TaskKind::Orientation, None, Some(&[0.01, 0.01, 7.0]), None).unwrap();
        let keeps = [keep(Subject::Tip(0), Some(task), Tolerance::default(), &target)];
        let [mut from, mut to] = [q; 2];
        (from[6], to[6]) = (-2.8, 2.8);
        let turned = |from: &[f64], to: &[f64]| KeepSweep::new(&robot, &keeps).check(&Edge { from, to }, [0.0, 1.0]);
        assert_eq!(turned(&from, &to), Ok(()));
        to[6] = 4.0;
        assert_eq!(turned(&q, &to), Ok(()));
        to[4] += 0.05;
        assert!(turned(&q, &to).is_err());
    }
}
