//! Motion profile of one joint in time.

use smallvec::SmallVec;

use super::motion_state::MotionState;
use super::phases::{Phases, ROUNDING};
use crate::math::polynomial::quadratic_roots;
use crate::math::vector::between;

/// Segment of constant jerk: its start (s), and state and jerk there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointSegment {
    /// Start time (s).
    pub time: f64,
    /// State at the start.
    pub state: MotionState,
    /// Jerk.
    pub jerk: f64,
}

/// Motion profile of one joint from t = 0 on.
#[derive(Debug, Clone, PartialEq)]
pub struct JointProfile {
    /// Segments in order; the first starts at zero.
    pub segments: SmallVec<[JointSegment; 8]>,
    /// Duration (s).
    pub duration: f64,
}

impl JointProfile {
    /// Creates an empty profile.
    pub(super) fn empty() -> Self {
        Self { segments: SmallVec::new(), duration: 0.0 }
    }

    /// Returns a profile of zero duration at `state`.
    pub fn still(state: MotionState) -> Self {
        let mut profile = Self::empty();
        profile.segments.push(JointSegment { time: 0.0, state, jerk: 0.0 });
        profile
    }

    /// Appends `duration` (s) of constant jerk from `state` on.
    pub(super) fn push(&mut self, state: MotionState, jerk: f64, duration: f64) {
        if duration > 0.0 {
            self.segments.push(JointSegment { time: self.duration, state, jerk });
            self.duration += duration;
        }
    }

    /// Builds the profile of these phases from the position `q`; `duration` (s) equals their sum up to rounding.
    pub(super) fn of(phases: &Phases, q: f64, duration: f64) -> Self {
        let mut motion = Self::empty();
        let mut state = MotionState { q, v: phases.velocity, a: 0.0 };
        for phase in &phases.phases {
            state.a = phase.acceleration;
            motion.push(state, phase.jerk, phase.duration);
            state = state.after(phase.jerk, phase.duration);
        }
        while motion.segments.last().is_some_and(|segment| segment.time >= duration) {
            motion.segments.pop();
        }
        if motion.segments.is_empty() {
            motion = Self::still(MotionState { q, ..state });
        }
        Self { duration, ..motion }
    }

    /// Corrects rounding of the final position to `q`: by the velocity of the longest segment, changed by up to `rounding`
    /// (rad/s or m/s), and otherwise by the position after it.
    pub(super) fn ending_at(mut self, q: f64, rounding: f64) -> Self {
        let error = q - self.at(self.duration).q;
        let (mut longest, mut longest_span) = (0, 0.0);
        for i in 0..self.segments.len() {
            let span = self.end_of(i) - self.segments[i].time;
            if span > longest_span {
                (longest, longest_span) = (i, span);
            }
        }
        // The velocities at both ends must not change.
        if 0 < longest && longest + 1 < self.segments.len() {
            self.segments[longest].state.v += (error / longest_span).clamp(-rounding, rounding);
        }
        self.segments[longest + 1..].iter_mut().for_each(|segment| segment.state.q += error);
        self
    }

    /// Returns the end time of a segment (s).
    fn end_of(&self, segment: usize) -> f64 {
        self.segments.get(segment + 1).map_or(self.duration, |next| next.time)
    }

    /// Returns the segment at time `t` (s), clamped to the motion.
    pub fn segment_at(&self, t: f64) -> &JointSegment {
        let started = self.segments.partition_point(|segment| segment.time <= t);
        &self.segments[started.saturating_sub(1)]
    }

    /// Returns the state at time `t` (s), between start and end.
    pub fn at(&self, t: f64) -> MotionState {
        let segment = self.segment_at(t);
        segment.state.after(segment.jerk, t - segment.time)
    }

    /// Returns the lowest and the highest position.
    pub fn range(&self) -> (f64, f64) {
        let mut range = (f64::INFINITY, f64::NEG_INFINITY);
        let mut visit = |q: f64| range = (range.0.min(q), range.1.max(q));
        for (i, segment) in self.segments.iter().enumerate() {
            let end = self.end_of(i) - segment.time;
            let MotionState { v, a, .. } = segment.state;
            let turns = quadratic_roots(v, a, 0.5 * segment.jerk, 0.0, end);
            turns.into_iter().chain([0.0, end]).for_each(|t| visit(segment.state.after(segment.jerk, t).q));
        }
        range
    }

    /// Returns the weighted mean with `other`, which has the same duration; `fraction` is the weight of this motion.
    pub(super) fn mean(&self, fraction: f64, other: &Self) -> Self {
        let mut mean = Self { segments: SmallVec::new(), duration: self.duration };
        let (mut i, mut k) = (0, 0);
        let start = |motion: &Self, index: usize| motion.segments.get(index).map_or(f64::INFINITY, |s| s.time);
        let (mut time, mut q) = (0.0, self.segments[0].state.q);
        loop {
            let (one, two) = (&self.segments[i], &other.segments[k]);
            let (a, b) = (one.state.after(one.jerk, time - one.time), two.state.after(two.jerk, time - two.time));
            let blend = |x: f64, y: f64| between(y, x, fraction);
            let state = MotionState { q, v: blend(a.v, b.v), a: blend(a.a, b.a) };
            let segment = JointSegment { time, state, jerk: blend(one.jerk, two.jerk) };
            mean.segments.push(segment);
            let next = start(self, i + 1).min(start(other, k + 1));
            if next == f64::INFINITY {
                return mean;
            }
            let together = next + ROUNDING * self.duration;
            if start(self, i + 1) <= together {
                i += 1;
            }
            if start(other, k + 1) <= together {
                k += 1;
            }
            // Integration of the mean: blending two distant positions would lose digits.
            q = segment.state.after(segment.jerk, next - time).q;
            time = next;
        }
    }

    /// Appends constant velocity until `duration` (s).
    pub fn extended_to(mut self, duration: f64) -> Self {
        let last = self.segments.last().map(|segment| segment.state.after(segment.jerk, self.duration - segment.time));
        let state = MotionState { a: 0.0, ..last.unwrap_or_default() };
        let more = duration - self.duration;
        self.push(state, 0.0, more);
        self
    }

    /// Appends the motion `next`.
    pub(super) fn then(mut self, next: &Self) -> Self {
        let start = self.duration;
        self.segments
            .extend(next.segments.iter().map(|segment| JointSegment { time: start + segment.time, ..*segment }));
        self.duration += next.duration;
        self
    }
}
