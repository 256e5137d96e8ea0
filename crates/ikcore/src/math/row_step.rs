//! Damped least-squares step in a box with linear inequalities (rows).
//!
//! Minimises |residual + J (x - start)|^2 + lambda |x - start|^2 over `lower` <= x <= `upper`, subject to rows g'x >= least
//! and held rows g'x = least. The dual is a least-squares problem in the multipliers, which are nonnegative except for held
//! rows; the active-set method of Lawson and Hanson ("Solving Least Squares Problems", 1974, chapter 23) solves it in
//! finitely many exchanges. Rows are slightly compliant: if no point of the box satisfies all rows, the violations are spread
//! and as small as possible.

use super::MAX_DOF;
use super::block_step::TaskRows;
use super::vector::dot;

/// Tolerance for violations by rounding (rad, m).
const ROUNDING: f64 = 1e-12;

/// Compliance of a row of high priority.
pub const SOFTNESS: f64 = 1e-9;

/// Largest number of active-set exchanges per constraint; a few are usual.
const EXCHANGES: usize = 3;

/// Linear inequality, `gradient`'x >= `least`; as a held row, the equation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Gradient g, one entry per joint; further entries are ignored.
    pub gradient: [f64; MAX_DOF],
    /// Lower bound b of g'x >= b.
    pub least: f64,
    /// Compliance of an active row: its bound is relaxed by this fraction of the displacement along g that its multiplier
    /// causes.
    pub softness: f64,
}

/// Damped least-squares step in a box with linear inequalities.
#[derive(Debug, Clone, Copy)]
pub struct RowStep<'a> {
    /// Jacobians and residuals to be removed by the step; J stacks their rows.
    pub tasks: &'a [TaskRows<'a>],
    /// Damping factor, positive.
    pub lambda: f64,
    /// Current point.
    pub start: &'a [f64],
    /// Lower bounds, one per entry of `start`.
    pub lower: &'a [f64],
    /// Upper bounds, one per entry of `start`.
    pub upper: &'a [f64],
    /// Inequality constraints.
    pub rows: &'a [Row],
    /// Equality constraints.
    pub held: &'a [Row],
}

/// Reference to a bound or a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Constraint {
    Lower(usize),
    Upper(usize),
    Row(usize),
    Held(usize),
}

/// Member of the active set.
#[derive(Debug, Clone)]
struct Active {
    constraint: Constraint,
    multiplier: f64,
    /// Step H^-1 a per unit multiplier of the constraint a'x >= b.
    along: [f64; MAX_DOF],
}

/// Active-set solver for row steps; owns its scratch memory.
#[derive(Debug, Default)]
pub struct RowSolver {
    /// Lower Cholesky factor of H = J'J + lambda I, stored by rows of length n.
    factor: Vec<f64>,
    active: Vec<Active>,
    /// System matrix of the multipliers, by rows, overwritten by its Cholesky factor.
    system: Vec<f64>,
    trial: Vec<f64>,
    /// Unconstrained minimum.
    free: Vec<f64>,
    exchanges: usize,
}

impl RowStep<'_> {
    fn slack(&self, constraint: Constraint, x: &[f64]) -> f64 {
        match constraint {
            Constraint::Lower(j) => x[j] - self.lower[j],
            Constraint::Upper(j) => self.upper[j] - x[j],
            Constraint::Row(i) => dot(&self.rows[i].gradient, x) - self.rows[i].least,
            Constraint::Held(i) => dot(&self.held[i].gradient, x) - self.held[i].least,
        }
    }

    /// Returns a'x for a constraint a'x >= b.
    fn product(&self, constraint: Constraint, x: &[f64]) -> f64 {
        match constraint {
            Constraint::Lower(j) => x[j],
            Constraint::Upper(j) => -x[j],
            Constraint::Row(i) => dot(&self.rows[i].gradient, x),
            Constraint::Held(i) => dot(&self.held[i].gradient, x),
        }
    }

    /// Returns the inactive constraint that `x` violates most.
    fn most_violated(&self, x: &[f64], active: &[Active]) -> Option<Constraint> {
        let bounds = (0..x.len()).flat_map(|j| [Constraint::Lower(j), Constraint::Upper(j)]);
        let constraints = bounds.chain((0..self.rows.len()).map(Constraint::Row));
        let mut worst = (-ROUNDING, None);
        for constraint in constraints {
            let slack = self.slack(constraint, x);
            if slack < worst.0 && active.iter().all(|active| active.constraint != constraint) {
                worst = (slack, Some(constraint));
            }
        }
        worst.1
    }
}

impl RowSolver {
    /// Allocates for steps of `n` entries and this many rows.
    pub fn with_room(n: usize, rows: usize) -> Self {
        let most = n + rows;
        Self {
            factor: Vec::with_capacity(n * n),
            active: Vec::with_capacity(most),
            system: Vec::with_capacity(most * most),
            trial: Vec::with_capacity(most),
            free: Vec::with_capacity(n),
            exchanges: 0,
        }
    }

    /// Exchanges of the active set so far: each solves for the multipliers anew.
    pub fn exchanges(&self) -> usize {
        self.exchanges
    }

    /// Writes the point after the step into `out`. Returns whether a row is active.
    pub fn write(&mut self, step: &RowStep<'_>, out: &mut [f64]) -> bool {
        let n = step.start.len();
        self.factorize(step);
        self.free.clear();
        self.free.resize(n, 0.0);
        for task in step.tasks {
            for (free, column) in self.free.iter_mut().zip(task.columns) {
                *free -= dot(column, task.residual);
            }
        }
        solve_factored(&self.factor, &mut self.free);
        self.free.iter_mut().zip(step.start).for_each(|(free, start)| *free += start);
        out.copy_from_slice(&self.free);
        self.active.clear();
        if !step.held.is_empty() {
            (0..step.held.len()).for_each(|i| self.add(step, Constraint::Held(i)));
            self.settle(step);
            self.write_point(out);
        }
        for _ in 0..EXCHANGES * (2 * n + step.rows.len()) {
            let Some(worst) = step.most_violated(out, &self.active) else { break };
            self.add(step, worst);
            self.settle(step);
            self.write_point(out);
        }
        for (j, out) in out.iter_mut().enumerate() {
            *out = out.max(step.lower[j]).min(step.upper[j]);
        }
        self.active.iter().any(|active| matches!(active.constraint, Constraint::Row(_)))
    }

    /// Writes the point given by the current multipliers.
    fn write_point(&self, out: &mut [f64]) {
        out.copy_from_slice(&self.free);
        for Active { multiplier, along, .. } in &self.active {
            out.iter_mut().zip(along).for_each(|(out, along)| *out += multiplier * along);
        }
    }

    /// Computes the Cholesky factorization H = L L'.
    fn factorize(&mut self, step: &RowStep<'_>) {
        let n = step.start.len();
        self.factor.clear();
        self.factor.resize(n * n, 0.0);
        for i in 0..n {
            for j in 0..=i {
                let damping = if i == j { step.lambda } else { 0.0 };
                let products = step.tasks.iter().map(|task| dot(&task.columns[i], &task.columns[j]));
                self.factor[i * n + j] = products.sum::<f64>() + damping;
            }
        }
        cholesky(&mut self.factor, n, 0.5 * step.lambda);
    }

    fn add(&mut self, step: &RowStep<'_>, constraint: Constraint) {
        let n = step.start.len();
        let mut along = [0.0; MAX_DOF];
        match constraint {
            Constraint::Lower(j) => along[j] = 1.0,
            Constraint::Upper(j) => along[j] = -1.0,
            Constraint::Row(i) => along[..n].copy_from_slice(&step.rows[i].gradient[..n]),
            Constraint::Held(i) => along[..n].copy_from_slice(&step.held[i].gradient[..n]),
        }
        solve_factored(&self.factor, &mut along[..n]);
        self.active.push(Active { constraint, multiplier: 0.0, along });
    }

    /// Moves the multipliers until all active constraints hold exactly; constraints whose multiplier would become negative
    /// leave the active set, except held rows.
    fn settle(&mut self, step: &RowStep<'_>) {
        while !self.active.is_empty() {
            self.solve_for_multipliers(step);
            // First multiplier to become negative, and the fraction of the step at which it does.
            let mut first = (1.0, None);
            for (i, (active, trial)) in self.active.iter().zip(&self.trial).enumerate() {
                let fraction = active.multiplier / (active.multiplier - trial).max(f64::MIN_POSITIVE);
                let leaves = !matches!(active.constraint, Constraint::Held(_));
                if leaves && *trial <= 0.0 && fraction < first.0 {
                    first = (fraction, Some(i));
                }
            }
            let (fraction, first) = first;
            for (active, trial) in self.active.iter_mut().zip(&self.trial) {
                active.multiplier += fraction * (trial - active.multiplier);
            }
            match first {
                Some(i) => self.active.remove(i),
                None => return,
            };
        }
    }

    /// Sets `trial` to the multipliers with which all active constraints hold exactly.
    fn solve_for_multipliers(&mut self, step: &RowStep<'_>) {
        self.exchanges += 1;
        let (m, n) = (self.active.len(), step.start.len());
        self.system.clear();
        self.system.resize(m * m, 0.0);
        self.trial.clear();
        for i in 0..m {
            let constraint = self.active[i].constraint;
            self.trial.push(-step.slack(constraint, &self.free));
            for j in 0..=i {
                let mut entry = step.product(constraint, &self.active[j].along[..n]);
                if i == j {
                    let softness = match constraint {
                        Constraint::Row(i) => step.rows[i].softness,
                        Constraint::Held(i) => step.held[i].softness,
                        Constraint::Lower(_) | Constraint::Upper(_) => 1e-14,
                    };
                    entry *= 1.0 + softness;
                }
                self.system[i * m + j] = entry;
            }
        }
        cholesky(&mut self.system, m, f64::MIN_POSITIVE.sqrt());
        solve_factored(&self.system, &mut self.trial);
    }
}

/// Replaces the lower half of a matrix, by rows of `n`, by its Cholesky factor L. Pivots below `least` are raised to it.
fn cholesky(matrix: &mut [f64], n: usize, least: f64) {
    for i in 0..n {
        for j in 0..=i {
            let mut entry = matrix[i * n + j];
            for k in 0..j {
                entry -= matrix[i * n + k] * matrix[j * n + k];
            }
            matrix[i * n + j] = if i == j { entry.max(least).sqrt() } else { entry / matrix[j * n + j] };
        }
    }
}

/// Solves L L' x = b in place; `factor` holds L by rows.
fn solve_factored(factor: &[f64], x: &mut [f64]) {
    let n = x.len();
    for i in 0..n {
        let known: f64 = (0..i).map(|k| factor[i * n + k] * x[k]).sum();
        x[i] = (x[i] - known) / factor[i * n + i];
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| factor[k * n + i] * x[k]).sum();
        x[i] = (x[i] - known) / factor[i * n + i];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    #[derive(Debug)]
    struct Case {
        columns: Vec<[f64; 6]>,
        residual: [f64; 6],
        lower: Vec<f64>,
        upper: Vec<f64>,
        rows: Vec<Row>,
        held: Vec<Row>,
    }

    const LAMBDA: f64 = 0.05;

    impl Case {
        fn tasks(&self) -> [TaskRows<'_>; 1] {
            [TaskRows { columns: &self.columns, residual: &self.residual, scale: 1.0 }]
        }

        fn solve(&self, start: &[f64], x: &mut [f64]) -> bool {
            let Self { lower, upper, rows, held, .. } = self;
            let tasks = &self.tasks();
            RowSolver::default().write(&RowStep { tasks, lambda: LAMBDA, start, lower, upper, rows, held }, x)
        }

        fn cost(&self, x: &[f64]) -> f64 {
            let residual =
                (0..6).map(|k| self.residual[k] + (0..x.len()).map(|j| self.columns[j][k] * x[j]).sum::<f64>());
            residual.map(|r| r * r).sum::<f64>() + LAMBDA * x.iter().map(|x| x * x).sum::<f64>()
        }

        /// Returns all inequality constraints as a'x >= b.
        fn constraints(&self) -> Vec<(Vec<f64>, f64)> {
            let n = self.columns.len();
            let unit = |j: usize, sign: f64| (0..n).map(|k| if k == j { sign } else { 0.0 }).collect::<Vec<f64>>();
            let mut all: Vec<(Vec<f64>, f64)> =
                (0..n).flat_map(|j| [(unit(j, 1.0), self.lower[j]), (unit(j, -1.0), -self.upper[j])]).collect();
            all.extend(self.rows.iter().map(|row| (row.gradient[..n].to_vec(), row.least)));
            all
        }

        /// Returns the least cost over all points at which the held rows and a subset of the constraints hold exactly; tries
        /// every subset of up to n constraints.
        fn by_enumeration(&self) -> Option<f64> {
            let n = self.columns.len();
            let (all, held) = (self.constraints(), self.held.iter().map(|row| (row.gradient[..n].to_vec(), row.least)));
            let held: Vec<(Vec<f64>, f64)> = held.collect();
            let j = DMatrix::from_fn(6, n, |k, j| self.columns[j][k]);
            let hessian = j.transpose() * &j + DMatrix::identity(n, n) * LAMBDA;
            let slope = j.transpose() * DVector::from_row_slice(&self.residual);
            let mut best: Option<f64> = None;
            for set in 0_u32..1 << all.len() {
                let chosen = (0..all.len()).filter(|i| set & (1 << i) != 0).map(|i| &all[i]);
                let chosen: Vec<_> = held.iter().chain(chosen).collect();
                let m = chosen.len();
                if m > n {
                    continue;
                }
                let mut kkt = DMatrix::zeros(n + m, n + m);
                kkt.view_mut((0, 0), (n, n)).copy_from(&hessian);
                let mut right = DVector::zeros(n + m);
                right.rows_mut(0, n).copy_from(&-&slope);
                for (i, (a, b)) in chosen.iter().enumerate() {
                    for k in 0..n {
                        kkt[(n + i, k)] = a[k];
                        kkt[(k, n + i)] = a[k];
                    }
                    right[n + i] = *b;
                }
                let Some(solution) = kkt.lu().solve(&right) else { continue };
                let x: Vec<f64> = solution.iter().take(n).copied().collect();
                // Contradictory constraints yield multipliers that are pure rounding.
                let met = held.iter().all(|(a, b)| (dot(a, &x) - b).abs() < 1e-9);
                if met && all.iter().all(|(a, b)| dot(a, &x) >= b - 1e-9) {
                    let cost = self.cost(&x);
                    best = Some(best.map_or(cost, |best| best.min(cost)));
                }
            }
            best
        }
    }

    fn rows(n: usize, count: usize) -> impl Strategy<Value = Vec<Row>> {
        let row = (prop::collection::vec(-1.0..1.0, n), -0.6_f64..0.3).prop_map(move |(entries, least)| {
            let mut gradient = [0.0; MAX_DOF];
            gradient[..n].copy_from_slice(&entries);
            Row { gradient, least, softness: SOFTNESS }
        });
        prop::collection::vec(row, count)
    }

    fn case(n: usize, [count, held]: [usize; 2]) -> impl Strategy<Value = Case> {
        (
            prop::collection::vec(prop::array::uniform6(-1.0..1.0), n),
            prop::array::uniform6(-1.0..1.0),
            prop::collection::vec(0.05_f64..1.0, n),
            rows(n, count),
            rows(n, held),
        )
            .prop_map(|(columns, residual, width, rows, held)| {
                let lower = width.iter().map(|width| -width).collect();
                Case { columns, residual, lower, upper: width, rows, held }
            })
    }

    proptest! {
        #[test]
        fn it_is_the_best_of_all_active_sets(
            case in prop_oneof![case(3, [4, 0]), case(3, [4, 1]), case(3, [1, 2])],
        ) {
            let mut x = [0.0; 3];
            case.solve(&[0.0; 3], &mut x);
            if let Some(least) = case.by_enumeration() {
                for (a, b) in case.constraints() {
                    prop_assert!(dot(&a, &x) >= b - 1e-5, "{x:?} {a:?} {b}");
                }
                for Row { gradient, least, .. } in &case.held {
                    prop_assert!((dot(gradient, &x) - least).abs() < 1e-5, "{x:?} {gradient:?} {least}");
                }
                // Compliant rows that barely constrain a point give way slightly, which lowers the cost.
                let excess = (case.cost(&x) - least) / (1.0 + least);
                prop_assert!(-1e-4 < excess && excess < 1e-5, "{} {least}", case.cost(&x));
            }
        }

        #[test]
        fn it_stays_in_the_box_whatever_the_rows(case in prop_oneof![case(7, [12, 0]), case(7, [6, 9])]) {
            let mut x = [f64::NAN; 7];
            case.solve(&[0.0; 7], &mut x);
            prop_assert!((0..7).all(|j| case.lower[j] <= x[j] && x[j] <= case.upper[j]), "{x:?}");
        }
    }

    #[test]
    fn rows_that_contradict_each_other_fall_short_alike() {
        let row = |slope: f64| {
            let mut gradient = [0.0; MAX_DOF];
            gradient[0] = slope;
            Row { gradient, least: 0.5, softness: SOFTNESS }
        };
        let case = Case {
            columns: vec![[0.0; 6]; 2],
            residual: [0.0; 6],
            lower: vec![-1.0; 2],
            upper: vec![1.0; 2],
            rows: vec![row(1.0), row(-1.0)],
            held: vec![],
        };
        let mut x = [0.3, 0.3];
        assert!(case.solve(&[0.3, 0.2], &mut x));
        assert!(x[0].abs() < 1e-4 && (x[1] - 0.2).abs() < 1e-12, "{x:?}");
    }

    #[test]
    fn a_free_step_is_the_damped_one() {
        let case = Case {
            columns: vec![[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]],
            residual: [-1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            lower: vec![-9.0],
            upper: vec![9.0],
            rows: vec![],
            held: vec![],
        };
        let mut x = [0.0];
        assert!(!case.solve(&[0.0], &mut x));
        assert!((x[0] - 1.0 / (1.0 + LAMBDA)).abs() < 1e-15);
    }
}
