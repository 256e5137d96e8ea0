//! Beetle antennae search as Cheng et al. (2020) plan motions with it: Algorithm 1 and equations (8) to (13).
//!
//! A step of this solver is one pass: lines 5 to 15 of Algorithm 1, n explorations with one antenna length. What the
//! algorithm does with the pass (line 16) is the caller's: the driver stops in the error band or below a given value.
//!
//! Readings of what the paper leaves open: o in eq. (12) is the squared norm of the error, so that the antennae shrink
//! in proportion to the error; it is taken at the best point so far against the target being sought.

use std::fmt;
use std::str::FromStr;

use smallvec::SmallVec;

use super::driver::Solver;
use super::evaluator::{Evaluator, Halt};
use crate::error::{Error, Result, require_positive};
use crate::objective::{Objective, Point};

/// From where the next exploration of a pass starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variant {
    /// Always from the best point before the pass: eq. (8), (9) and (11) to the letter.
    Star,
    /// From where the beetle went, better or not: the original beetle antennae search.
    Chain,
    /// From where the beetle went if that is better; antennae follow the error at once, and a pass ends when solved.
    Greedy,
}

impl fmt::Display for Variant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Star => "star",
            Self::Chain => "chain",
            Self::Greedy => "greedy",
        })
    }
}

impl FromStr for Variant {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self> {
        match name {
            "star" => Ok(Self::Star),
            "chain" => Ok(Self::Chain),
            "greedy" => Ok(Self::Greedy),
            _ => Err(Error::unknown_option("variant", name, &["star", "chain", "greedy"])),
        }
    }
}

/// Beetle antennae search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bas {
    /// From where explorations start.
    pub variant: Variant,
    /// Antenna length over error, eq. (12): rad per unit of the error's norm.
    pub c1: f64,
    /// Step length over antenna length, eq. (13).
    pub c2: f64,
    /// Explorations per pass, the paper's n.
    pub explorations: usize,
    /// Passes after which it gives up; the paper would go on for ever.
    pub max_passes: usize,
}

impl Default for Bas {
    fn default() -> Self {
        Self::of(Variant::Star)
    }
}

impl Bas {
    /// A variant with the options that suit it: those that tracked best on a 7-joint arm of about a metre.
    pub fn of(variant: Variant) -> Self {
        let (c1, explorations) = match variant {
            Variant::Star => (3.0, 50),
            Variant::Chain => (1.0, 30),
            Variant::Greedy => (3.0, 5),
        };
        Self { variant, c1, c2: 1.0, explorations, max_passes: 200 }
    }

    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the option and its range.
    pub fn validate(&self) -> Result<()> {
        require_positive("c1", self.c1)?;
        require_positive("c2", self.c2)?;
        for (name, count) in [("explorations", self.explorations), ("max_passes", self.max_passes)] {
            if count == 0 {
                return Err(Error::out_of_range(name, "at least 1", 0.0));
            }
        }
        Ok(())
    }
}

/// The beetle between passes.
#[derive(Debug, Clone)]
pub struct State {
    /// Best point that the beetle stood on.
    base: Point,
    base_value: f64,
    passes: usize,
    group: Group,
}

/// Explorations of a star do not depend on each other, so that four at a time go to the objective.
const LARGEST_GROUP: usize = 4;

/// Room for a group of explorations, one after another.
#[derive(Debug, Clone)]
struct Group {
    directions: SmallVec<[f64; LARGEST_GROUP * 8]>,
    antennae: SmallVec<[f64; 2 * LARGEST_GROUP * 8]>,
    beetles: SmallVec<[f64; LARGEST_GROUP * 8]>,
}

impl<O: Objective + ?Sized> Solver<O> for Bas {
    type State = State;

    fn start(&self, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<State, Halt> {
        let mut base = Point::from_slice(x0);
        let base_value = evaluator.evaluate(&mut base)?;
        let entries = self.group() * base.len();
        let group = Group {
            directions: SmallVec::from_elem(0.0, entries),
            antennae: SmallVec::from_elem(0.0, 2 * entries),
            beetles: SmallVec::from_elem(0.0, entries),
        };
        Ok(State { base, base_value, passes: 0, group })
    }

    fn step(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Halt> {
        if state.passes == self.max_passes {
            return Err(Halt::Stalled);
        }
        state.passes += 1;
        let n = state.base.len();
        let (mut current, mut current_value) = (state.base.clone(), state.base_value);
        let (mut pass_best, mut pass_value) = (current.clone(), f64::INFINITY);
        let mut lambda = self.antenna_length(state.base_value);
        let mut explored = 0;
        while explored < self.explorations {
            let count = self.group().min(self.explorations - explored);
            explored += count;
            // i) random directions, ii) to iv) smell at the antennae, eq. (8) to (10)
            let Group { directions, antennae, beetles } = &mut state.group;
            for e in 0..count {
                let b = &mut directions[e * n..(e + 1) * n];
                evaluator.rng().direction(b);
                for k in 0..n {
                    antennae[2 * e * n + k] = current[k] + lambda * b[k];
                    antennae[(2 * e + 1) * n + k] = current[k] - lambda * b[k];
                }
            }
            let mut smells = [0.0; 2 * LARGEST_GROUP];
            evaluator.evaluate_all(&mut antennae[..2 * count * n], &mut smells[..2 * count])?;
            // v) move towards the lower value, eq. (11) and (13); equal smells leave the beetle where it is
            for e in 0..count {
                let delta = self.c2 * lambda * sign(smells[2 * e] - smells[2 * e + 1]);
                for k in 0..n {
                    beetles[e * n + k] = current[k] - delta * directions[e * n + k];
                }
            }
            let mut values = [0.0; LARGEST_GROUP];
            evaluator.evaluate_all(&mut beetles[..count * n], &mut values[..count])?;
            for (beetle, value) in beetles.chunks_exact(n).zip(values).take(count) {
                // vi) record
                if value < pass_value {
                    pass_best.copy_from_slice(beetle);
                    pass_value = value;
                }
                // vii) update the location
                match self.variant {
                    Variant::Star => {}
                    Variant::Chain => current.copy_from_slice(beetle),
                    Variant::Greedy if value < current_value => {
                        current.copy_from_slice(beetle);
                        current_value = value;
                        lambda = self.antenna_length(value);
                    }
                    Variant::Greedy => {}
                }
            }
            if self.variant == Variant::Greedy {
                evaluator.check_solved()?;
            }
        }
        // Line 15; a pass that found nothing better starts again from the same place.
        if pass_value < state.base_value {
            (state.base, state.base_value) = (pass_best, pass_value);
        }
        Ok(())
    }
}

impl Bas {
    /// Explorations that start from the same point.
    fn group(&self) -> usize {
        if self.variant == Variant::Star { LARGEST_GROUP } else { 1 }
    }

    /// lambda = c1 sqrt(o), eq. (12); where the start has no finite value, a unit antenna.
    fn antenna_length(&self, value: f64) -> f64 {
        self.c1 * if value.is_finite() { value.sqrt() } else { 1.0 }
    }
}

/// The plain sign of eq. (11): zero at zero, and for antennae that both smell nothing finite.
fn sign(z: f64) -> f64 {
    if z > 0.0 {
        1.0
    } else if z < 0.0 {
        -1.0
    } else {
        0.0
    }
}
