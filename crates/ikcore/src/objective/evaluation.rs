//! The meeting point of the robot side and the solver side: what is minimised, and within which box.

use smallvec::SmallVec;

use crate::error::{Error, Result};
use crate::math::box_step::ROWS;
use crate::math::f64x4::F64x4;
use crate::math::ordered::{larger, smaller};
use crate::math::{MAX_DOF, interval};
use crate::rng::LazyRng;

/// A point of the search space; on the stack up to [`MAX_DOF`] entries. `clone` copies entry by entry: hot paths take
/// `from_slice`, which copies all at once.
pub type Point = SmallVec<[f64; MAX_DOF]>;

/// The value of an objective at a point, and whether that is good enough.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Score {
    /// The weighted sum of squares r'r.
    pub value: f64,
    /// The problem's own test, such as metres AND radians within their tolerances.
    pub solved: bool,
}

/// How an objective is best evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CallPattern {
    /// Points to evaluate together, where a solver has that many.
    pub batch_size: usize,
    /// Evaluations after which the monitor and the clock are asked again.
    pub poll_interval: usize,
}

impl Default for CallPattern {
    /// For evaluations of tens of nanoseconds: a poll every ten microseconds.
    fn default() -> Self {
        Self { batch_size: 8, poll_interval: 256 }
    }
}

/// Something to minimise. It owns its scratch and is cloned per thread.
pub trait Objective {
    /// Number of entries of a point.
    fn dimension(&self) -> usize;

    /// The score of `x`, which lies inside the box.
    fn evaluate(&mut self, x: &[f64]) -> Score;

    /// Scores of many points, stored one after another in `xs`.
    fn evaluate_all(&mut self, xs: &[f64], out: &mut [Score]) {
        for (x, score) in xs.chunks_exact(self.dimension()).zip(out) {
            *score = self.evaluate(x);
        }
    }

    /// How it is best evaluated; asked once a run.
    fn call_pattern(&self) -> CallPattern {
        CallPattern::default()
    }

    /// The start of attempt number `attempt` (from 1; attempt 0 is the caller's start). By default uniform in the box.
    fn propose_start(&mut self, attempt: usize, bounds: &Bounds, rng: &mut LazyRng, x: &mut [f64]) {
        let _ = attempt;
        bounds.sample(rng, x);
    }

    /// The period of entry number `entry` of a point, if it has one: 2 pi for an angle whose turns do not count.
    fn period(&self, entry: usize) -> Option<f64> {
        let _ = entry;
        None
    }
}

/// Residual r and Jacobian dr/dx at a point.
#[derive(Debug, Clone)]
pub struct Linearization {
    /// Weighted residual, current minus wanted; rows that a task does not use are zero.
    pub residual: [f64; ROWS],
    /// Columns of the weighted Jacobian, one per entry of x; the first `dimension` are in use.
    pub columns: [[f64; ROWS]; MAX_DOF],
}

impl Default for Linearization {
    fn default() -> Self {
        Self { residual: [0.0; ROWS], columns: [[0.0; ROWS]; MAX_DOF] }
    }
}

/// An objective that is a sum of at most six squares.
pub trait Residual: Objective {
    /// The weighted residual at `x`, current minus wanted, and the score; rows that a task does not use are zero.
    fn residual(&mut self, x: &[f64], out: &mut [f64; ROWS]) -> Score;
}

/// One that knows its derivative too.
pub trait LeastSquares: Residual {
    /// Residual and Jacobian at `x` in one pass, and the score.
    fn linearize(&mut self, x: &[f64], out: &mut Linearization) -> Score;
}

/// Four linearizations side by side: each number for all four in one register.
#[derive(Debug, Clone)]
pub struct FourLinearizations {
    /// As [`Linearization::residual`].
    pub residual: [F64x4; ROWS],
    /// As [`Linearization::columns`].
    pub columns: [[F64x4; ROWS]; MAX_DOF],
}

impl Default for FourLinearizations {
    fn default() -> Self {
        Self { residual: [F64x4::ZERO; ROWS], columns: [[F64x4::ZERO; ROWS]; MAX_DOF] }
    }
}

/// Objectives that are linearized faster four at a time than one after another. They differ in what is asked of one and the same
/// system: for a robot, in the targets, which are of one kind.
pub trait SideBySide: LeastSquares + Sized {
    /// [`linearize`](LeastSquares::linearize) of each objective at its lane of `xs`, to the same bits.
    fn linearize_four(objectives: [&Self; 4], xs: &[F64x4], out: &mut FourLinearizations) -> [Score; 4];
}

impl Linearization {
    /// J'r into `gradient`, which has one entry per entry of x: the gradient of r'r / 2.
    pub fn gradient(&self, gradient: &mut [f64]) {
        for (slope, column) in gradient.iter_mut().zip(&self.columns) {
            *slope = column.iter().zip(&self.residual).map(|(c, r)| c * r).sum();
        }
    }
}

/// An objective that knows a smooth error E and its gradient without forming a Jacobian.
///
/// E need not be half of the score's value: it shares its zeros. That of a pose is eq. (11) of Yuan et al. 2016.
pub trait Gradient: Objective {
    /// E and the score at `x` in one pass; dE/dx into `gradient`, which has one entry per entry of x.
    fn differentiate(&mut self, x: &[f64], gradient: &mut [f64]) -> SmoothScore;
}

/// The smooth error and the score of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SmoothScore {
    /// The smooth error E.
    pub error: f64,
    /// The score, which may measure the error otherwise.
    pub score: Score,
}

/// All that an algorithm can ask of inverse kinematics.
pub trait Differentiable: LeastSquares + Gradient {}

impl<O: LeastSquares + Gradient + ?Sized> Differentiable for O {}

/// A box, entry by entry: lower <= upper; infinite bounds are allowed.
#[derive(Debug, Clone, PartialEq)]
pub struct Bounds {
    lower: Point,
    upper: Point,
}

/// How far samples reach on an open side.
const HALF_TURN: f64 = std::f64::consts::PI;

impl Bounds {
    /// # Errors
    /// [`Error::WrongLength`] for unequal lengths, [`Error::OutOfRange`] for NaN or lower > upper.
    pub fn new(lower: &[f64], upper: &[f64]) -> Result<Self> {
        if lower.len() != upper.len() {
            let expected = format!("{} entries as in lower", lower.len());
            return Err(Error::WrongLength { what: "upper".into(), expected, got: upper.len() });
        }
        match lower.iter().zip(upper).position(|(l, u)| l.is_nan() || u.is_nan() || l > u) {
            Some(i) => {
                Err(Error::out_of_range(format!("lower[{i}]"), &format!("at most upper[{i}] = {}", upper[i]), lower[i]))
            }
            None => Ok(Self { lower: lower.into(), upper: upper.into() }),
        }
    }

    /// The box of these (lower, upper), which are known to be in order.
    pub(crate) fn from_ranges(ranges: impl Iterator<Item = (f64, f64)>) -> Self {
        let mut bounds = Self { lower: Point::new(), upper: Point::new() };
        for (lower, upper) in ranges {
            bounds.lower.push(lower);
            bounds.upper.push(upper);
        }
        bounds
    }

    /// Lower bounds.
    pub fn lower(&self) -> &[f64] {
        &self.lower
    }

    /// Upper bounds.
    pub fn upper(&self) -> &[f64] {
        &self.upper
    }

    /// Writable lower and upper bounds. Whoever writes keeps lower <= upper.
    pub(crate) fn parts_mut(&mut self) -> (&mut [f64], &mut [f64]) {
        (&mut self.lower, &mut self.upper)
    }

    /// Clips `x` to the box: R(.) of BAS, eq. (10).
    #[inline]
    pub fn clip(&self, x: &mut [f64]) {
        for ((x, lower), upper) in x.iter_mut().zip(self.lower()).zip(self.upper()) {
            // A NaN becomes the lower bound.
            *x = smaller(larger(*x, *lower), *upper);
        }
    }

    /// Brings every entry of `x` into its range by the fewest whole periods: eq. (12) of Yuan et al. 2016, which turns
    /// once at most. An entry without a period is clipped; one that no number of periods brings inside stays outside.
    pub fn wrap(&self, x: &mut [f64], periods: &[Option<f64>]) {
        for (i, x) in x.iter_mut().enumerate() {
            let (lower, upper) = (self.lower[i], self.upper[i]);
            if lower <= *x && *x <= upper {
                continue;
            }
            let nearest = if *x > upper { upper } else { lower };
            *x = match periods[i] {
                None => nearest,
                Some(period) => {
                    let turns = ((nearest - *x) / period).abs().ceil();
                    let wrapped = if *x > upper { *x - turns * period } else { *x + turns * period };
                    if lower <= wrapped && wrapped <= upper { wrapped } else { *x }
                }
            }
        }
    }

    /// Whether `x` lies in the box, bounds included.
    pub fn contains(&self, x: &[f64]) -> bool {
        x.iter().zip(&self.lower).zip(&self.upper).all(|((x, lower), upper)| lower <= x && x <= upper)
    }

    /// The ranges to draw from; an open side reaches one turn from the other bound, or half a turn from zero.
    pub fn ranges(&self) -> impl Iterator<Item = (f64, f64)> {
        self.lower.iter().zip(&self.upper).map(|(lower, upper)| interval::finite(*lower, *upper, HALF_TURN))
    }

    /// A uniform draw from the [`ranges`](Self::ranges).
    pub fn sample(&self, rng: &mut LazyRng, x: &mut [f64]) {
        for (x, (from, to)) in x.iter_mut().zip(self.ranges()) {
            *x = rng.uniform_in(from, to);
        }
    }
}
