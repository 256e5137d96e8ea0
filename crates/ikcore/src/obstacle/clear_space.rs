//! The configurations at which a robot keeps a margin from everything.

use std::sync::Arc;

use super::coming_rows::{Coming, ComingRows};
use super::contact::{Contact, NearestContact};
use super::joint_motion::JointMotion;
use super::motion_certificate::MotionCertificate;
use super::near_rows::NearRows;
use super::required_distance::RequiredDistance;
use super::scene::Scene;
use crate::robot::Robot;

/// A contact that no motion of the arm alone ends.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Blocked {
    /// Of an obstacle and a body that no joint moves.
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

    /// The same space with obstacles of its own, and `robot`, an equal one.
    pub(crate) fn with_shared(self, robot: &Arc<Robot>) -> ClearSpace<'static> {
        ClearSpace { scene: self.scene.with_shared(robot), margin: self.margin }
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
        self.scene.others.obstacles.first_open_mesh()
    }

    /// The nearest two bodies at `q` (n,); `None` if nothing can touch.
    pub fn nearest(&self, q: &[f64]) -> Option<NearestContact> {
        self.scene.nearest_contact(q).ok().flatten()
    }

    /// What makes every configuration unclear that has the frames of these numbers, those of tips, where `q` (n,) has them: a body
    /// that no joint moves, or one that is fixed to a tip, is nearer than the margin to something that does not move either.
    pub(crate) fn blocked_at(&self, q: &[f64], hands: &[usize]) -> Option<Blocked> {
        self.blocked_anywhere(q).or_else(|| self.scene.contact_of_hands(q, hands, self.margin).map(Blocked::Hand))
    }

    /// What makes every configuration unclear: a body that no joint moves is nearer to an obstacle than the margin.
    /// `q` (n,) is any configuration.
    pub(crate) fn blocked_anywhere(&self, q: &[f64]) -> Option<Blocked> {
        self.scene.contact_at_rest(q, self.margin).map(Blocked::Base)
    }

    /// Scratch of [`find_rows`](Self::find_rows).
    pub(crate) fn near_rows(&self) -> NearRows {
        NearRows::new(&self.scene)
    }

    /// Scratch of [`find_coming`](Self::find_coming).
    pub(crate) fn coming_rows(&self) -> ComingRows {
        ComingRows::new(&self.scene)
    }

    /// Finds what comes too near to an arm that stays at `q`.
    pub(crate) fn find_coming(&self, q: &[f64], coming: &Coming<'_>, rows: &mut ComingRows) {
        rows.find(&self.scene, q, coming);
    }

    /// Scratch of [`is_kept_by`](Self::is_kept_by).
    pub(crate) fn motion_certificate(&self) -> MotionCertificate {
        MotionCertificate::new(&self.scene)
    }

    /// Finds the pairs that are nearer than `up_to` (m) at `q`, without bodies that no joint moves.
    pub(crate) fn find_rows(&self, q: &[f64], up_to: f64, rows: &mut NearRows) {
        rows.find(&self.scene, q, up_to);
    }

    /// Whether `motion` from 0 to `end` keeps these distances for certain, between ticks too; of bodies that no joint moves none is asked.
    pub(crate) fn is_kept_by(
        &self,
        motion: &impl JointMotion,
        end: f64,
        kept: &RequiredDistance<'_>,
        check: &mut MotionCertificate,
    ) -> bool {
        check.is_clear(&self.scene, motion, end, kept)
    }

    /// The sum of (margin - d)^2 (m^2) over all pairs of bodies whose distance d is below the margin, but for those that no joint moves.
    pub fn squared_shortfall(&self, q: &[f64]) -> f64 {
        let mut sum = 0.0;
        self.scene.for_each_within(self.margin, &self.scene.place(q), |_, distance| {
            sum += (self.margin - distance) * (self.margin - distance);
        });
        sum
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
