//! The fastest speed profile along a path, by reachability analysis: Pham and Pham, "A new approach to time-optimal path
//! parameterization based on reachability analysis", IEEE Transactions on Robotics 34 (2018), Algorithm 1.
//!
//! The linear programs of the paper have two variables and strips as constraints. Here each is solved by Newton's
//! method on the width of the interval that the strips leave for u, which is concave and piecewise linear in x: it
//! converges from outside in a few steps, exactly.

use super::bounding_line::Line;
use super::constant_limits::ConstantLimits;
use super::derivatives::PathDerivatives;
use super::grid::{Segment, UNLIMITED};
use super::joint_path::JointPath;
use super::strips::{Strictness, Strips};
use super::tip_segments::TipSegments;
use super::torque_bounds::TorqueBounds;
use super::torque_segments::TorqueSegments;
use super::velocity_curve::{average_velocity_curve, maximum_velocity_curve};
use crate::constraint::TipRates;
use crate::error::{Error, Result};
use crate::interrupt::{checkpoint, checkpoint_at};

/// Smallest and largest admissible squared path speed at a point.
pub(super) type Range = [f64; 2];

/// x = (ds/dt)^2 at the ends of all segments, linear in s between them: constant acceleration along the path.
#[derive(Debug)]
pub(super) struct SpeedProfile {
    pub segments: Vec<Segment>,
    pub squared_speeds: Vec<f64>,
}

impl SpeedProfile {
    /// Computes the fastest profile on these `segments` that starts and ends in these ranges, within limits of torques if there are any.
    ///
    /// # Errors
    /// [`Error::Infeasible`] if the speeds at the ends are not possible, or a joint cannot hold the arm.
    pub(super) fn fastest(
        path: &JointPath,
        limits: &ConstantLimits,
        segments: Vec<Segment>,
        [start, end]: [Range; 2],
        torques: Option<&mut TorqueSegments<'_>>,
    ) -> Result<Self> {
        let mut derivatives = PathDerivatives::new(path.joints().len());
        let mut strips = Strips::new(path.joints().len());
        checkpoint()?;
        let tips = limits.tips.as_ref().map(|rates| TipSegments::new(path, &segments, rates)).transpose()?;
        let velocity_curve = maximum_velocity_curve(path, limits, &segments, tips.as_ref(), &mut derivatives);
        let tips = tips.filter(|_| limits.tips.as_ref().is_some_and(TipRates::limit_acceleration));
        let torques = torques.map_or(Ok(vec![]), |torques| torques.over(&segments, &velocity_curve))?;
        let (derivatives, strips, segments_of, torques) = (&mut derivatives, &mut strips, &segments[..], &torques[..]);
        let kept = Strictness::Throughout;
        let mut pass = Pass { path, limits, segments: segments_of, tips, torques, derivatives, strips, kept };
        let controllable = pass.backward(velocity_curve, end)?;
        let squared_speeds = pass.forward(&controllable, start)?;
        Ok(Self { segments, squared_speeds })
    }

    /// Computes about how long (s) each segment takes on the finest grid, without limits of tips. `torques` are those over these segments.
    ///
    /// # Errors
    /// As [`fastest`](Self::fastest).
    pub(super) fn spans_on_average(
        path: &JointPath,
        limits: &ConstantLimits,
        segments: Vec<Segment>,
        [start, end]: [Range; 2],
        torques: &TorqueSegments<'_>,
    ) -> Result<Vec<f64>> {
        let mut derivatives = PathDerivatives::new(path.joints().len());
        let mut strips = Strips::new(path.joints().len());
        let velocity_curve = average_velocity_curve(path, limits, &segments, &mut derivatives);
        let averages = torques.averages();
        let torques: Vec<_> = averages.iter().collect();
        let (derivatives, strips, segments_of, torques) = (&mut derivatives, &mut strips, &segments[..], &torques[..]);
        let kept = Strictness::OnAverage;
        let mut pass = Pass { path, limits, segments: segments_of, tips: None, torques, derivatives, strips, kept };
        let controllable = pass.backward(velocity_curve, end)?;
        let squared_speeds = pass.forward(&controllable, start)?;
        Ok(Self { segments, squared_speeds }.spans().collect())
    }

    /// Duration of each segment (s): its length over its mean speed, since the speed is linear in time.
    pub(super) fn spans(&self) -> impl Iterator<Item = f64> + '_ {
        let speeds = self.squared_speeds.windows(2).map(|pair| pair[0].sqrt() + pair[1].sqrt());
        self.segments.iter().zip(speeds).map(|(segment, speeds)| 2.0 * segment.length / speeds)
    }

    /// Duration of the motion (s).
    pub(super) fn duration(&self) -> f64 {
        self.spans().sum()
    }
}

struct Pass<'a> {
    path: &'a JointPath,
    limits: &'a ConstantLimits,
    segments: &'a [Segment],
    /// Tips whose acceleration is limited.
    tips: Option<TipSegments<'a>>,
    /// Torques by segment; empty without limits.
    torques: &'a [&'a TorqueBounds],
    derivatives: &'a mut PathDerivatives,
    strips: &'a mut Strips,
    kept: Strictness,
}

impl Pass<'_> {
    /// Returns segment `i`, and computes its constraints.
    fn enter(&mut self, i: usize) -> Segment {
        let segment = self.segments[i];
        self.derivatives.fill(self.path, &segment);
        self.strips.fill(self.derivatives, segment.length, self.limits, self.kept);
        if let Some(tips) = &self.tips {
            self.strips.add(tips, i);
        }
        if let Some(torques) = self.torques.get(i) {
            self.strips.bound(torques);
        }
        segment
    }

    /// The controllable sets: at each grid point the range of x from which the end can be reached.
    fn backward(&mut self, velocity_curve: Vec<f64>, end: Range) -> Result<Vec<Range>> {
        let last = self.segments.len();
        let mut sets: Vec<Range> = velocity_curve.into_iter().map(|highest| [0.0, highest]).collect();
        sets[last] = [end[0], end[1].min(sets[last][1])];
        if sets[last][0] > sets[last][1] {
            return Err(too_fast("end"));
        }
        for i in (0..last).rev() {
            checkpoint_at(i)?;
            let segment = self.enter(i);
            let [lowest, highest] = sets[i + 1];
            let launch = LAUNCH_FRACTION * (2.0 * segment.length * self.strips.launch).min(highest);
            sets[i + 1][0] = lowest.max(launch);
            let next = Coupling::new(sets[i + 1], segment.length);
            let highest = sets[i][1].min(self.strips.largest_x);
            // The next point may be passed so slowly that it can be reached from rest.
            let lowest = if next.set[0] <= launch { Some(0.0) } else { self.boundary(0.0, &next) };
            sets[i] = match (lowest, self.boundary(highest, &next)) {
                (Some(lowest), Some(highest)) if lowest <= highest => [lowest, highest],
                _ => return Err(too_fast("end")),
            };
        }
        Ok(sets)
    }

    /// The forward pass: at each grid point the largest acceleration that stays controllable.
    fn forward(&mut self, sets: &[Range], start: Range) -> Result<Vec<f64>> {
        let mut x = start[1].min(sets[0][1]);
        if x < start[0] {
            return Err(too_fast("start"));
        }
        if x < sets[0][0] {
            return Err(too_fast("end"));
        }
        let mut xs = Vec::with_capacity(sets.len());
        xs.push(x);
        for i in 0..self.segments.len() {
            checkpoint_at(i)?;
            let segment = self.enter(i);
            let u = self.strips.upper(x).at(x);
            let [lowest, highest] = sets[i + 1];
            x = (x + 2.0 * segment.length * u).clamp(lowest, highest);
            xs.push(x);
        }
        Ok(xs)
    }

    /// Returns the nearest x to `from` with a feasible acceleration; `None` if there is none on that side.
    fn boundary(&self, from: f64, next: &Coupling) -> Option<f64> {
        let mut x = from.min(UNLIMITED);
        loop {
            let [upper, lower] = next.tighten(self.strips.tightest(x), x);
            if lower.at(x) <= upper.at(x) {
                return Some(x);
            }
            // The intersection of the two lines: beyond it nothing is feasible.
            let crossing = (upper.offset - lower.offset) / (upper.slope - lower.slope);
            let inward = if from > 0.0 { crossing < x } else { crossing > x };
            if !inward || crossing < 0.0 {
                let narrow = lower.at(x) - upper.at(x) <= PARALLEL * (lower.offset.abs() + upper.offset.abs());
                return narrow.then_some(x);
            }
            x = crossing;
        }
    }
}

/// The motion could never leave two consecutive grid points at rest. So each point is passed with at least this
/// fraction of the x that a launch from the previous one would give, which is negligible on a fine grid.
const LAUNCH_FRACTION: f64 = 0.1;

/// Relative tolerance for intersecting lines.
const PARALLEL: f64 = 1e-12;

/// The constraint that x at the next grid point, x + 2 u length, is in its set.
struct Coupling {
    set: Range,
    upper: Line,
    lower: Line,
}

impl Coupling {
    fn new(set: Range, length: f64) -> Self {
        let slope = 0.5 / length;
        let [lower, upper] = set.map(|x| Line { offset: x * slope, slope });
        Self { set, upper, lower }
    }

    fn tighten(&self, [upper, lower]: [Line; 2], x: f64) -> [Line; 2] {
        [
            if self.upper.at(x) < upper.at(x) { self.upper } else { upper },
            if self.lower.at(x) > lower.at(x) { self.lower } else { lower },
        ]
    }
}

fn too_fast(end: &str) -> Error {
    Error::Infeasible {
        problem: format!("the speed at the {end} of the path is beyond what the limits allow there").into(),
    }
}
