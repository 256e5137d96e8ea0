//! The planner that searches the ends' configurations first: those that lie nearest to each other in time, joined by a
//! straight line in joint space, or by a path around obstacles.
//!
//! | file | what |
//! |---|---|
//! | [`point_to_point`] | the planner |
//! | [`ends`] | pairs of configurations for start and end |
//! | [`branches`] | the same from all solutions of inverse kinematics |
//! | [`displacement`] | both moved along their self-motion, to the smallest largest displacement |
//! | [`straight`] | straight lines between pairs, of which the best is taken |
//! | [`line_timing`] | the quickest smooth timing of straight lines |
//! | [`among_obstacles`] | a path around obstacles, its timing certified |
//! | [`rrt_connect`] | two trees that grow towards each other, and shortcuts |

mod among_obstacles;
mod branches;
mod displacement;
mod ends;
mod line_timing;
mod point_to_point;
mod rrt_connect;
mod straight;

pub(super) use point_to_point::point_to_point;
