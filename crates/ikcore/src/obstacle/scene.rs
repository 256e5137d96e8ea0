//! A robot among obstacles: pairs of bodies that can touch, and their distances.

use std::ops::Deref;
use std::sync::{Arc, OnceLock};

use nalgebra::Vector3;

use super::allowed_contacts::AllowedContacts;
use super::clear_groups::{OtherBodies, PosedArm};
use super::contact::{Contact, NearestContact, Neighbor};
use super::link_displacement::displacement;
use super::obstacles::Obstacles;
use crate::bodies::{BodyModel, BodyPair, BodyPoses, CarriedBody};
use crate::error::{Error, Result};
use crate::math::{Columns, Frame};
use crate::message::{Setting, message};
use crate::robot::{Joint, Robot};
use crate::shape::{LineSegment, PosedBody};
use crate::wording::listed;

/// A joint motion longer than any (rad, m).
const ANY_MOTION: f64 = 1e9;

/// A body that moves by less (m) does not move.
const AT_REST: f64 = 1e-6;

/// The bodies of a robot, the obstacles, and the pairs of bodies that must not touch.
///
/// All bodies are tested against the obstacles, those of the base and of held links too, unless an obstacle names their link
/// ([`Obstacle::touch`](super::Obstacle::touch)). Links are tested against each other in
/// pairs ([`Robot::collision_pairs`]).
#[derive(Debug, Clone)]
pub struct Scene<'a> {
    robot: SceneRobot<'a>,
    pub(super) bodies: Arc<BodyModel>,
    pub(super) others: OtherBodies,
    /// Cache of [`Self::fixed`].
    fixed: OnceLock<Option<(f64, BodyPair)>>,
    /// Cache of [`Self::fixed_are_clear`]: the first margin, and the answer.
    clear_at_rest: OnceLock<(f64, bool)>,
}

/// A robot, borrowed or shared.
#[derive(Debug, Clone)]
pub enum SceneRobot<'a> {
    /// A robot that outlives the scene.
    Borrowed(&'a Robot),
    /// A robot of its own.
    Shared(Arc<Robot>),
}

impl<'a> From<&'a Robot> for SceneRobot<'a> {
    fn from(robot: &'a Robot) -> Self {
        Self::Borrowed(robot)
    }
}

impl From<&Arc<Robot>> for SceneRobot<'_> {
    fn from(robot: &Arc<Robot>) -> Self {
        Self::Shared(Arc::clone(robot))
    }
}

impl Deref for SceneRobot<'_> {
    type Target = Robot;

    #[inline]
    fn deref(&self) -> &Robot {
        match self {
            Self::Borrowed(robot) => robot,
            Self::Shared(robot) => robot,
        }
    }
}

impl<'a> Scene<'a> {
    /// # Errors
    /// [`Error::NoCapsules`] if the robot has none, or if some of its collision shapes could not be read;
    /// [`Error::InvalidObstacle`] for a flat obstacle and an arm that leaves its plane, and for one that may touch a link
    /// without a body, or every link;
    /// [`Error::Contradiction`] if the robot carries something in the scene ([`Obstacles::beside_carried`]), and this one does not.
    pub fn new(robot: impl Into<SceneRobot<'a>>, obstacles: impl Into<Obstacles>) -> Result<Self> {
        let (robot, obstacles) = (robot.into(), obstacles.into());
        if robot.capsules().is_empty() || !robot.unread_collision_shapes().is_empty() {
            return Err(no_capsules(&robot));
        }
        if let Some(i) = obstacles.first_flat()
            && !moves_in_plane(&robot)
        {
            let problem = format!(
                "obstacle {i} is an Ellipse, which lies in the plane z = 0, and robot '{}' leaves that plane: use an \
                 Ellipsoid",
                robot.name()
            );
            return Err(Error::InvalidObstacle { problem });
        }
        let bodies = Arc::clone(robot.body_model());
        if let Some([link, name]) = obstacles.first_not_carried(&bodies.carried) {
            let problem = message![
                format!("in the scene, link '{link}' carries '{name}', which robot '{}' does not: use ", robot.name()),
                Setting::Attach
            ];
            return Err(Error::Contradiction { problem });
        }
        let allowed = AllowedContacts::new(&robot, &bodies.carried, &obstacles)?;
        let others = OtherBodies { obstacles, allowed, itself: true };
        Ok(Self { robot, bodies, others, fixed: OnceLock::new(), clear_at_rest: OnceLock::new() })
    }

    /// Scene of a robot around which nothing is, and whose links may cross each other: nothing can touch, so it needs no bodies.
    ///
    /// # Errors
    /// None in practice: there are no obstacles.
    pub(super) fn empty(robot: impl Into<SceneRobot<'a>>) -> Result<Self> {
        let (robot, obstacles) = (robot.into(), Obstacles::default());
        let bodies = Arc::clone(robot.body_model());
        let allowed = AllowedContacts::new(&robot, &bodies.carried, &obstacles)?;
        let others = OtherBodies { obstacles, allowed, itself: false };
        Ok(Self { robot, bodies, others, fixed: OnceLock::new(), clear_at_rest: OnceLock::new() })
    }

    /// The smallest distance (m) of an obstacle from a body that no joint moves, and the pair; the same at any configuration.
    pub(super) fn fixed(&self) -> Option<(f64, BodyPair)> {
        *self.fixed.get_or_init(|| self.nearest_fixed())
    }

    /// Pairs of the `wanted` bodies and the obstacles that they must not touch.
    fn with_obstacles(&self, wanted: impl Fn(&CarriedBody) -> bool + Clone) -> impl Iterator<Item = BodyPair> + Clone {
        let others = &self.others;
        let with_each = move |body| {
            let obstacles = (0..others.obstacles.len()).filter(move |obstacle| !others.allowed.allow(body, *obstacle));
            obstacles.map(move |obstacle| BodyPair::Obstacle { body, obstacle })
        };
        (0..self.bodies.carried.len()).filter(move |i| wanted(&self.bodies.carried[*i])).flat_map(with_each)
    }

    /// Pairs whose distance changes with the joints: of links, then of links and obstacles.
    pub(super) fn pairs(&self) -> impl Iterator<Item = BodyPair> + Clone {
        let links: &[BodyPair] = if self.others.itself { &self.bodies.pairs } else { &[] };
        links.iter().copied().chain(self.with_obstacles(|body| body.stages > 0))
    }

    /// Copy of the scene in which links may cross each other, as in a planar arm.
    pub fn without_self_collision(mut self) -> Self {
        self.others.itself = false;
        self
    }

    /// The robot.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Scene of the robot among other obstacles.
    ///
    /// # Errors
    /// Those of [`new`](Self::new).
    pub(super) fn among(&self, obstacles: Obstacles) -> Result<Self> {
        let scene = Self::new(self.robot.clone(), obstacles)?;
        Ok(if self.others.itself { scene } else { scene.without_self_collision() })
    }

    /// The nearest pair at `q` (n,), or the deepest one if pairs overlap; `None` if nothing can touch.
    ///
    /// # Errors
    /// [`Error::WrongLength`] or [`Error::NotFinite`].
    pub fn nearest(&self, q: &[f64]) -> Result<Option<Contact>> {
        self.robot.check("joint angles", q)?;
        Ok(self.nearest_pair(&self.poses(q)).map(|(distance, pair)| self.contact(pair, distance)))
    }

    /// The smallest distance (m) at `q` (n,); infinite if nothing can touch.
    ///
    /// # Errors
    /// As [`nearest`](Self::nearest).
    pub fn clearance(&self, q: &[f64]) -> Result<f64> {
        Ok(self.nearest(q)?.map_or(f64::INFINITY, |contact| contact.distance))
    }

    /// [`clearance`](Self::clearance) at each of the configurations stored one after another.
    ///
    /// # Errors
    /// As [`nearest`](Self::nearest).
    pub fn clearances(&self, qs: &[f64]) -> Result<Vec<f64>> {
        qs.chunks(self.robot.dof()).map(|q| self.clearance(q)).collect()
    }

    /// The nearest pair at `q` (n,) with its nearest points, and the derivative of its distance by the joints; `None` if nothing can
    /// touch.
    ///
    /// # Errors
    /// As [`nearest`](Self::nearest).
    pub fn nearest_contact(&self, q: &[f64]) -> Result<Option<NearestContact>> {
        self.robot.check("joint angles", q)?;
        let poses = self.poses(q);
        let Some((distance, pair)) = self.nearest_pair(&poses) else { return Ok(None) };
        let mut gradient = vec![0.0; self.robot.dof()];
        let [point, normal] = self.add_gradient(pair, &poses, 1.0, &mut gradient);
        let contact = self.contact(pair, distance);
        Ok(Some(NearestContact { contact, point: point.into(), normal: normal.into(), gradient }))
    }

    /// Adds `factor` times the derivative of a pair's distance by the joints. Returns the point of the link that is nearest to the
    /// other body, and the unit normal there.
    pub(super) fn add_gradient(
        &self,
        pair: BodyPair,
        poses: &BodyPoses,
        factor: f64,
        gradient: &mut [f64],
    ) -> [Vector3<f64>; 2] {
        let (point, slope) = match pair {
            BodyPair::Obstacle { body, obstacle } => {
                self.others.obstacles[obstacle].shape.nearest_to_body(&self.posed(body, poses))
            }
            BodyPair::Bodies { near, far, .. } => self.posed(far, poses).nearest_to(&self.posed(near, poses)),
        };
        let (below, own, other) = self.carriers_of(pair);
        for (frame, factor) in [(own, factor), (other, -factor)] {
            for (moved, motion) in self.robot.carriers(frame, below) {
                let velocity = motion.velocity(&poses.frames[moved], &point.into());
                gradient[motion.joint] += factor * slope.dot(&Vector3::from(velocity));
            }
        }
        [point, slope.normalize()]
    }

    /// The nearest obstacle and body that no joint moves, such as a capsule about the axis of the first joint, if they are nearer
    /// than `margin` (m); `q` (n,) is any configuration.
    pub(crate) fn contact_at_rest(&self, q: &[f64], margin: f64) -> Option<Contact> {
        let (poses, anywhere) = (self.poses(q), vec![ANY_MOTION; self.robot.dof()]);
        let mut nearest = self.fixed();
        self.for_each_within(margin - AT_REST, &poses, |pair, distance| {
            let is_nearest = nearest.is_none_or(|(least, _)| distance < least);
            let is_of_obstacle = matches!(pair, BodyPair::Obstacle { .. });
            if is_nearest && is_of_obstacle && self.change(pair, &poses, &anywhere) < AT_REST {
                nearest = Some((distance, pair));
            }
        });
        let (distance, pair) = nearest.filter(|(distance, _)| *distance < margin)?;
        Some(self.contact(pair, distance))
    }

    /// The nearest pair with one body on a frame of `hands` and the other on another one or at rest, if it is nearer than `margin` (m).
    pub(super) fn contact_of_hands(&self, q: &[f64], hands: &[usize], margin: f64) -> Option<Contact> {
        if hands.is_empty() {
            return None;
        }
        let poses = self.poses(q);
        let is_of_hand = |body: usize| hands.contains(&self.bodies.carried[body].stages);
        let is_still = |body: usize| self.bodies.carried[body].stages == 0 || is_of_hand(body);
        let is_of_hand = |pair: &BodyPair| match *pair {
            BodyPair::Obstacle { body, .. } => is_of_hand(body),
            BodyPair::Bodies { near, far, .. } => is_still(near) && is_of_hand(far),
        };
        let distances = self.pairs().filter(is_of_hand).map(|pair| (self.distance(pair, &poses, margin), pair));
        let nearest = distances.filter(|(distance, _)| *distance < margin).min_by(|(a, _), (b, _)| a.total_cmp(b));
        nearest.map(|(distance, pair)| self.contact(pair, distance))
    }

    /// Whether everything is at least `margin` >= 0 (m) apart at `q`, which has one finite entry per joint. Never true for
    /// bodies that are nearer.
    pub fn is_clear(&self, q: &[f64], margin: f64) -> bool {
        if !self.fixed_are_clear(margin) {
            return false;
        }
        let mut frames = self.robot.frame_buffer();
        self.robot.write_frames(q, &mut frames);
        self.arm_at(&frames, margin).is_clear()
    }

    /// Whether the bodies that no joint moves are at least `margin` (m) from the obstacles.
    pub(super) fn fixed_are_clear(&self, margin: f64) -> bool {
        let rest = self.arm_at(&self.bodies.rest.frames, margin);
        let judged = || rest.is_clear_at_rest();
        let (first, are_clear) = *self.clear_at_rest.get_or_init(|| (margin, judged()));
        if margin == first { are_clear } else { judged() }
    }

    fn arm_at<'b>(&'b self, frames: &'b [Frame], margin: f64) -> PosedArm<'b> {
        PosedArm { bodies: &self.bodies, frames, others: &self.others, margin }
    }

    /// The contact of a pair that is `distance` apart (m).
    pub(super) fn contact(&self, pair: BodyPair, distance: f64) -> Contact {
        let link = |body: usize| self.bodies.carried[body].link.clone();
        match pair {
            BodyPair::Obstacle { body, obstacle } => {
                let other = Neighbor::Obstacle(obstacle, self.others.obstacles[obstacle].shape.name().into());
                Contact { link: link(body), other, distance }
            }
            BodyPair::Bodies { near, far, .. } => {
                Contact { link: link(far), other: Neighbor::Link(link(near)), distance }
            }
        }
    }

    /// Room for [`write_poses`](Self::write_poses).
    pub(super) fn pose_buffer(&self) -> BodyPoses {
        BodyPoses::with_room(self.robot.frame_buffer(), self.bodies.carried.len())
    }

    /// The bodies at `q`.
    pub(super) fn poses(&self, q: &[f64]) -> BodyPoses {
        let mut poses = self.pose_buffer();
        self.write_poses(q, &mut poses);
        poses
    }

    /// Writes where the bodies are at `q`.
    pub(super) fn write_poses(&self, q: &[f64], poses: &mut BodyPoses) {
        self.robot.write_frames(q, &mut poses.frames);
        poses.update_axes(&self.bodies.carried);
    }

    #[inline]
    pub(super) fn posed<'b>(&'b self, body: usize, poses: &'b BodyPoses) -> PosedBody<'b> {
        self.posed_at(body, &poses.segments[body], &poses.frames)
    }

    /// A lower bound of the distance between the surfaces of a pair (m), exact to 1e-9 where it is below `enough`; to 1e-7 m
    /// for bodies that are no capsules.
    pub(super) fn distance(&self, pair: BodyPair, poses: &BodyPoses, enough: f64) -> f64 {
        self.distance_of(pair, &poses.frames, |body| poses.segments[body], enough)
    }

    /// [`distance`](Self::distance) with the moving elements at `frames`.
    pub(super) fn distance_at(&self, pair: BodyPair, frames: &[Frame], enough: f64) -> f64 {
        self.distance_of(pair, frames, |body| self.axis_at(body, frames), enough)
    }

    #[inline]
    fn distance_of(&self, pair: BodyPair, frames: &[Frame], axis: impl Fn(usize) -> LineSegment, enough: f64) -> f64 {
        match pair {
            BodyPair::Obstacle { body, obstacle } => self.others.obstacles[obstacle]
                .shape
                .distance_to_body(&self.posed_at(body, &axis(body), frames), enough),
            BodyPair::Bodies { near, far, .. } => {
                let reach = self.bodies.carried[near].reach + self.bodies.carried[far].reach;
                let axes = [axis(near), axis(far)];
                let [[a, b], [c, d]] = &axes;
                let apart = 0.5 * (a + b - c - d).norm() - reach;
                if apart > enough + 1e-9 {
                    return apart - 1e-9;
                }
                let near = self.posed_at(near, &axes[0], frames);
                self.posed_at(far, &axes[1], frames).distance_to(&near, enough)
            }
        }
    }

    /// A bound on the change (m) of a pair's distance while each joint moves by up to `reach` (rad, m).
    pub(super) fn change(&self, pair: BodyPair, poses: &BodyPoses, reach: &[f64]) -> f64 {
        self.change_of(pair, &poses.frames, |body| poses.segments[body], reach)
    }

    /// [`change`](Self::change) with the moving elements at `frames`.
    pub(super) fn change_at(&self, pair: BodyPair, frames: &[Frame], reach: &[f64]) -> f64 {
        self.change_of(pair, frames, |body| self.axis_at(body, frames), reach)
    }

    #[inline]
    fn change_of(&self, pair: BodyPair, frames: &[Frame], axis: impl Fn(usize) -> LineSegment, reach: &[f64]) -> f64 {
        let (below, own, other) = self.carriers_of(pair);
        let moved = |body: usize, frame: usize| {
            displacement(&self.robot, frames, &self.posed_at(body, &axis(body), frames), [below, frame], reach)
        };
        match pair {
            BodyPair::Obstacle { body, .. } => moved(body, own),
            BodyPair::Bodies { near, far, .. } => moved(far, own) + moved(near, other),
        }
    }

    /// Axis of the capsule around a body with the moving elements at `frames`.
    fn axis_at(&self, body: usize, frames: &[Frame]) -> LineSegment {
        let carried = &self.bodies.carried[body];
        carried.axis_at(&frames[carried.stages])
    }

    #[inline]
    fn posed_at<'b>(&'b self, body: usize, axis: &'b LineSegment, frames: &[Frame]) -> PosedBody<'b> {
        let carried = &self.bodies.carried[body];
        carried.posed(axis, &frames[carried.stages])
    }

    /// Numbers of the frame that carries both bodies of a pair, of the first body's own, and of the other's.
    fn carriers_of(&self, pair: BodyPair) -> (usize, usize, usize) {
        match pair {
            BodyPair::Obstacle { body, .. } => (0, self.bodies.carried[body].stages, 0),
            BodyPair::Bodies { near, far, .. } => {
                let [near, far] = [near, far].map(|body| self.bodies.carried[body].stages);
                (self.robot.meeting_frame(near, far), far, near)
            }
        }
    }
}

/// Whether the arm stays in the plane z = 0 for all joint positions.
fn moves_in_plane(robot: &Robot) -> bool {
    let q: Vec<f64> = robot.joints().iter().map(Joint::middle).collect();
    let mut columns = Columns::default();
    let tip = robot.tip_and_jacobian(&q, &mut columns);
    let flat = |column: &[f64; 6]| column[2..5].iter().all(|x| x.abs() < 1e-9);
    robot.tip_count() == 1 && tip.origin[2].abs() < 1e-9 && columns[..robot.dof()].iter().all(flat)
}

/// Error that names the missing shapes, and how to give them.
fn no_capsules(robot: &Robot) -> Error {
    let unread = robot.unread_collision_shapes();
    let problem = match unread {
        [] => "has no capsules, so that nothing is known of the room it takes up".into(),
        _ => format!("has collision shapes that cannot be read ({})", listed(unread.iter().map(String::as_str))),
    };
    let remedy = match robot.capsules() {
        [] => message!["load its URDF with ", Setting::Fitted, ", or ", Setting::GiveCapsules],
        _ => message![
            "load its URDF with ",
            Setting::Fitted,
            ", which covers meshes too; ",
            Setting::CapsulesAlone,
            " keeps the shapes that were read and leaves these out; ",
            Setting::MoreCapsules,
            " covers them too",
        ],
    };
    Error::NoCapsules { robot: robot.name().into(), problem, remedy }
}
