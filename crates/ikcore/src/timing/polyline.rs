//! Straight lines in joint space, and paths along them with corners rounded by parabolas.

use super::joint_path::{JointPath, NEGLIGIBLE_LENGTH, waypoint_rows};
use crate::error::{Error, Result};
use crate::math::vector::{distance, squared_distance};

/// Points (n each) joined by straight lines in joint space; consecutive points differ.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct JointPolyline(pub Vec<Vec<f64>>);

impl JointPath {
    /// Straight lines through `waypoints` (rad or m, one row of all joints per point). Each corner is replaced by a
    /// parabola from `blend` before it to `blend` after it (Euclidean distance in joint space; at most half of a line),
    /// which passes the corner at a distance of at most `blend` / 2. With `blend` zero the joints stop at each corner. A
    /// waypoint that repeats the previous one, to 1e-12 of the path's extent, is left out.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::NotFinite`], [`Error::InvalidPath`] where all waypoints are the same,
    /// [`Error::OutOfRange`] for `blend`.
    pub fn polyline(joints: Vec<String>, waypoints: &[f64], blend: f64) -> Result<Self> {
        waypoint_rows(&joints, waypoints)?;
        if !(blend >= 0.0 && blend.is_finite()) {
            return Err(Error::out_of_range("blend", "zero or more and finite", blend));
        }
        let rows: Vec<&[f64]> = waypoints.chunks_exact(joints.len()).collect();
        let negligible = NEGLIGIBLE_LENGTH * extent(&rows);
        let corners = JointPolyline::through(&rows, negligible);
        if corners.0.len() < 2 {
            let problem = "all waypoints are the same: give at least two that differ".into();
            return Err(Error::InvalidPath { problem });
        }
        Ok(corners.rounded(joints, blend, negligible))
    }
}

impl JointPolyline {
    /// Lines through the rows farther than `negligible` from the one kept before; the first and the last row stay.
    fn through(rows: &[&[f64]], negligible: f64) -> Self {
        let mut kept = vec![rows[0].to_vec()];
        for row in &rows[1..] {
            if distance(row, &kept[kept.len() - 1]) > negligible {
                kept.push(row.to_vec());
            }
        }
        if let [_, .., last] = &mut kept[..] {
            last.copy_from_slice(rows[rows.len() - 1]);
        }
        Self(kept)
    }

    /// The path along these lines, with a stop at each corner.
    pub(super) fn as_path(&self, joints: Vec<String>) -> JointPath {
        self.rounded(joints, 0.0, 0.0)
    }

    /// The path along these lines, each corner replaced by a parabola from `blend` before it to `blend` after it.
    fn rounded(&self, joints: Vec<String>, blend: f64, negligible: f64) -> JointPath {
        let legs: Vec<Leg> = self.0.windows(2).map(|ends| Leg::new(&ends[0], &ends[1])).collect();
        let mut pieces = Pieces { breaks: vec![0.0], lengths: Vec::new(), coefficients: Vec::new() };
        let mut cut_before = 0.0;
        for (i, leg) in legs.iter().enumerate() {
            let next = legs.get(i + 1);
            let widest = next.map_or(0.0, |next| blend.min(0.5 * leg.length).min(0.5 * next.length));
            let cut = if widest > negligible { widest } else { 0.0 };
            if leg.length - cut - cut_before > negligible {
                pieces.push_line(leg, cut_before, leg.length - cut);
            }
            if let Some(next) = next
                && cut > 0.0
            {
                pieces.push_blend(leg, next, cut);
            }
            cut_before = cut;
        }
        JointPath::from_parts(joints, pieces.breaks, pieces.lengths, pieces.coefficients)
    }
}

/// The largest distance of a row from the first.
fn extent(rows: &[&[f64]]) -> f64 {
    rows.iter().map(|row| squared_distance(row, rows[0])).fold(0.0, f64::max).sqrt()
}

/// One straight line.
struct Leg {
    start: Vec<f64>,
    direction: Vec<f64>,
    length: f64,
}

impl Leg {
    fn new(start: &[f64], end: &[f64]) -> Self {
        let length = distance(end, start);
        let direction = end.iter().zip(start).map(|(end, start)| (end - start) / length).collect();
        Self { start: start.to_vec(), direction, length }
    }

    fn at(&self, distance: f64) -> impl Iterator<Item = f64> + '_ {
        self.start.iter().zip(&self.direction).map(move |(start, direction)| start + distance * direction)
    }
}

/// The path under construction; its parameter is the length of the polyline.
struct Pieces {
    breaks: Vec<f64>,
    lengths: Vec<f64>,
    coefficients: Vec<f64>,
}

impl Pieces {
    fn push_line(&mut self, leg: &Leg, from: f64, to: f64) {
        self.push(to - from, leg.at(from), leg, leg.direction.iter().map(|_| 0.0));
    }

    /// q(s) = q(corner - cut) + s d_in + s^2 (d_out - d_in) / (4 cut): its slope turns from d_in to d_out.
    fn push_blend(&mut self, leg: &Leg, next: &Leg, cut: f64) {
        let turns = next.direction.iter().zip(&leg.direction).map(|(to, from)| (to - from) / (4.0 * cut));
        self.push(2.0 * cut, leg.at(leg.length - cut), leg, turns);
    }

    fn push(&mut self, length: f64, start: impl Iterator<Item = f64>, leg: &Leg, squares: impl Iterator<Item = f64>) {
        let begin = self.breaks[self.breaks.len() - 1];
        self.breaks.push(begin + length);
        self.lengths.push(length);
        self.coefficients.extend(start);
        self.coefficients.extend_from_slice(&leg.direction);
        self.coefficients.extend(squares);
        self.coefficients.extend(leg.direction.iter().map(|_| 0.0));
    }
}
