//! Inverse kinematics in closed form: all configurations of an arm of three to seven joints for a pose, and whether they are surely
//! all.
//!
//! Read `six` first: it decides the structure of a chain of six joints (`structure`) and its method (`spherical_wrist`,
//! `sliding_arm`, `three_parallel`, `general`) once, and solves poses. Seven joints (`redundant`) become six by giving one of them
//! (`given_joint`), or are solved for a given arm angle (`arm_angle`); `pose_family` asks them for many values at once, and
//! what limits leave of the values is known from `parameter_arcs`, `arm_angle_limits` and `limit_proof`. Five (`five_joints`) become six by adding one; `planar` serves planar arms and SCARAs. The methods reduce to canonical subproblems (`subproblem`) and to zeros of
//! trigonometric polynomials (`trigonometric`), and yield candidates as cosines and sines; `verify` keeps those that forward
//! kinematics confirms. `arm` takes the axes from a robot's chain and converts joint values.
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
mod vector;
mod verify;
mod wrist;

pub(crate) use angle_range::MOVED_BY_POLISHING;
pub(crate) use arm::{ClosedFormArm, NoClosedForm};
pub(crate) use arm_branches::ArmBranches;
pub(crate) use branches::{BranchError, Doubt, MOST as MOST_CONFIGURATIONS, MOST_JOINTS};
pub(crate) use configurations::ArmConfigurations;
pub(crate) use parameter_arcs::ParameterArcs;
pub(crate) use pose_family::{FamilyLimits, PoseFamily};
pub(crate) use verify::VERIFIED;
