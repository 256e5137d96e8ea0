//! The core through its public face. One binary holds all files: what they share is compiled and linked once.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that cannot go on should say so")]

mod common;

mod along_path_clear;
mod along_path_timed;
mod apps_paper;
mod batch;
mod best_posture;
mod choice;
mod circle_posture;
mod clear;
mod closed_form;
mod contract;
mod ease;
mod end_pieces;
mod ends;
mod first_branch;
mod ik;
mod jump;
mod kinematics;
mod layers;
mod manipulability;
mod map;
mod messages;
mod minimize;
mod mobile_base;
mod model_free;
mod motion;
mod obstacle;
mod pairs;
mod path;
mod plan_batch;
mod planning;
mod point_to_point;
mod polynomial;
mod readers;
mod redundancy;
mod region;
mod resolved_rate;
mod retime;
mod robots;
mod seed_index;
mod state_to_state;
mod tasks;
mod time_optimal;
mod tips;
mod touch;
mod track_clear;
mod track_tips;
mod tracking;
mod tracking_paper;
mod trajectory;
mod tree;
mod urdf;
mod znnbas;
