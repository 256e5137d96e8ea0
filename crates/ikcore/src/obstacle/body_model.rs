//! The bodies of a robot, prepared for scenes: made once, whatever the obstacles.

use std::sync::Arc;

use super::body_groups::BodyGroups;
use super::eight_bodies::EightBodies;
use super::placement::Placement;
use crate::robot::{Carried, Robot};

/// Two things that could touch.
#[derive(Debug, Clone, Copy)]
pub(super) enum BodyPair {
    /// A body and an obstacle.
    Obstacle { body: usize, obstacle: usize },
    /// Two bodies of the robot; `near` is nearer to the base. They have this number among the robot's pairs.
    Bodies { near: usize, far: usize, number: usize },
}

impl BodyPair {
    /// Sorts pairs: those of links in the order of the robot, then those of links and obstacles.
    pub fn order(&self) -> [usize; 3] {
        match self {
            Self::Bodies { number, .. } => [0, *number, 0],
            Self::Obstacle { body, obstacle } => [1, *body, *obstacle],
        }
    }
}

/// Bodies, their groups, and the pairs of bodies that must not touch.
#[derive(Debug)]
pub(super) struct BodyModel {
    pub carried: Vec<Carried>,
    pub groups: BodyGroups,
    /// The same in single precision.
    pub eight: EightBodies,
    /// In the order of the robot's pairs.
    pub pairs: Vec<BodyPair>,
    /// The bodies with all joints at zero: where those that no joint moves always are.
    pub rest: Placement,
    /// The pairs by pairs of groups.
    by_groups: Vec<([usize; 2], Vec<BodyPair>)>,
}

impl BodyModel {
    /// That of `robot`.
    pub fn of(robot: &Robot) -> Arc<Self> {
        robot.derived(|| Self::new(robot))
    }

    fn new(robot: &Robot) -> Self {
        let carried = robot.carried_bodies();
        let ordered = |[one, other]: [usize; 2]| {
            if carried[one].stages <= carried[other].stages { [one, other] } else { [other, one] }
        };
        let pairs: Vec<[usize; 2]> = robot.tested_bodies().into_iter().map(ordered).collect();
        let groups = BodyGroups::new(&carried, &pairs);
        let pairs: Vec<BodyPair> =
            (0..).zip(pairs).map(|(number, [near, far])| BodyPair::Bodies { near, far, number }).collect();
        let mut by_groups: Vec<([usize; 2], Vec<BodyPair>)> = vec![];
        for pair in &pairs {
            if let BodyPair::Bodies { near, far, .. } = pair {
                let of = [*near, *far].map(|body| groups.group_of(body));
                match by_groups.iter_mut().find(|(known, _)| *known == of) {
                    Some((_, pairs)) => pairs.push(*pair),
                    None => by_groups.push((of, vec![*pair])),
                }
            }
        }
        let mut rest = Placement::of(robot, carried.len());
        rest.update(robot, &carried, &vec![0.0; robot.dof()]);
        let eight = EightBodies::new(robot, &carried, &groups);
        Self { carried, groups, eight, pairs, rest, by_groups }
    }

    /// The pairs of groups with bodies that must not touch.
    pub fn pairs_of_groups(&self) -> impl Iterator<Item = [usize; 2]> {
        self.by_groups.iter().map(|(groups, _)| *groups)
    }

    /// The pairs of bodies of entry `i` of [`pairs_of_groups`](Self::pairs_of_groups).
    pub fn pairs_between(&self, i: usize) -> &[BodyPair] {
        &self.by_groups[i].1
    }
}
