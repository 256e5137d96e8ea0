//! Descent of several tips to the least error of each level among the configurations with the least errors of the levels below.
//!
//! The levels are lowered one after another, each by Newton's method along what the levels below leave free
//! (`math/level_step.rs`). After each step the levels below are brought back to their least errors; a step that fails in that, or that
//! does not lower the error of its own level, is halved. So no level is ever worse for those above it.

use nalgebra::{DMatrix, DVector};
use smallvec::SmallVec;

use crate::math::level_step::{LevelModel, write_level_step};
use crate::math::vector::{largest_difference, write_within};
use crate::objective::{Bounds, Linearization, Point};
use crate::obstacle::ClearSpace;
use crate::robot::Robot;
use crate::task::Levels;

/// Largest number of steps of one level; a handful is usual.
const MOST_STEPS: usize = 60;

/// Step (rad, m) at which the descent of a level ends.
const SHORT: f64 = 1e-8;

/// Relative decrease of the squared error at which the descent of a level ends.
const NO_GAIN: f64 = 1e-10;

/// Largest number of halvings of a step.
const HALVINGS: usize = 10;

/// Squared error of a level (m^2, rad^2) at which it counts as met.
const MET: f64 = 1e-18;

/// Relative increase of the squared error of a level below that counts as none.
const SAME: f64 = 1e-9;

/// Corrections of the levels below after a step; they converge quadratically.
const CORRECTIONS: usize = 5;

/// Error of a level (m, rad) below which Gauss-Newton suffices.
const SMALL: f64 = 1e-3;
/// Relative decrease of the squared error in a step above which Gauss-Newton suffices for the next.
const FAST: f64 = 0.5;

/// Step (rad, m) of the finite differences for second derivatives.
const APART: f64 = 1e-6;

/// Relative curvature of products of Jacobians below which a direction is flat.
const FLAT: f64 = 1e-12;
/// The same for finite differences.
const FLAT_BY_DIFFERENCES: f64 = 1e-5;

/// Relative excess over the best known error of a level at which a descent is abandoned.
const WORSE: f64 = 1e-3;
/// Absolute excess (m, rad) on top of it.
const WORSE_BY: f64 = 1e-5;

/// Squared errors of the levels (m^2, rad^2), the lowest level first.
pub(crate) type Errors = SmallVec<[f64; 4]>;

/// Descent to the targets of several levels.
pub(crate) struct LevelDescent<'a> {
    robot: &'a Robot,
    levels: &'a Levels,
    bounds: &'a Bounds,
    /// Space that a descent which begins in it does not leave.
    space: Option<&'a ClearSpace<'a>>,
    /// Evaluations of the forward kinematics.
    pub evaluations: usize,
    /// Number of evaluations at which the descents end.
    pub until: usize,
    scratch: Linearization,
}

/// Configuration with the errors of the levels.
#[derive(Debug, Clone)]
pub(crate) struct LevelPoint {
    pub q: Point,
    pub errors: Errors,
}

/// Residuals and Jacobian of a level at a point, by joints.
#[derive(Debug, Clone, Default)]
struct Rows {
    jacobian: DMatrix<f64>,
    residual: DVector<f64>,
}

impl Rows {
    fn gradient(&self) -> DVector<f64> {
        self.jacobian.tr_mul(&self.residual)
    }

    fn is_met(&self) -> bool {
        self.residual.norm_squared() <= MET
    }
}

impl<'a> LevelDescent<'a> {
    /// Descents in the box `bounds` that end within this many `evaluations`, but for one for each level of a descent.
    pub fn new(robot: &'a Robot, levels: &'a Levels, bounds: &'a Bounds, evaluations: usize) -> Self {
        Self {
            robot,
            levels,
            bounds,
            space: None,
            evaluations: 0,
            until: evaluations,
            scratch: Linearization::default(),
        }
    }

    /// Descents that stay in `space` where they begin in it.
    pub fn within(self, space: Option<&'a ClearSpace<'a>>) -> Self {
        Self { space, ..self }
    }

    /// Descends from `q`; ends early where a level stays worse than that of `best`, the errors of another descent.
    pub fn descend(&mut self, q: &[f64], best: Option<&Errors>) -> LevelPoint {
        let mut q = Point::from_slice(q);
        self.bounds.clip(&mut q);
        let mut errors = Errors::new();
        for k in 0..self.levels.len() {
            let error = self.lower(k, &mut q, &errors);
            errors.push(error);
            if best.is_some_and(|best| error.sqrt() > best[k].sqrt() * (1.0 + WORSE) + WORSE_BY) {
                errors.resize(self.levels.len(), f64::INFINITY);
                break;
            }
            if best.is_some_and(|best| error.sqrt() * (1.0 + WORSE) + WORSE_BY < best[k].sqrt()) {
                return self.descend_on(k + 1, q, errors);
            }
        }
        LevelPoint { q, errors }
    }

    /// Lowers the levels from number `from` on.
    fn descend_on(&mut self, from: usize, mut q: Point, mut errors: Errors) -> LevelPoint {
        for k in from..self.levels.len() {
            let error = self.lower(k, &mut q, &errors);
            errors.push(error);
        }
        LevelPoint { q, errors }
    }

    /// Lowers the error of the lowest level alone, by short steps.
    pub fn lower_lowest(&mut self, q: &mut Point) {
        self.lower(0, q, &Errors::new());
    }

    /// Lowers the error of level `k` as far as the levels below allow, whose errors are `below`; returns what is left of it.
    fn lower(&mut self, k: usize, q: &mut Point, below: &Errors) -> f64 {
        let space = self.space.filter(|space| space.holds(q));
        let mut value = self.value(k, q);
        let mut trial = q.clone();
        let dearest = q.len() + 2 + HALVINGS * (CORRECTIONS + 2);
        let mut is_bent = false;
        for _ in 0..MOST_STEPS {
            if value <= MET || self.evaluations + dearest > self.until {
                break;
            }
            is_bent &= value > SMALL * SMALL;
            let models = self.models(k, q, is_bent);
            let each: SmallVec<[&LevelModel; 4]> = models.iter().collect();
            write_level_step(&each, q, self.bounds.ends(), &mut trial);
            let (end, mut fraction) = (trial.clone(), 1.0);
            let mut lowered = None;
            for _ in 0..HALVINGS {
                write_within(q, &end, fraction, &mut trial);
                if self.correct_below(k, &mut trial, &models, below) && space.is_none_or(|space| space.holds(&trial)) {
                    let after = self.value(k, &trial);
                    if after < value {
                        lowered = Some(after);
                        break;
                    }
                }
                fraction *= 0.5;
            }
            let gain = lowered.map_or(0.0, |after| 1.0 - after / value);
            let length = largest_difference(&trial, q);
            if let Some(after) = lowered {
                q.copy_from_slice(&trial);
                value = after;
            }
            if gain >= NO_GAIN && length >= SHORT {
                is_bent = gain < FAST;
            } else if is_bent || value <= SMALL * SMALL {
                break;
            } else {
                is_bent = true;
            }
        }
        value
    }

    /// Brings the levels below `k` back to their errors `below`; returns whether that succeeds. `models` are those of the last step.
    fn correct_below(&mut self, k: usize, q: &mut Point, models: &[LevelModel], below: &Errors) -> bool {
        let mut next = q.clone();
        for round in 0..=CORRECTIONS {
            let rows: SmallVec<[Rows; 4]> = (0..k).map(|j| self.rows(j, q)).collect();
            self.evaluations += usize::from(k > 0);
            let is_same = |(rows, below): (&Rows, &f64)| rows.residual.norm_squared() <= below * (1.0 + SAME) + MET;
            if rows.iter().zip(below).all(is_same) {
                return true;
            }
            if round == CORRECTIONS {
                break;
            }
            let model = |(j, rows): (usize, &Rows)| {
                if below[j] <= MET {
                    return by_jacobian(rows);
                }
                LevelModel { gradient: rows.gradient(), ..models[j].clone() }
            };
            let models: SmallVec<[LevelModel; 4]> = rows.iter().enumerate().map(model).collect();
            let each: SmallVec<[&LevelModel; 4]> = models.iter().collect();
            write_level_step(&each, q, self.bounds.ends(), &mut next);
            q.copy_from_slice(&next);
        }
        false
    }

    /// Models of the levels up to number `k` at `q`. Where an error is left, in that of level `k` itself if `own` is set, the second
    /// derivatives are those of the Lagrangian: the equations of the levels below count by their multipliers.
    fn models(&mut self, k: usize, q: &[f64], own: bool) -> Vec<LevelModel> {
        let rows: SmallVec<[Rows; 4]> = (0..=k).map(|j| self.rows(j, q)).collect();
        self.evaluations += 1;
        let mut models: Vec<LevelModel> = rows.iter().map(by_jacobian).collect();
        let bending: SmallVec<[usize; 4]> = (0..=k).filter(|i| !rows[*i].is_met() && (*i < k || own)).collect();
        if bending.is_empty() {
            return models;
        }
        let multipliers: SmallVec<[Multipliers; 4]> = (0..=k).map(|i| self.multipliers(&rows[..=i], q)).collect();
        let mut ahead = Point::from_slice(q);
        let mut bent: Vec<DMatrix<f64>> = models.iter().map(|model| model.hessian.clone()).collect();
        for (j, at) in q.iter().enumerate() {
            ahead[j] = at + APART;
            let there: SmallVec<[Rows; 4]> = (0..=k).map(|i| self.rows(i, &ahead)).collect();
            self.evaluations += 1;
            for i in bending.iter().copied() {
                let slope = |rows: &[Rows]| lagrangian_slope(&rows[..=i], &multipliers[i]);
                bent[i].set_column(j, &((slope(&there) - slope(&rows)) / APART));
            }
            ahead[j] = *at;
        }
        for i in bending {
            models[i].hessian = 0.5 * (&bent[i] + bent[i].transpose());
            models[i].flat = FLAT_BY_DIFFERENCES;
        }
        models
    }

    /// Multipliers by which the equations of the levels below balance the gradient of the last of `rows`, one for each of their
    /// rows; zero for the levels below that are not met. Empty for a level that is met, or that stands alone.
    fn multipliers(&self, rows: &[Rows], q: &[f64]) -> Multipliers {
        let Some((own, below)) = rows.split_last() else { return Multipliers::new() };
        if own.is_met() {
            return Multipliers::new();
        }
        let [lower, upper] = self.bounds.ends();
        let inside: Vec<usize> = (0..q.len()).filter(|j| lower[*j] < q[*j] && q[*j] < upper[*j]).collect();
        let count: usize = below.iter().filter(|rows| rows.is_met()).map(|rows| rows.residual.len()).sum();
        if count == 0 || inside.is_empty() {
            return Multipliers::new();
        }
        let mut equations = DMatrix::zeros(count, inside.len());
        let mut first = 0;
        for rows in below.iter().filter(|rows| rows.is_met()) {
            let count = rows.residual.len();
            equations.rows_mut(first, count).copy_from(&rows.jacobian.select_columns(&inside));
            first += count;
        }
        let gradient = own.gradient();
        let right = DVector::from_fn(inside.len(), |i, _| -gradient[inside[i]]);
        if !equations.iter().chain(&right).all(|entry| entry.is_finite()) {
            return Multipliers::new();
        }
        let Ok(balanced) = equations.transpose().svd(true, true).solve(&right, 1e-9) else { return Multipliers::new() };
        let mut found = balanced.iter().copied();
        let each = below.iter().flat_map(|rows| std::iter::repeat_n(rows.is_met(), rows.residual.len()));
        each.map(|is_met| if is_met { found.next().unwrap_or_default() } else { 0.0 }).collect()
    }

    /// Residuals and Jacobian of level `k` at `q`.
    fn rows(&mut self, k: usize, q: &[f64]) -> Rows {
        self.levels.aims(k).linearize(self.robot, q, &mut self.scratch, |_| ());
        let blocks: SmallVec<[_; 4]> = self.scratch.blocks().collect();
        let row = |i: usize| (&blocks[i / 6], i % 6);
        Rows {
            jacobian: DMatrix::from_fn(6 * blocks.len(), q.len(), |i, j| row(i).0.columns[j][row(i).1]),
            residual: DVector::from_fn(6 * blocks.len(), |i, _| row(i).0.residual[row(i).1]),
        }
    }

    /// Squared error of level `k` at `q`.
    fn value(&mut self, k: usize, q: &[f64]) -> f64 {
        self.evaluations += 1;
        self.levels.aims(k).assess(self.robot, q).score.value
    }
}

/// Multipliers of the rows of the levels below.
type Multipliers = SmallVec<[f64; 12]>;

/// Model by products of the Jacobian, exact where the level is met.
fn by_jacobian(rows: &Rows) -> LevelModel {
    LevelModel { gradient: rows.gradient(), hessian: rows.jacobian.tr_mul(&rows.jacobian), flat: FLAT }
}

/// Gradient of the last of `rows`, half its squared error, plus the equations of the levels below times their `multipliers`.
fn lagrangian_slope(rows: &[Rows], multipliers: &Multipliers) -> DVector<f64> {
    let Some((own, below)) = rows.split_last() else { return DVector::zeros(0) };
    let mut slope = own.gradient();
    let mut rest = &multipliers[..];
    for rows in below.iter().take_while(|_| !multipliers.is_empty()) {
        let (here, later) = rest.split_at(rows.residual.len());
        slope += rows.jacobian.tr_mul(&DVector::from_row_slice(here));
        rest = later;
    }
    slope
}
