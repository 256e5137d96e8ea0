//! Certificate that a motion keeps its distances at every instant.
//!
//! Distances are computed at both ends of an interval of the motion. A pair is clear in between if neither end lets it come near
//! enough on the way, or if a plane parts both bodies at either end by more than they leave the straight lines between both ends.
//! Such a plane costs almost no clearance, even along a wall. Pairs that are not clear by this are examined again in both halves.
//!
//! The command of a tick is a control point of the spline from tick -1 on, where it draws the curve aside by up to a sixth of what it
//! changes: around the edge of a box, or past a thin rod, that can be into it although every later instant is clear. So the tick before the
//! command is certified again. Its other control points have been passed, nearer to a body perhaps than they should be, since obstacles
//! come and move; of such a body the command need only come no nearer than these.

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

/// A pair that is too near, or cannot be certified as clear, and when.
#[derive(Debug, Clone, Copy)]
pub(super) struct Blocker {
    pub at: f64,
    pub pair: BodyPair,
}

/// Gap between a body and an obstacle on both sides of one plane (m): of all control points but the last, and of the last.
#[derive(Debug, Clone, Copy)]
struct Gap {
    before: f64,
    after: f64,
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

    /// Whether `motion` keeps these distances for certain until `end`, between ticks too: from 0 on, a spline from the tick before.
    /// Bodies that no joint moves are left out.
    pub fn is_clear(
        &mut self,
        scene: &Scene<'_>,
        motion: &impl JointMotion,
        end: f64,
        kept: &RequiredDistance<'_>,
    ) -> bool {
        let first = if motion.is_spline() { -1.0 } else { 0.0 };
        let whole = self.begin(scene, motion, [first, end]);
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

    /// Computes the change of the joints in an interval, and their deviation from its straight line.
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
                // A distance that is not a number counts as near.
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
        let [needed_first, needed_last] = [interval.from, interval.to].map(|tick| kept.needed(pair, tick));
        // Control point before the interval, if the arm has passed all of the interval's but that of the command.
        let passed = self.outside.first().filter(|_| interval.from < 0.0 && interval.to <= 0.0);
        let needed = if passed.is_some() { needed_last.max(needed_first) } else { needed_last };
        let (change_first, change_last) =
            (scene.change_at(pair, first, &self.halfway), scene.change_at(pair, last, &self.halfway));
        let at_first = scene.distance_at(pair, first, needed + change_first);
        let at_last = scene.distance_at(pair, last, needed + change_last);
        if kept.only_parts && needed < 0.0 {
            return if at_last < needed { Verdict::TooNear(interval.to) } else { Verdict::Clear };
        }
        if at_first < needed_first && interval.from >= 0.0 {
            return Verdict::TooNear(interval.from);
        }
        if at_last < needed_last {
            return Verdict::TooNear(interval.to);
        }
        if at_first >= needed + change_first && at_last >= needed + change_last {
            return Verdict::Clear;
        }
        let nearer = if at_first < at_last { first } else { last };
        let gap = self.parted(scene, pair, nearer, [first, last]);
        if gap.is_some_and(|gap| gap.before.min(gap.after) >= needed) {
            return Verdict::Clear;
        }
        let comes_no_nearer = gap.is_none_or(|gap| gap.after >= gap.before);
        match passed {
            Some(before) if comes_no_nearer => {
                let at_before = scene.distance_at(pair, &before.frames, needed);
                if at_first.min(at_last).min(at_before) < needed { Verdict::Clear } else { Verdict::Open }
            }
            _ => Verdict::Open,
        }
    }

    /// Gap between a body and an obstacle on both sides of one plane in the whole interval; `None` for links, and without such a plane.
    fn parted(
        &self,
        scene: &Scene<'_>,
        pair: BodyPair,
        nearer: &FrameBuffer,
        [first, last]: [&FrameBuffer; 2],
    ) -> Option<Gap> {
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
        let [before, after] = &self.outside[..] else {
            let gap = least_between(ends, beside) - end;
            return Some(Gap { before: gap, after: gap });
        };
        let before = least(&before.frames).min(ends[0]).min(ends[1]);
        Some(Gap { before: before - beside - end, after: least(&after.frames) - beside - end })
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vector::write_between;
    use crate::rng;
    use crate::robot::{LinkCapsule, Robot};
    use crate::shape::Shape;

    const GANTRY: &str = r#"<robot name="gantry"><link name="base"/><link name="bridge"/><link name="ball"/>
        <joint name="x" type="prismatic"><parent link="base"/><child link="bridge"/><axis xyz="1 0 0"/>
        <limit lower="-1" upper="1" velocity="1" effort="1"/></joint><joint name="y" type="prismatic">
        <parent link="bridge"/><child link="ball"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" velocity="1" effort="1"/>
        </joint></robot>"#;
    const RADIUS: f64 = 0.001;
    /// Where the ball almost touches a face through the origin.
    const BESIDE: f64 = RADIUS + 1e-6;

    /// Control points of a spline, from tick -2 on; the arm rests at the last.
    struct Spline<'a>(&'a [[f64; 2]]);

    impl JointMotion for Spline<'_> {
        fn write(&self, tick: f64, q: &mut [f64]) {
            let (before, last) = ((tick.floor() + 2.0) as usize, self.0.len() - 1);
            write_between(&self.0[before.min(last)], &self.0[(before + 1).min(last)], tick.fract().abs(), q);
        }

        fn write_off_line(&self, from: f64, to: f64, off_line: &mut [f64]) {
            if to - from > 1.0 {
                off_line.fill(10.0);
            }
        }

        fn middle(&self, from: f64, to: f64) -> Option<f64> {
            (to - from > 1.0).then_some(from + (0.5 * (to - from)).floor().max(1.0))
        }

        fn is_spline(&self) -> bool {
            true
        }
    }

    fn gantry() -> Robot {
        let ball = LinkCapsule { link: "ball".into(), a: [0.0; 3], b: [0.0; 3], radius: RADIUS };
        Robot::from_urdf(GANTRY, None, None).unwrap().with_capsules(vec![ball]).unwrap()
    }

    /// The smallest clearance of the curve from tick -1 to that of the last control point but one.
    fn least_clearance(scene: &Scene<'_>, points: &[[f64; 2]]) -> f64 {
        let mut least = f64::INFINITY;
        for [a, b, c, d] in points.windows(4).map(|four| <[[f64; 2]; 4]>::try_from(four).unwrap()) {
            for i in 0..=200 {
                let s = f64::from(i) / 200.0;
                let r = 1.0 - s;
                let weights = [r.powi(3), 3.0 * s * s * (s - 2.0) + 4.0, 3.0 * r * r * (r - 2.0) + 4.0, s.powi(3)];
                let at =
                    |j: usize| (weights[0] * a[j] + weights[1] * b[j] + weights[2] * c[j] + weights[3] * d[j]) / 6.0;
                least = least.min(scene.clearance(&[at(0), at(1)]).unwrap());
            }
        }
        least
    }

    /// Whether the motion from `past` to a rest at `command` is certified to keep `margin`.
    fn certifies(scene: &Scene<'_>, past: [[f64; 2]; 3], command: [f64; 2], margin: f64) -> bool {
        let points = [past[0], past[1], past[2], command, command, command];
        MotionCertificate::new(scene).is_clear(scene, &Spline(&points), 2.0, &RequiredDistance::constant(margin))
    }

    #[test]
    fn a_command_around_an_edge_is_certified_before_it_too() {
        let robot = gantry();
        let obstacles = [Shape::cuboid([-0.5, -0.5, 0.0], [1.0, 1.0, 0.2], None).unwrap()];
        let scene = Scene::new(&robot, &obstacles).unwrap();
        // The ball slides along one face to the edge, waits there for a tick, and would go on along the other face.
        let (corner, around) = ([BESIDE, BESIDE], [BESIDE, -0.4]);
        let past = [[-0.4, BESIDE], corner, corner];
        assert!(least_clearance(&scene, &[past[0], past[1], past[2], around]) < 0.0);
        // From the command on it is clear, and certified.
        let later = [past[0], past[1], past[2], around, around, around];
        let (mut check, kept) = (MotionCertificate::new(&scene), RequiredDistance::constant(0.0));
        assert!(check.check(&scene, &Spline(&later), [0.0, 2.0], scene.pairs(), &kept).is_ok());
        assert!(!certifies(&scene, past, around, 0.0));
        let along = [-0.3, -0.2, -0.1].map(|x| [x, BESIDE]);
        assert!(certifies(&scene, along, [0.0, BESIDE], 0.0));
    }

    #[test]
    fn a_start_that_was_too_near_may_be_left() {
        let robot = gantry();
        let obstacles = [Shape::cuboid([0.0, -0.1, 0.0], [1.0, 0.2, 0.2], None).unwrap()];
        let scene = Scene::new(&robot, &obstacles).unwrap();
        let past = [0.012, 0.0135, 0.0145].map(|y| [0.0, y]);
        let margin = 0.013 - RADIUS;
        assert!(certifies(&scene, past, [0.0, 0.015], margin));
        assert!(!certifies(&scene, past, [0.0, 0.0125], margin));
    }

    #[test]
    fn what_is_called_clear_is_clear_at_every_instant() {
        let robot = gantry();
        let (mut clear, mut refused) = (0, 0);
        let mut rng = rng::stream(38, 0);
        for _ in 0..6000 {
            let half = [0.002, 0.02, 0.1][rng.uniform_in(0.0, 3.0) as usize % 3];
            let obstacle = match rng.uniform_in(0.0, 1.0) < 0.3 {
                true => Shape::sphere([0.0; 3], half),
                false => Shape::cuboid([0.0; 3], [2.0 * half, 2.0 * half, 0.1], None),
            };
            let obstacles = [obstacle.unwrap()];
            let scene = Scene::new(&robot, &obstacles).unwrap();
            let mut coordinate = || match rng.uniform_in(-1.0, 1.0) {
                x if x > 0.4 => half + BESIDE,
                x if x < -0.6 => -half - BESIDE,
                _ => rng.uniform_in(-1.0, 1.0) * (half + 0.05),
            };
            let mut point = || [coordinate(), coordinate()];
            let [before, here, command] = [point(), point(), point()];
            let past = [before, here, here];
            if past.iter().any(|q| scene.clearance(q).unwrap() < 0.0) {
                continue;
            }
            if certifies(&scene, past, command, 0.0) {
                let least = least_clearance(&scene, &[before, here, here, command, command, command]);
                assert!(least >= -1e-9, "{least} m from {before:?} by {here:?} to {command:?}, half {half} m");
                clear += 1;
            } else {
                refused += 1;
            }
        }
        assert!(clear > 100 && refused > 100, "{clear} {refused}");
    }
}
