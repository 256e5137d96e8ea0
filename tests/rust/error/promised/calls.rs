//! Calls that solve, plan and track.

use super::*;

pub fn calls() -> Vec<Row> {
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
    let at_level = |level| NamedTask {
        subject: Subject::Tip(level as usize),
        task: Some(Task::from(TaskKind::Position).at_level(level)),
        tolerance: Tolerance::default(),
    };
    let each = SolveOptions { tips: vec![at_level(0), at_level(1)], ..SolveOptions::default() };
    let levels = AllOptions { each, ..AllOptions::default() };
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
    let options = TrackOptions { limits: jumping(&two()), ..TrackOptions::default() };
    let still = [0.1, 0.2].repeat(9);
    let calibrated = |robot: &Robot, qs: &[f64], positions: &[[f64; 3]], options: &CalibrationOptions| {
        calibrate(robot, qs, &Measured::Positions(positions.to_vec()), options)
    };
    let plain = CalibrationOptions::default();
    let silent = CalibrationOptions { sigma: Some(vec![[0.0; 2]; 9]), ..plain.clone() };
    let nothing = CalibrationOptions { fit: vec![], ..plain.clone() };
    let lens = |focal, centre| PinholeCamera { focal: [focal; 2], centre: [centre; 2] }.validate();
    promises! {
        "calibrate" InvalidMeasurement: calibrated(&two(), &still, &[[0.0; 3]; 9], &plain), "all configurations are alike: move the arm between measurements, each joint over as much of its range as possible";
        "calibrate" WrongLength: calibrated(&two(), &still, &[[0.0; 3]; 8], &plain), "measurements of robot 'planar2': expected 9, one for each configuration, got 8";
        "calibrate" NotFinite: calibrated(&two(), &still, &[[NAN; 3]; 9], &plain), "measurements must be finite, but row 0, entry 0 is NaN";
        "calibrate" OutOfRange: calibrated(&two(), &still, &[[0.0; 3]; 9], &silent), "standard deviation of a measurement must be positive and finite, got 0";
        "calibrate" SeveralTips: calibrated(&arms(), &still, &[[0.0; 3]; 9], &plain), "calibration takes robots with one tip; this one has left_tool and right_tool: load the robot with one of them as its tip";
        "calibrate" Contradiction: calibrated(&two(), &still, &[[0.0; 3]; 9], &nothing), "nothing is to be fitted: name one or more of 'offsets', 'links', 'tool', 'base'";
        "PinholeCamera::validate" OutOfRange: lens(0.0, 1.0), "focal length (pixels) must be positive and finite, got 0";
        "PinholeCamera::validate" NotFinite: lens(1.0, NAN), "principal point must be finite, but entry 0 is NaN";
        "Robot::urdf_with_geometry" Urdf: two().urdf_with_geometry("<robot"), "URDF line 1: not XML: the document does not have a root node";
        "Robot::urdf_with_geometry" SeveralTips: arms().urdf_with_geometry(&two_arms()), "writing a URDF takes robots with one tip; this one has left_tool and right_tool: load the robot with one of them as its tip";
        "solve_batch" InRow: batch(&[[1.0, 0.5, 0.0], [NAN; 3]]), "row 1: target must be finite, but coordinate x is NaN";
        "solve_all" Contradiction: solve_all(&two(), &position, &turns, &mut Unattended), "taking all whole turns makes 202566 configurations; at most 10000 are allowed: narrow the limits";
        "solve_all_tips" Contradiction: solve_all_tips(&arms(), &[position; 2], &levels, &mut Unattended), "all solutions meet all targets, so levels from 0 to 1 have no effect: give all tasks one level, or solve for one configuration, which meets them in their order";
        "self_motion" Contradiction: self_motion(&two(), &position, &SelfMotionOptions::default(), &mut Unattended), "self_motion needs one joint more than the target: robot 'planar2' has 2 joints, and this target takes 2";
        "plan_batch" InProblem: plans(&[0.0], 1), "problems[0]: start_q of robot 'planar2': expected 2 joints, got 1";
        "plan_batch" OutOfRange: plans(&[0.0; 2], 0), "threads must be from 1 to 1024, got 0";
        "plan_point_to_point" Unreachable: between(&[far()], &[0.0; 2]), "end cannot be reached: the nearest configuration found stays 7.000 m away";
        "plan_point_to_point" NoUsableEnd: between(&[far(), far()], &[0.0; 2]), "none of the 2 ends can be reached: end[0]: the nearest configuration found stays 7.000 m away; end[1]: the nearest configuration found stays 7.000 m away";
        "Move::validate" OutOfRange: Move::new(MoveKind::Wait(-1.0)).validate(), "time must be from 0 to 1000000 s, got -1";
        "Move::validate" NotFinite: Move { name: Some("by".into()), ..Move::new(MoveKind::Arc { via: [NAN; 3], pose: Pose::identity(), angle: None, speed: None }) }.validate(), "via of move 'by' must be finite, but entry 0 is NaN";
        "plan_moves" InvalidMove: program([0.0; 3]), "the program: it has no moves: give at least one";
        "plan_moves" Unreachable: program([-0.9, 0.0, 0.0]), "move 0 'out' cannot be reached: 0.3521 m along it, no solution (no configuration has this pose): move or turn the target into reach, or move the base";
        "plan_moves" NotFound: program([0.3, 0.0, 0.0]), "a motion along move 0 'out' was not found: 0.07500 m along it, joint 'elbow_joint' would have to go to 2.326, beyond its limits [-6.283, 1.900]; begin with a joint move to a pose, so that the planner can choose the configuration";
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
        "Session::reset" Contradiction: eased_session().reset(&[0.55; 2], Some(&[1.0; 2]), None), "joint '0' at 0.5500 with velocity 1.000 and acceleration 0 cannot stop inside its limits; start slower or farther inside";
        "track_tips" WrongLength: track_tips(&two(), &TipPaths { tips: &[], paths: &[reference(4), reference(5)] }, None, &options, &mut Unattended), "a path of several: expected 4 samples of 0.1 s, as the first path has, got 5";
        "ControlSession::command" Contradiction: answered().command(&TipPose::from(&Pose::identity())), "target: expected a position (3,), as before, got a pose (4, 4)";
        "ControlSession::observe" Contradiction: posed().observe(&[0.0; 3].into()), "position: expected a pose (4, 4), like the target, got a position (3,)";
        "Session::step" WrongTarget: turning().step(&Target::Position([1.0, 0.0, 0.0]), &mut Unattended), "task Orientation needs a target pose (4, 4), got a position (3,)";
        "Session::advance" OutOfRange: eased_session().advance(Some(stamped(1.0)), &mut Unattended), "stamp must be at most 0.1, the end of the tick (s) on the clock of the tracker (its time advances by dt in each step; leave stamp out, or give the time of measurement on this clock), got 1";
        "Session::advance" Contradiction: session().advance(Some(stamped(0.0)), &mut Unattended), "a stamp is used by the library's own rule under acceleration or jerk limits; give such limits, or leave stamp out";
        "plan_batch" Unreachable: plan_batch(&two(), &[PlanProblem { ends: vec![far()], ..problem(&[0.0; 2]) }], Some(1), &mut Unattended).unwrap().remove(0), "end cannot be reached: the nearest configuration found stays 7.000 m away";
        "solve_tips" Contradiction: twice(), "tip 'left_tool' has two targets";
        "checkpoint" Interrupted: interruptible(|| false, checkpoint), "interrupted before the end";
    }
}
