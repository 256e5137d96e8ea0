//! A motion from tick to tick, certified to keep its distances at every instant.
//!
//! Distances are computed at both ends of an interval of the motion. A pair is clear in between if neither end lets it come near
//! enough on the way, or if a plane parts both bodies at either end by more than they leave the straight lines between their places.
//! Such a plane costs almost no clearance, even along a wall. What is not clear so is examined again in both halves.

use super::body_model::BodyPair;
use super::kept_distance::KeptDistance;
use super::link_displacement::{displacement, sagitta};
use super::near_rows::MOST_RESERVED;
use super::scene::Scene;
use crate::math::Frame;
use crate::objective::Point;
use crate::robot::FrameBuffer;
use crate::shape::PlacedBody;

/// Intervals examined before a motion counts as not clear.
const MOST_INTERVALS: usize = 120;

/// Largest weight of a control point outside of an interval in a uniform cubic B-spline.
const OUTSIDE: f64 = 1.0 / 6.0;

/// An interval this short (ticks) is not halved again.
const SHORTEST: f64 = 1e-3;

/// Places for which room is set aside; a deeper bisection takes more.
const MOST_DEPTHS: usize = 32;

/// A joint motion over whole ticks, from 0 to `ticks`.
pub(crate) trait TickedMotion {
    /// When it ends.
    fn ticks(&self) -> f64;
    /// Writes the configuration at a tick; between ticks that of the straight line.
    fn write(&self, tick: f64, q: &mut [f64]);
    /// Writes by how much each joint gets off the straight line between two ticks at most (rad, m), at the ticks in between.
    fn write_off_line(&self, from: f64, to: f64, off_line: &mut [f64]);
    /// Whether the arm does not pass the configurations of the ticks, but follows the uniform cubic B-spline with these control
    /// points. Then `write` also knows the ticks just before the motion and after it.
    fn is_spline(&self) -> bool;
}

/// Checks motions; owns its scratch.
#[derive(Debug)]
pub(crate) struct ChordCheck {
    /// Configurations by depth of the bisection; both ends of the motion first.
    places: Vec<Place>,
    /// Of a spline: the control points just outside of an interval.
    outside: Vec<Place>,
    pending: Vec<BodyPair>,
    intervals: usize,
    /// By how much the joints change between the control points of an interval, and get off the straight lines between them.
    change: Point,
    off_line: Point,
    /// How far a joint gets aside of the straight line between the ends, and from the nearer end.
    aside: Point,
    halfway: Point,
}

#[derive(Debug)]
struct Place {
    q: Point,
    frames: FrameBuffer,
}

/// An interval of the motion, and the places of its ends.
#[derive(Debug, Clone, Copy)]
struct Interval {
    from: f64,
    to: f64,
    ends: [usize; 2],
    depth: usize,
}

/// What is known of a pair in an interval.
enum Verdict {
    Clear,
    Open,
    TooNear,
}

impl ChordCheck {
    /// For motions in `scene`.
    pub(super) fn new(scene: &Scene<'_>) -> Self {
        let pending = Vec::with_capacity(scene.pairs().take(MOST_RESERVED).count());
        let [change, off_line, aside, halfway] = [(); 4].map(|()| Point::new());
        let (places, outside) = (Vec::with_capacity(MOST_DEPTHS), Vec::with_capacity(2));
        Self { places, outside, pending, intervals: 0, change, off_line, aside, halfway }
    }

    /// Whether `motion` keeps these distances for certain, between ticks too. Bodies that no joint moves are left out.
    pub(super) fn is_clear(&mut self, scene: &Scene<'_>, motion: &impl TickedMotion, kept: &KeptDistance<'_>) -> bool {
        self.intervals = 0;
        self.outside.clear();
        let end = motion.ticks();
        place(&mut self.places, 0, scene, (motion, 0.0));
        place(&mut self.places, 1, scene, (motion, end));
        let whole = Interval { from: 0.0, to: end, ends: [0, 1], depth: 0 };
        self.measure(motion, &whole);
        self.collect_pending(scene, &whole, kept);
        let count = self.pending.len();
        self.clear_in(scene, motion, kept, whole, count)
    }

    /// Finds how far the joints move in an interval.
    fn measure(&mut self, motion: &impl TickedMotion, interval: &Interval) {
        let Self { places, change, off_line, aside, halfway, .. } = self;
        let [from, to] = interval.ends.map(|end| &places[end].q);
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
    fn collect_pending(&mut self, scene: &Scene<'_>, whole: &Interval, kept: &KeptDistance<'_>) {
        let Self { places, pending, change, aside, halfway, .. } = self;
        pending.clear();
        let (groups, robot) = (&scene.bodies.groups, scene.robot());
        let [first, last] = whole.ends.map(|end| &places[end].frames);
        let most = kept.most_wanted(whole.to);
        for group in (0..groups.count()).filter(|group| groups.is_moving(*group)) {
            let [(from, radius), (to, _)] = [first, last].map(|frames| groups.ball(group, frames));
            let ball = PlacedBody { axis: &[from; 2], radius, solid: None };
            let beside = sagitta(robot, first, &ball, groups.frame_of(group), [change, aside]);
            let reach = radius + beside;
            let bodies = groups.bodies_of(group);
            let (middle, half) = (0.5 * (from + to), 0.5 * (to - from).norm());
            scene.others.each_near(&middle, half + reach + most, |obstacle| {
                let needed = kept.wanted(Some(obstacle), whole.to);
                if scene.others.obstacles[obstacle].distance_to_segment(&[from, to], needed + reach) < needed + reach {
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
                    let ball = PlacedBody { axis: &[center; 2], radius: 0.0, solid: None };
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
        motion: &impl TickedMotion,
        kept: &KeptDistance<'_>,
        interval: Interval,
        count: usize,
    ) -> bool {
        self.intervals += 1;
        if motion.is_spline() && count > 0 {
            place(&mut self.outside, 0, scene, (motion, interval.from - 1.0));
            place(&mut self.outside, 1, scene, (motion, interval.to + 1.0));
        }
        let mut open = 0;
        for i in 0..count {
            let pair = self.pending[i];
            match self.verdict(scene, pair, &interval, kept) {
                Verdict::Clear => {}
                Verdict::TooNear => return false,
                Verdict::Open => {
                    self.pending.swap(i, open);
                    open += 1;
                }
            }
        }
        // A spline is known by its control points alone.
        let shortest = if motion.is_spline() { 1.0 } else { SHORTEST };
        if open == 0 || self.intervals > MOST_INTERVALS || interval.to - interval.from <= shortest {
            return open == 0;
        }
        let Interval { from, to, ends: [first, last], depth } = interval;
        let half = 0.5 * (to - from);
        // Of more than one tick, halves of whole ticks: the motion is straight between ticks alone.
        let middle = from
            + if half >= 1.0 {
                half.floor()
            } else if to - from > 1.0 {
                1.0
            } else {
                half
            };
        let slot = depth + 2;
        place(&mut self.places, slot, scene, (motion, middle));
        [(from, middle, [first, slot]), (middle, to, [slot, last])].into_iter().all(|(from, to, ends)| {
            let half = Interval { from, to, ends, depth: depth + 1 };
            self.measure(motion, &half);
            self.clear_in(scene, motion, kept, half, open)
        })
    }

    fn verdict(&self, scene: &Scene<'_>, pair: BodyPair, interval: &Interval, kept: &KeptDistance<'_>) -> Verdict {
        let [first, last] = interval.ends.map(|end| &self.places[end].frames);
        let [needed_first, needed] = [interval.from, interval.to].map(|tick| kept.needed(pair, tick));
        let (change_first, change_last) =
            (scene.change_at(pair, first, &self.halfway), scene.change_at(pair, last, &self.halfway));
        let at_first = scene.distance_at(pair, first, needed + change_first);
        let at_last = scene.distance_at(pair, last, needed + change_last);
        if at_first < needed_first || at_last < needed {
            return Verdict::TooNear;
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

    /// By how much a plane parts a body from an obstacle in the whole interval (m); `None` for links, and if there is no such plane.
    fn parted(
        &self,
        scene: &Scene<'_>,
        pair: BodyPair,
        nearer: &FrameBuffer,
        [first, last]: [&FrameBuffer; 2],
    ) -> Option<f64> {
        let BodyPair::Obstacle { body, obstacle } = pair else { return None };
        let (shape, carried, frames) = (&scene.others.obstacles[obstacle], &scene.bodies.carried[body], first);
        let at = |frames: &FrameBuffer| frames[carried.stages];
        let (_, normal) = shape.nearest_to_body(&carried.placed(&carried.axis_at(&at(nearer)), &at(nearer)));
        let end = shape.farthest_along(&normal)?;
        let least = |frame: Frame| carried.placed(&carried.axis_at(&frame), &frame).least_along(&normal);
        let control_points = [first, last].into_iter().chain(self.outside.iter().map(|place| &place.frames));
        let least = control_points.map(|frames| least(at(frames))).fold(f64::INFINITY, f64::min);
        let (axis, frame) = (carried.axis_at(&at(first)), at(first));
        let body = carried.placed(&axis, &frame);
        let beside = sagitta(scene.robot(), frames, &body, carried.stages, [&self.change, &self.off_line]);
        Some(least - beside - end)
    }
}

/// Places the robot at a tick of the motion.
fn place(places: &mut Vec<Place>, slot: usize, scene: &Scene<'_>, (motion, tick): (&impl TickedMotion, f64)) {
    let robot = scene.robot();
    if places.len() <= slot {
        let q = Point::from_elem(0.0, robot.dof());
        places.resize_with(slot + 1, || Place { q: q.clone(), frames: robot.frame_buffer() });
    }
    let Place { q, frames } = &mut places[slot];
    motion.write(tick, q);
    robot.write_frames(q, frames);
}
