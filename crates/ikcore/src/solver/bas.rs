//! Beetle antennae search (BAS) for motion planning, Cheng et al. (2020): Algorithm 1 and equations (8) to (13).
//!
//! A step of this solver is one pass: lines 5 to 15 of Algorithm 1, n explorations with one antenna length. Line 16 belongs to
//! the caller: the driver stops in the error band or below a given value.
//!
//! Our reading of points that the paper leaves open: o in eq. (12) is the squared norm of the error, so that the antennae
//! shrink in proportion to the error; it is taken at the best point so far, for the current target. Passes after the first
//! start from the best beetle so far.
//!
//! A literal reading of the paper has two consequences. With c2 = 1 a beetle moves exactly to one of its antennae, so a third
//! of all evaluations repeat an earlier one; we repeat them too, so that counts are comparable. The best point is kept over all
//! evaluations, including antennae, which for c2 = 1 is the best beetle of line 15.

use smallvec::SmallVec;

use super::driver::Solver;
use super::evaluator::Evaluator;
use super::status::Status;
use crate::error::{Result, require_at_least_one, require_positive};
use crate::math::comparison::sign;
use crate::objective::{Objective, Point};
use crate::wording::words;

/// Starting point of the next exploration of a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BasVariant {
    /// Best point before the pass: eq. (8), (9) and (11) as printed.
    Star,
    /// Last position of the beetle, better or not: the original beetle antennae search.
    Chain,
    /// Last position of the beetle if it is better; antennae follow the error at once, and a pass ends when solved.
    Greedy,
}

words!("variant": BasVariant { Star => "star", Chain => "chain", Greedy => "greedy" });

/// Options of beetle antennae search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bas {
    /// Starting point of explorations.
    pub variant: BasVariant,
    /// Antenna length relative to the error, eq. (12): rad per unit of the error norm.
    pub c1: f64,
    /// Step length relative to the antenna length, eq. (13).
    pub c2: f64,
    /// Explorations per pass, n in the paper.
    pub explorations: usize,
    /// Passes after which the search gives up; the paper sets no limit.
    pub max_passes: usize,
}

impl Default for Bas {
    fn default() -> Self {
        Self::of(BasVariant::Star)
    }
}

impl Bas {
    /// Variant with the options that tracked best on a 7-joint arm of about a metre.
    pub fn of(variant: BasVariant) -> Self {
        let (c1, explorations) = match variant {
            BasVariant::Star => (3.0, 50),
            BasVariant::Chain => (1.0, 30),
            BasVariant::Greedy => (3.0, 5),
        };
        Self { variant, c1, c2: 1.0, explorations, max_passes: 200 }
    }

    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names the option and its range.
    pub fn validate(&self) -> Result<()> {
        require_positive("c1", self.c1)?;
        require_positive("c2", self.c2)?;
        require_at_least_one("explorations", self.explorations)?;
        require_at_least_one("max_passes", self.max_passes)
    }
}

/// State of the beetle between passes.
#[derive(Debug, Clone, Default)]
pub struct State {
    /// Best position of the beetle.
    base: Point,
    base_value: f64,
    passes: usize,
    group: Group,
}

/// State of the beetle within a pass.
struct Pass {
    /// Starting point of explorations.
    current: Point,
    current_value: f64,
    /// Antenna length (rad).
    lambda: f64,
    /// Best position in this pass.
    best: Point,
    best_value: f64,
}

/// Number of explorations of a star that are evaluated together, since they are independent.
const LARGEST_GROUP: usize = 4;

/// Points, stored consecutively; on the stack up to eight entries each.
type Points = SmallVec<[f64; 2 * LARGEST_GROUP * 8]>;

/// Storage for a group of explorations.
#[derive(Debug, Clone, Default)]
struct Group {
    directions: Points,
    antennae: Points,
    beetles: Points,
}

impl<O: Objective + ?Sized> Solver<O> for Bas {
    type State = State;

    fn start(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<(), Status> {
        let mut base = Point::from_slice(x0);
        let base_value = evaluator.evaluate(&mut base)?;
        *state = State { group: Group::new(self.group(), base.len()), base, base_value, passes: 0 };
        Ok(())
    }

    /// Runs one pass: lines 5 to 15 of Algorithm 1.
    fn step(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Status> {
        if state.passes == self.max_passes {
            return Err(Status::Stalled);
        }
        state.passes += 1;
        let State { base, base_value, group, .. } = state;
        let mut pass = Pass {
            current: base.clone(),
            current_value: *base_value,
            lambda: self.antenna_length(*base_value),
            best: base.clone(),
            best_value: f64::INFINITY,
        };
        for explored in (0..self.explorations).step_by(self.group()) {
            let count = self.group().min(self.explorations - explored);
            let values = self.explore(&pass, group, count, evaluator)?;
            for (beetle, value) in group.beetles.chunks_exact(base.len()).zip(values).take(count) {
                self.walk(&mut pass, beetle, value);
            }
            if self.variant == BasVariant::Greedy && pass.best_value < *base_value {
                evaluator.check_solved()?;
            }
        }
        // A pass without improvement starts again from the same position.
        if pass.best_value < *base_value {
            (*base, *base_value) = (pass.best, pass.best_value);
        }
        Ok(())
    }
}

impl Bas {
    /// Number of explorations that start from the same point.
    fn group(&self) -> usize {
        if self.variant == BasVariant::Star { LARGEST_GROUP } else { 1 }
    }

    /// Antenna length lambda = c1 sqrt(o), eq. (12); 1 if the start has no finite value. The rule assumes that the minimum is
    /// zero, as for an error. Shift any other function by its expected minimum, or antennae do not shrink near it.
    fn antenna_length(&self, value: f64) -> f64 {
        self.c1 * if value.is_finite() { value.abs().sqrt() } else { 1.0 }
    }

    /// Runs steps i) to v) of `count` explorations from one point: writes the beetles' next positions to `group`, and returns o
    /// there.
    #[inline]
    fn explore<O: Objective + ?Sized>(
        &self,
        pass: &Pass,
        group: &mut Group,
        count: usize,
        evaluator: &mut Evaluator<'_, O>,
    ) -> Result<[f64; LARGEST_GROUP], Status> {
        let Pass { current: x, lambda, .. } = pass;
        let n = x.len();
        let antennae = &mut group.antennae[..2 * count * n];
        let beetles = &mut group.beetles[..count * n];
        // Steps i) random directions b, ii) to iv) values at both antennae, eq. (8) to (10).
        for (b, pair) in group.directions.chunks_exact_mut(n).zip(antennae.chunks_exact_mut(2 * n)) {
            evaluator.rng().direction(b);
            let (left, right) = pair.split_at_mut(n);
            place(left, x, *lambda, b);
            place(right, x, -lambda, b);
        }
        let mut smells = [[0.0; 2]; LARGEST_GROUP];
        evaluator.evaluate_all(antennae, smells[..count].as_flattened_mut())?;
        // Step v) move towards the lower value, eq. (11) and (13). With equal values, also if neither is finite, the beetle
        // stays.
        let delta = self.c2 * lambda;
        for ((b, beetle), [left, right]) in
            group.directions.chunks_exact(n).zip(beetles.chunks_exact_mut(n)).zip(smells)
        {
            place(beetle, x, -delta * sign(left - right), b);
        }
        let mut values = [0.0; LARGEST_GROUP];
        evaluator.evaluate_all(beetles, &mut values[..count])?;
        Ok(values)
    }

    /// Runs steps vi) record and vii) update the position, for a beetle that moved to `beetle` with this `value`.
    #[inline]
    fn walk(&self, pass: &mut Pass, beetle: &[f64], value: f64) {
        if value < pass.best_value {
            pass.best.copy_from_slice(beetle);
            pass.best_value = value;
        }
        match self.variant {
            BasVariant::Star => {}
            BasVariant::Chain => pass.current.copy_from_slice(beetle),
            BasVariant::Greedy if value < pass.current_value => {
                pass.current.copy_from_slice(beetle);
                pass.current_value = value;
                pass.lambda = self.antenna_length(value);
            }
            BasVariant::Greedy => {}
        }
    }
}

impl Group {
    fn new(explorations: usize, dimension: usize) -> Self {
        let room = |points: usize| Points::from_elem(0.0, points * dimension);
        Self { directions: room(explorations), antennae: room(2 * explorations), beetles: room(explorations) }
    }
}

/// Writes x + distance b.
#[inline]
fn place(out: &mut [f64], x: &[f64], distance: f64, b: &[f64]) {
    for ((out, x), b) in out.iter_mut().zip(x).zip(b) {
        *out = x + distance * b;
    }
}
