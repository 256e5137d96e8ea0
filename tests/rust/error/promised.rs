//! Each error that `# Errors` of a public function names has a row here: a call that returns it, and the exact message.

mod calls;
mod dynamics;
mod motions;
mod robots;
mod samples;
mod settings;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path as FilePath;
use std::sync::Arc;

use crate::common::arms::two_arms;
use crate::common::{jumping, robot};
use crate::interface::{interface, type_of};
use crate::layers::imports::{Sources, rust_files};
use ikcore::batch::{BatchOptions, OnInvalid, PlanProblem, Targets, plan_batch, solve_batch};
use ikcore::calibration::{CalibrationOptions, Measured, PinholeCamera, calibrate};
use ikcore::constraint::Keep;
use ikcore::ik::{
    AllOptions, SelfMotionOptions, Solution, SolveOptions, self_motion, solve_all, solve_all_tips, solve_tips,
};
use ikcore::interrupt::{checkpoint, interruptible};
use ikcore::limits::{Field, Limits, Profile, Sinusoid, StartSlack, TipField};
use ikcore::load::{Dh, DhTable, covered_mesh, read_mesh};
use ikcore::manipulability::{Motion, manipulability, manipulability_all};
use ikcore::map::{MapGrid, MapLayout, MapOptions};
use ikcore::math::ticks::{ticks, ticks_of_path};
use ikcore::math::{Knots, Pose, pose};
use ikcore::motion::{ArmState, state_to_state, stop};
use ikcore::nalgebra::{Matrix3, Matrix4, Rotation3, Vector3};
use ikcore::objective::Bounds;
use ikcore::obstacle::{Obstacle, Obstacles, Scene, Surroundings};
use ikcore::path::{Circle, Curve, Hypotrochoid, Path, Plane, Polyline, Reference, Rose, Samples, Waypoints};
use ikcore::planning::{
    AlongPathOptions, ConstantLimits, Endpoint, JointPath, LineFrame, Move, MoveKind, MovesOptions, Plan,
    PointToPointOptions, SplineEnds, StraightLine, TimingOptions, TipPath, plan_along_path, plan_moves,
    plan_point_to_point, time_optimal, time_optimal_within,
};
use ikcore::posture::{CircleSwarm, Linkage, Measure, PostureOptions, best_posture};
use ikcore::rng;
use ikcore::robot::{BaseLimits, ChainBuilder, Drive, Joint, JointKind, LinkCapsule, MobileBase, Robot};
use ikcore::shape::{Cover, Geometry, Shape};
use ikcore::solver::{
    Algorithm, AnySolver, Apps, Bas, BeeColony, BeetleSwarm, BroydenBas, DerivativeFree, DifferentialEvolution,
    Firefly, Genetic, JacobianTranspose, LevenbergMarquardt, MultiStart, NewtonRaphson, Pso, PsoForm, Qpso,
    RestartRule, Schedule, StepSize, Stop, Unattended,
};
use ikcore::stored;
use ikcore::task::{Components, Criterion, First, Goal, NamedTask, Region, Subject, Target, Task, TaskKind, Tolerance};
use ikcore::tracking::{
    Antenna, Arrival, ControlSession, Controller, Fault, KinematicPlant, LowPass, ModelFreeOptions, Plant, Session,
    TargetFilter, TickRule, TipPaths, TipPose, TrackOptions, Znnbas, track, track_model_free, track_tips,
};
use ikcore::trajectory::Trajectory;
use ikcore::{Error, Result};
use serde::ser::SerializeTuple;

const NAN: f64 = f64::NAN;
const HALVES: [[f64; 3]; 2] = [[0.0; 3], [1.0, 0.0, 0.0]];

/// A function, the error that it promises, what it returned, and what that says.
type Row = (&'static str, &'static str, Option<Error>, &'static str);

macro_rules! promises {
    ($($function:literal $error:ident: $call:expr, $message:literal;)+) => {
        vec![$(($function, stringify!($error), $call.err(), $message)),+]
    };
}

use promises;
use samples::*;

fn rows() -> Vec<Row> {
    [
        motions::paths_and_trajectories(),
        robots::robots_and_shapes(),
        dynamics::masses_and_torques(),
        settings::tasks_limits_and_solvers(),
        calls::calls(),
    ]
    .concat()
}

/// Errors whose exact words other files of tests hold, as they need more than a call.
const ELSEWHERE: &[(&str, &[(&str, &str)])] = &[
    ("along_path_timed.rs", &[("plan_along_path", "NotFound")]),
    ("map.rs", &[("map_chunks", "Interrupted")]),
    ("a machine without threads", &[("plan_batch", "NoThreads")]),
];

#[test]
fn promised_errors_are_returned_in_exact_words() {
    let rows = rows();
    let mut wrong = vec![];
    for (function, name, error, message) in rows {
        let found = error.as_ref().map_or_else(|| "nothing".into(), |error| format!("{error:?}"));
        let told = error.map_or_else(String::new, |error| error.to_string());
        if !found.starts_with(name) || told != message {
            wrong.push(format!("{function}\t{name}\t{}\t{told}", found.split([' ', '{']).next().unwrap_or_default()));
        }
    }
    assert!(wrong.is_empty(), "\n{}\n", wrong.join("\n"));
}

#[test]
fn every_promised_error_has_a_row() {
    let rows = rows();
    let shown: BTreeSet<String> = rows.iter().map(|(function, name, ..)| format!("{function} {name}")).collect();
    let elsewhere: BTreeSet<String> =
        ELSEWHERE.iter().flat_map(|(_, all)| all.iter().map(|(function, name)| format!("{function} {name}"))).collect();
    let promised = promised();
    let known: BTreeSet<String> = shown.union(&elsewhere).cloned().collect();
    let (open, idle): (Vec<_>, Vec<_>) = (promised.difference(&known).collect(), known.difference(&promised).collect());
    assert!(open.is_empty() && idle.is_empty(), "without a row: {open:#?}\nnot promised: {idle:#?}");
}

/// The public functions of the core, each with an error that its documentation names.
fn promised() -> BTreeSet<String> {
    let root = FilePath::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let public: BTreeSet<String> =
        interface(&Sources::read(&root)).iter().filter_map(|line| function_of(line)).collect();
    let mut promised = BTreeSet::new();
    for path in rust_files(&root) {
        let text = fs::read_to_string(&path).expect("a readable file");
        let text = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
        let (mut of_type, mut named) = (None, vec![]);
        let mut lists = false;
        for line in text.lines() {
            let inner = line.trim_start();
            if line.starts_with("impl") {
                of_type = type_of(line);
            } else if let Some(comment) = inner.strip_prefix("///") {
                lists |= comment.trim() == "# Errors";
                if lists {
                    named.extend(errors_in(comment));
                }
            } else if !inner.starts_with('#') && lists {
                let of_type = of_type.as_ref().filter(|_| line.starts_with(' '));
                if let Some(name) = inner.strip_prefix("pub fn ").and_then(|rest| rest.split(['(', '<']).next()) {
                    let name = of_type.map_or_else(|| name.to_owned(), |of_type| format!("{of_type}::{name}"));
                    let known = public.contains(&name);
                    promised.extend(named.iter().filter(|_| known).map(|error| format!("{name} {error}")));
                }
                named.clear();
                lists = false;
            }
        }
    }
    promised
}

/// The name of a function in a line of the interface; that of a method with its type.
fn function_of(line: &str) -> Option<String> {
    let (path, item) = line.split_once(": fn ")?;
    let name = item.split(['(', '<']).next()?;
    let last = path.split(", ").next()?.rsplit("::").next()?;
    Some(if last == name { name.to_owned() } else { format!("{last}::{name}") })
}

/// The variants of `Error` that a line of documentation names.
fn errors_in(comment: &str) -> Vec<String> {
    let after = comment.split("Error::").skip(1);
    let names = after.map(|rest| rest.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default().to_owned());
    names.collect::<BTreeSet<_>>().into_iter().collect()
}
