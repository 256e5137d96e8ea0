//! Near pairs as rows: their distances, and how these change with the joints.

use nalgebra::Vector3;

use super::scene::Scene;
use crate::bodies::{BodyPair, BodyPoses};
use crate::math::MAX_DOF;

/// A pair that is near, linearised at a configuration.
#[derive(Debug, Clone)]
pub(crate) struct NearRow {
    pub(super) pair: BodyPair,
    /// Distance (m).
    pub distance: f64,
    /// Unit normal from the other body to the link's.
    pub normal: Vector3<f64>,
    /// Derivative of the distance by the joints (m/rad, m/m).
    pub gradient: [f64; MAX_DOF],
}

impl NearRow {
    /// The obstacle of the pair; `None` for two links.
    pub fn obstacle(&self) -> Option<usize> {
        match self.pair {
            BodyPair::Obstacle { obstacle, .. } => Some(obstacle),
            BodyPair::Bodies { .. } => None,
        }
    }
}

/// Finds near pairs; owns its scratch.
#[derive(Debug)]
pub(crate) struct NearRows {
    rows: Vec<NearRow>,
    /// Near pairs and their distances (m), before the nearest are chosen.
    pairs: Vec<(f64, BodyPair)>,
    poses: BodyPoses,
}

/// Rows of one configuration; pairs farther than these do not count.
pub(crate) const MOST_ROWS: usize = 24;

/// Near pairs for which room is reserved; more are allocated when they come.
pub(super) const MOST_RESERVED: usize = 4096;

impl NearRows {
    /// Scratch for configurations in `scene`.
    pub fn new(scene: &Scene<'_>) -> Self {
        let rest = vec![0.0; scene.robot().dof()];
        let pairs = Vec::with_capacity(scene.pairs().take(MOST_RESERVED).count());
        Self { rows: Vec::with_capacity(MOST_ROWS), pairs, poses: scene.poses(&rest) }
    }

    /// The rows found last, the nearest first.
    pub fn rows(&self) -> &[NearRow] {
        &self.rows
    }

    /// Finds the pairs that are nearer than `up_to` (m) at `q`.
    pub fn find(&mut self, scene: &Scene<'_>, q: &[f64], up_to: f64) {
        let Self { rows, pairs, poses } = self;
        rows.clear();
        pairs.clear();
        scene.write_poses(q, poses);
        scene.for_each_within(up_to, poses, |pair, distance| pairs.push((distance, pair)));
        let order = |(one, pair): &(f64, BodyPair), (other, with): &(f64, BodyPair)| {
            one.total_cmp(other).then_with(|| pair.order().cmp(&with.order()))
        };
        pairs.sort_unstable_by(order);
        for (distance, pair) in pairs.iter().take(MOST_ROWS) {
            let mut gradient = [0.0; MAX_DOF];
            let [_, normal] = scene.add_gradient(*pair, poses, 1.0, &mut gradient);
            rows.push(NearRow { pair: *pair, distance: *distance, normal, gradient });
        }
    }
}
