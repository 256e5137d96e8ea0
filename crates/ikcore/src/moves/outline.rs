//! Stages of a program, before configurations are chosen.

use nalgebra::Rotation3;

use super::corner::Corner;
use super::leg::Leg;
use super::moving_tip::{MovingTip, led_by};
use super::program::{JointGoal, Move, MoveKind};
use super::tool_path::{ROUNDING, ToolPath};
use crate::error::{Error, Result};
use crate::math::Pose;
use crate::wording::number;

/// A part of a program, from rest to rest.
#[derive(Debug, Clone)]
pub(super) enum StageKind {
    /// The joint move of this index.
    Joints(usize),
    /// Moves of the tip that blend into one another.
    Along(ToolPath),
    /// Move `index` rests for this time (s): a wait, or a move of the tip to where it is.
    Rest(usize, f64),
}

/// A stage, and the radius (m) of the blend into the next one; 0: the arm stops.
#[derive(Debug, Clone)]
pub(super) struct Stage {
    pub kind: StageKind,
    pub blend: f64,
}

/// The parts of a program that begins at the configuration `start`.
///
/// # Errors
/// [`Error::InvalidMove`].
pub(super) fn outline(tips: &[MovingTip<'_>], moves: &[Move], start: &[f64]) -> Result<Vec<Stage>> {
    let mut stages: Vec<Stage> = vec![];
    let mut legs: Vec<Leg> = vec![];
    let poses_at = |q: &[f64]| -> Vec<Pose> { tips.iter().map(|tip| tip.frame(q).into()).collect() };
    let mut poses = poses_at(start);
    for (i, each) in moves.iter().enumerate() {
        let blend = if i + 1 < moves.len() { each.blend } else { 0.0 };
        let MovingTip { number: tip, task, .. } = &led_by(tips, each)[0];
        let pose = &mut poses[*tip];
        let mut push = |kind: StageKind, blend: f64| stages.push(Stage { kind, blend });
        match &each.kind {
            MoveKind::Wait(seconds) => push(StageKind::Rest(i, *seconds), 0.0),
            MoveKind::Joints(goal) => {
                push(StageKind::Joints(i), blend);
                match goal {
                    JointGoal::Configuration(q) => poses = poses_at(q),
                    JointGoal::Pose(goal) => *pose = *goal,
                }
            }
            MoveKind::Line { .. } | MoveKind::Arc { .. } => match Leg::of(i, each, pose, task)? {
                None => {
                    let before = i.checked_sub(1).filter(|before| moves[*before].blend > 0.0);
                    if let Some(with_blend) = before.or((blend > 0.0).then_some(i)) {
                        return Err(no_room(moves, with_blend, i));
                    }
                    push(StageKind::Rest(i, 0.0), 0.0);
                    if !task.is_whole() {
                        pose.rotation = orientation_of(each, pose);
                    }
                }
                Some(leg) => {
                    *pose = end_of(&leg, each);
                    require_length(moves, i, &leg)?;
                    // No smooth curve leads back: the arm stops there.
                    if legs.last().is_some_and(|before| Corner::turns_back(before, &leg)) {
                        push(StageKind::Along(ToolPath::along(*tip, std::mem::take(&mut legs), moves)?), 0.0);
                    }
                    legs.push(leg);
                    let goes_on = blend > 0.0 && moves[i + 1].is_cartesian();
                    if !goes_on {
                        push(StageKind::Along(ToolPath::along(*tip, std::mem::take(&mut legs), moves)?), blend);
                    }
                }
            },
        }
    }
    Ok(stages)
}

/// Checks that the blend at either end of a line or an arc is no longer than the move.
fn require_length(moves: &[Move], i: usize, leg: &Leg) -> Result<()> {
    let (before, after) = (i.checked_sub(1), Some(i).filter(|i| i + 1 < moves.len()));
    for with_blend in [before, after].into_iter().flatten().filter(|_| !leg.turns_on_the_spot()) {
        let radius = moves[with_blend].blend;
        if radius > 0.0 && leg.length_within(radius) > leg.length * (1.0 + ROUNDING) {
            let problem = format!(
                "its blend of {radius} m does not fit into {}, which is {} m long: make the blend smaller",
                moves[i].named(i),
                number(leg.length)
            );
            return Err(Error::InvalidMove { what: moves[with_blend].named(with_blend), problem: problem.into() });
        }
    }
    Ok(())
}

/// The pose at the end of a leg, as given.
fn end_of(leg: &Leg, each: &Move) -> Pose {
    match &each.kind {
        MoveKind::Arc { pose, angle: Some(_), .. } => Pose::from_parts(leg.pose(leg.length).translation, pose.rotation),
        MoveKind::Line { pose, .. } | MoveKind::Arc { pose, .. } => *pose,
        MoveKind::Joints(_) | MoveKind::Wait(_) => leg.pose(leg.length),
    }
}

/// The orientation that a move of the tip gives.
fn orientation_of(each: &Move, before: &Pose) -> Rotation3<f64> {
    match &each.kind {
        MoveKind::Line { pose, .. } | MoveKind::Arc { pose, .. } => pose.rotation,
        MoveKind::Joints(_) | MoveKind::Wait(_) => before.rotation,
    }
}

fn no_room(moves: &[Move], with_blend: usize, still: usize) -> Error {
    let problem = format!(
        "its blend has no room, because {} ends where it begins: leave that out, or give no blend",
        moves[still].named(still)
    );
    Error::InvalidMove { what: moves[with_blend].named(with_blend), problem: problem.into() }
}
