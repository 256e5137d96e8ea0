//! Errors in the words of another language: its own name for each setting.

use super::Error;
use crate::message::{Message, Setting};

impl Error {
    /// Returns the error with these words in place of the plain ones of each setting in its messages.
    pub fn worded(mut self, words: impl Fn(&Setting) -> String + Copy) -> Self {
        if let Self::InRow { error, .. } | Self::InProblem { error, .. } | Self::InFile { error, .. } = &mut self {
            **error = error.clone().worded(words);
        }
        for message in self.messages() {
            *message = message.worded(words).into();
        }
        self
    }

    /// Returns the parts that may name settings. The match names every variant, so that none is added without a decision here.
    fn messages(&mut self) -> Vec<&mut Message> {
        match self {
            Self::NotFinite { what, .. } | Self::WrongLength { what, .. } => vec![what],
            Self::OutOfRange { what, requirement, .. } => vec![what, requirement],
            Self::SeveralTips { call, remedy, .. } => vec![call, remedy],
            Self::UnsupportedLimit { method, remedy, .. } => vec![method, remedy],
            Self::OutsideLimits { what, excess, .. } => vec![what, excess],
            Self::NoCapsules { remedy, .. }
            | Self::InCollision { remedy, .. }
            | Self::NoPace { remedy, .. }
            | Self::UnknownJoint { remedy, .. } => vec![remedy],
            Self::ImpossibleInertia { what, .. } => vec![what],
            Self::InvalidRobot { problem, .. }
            | Self::NoDynamics { problem, .. }
            | Self::InvalidMeasurement { problem }
            | Self::Urdf { problem, .. }
            | Self::Srdf { problem, .. }
            | Self::Unreachable { problem, .. }
            | Self::NotFound { problem, .. }
            | Self::InvalidMove { problem, .. }
            | Self::NoUsableEnd { problems: problem, .. }
            | Self::Infeasible { problem }
            | Self::Contradiction { problem } => vec![problem],
            Self::Interrupted
            | Self::UnknownOption { .. }
            | Self::UnknownRobot { .. }
            | Self::UnknownLink { .. }
            | Self::UnknownTip { .. }
            | Self::NotHeld { .. }
            | Self::AmbiguousTip { .. }
            | Self::SingularMassMatrix { .. }
            | Self::Unreadable { .. }
            | Self::EmptyRange { .. }
            | Self::OutsideRegion { .. }
            | Self::NegativeLimit { .. }
            | Self::NotRigid { .. }
            | Self::WrongTarget { .. }
            | Self::InvalidObstacle { .. }
            | Self::InvalidPath { .. }
            | Self::NotIncreasing { .. }
            | Self::InvalidTrajectory { .. }
            | Self::InRow { .. }
            | Self::InProblem { .. }
            | Self::InFile { .. }
            | Self::NoThreads { .. }
            | Self::OutOfTurn { .. }
            | Self::PlantFailed { .. }
            | Self::Corrupt { .. } => vec![],
        }
    }
}
