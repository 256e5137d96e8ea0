//! Closest approaches of moving obstacles to an arm at rest, and their derivatives by the joints.
//!
//! The distance of convex bodies is convex in time while one of them moves straight on, so that a search by sections finds the closest
//! approach; of others it finds one of several. There the normal is at right angles to the motion: it leads out of the way, not ahead of
//! the obstacle.

use nalgebra::Vector3;

use super::scene::Scene;
use crate::bodies::BodyPoses;
use crate::math::MAX_DOF;
use crate::math::vector::between;
use crate::shape::PosedBody;

/// Sections of the search; each leaves 0.62 of the interval.
const SECTIONS: usize = 12;

/// The fraction of an interval that a section leaves.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Smallest shortfall (m) that makes a row; negative, since obstacles that will just pass count too.
const FAR: f64 = -0.05;

/// Rows of one configuration.
pub(crate) const MOST_COMING: usize = 8;

/// The closest approach of an obstacle to a body, linearised at a configuration.
#[derive(Debug, Clone)]
pub(crate) struct ComingRow {
    /// Shortfall of the distance then (m); negative if it is large enough.
    pub short: f64,
    /// Derivative of the distance by the joints (m/rad, m/m).
    pub gradient: [f64; MAX_DOF],
}

/// Finds obstacles that come too near; owns its scratch.
#[derive(Debug)]
pub(crate) struct ComingRows {
    rows: Vec<ComingRow>,
    poses: BodyPoses,
}

/// Criterion of coming too near: a distance at the closest approach below `margin` - `pace` * the time until then.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coming<'a> {
    /// Velocities of the obstacles (m/s); empty if all are at rest.
    pub velocities: &'a [[f64; 3]],
    /// Age of the obstacle poses (s).
    pub since: f64,
    /// Horizon of the prediction (s).
    pub horizon: f64,
    /// Distance to keep (m).
    pub margin: f64,
    /// Speed at which an arm can give way (m/s).
    pub pace: f64,
}

impl ComingRows {
    /// Scratch for configurations in `scene`.
    pub fn new(scene: &Scene<'_>) -> Self {
        let rest = vec![0.0; scene.robot().dof()];
        Self { rows: Vec::with_capacity(MOST_COMING + 1), poses: scene.poses(&rest) }
    }

    /// The rows found last, the most urgent first.
    pub fn rows(&self) -> &[ComingRow] {
        &self.rows
    }

    /// Finds the obstacles that come too near to an arm at rest at `q`.
    pub fn find(&mut self, scene: &Scene<'_>, q: &[f64], coming: &Coming<'_>) {
        let Self { rows, poses } = self;
        rows.clear();
        let moving = |velocity: &[f64; 3]| *velocity != [0.0; 3];
        if !coming.velocities.iter().any(moving) {
            return;
        }
        scene.write_poses(q, poses);
        for (obstacle, velocity) in coming.velocities.iter().enumerate().filter(|(_, velocity)| moving(velocity)) {
            for body in 0..poses.segments.len() {
                let passing = Passing { scene, poses, body, obstacle, velocity: Vector3::from(*velocity), coming };
                if let Some(row) = passing.row() {
                    let at = rows.partition_point(|other| other.short >= row.short);
                    rows.insert(at, row);
                    rows.truncate(MOST_COMING);
                }
            }
        }
    }
}

/// An obstacle that passes a body at rest.
struct Passing<'a> {
    scene: &'a Scene<'a>,
    poses: &'a BodyPoses,
    body: usize,
    obstacle: usize,
    velocity: Vector3<f64>,
    coming: &'a Coming<'a>,
}

impl Passing<'_> {
    /// The closest approach, if it is too close or not much farther.
    fn row(&self) -> Option<ComingRow> {
        let Self { scene, body, obstacle, .. } = *self;
        let never_meets = scene.bodies.carried[body].stages == 0 || scene.others.allowed.allow(body, obstacle);
        if never_meets || !self.balls_meet() {
            return None;
        }
        let (time, distance) = self.closest()?;
        let short = self.coming.margin - self.coming.pace * time - distance;
        (short > FAR).then(|| ComingRow { short, gradient: self.gradient(time) })
    }

    /// Displacement of the obstacle from its given position, after `time` (s).
    fn way(&self, time: f64) -> Vector3<f64> {
        (self.coming.since + time) * self.velocity
    }

    /// Whether the balls around both come too near.
    fn balls_meet(&self) -> bool {
        let (center, radius) = self.scene.others.obstacles.ball(self.obstacle);
        let [from, to] = self.poses.segments[self.body];
        let apart = 0.5 * (from + to) - center;
        let nearest = apart.dot(&self.velocity) / self.velocity.norm_squared() - self.coming.since;
        let left = (apart - self.way(nearest.clamp(0.0, self.coming.horizon))).norm() - radius;
        left - self.scene.bodies.carried[self.body].reach <= self.coming.margin
    }

    /// The body as the obstacle sees it after `time` (s): moved instead of the obstacle.
    fn seen<T>(&self, time: f64, look: impl FnOnce(&PosedBody<'_>) -> T) -> T {
        let way = self.way(time);
        let carried = &self.scene.bodies.carried[self.body];
        let axis = self.poses.segments[self.body].map(|end| end - way);
        let mut frame = self.poses.frames[carried.stages];
        (0..3).for_each(|k| frame.origin[k] -= way[k]);
        look(&carried.posed(&axis, &frame))
    }

    /// Time (s) and distance (m) of the closest approach; `None` if the obstacle moves away.
    fn closest(&self) -> Option<(f64, f64)> {
        let shape = &self.scene.others.obstacles[self.obstacle].shape;
        let distance = |time: f64| self.seen(time, |body| shape.distance_to_body(body, f64::INFINITY));
        let [mut low, mut high] = [0.0, self.coming.horizon];
        let mut inner = [between(high, low, GOLDEN), between(low, high, GOLDEN)];
        let mut values = inner.map(distance);
        for _ in 0..SECTIONS {
            if values[0] < values[1] {
                high = inner[1];
                inner = [between(high, low, GOLDEN), inner[0]];
                values = [distance(inner[0]), values[0]];
            } else {
                low = inner[0];
                inner = [inner[1], between(low, high, GOLDEN)];
                values = [values[1], distance(inner[1])];
            }
        }
        let nearer = usize::from(values[0] >= values[1]);
        (low > 0.0).then_some((inner[nearer], values[nearer]))
    }

    /// The derivative by the joints of the distance after `time` (s).
    fn gradient(&self, time: f64) -> [f64; MAX_DOF] {
        let shape = &self.scene.others.obstacles[self.obstacle].shape;
        let (point, slope) = self.seen(time, |body| shape.nearest_to_body(body));
        let point = point + self.way(time);
        let mut gradient = [0.0; MAX_DOF];
        for (moved, motion) in self.scene.robot().carriers(self.scene.bodies.carried[self.body].stages, 0) {
            let velocity = motion.velocity(&self.poses.frames[moved], &point.into());
            gradient[motion.joint] += slope.dot(&Vector3::from(velocity));
        }
        gradient
    }
}
