//! Each error that `# Errors` of a public function names has a row here: a call that returns it, and the exact message.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path as FilePath;
use std::sync::Arc;

use crate::common::robot;
use crate::interface::{interface, type_of};
use crate::layers::imports::{Sources, rust_files};
use crate::tips::two_arms;
use ikcore::batch::{BatchOptions, OnInvalid, PlanProblem, Targets, plan_batch, solve_batch};
use ikcore::ik::{AllOptions, SelfMotionOptions, Solution, SolveOptions, self_motion, solve_all, solve_tips};
use ikcore::interrupt::{checkpoint, interruptible};
use ikcore::limits::{Field, Limits, Profile, Sinusoid};
use ikcore::load::{Dh, DhTable, covered_mesh, read_mesh};
use ikcore::manipulability::{Motion, manipulability, manipulability_all};
use ikcore::map::{MapGrid, MapLayout, MapOptions};
use ikcore::math::ticks::{ticks, ticks_of_path};
use ikcore::math::{Knots, Pose, pose};
use ikcore::motion::{ArmState, state_to_state, stop};
use ikcore::nalgebra::{Matrix3, Matrix4, Rotation3, Vector3};
use ikcore::objective::Bounds;
use ikcore::obstacle::{Scene, Surroundings};
use ikcore::path::{Circle, Curve, Hypotrochoid, Path, Plane, Polyline, Reference, Rose, Samples, Waypoints};
use ikcore::planning::{
    AlongPathOptions, Endpoint, JointPath, LineFrame, Plan, PointToPointOptions, SplineEnds, StraightLine,
    TimingLimits, TimingOptions, TipPath, plan_along_path, plan_point_to_point, time_optimal,
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
use ikcore::task::{Components, Criterion, Goal, NamedTask, Region, Subject, Target, Task, TaskKind, Tolerance};
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

macro_rules! rows {
    ($($function:literal $error:ident: $call:expr, $message:literal;)+) => {
        vec![$(($function, stringify!($error), $call.err(), $message)),+]
    };
}

fn plane() -> Plane {
    Plane::xy([0.0; 3]).unwrap()
}

fn two() -> Robot {
    Robot::planar(&[1.0, 1.0]).unwrap()
}

fn arms() -> Robot {
    Robot::from_urdf_with(
        &two_arms(),
        &ikcore::load::UrdfOptions { tips: vec!["left_tool".into(), "right_tool".into()], ..Default::default() },
    )
    .unwrap()
}

fn constant(field: Field, value: f64) -> Limits {
    Limits::none_for(2).replace(field, vec![Profile::Constant(value)]).unwrap()
}

fn crossed() -> Limits {
    constant(Field::Lower, 1.0).replace(Field::Upper, vec![Profile::Constant(0.0)]).unwrap()
}

fn wide() -> Limits {
    constant(Field::Lower, -1000.0).replace(Field::Upper, vec![Profile::Constant(1000.0)]).unwrap()
}

fn at(q: &[f64]) -> Endpoint {
    Endpoint::Configuration(q.to_vec())
}

fn varying(field: Field) -> Limits {
    let sinusoid = Sinusoid { mean: 2.0, amplitude: 1.0, angular_frequency: 1.0, phase: 0.0 };
    Limits::none_for(2).replace(field, vec![Profile::Sinusoid(sinusoid)]).unwrap()
}

fn state(q: &[f64]) -> ArmState {
    ArmState { q: q.to_vec(), qd: vec![0.0; q.len()], qdd: vec![0.0; q.len()] }
}

fn moving(q: &[f64], qd: &[f64]) -> ArmState {
    ArmState { qd: qd.to_vec(), ..state(q) }
}

fn rated() -> Limits {
    constant(Field::Velocity, 1.0).replace(Field::Acceleration, vec![Profile::Constant(2.0)]).unwrap()
}

fn names(count: usize) -> Vec<String> {
    (0..count).map(|i| format!("joint_{}", i + 1)).collect()
}

fn twisted() -> Matrix3<f64> {
    Matrix3::identity() * 2.0
}

/// One joint about z.
fn hinge(joint: Joint) -> Result<Robot> {
    let mut chain = ChainBuilder::new("door", "frame");
    let index = chain.add_joint(joint);
    chain.moving(index, JointKind::Revolute, Vector3::z(), Drive::DIRECT);
    chain.link("leaf");
    chain.build()
}

fn leaf() -> Joint {
    Joint::new("hinge", JointKind::Revolute)
}

fn reference(rows: usize) -> Reference {
    Reference::new(0.1, (0..rows).map(|i| [1.5, 0.01 * i as f64, 0.0]).collect(), None).unwrap()
}

fn between(ends: &[Endpoint], start: &[f64]) -> Result<Plan> {
    let options = PointToPointOptions { limits: Some(rated()), ..Default::default() };
    plan_point_to_point(&two(), &Endpoint::Configuration(start.to_vec()), ends, &options, &mut Unattended)
}

fn far() -> Endpoint {
    Endpoint::Targets { tips: vec![], targets: [Target::Position([9.0, 0.0, 0.0])].into_iter().collect() }
}

fn along(points: &[[f64; 3]]) -> Result<Plan> {
    let path = TipPath::through(&Waypoints::new(points.to_vec(), None)?)?;
    plan_along_path(&two(), &path, &AlongPathOptions { limits: Some(rated()), ..Default::default() }, &mut Unattended)
}

fn session() -> Session {
    Session::new(&two(), &[0.5, 0.5], 0.1, &TrackOptions::default()).unwrap()
}

fn eased_session() -> Session {
    let limits = rated().replace(Field::Upper, vec![Profile::Constant(0.6)]).unwrap();
    Session::new(&two(), &[0.5, 0.5], 0.1, &TrackOptions { limits: Some(limits), ..Default::default() }).unwrap()
}

fn control() -> ControlSession {
    ControlSession::new(&Controller::default(), &[0.0; 2], 0.1, Limits::none_for(2), Tolerance::default(), 0).unwrap()
}

fn commanded() -> ControlSession {
    let mut session = control();
    session.command(&[1.0, 0.0, 0.0].into()).unwrap();
    session
}

struct Broken;

impl Plant for Broken {
    fn measure(&mut self, _: &[f64]) -> std::result::Result<TipPose, Fault> {
        Err(Fault("does not answer".into()))
    }
}

fn solid() -> Robot {
    two().with_capsules_along_links(0.05).unwrap()
}

fn ball(x: f64) -> Shape {
    Shape::sphere([x, 0.0, 0.0], 0.1).unwrap()
}

fn line() -> StraightLine {
    StraightLine { distance: 0.1, direction: None, frame: LineFrame::Tip, touch: vec![] }
}

/// A curve of a user.
#[derive(Debug)]
struct Own;

impl Curve for Own {
    fn duration(&self) -> f64 {
        1.0
    }

    fn position(&self, _: f64) -> [f64; 3] {
        [0.0; 3]
    }

    fn velocity(&self, _: f64) -> [f64; 3] {
        [0.0; 3]
    }
}

struct Unwritable;

impl serde::Serialize for Unwritable {
    fn serialize<S: serde::Serializer>(&self, _: S) -> std::result::Result<S::Ok, S::Error> {
        Err(serde::ser::Error::custom("no"))
    }
}

/// Bytes as they are.
struct Raw(Vec<u8>);

impl serde::Serialize for Raw {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let mut bytes = serializer.serialize_tuple(self.0.len())?;
        self.0.iter().try_for_each(|byte| bytes.serialize_element(byte))?;
        bytes.end()
    }
}

/// Bytes before those of a stored value: the format and a checksum.
const HEADER: usize = 9;

/// A stored circle with one of its numbers replaced.
fn spoiled_circle(number: f64, instead: f64) -> Result<Path> {
    let circle = Circle::new(Plane::xy([0.1234, 0.0, 0.0]).unwrap(), 0.7317, 1.7).unwrap();
    let turned =
        Path::new(circle).with_orientation(*Rotation3::from_axis_angle(&Vector3::z_axis(), 0.5).matrix()).unwrap();
    let mut payload = turned.to_bytes().unwrap().split_off(HEADER);
    let at = payload.windows(8).position(|window| window == number.to_le_bytes()).expect("the number");
    payload[at..at + 8].copy_from_slice(&instead.to_le_bytes());
    Path::from_bytes(&stored::to_bytes("path", &Raw(payload)).unwrap())
}

fn lost() -> Pose {
    pose::translation(NAN, 0.0, 0.0)
}

fn scaled() -> Pose {
    Pose::from_parts(Vector3::zeros().into(), Rotation3::from_matrix_unchecked(twisted()))
}

fn table() -> DhTable {
    DhTable::new(Dh::Standard, vec![0.1], vec![0.0], vec![0.0])
}

fn nameless() -> Robot {
    let mut chain = ChainBuilder::new("nameless", "base");
    for name in ["one", "two"] {
        let index = chain.add_joint(Joint::new(name, JointKind::Revolute));
        chain.moving(index, JointKind::Revolute, Vector3::z(), Drive::DIRECT);
        chain.fixed(pose::translation(1.0, 0.0, 0.0));
    }
    chain.link("tip");
    chain.build().unwrap()
}

fn adrift() -> Result<Robot> {
    let mut chain = ChainBuilder::new("adrift", "base");
    chain.fixed(lost());
    let index = chain.add_joint(leaf());
    chain.moving(index, JointKind::Revolute, Vector3::z(), Drive::DIRECT);
    chain.build()
}

fn huge_cover() -> Result<Cover> {
    let far = 1e200;
    let corners = vec![[0.0; 3], [far, 0.0, 0.0], [0.0, far, 0.0], [0.0, 0.0, far]];
    let shape = Shape::mesh(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap();
    let Geometry::Mesh(mesh) = shape.geometry() else { panic!("no mesh") };
    mesh.cover(4)
}

fn held() -> Robot {
    let joint = |name: &str, child: &str| {
        format!(
            r#"<link name="{child}"/><joint name="{name}" type="revolute"><parent link="base"/><child link="{child}"/>
            <limit lower="-1" upper="1" velocity="1" effort="1"/></joint>"#
        )
    };
    let urdf =
        format!(r#"<robot name="held"><link name="base"/>{}{}</robot>"#, joint("j", "arm"), joint("side", "flap"));
    Robot::from_urdf(&urdf, None, Some("arm")).unwrap()
}

fn on_wheels(far: f64) -> BaseLimits {
    BaseLimits { lower: vec![-far; 3], upper: vec![far; 3], velocity: vec![1.0; 3], acceleration: vec![1.0; 3] }
}

fn antennae() -> Znnbas {
    Znnbas { antenna: Antenna::Constant(vec![0.1; 3]), ..Znnbas::default() }
}

fn answered() -> ControlSession {
    let mut session = commanded();
    session.observe(&[1.0, 0.0, 0.0].into()).unwrap();
    session
}

fn posed() -> ControlSession {
    let mut session = control();
    session.command(&TipPose::from(&Pose::identity())).unwrap();
    session
}

fn turning() -> Session {
    let task = Task::new(TaskKind::Orientation, None, None, None).unwrap();
    Session::new(&two(), &[0.5, 0.5], 0.1, &TrackOptions { task: Some(task), ..TrackOptions::default() }).unwrap()
}

fn stamped(stamp: f64) -> Arrival {
    Arrival { stamp: Some(stamp), ..Target::Position([1.5, 0.5, 0.0]).into() }
}

/// Targets of both tips and of the pair, which contradict each other.
fn twice() -> Result<Solution> {
    let arms = arms();
    let tips = [Subject::Tip(0), Subject::Tip(0)].map(|subject| NamedTask {
        subject,
        task: None,
        tolerance: Tolerance::default(),
    });
    let targets = [Target::Position([0.5, 0.0, 0.5]), Target::Position([0.5, 0.0, 0.6])];
    solve_tips(&arms, &targets, &SolveOptions { tips: tips.to_vec(), ..SolveOptions::default() }, &mut Unattended)
}

fn paths_and_trajectories() -> Vec<Row> {
    let polyline = |waypoints: &[f64]| JointPath::polyline(names(2), waypoints, 0.1);
    let spline =
        |waypoints: &[f64], knots: Option<&[f64]>| JointPath::spline(names(2), waypoints, knots, SplineEnds::Natural);
    let timed = |limits: Limits, options: TimingOptions| {
        time_optimal(
            &polyline(&[0.0, 0.0, 1.0, 1.0]).unwrap(),
            &TimingLimits::new(&limits, "time_optimal").unwrap(),
            &options,
        )
    };
    let motion = || Trajectory::from_samples(names(1), &[0.0, 1.0], &[0.0, 1.0], None, None).unwrap();
    rows! {
        "Circle::new" OutOfRange: Circle::new(plane(), 0.0, 1.0), "diameter must be positive and finite, got 0";
        "Hypotrochoid::new" OutOfRange: Hypotrochoid::new(plane(), 1.0, 2.0, 0.1, 1.0), "inner_radius must be smaller than outer_radius, got 2";
        "Hypotrochoid::new" InvalidPath: Hypotrochoid::new(plane(), std::f64::consts::PI, 1.0, 0.1, 1.0), "path: outer_radius / inner_radius = 3.141592653589793 is no ratio of integers with a denominator up to 100, so the hypotrochoid does not close";
        "Polyline::letter_m" OutOfRange: Polyline::letter_m(&plane(), 0.0, 1.0, 1.0), "width must be positive and finite, got 0";
        "Polyline::pentagram" OutOfRange: Polyline::pentagram(&plane(), -1.0, 1.0), "radius must be positive and finite, got -1";
        "Plane::new" NotFinite: Plane::new([NAN, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]), "path center must be finite, but entry 0 is NaN";
        "Plane::new" InvalidPath: Plane::new([0.0; 3], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]), "path: axes a and b must be orthonormal, but |a| = 1, |b| = 1 and a.b = 1";
        "Plane::xy" NotFinite: Plane::xy([0.0, NAN, 0.0]), "path center must be finite, but entry 1 is NaN";
        "Plane::yz" NotFinite: Plane::yz([0.0, 0.0, NAN]), "path center must be finite, but entry 2 is NaN";
        "Polyline::new" InvalidPath: Polyline::new(&HALVES[..1], 1.0), "path: it needs at least 2 points, got 1";
        "Polyline::new" NotFinite: Polyline::new(&[[0.0; 3], [NAN; 3]], 1.0), "path points must be finite, but x of row 1 is NaN";
        "Polyline::new" OutOfRange: Polyline::new(&HALVES, 0.0), "duration must be positive and finite, got 0";
        "Reference::new" OutOfRange: Reference::new(0.0, HALVES.to_vec(), None), "dt must be positive and finite, got 0";
        "Reference::new" InvalidPath: Reference::new(0.1, vec![[0.0; 3]], None), "path: it needs at least 2 points, got 1";
        "Reference::new" WrongLength: Reference::new(0.1, HALVES.to_vec(), Some(vec![Matrix3::identity()])), "path rotations: expected 2, one a position, got 1";
        "Reference::new" NotFinite: Reference::new(0.1, vec![[0.0; 3], [NAN; 3]], None), "path points must be finite, but x of row 1 is NaN";
        "Reference::new" NotRigid: Reference::new(0.1, HALVES.to_vec(), Some(vec![Matrix3::identity(), twisted()])), "path rotation of row 1 is not a rigid transform: R'R differs from the identity by 3.000e0";
        "Reference::with_velocities" WrongLength: reference(2).with_velocities(vec![[0.0; 3]]), "path velocities: expected 2, one a position, got 1";
        "Reference::with_velocities" NotFinite: reference(2).with_velocities(vec![[0.0; 3], [NAN; 3]]), "path velocities must be finite, but x of row 1 is NaN";
        "Rose::new" OutOfRange: Rose::new(plane(), 1.0, 0, 1.0), "k must be at least 1 (a rose without petals is a circle), got 0";
        "Samples::from_positions" InvalidPath: Samples::from_positions(vec![0.0], vec![[0.0; 3]]), "path: it needs at least 2 points, got 1";
        "Samples::from_positions" WrongLength: Samples::from_positions(vec![0.0], HALVES.to_vec()), "path times: expected 2, one a point, got 1";
        "Samples::from_positions" NotFinite: Samples::from_positions(vec![0.0, NAN], HALVES.to_vec()), "path times must be finite, but row 1 is NaN";
        "Samples::from_positions" OutOfRange: Samples::from_positions(vec![1.0, 2.0], HALVES.to_vec()), "path times: row 0 must be 0, where the clock starts (take the first time from all), got 1";
        "Samples::from_positions" NotIncreasing: Samples::from_positions(vec![0.0, 0.0], HALVES.to_vec()), "path times must increase, but row 1 has 0 after 0";
        "Path::with_orientation" NotFinite: Path::new(Circle::new(plane(), 1.0, 1.0).unwrap()).with_orientation(Matrix3::identity() * NAN), "path orientation must be finite, but entry (0, 0) is NaN";
        "Path::with_orientation" NotRigid: Path::new(Circle::new(plane(), 1.0, 1.0).unwrap()).with_orientation(twisted()), "path orientation is not a rigid transform: R'R differs from the identity by 3.000e0";
        "Path::sample" OutOfRange: Path::new(Circle::new(plane(), 1.0, 1.0).unwrap()).sample(0.0), "dt must be positive and finite, got 0";
        "Path::from_bytes" Corrupt: Path::from_bytes(&[1, 2, 3]), "cannot restore path: it was stored in format 1 by an earlier version of beetle-ik, and this one reads format 3: make it anew";
        "Plan::from_bytes" Corrupt: Plan::from_bytes(&[1, 2, 3]), "cannot restore plan: it was stored in format 1 by an earlier version of beetle-ik, and this one reads format 3: make it anew";
        "Waypoints::new" InvalidPath: Waypoints::new(vec![[0.0; 3]], None), "path: it needs at least 2 points, got 1";
        "Waypoints::new" WrongLength: Waypoints::new(HALVES.to_vec(), Some(vec![Matrix3::identity()])), "path rotations: expected 2, one a position, got 1";
        "Waypoints::new" NotFinite: Waypoints::new(vec![[0.0; 3], [NAN; 3]], None), "path points must be finite, but x of row 1 is NaN";
        "Waypoints::new" NotRigid: Waypoints::new(HALVES.to_vec(), Some(vec![Matrix3::identity(), twisted()])), "path rotation of row 1 is not a rigid transform: R'R differs from the identity by 3.000e0";
        "TipPath::through" InvalidPath: TipPath::through(&Waypoints::new(vec![[0.0; 3]; 2], None).unwrap()), "path: point 1 repeats point 0: leave it out";
        "TipPath::sampled" InvalidPath: TipPath::sampled(vec![0.0, 1.0], vec![[0.0; 3]; 2], None), "path: it must lead somewhere, but it is 0 m long";
        "JointPath::polyline" WrongLength: polyline(&[0.0, 0.0, 1.0]), "waypoints: expected rows of 2 joints, got 3";
        "JointPath::polyline" NotFinite: polyline(&[0.0, 0.0, 1.0, NAN]), "waypoints must be finite, but joint 'joint_2' of row 1 is NaN";
        "JointPath::polyline" InvalidPath: polyline(&[0.0, 0.0, 0.0, 0.0]), "path: all waypoints are the same: give at least two that differ";
        "JointPath::polyline" OutOfRange: JointPath::polyline(names(1), &[0.0, 1.0], -1.0), "blend must be zero or more and finite, got -1";
        "JointPath::spline" WrongLength: spline(&[0.0, 0.0, 1.0], None), "waypoints: expected rows of 2 joints, got 3";
        "JointPath::spline" NotFinite: spline(&[0.0, 0.0, 1.0, NAN], None), "waypoints must be finite, but joint 'joint_2' of row 1 is NaN";
        "JointPath::spline" InvalidPath: spline(&[0.0, 0.0, 0.0, 0.0], None), "path: waypoint 1 is the same as waypoint 0: leave one of them out";
        "JointPath::spline" NotIncreasing: spline(&[0.0, 0.0, 1.0, 1.0, 2.0, 2.0], Some(&[0.0, 2.0, 1.0])), "knots must increase, but row 2 has 1 after 2";
        "time_optimal" Infeasible: timed(rated().replace(Field::Upper, vec![Profile::Constant(0.5)]).unwrap(), TimingOptions::default()), "infeasible: the path takes joint 'joint_1' to 1, beyond its upper limit 0.5";
        "time_optimal" OutOfRange: timed(rated(), TimingOptions { gridpoints: Some(0), ..Default::default() }), "gridpoints must be from 3 to 200000, got 0";
        "TimingLimits::new" UnsupportedLimit: TimingLimits::new(&varying(Field::Acceleration), "time_optimal"), "time_optimal cannot honour time-varying acceleration limits: when a point of the path is passed is what it looks for; give numbers";
        "TimingLimits::new" NegativeLimit: TimingLimits::new(&constant(Field::Acceleration, -1.0), "time_optimal"), "acceleration limit of joint '0' is -1 at t = 0 s: a limit cannot be negative";
        "TimingLimits::new" EmptyRange: TimingLimits::new(&crossed(), "time_optimal"), "joint '0': lower limit 1 is above upper limit 0";
        "Trajectory::new" InvalidTrajectory: Trajectory::new(vec![], vec![0.0, 1.0], vec![]), "trajectory: it needs at least 1 joint";
        "Trajectory::new" WrongLength: Trajectory::new(names(1), vec![0.0, 1.0], vec![]), "trajectory coefficients: expected 1 polynomials (1 segments of 1 joints), got 0";
        "Trajectory::new" NotFinite: Trajectory::new(names(1), vec![0.0, 1.0], vec![[NAN; 7]]), "trajectory coefficients must be finite, but power 0 of joint 'joint_1' in segment 0 is NaN";
        "Trajectory::new" OutOfRange: Trajectory::new(names(1), vec![1.0, 2.0], vec![[0.0; 7]]), "trajectory times: row 0 must be 0, where the clock starts (take the first time from all), got 1";
        "Trajectory::new" NotIncreasing: Trajectory::new(names(1), vec![0.0, 0.0], vec![[0.0; 7]]), "trajectory times must increase, but row 1 has 0 after 0";
        "Trajectory::from_samples" InvalidTrajectory: Trajectory::from_samples(names(1), &[0.0, 1.0], &[0.0, 1.0], None, Some(&[0.0, 0.0])), "trajectory: accelerations need velocities too";
        "Trajectory::at" WrongLength: motion().at(0.5, &mut [0.0; 2], &mut [0.0], &mut [0.0]), "state of the trajectory: expected 1 joints, got 2";
        "Trajectory::slowed" OutOfRange: motion().slowed(0.0), "factor must be positive and finite, got 0";
        "Trajectory::sample_times" OutOfRange: motion().sample_times(0.0), "dt must be positive and finite, got 0";
        "Trajectory::then" OutOfRange: motion().then(&motion(), -1.0), "pause must be from 0 to 1000000 s, got -1";
        "Trajectory::then" InvalidTrajectory: motion().then(&motion(), 0.0), "trajectory: joint 'joint_1' jumps from 1 to 0 at t = 1 s";
        "Knots::new" WrongLength: Knots::new("times", vec![0.0]), "times: expected at least 2, got 1";
        "Knots::new" NotFinite: Knots::new("times", vec![0.0, NAN]), "times must be finite, but row 1 is NaN";
        "Knots::new" OutOfRange: Knots::new("times", vec![1.0, 2.0]), "times: row 0 must be 0, where the clock starts (take the first time from all), got 1";
        "Knots::new" NotIncreasing: Knots::new("times", vec![0.0, 0.0]), "times must increase, but row 1 has 0 after 0";
        "ticks" OutOfRange: ticks(1.0, 1e-9), "dt must be at least 0.0000001 s to cover 1 s in 10 million ticks, got 0.000000001";
        "ticks_of_path" OutOfRange: ticks_of_path(1.0, 2.0), "dt must be at most 1 s, which the path takes, got 2";
        "from_quaternion" OutOfRange: pose::from_quaternion([0.0; 4], [0.0; 3]), "length of the quaternion must be positive and finite, got 0";
        "finite" NotFinite: pose::finite("point", [0.0, NAN, 0.0]), "point must be finite, but entry 1 is NaN";
        "from_matrix" NotFinite: pose::from_matrix("target", &(Matrix4::identity() * NAN)), "target must be finite, but entry (0, 0) is NaN";
        "from_matrix" NotRigid: pose::from_matrix("target", &(Matrix4::identity() * 2.0)), "target is not a rigid transform: its last row is (0, 0, 0, 2), not (0, 0, 0, 1)";
        "state_to_state" WrongLength: state_to_state(&state(&[0.0; 2]), &state(&[1.0]), &rated()), "q1: expected 2 joints, got 1";
        "state_to_state" NotFinite: state_to_state(&state(&[0.0, NAN]), &state(&[1.0; 2]), &rated()), "q0 must be finite, but joint '1' is NaN";
        "state_to_state" UnsupportedLimit: state_to_state(&state(&[0.0; 2]), &state(&[1.0; 2]), &varying(Field::Velocity)), "state_to_state cannot honour time-varying velocity limits: give numbers";
        "state_to_state" OutOfRange: state_to_state(&state(&[0.0; 2]), &state(&[1.0; 2]), &constant(Field::Velocity, 0.0)), "velocity limit of joint '0' must be positive, got 0";
        "state_to_state" NoPace: state_to_state(&state(&[0.0; 2]), &state(&[1.0; 2]), &Limits::none_for(2)), "joint '0' has neither a velocity nor an acceleration limit, so that nothing sets its pace: give a velocity limit";
        "state_to_state" OutsideLimits: state_to_state(&state(&[0.0; 2]), &state(&[1.0; 2]), &rated().replace(Field::Upper, vec![Profile::Constant(0.5)]).unwrap()), "q1: joint '0' at 1 is outside its limits [-inf, 0.5]";
        "state_to_state" Infeasible: state_to_state(&moving(&[0.4; 2], &[1.0; 2]), &state(&[0.2; 2]), &rated().replace(Field::Upper, vec![Profile::Constant(0.5)]).unwrap()), "infeasible: joint '0' would get to 0.6500, beyond its upper limit 0.5000: begin or end it slower, or farther from its limit";
        "state_to_state" InvalidTrajectory: state_to_state(&state(&[0.0; 2]), &state(&[0.0; 2]), &rated()), "trajectory: q0 and q1, with their velocities and accelerations, are the same state: nothing moves";
        "stop" InvalidTrajectory: stop(&state(&[0.0; 2]), &rated()), "trajectory: the arm is at rest: nothing has to stop";
        "Path::to_bytes" InvalidPath: Path::new(Own).to_bytes(), "path: a curve of your own cannot be stored; store its samples";
        "Path::from_bytes" OutOfRange: spoiled_circle(1.7, -1.0), "duration of the stored path must be positive and finite, got -1";
        "Path::from_bytes" NotFinite: spoiled_circle(0.1234, NAN), "stored path must be finite, but x at t = 0 s is NaN";
        "Path::from_bytes" NotRigid: spoiled_circle(0.5_f64.sin(), 2.0), "orientation of the stored path is not a rigid transform: R'R differs from the identity by 3.770e0";
        "Samples::from_poses" NotRigid: Samples::from_poses(vec![0.0, 1.0], &[Pose::identity(), scaled()]), "path rotation of row 1 is not a rigid transform: R'R differs from the identity by 3.000e0";
        "checked" NotFinite: pose::checked("tool", lost()), "tool must be finite, but entry (0, 3) is NaN";
    }
}

fn robots_and_shapes() -> Vec<Row> {
    let panda = robot("panda");
    let capsule =
        |link: &str, radius: f64, a: [f64; 3]| vec![LinkCapsule { link: link.into(), a, b: [0.0; 3], radius }];
    rows! {
        "Robot::named" UnknownRobot: Robot::named("pnda"), "no robot is named 'pnda' (did you mean 'panda'?); known robots: fr3, gen3, hydraulic3, iiwa14, iiwa7, kr210, kr210_yuan2016, panda, planar5, ur10, ur10e, ur3e, ur5, ur5e";
        "Robot::planar" OutOfRange: Robot::planar(&[0.0]), "length 0 of a planar arm must be positive and finite, got 0";
        "Robot::planar" WrongLength: Robot::planar(&[]), "lengths of a planar arm: expected at least 1, got 0";
        "Robot::from_urdf" Unreadable: Robot::from_urdf("none.urdf", None, None), "cannot read 'none.urdf': No such file or directory (os error 2)";
        "Robot::from_urdf" Urdf: Robot::from_urdf("<robot", None, None), "URDF line 1: not XML: the document does not have a root node";
        "Robot::from_urdf" UnknownLink: Robot::from_urdf(&two_arms(), None, Some("left_tol")), "robot 'pair' has no link 'left_tol' (did you mean 'left_tool'?); its links: floor, chest, camera, left_0, left_1, left_2, left_3, left_4, left_5, left_6, left_tool, left_badge, right_0, right_1, right_2, right_3, right_4, right_5, right_6, right_tool, right_badge";
        "Robot::from_urdf" AmbiguousTip: Robot::from_urdf(&two_arms(), None, None), "robot 'pair' ends in 5 links: say which one is the tip; leaves, by number of joints: left_tool (8), left_badge (8), right_tool (8), right_badge (8), camera (1)";
        "Robot::with_srdf" Unreadable: panda.with_srdf("none.srdf"), "cannot read 'none.srdf': No such file or directory (os error 2)";
        "Robot::with_srdf" Srdf: panda.with_srdf("<srdf/>"), "SRDF line 1: the outermost element must be <robot>, found <srdf>";
        "read_mesh" Unreadable: read_mesh(FilePath::new("none.stl"), [1.0; 3]), "cannot read 'none.stl': No such file or directory (os error 2)";
        "Robot::with_attached" UnknownLink: panda.with_attached("hnd", &ball(0.0), &[], None), "robot 'panda' has no link 'hnd'; its links: base, link_1, link_2, link_3, link_4, link_5, link_6, link_7, flange";
        "Robot::with_attached" InvalidObstacle: panda.with_attached("flange", &Shape::half_space([0.0, 0.0, 1.0], 0.0).unwrap(), &[], None), "a HalfSpace cannot be attached: a Sphere, Box, Capsule, Cylinder, Ellipsoid or ConvexMesh can";
        "Robot::with_attached" InvalidRobot: panda.with_attached("flange", &ball(0.0), &[], Some("link_1")), "robot 'panda': two links are named 'link_1'";
        "Robot::fk" WrongLength: panda.fk(&[0.0; 6]), "joint angles of robot 'panda': expected 7 joints, got 6";
        "Robot::fk" NotFinite: panda.fk(&[NAN; 7]), "joint angles must be finite, but joint 'panda_joint1' is NaN";
        "Robot::jacobian" WrongLength: panda.jacobian(&[0.0; 6]), "joint angles of robot 'panda': expected 7 joints, got 6";
        "Robot::jacobian" NotFinite: panda.jacobian(&[NAN; 7]), "joint angles must be finite, but joint 'panda_joint1' is NaN";
        "Robot::link_poses" WrongLength: panda.link_poses(&[0.0; 6]), "joint angles of robot 'panda': expected 7 joints, got 6";
        "Robot::link_poses" NotFinite: panda.link_poses(&[NAN; 7]), "joint angles must be finite, but joint 'panda_joint1' is NaN";
        "Robot::fk_all" WrongLength: panda.fk_all(&[0.0; 8]), "joint angles of robot 'panda': expected rows of 7 joints, got 8";
        "Robot::fk_all" NotFinite: panda.fk_all(&[NAN; 7]), "joint angles must be finite, but joint 'panda_joint1' of configuration 0 is NaN";
        "Robot::with_capsules" UnknownLink: panda.with_capsules(capsule("hnd", 0.1, [0.0; 3])), "robot 'panda' has no link 'hnd'; its links: base, link_1, link_2, link_3, link_4, link_5, link_6, link_7, flange";
        "Robot::with_capsules" NotFinite: panda.with_capsules(capsule("flange", 0.1, [NAN; 3])), "capsule 0 of link 'flange' must be finite, but coordinate x of end a is NaN";
        "Robot::with_capsules" OutOfRange: panda.with_capsules(capsule("flange", -0.1, [0.0; 3])), "radius of capsule 0 of link 'flange' must be zero or more and finite, got -0.1";
        "Robot::with_capsules_along_links" OutOfRange: panda.with_capsules_along_links(-0.1), "radius must be zero or more and finite, got -0.1";
        "Robot::with_capsules_along_links" SeveralTips: arms().with_capsules_along_links(0.1), "with_capsules_along_links takes robots with one tip; this one has left_tool and right_tool: load the robot with one of them as its tip";
        "ChainBuilder::build" InvalidRobot: ChainBuilder::new("empty", "base").build(), "robot 'empty': no joint moves between base and tip";
        "ChainBuilder::build" EmptyRange: hinge(leaf().with_range(1.0, -1.0)), "joint 'hinge': lower limit 1 is above upper limit -1";
        "ChainBuilder::build" NegativeLimit: hinge(leaf().with_velocity(-1.0)), "velocity limit of joint 'hinge' is -1 at t = 0 s: a limit cannot be negative";
        "ChainBuilder::build" OutOfRange: hinge(leaf().with_range(NAN, 1.0)), "lower limit of joint 'hinge' must be a number below infinity, got NaN";
        "Robot::with_held" NotHeld: panda.with_held([("finger", 0.0)]), "robot 'panda' holds no joint 'finger'; joints that it holds: none";
        "Robot::link_fk" UnknownLink: panda.link_fk("hnd", &[0.0; 7]), "robot 'panda' has no link 'hnd'; its links: base, link_1, link_2, link_3, link_4, link_5, link_6, link_7, flange";
        "Robot::link_fk_all" UnknownLink: panda.link_fk_all("hnd", &[0.0; 7]), "robot 'panda' has no link 'hnd'; its links: base, link_1, link_2, link_3, link_4, link_5, link_6, link_7, flange";
        "Robot::link_jacobian_all" UnknownLink: panda.link_jacobian_all("hnd", &[0.0; 7]), "robot 'panda' has no link 'hnd'; its links: base, link_1, link_2, link_3, link_4, link_5, link_6, link_7, flange";
        "Robot::with_errors" OutOfRange: panda.with_errors(-1.0, 0.0, &mut rng::stream(0, 0)), "length must be zero or more and finite, got -1";
        "Robot::with_errors" SeveralTips: arms().with_errors(0.0, 0.0, &mut rng::stream(0, 0)), "with_errors takes robots with one tip; this one has left_tool and right_tool: load the robot with one of them as its tip";
        "Robot::with_mobile_base" WrongLength: panda.with_mobile_base(MobileBase::Planar, &BaseLimits { lower: vec![0.0], upper: vec![], velocity: vec![], acceleration: vec![] }), "lower of a planar base: expected 3 joints: base_x, base_y, base_yaw, got 1";
        "Robot::with_tool" SeveralTips: arms().with_tool(Pose::identity()), "with_tool takes robots with one tip; this one has left_tool and right_tool: load the robot with one of them as its tip";
        "Robot::with_limits" EmptyRange: panda.with_limits(|_, joint| (joint.lower, joint.upper) = (1.0, -1.0)), "joint 'panda_joint1': lower limit 1 is above upper limit -1";
        "Robot::with_limits" NegativeLimit: panda.with_limits(|_, joint| joint.velocity = -1.0), "velocity limit of joint 'panda_joint1' is -1 at t = 0 s: a limit cannot be negative";
        "Robot::random_configurations" OutOfRange: panda.random_configurations(usize::MAX, &mut rng::stream(0, 0)), "number of configurations must be small enough for memory, got 18446744073709552000";
        "Robot::with_collision_pairs" UnknownLink: panda.with_collision_pairs(vec![["hnd".into(), "link_1".into()]]), "robot 'panda' has no link 'hnd'; its links: base, link_1, link_2, link_3, link_4, link_5, link_6, link_7, flange";
        "Robot::with_collision_pairs" Contradiction: panda.with_collision_pairs(vec![["link_1".into(), "link_1".into()]]), "link 'link_1' cannot be tested against itself";
        "Robot::from_bytes" Corrupt: Robot::from_bytes(&[1, 2, 3]), "cannot restore robot: it was stored in format 1 by an earlier version of beetle-ik, and this one reads format 3: make it anew";
        "Robot::tip_number" UnknownTip: arms().tip_number("lft_tool"), "robot 'pair' has no tip 'lft_tool' (did you mean 'left_tool'?); its tips: left_tool, right_tool";
        "Robot::require_one_tip" SeveralTips: arms().require_one_tip("track"), "track takes robots with one tip; this one has left_tool and right_tool: load the robot with one of them as its tip";
        "manipulability" SeveralTips: manipulability(&arms(), Motion::Position, &[0.0; 16]), "manipulability takes robots with one tip; this one has left_tool and right_tool: load the robot with one of them as its tip";
        "manipulability_all" SeveralTips: manipulability_all(&arms(), Motion::Position, &[0.0; 16]), "manipulability takes robots with one tip; this one has left_tool and right_tool: load the robot with one of them as its tip";
        "Scene::new" NoCapsules: Scene::new(&panda, vec![ball(2.0)]), "robot 'panda' has no capsules, so that nothing is known of the room it takes up: load its URDF with shapes fitted to its meshes, or give it capsules";
        "Scene::new" InvalidObstacle: Scene::new(&solid(), vec![ball(2.0).with_touch(vec!["hnd".into()])]), "touch of obstacle 0 (Sphere): robot 'planar2' has no link 'hnd'; links with bodies: link_1, link_2";
        "Scene::nearest" WrongLength: Scene::new(&solid(), vec![ball(3.0)]).unwrap().nearest(&[0.0]), "joint angles of robot 'planar2': expected 2 joints, got 1";
        "Scene::nearest" NotFinite: Scene::new(&solid(), vec![ball(3.0)]).unwrap().nearest(&[NAN; 2]), "joint angles must be finite, but joint 'joint_1' is NaN";
        "Scene::which_are_clear" OutOfRange: Scene::new(&solid(), vec![ball(3.0)]).unwrap().which_are_clear(&[0.0; 2], -1.0), "margin must be zero or more and finite, got -1";
        "Surroundings::clear_space" OutOfRange: Surroundings { margin: Some(-1.0), ..Default::default() }.clear_space(&solid()), "margin must be zero or more and finite, got -1";
        "Surroundings::clear_space" Contradiction: Surroundings { margin: Some(0.1), ..Default::default() }.clear_space(&solid()), "a margin needs obstacles (perhaps none) or self-collision";
        "Shape::sphere" NotFinite: Shape::sphere([NAN; 3], 1.0), "center must be finite, but coordinate x is NaN";
        "Shape::sphere" OutOfRange: Shape::sphere([0.0; 3], 0.0), "radius of the sphere must be positive and finite, got 0";
        "Shape::capsule" NotFinite: Shape::capsule([NAN; 3], [0.0; 3], 1.0), "a must be finite, but coordinate x is NaN";
        "Shape::capsule" OutOfRange: Shape::capsule([1.0; 3], [0.0; 3], 0.0), "radius of the capsule must be positive and finite, got 0";
        "Shape::cylinder" NotFinite: Shape::cylinder([NAN; 3], [0.0, 0.0, 1.0], 1.0, 1.0), "center must be finite, but coordinate x is NaN";
        "Shape::cylinder" OutOfRange: Shape::cylinder([0.0; 3], [0.0; 3], 1.0, 1.0), "length of the axis of the cylinder must be positive and finite, got 0";
        "Shape::half_space" NotFinite: Shape::half_space([NAN; 3], 0.0), "normal of the half-space must be finite, but coordinate x is NaN";
        "Shape::half_space" OutOfRange: Shape::half_space([0.0; 3], 0.0), "length of the normal of the half-space must be positive and finite, got 0";
        "Shape::convex_mesh" NotFinite: Shape::convex_mesh(&[[NAN; 3]; 4]), "points of the convex mesh must be finite, but coordinate x of point 0 is NaN";
        "Shape::convex_mesh" InvalidObstacle: Shape::convex_mesh(&[[0.0; 3]]), "a convex mesh needs at least 4 points that do not lie in a plane, got 1";
        "Shape::mesh" NotFinite: Shape::mesh(vec![[NAN; 3]; 3], vec![[0, 1, 2]]), "vertices of the mesh must be finite, but coordinate x of point 0 is NaN";
        "Shape::mesh" InvalidObstacle: Shape::mesh(vec![[0.0; 3]; 3], vec![[0, 1, 3]]), "face 0 of the mesh names vertex 3, but it has 3 (from 0)";
        "Shape::point_cloud" NotFinite: Shape::point_cloud(vec![[NAN; 3]], 0.1), "points of the point cloud must be finite, but coordinate x of point 0 is NaN";
        "Shape::point_cloud" OutOfRange: Shape::point_cloud(vec![[0.0; 3]], -0.1), "radius of the point cloud must be zero or more and finite, got -0.1";
        "Shape::point_cloud" InvalidObstacle: Shape::point_cloud(vec![], 0.1), "a point cloud needs at least one point, got none";
        "Robot::from_dh" WrongLength: Robot::from_dh("arm", &DhTable { d: vec![], ..table() }), "d in the DH table of robot 'arm': expected 1 entries, as in a, got 0";
        "Robot::from_dh" NotFinite: Robot::from_dh("arm", &DhTable { alpha: vec![NAN], ..table() }), "alpha in the DH table of robot 'arm' must be finite, but entry 0 is NaN";
        "Robot::with_base" NotFinite: panda.with_base(lost()), "base must be finite, but entry (0, 3) is NaN";
        "Robot::with_tool" NotFinite: panda.with_tool(lost()), "tool must be finite, but entry (0, 3) is NaN";
        "Robot::with_capsules_along_links" InvalidRobot: nameless().with_capsules_along_links(0.1), "robot 'nameless': no link is named between moving elements 1 and 2, so that none can carry a capsule: name one there";
        "ChainBuilder::build" NotFinite: adrift(), "fixed transform must be finite, but entry (0, 3) is NaN";
        "Robot::with_held" NotFinite: held().with_held([("side", NAN)]), "held joints must be finite, but joint 'side' is NaN";
        "Robot::with_held" OutsideLimits: held().with_held([("side", 2.0)]), "hold: joint 'side' at 2 is outside its limits [-1, 1]";
        "Robot::with_mobile_base" OutOfRange: panda.with_mobile_base(MobileBase::Planar, &on_wheels(f64::INFINITY)), "lower limit of joint 'base_x' must be finite: configurations are drawn from the range, got -inf";
        "Robot::with_mobile_base" InvalidRobot: panda.with_mobile_base(MobileBase::Planar, &on_wheels(1.0)).unwrap().with_mobile_base(MobileBase::Planar, &on_wheels(1.0)), "robot 'panda': two joints are named 'base_x'";
        "Mesh::cover" OutOfRange: huge_cover(), "radius of the capsule must be positive and finite, got inf";
        "covered_mesh" Unreadable: covered_mesh(FilePath::new("none.stl"), [1.0; 3], 4), "cannot read 'none.stl': No such file or directory (os error 2)";
        "Shape::cuboid" NotFinite: Shape::cuboid([NAN; 3], [1.0; 3], None), "center must be finite, but coordinate x is NaN";
        "Shape::cuboid" OutOfRange: Shape::cuboid([0.0; 3], [0.0; 3], None), "size of the box along x must be positive and finite, got 0";
        "Shape::cuboid" NotRigid: Shape::cuboid([0.0; 3], [1.0; 3], Some(twisted())), "rotation is not a rigid transform: R'R differs from the identity by 3.000e0";
        "Shape::ellipsoid" NotFinite: Shape::ellipsoid([NAN; 3], [1.0; 3], None), "center must be finite, but coordinate x is NaN";
        "Shape::ellipsoid" OutOfRange: Shape::ellipsoid([0.0; 3], [0.0; 3], None), "semi-axes of the ellipsoid along x must be positive and finite, got 0";
        "Shape::ellipsoid" NotRigid: Shape::ellipsoid([0.0; 3], [1.0; 3], Some(twisted())), "rotation is not a rigid transform: R'R differs from the identity by 3.000e0";
        "Shape::ellipse" NotFinite: Shape::ellipse([NAN; 2], [1.0; 2], 0.0), "center must be finite, but coordinate x is NaN";
        "Shape::ellipse" OutOfRange: Shape::ellipse([0.0; 2], [0.0; 2], 0.0), "semi-axes of the ellipse along x must be positive and finite, got 0";
        "Shape::grid" NotFinite: Shape::grid([NAN; 3], 0.1, [1; 3], vec![true]), "origin must be finite, but coordinate x is NaN";
        "Shape::grid" OutOfRange: Shape::grid([0.0; 3], 0.0, [1; 3], vec![true]), "voxel of the grid must be positive and finite, got 0";
        "Shape::grid" WrongLength: Shape::grid([0.0; 3], 0.1, [1; 3], vec![]), "occupied voxels: expected 1 x 1 x 1 voxels, got 0";
        "Shape::grid" InvalidObstacle: Shape::grid([0.0; 3], 0.1, [1; 3], vec![false]), "a grid needs at least one occupied voxel, got none";
        "to_bytes" Corrupt: stored::to_bytes("thing", &Unwritable), "cannot restore thing: Serde Serialization Error";
        "from_bytes" Corrupt: stored::from_bytes::<u8>("thing", &[]), "cannot restore thing: no bytes";
    }
}

fn tasks_limits_and_solvers() -> Vec<Row> {
    let none = || Limits::none_for(2);
    let nan = Sinusoid { mean: NAN, amplitude: 1.0, angular_frequency: 1.0, phase: 0.0 };
    let within = || Region::new([0.0; 3], [1.0; 3]).unwrap();
    let weighed = |kind, weights: &[f64]| Task::new(kind, Some(weights), None, None);
    rows! {
        "Limits::replace" WrongLength: none().replace(Field::Velocity, vec![Profile::Constant(1.0); 3]), "velocity limit: expected one number, or 2 (one per joint), got 3";
        "Limits::replace" OutOfRange: none().replace(Field::Velocity, vec![Profile::Constant(NAN)]), "velocity limit of joint '0' must be a number, got NaN";
        "Limits::replace" NotFinite: none().replace(Field::Velocity, vec![Profile::Sinusoid(nan)]), "velocity limit of joint '0' must be finite, but mean is NaN";
        "Limits::validate" NegativeLimit: constant(Field::Velocity, -1.0).validate(0.1, 1), "velocity limit of joint '0' is -1 at t = 0 s: a limit cannot be negative";
        "Limits::validate" EmptyRange: crossed().validate(0.1, 1), "joint '0': lower limit 1 is above upper limit 0";
        "Limits::require_inside" OutsideLimits: constant(Field::Upper, 1.0).require_inside("start", 0.0, &[0.0, 2.0]), "start: joint '1' at 2 is outside its limits [-inf, 1]";
        "Bounds::new" WrongLength: Bounds::new(&[0.0], &[1.0, 1.0]), "upper: expected 1 entries as in lower, got 2";
        "Bounds::new" OutOfRange: Bounds::new(&[1.0], &[0.0]), "lower[0] must be at most upper[0] = 0, got 1";
        "Region::new" OutOfRange: Region::new([1.0; 3], [0.0; 3]), "lower x of region must be below its upper one, 0, got 1";
        "Region::require_inside" OutsideRegion: within().require_inside("start", &[2.0, 0.5, 0.5]), "start: x of the tip, 2 m, is outside its region (0, 1)";
        "Target::validate" NotFinite: Target::Position([NAN; 3]).validate(), "target must be finite, but coordinate x is NaN";
        "Tolerance::validate" OutOfRange: Tolerance { position: 0.0, rotation: 1.0 }.validate(), "position_tolerance must be positive, got 0";
        "Task::new" WrongLength: weighed(TaskKind::Position, &[1.0]), "weights of task Position: expected 3 entries (x, y, z), got 1";
        "Task::validate" NotFinite: weighed(TaskKind::Pointing { axis: [NAN; 3] }, &[1.0; 4]), "axis must be finite, but entry 0 is NaN";
        "Task::validate" OutOfRange: weighed(TaskKind::Position, &[-1.0, 1.0, 1.0]), "weights[0] must be zero or more, and finite, got -1";
        "Task::validate" Contradiction: weighed(TaskKind::Pose, &[0.0, 1.0, 1.0, 1.0, 1.0, 1.0]).unwrap().within(within()), "region keeps x, y and z of the base, but weights free some of x, y and z of the target: free all three or none, or take task Position, whose axes are the base's";
        "Task::target" WrongTarget: weighed(TaskKind::Orientation, &[1.0; 3]).unwrap().target(&Target::Position([0.0; 3])), "task Orientation needs a target pose (4, 4), got a position (3,)";
        "Goal::validate_numbers" OutOfRange: Goal::Centring { weight: 0.0 }.validate_numbers(), "weight of a goal must be positive and finite, got 0";
        "Goal::validate" Contradiction: Goal::Clearance { up_to: 0.1, weight: 1.0 }.validate(&two(), false), "the goal Clearance is for calls with obstacles (perhaps none) or self-collision";
        "Algorithm::validate" OutOfRange: Algorithm::from(NewtonRaphson { step_fraction: 0.0 }).validate(), "step_fraction must be above 0 and at most 1, got 0";
        "DerivativeFree::validate" OutOfRange: DerivativeFree::from(Bas { c1: 0.0, ..Bas::default() }).validate(), "c1 must be positive and finite, got 0";
        "AnySolver::validate" OutOfRange: AnySolver::Single(Algorithm::from(NewtonRaphson { step_fraction: 0.0 })).validate(), "step_fraction must be above 0 and at most 1, got 0";
        "NewtonRaphson::validate" OutOfRange: NewtonRaphson { step_fraction: 0.0 }.validate(), "step_fraction must be above 0 and at most 1, got 0";
        "LevenbergMarquardt::validate" OutOfRange: LevenbergMarquardt { increase: 0.5, ..LevenbergMarquardt::default() }.validate(), "increase must be above 1 and finite, got 0.5";
        "BroydenBas::validate" OutOfRange: BroydenBas { antenna_length: 0.0, ..BroydenBas::default() }.validate(), "antenna_length must be positive and finite, got 0";
        "Apps::validate" OutOfRange: Apps { step_limit: 0.0, ..Apps::default() }.validate(), "step_limit must be positive and finite, got 0";
        "Bas::validate" OutOfRange: Bas { c1: 0.0, ..Bas::default() }.validate(), "c1 must be positive and finite, got 0";
        "BeeColony::validate" OutOfRange: BeeColony { limit: Some(0), ..BeeColony::default() }.validate(), "limit must be at least 1, got 0";
        "BeetleSwarm::validate" OutOfRange: BeetleSwarm { inertia: -1.0, ..BeetleSwarm::default() }.validate(), "inertia must be between 0 and 1, got -1";
        "DifferentialEvolution::validate" OutOfRange: DifferentialEvolution { weight: 0.0, ..DifferentialEvolution::default() }.validate(), "weight must be above 0 and at most 2, got 0";
        "Firefly::validate" OutOfRange: Firefly { absorption: -1.0, ..Firefly::default() }.validate(), "absorption must be zero or more and finite, got -1";
        "Genetic::validate" OutOfRange: Genetic { tournament: 0, ..Genetic::default() }.validate(), "tournament must be between 1 and the population of 50, got 0";
        "Pso::validate" OutOfRange: Pso { c1: -1.0, ..Pso::default() }.validate(), "c1 must be positive and finite, got -1";
        "PsoForm::named" UnknownOption: PsoForm::named("inerta", None), "form must be one of 'constriction', 'inertia', got 'inerta'";
        "PsoForm::named" OutOfRange: PsoForm::named("constriction", Some(0.5)), "inertia must be left out with form 'constriction', got 0.5";
        "Qpso::validate" OutOfRange: Qpso { expansion: 0.0, ..Qpso::default() }.validate(), "expansion must be positive and finite, got 0";
        "Stop::validate" OutOfRange: Stop { max_evaluations: 0, ..Stop::default() }.validate(), "max_evaluations must be at least 1, got 0";
        "CircleSwarm::validate" OutOfRange: CircleSwarm { population: 0, ..CircleSwarm::default() }.validate(), "population must be at least 1, got 0";
        "Znnbas::validate" OutOfRange: Znnbas { gain: 0.0, ..Znnbas::default() }.validate(2), "gain must be finite and not zero (positive to converge), got 0";
        "Znnbas::validate_numbers" OutOfRange: Znnbas { gain: 0.0, ..Znnbas::default() }.validate_numbers(), "gain must be finite and not zero (positive to converge), got 0";
        "Controller::validate" OutOfRange: Controller::Znnbas(Znnbas { gain: 0.0, ..Znnbas::default() }).validate(2), "gain must be finite and not zero (positive to converge), got 0";
        "TickRule::validate" OutOfRange: TickRule::Solver(AnySolver::Single(Algorithm::from(NewtonRaphson { step_fraction: 0.0 }))).validate(), "step_fraction must be above 0 and at most 1, got 0";
        "StraightLine::validate" OutOfRange: StraightLine { distance: 0.0, ..line() }.validate("approach"), "distance of approach must be positive and finite, got 0";
        "StraightLine::validate" NotFinite: StraightLine { direction: Some([NAN; 3]), ..line() }.validate("approach"), "direction of approach must be finite, but entry 0 is NaN";
        "Components::validate" OutOfRange: Components { weights: [-1.0; 6], tolerance: None }.validate(), "weights[0] must be zero or more, and finite, got -1";
        "Criterion::validate" OutOfRange: Criterion::from(Tolerance { position: -1.0, rotation: 1.0 }).validate(), "position_tolerance must be positive, got -1";
        "JacobianTranspose::validate" OutOfRange: JacobianTranspose { step_size: StepSize::Fixed(0.0) }.validate(), "step_size must be positive and finite, got 0";
        "MultiStart::validate" OutOfRange: MultiStart { solver: NewtonRaphson::default(), rule: RestartRule { max_starts: 0, patience: 1, min_reduction: 0.1 } }.validate(), "max_starts must be at least 1, got 0";
        "Schedule::validate" OutOfRange: Schedule { population: 0, ..Pso::default().schedule }.validate(1), "population must be between 1 and 1000000, got 0";
        "TargetFilter::validate" OutOfRange: TargetFilter::LowPass(LowPass { cutoff: 0.0 }).validate(), "cutoff must be positive and finite, got 0";
        "Znnbas::validate" WrongLength: antennae().validate(2), "antenna_length: expected one number, or 2 (one per joint), got 3";
        "Controller::validate" WrongLength: Controller::Znnbas(antennae()).validate(2), "antenna_length: expected one number, or 2 (one per joint), got 3";
    }
}

fn calls() -> Vec<Row> {
    let panda = robot("panda");
    let position = Target::Position([1.0, 0.5, 0.0]);
    let batch = |positions: &[[f64; 3]]| {
        let options = BatchOptions {
            each: SolveOptions::default(),
            starts: None,
            first_row: 0,
            threads: Some(1),
            on_invalid: OnInvalid::Raise,
        };
        solve_batch(&two(), Targets::Positions(positions), &options, &mut Unattended)
    };
    let turns = AllOptions {
        turns: true,
        each: SolveOptions { limits: Some(wide()), ..SolveOptions::default() },
        ..AllOptions::default()
    };
    let problem = |q: &[f64]| PlanProblem {
        start: at(q),
        ends: vec![at(&[0.5; 2])],
        options: Arc::new(PointToPointOptions { limits: Some(rated()), ..Default::default() }),
    };
    let plans = |q: &[f64], threads| plan_batch(&two(), &[problem(q)], Some(threads), &mut Unattended);
    let map = |robot: &Robot, voxel: f64, region| {
        MapGrid::new(robot, &MapLayout { voxel, region, directions: 20, rolls: 4 }, &MapOptions::default())
    };
    let model_free = ModelFreeOptions { controller: Controller::Znnbas(Znnbas::default()), ..Default::default() };
    let options = TrackOptions::default();
    rows! {
        "solve_batch" InRow: batch(&[[1.0, 0.5, 0.0], [NAN; 3]]), "row 1: target must be finite, but coordinate x is NaN";
        "solve_all" Contradiction: solve_all(&two(), &position, &turns, &mut Unattended), "taking all whole turns makes 202566 configurations; at most 10000 are allowed: narrow the limits";
        "self_motion" Contradiction: self_motion(&two(), &position, &SelfMotionOptions::default(), &mut Unattended), "self_motion needs one joint more than the target: robot 'planar2' has 2 joints, and this target takes 2";
        "plan_batch" InProblem: plans(&[0.0], 1), "problems[0]: start_q of robot 'planar2': expected 2 joints, got 1";
        "plan_batch" OutOfRange: plans(&[0.0; 2], 0), "threads must be from 1 to 1024, got 0";
        "plan_point_to_point" Unreachable: between(&[far()], &[0.0; 2]), "end cannot be reached: the nearest configuration found stays 7.000 m away";
        "plan_point_to_point" NoUsableEnd: between(&[far(), far()], &[0.0; 2]), "none of the 2 ends can be reached: end[0]: the nearest configuration found stays 7.000 m away; end[1]: the nearest configuration found stays 7.000 m away";
        "plan_along_path" Unreachable: along(&[[9.0, 0.0, 0.0], [9.0, 1.0, 0.0]]), "points 0 to 1 of the path cannot be reached: the nearest configurations found within the limits stay up to 7.055 m away";
        "Plan::retime" Infeasible: between(&[at(&[0.5; 2])], &[0.0; 2]).unwrap().retime(&two(), Some(&rated().replace(Field::Upper, vec![Profile::Constant(0.2)]).unwrap())), "infeasible: the path of the plan leaves the limits: highest position of joint 'joint_1' is 0.5000 rad, allowed 0.2000 rad";
        "best_posture" NotFinite: best_posture(&robot("planar5"), &[NAN, 0.0, 0.0], &PostureOptions::default(), &mut Unattended), "target must be finite, but coordinate x is NaN";
        "Linkage::new" InvalidRobot: Linkage::new(&panda, &[0.5, 0.0, 0.0], Measure::Tip, None), "robot 'panda': a posture on circles needs an arm of joints that turn about z in one plane";
        "Linkage::new" OutOfRange: Linkage::new(&robot("planar5"), &[0.5, 0.0, 1.0], Measure::Tip, None), "z of the target must be that of the arm's plane, 0, got 1";
        "MapGrid::new" OutOfRange: map(&panda, 0.0, None), "voxel must be positive and finite, got 0";
        "MapGrid::new" NotFinite: map(&panda, 0.1, Some([[NAN; 3], [1.0; 3]])), "region must be finite, but entry 0 of corner 0 is NaN";
        "MapGrid::new" Contradiction: map(&two(), 0.1, None), "the tip of robot 'planar2' moves in 2 directions, and a map of task Pose needs 3, as it reaches hardly any voxel's centre otherwise: give a position task";
        "ControlSession::command" NotFinite: control().command(&[NAN; 3].into()), "target must be finite, but entry 0 is NaN";
        "ControlSession::command" OutOfTurn: commanded().command(&[1.0, 0.0, 0.0].into()), "command: the last command is not answered yet; call observe(position) first";
        "ControlSession::observe" OutOfTurn: control().observe(&[0.0; 3].into()), "observe: there is no command to answer; call command(target) first";
        "ControlSession::observe" NotFinite: commanded().observe(&[NAN; 3].into()), "position must be finite, but entry 0 is NaN";
        "track_model_free" PlantFailed: track_model_free(&mut Broken, &reference(4), &[0.0; 2], &model_free, &mut Unattended), "the plant does not answer";
        "KinematicPlant::new" OutOfRange: KinematicPlant::new(two(), -1.0, 0), "noise must be zero or more and finite, got -1";
        "KinematicPlant::new" SeveralTips: KinematicPlant::new(arms(), 0.0, 0), "KinematicPlant takes robots with one tip; this one has left_tool and right_tool: load the robot with one of them as its tip";
        "KinematicPlant::with_orientation" OutOfRange: KinematicPlant::new(two(), 0.0, 0).unwrap().with_orientation(-1.0), "rotation_noise must be zero or more and finite, got -1";
        "Record::trajectory" WrongLength: track(&two(), &reference(4), None, &options, &mut Unattended).unwrap().trajectory(names(3)), "trajectory samples: expected 12 numbers (4 times of 3 joints), got 8";
        "Session::step" NotFinite: session().step(&Target::Position([NAN; 3]), &mut Unattended), "target must be finite, but coordinate x is NaN";
        "Session::reset_moving" Contradiction: eased_session().reset_moving(&[0.55; 2], Some(&[1.0; 2]), None), "joint '0' at 0.5500 with velocity 1.000 and acceleration 0 cannot stop inside its limits; start slower or farther inside";
        "track_tips" WrongLength: track_tips(&two(), &TipPaths { tips: &[], paths: &[reference(4), reference(5)] }, None, &options, &mut Unattended), "a path of several: expected 4 samples of 0.1 s, as the first path has, got 5";
        "ControlSession::command" Contradiction: answered().command(&TipPose::from(&Pose::identity())), "target: expected a position (3,), as before, got a pose (4, 4)";
        "ControlSession::observe" Contradiction: posed().observe(&[0.0; 3].into()), "position: expected a pose (4, 4), like the target, got a position (3,)";
        "Session::step" WrongTarget: turning().step(&Target::Position([1.0, 0.0, 0.0]), &mut Unattended), "task Orientation needs a target pose (4, 4), got a position (3,)";
        "Session::advance" OutOfRange: eased_session().advance(Some(stamped(1.0)), &mut Unattended), "stamp must be at most 0.1, the end of the tick (s), got 1";
        "Session::advance" Contradiction: session().advance(Some(stamped(0.0)), &mut Unattended), "a stamp is used by the library's own rule under acceleration or jerk limits; give such limits, or leave stamp out";
        "plan_batch" Unreachable: plan_batch(&two(), &[PlanProblem { ends: vec![far()], ..problem(&[0.0; 2]) }], Some(1), &mut Unattended).unwrap().remove(0), "end cannot be reached: the nearest configuration found stays 7.000 m away";
        "solve_tips" Contradiction: twice(), "tip 'left_tool' has two targets";
        "checkpoint" Interrupted: interruptible(|| false, checkpoint), "interrupted before the end";
    }
}

/// Errors whose exact words other files of tests hold, as they need more than a call.
const ELSEWHERE: &[(&str, &[(&str, &str)])] = &[
    ("along_path_reach.rs", &[("plan_along_path", "NotFound")]),
    ("map.rs", &[("map_chunks", "Interrupted")]),
    ("a machine without threads", &[("plan_batch", "NoThreads")]),
];

#[test]
fn promised_errors_are_returned_in_exact_words() {
    let rows = [paths_and_trajectories(), robots_and_shapes(), tasks_limits_and_solvers(), calls()].concat();
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
    let rows = [paths_and_trajectories(), robots_and_shapes(), tasks_limits_and_solvers(), calls()].concat();
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
