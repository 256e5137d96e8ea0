//! Clearance test of one configuration, four bodies at a time in the lanes of the registers.
//!
//! Most balls around groups are clear of most obstacles; only bodies of the others are tested one by one.

use nalgebra::Vector3;
use smallvec::SmallVec;

use super::allowed_contacts::AllowedContacts;
use super::obstacles::{Obstacle, Obstacles};
use crate::bodies::{Balls, BodyGroups, BodyModel, BodyTest, Group, GroupPair};
use crate::math::Frame;
use crate::math::arithmetic::{Arithmetic, by_instructions};
use crate::math::f64x4::F64x4;
use crate::shape::{BodyBlock, PosedBody, Shape, clear_of_each_other};

/// Obstacles and own links to keep clear of, and the contacts that are allowed.
#[derive(Debug, Clone)]
pub(super) struct OtherBodies {
    pub obstacles: Obstacles,
    /// Bodies that may touch some of them.
    pub allowed: AllowedContacts,
    /// The bodies of the robot itself, in the pairs that must not touch.
    pub itself: bool,
}

/// An arm at one configuration among other bodies, and the distance to keep (m).
#[derive(Clone, Copy)]
pub(super) struct PosedArm<'a> {
    pub bodies: &'a BodyModel,
    /// The moving elements.
    pub frames: &'a [Frame],
    pub others: &'a OtherBodies,
    /// Zero or more.
    pub margin: f64,
}

/// Groups of more blocks than this are on the heap.
const BLOCKS: usize = 8;
/// Near groups beyond this many are on the heap.
const NEAR_GROUPS: usize = 12;

type NearBodies = SmallVec<[usize; 4 * BLOCKS]>;

impl PosedArm<'_> {
    /// Whether everything keeps the distance, but for bodies that no joint moves and obstacles.
    pub fn is_clear(&self) -> bool {
        is_clear(self)
    }

    /// Whether the bodies that no joint moves keep the distance from the obstacles.
    pub fn is_clear_at_rest(&self) -> bool {
        is_clear_at_rest(self)
    }

    /// Whether the bodies of the lanes that are not `clear` of an obstacle by their capsules may touch it, or keep the distance by their
    /// shapes.
    #[inline(never)]
    fn others_are_clear(&self, (group, block, obstacle): (usize, usize, usize), clear: &F64x4) -> bool {
        let Self { others, margin, .. } = *self;
        let may_touch = |lane: usize| others.allowed.allow(self.group(group).body(block, lane), obstacle);
        let near = (0..4).filter(|lane| clear.0[*lane] == 0.0 && !may_touch(*lane));
        self.solids_are_clear(near, (group, block), |body| {
            others.obstacles[obstacle].shape.distance_to_body(body, margin) >= margin
        })
    }

    /// Whether the bodies of these lanes, which are not clear by their capsules, are `clear_of` something by their shapes.
    #[inline]
    fn solids_are_clear(
        &self,
        mut lanes: impl Iterator<Item = usize>,
        (group, block): (usize, usize),
        clear_of: impl Fn(&PosedBody) -> bool,
    ) -> bool {
        lanes.all(|lane| {
            let body = &self.bodies.carried[self.group(group).body(block, lane)];
            let frame = &self.frames[body.stages];
            self.bodies.groups.solids && clear_of(&body.posed(&body.axis_at(frame), frame))
        })
    }

    /// Whether the pairs of the lanes that are not `clear` by their capsules keep the distance by their shapes.
    #[inline(never)]
    fn solid_pairs_are_clear(&self, pair: &GroupPair, test: &BodyTest, clear: &F64x4) -> bool {
        let own = &self.bodies.carried[self.group(pair.near).body(test.block, test.lane)];
        let frame = &self.frames[own.stages];
        let near = (0..4).filter(|lane| clear.0[*lane] == 0.0);
        self.solids_are_clear(near, (pair.far, test.far_block), |body| {
            own.posed(&own.axis_at(frame), frame).distance_to(body, self.margin) >= self.margin
        })
    }

    fn group(&self, group: usize) -> &Group {
        &self.bodies.groups.groups[group]
    }
}

/// Blocks of a group at the present frames, cached until another group is asked for.
struct PosedGroup {
    group: usize,
    blocks: SmallVec<[BodyBlock; BLOCKS]>,
}

impl PosedGroup {
    fn none() -> Self {
        Self { group: usize::MAX, blocks: SmallVec::new() }
    }

    #[inline(always)]
    fn of<A: Arithmetic>(&mut self, arm: &PosedArm<'_>, group: usize) -> &[BodyBlock] {
        if self.group != group {
            self.group = group;
            self.blocks.clear();
            let Group { blocks, stages, .. } = arm.group(group);
            for block in blocks {
                self.blocks.push(block.posed::<A>(&arm.frames[*stages]));
            }
        }
        &self.blocks
    }
}

/// Whether all lanes are 1; each is 1 or 0.
#[inline(always)]
fn all_clear(lanes: &F64x4) -> bool {
    lanes.0[0] + lanes.0[1] + lanes.0[2] + lanes.0[3] == 4.0
}

/// The larger of each two lanes.
#[inline(always)]
fn larger_lanes<A: Arithmetic>(one: F64x4, other: F64x4) -> F64x4 {
    A::choose_below_x4(one, other, other, one)
}

by_instructions! {
    fn is_clear(arm: &PosedArm<'_>) -> bool {
        let balls = arm.bodies.groups.balls(arm.frames);
        obstacles_are_clear::<A>(arm, &balls, true) && pairs_are_clear::<A>(arm, &balls)
    }
}

by_instructions! {
    fn is_clear_at_rest(arm: &PosedArm<'_>) -> bool {
        obstacles_are_clear::<A>(arm, &arm.bodies.groups.balls(arm.frames), false)
    }
}

/// Centre and radius (m) of the ball around a group.
#[inline(always)]
fn ball_in(balls: &Balls, group: usize) -> (Vector3<f64>, f64) {
    let ([x, y, z], radius) = (&balls[group / 4].start, &balls[group / 4].radius);
    let lane = group % 4;
    (Vector3::new(x.0[lane], y.0[lane], z.0[lane]), radius.0[lane])
}

/// The obstacles that the balls are near to, with their groups: of those groups that a joint moves, or of the others.
#[inline(always)]
fn near_obstacles<A: Arithmetic>(arm: &PosedArm<'_>, balls: &Balls, moving: bool) -> SmallVec<[(usize, usize); 32]> {
    let PosedArm { others: OtherBodies { obstacles, .. }, margin, .. } = *arm;
    let all = &arm.bodies.groups;
    let mut near = SmallVec::new();
    let asked = |group: usize| group < all.groups.len() && all.is_moving(group) == moving;
    if let Some(index) = obstacles.index() {
        for group in (0..all.groups.len()).filter(|group| asked(*group)) {
            let (center, radius) = ball_in(balls, group);
            index.near_ball(&center, radius + margin, |obstacle| near.push((group, obstacle)));
        }
        return near;
    }
    for (obstacle, Obstacle { shape, .. }) in obstacles.iter().enumerate() {
        for (i, block) in balls.iter().enumerate() {
            let clear = shape.clear_lanes::<A>(block, margin);
            if all_clear(&clear) {
                continue;
            }
            for lane in 0..4 {
                if clear.0[lane] == 0.0 && asked(4 * i + lane) {
                    near.push((4 * i + lane, obstacle));
                }
            }
        }
    }
    near.sort_unstable();
    near
}

#[inline(always)]
fn obstacles_are_clear<A: Arithmetic>(arm: &PosedArm<'_>, balls: &Balls, moving: bool) -> bool {
    let PosedArm { others, margin, .. } = *arm;
    let mut posed = PosedGroup::none();
    for (group, obstacle) in near_obstacles::<A>(arm, balls, moving) {
        for (block, capsules) in posed.of::<A>(arm, group).iter().enumerate() {
            let clear = others.obstacles[obstacle].shape.clear_lanes::<A>(capsules, margin);
            if !all_clear(&clear) && !arm.others_are_clear((group, block, obstacle), &clear) {
                return false;
            }
        }
    }
    true
}

#[inline(always)]
fn pairs_are_clear<A: Arithmetic>(arm: &PosedArm<'_>, balls: &Balls) -> bool {
    let PosedArm { others, margin, .. } = *arm;
    let (mut one, mut other) = (PosedGroup::none(), PosedGroup::none());
    let pairs: &[GroupPair] = if others.itself { &arm.bodies.groups.pairs } else { &[] };
    for pair in pairs {
        let ((near, near_radius), (far, far_radius)) = (ball_in(balls, pair.near), ball_in(balls, pair.far));
        let enough = near_radius + far_radius + margin;
        if (near - far).norm_squared() > enough * enough * (1.0 + 1e-12) {
            continue;
        }
        let (near, far) = (one.of::<A>(arm, pair.near), other.of::<A>(arm, pair.far));
        for test in &pair.tests {
            let clear = clear_of_each_other::<A>(&near[test.block].repeated(test.lane), &far[test.far_block], margin);
            let clear = larger_lanes::<A>(clear, test.ignored);
            if !all_clear(&clear) && !arm.solid_pairs_are_clear(pair, test, &clear) {
                return false;
            }
        }
    }
    true
}

by_instructions! {
    /// Groups that a joint moves and that may be nearer than `margin` >= 0 (m) to a shape; `balls` are around all groups.
    pub(super) fn near_groups(
        all: &BodyGroups,
        balls: &Balls,
        shape: &Shape,
        margin: f64
    ) -> SmallVec<[usize; NEAR_GROUPS]> {
        let mut near = SmallVec::new();
        for (i, block) in balls.iter().enumerate() {
            let clear = shape.clear_lanes::<A>(block, margin);
            let groups = (4 * i..all.groups.len()).zip(clear.0).filter(|(_, clear)| *clear == 0.0);
            near.extend(groups.map(|(group, _)| group).filter(|group| all.is_moving(*group)));
        }
        near
    }
}

by_instructions! {
    /// Bodies of a group at `frame` that may be nearer than `margin` >= 0 (m) to a shape.
    pub(super) fn near_bodies(group: &Group, frame: &Frame, shape: &Shape, margin: f64) -> NearBodies {
        let mut near = NearBodies::new();
        for (bodies, block) in group.bodies.chunks(4).zip(&group.blocks) {
            let clear = shape.clear_lanes::<A>(&block.posed::<A>(frame), margin);
            if !all_clear(&clear) {
                near.extend(bodies.iter().zip(clear.0).filter(|(_, clear)| *clear == 0.0).map(|(body, _)| *body));
            }
        }
        near
    }
}
