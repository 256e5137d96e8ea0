//! Batches of plans: bits equal to single plans, invalid input, errors of single problems, interruption.

use std::sync::Arc;
use std::thread::{self, ThreadId};

use ikcore::Error;
use ikcore::batch::{PlanProblem, plan_batch, plan_status};
use ikcore::limits::{Field, Limits, Profile};
use ikcore::obstacle::Surroundings;
use ikcore::planning::{Endpoint, PointToPointOptions, plan_point_to_point};
use ikcore::robot::Robot;
use ikcore::shape::Shape;
use ikcore::solver::{Monitor, Status, Unattended};
use ikcore::task::Target;

const READY: [f64; 7] = [0.0, 0.3, 0.0, -1.5, 0.0, 1.8, 0.8];

fn panda() -> Robot {
    Robot::named("panda").unwrap().with_capsules_along_links(0.05).unwrap()
}

fn to(end: Endpoint, options: &Arc<PointToPointOptions>) -> PlanProblem {
    PlanProblem { start: Endpoint::Configuration(READY.to_vec()), ends: vec![end], options: Arc::clone(options) }
}

fn at(position: [f64; 3]) -> Endpoint {
    Endpoint::from(Target::Position(position))
}

/// Problems around a ball, beside it, and out of reach.
fn problems(robot: &Robot) -> Vec<PlanProblem> {
    let limits = Limits::of(robot).replace(Field::Acceleration, vec![Profile::Constant(5.0)]).unwrap();
    let ball = Shape::sphere([0.55, 0.2, 0.5], 0.1).unwrap();
    let options = Arc::new(PointToPointOptions {
        limits: Some(limits),
        surroundings: Surroundings::among(vec![ball]),
        seed: 3,
        ..PointToPointOptions::default()
    });
    let farther = Surroundings { margin: Some(0.02), ..options.surroundings.clone() };
    let own = Arc::new(PointToPointOptions { seed: 4, surroundings: farther, ..(*options).clone() });
    let mut all: Vec<PlanProblem> = (-3..4).map(|k| to(at([0.45, 0.15 * f64::from(k), 0.4]), &options)).collect();
    all.push(to(at([0.4, 0.4, 0.5]), &own));
    all.push(to(at([4.0, 0.0, 0.5]), &options));
    all.push(to(Endpoint::Configuration(vec![0.3, 0.8, 0.1, -1.3, 0.0, 1.5, 0.3]), &options));
    all
}

#[test]
fn each_item_is_what_a_single_plan_is_on_any_number_of_threads() {
    let robot = panda();
    let problems = problems(&robot);
    for threads in [Some(1), Some(2), Some(5), None] {
        let results = plan_batch(&robot, &problems, threads, &mut Unattended).unwrap();
        assert_eq!(results.len(), problems.len());
        for (result, PlanProblem { start, ends, options }) in results.iter().zip(&problems) {
            let alone = plan_point_to_point(&robot, start, ends, options, &mut Unattended);
            match (result, &alone) {
                (Ok(plan), Ok(alone)) => assert!(
                    plan.trajectory == alone.trajectory
                        && plan.evaluations == alone.evaluations
                        && plan.clearance == alone.clearance
                ),
                (result, alone) => assert_eq!(result, alone),
            }
        }
        let status: Vec<Status> = results.iter().map(plan_status).collect();
        assert_eq!((status[0], status[8]), (Status::Solved, Status::OutOfReach), "{status:?}");
    }
    assert!(plan_batch(&robot, &[], None, &mut Unattended).unwrap().is_empty());
}

#[test]
fn mistakes_are_named_before_anything_is_planned() {
    let robot = panda();
    let mut wrong = problems(&robot);
    wrong[5].ends.push(at([0.4, f64::NAN, 0.3]));
    let told = |problems: &[PlanProblem], threads| {
        plan_batch(&robot, problems, threads, &mut Unattended).unwrap_err().to_string()
    };
    assert_eq!(told(&wrong, Some(2)), "problems[5]: end[1] must be finite, but coordinate y is NaN");
    wrong[1].start = Endpoint::Configuration(vec![0.0; 6]);
    assert_eq!(told(&wrong, Some(1)), "problems[1]: start_q of robot 'panda': expected 7 joints, got 6");
    assert_eq!(told(&wrong, Some(0)), "threads must be from 1 to 1024, got 0");
}

/// Monitor that stops at the third report, and records the reporting thread.
struct Stopping {
    reports: usize,
    callers: Vec<ThreadId>,
}

impl Monitor for Stopping {
    fn keep_going(&mut self) -> bool {
        self.callers.push(thread::current().id());
        self.reports < 2
    }

    fn progress(&mut self, _: usize, _: usize) {
        self.callers.push(thread::current().id());
        self.reports += 1;
    }
}

#[test]
fn what_is_left_when_stopped_is_marked() {
    let robot = panda();
    let problems: Vec<PlanProblem> = (0..40).flat_map(|_| problems(&robot)).collect();
    for threads in [1, 3] {
        let mut monitor = Stopping { reports: 0, callers: vec![] };
        let results = plan_batch(&robot, &problems, Some(threads), &mut monitor).unwrap();
        assert_eq!(results.len(), problems.len());
        assert_eq!(results.last().unwrap(), &Err(Error::Interrupted));
        assert_eq!(plan_status(results.last().unwrap()), Status::Interrupted);
        assert!(monitor.callers.iter().all(|caller| *caller == thread::current().id()));
    }
}
