//! The fewest stretches of a path that the arm follows without leaving it.
//!
//! Each stretch goes as far as any sequence of postures leads; the next one begins beyond, with any posture. No division has fewer
//! stretches: whatever sequence covers the rest of the path covers what is left of it after a longer stretch too. Then neighbours are
//! extended towards each other.

use super::passage::Passage;
use super::path_end::why_it_ends;
use super::postures::{DENSITIES, LayerSampling, clear_layers, intervals, postures};
use super::price::Price;
use super::sequence::{LayerPosture, Swept, ends_by_cost, reached, swept_on_to, traced};
use crate::along_path::timed::PathProblem;
use crate::along_path::tip_path::TipPath;
use crate::error::Result;
use crate::objective::Point;
use crate::obstacle::ClearSpace;

/// Largest number of layers at the points of a path; a path with more has layers at equal distances.
const MOST_LAYERS: usize = 400;

/// Number of steps towards the next layer beyond the end of a stretch.
const PARTS: usize = 8;
/// Maximum number of halvings of a failed step.
const HALVINGS: usize = 12;

/// Postures along a part of a path.
#[derive(Debug, Clone)]
pub(crate) struct Stretch {
    /// Path parameters of the layers, from 0 to 1 on the stretch.
    pub fractions: Vec<f64>,
    /// Postures of each layer.
    pub postures: Vec<Vec<Point>>,
    /// The posture taken of each layer.
    pub sequence: Vec<Point>,
    /// Path parameters of its ends on the whole path.
    pub ends: [f64; 2],
}

impl Stretch {
    /// The stretch without its first layers, and without its last ones; `None` where too little remains.
    pub fn without(mut self, first: usize, last: usize) -> Option<Self> {
        let kept = first..self.fractions.len().checked_sub(last)?;
        if kept.len() < 2 {
            return None;
        }
        let [from, to] = self.ends;
        let whole = |fraction: f64| from + fraction * (to - from);
        let places: Vec<f64> = self.fractions[kept.clone()].iter().map(|fraction| whole(*fraction)).collect();
        self.sequence = self.sequence[kept.clone()].to_vec();
        self.postures = self.postures[kept].to_vec();
        Some(Self { fractions: relative(&places), ends: [places[0], places[places.len() - 1]], ..self })
    }
}

/// Stretches of a path, and why the arm has to leave it between them.
#[derive(Debug, Clone)]
pub(crate) struct Stretches {
    /// The stretches, in order.
    pub stretches: Vec<Stretch>,
    /// The reason before each stretch; the last one is behind the last stretch. `None` at an end of the path.
    pub reasons: Vec<Option<String>>,
}

/// Returns the stretches of a path.
///
/// # Errors
/// [`Error::Interrupted`](crate::Error::Interrupted).
pub(crate) fn stretches(problem: &PathProblem<'_>, space: Option<&ClearSpace<'_>>) -> Result<Stretches> {
    let fractions = layers_of(problem.tip_path);
    let mut best: Option<(usize, Divider)> = None;
    for density in DENSITIES {
        let mut divider = Divider::new(problem, space, &fractions, density)?;
        divider.divide()?;
        let missed = divider.missed();
        let [stretches, fewest] = [Some(divider.parts.len()), best.as_ref().map(|(_, best)| best.parts.len())];
        if best.as_ref().is_none_or(|(least, _)| (missed, stretches) < (*least, fewest)) {
            best = Some((missed, divider));
        }
        if best.as_ref().is_some_and(|(_, divider)| divider.parts.len() <= divider.fewest()) {
            break;
        }
    }
    Ok(best.map_or_else(|| Stretches { stretches: vec![], reasons: vec![None] }, |(_, divider)| divider.finished()))
}

/// The path parameters of the layers.
fn layers_of(tip_path: &TipPath) -> Vec<f64> {
    let [count, points] = [intervals(tip_path), tip_path.numbered_points().len()];
    if (count..=MOST_LAYERS).contains(&points) { tip_path.numbered_points().to_vec() } else { tip_path.knots(count) }
}

/// A part of the path: its first and last layer, and a posture in each.
struct Part {
    first: usize,
    sequence: Vec<Point>,
    /// Reason why the arm does not go on from its end.
    reason: Option<String>,
}

impl Part {
    fn last(&self) -> usize {
        self.first + self.sequence.len() - 1
    }
}

/// The division of a path.
struct Divider<'a> {
    fractions: &'a [f64],
    price: Price,
    passage: Passage<'a>,
    space: Option<&'a ClearSpace<'a>>,
    postures: Vec<Vec<Point>>,
    layers: Vec<Vec<LayerPosture>>,
    parts: Vec<Part>,
}

impl<'a> Divider<'a> {
    fn new(
        problem: &'a PathProblem<'a>,
        space: Option<&'a ClearSpace<'a>>,
        fractions: &'a [f64],
        density: usize,
    ) -> Result<Self> {
        let (price, mut passage) = (Price::new(problem), Passage::new(problem, space));
        let postures = postures(&mut passage, &price, &LayerSampling { fractions, density })?;
        let layers = clear_layers(&passage, fractions, &postures)?;
        Ok(Self { fractions, price, passage, space, postures, layers, parts: vec![] })
    }

    /// Finds the parts, each as long as possible.
    fn divide(&mut self) -> Result<()> {
        let last = self.layers.len() - 1;
        let mut from = 0;
        while from <= last {
            let mut sequence = self.longest(from)?;
            // A layer that no sequence leaves may be the end of one from the layer before.
            if sequence.len() == 1 && self.parts.last().is_some_and(|before| before.last() + 1 == from) {
                from -= 1;
                sequence = self.longest(from)?;
            }
            if sequence.len() < 2 {
                from += if self.parts.last().is_some_and(|before| before.last() == from) { 2 } else { 1 };
                continue;
            }
            let end = from + sequence.len() - 1;
            let swept = if from == 0 && self.passage.problem.options.start.is_some() { None } else { swept(&sequence) };
            let reason = (end < last).then(|| self.reason(end, &sequence[end - from], end + 1, swept));
            self.parts.push(Part { first: from, sequence, reason });
            from = end + 1;
        }
        for next in 1..self.parts.len() {
            self.move_apart(next);
        }
        Ok(())
    }

    /// The cheapest of the longest sequences from a layer on.
    fn longest(&mut self, from: usize) -> Result<Vec<Point>> {
        // The start that is given has the whole turns that it has.
        let is_open = from > 0 || self.passage.problem.options.start.is_none();
        if is_open {
            self.passage.open_turns();
        }
        // Of postures that lead as far, those near the end of the part before.
        if let Some(end) = self.parts.last().and_then(|before| before.sequence.last()) {
            let price = &self.price;
            self.layers[from].iter_mut().for_each(|start| start.penalty = price.of_way(end, &start.q));
        }
        let reached = reached(&self.layers[from..], &self.fractions[from..], &self.price, &mut self.passage);
        self.passage.close_turns();
        let reached = reached?;
        let mut sequence = ends_by_cost(&reached).next().map_or_else(Vec::new, |end| traced(&reached, end));
        if is_open {
            self.passage.shift_inside(&mut sequence);
        }
        Ok(sequence)
    }

    /// Explains why the arm does not get from a posture of one layer to another layer.
    fn reason(&mut self, layer: usize, q: &Point, to: usize, swept: Option<Swept>) -> String {
        let from = (self.fractions[layer], &q[..]);
        let why = why_it_ends(&mut self.passage, self.space, from, self.fractions[to], swept);
        let place = self.passage.problem.tip_path.point_in_words(self.fractions[to]);
        format!("towards {place}, {why}")
    }

    /// Moves a break away from the place where the part before it ends: to the middle of what both parts can follow. The arm is at a
    /// limit, near a singularity or close to a body at the ends.
    fn move_apart(&mut self, next: usize) {
        let [before, after] = [&self.parts[next - 1], &self.parts[next]];
        let (end, mut here, mut back) = (before.last(), after.sequence[0].clone(), vec![]);
        if after.first > end + 1 {
            return;
        }
        for layer in (before.first + 1..after.first).rev() {
            let [from, to] = [layer + 1, layer].map(|layer| self.fractions[layer]);
            let Some(q) = self.passage.clear_on_path(to, &here) else { break };
            if self.price.of_step(&here, &q, from - to).is_infinite() || !self.passage.leads((from, &here), (to, &q)) {
                break;
            }
            back.push(q.clone());
            here = q;
        }
        let Some(common) = (back.len() + end + 1).checked_sub(self.parts[next].first) else { return };
        if common == 0 {
            return;
        }
        let begin = end - (common - 1) / 2;
        let before = &mut self.parts[next - 1];
        before.sequence.truncate(begin - before.first + 1);
        let after = &mut self.parts[next];
        if begin <= after.first {
            back.truncate(after.first - begin);
            back.reverse();
            after.first = begin;
            after.sequence.splice(0..0, back);
        }
    }

    /// Number of steps between layers that no part makes.
    fn missed(&self) -> usize {
        self.fractions.len() - 1 - self.parts.iter().map(|part| part.sequence.len() - 1).sum::<usize>()
    }

    /// The fewest parts that any division has: layers without a posture are between some of them.
    fn fewest(&self) -> usize {
        let runs = self.layers.split(|layer| layer.is_empty());
        runs.filter(|run| run.len() > 1).count()
    }

    /// The stretches, extended beyond their last layers as far as the arm goes on.
    fn finished(mut self) -> Stretches {
        let (last, mut reached) = (self.fractions.len() - 1, 0.0);
        let (mut stretches, mut reasons) = (vec![], vec![]);
        let parts = std::mem::take(&mut self.parts);
        let first = parts.first().filter(|part| part.first > 0);
        reasons
            .push(first.map(|part| self.reason(part.first, &part.sequence[0], part.first - 1, swept(&part.sequence))));
        for (i, part) in parts.iter().enumerate() {
            let next = parts.get(i + 1).map_or(last, |next| next.first);
            let before = if part.first > 0 { reached } else { 0.0 };
            let mut stretch = self.stretch(part);
            if before < stretch[0].0 {
                let beyond = self.beyond((stretch[0].0, &part.sequence[0]), self.fractions[part.first - 1].max(before));
                stretch.splice(0..0, beyond.into_iter().rev());
            }
            if part.last() < next {
                let end = (self.fractions[part.last()], &part.sequence[part.sequence.len() - 1]);
                stretch.extend(self.beyond(end, self.fractions[part.last() + 1]));
            }
            reached = stretch[stretch.len() - 1].0;
            stretches.push(self.with_candidates(stretch));
            reasons.push(part.reason.clone());
        }
        Stretches { stretches, reasons }
    }

    fn stretch(&self, part: &Part) -> Vec<(f64, Point)> {
        part.sequence.iter().enumerate().map(|(i, q)| (self.fractions[part.first + i], q.clone())).collect()
    }

    /// Postures beyond the last layer of a part, as near to the path parameter `to` as the arm goes.
    fn beyond(&mut self, (from, q): (f64, &Point), to: f64) -> Vec<(f64, Point)> {
        let coarse = (to - from) / PARTS as f64;
        let mut beyond = vec![(from, q.clone())];
        let (mut here, mut step, mut halvings) = (beyond[0].clone(), coarse, 0);
        while here.0 != to && halvings <= HALVINGS {
            let fraction = if (to - here.0).abs() <= step.abs() { to } else { here.0 + step };
            let next = self.passage.clear_on_path(fraction, &here.1);
            match next.filter(|q| self.passage.leads((here.0, &here.1), (fraction, q))) {
                Some(q) => here = (fraction, q),
                None => {
                    step *= 0.5;
                    halvings += 1;
                }
            }
            // Knots that are much nearer to each other than the others make a spline swing.
            if halvings == 0 && here.0 != beyond[beyond.len() - 1].0 {
                beyond.push(here.clone());
            }
        }
        if here.0 != beyond[beyond.len() - 1].0 {
            if beyond.len() > 1 && (here.0 - beyond[beyond.len() - 1].0).abs() < 0.5 * coarse.abs() {
                beyond.pop();
            }
            beyond.push(here);
        }
        beyond.remove(0);
        beyond
    }

    /// The stretch through these postures, with the candidates of its layers: no more of them than a path has by default, but its corners.
    fn with_candidates(&self, stretch: Vec<(f64, Point)>) -> Stretch {
        let tip_path = self.passage.problem.tip_path;
        let spacing = 0.999 / intervals(tip_path) as f64;
        let (corners, last): (Vec<f64>, usize) = (tip_path.corners().collect(), stretch.len() - 1);
        let mut kept: Vec<(f64, Point)> = vec![];
        for (i, (place, q)) in stretch.into_iter().enumerate() {
            let is_due = kept.last().is_none_or(|(before, _)| place - before >= spacing);
            if is_due || i == last || corners.contains(&place) {
                kept.push((place, q));
            }
        }
        let stretch = kept;
        let (places, sequence): (Vec<f64>, Vec<Point>) = stretch.into_iter().unzip();
        let candidates = |(place, q): (&f64, &Point)| {
            let layer = self.fractions.iter().position(|fraction| fraction == place);
            let mut all = layer.map_or_else(Vec::new, |layer| self.postures[layer].clone());
            all.push(q.clone());
            all
        };
        Stretch {
            fractions: relative(&places),
            postures: places.iter().zip(&sequence).map(candidates).collect(),
            ends: [places[0], places[places.len() - 1]],
            sequence,
        }
    }
}

/// Range that each joint covers along a sequence.
fn swept(sequence: &[Point]) -> Option<Swept> {
    let first = sequence.first()?;
    Some(sequence.iter().fold([first.clone(), first.clone()], |swept, q| swept_on_to(&swept, q)))
}

/// Path parameters on the part of the path that they cover.
fn relative(places: &[f64]) -> Vec<f64> {
    let (first, last) = (places[0], places[places.len() - 1]);
    places.iter().map(|place| (place - first) / (last - first)).collect()
}
