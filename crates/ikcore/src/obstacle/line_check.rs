//! "Is a straight line in joint space clear?" at closely spaced configurations, eight of them in the registers: for searches, whose
//! results are certified afterwards.
//!
//! The first eight span the whole line. They list the pairs of bodies that may meet anywhere on it; the others test only these.

use super::body_model::BodyPair;
use super::eight_scene::EightScene;
use super::scene::Scene;
use crate::math::arithmetic::{Arithmetic, by_instructions};
use crate::math::f32x8::F32x8;
use crate::objective::Point;

/// No body moves farther from one configuration to the next (m), by a bound that is two to three times what it moves.
const SPACING: f64 = 0.05;

/// Checks lines in a scene; owns its scratch.
#[derive(Debug)]
pub struct LineCheck<'a> {
    eight: EightScene<'a>,
    margin: f64,
    /// Pairs that may meet on the line.
    pending: Vec<BodyPair>,
    /// The pair that met last.
    likely: Option<BodyPair>,
    examined: usize,
}

impl<'a> LineCheck<'a> {
    /// For lines that keep `margin` >= 0 (m) in `scene`, but for rounding.
    pub fn new(scene: &'a Scene<'a>, margin: f64) -> Self {
        Self { eight: EightScene::new(scene), margin, pending: vec![], likely: None, examined: 0 }
    }

    /// Number of configurations examined.
    pub fn examined(&self) -> usize {
        self.examined
    }

    /// Whether everything is clear on the way from `from` to `to`, and there; `from` is known to be clear.
    pub fn is_clear(&mut self, from: &[f64], to: &[f64]) -> bool {
        is_clear(self, from, to)
    }

    #[inline(always)]
    fn examine<A: Arithmetic>(&mut self, from: &[f64], to: &[f64]) -> bool {
        let mut reach: Point = from.iter().zip(to).map(|(from, to)| (to - from).abs()).collect();
        let blocks = (self.eight.farthest(&reach) / (8.0 * SPACING)).ceil().max(1.0) as usize;
        // Every configuration of the line is this near to one of the first eight, which are in the middle of each eighth.
        reach.iter_mut().for_each(|reach| *reach *= 1.0 / 16.0);
        let first = blocks / 2;
        self.place::<A>(from, to, first, blocks);
        if !self.first_block::<A>(&reach) {
            return false;
        }
        for block in (0..blocks).filter(|block| *block != first) {
            if self.pending.is_empty() {
                return true;
            }
            self.place::<A>(from, to, block, blocks);
            for i in 0..self.pending.len() {
                let pair = self.pending[i];
                if self.eight.meet::<A>(pair, self.margin) {
                    self.likely = Some(pair);
                    return false;
                }
            }
        }
        true
    }

    /// Places everything at entry `block` of `blocks` configurations in each eighth of the line.
    #[inline(always)]
    fn place<A: Arithmetic>(&mut self, from: &[f64], to: &[f64], block: usize, blocks: usize) {
        let share = |lane: usize| (lane * blocks + block + 1) as f32 / (8 * blocks) as f32;
        let shares: [f32; 8] = std::array::from_fn(share);
        self.eight.place::<A>(|j| {
            let (start, along) = (from[j] as f32, (to[j] - from[j]) as f32);
            F32x8(std::array::from_fn(|lane| start + shares[lane] * along))
        });
        self.examined += 8;
    }

    /// Tests everything at the configurations, and lists the pairs that may meet between them.
    #[inline(always)]
    fn first_block<A: Arithmetic>(&mut self, reach: &[f64]) -> bool {
        let Self { eight, margin, pending, likely, .. } = self;
        pending.clear();
        if let Some(pair) = *likely
            && eight.meet::<A>(pair, *margin)
        {
            return false;
        }
        eight.each_near::<A>(*margin, reach, |near, pair, _| {
            if near.meet::<A>(pair, *margin) {
                *likely = Some(pair);
                return false;
            }
            pending.push(pair);
            true
        })
    }
}

by_instructions! {
    fn is_clear(check: &mut LineCheck<'_>, from: &[f64], to: &[f64]) -> bool {
        check.examine::<A>(from, to)
    }
}
