//! Configurations to start from, found by where they bring the tip.
//!
//! A turn of the first joint carries the whole arm round its first axis, a turn of the last only spins the flange: what
//! the joints between them have to do stays the same. Both turns are taken out before stored frames are compared with a
//! wanted one, and set in closed form afterwards. That leaves four dimensions to be covered instead of six, so that some
//! thousand configurations lie close to most targets. Joints that slide, or that drive others, stay as they are stored.
//!
//! Entries lie sorted into buckets of like frames. A search compares the centres of the buckets first and then scans the few
//! nearest, so that it reads a tenth of what a plain scan would: between calls other work empties the caches.

use std::f64::consts::TAU;

use super::lane_search::{Distance, LANES, Row, nearest_by_lane};
use crate::kinematics::chain::{Chain, Motion};
use crate::math::Frame;
use crate::math::arithmetic::Separate;
use crate::rng;
use crate::robot::Joint;

/// Configurations stored: 1.4 MB for 7 joints, 3.1 MB for 32, built in some 4 ms.
const SIZE: usize = 8192;

/// Configurations in a bucket.
const BUCKET: usize = 64;

/// Buckets scanned.
const SCANNED: usize = 4;

/// Of so many blocks, one is compared with a point.
const STRIDE: usize = SIZE / 512;

/// What a change of one in an axis of unit length counts (m).
pub(crate) const AXIS_WEIGHT: f64 = 0.3;

/// Position, weighted z axis and weighted x axis of a frame.
const FEATURES: usize = 9;

/// Random configurations of one robot within its limits, and the frames that they reach.
///
/// It knows neither base nor tool: frames are those of the last joint, seen from the first.
#[derive(Debug)]
pub(crate) struct SeedIndex {
    dof: usize,
    /// The first and last joint where they can be taken out.
    pub first: Option<Turn>,
    pub last: Option<Turn>,
    configurations: Vec<f64>,
    frames: Vec<Frame>,
    /// Block after block the rows of `compared` features.
    rows: Vec<Row>,
    /// The same of the buckets' centres.
    centres: Vec<Row>,
    compared: Vec<usize>,
}

/// A joint that turns one stage and nothing else, by `scale` (rad) a unit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Turn {
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
        let drawn: Vec<f64> =
            (0..SIZE).flat_map(|_| &ranges).map(|(lower, upper)| rng.uniform_in(*lower, *upper)).collect();
        // The first joint turns every position to y = 0, the last one any x axis to any other.
        let redundant = |feature: usize| (first.is_some() && feature == 1) || (last.is_some() && feature >= 6);
        let compared = (0..FEATURES).filter(|feature| !redundant(*feature)).collect();
        let mut index = Self {
            dof: joints.len(),
            first,
            last,
            configurations: Vec::with_capacity(drawn.len()),
            frames: Vec::with_capacity(SIZE),
            rows: vec![],
            centres: vec![],
            compared,
        };
        index.fill(chain, &drawn);
        index
    }

    /// Stores the configurations `drawn`, bucket after bucket.
    fn fill(&mut self, chain: &Chain, drawn: &[f64]) {
        let configurations: Vec<_> = drawn.chunks_exact(self.dof).collect();
        let frames: Vec<_> = configurations.iter().map(|q| between_joints(chain, &chain.tip(q))).collect();
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

    fn rows_of(&self, features: &[[f32; FEATURES]]) -> Vec<Row> {
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

    /// Entries whose frames come near `wanted`, the nearest first.
    pub fn near_frame(&self, wanted: &Frame) -> [usize; LANES] {
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

    /// Entries that bring the point `reach` (m) along the z axis of their frame near `place`, the nearest first.
    pub fn near_point(&self, place: [f64; 3], reach: f64) -> [usize; LANES] {
        let distance = ToPoint {
            place: place.map(|v| v as f32),
            reach: (reach / AXIS_WEIGHT) as f32,
            azimuth_free: self.first.is_some(),
        };
        // Points have fewer dimensions than frames: some of the entries, from all buckets, are as dense.
        let blocks = (0..SIZE / LANES).step_by(STRIDE);
        nearest_by_lane(&self.rows, self.compared.len(), blocks, &distance)
    }

    /// Configuration number `entry`, and the frame it reaches.
    pub fn entry(&self, entry: usize) -> (&[f64], &Frame) {
        (&self.configurations[entry * self.dof..(entry + 1) * self.dof], &self.frames[entry])
    }
}

/// Orders `entries` so that each run of [`BUCKET`] has like features: halved again and again across the widest feature.
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

/// To a frame with these features.
struct ToFrame<'a> {
    features: &'a [f32],
}

impl Distance for ToFrame<'_> {
    #[inline(always)]
    fn of(&self, block: &[Row]) -> Row {
        let mut squared = [0.0; LANES];
        for (row, feature) in block.iter().zip(self.features) {
            for (squared, entry) in squared.iter_mut().zip(row) {
                *squared += (entry - feature) * (entry - feature);
            }
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
        let mut squared = [0.0; LANES];
        if self.azimuth_free {
            // Stored positions have no y.
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
        for (k, coordinate) in self.place.iter().enumerate() {
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
pub(crate) fn between_joints(chain: &Chain, tip: &Frame) -> Frame {
    chain.stages.frame(0).inverse().then::<Separate>(tip).then::<Separate>(&chain.tip.inverse())
}

/// `frame` carried round the base's z axis, given sine and cosine of the angle.
pub(crate) fn turned_about_base_z(frame: &Frame, sine: f64, cosine: f64) -> Frame {
    let turned = |v: [f64; 3]| [cosine * v[0] - sine * v[1], sine * v[0] + cosine * v[1], v[2]];
    Frame { axes: frame.axes.map(turned), origin: turned(frame.origin) }
}
