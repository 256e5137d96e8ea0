//! Trajectory planning by beetle swarm optimisation (TPBSO): Wang et al. (2019), "A New Trajectory-Planning Beetle Swarm
//! Optimization Algorithm for Trajectory Planning of Robot Manipulators".
//!
//! | file | paper |
//! |---|---|
//! | [`via_point_planner`] | the point-to-point planner |
//! | [`path_planner`] | the planner along a path |
//! | [`published_settings`] | the search settings of both planners |
//! | [`rest_segment`] | the segments of eq. (3)-(6), their extremes in closed form |
//! | [`end_configurations`] | the redundancy at the ends; other robots by inverse kinematics |
//! | [`via_point_cost`] | the decision vector and cost from point to point, eq. (8)-(18) |
//! | [`collision_constraint`] | obstacles, eq. (14) and (18) |
//! | [`redundancy`] | the free orientations along a path, eq. (7) |
//! | [`path_cost`] | the decision vector and cost along a path, eq. (19)-(25) |
//! | [`penalties`] | the weights of eq. (15) and (25) |

mod collision_constraint;
mod end_configurations;
mod path_cost;
mod path_planner;
mod penalties;
mod published_settings;
mod redundancy;
mod rest_segment;
mod via_point_cost;
mod via_point_planner;

pub(crate) use path_planner::along_path;
pub(crate) use via_point_planner::point_to_point;
