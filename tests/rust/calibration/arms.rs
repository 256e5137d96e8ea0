//! Arms with known errors, and what is found of them.

use ikcore::calibration::{Calibration, CalibrationOptions, CameraPlace, Measured, Part, SuggestionOptions, calibrate};
use ikcore::math::{Pose, pose};
use ikcore::nalgebra::Vector3;
use ikcore::obstacle::Surroundings;
use ikcore::rng::stream;
use ikcore::robot::{ChainBuilder, Drive, Joint, JointKind, Robot};

const COUNT: usize = 40;

/// A model whose tool is beside the last axis, so that every joint moves the tip.
fn model(name: &str) -> Robot {
    Robot::named(name).unwrap().with_tool(pose::translation(0.05, 0.03, 0.1)).unwrap()
}

/// The arm as it is built: with manufacturing errors, another tool and another base.
fn built(model: &Robot, seed: u64) -> Robot {
    let arm = model.with_errors(1e-3, 0.5_f64.to_radians(), &mut stream(seed, 0)).unwrap();
    let tool = pose::from_rpy([0.01, 0.0, 0.02], [0.051, 0.029, 0.101]);
    let base = pose::from_rpy([0.3, -0.4, 2.0], [1.0, 2.0, -0.5]);
    arm.with_tool(tool).unwrap().with_base(base).unwrap()
}

fn tips(robot: &Robot, qs: &[f64]) -> Vec<Pose> {
    qs.chunks(robot.dof()).map(|q| robot.fk(q).unwrap()).collect()
}

fn positions(robot: &Robot, qs: &[f64]) -> Vec<[f64; 3]> {
    tips(robot, qs).iter().map(|tip| tip.translation.vector.into()).collect()
}

/// Adds normal noise of this standard deviation (m).
fn noisy(mut points: Vec<[f64; 3]>, sigma: f64, seed: u64) -> Vec<[f64; 3]> {
    let mut rng = stream(seed, 1);
    for entry in points.as_flattened_mut() {
        *entry += sigma * rng.normal_pair()[0];
    }
    points
}

fn configurations(robot: &Robot, count: usize, seed: u64) -> Vec<f64> {
    robot.random_configurations(count, &mut stream(seed, 2)).unwrap()
}

/// Largest distance between the tips of two robots at configurations of neither fit.
fn apart(a: &Robot, b: &Robot) -> f64 {
    let qs = configurations(a, 50, 99);
    let far = |(a, b): (&[f64; 3], &[f64; 3])| (Vector3::from(*a) - Vector3::from(*b)).norm();
    positions(a, &qs).iter().zip(&positions(b, &qs)).map(far).fold(0.0, f64::max)
}

fn found(robot: &Robot, qs: &[f64], measured: &Measured) -> Calibration {
    calibrate(robot, qs, measured, &CalibrationOptions::default()).unwrap()
}

#[test]
fn exact_measurements_give_the_arm_as_it_is_built() {
    for name in ["panda", "ur5e", "iiwa14"] {
        let (model, arm) = (model(name), built(&model(name), 7));
        let qs = configurations(&model, COUNT, 1);
        let by_position = found(&model, &qs, &Measured::Positions(positions(&arm, &qs)));
        let by_pose = found(&model, &qs, &Measured::Poses(tips(&arm, &qs)));
        for result in [by_position, by_pose] {
            let far = apart(&result.robot, &arm);
            assert!(far < 1e-6, "{name}: {far}");
            assert!(result.findings.converged && result.findings.outliers.is_empty(), "{}", result.findings.message());
        }
    }
}

#[test]
fn poses_determine_four_parameters_a_turn_two_a_slide_and_six() {
    let mut slider = ChainBuilder::new("slider", "base");
    for (name, kind, axis) in [
        ("lift", JointKind::Prismatic, Vector3::z()),
        ("turn", JointKind::Revolute, Vector3::z()),
        ("reach", JointKind::Prismatic, Vector3::x()),
        ("wrist", JointKind::Revolute, Vector3::y()),
    ] {
        let joint = slider.add_joint(Joint::new(name, kind).with_range(-1.0, 1.0));
        slider.fixed(pose::translation(0.1, 0.0, 0.2));
        slider.moving(joint, kind, axis, Drive::DIRECT);
    }
    slider.fixed(pose::translation(0.1, 0.05, 0.0));
    slider.link("tip");
    let slider = slider.build().unwrap();
    for (robot, turns, slides) in [(slider, 2, 2), (model("panda"), 7, 0), (model("ur5e"), 6, 0)] {
        let qs = configurations(&robot, COUNT, 2);
        let result = found(&robot, &qs, &Measured::Poses(tips(&robot, &qs)));
        let known = &result.findings.identifiability;
        assert_eq!([known.rank, known.possible], [4 * turns + 2 * slides + 6; 2], "{}", robot.name());
        assert!(known.unknown.is_empty(), "{:?}", known.unknown);
    }
}

#[test]
fn gross_errors_are_named_and_left_out() {
    let (model, arm) = (model("panda"), built(&model("panda"), 3));
    let qs = configurations(&model, COUNT, 4);
    let clean = noisy(positions(&arm, &qs), 1e-4, 5);
    let mut wrong = clean.clone();
    for (row, error) in [(3, [0.05, 0.0, 0.0]), (17, [0.0, -0.5, 0.0]), (30, [0.002, 0.002, -0.002])] {
        (0..3).for_each(|k| wrong[row][k] += error[k]);
    }
    let without = found(&model, &qs, &Measured::Positions(clean));
    let result = found(&model, &qs, &Measured::Positions(wrong.clone()));
    assert_eq!(result.findings.outliers, [3, 17, 30]);
    assert!(apart(&result.robot, &arm) < 2.0 * apart(&without.robot, &arm));
    assert!(result.findings.message().contains("; rows 3, 17, 30 do not belong with the others and were left out"));
    let options = CalibrationOptions { robust: false, ..CalibrationOptions::default() };
    let plain = calibrate(&model, &qs, &Measured::Positions(wrong), &options).unwrap();
    assert!(plain.findings.outliers.is_empty() && apart(&plain.robot, &arm) > 5e-3);
}

#[test]
fn the_same_measurements_give_the_same_bits() {
    let (model, arm) = (model("iiwa14"), built(&model("iiwa14"), 3));
    let qs = configurations(&model, COUNT, 4);
    let measured = Measured::Positions(noisy(positions(&arm, &qs), 1e-4, 5));
    let (once, again) = (found(&model, &qs, &measured), found(&model, &qs, &measured));
    assert_eq!(once.robot, again.robot);
    assert_eq!(once.findings.parameters, again.findings.parameters);
}

#[test]
fn held_out_errors_are_those_of_fits_without_the_row() {
    let (model, arm) = (model("ur5e"), built(&model("ur5e"), 8));
    let qs = configurations(&model, 20, 6);
    let points = noisy(positions(&arm, &qs), 1e-4, 7);
    let sigma = Some(vec![[1e-4; 2]; 20]);
    let options = CalibrationOptions { robust: false, sigma, ..CalibrationOptions::default() };
    let whole = calibrate(&model, &qs, &Measured::Positions(points.clone()), &options).unwrap();
    let mut sum = 0.0;
    for row in 0..20 {
        let (mut fewer, mut rest) = (qs.clone(), points.clone());
        fewer.drain(6 * row..6 * (row + 1));
        rest.remove(row);
        let sigma = Some(vec![[1e-4; 2]; 19]);
        let options = CalibrationOptions { sigma, ..options.clone() };
        let fit = calibrate(&model, &fewer, &Measured::Positions(rest), &options).unwrap();
        let there = fit.robot.fk(&qs[6 * row..6 * (row + 1)]).unwrap().translation.vector;
        sum += (there - Vector3::from(points[row])).norm_squared();
    }
    let (refitted, closed_form) = ((sum / 20.0).sqrt(), whole.findings.held_out.length);
    assert!((closed_form / refitted - 1.0).abs() < 0.02, "{closed_form} {refitted}");
}

#[test]
fn a_joint_that_never_moved_is_named() {
    let (model, arm) = (model("panda"), built(&model("panda"), 3));
    let mut qs = configurations(&model, COUNT, 4);
    qs.chunks_mut(7).for_each(|q| q[3] = -1.5);
    let result = found(&model, &qs, &Measured::Poses(tips(&arm, &qs)));
    let known = &result.findings.identifiability;
    assert_eq!([known.rank, known.possible], [30, 34]);
    assert!(!known.unknown.is_empty());
    assert_eq!(result.findings.still_joints, ["panda_joint4"]);
    let said = "joint 'panda_joint4' never moved, so that its zero and the links beside it cannot be told apart";
    assert!(result.findings.message().contains(said), "{}", result.findings.message());
}

#[test]
fn distances_alone_find_links_and_zeros() {
    let model = model("panda");
    let arm = built(&model, 3).with_base(Pose::identity()).unwrap();
    let qs = configurations(&model, 80, 4);
    let centre = Vector3::new(0.6, 0.2, 0.1);
    let points = positions(&arm, &qs);
    let bar = Measured::BallBar {
        distances: points.iter().map(|p| (Vector3::from(*p) - centre).norm()).collect(),
        centre: [0.61, 0.19, 0.1],
    };
    let result = found(&model, &qs, &bar);
    let there = result.findings.centre.unwrap();
    let (from, to) = (positions(&result.robot, &qs), Vector3::from(there));
    let worst = from
        .iter()
        .zip(&points)
        .map(|(a, b)| ((Vector3::from(*a) - to).norm() - (Vector3::from(*b) - centre).norm()).abs());
    assert!(worst.fold(0.0, f64::max) < 1e-6);
    let pairs = points.chunks(2).map(|pair| (Vector3::from(pair[0]) - Vector3::from(pair[1])).norm());
    let result = found(&model, &qs, &Measured::Pairs(pairs.collect()));
    assert!(result.findings.after.length < 1e-6, "{}", result.findings.message());
}

#[test]
fn contacts_with_a_plane_find_the_plane() {
    let model = Robot::named("ur5e").unwrap();
    let qs = configurations(&model, 60, 4);
    let normal = Vector3::new(0.1, -0.05, 1.0).normalize();
    let heights = positions(&model, &qs).iter().map(|p| normal.dot(&Vector3::from(*p)) - 0.12).collect();
    let measured = Measured::Heights { heights, normal: [0.0, 0.0, 2.0], height: 0.2 };
    let options = CalibrationOptions { fit: vec![Part::Base], ..CalibrationOptions::default() };
    let (found, height) = calibrate(&model, &qs, &measured, &options).unwrap().findings.plane.unwrap();
    assert!((Vector3::from(found) - normal).norm() < 1e-7 && (height - 0.12).abs() < 1e-7);
}

#[test]
fn both_arrangements_of_a_camera_are_found() {
    let robot = Robot::named("ur5e").unwrap();
    let qs = configurations(&robot, 12, 4);
    let (camera, board) =
        (pose::from_rpy([3.0, 0.1, 0.2], [0.3, 0.1, 1.5]), pose::from_rpy([0.1, 0.2, 0.3], [0.02, 0.0, 0.1]));
    for place in [CameraPlace::Fixed, CameraPlace::Hand] {
        let seen = |tip: Pose| match place {
            CameraPlace::Fixed => camera.inverse() * tip * board,
            CameraPlace::Hand => (tip * camera).inverse() * board,
        };
        let poses = tips(&robot, &qs).into_iter().map(seen).collect();
        let options = CalibrationOptions { fit: vec![Part::Tool, Part::Base], ..CalibrationOptions::default() };
        let result = calibrate(&robot, &qs, &Measured::BoardPoses { poses, camera: place }, &options).unwrap();
        for (found, exact) in [(result.findings.camera.unwrap(), camera), (result.findings.board.unwrap(), board)] {
            let change = (exact.to_homogeneous() - found.to_homogeneous()).norm();
            assert!(change < 1e-6, "{place:?} {change}");
        }
        assert_eq!(result.robot, robot);
    }
}

#[test]
fn suggested_configurations_tell_more_than_random_ones() {
    let (model, arm) = (model("ur5e"), built(&model("ur5e"), 3));
    let qs = configurations(&model, 12, 4);
    let measured = Measured::Positions(noisy(positions(&arm, &qs), 1e-4, 5));
    let suggestion = SuggestionOptions { count: 10, surroundings: Surroundings::default(), seed: 1 };
    let sigma = |count| Some(vec![[1e-4; 2]; count]);
    let options = CalibrationOptions { suggestion, sigma: sigma(12), ..CalibrationOptions::default() };
    let suggested = calibrate(&model, &qs, &measured, &options).unwrap().findings.suggested;
    assert_eq!(suggested.len(), 60);
    let information = |more: &[f64]| {
        let qs = [&qs[..], more].concat();
        let points = Measured::Positions(positions(&arm, &qs));
        let options = CalibrationOptions { sigma: sigma(22), ..CalibrationOptions::default() };
        let known = calibrate(&model, &qs, &points, &options).unwrap().findings.identifiability;
        known.singular_values[..known.possible].iter().map(|value| value.ln()).sum::<f64>()
    };
    let random = (0..5).map(|seed| information(&configurations(&model, 10, 50 + seed))).fold(f64::MIN, f64::max);
    assert!(information(&suggested) > random + 1.0, "{} {random}", information(&suggested));
}
