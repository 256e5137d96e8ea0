//! Smoothing of sequences: postures between two others are replaced by postures near the straight line.

use super::passage::Passage;
use super::price::Price;
use crate::error::Result;
use crate::interrupt::checkpoint;
use crate::math::vector::point_between;
use crate::objective::Point;

/// Passes over the sequence, from long stretches to short ones.
const PASSES: usize = 8;

/// A stretch is replaced if that lowers its cost by more than this fraction.
const GAIN: f64 = 1e-5;

/// A sequence of postures at these path parameters.
pub(super) struct Smoothing<'s, 'a> {
    pub fractions: &'s [f64],
    pub price: &'s Price,
    pub passage: &'s mut Passage<'a>,
    /// Whether the first posture stays as it is.
    pub starts_as_given: bool,
}

impl Smoothing<'_, '_> {
    /// Lowers the cost of the sequence.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted).
    pub fn smooth(&mut self, postures: &mut [Point]) -> Result<()> {
        let last = postures.len() - 1;
        for _ in 0..PASSES {
            let mut width = last.next_power_of_two();
            while width >= 2 {
                checkpoint()?;
                for begin in (0..last).step_by(width / 2) {
                    self.replace(postures, begin, (begin + width).min(last));
                }
                self.replace_end(postures, last - width.min(last));
                if !self.starts_as_given {
                    self.replace_begin(postures, width.min(last));
                }
                width /= 2;
            }
        }
        Ok(())
    }

    /// Replaces the postures between two others by those nearest to the straight line between them.
    fn replace(&mut self, postures: &mut [Point], begin: usize, end: usize) {
        let (from, to) = (&postures[begin], &postures[end]);
        let length = self.fractions[end] - self.fractions[begin];
        let mut between = vec![from.clone()];
        for i in begin + 1..end {
            let part = (self.fractions[i] - self.fractions[begin]) / length;
            let guess: Point = point_between(from, to, part).collect();
            let Some(q) = self.passage.clear_on_path(self.fractions[i], &guess) else { return };
            between.push(q);
        }
        between.push(to.clone());
        self.take(postures, begin, between);
    }

    /// Replaces the end of the sequence by the shortest motion from the posture `begin`.
    fn replace_end(&mut self, postures: &mut [Point], begin: usize) {
        let mut tail = vec![postures[begin].clone()];
        for i in begin + 1..postures.len() {
            let Some(q) = self.passage.clear_on_path(self.fractions[i], &tail[i - begin - 1]) else { return };
            tail.push(q);
        }
        self.take(postures, begin, tail);
    }

    /// Replaces the beginning of the sequence by the shortest motion to the posture `end`.
    fn replace_begin(&mut self, postures: &mut [Point], end: usize) {
        let mut head = vec![postures[end].clone()];
        for i in (0..end).rev() {
            let Some(q) = self.passage.clear_on_path(self.fractions[i], &head[end - i - 1]) else { return };
            head.push(q);
        }
        head.reverse();
        self.take(postures, 0, head);
    }

    /// Takes `others` from the posture `begin` on if that lowers the cost and they lead along the path.
    fn take(&mut self, postures: &mut [Point], begin: usize, others: Vec<Point>) {
        let fractions = &self.fractions[begin..begin + others.len()];
        let replaced = &mut postures[begin..begin + others.len()];
        let (old, new) = (self.price.of_all(replaced, fractions), self.price.of_all(&others, fractions));
        let steps =
            || (1..others.len()).map(|i| ((fractions[i - 1], &others[i - 1][..]), (fractions[i], &others[i][..])));
        if new < (1.0 - GAIN) * old && steps().all(|(from, to)| self.passage.leads(from, to)) {
            replaced.clone_from_slice(&others);
        }
    }
}
