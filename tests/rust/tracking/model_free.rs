//! Model-free tracking: the secant controller, and promises of every controller on any plant.

use std::collections::VecDeque;

use crate::common::{StopAt, bits, message, robot};
use ikcore::limits::{Field, Limits, Profile, Sinusoid};
use ikcore::path::{Circle, Path, Plane, Reference};
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::solver::{BroydenBas, Status, Unattended};
use ikcore::task::Tolerance;
use ikcore::tracking::{
    Antenna, ControlSession, Controller, Fault, FunctionPlant, KinematicPlant, ModelFreeOptions, ModelFreeRecord,
    Plant, TipPose, Znnbas, track_model_free,
};

const SEEDS: u64 = 20;

/// Configuration on the circle of Cheng et al. (2020).
const ON_CIRCLE: [f64; 7] = [0.5449219327, 0.1036664288, 0.0969337234, -0.8713896072, 0.1027968992, 0.6179441060, 0.0];

fn circle() -> Reference {
    circle_at(0.2)
}

fn circle_at(dt: f64) -> Reference {
    let plane = Plane::xy([0.3, 0.3, 1.0]).unwrap();
    Path::new(Circle::new(plane, 0.2, 30.0).unwrap()).sample(dt).unwrap()
}

/// Limits of that paper: 2 + 0.004 sin t (rad/s).
fn circle_limits(robot: &Robot) -> Limits {
    let limit = Sinusoid { mean: 2.0, amplitude: 0.004, angular_frequency: 1.0, phase: 0.0 };
    Limits::of(robot).replace(Field::Velocity, vec![Profile::Sinusoid(limit)]).unwrap()
}

fn on_circle(plant: &mut dyn Plant, options: &ModelFreeOptions) -> ModelFreeRecord {
    track_model_free(plant, &circle(), &ON_CIRCLE, options, &mut Unattended).unwrap()
}

fn options(seed: u64) -> ModelFreeOptions {
    ModelFreeOptions { limits: Some(circle_limits(&robot("iiwa14"))), seed, ..ModelFreeOptions::default() }
}

/// Arm with link errors of up to 2 cm and joint errors of up to 2 degrees.
fn wrong_arm(seed: u64) -> Robot {
    robot("iiwa14").with_errors(0.02, 2_f64.to_radians(), &mut rng::stream(seed, 9)).unwrap()
}

/// Nominal arm with a noiseless sensor.
fn exact_plant() -> KinematicPlant {
    KinematicPlant::new(robot("iiwa14"), 0.0, 0).unwrap()
}

/// Root mean square of `errors` over rows 20 to 149.
fn rms(errors: impl Fn(usize) -> f64) -> f64 {
    ((20..150).map(|i| errors(i).powi(2)).sum::<f64>() / 130.0).sqrt()
}

/// Distance of the true arm's tip from its target in row `i`.
fn true_error(arm: &Robot, record: &ModelFreeRecord, i: usize) -> f64 {
    distance(arm.tip_position(&record.track.q[7 * i..][..7]), record.track.reference[i])
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn broyden_tracks_to_a_nanometre_in_four_measurements() {
    let record = on_circle(&mut exact_plant(), &options(0));
    assert_eq!(record.track.status, Status::Solved, "{}", record.message());
    assert!(record.track.position_error.iter().all(|error| *error <= 1e-9));
    assert!(record.track.evaluations() <= 700, "{}", record.track.evaluations());
    assert_eq!(record.track.max_violation, 0.0);
    assert_eq!(record.command, record.track.q, "what was accepted was measured");
}

#[test]
fn a_wrong_model_makes_no_difference_to_who_has_none() {
    for seed in 0..SEEDS {
        let wrong = wrong_arm(seed);
        let designed = robot("iiwa14").tip_position(&ON_CIRCLE);
        assert!(distance(wrong.tip_position(&ON_CIRCLE), designed) > 1e-3, "seed {seed} is hardly wrong");
        let record = on_circle(&mut KinematicPlant::new(wrong, 0.0, 0).unwrap(), &options(0));
        assert!(
            record.track.position_error[1..].iter().all(|error| *error <= 1e-6),
            "seed {seed}: {}",
            record.message()
        );
        assert_eq!(record.track.max_violation, 0.0, "seed {seed}");
    }
}

#[test]
fn noise_of_the_sensor_is_not_much_more_than_passed_on() {
    for seed in 0..SEEDS {
        let wrong = wrong_arm(seed);
        let record = on_circle(&mut KinematicPlant::new(wrong.clone(), 1e-4, seed).unwrap(), &options(seed));
        let rms = rms(|i| true_error(&wrong, &record, i));
        assert!(rms <= 3.0 * 1e-4 * 3_f64.sqrt(), "seed {seed}: {rms:.2e}");
        assert_eq!(record.track.max_violation, 0.0, "seed {seed}");
    }
}

#[test]
fn one_measurement_per_step_withstands_noise() {
    let reference = circle_at(0.05);
    let mut largest: Vec<f64> = (0..SEEDS)
        .map(|seed| {
            let wrong = wrong_arm(seed);
            let mut plant = KinematicPlant::new(wrong.clone(), 1e-4, seed).unwrap();
            let controller =
                Controller::BroydenBas(BroydenBas { max_evaluations_per_step: 1, ..BroydenBas::default() });
            let options = ModelFreeOptions { controller, limits: None, ..options(seed) };
            let record = track_model_free(&mut plant, &reference, &ON_CIRCLE, &options, &mut Unattended).unwrap();
            (20..record.track.rows()).map(|i| true_error(&wrong, &record, i)).fold(0.0, f64::max)
        })
        .collect();
    largest.sort_by(f64::total_cmp);
    // An arm that puts out its antennae again falls 8 mm behind its target: few do.
    assert!(largest[SEEDS as usize / 2] <= 1e-3, "{largest:?}");
}

/// 90th percentile of the true error in rows 20 to 149.
fn ninetieth(arm: &Robot, record: &ModelFreeRecord) -> f64 {
    let mut errors: Vec<f64> = (20..150).map(|i| true_error(arm, record, i)).collect();
    errors.sort_by(f64::total_cmp);
    errors[117]
}

#[test]
fn outliers_of_the_sensor_are_withstood() {
    for seed in 0..SEEDS {
        let (wrong, mut rng) = (wrong_arm(seed), rng::stream(seed, 2));
        // One measurement in a hundred is wrong by a decimetre.
        let mut plant = FunctionPlant(|q: &[f64]| {
            let outlier = if rng.uniform() < 0.01 { 0.1 } else { 0.0 };
            wrong.tip_position(q).map(|x| x + outlier * rng.normal_pair()[0])
        });
        let record = on_circle(&mut plant, &options(0));
        let error = ninetieth(&wrong, &record);
        assert!(error <= 1e-8, "seed {seed}: {error:.1e}");
    }
}

/// Plant whose sensor is `late` measurements late.
fn late_plant(late: usize) -> impl Plant {
    let arm = robot("iiwa14");
    let mut on_the_way = VecDeque::from(vec![ON_CIRCLE.to_vec(); late]);
    FunctionPlant(move |q: &[f64]| {
        on_the_way.push_back(q.to_vec());
        arm.tip_position(&on_the_way.pop_front().unwrap())
    })
}

#[test]
fn a_late_sensor_costs_measurements_and_no_accuracy() {
    let broyden = BroydenBas { sensor_delay: 1, max_evaluations_per_step: 40, ..BroydenBas::default() };
    let record =
        on_circle(&mut late_plant(1), &ModelFreeOptions { controller: Controller::BroydenBas(broyden), ..options(0) });
    assert_eq!(record.track.status, Status::Solved, "{}", record.message());
    assert!(record.track.evaluations() <= 1400, "{}", record.track.evaluations());
    assert_eq!(record.sensor_delay, None);
    let plane = Plane::xy([0.3, 0.3, 1.0]).unwrap();
    let fine = Path::new(Circle::new(plane, 0.2, 30.0).unwrap()).sample(1e-3).unwrap();
    let znnbas = Znnbas { sensor_delay: 20, ..Znnbas::default() };
    let options = ModelFreeOptions {
        controller: Controller::Znnbas(znnbas),
        tolerance: Tolerance { position: 0.02, rotation: 0.02 },
        ..options(0)
    };
    let record = track_model_free(&mut late_plant(20), &fine, &ON_CIRCLE, &options, &mut Unattended).unwrap();
    assert_eq!(record.track.status, Status::Solved, "{}", record.message());
}

#[test]
fn a_step_with_a_late_sensor_needs_little_more_than_its_delay() {
    let broyden = BroydenBas { sensor_delay: 2, max_evaluations_per_step: 60, ..BroydenBas::default() };
    let tolerance = Tolerance { position: 1e-5, rotation: 1e-5 };
    let options = ModelFreeOptions { controller: Controller::BroydenBas(broyden), tolerance, ..options(0) };
    let record = on_circle(&mut late_plant(2), &options);
    assert_eq!(record.track.status, Status::Solved, "{}", record.message());
    let steps = record.track.rows() - 1;
    assert!(record.track.evaluations() <= 4 * steps, "{} for {steps} steps", record.track.evaluations());
}

/// Checks that runs fail without the right delay.
fn run_on(plant: &mut dyn Plant, seed: u64, controller: Controller, dt: f64) -> ModelFreeRecord {
    let mut rng = rng::stream(seed, 3);
    let start = ON_CIRCLE.map(|q| q + rng.uniform_in(-0.05, 0.05));
    let options = ModelFreeOptions { controller, seed, ..options(seed) };
    track_model_free(plant, &circle_at(dt), &start, &options, &mut Unattended).unwrap()
}

fn both_controllers() -> [(Controller, f64); 2] {
    [(Controller::default(), 0.2), (Controller::Znnbas(Znnbas::published()), 0.01)]
}

#[test]
fn an_undeclared_delay_is_named() {
    for late in 1..=5 {
        for (controller, dt) in both_controllers() {
            let found = (0..SEEDS).filter(|seed| {
                let record = run_on(&mut late_plant(late), *seed, controller.clone(), dt);
                assert!(matches!(record.sensor_delay, None | Some(1..)), "{late}: {:?}", record.sensor_delay);
                record.sensor_delay == Some(late)
            });
            let found = found.count() as u64;
            assert!(2 * found >= SEEDS, "{controller:?}: {found} of {SEEDS} with {late} late");
        }
    }
    let record = on_circle(&mut late_plant(2), &options(0));
    let advice = ": the sensor is 2 measurements late; give the controller a sensor_delay of 2. Over the second half the error was ";
    assert!(record.message().contains(advice), "{}", record.message());
}

/// Plant with a servo that covers only a part of the way to each command, and a noisy sensor.
fn slow_plant(pole: f64, noise: f64, seed: u64) -> impl Plant {
    let (arm, mut rng) = (robot("iiwa14"), rng::stream(seed, 5));
    let mut at: Option<Vec<f64>> = None;
    FunctionPlant(move |q: &[f64]| {
        let at = at.get_or_insert_with(|| q.to_vec());
        at.iter_mut().zip(q).for_each(|(at, q)| *at = pole * *at + (1.0 - pole) * q);
        let ([x, y], [z, _]) = (rng.normal_pair(), rng.normal_pair());
        let tip = arm.tip_position(at);
        [tip[0] + noise * x, tip[1] + noise * y, tip[2] + noise * z]
    })
}

#[test]
fn noise_and_slow_servos_are_not_taken_for_delay() {
    for (pole, noise) in [(0.0, 1e-4), (0.0, 1e-3), (0.0, 5e-3), (0.3, 0.0), (0.6, 0.0), (0.9, 0.0), (0.6, 1e-3)] {
        for (controller, dt) in both_controllers() {
            for seed in 0..SEEDS {
                let record = run_on(&mut slow_plant(pole, noise, seed), seed, controller.clone(), dt);
                assert_eq!(record.sensor_delay, None, "pole {pole}, noise {noise}, seed {seed}, {controller:?}");
            }
        }
    }
}

#[test]
fn one_measurement_a_step_is_enough_for_a_tenth_of_a_millimetre() {
    let broyden = BroydenBas { max_evaluations_per_step: 1, ..BroydenBas::default() };
    let record =
        on_circle(&mut exact_plant(), &ModelFreeOptions { controller: Controller::BroydenBas(broyden), ..options(0) });
    assert_eq!(record.track.evaluations(), 151);
    assert!(record.settled_error() <= 1e-4, "{}", record.settled_error());
    assert_eq!(record.track.max_violation, 0.0);
}

#[test]
fn tracking_starts_from_the_singular_home_position() {
    for limits in [None, Some(circle_limits(&robot("iiwa14")))] {
        let options = ModelFreeOptions { limits, ..ModelFreeOptions::default() };
        let record = track_model_free(&mut exact_plant(), &circle(), &[0.0; 7], &options, &mut Unattended).unwrap();
        assert_eq!(record.track.status, Status::Solved, "{}", record.message());
        assert!(record.track.joined().unwrap() <= 10);
    }
}

/// Plant that forwards to another, and checks every command against the limits.
struct Guarded {
    arm: Robot,
    limits: Limits,
    sent: Vec<f64>,
}

impl Plant for Guarded {
    fn measure(&mut self, command: &[f64]) -> Result<TipPose, Fault> {
        self.limits.admit(None, "command", command).map_err(|error| Fault(error.to_string()))?;
        self.sent.extend_from_slice(command);
        Ok(self.arm.tip_position(command).into())
    }
}

#[test]
fn no_command_breaks_a_limit_and_the_seed_decides_every_bit() {
    let (arm, speed) = (robot("iiwa14"), 0.3);
    let narrow = Limits::of(&arm).replace(Field::Velocity, vec![Profile::Constant(speed)]).unwrap();
    // A limit that the circle runs into.
    let narrow = narrow.replace(Field::Upper, vec![Profile::Constant(0.56)]).unwrap();
    let start = [0.5, 0.1, 0.1, -0.9, 0.1, 0.55, 0.0];
    let constant = Znnbas { antenna: Antenna::Constant(vec![0.5]), ..Znnbas::published() };
    for controller in [Controller::default(), Controller::Znnbas(Znnbas::default()), Controller::Znnbas(constant)] {
        let run = |seed| {
            let mut plant = Guarded { arm: arm.clone(), limits: narrow.clone(), sent: vec![] };
            let options = ModelFreeOptions {
                controller: controller.clone(),
                limits: Some(narrow.clone()),
                seed,
                ..ModelFreeOptions::default()
            };
            let record = track_model_free(&mut plant, &circle(), &start, &options, &mut Unattended).unwrap();
            assert_eq!((record.fault.as_ref(), record.track.max_violation), (None, 0.0), "{controller:?}");
            let mut commands = plant.sent.chunks(7);
            for (i, count) in record.track.step_evaluations.iter().enumerate() {
                let accepted = &record.track.q[7 * i.saturating_sub(1)..][..7];
                for command in commands.by_ref().take(*count) {
                    let farthest = command.iter().zip(accepted).map(|(to, from)| (to - from).abs()).fold(0.0, f64::max);
                    assert!(farthest <= speed * 0.2, "{controller:?}, step {i}: {farthest}");
                }
            }
            assert_eq!(commands.next(), None);
            plant.sent
        };
        let sent = run(5);
        assert_eq!(bits(&sent), bits(&run(5)), "{controller:?}");
        if controller != Controller::default() {
            assert_ne!(bits(&sent), bits(&run(6)), "{controller:?}");
        }
    }
}

#[test]
fn a_limit_that_closes_in_is_followed_and_told() {
    let closing = Profile::Sampled { step: 1.0, values: vec![1.0, -1.0] };
    let limits = Limits::none_for(7).replace(Field::Upper, vec![closing]).unwrap();
    let limits = limits.replace(Field::Velocity, vec![Profile::Constant(0.5)]).unwrap();
    let options = ModelFreeOptions { limits: Some(limits), ..ModelFreeOptions::default() };
    let record = on_circle(&mut exact_plant(), &options);
    assert_eq!(record.track.status, Status::Lost);
    assert!(record.track.max_violation > 0.1);
    assert!(record.message().contains("beyond its limits at t = "), "{}", record.message());
}

/// Plant that fails in one of several ways after some answers.
struct Failing {
    left: usize,
    failure: fn() -> Result<TipPose, Fault>,
}

impl Plant for Failing {
    fn measure(&mut self, command: &[f64]) -> Result<TipPose, Fault> {
        if self.left == 0 {
            return (self.failure)();
        }
        self.left -= 1;
        Ok(robot("iiwa14").tip_position(command).into())
    }
}

#[test]
fn a_plant_that_fails_ends_the_run_with_what_was_recorded() {
    let every_tick =
        ModelFreeOptions { controller: Controller::Znnbas(Znnbas::default()), ..ModelFreeOptions::default() };
    let run = |left, failure| {
        let mut plant = Failing { left, failure };
        track_model_free(&mut plant, &circle(), &ON_CIRCLE, &every_tick, &mut Unattended)
    };
    let record = run(41, || Err(Fault("raised ValueError: no".into()))).unwrap();
    assert_eq!((record.track.status, record.track.rows()), (Status::PlantFailed, 41));
    assert_eq!(record.message(), "the plant raised ValueError: no at t = 8.2 s; the 41 rows before are recorded");
    let record = run(3, || Ok([0.0, f64::NAN, 0.0].into())).unwrap();
    let expected = "the plant returned a position that is not finite: [0.0, NaN, 0.0] at t = 0.6 s; the 3 rows before are recorded";
    assert_eq!(record.message(), expected);
    let at_once = message(run(0, || Err(Fault("raised ValueError: no".into()))));
    assert_eq!(at_once, "the plant raised ValueError: no");
}

#[test]
fn a_monitor_that_says_stop_leaves_the_steps_that_were_finished() {
    let arm = robot("iiwa14");
    let mut plant = FunctionPlant(|q: &[f64]| arm.tip_position(q));
    let record = track_model_free(&mut plant, &circle(), &ON_CIRCLE, &options(0), &mut StopAt(8)).unwrap();
    assert_eq!((record.track.status, record.track.rows()), (Status::Interrupted, 7));
    // A plant that answers at once is looked after every 64 steps.
    let record = track_model_free(&mut exact_plant(), &circle(), &ON_CIRCLE, &options(0), &mut StopAt(2)).unwrap();
    assert_eq!((record.track.status, record.track.rows()), (Status::Interrupted, 64));
}

#[test]
fn a_session_gives_the_same_commands_as_the_run() {
    let arm = robot("iiwa14");
    for controller in [Controller::default(), Controller::Znnbas(Znnbas::default())] {
        let options = ModelFreeOptions { controller: controller.clone(), ..options(3) };
        let record = on_circle(&mut exact_plant(), &options);
        let limits = options.limits.clone().unwrap();
        let mut session = ControlSession::new(&controller, &ON_CIRCLE, 0.2, limits, options.tolerance, 3).unwrap();
        for i in 0..=150 {
            let step = loop {
                let command = session.command(&record.track.reference[i].into()).unwrap().to_vec();
                if let Some(step) = session.observe(&arm.tip_position(&command).into()).unwrap() {
                    break step;
                }
            };
            assert_eq!(bits(session.q()), bits(&record.track.q[7 * i..][..7]), "{controller:?}, row {i}");
            assert_eq!((step.status, session.time()), (record.track.step_status[i], i as f64 * session.dt()));
        }
    }
}

/// Circle with the orientation of the tip at the start.
fn turned_circle(arm: &Robot) -> Reference {
    let circle = Path::new(Circle::new(Plane::xy([0.3, 0.3, 1.0]).unwrap(), 0.2, 30.0).unwrap());
    let rotation = *arm.fk(&ON_CIRCLE).unwrap().rotation.matrix();
    circle.with_orientation(rotation).unwrap().sample(0.2).unwrap()
}

#[test]
fn broyden_tracks_poses_with_a_wrong_model() {
    for seed in 0..SEEDS {
        let wrong = wrong_arm(seed);
        let tolerance = Tolerance { position: 1e-6, rotation: 1e-6 };
        let options = ModelFreeOptions { tolerance, limits: None, ..options(0) };
        let mut plant = KinematicPlant::new(wrong.clone(), 0.0, 0).unwrap().with_orientation(0.0).unwrap();
        let reference = turned_circle(&wrong);
        let record = track_model_free(&mut plant, &reference, &ON_CIRCLE, &options, &mut Unattended).unwrap();
        assert_eq!(record.track.status, Status::Solved, "seed {seed}: {}", record.message());
        assert!(record.track.evaluations() <= 700, "seed {seed}: {}", record.track.evaluations());
        for i in 1..record.track.rows() {
            let tip = wrong.fk(&record.track.q[7 * i..][..7]).unwrap();
            let turned = (tip.rotation.matrix() - reference.rotation(i).unwrap()).norm() / 2_f64.sqrt();
            assert!(true_error(&wrong, &record, i) <= 1e-6 && turned <= 1.1e-6, "seed {seed}, row {i}: {turned:.1e}");
        }
    }
}

#[test]
fn targets_are_positions_or_poses_throughout() {
    let pose = robot("iiwa14").fk(&ON_CIRCLE).unwrap();
    let start = || {
        let limits = Limits::none_for(2);
        ControlSession::new(&Controller::default(), &[0.0; 2], 0.1, limits, Tolerance::default(), 0).unwrap()
    };
    let mut session = start();
    session.command(&TipPose::from(&pose)).unwrap();
    let problem = "position: expected a pose (4, 4), like the target, got a position (3,)";
    assert_eq!(message(session.observe(&[0.0; 3].into())), problem);
    let step = session.observe(&TipPose::from(&pose)).unwrap().unwrap();
    assert_eq!((step.error.position, step.error.rotation), (0.0, 0.0), "the turn is not lost by a mistake");
    let problem = "target: expected a pose (4, 4), as before, got a position (3,)";
    assert_eq!(message(session.command(&[0.0; 3].into())), problem);
    let mut session = start();
    session.command(&[0.0; 3].into()).unwrap();
    assert!(
        session.observe(&TipPose::from(&pose)).unwrap().unwrap().error.rotation.is_nan(),
        "the orientation is free"
    );
    let problem = "target: expected a position (3,), as before, got a pose (4, 4)";
    assert_eq!(message(session.command(&TipPose::from(&pose))), problem);
}

#[test]
fn turns_are_kept() {
    let mut session =
        ControlSession::new(&Controller::default(), &[0.0; 2], 0.1, Limits::none_for(2), Tolerance::default(), 0)
            .unwrap();
    let early = "observe: there is no command to answer; call command(target) first";
    assert_eq!(message(session.observe(&[0.0; 3].into())), early);
    session.command(&[1.0, 0.0, 0.0].into()).unwrap();
    let late = "command: the last command is not answered yet; call observe(position) first";
    assert_eq!(message(session.command(&[1.0, 0.0, 0.0].into())), late);
    assert_eq!(message(session.observe(&[0.0, f64::NAN, 0.0].into())), "position must be finite, but entry 1 is NaN");
    assert!(session.observe(&[0.0; 3].into()).is_ok(), "the turn is not lost by a mistake");
    assert_eq!(
        message(session.command(&[f64::INFINITY, 0.0, 0.0].into())),
        "target must be finite, but entry 0 is inf"
    );
}

#[test]
fn wrong_input_is_named() {
    let run = |controller: Controller, start: &[f64]| {
        let options = ModelFreeOptions { controller, ..options(0) };
        message(track_model_free(&mut exact_plant(), &circle(), start, &options, &mut Unattended))
    };
    let znnbas = |znnbas| run(Controller::Znnbas(znnbas), &ON_CIRCLE);
    let standard = Znnbas::default;
    assert_eq!(
        znnbas(Znnbas { delay_steps: 150, ..standard() }),
        "delay_steps must be less than the 150 steps of the run, got 150"
    );
    assert_eq!(znnbas(Znnbas { delay_steps: 0, ..standard() }), "delay_steps must be at least 1, got 0");
    assert_eq!(
        znnbas(Znnbas { gain: 0.0, ..standard() }),
        "gain must be finite and not zero (positive to converge), got 0"
    );
    let antenna = Antenna::Constant(vec![0.1; 3]);
    assert_eq!(
        znnbas(Znnbas { antenna, ..standard() }),
        "antenna_length: expected one number, or 7 (one per joint), got 3"
    );
    let antenna = Antenna::Adaptive { c1: -1.0 };
    assert_eq!(znnbas(Znnbas { antenna, ..standard() }), "c1 must be positive and finite, got -1");
    let broyden = |broyden| run(Controller::BroydenBas(broyden), &ON_CIRCLE);
    assert_eq!(
        broyden(BroydenBas { max_evaluations_per_step: 0, ..Default::default() }),
        "max_evaluations_per_step must be at least 1, got 0"
    );
    assert_eq!(
        broyden(BroydenBas { antenna_length: 0.0, ..Default::default() }),
        "antenna_length must be positive and finite, got 0"
    );
    let outside = [3.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let limits = "start_q: joint 'joint_a1' at 3.2 is outside its limits [-2.9670597283903604, 2.9670597283903604] by 0.2329 rad: \
                  moving it to the limit changes the pose; start slack takes a start farther out";
    assert_eq!(run(Controller::default(), &outside), limits);
    let none = ModelFreeOptions::default();
    let no_joints = track_model_free(&mut exact_plant(), &circle(), &[], &none, &mut Unattended);
    assert_eq!(message(no_joints), "start_q: expected 1 to 64 joints, got 0");
}
