//! Whole motions, certified to keep a margin at every instant, and their smallest clearance.
//!
//! A motion is divided until its bodies move little. Eight configurations of each part, in single precision, list the pairs of bodies
//! that may come near; few do. Those are certified in double precision. No step width has to be chosen, and no collision can be
//! missed between two samples.

use super::contact::Contact;
use super::eight_scene::{EightScene, Near, Visitor};
use super::joint_motion::JointMotion;
use super::motion_certificate::MotionCertificate;
use super::required_distance::RequiredDistance;
use super::scene::Scene;
use crate::bodies::{BodyPair, BodyPoses};
use crate::math::MAX_DOF;
use crate::math::arithmetic::{Arithmetic, by_instructions};
use crate::objective::Point;

/// The point at which a motion comes too near to a body.
#[derive(Debug, Clone, PartialEq)]
pub struct TooNear {
    /// The motion's parameter.
    pub at: f64,
    /// The two bodies.
    pub contact: Contact,
}

/// No body moves farther than this (m) from one of the eight configurations of a part, by a bound.
const REACH: f64 = 0.06;

/// All eighths of a part.
const ALL: u32 = 0xff;

/// Parts are not divided more often.
const MOST_DIVISIONS: usize = 24;

/// Intervals in which the smallest distance is looked for are not halved more often: time rounds to no less.
const MOST_HALVINGS: usize = 52;

/// Checks motions in a scene; owns its scratch.
#[derive(Debug)]
pub struct ClearanceSweep<'a> {
    scene: &'a Scene<'a>,
    eight: EightScene<'a>,
    chords: MotionCertificate,
    /// Pairs that may be near in a part, and the eighths of it in which they may.
    near: Vec<(BodyPair, u32)>,
    pending: Vec<BodyPair>,
    poses: BodyPoses,
    examined: usize,
}

/// A part of a motion.
struct Part {
    /// Configurations at both ends.
    from: Point,
    to: Point,
    /// Deviation of each joint from the straight line.
    off_line: Point,
}

impl Part {
    fn of(motion: &impl JointMotion, [begin, end]: [f64; 2], joints: usize) -> Self {
        let [mut from, mut to, mut off_line] = [(); 3].map(|()| Point::from_elem(0.0, joints));
        motion.write(begin, &mut from);
        motion.write(end, &mut to);
        motion.write_off_line(begin, end, &mut off_line);
        Self { from, to, off_line }
    }

    /// Largest distance of each joint from the middle of the nearest eighth of the straight line.
    fn reach(&self) -> Point {
        let along = self.from.iter().zip(&self.to).map(|(from, to)| (to - from).abs() / 16.0);
        along.zip(&self.off_line).map(|(along, off_line)| along + off_line).collect()
    }

    /// The largest joint value on it.
    fn largest(&self) -> f64 {
        let ends = self.from.iter().chain(&self.to).fold(0.0, |largest: f64, q| largest.max(q.abs()));
        ends + self.off_line.iter().copied().fold(0.0, f64::max)
    }
}

impl<'a> ClearanceSweep<'a> {
    /// A checker for any number of motions in `scene`.
    pub fn new(scene: &'a Scene<'a>) -> Self {
        Self {
            scene,
            eight: EightScene::new(scene),
            chords: MotionCertificate::new(scene),
            near: vec![],
            pending: vec![],
            poses: scene.pose_buffer(),
            examined: 0,
        }
    }

    /// The scene.
    pub fn scene(&self) -> &'a Scene<'a> {
        self.scene
    }

    /// Number of configurations examined.
    pub fn examined(&self) -> usize {
        self.examined
    }

    /// Certifies that all pairs stay at least `margin` (m) apart on the motion over \[`from`, `to`\], between samples too. An error if
    /// one does not, or exceeds the margin by too little to tell.
    ///
    /// # Errors
    /// [`TooNear`]: the first such place.
    pub fn check(&mut self, motion: &impl JointMotion, [from, to]: [f64; 2], margin: f64) -> Result<(), Box<TooNear>> {
        if let Some((distance, pair)) = self.scene.fixed()
            && distance < margin
        {
            return Err(Box::new(TooNear { at: from, contact: self.scene.contact(pair, distance) }));
        }
        self.check_part(motion, [from, to], margin, 0)
    }

    fn check_part(
        &mut self,
        motion: &impl JointMotion,
        ends: [f64; 2],
        margin: f64,
        divisions: usize,
    ) -> Result<(), Box<TooNear>> {
        let part = Part::of(motion, ends, self.scene.robot().dof());
        let reach = part.reach();
        if divisions < MOST_DIVISIONS
            && self.eight.farthest(&reach) > REACH
            && let Some(middle) = motion.middle(ends[0], ends[1])
        {
            self.check_part(motion, [ends[0], middle], margin, divisions + 1)?;
            return self.check_part(motion, [middle, ends[1]], margin, divisions + 1);
        }
        self.near.clear();
        if self.eight.covers(&part.from, &part.off_line) && self.eight.covers(&part.to, &part.off_line) {
            find_near(self, &part, &reach, margin);
        } else {
            self.near.extend(self.scene.pairs().map(|pair| (pair, ALL)));
        }
        let kept = RequiredDistance::constant(margin);
        let at = |eighth: usize| ends[0] + (ends[1] - ends[0]) * eighth as f64 / 8.0;
        for eighth in (0..8).filter(|eighth| self.near.iter().any(|(_, lanes)| lanes & (1 << eighth) != 0)) {
            let pairs = self.near.iter().filter(|(_, lanes)| lanes & (1 << eighth) != 0).map(|(pair, _)| *pair);
            let checked = self.chords.check(self.scene, motion, [at(eighth), at(eighth + 1)], pairs, &kept);
            if let Err(blocker) = checked {
                self.pose(motion, blocker.at, blocker.at);
                let distance = self.scene.distance(blocker.pair, &self.poses, f64::INFINITY);
                let contact = self.scene.contact(blocker.pair, distance);
                return Err(Box::new(TooNear { at: blocker.at, contact }));
            }
        }
        Ok(())
    }

    /// Lists the pairs that may come nearer than `margin` in a part.
    #[inline(always)]
    fn find_near<A: Arithmetic>(&mut self, part: &Part, reach: &[f64], margin: f64) {
        let fraction = |lane: usize| (lane as f32 + 0.5) / 8.0;
        self.eight.pose_along::<A>([&part.from, &part.to], std::array::from_fn(fraction));
        self.examined += 8;
        let rounding = self.eight.rounding(part.largest());
        self.eight.each_near::<A>(margin + rounding, reach, &mut All(&mut self.near));
    }

    /// The smallest distance (m) on the motion over \[`from`, `to`\], and where it occurs: a certified lower bound, at
    /// most 0.1 mm or 1 % below the true value. `None` if nothing can touch.
    pub fn smallest(&mut self, motion: &impl JointMotion, [from, to]: [f64; 2]) -> Option<TooNear> {
        self.pending.clear();
        self.pending.extend(self.scene.pairs());
        let mut best = match (self.scene.fixed(), self.pending.first()) {
            (Some((distance, pair)), _) => Best { seen: distance, proven: distance, at: from, pair },
            (None, Some(first)) => Best { seen: f64::INFINITY, proven: f64::INFINITY, at: from, pair: *first },
            (None, None) => return None,
        };
        // A good first guess makes most of the motion quick to rule out.
        for i in 0..=FIRST_SAMPLES {
            let t = from + (to - from) * i as f64 / FIRST_SAMPLES as f64;
            self.pose(motion, t, t);
            for i in 0..self.pending.len() {
                let pair = self.pending[i];
                best.offer(self.scene.distance(pair, &self.poses, best.seen), t, pair);
            }
        }
        self.narrow(motion, ([from, to], MOST_HALVINGS), &mut best, self.pending.len());
        let contact = self.scene.contact(best.pair, best.proven.min(best.seen));
        Some(TooNear { at: best.at, contact })
    }

    /// Narrows down where the first `count` pending pairs come nearest, in an interval that may be halved so often.
    fn narrow(
        &mut self,
        motion: &impl JointMotion,
        ([from, to], halvings): ([f64; 2], usize),
        best: &mut Best,
        count: usize,
    ) {
        let reach = self.pose(motion, from, to);
        let middle = 0.5 * (from + to);
        let mut left = 0;
        for i in 0..count {
            let pair = self.pending[i];
            let change = self.scene.change(pair, &self.poses, &reach);
            let distance = self.scene.distance(pair, &self.poses, best.seen + change);
            best.offer(distance, middle, pair);
            let bound = distance - change;
            if halvings == 0 || bound >= best.seen - best.slack() {
                best.proven = best.proven.min(bound);
            } else {
                self.pending.swap(i, left);
                left += 1;
            }
        }
        if left > 0 {
            self.narrow(motion, ([from, middle], halvings - 1), best, left);
            self.narrow(motion, ([middle, to], halvings - 1), best, left);
        }
    }

    /// Poses everything in the middle of an interval; returns how far each joint is from there at most.
    fn pose(&mut self, motion: &impl JointMotion, from: f64, to: f64) -> Point {
        let n = self.scene.robot().dof();
        let mut middle = [0.0; MAX_DOF];
        motion.write(0.5 * (from + to), &mut middle[..n]);
        self.scene.write_poses(&middle[..n], &mut self.poses);
        self.examined += 1;
        let part = Part::of(motion, [from, to], n);
        // The middle may be off the straight line too.
        let half = part.from.iter().zip(&part.to).map(|(from, to)| 0.5 * (to - from).abs());
        half.zip(&part.off_line).map(|(half, off_line)| half + 2.0 * off_line).collect()
    }
}

/// Lists near pairs.
struct All<'v>(&'v mut Vec<(BodyPair, u32)>);

impl Visitor for All<'_> {
    #[inline(always)]
    fn goes_on<A: Arithmetic>(&mut self, _near: &mut Near<'_, '_>, pair: BodyPair, lanes: u32) -> bool {
        self.0.push((pair, lanes));
        true
    }
}

by_instructions! {
    fn find_near(sweep: &mut ClearanceSweep<'_>, part: &Part, reach: &[f64], margin: f64) {
        sweep.find_near::<A>(part, reach, margin);
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

    /// Tolerance of the answer: it may lie below the truth by this (m).
    fn slack(&self) -> f64 {
        1e-4_f64.max(0.01 * self.seen.abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::obstacle::Edge;
    use crate::robot::Robot;
    use crate::shape::Shape;

    const GANTRY: &str = r#"<robot name="gantry"><link name="base"/><link name="arm"/><link name="rod"/>
        <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/></joint>
        <joint name="slide" type="prismatic"><parent link="arm"/><child link="rod"/><axis xyz="1 0 0"/>
        <limit lower="0" upper="1" velocity="1" effort="1"/></joint><link name="tip"/><joint name="end" type="fixed">
        <parent link="rod"/><child link="tip"/><origin xyz="0.5 0 0"/></joint></robot>"#;

    #[test]
    fn a_rod_far_outside_its_range_is_certified_no_less() {
        let robot = Robot::from_urdf(GANTRY, None, None).unwrap().with_capsules_along_links(0.005).unwrap();
        // The rod, 50 m away, passes the ball between two of eight configurations of a turn that moves it by 0.5 m.
        let obstacles = [Shape::sphere([50.2, 0.0, 0.0], 0.005).unwrap()];
        let scene = Scene::new(&robot, &obstacles).unwrap();
        let (from, to) = ([-0.0051, 50.0], [0.0049, 50.0]);
        assert!(scene.clearance(&from).unwrap() > 0.1 && scene.clearance(&to).unwrap() > 0.1);
        assert!(ClearanceSweep::new(&scene).check(&Edge { from: &from, to: &to }, [0.0, 1.0], 0.001).is_err());
    }
}
