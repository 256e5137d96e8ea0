//! Straight lines between waypoints, with corners rounded by parabolas.

use super::joint_path::{JointPath, check_waypoints};
use crate::error::{Error, Result};

impl JointPath {
    /// Straight lines through `waypoints` (rad or m, one row of all joints per point). Each corner is replaced by a
    /// parabola from `blend` before it to `blend` after it (Euclidean distance in joint space; at most half of a line),
    /// which passes the corner at a distance of at most `blend` / 2. With `blend` zero the joints stop at each corner.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::NotFinite`], [`Error::InvalidPath`] if a waypoint repeats the previous one,
    /// [`Error::OutOfRange`] for `blend`.
    pub fn polyline(joints: Vec<String>, waypoints: &[f64], blend: f64) -> Result<Self> {
        let rows = check_waypoints(&joints, waypoints)?;
        if !(blend >= 0.0 && blend.is_finite()) {
            return Err(Error::out_of_range("blend", "zero or more and finite", blend));
        }
        let n = joints.len();
        let legs: Vec<Leg> = (1..rows).map(|row| Leg::new(&waypoints[(row - 1) * n..(row + 1) * n])).collect();
        let mut pieces = Pieces { breaks: vec![0.0], coefficients: Vec::new() };
        let mut cut_before = 0.0;
        for (i, leg) in legs.iter().enumerate() {
            let next = legs.get(i + 1);
            let cut = next.map_or(0.0, |next| blend.min(0.5 * leg.length).min(0.5 * next.length));
            pieces.push_line(leg, cut_before, leg.length - cut);
            if let Some(next) = next
                && cut > 0.0
            {
                pieces.push_blend(leg, next, cut);
            }
            cut_before = cut;
        }
        Ok(Self::from_parts(joints, pieces.breaks, pieces.coefficients))
    }
}

/// One straight line.
struct Leg {
    start: Vec<f64>,
    direction: Vec<f64>,
    length: f64,
}

impl Leg {
    /// From its two ends, stored consecutively.
    fn new(ends: &[f64]) -> Self {
        let (start, end) = ends.split_at(ends.len() / 2);
        let difference: Vec<f64> = end.iter().zip(start).map(|(end, start)| end - start).collect();
        let length = difference.iter().map(|d| d * d).sum::<f64>().sqrt();
        Self { start: start.to_vec(), direction: difference.iter().map(|d| d / length).collect(), length }
    }

    fn at(&self, distance: f64) -> impl Iterator<Item = f64> + '_ {
        self.start.iter().zip(&self.direction).map(move |(start, direction)| start + distance * direction)
    }
}

/// The path under construction; its parameter is the length of the polyline.
struct Pieces {
    breaks: Vec<f64>,
    coefficients: Vec<f64>,
}

impl Pieces {
    fn push_line(&mut self, leg: &Leg, from: f64, to: f64) {
        if to > from {
            self.push(to - from, leg.at(from), leg, leg.direction.iter().map(|_| 0.0));
        }
    }

    /// q(s) = q(corner - cut) + s d_in + s^2 (d_out - d_in) / (4 cut): its slope turns from d_in to d_out.
    fn push_blend(&mut self, leg: &Leg, next: &Leg, cut: f64) {
        let turns = next.direction.iter().zip(&leg.direction).map(|(to, from)| (to - from) / (4.0 * cut));
        self.push(2.0 * cut, leg.at(leg.length - cut), leg, turns);
    }

    fn push(&mut self, length: f64, start: impl Iterator<Item = f64>, leg: &Leg, squares: impl Iterator<Item = f64>) {
        let begin = self.breaks[self.breaks.len() - 1];
        self.breaks.push(begin + length);
        self.coefficients.extend(start);
        self.coefficients.extend_from_slice(&leg.direction);
        self.coefficients.extend(squares);
        self.coefficients.extend(leg.direction.iter().map(|_| 0.0));
    }
}
