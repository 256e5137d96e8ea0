//! The nearest pairs of bodies. Balls around the bodies of a moving element leave out most pairs.

use nalgebra::Vector3;
use smallvec::SmallVec;

use super::body_model::BodyPair;
use super::placement::Placement;
use super::scene::Scene;

/// Distances that differ by less (m) are equal but for rounding.
const EQUALLY_NEAR: f64 = 1e-9;

/// Groups of bodies that may be near.
#[derive(Debug, Clone, Copy)]
enum Near {
    /// A group and an obstacle.
    Obstacle { group: usize, obstacle: usize },
    /// This entry of the pairs of groups.
    Groups(usize),
}

/// A lower bound of the distance (m) of what may be near.
type Bounded = SmallVec<[(f64, Near); 128]>;

impl Scene<'_> {
    /// The nearest pair, and its distance (m); of those that are equally near the first.
    pub(super) fn nearest_pair(&self, placement: &Placement) -> Option<(f64, BodyPair)> {
        let mut near = self.near(f64::INFINITY, placement);
        near.sort_unstable_by(|(a, _), (b, _)| a.total_cmp(b));
        let mut least = self.fixed.map_or(f64::INFINITY, |(distance, _)| distance);
        let mut nearest: SmallVec<[(f64, BodyPair); 8]> = SmallVec::new();
        for (bound, near) in near {
            if bound > least + EQUALLY_NEAR {
                break;
            }
            self.for_each_pair(near, |pair| {
                let distance = self.distance(pair, placement, least + EQUALLY_NEAR);
                if distance < least + EQUALLY_NEAR {
                    least = least.min(distance);
                    nearest.push((distance, pair));
                }
            });
        }
        let equal = |distance: f64| distance < least + EQUALLY_NEAR;
        let fixed = self.fixed.filter(|(distance, _)| equal(*distance)).map(|(_, pair)| pair);
        let moving = nearest.into_iter().filter(|(distance, _)| equal(*distance)).map(|(_, pair)| pair);
        fixed.or_else(|| moving.min_by_key(BodyPair::order)).map(|pair| (least, pair))
    }

    /// Calls `visit` with each pair that is nearer than `up_to` (m), and its distance; not with bodies that no joint moves.
    pub(super) fn for_each_within(&self, up_to: f64, placement: &Placement, mut visit: impl FnMut(BodyPair, f64)) {
        for (_, near) in self.near(up_to, placement) {
            self.for_each_pair(near, |pair| {
                let distance = self.distance(pair, placement, up_to);
                if distance < up_to {
                    visit(pair, distance);
                }
            });
        }
    }

    /// What may be nearer than `up_to` (m).
    fn near(&self, up_to: f64, placement: &Placement) -> Bounded {
        let groups = &self.bodies.groups;
        let balls: SmallVec<[(Vector3<f64>, f64); 16]> =
            (0..groups.count()).map(|group| groups.ball(group, &placement.frames)).collect();
        let mut near = Bounded::new();
        let mut keep = |bound: f64, one: Near| {
            if bound < up_to {
                near.push((bound, one));
            }
        };
        if self.others.itself {
            for (i, [one, other]) in self.bodies.pairs_of_groups().enumerate() {
                let ((one, radius), (other, other_radius)) = (balls[one], balls[other]);
                keep((one - other).norm() - radius - other_radius, Near::Groups(i));
            }
        }
        for group in (0..balls.len()).filter(|group| groups.is_moving(*group)) {
            let (center, radius) = balls[group];
            for (obstacle, shape) in self.others.obstacles.iter().enumerate() {
                let bound = shape.distance_to_segment(&[center, center], up_to + radius) - radius;
                // How deep a body reaches into a shape of many pieces is not bounded by how deep the ball does.
                keep(if bound < 0.0 { f64::NEG_INFINITY } else { bound }, Near::Obstacle { group, obstacle });
            }
        }
        near
    }

    fn for_each_pair(&self, near: Near, mut visit: impl FnMut(BodyPair)) {
        match near {
            Near::Groups(i) => self.bodies.pairs_between(i).iter().copied().for_each(visit),
            Near::Obstacle { group, obstacle } => {
                let bodies = self.bodies.groups.bodies_of(group);
                bodies.iter().for_each(|body| visit(BodyPair::Obstacle { body: *body, obstacle }));
            }
        }
    }
}
