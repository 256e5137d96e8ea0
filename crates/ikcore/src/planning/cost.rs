//! What a plan minimises.

use serde::{Deserialize, Serialize};

use super::motion_limits::MotionLimits;
use crate::robot::Robot;
use crate::wording::words;

/// What a plan minimises (Wang et al. 2019, eq. 8-10).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Cost {
    /// How long the motion takes (s): eq. (8) and (19).
    #[default]
    Time,
    /// How far all joints together travel (rad, m): eq. (9) and (20).
    JointTravel,
    /// How far the tip travels (m): eq. (10).
    TipTravel,
}

words!("objective": Cost { Time => "time", JointTravel => "joint_travel", TipTravel => "tip_travel" });

impl Cost {
    /// What it measures, in words.
    pub fn noun(self) -> &'static str {
        match self {
            Self::Time => "a duration",
            Self::JointTravel => "a joint travel",
            Self::TipTravel => "a tip travel",
        }
    }

    /// Its unit. (Joints that slide add their metres to the radians of the others.)
    pub fn unit(self) -> &'static str {
        match self {
            Self::Time => "s",
            Self::JointTravel => "rad",
            Self::TipTravel => "m",
        }
    }

    /// What is a lot of it for `robot` under `limits`: the measure of penalties.
    pub(super) fn scale(self, robot: &Robot, limits: &MotionLimits) -> f64 {
        let ranges = (0..limits.dof()).map(|j| limits.finite_range(j));
        match self {
            Self::Time => limits.whole_range_time(),
            Self::JointTravel => ranges.map(|(lower, upper)| upper - lower).sum(),
            Self::TipTravel => chain_length(robot),
        }
    }
}

/// Length of the chain from link to link (m).
fn chain_length(robot: &Robot) -> f64 {
    let poses = robot.link_poses(&vec![0.0; robot.dof()]).unwrap_or_default();
    poses.windows(2).map(|ends| (ends[1].translation.vector - ends[0].translation.vector).norm()).sum()
}
