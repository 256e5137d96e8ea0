//! Links that can touch, found by sampling, in the way of MoveIt's setup assistant: neighbours, links that always touch and links
//! that never do are not tested against each other.

use std::collections::HashSet;

use nalgebra::Vector3;

use super::joint::Joint;
use super::model::Robot;
use crate::bodies::CarriedBody;
use crate::kinematics::link_tree::FrameBuffer;
use crate::math::Frame;
use crate::math::arithmetic::NoFma;
use crate::rng;

/// Seed of the random configurations.
const SEED: u64 = 0;
/// Random configurations for links that always touch.
const FEW: usize = 1_000;
/// Random configurations for links that never touch.
const MANY: usize = 10_000;
/// Links that touch in this fraction of all configurations count as always touching.
const ALWAYS: f64 = 0.95;
/// Links never nearer than this (m) count as never touching: rare contacts between samples remain out of reach.
const NEAR: f64 = 0.02;

/// A link with bodies.
struct Carrier {
    link: usize,
    /// Number of the frame that carries it.
    frame: usize,
    bodies: Vec<CarriedBody>,
    /// A ball that holds them.
    center: [f64; 3],
    radius: f64,
}

/// All pairs of links with bodies but these and those that always touch.
pub(super) fn all_but(robot: &Robot, disabled: &[[usize; 2]]) -> Vec<[usize; 2]> {
    let disabled: HashSet<[usize; 2]> = disabled.iter().copied().collect();
    let mut sampling = Sampling::new(robot, |pair| !disabled.contains(&pair));
    sampling.drop_always_touching();
    sampling.links()
}

/// The pairs of links that can touch and be apart.
pub(super) fn that_can_touch(robot: &Robot) -> Vec<[usize; 2]> {
    let neighbours = neighbours(robot);
    let mut sampling = Sampling::new(robot, |pair| !neighbours.contains(&pair));
    sampling.drop_touching_at_rest();
    sampling.drop_always_touching();
    sampling.drop_never_near();
    sampling.links()
}

/// Pairs of links with capsules, between which no other link with capsules lies in the tree.
fn neighbours(robot: &Robot) -> HashSet<[usize; 2]> {
    let mut with_capsules = vec![false; robot.all_link_names().count()];
    robot.links_of_bodies().into_iter().for_each(|link| with_capsules[link] = true);
    // The nearest link with capsules at or above each link; parents come before their children.
    let mut carrier: Vec<Option<usize>> = Vec::with_capacity(with_capsules.len());
    let mut pairs = HashSet::new();
    for (link, has_capsules) in with_capsules.into_iter().enumerate() {
        let above = robot.parent_link(link).and_then(|parent| carrier[parent]);
        if has_capsules && let Some(above) = above {
            pairs.insert([above.min(link), above.max(link)]);
        }
        carrier.push(if has_capsules { Some(link) } else { above });
    }
    pairs
}

/// Pairs of links whose distances are sampled.
struct Sampling<'a> {
    robot: &'a Robot,
    carriers: Vec<Carrier>,
    /// Indices of carriers.
    pairs: Vec<[usize; 2]>,
    frames: FrameBuffer,
}

impl<'a> Sampling<'a> {
    /// The pairs of links on different moving elements that are `wanted`.
    fn new(robot: &'a Robot, wanted: impl Fn([usize; 2]) -> bool) -> Self {
        let carriers = carriers(robot);
        let indices = 0..carriers.len();
        let all = indices.clone().flat_map(|one| (one + 1..indices.end).map(move |other| [one, other]));
        let pairs = all.filter(|[one, other]| {
            let (one, other) = (&carriers[*one], &carriers[*other]);
            one.frame != other.frame && wanted([one.link, other.link])
        });
        Self { robot, pairs: pairs.collect(), frames: robot.frame_buffer(), carriers }
    }

    fn links(&self) -> Vec<[usize; 2]> {
        self.pairs.iter().map(|pair| pair.map(|carrier| self.carriers[carrier].link)).collect()
    }

    fn drop_touching_at_rest(&mut self) {
        let rest: Vec<f64> = self.robot.joints().iter().map(Joint::middle).collect();
        self.robot.write_frames(&rest, &mut self.frames);
        let Self { pairs, carriers, frames, .. } = self;
        pairs.retain(|pair| !nearer(pair.map(|i| &carriers[i]), frames, 0.0));
    }

    fn drop_always_touching(&mut self) {
        let mut touching = vec![0_usize; self.pairs.len()];
        for q in self.configurations(FEW, 0) {
            self.robot.write_frames(&q, &mut self.frames);
            for (count, pair) in touching.iter_mut().zip(&self.pairs) {
                *count += usize::from(nearer(pair.map(|i| &self.carriers[i]), &self.frames, 0.0));
            }
        }
        let most = (ALWAYS * FEW as f64) as usize;
        let mut touching = touching.into_iter();
        self.pairs.retain(|_| touching.next().is_some_and(|count| count < most));
    }

    fn drop_never_near(&mut self) {
        let mut apart = self.pairs.clone();
        for q in self.configurations(MANY, 1) {
            self.robot.write_frames(&q, &mut self.frames);
            apart.retain(|pair| !nearer(pair.map(|i| &self.carriers[i]), &self.frames, NEAR));
        }
        let apart: HashSet<[usize; 2]> = apart.into_iter().collect();
        self.pairs.retain(|pair| !apart.contains(pair));
    }

    /// Random configurations between the limits, drawn as they are needed.
    fn configurations(&self, count: usize, stream: u64) -> impl Iterator<Item = Vec<f64>> + use<> {
        let ranges: Vec<(f64, f64)> = self.robot.joints().iter().map(Joint::sampling_range).collect();
        let mut rng = rng::stream(SEED, stream);
        (0..count).map(move |_| ranges.iter().map(|(lower, upper)| rng.uniform_in(*lower, *upper)).collect())
    }
}

/// The links with capsules, in the order of the links.
fn carriers(robot: &Robot) -> Vec<Carrier> {
    let mut on_link: Vec<Vec<CarriedBody>> = robot.all_link_names().map(|_| vec![]).collect();
    for (body, link) in robot.carried_bodies().into_iter().zip(robot.links_of_bodies()) {
        on_link[link].push(body);
    }
    let with_bodies = on_link.into_iter().enumerate().filter(|(_, bodies)| !bodies.is_empty());
    with_bodies
        .map(|(link, bodies)| {
            let ends = || bodies.iter().flat_map(|body| body.ends.map(|end| (Vector3::from(end), body.radius)));
            let center = ends().map(|(end, _)| end).sum::<Vector3<f64>>() / ends().count() as f64;
            let radius = ends().map(|(end, radius)| (end - center).norm() + radius).fold(0.0, f64::max);
            Carrier { link, frame: robot.carrier_of_link_number(link).0, bodies, center: center.into(), radius }
        })
        .collect()
}

/// Whether two links are nearer than `distance` (m), or at most as near if it is zero.
fn nearer([one, other]: [&Carrier; 2], frames: &[Frame], distance: f64) -> bool {
    let (frame, other_frame) = (&frames[one.frame], &frames[other.frame]);
    let [center, other_center] =
        [frame.transform::<NoFma>(&one.center), other_frame.transform::<NoFma>(&other.center)].map(Vector3::from);
    if (center - other_center).norm() > one.radius + other.radius + distance {
        return false;
    }
    one.bodies.iter().any(|body| {
        let axis = body.axis_at(frame);
        other.bodies.iter().any(|other| {
            let other_axis = other.axis_at(other_frame);
            let (body, other) = (body.posed(&axis, frame), other.posed(&other_axis, other_frame));
            body.distance_to(&other, distance.next_up()) <= distance
        })
    })
}
