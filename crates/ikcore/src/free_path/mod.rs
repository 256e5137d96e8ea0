//! Motions between two ends without a path between them, by the min-max planner: searches for the end configurations that are nearest to each other in time, and joins them by a
//! straight line in joint space or by a path around obstacles.
//!
//! | file | what |
//! |---|---|
//! | [`minmax_planner`] | the planner |
//! | [`pair_search`] | pairs of end configurations |
//! | [`branch_pairs`] | pairs from all inverse kinematics solutions |
//! | [`least_displacement`] | moves both ends along their self-motion to minimise the largest displacement |
//! | [`straight_line_plan`] | the best of the straight lines between pairs |
//! | [`among_obstacles`], [`path_search`] | the best certified motion around obstacles |
//! | [`certified_timing`] | timings of a path that keep the margin for certain |
//! | [`no_way`] | why there is no clear motion |
//! | [`moving_start`] | motions that begin at a velocity |
//! | [`line_check`] | whether a straight line can be part of a path |
//! | [`rrt_connect`], [`configuration_tree`] | RRT-Connect, half of whose attempts grow from little-tried nodes |
//! | [`joint_groups`] | joints that move independently of each other, such as each arm of two |
//! | [`narrow_way`] | motions within constraints that leave straight lines no room |
//! | [`shortening`] | shortcuts |
//! | [`refinement`], [`improvement`] | local search round a path, and round the best of many |

mod among_obstacles;
mod branch_pairs;
mod certified_timing;
mod configuration_tree;
mod end_pair;
mod improvement;
mod joint_groups;
mod least_displacement;
mod line_check;
mod minmax_planner;
mod moving_start;
mod narrow_way;
mod no_way;
mod pair_search;
mod path_search;
mod refinement;
mod rrt_connect;
mod shortening;
mod straight_line_plan;

pub(crate) use minmax_planner::point_to_point;
