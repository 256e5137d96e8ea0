//! Shared test helpers: robots, targets, arms, generated chains with a reference twin, error messages.

pub mod arms;
pub mod chains;
pub mod circles;
pub mod executed_curve;

use ikcore::limits::{Field, Limits, Profile};
use ikcore::objective::{LeastSquares, Linearization};
use ikcore::problem::Problem;
use ikcore::rng;
use ikcore::robot::Robot;
use ikcore::solver::Monitor;
use ikcore::task::{Aims, Criterion, Target};
use proptest::test_runner::Config;

/// Number of cases of a drawn test that has `usual` ones: as many times more as `PROPTEST_CASES` is of its default of 256.
pub fn cases(usual: u32) -> u32 {
    (u64::from(usual) * u64::from(Config::default().cases) / 256).max(1) as u32
}

/// Settings of a property with `usual` cases.
pub fn drawn(usual: u32) -> Config {
    Config { cases: cases(usual), ..Config::default() }
}

/// Built-in robot of this name.
pub fn robot(name: &str) -> Robot {
    Robot::named(name).unwrap()
}

/// Limits of a robot without velocity limits that say that jumps within a tick are meant.
pub fn jumping(robot: &Robot) -> Option<Limits> {
    Some(Limits::of(robot).replace(Field::Velocity, vec![Profile::Constant(f64::INFINITY)]).unwrap())
}

/// Monitor that stops from its n-th poll on.
pub struct StopAt(pub usize);

impl Monitor for StopAt {
    fn keep_going(&mut self) -> bool {
        self.0 = self.0.saturating_sub(1);
        self.0 > 0
    }
}

/// Message of an expected error.
#[track_caller]
pub fn message<T>(result: ikcore::Result<T>) -> String {
    match result {
        Ok(_) => panic!("no error came"),
        Err(error) => error.to_string(),
    }
}

/// Target at the tip pose of `q`.
pub fn pose_at(robot: &Robot, q: &[f64]) -> Target {
    Target::from(&robot.fk(q).unwrap())
}

/// Target at the tip position of `q`.
pub fn position_at(robot: &Robot, q: &[f64]) -> Target {
    Target::Position(robot.tip_position(q))
}

/// Bits of these numbers: unlike values they tell 0 from -0 and compare NaN.
pub fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// List of `count` random configurations of `robot`.
pub fn configurations(robot: &Robot, count: usize) -> Vec<Vec<f64>> {
    let flat = robot.random_configurations(count, &mut rng::stream(11, 0)).unwrap();
    flat.chunks_exact(robot.dof()).map(<[f64]>::to_vec).collect()
}

/// Targets in tick `tick` of an arm whose tip is at `from`, of five kinds: none can be followed.
pub fn hostile(kind: usize, tick: usize, from: [f64; 3], draws: &mut rng::LazyRng) -> [f64; 3] {
    let mut shifted = |size: f64| from.map(|x| x + size * draws.uniform_in(-1.0, 1.0));
    match (kind, tick % 97) {
        (0, 0) | (1, 0..20) => shifted(1.5),
        (2, _) => shifted(0.003),
        (3, phase) => [from[0] + if phase < 40 { 3.0 } else { -3.0 }, from[1], from[2]],
        (4, _) => [0.0, 0.0, 0.333],
        _ => from,
    }
}

/// Compares the columns of `linearize` with central differences of its residual.
#[track_caller]
pub fn assert_derivative(robot: &Robot, target: &Target, criterion: impl Into<Criterion>, q: &[f64]) {
    let task = criterion.into().into();
    let mut problem = Problem::new(robot, Aims::of_one(&task, target));
    let mut residual_at = |q: &[f64]| {
        let mut out = Linearization::default();
        let score = problem.linearize(q, &mut out);
        let squares: f64 = out.first.residual.iter().map(|r| r * r).sum();
        assert!((score.value - squares).abs() <= 1e-14 * squares, "{}: value and residual differ", robot.name());
        (out.first.residual, out.first.columns)
    };
    let (_, columns) = residual_at(q);
    let h = 1e-6;
    for j in 0..q.len() {
        let mut moved = q.to_vec();
        moved[j] = q[j] + h;
        let (ahead, _) = residual_at(&moved);
        moved[j] = q[j] - h;
        let (behind, _) = residual_at(&moved);
        for row in 0..6 {
            let difference = (ahead[row] - behind[row]) / (2.0 * h);
            let error = (difference - columns[j][row]).abs();
            let size = columns[j].iter().fold(1.0_f64, |size, v| size.max(v.abs()));
            assert!(error < 1e-7 * size, "{}: row {row}, joint {j}: {error:.3e}", robot.name());
        }
    }
}
