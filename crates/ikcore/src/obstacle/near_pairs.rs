//! The nearest pairs of bodies. Balls around the bodies of a moving element leave out most pairs.

use nalgebra::Vector3;
use smallvec::SmallVec;

use super::clear_groups::{near_bodies, near_groups};
use super::scene::Scene;
use crate::bodies::{Balls, BodyPair, BodyPoses};

/// Distances that differ by less (m) are equal but for rounding.
const EQUALLY_NEAR: f64 = 1e-9;

/// Distances (m) within which the obstacle nearest to bodies at rest is looked for, one after the other.
const LOOKED_WITHIN: [f64; 3] = [0.1, 1.0, f64::INFINITY];

/// A ball around a group, or an obstacle.
type Ball = (Vector3<f64>, f64);

/// The balls around all groups at a poses: one by one, and in the lanes of the registers.
struct GroupBalls {
    each: SmallVec<[Ball; 16]>,
    lanes: Balls,
}

impl Scene<'_> {
    /// The nearest pair, and its distance (m); of those that are equally near the first.
    pub(super) fn nearest_pair(&self, poses: &BodyPoses) -> Option<(f64, BodyPair)> {
        let mut least = self.fixed().map_or(f64::INFINITY, |(distance, _)| distance);
        let mut nearest: SmallVec<[(f64, BodyPair); 8]> = SmallVec::new();
        self.for_each_near(least + EQUALLY_NEAR, poses, |pair| {
            let distance = self.distance(pair, poses, least + EQUALLY_NEAR);
            if distance <= least + EQUALLY_NEAR {
                least = least.min(distance);
                nearest.push((distance, pair));
            }
            least + EQUALLY_NEAR
        });
        let equal = |distance: f64| distance <= least + EQUALLY_NEAR;
        let fixed = self.fixed().filter(|(distance, _)| equal(*distance)).map(|(_, pair)| pair);
        let moving = nearest.into_iter().filter(|(distance, _)| equal(*distance)).map(|(_, pair)| pair);
        fixed.or_else(|| moving.min_by_key(BodyPair::order)).map(|pair| (least, pair))
    }

    /// The nearest pair of an obstacle and a body that no joint moves.
    pub(super) fn nearest_fixed(&self) -> Option<(f64, BodyPair)> {
        // A pair found within a reach is the nearest of all if it is no farther than that.
        let found =
            LOOKED_WITHIN.iter().map(|reach| self.nearest_fixed_within(*reach).filter(|(least, _)| least <= reach));
        found.flatten().next()
    }

    /// [`nearest_fixed`](Self::nearest_fixed) where it is nearer than `reach` (m); otherwise any pair, or none.
    fn nearest_fixed_within(&self, reach: f64) -> Option<(f64, BodyPair)> {
        let (rest, obstacles) = (&self.bodies.rest, &self.others.obstacles);
        let mut nearest = (f64::INFINITY, None);
        for (body, carried) in self.bodies.carried.iter().enumerate().filter(|(_, carried)| carried.stages == 0) {
            let [from, to] = rest.segments[body];
            let (center, radius) = (0.5 * (from + to), 0.5 * (to - from).norm() + carried.reach);
            obstacles.each_near(&center, radius + reach, |obstacle| {
                let is_beyond = unless_inside(gap((center, radius), obstacles.ball(obstacle))) > nearest.0;
                if is_beyond || self.others.allowed.allow(body, obstacle) {
                    return;
                }
                let pair = BodyPair::Obstacle { body, obstacle };
                let distance = self.distance(pair, rest, nearest.0);
                if distance < nearest.0 {
                    nearest = (distance, Some(pair));
                }
            });
        }
        nearest.1.map(|pair| (nearest.0, pair))
    }

    /// Calls `visit` with each pair that is nearer than `up_to` (m), and its distance; not with bodies that no joint moves.
    pub(super) fn for_each_within(&self, up_to: f64, poses: &BodyPoses, mut visit: impl FnMut(BodyPair, f64)) {
        self.for_each_near(up_to, poses, |pair| {
            let distance = self.distance(pair, poses, up_to);
            if distance < up_to {
                visit(pair, distance);
            }
            up_to
        });
    }

    /// Calls `visit` with all pairs that are nearer than `up_to` (m), and some others; it returns the next `up_to`.
    fn for_each_near(&self, up_to: f64, poses: &BodyPoses, mut visit: impl FnMut(BodyPair) -> f64) {
        let groups = &self.bodies.groups;
        let each = (0..groups.count()).map(|group| groups.ball(group, &poses.frames)).collect();
        let balls = GroupBalls { each, lanes: groups.balls(&poses.frames) };
        let up_to = self.for_each_near_link(up_to, &balls, &mut visit);
        self.for_each_near_obstacle(up_to, &balls, poses, &mut visit);
    }

    /// The pairs of two links.
    fn for_each_near_link(&self, mut up_to: f64, balls: &GroupBalls, visit: &mut impl FnMut(BodyPair) -> f64) -> f64 {
        if !self.others.itself {
            return up_to;
        }
        let gap_of = |[one, other]: [usize; 2]| gap(balls.each[one], balls.each[other]);
        let mut gaps: SmallVec<[(f64, usize); 64]> = self.bodies.pairs_of_groups().map(gap_of).zip(0..).collect();
        // The nearest balls first: their bodies leave out most of the others.
        if let Some(first) = (0..gaps.len()).min_by(|i, j| gaps[*i].0.total_cmp(&gaps[*j].0)) {
            gaps.swap(0, first);
        }
        for (gap, i) in gaps {
            if gap <= up_to {
                self.bodies.pairs_between(i).iter().for_each(|pair| up_to = visit(*pair));
            }
        }
        up_to
    }

    /// The pairs of a link and an obstacle.
    fn for_each_near_obstacle(
        &self,
        mut up_to: f64,
        balls: &GroupBalls,
        poses: &BodyPoses,
        visit: &mut impl FnMut(BodyPair) -> f64,
    ) {
        let groups = &self.bodies.groups;
        for obstacle in self.obstacles_near(balls, up_to) {
            let shape = &self.others.obstacles[obstacle].shape;
            let mut visit = |body: usize, up_to: f64| {
                let may_touch = self.others.allowed.allow(body, obstacle);
                if may_touch { up_to } else { visit(BodyPair::Obstacle { body, obstacle }) }
            };
            if shape.has_lanes() && (0.0..f64::INFINITY).contains(&up_to) {
                for group in near_groups(groups, &balls.lanes, shape, up_to) {
                    let group = &groups.groups[group];
                    // Below zero once a body has been found that overlaps.
                    for body in near_bodies(group, &poses.frames[group.stages], shape, up_to.max(0.0)) {
                        up_to = visit(body, up_to);
                    }
                }
                continue;
            }
            for group in (0..groups.count()).filter(|group| groups.is_moving(*group)) {
                if self.may_be_near(balls.each[group], groups.bodies_of(group).len(), obstacle, up_to) {
                    groups.bodies_of(group).iter().for_each(|body| up_to = visit(*body, up_to));
                }
            }
        }
    }

    /// Obstacles that may be nearer than `up_to` (m) to a group that moves, and some others, in order.
    fn obstacles_near(&self, balls: &GroupBalls, up_to: f64) -> impl Iterator<Item = usize> + use<> {
        let obstacles = &self.others.obstacles;
        let mut near: SmallVec<[usize; 64]> = SmallVec::new();
        if obstacles.index().is_none() {
            return (0..obstacles.len()).chain(near);
        }
        for (group, (center, radius)) in balls.each.iter().enumerate() {
            if self.bodies.groups.is_moving(group) {
                obstacles.each_near(center, radius + up_to.max(0.0), |obstacle| near.push(obstacle));
            }
        }
        near.sort_unstable();
        near.dedup();
        (0..0).chain(near)
    }

    /// Whether one of `count` bodies in a ball may be nearer than `up_to` (m) to an obstacle.
    fn may_be_near(&self, (center, radius): Ball, count: usize, obstacle: usize, up_to: f64) -> bool {
        if unless_inside(gap((center, radius), self.others.obstacles.ball(obstacle))) > up_to {
            return false;
        }
        // The obstacle itself is farther away than the ball around it.
        let distance = || self.others.obstacles[obstacle].shape.distance_to_segment(&[center, center], up_to + radius);
        count == 1 || unless_inside(distance() - radius) <= up_to
    }
}

fn gap((one, radius): Ball, (other, other_radius): Ball) -> f64 {
    (one - other).norm() - radius - other_radius
}

/// A bound on the distance of an obstacle. How deep a body reaches into a shape of many pieces is not bounded by how deep its ball
/// does.
fn unless_inside(bound: f64) -> f64 {
    if bound < 0.0 { f64::NEG_INFINITY } else { bound }
}
