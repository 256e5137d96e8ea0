//! Curves against their own derivatives and their geometry; paths, references and error messages.

use ikcore::math::pose;
use ikcore::nalgebra::{Matrix3, Rotation3, Vector3};
use ikcore::path::{Circle, Curve, Hypotrochoid, Path, Plane, Polyline, Reference, Rose, Samples};

const CENTER: [f64; 3] = [0.4, -0.2, 0.7];

/// Plane along no axis of the frame.
fn slanted() -> Plane {
    let turn = Rotation3::from_euler_angles(0.3, -0.8, 1.1);
    Plane::new(CENTER, (turn * Vector3::x()).into(), (turn * Vector3::y()).into()).unwrap()
}

/// Centre (m) of the letter M of Khan et al. 2022, eq. (19), in the plane of y and z.
const M_CENTER: [f64; 3] = [0.1, 0.4, 0.3];

fn published_m() -> Polyline {
    Polyline::letter_m(&Plane::yz(M_CENTER).unwrap(), 0.4, 0.4, 50.0).unwrap()
}

/// Curves of every kind, with the times of their corners.
fn curves() -> Vec<(Box<dyn Curve>, Vec<f64>)> {
    let stairs = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 2.0], [1.0, 1.0, 2.0]];
    let samples = Samples::from_positions(vec![0.0, 0.5, 2.0], vec![[0.0; 3], [0.1, 0.2, 0.3], [-0.3, 0.0, 0.1]]);
    vec![
        (Box::new(Circle::new(slanted(), 0.3, 7.0).unwrap()), vec![]),
        (Box::new(Hypotrochoid::new(slanted(), 0.04, 0.024, 0.04, 50.0).unwrap()), vec![]),
        (Box::new(Rose::new(slanted(), 0.2, 3, 6.0).unwrap()), vec![]),
        (Box::new(Rose::new(slanted(), 0.2, 4, 6.0).unwrap()), vec![]),
        (Box::new(Polyline::pentagram(&slanted(), 0.25, 10.0).unwrap()), vec![2.0, 4.0, 6.0, 8.0]),
        (Box::new(published_m()), vec![12.5, 25.0, 37.5]),
        (Box::new(Polyline::new(&stairs, 8.0).unwrap()), vec![2.0, 6.0]),
        (Box::new(samples.unwrap()), vec![0.5]),
    ]
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (Vector3::from(a) - Vector3::from(b)).norm()
}

#[track_caller]
fn assert_near(a: [f64; 3], b: [f64; 3], tolerance: f64) {
    assert!(distance(a, b) <= tolerance, "{a:?} is not {b:?} to {tolerance}");
}

#[test]
fn velocity_is_the_derivative_of_position() {
    for (curve, corners) in curves() {
        let h = 1e-5 * curve.duration();
        for i in 0..97 {
            let t = curve.duration() * (f64::from(i) + 0.5) / 97.0;
            if corners.iter().any(|corner| (t - corner).abs() <= h) {
                continue;
            }
            let (before, after) = (Vector3::from(curve.position(t - h)), Vector3::from(curve.position(t + h)));
            let difference = (after - before) / (2.0 * h);
            let scale = difference.norm().max(1e-3);
            assert_near(curve.velocity(t), difference.into(), 1e-6 * scale);
        }
    }
}

#[test]
fn time_is_clamped() {
    for (curve, _) in curves() {
        let end = curve.duration();
        assert_eq!(curve.position(-1.0), curve.position(0.0));
        assert_eq!(curve.position(end + 1.0), curve.position(end));
        assert_eq!(curve.velocity(end + 1.0), curve.velocity(end));
    }
}

#[test]
fn closed_curves_close() {
    let closed: [Box<dyn Curve>; 5] = [
        Box::new(Circle::new(slanted(), 0.3, 7.0).unwrap()),
        Box::new(Hypotrochoid::new(slanted(), 0.04, 0.024, 0.04, 50.0).unwrap()),
        Box::new(Rose::new(slanted(), 0.2, 3, 6.0).unwrap()),
        Box::new(Rose::new(slanted(), 0.2, 4, 6.0).unwrap()),
        Box::new(Polyline::pentagram(&slanted(), 0.25, 10.0).unwrap()),
    ];
    for curve in closed {
        assert_near(curve.position(0.0), curve.position(curve.duration()), 1e-14);
        let half = curve.position(0.5 * curve.duration());
        assert!(distance(curve.position(0.0), half) > 1e-3, "{curve:?} is drawn more than once");
    }
}

#[test]
fn circle_is_that_of_cheng_2020() {
    // Eq. (14) with the values of the paper's second example, at quarter turns.
    let circle = Circle::new(Plane::xy([0.3, 0.3, 1.0]).unwrap(), 0.2, 30.0).unwrap();
    assert_near(circle.position(0.0), [0.4, 0.3, 1.0], 1e-15);
    assert_near(circle.position(7.5), [0.3, 0.4, 1.0], 1e-15);
    assert_near(circle.position(15.0), [0.2, 0.3, 1.0], 1e-15);
    assert_near(circle.velocity(0.0), [0.0, 0.1 * std::f64::consts::TAU / 30.0, 0.0], 1e-15);
}

#[test]
fn letter_m_is_that_of_khan_2022() {
    let m = published_m();
    let vertices = [[0.1, 0.2, 0.1], [0.1, 0.2, 0.5], [0.1, 0.4, 0.3], [0.1, 0.6, 0.5], [0.1, 0.6, 0.1]];
    for (segment, vertex) in vertices.into_iter().enumerate() {
        assert_near(m.position(12.5 * segment as f64), vertex, 1e-15);
    }
}

#[test]
fn hypotrochoid_is_the_star_with_three_turns() {
    // R = 5, r = 3, d = 5 in units of 8 mm, checked at quarter turns of the arm against the formula by hand.
    let [outer, inner, pen, turns] = [0.04, 0.024, 0.04, 3.0];
    let star = Hypotrochoid::new(Plane::yz([0.1, 0.3, 0.2]).unwrap(), outer, inner, pen, 50.0).unwrap();
    for quarter in 0..=12 {
        let u = std::f64::consts::FRAC_PI_2 * f64::from(quarter);
        let spin = (outer - inner) / inner * u;
        let y = 0.3 + (outer - inner) * u.cos() + pen * spin.cos();
        let z = 0.2 + (outer - inner) * u.sin() - pen * spin.sin();
        assert_near(star.position(50.0 * f64::from(quarter) / (4.0 * turns)), [0.1, y, z], 1e-15);
    }
}

#[test]
fn pentagram_has_five_equal_strokes_and_points_up() {
    let star = Polyline::pentagram(&Plane::yz(CENTER).unwrap(), 0.5, 5.0).unwrap();
    assert_near(star.position(0.0), [CENTER[0], CENTER[1], CENTER[2] + 0.5], 1e-15);
    let segment = 2.0 * 0.5 * (72.0_f64).to_radians().sin();
    for i in 0..5 {
        let (from, to) = (star.position(f64::from(i)), star.position(f64::from(i + 1)));
        assert!((distance(from, to) - segment).abs() < 1e-15);
        assert!((distance(from, CENTER) - 0.5).abs() < 1e-15);
    }
}

#[test]
fn rose_has_k_or_twice_k_petals() {
    for (k, petals) in [(1, 1), (2, 4), (3, 3), (5, 5)] {
        let rose = Rose::new(Plane::xy(CENTER).unwrap(), 0.2, k, 1.0).unwrap();
        let radii: Vec<f64> = (0..=1000).map(|i| distance(rose.position(f64::from(i) / 1000.0), CENTER)).collect();
        let interior = radii.windows(3).filter(|r| r[1] > r[0] && r[1] >= r[2] && r[1] > 0.199).count();
        // The first petal is begun at its point and finished at the end.
        assert_eq!(interior + 1, petals, "k = {k}");
    }
}

#[test]
fn polyline_keeps_one_speed_and_meets_its_corners() {
    let points = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 4.0, 0.0], [3.0, 4.0, 1.0]];
    let line = Polyline::new(&points, 16.0).unwrap();
    for i in 0..160 {
        let speed = Vector3::from(line.velocity(0.1 * f64::from(i))).norm();
        assert!((speed - 0.5).abs() < 1e-14, "{speed} m/s");
    }
    assert_eq!([0.0, 6.0, 14.0, 16.0].map(|t| line.position(t)), [points[0], points[1], points[3], points[4]]);
}

#[test]
fn sampled_poses_turn_about_a_fixed_axis() {
    let axis = Vector3::new(1.0, -2.0, 0.5).normalize();
    // From the smallest turn to almost half of one.
    for angle in [1e-9, 1e-3, 1.0, 3.1] {
        let start = pose::from_rpy([0.2, 0.4, -2.0], [0.0, 0.0, 1.0]);
        let end = start * pose::rotation(axis, angle);
        let path = Path::new(Samples::from_poses(vec![0.0, 4.0], &[start, end]).unwrap());
        for t in [0.0, 1.0, 2.5, 4.0] {
            let expected = start * pose::rotation(axis, angle * t / 4.0);
            let deviation = (path.rotation(t).unwrap() - expected.rotation.matrix()).amax();
            assert!(deviation < 4e-15, "turn of {angle} rad at {t} s: {deviation}");
        }
        assert_eq!(path.pose(2.0).unwrap().translation.vector, Vector3::new(0.0, 0.0, 1.0));
    }
}

#[test]
fn orientation_of_a_path_is_none_constant_or_its_own() {
    let circle = Path::new(Circle::new(slanted(), 0.3, 7.0).unwrap());
    assert!(circle.pose(1.0).is_none());
    let turn = *Rotation3::from_euler_angles(0.1, 0.2, 0.3).matrix();
    let turned = circle.with_orientation(turn).unwrap();
    assert!((turned.pose(3.0).unwrap().rotation.matrix() - turn).amax() < 1e-15);
    assert_eq!(turned.position(3.0), circle.position(3.0));

    let poses = [pose::translation(0.0, 0.0, 0.0), pose::translation(1.0, 0.0, 0.0)];
    let samples = Path::new(Samples::from_poses(vec![0.0, 1.0], &poses).unwrap());
    assert_eq!(samples.rotation(0.5), Some(Matrix3::identity()));
    assert!((samples.with_orientation(turn).unwrap().rotation(0.5).unwrap() - turn).amax() < 1e-15);
}

#[test]
fn reference_covers_the_path_in_ticks() {
    let path = Path::new(Circle::new(slanted(), 0.3, 1.0).unwrap());
    // 1 / 0.1 is ten ticks although 0.1 is not exact; a true remainder is one more tick, held at the end.
    for (dt, rows) in [(0.1, 11), (0.3, 5), (1.0, 2)] {
        let reference = path.sample(dt).unwrap();
        assert_eq!((reference.len(), reference.dt()), (rows, dt));
        for i in 0..rows {
            assert_eq!(reference.time(i), i as f64 * dt);
            assert_eq!(reference.position(i), path.position(i as f64 * dt));
            assert_eq!(reference.rotation(i), None);
        }
    }
    let turned = path.with_orientation(Matrix3::identity()).unwrap().sample(0.5).unwrap();
    assert_eq!(turned.rotation(2), Some(Matrix3::identity()));
}

/// Message of an expected error.
#[track_caller]
fn message<T>(result: ikcore::Result<T>) -> String {
    match result {
        Ok(_) => panic!("this must be an error"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn wrong_curves_are_named() {
    let plane = || Plane::xy(CENTER).unwrap();
    let ends = [[0.0; 3], [1.0, 0.0, 0.0]];
    for (result, expected) in [
        (Circle::new(plane(), 0.2, 0.0).map(|_| ()), "duration must be positive and finite, got 0"),
        (Circle::new(plane(), 0.2, f64::NAN).map(|_| ()), "duration must be positive and finite, got NaN"),
        (Circle::new(plane(), -0.2, 1.0).map(|_| ()), "diameter must be positive and finite, got -0.2"),
        (Rose::new(plane(), 0.2, 3, -1.0).map(|_| ()), "duration must be positive and finite, got -1"),
        (
            Rose::new(plane(), 0.2, 0, 1.0).map(|_| ()),
            "k must be at least 1 (a rose without petals is a circle), got 0",
        ),
        (
            Hypotrochoid::new(plane(), 0.1, 0.2, 0.1, 1.0).map(|_| ()),
            "inner_radius must be smaller than outer_radius, got 0.2",
        ),
        (
            Hypotrochoid::new(plane(), 2.0_f64.sqrt(), 1.0, 0.1, 1.0).map(|_| ()),
            "path: outer_radius / inner_radius = 1.4142135623730951 is no ratio of integers with a denominator up to \
             100, so the hypotrochoid does not close",
        ),
        (Polyline::new(&[], 1.0).map(|_| ()), "path: it needs at least 2 points, got 0"),
        (Polyline::new(&ends, -3.0).map(|_| ()), "duration must be positive and finite, got -3"),
        (
            Polyline::new(&[ends[0], [0.0, f64::NAN, 0.0]], 1.0).map(|_| ()),
            "path points must be finite, but y of row 1 is NaN",
        ),
        (
            Polyline::new(&[ends[1]; 3], 1.0).map(|_| ()),
            "path: the points of a polyline must span a positive, finite length, not 0 m",
        ),
        (Polyline::letter_m(&plane(), 0.0, 1.0, 1.0).map(|_| ()), "width must be positive and finite, got 0"),
        (Polyline::pentagram(&plane(), 1.0, 0.0).map(|_| ()), "duration must be positive and finite, got 0"),
        (Plane::xy([0.0, f64::INFINITY, 0.0]).map(|_| ()), "path center must be finite, but entry 1 is inf"),
        (
            Plane::new(CENTER, [1.0, 0.0, 0.0], [0.5, 2.0, 0.0]).map(|_| ()),
            "path: axes a and b must be orthonormal, but |a| = 1, |b| = 2.0615528128088303 and a.b = 0.5",
        ),
    ] {
        assert_eq!(message(result), expected);
    }
}

#[test]
fn wrong_samples_are_named_by_row() {
    let rows = vec![[0.0; 3]; 3];
    for (times, positions, expected) in [
        (vec![], vec![], "path: it needs at least 2 points, got 0"),
        (vec![0.0, 1.0], rows.clone(), "path times: expected 3, one a point, got 2"),
        (vec![0.0, 1.0, 1.0], rows.clone(), "path times must increase, but row 2 has 1 after 1"),
        (vec![0.0, 1.0, 0.5], rows.clone(), "path times must increase, but row 2 has 0.5 after 1"),
        (
            vec![0.5, 1.0, 2.0],
            rows.clone(),
            "path times: row 0 must be 0, where the clock starts (take the first time from all), got 0.5",
        ),
        (vec![0.0, f64::NAN, 2.0], rows, "path times must be finite, but row 1 is NaN"),
    ] {
        assert_eq!(message(Samples::from_positions(times, positions)), expected);
    }
}

#[test]
fn wrong_references_are_named() {
    let path = Path::new(Circle::new(slanted(), 0.3, 1.0).unwrap());
    let rows = vec![[0.0; 3]; 2];
    let scaled = Matrix3::identity() * 2.0;
    for (result, expected) in [
        (path.sample(0.0), "dt must be positive and finite, got 0"),
        (path.sample(f64::NAN), "dt must be positive and finite, got NaN"),
        (path.sample(1.5), "dt must be at most 1 s, which the path takes, got 1.5"),
        (path.sample(1e-9), "dt must be at least 0.0000001 s to cover 1 s in 10 million ticks, got 0.000000001"),
        (Reference::new(0.1, vec![[0.0; 3]], None), "path: it needs at least 2 points, got 1"),
        (
            Reference::new(0.1, rows.clone(), Some(vec![Matrix3::identity()])),
            "path rotations: expected 2, one a position, got 1",
        ),
        (
            Reference::new(0.1, rows, Some(vec![Matrix3::identity(), scaled])),
            "path rotation of row 1 is not a rigid transform: R'R differs from the identity by 3.000e0; the nearest rotation is U V' of its singular value decomposition U S V'",
        ),
    ] {
        assert_eq!(message(result), expected);
    }
    let mirror = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, -1.0));
    assert_eq!(
        message(path.with_orientation(mirror)),
        "path orientation is not a rigid transform: its rotation is a reflection (determinant -1): turn one of its axes round"
    );
}
