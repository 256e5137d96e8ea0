//! The planner that searches the ends' configurations first: those that lie nearest to each other in time, joined by a
//! straight line in joint space, or by a path around obstacles.
//!
//! | file | what |
//! |---|---|
//! | [`minmax_planner`] | the planner |
//! | [`pair_search`] | pairs of configurations for start and end |
//! | [`branch_pairs`] | the same from all solutions of inverse kinematics |
//! | [`least_displacement`] | moves both ends along their self-motion, to the smallest maximum displacement |
//! | [`straight_line_plan`] | straight lines between pairs, of which the best is taken |
//! | [`line_timing`] | the quickest smooth timing of straight lines |
//! | [`among_obstacles`] | a path around obstacles, its timing certified |
//! | [`rrt_connect`] | two trees that grow towards each other, and shortcuts |

mod among_obstacles;
mod branch_pairs;
mod end_pair;
mod least_displacement;
mod line_timing;
mod minmax_planner;
mod pair_search;
mod rrt_connect;
mod straight_line_plan;

pub(super) use minmax_planner::point_to_point;
