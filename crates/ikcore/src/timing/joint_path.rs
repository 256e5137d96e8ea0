//! Geometric path of the joints: cubics in a path parameter, without timing.

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result, require_finite};
use crate::interrupt::checkpoint_at;
use crate::math::polynomial::{derivative, roots};

/// Number of coefficients of a cubic.
pub(super) const POWERS: usize = 4;

/// Distance below which two waypoints count as one, and a line between two blends as none, relative to the extent of the
/// waypoints: the time for it would be lost to rounding.
pub(super) const NEGLIGIBLE_LENGTH: f64 = 1e-12;

/// Largest difference of a derivative on both sides of a break before it counts as a jump (relative to its size there).
const JUMP_TOLERANCE: f64 = 1e-9;

/// Largest difference of a derivative on both sides of a break that is only rounding (relative).
const SAME: f64 = 1e-12;

/// Largest slope that counts as zero, relative to the largest of the path: rounding error.
const VANISHING: f64 = 1e-12;

/// A continuous path of all joints: piecewise cubics q(s) in the path parameter s.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "StoredParts")]
pub struct JointPath {
    joints: Vec<String>,
    /// Path parameters of the starts of all pieces, and of the end of the last.
    breaks: Vec<f64>,
    /// Length of each piece in the parameter. Differences of `breaks` would lose the digits of a short piece that
    /// begins far along the path.
    lengths: Vec<f64>,
    /// Coefficients of powers of s since the start of the piece: by piece, then by power, then by joint, because a grid
    /// point needs one power of all joints.
    coefficients: Vec<f64>,
    /// Largest path speed ds/dt on each piece; empty where only the joints limit it.
    speeds: Vec<f64>,
}

/// The fields of a path, in order.
type StoredParts = (Vec<String>, Vec<f64>, Vec<f64>, Vec<f64>, Vec<f64>);

/// Checks stored paths again.
impl TryFrom<StoredParts> for JointPath {
    type Error = Error;

    fn try_from((joints, breaks, lengths, coefficients, speeds): StoredParts) -> Result<Self> {
        let pieces = lengths.len();
        let fits = pieces > 0 && breaks.len() == pieces + 1 && coefficients.len() == pieces * POWERS * joints.len();
        let increases = breaks.windows(2).all(|ends| ends[0] < ends[1]) && lengths.iter().all(|length| *length > 0.0);
        let paced = (speeds.is_empty() || speeds.len() == pieces) && speeds.iter().all(|speed| *speed > 0.0);
        if joints.is_empty() || !fits || !increases || !paced {
            return Err(Error::InvalidPath { problem: "its parts contradict each other".into() });
        }
        require_finite("joint path", &breaks, |i| format!("break {i}"))?;
        require_finite("joint path", &coefficients, |i| format!("coefficient {i}"))?;
        Ok(Self { joints, breaks, lengths, coefficients, speeds })
    }
}

/// One of the two ends of a path.
#[derive(Debug, Clone, Copy)]
pub(super) enum PathEnd {
    Start,
    End,
}

impl PathEnd {
    /// Name in messages and options.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::End => "end",
        }
    }
}

impl JointPath {
    /// A path of pieces that were already checked.
    pub(super) fn from_parts(joints: Vec<String>, breaks: Vec<f64>, lengths: Vec<f64>, coefficients: Vec<f64>) -> Self {
        Self { joints, breaks, lengths, coefficients, speeds: Vec::new() }
    }

    /// The same path with a largest path speed ds/dt on each piece, positive; infinite where only the joints limit it.
    pub(crate) fn with_speeds(self, speeds: Vec<f64>) -> Self {
        debug_assert_eq!(speeds.len(), self.pieces());
        Self { speeds, ..self }
    }

    /// Whether any piece has a largest path speed.
    pub(super) fn has_speeds(&self) -> bool {
        self.speeds.iter().any(|speed| speed.is_finite())
    }

    /// Largest path speed on a piece; infinite where only the joints limit it.
    pub(crate) fn largest_speed(&self, piece: usize) -> f64 {
        self.speeds.get(piece).copied().unwrap_or(f64::INFINITY)
    }

    /// Concatenates paths, each of which starts where the previous one ends; at least one.
    pub(crate) fn joined(paths: impl IntoIterator<Item = Self>) -> Option<Self> {
        paths.into_iter().reduce(|mut all, next| {
            if !(all.speeds.is_empty() && next.speeds.is_empty()) {
                all.speeds = (0..all.pieces()).map(|piece| all.largest_speed(piece)).collect();
                all.speeds.extend((0..next.pieces()).map(|piece| next.largest_speed(piece)));
            }
            all.breaks.extend(&next.breaks[1..]);
            all.lengths.extend(&next.lengths);
            all.coefficients.extend(&next.coefficients);
            all
        })
    }

    /// Names of the joints.
    pub fn joints(&self) -> &[String] {
        &self.joints
    }

    /// Path parameters of the starts of all pieces, and of the end of the last.
    pub fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    /// Number of pieces.
    pub fn pieces(&self) -> usize {
        self.breaks.len() - 1
    }

    /// Length of a piece in the path parameter.
    pub fn length(&self, piece: usize) -> f64 {
        self.lengths[piece]
    }

    /// Coefficients of all joints in a piece, for the powers 1, s, s^2 and s^3.
    #[inline]
    pub(super) fn powers(&self, piece: usize) -> [&[f64]; POWERS] {
        let n = self.joints.len();
        let of_piece = &self.coefficients[piece * POWERS * n..(piece + 1) * POWERS * n];
        let ((c0, c1), (c2, c3)) = (of_piece[..2 * n].split_at(n), of_piece[2 * n..].split_at(n));
        [c0, c1, c2, c3]
    }

    /// Adds a cubic to a joint in a piece.
    pub(super) fn add(&mut self, piece: usize, joint: usize, cubic: [f64; POWERS]) {
        let n = self.joints.len();
        for (power, coefficient) in cubic.into_iter().enumerate() {
            self.coefficients[(piece * POWERS + power) * n + joint] += coefficient;
        }
    }

    /// Position of one joint and its first and second derivative by the path parameter, at `from` within a piece.
    pub(crate) fn joint_at(&self, piece: usize, from: f64, joint: usize) -> [f64; 3] {
        let [c0, c1, c2, c3] = self.powers(piece).map(|of_power| of_power[joint]);
        [
            c0 + from * (c1 + from * (c2 + from * c3)),
            c1 + from * (2.0 * c2 + from * 3.0 * c3),
            2.0 * c2 + 6.0 * from * c3,
        ]
    }

    /// Writes the positions of all joints and their first and second derivatives by the path parameter, at `from` within a piece.
    pub(super) fn write(&self, piece: usize, from: f64, [q, first, second]: [&mut [f64]; 3]) {
        let [c0, c1, c2, c3] = self.powers(piece);
        for j in 0..c0.len() {
            q[j] = c0[j] + from * (c1[j] + from * (c2[j] + from * c3[j]));
            first[j] = c1[j] + from * (2.0 * c2[j] + from * 3.0 * c3[j]);
            second[j] = 2.0 * c2[j] + 6.0 * from * c3[j];
        }
    }

    /// Writes the position of all joints (rad or m) at the path parameter `s`, clamped to the path.
    pub fn position(&self, s: f64, q: &mut [f64]) {
        let (piece, from) = self.locate(s);
        for (joint, q) in q.iter_mut().enumerate() {
            *q = self.joint_at(piece, from, joint)[0];
        }
    }

    /// Writes position and dq/ds of all joints at the path parameter `s`, clamped to the path.
    pub(crate) fn position_and_slope(&self, s: f64, q: &mut [f64], slope: &mut [f64]) {
        let (piece, from) = self.locate(s);
        for (joint, (q, slope)) in q.iter_mut().zip(slope).enumerate() {
            [*q, *slope, _] = self.joint_at(piece, from, joint);
        }
    }

    /// The piece that contains the path parameter `s`, clamped to the path, and the parameter within it.
    pub(crate) fn locate(&self, s: f64) -> (usize, f64) {
        let piece = self.breaks.partition_point(|start| *start <= s).saturating_sub(1).min(self.pieces() - 1);
        (piece, s.clamp(self.breaks[0], self.breaks[self.pieces()]) - self.breaks[piece])
    }

    /// The piece at an end of the path, and the parameter of the end within it.
    fn located_end(&self, end: PathEnd) -> (usize, f64) {
        match end {
            PathEnd::Start => (0, 0.0),
            PathEnd::End => (self.pieces() - 1, self.length(self.pieces() - 1)),
        }
    }

    /// Euclidean norm of dq/ds at an end of the path.
    pub(super) fn slope(&self, end: PathEnd) -> f64 {
        let (piece, from) = self.located_end(end);
        (0..self.joints.len()).map(|joint| self.joint_at(piece, from, joint)[1].powi(2)).sum::<f64>().sqrt()
    }

    /// Whether dq/ds vanishes at an end of the path, e.g. for a clamped spline.
    pub(super) fn has_no_direction(&self, end: PathEnd) -> bool {
        let (piece, _) = self.located_end(end);
        let chord = (0..self.joints.len())
            .map(|joint| self.joint_at(piece, self.length(piece), joint)[0] - self.joint_at(piece, 0.0, joint)[0])
            .fold(0.0, |sum: f64, d| sum + d * d)
            .sqrt();
        self.slope(end) <= VANISHING * chord / self.length(piece)
    }

    /// Whether the direction jumps between this piece and the next, so that the joints must stop there.
    pub(super) fn has_corner_after(&self, piece: usize) -> bool {
        self.jumps_after(piece, 1)
    }

    /// Whether the first two derivatives at the end of this piece are those at the start of the next, up to rounding.
    pub(super) fn continues_after(&self, piece: usize) -> bool {
        let end = self.length(piece);
        let ([_, c1, c2, c3], [_, next1, next2, _]) = (self.powers(piece), self.powers(piece + 1));
        let is_same = |one: f64, other: f64| (one - other).abs() <= SAME * one.abs();
        (0..self.joints.len()).all(|joint| {
            let first = c1[joint] + end * (2.0 * c2[joint] + end * 3.0 * c3[joint]);
            is_same(first, next1[joint]) && is_same(2.0 * c2[joint] + 6.0 * end * c3[joint], 2.0 * next2[joint])
        })
    }

    /// Whether the second derivative jumps between this piece and the next: the jerk would be infinite.
    pub(super) fn has_curvature_jump_after(&self, piece: usize) -> bool {
        self.has_corner_after(piece) || self.jumps_after(piece, 2)
    }

    fn jumps_after(&self, piece: usize, order: usize) -> bool {
        let (end, mut jump, mut size) = (self.length(piece), 0.0_f64, 0.0_f64);
        for joint in 0..self.joints.len() {
            let [before, after] = [self.joint_at(piece, end, joint), self.joint_at(piece + 1, 0.0, joint)];
            jump = jump.max((after[order] - before[order]).abs());
            // The rounding error of a derivative is proportional to the lower ones, and to the way where these vanish.
            let chord = (before[0] - self.joint_at(piece, 0.0, joint)[0]).abs() / end.powi(order as i32);
            let scale = |at: &[f64; 3]| at[1].abs() / end.powi(order as i32 - 1) + at[order].abs();
            size = size.max(chord).max(scale(&before)).max(scale(&after));
        }
        jump > JUMP_TOLERANCE * size
    }

    /// Excess of a joint over this range (rad, m), summed over the pieces, from their Bezier points: these enclose the
    /// curve and are quicker to compute than its extremes.
    pub(crate) fn excess(&self, joint: usize, lower: f64, upper: f64) -> f64 {
        let of_piece = |piece: usize| {
            let [_, first, second, end] = self.bezier_points(piece, joint);
            let beyond = |q: f64| (lower - q).max(q - upper).max(0.0);
            beyond(first).max(beyond(second)).max(beyond(end))
        };
        (0..self.pieces()).map(of_piece).sum()
    }

    /// The exact smallest and largest position of a joint (rad or m).
    pub fn range(&self, joint: usize) -> [f64; 2] {
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for piece in 0..self.pieces() {
            if checkpoint_at(piece).is_err() {
                break; // the interrupted caller discards the result
            }
            let [start, first, second, end] = self.bezier_points(piece, joint);
            range = [range[0].min(start).min(end), range[1].max(start).max(end)];
            // Few pieces turn back beyond what others reach: the inner Bezier points tell which cannot.
            if first.min(second) < range[0] || first.max(second) > range[1] {
                let cubic = self.powers(piece).map(|of_power| of_power[joint]);
                for s in roots(&derivative(&cubic), 0.0, self.length(piece)) {
                    let q = self.joint_at(piece, s, joint)[0];
                    range = [range[0].min(q), range[1].max(q)];
                }
            }
        }
        range
    }

    /// The Bezier points of a joint over a piece; they enclose it, and it goes through the first and the last.
    fn bezier_points(&self, piece: usize, joint: usize) -> [f64; 4] {
        let [c0, c1, c2, c3] = self.powers(piece).map(|of_power| of_power[joint]);
        let h = self.length(piece);
        let end = c0 + h * (c1 + h * (c2 + h * c3));
        [c0, c0 + h * c1 / 3.0, c0 + h * (2.0 * c1 + h * c2) / 3.0, end]
    }
}

/// Checks that these are at least two rows with one finite position per joint. Returns their number.
pub(super) fn waypoint_rows(joints: &[String], waypoints: &[f64]) -> Result<usize> {
    let n = joints.len();
    if n == 0 {
        return Err(Error::InvalidPath { problem: "it needs at least 1 joint".into() });
    }
    if !waypoints.len().is_multiple_of(n) {
        let expected = format!("rows of {n} joints");
        return Err(Error::WrongLength { what: "waypoints".into(), expected, got: waypoints.len() });
    }
    let rows = waypoints.len() / n;
    if rows < 2 {
        return Err(Error::WrongLength { what: "waypoints".into(), expected: "at least 2".into(), got: rows });
    }
    require_finite("waypoints", waypoints, |i| format!("joint '{}' of row {}", joints[i % n], i / n))?;
    Ok(rows)
}
