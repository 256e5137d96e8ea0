//! Closed-form inverse kinematics: all configurations of an arm of three to seven joints for a pose, and whether that list is
//! provably complete.
//!
//! Start with `six`: it determines the structure of a six-joint chain (`structure`) and its method (`spherical_wrist`,
//! `sliding_arm`, `three_parallel`, `general`) once, and solves poses. Arms of seven joints (`redundant`) reduce to six by
//! fixing one joint (`given_joint`), or are solved for a given arm angle (`arm_angle`); `pose_family` solves for many
//! parameter values at once, and `parameter_arcs`, `arm_angle_limits` and `limit_proof` bound the values that the limits
//! allow. Arms of five joints (`five_joints`) become six by adding a virtual joint; `planar` covers planar arms and SCARAs.
//! `position_arm` scans the configurations of an arm with few joints at a position.
//! The methods reduce to canonical subproblems (`subproblem`) and to zeros of trigonometric polynomials (`trigonometric`),
//! and yield candidates as cosines and sines; `verify` keeps those confirmed by forward kinematics. `arm` extracts the axes
//! from a robot's chain and converts axis values to joint values.
//!
//! Sources: Pieper (1968); Raghavan and Roth (1990); Manocha and Canny (1994); Elias and Wen, "IK-Geo" (arXiv 2211.05737).

mod angle;
mod angle_range;
mod arm;
mod arm_angle;
mod arm_angle_limits;
mod arm_branches;
mod axis_chain;
mod branches;
mod configurations;
mod elbow_distance;
mod enclosure;
mod five_joints;
mod four_angles;
mod general;
mod given_joint;
mod limit_proof;
mod orbit;
mod parameter_arcs;
mod planar;
mod pose_family;
mod position;
mod position_arm;
mod redundant;
#[cfg(test)]
mod seven_joint_arms;
mod six;
mod sliding_arm;
mod spherical_wrist;
mod structure;
mod subproblem;
mod three_parallel;
mod trigonometric;
mod verify;
mod wrist;

pub(crate) use angle_range::MOVED_BY_POLISHING;
pub(crate) use arm::{ClosedFormArm, NoClosedForm};
pub(crate) use arm_branches::ArmBranches;
pub(crate) use branches::{BranchFit, Doubt, MOST as MOST_CONFIGURATIONS, MOST_JOINTS};
pub(crate) use configurations::ArmConfigurations;
pub(crate) use parameter_arcs::ParameterArcs;
pub(crate) use pose_family::PoseFamily;
pub(crate) use position_arm::{PositionArm, SEEDS, Seed};
pub(crate) use redundant::FamilyLimits;
pub(crate) use verify::VERIFIED;
