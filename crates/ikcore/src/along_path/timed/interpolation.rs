//! Joint splines through waypoints on a path, dense enough that the tip stays on the path between them.

use super::projection::{NEAR_ENOUGH, PathKeeps, Projection, strays};
use crate::along_path::deviation::deviation_on;
use crate::along_path::tip_path::TipPath;
use crate::error::{Error, Result};
use crate::interrupt::checkpoint_at;
use crate::math::MAX_DOF;
use crate::math::cubic_spline::SplineEnds;
use crate::math::vector::largest_difference;
use crate::robot::{Joint, Robot};
use crate::timing::JointPath;

/// Joint positions along a path.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct JointWaypoints {
    /// Path parameters, from 0 to 1.
    pub knots: Vec<f64>,
    /// Joint positions at each knot, in row-major order.
    pub rows: Vec<f64>,
}

impl JointWaypoints {
    /// Joint positions at knot `i`.
    pub(crate) fn row(&self, i: usize) -> &[f64] {
        let n = self.rows.len() / self.knots.len();
        &self.rows[i * n..(i + 1) * n]
    }

    /// Appends a knot with joint positions `q`.
    pub(super) fn push(&mut self, knot: f64, q: &[f64]) {
        self.knots.push(knot);
        self.rows.extend_from_slice(q);
    }
}

/// Behaviour of the joints at the corners of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Corners {
    /// One spline passes through them: it rounds each corner, less with denser knots.
    Passed,
    /// A spline ends at each corner and the next one begins: the arm stops there, and follows the path as closely as
    /// elsewhere.
    Stopped,
}

impl Corners {
    /// The alternatives for this path.
    pub(super) fn on(tip_path: &TipPath) -> &'static [Self] {
        match tip_path.corners().next() {
            None => &[Self::Passed],
            Some(_) => &[Self::Passed, Self::Stopped],
        }
    }
}

/// Splines of a robot's joints along a path.
#[derive(Debug)]
pub(crate) struct Interpolation<'a> {
    /// The robot.
    pub robot: &'a Robot,
    /// The path.
    pub tip_path: &'a TipPath,
    /// Constraints at every instant.
    pub keeps: PathKeeps<'a>,
    /// Behaviour at corners.
    pub corners: Corners,
    /// Allowed distance of the tip from the path (m) and angle from its orientation (rad).
    pub accuracy: f64,
}

/// Largest deviation of the tip in an interval that is not halved, as a fraction of the accuracy.
const ENOUGH: f64 = 0.8;

/// Samples inside each interval.
const SAMPLES: usize = 7;

/// Largest excess of a joint over its limits in an interval that is not halved (rad, m), as a fraction of the accuracy.
const SWING: f64 = 0.05;

/// Number of intervals beside a new knot in which the spline changes: in each by about a quarter of what it does in the one before.
const FELT: usize = 4;

/// Maximum number of times that intervals are halved; near where one is, the spline of others changes, and they may need it later.
const HALVINGS: usize = 20;

/// Shortest interval that is halved, as a fraction of the path: where joints jump, no knots help.
const SHORTEST: f64 = 1e-9;

/// Maximum number of knots, without those per row of the path.
const MOST_KNOTS: usize = 2000;
/// Further knots per row of the path.
const KNOTS_A_ROW: usize = 2;

impl Interpolation<'_> {
    /// Returns the joint path through these waypoints, over the path parameter.
    ///
    /// # Errors
    /// None in practice: waypoints that differ define a spline.
    pub(super) fn path(&self, waypoints: &JointWaypoints) -> Result<JointPath> {
        let joined = JointPath::joined(self.stretches(waypoints)?);
        joined.ok_or_else(|| Error::InvalidPath { problem: "it has no points".into() })
    }

    /// Returns the parts of that path between stops.
    ///
    /// # Errors
    /// As [`path`](Self::path).
    pub(super) fn stretches(&self, waypoints: &JointWaypoints) -> Result<Vec<JointPath>> {
        let n = self.robot.dof();
        self.refuse_rest(waypoints)?;
        let names: Vec<String> = self.robot.joints().iter().map(|joint| joint.name.clone()).collect();
        // Natural ends, i.e. zero curvature, would be less accurate.
        let spline = |from: usize, to: usize| {
            let rows = &waypoints.rows[from * n..(to + 1) * n];
            JointPath::spline(names.clone(), rows, Some(&waypoints.knots[from..=to]), SplineEnds::NotAKnot)
        };
        let last = waypoints.knots.len() - 1;
        if self.corners == Corners::Passed {
            return Ok(vec![spline(0, last)?]);
        }
        let mut ends = vec![0];
        ends.extend(self.tip_path.corners().map(|corner| waypoints.knots.partition_point(|knot| *knot < corner)));
        ends.push(last);
        ends.dedup(); // a corner within rounding of an end
        ends.windows(2).map(|ends| spline(ends[0], ends[1])).collect()
    }

    /// Refuses a motion that rests on a part of the path: a spline over the path cannot.
    ///
    /// # Errors
    /// [`Error::InvalidPath`] names that part.
    fn refuse_rest(&self, waypoints: &JointWaypoints) -> Result<()> {
        let knots = &waypoints.knots;
        let rests = |i: &usize| waypoints.row(i - 1) == waypoints.row(*i);
        let Some(i) = (1..knots.len()).find(rests) else { return Ok(()) };
        let [from, to] = [knots[i - 1], knots[i]].map(|fraction| self.tip_path.point_in_words(fraction));
        let problem = format!(
            "the task leaves the tip so free that the arm need not move from {from} to {to}: ask for more of the pose, or for \
             smaller tolerances"
        );
        Err(Error::InvalidPath { problem })
    }

    /// Returns the waypoints with knots added until the tip is within the accuracy, or until more knots do not help.
    ///
    /// # Errors
    /// None in practice, as for [`path`](Self::path).
    pub(super) fn refined(&self, mut waypoints: JointWaypoints) -> Result<JointWaypoints> {
        let accuracy = self.accuracy;
        let most = MOST_KNOTS + KNOTS_A_ROW * self.tip_path.positions().len();
        let mut settled = vec![false; waypoints.knots.len() - 1];
        for _ in 0..HALVINGS {
            let path = self.path(&waypoints)?;
            let deviation = deviation_on(self.robot, self.tip_path, &path);
            let is_coarse = |i: usize| {
                checkpoint_at(i)?;
                let ends = [waypoints.knots[i], waypoints.knots[i + 1]];
                // A given start may be off the path.
                let most = ENOUGH * accuracy + if i == 0 { deviation.at(ends[0]) } else { 0.0 };
                let is_too_much = |q: &[f64], off: f64| off > most || self.excess(q) > SWING * accuracy;
                Ok(deviation.any_between(ends, SAMPLES, is_too_much).then_some(i))
            };
            let knots = &waypoints.knots;
            let intervals = (0..settled.len()).filter(|i| !settled[*i] && knots[i + 1] - knots[*i] > SHORTEST);
            let coarse: Vec<usize> = intervals.filter_map(|i| is_coarse(i).transpose()).collect::<Result<_>>()?;
            if coarse.is_empty() || waypoints.knots.len() + coarse.len() > most {
                break;
            }
            let finer = self.halved(&waypoints, &coarse, &path, NEAR_ENOUGH * accuracy);
            if finer.knots.len() == waypoints.knots.len() {
                break;
            }
            settled = settled_after(&waypoints.knots, &finer.knots, &coarse);
            waypoints = finer;
        }
        Ok(waypoints)
    }

    /// Returns these waypoints of another path with the tip on this one; `None` where it cannot be moved there.
    pub(super) fn moved(&self, mut waypoints: JointWaypoints) -> Option<JointWaypoints> {
        let n = self.robot.dof();
        let mut projection = Projection::new(self.robot, self.keeps);
        let met = waypoints.knots.iter().zip(waypoints.rows.chunks_exact_mut(n));
        let mut met = met.map(|(knot, q)| projection.project(&self.tip_path.path_target(*knot), q) == 0.0);
        met.all(|is_met| is_met).then_some(waypoints)
    }

    /// Largest excess of a joint over its limits (rad, m).
    fn excess(&self, q: &[f64]) -> f64 {
        let beyond = |(joint, q): (&Joint, &f64)| (joint.lower - q).max(q - joint.upper);
        self.robot.joints().iter().zip(q).map(beyond).fold(0.0, f64::max)
    }

    /// Scales all positions of a joint that swings out of its limits into them.
    ///
    /// # Errors
    /// As [`path`](Self::path).
    pub(super) fn draw_inside(&self, waypoints: &mut JointWaypoints) -> Result<()> {
        let path = self.path(waypoints)?;
        let n = self.robot.dof();
        for (j, joint) in self.robot.joints().iter().enumerate() {
            let [lowest, highest] = path.range(j);
            let (low, high) = (lowest.max(joint.lower), highest.min(joint.upper));
            if (low, high) == (lowest, highest) || !(low <= high) {
                continue;
            }
            let scale = if highest > lowest { (high - low) / (highest - lowest) } else { 1.0 };
            let values = waypoints.rows.iter_mut().skip(j).step_by(n);
            values.for_each(|q| *q = (low + scale * (*q - lowest)).clamp(low, high));
        }
        Ok(())
    }

    /// Returns the waypoints with a knot added in the middle of each of these intervals, if a configuration near the spline has the tip
    /// there, or `within` this distance (m, rad).
    fn halved(&self, waypoints: &JointWaypoints, intervals: &[usize], path: &JointPath, within: f64) -> JointWaypoints {
        let n = self.robot.dof();
        let mut projection = Projection::new(self.robot, self.keeps);
        let mut finer = JointWaypoints { knots: vec![], rows: vec![] };
        let mut intervals = intervals.iter().peekable();
        for (i, knot) in waypoints.knots.iter().enumerate() {
            finer.push(*knot, waypoints.row(i));
            if intervals.next_if_eq(&&i).is_none() {
                continue;
            }
            let middle = 0.5 * (knot + waypoints.knots[i + 1]);
            let mut spline = [0.0; MAX_DOF];
            let spline = &mut spline[..n];
            path.position(middle, spline);
            projection.bounds.clip(spline);
            let mut q = [0.0; MAX_DOF];
            let q = &mut q[..n];
            q.copy_from_slice(spline);
            let target = self.tip_path.path_target(middle);
            let apart = largest_difference(waypoints.row(i), waypoints.row(i + 1));
            let mut is_met = projection.project(&target, q) == 0.0;
            if !is_met || strays(q, spline, apart) {
                q.copy_from_slice(spline);
                is_met = projection.approach(&target, q, within);
            }
            if is_met {
                finer.push(middle, q);
            }
        }
        finer
    }
}

/// Which intervals between `finer` knots are fine enough: those that were not `coarse`, with no new knot near.
fn settled_after(knots: &[f64], finer: &[f64], coarse: &[usize]) -> Vec<bool> {
    let (mut settled, mut added) = (Vec::with_capacity(finer.len() - 1), vec![]);
    for i in 0..knots.len() - 1 {
        let begin = settled.len();
        settled.push(coarse.binary_search(&i).is_err());
        if finer[begin + 1] < knots[i + 1] {
            settled.push(false);
            added.push(begin + 1);
        }
    }
    for knot in added {
        let last = (knot + FELT).min(settled.len());
        settled[knot.saturating_sub(FELT)..last].fill(false);
    }
    settled
}
