//! Joint positions along a path of the tip, from configuration to configuration by Newton's method.

use super::moving_tip::MovingTip;
use super::tool_path::ToolPath;
use crate::along_path::{Borders, PathTarget};
use crate::error::Result;
use crate::interrupt::checkpoint_at;
use crate::math::Frame;
use crate::math::cubic_spline::SplineEnds;
use crate::math::vector::largest_difference;
use crate::objective::{Bounds, Linearization, Point};
use crate::timing::{ConstantLimits, JointPath};

/// Maximum number of Newton steps.
const STEPS: usize = 20;
/// Squared error at which Newton steps end (m^2, rad^2).
const MET: f64 = 1e-22;
/// Squared error up to which a pose counts as met if no step leads nearer.
const AS_NEAR_AS_SOLVES: f64 = 1e-14;
/// Damping relative to squared error, as in the library's Levenberg-Marquardt.
const DAMPING: f64 = 0.05;

/// Longest step along the path (m).
const LONGEST_STEP: f64 = 0.05;
/// Longest step, as a fraction of the length in which the path turns by a radian.
const PART_OF_TURN: f64 = 0.25;
/// Largest change of a joint in a step (rad, m).
const LARGEST_CHANGE: f64 = 0.4;
/// Largest difference of a joint from the predicted value (rad, m): beyond, another branch may be met.
const LARGEST_SURPRISE: f64 = 0.1;
/// Halvings after which the path counts as lost.
const HALVINGS: i32 = 10;

/// Largest distance (m) and angle (rad) of the tip from its path between knots.
const ACCURACY: [f64; 2] = [2e-6, 2e-5];
/// The same relative to the length between knots, so that the speed of the tip is that of the parameter.
const SLOPE_ACCURACY: f64 = 5e-5;
/// Fractions of an interval at which the distance of the tip from its path is checked.
const LOOKS: [f64; 3] = [0.25, 0.5, 0.75];
/// Change of the joints (rad, m) between knots that counts as rest: a path in joint space cannot.
const REST: f64 = 1e-12;
/// Maximum number of rounds of refinement.
const ROUNDS: usize = 16;
/// Maximum number of knots.
const MOST_KNOTS: usize = 5000;

/// Joint positions at lengths along a path.
#[derive(Debug, Clone)]
pub(super) struct Track {
    /// Lengths (m), from 0 to that of the path.
    pub knots: Vec<f64>,
    /// Joint positions at each, in row-major order.
    pub rows: Vec<f64>,
}

/// Place where a path is lost.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lost {
    /// Length up to there (m).
    pub at: f64,
}

/// Reason why a track cannot be refined.
#[derive(Debug, Clone, Copy)]
pub(super) enum Stray {
    Lost(Lost),
    /// At the length `at` (m) a joint would have to go to `value`, beyond its limits.
    Beyond {
        at: f64,
        joint: usize,
        value: f64,
    },
    /// At the length `at` (m) the arm need not move on: its task leaves the tip that free.
    Still {
        at: f64,
    },
}

impl Track {
    /// Joint positions at knot `i`.
    pub fn row(&self, i: usize) -> &[f64] {
        let n = self.rows.len() / self.knots.len();
        &self.rows[i * n..(i + 1) * n]
    }

    /// Joint positions at the end.
    pub fn end(&self) -> &[f64] {
        self.row(self.knots.len() - 1)
    }

    /// The first length at which the joints rest.
    fn rest(&self) -> Option<f64> {
        (1..self.knots.len())
            .find(|i| largest_difference(self.row(i - 1), self.row(*i)) <= REST)
            .map(|i| self.knots[i - 1])
    }

    fn push(&mut self, knot: f64, q: &[f64]) {
        self.knots.push(knot);
        self.rows.extend_from_slice(q);
    }
}

/// Direction of the self-motion of a redundant arm: towards a configuration.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lead<'a> {
    /// Number of the tip whose arm is led.
    pub tip: usize,
    /// The configuration that the arm goes to, as near as its path allows.
    pub toward: &'a [f64],
    /// Length of the path (m) after which two thirds of the way are gone.
    pub within: f64,
}

/// Follows paths of the tip within a box.
pub(super) struct Follower<'a> {
    tip: &'a MovingTip<'a>,
    bounds: Bounds,
    linearization: Linearization,
    /// Evaluations of the kinematics so far.
    pub evaluations: usize,
}

impl<'a> Follower<'a> {
    pub fn new(tip: &'a MovingTip<'a>, bounds: Bounds) -> Self {
        Self { tip, bounds, linearization: Linearization::default(), evaluations: 0 }
    }

    /// Follows the path from the configuration `q` at its start, in the longest steps allowed. Without a `lead`, the joints
    /// move as little as they can.
    pub fn follow(&mut self, path: &ToolPath, q: &[f64], lead: Option<&Lead<'_>>) -> Result<Track, Lost> {
        let widened = self.bounds_from(q);
        // A joint at its limit moves off it where the task leaves it the freedom: a motion along a limit swings beyond.
        if !self.tip.task.is_whole() {
            let inside = self.tip.with_others_at(q, self.bounds.clone());
            if !inside.contains(q)
                && let Ok(track) = self.follow_within(path, q, lead, [&widened, &inside])
            {
                return Ok(track);
            }
        }
        self.follow_within(path, q, lead, [&widened, &widened])
    }

    /// Follows the path from `q` in the box `first`, and from there on in the box `then`.
    fn follow_within(
        &mut self,
        path: &ToolPath,
        q: &[f64],
        lead: Option<&Lead<'_>>,
        [first, then]: [&Bounds; 2],
    ) -> Result<Track, Lost> {
        let mut track = Track { knots: vec![0.0], rows: q.to_vec() };
        let mut before = Point::from_slice(q);
        if !self.project(&self.target(path, 0.0), &mut before, first) {
            return Err(Lost { at: 0.0 });
        }
        track.rows.copy_from_slice(&before);
        for (piece, begin) in path.pieces.iter().zip(&path.breaks) {
            let end = begin + piece.length;
            let longest = LONGEST_STEP.min(PART_OF_TURN * piece.length_per_turn());
            let even = piece.length / (piece.length / longest).ceil().max(2.0);
            self.follow_piece(path, [*begin, end, even], lead, then, &mut track)?;
        }
        Ok(track)
    }

    /// The box for a track that begins at `q`, which may be nearer to its limits than the box is.
    fn bounds_from(&self, q: &[f64]) -> Bounds {
        self.tip.with_others_at(q, self.bounds.clone().including(q))
    }

    fn follow_piece(
        &mut self,
        path: &ToolPath,
        [begin, end, even]: [f64; 3],
        lead: Option<&Lead<'_>>,
        bounds: &Bounds,
        track: &mut Track,
    ) -> Result<(), Lost> {
        let (mut at, mut step) = (begin, even);
        let smallest = even * 0.5_f64.powi(HALVINGS);
        while at < end {
            // The end is met exactly, and no sliver is left before it.
            let next = if at + 1.2 * step >= end { end } else { at + step };
            let last = track.knots.len() - 1;
            let mut q = Point::from_slice(track.row(last));
            if let Some(lead) = lead {
                let part = 1.0 - (-(next - at) / lead.within).exp();
                q.iter_mut().zip(lead.toward).for_each(|(q, toward)| *q += part * (toward - *q));
            } else if last > 0 {
                let stretch = (next - at) / (track.knots[last] - track.knots[last - 1]);
                q.iter_mut().zip(track.row(last - 1)).for_each(|(q, before)| *q += stretch * (*q - before));
            }
            bounds.clip(&mut q);
            let expected = q.clone();
            if self.project(&self.target(path, next), &mut q, bounds)
                && largest_difference(&q, track.row(last)) <= LARGEST_CHANGE
                && largest_difference(&q, &expected) <= LARGEST_SURPRISE
            {
                track.push(next, &q);
                at = next;
                step = (2.0 * step).min(even);
            } else if step > smallest {
                step *= 0.5;
            } else {
                return Err(Lost { at });
            }
        }
        Ok(())
    }

    /// Moves `q`, inside the box, to the nearest configuration that meets the task at `pose`. Returns whether there is one.
    pub fn meet(&mut self, pose: &Frame, q: &mut [f64]) -> bool {
        let bounds = self.bounds_from(q);
        self.project(&self.tip.task.target(pose), q, &bounds)
    }

    /// Target of the tip at the length `s`.
    fn target(&self, path: &ToolPath, s: f64) -> PathTarget {
        self.tip.task.target(&path.pose(s))
    }

    /// Moves `q` to the nearest configuration that meets a target. Returns whether there is one.
    fn project(&mut self, target: &PathTarget, q: &mut [f64], bounds: &Bounds) -> bool {
        let (tip, mut value, mut count) = (self.tip, f64::INFINITY, 0);
        let mut borders = Borders::default();
        self.linearization.project(q, bounds, STEPS, |q, at| {
            let before = value;
            let frame = tip.frame_and_jacobian(q, &mut at.first.columns);
            value = target.linearize_tip(&frame, q.len(), &mut borders, at);
            count += 1;
            let is_stuck = value >= before && value <= AS_NEAR_AS_SOLVES;
            (!(value <= MET) && !is_stuck).then_some(DAMPING * value)
        });
        self.evaluations += count;
        value <= AS_NEAR_AS_SOLVES
    }

    /// The joint path through a track inside `limits`, with knots added until the tip stays on its path between them.
    ///
    /// # Errors
    /// [`Stray`] where knots do not help; interruptions.
    pub fn refined(
        &mut self,
        path: &ToolPath,
        mut track: Track,
        limits: &ConstantLimits,
    ) -> Result<Result<JointPath, Stray>> {
        let names = self.tip.joint_names();
        let mut coarse = vec![];
        if let Some(at) = track.rest() {
            return Ok(Err(Stray::Still { at }));
        }
        for _ in 0..ROUNDS {
            let joints = JointPath::spline(names.clone(), &track.rows, Some(&track.knots), SplineEnds::NotAKnot)?
                .inside(&limits.lower, &limits.upper);
            coarse.clear();
            for i in 0..track.knots.len() - 1 {
                checkpoint_at(i)?;
                if self.is_coarse(path, &joints, [track.knots[i], track.knots[i + 1]]) {
                    coarse.push(i);
                }
            }
            if coarse.is_empty() {
                let speeds = track.knots.windows(2).map(|ends| {
                    let piece = path.piece_at(0.5 * (ends[0] + ends[1]));
                    path.pieces[piece].speed.unwrap_or(f64::INFINITY)
                });
                return Ok(Ok(joints.with_speeds(speeds.collect())));
            }
            if track.knots.len() + coarse.len() > MOST_KNOTS {
                break;
            }
            match self.halved(path, &track, &coarse, &joints, limits) {
                Ok(finer) => track = finer,
                Err(stray) => return Ok(Err(stray)),
            }
        }
        Ok(Err(Stray::Lost(Lost { at: coarse.first().map_or(0.0, |i| track.knots[*i]) })))
    }

    fn is_coarse(&mut self, path: &ToolPath, joints: &JointPath, [from, to]: [f64; 2]) -> bool {
        let mut q = Point::from_elem(0.0, self.tip.dof());
        let allowed = |most: f64| most.min((SLOPE_ACCURACY * (to - from)).max(1e-9));
        self.evaluations += LOOKS.len();
        LOOKS.iter().any(|look| {
            let s = from + look * (to - from);
            joints.position(s, &mut q);
            let [distance, angle] = self.target(path, s).off(&self.tip.frame(&q));
            distance > allowed(ACCURACY[0]) || angle > ACCURACY[1]
        })
    }

    /// The track with the intervals `coarse` halved.
    fn halved(
        &mut self,
        path: &ToolPath,
        track: &Track,
        coarse: &[usize],
        joints: &JointPath,
        limits: &ConstantLimits,
    ) -> Result<Track, Stray> {
        let mut finer = Track { knots: vec![], rows: vec![] };
        let mut coarse = coarse.iter().peekable();
        let mut q = Point::from_elem(0.0, self.tip.dof());
        let bounds = self.bounds_from(track.row(0));
        for (i, knot) in track.knots.iter().enumerate() {
            finer.push(*knot, track.row(i));
            if coarse.next_if(|index| **index == i).is_some() {
                let middle = 0.5 * (knot + track.knots[i + 1]);
                joints.position(middle, &mut q);
                bounds.clip(&mut q);
                if !self.project(&self.target(path, middle), &mut q, &bounds) {
                    return Err(Stray::Lost(Lost { at: middle }));
                }
                if let Some((joint, value)) = limits.excess(&q) {
                    return Err(Stray::Beyond { at: middle, joint, value });
                }
                limits.clip(&mut q);
                finer.push(middle, &q);
            }
        }
        Ok(finer)
    }
}
