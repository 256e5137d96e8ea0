//! Free configurations: those at which a robot keeps a margin from everything.

use super::clear_groups::OtherBodies;
use super::clearance::Clearance;
use super::contact::Contact;
use super::obstacles::Obstacles;
use super::scene::{Scene, SceneRobot};
use super::surroundings::Surroundings;
use crate::error::{Error, Result};
use crate::message::{Setting, message};
use crate::robot::Robot;

/// Free configurations of a scene: those at which everything keeps the margin. Callers check configurations: one finite entry per
/// joint.
#[derive(Debug, Clone)]
pub struct ClearSpace<'a> {
    scene: Scene<'a>,
    margin: f64,
}

/// A contact that no motion of the arm alone ends.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Blocked {
    /// Contact of an obstacle and a body that no joint moves.
    Base(Contact),
    /// Contact of a body that is fixed to the tip.
    Hand(Contact),
}

impl Surroundings {
    /// The free configurations of `robot`; `None` if nothing is to be checked.
    ///
    /// # Errors
    /// Those of [`Scene::new`]; [`Error::OutOfRange`] for a margin that is negative or not finite; [`Error::Contradiction`] for a
    /// margin without anything to keep it from.
    pub fn clear_space<'a>(&self, robot: impl Into<SceneRobot<'a>>) -> Result<Option<ClearSpace<'a>>> {
        let (margin, robot) = (self.kept_margin()?, robot.into());
        if !self.apply_to(&robot) {
            if self.margin.is_some() {
                let problem = message![Setting::Margin, " needs ", Setting::Surroundings];
                return Err(Error::Contradiction { problem });
            }
            return Ok(None);
        }
        let scene = Scene::new(robot, self.obstacles.clone().unwrap_or_default())?;
        let scene = if self.self_collision == Some(false) { scene.without_self_collision() } else { scene };
        Ok(Some(ClearSpace { scene, margin }))
    }
}

impl<'a> ClearSpace<'a> {
    /// The space of a robot in empty surroundings.
    ///
    /// # Errors
    /// Those of [`Scene::empty`].
    pub(crate) fn empty(robot: impl Into<SceneRobot<'a>>) -> Result<Self> {
        Ok(Self { scene: Scene::empty(robot)?, margin: 0.0 })
    }

    /// The space in which everything keeps `more` (m) beyond the margin.
    pub(crate) fn narrowed(&self, more: f64) -> Self {
        Self { scene: self.scene.clone(), margin: self.margin + more }
    }

    /// The space of the same robot among other obstacles.
    ///
    /// # Errors
    /// Those of [`Scene::new`].
    pub(crate) fn among(&self, obstacles: Obstacles) -> Result<Self> {
        Ok(Self { scene: self.scene.among(obstacles)?, margin: self.margin })
    }

    /// Surroundings that define this space.
    pub(crate) fn surroundings(&self) -> Surroundings {
        let OtherBodies { obstacles, itself, .. } = &self.scene.others;
        Surroundings { obstacles: Some(obstacles.clone()), margin: Some(self.margin), self_collision: Some(*itself) }
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

    /// The robot.
    pub(crate) fn robot(&self) -> &Robot {
        self.scene.robot()
    }

    /// The obstacles.
    pub(crate) fn obstacles(&self) -> &Obstacles {
        &self.scene.others.obstacles
    }

    /// The robot and its surroundings.
    pub fn scene(&self) -> &Scene<'a> {
        &self.scene
    }

    /// The first obstacle that is a mesh which is not closed.
    pub fn first_open_mesh(&self) -> Option<usize> {
        self.obstacles().first_open_mesh()
    }

    /// The clearance at `q` (n,).
    pub fn clearance(&self, q: &[f64]) -> Clearance {
        self.scene.nearest_contact(q).ok().flatten().into()
    }

    /// Names a blocked body if every configuration with the frames `hands` of the tips where `q` (n,) has them collides: a body that no
    /// joint moves, or one that is fixed to a tip, is nearer than the margin to something that does not move either.
    pub(crate) fn blocked_at(&self, q: &[f64], hands: &[usize]) -> Option<Blocked> {
        self.blocked_anywhere(q).or_else(|| self.scene.contact_of_hands(q, hands, self.margin).map(Blocked::Hand))
    }

    /// Names a body that no joint moves and that is nearer to an obstacle than the margin: then every configuration collides. `q` (n,)
    /// is any configuration.
    pub(crate) fn blocked_anywhere(&self, q: &[f64]) -> Option<Blocked> {
        self.scene.contact_at_rest(q, self.margin).map(Blocked::Base)
    }

    /// The sum of (margin - d)^2 (m^2) over all pairs of bodies whose distance d is below the margin, but for those that no joint moves.
    pub fn squared_shortfall(&self, q: &[f64]) -> f64 {
        let mut sum = 0.0;
        self.scene.for_each_within(self.margin, &self.scene.poses(q), |_, distance| {
            sum += (self.margin - distance) * (self.margin - distance);
        });
        sum
    }

    /// The sum of ((up_to - d) / up_to)^2 over all pairs of bodies whose distance d is below `up_to` (m). Adds `weight` times its
    /// derivative by the joints to `gradient`.
    pub fn nearness(&self, q: &[f64], up_to: f64, weight: f64, gradient: &mut [f64]) -> f64 {
        let poses = self.scene.poses(q);
        let mut sum = 0.0;
        self.scene.for_each_within(up_to, &poses, |pair, distance| {
            let short = (up_to - distance) / up_to;
            sum += short * short;
            self.scene.add_gradient(pair, &poses, -2.0 * weight * short / up_to, gradient);
        });
        sum
    }
}
