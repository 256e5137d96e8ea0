//! Tests of the core through its public interface, in the rooms of `crates/ikcore/src`. One binary holds all files, so that shared
//! code is compiled and linked once.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that cannot go on should say so")]

mod common;
mod interface;
mod layers;
mod plain_words;
mod repeatable;

mod along_path {
    mod clear;
    mod reach;
    mod timed;
    mod tolerance;
}
mod approach_retreat {
    mod straight_ends;
}
mod batch {
    mod plan_batch;
    mod solve_batch;
}
mod calibration {
    mod arms;
    mod urdf;
    mod wrong_input;
}
mod closed_form {
    mod branches;
}
mod dynamics {
    mod laws;
    mod least_torque;
}
mod error {
    mod promised;
    mod wrong_input;
}
mod free_path {
    mod ends;
    mod point_to_point;
}
mod ik {
    mod choice;
    mod clear;
    mod first_branch;
    mod round_poses;
    mod self_motion;
    mod solve;
    mod tips;
}
mod kinematics {
    mod chains;
}
mod load {
    mod catalog;
    mod damaged_files;
    mod mesh_loader;
    mod urdf;
}
mod manipulability {
    mod index;
}
mod map {
    mod reach;
}
mod math {
    mod polynomial;
}
mod minimize;
mod motion {
    mod state_to_state;
}
mod obstacle {
    mod allowed_contacts;
    mod scene;
    mod without_robot;
}
mod path {
    mod curves;
}
mod posture {
    mod best_posture;
    mod circle;
}
mod robot {
    mod mobile_base;
    mod off_chain;
    mod pairs;
}
mod solver {
    mod contract;
    mod yuan_2016;
}
mod starts {
    mod index;
}
mod task {
    mod kinds;
    mod region;
}
mod timing {
    mod jerk_limits;
    mod retime;
    mod time_optimal;
    mod tolerance;
}
mod moves {
    mod at_limits;
    mod programs;
    mod several_tips;
    mod tasks;
    mod torque_limits;
}
mod tpbso {
    mod wang_2019;
}
mod tracking {
    mod cheng_2020;
    mod clear;
    mod ease;
    mod jump;
    mod keep;
    mod khan_2022;
    mod model_free;
    mod resolved_rate;
    mod settling;
    mod streams;
    mod tips;
    mod track;
    mod way_back;
    mod within_torques;
    mod work;
}
mod trajectory {
    mod piecewise;
}
