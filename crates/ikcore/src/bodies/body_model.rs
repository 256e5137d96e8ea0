//! The collision model of an arm: made once, whatever the obstacles.

use super::body_groups::BodyGroups;
use super::body_poses::BodyPoses;
use super::carried_body::CarriedBody;
use super::eight_bodies::EightBodies;
use crate::kinematics::eight_frames::EightStages;
use crate::kinematics::link_tree::FrameBuffer;

/// Two bodies that could touch.
#[derive(Debug, Clone, Copy)]
pub(crate) enum BodyPair {
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
pub(crate) struct BodyModel {
    pub carried: Vec<CarriedBody>,
    pub groups: BodyGroups,
    /// Bodies and groups in single precision.
    pub eight: EightBodies,
    /// Pairs of bodies, in the order of the robot's pairs.
    pub pairs: Vec<BodyPair>,
    /// Poses with all joints at zero: bodies that no joint moves are always there.
    pub rest: BodyPoses,
    /// The pairs by pairs of groups.
    by_groups: Vec<([usize; 2], Vec<BodyPair>)>,
}

impl BodyModel {
    /// The model of an arm with these bodies, of which these pairs must not touch, and its moving elements, which are at `rest` with
    /// all joints at zero.
    pub fn new(carried: Vec<CarriedBody>, pairs: &[[usize; 2]], stages: EightStages, rest: FrameBuffer) -> Self {
        let ordered = |&[one, other]: &[usize; 2]| {
            if carried[one].stages <= carried[other].stages { [one, other] } else { [other, one] }
        };
        let pairs: Vec<[usize; 2]> = pairs.iter().map(ordered).collect();
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
        let mut rest = BodyPoses::with_room(rest, carried.len());
        rest.update_axes(&carried);
        let eight = EightBodies::new(stages, &carried, &groups);
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
