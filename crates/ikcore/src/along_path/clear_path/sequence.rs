//! The cheapest sequence of postures, one in each layer.

use super::passage::Passage;
use super::price::Price;
use crate::error::Result;
use crate::interrupt::checkpoint;
use crate::objective::Point;

/// Number of steps to a posture that are checked, cheapest first, before it counts as out of reach.
const CHECKED: usize = 12;

/// Fewest candidates reached in a layer; below, sequences that reach none of them are continued too.
const FEW: usize = 16;

/// A candidate posture.
#[derive(Debug, Clone)]
pub(super) struct LayerPosture {
    pub q: Point,
    /// Cost beside the steps.
    pub penalty: f64,
}

/// A posture that a sequence has reached.
pub(super) struct Reached {
    pub q: Point,
    cost: f64,
    /// Index of its predecessor in the layer before.
    before: usize,
    /// Smallest and largest value of each joint on the sequence.
    swept: Swept,
}

/// Smallest and largest value of each joint on a motion.
pub(super) type Swept = [Point; 2];

impl Reached {
    /// The first posture of a sequence.
    fn first(candidate: &LayerPosture) -> Self {
        let LayerPosture { q, penalty } = candidate;
        Self { q: q.clone(), cost: *penalty, before: 0, swept: [q.clone(), q.clone()] }
    }

    /// The values that each joint takes on the sequence to here, and on to `q`.
    fn swept_on_to(&self, q: &[f64]) -> Swept {
        swept_on_to(&self.swept, q)
    }
}

/// Returns the ranges of the joints, widened to include `q`.
pub(super) fn swept_on_to([low, high]: &Swept, q: &[f64]) -> Swept {
    [low.iter().zip(q).map(|(a, b)| a.min(*b)).collect(), high.iter().zip(q).map(|(a, b)| a.max(*b)).collect()]
}

/// The layer that no sequence reaches.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Unreached {
    pub layer: usize,
    /// The posture of the layer before that the cheapest sequence ends at, and what its joints sweep.
    pub last: Option<(Point, Swept)>,
}

/// A sequence, or the layer at which it breaks off.
pub(super) type FoundSequence = std::result::Result<Vec<Point>, Box<Unreached>>;

/// Returns the cheapest sequence through `layers` at `fractions` of the path, each step of which leads along the path.
/// Where the start is free, the joints begin at whatever whole turns keep them inside their limits.
///
/// # Errors
/// [`Error::Interrupted`](crate::Error::Interrupted).
pub(super) fn cheapest(
    layers: &[Vec<LayerPosture>],
    fractions: &[f64],
    price: &Price,
    passage: &mut Passage<'_>,
) -> Result<FoundSequence> {
    if passage.problem.options.start.is_none() {
        passage.open_turns();
        let reached = reached(layers, fractions, price, passage);
        passage.close_turns();
        let reached = reached?;
        if let Some(unreached) = unreached(layers, &reached) {
            return Ok(Err(Box::new(unreached)));
        }
        let mut ends = ends_by_cost(&reached).map(|end| traced(&reached, end));
        if let Some(sequence) = ends.find_map(|mut sequence| passage.shift_inside(&mut sequence).then_some(sequence)) {
            return Ok(Ok(sequence));
        }
    }
    let reached = reached(layers, fractions, price, passage)?;
    if let Some(unreached) = unreached(layers, &reached) {
        return Ok(Err(Box::new(unreached)));
    }
    Ok(Ok(ends_by_cost(&reached).next().map_or_else(Vec::new, |end| traced(&reached, end))))
}

/// The first layer that no sequence reaches, if there is one.
fn unreached(layers: &[Vec<LayerPosture>], reached: &[Vec<Reached>]) -> Option<Unreached> {
    let layer = reached.len();
    (layer < layers.len()).then(|| {
        let last = ends_by_cost(reached).next().map(|end| {
            let Reached { q, swept, .. } = &reached[layer - 1][end];
            (q.clone(), swept.clone())
        });
        Unreached { layer, last }
    })
}

/// Returns the postures that sequences reach, layer by layer, up to the last layer that one reaches.
pub(super) fn reached(
    layers: &[Vec<LayerPosture>],
    fractions: &[f64],
    price: &Price,
    passage: &mut Passage<'_>,
) -> Result<Vec<Vec<Reached>>> {
    let mut reached: Vec<Vec<Reached>> = vec![layers[0].iter().map(Reached::first).collect()];
    if layers[0].is_empty() {
        return Ok(vec![]);
    }
    for i in 1..layers.len() {
        checkpoint()?;
        let before = &reached[i - 1];
        let mut step =
            Step { fractions: [fractions[i - 1], fractions[i]], price, passage: &mut *passage, costs: vec![] };
        let mut next: Vec<Reached> = layers[i].iter().filter_map(|candidate| step.to(candidate, before)).collect();
        if next.len() < FEW {
            step.beside_candidates(before, &mut next);
        }
        if next.is_empty() {
            break;
        }
        reached.push(next);
    }
    Ok(reached)
}

/// Steps from one layer to the next.
struct Step<'s, 'a> {
    fractions: [f64; 2],
    price: &'s Price,
    passage: &'s mut Passage<'a>,
    costs: Vec<f64>,
}

impl Step<'_, '_> {
    /// Returns the cheapest predecessor of a candidate.
    fn to(&mut self, candidate: &LayerPosture, before: &[Reached]) -> Option<Reached> {
        let [from, to] = self.fractions;
        let cost = |reached: &Reached| reached.cost + self.price.of_turned_step(&reached.q, &candidate.q, to - from);
        self.costs.clear();
        self.costs.extend(before.iter().map(cost));
        for _ in 0..CHECKED {
            let nearest = (0..before.len()).min_by(|a, b| self.costs[*a].total_cmp(&self.costs[*b]))?;
            if self.costs[nearest].is_infinite() {
                return None;
            }
            let begin = &before[nearest].q;
            let end = self.price.turned_near(begin, &candidate.q);
            let swept = before[nearest].swept_on_to(&end);
            let fits = self.passage.is_within_limits(&end) && self.passage.fits(&swept);
            if fits && self.passage.leads((from, begin), (to, &end)) {
                return Some(Reached { q: end, cost: self.costs[nearest] + candidate.penalty, before: nearest, swept });
            }
            self.costs[nearest] = f64::INFINITY;
        }
        None
    }
}

impl Step<'_, '_> {
    /// Adds to `next` the continuations of sequences that lead to none of the candidates. Candidates are samples:
    /// between them others lie, and at a singularity a whole family.
    fn beside_candidates(&mut self, before: &[Reached], next: &mut Vec<Reached>) {
        let mut goes_on = vec![false; before.len()];
        next.iter().for_each(|reached| goes_on[reached.before] = true);
        for (number, reached) in before.iter().enumerate().filter(|(number, _)| !goes_on[*number]) {
            let [from, to] = self.fractions;
            let on_path = self.passage.clear_on_path(to, &reached.q);
            let near_path = self.passage.clear_near_path(to, &reached.q);
            for q in [on_path, near_path].into_iter().flatten() {
                let cost = reached.cost + self.price.of_step(&reached.q, &q, to - from);
                let swept = reached.swept_on_to(&q);
                let goes_on = cost.is_finite() && self.passage.fits(&swept);
                if goes_on && self.passage.leads((from, &reached.q), (to, &q)) {
                    next.push(Reached { q, cost, before: number, swept });
                    break;
                }
            }
        }
    }
}

/// Returns the indices of the postures of the last layer, cheapest first.
pub(super) fn ends_by_cost(reached: &[Vec<Reached>]) -> impl Iterator<Item = usize> {
    let last = reached.last().map_or(&[][..], |last| last);
    let mut ends: Vec<usize> = (0..last.len()).collect();
    ends.sort_by(|a, b| last[*a].cost.total_cmp(&last[*b].cost));
    ends.into_iter()
}

/// Traces the sequence that leads to a posture of the last layer.
pub(super) fn traced(reached: &[Vec<Reached>], mut at: usize) -> Vec<Point> {
    let mut postures: Vec<Point> = reached
        .iter()
        .rev()
        .map(|layer| {
            let Reached { q, before, .. } = &layer[at];
            at = *before;
            q.clone()
        })
        .collect();
    postures.reverse();
    postures
}
