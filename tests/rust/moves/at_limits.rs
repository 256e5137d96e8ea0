//! Programs whose joints rest at their limits, leave them and come back: the motion stays inside, by its exact extremes.

use crate::common::{self, robot};
use ikcore::Error;
use ikcore::limits::{Field, Limits, Profile};
use ikcore::planning::{JointGoal, Move, MoveKind, MovesOptions, plan_moves};
use ikcore::rng;
use ikcore::robot::{Joint, Robot};
use ikcore::solver::{Status, Unattended};

const ARMS: [(&str, &[f64]); 2] =
    [("ur5e", &[0.0, -1.5, 1.8, -1.9, -1.57, 0.3]), ("panda", &[0.0, -0.6, 0.0, -2.2, 0.0, 1.8, 0.7])];

/// Rounding of positions (rad).
const ROUNDING: f64 = 1e-9;

/// A program whose first configuration has joints at their limits.
struct AtLimits {
    arm: Robot,
    start: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    moves: Vec<Move>,
    jerk: Option<f64>,
}

impl AtLimits {
    /// Half of the joints begin at one of their limits; some have no room at all.
    fn drawn(case: u64) -> Self {
        let mut rng = rng::stream(38, case);
        let (name, home) = ARMS[rng.below(ARMS.len())];
        let arm = robot(name);
        let [mut start, mut lower, mut upper] =
            [home.to_vec(), bounds(&arm, |joint| joint.lower), bounds(&arm, |joint| joint.upper)];
        let held: Vec<bool> = (0..arm.dof()).map(|_| rng.uniform() < 0.5).collect();
        for joint in 0..arm.dof() {
            start[joint] += rng.uniform_in(-0.2, 0.2);
            let width = if rng.uniform() < 0.1 { 0.0 } else { rng.uniform_in(0.05, 1.0) };
            if held[joint] && rng.uniform() < 0.5 {
                (lower[joint], upper[joint]) = (start[joint] - width, start[joint]);
            } else if held[joint] {
                (lower[joint], upper[joint]) = (start[joint], start[joint] + width);
            }
        }
        let jerk = (rng.uniform() < 0.4).then_some(80.0);
        let mut case = Self { arm, start, lower, upper, moves: vec![], jerk };
        let mut q = case.start.clone();
        for _ in 0..2 + rng.below(3) {
            let goal = case.goal(&q, &held, &mut rng);
            let blend = [0.0, 0.002, 0.01, 0.03][rng.below(4)];
            let kind = match rng.below(5) {
                0 => MoveKind::Wait(0.1),
                1 => {
                    let near: Vec<f64> = q.iter().zip(&goal).map(|(q, goal)| q + 0.3 * (goal - q)).collect();
                    let pose = case.arm.fk(&near).unwrap();
                    q = near;
                    MoveKind::Line { pose, speed: Some(0.1) }
                }
                _ => {
                    q.clone_from(&goal);
                    MoveKind::Joints(JointGoal::Configuration(goal))
                }
            };
            let blend = if matches!(kind, MoveKind::Wait(_)) { 0.0 } else { blend };
            case.moves.push(Move { blend, ..Move::new(kind) });
        }
        case
    }

    /// A configuration near `q`: of the joints that began at a limit some stay where they are, and some are at a limit, or an ulp beyond.
    fn goal(&self, q: &[f64], held: &[bool], rng: &mut rng::LazyRng) -> Vec<f64> {
        let of_joint = |joint: usize| {
            let (lower, upper) = (self.lower[joint], self.upper[joint]);
            let moved = (q[joint] + rng.uniform_in(-0.3, 0.3)).clamp(lower, upper);
            let choices =
                [q[joint], lower.max(q[joint] - 0.3), upper.min(q[joint] + 0.3), upper.next_up(), moved, moved];
            let choice = choices[rng.below(choices.len())];
            if held[joint] && (choice - q[joint]).abs() < 0.4 { choice } else { moved }
        };
        (0..q.len()).map(of_joint).collect()
    }

    fn options(&self) -> MovesOptions {
        let each = |values: &[f64]| values.iter().map(|value| Profile::Constant(*value)).collect::<Vec<_>>();
        let constant = |value: f64| vec![Profile::Constant(value); self.arm.dof()];
        let mut limits = Limits::of(&self.arm);
        limits = limits.replace(Field::Lower, each(&self.lower)).unwrap();
        limits = limits.replace(Field::Upper, each(&self.upper)).unwrap();
        limits = limits.replace(Field::Acceleration, constant(4.0)).unwrap();
        if let Some(jerk) = self.jerk {
            limits = limits.replace(Field::Jerk, constant(jerk)).unwrap();
        }
        MovesOptions { limits: Some(limits), ..MovesOptions::default() }
    }
}

fn bounds(arm: &Robot, of: impl Fn(&Joint) -> f64) -> Vec<f64> {
    arm.joints().iter().map(of).collect()
}

#[test]
fn joints_at_their_limits_stay_inside_while_others_move() {
    let (cases, mut planned) = (common::cases(120), 0);
    for index in 0..u64::from(cases) {
        let case = AtLimits::drawn(index);
        let plan = match plan_moves(&case.arm, &case.moves, &case.start, &case.options(), &mut Unattended) {
            Ok(plan) => plan,
            // A blend without room, a line that needs a joint beyond its limits, nothing that moves.
            Err(Error::InvalidMove { .. } | Error::NotFound { .. } | Error::Unreachable { .. }) => continue,
            Err(error) => panic!("case {index}: {error}"),
        };
        planned += 1;
        assert_eq!(plan.status, Status::Solved, "case {index}: {}", plan.message());
        for (joint, (lowest, highest)) in plan.trajectory.position_range().into_iter().enumerate() {
            let excess = (case.lower[joint] - lowest).max(highest - case.upper[joint]);
            assert!(excess <= ROUNDING, "case {index}: joint {joint} is {excess} beyond its limits");
        }
        let [mut begins, mut qd, mut qdd] = [(); 3].map(|()| vec![0.0; case.arm.dof()]);
        plan.trajectory.at(0.0, &mut begins, &mut qd, &mut qdd).unwrap();
        assert!(begins.iter().zip(&case.start).all(|(q, start)| (q - start).abs() < 1e-12), "case {index}: {begins:?}");
    }
    assert!(3 * planned > cases, "{planned} of {cases}");
}
