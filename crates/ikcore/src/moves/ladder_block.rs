//! Blocks of a program: a joint move, and the paths of the tip after it.

use super::moving_tip::{MovingTip, led_by};
use super::outline::{Stage, StageKind};
use super::program::{JointGoal, Move, MoveKind};
use super::tool_path::ToolPath;

/// A block of a program.
#[derive(Debug)]
pub(super) struct LadderBlock<'a> {
    /// The joint move at its start; `None` for the block before the first joint move.
    pub goal: Option<(usize, &'a JointGoal)>,
    /// Number of the tip that it leads to a pose.
    pub tip: usize,
    /// Configuration with the joints that several tips share as in this block.
    pub stem: &'a [f64],
    /// The paths of the tip after it.
    pub paths: Vec<&'a ToolPath>,
}

/// The blocks of a program that begins at the configuration `start`.
pub(super) fn blocks<'a>(
    tips: &[MovingTip<'_>],
    stages: &'a [Stage],
    moves: &'a [Move],
    start: &'a [f64],
) -> Vec<LadderBlock<'a>> {
    let mut stem = start;
    let mut blocks = vec![LadderBlock { goal: None, tip: 0, stem, paths: vec![] }];
    for Stage { kind, .. } in stages {
        match kind {
            StageKind::Joints(index) => {
                if let MoveKind::Joints(goal) = &moves[*index].kind {
                    if let JointGoal::Configuration(q) = goal {
                        stem = q;
                    }
                    let tip = led_by(tips, &moves[*index])[0].number;
                    blocks.push(LadderBlock { goal: Some((*index, goal)), tip, stem, paths: vec![] });
                }
            }
            StageKind::Along(path) => {
                if let Some(block) = blocks.last_mut() {
                    block.paths.push(path);
                }
            }
            StageKind::Rest(..) => {}
        }
    }
    blocks
}
