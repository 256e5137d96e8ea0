//! Box of a search.

use std::borrow::Cow;
use std::sync::Arc;

use crate::error::{Error, Result};
use crate::math::comparison::{larger, smaller};
use crate::math::sampling_range;
use crate::rng::LazyRng;

use super::point::Point;
use crate::math::{JointWeights, StepBox};

/// Box with lower <= upper in every entry; infinite bounds are allowed. Steps in it may have a weight for each joint.
#[derive(Debug, Clone, PartialEq)]
pub struct Bounds {
    lower: Point,
    upper: Point,
    weights: Option<Arc<JointWeights>>,
}

/// Sampling range on an unbounded side.
const HALF_TURN: f64 = std::f64::consts::PI;

impl<'a> From<&'a Bounds> for StepBox<'a> {
    #[inline]
    fn from(bounds: &'a Bounds) -> Self {
        Self { lower: &bounds.lower, upper: &bounds.upper, weights: bounds.weights.as_deref() }
    }
}

impl Bounds {
    /// Box between these bounds.
    ///
    /// # Errors
    /// [`Error::WrongLength`] for unequal lengths, [`Error::OutOfRange`] for NaN or lower > upper.
    pub fn new(lower: &[f64], upper: &[f64]) -> Result<Self> {
        if lower.len() != upper.len() {
            let expected = format!("{} entries as in lower", lower.len());
            return Err(Error::WrongLength { what: "upper".into(), expected, got: upper.len() });
        }
        match lower.iter().zip(upper).position(|(l, u)| l.is_nan() || u.is_nan() || l > u) {
            Some(i) => {
                Err(Error::out_of_range(format!("lower[{i}]"), format!("at most upper[{i}] = {}", upper[i]), lower[i]))
            }
            None => Ok(Self { lower: lower.into(), upper: upper.into(), weights: None }),
        }
    }

    /// Box of these (lower, upper) pairs, without checks.
    pub(crate) fn from_ranges(ranges: impl Iterator<Item = (f64, f64)>) -> Self {
        let mut bounds = Self { lower: Point::new(), upper: Point::new(), weights: None };
        for (lower, upper) in ranges {
            bounds.lower.push(lower);
            bounds.upper.push(upper);
        }
        bounds
    }

    /// The smallest box that holds this one and `q`.
    pub(crate) fn including(mut self, q: &[f64]) -> Self {
        self.lower.iter_mut().zip(q).for_each(|(lower, q)| *lower = lower.min(*q));
        self.upper.iter_mut().zip(q).for_each(|(upper, q)| *upper = upper.max(*q));
        self
    }

    /// Holds one entry at a value.
    pub(crate) fn hold(&mut self, entry: usize, value: f64) {
        self.lower[entry] = value;
        self.upper[entry] = value;
    }

    /// The box with these weights of the joints.
    pub(crate) fn weighted(self, weights: Option<Arc<JointWeights>>) -> Self {
        Self { weights, ..self }
    }

    /// The box without weights of the joints.
    pub(crate) fn without_weights(&self) -> Cow<'_, Self> {
        match self.weights {
            None => Cow::Borrowed(self),
            Some(_) => Cow::Owned(self.clone().weighted(None)),
        }
    }

    /// Weights of the joints; `None` where all cost the same.
    pub(crate) fn weights(&self) -> Option<&Arc<JointWeights>> {
        self.weights.as_ref()
    }

    /// Turns a gradient into the direction of steepest ascent by the weights of the joints.
    pub(crate) fn steepest(&self, gradient: &mut [f64]) {
        if let Some(weights) = &self.weights {
            weights.steepest(gradient);
        }
    }

    /// Lower bounds.
    pub fn lower(&self) -> &[f64] {
        &self.lower
    }

    /// Upper bounds.
    pub fn upper(&self) -> &[f64] {
        &self.upper
    }

    /// Lower and upper bounds.
    pub fn ends(&self) -> [&[f64]; 2] {
        [&self.lower, &self.upper]
    }

    /// Writable lower and upper bounds. Keep lower <= upper.
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

    /// Shifts every entry of `x` into its range by the fewest whole periods: eq. (12) of Yuan et al. 2016, which shifts
    /// by at most one turn. An entry without a period is clipped; an entry that no shift brings inside stays outside.
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

    /// Whether `x` is in the box, bounds included.
    pub fn contains(&self, x: &[f64]) -> bool {
        x.iter().zip(&self.lower).zip(&self.upper).all(|((x, lower), upper)| lower <= x && x <= upper)
    }

    /// Finite ranges for sampling; an unbounded side ends one turn from the other bound, or half a turn from zero.
    pub fn ranges(&self) -> impl Iterator<Item = (f64, f64)> {
        self.lower.iter().zip(&self.upper).map(|(lower, upper)| sampling_range::finite(*lower, *upper, HALF_TURN))
    }

    /// Draws `x` uniformly from the [`ranges`](Self::ranges).
    pub fn sample(&self, rng: &mut LazyRng, x: &mut [f64]) {
        for (x, (from, to)) in x.iter_mut().zip(self.ranges()) {
            *x = rng.uniform_in(from, to);
        }
    }
}
