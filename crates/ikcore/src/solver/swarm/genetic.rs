//! Genetic algorithm on real numbers, with the operators and options of the MATLAB `ga`, the usual reference of papers on
//! manipulators: elite, tournament selection, scattered crossover, Gaussian mutation (Goldberg 1989 for the scheme).
//!
//! A generation is the elite, then children by crossover, then children by mutation. The standard deviation of mutations
//! shrinks by a constant factor: MATLAB's linear shrinking needs the number of generations in advance, which a budget of
//! evaluations or a tolerance does not give.

use super::population::{Generation, Members, Population};
use super::schedule::Schedule;
use crate::error::{Error, Result, require_factor, require_fraction, require_positive, require_proper_fraction};
use crate::objective::Objective;
use crate::rng::LazyRng;
use crate::solver::Status;
use crate::solver::driver::Solver;
use crate::solver::evaluator::Evaluator;

/// Options of the genetic algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Genetic {
    /// Number of members and generations.
    pub schedule: Schedule,
    /// Fraction of the members that survive unchanged, rounded up: MATLAB's EliteCount, 5 %.
    pub elite_share: f64,
    /// Fraction of the other members that come from crossover: MATLAB's CrossoverFraction.
    pub crossover_share: f64,
    /// Number of members in a tournament, whose best becomes a parent: MATLAB's selectiontournament.
    pub tournament: usize,
    /// Probability that a coordinate of a mutant changes; at least one changes. MATLAB's Gaussian mutation changes all (1); one
    /// over the dimension searches coordinate by coordinate.
    pub mutation_rate: f64,
    /// Initial standard deviation of mutations, relative to the width of the box.
    pub mutation_scale: f64,
    /// Factor on the standard deviation per generation.
    pub mutation_decay: f64,
}

impl Default for Genetic {
    /// Default of MATLAB's elite, crossover fraction and population, with tournaments of two, which keep more variety than
    /// MATLAB's four.
    fn default() -> Self {
        Self {
            schedule: Schedule::of(50),
            elite_share: 0.05,
            crossover_share: 0.8,
            tournament: 2,
            mutation_rate: 1.0,
            mutation_scale: 0.1,
            mutation_decay: 0.97,
        }
    }
}

impl Genetic {
    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the option and its range.
    pub fn validate(&self) -> Result<()> {
        self.schedule.validate(2)?;
        require_proper_fraction("elite_share", self.elite_share)?;
        require_fraction("crossover_share", self.crossover_share)?;
        if !(1..=self.schedule.population).contains(&self.tournament) {
            let requirement = format!("between 1 and the population of {}", self.schedule.population);
            return Err(Error::out_of_range("tournament", &requirement, self.tournament as f64));
        }
        require_factor("mutation_rate", self.mutation_rate)?;
        require_positive("mutation_scale", self.mutation_scale)?;
        require_factor("mutation_decay", self.mutation_decay)
    }

    /// Number of survivors; at least one member is always a child.
    fn elite(&self) -> usize {
        let population = self.schedule.population;
        ((self.elite_share * population as f64).ceil() as usize).min(population - 1)
    }
}

/// State of the population between generations.
#[derive(Debug, Clone, Default)]
pub struct State {
    population: Population,
    children: Members,
    /// Indices of members; the elite comes first.
    ranking: Vec<usize>,
    /// Standard deviation of mutations, relative to the width.
    scale: f64,
}

impl<O: Objective + ?Sized> Solver<O> for Genetic {
    type State = State;

    fn start(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>, x0: &[f64]) -> Result<(), Status> {
        let members = self.schedule.population;
        *state = State {
            population: Population::start(&self.schedule, evaluator, x0)?,
            children: Members::new(members, x0.len()),
            ranking: (0..members).collect(),
            scale: self.mutation_scale,
        };
        Ok(())
    }

    fn step(&self, state: &mut State, evaluator: &mut Evaluator<'_, O>) -> Result<(), Status> {
        let State { population, children, ranking, scale } = state;
        if population.begin_generation(&self.schedule, evaluator)? == Generation::First {
            return Ok(());
        }
        let parents = &population.members;
        let elite = self.elite();
        keep_elite(parents, elite, ranking, children);
        let crossed = (self.crossover_share * (children.values.len() - elite) as f64).round() as usize;
        for child in elite..children.values.len() {
            let child_point = children.point_mut(child);
            if child < elite + crossed {
                self.cross(parents, evaluator.rng(), child_point);
            } else {
                child_point.copy_from_slice(self.parent(parents, evaluator.rng()));
                if self.mutation_rate < 1.0 {
                    mutate_some(child_point, &population.widths, *scale, self.mutation_rate, evaluator.rng());
                } else {
                    mutate(child_point, &population.widths, *scale, evaluator.rng());
                }
            }
        }
        children.evaluate_from(elite, evaluator)?;
        std::mem::swap(&mut population.members, children);
        *scale *= self.mutation_decay;
        Ok(())
    }
}

/// Copies the best members to the front of the next generation, with their values.
fn keep_elite(parents: &Members, elite: usize, ranking: &mut [usize], children: &mut Members) {
    if elite == 0 {
        return;
    }
    let order = |i: &usize, j: &usize| parents.values[*i].total_cmp(&parents.values[*j]).then(i.cmp(j));
    ranking.select_nth_unstable_by(elite - 1, order);
    for (place, member) in ranking[..elite].iter().enumerate() {
        children.take(place, parents, *member);
    }
}

impl Genetic {
    /// Draws the best of a tournament, two members at a time.
    fn parent<'a>(&self, parents: &'a Members, rng: &mut LazyRng) -> &'a [f64] {
        let count = parents.values.len();
        let better = |i: usize, j: usize| if parents.values[j] < parents.values[i] { j } else { i };
        let mut winner = if self.tournament % 2 == 1 { rng.below(count) } else { better_of_two(parents, rng) };
        for _ in 0..(self.tournament - 1) / 2 {
            winner = better(winner, better_of_two(parents, rng));
        }
        parents.point(winner)
    }

    /// Writes a child by scattered crossover: each coordinate from either parent.
    fn cross(&self, parents: &Members, rng: &mut LazyRng, child: &mut [f64]) {
        let (mother, father) = (self.parent(parents, rng), self.parent(parents, rng));
        let mut coins = Coins::default();
        for (x, (mother, father)) in child.iter_mut().zip(mother.iter().zip(father)) {
            *x = [*father, *mother][usize::from(coins.toss(rng))];
        }
    }
}

/// Draws the better of two members.
fn better_of_two(parents: &Members, rng: &mut LazyRng) -> usize {
    let [one, other] = rng.pair_below(parents.values.len());
    [one, other][usize::from(parents.values[other] < parents.values[one])]
}

/// Applies Gaussian mutation to all coordinates.
fn mutate(x: &mut [f64], widths: &[f64], scale: f64, rng: &mut LazyRng) {
    for (pair, widths) in x.chunks_mut(2).zip(widths.chunks(2)) {
        let normals = rng.normal_pair();
        for ((x, width), z) in pair.iter_mut().zip(widths).zip(normals) {
            *x += scale * width * z;
        }
    }
}

/// Applies Gaussian mutation to each coordinate with probability `rate`, and to at least one.
fn mutate_some(x: &mut [f64], widths: &[f64], scale: f64, rate: f64, rng: &mut LazyRng) {
    let forced = rng.below(x.len());
    for (k, (x, width)) in x.iter_mut().zip(widths).enumerate() {
        if rng.uniform() < rate || k == forced {
            *x += scale * width * rng.normal_pair()[0];
        }
    }
}

/// Source of coin tosses, 32 per draw.
#[derive(Default)]
struct Coins {
    bits: u32,
    left: u32,
}

impl Coins {
    fn toss(&mut self, rng: &mut LazyRng) -> bool {
        if self.left == 0 {
            *self = Self { bits: (rng.uniform() * (1_u64 << 32) as f64) as u32, left: 32 };
        }
        let heads = self.bits & 1 == 1;
        self.bits >>= 1;
        self.left -= 1;
        heads
    }
}
