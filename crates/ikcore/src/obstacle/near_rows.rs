//! Near pairs as rows: their distances, and how these change with the joints.

use nalgebra::Vector3;

use super::body_model::BodyPair;
use super::placement::Placement;
use super::scene::Scene;
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
    placement: Placement,
}

/// Rows of one configuration; pairs farther than these do not count.
const MOST_ROWS: usize = 24;

impl NearRows {
    /// For configurations in `scene`.
    pub(super) fn new(scene: &Scene<'_>) -> Self {
        let rest = vec![0.0; scene.robot().dof()];
        Self { rows: vec![], placement: scene.place(&rest) }
    }

    /// The rows found last, the nearest first.
    pub fn rows(&self) -> &[NearRow] {
        &self.rows
    }

    /// Finds the pairs that are nearer than `up_to` (m) at `q`.
    pub(super) fn find(&mut self, scene: &Scene<'_>, q: &[f64], up_to: f64) {
        let Self { rows, placement } = self;
        rows.clear();
        scene.place_into(q, placement);
        scene.for_each_within(up_to, placement, |pair, distance| {
            rows.push(NearRow { pair, distance, normal: Vector3::zeros(), gradient: [0.0; MAX_DOF] });
        });
        rows.sort_unstable_by(|one, other| {
            one.distance.total_cmp(&other.distance).then_with(|| one.pair.order().cmp(&other.pair.order()))
        });
        rows.truncate(MOST_ROWS);
        for row in rows {
            [_, row.normal] = scene.add_gradient(row.pair, placement, 1.0, &mut row.gradient);
        }
    }
}
