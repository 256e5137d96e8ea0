//! What a program asks of the tip, before configurations are chosen.

use super::leg::Leg;
use super::program::{JointGoal, Move, MoveKind};
use super::tool_path::ToolPath;
use crate::error::{Error, Result};
use crate::math::Pose;
use crate::robot::Robot;

/// A part of a program, from rest to rest.
#[derive(Debug, Clone)]
pub(super) enum Step {
    /// The joint move of this index.
    Joints(usize),
    /// Moves of the tip that blend into one another.
    Along(ToolPath),
    /// Move `index` rests for this time (s): a wait, or a move of the tip to where it is.
    Rest(usize, f64),
}

/// The parts of a program that begins at the configuration `start`.
///
/// # Errors
/// [`Error::InvalidMove`].
pub(super) fn outline(robot: &Robot, moves: &[Move], start: &[f64]) -> Result<Vec<Step>> {
    let mut steps = vec![];
    let mut legs: Vec<Leg> = vec![];
    let mut pose: Pose = robot.tip(start).into();
    for (i, each) in moves.iter().enumerate() {
        let blends = each.blend > 0.0 && i + 1 < moves.len();
        match &each.kind {
            MoveKind::Wait(seconds) => steps.push(Step::Rest(i, *seconds)),
            MoveKind::Joints(goal) => {
                steps.push(Step::Joints(i));
                pose = match goal {
                    JointGoal::Configuration(q) => robot.tip(q).into(),
                    JointGoal::Pose(goal) => *goal,
                };
            }
            MoveKind::Line { .. } | MoveKind::Arc { .. } => match Leg::of(i, each, &pose)? {
                None if blends || !legs.is_empty() => {
                    let with_blend = if blends { i } else { i - 1 };
                    let problem = format!(
                        "its blend has no room, because {} ends where it begins: leave that out, or give no blend",
                        each.named(i)
                    );
                    return Err(Error::InvalidMove { what: moves[with_blend].named(with_blend), problem: problem.into() });
                }
                None => steps.push(Step::Rest(i, 0.0)),
                Some(leg) => {
                    pose = end_of(&leg, each);
                    legs.push(leg);
                }
            },
        }
        let goes_on = blends && each.is_cartesian() && moves[i + 1].is_cartesian();
        if blends && !goes_on {
            return Err(beside_a_joint_move(moves, i));
        }
        if !legs.is_empty() && !goes_on {
            steps.push(Step::Along(ToolPath::along(std::mem::take(&mut legs), moves)?));
        }
    }
    Ok(steps)
}

/// The pose at the end of a leg, as given.
fn end_of(leg: &Leg, each: &Move) -> Pose {
    match &each.kind {
        MoveKind::Arc { pose, angle: Some(_), .. } => Pose::from_parts(leg.pose(leg.length).translation, pose.rotation),
        MoveKind::Line { pose, .. } | MoveKind::Arc { pose, .. } => *pose,
        MoveKind::Joints(_) | MoveKind::Wait(_) => leg.pose(leg.length),
    }
}

fn beside_a_joint_move(moves: &[Move], i: usize) -> Error {
    let problem = format!(
        "its blend leads from or into a joint move ({}), and blends join lines and arcs: give no blend",
        moves[i + 1].named(i + 1)
    );
    Error::InvalidMove { what: moves[i].named(i), problem: problem.into() }
}
