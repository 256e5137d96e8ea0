//! The parts that determine a robot; all else is derived from them. They are also its stored form.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::body::Bodies;
use super::description::Description;
use super::masses::Masses;
use super::off_chain::OffChain;
use super::pair_rule::PairRule;
use super::stance::Stance;
use super::visual::Visual;
use crate::error::Result;
use crate::math::Pose;

/// Chain, branches, base, tool and bodies.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Parts {
    pub description: Description,
    pub off_chain: Arc<OffChain>,
    /// Pose of the first link of the chain in the frame of the robot's base.
    pub base: Pose,
    /// Pose of the tool in the frame of the tip link.
    pub tool: Pose,
    pub bodies: Bodies,
    /// Rule for the pairs of links that are tested against each other.
    pub pairs: PairRule,
    /// Pairs of links that may touch, whatever the rule.
    pub may_touch: Vec<[String; 2]>,
    /// Named configurations.
    pub stances: Vec<Stance>,
    /// Links of further tips, beside that at the end of the chain.
    pub tips: Vec<String>,
    pub visuals: Vec<Visual>,
    pub masses: Arc<Masses>,
}

impl Parts {
    /// A chain with nothing else.
    pub fn of(description: Description) -> Self {
        let (base, tool) = (Pose::identity(), Pose::identity());
        Self {
            description,
            off_chain: Arc::default(),
            base,
            tool,
            bodies: Bodies::default(),
            pairs: PairRule::default(),
            may_touch: vec![],
            stances: vec![],
            tips: vec![],
            visuals: vec![],
            masses: Arc::default(),
        }
    }

    /// Checks all assumptions of the kernels.
    pub fn validate(&self) -> Result<()> {
        self.description.validate()?;
        self.off_chain.validate(&self.description)
    }
}
