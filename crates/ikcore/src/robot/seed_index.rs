//! Configurations to start from, found by where they bring the tip.
//!
//! A turn of the first joint carries the arm round its first axis, and a turn of the last joint only spins the flange:
//! neither changes what the arm between them has to do. Both are taken out before configurations are compared with a
//! target and set in closed form afterwards, so that for most arms four dimensions are to be covered instead of six, and
//! a few thousand configurations lie close.

use std::f64::consts::TAU;

use super::Joint;
use super::chain::{Chain, Motion};
use crate::math::Frame;
use crate::math::arithmetic::Separate;
#[cfg(target_arch = "x86_64")]
use crate::math::arithmetic::has_fused;
use crate::rng;

/// Configurations stored.
const SIZE: usize = 2048;

/// Configurations compared side by side, and starts that a search returns.
pub(super) const LANES: usize = 8;

/// Metres that count as much as a change of one in an axis of unit length.
const AXIS_WEIGHT: f64 = 0.3;

/// Position, z axis and x axis of a reduced frame.
const FEATURES: usize = 9;

/// Random configurations of one robot within its limits, with the frames they reach. It knows neither base nor tool:
/// frames are those of the last joint seen from the first.
#[derive(Debug)]
pub(super) struct SeedIndex {
    dof: usize,
    first: Option<Turn>,
    last: Option<Turn>,
    configurations: Vec<f64>,
    frames: Vec<Frame>,
    /// For every eight configurations the rows of their features that tell them apart, lane by lane.
    blocks: Vec<[f32; LANES]>,
    /// Which features these are.
    compared: Vec<usize>,
}

/// A joint that turns one stage and nothing else, by `scale` a unit.
#[derive(Debug, Clone, Copy)]
struct Turn {
    joint: usize,
    scale: f64,
}

impl SeedIndex {
    /// The first `moving` stages of `chain` are no padding; it has neither base nor tool.
    pub fn new(chain: &Chain, moving: usize, joints: &[Joint]) -> Self {
        let dof = joints.len();
        let motions = &chain.motions[..moving];
        let first = Turn::of(motions, 0);
        let last = if moving > 1 { Turn::of(motions, moving - 1) } else { None };
        let rng = &mut rng::stream(0, 0);
        let mut configurations = Vec::with_capacity(SIZE * dof);
        for _ in 0..SIZE {
            configurations.extend(joints.iter().map(|joint| {
                let (lower, upper) = joint.sampling_range();
                rng.uniform_in(lower, upper)
            }));
        }
        let frames: Vec<Frame> =
            configurations.chunks_exact(dof).map(|q| between_joints(chain, &chain.tip(q))).collect();
        let mut index = Self { dof, first, last, configurations, frames, blocks: vec![], compared: vec![] };
        index.compared = index.distinguishing_features();
        index.blocks = index.frames.chunks_exact(LANES).flat_map(|lanes| index.block(lanes)).collect();
        index
    }

    fn distinguishing_features(&self) -> Vec<usize> {
        // The azimuth is taken out by the first joint, the x axis by the last.
        let redundant = |feature: &usize| {
            (self.first.is_some() && *feature == 1) || (self.last.is_some() && *feature >= 6)
        };
        (0..FEATURES).filter(|feature| !redundant(feature)).collect()
    }

    fn block(&self, lanes: &[Frame]) -> Vec<[f32; LANES]> {
        let features: Vec<_> = lanes.iter().map(|frame| self.features(frame)).collect();
        self.compared.iter().map(|row| std::array::from_fn(|lane| features[lane][*row])).collect()
    }

    fn features(&self, frame: &Frame) -> [f32; FEATURES] {
        let turned = match self.first {
            // Onto azimuth zero.
            Some(_) => {
                let [x, y, _] = frame.origin;
                let radius = x.hypot(y).max(f64::MIN_POSITIVE);
                turned_about_base_z(frame, -y / radius, x / radius)
            }
            None => *frame,
        };
        let ([p, z, x], w) = ([turned.origin, turned.axes[2], turned.axes[0]], AXIS_WEIGHT);
        [p[0], p[1], p[2], w * z[0], w * z[1], w * z[2], w * x[0], w * x[1], w * x[2]].map(|v| v as f32)
    }

    /// The nearest of each eighth of the index, the nearest of all first.
    pub fn nearest(&self, wanted: &Frame) -> [usize; LANES] {
        let features = self.features(wanted);
        let mut rows = [0.0; FEATURES];
        for (row, feature) in rows.iter_mut().zip(&self.compared) {
            *row = features[*feature];
        }
        let (distances, blocks) = nearest_by_lane(&self.blocks, &rows[..self.compared.len()]);
        let mut lanes: [usize; LANES] = std::array::from_fn(|lane| lane);
        lanes.sort_by(|a, b| distances[*a].total_cmp(&distances[*b]));
        lanes.map(|lane| blocks[lane] as usize * LANES + lane)
    }

    /// Writes configuration `entry` into `q`, first and last joint turned towards the frame `wanted`. `ranges` are finite.
    pub fn adapted(&self, entry: usize, wanted: &Frame, range: impl Fn(usize) -> (f64, f64), q: &mut [f64]) {
        q.copy_from_slice(&self.configurations[entry * self.dof..(entry + 1) * self.dof]);
        let mut frame = self.frames[entry];
        if let Some(turn) = self.first {
            let angle = turn_about_base_z(&frame, wanted, self.last.is_none());
            q[turn.joint] = turn.moved_by(angle, q[turn.joint], range(turn.joint));
            let (sine, cosine) = angle.sin_cos();
            frame = turned_about_base_z(&frame, sine, cosine);
        }
        if let Some(turn) = self.last {
            let angle = turn_about_own_z(&frame, wanted);
            q[turn.joint] = turn.moved_by(angle, q[turn.joint], range(turn.joint));
        }
        for (i, value) in q.iter_mut().enumerate() {
            let (lower, upper) = range(i);
            *value = value.clamp(lower, upper);
        }
    }
}

impl Turn {
    fn of(motions: &[Motion], stage: usize) -> Option<Self> {
        let Motion { joint, turn_scale: scale, .. } = motions[stage];
        let alone = motions.iter().filter(|motion| motion.joint == joint).count() == 1;
        (alone && scale != 0.0).then_some(Self { joint, scale })
    }

    /// `q` moved by a turn of `angle`, give or take whole turns that bring it nearest to the middle of its range.
    fn moved_by(&self, angle: f64, q: f64, (lower, upper): (f64, f64)) -> f64 {
        let (moved, period) = (q + angle / self.scale, TAU / self.scale.abs());
        moved - period * ((moved - 0.5 * (lower + upper)) / period).round()
    }
}

/// From the axis of the first joint to that of the last, when the tip of `chain` is at `tip`.
pub(super) fn between_joints(chain: &Chain, tip: &Frame) -> Frame {
    chain.stages[0].inverse().then::<Separate>(tip).then::<Separate>(&chain.tip.inverse())
}

fn turned_about_base_z(frame: &Frame, sine: f64, cosine: f64) -> Frame {
    let turned = |v: [f64; 3]| [cosine * v[0] - sine * v[1], sine * v[0] + cosine * v[1], v[2]];
    Frame { axes: frame.axes.map(turned), origin: turned(frame.origin) }
}

/// The turn about the base's z axis (rad) that brings `frame` nearest to `wanted`, position and z axis; the x axis too
/// where `all_axes`.
fn turn_about_base_z(frame: &Frame, wanted: &Frame, all_axes: bool) -> f64 {
    let weight = AXIS_WEIGHT * AXIS_WEIGHT;
    let mut pairs = vec![(1.0, frame.origin, wanted.origin), (weight, frame.axes[2], wanted.axes[2])];
    if all_axes {
        pairs.push((weight, frame.axes[0], wanted.axes[0]));
    }
    let (mut sine, mut cosine) = (0.0, 0.0);
    for (weight, from, to) in pairs {
        sine += weight * (from[0] * to[1] - from[1] * to[0]);
        cosine += weight * (from[0] * to[0] + from[1] * to[1]);
    }
    f64::atan2(sine, cosine)
}

/// The turn of `frame` about its own z axis (rad) that brings its x and y axes nearest to those of `wanted`.
fn turn_about_own_z(frame: &Frame, wanted: &Frame) -> f64 {
    let dot = |i: usize, j: usize| -> f64 { (0..3).map(|k| frame.axes[i][k] * wanted.axes[j][k]).sum() };
    f64::atan2(dot(1, 0) - dot(0, 1), dot(0, 0) + dot(1, 1))
}

/// For every lane the smallest squared distance of `wanted` to a block of `blocks`, and which block that is.
fn nearest_by_lane(blocks: &[[f32; LANES]], wanted: &[f32]) -> ([f32; LANES], [u32; LANES]) {
    #[cfg(target_arch = "x86_64")]
    if has_fused() {
        // SAFETY: the instructions were found.
        return unsafe { nearest_by_lane_avx2(blocks, wanted) };
    }
    nearest_by_lane_body(blocks, wanted)
}

/// The same with registers as wide as a row.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn nearest_by_lane_avx2(blocks: &[[f32; LANES]], wanted: &[f32]) -> ([f32; LANES], [u32; LANES]) {
    nearest_by_lane_body(blocks, wanted)
}

#[inline(always)]
fn nearest_by_lane_body(blocks: &[[f32; LANES]], wanted: &[f32]) -> ([f32; LANES], [u32; LANES]) {
    let (mut nearest, mut found) = ([f32::INFINITY; LANES], [0; LANES]);
    for (number, block) in (0..).zip(blocks.chunks_exact(wanted.len())) {
        let mut distances = [0.0; LANES];
        for (row, value) in block.iter().zip(wanted) {
            for lane in 0..LANES {
                let difference = row[lane] - value;
                distances[lane] += difference * difference;
            }
        }
        for lane in 0..LANES {
            let nearer = distances[lane] < nearest[lane];
            nearest[lane] = if nearer { distances[lane] } else { nearest[lane] };
            found[lane] = if nearer { number } else { found[lane] };
        }
    }
    (nearest, found)
}
