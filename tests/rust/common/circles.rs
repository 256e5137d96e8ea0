//! Circles of Cheng et al. (2020), and checks that hold for every track along them.

use ikcore::limits::{Field, Limits, Profile, Sinusoid};
use ikcore::path::{Circle, Path, Plane, Reference};
use ikcore::robot::Robot;
use ikcore::solver::{Algorithm, AnySolver, Bas, BasVariant, LevenbergMarquardt, Status, Unattended};
use ikcore::task::Tolerance;
use ikcore::tracking::{Record, TickRule, TrackOptions, track};

use super::robot;

pub const DT: f64 = 0.2;
pub const DURATION: f64 = 30.0;

/// Starts half a metre (5-link) and a decimetre (iiwa) off the path's first point.
pub const OFF5: [f64; 5] = [0.7197427192, -0.2900667941, -0.1974717864, -0.3088906663, 0.3763813181];
pub const OFF7: [f64; 7] = [0.6449219327, 0.2036664288, 0.1969337234, -0.7713896072, 0.2027968992, 0.7179441060, 0.1];

/// Robot on the paper's circle, within limit + 0.004 sin t (rad/s) on every joint.
pub struct Task {
    pub robot: Robot,
    pub start: Vec<f64>,
    pub circle: Circle,
    pub limit: f64,
}

pub fn circle(center: [f64; 3], diameter: f64) -> Circle {
    Circle::new(Plane::xy(center).unwrap(), diameter, DURATION).unwrap()
}

pub fn five_links() -> Task {
    let circle = circle([4.0, 1.0, 0.0], 1.4);
    Task { robot: robot("planar5"), start: OFF5.to_vec(), circle, limit: 0.2 }
}

pub fn iiwa() -> Task {
    let circle = circle([0.3, 0.3, 1.0], 0.2);
    Task { robot: robot("iiwa14"), start: OFF7.to_vec(), circle, limit: 2.0 }
}

pub fn sinusoid(mean: f64) -> Sinusoid {
    Sinusoid { mean, amplitude: 0.004, angular_frequency: 1.0, phase: 0.0 }
}

pub fn velocity_limits(robot: &Robot, profile: Profile) -> Limits {
    Limits::of(robot).replace(Field::Velocity, vec![profile]).unwrap()
}

pub fn beetle(variant: BasVariant, c1: f64, explorations: usize) -> TickRule {
    TickRule::Solver(AnySolver::Single(Algorithm::from(Bas { variant, c1, explorations, ..Bas::default() })))
}

pub fn descent() -> TickRule {
    TickRule::Solver(AnySolver::Single(Algorithm::LevenbergMarquardt(LevenbergMarquardt::default())))
}

impl Task {
    pub fn reference(&self) -> Reference {
        Path::new(self.circle.clone()).sample(DT).unwrap()
    }

    pub fn options(&self, rule: TickRule, band: f64, seed: u64) -> TrackOptions {
        TrackOptions {
            rule,
            tolerance: Tolerance { position: band, ..Tolerance::default() },
            limits: Some(velocity_limits(&self.robot, Profile::Sinusoid(sinusoid(self.limit)))),
            seed,
            ..TrackOptions::default()
        }
    }

    pub fn track_with(&self, options: &TrackOptions) -> Record {
        track(&self.robot, &self.reference(), Some(&self.start), options, &mut Unattended).unwrap()
    }

    /// Tracks, and checks the invariants of every track.
    pub fn track(&self, rule: TickRule, band: f64, seed: u64) -> Record {
        let record = self.track_with(&self.options(rule, band, seed));
        self.check(&record, band);
        record
    }

    fn check(&self, record: &Record, band: f64) {
        assert_eq!(record.rows(), 151, "time always advances");
        assert_eq!(record.max_violation, 0.0);
        let n = record.dof;
        let time = record.time();
        for i in 1..record.rows() {
            let (from, to) = (time[i - 1], time[i]);
            // The limit's smallest value over the tick, counted out.
            let limit = (0..=100).map(|k| sinusoid(self.limit).at(from + (to - from) * f64::from(k) / 100.0));
            let limit = limit.fold(f64::INFINITY, f64::min);
            for j in 0..n {
                let (q, before, joint) = (record.q[i * n + j], record.q[(i - 1) * n + j], &self.robot.joints()[j]);
                assert!(((q - before) / DT).abs() <= limit + 1e-12, "row {i}, joint {j}");
                assert!(joint.lower <= q && q <= joint.upper, "row {i}, joint {j}: {q}");
            }
            let inside = record.position_error[i] <= band;
            assert_eq!(record.step_status[i] == Status::Solved, inside, "row {i}: {}", record.position_error[i]);
        }
    }
}

/// Number of steps with this status.
pub fn count(record: &Record, status: Status) -> usize {
    record.step_status[1..].iter().filter(|step| **step == status).count()
}
