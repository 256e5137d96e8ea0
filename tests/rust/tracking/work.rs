//! Work of a tick, counted: bounded whatever the targets are and whatever stands around the arm.

use super::clear::{MARGIN, START, all_limits, panda, random_obstacles, surroundings};
use super::tips;
use crate::common::{hostile, robot};
use ikcore::limits::Limits;
use ikcore::obstacle::Surroundings;
use ikcore::rng::{self, LazyRng};
use ikcore::robot::Robot;
use ikcore::shape::Shape;
use ikcore::solver::Unattended;
use ikcore::task::{Goal, Target};
use ikcore::tracking::{Arrival, Session, TrackOptions};

/// Evaluations of a tick under acceleration or jerk limits: six steps, a look at where the goal was, a descent of 60, the end.
const PURSUIT: usize = 68;

/// Intervals of a tick: five certificates of 120 intervals, and those left at the depths of their bisection.
const INTERVALS: usize = 5 * (120 + 32);

/// Exchanges of a tick; the most that was counted is 1,181, in seven steps beside rows.
const EXCHANGES: usize = 1500;

/// The largest counts of any tick.
#[derive(Debug, Default)]
struct Most {
    evaluations: usize,
    intervals: usize,
    exchanges: usize,
}

impl Most {
    /// Moves by one tick, and counts its work.
    fn step(&mut self, session: &mut Session, arrival: impl Into<Arrival>) {
        let before = session.filter_work();
        let step = session.advance(Some(arrival.into()), &mut Unattended).unwrap();
        let after = session.filter_work();
        self.evaluations = self.evaluations.max(step.evaluations);
        self.intervals = self.intervals.max(after.intervals - before.intervals);
        self.exchanges = self.exchanges.max(after.exchanges - before.exchanges);
    }
}

fn session(robot: &Robot, limits: Limits, surroundings: Surroundings, goals: Vec<Goal>) -> Session {
    let options = TrackOptions { limits: Some(limits), surroundings, goals, ..TrackOptions::default() };
    Session::new(robot, &START, 0.004, &options).unwrap()
}

/// A hostile target as a position, or with the orientation of the start.
fn target(robot: &Robot, kind: usize, tick: usize, draws: &mut LazyRng) -> Target {
    let mut frame = robot.tip(&START);
    frame.origin = hostile(kind % 5, tick, frame.origin, draws);
    if kind.is_multiple_of(2) { Target::Position(frame.origin) } else { Target::Pose(frame) }
}

/// Walls at the margin from the tip on all sides, some of them twice, and a grid of spheres above.
fn a_cage(robot: &Robot) -> Vec<Shape> {
    let tip = robot.tip_position(&START);
    let walls = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]];
    let wall = |side: [f64; 3]| {
        let center = std::array::from_fn(|k| tip[k] + (0.05 + MARGIN + 0.01) * side[k]);
        Shape::cuboid(center, side.map(|x| if x == 0.0 { 0.3 } else { 0.02 }), None).unwrap()
    };
    let sphere = |i: i32| {
        let [x, y] = [i % 6, i / 6].map(|k| 0.2 * f64::from(k) - 0.5);
        Shape::sphere([x, y, 1.0], 0.05).unwrap()
    };
    walls.into_iter().map(wall).chain((0..36).map(sphere)).collect()
}

#[test]
fn hostile_targets_cost_a_bounded_number_of_evaluations() {
    let robot = robot("panda");
    let mut draws = rng::stream(31, 0);
    let mut most = [(); 3].map(|()| Most::default());
    for kind in 0..10 {
        for goals in [vec![], vec![Goal::Centring { weight: 0.1 }]] {
            for (limits, most) in all_limits(&robot).into_iter().zip(&mut most) {
                let mut session = session(&robot, limits, Surroundings::default(), goals.clone());
                (0..600).for_each(|tick| most.step(&mut session, target(&robot, kind, tick, &mut draws)));
                assert_eq!((most.intervals, most.exchanges), (0, 0), "nothing is to be kept clear of");
            }
        }
    }
    let most = most.map(|most| most.evaluations);
    // A descent in the box of a tick that changes no velocity has the budget of a whole solve; it needed 1,236.
    assert!(most[0] <= 2000 && most[1..].iter().all(|most| *most <= PURSUIT), "{most:?}");
}

#[test]
fn among_obstacles_intervals_and_exchanges_are_bounded() {
    let robot = panda();
    let mut draws = rng::stream(32, 0);
    let mut most = [(); 3].map(|()| Most::default());
    for kind in 0..10 {
        for (limits, most) in all_limits(&robot).into_iter().zip(&mut most) {
            let scenes = [a_cage(&robot), random_obstacles(&robot, &mut draws)];
            for scene in scenes {
                let mut session = session(&robot, limits.clone(), surroundings(scene.clone()), vec![]);
                for tick in 0..300 {
                    // Obstacles that come, jump aside, and stand still again.
                    if tick % 100 == 50 {
                        let moving = random_obstacles(&robot, &mut draws);
                        let velocities = vec![[0.0, [0.5, -0.2, 0.0][kind % 3], 0.1]; moving.len()];
                        session.set_obstacles(Some(moving.into()), velocities).unwrap();
                    } else if tick % 100 == 0 {
                        session.set_obstacles(Some(scene.clone().into()), vec![]).unwrap();
                    }
                    most.step(&mut session, target(&robot, kind, tick, &mut draws));
                }
            }
        }
    }
    assert!(most.iter().all(|most| most.intervals <= INTERVALS && most.exchanges <= EXCHANGES), "{most:?}");
    assert!(most[1..].iter().all(|most| most.evaluations <= PURSUIT + 1), "{most:?}");
    assert!(most.iter().all(|most| most.intervals > 0 && most.exchanges > 0), "{most:?}");
}

#[test]
fn holding_a_tray_takes_a_bounded_number_of_exchanges() {
    let robot = tips::robot();
    let home = tips::forward([0.5, 0.25, 0.9], [0.0; 3]);
    let q = tips::start(&robot, &home);
    let mut draws = rng::stream(33, 0);
    let mut most = [(); 3].map(|()| Most::default());
    for kind in 0..5 {
        for ((limits, _), most) in tips::all_limits(&robot).into_iter().zip(&mut most) {
            let mut session = tips::session(&robot, &q, limits);
            for tick in 0..200 {
                let left = tips::forward(hostile(kind, tick, [0.5, 0.25, 0.9], &mut draws), [0.0; 3]);
                most.step(&mut session, tips::targets(&left).into_iter().collect::<Arrival>());
            }
        }
    }
    assert!(most.iter().all(|most| most.evaluations <= PURSUIT + 1 && (1..250).contains(&most.exchanges)), "{most:?}");
}
