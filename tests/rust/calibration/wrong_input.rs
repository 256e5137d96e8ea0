//! Measurements that cannot be right: each is refused with its reason.

use ikcore::Error;
use ikcore::calibration::{CalibrationOptions, Measured, Part, calibrate};
use ikcore::rng::stream;
use ikcore::robot::Robot;

fn arm() -> Robot {
    Robot::named("ur5e").unwrap()
}

fn refused(qs: &[f64], measured: &Measured) -> String {
    calibrate(&arm(), qs, measured, &CalibrationOptions::default()).unwrap_err().to_string()
}

fn configurations(count: usize) -> Vec<f64> {
    arm().random_configurations(count, &mut stream(1, 0)).unwrap()
}

fn points(qs: &[f64], factors: [f64; 3]) -> Measured {
    let point = |q: &[f64]| {
        let p = arm().fk(q).unwrap().translation.vector;
        [factors[0] * p.x, factors[1] * p.y, factors[2] * p.z]
    };
    Measured::Positions(qs.chunks(6).map(point).collect())
}

#[test]
fn too_few_measurements_say_how_many_are_needed() {
    let qs = configurations(5);
    assert_eq!(
        refused(&qs, &points(&qs, [1.0; 3])),
        "5 measurements give 15 equations for 25 unknowns: measure 9 configurations or more, twice as many if you can, or fit fewer parts"
    );
    assert_eq!(refused(&qs[..6], &points(&qs[..6], [1.0; 3])), "1 measurement: two or more are needed");
}

#[test]
fn configurations_that_are_alike_are_refused() {
    let qs = configurations(1).repeat(20);
    assert_eq!(
        refused(&qs, &points(&qs, [1.0; 3])),
        "all configurations are alike: move the arm between measurements, each joint over as much of its range as possible"
    );
}

#[test]
fn millimetres_are_told() {
    let qs = configurations(30);
    assert_eq!(
        refused(&qs, &points(&qs, [1000.0; 3])),
        "the measured positions spread 1000 times as far as the arm moves: lengths are in metres, and these look like millimetres; divide by 1000"
    );
}

#[test]
fn a_mirrored_frame_is_told() {
    let qs = configurations(30);
    let said = refused(&qs, &points(&qs, [1.0, -1.0, 1.0]));
    assert!(said.starts_with("the measured frame is mirrored: a mirror image of it fits the arm to "), "{said}");
    assert!(said.ends_with(" m; reverse the sign of one coordinate, or swap two"), "{said}");
}

#[test]
fn degrees_are_told() {
    let qs = configurations(30);
    let degrees: Vec<f64> = qs.iter().map(|angle| angle.to_degrees()).collect();
    let said = refused(&degrees, &points(&qs, [1.0; 3]));
    assert!(said.starts_with("joint 'shoulder_pan_joint' reaches "), "{said}");
    assert!(
        said.ends_with(" rad, far beyond its limits: angles are in radians, and these look like degrees"),
        "{said}"
    );
}

#[test]
fn numbers_that_are_none_are_named() {
    let mut qs = configurations(30);
    let Measured::Positions(mut positions) = points(&qs, [1.0; 3]) else { return };
    positions[7][2] = f64::NAN;
    assert_eq!(refused(&qs, &Measured::Positions(positions)), "measurements must be finite, but row 7, entry 2 is NaN");
    let measured = points(&qs, [1.0; 3]);
    qs[6 * 4 + 1] = f64::INFINITY;
    assert_eq!(refused(&qs, &measured), "row 4: joint angles must be finite, but joint 'shoulder_lift_joint' is inf");
}

#[test]
fn options_are_checked() {
    let qs = configurations(30);
    let measured = points(&qs, [1.0; 3]);
    let with = |options: CalibrationOptions| calibrate(&arm(), &qs, &measured, &options).unwrap_err();
    let error = with(CalibrationOptions { fit: vec![], ..CalibrationOptions::default() });
    let said = "nothing is to be fitted: name one or more of 'offsets', 'links', 'tool', 'base'";
    assert_eq!(error, Error::Contradiction { problem: said.into() });
    let error = with(CalibrationOptions { sigma: Some(vec![[0.0; 2]; 30]), ..CalibrationOptions::default() });
    assert_eq!(error.to_string(), "standard deviation of a measurement must be positive and finite, got 0");
    let error = with(CalibrationOptions { sigma: Some(vec![[1e-300; 2]; 30]), ..CalibrationOptions::default() });
    let said = "standard deviation of a measurement must be from 1e-100 to 1e100 (m, rad), got ";
    assert!(error.to_string().starts_with(said), "{error}");
    let pairs = Measured::Pairs(vec![0.1; 15]);
    let options = CalibrationOptions { fit: vec![Part::Base], ..CalibrationOptions::default() };
    let error = calibrate(&arm(), &qs, &pairs, &options).unwrap_err().to_string();
    let said =
        "nothing of what is to be fitted has an effect on these measurements: add link transforms or joint offsets";
    assert_eq!(error, said);
}
