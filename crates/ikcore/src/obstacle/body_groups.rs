//! The bodies of a robot in the lanes of the registers: is everything clear at a configuration?
//!
//! Bodies of one moving element form a group with a ball around it. Most balls are clear of most obstacles; only bodies of
//! the others are tested one by one.

use nalgebra::Vector3;
use smallvec::SmallVec;

use super::allowed_contacts::AllowedContacts;
use super::obstacles::Obstacles;
use crate::math::Frame;
use crate::math::arithmetic::{Arithmetic, NoFma, by_instructions};
use crate::math::f64x4::F64x4;
use crate::robot::Carried;
use crate::shape::{BodyBlock, PlacedBody, Shape, clear_of_each_other};

/// The bodies of a robot by moving element, and the pairs of them that must not touch.
#[derive(Debug, Clone)]
pub(super) struct BodyGroups {
    groups: Vec<Group>,
    /// Group, block and lane of each body.
    places: Vec<[usize; 3]>,
    pairs: Vec<GroupPair>,
    /// Whether some bodies are no capsules.
    solids: bool,
}

/// What the bodies are to keep clear of.
#[derive(Debug, Clone)]
pub(super) struct OtherBodies {
    pub obstacles: Obstacles,
    /// Bodies that may touch some of them.
    pub allowed: AllowedContacts,
    /// The bodies of the robot itself, in the pairs that must not touch.
    pub itself: bool,
}

/// All bodies of one moving element, in its frame.
#[derive(Debug, Clone)]
struct Group {
    stages: usize,
    center: [f64; 3],
    radius: f64,
    /// Indices of its bodies, four in a block.
    bodies: Vec<usize>,
    blocks: Vec<BodyBlock>,
}

/// Two groups, and the pairs of their bodies that must not touch.
#[derive(Debug, Clone)]
struct GroupPair {
    near: usize,
    far: usize,
    tests: Vec<BodyTest>,
}

/// One body of the near group against a block of the far one.
#[derive(Debug, Clone)]
struct BodyTest {
    block: usize,
    lane: usize,
    far_block: usize,
    /// 1 in lanes that may touch, else 0.
    ignored: F64x4,
}

/// Groups of more blocks than this are placed on the heap.
const BLOCKS: usize = 8;
/// Groups beyond this many are placed on the heap.
const GROUPS: usize = 12;
type Placed = SmallVec<[BodyBlock; BLOCKS]>;
pub(super) type Balls = SmallVec<[BodyBlock; GROUPS / 4]>;
pub(super) type NearBodies = SmallVec<[usize; 4 * BLOCKS]>;

impl BodyGroups {
    /// Groups of `carried`, of which these pairs must not touch. Bodies that no joint moves are not compared with obstacles each time.
    pub fn new(carried: &[Carried], pairs: &[[usize; 2]]) -> Self {
        let mut stages: Vec<usize> = carried.iter().map(|body| body.stages).collect();
        stages.sort_unstable_by(|one, other| other.cmp(one));
        stages.dedup();
        let members = |stage: usize| (0..carried.len()).filter(move |i| carried[*i].stages == stage);
        let mut places = vec![[0; 3]; carried.len()];
        let mut groups = vec![];
        for stage in stages {
            // Spheres first: blocks of spheres alone are cheaper.
            let mut bodies: Vec<usize> = members(stage).collect();
            bodies.sort_by_key(|i| carried[*i].ends[0] != carried[*i].ends[1]);
            for (i, body) in bodies.iter().enumerate() {
                places[*body] = [groups.len(), i / 4, i % 4];
            }
            groups.push(Group::new(stage, bodies, carried));
        }
        let solids = carried.iter().any(|body| body.solid.is_some());
        let mut all = Self { groups, places, pairs: vec![], solids };
        for [near, far] in pairs {
            all.forbid(all.places[*near], all.places[*far]);
        }
        all
    }

    fn forbid(&mut self, [near, block, lane]: [usize; 3], [far, far_block, far_lane]: [usize; 3]) {
        let found = self.pairs.iter().position(|pair| (pair.near, pair.far) == (near, far));
        let index = found.unwrap_or_else(|| {
            self.pairs.push(GroupPair { near, far, tests: vec![] });
            self.pairs.len() - 1
        });
        let tests = &mut self.pairs[index].tests;
        let same = |test: &BodyTest| (test.block, test.lane, test.far_block) == (block, lane, far_block);
        let index = tests.iter().position(same).unwrap_or_else(|| {
            tests.push(BodyTest { block, lane, far_block, ignored: F64x4::splat(1.0) });
            tests.len() - 1
        });
        tests[index].ignored.0[far_lane] = 0.0;
    }

    /// Whether everything keeps the distance, but for bodies that no joint moves and obstacles.
    pub fn are_clear(&self, posed: &Posed<'_>) -> bool {
        are_clear(self, posed)
    }

    /// Whether the bodies that no joint moves keep the distance from the obstacles.
    pub fn are_clear_at_rest(&self, posed: &Posed<'_>) -> bool {
        are_clear_at_rest(self, posed)
    }

    /// How many groups there are.
    pub fn count(&self) -> usize {
        self.groups.len()
    }

    /// The group of a body.
    pub fn group_of(&self, body: usize) -> usize {
        self.places[body][0]
    }

    /// The groups that a joint moves and that may be nearer than `margin` >= 0 (m) to a shape; `balls` are around all groups.
    pub fn near_groups(&self, balls: &Balls, shape: &Shape, margin: f64) -> SmallVec<[usize; GROUPS]> {
        near_groups(self, balls, shape, margin)
    }

    /// The bodies of a group that may be nearer than `margin` >= 0 (m) to a shape, with the moving elements at `frames`.
    pub fn near_bodies(&self, group: usize, frames: &[Frame], shape: &Shape, margin: f64) -> NearBodies {
        let group = &self.groups[group];
        near_bodies(group, &frames[group.stages], shape, margin)
    }

    /// The bodies of a group.
    pub fn bodies_of(&self, group: usize) -> &[usize] {
        &self.groups[group].bodies
    }

    /// Whether a joint moves a group.
    pub fn is_moving(&self, group: usize) -> bool {
        self.groups[group].stages > 0
    }

    /// Number of the frame that carries a group.
    pub fn frame_of(&self, group: usize) -> usize {
        self.groups[group].stages
    }

    /// Centre and radius (m) of a ball that holds a group, in its frame.
    pub fn ball_in_frame(&self, group: usize) -> ([f64; 3], f64) {
        let Group { center, radius, .. } = &self.groups[group];
        (*center, *radius)
    }

    /// Centre and radius (m) of a ball that holds a group, with the moving elements at `frames`.
    pub fn ball(&self, group: usize, frames: &[Frame]) -> (Vector3<f64>, f64) {
        let Group { stages, center, radius, .. } = &self.groups[group];
        (frames[*stages].place::<NoFma>(center).into(), *radius)
    }

    /// The pairs of groups that must keep clear.
    fn pairs_of(&self, others: &OtherBodies) -> &[GroupPair] {
        if others.itself { &self.pairs } else { &[] }
    }

    /// Whether the bodies of the lanes that are not `clear` of an obstacle by their capsules may touch it, or are at least `margin`
    /// (m) from it by their shapes.
    #[inline(never)]
    fn others_are_clear(
        &self,
        (group, block, obstacle): (usize, usize, usize),
        clear: &F64x4,
        carried: &[Carried],
        frames: &[Frame],
        (others, margin): (&OtherBodies, f64),
    ) -> bool {
        let may_touch = |lane: usize| others.allowed.allow(self.groups[group].body(block, lane), obstacle);
        let near = (0..4).filter(|lane| clear.0[*lane] == 0.0 && !may_touch(*lane));
        self.solids_are_clear(near, (group, block), carried, frames, |body| {
            others.obstacles[obstacle].distance_to_body(body, margin) >= margin
        })
    }

    /// Whether the bodies of these lanes, which are not clear by their capsules, are `clear_of` something by their shapes.
    #[inline]
    fn solids_are_clear(
        &self,
        mut lanes: impl Iterator<Item = usize>,
        (group, block): (usize, usize),
        carried: &[Carried],
        frames: &[Frame],
        clear_of: impl Fn(&PlacedBody) -> bool,
    ) -> bool {
        lanes.all(|lane| {
            let body = &carried[self.groups[group].body(block, lane)];
            let frame = &frames[body.stages];
            self.solids && clear_of(&body.placed(&body.axis_at(frame), frame))
        })
    }

    /// Whether the pairs of the lanes that are not `clear` by their capsules are at least `margin` (m) apart by their shapes.
    #[inline(never)]
    fn solid_pairs_are_clear(
        &self,
        (pair, test): (&GroupPair, &BodyTest),
        clear: &F64x4,
        carried: &[Carried],
        frames: &[Frame],
        margin: f64,
    ) -> bool {
        let own = &carried[self.groups[pair.near].body(test.block, test.lane)];
        let frame = &frames[own.stages];
        let near = (0..4).filter(|lane| clear.0[*lane] == 0.0);
        self.solids_are_clear(near, (pair.far, test.far_block), carried, frames, |body| {
            own.placed(&own.axis_at(frame), frame).distance_to(body, margin) >= margin
        })
    }

    /// The balls around all groups, four in a block.
    #[inline(always)]
    pub fn balls(&self, frames: &[Frame]) -> Balls {
        let mut balls = Balls::new();
        for (i, group) in self.groups.iter().enumerate() {
            if i % 4 == 0 {
                balls.push(BodyBlock::SPHERES);
            }
            let center = frames[group.stages].place::<NoFma>(&group.center);
            let Some(block) = balls.last_mut() else { continue };
            // Lanes after the last group repeat it.
            for lane in i % 4..4 {
                for k in 0..3 {
                    block.start[k].0[lane] = center[k];
                }
                block.radius.0[lane] = group.radius;
            }
        }
        balls
    }
}

impl Group {
    fn new(stages: usize, indices: Vec<usize>, carried: &[Carried]) -> Self {
        let bodies: Vec<&Carried> = indices.iter().map(|i| &carried[*i]).collect();
        let ends = || bodies.iter().flat_map(|body| body.ends.map(Vector3::from));
        let (low, high) = ends()
            .fold((Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY)), |(low, high), end| {
                (low.inf(&end), high.sup(&end))
            });
        let center = 0.5 * (low + high);
        let reach = |body: &&Carried| {
            let far = body.ends.map(|end| (Vector3::from(end) - center).norm());
            far[0].max(far[1]) + body.radius
        };
        // Rounded up: the ball holds its bodies wherever both are placed.
        let radius = bodies.iter().map(reach).fold(0.0, f64::max) * (1.0 + 1e-12) + 1e-12;
        let blocks = bodies.chunks(4).map(|four| {
            // Lanes without a body repeat the first.
            let body = |lane: usize| four.get(lane).unwrap_or(&four[0]);
            let lanes = |value: &dyn Fn(&Carried) -> f64| F64x4(std::array::from_fn(|lane| value(body(lane))));
            BodyBlock {
                start: std::array::from_fn(|k| lanes(&|body| body.ends[0][k])),
                along: std::array::from_fn(|k| lanes(&|body| body.ends[1][k] - body.ends[0][k])),
                radius: lanes(&|body| body.radius),
                spheres: four.iter().all(|body| body.ends[0] == body.ends[1]),
            }
        });
        let blocks = blocks.collect();
        Self { stages, center: center.into(), radius, bodies: indices, blocks }
    }

    /// The body in a lane of a block; lanes without one repeat the first.
    fn body(&self, block: usize, lane: usize) -> usize {
        self.bodies.get(4 * block + lane).copied().unwrap_or(self.bodies[4 * block])
    }
}

/// The blocks of a group where the moving elements are, kept while the same group is asked for.
struct PlacedGroup {
    group: usize,
    blocks: Placed,
}

impl PlacedGroup {
    fn none() -> Self {
        Self { group: usize::MAX, blocks: Placed::new() }
    }

    #[inline(always)]
    fn of<A: Arithmetic>(&mut self, all: &BodyGroups, group: usize, frames: &[Frame]) -> &Placed {
        if self.group != group {
            self.group = group;
            self.blocks.clear();
            let Group { blocks, stages, .. } = &all.groups[group];
            for block in blocks {
                self.blocks.push(block.placed::<A>(&frames[*stages]));
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

/// A robot among others, and the distance to keep (m).
#[derive(Clone, Copy)]
pub(super) struct Posed<'a> {
    pub carried: &'a [Carried],
    /// The moving elements.
    pub frames: &'a [Frame],
    pub others: &'a OtherBodies,
    /// Zero or more.
    pub margin: f64,
}

by_instructions! {
    fn are_clear(all: &BodyGroups, posed: &Posed<'_>) -> bool {
        let balls = all.balls(posed.frames);
        obstacles_are_clear::<A>(all, posed, &balls, true) && pairs_are_clear::<A>(all, posed, &balls)
    }
}

by_instructions! {
    fn are_clear_at_rest(all: &BodyGroups, posed: &Posed<'_>) -> bool {
        obstacles_are_clear::<A>(all, posed, &all.balls(posed.frames), false)
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
fn near_obstacles<A: Arithmetic>(
    all: &BodyGroups,
    posed: &Posed<'_>,
    balls: &Balls,
    moving: bool,
) -> SmallVec<[(usize, usize); 32]> {
    let Posed { others: OtherBodies { obstacles, .. }, margin, .. } = *posed;
    let mut near = SmallVec::new();
    let asked = |group: usize| group < all.groups.len() && all.is_moving(group) == moving;
    if let Some(index) = obstacles.index() {
        for group in (0..all.groups.len()).filter(|group| asked(*group)) {
            let (center, radius) = ball_in(balls, group);
            index.near_ball(&center, radius + margin, |obstacle| near.push((group, obstacle)));
        }
        return near;
    }
    for (obstacle, shape) in obstacles.iter().enumerate() {
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
fn obstacles_are_clear<A: Arithmetic>(all: &BodyGroups, posed: &Posed<'_>, balls: &Balls, moving: bool) -> bool {
    let Posed { carried, frames, others, margin } = *posed;
    let mut placed = PlacedGroup::none();
    for (group, obstacle) in near_obstacles::<A>(all, posed, balls, moving) {
        for (block, capsules) in placed.of::<A>(all, group, frames).iter().enumerate() {
            let clear = others.obstacles[obstacle].clear_lanes::<A>(capsules, margin);
            let part = (group, block, obstacle);
            if !all_clear(&clear) && !all.others_are_clear(part, &clear, carried, frames, (others, margin)) {
                return false;
            }
        }
    }
    true
}

#[inline(always)]
fn pairs_are_clear<A: Arithmetic>(all: &BodyGroups, posed: &Posed<'_>, balls: &Balls) -> bool {
    let Posed { carried, frames, others, margin } = *posed;
    let (mut one, mut other) = (PlacedGroup::none(), PlacedGroup::none());
    for pair in all.pairs_of(others) {
        let ((near, near_radius), (far, far_radius)) = (ball_in(balls, pair.near), ball_in(balls, pair.far));
        let enough = near_radius + far_radius + margin;
        if (near - far).norm_squared() > enough * enough * (1.0 + 1e-12) {
            continue;
        }
        let (near, far) = (one.of::<A>(all, pair.near, frames), other.of::<A>(all, pair.far, frames));
        for test in &pair.tests {
            let clear = clear_of_each_other::<A>(&near[test.block].repeated(test.lane), &far[test.far_block], margin);
            let clear = larger_lanes::<A>(clear, test.ignored);
            if !all_clear(&clear) && !all.solid_pairs_are_clear((pair, test), &clear, carried, frames, margin) {
                return false;
            }
        }
    }
    true
}

by_instructions! {
    fn near_groups(all: &BodyGroups, balls: &Balls, shape: &Shape, margin: f64) -> SmallVec<[usize; GROUPS]> {
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
    fn near_bodies(group: &Group, frame: &Frame, shape: &Shape, margin: f64) -> NearBodies {
        let mut near = NearBodies::new();
        for (bodies, block) in group.bodies.chunks(4).zip(&group.blocks) {
            let clear = shape.clear_lanes::<A>(&block.placed::<A>(frame), margin);
            if !all_clear(&clear) {
                near.extend(bodies.iter().zip(clear.0).filter(|(_, clear)| *clear == 0.0).map(|(body, _)| *body));
            }
        }
        near
    }
}
