//! Conservative collision test of eight configurations, in single precision: lists the near pairs of bodies.

use super::scene::Scene;
use super::travel_bounds::{CarriedBall, MovingElements, TravelBounds};
use crate::bodies::{BodyPair, EightPoses};
use crate::math::Frame;
use crate::math::arithmetic::Arithmetic;
use crate::math::f32x8::F32x8;
use crate::math::real::{Eight, Real};
use crate::shape::{EightCapsules, EightShape, LARGEST_IN_SINGLE, below_square};

/// Rounding of distances in single precision, for coordinates of 1 m and angles of a few rad (m): a few units in the last place
/// for each of the operations that lead to it.
const SINGLE_ROUNDING: f64 = 2e-6;

/// Two groups with bodies that must not touch.
#[derive(Debug)]
struct NearGroups {
    groups: [usize; 2],
    /// Bounds on the motion of one relative to the other.
    levers: TravelBounds,
    /// Bodies of the first group, and the pairs of each.
    rows: Vec<(usize, Vec<BodyPair>)>,
}

impl NearGroups {
    fn new(groups: [usize; 2], levers: TravelBounds, pairs: &[BodyPair]) -> Self {
        let mut rows: Vec<(usize, Vec<BodyPair>)> = vec![];
        for pair in pairs {
            let BodyPair::Bodies { near, .. } = pair else { continue };
            match rows.iter_mut().find(|(body, _)| body == near) {
                Some((_, row)) => row.push(*pair),
                None => rows.push((*near, vec![*pair])),
            }
        }
        Self { groups, levers, rows }
    }
}

/// A scene, prepared for eight configurations at once.
#[derive(Debug)]
pub(super) struct EightScene<'a> {
    pub scene: &'a Scene<'a>,
    obstacles: Vec<EightShape>,
    /// The groups that a joint moves, with bounds on their motion.
    groups: Vec<(usize, TravelBounds)>,
    pairs: Vec<NearGroups>,
    /// The joint values for which the levers hold.
    ranges: Vec<(f64, f64)>,
    /// Largest coordinates and levers (m).
    extent: f64,
    poses: EightPoses,
    qs: Vec<F32x8>,
}

impl<'a> EightScene<'a> {
    /// Prepares `scene`.
    pub fn new(scene: &'a Scene<'a>) -> Self {
        let (robot, bodies) = (scene.robot(), &scene.bodies);
        let elements = MovingElements::of(robot);
        let ball = |group: usize| {
            let (center, radius) = bodies.groups.ball_in_frame(group);
            CarriedBall { frame: bodies.groups.frame_of(group), center, radius }
        };
        let levers = |groups: &[usize], below: usize| {
            let mut levers = TravelBounds::none(robot.dof());
            groups.iter().for_each(|group| elements.add(&ball(*group), below, &mut levers));
            levers
        };
        let moving = (0..bodies.groups.count()).filter(|group| bodies.groups.is_moving(*group));
        let groups: Vec<(usize, TravelBounds)> = moving.map(|group| (group, levers(&[group], 0))).collect();
        let pairs = bodies.pairs_of_groups().enumerate().filter(|_| scene.others.itself);
        let pairs = pairs.map(|(number, groups)| {
            let [one, other] = groups.map(|group| bodies.groups.frame_of(group));
            let levers = levers(&groups, robot.meeting_frame(one, other));
            NearGroups::new(groups, levers, bodies.pairs_between(number))
        });
        let pairs = pairs.collect();
        let levers = groups.iter().map(|(_, levers)| levers.sum()).fold(0.0, f64::max);
        let reach = (0..bodies.groups.count()).map(|group| elements.reach(&ball(group))).fold(0.0, f64::max);
        let obstacles = (0..scene.others.obstacles.len()).map(|obstacle| {
            let (center, radius) = scene.others.obstacles.ball(obstacle);
            center.norm() + if radius.is_finite() { radius } else { 0.0 }
        });
        Self {
            scene,
            obstacles: scene.others.obstacles.iter().map(|obstacle| EightShape::new(&obstacle.shape)).collect(),
            groups,
            pairs,
            ranges: (0..robot.dof()).map(|j| elements.range(robot, j)).collect(),
            extent: levers.max(reach) + obstacles.filter(|far| *far <= LARGEST_IN_SINGLE).fold(1.0, f64::max),
            poses: bodies.eight.buffer(),
            qs: vec![F32x8::ZERO; robot.dof()],
        }
    }

    /// Whether the bounds on how far bodies move hold for joint values within `off_line` (rad, m) of those of `q`.
    pub fn covers(&self, q: &[f64], off_line: &[f64]) -> bool {
        let mut joints = self.ranges.iter().zip(q.iter().zip(off_line));
        joints.all(|((lower, upper), (q, off_line))| *lower <= q - off_line && q + off_line <= *upper)
    }

    /// Rounding of a distance (m), for joint values of up to `largest` (rad, m). Not a number, which makes everything
    /// near, if coordinates are too large for single precision.
    pub fn rounding(&self, largest: f64) -> f64 {
        let rounding = SINGLE_ROUNDING * self.extent * (1.0 + 0.1 * largest);
        if rounding <= SINGLE_ROUNDING * LARGEST_IN_SINGLE { rounding } else { f64::NAN }
    }

    /// A bound on how far any body moves (m) while the joints move by `reach` (rad, m).
    #[inline]
    pub fn farthest(&self, reach: &[f64]) -> f64 {
        self.groups.iter().map(|(_, levers)| levers.travel(reach)).fold(0.0, f64::max)
    }

    /// Poses everything at these fractions of the straight line between two configurations.
    #[inline(always)]
    pub fn pose_along<A: Arithmetic>(&mut self, [from, to]: [&[f64]; 2], fractions: [f32; 8]) {
        let fractions = Eight::<A>::of(F32x8(fractions));
        self.pose_at::<A>(|j| fractions.mul_add(Eight::splat(to[j] - from[j]), Eight::splat(from[j])).stored());
    }

    /// Poses everything at configurations of which `values` returns the values of a joint.
    #[inline(always)]
    pub fn pose_at<A: Arithmetic>(&mut self, values: impl Fn(usize) -> F32x8) {
        self.qs.iter_mut().enumerate().for_each(|(joint, q)| *q = values(joint));
        self.scene.bodies.eight.update::<A>(&self.qs, &mut self.poses);
    }

    /// Shows `visitor` all pairs that may come nearer than `margin` (m) while the joints move by `reach` (rad, m) from the
    /// configurations, and the lanes in which they may. False if it wants no more.
    #[inline(always)]
    pub fn each_near<A: Arithmetic>(&mut self, margin: f64, reach: &[f64], visitor: &mut impl Visitor) -> bool {
        let Self { scene, obstacles, groups, pairs, poses, .. } = self;
        let (eight, others) = (&scene.bodies.eight, &scene.others);
        let mut near = Near { scene, obstacles, poses };
        for (group, levers) in groups.iter() {
            let enough = Eight::splat(margin + levers.travel(reach));
            let ball = eight.ball::<A>(*group, near.poses);
            for (obstacle, shape) in obstacles.iter().enumerate() {
                if shape.near(&ball, enough) == 0 {
                    continue;
                }
                for &body in scene.bodies.groups.bodies_of(*group) {
                    let lanes = shape.near(&eight.body::<A>(body, near.poses), enough);
                    if lanes == 0 || others.allowed.allow(body, obstacle) {
                        continue;
                    }
                    if !visitor.goes_on::<A>(&mut near, BodyPair::Obstacle { body, obstacle }, lanes) {
                        return false;
                    }
                }
            }
        }
        for NearGroups { groups: [one, other], levers, rows } in pairs.iter() {
            let enough = Eight::splat(margin + levers.travel(reach));
            let [a, b] = [eight.ball::<A>(*one, near.poses), eight.ball::<A>(*other, near.poses)];
            if near_each_other(&a, &b, enough) == 0 {
                continue;
            }
            for (body, row) in rows {
                let own = eight.body::<A>(*body, near.poses);
                if near_each_other(&own, &b, enough) == 0 {
                    continue;
                }
                for &pair in row {
                    let BodyPair::Bodies { far, .. } = pair else { continue };
                    let lanes = near_each_other(&own, &eight.body::<A>(far, near.poses), enough);
                    if lanes != 0 && !visitor.goes_on::<A>(&mut near, pair, lanes) {
                        return false;
                    }
                }
            }
        }
        true
    }

    /// Whether a pair is nearer than `margin` (m) at any of the configurations.
    #[inline(always)]
    pub fn meet<A: Arithmetic>(&mut self, pair: BodyPair, margin: f64) -> bool {
        let Self { scene, obstacles, poses, .. } = self;
        Near { scene, obstacles, poses }.meet::<A>(pair, margin)
    }
}

/// Visitor of near pairs. No closure: that would be compiled without the instructions of the calling kernel.
pub(super) trait Visitor {
    /// Takes a pair and the lanes in which it may be near; returns whether it wants more.
    fn goes_on<A: Arithmetic>(&mut self, near: &mut Near<'_, '_>, pair: BodyPair, lanes: u32) -> bool;
}

/// Bodies and obstacles at eight configurations.
pub(super) struct Near<'s, 'a> {
    scene: &'s Scene<'a>,
    obstacles: &'s [EightShape],
    poses: &'s mut EightPoses,
}

impl Near<'_, '_> {
    /// Whether a pair is nearer than `margin` (m) at any of the configurations.
    #[inline(always)]
    pub fn meet<A: Arithmetic>(&mut self, pair: BodyPair, margin: f64) -> bool {
        let eight = &self.scene.bodies.eight;
        let enough = Eight::splat(margin);
        let lanes = match pair {
            BodyPair::Obstacle { body, obstacle } => {
                self.obstacles[obstacle].near(&eight.body::<A>(body, self.poses), enough)
            }
            BodyPair::Bodies { near, far, .. } => {
                let (a, b) = (eight.body::<A>(near, self.poses), eight.body::<A>(far, self.poses));
                near_each_other(&a, &b, enough)
            }
        };
        lanes != 0 && self.shapes_meet(pair, margin, lanes)
    }

    /// Whether a pair whose capsules are too near in these lanes really is: bodies that are no capsules are examined one by one.
    #[inline]
    fn shapes_meet(&self, pair: BodyPair, margin: f64, lanes: u32) -> bool {
        let solid = |body: usize| self.scene.bodies.carried[body].solid.is_some();
        let is_exact = match pair {
            BodyPair::Obstacle { body, .. } => !solid(body),
            BodyPair::Bodies { near, far, .. } => !solid(near) && !solid(far),
        };
        is_exact
            || (0..8).filter(|lane| lanes & (1 << lane) != 0).any(|lane| {
                let frames: Vec<Frame> = self.poses.frames.iter().map(|frame| frame.lane(lane)).collect();
                self.scene.distance_at(pair, &frames, margin) < margin
            })
    }
}

/// The lanes in which two bodies may be nearer than `margin`, one bit each.
#[inline(always)]
fn near_each_other<A: Arithmetic>(one: &EightCapsules<A>, other: &EightCapsules<A>, margin: Eight<A>) -> u32 {
    below_square(one.squared_distance(other), one.radius + other.radius + margin)
}
