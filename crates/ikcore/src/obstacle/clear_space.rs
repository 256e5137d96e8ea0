//! The configurations at which a robot keeps a margin from everything.

use super::contact::{Contact, NearestContact};
use super::scene::Scene;
use crate::shape::Shape;

/// A contact that no motion of the arm alone ends.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Blocked {
    /// Of a body that no joint moves.
    Base(Contact),
    /// Of a body that is fixed to the tip.
    Hand(Contact),
}

/// A scene and a margin. Configurations are checked by the caller: one finite entry per joint.
#[derive(Debug, Clone)]
pub struct ClearSpace<'a> {
    scene: Scene<'a>,
    margin: f64,
}

impl<'a> ClearSpace<'a> {
    pub(super) fn new(scene: Scene<'a>, margin: f64) -> Self {
        Self { scene, margin }
    }

    /// The distance to keep (m).
    pub fn margin(&self) -> f64 {
        self.margin
    }

    /// Whether everything keeps the margin at `q` (n,). Never true for bodies that are nearer.
    pub fn holds(&self, q: &[f64]) -> bool {
        self.scene.is_clear(q, self.margin)
    }

    /// Whether everything keeps the margin and `more` >= 0 (m) at `q` (n,).
    pub(crate) fn keeps(&self, q: &[f64], more: f64) -> bool {
        self.scene.is_clear(q, self.margin + more)
    }

    /// The robot and what is around it.
    pub(crate) fn scene(&self) -> &Scene<'a> {
        &self.scene
    }

    /// The first obstacle that is a mesh which is not closed.
    pub fn first_open_mesh(&self) -> Option<usize> {
        self.scene.others.obstacles.iter().position(Shape::is_open_mesh)
    }

    /// The nearest two bodies at `q` (n,); `None` if nothing can touch.
    pub fn nearest(&self, q: &[f64]) -> Option<NearestContact> {
        self.scene.nearest_contact(q).ok().flatten()
    }

    /// What makes every configuration unclear that has the tip where `q` (n,) has it: a body that no joint moves, or one that is
    /// fixed to the tip, is nearer than the margin to something that does not move either.
    pub(crate) fn blocked_at_tip(&self, q: &[f64]) -> Option<Blocked> {
        self.blocked_anywhere().or_else(|| self.scene.contact_of_hand(q, self.margin).map(Blocked::Hand))
    }

    /// What makes every configuration unclear: a body that no joint moves is nearer to an obstacle than the margin.
    pub(crate) fn blocked_anywhere(&self) -> Option<Blocked> {
        let nearest = self.scene.nearest_fixed_contact().filter(|contact| contact.distance < self.margin);
        nearest.map(Blocked::Base)
    }

    /// The sum of ((up_to - d) / up_to)^2 over all pairs of bodies whose distance d is below `up_to` (m). Adds `weight` times its
    /// derivative by the joints to `gradient`.
    pub fn nearness(&self, q: &[f64], up_to: f64, weight: f64, gradient: &mut [f64]) -> f64 {
        let placement = self.scene.place(q);
        let mut sum = 0.0;
        self.scene.for_each_within(up_to, &placement, |pair, distance| {
            let short = (up_to - distance) / up_to;
            sum += short * short;
            self.scene.add_gradient(pair, &placement, -2.0 * weight * short / up_to, gradient);
        });
        sum
    }
}
