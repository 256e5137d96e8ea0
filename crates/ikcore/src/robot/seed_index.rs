//! Configurations to start from, found by where they bring the tip.
//!
//! A turn of the first joint carries the whole arm round its first axis, a turn of the last only spins the flange: what
//! the joints between them have to do stays the same. Both turns are taken out before stored frames are compared with a
//! wanted one, and set in closed form afterwards. That leaves four dimensions to be covered instead of six, so that two
//! thousand configurations lie close to most targets. Joints that slide, or that drive others, stay as they are stored.

use std::f64::consts::TAU;

use super::Joint;
use super::chain::{Chain, Motion};
use super::lane_search::{Distance, LANES, Row, nearest_by_lane};
use crate::math::Frame;
use crate::math::arithmetic::Separate;
use crate::rng;

/// Configurations stored: 0.4 MB for 7 joints, 0.8 MB for 32, built in 0.3 ms. Twice as many save less iterations
/// than their scan costs.
const SIZE: usize = 2048;

/// What a change of one in an axis of unit length counts (m).
pub(super) const AXIS_WEIGHT: f64 = 0.3;

/// Position, weighted z axis and weighted x axis of a frame.
const FEATURES: usize = 9;

/// Random configurations of one robot within its limits, and the frames that they reach.
///
/// It knows neither base nor tool: frames are those of the last joint, seen from the first.
#[derive(Debug)]
pub(super) struct SeedIndex {
    dof: usize,
    /// The first and last joint where they can be taken out.
    pub first: Option<Turn>,
    pub last: Option<Turn>,
    configurations: Vec<f64>,
    frames: Vec<Frame>,
    /// Block after block the rows of `compared` features.
    rows: Vec<Row>,
    compared: Vec<usize>,
}

/// A joint that turns one stage and nothing else, by `scale` (rad) a unit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    pub joint: usize,
    scale: f64,
}

impl SeedIndex {
    /// The index of a chain with neither base nor tool, whose first `moving` stages are no padding.
    pub fn new(chain: &Chain, moving: usize, joints: &[Joint]) -> Self {
        let motions = &chain.motions[..moving];
        let first = Turn::of_stage(motions, 0);
        let last = if moving > 1 { Turn::of_stage(motions, moving - 1) } else { None };
        let ranges: Vec<_> = joints.iter().map(Joint::sampling_range).collect();
        let mut rng = rng::stream(0, 0);
        let configurations: Vec<f64> =
            (0..SIZE).flat_map(|_| &ranges).map(|(lower, upper)| rng.uniform_in(*lower, *upper)).collect();
        let frames = configurations.chunks_exact(joints.len()).map(|q| between_joints(chain, &chain.tip(q))).collect();
        // The first joint turns every position to y = 0, the last one any x axis to any other.
        let redundant = |feature: usize| (first.is_some() && feature == 1) || (last.is_some() && feature >= 6);
        let compared = (0..FEATURES).filter(|feature| !redundant(*feature)).collect();
        let mut index = Self { dof: joints.len(), first, last, configurations, frames, rows: vec![], compared };
        index.rows = index.frames.chunks_exact(LANES).flat_map(|block| index.rows_of(block)).collect();
        index
    }

    fn rows_of(&self, block: &[Frame]) -> Vec<Row> {
        let features: Vec<_> = block.iter().map(|frame| self.features(frame)).collect();
        self.compared.iter().map(|feature| std::array::from_fn(|lane| features[lane][*feature])).collect()
    }

    fn features(&self, frame: &Frame) -> [f32; FEATURES] {
        let [x, y, _] = frame.origin;
        let radius = x.hypot(y);
        let frame = if self.first.is_some() && radius > 0.0 {
            turned_about_base_z(frame, -y / radius, x / radius)
        } else {
            *frame
        };
        let [[zx, zy, zz], [xx, xy, xz]] = [2, 0].map(|axis: usize| frame.axes[axis].map(|v| AXIS_WEIGHT * v));
        let [px, py, pz] = frame.origin;
        [px, py, pz, zx, zy, zz, xx, xy, xz].map(|v| v as f32)
    }

    /// Entries whose frames come near `wanted`, the nearest first.
    pub fn near_frame(&self, wanted: &Frame) -> [usize; LANES] {
        let all = self.features(wanted);
        let mut features = [0.0; FEATURES];
        features.iter_mut().zip(&self.compared).for_each(|(value, feature)| *value = all[*feature]);
        let width = self.compared.len();
        nearest_by_lane(&self.rows, width, &ToFrame { features: &features[..width] })
    }

    /// Entries that bring the point `reach` (m) along the z axis of their frame near `place`, the nearest first.
    pub fn near_point(&self, place: [f64; 3], reach: f64) -> [usize; LANES] {
        let distance = ToPoint {
            place: place.map(|v| v as f32),
            reach: (reach / AXIS_WEIGHT) as f32,
            azimuth_free: self.first.is_some(),
        };
        // Points have fewer dimensions than frames: a quarter of the entries is as dense.
        nearest_by_lane(&self.rows[..self.rows.len() / 4], self.compared.len(), &distance)
    }

    /// Configuration number `entry`, and the frame it reaches.
    pub fn entry(&self, entry: usize) -> (&[f64], &Frame) {
        (&self.configurations[entry * self.dof..(entry + 1) * self.dof], &self.frames[entry])
    }
}

/// To a frame with these features.
struct ToFrame<'a> {
    features: &'a [f32],
}

impl Distance for ToFrame<'_> {
    #[inline(always)]
    fn of(&self, block: &[Row]) -> Row {
        let mut squared = [0.0; LANES];
        for (row, feature) in block.iter().zip(self.features) {
            squared = std::array::from_fn(|i| squared[i] + (row[i] - feature) * (row[i] - feature));
        }
        squared
    }
}

/// From the point at `reach` along the weighted z axis to `place`; at any azimuth if that is free.
struct ToPoint {
    place: [f32; 3],
    reach: f32,
    azimuth_free: bool,
}

impl Distance for ToPoint {
    #[inline(always)]
    fn of(&self, block: &[Row]) -> Row {
        let [x, y, z] = self.place;
        let along = |origin: &Row, axis: &Row| -> Row { std::array::from_fn(|i| origin[i] + self.reach * axis[i]) };
        let sum_of_squares = |a: &Row, b: &Row| -> Row { std::array::from_fn(|i| a[i] * a[i] + b[i] * b[i]) };
        if self.azimuth_free {
            // Stored positions have no y.
            let across = sum_of_squares(&along(&block[0], &block[2]), &along(&[0.0; LANES], &block[3]));
            let radius = (x * x + y * y).sqrt();
            let outward = across.map(|squared| squared.sqrt() - radius);
            return sum_of_squares(&outward, &along(&block[1], &block[4]).map(|height| height - z));
        }
        let [dx, dy, dz] = std::array::from_fn(|k| along(&block[k], &block[3 + k]).map(|p| p - self.place[k]));
        let across = sum_of_squares(&dx, &dy);
        std::array::from_fn(|i| across[i] + dz[i] * dz[i])
    }
}

impl Turn {
    fn of_stage(motions: &[Motion], stage: usize) -> Option<Self> {
        let Motion { joint, turn_scale: scale, .. } = motions[stage];
        let alone = motions.iter().filter(|motion| motion.joint == joint).count() == 1;
        (alone && scale != 0.0).then_some(Self { joint, scale })
    }

    /// The joint's value `q` after a turn by `angle` (rad), give or take the whole turns that bring it nearest to the
    /// middle of `range`.
    pub fn turned(&self, q: f64, angle: f64, (lower, upper): (f64, f64)) -> f64 {
        let (turned, period) = (q + angle / self.scale, TAU / self.scale.abs());
        turned - period * ((turned - 0.5 * (lower + upper)) / period).round()
    }
}

/// The frame of the last joint, seen from the first, when the tip of `chain` is at `tip`.
pub(super) fn between_joints(chain: &Chain, tip: &Frame) -> Frame {
    chain.stages[0].inverse().then::<Separate>(tip).then::<Separate>(&chain.tip.inverse())
}

/// `frame` carried round the base's z axis, given sine and cosine of the angle.
pub(super) fn turned_about_base_z(frame: &Frame, sine: f64, cosine: f64) -> Frame {
    let turned = |v: [f64; 3]| [cosine * v[0] - sine * v[1], sine * v[0] + cosine * v[1], v[2]];
    Frame { axes: frame.axes.map(turned), origin: turned(frame.origin) }
}
