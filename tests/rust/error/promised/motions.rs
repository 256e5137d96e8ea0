//! Curves, paths, timings and trajectories.

use super::*;

pub fn paths_and_trajectories() -> Vec<Row> {
    let polyline = |waypoints: &[f64]| JointPath::polyline(names(2), waypoints, 0.1);
    let spline =
        |waypoints: &[f64], knots: Option<&[f64]>| JointPath::spline(names(2), waypoints, knots, SplineEnds::Natural);
    let timed = |limits: Limits, options: TimingOptions| {
        time_optimal(
            &polyline(&[0.0, 0.0, 1.0, 1.0]).unwrap(),
            &ConstantLimits::new(&limits, "time_optimal").unwrap(),
            &options,
        )
    };
    let too_far = || {
        let limits = ConstantLimits::new(&rated(), "time_optimal").unwrap();
        time_optimal(&spline(&[0.0, 0.0, 1.0, 1e300], None).unwrap(), &limits, &TimingOptions::default())
    };
    let swung = || {
        let limits = ConstantLimits::new(&rated(), "time_optimal").unwrap();
        let path = spline(&[0.0, 0.0, 1.0, 1.0, 3.0, 1.0], Some(&[0.0, 1e-300, 1.0])).unwrap();
        time_optimal(&path, &limits, &TimingOptions::default())
    };
    let within = |tolerance: &[f64], limits: Limits| {
        let path = JointPath::spline(names(2), &[0.0, 0.0, 1.0, 1.0], None, SplineEnds::Natural).unwrap();
        let limits = ConstantLimits::new(&limits, "time_optimal").unwrap();
        time_optimal_within(&path, tolerance, &limits, &TimingOptions::default())
    };
    let of_path = |limits: &Limits| ConstantLimits::of_path(&Robot::planar(&[1.0; 2]).unwrap(), limits, "time_optimal");
    let motion = || Trajectory::from_samples(names(1), &[0.0, 1.0], &[0.0, 1.0], None, None).unwrap();
    promises! {
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
        "Reference::new" NotRigid: Reference::new(0.1, HALVES.to_vec(), Some(vec![Matrix3::identity(), twisted()])), "path rotation of row 1 is not a rigid transform: R'R differs from the identity by 3.000e0; the nearest rotation is U V' of its singular value decomposition U S V'";
        "Reference::with_velocities" WrongLength: reference(2).with_velocities(vec![[0.0; 3]]), "path velocities: expected 2, one a position, got 1";
        "Reference::with_velocities" NotFinite: reference(2).with_velocities(vec![[0.0; 3], [NAN; 3]]), "path velocities must be finite, but x of row 1 is NaN";
        "Rose::new" OutOfRange: Rose::new(plane(), 1.0, 0, 1.0), "k must be at least 1 (a rose without petals is a circle), got 0";
        "Samples::from_positions" InvalidPath: Samples::from_positions(vec![0.0], vec![[0.0; 3]]), "path: it needs at least 2 points, got 1";
        "Samples::from_positions" WrongLength: Samples::from_positions(vec![0.0], HALVES.to_vec()), "path times: expected 2, one a point, got 1";
        "Samples::from_positions" NotFinite: Samples::from_positions(vec![0.0, NAN], HALVES.to_vec()), "path times must be finite, but row 1 is NaN";
        "Samples::from_positions" OutOfRange: Samples::from_positions(vec![1.0, 2.0], HALVES.to_vec()), "path times: row 0 must be 0, where the clock starts (take the first time from all), got 1";
        "Samples::from_positions" NotIncreasing: Samples::from_positions(vec![0.0, 0.0], HALVES.to_vec()), "path times must increase, but row 1 has 0 after 0";
        "Path::with_orientation" NotFinite: Path::new(Circle::new(plane(), 1.0, 1.0).unwrap()).with_orientation(Matrix3::identity() * NAN), "path orientation must be finite, but entry (0, 0) is NaN";
        "Path::with_orientation" NotRigid: Path::new(Circle::new(plane(), 1.0, 1.0).unwrap()).with_orientation(twisted()), "path orientation is not a rigid transform: R'R differs from the identity by 3.000e0; the nearest rotation is U V' of its singular value decomposition U S V'";
        "Path::sample" OutOfRange: Path::new(Circle::new(plane(), 1.0, 1.0).unwrap()).sample(0.0), "dt must be positive and finite, got 0";
        "Path::from_bytes" Corrupt: Path::from_bytes(&[1, 2, 3]), "cannot restore path: it was stored in format 1 by an earlier version of beetle-ik, and this one reads format 3: make it anew";
        "Plan::from_bytes" Corrupt: Plan::from_bytes(&[1, 2, 3]), "cannot restore plan: it was stored in format 1 by an earlier version of beetle-ik, and this one reads format 3: make it anew";
        "Waypoints::new" InvalidPath: Waypoints::new(vec![[0.0; 3]], None), "path: it needs at least 2 points, got 1";
        "Waypoints::new" WrongLength: Waypoints::new(HALVES.to_vec(), Some(vec![Matrix3::identity()])), "path rotations: expected 2, one a position, got 1";
        "Waypoints::new" NotFinite: Waypoints::new(vec![[0.0; 3], [NAN; 3]], None), "path points must be finite, but x of row 1 is NaN";
        "Waypoints::new" NotRigid: Waypoints::new(HALVES.to_vec(), Some(vec![Matrix3::identity(), twisted()])), "path rotation of row 1 is not a rigid transform: R'R differs from the identity by 3.000e0; the nearest rotation is U V' of its singular value decomposition U S V'";
        "TipPath::through" InvalidPath: TipPath::through(&Waypoints::new(vec![[0.0; 3]; 2], None).unwrap()), "path: point 1 repeats point 0: leave it out";
        "TipPath::sampled" InvalidPath: TipPath::sampled(vec![0.0, 1.0], vec![[0.0; 3]; 2], None), "path: it must lead somewhere, but it is 0 m long";
        "JointPath::polyline" WrongLength: polyline(&[0.0, 0.0, 1.0]), "waypoints: expected rows of 2 joints, got 3";
        "JointPath::polyline" NotFinite: polyline(&[0.0, 0.0, 1.0, NAN]), "waypoints must be finite, but joint 'joint_2' of row 1 is NaN";
        "JointPath::polyline" InvalidPath: polyline(&[0.0, 0.0, 0.0, 0.0]), "path: all waypoints are the same: give at least two that differ";
        "JointPath::polyline" OutOfRange: JointPath::polyline(names(1), &[0.0, 1.0], -1.0), "blend must be zero or more and finite, got -1";
        "JointPath::spline" WrongLength: spline(&[0.0, 0.0, 1.0], None), "waypoints: expected rows of 2 joints, got 3";
        "JointPath::spline" NotFinite: spline(&[0.0, 0.0, 1.0, NAN], None), "waypoints must be finite, but joint 'joint_2' of row 1 is NaN";
        "JointPath::spline" InvalidPath: spline(&[0.0, 0.0, 0.0, 0.0], None), "path: all waypoints are the same: give at least two that differ";
        "JointPath::spline" NotIncreasing: spline(&[0.0, 0.0, 1.0, 1.0, 2.0, 2.0], Some(&[0.0, 2.0, 1.0])), "knots must increase, but row 2 has 1 after 2";
        "time_optimal" Infeasible: timed(rated().replace(Field::Upper, vec![Profile::Constant(0.5)]).unwrap(), TimingOptions::default()), "infeasible: the path takes joint 'joint_1' to 1, beyond its upper limit 0.5";
        "time_optimal" OutOfRange: timed(rated(), TimingOptions { gridpoints: Some(0), ..Default::default() }), "gridpoints must be from 3 to 200000, got 0";
        "time_optimal" InvalidPath: too_far(), "path: joint 'joint_2' moves by 1.000e300, for which the limits leave a time beyond floating-point numbers: check the units of waypoints, knots and limits";
        "time_optimal" InvalidPath: swung(), "path: between its waypoints joint 'joint_2' swings to positions beyond floating-point numbers: check the units of waypoints, knots and limits";
        "time_optimal_within" WrongLength: within(&[0.1], rated()), "tolerance: expected 2 (one per joint), got 1";
        "time_optimal_within" OutOfRange: within(&[-0.1, 0.1], rated()), "tolerance of joint 'joint_1' must be zero or more and finite, got -0.1";
        "time_optimal_within" Infeasible: within(&[0.1; 2], rated().replace(Field::Upper, vec![Profile::Constant(0.5)]).unwrap()), "infeasible: the path takes joint 'joint_1' to 1, beyond its upper limit 0.5";
        "ConstantLimits::new" UnsupportedLimit: ConstantLimits::new(&varying(Field::Acceleration), "time_optimal"), "time_optimal cannot honour time-varying acceleration limits: when a point of the path is passed is what it looks for; give numbers";
        "ConstantLimits::new" NegativeLimit: ConstantLimits::new(&constant(Field::Acceleration, -1.0), "time_optimal"), "acceleration limit of joint '0' is -1 at t = 0 s: a limit cannot be negative";
        "ConstantLimits::new" EmptyRange: ConstantLimits::new(&crossed(), "time_optimal"), "joint '0': lower limit 1 is above upper limit 0";
        "ConstantLimits::of_path" UnsupportedLimit: of_path(&varying(Field::Acceleration)), "time_optimal cannot honour time-varying acceleration limits: give numbers";
        "ConstantLimits::of_path" OutOfRange: of_path(&constant(Field::Velocity, 0.0)), "velocity limit of joints '0', '1' must be positive, got 0";
        "ConstantLimits::of_path" EmptyRange: of_path(&crossed()), "joint '0': lower limit 1 is above upper limit 0";
        "ConstantLimits::of_path" NegativeLimit: of_path(&constant(Field::Acceleration, -1.0)), "acceleration limit of joint '0' is -1 at t = 0 s: a limit cannot be negative";
        "ConstantLimits::of_path" WrongLength: of_path(&Limits::none_for(3)), "limits for robot 'planar2': expected 2 joints, got 3";
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
        "from_drifted" NotFinite: pose::from_drifted("target", &(Matrix4::identity() * NAN)), "target must be finite, but entry (0, 0) is NaN";
        "from_drifted" NotRigid: pose::from_drifted("target", &(Matrix4::identity() * 2.0)), "target is not a rigid transform: its last row is (0, 0, 0, 2), not (0, 0, 0, 1)";
        "from_matrix" NotRigid: pose::from_matrix("target", &(Matrix4::identity() * 2.0)), "target is not a rigid transform: its last row is (0, 0, 0, 2), not (0, 0, 0, 1)";
        "state_to_state" WrongLength: state_to_state(&state(&[0.0; 2]), &state(&[1.0]), &rated()), "end_q: expected 2 joints, got 1";
        "state_to_state" NotFinite: state_to_state(&state(&[0.0, NAN]), &state(&[1.0; 2]), &rated()), "start_q must be finite, but joint '1' is NaN";
        "state_to_state" UnsupportedLimit: state_to_state(&state(&[0.0; 2]), &state(&[1.0; 2]), &varying(Field::Velocity)), "state_to_state cannot honour time-varying velocity limits: give numbers";
        "state_to_state" OutOfRange: state_to_state(&state(&[0.0; 2]), &state(&[1.0; 2]), &constant(Field::Velocity, 0.0)), "velocity limit of joints '0', '1' must be positive, got 0";
        "state_to_state" NoPace: state_to_state(&state(&[0.0; 2]), &state(&[1.0; 2]), &Limits::none_for(2)), "joints '0', '1' have neither a velocity nor an acceleration limit, so that nothing sets their pace: give a velocity limit";
        "state_to_state" OutsideLimits: state_to_state(&state(&[0.0; 2]), &state(&[1.0; 2]), &rated().replace(Field::Upper, vec![Profile::Constant(0.5)]).unwrap()), "end_q: joint '0' at 1 is outside its limits [-inf, 0.5] by 0.5000 rad: moving it to the limit changes the pose";
        "state_to_state" Infeasible: state_to_state(&moving(&[0.4; 2], &[1.0; 2]), &state(&[0.2; 2]), &rated().replace(Field::Upper, vec![Profile::Constant(0.5)]).unwrap()), "infeasible: joint '0' would get to 0.6500, beyond its upper limit 0.5000: begin or end it slower, or farther from its limit";
        "state_to_state" InvalidTrajectory: state_to_state(&state(&[0.0; 2]), &state(&[0.0; 2]), &rated()), "trajectory: start_q and end_q, with their velocities and accelerations, are the same state: nothing moves";
        "stop" InvalidTrajectory: stop(&state(&[0.0; 2]), &rated()), "trajectory: the arm is at rest: nothing has to stop";
        "Path::to_bytes" InvalidPath: Path::new(Own).to_bytes(), "path: a curve of your own cannot be stored; store its samples";
        "Path::from_bytes" OutOfRange: spoiled_circle(1.7, -1.0), "duration of the stored path must be positive and finite, got -1";
        "Path::from_bytes" NotFinite: spoiled_circle(0.1234, NAN), "stored path must be finite, but x at t = 0 s is NaN";
        "Path::from_bytes" NotRigid: spoiled_circle(0.5_f64.sin(), 2.0), "orientation of the stored path is not a rigid transform: R'R differs from the identity by 3.770e0; the nearest rotation is U V' of its singular value decomposition U S V'";
        "Samples::from_poses" NotRigid: Samples::from_poses(vec![0.0, 1.0], &[Pose::identity(), scaled()]), "path rotation of row 1 is not a rigid transform: R'R differs from the identity by 3.000e0; the nearest rotation is U V' of its singular value decomposition U S V'";
        "checked" NotFinite: pose::checked("tool", lost()), "tool must be finite, but entry (0, 3) is NaN";
    }
}
