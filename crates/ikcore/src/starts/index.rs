//! Index of random configurations by tip frame.
//!
//! The first joint rotates the whole arm about its axis, and the last one only rotates the flange; neither changes the rest
//! of the arm. Both rotations are therefore removed before stored frames are compared with a target, and set in closed form
//! afterwards. That leaves four dimensions instead of six, so that a few thousand configurations lie close to most targets.
//! First and last joints that are prismatic, or that also drive other stages, keep their stored values.
//!
//! Entries are sorted into buckets of similar frames. A search compares the centres of the buckets and then scans the nearest
//! buckets: it reads a tenth of what a plain scan reads, which matters because other work evicts the index from the caches
//! between calls.

use std::f64::consts::TAU;

use crate::kinematics::chain::{Chain, Transmission};
use crate::kinematics::kernels::Kernels;
use crate::math::Frame;
use crate::math::arithmetic::NoFma;
use crate::math::nearest_by_lane::{Distance, LANES, LaneRow, nearest_by_lane};
use crate::rng;

/// Number of configurations: 1.4 MB for 7 joints, 3.1 MB for 32, built in about 4 ms.
const SIZE: usize = 8192;

/// Number of configurations in a bucket.
const BUCKET: usize = 64;

/// Number of buckets scanned.
const SCANNED: usize = 4;

/// Stride of position queries, which scan every n-th block.
const STRIDE: usize = SIZE / 512;

/// Weight of a difference between unit axes, relative to positions (m).
pub(super) const AXIS_WEIGHT: f64 = 0.3;

/// Number of features of a frame: position, weighted z axis, weighted x axis.
const FEATURES: usize = 9;

/// Random configurations of one chain, and the frames of their last joints.
///
/// The frames are relative to the first joint, so the index does not depend on base and tool.
#[derive(Debug)]
pub(crate) struct StartIndex {
    dof: usize,
    /// First and last joint, if their rotations can be removed.
    pub(super) first: Option<Turn>,
    pub(super) last: Option<Turn>,
    configurations: Vec<f64>,
    frames: Vec<Frame>,
    /// Rows of the `compared` features, block by block.
    rows: Vec<LaneRow>,
    /// Rows of the bucket centres.
    centres: Vec<LaneRow>,
    compared: Vec<usize>,
}

/// Joint that rotates exactly one stage, by `scale` (rad) per unit of q.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    pub joint: usize,
    scale: f64,
}

impl StartIndex {
    /// Builds the index of a chain without base and tool, drawn from `ranges`, one per joint.
    pub fn new(chain: &Chain, kernels: &Kernels, ranges: &[(f64, f64)]) -> Self {
        let motions = &chain.motions[..chain.moving];
        let first = Turn::of_stage(motions, 0);
        let last = if chain.moving > 1 { Turn::of_stage(motions, chain.moving - 1) } else { None };
        let mut rng = rng::stream(0, 0);
        let drawn: Vec<f64> =
            (0..SIZE).flat_map(|_| ranges).map(|(lower, upper)| rng.uniform_in(*lower, *upper)).collect();
        // The first joint can rotate every position to y = 0, and the last one any x axis to any other.
        let redundant = |feature: usize| (first.is_some() && feature == 1) || (last.is_some() && feature >= 6);
        let compared = (0..FEATURES).filter(|feature| !redundant(*feature)).collect();
        let mut index = Self {
            dof: ranges.len(),
            first,
            last,
            configurations: Vec::with_capacity(drawn.len()),
            frames: Vec::with_capacity(SIZE),
            rows: vec![],
            centres: vec![],
            compared,
        };
        index.fill(chain, kernels, &drawn);
        index
    }

    /// Stores the configurations `drawn`, bucket by bucket.
    fn fill(&mut self, chain: &Chain, kernels: &Kernels, drawn: &[f64]) {
        let configurations: Vec<_> = drawn.chunks_exact(self.dof).collect();
        let frames: Vec<_> = configurations.iter().map(|q| between_joints(chain, &(kernels.tip)(chain, q))).collect();
        let features: Vec<_> = frames.iter().map(|frame| self.features(frame)).collect();
        let mut order: Vec<u32> = (0..SIZE as u32).collect();
        into_buckets(&mut order, &features, &self.compared);
        for entry in &order {
            self.configurations.extend_from_slice(configurations[*entry as usize]);
            self.frames.push(frames[*entry as usize]);
        }
        let sorted: Vec<_> = order.iter().map(|entry| features[*entry as usize]).collect();
        let centres: Vec<_> = sorted.chunks_exact(BUCKET).map(centre).collect();
        self.rows = self.rows_of(&sorted);
        self.centres = self.rows_of(&centres);
    }

    fn rows_of(&self, features: &[[f32; FEATURES]]) -> Vec<LaneRow> {
        let blocks = features.chunks_exact(LANES);
        blocks
            .flat_map(|block| {
                self.compared.iter().map(move |feature| std::array::from_fn(|lane| block[lane][*feature]))
            })
            .collect()
    }

    fn features(&self, frame: &Frame) -> [f32; FEATURES] {
        let [x, y, _] = frame.origin;
        let radius = (x * x + y * y).sqrt();
        let frame = if self.first.is_some() && radius > 0.0 {
            turned_about_base_z(frame, -y / radius, x / radius)
        } else {
            *frame
        };
        let [[zx, zy, zz], [xx, xy, xz]] = [2, 0].map(|axis: usize| frame.axes[axis].map(|v| AXIS_WEIGHT * v));
        let [px, py, pz] = frame.origin;
        [px, py, pz, zx, zy, zz, xx, xy, xz].map(|v| v as f32)
    }

    /// Returns entries with frames near `wanted`, nearest first.
    pub(super) fn near_frame(&self, wanted: &Frame) -> [usize; LANES] {
        let all = self.features(wanted);
        let mut features = [0.0; FEATURES];
        features.iter_mut().zip(&self.compared).for_each(|(value, feature)| *value = all[*feature]);
        let width = self.compared.len();
        let distance = ToFrame { features: &features[..width] };
        let buckets = nearest_by_lane(&self.centres, width, 0..SIZE / BUCKET / LANES, &distance);
        let blocks = buckets[..SCANNED].iter().flat_map(|bucket| {
            let first = bucket * (BUCKET / LANES);
            first..first + BUCKET / LANES
        });
        nearest_by_lane(&self.rows, width, blocks, &distance)
    }

    /// Returns entries whose point at `reach` (m) along the z axis of their frame is near `position`, nearest first.
    pub(super) fn near_point(&self, position: [f64; 3], reach: f64) -> [usize; LANES] {
        let distance = ToPoint {
            position: position.map(|v| v as f32),
            reach: (reach / AXIS_WEIGHT) as f32,
            azimuth_free: self.first.is_some(),
        };
        // A subset of the blocks suffices, since positions have fewer dimensions than frames.
        let blocks = (0..SIZE / LANES).step_by(STRIDE);
        nearest_by_lane(&self.rows, self.compared.len(), blocks, &distance)
    }

    /// Returns configuration and frame of entry `entry`.
    pub(super) fn entry(&self, entry: usize) -> (&[f64], &Frame) {
        (&self.configurations[entry * self.dof..(entry + 1) * self.dof], &self.frames[entry])
    }
}

/// Sorts `entries` into buckets of [`BUCKET`] with similar features, by repeatedly halving along the widest feature.
fn into_buckets(entries: &mut [u32], features: &[[f32; FEATURES]], compared: &[usize]) {
    if entries.len() <= BUCKET {
        return;
    }
    let spread = |feature: usize| {
        let values = entries.iter().map(|entry| features[*entry as usize][feature]);
        let (least, most) =
            values.fold((f32::INFINITY, f32::NEG_INFINITY), |(least, most), v| (least.min(v), most.max(v)));
        most - least
    };
    let widest = compared.iter().copied().max_by(|a, b| spread(*a).total_cmp(&spread(*b))).unwrap_or(0);
    let middle = entries.len() / 2;
    entries.select_nth_unstable_by(middle, |a, b| {
        let value = |entry: &u32| features[*entry as usize][widest];
        value(a).total_cmp(&value(b)).then(a.cmp(b))
    });
    let (below, above) = entries.split_at_mut(middle);
    into_buckets(below, features, compared);
    into_buckets(above, features, compared);
}

fn centre(bucket: &[[f32; FEATURES]]) -> [f32; FEATURES] {
    std::array::from_fn(|feature| bucket.iter().map(|features| features[feature]).sum::<f32>() / bucket.len() as f32)
}

/// Distance to a frame with these features.
struct ToFrame<'a> {
    features: &'a [f32],
}

impl Distance for ToFrame<'_> {
    #[inline(always)]
    fn of(&self, block: &[LaneRow]) -> LaneRow {
        let mut squared = [0.0; LANES];
        for (row, feature) in block.iter().zip(self.features) {
            for (squared, entry) in squared.iter_mut().zip(row) {
                *squared += (entry - feature) * (entry - feature);
            }
        }
        squared
    }
}

/// Distance from `position` to the point at `reach` along the weighted z axis, minimised over the azimuth if the azimuth is
/// free.
struct ToPoint {
    position: [f32; 3],
    reach: f32,
    azimuth_free: bool,
}

impl Distance for ToPoint {
    #[inline(always)]
    fn of(&self, block: &[LaneRow]) -> LaneRow {
        let [x, y, z] = self.position;
        let mut squared = [0.0; LANES];
        if self.azimuth_free {
            // Stored positions have y = 0.
            let (px, pz, zx, zy, zz) = (&block[0], &block[1], &block[2], &block[3], &block[4]);
            let radius = (x * x + y * y).sqrt();
            for (i, squared) in squared.iter_mut().enumerate() {
                let (across_x, across_y) = (px[i] + self.reach * zx[i], self.reach * zy[i]);
                let outward = (across_x * across_x + across_y * across_y).sqrt() - radius;
                let upward = pz[i] + self.reach * zz[i] - z;
                *squared = outward * outward + upward * upward;
            }
            return squared;
        }
        for (k, coordinate) in self.position.iter().enumerate() {
            let (origin, axis) = (&block[k], &block[3 + k]);
            for (i, squared) in squared.iter_mut().enumerate() {
                let missed = origin[i] + self.reach * axis[i] - coordinate;
                *squared += missed * missed;
            }
        }
        squared
    }
}

impl Turn {
    fn of_stage(motions: &[Transmission], stage: usize) -> Option<Self> {
        let Transmission { joint, turn_scale: scale, .. } = motions[stage];
        let alone = motions.iter().filter(|motion| motion.joint == joint).count() == 1;
        (alone && scale != 0.0 && motions[stage].is_linear()).then_some(Self { joint, scale })
    }

    /// Returns the joint value `q` after a rotation by `angle` (rad), shifted by whole turns to be nearest to the middle of
    /// `range`.
    pub fn turned(&self, q: f64, angle: f64, (lower, upper): (f64, f64)) -> f64 {
        let (turned, period) = (q + angle / self.scale, TAU / self.scale.abs());
        turned - period * ((turned - 0.5 * (lower + upper)) / period).round()
    }
}

/// Returns the frame of the last joint, relative to the first, when the tip of `chain` is at `tip`.
pub(super) fn between_joints(chain: &Chain, tip: &Frame) -> Frame {
    chain.stages.frame(0).inverse().then::<NoFma>(tip).then::<NoFma>(&chain.tip.inverse())
}

/// Rotates `frame` about the base's z axis, given sine and cosine of the angle.
pub(super) fn turned_about_base_z(frame: &Frame, sine: f64, cosine: f64) -> Frame {
    let turned = |v: [f64; 3]| [cosine * v[0] - sine * v[1], sine * v[0] + cosine * v[1], v[2]];
    Frame { axes: frame.axes.map(turned), origin: turned(frame.origin) }
}
