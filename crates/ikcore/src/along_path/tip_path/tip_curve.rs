//! The curve that the tip follows.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion};

use super::path_target::PathTarget;
use super::repetition::refuse_repetition;
use super::segment_geometry::squared_distance_to_segment;
use super::tolerance_band::{ToleranceBand, smallest_tolerance};
use crate::error::{Error, Result};
use crate::math::vector::between;
use crate::math::vector::distance;
use crate::math::{Frame, pose};
use crate::path::Waypoints;
use crate::task::{Components, Target, Task, TaskKind};
use crate::wording::number;

/// The curve that the tip follows: straight segments between positions, with a rotation about a fixed axis on each if
/// orientations are given.
///
/// Its path parameter is the fraction of the whole length, from 0 to 1; a radian of rotation counts as a metre.
#[derive(Debug, Clone, PartialEq)]
pub struct TipPath {
    pub(super) fractions: Vec<f64>,
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) rotations: Option<Vec<UnitQuaternion<f64>>>,
    /// The part of the poses that matters, without a tool; `None` if all of it does.
    task: Option<Task>,
    /// Band in which the tip may be off; `None`: not at all.
    tolerance_band: Option<ToleranceBand>,
    /// Angle (rad) that the orientations leave open between the rows.
    pub(super) open_turn: f64,
    /// Length of the curve (m); a radian of rotation counts as a metre.
    length: f64,
    /// Rows at which the direction jumps.
    pub(super) corners: Vec<usize>,
    /// Time of each row of a timed path (s); `None` for given points, which messages number instead.
    times: Option<Vec<f64>>,
    points: Waypoints,
    /// Path parameters of those points.
    point_fractions: Vec<f64>,
}

/// A position (m), and a rotation if the path has orientations.
pub(super) type PathPlace = ([f64; 3], Option<UnitQuaternion<f64>>);

/// Smallest advance of a path that is no pause, as a fraction of its length.
pub(super) const PAUSE: f64 = 1e-9;

/// Allowed distance of the tip from the path, relative to the extent of the path.
const ACCURACY: f64 = 1e-3;

impl TipPath {
    /// Straight segments from point to point.
    ///
    /// # Errors
    /// [`Error::InvalidPath`] if a point repeats the previous one.
    pub fn through(points: &Waypoints) -> Result<Self> {
        refuse_repetition(points)?;
        Self::from_rows(points, &(0..points.len()).collect::<Vec<_>>(), None)
    }

    /// The curve through all `waypoints`; the published planner passes those at the rows `points`. `times` (s) for a
    /// timed path.
    pub(super) fn from_rows(waypoints: &Waypoints, points: &[usize], times: Option<&[f64]>) -> Result<Self> {
        let rows = 0..waypoints.len();
        let quaternion = |r: Matrix3<f64>| UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(r));
        let rotations: Option<Vec<_>> = rows.clone().map(|i| waypoints.rotation(i).map(quaternion)).collect();
        let step = |i: usize| {
            let turned = rotations.as_ref().map_or(0.0, |rows| rows[i - 1].angle_to(&rows[i]));
            distance(&waypoints.position(i), &waypoints.position(i - 1)).hypot(turned)
        };
        let steps: Vec<f64> = rows.clone().map(|i| if i == 0 { 0.0 } else { step(i) }).collect();
        let way: f64 = steps.iter().sum();
        if !(way > 0.0 && way.is_finite()) {
            return Err(Error::InvalidPath { problem: format!("it must lead somewhere, but it is {way} m long") });
        }
        let mut travelled = 0.0;
        let fractions: Vec<f64> = steps
            .iter()
            .map(|step| {
                travelled += step / way;
                travelled
            })
            .collect();
        // The last one is exactly 1, regardless of rounding.
        let fraction = |i: usize| fractions[i] / travelled;
        let kept: Vec<usize> = rows.filter(|i| *i == 0 || steps[*i] > PAUSE * way).collect();
        let positions: Vec<[f64; 3]> = kept.iter().map(|i| waypoints.position(*i)).collect();
        let place = points.iter().map(|i| waypoints.position(*i)).collect();
        let turned = points.iter().map(|i| waypoints.rotation(*i)).collect();
        let tip_path = Self {
            fractions: kept.iter().map(|i| fraction(*i)).collect(),
            length: way,
            corners: vec![],
            task: None,
            tolerance_band: None,
            open_turn: 0.0,
            rotations: rotations.map(|rows| kept.iter().map(|i| rows[*i]).collect()),
            times: times.map(|times| kept.iter().map(|i| times[*i]).collect()),
            points: Waypoints::new(place, turned)?,
            point_fractions: points.iter().map(|i| fraction(*i)).collect(),
            positions,
        };
        Ok(Self { corners: tip_path.sharpest_turns(), ..tip_path })
    }

    /// Returns the same curve, reduced to the part of its poses that `task` uses, for a motion that strays by
    /// `accuracy` (m, rad), or by [`default_accuracy`](Self::default_accuracy).
    ///
    /// # Errors
    /// [`Error::WrongTarget`] for a path without orientations and a task that needs them; [`Error::Contradiction`] for a
    /// task with a region, or an accuracy above its smallest tolerance.
    pub(crate) fn for_task(&self, task: &Task, accuracy: Option<f64>) -> Result<Self> {
        task.validate()?;
        if task.region.is_some() {
            let problem =
                "along a path the task takes no region: its weights and tolerance say how far the tip may be off";
            return Err(Error::Contradiction { problem: problem.into() });
        }
        task.target(&self.pose(0.0))?;
        let curve = match task.kind {
            TaskKind::Position => {
                let positions = Waypoints::new(self.positions.clone(), None)?;
                Self::from_rows(&positions, &(0..self.positions.len()).collect::<Vec<_>>(), self.times.as_deref())?
            }
            _ => self.clone(),
        };
        let task = with_position(task);
        let curve = Self { task: Some(task), ..curve };
        let Some(components) = &task.components else { return Ok(curve) };
        let tolerance_band = ToleranceBand::new(components, accuracy.unwrap_or_else(|| curve.default_accuracy()))?;
        Ok(Self { tolerance_band: Some(tolerance_band), ..curve })
    }

    /// Task that uses a part of the poses; `None` if all of it matters.
    pub fn task(&self) -> Option<&Task> {
        self.task.as_ref()
    }

    /// The same curve with no component off by more than `part` of the largest tolerance; free components stay free.
    pub(crate) fn within_part(&self, part: f64) -> Self {
        let most = part * self.largest_tolerance();
        Self { tolerance_band: self.tolerance_band.map(|tolerance_band| tolerance_band.at_most(most)), ..self.clone() }
    }

    /// Whether the tip has to meet whole poses.
    pub fn fixes_pose(&self) -> bool {
        matches!(self.target(0.0), Target::Pose(_)) && !self.has_tolerance()
    }

    /// Whether the tip may be off the path.
    pub fn has_tolerance(&self) -> bool {
        self.tolerance_band.is_some()
    }

    /// Largest tolerance of a component that is not free (m, rad).
    pub(crate) fn largest_tolerance(&self) -> f64 {
        self.tolerance_band.map_or(0.0, |tolerance_band| tolerance_band.largest())
    }

    /// Whether the task leaves a part of the given poses out of account.
    pub(crate) fn ignores_a_part(&self) -> bool {
        let leaves_free = self.task.and_then(|task| task.components).is_some_and(|it| it.weights.contains(&0.0));
        self.rotations.is_some() && (leaves_free || !matches!(self.target(0.0), Target::Pose(_)))
    }

    /// Default accuracy (m, rad): a thousandth of the extent, and the distance of the sampled curve; at most the
    /// smallest tolerance.
    pub fn default_accuracy(&self) -> f64 {
        let least = self.task.and_then(|task| task.components).map_or(f64::INFINITY, |it| smallest_tolerance(&it));
        (ACCURACY * self.extent() + self.coarseness()).min(least)
    }

    /// The points that the published planner passes: the given ones, or 51 at equal times.
    pub fn points(&self) -> &Waypoints {
        &self.points
    }

    /// Path parameters of [`points`](Self::points).
    pub fn point_fractions(&self) -> &[f64] {
        &self.point_fractions
    }

    /// Path parameters of the given points, which messages number; none for a path in time.
    pub fn numbered_points(&self) -> &[f64] {
        if self.times.is_none() { &self.point_fractions } else { &[] }
    }

    /// End points of the straight segments (m).
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// Length of the curve (m); a radian of rotation counts as a metre.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Longest edge of the bounding box (m); for a rotation in place, its angle (rad).
    pub fn extent(&self) -> f64 {
        let along = |k: usize| {
            let values = self.positions.iter().map(|p| p[k]);
            values.clone().fold(f64::NEG_INFINITY, f64::max) - values.fold(f64::INFINITY, f64::min)
        };
        let extent = (0..3).map(along).fold(0.0, f64::max);
        if extent > 0.0 { extent } else { self.turned() }
    }

    fn turned(&self) -> f64 {
        self.rotations.as_ref().map_or(0.0, |rows| rows.windows(2).map(|pair| pair[0].angle_to(&pair[1])).sum())
    }

    /// Path parameters at which the direction jumps.
    pub fn corners(&self) -> impl Iterator<Item = f64> + '_ {
        self.corners.iter().map(|row| self.fractions[*row])
    }

    /// Path parameters from 0 to 1 that include all corners; the others are about 1 / `intervals` apart, at rows where
    /// rows are dense enough.
    pub fn knots(&self, intervals: usize) -> Vec<f64> {
        let spacing = 1.0 / intervals as f64;
        let (mut knots, mut fixed) = (vec![0.0], true);
        for (row, fraction) in self.fractions.iter().enumerate().skip(1) {
            let needed = row + 1 == self.fractions.len() || self.corners.binary_search(&row).is_ok();
            let since = fraction - knots[knots.len() - 1];
            if since < (1.0 - PAUSE) * spacing && !needed {
                continue;
            }
            if since < 0.5 * spacing && !fixed {
                knots.pop(); // too near to a required knot
            }
            let from = knots[knots.len() - 1];
            let count = ((fraction - from) / spacing).round().max(1.0) as usize;
            knots.extend((1..count).map(|i| from + (fraction - from) * i as f64 / count as f64));
            knots.push(*fraction);
            fixed = needed;
        }
        knots
    }

    /// The target of the tip at this path parameter: the part of the pose that matters.
    pub fn target(&self, fraction: f64) -> Target {
        let pose = self.pose(fraction);
        // The task has been checked with the first pose.
        self.task.and_then(|task| task.target(&pose).ok()).unwrap_or(pose)
    }

    /// The target and the tolerance band of the tip.
    pub(crate) fn path_target(&self, fraction: f64) -> PathTarget {
        PathTarget { target: self.target(fraction), tolerance_band: self.tolerance_band, displacement: None }
    }

    /// The whole pose at this path parameter, or the position where the path has no orientations.
    pub fn pose(&self, fraction: f64) -> Target {
        let position = self.position(fraction);
        let Some(rotation) = self.rotation(fraction) else { return Target::Position(position) };
        Target::Pose(Frame::from(&pose::from_parts(position, rotation.to_rotation_matrix().into_inner())))
    }

    pub(super) fn position(&self, fraction: f64) -> [f64; 3] {
        let (row, part) = self.locate(fraction);
        let [from, to] = [self.positions[row], self.positions[row + 1]];
        std::array::from_fn(|k| (1.0 - part) * from[k] + part * to[k])
    }

    pub(super) fn rotation(&self, fraction: f64) -> Option<UnitQuaternion<f64>> {
        let (row, part) = self.locate(fraction);
        self.rotations.as_ref().map(|rows| rows[row].rotation_to(&rows[row + 1]).powf(part) * rows[row])
    }

    /// The same curve without corners, with rows at these path parameters: at the `place` where there is one.
    pub(super) fn resampled(&self, fractions: Vec<f64>, place: impl Fn(f64) -> Option<PathPlace>) -> Self {
        let place = |at: &f64| place(*at).unwrap_or_else(|| (self.position(*at), self.rotation(*at)));
        let (positions, rotations): (Vec<_>, Vec<_>) = fractions.iter().map(place).unzip();
        Self {
            times: fractions.iter().map(|at| self.time(*at)).collect(),
            rotations: rotations.into_iter().collect(),
            positions,
            fractions,
            corners: vec![],
            ..self.clone()
        }
    }

    /// The part of the curve between two path parameters, with the same task and tolerance.
    ///
    /// # Errors
    /// [`Error::InvalidPath`] for a part without length.
    pub(crate) fn part(&self, from: f64, to: f64) -> Result<Self> {
        let inside = self.fractions.iter().copied().filter(|at| from < *at && *at < to);
        let places: Vec<f64> = std::iter::once(from).chain(inside).chain([to]).collect();
        let rotation = |at: &f64| self.rotation(*at).map(|it| it.to_rotation_matrix().into_inner());
        let positions = places.iter().map(|at| self.position(*at)).collect();
        let waypoints = Waypoints::new(positions, places.iter().map(rotation).collect())?;
        let times: Option<Vec<f64>> = places.iter().map(|at| self.time(*at)).collect();
        let part = Self::from_rows(&waypoints, &(0..places.len()).collect::<Vec<_>>(), times.as_deref())?;
        Ok(Self { task: self.task, tolerance_band: self.tolerance_band, open_turn: self.open_turn, ..part })
    }

    /// The time (s) at a path parameter of a path in time.
    fn time(&self, fraction: f64) -> Option<f64> {
        let (row, part) = self.locate(fraction);
        self.times.as_ref().map(|times| between(times[row], times[row + 1], part))
    }

    /// The place at a path parameter as the caller counts: the number of a point, with the part of the way to the next one, or the time of
    /// a path in time (s).
    pub(crate) fn place(&self, fraction: f64) -> f64 {
        self.time(fraction).unwrap_or_else(|| {
            let points = &self.point_fractions;
            let row = points.partition_point(|start| *start <= fraction).clamp(1, points.len() - 1) - 1;
            row as f64 + ((fraction - points[row]) / (points[row + 1] - points[row])).clamp(0.0, 1.0)
        })
    }

    /// The distance (m) of a position from the part of the curve between two path parameters.
    pub fn distance(&self, position: [f64; 3], from: f64, to: f64) -> f64 {
        let (first, last) = (self.locate(from.max(0.0)).0, self.locate(to.min(1.0)).0);
        let segments = self.positions[first..=last + 1].windows(2);
        segments
            .map(|ends| squared_distance_to_segment(position, ends[0], ends[1]))
            .fold(f64::INFINITY, f64::min)
            .sqrt()
    }

    /// The point at this path parameter, in words for messages.
    pub fn point_in_words(&self, fraction: f64) -> String {
        let (row, part) = self.locate(fraction);
        match self.time(fraction) {
            Some(time) => format!("the path at t = {} s", number(time)),
            None if part == 0.0 => format!("point {row} of the path"),
            None if part == 1.0 => format!("point {} of the path", row + 1),
            None => format!("the path between points {row} and {}", row + 1),
        }
    }

    /// Returns the row at which the segment with this path parameter starts, and the fraction of the segment before it.
    fn locate(&self, fraction: f64) -> (usize, f64) {
        let row = self.rows_up_to(fraction).clamp(1, self.fractions.len() - 1) - 1;
        let [from, to] = [self.fractions[row], self.fractions[row + 1]];
        (row, ((fraction - from) / (to - from)).clamp(0.0, 1.0))
    }

    /// Number of rows up to this path parameter, searched in both directions from where it is if rows are evenly spaced.
    fn rows_up_to(&self, fraction: f64) -> usize {
        let (fractions, count) = (&self.fractions, self.fractions.len());
        let guess = ((fraction * (count - 1) as f64) as usize).min(count - 1);
        let [mut low, mut high, mut reach] = [guess, guess + 1, 1];
        while low > 0 && fractions[low] > fraction {
            low = low.saturating_sub(reach);
            reach *= 2;
        }
        while high < count && fractions[high] <= fraction {
            high = (high + reach).min(count);
            reach *= 2;
        }
        low + fractions[low..high].partition_point(|row| *row <= fraction)
    }
}

/// The task without its tool; one of the orientation alone as a task of the pose whose position is free.
fn with_position(task: &Task) -> Task {
    let free = Components { weights: [0.0, 0.0, 0.0, 1.0, 1.0, 1.0], tolerance: None };
    match task.kind {
        TaskKind::Orientation => Task {
            kind: TaskKind::Pose,
            components: task.components.or(Some(free)),
            tool: None,
            region: None,
            first: None,
            level: task.level,
        },
        _ => Task { tool: None, ..*task },
    }
}
