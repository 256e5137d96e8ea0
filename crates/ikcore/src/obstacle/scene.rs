//! A robot among obstacles: pairs of bodies that can touch, and their distances.

use std::fmt;

use nalgebra::Vector3;

use super::link_displacement::{Frames, displacement};
use super::segment_distance::{LineSegment, distance_between, distance_to_obstacle};
use super::shape::Obstacle;
use crate::error::{Error, Result};
use crate::math::arithmetic::NoFma;
use crate::math::{Frame, MAX_DOF};
use crate::robot::{Joint, Robot};
use crate::wording::listed;

/// A capsule of the robot, seen from the moving element that carries it.
#[derive(Debug, Clone)]
struct Carried {
    link: String,
    stages: usize,
    ends: [[f64; 3]; 2],
    radius: f64,
}

/// Two things that could touch.
#[derive(Debug, Clone, Copy)]
pub(super) enum BodyPair {
    /// A capsule and an obstacle.
    Obstacle { capsule: usize, obstacle: usize },
    /// Two capsules of the robot; `near` is nearer to the base.
    Capsules { near: usize, far: usize },
}

/// The body that a link is near.
#[derive(Debug, Clone, PartialEq)]
pub enum Body {
    /// The obstacle of this index, and its kind.
    Obstacle(usize, &'static str),
    /// Another link.
    Link(String),
}

/// A link, the body it is near, and their distance.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// The link.
    pub link: String,
    /// The body that it is near to.
    pub other: Body,
    /// Distance between their surfaces (m); negative by how deep they reach into each other.
    pub distance: f64,
}

impl fmt::Display for Body {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Obstacle(index, name) => write!(f, "obstacle {index} ({name})"),
            Self::Link(name) => write!(f, "link '{name}'"),
        }
    }
}

/// The capsules of a robot, the obstacles, and the pairs of bodies that must not touch.
///
/// Capsules that no joint moves are not tested against obstacles: no plan could move them away. Capsules of one link,
/// or of two links with no capsule between them, are not tested against each other; nor are pairs that touch with all
/// joints in the middle of their ranges, since such overlaps come from the model and not from the motion.
#[derive(Debug, Clone)]
pub struct Scene<'a> {
    robot: &'a Robot,
    carried: Vec<Carried>,
    obstacles: &'a [Obstacle],
    pub(super) pairs: Vec<BodyPair>,
}

/// Where everything is at one configuration.
#[derive(Debug, Clone)]
pub(super) struct Placement {
    pub frames: Frames,
    pub segments: Vec<LineSegment>,
}

impl<'a> Scene<'a> {
    /// # Errors
    /// [`Error::NoCapsules`] if the robot has none, or if some of its collision shapes could not be read;
    /// [`Error::InvalidObstacle`] for a flat obstacle and an arm that leaves its plane.
    pub fn new(robot: &'a Robot, obstacles: &'a [Obstacle]) -> Result<Self> {
        if robot.capsules().is_empty() || !robot.unread_collision_shapes().is_empty() {
            return Err(no_capsules(robot));
        }
        if let Some(i) = obstacles.iter().position(Obstacle::is_flat)
            && !moves_in_plane(robot)
        {
            let problem = format!(
                "obstacle {i} is an Ellipse, which lies in the plane z = 0, and robot '{}' leaves that plane: use an \
                 Ellipsoid",
                robot.name()
            );
            return Err(Error::InvalidObstacle { problem });
        }
        let carried = robot.capsules().iter().filter_map(|capsule| {
            let (stages, offset) = robot.place_of_link(&capsule.link)?;
            let ends = [capsule.a, capsule.b].map(|end| offset.place::<NoFma>(&end));
            Some(Carried { link: capsule.link.clone(), stages, ends, radius: capsule.radius })
        });
        let carried = carried.collect();
        let mut scene = Self { robot, carried, obstacles, pairs: vec![] };
        scene.pairs = scene.self_pairs();
        let moving = (0..scene.carried.len()).filter(|i| scene.carried[*i].stages > 0);
        let with_obstacles = moving
            .flat_map(|capsule| (0..obstacles.len()).map(move |obstacle| BodyPair::Obstacle { capsule, obstacle }));
        scene.pairs.extend(with_obstacles.collect::<Vec<_>>());
        Ok(scene)
    }

    /// The same scene, but links may cross each other, as in a planar arm.
    pub fn without_self_collision(mut self) -> Self {
        self.pairs.retain(|pair| matches!(pair, BodyPair::Obstacle { .. }));
        self
    }

    /// The robot.
    pub fn robot(&self) -> &'a Robot {
        self.robot
    }

    /// The nearest pair at `q` (n,), or the deepest one if pairs overlap; `None` if nothing can touch.
    ///
    /// # Errors
    /// [`Error::WrongLength`] or [`Error::NotFinite`].
    pub fn nearest(&self, q: &[f64]) -> Result<Option<Contact>> {
        self.robot.check("joint angles", q)?;
        let placement = self.place(q);
        let distances = self.pairs.iter().map(|pair| (self.distance(*pair, &placement, f64::INFINITY), *pair));
        let nearest = distances.min_by(|one, other| one.0.total_cmp(&other.0));
        Ok(nearest.map(|(distance, pair)| self.contact(pair, distance)))
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

    /// Whether everything is at least `margin` (m) apart at `q`.
    pub fn is_clear(&self, q: &[f64], margin: f64) -> bool {
        let placement = self.place(q);
        self.pairs.iter().all(|pair| self.distance(*pair, &placement, margin) >= margin)
    }

    /// The contact of a pair that is `distance` apart (m).
    pub(super) fn contact(&self, pair: BodyPair, distance: f64) -> Contact {
        let link = |capsule: usize| self.carried[capsule].link.clone();
        match pair {
            BodyPair::Obstacle { capsule, obstacle } => {
                let other = Body::Obstacle(obstacle, self.obstacles[obstacle].name());
                Contact { link: link(capsule), other, distance }
            }
            BodyPair::Capsules { near, far } => Contact { link: link(far), other: Body::Link(link(near)), distance },
        }
    }

    pub(super) fn place(&self, q: &[f64]) -> Placement {
        let mut placement = Placement {
            frames: [Frame::IDENTITY; MAX_DOF + 1],
            segments: vec![[Vector3::zeros(); 2]; self.carried.len()],
        };
        self.place_into(q, &mut placement);
        placement
    }

    pub(super) fn place_into(&self, q: &[f64], placement: &mut Placement) {
        self.robot.write_stage_frames(q, &mut placement.frames);
        for (segment, carried) in placement.segments.iter_mut().zip(&self.carried) {
            let frame = &placement.frames[carried.stages];
            *segment = carried.ends.map(|end| frame.place::<NoFma>(&end).into());
        }
    }

    /// A lower bound of the distance between the surfaces of a pair (m), exact to 1e-9 where it is below `enough`.
    pub(super) fn distance(&self, pair: BodyPair, placement: &Placement, enough: f64) -> f64 {
        match pair {
            BodyPair::Obstacle { capsule, obstacle } => {
                let radius = self.carried[capsule].radius;
                distance_to_obstacle(&placement.segments[capsule], &self.obstacles[obstacle], enough + radius) - radius
            }
            BodyPair::Capsules { near, far } => {
                let radii = self.carried[near].radius + self.carried[far].radius;
                distance_between(&placement.segments[near], &placement.segments[far]) - radii
            }
        }
    }

    /// A bound on the change (m) of a pair's distance while each joint moves by up to `reach` (rad, m).
    pub(super) fn change(&self, pair: BodyPair, placement: &Placement, reach: &[f64]) -> f64 {
        let (first, capsule) = match pair {
            BodyPair::Obstacle { capsule, .. } => (0, capsule),
            BodyPair::Capsules { near, far } => (self.carried[near].stages, far),
        };
        let stages = first..self.carried[capsule].stages;
        displacement(self.robot, &placement.frames, &placement.segments[capsule], stages, reach)
    }

    fn self_pairs(&self) -> Vec<BodyPair> {
        let mut bodies: Vec<usize> = self.carried.iter().map(|carried| carried.stages).collect();
        bodies.sort_unstable();
        bodies.dedup();
        let order = |capsule: usize| bodies.partition_point(|stages| *stages < self.carried[capsule].stages);
        let rest: Vec<f64> = self.robot.joints().iter().map(middle_of_range).collect();
        let at_rest = self.place(&rest);
        let count = self.carried.len();
        let pairs = (0..count).flat_map(|near| (0..count).map(move |far| (near, far)));
        let apart = pairs.filter(|(near, far)| order(*near) + 1 < order(*far));
        let pairs = apart.map(|(near, far)| BodyPair::Capsules { near, far });
        pairs.filter(|pair| self.distance(*pair, &at_rest, 0.0) > 0.0).collect()
    }
}

fn middle_of_range(joint: &Joint) -> f64 {
    let (lower, upper) = joint.sampling_range();
    0.5 * (lower + upper)
}

/// Whether the arm stays in the plane z = 0 for all joint positions.
fn moves_in_plane(robot: &Robot) -> bool {
    let q: Vec<f64> = robot.joints().iter().map(middle_of_range).collect();
    let mut columns = [[0.0; 6]; MAX_DOF];
    let tip = robot.tip_and_jacobian(&q, &mut columns);
    let flat = |column: &[f64; 6]| column[2..5].iter().all(|x| x.abs() < 1e-9);
    tip.origin[2].abs() < 1e-9 && columns[..robot.dof()].iter().all(flat)
}

/// Says which shapes are missing and how to give them.
fn no_capsules(robot: &Robot) -> Error {
    let unread = robot.unread_collision_shapes();
    let problem = match unread {
        [] => "has no capsules, so that nothing is known of the room it takes up".into(),
        _ => format!("has collision shapes that cannot be read ({})", listed(unread.iter().map(String::as_str))),
    };
    let given = "with_capsules(radius=...) along its links or with_capsules([(link, a, b, radius), ...])";
    let remedy = match robot.capsules() {
        [] => format!(
            "give it capsules with {given}, or load a URDF whose links have <collision> shapes of spheres, cylinders, \
             capsules and boxes"
        ),
        _ => "robot.with_capsules(robot.capsules) keeps the shapes that were read and leaves these out; \
              robot.with_capsules(robot.capsules + [(link, a, b, radius), ...]) covers them too"
            .into(),
    };
    Error::NoCapsules { robot: robot.name().into(), problem, remedy }
}
