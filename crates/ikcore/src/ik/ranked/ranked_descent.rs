//! Descent to the least error of the second part of a pose among the configurations that meet the first.
//!
//! Newton's method for an optimum on equations (sequential quadratic programming) in the box of the limits: each step solves the
//! equations of the first part to first order and minimises a quadratic model of the second along their null space. A step is
//! halved until it lowers the merit, the value of the second part plus the error of the first times its largest price.

use crate::math::ranked_step::{RankedModel, RankedStep};
use crate::math::vector::{largest_difference, write_within};
use crate::math::{Columns, Frame};
use crate::objective::{Bounds, Point};
use crate::robot::Robot;
use crate::task::First;

/// Largest number of steps; a handful is usual.
const MOST_STEPS: usize = 40;

/// Evaluations after which a descent ends.
const LONG: usize = 100;

/// Largest number of evaluations of a descent: it ends with the step under way.
pub(crate) const MOST_EVALUATIONS: usize = 150;

/// Step (rad, m) at which the descent ends: convergence is quadratic, so the step taken is the last.
const SHORT: f64 = 1e-6;

/// Largest number of halvings of a step.
const HALVINGS: usize = 8;

/// Error of the first part (m, rad) at which it counts as met.
const MET: f64 = 1e-11;

/// Steps that lower the error of the first part at the end.
const LAST_STEPS: usize = 4;

/// Error of the first part (m, rad) above which it counts as out of reach.
const OUT_OF_REACH: f64 = 1e-8;

/// Motion of the first part (m, rad) per rad or m of a joint below which the joint leaves it unchanged.
const IDLE: f64 = 1e-9;

/// Price of an error of the first part, relative to the multipliers.
const PRICE: f64 = 2.0;

/// Least price of an error of the first part (1/m or m^2/rad).
const LEAST_PRICE: f64 = 1.0;

/// Step (rad, m) up to which the Lagrangian judges steps too.
const NEAR: f64 = 0.1;

/// Price of the squared error of the first part in the Lagrangian (1/m^2, 1/rad^2).
const CURVED: f64 = 50.0;

/// Descent towards one pose.
pub(crate) struct RankedDescent<'a> {
    robot: &'a Robot,
    target: &'a Frame,
    first: First,
    bounds: &'a Bounds,
    /// Evaluations of the forward kinematics.
    pub evaluations: usize,
    /// Number of evaluations at which the descent under way ends.
    until: usize,
}

/// Configuration with the errors of both parts.
#[derive(Debug, Clone)]
pub(crate) struct RankedPoint {
    pub q: Point,
    /// Error of the first part (m or rad).
    pub first: f64,
    /// Value of the second part: 1 - cos(angle), or half the squared distance (m^2).
    pub second: f64,
}

/// Model of the pose at a configuration.
#[derive(Debug, Default)]
struct At {
    columns: Columns,
    model: RankedModel,
}

impl At {
    fn first_error(&self) -> f64 {
        self.model.residual.iter().map(|entry| entry * entry).sum::<f64>().sqrt()
    }
}

impl RankedPoint {
    /// Whether the first part is met.
    pub fn is_met(&self) -> bool {
        self.first <= OUT_OF_REACH
    }
}

impl<'a> RankedDescent<'a> {
    /// Descent towards `target` in the box `bounds`.
    pub fn new(robot: &'a Robot, target: &'a Frame, first: First, bounds: &'a Bounds) -> Self {
        Self { robot, target, first, bounds, evaluations: 0, until: LONG }
    }

    /// Descends from `q`, inside the box.
    pub fn descend(&mut self, q: &[f64]) -> RankedPoint {
        self.until = self.evaluations + LONG;
        let (mut a, mut b) = (At::default(), At::default());
        let (mut here, mut there) = (&mut a, &mut b);
        let mut q = Point::from_slice(q);
        self.bounds.clip(&mut q);
        self.place(&q, here);
        let mut trial = q.clone();
        for _ in 0..MOST_STEPS {
            let multipliers = self.step(here, &q, &mut trial);
            let length = largest_difference(&trial, &q);
            if length == 0.0 || !self.lowered(&multipliers, &q, &mut trial, here, there) {
                break;
            }
            q.copy_from_slice(&trial);
            std::mem::swap(&mut here, &mut there);
            if length < SHORT || self.evaluations >= self.until {
                break;
            }
        }
        self.meet_first(&mut q, &mut here, &mut there);
        if here.first_error() > OUT_OF_REACH {
            self.approach_first(&mut q);
            self.turn_idle_joints(&mut q);
            self.place(&q, here);
        }
        RankedPoint { first: here.first_error(), second: here.model.value, q }
    }

    /// Writes the point after one step from `q` into `out`, and returns the multipliers of the first part.
    fn step(&self, here: &At, q: &[f64], out: &mut Point) -> [f64; 3] {
        let [lower, upper] = self.bounds.ends();
        RankedStep { columns: &here.columns, model: &here.model, x: q, lower, upper }.write(out)
    }

    /// Shortens `trial` until its merit is lower than at `q`; returns whether that succeeds.
    fn lowered(&mut self, multipliers: &[f64; 3], q: &[f64], trial: &mut Point, here: &At, there: &mut At) -> bool {
        let price = PRICE * multipliers.iter().map(|entry| entry * entry).sum::<f64>().sqrt() + LEAST_PRICE;
        let merit = |at: &At| at.model.value + price * at.first_error();
        let lagrangian = |at: &At| {
            let balance: f64 = multipliers.iter().zip(&at.model.residual).map(|(price, entry)| price * entry).sum();
            at.model.value + balance + CURVED * at.first_error().powi(2)
        };
        let (before, balanced) = (merit(here), lagrangian(here));
        let mut end = None;
        let mut fraction = 1.0;
        for _ in 0..HALVINGS {
            self.place(trial, there);
            let after = merit(there);
            let length = largest_difference(trial, q);
            // At an optimum, rounding may hide the gain of the last step; near it, a full step may gain less than the bend of the
            // equations costs, which the Lagrangian leaves out.
            let is_near = length < NEAR && lagrangian(there) < balanced;
            if after < before || is_near || length < SHORT && after <= before + 1e-14 {
                return true;
            }
            fraction *= 0.5;
            let end = end.get_or_insert_with(|| trial.clone());
            write_within(q, end, fraction, trial);
        }
        false
    }

    /// Lowers the error of the first part alone, to rounding.
    fn meet_first<'b>(&mut self, q: &mut Point, here: &mut &'b mut At, next: &mut &'b mut At) {
        let [lower, upper] = self.bounds.ends();
        for _ in 0..LAST_STEPS {
            if here.first_error() <= MET {
                return;
            }
            let mut trial = q.clone();
            RankedStep { columns: &here.columns, model: &here.model, x: q, lower, upper }.write_first(&mut trial);
            self.place(&trial, next);
            if !(next.first_error() < here.first_error()) {
                return;
            }
            q.copy_from_slice(&trial);
            std::mem::swap(here, next);
        }
    }

    /// Lowers the error of a first part that is out of reach, by Newton's method on its square.
    fn approach_first(&mut self, q: &mut Point) {
        let other = match self.first {
            First::Position => First::Orientation,
            First::Orientation => First::Position,
        };
        let bounds = self.bounds;
        self.minimise(q, bounds, |descent, q, at| {
            descent.place_by(other, q, at);
            // Without equations, the part that usually comes second is all that counts.
            at.columns[..q.len()].fill([0.0; 6]);
            at.model.residual = [0.0; 3];
        });
    }

    /// Lowers the error of the second part by the joints that leave the first unchanged.
    fn turn_idle_joints(&mut self, q: &mut Point) {
        let mut at = At::default();
        self.place(q, &mut at);
        let row = at.model.first_row;
        let moves = |column: &[f64; 6]| column[row..row + 3].iter().any(|entry| entry.abs() > IDLE);
        let [lower, upper] = self.bounds.ends();
        let ranges =
            q.iter().enumerate().map(|(j, q)| if moves(&at.columns[j]) { (*q, *q) } else { (lower[j], upper[j]) });
        let idle = Bounds::from_ranges(ranges);
        self.minimise(q, &idle, |descent, q, at| {
            descent.place(q, at);
            at.columns[..q.len()].fill([0.0; 6]);
            at.model.residual = [0.0; 3];
        });
    }

    /// Minimises the value of the model that `place` writes, in `bounds`, without equations.
    fn minimise(&mut self, q: &mut Point, bounds: &Bounds, place: impl Fn(&mut Self, &[f64], &mut At)) {
        let (mut a, mut b) = (At::default(), At::default());
        let (mut here, mut there) = (&mut a, &mut b);
        let [lower, upper] = bounds.ends();
        place(self, q, here);
        for _ in 0..MOST_STEPS {
            let mut trial = q.clone();
            RankedStep { columns: &here.columns, model: &here.model, x: q, lower, upper }.write(&mut trial);
            let (end, mut fraction) = (trial.clone(), 1.0);
            let is_lower = (0..HALVINGS).any(|_| {
                write_within(q, &end, fraction, &mut trial);
                place(self, &trial, there);
                fraction *= 0.5;
                there.model.value < here.model.value
            });
            if !is_lower {
                return;
            }
            let length = largest_difference(&trial, q);
            q.copy_from_slice(&trial);
            std::mem::swap(&mut here, &mut there);
            if length < SHORT || self.evaluations >= self.until {
                return;
            }
        }
    }

    fn place(&mut self, q: &[f64], at: &mut At) {
        self.place_by(self.first, q, at);
    }

    fn place_by(&mut self, first: First, q: &[f64], at: &mut At) {
        self.evaluations += 1;
        at.columns.fit(q.len());
        let tip = self.robot.tip_and_jacobian(q, &mut at.columns);
        first.write_model(self.target, &tip, &mut at.columns[..q.len()], &mut at.model);
    }
}
