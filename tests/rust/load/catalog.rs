//! Robots from DH tables, planar arms and the catalogue, against published positions and the makers' URDFs.

use std::f64::consts::{FRAC_PI_2, PI};
use std::path::PathBuf;

use ikcore::load::{Dh, DhTable};
use ikcore::math::{Pose, pose};
use ikcore::nalgebra::{Matrix4, Vector3};
use ikcore::robot::{JointKind, Robot};

fn position(robot: &Robot, q: &[f64]) -> Vector3<f64> {
    robot.fk(q).unwrap().translation.vector
}

#[track_caller]
fn assert_near(actual: Vector3<f64>, expected: [f64; 3], tolerance: f64) {
    let error = (actual - Vector3::from(expected)).amax();
    assert!(error <= tolerance, "{actual:?} is {error:.3e} from {expected:?}");
}

#[test]
fn tracking_arms_meet_their_test_vectors() {
    let iiwa = Robot::named("iiwa14").unwrap();
    assert_near(position(&iiwa, &[0.0; 7]), [0.0, 0.0, 1.306], 1e-15);
    assert_near(position(&iiwa, &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]), [0.04133656, -0.00431495, 1.27874931], 5e-9);
    let planar = Robot::named("planar5").unwrap();
    assert_near(position(&planar, &[0.1, 0.2, 0.3, 0.4, 0.5]), [3.38671578, 2.79896207, 0.0], 5e-9);
}

/// Rounded joint angles (Table 3, R_2) and the positions printed for them (Table 4, R_2), Yuan et al. 2016.
const YUAN: [([f64; 6], [f64; 3]); 7] = [
    ([-20.10, -66.53, 184.76, 142.27, 34.16, -147.38], [1.94846, 0.63437, 1.12609]),
    ([-22.00, -75.73, 191.81, 137.42, 33.61, -142.58], [1.78496, 0.63432, 1.22513]),
    ([-24.27, -85.03, 197.50, 130.29, 32.60, -135.18], [1.62150, 0.63419, 1.32414]),
    ([24.27, -85.03, 197.50, 229.71, 32.60, -224.82], [1.62150, -0.63419, 1.32414]),
    ([22.00, -75.73, 191.81, 222.58, 33.61, -217.43], [1.78496, -0.63432, 1.22513]),
    ([20.10, -66.53, 184.76, 217.73, 34.16, -212.62], [1.94846, -0.63437, 1.12609]),
    ([0.01, -78.33, 183.51, 0.16, -44.87, -179.93], [1.91678, 0.00009, 1.55393]),
];

#[test]
fn kr210_reaches_the_positions_printed_by_yuan() {
    let (paper, maker) = (Robot::named("kr210_yuan2016").unwrap(), Robot::named("kr210").unwrap());
    for (degrees, printed) in YUAN {
        let mut q = degrees.map(f64::to_radians);
        assert_near(position(&paper, &q), printed, 5.1e-6);
        // The controller's A3 is 90 degrees less than the paper's angle.
        q[2] -= FRAC_PI_2;
        assert_near(position(&maker, &q), printed, 5.1e-6);
    }
}

#[test]
fn kr210_stands_as_the_data_sheet_draws_it() {
    let upright = position(&Robot::named("kr210").unwrap(), &[0.0, -FRAC_PI_2, FRAC_PI_2, 0.0, 0.0, 0.0]);
    assert_near(upright, [0.35 + 1.2 + 0.215, 0.0, 0.675 + 1.15 - 0.041], 1e-12);
}

#[test]
fn hydraulic3_keeps_its_equations() {
    let arm = Robot::named("hydraulic3").unwrap();
    assert_eq!(arm.joints()[2].kind, JointKind::Prismatic);
    let (q1, q2, q3): (f64, f64, f64) = (0.7, -0.4, 0.2);
    let reach = 0.7 + q3;
    let expected = [0.7 * q1.cos() + reach * (q1 - q2).cos(), 0.7 * q1.sin() + reach * (q1 - q2).sin(), 0.0];
    assert_near(position(&arm, &[q1, q2, q3]), expected, 1e-15);
}

/// Checks base * urdf(q) * tip = catalogue(q) with one constant `tip`, taken from q = 0.
fn assert_same_arm(name: &str, file: &str, urdf_base: &str, urdf_tip: &str, base: Pose, tolerance: f64) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/robots").join(file);
    if !path.exists() {
        println!("skipped {name}: no {}", path.display());
        return;
    }
    let urdf = Robot::from_urdf(&path.display().to_string(), Some(urdf_base), Some(urdf_tip)).unwrap();
    let arm = Robot::named(name).unwrap();
    let at = |robot: &Robot, q: &[f64]| -> Matrix4<f64> { robot.fk(q).unwrap().to_homogeneous() };
    let base = base.to_homogeneous();
    let n = arm.dof();
    let tip = (base * at(&urdf, &vec![0.0; n])).try_inverse().unwrap() * at(&arm, &vec![0.0; n]);
    assert!(tip.column(3).xyz().amax() <= tolerance, "{name}: tips are {tip} apart");
    for sample in 1..20 {
        let q: Vec<f64> = (0..n).map(|i| ((7 * sample + 3 * i) as f64).sin() * 2.5).collect();
        let error = (base * at(&urdf, &q) * tip - at(&arm, &q)).amax();
        assert!(error <= tolerance, "{name} differs from {file} by {error:.3e}");
    }
}

#[test]
fn catalogue_agrees_with_the_urdf_of_the_same_arm() {
    let same = Pose::identity();
    assert_same_arm("panda", "panda.urdf", "panda_link0", "panda_link8", same, 1e-15);
    // The ROS description stands turned by half a turn, and prints quarter turns with 12 digits.
    assert_same_arm("ur5", "ur5.urdf", "base_link", "tool0", pose::rotation(Vector3::z(), PI), 1e-10);
    // Its shoulder and elbow are 0.436 mm off the drawing.
    assert_same_arm("iiwa14", "iiwa14.urdf", "base_link", "tool0", same, 1e-3);
    // The user guide rounds lengths to 0.1 mm and leaves out offsets of 0.2 mm.
    assert_same_arm("gen3", "gen3.urdf", "base_link", "end_effector_link", same, 1e-3);
}

#[test]
fn every_name_builds_and_unknown_ones_suggest() {
    let names: Vec<_> = Robot::names().collect();
    assert!(names.is_sorted(), "{names:?}");
    for name in &names {
        let robot = Robot::named(name).unwrap();
        assert_eq!(robot.name(), *name);
        for joint in robot.joints() {
            assert!(joint.lower < joint.upper && joint.velocity > 0.0, "{name}: {joint:?}");
        }
    }
    assert_eq!(
        Robot::named("iwa14").unwrap_err().to_string(),
        format!("no robot is named 'iwa14' (did you mean 'iiwa14'?); known robots: {}", names.join(", "))
    );
}

/// DH table of two revolute joints around a prismatic one, with every parameter in use.
fn table(convention: Dh) -> DhTable {
    DhTable {
        theta: vec![0.7, -0.8, 0.9],
        kinds: vec![JointKind::Revolute, JointKind::Prismatic, JointKind::Continuous],
        base: pose::translation(1.0, 0.0, 0.0),
        tool: pose::translation(0.0, 2.0, 0.0),
        ..DhTable::new(convention, vec![0.1, 0.2, 0.3], vec![0.4, -0.5, 0.6], vec![1.0, 1.1, 1.2])
    }
}

#[test]
fn dh_tables_multiply_as_their_conventions_say() {
    let q = [0.15, 0.25, 0.35];
    for convention in [Dh::Standard, Dh::Modified] {
        let table = table(convention);
        let mut expected = table.base;
        for i in 0..3 {
            let (theta, d) = match table.kinds[i] {
                JointKind::Prismatic => (table.theta[i], table.d[i] + q[i]),
                _ => (table.theta[i] + q[i], table.d[i]),
            };
            let about_z = pose::rotation(Vector3::z(), theta) * pose::translation(0.0, 0.0, d);
            let about_x = pose::translation(table.a[i], 0.0, 0.0) * pose::rotation(Vector3::x(), table.alpha[i]);
            expected *= if convention == Dh::Standard { about_z * about_x } else { about_x * about_z };
        }
        expected *= table.tool;
        let actual = Robot::from_dh("arm", &table).unwrap().fk(&q).unwrap();
        assert!((actual.to_homogeneous() - expected.to_homogeneous()).amax() < 1e-15, "{convention:?}");
    }
}

#[test]
fn impossible_dh_tables_are_named() {
    let message = |table: DhTable| Robot::from_dh("arm", &table).unwrap_err().to_string();
    assert_eq!(
        message(DhTable { d: vec![0.0; 2], ..table(Dh::Standard) }),
        "d in the DH table of robot 'arm': expected 3 entries, as in a, got 2"
    );
    assert_eq!(
        message(DhTable { alpha: vec![0.0, f64::NAN, 0.0], ..table(Dh::Standard) }),
        "alpha in the DH table of robot 'arm' must be finite, but entry 1 is NaN"
    );
    assert_eq!(
        message(DhTable { lower: vec![0.0; 3], upper: vec![0.0, -1.0, 0.0], ..table(Dh::Standard) }),
        "joint 'joint_2': lower limit 0 is above upper limit -1"
    );
}

#[test]
fn planar_arms_have_their_links_in_the_plane() {
    let arm = Robot::planar(&[2.0, 1.0]).unwrap();
    assert_eq!(arm.link_names().collect::<Vec<_>>(), ["base", "link_1", "link_2", "tip"]);
    assert_eq!((arm.joints()[0].lower, arm.joints()[0].upper), (-PI, PI));
    assert_near(position(&arm, &[FRAC_PI_2, -FRAC_PI_2]), [1.0, 2.0, 0.0], 1e-15);
    assert_eq!(
        Robot::planar(&[1.0, 0.0]).unwrap_err().to_string(),
        "length 1 of a planar arm must be positive and finite, got 0"
    );
    assert_eq!(Robot::planar(&[]).unwrap_err().to_string(), "lengths of a planar arm: expected at least 1, got 0");
}
