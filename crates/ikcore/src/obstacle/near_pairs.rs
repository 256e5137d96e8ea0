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

/// A ball around a group, at its place.
type Ball = (Vector3<f64>, f64);

/// What may be near, each with a lower bound of the distance (m); and the balls that the bounds come from.
struct Candidates {
    bounded: SmallVec<[(f64, Near); 128]>,
    balls: SmallVec<[Ball; 16]>,
}

impl Scene<'_> {
    /// The nearest pair, and its distance (m); of those that are equally near the first.
    pub(super) fn nearest_pair(&self, placement: &Placement) -> Option<(f64, BodyPair)> {
        let candidates = self.candidates(f64::INFINITY, placement);
        let count = candidates.bounded.len();
        // What is likely to be nearest comes first: it leaves out most of the others.
        let likely = (0..count).min_by(|i, j| candidates.bounded[*i].0.total_cmp(&candidates.bounded[*j].0));
        let mut least = self.fixed.map_or(f64::INFINITY, |(distance, _)| distance);
        let mut nearest: SmallVec<[(f64, BodyPair); 8]> = SmallVec::new();
        for i in likely.into_iter().chain((0..count).filter(|i| Some(*i) != likely)) {
            let enough = least + EQUALLY_NEAR;
            let Some(near) = self.within(&candidates, i, enough) else { continue };
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
        let candidates = self.candidates(up_to, placement);
        for i in 0..candidates.bounded.len() {
            let Some(near) = self.within(&candidates, i, up_to) else { continue };
            self.for_each_pair(near, |pair| {
                let distance = self.distance(pair, placement, up_to);
                if distance < up_to {
                    visit(pair, distance);
                }
            });
        }
    }

    /// What may be nearer than `up_to` (m), by the balls around groups and obstacles.
    fn candidates(&self, up_to: f64, placement: &Placement) -> Candidates {
        let groups = &self.bodies.groups;
        let balls: SmallVec<[Ball; 16]> =
            (0..groups.count()).map(|group| groups.ball(group, &placement.frames)).collect();
        let mut bounded = SmallVec::new();
        let mut keep = |bound: f64, one: Near| {
            if bound < up_to {
                bounded.push((bound, one));
            }
        };
        let gap = |(one, radius): Ball, (other, other_radius): Ball| (one - other).norm() - radius - other_radius;
        if self.others.itself {
            for (i, [one, other]) in self.bodies.pairs_of_groups().enumerate() {
                keep(gap(balls[one], balls[other]), Near::Groups(i));
            }
        }
        for group in (0..balls.len()).filter(|group| groups.is_moving(*group)) {
            for (obstacle, ball) in self.others.balls().enumerate() {
                keep(unless_inside(gap(balls[group], ball)), Near::Obstacle { group, obstacle });
            }
        }
        Candidates { bounded, balls }
    }

    /// Candidate `i` if it may be nearer than `up_to` (m).
    fn within(&self, candidates: &Candidates, i: usize, up_to: f64) -> Option<Near> {
        let (bound, near) = candidates.bounded[i];
        if bound > up_to {
            return None;
        }
        if let Near::Obstacle { group, obstacle } = near
            && self.bodies.groups.bodies_of(group).len() > 1
        {
            // The obstacle itself is farther away than the ball around it.
            let (center, radius) = candidates.balls[group];
            let distance = self.others.obstacles[obstacle].distance_to_segment(&[center, center], up_to + radius);
            return (unless_inside(distance - radius) <= up_to).then_some(near);
        }
        Some(near)
    }

    fn for_each_pair(&self, near: Near, mut visit: impl FnMut(BodyPair)) {
        match near {
            Near::Groups(i) => self.bodies.pairs_between(i).iter().copied().for_each(visit),
            Near::Obstacle { group, obstacle } => {
                let bodies = self.bodies.groups.bodies_of(group).iter().copied();
                let tested = bodies.filter(|body| !self.others.allowed.allow(*body, obstacle));
                tested.for_each(|body| visit(BodyPair::Obstacle { body, obstacle }));
            }
        }
    }
}

/// A bound on the distance of an obstacle. How deep a body reaches into a shape of many pieces is not bounded by how deep its ball
/// does.
fn unless_inside(bound: f64) -> f64 {
    if bound < 0.0 { f64::NEG_INFINITY } else { bound }
}
