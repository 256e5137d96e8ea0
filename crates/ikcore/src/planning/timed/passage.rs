//! Joint positions at places of a course: enough of them that the splines in between keep to it.

use super::project::project;
use crate::error::Result;
use crate::math::MAX_DOF;
use crate::objective::{Bounds, Linearization};
use crate::planning::course::Course;
use crate::planning::stray::Stray;
use crate::planning::{JointPath, SplineEnds};
use crate::robot::Robot;

/// Where the joints are on the way.
#[derive(Debug, Clone, PartialEq)]
pub struct Passage {
    /// Shares of the course, from 0 to 1.
    pub knots: Vec<f64>,
    /// One row of joints a knot.
    pub waypoints: Vec<f64>,
}

/// What the joints do at the corners of a course.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Corners {
    /// One spline leads through them: the arm swings round a corner, the nearer its knots the less.
    Passed,
    /// A spline ends at each and the next begins: the arm stops there, and leaves the course no more than elsewhere.
    Stopped,
}

impl Corners {
    /// The ways to take a course.
    pub fn on(course: &Course) -> &'static [Self] {
        match course.corners().next() {
            None => &[Self::Passed],
            Some(_) => &[Self::Passed, Self::Stopped],
        }
    }
}

/// Splines of a robot's joints along a course.
#[derive(Debug)]
pub struct Interpolation<'a> {
    /// The robot.
    pub robot: &'a Robot,
    /// The course.
    pub course: &'a Course,
    /// What it does at corners.
    pub corners: Corners,
}

/// A stretch that strays by more than this share of the accuracy is halved.
const ENOUGH: f64 = 0.8;

/// Looks inside each stretch.
const LOOKS: usize = 7;

/// Times that a stretch is halved: to a four-thousandth of its length.
const HALVINGS: usize = 12;

/// More knots are not worth the time.
const MOST_KNOTS: usize = 2000;

impl Interpolation<'_> {
    /// The joint path through these waypoints, with the share of the course for its parameter.
    ///
    /// # Errors
    /// None in practice: waypoints that differ make a spline.
    pub fn path(&self, passage: &Passage) -> Result<JointPath> {
        let n = self.robot.dof();
        let names: Vec<String> = self.robot.joints().iter().map(|joint| joint.name.clone()).collect();
        // Between the same ends a spline without curvature there would be less accurate.
        let spline = |from: usize, to: usize| {
            let rows = &passage.waypoints[from * n..(to + 1) * n];
            JointPath::spline(names.clone(), rows, Some(&passage.knots[from..=to]), SplineEnds::NotAKnot)
        };
        let last = passage.knots.len() - 1;
        if self.corners == Corners::Passed {
            return spline(0, last);
        }
        let mut ends = vec![0];
        ends.extend(self.course.corners().map(|corner| passage.knots.partition_point(|knot| *knot < corner)));
        ends.push(last);
        let stretches = ends.windows(2).map(|ends| spline(ends[0], ends[1])).collect::<Result<Vec<_>>>()?;
        JointPath::joined(stretches).map_or_else(|| spline(0, last), Ok)
    }

    /// The passage with knots added until the tip is within `accuracy` (m, rad) of the course, or until more do not help.
    ///
    /// # Errors
    /// None in practice, as for [`path`](Self::path).
    pub fn refined(&self, mut passage: Passage, accuracy: f64) -> Result<Passage> {
        for _ in 0..HALVINGS {
            let path = self.path(&passage)?;
            let stray = Stray {
                robot: self.robot,
                course: self.course,
                configurations: |share: f64, q: &mut [f64]| path.position(share, q),
            };
            let is_coarse = |i: &usize| {
                let [from, to] = [passage.knots[*i], passage.knots[*i + 1]];
                // A given start may itself be off.
                stray.between(from, to, LOOKS) > ENOUGH * accuracy + stray.at(from)
            };
            let coarse: Vec<usize> = (0..passage.knots.len() - 1).filter(is_coarse).collect();
            if coarse.is_empty() || passage.knots.len() + coarse.len() > MOST_KNOTS {
                break;
            }
            let finer = self.halved(&passage, &coarse, &path);
            if finer.knots.len() == passage.knots.len() {
                break;
            }
            passage = finer;
        }
        Ok(passage)
    }

    /// The passage with a knot in the middle of each of these stretches, where the course can be reached there.
    fn halved(&self, passage: &Passage, stretches: &[usize], path: &JointPath) -> Passage {
        let n = self.robot.dof();
        let bounds = Bounds::from_ranges(self.robot.joints().iter().map(|joint| (joint.lower, joint.upper)));
        let mut scratch = Linearization::default();
        let mut finer = Passage { knots: vec![], waypoints: vec![] };
        let mut stretches = stretches.iter().peekable();
        for (i, knot) in passage.knots.iter().enumerate() {
            finer.knots.push(*knot);
            finer.waypoints.extend_from_slice(&passage.waypoints[i * n..(i + 1) * n]);
            if stretches.next_if_eq(&&i).is_none() {
                continue;
            }
            let middle = 0.5 * (knot + passage.knots[i + 1]);
            let mut q = [0.0; MAX_DOF];
            let q = &mut q[..n];
            path.position(middle, q);
            bounds.clip(q);
            if project(self.robot, &self.course.target(middle), &bounds, q, &mut scratch) == 0.0 {
                finer.knots.push(middle);
                finer.waypoints.extend_from_slice(q);
            }
        }
        finer
    }
}
