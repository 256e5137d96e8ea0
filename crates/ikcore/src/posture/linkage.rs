//! Planar arm with a fixed tip: joint points on circles. `plan::planar_arm` describes the same arm with link orientations
//! as unknowns, and explains why each measures the link lengths itself.

use std::f64::consts::TAU;

use crate::error::{Error, Result};
use crate::manipulability::{Manipulability, Motion};
use crate::math::turns::without_turns;
use crate::robot::Robot;
use crate::wording::words;

/// Point of the plane (m).
pub type Point2 = [f64; 2];

/// Measure of a posture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Measure {
    /// Yoshikawa's index of the tip; multiplied by k_m it is the paper's SM_n, eq. (15).
    #[default]
    Tip,
    /// Sum of the indices of all links, SM of eq. (16).
    Overall,
}

words!("measure": Measure { Tip => "tip", Overall => "overall" });

/// Rectangle that contains all joint points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rectangle {
    /// Smallest x and y (m).
    pub lower: Point2,
    /// Largest x and y (m).
    pub upper: Point2,
}

/// Tolerance (m) at the edges of a region, where optima often lie.
const ON_EDGE: f64 = 1e-12;

impl Rectangle {
    fn contains(&self, point: &Point2) -> bool {
        (0..2).all(|k| self.lower[k] - ON_EDGE <= point[k] && point[k] <= self.upper[k] + ON_EDGE)
    }
}

/// Planar arm with a fixed tip.
#[derive(Debug, Clone)]
pub struct Linkage {
    robot: Robot,
    base: Point2,
    target: Point2,
    lengths: Vec<f64>,
    /// Headings of the links at q = 0 (rad).
    directions: Vec<f64>,
    measure: Measure,
    region: Option<Rectangle>,
    manipulability: Manipulability,
}

impl Linkage {
    /// Linkage of `robot` with its tip at `target` (m).
    ///
    /// # Errors
    /// [`Error::InvalidRobot`] unless the robot has at least three joints, all turning about z in one plane;
    /// [`Error::OutOfRange`] for a target out of that plane.
    pub fn new(robot: &Robot, target: &[f64; 3], measure: Measure, region: Option<Rectangle>) -> Result<Self> {
        let screws = robot.screws(&vec![0.0; robot.dof()]);
        let invalid = |problem: String| Error::InvalidRobot { robot: robot.name().into(), problem: problem.into() };
        let height = screws[0].origin[2];
        let planar = robot.curve_leader().is_none()
            && screws.iter().enumerate().all(|(i, screw)| {
                let axis_is_z = (screw.turn[2] - 1.0).abs() < 1e-12 && screw.slide == [0.0; 3];
                axis_is_z
                    && screw.joint == i
                    && (screw.origin[2] - height).abs() < 1e-9
                    && (screw.end[2] - height).abs() < 1e-9
            });
        if !planar {
            return Err(invalid("a posture on circles needs an arm of joints that turn about z in one plane".into()));
        }
        if screws.len() < 3 {
            return Err(invalid(format!("a posture on circles needs at least 3 links, got {}", screws.len())));
        }
        if !((target[2] - height).abs() < 1e-9) {
            return Err(Error::out_of_range(
                "z of the target",
                format!("that of the arm's plane, {height}"),
                target[2],
            ));
        }
        let links = screws.iter().map(|screw| [screw.end[0] - screw.origin[0], screw.end[1] - screw.origin[1]]);
        Ok(Self {
            base: [screws[0].origin[0], screws[0].origin[1]],
            target: [target[0], target[1]],
            lengths: links.clone().map(|[x, y]| x.hypot(y)).collect(),
            directions: links.map(|[x, y]| y.atan2(x)).collect(),
            measure,
            region,
            manipulability: Manipulability::of(robot, Motion::Position),
            robot: robot.clone(),
        })
    }

    /// Number of links.
    pub fn links(&self) -> usize {
        self.lengths.len()
    }

    /// Returns the joint points between base and tip, one fewer than links, from the headings (rad) of all links but
    /// the last two. For a positive `side` the last point is to the left of the line to the target, else to the right;
    /// `None` if the last two links cannot close the linkage.
    pub fn close(&self, headings: &[f64], side: f64) -> Option<Vec<Point2>> {
        let mut points = Vec::with_capacity(self.links() - 1);
        let mut end = self.base;
        for (heading, length) in headings.iter().zip(&self.lengths) {
            end = [end[0] + length * heading.cos(), end[1] + length * heading.sin()];
            points.push(end);
        }
        points.push(self.last_point(&end, side)?);
        Some(points)
    }

    /// Moves `points` onto their circles: each along the direction from the previous one, the last to the nearer
    /// intersection of the circles of the last two links. `None` if these do not intersect.
    pub(super) fn repair(&self, points: &mut [Point2]) -> Option<()> {
        let mut end = self.base;
        let last = points.len() - 1;
        for (point, length) in points[..last].iter_mut().zip(&self.lengths) {
            let (x, y) = (point[0] - end[0], point[1] - end[1]);
            let scale = length / x.hypot(y).max(f64::MIN_POSITIVE);
            *point = [end[0] + scale * x, end[1] + scale * y];
            end = *point;
        }
        let (near, target) = (points[last], self.target);
        let side = (target[0] - end[0]) * (near[1] - end[1]) - (target[1] - end[1]) * (near[0] - end[0]);
        points[last] = self.last_point(&end, side)?;
        Some(())
    }

    /// Intersection of the circles about `from` and about the target, to the left or the right of the line between.
    fn last_point(&self, from: &Point2, side: f64) -> Option<Point2> {
        let n = self.links();
        let (a, b) = (self.lengths[n - 2], self.lengths[n - 1]);
        let (x, y) = (self.target[0] - from[0], self.target[1] - from[1]);
        let gap = x.hypot(y);
        if gap > a + b || gap < (a - b).abs() || gap == 0.0 {
            return None;
        }
        let along = (gap * gap + a * a - b * b) / (2.0 * gap);
        let aside = (a * a - along * along).max(0.0).sqrt().copysign(side);
        let (ux, uy) = (x / gap, y / gap);
        Some([from[0] + along * ux - aside * uy, from[1] + along * uy + aside * ux])
    }

    /// Returns the index of a posture and writes its configuration to `q` (n,); `None` outside the region or the joint
    /// limits.
    pub fn index(&self, points: &[Point2], q: &mut [f64]) -> Option<f64> {
        if self.region.is_some_and(|region| !points.iter().all(|point| region.contains(point))) {
            return None;
        }
        let mut from = self.base;
        let mut before = 0.0;
        for (j, to) in points.iter().chain([&self.target]).enumerate() {
            let turned = (to[1] - from[1]).atan2(to[0] - from[0]) - self.directions[j];
            q[j] = self.within_limits(j, turned - before)?;
            (from, before) = (*to, turned);
        }
        Some(match self.measure {
            Measure::Tip => self.manipulability.index(&self.robot, q),
            Measure::Overall => self.manipulability.link_indices(&self.robot, q).sum(),
        })
    }

    /// Shifts `angle` by whole turns into the limits of joint `j`, as near to zero as possible.
    fn within_limits(&self, j: usize, angle: f64) -> Option<f64> {
        let joint = &self.robot.joints()[j];
        let nearest = without_turns(angle);
        [nearest, nearest - TAU, nearest + TAU].into_iter().find(|q| joint.lower <= *q && *q <= joint.upper)
    }
}
