//! Continuous collision checking: motions certified to be collision-free at every instant, and their smallest
//! clearance.
//!
//! Distances are computed in the middle of an interval of the motion. If a pair is farther apart there than it can
//! approach within the interval, it is clear in the whole interval; the other pairs are examined again in both halves.
//! No step width has to be chosen, and no collision can be missed between two samples.

use super::body_model::BodyPair;
use super::contact::Contact;
use super::placement::Placement;
use super::scene::Scene;
use crate::math::MAX_DOF;
use crate::objective::Point;

/// A joint motion over an interval of its parameter (time, or the fraction of a straight line).
pub trait JointMotion {
    /// Writes the configuration in the middle of \[`from`, `to`\], and by how much each joint differs from it in there
    /// at most (rad, m).
    fn around(&self, from: f64, to: f64, middle: &mut [f64], reach: &mut [f64]);
}

/// A straight line in joint space; its parameter runs from 0 to 1.
#[derive(Debug, Clone, Copy)]
pub struct Edge<'a> {
    /// Where it begins (n,).
    pub from: &'a [f64],
    /// Where it ends (n,).
    pub to: &'a [f64],
}

impl JointMotion for Edge<'_> {
    fn around(&self, from: f64, to: f64, middle: &mut [f64], reach: &mut [f64]) {
        let (share, half) = (0.5 * (from + to), 0.5 * (to - from));
        for j in 0..middle.len() {
            let along = self.to[j] - self.from[j];
            middle[j] = self.from[j] + share * along;
            reach[j] = half * along.abs();
        }
    }
}

/// The point at which a motion comes too near to a body.
#[derive(Debug, Clone, PartialEq)]
pub struct TooNear {
    /// The motion's parameter.
    pub at: f64,
    /// What comes too near.
    pub contact: Contact,
}

/// A pair that exceeds its margin by less than this (m) counts as too near, since a decision would take many
/// bisections.
const RESOLUTION: f64 = 1e-5;

/// Checks motions in a scene; owns its scratch.
#[derive(Debug)]
pub struct Sweep<'a> {
    scene: &'a Scene<'a>,
    pending: Vec<BodyPair>,
    placement: Placement,
    examined: usize,
}

impl<'a> Sweep<'a> {
    /// A checker for any number of motions in `scene`.
    pub fn new(scene: &'a Scene<'a>) -> Self {
        let rest = vec![0.0; scene.robot().dof()];
        Self { scene, pending: scene.pairs().collect(), placement: scene.place(&rest), examined: 0 }
    }

    /// Number of configurations examined.
    pub fn examined(&self) -> usize {
        self.examined
    }

    /// Certifies that all pairs stay at least `margin` (m) apart on the motion over \[`from`, `to`\], between samples
    /// too. An error if one does not, or exceeds the margin by less than a hundredth of a millimetre.
    pub fn check(&mut self, motion: &impl JointMotion, [from, to]: [f64; 2], margin: f64) -> Result<(), Box<TooNear>> {
        if let Some((distance, pair)) = self.scene.fixed
            && distance < margin
        {
            return Err(Box::new(TooNear { at: from, contact: self.scene.contact(pair, distance) }));
        }
        self.check_pending(motion, [from, to], margin, self.pending.len())
    }

    fn check_pending(
        &mut self,
        motion: &impl JointMotion,
        [from, to]: [f64; 2],
        margin: f64,
        count: usize,
    ) -> Result<(), Box<TooNear>> {
        let reach = self.place(motion, from, to);
        let mut left = 0;
        for i in 0..count {
            let pair = self.pending[i];
            let change = self.scene.change(pair, &self.placement, &reach);
            let distance = self.scene.distance(pair, &self.placement, margin + change);
            if distance < margin + change {
                if distance < margin || change < RESOLUTION {
                    let contact = self.scene.contact(pair, distance);
                    return Err(Box::new(TooNear { at: 0.5 * (from + to), contact }));
                }
                self.pending.swap(i, left);
                left += 1;
            }
        }
        if left == 0 {
            return Ok(());
        }
        let middle = 0.5 * (from + to);
        self.check_pending(motion, [from, middle], margin, left)?;
        self.check_pending(motion, [middle, to], margin, left)
    }

    /// The smallest distance (m) on the motion over \[`from`, `to`\], and where it occurs: a certified lower bound, at
    /// most 0.1 mm or 1 % below the true value. `None` if nothing can touch.
    pub fn smallest(&mut self, motion: &impl JointMotion, [from, to]: [f64; 2]) -> Option<TooNear> {
        let mut best = match (self.scene.fixed, self.pending.first()) {
            (Some((distance, pair)), _) => Best { seen: distance, proven: distance, at: from, pair },
            (None, Some(first)) => Best { seen: f64::INFINITY, proven: f64::INFINITY, at: from, pair: *first },
            (None, None) => return None,
        };
        // A good first guess makes most of the motion quick to rule out.
        for i in 0..=FIRST_SAMPLES {
            let t = from + (to - from) * i as f64 / FIRST_SAMPLES as f64;
            self.place(motion, t, t);
            for i in 0..self.pending.len() {
                let pair = self.pending[i];
                best.offer(self.scene.distance(pair, &self.placement, best.seen), t, pair);
            }
        }
        self.narrow(motion, [from, to], &mut best, self.pending.len());
        let contact = self.scene.contact(best.pair, best.proven.min(best.seen));
        Some(TooNear { at: best.at, contact })
    }

    fn narrow(&mut self, motion: &impl JointMotion, [from, to]: [f64; 2], best: &mut Best, count: usize) {
        let reach = self.place(motion, from, to);
        let middle = 0.5 * (from + to);
        let mut left = 0;
        for i in 0..count {
            let pair = self.pending[i];
            let change = self.scene.change(pair, &self.placement, &reach);
            let distance = self.scene.distance(pair, &self.placement, best.seen + change);
            best.offer(distance, middle, pair);
            let bound = distance - change;
            if bound >= best.seen - best.slack() {
                best.proven = best.proven.min(bound);
            } else {
                self.pending.swap(i, left);
                left += 1;
            }
        }
        if left > 0 {
            self.narrow(motion, [from, middle], best, left);
            self.narrow(motion, [middle, to], best, left);
        }
    }

    /// Places everything in the middle of an interval; returns how far each joint is from there at most.
    fn place(&mut self, motion: &impl JointMotion, from: f64, to: f64) -> Point {
        let n = self.scene.robot().dof();
        let (mut middle, mut reach) = ([0.0; MAX_DOF], Point::from_elem(0.0, n));
        motion.around(from, to, &mut middle[..n], &mut reach);
        self.scene.place_into(&middle[..n], &mut self.placement);
        self.examined += 1;
        reach
    }
}

/// Samples before a search for the smallest distance.
const FIRST_SAMPLES: usize = 64;

/// The smallest distance so far.
struct Best {
    seen: f64,
    proven: f64,
    at: f64,
    pair: BodyPair,
}

impl Best {
    fn offer(&mut self, distance: f64, at: f64, pair: BodyPair) {
        if distance < self.seen {
            (self.seen, self.at, self.pair) = (distance, at, pair);
        }
    }

    /// By how much the answer may lie below the truth (m).
    fn slack(&self) -> f64 {
        1e-4_f64.max(0.01 * self.seen.abs())
    }
}
