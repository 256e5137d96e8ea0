//! Arms of a robot with several tips: the elements that move one tip alone, as a robot of its own. Starts of searches come from them.

use smallvec::SmallVec;

use super::description::{Description, Element};
use super::model::{Robot, TipArm};
use crate::closed_form::ArmConfigurations;
use crate::math::Frame;
use crate::rng::LazyRng;

/// Values of the parameter of a redundant arm that are tried for a start.
const SCANNED: usize = 32;

/// Values that later attempts begin at.
const BEGINNINGS: usize = 16;

/// Starts of the index that are taken; later attempts begin anywhere.
const STARTS: usize = 8;

/// Choice among several configurations.
pub(crate) struct Choice<'a> {
    /// Position limits of the whole robot (rad, m).
    pub lower: &'a [f64],
    pub upper: &'a [f64],
    /// 0 takes the most central one, later attempts others.
    pub attempt: usize,
    pub rng: &'a mut LazyRng,
}

impl Robot {
    /// The arm that moves tip number `tip` alone; None for a tip that no joint moves alone, and for the tip of a robot with one.
    pub(crate) fn arm(&self, tip: usize) -> Option<&TipArm> {
        let arms = || self.tip_chains().chains.iter().map(|chain| arm(self, &chain.own)).collect();
        self.found_arms().get_or_init(arms).get(tip)?.as_ref()
    }
}

/// The arm of these elements.
fn arm(robot: &Robot, own: &[Element]) -> Option<TipArm> {
    let mut joints: Vec<usize> = vec![];
    let mut elements = vec![Element::Link(String::new())];
    for element in own {
        let mut element = element.clone();
        // A rotation vector is that of the base, which all tips share.
        if let Element::Moving { joint, .. } | Element::Curved { joint, .. } = &mut element {
            let known = joints.iter().position(|known| known == joint);
            let number = known.unwrap_or(joints.len());
            if known.is_none() {
                joints.push(*joint);
            }
            *joint = number;
        }
        elements.push(element);
    }
    let described = joints.iter().map(|joint| robot.joints()[*joint].clone()).collect();
    let robot = Robot::new(Description { name: robot.name().into(), joints: described, elements }).ok()?;
    Some(TipArm { robot, joints })
}

impl TipArm {
    /// Writes a configuration of its joints, with the tip at or near `pose` as seen from the end of the stem, into `q` of the whole
    /// robot; false where none is known.
    pub fn start_at_pose(&self, pose: &Frame, choice: &mut Choice<'_>, q: &mut [f64]) -> bool {
        let [lower, upper] = self.limits(choice);
        if self.robot.solves_at_once() == Some(true) {
            let mut found = ArmConfigurations::none();
            match self.robot.family(pose) {
                None => self.robot.likely_branches(pose, &mut found),
                Some(family) => {
                    let limits = family.limits(&lower, &upper);
                    let arcs = family.arcs(&limits);
                    for value in arcs.scattered(SCANNED + BEGINNINGS).skip(choice.attempt % BEGINNINGS) {
                        family.likely_at(value, &limits, &mut found);
                        if self.write_one_of(&found, [&lower, &upper], choice, q) {
                            return true;
                        }
                    }
                    return false;
                }
            }
            return self.write_one_of(&found, [&lower, &upper], choice, q);
        }
        let mut starts = self.robot.starts_near_pose(pose);
        self.write_start(|own| starts.write_next(&lower, &upper, own), choice, q)
    }

    /// A start with the tip near `position` (m), at any orientation.
    pub fn start_at_position(&self, position: &[f64; 3], choice: &mut Choice<'_>, q: &mut [f64]) -> bool {
        let [lower, upper] = self.limits(choice);
        let mut starts = self.robot.starts_near_position(position);
        self.write_start(|own| starts.write_next(&lower, &upper, own), choice, q)
    }

    /// The limits of its joints, finite.
    fn limits(&self, choice: &Choice<'_>) -> [Own; 2] {
        let ranges = self.joints.iter().zip(self.robot.joints());
        let ranges = ranges.map(|(j, joint)| joint.sampling_range_within(choice.lower[*j], choice.upper[*j]));
        let (lower, upper): (Own, Own) = ranges.unzip();
        [lower, upper]
    }

    /// Writes one of `found` that is inside the limits: the most central one, or in later attempts any.
    fn write_one_of(
        &self,
        found: &ArmConfigurations,
        [lower, upper]: [&[f64]; 2],
        choice: &mut Choice<'_>,
        q: &mut [f64],
    ) -> bool {
        let mut best: Option<(f64, Own)> = None;
        for place in 0..found.len() {
            let values = found.columns().iter().enumerate().map(|(j, values)| {
                let (value, period) = (values[place], self.robot.turn_period(j));
                let turns = |period: f64| period * ((lower[j] - value).max(0.0) / period).ceil();
                let back = |period: f64| period * ((value - upper[j]).max(0.0) / period).ceil();
                period.map_or(value, |period| value + turns(period) - back(period))
            });
            let own: Own = values.collect();
            if !own.iter().zip(lower).zip(upper).all(|((q, lower), upper)| lower <= q && q <= upper) {
                continue;
            }
            let off = |j: usize| ((own[j] - lower[j]) / (upper[j] - lower[j]) - 0.5).powi(2);
            let cost = match choice.attempt {
                0 => (0..own.len()).map(off).sum(),
                _ => choice.rng.uniform_in(0.0, 1.0),
            };
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, own));
            }
        }
        let Some((_, own)) = best else { return false };
        self.write(&own, q);
        true
    }

    /// Writes one of the next starts: the first one, or in later attempts another.
    fn write_start(&self, mut next: impl FnMut(&mut [f64]) -> bool, choice: &Choice<'_>, q: &mut [f64]) -> bool {
        let mut own = Own::from_elem(0.0, self.joints.len());
        if choice.attempt < STARTS && (0..=choice.attempt).all(|_| next(&mut own)) {
            self.write(&own, q);
        }
        // Otherwise the joints stay where they were drawn.
        true
    }

    fn write(&self, own: &[f64], q: &mut [f64]) {
        for (joint, value) in self.joints.iter().zip(own) {
            q[*joint] = *value;
        }
    }
}

/// Values of the arm's joints.
type Own = SmallVec<[f64; 8]>;
