//! Arms that are led too far and back: they return to the target, inside all limits, or say why they stay.

use super::tips;
use crate::common::robot;
use ikcore::limits::{Field, Limits};
use ikcore::math::Frame;
use ikcore::obstacle::{Scene, Surroundings};
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::shape::Shape;
use ikcore::solver::{Status, Unattended};
use ikcore::task::Target;
use ikcore::tracking::{Arrival, Idle, Session, Step, TrackOptions, Way};

use super::clear::all_limits;

const START: [f64; 7] = [0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8];
const DT: f64 = 0.02;

/// Ticks out, back, and of the target at rest.
const TICKS: [usize; 3] = [200, 200, 300];

/// Directions in which the panda is led; by the second and the sixth it gets into a dead end.
const WAYS: [[f64; 3]; 8] = [
    [0.995, 0.0, 0.0995],
    [0.372, 0.885, 0.178],
    [0.829, 0.287, 0.479],
    [0.523, 0.562, 0.641],
    [0.329, 0.271, 0.905],
    [0.894, 0.397, 0.208],
    [0.451, 0.851, 0.270],
    [0.208, 0.945, 0.253],
];

/// Pose of the tip at `q`, moved by `way` (m).
fn moved(robot: &Robot, q: &[f64], way: [f64; 3]) -> Target {
    let tip = robot.tip(q);
    Target::Pose(Frame { origin: std::array::from_fn(|k| tip.origin[k] + way[k]), ..tip })
}

/// Share of the way after this tick.
fn share(tick: usize) -> f64 {
    let [out, back, _] = TICKS;
    if tick < out { tick as f64 / out as f64 } else { 1.0 - ((tick - out) as f64 / back as f64).min(1.0) }
}

/// Leads an arm 1.3 m along `way` and back, and hands each step with its configuration to `look`.
fn lead(session: &mut Session, way: [f64; 3], mut look: impl FnMut(&Session, &Step)) -> Step {
    let (robot, start) = (session.robot().clone(), session.q().to_vec());
    let mut last = None;
    for tick in 0..TICKS.iter().sum() {
        let target = moved(&robot, &start, way.map(|x| 1.3 * share(tick) * x));
        let step = session.step(&target, &mut Unattended).unwrap();
        look(session, &step);
        last = Some(step);
    }
    last.unwrap()
}

/// Largest excess of the differences of commands over the limits, relative to these, and of positions (rad).
#[derive(Default)]
struct Excess {
    rows: Vec<Vec<f64>>,
}

impl Excess {
    fn push(&mut self, q: &[f64]) {
        self.rows.push(q.to_vec());
    }

    fn over(&self, limits: &Limits) -> f64 {
        let at = |field: Field, j: usize| limits.field(field).map(|profiles| profiles[j].at(0.0));
        let mut worst: f64 = 0.0;
        for j in 0..self.rows[0].len() {
            let mut values: Vec<f64> = vec![self.rows[0][j]; 3];
            values.extend(self.rows.iter().map(|row| row[j]));
            let [lower, upper] = [Field::Lower, Field::Upper].map(|field| at(field, j).unwrap());
            worst = worst.max(values.iter().map(|q| (lower - q).max(q - upper)).fold(0.0, f64::max));
            for (order, field) in [Field::Velocity, Field::Acceleration, Field::Jerk].into_iter().enumerate() {
                values = values.windows(2).map(|two| two[1] - two[0]).collect();
                let Some(limit) = at(field, j) else { continue };
                let most = limit * DT.powi(order as i32 + 1);
                worst = worst.max(values.iter().map(|x| x.abs() / most - 1.0).fold(0.0, f64::max));
            }
        }
        worst
    }
}

fn session(robot: &Robot, start: &[f64], options: &TrackOptions) -> Session {
    Session::new(robot, start, DT, options).unwrap()
}

#[test]
fn an_arm_led_too_far_and_back_is_on_its_target_again() {
    let panda = robot("panda");
    let mut returned = 0;
    for limits in all_limits(&panda) {
        for way in WAYS {
            let options = TrackOptions { limits: Some(limits.clone()), ..TrackOptions::default() };
            let mut session = session(&panda, &START, &options);
            let (mut path, mut was_taken) = (Excess::default(), false);
            path.push(&START);
            let end = lead(&mut session, way, |session, step| {
                path.push(session.q());
                was_taken |= step.away.is_some_and(|away| away.way == Way::Taken);
                let rests = session.qd().iter().all(|v| v.abs() < 1e-6);
                assert!(!(rests && step.status == Status::Improved), "{}", step.message());
            });
            assert_eq!(end.status, Status::Solved, "{way:?}: {}", end.message());
            assert!(path.over(&limits) < 1e-6, "{way:?}: {}", path.over(&limits));
            returned += usize::from(was_taken);
        }
    }
    assert!(returned >= 3, "only {returned} of 24 had to return");
}

#[test]
fn an_arm_told_to_stay_says_what_holds_it_and_that_it_could_go() {
    let panda = robot("panda");
    let mut held = 0;
    for limits in all_limits(&panda) {
        for way in WAYS {
            let options = TrackOptions { limits: Some(limits.clone()), recover: false, ..TrackOptions::default() };
            let mut session = session(&panda, &START, &options);
            let end = lead(&mut session, way, |_, step| {
                assert!(step.away.is_none_or(|away| away.way != Way::Taken));
            });
            if end.status == Status::Solved {
                continue;
            }
            held += 1;
            let message = end.message_with(end.status.advice(), &[], |j| panda.joints()[j].name.clone());
            let ends = "; the target is in reach: recovery lets the arm go to a configuration on it";
            let holds = message.starts_with("joint '") || message.starts_with("joints at their limits, '");
            assert!(end.status == Status::Capped && holds && message.ends_with(ends), "{message}");
            assert!(message.contains(&format!("the arm {} away", end.error)), "{message}");
        }
    }
    assert!(held >= 3, "only {held} of 24 were held");
}

#[test]
fn an_arm_comes_to_rest_before_a_target_out_of_reach() {
    for name in ["panda", "ur5e", "iiwa14"] {
        let robot = robot(name);
        let start: Vec<f64> = START[..robot.dof()].iter().map(|q| 0.6 * q).collect();
        for noise in [0.0, 0.004] {
            let mut draws = rng::stream(5, 0);
            let mut session = session(&robot, &start, &TrackOptions::default());
            let mut far = vec![];
            for tick in 0..600 {
                let shift = [2.0, 0.3, 0.1].map(|x| x + noise * draws.uniform_in(-1.0, 1.0));
                let step = session.step(&moved(&robot, &start, shift), &mut Unattended).unwrap();
                assert!(step.away.is_none_or(|away| away.way == Way::Unknown), "{name} at {tick}");
                far.push(session.q().to_vec());
            }
            let wandered = far[300..].iter().flatten().zip(far[599].iter().cycle()).map(|(q, end)| (q - end).abs());
            assert!(wandered.fold(0.0, f64::max) < 0.02 + 20.0 * noise, "{name}");
            let text = session.step(&moved(&robot, &start, [2.0, 0.3, 0.1]), &mut Unattended).unwrap();
            let text = text.message();
            let advice = "the arm, and no configuration on the target is known: widen the limits or the tolerance, or move the \
                          target into reach";
            assert!(text.ends_with(advice), "{text}");
        }
    }
}

#[test]
fn noise_does_not_send_an_arm_from_one_configuration_to_another() {
    let panda = robot("panda");
    for limits in all_limits(&panda) {
        let mut draws = rng::stream(6, 0);
        let options = TrackOptions { limits: Some(limits), ..TrackOptions::default() };
        let mut session = session(&panda, &START, &options);
        for tick in 0..1000 {
            let shift = std::array::from_fn(|_| 0.005 * draws.uniform_in(-1.0, 1.0));
            let step = session.step(&moved(&panda, &START, shift), &mut Unattended).unwrap();
            assert_eq!(step.away, None, "tick {tick}");
        }
        assert!(session.q().iter().zip(START).all(|(q, start)| (q - start).abs() < 1.0), "{:?}", session.q());
    }
}

#[test]
fn noise_of_a_stretched_arm_needs_no_way_back() {
    let iiwa = robot("iiwa14");
    let start = [1.5, 0.0, -1.5, 0.0, 1.5, -1.0, -1.5];
    let [_, accelerations, jerks] = all_limits(&iiwa);
    for (limits, seed) in [(&accelerations, 0), (&accelerations, 1), (&jerks, 0), (&jerks, 1)] {
        let mut draws = rng::stream(seed, 0);
        let options = TrackOptions { limits: Some(limits.clone()), ..TrackOptions::default() };
        let mut session = session(&iiwa, &start, &options);
        for tick in 0..1000 {
            let shift = std::array::from_fn(|_| 0.003 * draws.uniform_in(-1.0, 1.0));
            let step = session.step(&moved(&iiwa, &start, shift), &mut Unattended).unwrap();
            assert!(step.away.is_none_or(|away| away.way != Way::Taken), "seed {seed}, tick {tick}");
        }
    }
}

#[test]
fn an_arm_whose_targets_cease_rests_where_their_motion_has_led_it() {
    let panda = robot("panda");
    for limits in all_limits(&panda).into_iter().skip(1) {
        let options = TrackOptions { limits: Some(limits), ..TrackOptions::default() };
        let mut session = session(&panda, &START, &options);
        let (mut rests_at, mut said) = (vec![], None);
        for tick in 0..300 {
            let arrival = (tick < 75 && tick % 3 == 0)
                .then(|| Arrival::from(moved(&panda, &START, [0.0, 0.25 * DT * f64::from(tick), 0.0])));
            let step = session.advance(arrival, &mut Unattended).unwrap();
            assert!(step.away.is_none(), "tick {tick}: {}", step.message());
            rests_at = if tick < 150 { session.q().to_vec() } else { rests_at };
            said = Some((step.idle, step.message()));
        }
        let (idle, text) = said.unwrap();
        let follows = ": the arm follows the motion of the last ones on, and then rests until the next one";
        assert!(text.starts_with("no new target, 0.") && text.ends_with(follows), "{text}");
        assert_eq!(idle, Some(Idle::Ceased));
        let moved = session.q().iter().zip(&rests_at).map(|(q, before)| (q - before).abs());
        assert!(moved.fold(0.0, f64::max) < 1e-6);
    }
}

/// Dead end of the panda: led along this way, it stays far from the target.
fn dead_end(limits: &Limits, panda: &Robot) -> Option<(Vec<f64>, [f64; 3])> {
    WAYS.into_iter().find_map(|way| {
        let options = TrackOptions { limits: Some(limits.clone()), recover: false, ..TrackOptions::default() };
        let mut session = session(panda, &START, &options);
        let end = lead(&mut session, way, |_, _| ());
        (end.status != Status::Solved).then(|| (session.q().to_vec(), way))
    })
}

#[test]
fn a_blocked_way_is_taken_when_it_becomes_clear() {
    let panda = super::clear::panda();
    let mut tried = 0;
    for limits in all_limits(&panda) {
        let Some((stuck, _)) = dead_end(&limits, &panda) else { continue };
        tried += 1;
        // Balls all around the stuck arm, close to it, and none at the target.
        let mut draws = rng::stream(7, 0);
        let mut cage: Vec<Shape> = vec![];
        while cage.len() < 60 {
            let center = std::array::from_fn(|k| draws.uniform_in([-0.9, -0.9, 0.3][k], [0.9, 0.9, 1.3][k]));
            let ball = Shape::sphere(center, 0.04).unwrap();
            let scene = Scene::new(&panda, std::slice::from_ref(&ball)).unwrap();
            if (0.007..0.03).contains(&scene.clearance(&stuck).unwrap()) && scene.clearance(&START).unwrap() > 0.03 {
                cage.push(ball);
            }
        }
        let surroundings =
            Surroundings { obstacles: Some(cage.into()), margin: Some(0.005), self_collision: Some(false) };
        let options = TrackOptions { limits: Some(limits.clone()), surroundings, ..TrackOptions::default() };
        let mut session = session(&panda, &stuck, &options);
        let target = moved(&panda, &START, [0.0; 3]);
        let mut step = None;
        for _ in 0..400 {
            step = Some(session.step(&target, &mut Unattended).unwrap());
            assert!(session.space().unwrap().holds(session.q()));
        }
        let blocked = step.unwrap();
        assert_eq!(blocked.away.map(|away| away.way), Some(Way::Blocked), "{}", blocked.message());
        assert!(session.qd().iter().all(|v| v.abs() < 1e-4), "it rests");
        let text = blocked.message();
        assert!(
            text.contains("; the target is in reach, but no straight way of the joints to it was found: "),
            "{text}"
        );
        session.set_obstacles(None, vec![]).unwrap();
        for _ in 0..300 {
            step = Some(session.step(&target, &mut Unattended).unwrap());
        }
        assert_eq!(step.unwrap().status, Status::Solved);
    }
    assert!(tried > 0);
}

#[test]
fn an_arm_on_its_way_back_stops_at_once_and_follows_new_targets() {
    let panda = robot("panda");
    let limits = &all_limits(&panda)[2];
    let (stuck, _) = dead_end(limits, &panda).expect("a dead end");
    let options = TrackOptions { limits: Some(limits.clone()), ..TrackOptions::default() };
    let mut session = session(&panda, &stuck, &options);
    let target = moved(&panda, &START, [0.0; 3]);
    let mut path = Excess::default();
    path.push(&stuck);
    let mut step = |session: &mut Session, target: Option<&Target>| {
        let step = session.advance(target.map(|target| Arrival::from(*target)), &mut Unattended).unwrap();
        path.push(session.q());
        (step, path.over(limits))
    };
    while step(&mut session, Some(&target)).0.away.is_none_or(|away| away.way != Way::Taken) {}
    for _ in 0..30 {
        step(&mut session, Some(&target));
    }
    assert!(session.qd().iter().any(|v| v.abs() > 0.2), "it moves");
    let ticks = (session.stop() / DT).ceil() as usize + 1;
    for _ in 0..ticks {
        step(&mut session, None);
    }
    assert!(session.qd().iter().all(|v| v.abs() < 1e-6), "it has stopped");
    let here = session.q().to_vec();
    let near = moved(&panda, &here, [0.02, 0.01, -0.01]);
    let (end, over) = (0..200).map(|_| step(&mut session, Some(&near))).last().unwrap();
    assert!(end.status == Status::Solved && over < 1e-6, "{over}");
}

#[test]
fn a_target_that_moves_while_the_arm_is_on_its_way_is_met() {
    let panda = robot("panda");
    let limits = &all_limits(&panda)[1];
    let (stuck, _) = dead_end(limits, &panda).expect("a dead end");
    let options = TrackOptions { limits: Some(limits.clone()), ..TrackOptions::default() };
    for way in (0..6).map(|k| std::array::from_fn(|axis| if axis == k / 2 { 0.2 - 0.4 * (k % 2) as f64 } else { 0.0 }))
    {
        let mut session = session(&panda, &stuck, &options);
        let (mut ticks_taken, mut end) = (0, None);
        for _ in 0..1000 {
            let share = (ticks_taken as f64 - 20.0).clamp(0.0, 25.0) / 25.0;
            let target = moved(&panda, &START, way.map(|x: f64| x * share));
            let step = session.step(&target, &mut Unattended).unwrap();
            let way = step.away.map(|away| away.way);
            assert_ne!(way, Some(Way::Blocked), "{}", step.message());
            ticks_taken += usize::from(ticks_taken > 0 || way == Some(Way::Taken));
            end = Some(step);
        }
        assert_eq!(end.as_ref().unwrap().status, Status::Solved, "{way:?}: {}", end.unwrap().message());
    }
}

#[test]
fn two_hands_return_as_one_does() {
    let robot = tips::robot();
    let home = tips::forward([0.5, 0.25, 0.9], [0.0; 3]);
    let start = tips::start(&robot, &home);
    let (task, _) = tips::targets(&home)[0];
    let mut taken = 0;
    for (limits, _) in tips::all_limits(&robot) {
        for (x, y) in [(1.5, 0.0), (1.2, 0.9), (0.3, 1.5), (0.8, -1.4), (-1.5, 0.2), (-0.8, -1.2)] {
            let surroundings = Surroundings { self_collision: Some(false), ..Surroundings::default() };
            let options = TrackOptions { limits: Some(limits.clone()), surroundings, ..TrackOptions::default() };
            let mut session = session(&robot, &start, &options);
            let mut path = Excess::default();
            path.push(&start);
            let mut end = None;
            for tick in 0..TICKS.iter().sum::<usize>() {
                let mut left = home;
                (left.translation.vector.x, left.translation.vector.y) =
                    (0.5 + x * share(tick), 0.25 + y * share(tick));
                let arrival = [(task, Target::from(&left))].into_iter().collect::<Arrival>();
                let step = session.advance(Some(arrival), &mut Unattended).unwrap();
                path.push(session.q());
                taken += usize::from(step.away.is_some_and(|away| away.way == Way::Taken));
                end = Some(step);
            }
            let end = end.unwrap();
            assert_eq!(end.status, Status::Solved, "({x}, {y}): {}", end.message());
            assert!(path.over(&limits) < 1e-6, "({x}, {y}): {}", path.over(&limits));
        }
    }
    assert!(taken > 0, "no arm had to return");
}

#[test]
fn the_same_seed_gives_the_same_way_back() {
    let robot = tips::robot();
    let home = tips::forward([0.5, 0.25, 0.9], [0.0; 3]);
    let start = tips::start(&robot, &home);
    let (task, _) = tips::targets(&home)[0];
    let run = || {
        let mut session = session(&robot, &start, &TrackOptions { seed: 3, ..TrackOptions::default() });
        for tick in 0..TICKS.iter().sum::<usize>() {
            let mut left = home;
            left.translation.vector.y += 1.4 * share(tick);
            session.advance(Some([(task, Target::from(&left))].into_iter().collect()), &mut Unattended).unwrap();
        }
        session.q().to_vec()
    };
    assert_eq!(run(), run());
}

#[test]
fn joints_that_equal_limits_lock_are_named_so() {
    let start = [0.0, -1.5, 1.5, -1.5, -1.5, 0.0];
    for locked in [vec![1, 2], vec![2]] {
        let robot = robot("ur5e").with_limits(|j, joint| {
            if locked.contains(&j) {
                (joint.lower, joint.upper) = (start[j], start[j]);
            }
        });
        let robot = robot.unwrap();
        let mut session = Session::new(&robot, &start, DT, &TrackOptions::default()).unwrap();
        let target = Target::Position([0.3, 0.13, 0.1]);
        let last = (0..300).map(|_| session.step(&target, &mut Unattended).unwrap()).last().unwrap();
        let said = last.message_with(last.status.advice(), &[], |j| robot.joints()[j].name.clone());
        let holder = match locked.len() {
            1 => "joint 'elbow_joint', locked by equal limits, holds the arm",
            _ => "'shoulder_lift_joint' (locked by equal limits), 'elbow_joint' (locked by equal limits)",
        };
        assert!(said.contains(holder), "{said}");
    }
}
