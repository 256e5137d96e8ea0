//! Error messages: wrong input of every kind, and the exact sentence for it. (URDF files, curves, samples and DH tables have
//! theirs in `load` and `path`.)

use std::f64::consts::PI;

use crate::common::{jumping, message, robot};
use ikcore::Error;
use ikcore::ik::{SolveOptions, solve};
use ikcore::limits::{Field, LimitAt, Limits, Profile, Sinusoid};
use ikcore::math::pose;
use ikcore::nalgebra::{Matrix4, Vector3};
use ikcore::path::{Circle, Path, Plane, Reference};
use ikcore::robot::{ChainBuilder, Drive, Joint, JointKind, Robot};
use ikcore::solver::RestartRule;
use ikcore::solver::{Algorithm, AnySolver, Bas, BasVariant, LevenbergMarquardt, MultiStart, Stop, Unattended};
use ikcore::task::{Target, Tolerance};
use ikcore::tracking::{Session, TickRule, TrackOptions, track};

const NAN: f64 = f64::NAN;
const INFINITE: f64 = f64::INFINITY;

/// Message of `solve` for these options and a valid target.
#[track_caller]
fn solve_says(options: SolveOptions) -> String {
    message(solve(&robot("iiwa14"), &Target::Position([0.4, 0.3, 1.0]), &options, &mut Unattended))
}

/// Short path within reach of the planar arm, with ticks of 0.2 s.
fn reference() -> Reference {
    Path::new(Circle::new(Plane::xy([4.0, 1.0, 0.0]).unwrap(), 1.0, 6.0).unwrap()).sample(0.2).unwrap()
}

/// Message of `track` for these options and this start on the planar arm.
#[track_caller]
fn track_says(start: &[f64], options: TrackOptions) -> String {
    let planar = robot("planar5");
    let options = TrackOptions { limits: options.limits.or_else(|| jumping(&planar)), ..options };
    message(track(&planar, &reference(), Some(start), &options, &mut Unattended))
}

fn planar_limits(field: Field, profile: Profile) -> ikcore::Result<Limits> {
    jumping(&robot("planar5")).unwrap().replace(field, vec![profile])
}

fn within(field: Field, profile: Profile) -> TrackOptions {
    TrackOptions { limits: Some(planar_limits(field, profile).unwrap()), ..TrackOptions::default() }
}

#[test]
fn a_wrong_number_of_joint_positions_is_named() {
    let iiwa = robot("iiwa14");
    let says = "joint angles of robot 'iiwa14': expected 7 joints, got 6";
    assert_eq!(message(iiwa.fk(&[0.0; 6])), says);
    assert_eq!(message(iiwa.jacobian(&[0.0; 6])), says);
    assert_eq!(message(iiwa.link_poses(&[0.0; 6])), says);
    let says = "start_q of robot 'iiwa14': expected 7 joints, got 0";
    assert_eq!(solve_says(SolveOptions { start: Some(vec![]), ..SolveOptions::default() }), says);
    let says = "start_q of robot 'planar5': expected 5 joints (joint_1 to joint_5), got 7";
    assert_eq!(track_says(&[0.0; 7], TrackOptions::default()), says);
}

#[test]
fn joint_positions_that_are_not_finite_are_named() {
    let iiwa = robot("iiwa14");
    let q = |value| [0.0, 0.0, value, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(message(iiwa.fk(&q(NAN))), "joint angles must be finite, but joint 'joint_a3' is NaN");
    assert_eq!(message(iiwa.jacobian(&q(INFINITE))), "joint angles must be finite, but joint 'joint_a3' is inf");
    assert_eq!(message(iiwa.link_poses(&q(-INFINITE))), "joint angles must be finite, but joint 'joint_a3' is -inf");
    let says = "start_q must be finite, but joint 'joint_a3' is NaN";
    assert_eq!(solve_says(SolveOptions { start: Some(q(NAN).to_vec()), ..SolveOptions::default() }), says);
    let says = "start_q must be finite, but joint 'joint_3' is NaN";
    assert_eq!(track_says(&[0.0, 0.0, NAN, 0.0, 0.0], TrackOptions::default()), says);
}

#[test]
fn starts_outside_their_limits_are_named() {
    let says = format!(
        "start_q: joint 'joint_1' at -4 is outside its limits [{}, {PI}] by 0.8584 rad: whole turns taken off bring it inside",
        -PI
    );
    assert_eq!(track_says(&[-4.0, 0.0, 0.0, 0.0, 0.0], TrackOptions::default()), says);
    let says = "start_q: joint 'joint_1' at 0 is outside its limits [0.1, 3.141592653589793] by 0.1000 rad: moving it to the limit \
                changes the pose; start slack takes a start farther out";
    assert_eq!(track_says(&[0.0; 5], within(Field::Lower, Profile::Constant(0.1))), says);
}

#[test]
fn unknown_robots_are_named_with_suggestions() {
    let known =
        "fr3, gen3, hydraulic3, iiwa14, iiwa7, kr210, kr210_yuan2016, panda, planar5, ur10, ur10e, ur3e, ur5, ur5e";
    let says = |name, near| format!("no robot is named '{name}'{near}; known robots: {known}");
    assert_eq!(message(Robot::named("Panda")), says("Panda", " (did you mean 'panda'?)"));
    assert_eq!(message(Robot::named("iiwa 14")), says("iiwa 14", " (did you mean 'iiwa14'?)"));
    assert_eq!(message(Robot::named("scara")), says("scara", ""));
    assert_eq!(message(Robot::named("")), says("", ""));
}

#[test]
fn unknown_links_are_named_with_the_known_ones() {
    let urdf = r#"<robot name="arm"><link name="base"/><link name="wrist"/><joint name="j" type="revolute">
        <parent link="base"/><child link="wrist"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"#;
    let says = "robot 'arm' has no link 'rist' (did you mean 'wrist'?); its links: base, wrist";
    assert_eq!(message(Robot::from_urdf(urdf, None, Some("rist"))), says);
    assert_eq!(message(Robot::from_urdf(urdf, Some("rist"), None)), says);
    let says = "robot 'arm' has no link 'j' (did you mean 'wrist', the link that the joint of this name moves?); \
                its links: base, wrist";
    assert_eq!(message(Robot::from_urdf(urdf, None, Some("j"))), says);
}

/// Single joint about z in the given range.
fn hinge(joint: Joint) -> ikcore::Result<Robot> {
    let mut chain = ChainBuilder::new("door", "frame");
    let index = chain.add_joint(joint);
    chain.moving(index, JointKind::Revolute, Vector3::z(), Drive::DIRECT);
    chain.link("leaf");
    chain.build()
}

#[test]
fn impossible_limits_of_joints_are_named() {
    let joint = |lower, upper| Joint::new("hinge", JointKind::Revolute).with_range(lower, upper);
    assert_eq!(message(hinge(joint(1.0, 0.5))), "joint 'hinge': lower limit 1 is above upper limit 0.5");
    let says = "lower limit of joint 'hinge' must be a number below infinity, got NaN";
    assert_eq!(message(hinge(joint(NAN, 0.5))), says);
    let says = "upper limit of joint 'hinge' must be a number above -infinity, got -inf";
    assert_eq!(message(hinge(joint(-INFINITE, -INFINITE))), says);
    let says = "velocity limit of joint 'hinge' must be a number, got NaN";
    assert_eq!(message(hinge(joint(0.0, 1.0).with_velocity(NAN))), says);
    let says = "velocity limit of joint 'hinge' is -2 at t = 0 s: a limit cannot be negative";
    assert_eq!(message(hinge(joint(0.0, 1.0).with_velocity(-2.0))), says);
    let says = "joint 'shoulder_lift_joint': lower limit 2 is above upper limit 1";
    let crossed = robot("ur5e").with_limits(|i, joint| {
        if i == 1 {
            (joint.lower, joint.upper) = (2.0, 1.0);
        }
    });
    assert_eq!(message(crossed), says);
}

#[test]
fn impossible_chains_are_named() {
    let empty = ChainBuilder::new("stick", "base").build();
    assert_eq!(message(empty), "robot 'stick': no joint moves between base and tip");
    let mut chain = ChainBuilder::new("arm", "base");
    let joint = chain.add_joint(Joint::new("elbow", JointKind::Revolute));
    chain.moving(joint, JointKind::Revolute, Vector3::zeros(), Drive::DIRECT);
    assert_eq!(message(chain.build()), "robot 'arm': joint 'elbow' has a zero or non-finite axis");
    let mut chain = ChainBuilder::new("arm", "base");
    for _ in 0..2 {
        let joint = chain.add_joint(Joint::new("elbow", JointKind::Revolute));
        chain.moving(joint, JointKind::Revolute, Vector3::z(), Drive::DIRECT);
    }
    assert_eq!(message(chain.build()), "robot 'arm': two joints are named 'elbow'");
}

#[test]
fn matrices_that_are_no_poses_are_refused() {
    let says = |matrix: Matrix4<f64>| message(pose::from_matrix("target", &matrix));
    let mut matrix = Matrix4::identity();
    matrix[(0, 3)] = NAN;
    assert_eq!(says(matrix), "target must be finite, but entry (0, 3) is NaN");
    let last_row = "target is not a rigid transform: its last row is (0, 0, 0, 2), not (0, 0, 0, 1)";
    assert_eq!(says(Matrix4::from_diagonal(&[1.0, 1.0, 1.0, 2.0].into())), last_row);
    let scaled = "target is not a rigid transform: R'R differs from the identity by 3.000e0; the nearest rotation is U V' of its singular value decomposition U S V'";
    assert_eq!(says(Matrix4::from_diagonal(&[1.0, 2.0, 1.0, 1.0].into())), scaled);
    let mirrored =
        "target is not a rigid transform: its rotation is a reflection (determinant -1): turn one of its axes round";
    assert_eq!(says(Matrix4::from_diagonal(&[1.0, -1.0, 1.0, 1.0].into())), mirrored);
    let nowhere = pose::translation(0.0, INFINITE, 0.0);
    let says = "tool must be finite, but entry (1, 3) is inf";
    assert_eq!(message(robot("iiwa14").with_tool(nowhere)), says);
    let says = "base must be finite, but entry (1, 3) is inf";
    assert_eq!(message(robot("iiwa14").with_base(nowhere)), says);
}

#[test]
fn targets_that_are_not_finite_are_refused() {
    let iiwa = robot("iiwa14");
    let says = |target: Target| message(solve(&iiwa, &target, &SolveOptions::default(), &mut Unattended));
    assert_eq!(says(Target::Position([0.0, NAN, 0.0])), "target must be finite, but coordinate y is NaN");
    let mut frame = iiwa.tip(&[0.0; 7]);
    frame.axes[1][2] = INFINITE;
    assert_eq!(says(Target::Pose(frame)), "target must be finite, but rotation entry 5 is inf");
    let mut session = Session::new(&iiwa, &[0.0; 7], 0.1, &TrackOptions::default()).unwrap();
    let step = session.step(&Target::Position([INFINITE, 0.0, 0.0]), &mut Unattended);
    assert_eq!(message(step), "target must be finite, but coordinate x is inf");
    assert_eq!(session.time(), 0.0, "a refused target takes no time");
}

#[test]
fn solver_options_out_of_range_are_named() {
    let bas = |bas| AnySolver::Single(Algorithm::from(bas));
    let lm = |lm| AnySolver::Single(Algorithm::LevenbergMarquardt(lm));
    let again = |rule| {
        let solver = Algorithm::LevenbergMarquardt(LevenbergMarquardt::default());
        AnySolver::MultiStart(MultiStart { solver, rule })
    };
    let (beetle, descent, rule) = (Bas::default(), LevenbergMarquardt::default(), RestartRule::with_patience(3));
    for (solver, says) in [
        (bas(Bas { explorations: 0, ..beetle }), "explorations must be at least 1, got 0"),
        (bas(Bas { max_passes: 0, ..beetle }), "max_passes must be at least 1, got 0"),
        (bas(Bas { c1: -1.0, ..beetle }), "c1 must be positive and finite, got -1"),
        (bas(Bas { c2: NAN, ..beetle }), "c2 must be positive and finite, got NaN"),
        (
            lm(LevenbergMarquardt { initial_damping: 0.0, ..descent }),
            "initial_damping must be positive and finite, got 0",
        ),
        (lm(LevenbergMarquardt { increase: 1.0, ..descent }), "increase must be above 1 and finite, got 1"),
        (lm(LevenbergMarquardt { decrease: 2.0, ..descent }), "decrease must be above 0 and at most 1, got 2"),
        (lm(LevenbergMarquardt { min_gain: 1.0, ..descent }), "min_gain must be at least 0 and below 1, got 1"),
        (again(RestartRule { max_starts: 0, ..rule }), "max_starts must be at least 1, got 0"),
        (again(RestartRule { patience: 0, ..rule }), "patience must be at least 1, got 0"),
        (again(RestartRule { min_reduction: 0.5, ..rule }), "min_reduction must be at least 1 and finite, got 0.5"),
    ] {
        assert_eq!(solve_says(SolveOptions { solver: Some(solver.clone()), ..SolveOptions::default() }), says);
        assert_eq!(
            track_says(&[0.0; 5], TrackOptions { rule: TickRule::Solver(solver), ..TrackOptions::default() }),
            says
        );
    }
    let says = "variant must be one of 'star', 'chain', 'greedy', got 'cain'";
    assert_eq!(message("cain".parse::<BasVariant>()), says);
    assert_eq!(message("end".parse::<LimitAt>()), "limit_at must be one of 'interval', 'start', got 'end'");
}

#[test]
fn budgets_and_tolerances_out_of_range_are_named() {
    let stopping = |stop| solve_says(SolveOptions { stop, ..SolveOptions::default() });
    let says = "max_evaluations must be at least 1, got 0";
    assert_eq!(stopping(Stop { max_evaluations: 0, ..Stop::default() }), says);
    let says = "max_iterations must be at least 1, got 0";
    assert_eq!(stopping(Stop { max_iterations: 0, ..Stop::default() }), says);
    let tolerant = |position, rotation| Tolerance { position, rotation };
    for (tolerance, says) in [
        (tolerant(0.0, 1.0), "position_tolerance must be positive, got 0"),
        (tolerant(1.0, -1.0), "rotation_tolerance must be positive, got -1"),
        (tolerant(NAN, 1.0), "position_tolerance must be positive, got NaN"),
    ] {
        assert_eq!(solve_says(SolveOptions { tolerance, ..SolveOptions::default() }), says);
        assert_eq!(track_says(&[0.0; 5], TrackOptions { tolerance, ..TrackOptions::default() }), says);
    }
}

#[test]
fn time_steps_and_durations_out_of_range_are_named() {
    for (value, shown) in [(0.0, "0"), (-0.1, "-0.1"), (NAN, "NaN"), (INFINITE, "inf")] {
        let says = format!("dt must be positive and finite, got {shown}");
        assert_eq!(message(Reference::new(value, vec![[0.0; 3]; 2], None)), says);
        let circle = Circle::new(Plane::xy([0.0; 3]).unwrap(), 1.0, 6.0).unwrap();
        assert_eq!(message(Path::new(circle).sample(value)), says);
        let (planar, options) = (robot("planar5"), TrackOptions::default());
        assert_eq!(message(Session::new(&planar, &[0.0; 5], value, &options)), says);
        let says = format!("duration must be positive and finite, got {shown}");
        assert_eq!(message(Circle::new(Plane::xy([0.0; 3]).unwrap(), 1.0, value)), says);
    }
}

#[test]
fn paths_without_points_are_refused() {
    assert_eq!(message(Reference::new(0.2, vec![], None)), "path: it needs at least 2 points, got 0");
    assert_eq!(message(Reference::new(0.2, vec![[0.0; 3]], None)), "path: it needs at least 2 points, got 1");
    let says = "path points must be finite, but z of row 1 is NaN";
    assert_eq!(message(Reference::new(0.2, vec![[0.0; 3], [0.0, 0.0, NAN]], None)), says);
}

#[test]
fn negative_velocity_limits_are_named() {
    let says = "velocity limit of joint 'joint_1' is -0.5 at t = 0 s: a limit cannot be negative";
    assert_eq!(track_says(&[0.0; 5], within(Field::Velocity, Profile::Constant(-0.5))), says);
    let options = within(Field::Velocity, Profile::Constant(-0.5));
    assert_eq!(message(Session::new(&robot("planar5"), &[0.0; 5], 0.1, &options)), says);
    // 0.1 + 0.2 sin t is lowest at 3 pi / 2 s.
    let dipping = Sinusoid { mean: 0.1, amplitude: 0.2, angular_frequency: 1.0, phase: 0.0 };
    let says = "velocity limit of joint 'joint_1' is -0.1 at t = 4.71238898038469 s: a limit cannot be negative";
    assert_eq!(track_says(&[0.0; 5], within(Field::Velocity, Profile::Sinusoid(dipping))), says);
    let dipping = Profile::Sampled { step: 1.0, values: vec![0.5, 0.25, -0.25, 0.5] };
    let says = "velocity limit of joint 'joint_1' is -0.25 at t = 2 s: a limit cannot be negative";
    assert_eq!(track_says(&[0.0; 5], within(Field::Velocity, dipping)), says);
}

#[test]
fn a_limit_that_dips_after_the_end_is_no_mistake() {
    // 0.1 + 0.2 sin(t / 10) is negative only after 36 s; the path takes 6 s.
    let later = Sinusoid { mean: 0.1, amplitude: 0.2, angular_frequency: 0.1, phase: 0.0 };
    let options = within(Field::Velocity, Profile::Sinusoid(later));
    let record = track(&robot("planar5"), &reference(), Some(&[0.0; 5]), &options, &mut Unattended).unwrap();
    assert_eq!(record.max_violation, 0.0);
}

#[test]
fn limits_that_are_nan_are_named() {
    let says = |field, profile| message(planar_limits(field, profile));
    let expected = "velocity limit of joint 'joint_1' must be a number, got NaN";
    assert_eq!(says(Field::Velocity, Profile::Constant(NAN)), expected);
    let expected = "lower limit of joint 'joint_1' at t = 0.5 s must be a number, got NaN";
    assert_eq!(says(Field::Lower, Profile::Sampled { step: 0.5, values: vec![0.0, NAN] }), expected);
    let expected = "velocity limit of joint 'joint_1' must be finite, but amplitude is inf";
    let wild = Sinusoid { mean: 1.0, amplitude: INFINITE, angular_frequency: 1.0, phase: 0.0 };
    assert_eq!(says(Field::Velocity, Profile::Sinusoid(wild)), expected);
    let expected = "velocity limit of joint 'joint_1': expected at least 1 sample, got 0";
    assert_eq!(says(Field::Velocity, Profile::Sampled { step: 0.5, values: vec![] }), expected);
    let expected = "time between samples of the velocity limit of joint 'joint_1' must be positive and finite, got 0";
    assert_eq!(says(Field::Velocity, Profile::Sampled { step: 0.0, values: vec![1.0] }), expected);
}

#[test]
fn a_wrong_number_of_limits_is_named() {
    let profiles = vec![Profile::Constant(1.0); 3];
    let says = "velocity limit: expected one number, or 5 (one per joint), got 3";
    assert_eq!(message(Limits::of(&robot("planar5")).replace(Field::Velocity, profiles)), says);
    let says = "limits for robot 'planar5': expected 5 joints, got 7";
    let foreign = Some(Limits::of(&robot("iiwa14")));
    assert_eq!(track_says(&[0.0; 5], TrackOptions { limits: foreign, ..TrackOptions::default() }), says);
    let says = "limits for robot 'iiwa14': expected 7 joints, got 5";
    let foreign = Some(Limits::of(&robot("planar5")));
    assert_eq!(solve_says(SolveOptions { limits: foreign, ..SolveOptions::default() }), says);
}

#[test]
fn crossing_position_limits_are_named() {
    let says = "joint 'joint_1': lower limit 4 is above upper limit 3.141592653589793";
    assert_eq!(track_says(&[0.0; 5], within(Field::Lower, Profile::Constant(4.0))), says);
    let limits = Limits::of(&robot("iiwa14")).replace(Field::Upper, vec![Profile::Constant(-3.0)]).unwrap();
    let lower = (-170.0_f64).to_radians();
    let says = format!("joint 'joint_a1': lower limit {lower} is above upper limit -3");
    assert_eq!(solve_says(SolveOptions { limits: Some(limits), ..SolveOptions::default() }), says);
}

#[test]
fn infinity_switches_a_limit_off() {
    let options = within(Field::Jerk, Profile::Constant(INFINITE));
    track(&robot("planar5"), &reference(), Some(&[0.0; 5]), &options, &mut Unattended).unwrap();
}

#[test]
fn an_error_carries_its_values() {
    let error = robot("planar5").fk(&[0.0]).unwrap_err();
    let Error::WrongLength { what, expected, got } = error else { panic!("{error:?}") };
    assert_eq!((what.as_str(), expected.as_str(), got), ("joint angles of robot 'planar5'", "5 joints", 1));
}
