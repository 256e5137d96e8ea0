//! Planar arms: their inverse kinematics in closed form, with the redundancy as a parameter.
//!
//! Here the unknowns are orientations of links, and the first two links close the chain. In
//! [`Linkage`](crate::posture::Linkage) the tip is fixed, the unknowns are joint positions on circles, and the last two
//! links close the chain. Each measures the link lengths itself, because lengths that differ in the last bit would lead
//! the swarms of the reproduced papers to other plans and postures.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use crate::math::turns::without_turns;
use crate::robot::{JointKind, Robot};
use crate::task::Target;
use crate::wording::number;

/// An arm of revolute joints about the z axis; its links are the sides of a polygon in the x-y plane.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanarArm {
    /// Position of the first joint (m).
    base: [f64; 2],
    /// Height of the plane in which the tip moves (m).
    height: f64,
    /// Distance from each joint to the next, or to the tip (m).
    lengths: Vec<f64>,
    /// Direction of each link at q = 0, relative to the previous link (rad).
    offsets: Vec<f64>,
    /// Orientation of the tip's x axis relative to the last link (rad).
    tool: f64,
}

/// The sign of the second joint's angle, which the arccosine of eq. (1) leaves open.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Elbow {
    /// theta_2 >= 0, the value of the arccosine.
    #[default]
    Positive,
    /// theta_2 <= 0.
    Negative,
}

impl Elbow {
    /// The sign of the second joint's angle: 1 or -1.
    pub fn sign(self) -> f64 {
        match self {
            Self::Positive => 1.0,
            Self::Negative => -1.0,
        }
    }
}

/// The links after these two are the redundancy.
pub(crate) const ELBOW_LINKS: usize = 2;

const HOLE: &str = "inside the hole that the arm leaves about its base";

/// Largest deviation of a robot from the polygon of its links (m).
const AGREEMENT: f64 = 1e-9;

impl PlanarArm {
    /// `robot` as a planar arm of at least two links; `None` if it is not one.
    pub fn of(robot: &Robot) -> Option<Self> {
        let n = robot.dof();
        if robot.tip_count() > 1
            || n < ELBOW_LINKS
            || robot.joints().iter().any(|joint| joint.kind == JointKind::Prismatic)
        {
            return None;
        }
        let mut columns = crate::math::Columns::default();
        let tip = robot.tip_and_jacobian(&vec![0.0; n], &mut columns);
        let vertical = |column: &[f64; 6]| {
            let [_, _, up, about @ ..] = column;
            up.abs() < AGREEMENT && (Vector3::from(about.to_owned()) - Vector3::z()).norm() < AGREEMENT
        };
        if !columns[..n].iter().all(vertical) {
            return None;
        }
        // A column is z x (tip - joint), which gives the position of the joint.
        let mut places: Vec<[f64; 2]> =
            columns[..n].iter().map(|c| [tip.origin[0] - c[1], tip.origin[1] + c[0]]).collect();
        let base = places[0];
        places.push([tip.origin[0], tip.origin[1]]);
        let sides = places.windows(2).map(|ends| [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]]);
        let (lengths, directions): (Vec<_>, Vec<_>) = sides.map(|[x, y]| (x.hypot(y), y.atan2(x))).unzip();
        let offsets = (0..n).map(|i| directions[i] - if i == 0 { 0.0 } else { directions[i - 1] }).collect();
        let tool = tip.axes[0][1].atan2(tip.axes[0][0]) - directions[n - 1];
        let arm = Self { base, height: tip.origin[2], lengths, offsets, tool };
        arm.agrees_with(robot).then_some(arm)
    }

    /// Whether the polygon moves as the robot does. One configuration is enough to detect coupled joints.
    fn agrees_with(&self, robot: &Robot) -> bool {
        let q: Vec<f64> = (0..self.dof()).map(|i| 0.3 + 0.7 * i as f64).collect();
        let (x, y) = self.corners(&q).last().unwrap_or_default().into();
        let tip = robot.tip_position(&q);
        let sound = self.lengths[..ELBOW_LINKS].iter().all(|length| *length > AGREEMENT);
        sound && (tip[0] - x).hypot(tip[1] - y) < AGREEMENT && (tip[2] - self.height).abs() < AGREEMENT
    }

    /// Number of links.
    pub fn dof(&self) -> usize {
        self.lengths.len()
    }

    /// Lengths of the links (m).
    pub fn lengths(&self) -> &[f64] {
        &self.lengths
    }

    /// Positions of the first joint, the others and the tip at `q` (n,) (m).
    pub fn corners<'a>(&'a self, q: &'a [f64]) -> impl Iterator<Item = [f64; 2]> + 'a {
        let mut at = self.base;
        let mut direction = 0.0;
        let links = self.lengths.iter().zip(&self.offsets).zip(q).map(move |((length, offset), angle)| {
            direction += angle + offset;
            let (sine, cosine) = direction.sin_cos();
            at = [at[0] + length * cosine, at[1] + length * sine];
            at
        });
        std::iter::once(self.base).chain(links)
    }

    /// The target in the plane, with the orientation (rad) if given. `None` for a target outside the plane, or one that
    /// is neither a position nor a pose.
    pub fn planar_target(&self, target: &Target) -> Option<PlanarTarget> {
        let position = target.position()?;
        let orientation = match target {
            Target::Position(_) => None,
            Target::Pose(frame) => {
                let upright = (Vector3::from(frame.axes[2]) - Vector3::z()).norm() < AGREEMENT;
                let angle = frame.axes[0][1].atan2(frame.axes[0][0]) - self.tool;
                upright.then_some(Some(angle))?
            }
            Target::Orientation(_) | Target::Pointing { .. } => return None,
        };
        let in_plane = (position[2] - self.height).abs() < AGREEMENT;
        in_plane.then_some(PlanarTarget { position: [position[0], position[1]], orientation })
    }

    /// Explains why a target cannot be reached; `None` if it can.
    pub fn problem(&self, place: &PlanarTarget) -> Option<String> {
        let (free, held) = match &place.orientation {
            None => (self.dof(), [].as_slice()),
            Some(orientation) => (self.dof() - 1, std::slice::from_ref(orientation)),
        };
        let gap = self.gap(self.wrist(place.position, free, held), free)?;
        let (distance, side) = (number(gap.abs()), if gap > 0.0 { "beyond the arm's reach" } else { HOLE });
        Some(format!("it is {distance} m {side}"))
    }

    /// Distance (m) of a point from the annulus that the first `links` links reach: positive outside, negative in the
    /// hole; `None` if they reach it.
    pub fn gap(&self, [x, y]: [f64; 2], links: usize) -> Option<f64> {
        let distance = (x - self.base[0]).hypot(y - self.base[1]);
        let longest = self.lengths[..links].iter().copied().fold(0.0, f64::max);
        let reach: f64 = self.lengths[..links].iter().sum();
        let hole = (2.0 * longest - reach).max(0.0);
        match distance {
            _ if distance > reach => Some(distance - reach),
            _ if distance < hole => Some(distance - hole),
            _ => None,
        }
    }

    /// Start of link `link` (from 0) that ends in `end` at this absolute `orientation` (rad).
    pub fn start_of(&self, link: usize, [x, y]: [f64; 2], orientation: f64) -> [f64; 2] {
        let (sine, cosine) = orientation.sin_cos();
        [x - self.lengths[link] * cosine, y - self.lengths[link] * sine]
    }

    /// Absolute orientation of every link at `q` (rad).
    pub fn orientations(&self, q: &[f64]) -> Vec<f64> {
        let turned = self.offsets.iter().zip(q).map(|(offset, angle)| offset + angle);
        turned
            .scan(0.0, |sum, angle| {
                *sum += angle;
                Some(*sum)
            })
            .collect()
    }

    /// The elbow of the arm at `q`.
    pub fn elbow(&self, q: &[f64]) -> Elbow {
        if wrapped(q[1] + self.offsets[1]) < 0.0 { Elbow::Negative } else { Elbow::Positive }
    }

    /// Start of link `links` (from 0) such that it and the links after it, at `orientations` (rad, absolute), end in
    /// `position`.
    pub fn wrist(&self, position: [f64; 2], links: usize, orientations: &[f64]) -> [f64; 2] {
        let held = (links..self.dof()).zip(orientations);
        held.fold(position, |end, (link, orientation)| self.start_of(link, end, *orientation))
    }

    /// Writes the joint angles (rad, wrapped to (-pi, pi]) that put the tip at `position` (m), with the third and later
    /// links at these absolute `orientations` (rad).
    ///
    /// # Errors
    /// The infeasible cos(theta_2) of eq. (1): above 1 the wrist is out of reach, below -1 inside the hole.
    pub fn solve(&self, position: [f64; 2], orientations: &[f64], elbow: Elbow, q: &mut [f64]) -> Result<(), f64> {
        let [x, y] = self.wrist(position, ELBOW_LINKS, orientations);
        let (x, y) = (x - self.base[0], y - self.base[1]);
        let [l1, l2] = [self.lengths[0], self.lengths[1]];
        let cosine = (x * x + y * y - l1 * l1 - l2 * l2) / (2.0 * l1 * l2); // eq. (1)
        if cosine.abs() > 1.0 {
            return Err(cosine);
        }
        let bend = elbow.sign() * cosine.acos();
        // Eq. (2) gives only the cosine of theta_1; this is the angle with its sign.
        let first = y.atan2(x) - (l2 * bend.sin()).atan2(l1 + l2 * cosine);
        let mut direction = 0.0;
        for (i, q) in q.iter_mut().enumerate() {
            let absolute = match i {
                0 => first,
                1 => first + bend,
                _ => orientations[i - ELBOW_LINKS],
            };
            *q = wrapped(absolute - direction - self.offsets[i]);
            direction = absolute;
        }
        Ok(())
    }

    /// The orientations (rad) of link `link` (from 0, at least 2) that ends in `position`, such that the links before
    /// it reach its start: middle and half-width of an interval. A half-width of pi is the full circle; `None` if there
    /// is no such orientation.
    ///
    /// The law of cosines in the triangle of base, start and end of the link: the paper's "geometric method".
    pub fn orientation_range(&self, position: [f64; 2], link: usize) -> Option<(f64, f64)> {
        let (x, y) = (position[0] - self.base[0], position[1] - self.base[1]);
        let (distance, length) = (x.hypot(y), self.lengths[link]);
        let reach: f64 = self.lengths[..link].iter().sum();
        if distance * length == 0.0 {
            return (distance.max(length) <= reach).then_some((0.0, PI));
        }
        let cosine = (distance * distance + length * length - reach * reach) / (2.0 * distance * length);
        let middle = y.atan2(x);
        match cosine {
            c if c > 1.0 => None,
            c if c < -1.0 => Some((middle, PI)),
            c => Some((middle, c.acos())),
        }
    }
}

/// Target of a planar arm's tip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanarTarget {
    /// Position in the plane (m).
    pub position: [f64; 2],
    /// Absolute orientation of the last link (rad), if given.
    pub orientation: Option<f64>,
}

/// An orientation and the range that it was chosen from (rad).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Orientation {
    /// The chosen value.
    pub value: f64,
    /// The lowest possible.
    pub lowest: f64,
    /// The highest possible.
    pub highest: f64,
}

/// Orientations of several links, from the last one inwards.
pub type Orientations = SmallVec<[Orientation; 4]>;

/// The angle (rad) in (-pi, pi] that differs from `angle` by whole turns.
pub(crate) fn wrapped(angle: f64) -> f64 {
    let wrapped = without_turns(angle);
    if wrapped <= -PI { wrapped + TAU } else { wrapped }
}
