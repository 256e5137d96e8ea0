//! Limits, tasks, solvers and controllers.

use super::*;

pub fn tasks_limits_and_solvers() -> Vec<Row> {
    let none = || Limits::none_for(2);
    let nan = Sinusoid { mean: NAN, amplitude: 1.0, angular_frequency: 1.0, phase: 0.0 };
    let within = || Region::new([0.0; 3], [1.0; 3]).unwrap();
    let weighed = |kind, weights: &[f64]| Task::new(kind, Some(weights), None, None);
    let least_torque = |relative_to| Goal::LeastTorque { relative_to, weight: 1.0 };
    let unbounded = Task::new(TaskKind::Position, None, Some(&[f64::INFINITY; 3]), None).unwrap();
    let kept = |tip, task| {
        let named = NamedTask { subject: Subject::Tip(tip), task, tolerance: Tolerance::default() };
        Keep::new(&named, &Target::Position([0.0; 3]))
    };
    promises! {
        "Limits::replace" WrongLength: none().replace(Field::Velocity, vec![Profile::Constant(1.0); 3]), "velocity limit: expected one number, or 2 (one per joint), got 3";
        "Limits::replace" OutOfRange: none().replace(Field::Velocity, vec![Profile::Constant(NAN)]), "velocity limit of joint '0' must be a number, got NaN";
        "Limits::replace" NotFinite: none().replace(Field::Velocity, vec![Profile::Sinusoid(nan)]), "velocity limit of joint '0' must be finite, but mean is NaN";
        "Limits::with_tip_limit" WrongLength: none().with_tip_limit(TipField::Speed, vec![]), "tip speed limit: expected one number, or one per tip, got 0";
        "Limits::with_tip_limit" OutOfRange: none().with_tip_limit(TipField::TurnSpeed, vec![0.0]), "tip turn speed limit must be positive, got 0";
        "Limits::with_torque_limit" WrongLength: constant(Field::Velocity, 1.0).with_torque_limit(vec![1.0; 3]), "torque limit: expected one number, or 2 (one per joint), got 3";
        "Limits::with_torque_limit" OutOfRange: constant(Field::Velocity, 1.0).with_torque_limit(vec![1.0, 0.0]), "torque limit of joint '1' must be positive, got 0";
        "Limits::validate" NegativeLimit: constant(Field::Velocity, -1.0).validate(0.1, 1), "velocity limit of joint '0' is -1 at t = 0 s: a limit cannot be negative";
        "Limits::validate" EmptyRange: crossed().validate(0.1, 1), "joint '0': lower limit 1 is above upper limit 0";
        "Limits::admit_start" OutsideLimits: constant(Field::Upper, 1.0).admit_start(None, "start_q", &[0.0, 1.5], &StartSlack::default()), "start_q: joint '1' at 1.5 is outside its limits [-inf, 1] by 0.5000 rad: moving it to the limit changes the pose; start slack takes a start farther out";
        "Limits::admit_start" WrongLength: constant(Field::Upper, 1.0).admit_start(None, "start_q", &[0.0; 2], &StartSlack::new(vec![0.1; 3]).unwrap()), "start slack: expected one number, or 2 (one per joint), got 3";
        "Limits::admit" OutsideLimits: constant(Field::Upper, 1.0).admit(None, "end_q", &[0.0, 2.0]), "end_q: joint '1' at 2 is outside its limits [-inf, 1] by 1.000 rad: move it inside";
        "Limits::turn_near" UnsupportedLimit: varying(Field::Lower).turn_near(&robot("panda"), &[0.0; 7], &mut [0.0; 7]), "the short way round cannot honour time-varying lower limits: give numbers";
        "StartSlack::new" OutOfRange: StartSlack::new(vec![0.1, NAN]), "start slack must be zero or more, got NaN";
        "StartSlack::new" WrongLength: StartSlack::new(vec![]), "start slack: expected one number, or one per joint, got 0";
        "Bounds::new" WrongLength: Bounds::new(&[0.0], &[1.0, 1.0]), "upper: expected 1 entries as in lower, got 2";
        "Bounds::new" OutOfRange: Bounds::new(&[1.0], &[0.0]), "lower[0] must be at most upper[0] = 0, got 1";
        "Region::new" OutOfRange: Region::new([1.0; 3], [0.0; 3]), "lower x of region must be below its upper one, 0, got 1";
        "Region::require_inside" OutsideRegion: within().require_inside("start_q", &[2.0, 0.5, 0.5]), "start_q: x of the tip, 2 m, is outside its region (0, 1)";
        "Target::validate" NotFinite: Target::Position([NAN; 3]).validate(), "target must be finite, but coordinate x is NaN";
        "Target::validate" OutOfRange: Target::Position([0.0, -1e300, 0.0]).validate(), "target: coordinate y must be from -1e100 to 1e100 m, got -1e300";
        "Tolerance::validate" OutOfRange: Tolerance { position: 0.0, rotation: 1.0 }.validate(), "position_tolerance must be positive, got 0";
        "Task::new" WrongLength: weighed(TaskKind::Position, &[1.0]), "weights of task Position: expected 3 entries (x, y, z), got 1";
        "Task::validate" NotFinite: weighed(TaskKind::Pointing { axis: [NAN; 3] }, &[1.0; 4]), "axis must be finite, but entry 0 is NaN";
        "Task::validate" OutOfRange: weighed(TaskKind::Position, &[-1.0, 1.0, 1.0]), "weights[0] must be zero or more, and finite, got -1";
        "Task::validate" Contradiction: weighed(TaskKind::Pose, &[0.0, 1.0, 1.0, 1.0, 1.0, 1.0]).unwrap().within(within()), "region keeps x, y and z of the base, but weights free some of x, y and z of the target: free all three or none, or take task Position, whose axes are the base's";
        "Task::with_first" Contradiction: Task::from(TaskKind::Position).with_first(First::Position), "task Position has no order of position and orientation ('position' first): take task Pose";
        "Task::target" WrongTarget: weighed(TaskKind::Orientation, &[1.0; 3]).unwrap().target(&Target::Position([0.0; 3])), "task Orientation needs a target pose (4, 4), got a position (3,)";
        "Goal::validate_numbers" Contradiction: least_torque(Some(vec![f64::INFINITY; 7])).validate_numbers(), "relative_to of the goal LeastTorque is infinite for all joints: none would count";
        "Goal::validate_numbers" OutOfRange: Goal::Centring { weight: 0.0 }.validate_numbers(), "weight of a goal must be positive and finite, got 0";
        "Keep::new" Contradiction: kept(0, Some(unbounded)), "nothing would be kept: all tolerances of the task are infinite, or all its weights zero";
        "Keep::new" Contradiction: kept(0, Some(Task::from(TaskKind::Position).at_level(1))), "what is kept comes before all targets, at every instant: leave out the level of its task, 1";
        "Keep::require_tips" Contradiction: kept(1, None).unwrap().require_tips(&two()), "something is to be kept for tip number 1, but the robot has 1";
        "Goal::validate" Contradiction: Goal::Clearance { up_to: 0.1, weight: 1.0 }.validate(&two(), false), "the goal Clearance is for calls with obstacles (perhaps none) or self-collision";
        "Goal::validate" NoDynamics: least_torque(None).validate(&robot("ur5e"), false), "robot 'ur5e' has no dynamics: no link has a mass: give its links inertias";
        "Goal::validate" WrongLength: least_torque(Some(vec![1.0])).validate(&robot("panda"), false), "relative_to of the goal LeastTorque: expected 7 (one per joint), got 1";
        "Goal::validate" OutOfRange: least_torque(Some(vec![0.0; 7])).validate(&robot("panda"), false), "relative_to of the goal LeastTorque, entry 0, must be positive, infinite for a joint that does not count, got 0";
        "Goal::validate" Contradiction: least_torque(Some(vec![f64::INFINITY; 7])).validate(&robot("panda"), false), "relative_to of the goal LeastTorque is infinite for all joints: none would count";
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
