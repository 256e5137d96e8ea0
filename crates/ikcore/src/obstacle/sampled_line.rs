//! Collision check of straight lines in joint space at closely spaced configurations, eight of them in the registers: for searches,
//! whose results are certified afterwards.
//!
//! The first eight span the whole line. They list the pairs of bodies that may meet anywhere on it; the others test only these.

use super::eight_scene::{EightScene, Near, Visitor};
use super::scene::Scene;
use crate::bodies::BodyPair;
use crate::math::arithmetic::{Arithmetic, by_instructions};
use crate::objective::Point;

/// First spacing of configurations: no body moves farther from one to the next (m), by a bound two to three times too large.
const SPACING: f64 = 0.08;

/// Fraction of the bound that bodies move at most.
const SLACK: f64 = 0.6;

/// Number of pairs that are tested first, since they met before.
const LIKELY: usize = 24;

/// Checks lines in a scene; owns its scratch.
#[derive(Debug)]
pub struct SampledLine<'a> {
    eight: EightScene<'a>,
    margin: f64,
    spacing: f64,
    /// Pairs that may meet on the line.
    pending: Vec<BodyPair>,
    /// The pairs that met last, the latest first.
    likely: Vec<BodyPair>,
    examined: usize,
}

impl<'a> SampledLine<'a> {
    /// Checker of lines that keep `margin` >= 0 (m) in `scene`, but for rounding.
    pub fn new(scene: &'a Scene<'a>, margin: f64) -> Self {
        Self { eight: EightScene::new(scene), margin, spacing: SPACING, pending: vec![], likely: vec![], examined: 0 }
    }

    /// Keeps more: `margin` >= 0 (m), at configurations that are half as far apart.
    pub fn be_stricter(&mut self, margin: f64) {
        (self.margin, self.spacing) = (margin, 0.5 * self.spacing);
    }

    /// Number of configurations examined.
    pub fn examined(&self) -> usize {
        self.examined
    }

    /// Whether everything is clear on the way from `from` to `to`, and there; `from` is known to be clear.
    pub fn is_clear(&mut self, from: &[f64], to: &[f64]) -> bool {
        is_clear(self, from, to)
    }

    #[inline(always)]
    fn examine<A: Arithmetic>(&mut self, from: &[f64], to: &[f64]) -> bool {
        let mut reach: Point = from.iter().zip(to).map(|(from, to)| (to - from).abs()).collect();
        let blocks = (self.eight.farthest(&reach) / (8.0 * self.spacing)).ceil().max(1.0) as usize;
        // Every configuration of the line is within half an eighth of one of the first eight.
        reach.iter_mut().for_each(|reach| *reach *= SLACK / 16.0);
        let first = blocks / 2;
        self.pose::<A>(from, to, first, blocks);
        if !self.first_block::<A>(&reach) {
            return false;
        }
        for block in (0..blocks).filter(|block| *block != first) {
            if self.pending.is_empty() {
                return true;
            }
            self.pose::<A>(from, to, block, blocks);
            for i in 0..self.pending.len() {
                let pair = self.pending[i];
                if self.eight.meet::<A>(pair, self.margin) {
                    note_hit(&mut self.likely, pair);
                    return false;
                }
            }
        }
        true
    }

    /// Poses everything at entry `block` of `blocks` configurations in each eighth of the line.
    #[inline(always)]
    fn pose<A: Arithmetic>(&mut self, from: &[f64], to: &[f64], block: usize, blocks: usize) {
        let fraction = |lane: usize| (lane * blocks + block + 1) as f32 / (8 * blocks) as f32;
        self.eight.pose_along::<A>([from, to], std::array::from_fn(fraction));
        self.examined += 8;
    }

    /// Tests everything at the configurations, and lists the pairs that may meet between them.
    #[inline(always)]
    fn first_block<A: Arithmetic>(&mut self, reach: &[f64]) -> bool {
        let Self { eight, margin, pending, likely, .. } = self;
        pending.clear();
        for i in 0..likely.len() {
            if eight.meet::<A>(likely[i], *margin) {
                likely[..=i].rotate_right(1);
                return false;
            }
        }
        eight.each_near::<A>(*margin, reach, &mut UntilHit { margin: *margin, pending, likely })
    }
}

/// Lists near pairs until one meets.
struct UntilHit<'v> {
    margin: f64,
    pending: &'v mut Vec<BodyPair>,
    likely: &'v mut Vec<BodyPair>,
}

impl Visitor for UntilHit<'_> {
    #[inline(always)]
    fn goes_on<A: Arithmetic>(&mut self, near: &mut Near<'_, '_>, pair: BodyPair, _lanes: u32) -> bool {
        let meets = near.meet::<A>(pair, self.margin);
        if meets {
            note_hit(self.likely, pair);
        } else {
            self.pending.push(pair);
        }
        !meets
    }
}

/// Remembers a pair that is not among the likely ones.
fn note_hit(likely: &mut Vec<BodyPair>, pair: BodyPair) {
    likely.truncate(LIKELY - 1);
    likely.insert(0, pair);
}

by_instructions! {
    fn is_clear(check: &mut SampledLine<'_>, from: &[f64], to: &[f64]) -> bool {
        check.examine::<A>(from, to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::arithmetic::NoFma;
    use crate::rng::{self, LazyRng};
    use crate::robot::Robot;
    use crate::shape::Shape;

    /// One shape of each kind, near the arm but for its first links.
    fn shapes(rng: &mut LazyRng) -> Vec<Shape> {
        let mut place = || -> [f64; 3] {
            let at = [rng.uniform_in(0.4, 0.9), rng.uniform_in(-0.6, 0.6), rng.uniform_in(0.1, 1.0)];
            if rng.uniform() < 0.5 { at } else { at.map(|x| -x) }
        };
        let cloud: Vec<[f64; 3]> = (0..40).map(|_| place()).collect();
        let turn = Some(*nalgebra::Rotation3::new(nalgebra::Vector3::new(0.3, -0.8, 0.5)).matrix());
        let shapes = [
            Shape::sphere(place(), 0.1),
            Shape::capsule(place(), place(), 0.05),
            Shape::cuboid(place(), [0.1, 0.3, 0.2], turn),
            Shape::cylinder(place(), place(), 0.06, 0.4),
            Shape::half_space([0.0, 0.0, 1.0], -0.1),
            Shape::ellipsoid(place(), [0.1, 0.2, 0.15], turn),
            Shape::point_cloud(cloud, 0.01),
        ];
        shapes.into_iter().map(Result::unwrap).collect()
    }

    fn robots() -> Vec<Robot> {
        let panda = Robot::named("panda").unwrap().with_capsules_along_links(0.05).unwrap();
        let tool = Shape::cuboid([0.0, 0.0, 0.1], [0.1, 0.04, 0.2], None).unwrap();
        let holding = panda.with_attached("flange", &tool, &[], None).unwrap();
        vec![panda, holding]
    }

    #[test]
    fn one_configuration_is_clear_when_its_distances_say_so() {
        let mut rng = rng::stream(1, 0);
        let (mut clear, mut near) = (0, 0);
        for robot in robots() {
            for _ in 0..40 {
                let obstacles = shapes(&mut rng);
                let scene = Scene::new(&robot, &obstacles).unwrap();
                let margin = rng.uniform_in(0.0, 0.03);
                let mut check = SampledLine::new(&scene, margin);
                for _ in 0..40 {
                    let q = robot.random_configurations(1, &mut rng).unwrap();
                    let distance = scene.clearance(&q).unwrap();
                    let verdict = check.is_clear(&q, &q);
                    assert!(
                        (distance - margin).abs() < 1e-4 || verdict == (distance > margin),
                        "{distance} of {margin}"
                    );
                    *(if verdict { &mut clear } else { &mut near }) += 1;
                }
            }
        }
        assert!(clear > 300 && near > 300, "{clear} {near}");
    }

    #[test]
    fn lines_are_refused_for_what_is_near_them_on_any_machine() {
        let mut rng = rng::stream(2, 0);
        let (mut clear, mut refused) = (0, 0);
        for robot in robots() {
            for _ in 0..30 {
                let obstacles = shapes(&mut rng);
                let scene = Scene::new(&robot, &obstacles).unwrap();
                let mut check = SampledLine::new(&scene, 0.01);
                for _ in 0..20 {
                    let from = robot.random_configurations(1, &mut rng).unwrap();
                    if !scene.is_clear(&from, 0.01) {
                        continue;
                    }
                    let to: Vec<f64> = from.iter().map(|q| q + rng.uniform_in(-0.6, 0.6)).collect();
                    let verdict = check.is_clear(&from, &to);
                    let at = |i: usize| -> Vec<f64> {
                        from.iter().zip(&to).map(|(from, to)| from + i as f64 / 300.0 * (to - from)).collect()
                    };
                    let least = (0..=300).map(|i| scene.clearance(&at(i)).unwrap()).fold(f64::INFINITY, f64::min);
                    // Between two of its configurations a body may come nearer by half of what it moves.
                    let missed = if verdict { 0.01 - 0.5 * SPACING } else { f64::NEG_INFINITY };
                    assert!(least > missed && (verdict || least < 0.0101), "{verdict}: {least}");
                    assert_eq!(check.examine::<NoFma>(&from, &to), verdict, "{least}");
                    *(if verdict { &mut clear } else { &mut refused }) += 1;
                }
            }
        }
        assert!(clear > 100 && refused > 100, "{clear} {refused}");
    }
}
