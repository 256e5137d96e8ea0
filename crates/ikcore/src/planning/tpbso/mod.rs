//! Trajectory planning by beetle swarm optimisation (TPBSO): Wang et al. (2019), "A New Trajectory-Planning Beetle Swarm
//! Optimization Algorithm for Trajectory Planning of Robot Manipulators".
//!
//! | file | paper |
//! |---|---|
//! | [`point_to_point`](mod@point_to_point) | the planner from end to end |
//! | [`along_path`](mod@along_path) | the planner along a path |
//! | [`published`] | the search of both |
//! | [`rest_segment`] | the segments of eq. (3)-(6), their extremes in closed form |
//! | [`end_configurations`] | the redundancy at the ends; any robot by inverse kinematics |
//! | [`via_point`] | the decision vector and cost from end to end, eq. (8)-(18) |
//! | [`collision_test`] | obstacles, eq. (14) and (18) |
//! | [`redundancy`] | the free orientations along a path, eq. (7) |
//! | [`path_cost`] | the decision vector and cost along a path, eq. (19)-(25) |
//! | [`penalties`] | the weights of eq. (15) and (25) |

mod along_path;
mod collision_test;
mod end_configurations;
mod path_cost;
mod penalties;
mod point_to_point;
mod published;
mod redundancy;
mod rest_segment;
mod via_point;

pub(super) use along_path::along_path;
pub(super) use point_to_point::point_to_point;
