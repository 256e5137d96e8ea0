//! Bodies by moving element, each group in a bounding ball, four bodies in the lanes of a register.

use nalgebra::Vector3;
use smallvec::SmallVec;

use super::carried_body::CarriedBody;
use crate::math::Frame;
use crate::math::arithmetic::NoFma;
use crate::math::f64x4::F64x4;
use crate::shape::BodyBlock;

/// The bodies of a robot by moving element, and the pairs of them that must not touch.
#[derive(Debug, Clone)]
pub(crate) struct BodyGroups {
    pub groups: Vec<Group>,
    /// Group, block and lane of each body.
    slots: Vec<[usize; 3]>,
    pub pairs: Vec<GroupPair>,
    /// Whether some bodies are no capsules.
    pub solids: bool,
}

/// All bodies of one moving element, in its frame.
#[derive(Debug, Clone)]
pub(crate) struct Group {
    pub stages: usize,
    pub center: [f64; 3],
    pub radius: f64,
    /// Indices of its bodies, four in a block.
    pub bodies: Vec<usize>,
    pub blocks: Vec<BodyBlock>,
}

/// Two groups, and the pairs of their bodies that must not touch.
#[derive(Debug, Clone)]
pub(crate) struct GroupPair {
    pub near: usize,
    pub far: usize,
    pub tests: Vec<BodyTest>,
}

/// Test of one body of the near group against a block of the far one.
#[derive(Debug, Clone)]
pub(crate) struct BodyTest {
    pub block: usize,
    pub lane: usize,
    pub far_block: usize,
    /// 1 in lanes that may touch, else 0.
    pub ignored: F64x4,
}

/// Balls of more groups than this are on the heap.
const GROUPS: usize = 12;

/// Bounding balls of groups, four in a block.
pub(crate) type Balls = SmallVec<[BodyBlock; GROUPS / 4]>;

impl BodyGroups {
    /// Groups of `carried`, of which these pairs must not touch. Bodies that no joint moves are not compared with obstacles each time.
    pub fn new(carried: &[CarriedBody], pairs: &[[usize; 2]]) -> Self {
        let mut stages: Vec<usize> = carried.iter().map(|body| body.stages).collect();
        stages.sort_unstable_by(|one, other| other.cmp(one));
        stages.dedup();
        let members = |stage: usize| (0..carried.len()).filter(move |i| carried[*i].stages == stage);
        let mut slots = vec![[0; 3]; carried.len()];
        let mut groups = vec![];
        for stage in stages {
            // Spheres first: blocks of spheres alone are cheaper.
            let mut bodies: Vec<usize> = members(stage).collect();
            bodies.sort_by_key(|i| carried[*i].ends[0] != carried[*i].ends[1]);
            for (i, body) in bodies.iter().enumerate() {
                slots[*body] = [groups.len(), i / 4, i % 4];
            }
            groups.push(Group::new(stage, bodies, carried));
        }
        let solids = carried.iter().any(|body| body.solid.is_some());
        let mut all = Self { groups, slots, pairs: vec![], solids };
        for [near, far] in pairs {
            all.forbid(all.slots[*near], all.slots[*far]);
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

    /// Number of groups.
    pub fn count(&self) -> usize {
        self.groups.len()
    }

    /// The group of a body.
    pub fn group_of(&self, body: usize) -> usize {
        self.slots[body][0]
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
        (frames[*stages].transform::<NoFma>(center).into(), *radius)
    }

    /// The balls around all groups, four in a block.
    #[inline(always)]
    pub fn balls(&self, frames: &[Frame]) -> Balls {
        let mut balls = Balls::new();
        for (i, group) in self.groups.iter().enumerate() {
            if i % 4 == 0 {
                balls.push(BodyBlock::SPHERES);
            }
            let center = frames[group.stages].transform::<NoFma>(&group.center);
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
    fn new(stages: usize, indices: Vec<usize>, carried: &[CarriedBody]) -> Self {
        let bodies: Vec<&CarriedBody> = indices.iter().map(|i| &carried[*i]).collect();
        let ends = || bodies.iter().flat_map(|body| body.ends.map(Vector3::from));
        let (low, high) = ends()
            .fold((Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY)), |(low, high), end| {
                (low.inf(&end), high.sup(&end))
            });
        let center = 0.5 * (low + high);
        let reach = |body: &&CarriedBody| {
            let far = body.ends.map(|end| (Vector3::from(end) - center).norm());
            far[0].max(far[1]) + body.radius
        };
        // Rounded up: the ball holds its bodies at any pose.
        let radius = bodies.iter().map(reach).fold(0.0, f64::max) * (1.0 + 1e-12) + 1e-12;
        let blocks = bodies.chunks(4).map(|four| {
            // Lanes without a body repeat the first.
            let body = |lane: usize| four.get(lane).unwrap_or(&four[0]);
            let lanes = |value: &dyn Fn(&CarriedBody) -> f64| F64x4(std::array::from_fn(|lane| value(body(lane))));
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
    pub fn body(&self, block: usize, lane: usize) -> usize {
        self.bodies.get(4 * block + lane).copied().unwrap_or(self.bodies[4 * block])
    }
}
