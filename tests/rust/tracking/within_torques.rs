//! Torque limits of a tracker: commands and stops, judged by inverse dynamics of the differences of commands.

use ikcore::dynamics::Inertia;
use ikcore::error::Error;
use ikcore::limits::{Field, Limits, Profile};
use ikcore::path::Reference;
use ikcore::rng::{self, LazyRng};
use ikcore::robot::{Motions, Robot};
use ikcore::solver::{Status, Unattended};
use ikcore::task::Target;
use ikcore::tracking::{Session, TrackOptions, track};

use super::clear::{MARGIN, START, random_obstacles, surroundings};

/// Rated accelerations of the Panda (rad/s^2).
const RATED: [f64; 7] = [15.0, 7.5, 10.0, 12.5, 15.0, 20.0, 20.0];

fn carrying(robot: &Robot, mass: f64) -> Robot {
    robot.with_payload(None, Inertia::point(mass, [0.0, 0.0, 0.05])).unwrap()
}

fn panda(mass: f64) -> Robot {
    carrying(&Robot::named("panda").unwrap(), mass)
}

fn limits(robot: &Robot, jerk: Option<f64>, torque: Vec<f64>) -> Limits {
    let constant = |values: Vec<f64>| values.into_iter().map(Profile::Constant).collect::<Vec<_>>();
    let limits = Limits::of(robot).replace(Field::Acceleration, constant(RATED.to_vec())).unwrap();
    let limits = match jerk {
        Some(jerk) => limits.replace(Field::Jerk, constant(RATED.map(|a| jerk * a).to_vec())).unwrap(),
        None => limits,
    };
    limits.with_torque_limit(torque).unwrap()
}

fn motors(robot: &Robot, part: f64) -> Vec<f64> {
    robot.joints().iter().map(|joint| part * joint.rated_torque).collect()
}

fn session(robot: &Robot, dt: f64, limits: Limits) -> Session {
    let options = TrackOptions { limits: Some(limits), ..TrackOptions::default() };
    Session::new(robot, &START, dt, &options).unwrap()
}

/// Judge of the torques at ticks.
struct Judge {
    robot: Robot,
    limits: Vec<f64>,
    dt: f64,
    rows: [Vec<f64>; 3],
    worst: f64,
}

impl Judge {
    fn of(session: &Session, robot: &Robot) -> Self {
        let rows = std::array::from_fn(|_| session.q().to_vec());
        let limits = session.limits().torque().to_vec();
        Self { robot: robot.clone(), limits, dt: session.dt(), rows, worst: f64::NEG_INFINITY }
    }

    /// Notes a command; returns by how much the torques there exceed their limits (N m).
    fn note(&mut self, q: &[f64]) -> f64 {
        self.rows.rotate_left(1);
        self.rows[2] = q.to_vec();
        let difference = |row: usize, j: usize| (self.rows[row + 1][j] - self.rows[row][j]) / self.dt;
        let qd: Vec<f64> = (0..q.len()).map(|j| difference(1, j)).collect();
        let qdd: Vec<f64> = (0..q.len()).map(|j| (difference(1, j) - difference(0, j)) / self.dt).collect();
        let motion = Motions { q, qd: Some(&qd), qdd: Some(&qdd), wrenches: None };
        let torques = self.robot.torques_all(&motion).unwrap();
        let beyond = torques.iter().zip(&self.limits).map(|(torque, limit)| torque.abs() - limit);
        let excess = beyond.fold(f64::NEG_INFINITY, f64::max);
        self.worst = self.worst.max(excess);
        excess
    }
}

/// A pose that a configuration near the start, or anywhere, has.
fn jumped(robot: &Robot, rng: &mut LazyRng) -> Target {
    let size = [0.0, 0.1, 0.5, 1.0, 1.5][rng.below(5)];
    let q: Vec<f64> = robot
        .joints()
        .iter()
        .zip(START)
        .map(|(joint, start)| (start + rng.uniform_in(-size, size)).clamp(joint.lower + 0.05, joint.upper - 0.05))
        .collect();
    Target::from(&robot.fk(&q).unwrap())
}

/// Takes steps towards one target; returns the last status.
fn follow(session: &mut Session, target: &Target, ticks: usize) -> Status {
    let mut status = Status::Capped;
    for _ in 0..ticks {
        status = session.step(target, &mut Unattended).unwrap().status;
    }
    status
}

/// Follows targets that jump, with stops. Returns statuses.
fn live(session: &mut Session, judge: &mut Judge, rng: &mut LazyRng, ticks: usize) -> Vec<Status> {
    let robot = session.robot().clone();
    let (mut target, mut stopping, mut statuses) = (jumped(&robot, rng), 0_usize, vec![]);
    for tick in 0..ticks {
        if tick % 60 == 0 {
            target = jumped(&robot, rng);
        }
        if stopping == 0 && rng.below(90) == 0 {
            session.stop();
            stopping = 30;
        }
        let step = match stopping {
            0 => session.step(&target, &mut Unattended).unwrap(),
            _ => session.advance(None, &mut Unattended).unwrap(),
        };
        stopping = stopping.saturating_sub(1);
        judge.note(session.q());
        statuses.push(step.status);
    }
    stop(session, judge);
    statuses
}

/// Stops, as fast as the session says.
fn stop(session: &mut Session, judge: &mut Judge) {
    let ticks = (session.stop() / session.dt()).round() as usize;
    for _ in 0..ticks + 2 {
        session.advance(None, &mut Unattended).unwrap();
        judge.note(session.q());
    }
    assert!(session.qd().iter().all(|rate| rate.abs() < 1e-9), "{:?}", session.qd());
}

#[test]
fn commands_and_stops_keep_torques_at_every_tick() {
    let mut rng = rng::stream(81, 0);
    let mut binds = 0;
    for trial in 0..30 {
        let robot = panda([0.0, 1.0, 2.0, 3.0, rng.uniform_in(0.0, 3.0)][trial % 5]);
        let (jerk, dt) = ([None, Some(50.0)][trial % 2], [0.002, 0.01, 0.001][trial % 3]);
        let torque = motors(&robot, [0.7, 0.5, 1.0][trial % 3]);
        let mut session = session(&robot, dt, limits(&robot, jerk, torque));
        let mut judge = Judge::of(&session, &robot);
        live(&mut session, &mut judge, &mut rng, 300);
        assert!(judge.worst <= 1e-9, "{} in trial {trial}", judge.worst);
        binds += usize::from(judge.worst > -1.0);
    }
    assert!(binds > 10, "{binds}");
}

#[test]
fn torques_are_kept_among_obstacles() {
    let robot = carrying(&super::clear::panda(), 2.0);
    let mut rng = rng::stream(82, 0);
    for _ in 0..4 {
        let limits = limits(&robot, None, motors(&robot, 0.6));
        let surroundings = surroundings(random_obstacles(&robot, &mut rng));
        let options = TrackOptions { limits: Some(limits), surroundings, ..TrackOptions::default() };
        let mut session = Session::new(&robot, &START, 0.004, &options).unwrap();
        let mut judge = Judge::of(&session, &robot);
        for _ in 0..4 {
            live(&mut session, &mut judge, &mut rng, 100);
            let space = session.space().unwrap().clone();
            assert!(space.clearance(session.q()).distance >= MARGIN - 1e-6);
        }
        assert!(judge.worst <= 1e-9, "{}", judge.worst);
    }
}

#[test]
fn torque_limits_out_of_sight_change_no_bit() {
    let robot = panda(1.0);
    let [free, far] = [f64::INFINITY, 1e9].map(|limit| session(&robot, 0.004, limits(&robot, None, vec![limit; 7])));
    let mut runs = [free, far];
    let mut rng = rng::stream(83, 0);
    for _ in 0..10 {
        let target = jumped(&robot, &mut rng);
        for _ in 0..40 {
            let [one, other] = runs.each_mut().map(|session| {
                let step = session.step(&target, &mut Unattended).unwrap();
                (session.q().to_vec(), step.status)
            });
            assert_eq!(one, other);
        }
    }
}

#[test]
fn an_arm_stops_before_what_a_joint_cannot_hold() {
    let robot = panda(3.0);
    let hold = robot.torques_all(&Motions { q: &START, qd: None, qdd: None, wrenches: None }).unwrap();
    let mut torque = motors(&robot, 1.0);
    (torque[1], torque[3]) = (1.2 * hold[1].abs(), 1.4 * hold[3].abs());
    let mut session = session(&robot, 0.004, limits(&robot, None, torque));
    let mut judge = Judge::of(&session, &robot);
    let far = Target::from(&robot.fk(&[0.3, 0.9, 0.0, -0.9, 0.0, 1.8, 0.8]).unwrap());
    let mut statuses = vec![];
    for _ in 0..2000 {
        statuses.push(session.step(&far, &mut Unattended).unwrap().status);
        judge.note(session.q());
    }
    assert!(judge.worst <= 1e-9, "{}", judge.worst);
    assert!(statuses[1500..].iter().all(|status| *status == Status::HeldByTorque), "{:?}", &statuses[1990..]);
    assert!(session.qd().iter().all(|rate| rate.abs() < 0.1), "{:?}", session.qd());
    let words = session.held_by_torque().unwrap();
    assert!(words.contains("joint 'panda_joint2' would need") && words.contains("its limit is"), "{words}");
    let home = Target::from(&robot.fk(&START).unwrap());
    assert_eq!(follow(&mut session, &home, 1500), Status::Solved);
}

#[test]
fn a_payload_may_change_in_the_hand() {
    let empty = panda(0.0);
    let mut rng = rng::stream(84, 0);
    for mass in [0.5, 1.0, 3.0, 0.0, 2.0] {
        let mut session = session(&empty, 0.002, limits(&empty, None, motors(&empty, 0.6)));
        let target = jumped(&empty, &mut rng);
        follow(&mut session, &target, 60);
        let heavier = carrying(&empty, mass);
        session.set_robot(&heavier).unwrap();
        let mut judge = Judge::of(&session, &heavier);
        let mut was_held = true;
        for tick in 0..400 {
            let status = session.step(&target, &mut Unattended).unwrap().status;
            let excess = judge.note(session.q());
            // The judge knows the velocity from the third command on.
            if tick > 2 {
                assert!(excess <= 1e-9 || status == Status::HeldByTorque && was_held, "{excess} {status:?} {mass}");
                was_held &= excess > 1e-9;
            }
        }
    }
}

#[test]
fn more_than_the_joints_can_hold_is_said_until_it_is_gone() {
    let empty = panda(0.0);
    let mut session = session(&empty, 0.004, limits(&empty, None, motors(&empty, 0.6)));
    let target = Target::from(&empty.fk(&[0.4, 0.3, 0.0, -1.5, 0.0, 1.8, 0.8]).unwrap());
    follow(&mut session, &target, 30);
    session.set_robot(&carrying(&empty, 20.0)).unwrap();
    let grasped = holding(&session, &carrying(&empty, 20.0));
    for _ in 0..500 {
        assert_eq!(session.step(&target, &mut Unattended).unwrap().status, Status::HeldByTorque);
    }
    assert!(holding(&session, &carrying(&empty, 20.0)) < grasped);
    let words = session.held_by_torque().unwrap();
    assert!(words.contains(" needs ") && words.contains("to hold the arm"), "{words}");
    session.set_robot(&empty).unwrap();
    assert_eq!(follow(&mut session, &target, 800), Status::Solved);
}

#[test]
fn limits_at_the_holding_torque_hold_the_arm() {
    let robot = panda(1.0);
    let hold = robot.torques_all(&Motions { q: &START, qd: None, qdd: None, wrenches: None }).unwrap();
    let torque: Vec<f64> = hold.iter().map(|torque| torque.abs().max(1e-6)).collect();
    let mut session = session(&robot, 0.004, limits(&robot, None, torque));
    let mut judge = Judge::of(&session, &robot);
    let mut rng = rng::stream(85, 0);
    for _ in 0..5 {
        let target = jumped(&robot, &mut rng);
        for _ in 0..100 {
            session.step(&target, &mut Unattended).unwrap();
            judge.note(session.q());
        }
    }
    assert!(judge.worst <= 1e-9, "{}", judge.worst);
}

/// An arm of two joints that swings up, with this friction.
fn swing(damping: f64, friction: f64) -> Robot {
    let joint = |name: &str, parent: &str, child: &str, x: f64| {
        format!(
            "<joint name='{name}' type='revolute'><parent link='{parent}'/><child link='{child}'/><origin xyz='{x} 0 0'/>\
             <axis xyz='0 1 0'/><limit lower='-3' upper='3' velocity='3' effort='50'/>\
             <dynamics damping='{damping}' friction='{friction}'/></joint>"
        )
    };
    let link = |name: &str| {
        format!(
            "<link name='{name}'><inertial><origin xyz='0.2 0 0'/><mass value='2'/>\
             <inertia ixx='0.01' iyy='0.02' izz='0.02' ixy='0' ixz='0' iyz='0'/></inertial></link>"
        )
    };
    let urdf = format!(
        "<robot name='swing'><link name='base'/>{}{}{}{}<link name='tip'/><joint name='end' type='fixed'><parent link='b'/>\
         <child link='tip'/><origin xyz='0.4 0 0'/></joint></robot>",
        joint("j1", "base", "a", 0.0),
        link("a"),
        joint("j2", "a", "b", 0.4),
        link("b"),
    );
    Robot::from_urdf(&urdf, None, None).unwrap()
}

#[test]
fn friction_counts_where_it_does_not_help() {
    for (damping, friction) in [(0.0, 0.0), (2.0, 0.0), (0.0, 3.0), (1.0, 2.0)] {
        let robot = swing(damping, friction);
        let limits = Limits::of(&robot)
            .replace(Field::Acceleration, vec![Profile::Constant(40.0)])
            .unwrap()
            .with_torque_limit(vec![20.0, 8.0])
            .unwrap();
        let options = TrackOptions { limits: Some(limits), ..TrackOptions::default() };
        let mut session = Session::new(&robot, &[1.2, 0.3], 0.004, &options).unwrap();
        let mut judge = Judge::of(&session, &robot);
        for q in [[0.3, 0.5], [1.5, -0.5], [1.0, 1.0], [2.0, 0.0], [0.0, 2.0]] {
            let target = Target::Position(pose_of(&robot, &q));
            for _ in 0..150 {
                session.step(&target, &mut Unattended).unwrap();
                judge.note(session.q());
            }
        }
        assert!(judge.worst <= 1e-9, "{} with {damping} and {friction}", judge.worst);
        assert!(judge.worst > -4.0, "{} with {damping} and {friction}", judge.worst);
    }
}

fn pose_of(robot: &Robot, q: &[f64]) -> [f64; 3] {
    robot.fk(q).unwrap().translation.vector.into()
}

#[test]
fn a_track_keeps_torques() {
    let robot = panda(3.0);
    let options = TrackOptions { limits: Some(limits(&robot, None, motors(&robot, 0.55))), ..TrackOptions::default() };
    let wave = |i: i32| [0.0, 0.25 * (f64::from(i) * 0.06).sin(), 0.1 * (f64::from(i) * 0.11).sin()];
    let place = pose_of(&robot, &START);
    let positions = (0..200).map(|i| std::array::from_fn(|k| place[k] + wave(i)[k])).collect();
    let path = Reference::new(0.01, positions, None).unwrap();
    let record = track(&robot, &path, Some(&START), &options, &mut Unattended).unwrap();
    let session = Session::new(&robot, &START, 0.01, &options).unwrap();
    let mut judge = Judge::of(&session, &robot);
    for q in record.q.chunks_exact(7).skip(1) {
        judge.note(q);
    }
    assert!(judge.worst <= 1e-9 && judge.worst > -2.0, "{}", judge.worst);
}

#[test]
fn what_cannot_be_kept_is_refused_by_name() {
    let robot = panda(1.0);
    let options = |limits: Limits| TrackOptions { limits: Some(limits), ..TrackOptions::default() };
    let refused = |robot: &Robot, limits: Limits| Session::new(robot, &START, 0.01, &options(limits)).unwrap_err();
    let at_once = Limits::of(&robot).with_torque_limit(vec![50.0]).unwrap();
    let error = refused(&robot, at_once);
    assert!(matches!(error, Error::UnsupportedLimit { .. }), "{error}");
    assert!(error.to_string().contains("joint 'panda_joint1' may change its velocity at once"), "{error}");
    let weak = limits(&robot, None, vec![1.0; 7]);
    let error = refused(&robot, weak);
    assert!(matches!(error, Error::Infeasible { .. }), "{error}");
    assert!(error.to_string().starts_with("infeasible: at start_q joint 'panda_joint4' needs "), "{error}");
    let mut session = session(&robot, 0.01, limits(&robot, None, motors(&robot, 1.0)));
    let error = session.set_robot(&Robot::named("ur5e").unwrap()).unwrap_err();
    assert!(matches!(error, Error::Contradiction { .. }), "{error}");
    assert!(error.to_string().contains("in more than masses"), "{error}");
    let ease = TrackOptions { ease: true, ..options(limits(&robot, None, motors(&robot, 1.0))) };
    let path = Reference::new(0.01, vec![pose_of(&robot, &START); 5], None).unwrap();
    let error = track(&robot, &path, Some(&START), &ease, &mut Unattended).unwrap_err();
    assert!(error.to_string().contains("does not keep torque limits"), "{error}");
}

#[test]
fn milder_stops_end_inside_the_position_limits() {
    let robot = panda(3.0);
    let mut rng = rng::stream(86, 0);
    let around = |j: usize, side: f64| Profile::Constant(START[j] + side * 0.25);
    let mut limits = limits(&robot, None, motors(&robot, 0.5));
    for (field, side) in [(Field::Lower, -1.0), (Field::Upper, 1.0)] {
        limits = limits.replace(field, (0..7).map(|j| around(j, side)).collect()).unwrap();
    }
    let mut session = session(&robot, 0.002, limits);
    let mut judge = Judge::of(&session, &robot);
    for _ in 0..20 {
        let target = jumped(&robot, &mut rng);
        for _ in 0..60 {
            let step = session.step(&target, &mut Unattended).unwrap();
            judge.note(session.q());
            let farthest = session.q().iter().zip(START).map(|(q, start)| (q - start).abs()).fold(0.0, f64::max);
            assert!(step.inside_limits && farthest <= 0.25 + 1e-12, "{farthest}");
        }
        if rng.below(2) == 0 {
            stop(&mut session, &mut judge);
        }
    }
    assert!(judge.worst <= 1e-9, "{}", judge.worst);
}

#[test]
fn a_stop_with_other_masses_or_from_elsewhere_takes_as_long_as_it_says() {
    let mut rng = rng::stream(87, 0);
    let mut moving = 0;
    for trial in 0..12 {
        let robot = panda(1.0);
        let torque = motors(&robot, 0.45);
        let mut session = session(&robot, 0.002, limits(&robot, [None, Some(50.0)][trial % 2], torque));
        follow(&mut session, &jumped(&robot, &mut rng), 60 + 5 * trial);
        if trial < 6 {
            session.set_robot(&panda([0.0, 3.0, 6.0][trial % 3])).unwrap();
        } else {
            let (q, qd) = (session.q().to_vec(), [0.6, -0.8, 0.7, 0.8, -0.6, 0.5, 0.9]);
            session.reset(&q, Some(&qd), None).unwrap();
        }
        let said = (session.stop() / session.dt()).round() as usize;
        moving += usize::from(said > 0);
        let mut last = 0;
        for tick in 1..=said + 100 {
            session.advance(None, &mut Unattended).unwrap();
            if session.qd().iter().any(|rate| rate.abs() > 1e-9) {
                last = tick;
            }
        }
        assert!(last <= said + 1, "trial {trial}: {last} ticks, {said} said");
    }
    assert!(moving > 8, "{moving}");
}

#[test]
fn a_track_begins_where_the_motors_can_hold_the_arm() {
    let robot = panda(3.0);
    let mut rng = rng::stream(11, 0);
    let options =
        |torque: Vec<f64>| TrackOptions { limits: Some(limits(&robot, None, torque)), ..TrackOptions::default() };
    let mut lightened = 0;
    for _ in 0..12 {
        let q: Vec<f64> = START.iter().map(|start| start + rng.uniform_in(-0.5, 0.5)).collect();
        let path = Reference::new(0.01, vec![pose_of(&robot, &q); 2], None).unwrap();
        let free = track(&robot, &path, None, &options(vec![f64::INFINITY; 7]), &mut Unattended).unwrap();
        let held = robot.torques_all(&Motions { q: &free.q[..7], qd: None, qdd: None, wrenches: None }).unwrap();
        // What the configuration that is best without regard to motors needs is a little more than they give.
        let most = |joint: usize| held[joint].abs();
        let heaviest = (0..7).max_by(|i, j| most(*i).total_cmp(&most(*j))).unwrap();
        let mut torque = vec![f64::INFINITY; 7];
        torque[heaviest] = 0.98 * most(heaviest);
        match track(&robot, &path, None, &options(torque), &mut Unattended) {
            Ok(_) => lightened += 1,
            Err(error) => assert!(error.to_string().contains("needs"), "{error}"),
        }
    }
    assert!(lightened >= 8, "{lightened} of 12");
}

/// A session whose arm has just grasped 3 kg where joint 2 can hold at most 93 % of them.
fn overloaded(jerk: Option<f64>) -> (Session, Robot) {
    let (empty, grasped_at) = (panda(0.0), [0.0, 0.7, 0.0, -1.2, 0.0, 1.8, 0.8]);
    let options = TrackOptions { limits: Some(limits(&empty, jerk, motors(&empty, 0.7))), ..TrackOptions::default() };
    let mut session = Session::new(&empty, &grasped_at, 0.004, &options).unwrap();
    follow(&mut session, &Target::from(&empty.fk(&grasped_at).unwrap()), 20);
    let loaded = panda(3.0);
    session.set_robot(&loaded).unwrap();
    (session, loaded)
}

/// Largest part of a torque limit that holds the arm.
fn holding(session: &Session, robot: &Robot) -> f64 {
    let torques = robot.torques_all(&Motions { q: session.q(), qd: None, qdd: None, wrenches: None }).unwrap();
    torques.iter().zip(session.limits().torque()).map(|(torque, limit)| torque.abs() / limit).fold(0.0, f64::max)
}

#[test]
fn an_arm_leaves_where_it_cannot_be_held() {
    for jerk in [None, Some(50.0)] {
        let (mut session, loaded) = overloaded(jerk);
        let mut judge = Judge::of(&session, &loaded);
        let (here, limit) = (Target::from(&loaded.fk(session.q()).unwrap()), session.limits().torque()[1]);
        let grasped = holding(&session, &loaded);
        assert!((1.05..1.1).contains(&grasped), "{grasped}");
        let mut before = grasped;
        for tick in 0..1000 {
            session.step(&here, &mut Unattended).unwrap();
            let excess = judge.note(session.q());
            assert!(excess <= (grasped - 1.0 + 0.02) * limit + 1e-9, "{excess} in tick {tick} with {jerk:?}");
            let now = holding(&session, &loaded);
            assert!(now <= before.max(1.0) + 1e-9, "{now} after {before} in tick {tick} with {jerk:?}");
            before = now;
            if tick == 5 {
                let words = session.held_by_torque().unwrap();
                assert!(words.contains("needs") && words.ends_with("the arm goes to where it needs less"), "{words}");
            }
        }
        assert!(before < 1.0, "{before} with {jerk:?}");
        let back = Target::from(&loaded.fk(&[0.0, -0.5, 0.0, -2.2, 0.0, 1.8, 0.8]).unwrap());
        assert_eq!(follow(&mut session, &back, 800), Status::Solved, "{jerk:?}");
    }
}

#[test]
fn an_arm_that_is_told_to_stop_stays_where_it_cannot_be_held() {
    let (mut session, loaded) = overloaded(None);
    let here = Target::from(&loaded.fk(session.q()).unwrap());
    follow(&mut session, &here, 10);
    let mut judge = Judge::of(&session, &loaded);
    stop(&mut session, &mut judge);
    let q = session.q().to_vec();
    for _ in 0..50 {
        session.advance(None, &mut Unattended).unwrap();
    }
    assert_eq!(session.q(), q);
}
