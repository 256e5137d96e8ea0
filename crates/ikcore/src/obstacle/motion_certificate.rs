//! Certificate that a motion keeps its distances at every instant.
//!
//! Distances are computed at both ends of an interval of the motion. A pair is clear in between if neither end lets it come near
//! enough on the way, or if a plane parts both bodies at either end by more than they leave the straight lines between both ends.
//! Such a plane costs almost no clearance, even along a wall. What is not clear so is examined again in both halves.

use super::joint_motion::JointMotion;
use super::link_displacement::{displacement, sagitta};
use super::near_rows::MOST_RESERVED;
use super::required_distance::RequiredDistance;
use super::scene::Scene;
use crate::bodies::BodyPair;
use crate::kinematics::link_tree::FrameBuffer;
use crate::math::Frame;
use crate::objective::Point;
use crate::shape::PosedBody;

/// Intervals examined before a motion counts as not clear.
const MOST_INTERVALS: usize = 120;

/// Largest weight of a control point outside of an interval in a uniform cubic B-spline.
const OUTSIDE: f64 = 1.0 / 6.0;

/// Samples for which room is reserved; a deeper bisection takes more.
const MOST_DEPTHS: usize = 32;

/// Checks motions; owns its scratch.
#[derive(Debug)]
pub(crate) struct MotionCertificate {
    /// Configurations by depth of the bisection; both ends of the motion first.
    samples: Vec<Sample>,
    /// Control points of a spline just outside of an interval.
    outside: Vec<Sample>,
    pending: Vec<BodyPair>,
    /// Intervals examined so far, and from how many on this motion is divided no further.
    intervals: usize,
    most: usize,
    /// Change of the joints between the control points of an interval, and their deviation from the straight lines between them.
    change: Point,
    off_line: Point,
    /// Deviation of each joint from the straight line between the ends, and its distance from the nearer end.
    aside: Point,
    halfway: Point,
}

#[derive(Debug)]
struct Sample {
    q: Point,
    frames: FrameBuffer,
}

/// An interval of the motion, and the samples at its ends.
#[derive(Debug, Clone, Copy)]
struct Interval {
    from: f64,
    to: f64,
    ends: [usize; 2],
    depth: usize,
}

/// A pair that is too near, or cannot be told to be clear, and when.
#[derive(Debug, Clone, Copy)]
pub(super) struct Blocker {
    pub at: f64,
    pub pair: BodyPair,
}

/// Outcome for a pair in an interval.
enum Verdict {
    Clear,
    Open,
    /// When.
    TooNear(f64),
}

impl MotionCertificate {
    /// Scratch for motions in `scene`.
    pub fn new(scene: &Scene<'_>) -> Self {
        let pending = Vec::with_capacity(scene.pairs().take(MOST_RESERVED).count());
        let [change, off_line, aside, halfway] = [(); 4].map(|()| Point::new());
        let (samples, outside) = (Vec::with_capacity(MOST_DEPTHS), Vec::with_capacity(2));
        Self { samples, outside, pending, intervals: 0, most: 0, change, off_line, aside, halfway }
    }

    /// Number of intervals examined so far.
    pub fn intervals(&self) -> usize {
        self.intervals
    }

    /// Whether `motion` from 0 to `end` keeps these distances for certain, between ticks too. Bodies that no joint moves are left out.
    pub fn is_clear(
        &mut self,
        scene: &Scene<'_>,
        motion: &impl JointMotion,
        end: f64,
        kept: &RequiredDistance<'_>,
    ) -> bool {
        let whole = self.begin(scene, motion, [0.0, end]);
        self.collect_pending(scene, &whole, kept);
        let count = self.pending.len();
        self.clear_in(scene, motion, kept, whole, count).is_ok()
    }

    /// Certifies that these pairs keep their distances while `motion` goes from `from` to `to`.
    pub(super) fn check(
        &mut self,
        scene: &Scene<'_>,
        motion: &impl JointMotion,
        [from, to]: [f64; 2],
        pairs: impl Iterator<Item = BodyPair>,
        kept: &RequiredDistance<'_>,
    ) -> Result<(), Blocker> {
        let whole = self.begin(scene, motion, [from, to]);
        self.pending.clear();
        self.pending.extend(pairs);
        let count = self.pending.len();
        self.clear_in(scene, motion, kept, whole, count)
    }

    /// Samples the arm at both ends of a motion.
    fn begin(&mut self, scene: &Scene<'_>, motion: &impl JointMotion, [from, to]: [f64; 2]) -> Interval {
        self.most = self.intervals + MOST_INTERVALS;
        self.outside.clear();
        sample(&mut self.samples, 0, scene, (motion, from));
        sample(&mut self.samples, 1, scene, (motion, to));
        let whole = Interval { from, to, ends: [0, 1], depth: 0 };
        self.measure(motion, &whole);
        whole
    }

    /// Finds how far the joints move in an interval.
    fn measure(&mut self, motion: &impl JointMotion, interval: &Interval) {
        let Self { samples, change, off_line, aside, halfway, .. } = self;
        let [from, to] = interval.ends.map(|end| &samples[end].q);
        change.clear();
        change.extend(from.iter().zip(to).map(|(from, to)| (to - from).abs()));
        off_line.clear();
        off_line.resize(from.len(), 0.0);
        motion.write_off_line(interval.from, interval.to, off_line);
        aside.clone_from(off_line);
        halfway.clone_from(change);
        if motion.is_spline() {
            let mut q = from.clone();
            for (tick, end) in [(interval.from - 1.0, from), (interval.to + 1.0, to)] {
                motion.write(tick, &mut q);
                for (j, (q, end)) in q.iter().zip(end).enumerate() {
                    let outside = (q - end).abs();
                    change[j] += outside;
                    aside[j] += OUTSIDE * outside;
                }
            }
        }
        halfway.iter_mut().zip(&*aside).for_each(|(halfway, aside)| *halfway = 0.5 * *halfway + aside);
    }

    /// Lists the pairs that may come too near in the whole motion, by balls around groups of bodies.
    fn collect_pending(&mut self, scene: &Scene<'_>, whole: &Interval, kept: &RequiredDistance<'_>) {
        let Self { samples, pending, change, aside, halfway, .. } = self;
        pending.clear();
        let (groups, robot) = (&scene.bodies.groups, scene.robot());
        let [first, last] = whole.ends.map(|end| &samples[end].frames);
        let most = kept.most_wanted(whole.to);
        for group in (0..groups.count()).filter(|group| groups.is_moving(*group)) {
            let [(from, radius), (to, _)] = [first, last].map(|frames| groups.ball(group, frames));
            let ball = PosedBody { axis: &[from; 2], radius, solid: None };
            let beside = sagitta(robot, first, &ball, groups.frame_of(group), [change, aside]);
            let reach = radius + beside;
            let bodies = groups.bodies_of(group);
            let (middle, half) = (0.5 * (from + to), 0.5 * (to - from).norm());
            scene.others.obstacles.each_near(&middle, half + reach + most, |obstacle| {
                let needed = kept.wanted(Some(obstacle), whole.to);
                // What is not a number is near.
                if !(scene.others.obstacles[obstacle].shape.distance_to_segment(&[from, to], needed + reach)
                    >= needed + reach)
                {
                    let tested = bodies.iter().filter(|body| !scene.others.allowed.allow(**body, obstacle));
                    pending.extend(tested.map(|body| BodyPair::Obstacle { body: *body, obstacle }));
                }
            });
        }
        if !scene.others.itself {
            return;
        }
        for (i, of) in scene.bodies.pairs_of_groups().enumerate() {
            let frames_of = of.map(|group| groups.frame_of(group));
            let below = robot.meeting_frame(frames_of[0], frames_of[1]);
            let needed = kept.wanted(None, whole.to);
            let apart = |frames: &[Frame]| {
                let [(one, radius), (other, other_radius)] = of.map(|group| groups.ball(group, frames));
                let gap = (one - other).norm() - radius - other_radius - needed;
                let moved = |center, frame: usize| {
                    let ball = PosedBody { axis: &[center; 2], radius: 0.0, solid: None };
                    displacement(robot, frames, &ball, [below, frame], halfway)
                };
                gap > 0.0 && gap >= moved(one, frames_of[0]) + moved(other, frames_of[1])
            };
            if !(apart(first) && apart(last)) {
                pending.extend_from_slice(scene.bodies.pairs_between(i));
            }
        }
    }

    /// Certifies the first `count` pending pairs in an interval whose joint motion has been measured.
    fn clear_in(
        &mut self,
        scene: &Scene<'_>,
        motion: &impl JointMotion,
        kept: &RequiredDistance<'_>,
        interval: Interval,
        count: usize,
    ) -> Result<(), Blocker> {
        self.intervals += 1;
        if motion.is_spline() && count > 0 {
            sample(&mut self.outside, 0, scene, (motion, interval.from - 1.0));
            sample(&mut self.outside, 1, scene, (motion, interval.to + 1.0));
        }
        let mut open = 0;
        for i in 0..count {
            let pair = self.pending[i];
            match self.verdict(scene, pair, &interval, kept) {
                Verdict::Clear => {}
                Verdict::TooNear(at) => return Err(Blocker { at, pair }),
                Verdict::Open => {
                    self.pending.swap(i, open);
                    open += 1;
                }
            }
        }
        if open == 0 {
            return Ok(());
        }
        let Interval { from, to, ends: [first, last], depth } = interval;
        let middle = motion.middle(from, to).filter(|_| self.intervals <= self.most);
        let Some(middle) = middle else { return Err(Blocker { at: 0.5 * (from + to), pair: self.pending[0] }) };
        let slot = depth + 2;
        sample(&mut self.samples, slot, scene, (motion, middle));
        [(from, middle, [first, slot]), (middle, to, [slot, last])].into_iter().try_for_each(|(from, to, ends)| {
            let half = Interval { from, to, ends, depth: depth + 1 };
            self.measure(motion, &half);
            self.clear_in(scene, motion, kept, half, open)
        })
    }

    fn verdict(&self, scene: &Scene<'_>, pair: BodyPair, interval: &Interval, kept: &RequiredDistance<'_>) -> Verdict {
        let [first, last] = interval.ends.map(|end| &self.samples[end].frames);
        let [needed_first, needed] = [interval.from, interval.to].map(|tick| kept.needed(pair, tick));
        let (change_first, change_last) =
            (scene.change_at(pair, first, &self.halfway), scene.change_at(pair, last, &self.halfway));
        let at_first = scene.distance_at(pair, first, needed + change_first);
        let at_last = scene.distance_at(pair, last, needed + change_last);
        if kept.only_parts && needed < 0.0 {
            return if at_last < needed { Verdict::TooNear(interval.to) } else { Verdict::Clear };
        }
        if at_first < needed_first {
            return Verdict::TooNear(interval.from);
        }
        if at_last < needed {
            return Verdict::TooNear(interval.to);
        }
        if at_first >= needed + change_first && at_last >= needed + change_last {
            return Verdict::Clear;
        }
        let nearer = if at_first < at_last { first } else { last };
        match self.parted(scene, pair, nearer, [first, last]) {
            Some(gap) if gap >= needed => Verdict::Clear,
            _ => Verdict::Open,
        }
    }

    /// Gap (m) between a body and an obstacle on both sides of one plane in the whole interval; `None` for links, and without such a
    /// plane.
    fn parted(
        &self,
        scene: &Scene<'_>,
        pair: BodyPair,
        nearer: &FrameBuffer,
        [first, last]: [&FrameBuffer; 2],
    ) -> Option<f64> {
        let BodyPair::Obstacle { body, obstacle } = pair else { return None };
        let (shape, carried, frames) = (&scene.others.obstacles[obstacle].shape, &scene.bodies.carried[body], first);
        let at = |frames: &FrameBuffer| frames[carried.stages];
        let (_, slope) = shape.nearest_to_body(&carried.posed(&carried.axis_at(&at(nearer)), &at(nearer)));
        let normal = slope.normalize();
        let end = shape.farthest_along(&normal)?;
        let least = |frames: &FrameBuffer| {
            let frame = at(frames);
            carried.posed(&carried.axis_at(&frame), &frame).least_along(&normal)
        };
        let (axis, frame) = (carried.axis_at(&at(first)), at(first));
        let body = carried.posed(&axis, &frame);
        let beside = sagitta(scene.robot(), frames, &body, carried.stages, [&self.change, &self.off_line]);
        let ends = [least(first), least(last)];
        if self.outside.is_empty() {
            return Some(least_between(ends, beside) - end);
        }
        let control_points = self.outside.iter().map(|sample| least(&sample.frames));
        Some(control_points.fold(ends[0].min(ends[1]), f64::min) - beside - end)
    }
}

/// The least value between two ends of something that is off the straight line between them, at fraction s by at most
/// 4 s (1 - s) `beside`.
fn least_between([first, last]: [f64; 2], beside: f64) -> f64 {
    let rise = (last - first).abs();
    if rise >= 4.0 * beside {
        return first.min(last);
    }
    first.min(last) - (4.0 * beside - rise).powi(2) / (16.0 * beside)
}

/// Computes the arm at a tick of the motion.
fn sample(samples: &mut Vec<Sample>, slot: usize, scene: &Scene<'_>, (motion, tick): (&impl JointMotion, f64)) {
    let robot = scene.robot();
    if samples.len() <= slot {
        let q = Point::from_elem(0.0, robot.dof());
        samples.resize_with(slot + 1, || Sample { q: q.clone(), frames: robot.frame_buffer() });
    }
    let Sample { q, frames } = &mut samples[slot];
    motion.write(tick, q);
    robot.write_frames(q, frames);
}
