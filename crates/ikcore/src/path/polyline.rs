//! Straight segments.

use serde::{Deserialize, Serialize};

use super::curve::Curve;
use super::waypoints::check_points;
use crate::error::{Error, Result, require_positive};
use crate::math::Knots;

/// Straight segments from vertex to vertex, each at its own constant speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "(Knots, Vec<[f64; 3]>)")]
pub struct Polyline {
    knots: Knots,
    vertices: Vec<[f64; 3]>,
}

/// Checks stored segments again.
impl TryFrom<(Knots, Vec<[f64; 3]>)> for Polyline {
    type Error = Error;

    fn try_from((knots, vertices): (Knots, Vec<[f64; 3]>)) -> Result<Self> {
        Self::through(knots.times().to_vec(), vertices)
    }
}

impl Polyline {
    /// Segments through `points` (m) in `duration` (s), at constant speed. Repeated points are skipped.
    ///
    /// # Errors
    /// [`Error::InvalidPath`] for fewer than 2 points or points without extent, [`Error::NotFinite`],
    /// [`Error::OutOfRange`] for a duration that is not positive.
    pub fn new(points: &[[f64; 3]], duration: f64) -> Result<Self> {
        require_positive("duration", duration)?;
        check_points(points)?;
        let travelled = arc_lengths(points);
        let length = travelled[points.len() - 1];
        if !(length.is_finite() && length > 0.0) {
            let problem = format!("the points of a polyline must span a positive, finite length, not {length} m");
            return Err(Error::InvalidPath { problem });
        }
        let (mut times, mut vertices) = (vec![0.0], vec![points[0]]);
        for (point, arc_length) in points.iter().zip(travelled).skip(1) {
            let time = duration * (arc_length / length);
            if times.last().is_some_and(|last| time > *last) {
                times.push(time);
                vertices.push(*point);
            }
        }
        Self::through(times, vertices)
    }

    /// Segments that pass each vertex (m) at its time (s).
    pub(super) fn through(times: Vec<f64>, vertices: Vec<[f64; 3]>) -> Result<Self> {
        check_points(&vertices)?;
        if times.len() != vertices.len() {
            let expected = format!("{}, one a point", vertices.len());
            return Err(Error::WrongLength { what: "path times".into(), expected, got: times.len() });
        }
        Ok(Self { knots: Knots::new("path times", times)?, vertices })
    }

    /// Segments between `vertices` (m), each taking an equal part of `duration` (s).
    pub(super) fn equal_times<const N: usize>(vertices: [[f64; 3]; N], duration: f64) -> Result<Self> {
        require_positive("duration", duration)?;
        let times = (0..N).map(|i| duration * (i as f64 / (N - 1) as f64)).collect();
        Self::through(times, vertices.to_vec())
    }

    /// Times of the vertices.
    pub(super) fn knots(&self) -> &Knots {
        &self.knots
    }
}

impl Curve for Polyline {
    fn duration(&self) -> f64 {
        self.knots.duration()
    }

    fn position(&self, t: f64) -> [f64; 3] {
        let (segment, elapsed) = self.knots.locate(t);
        let fraction = elapsed / self.knots.span(segment);
        let [from, to] = [self.vertices[segment], self.vertices[segment + 1]];
        // Exact at both ends.
        std::array::from_fn(|i| (1.0 - fraction) * from[i] + fraction * to[i])
    }

    fn velocity(&self, t: f64) -> [f64; 3] {
        let (segment, _) = self.knots.locate(t);
        let [from, to] = [self.vertices[segment], self.vertices[segment + 1]];
        std::array::from_fn(|i| (to[i] - from[i]) / self.knots.span(segment))
    }

    fn corners(&self) -> Vec<f64> {
        self.knots.times()[1..self.vertices.len() - 1].to_vec()
    }
}

/// The length (m) travelled up to each point.
fn arc_lengths(points: &[[f64; 3]]) -> Vec<f64> {
    let segments = points.windows(2).map(|ends| {
        let [x, y, z]: [f64; 3] = std::array::from_fn(|i| ends[1][i] - ends[0][i]);
        x.hypot(y).hypot(z)
    });
    let mut travelled = 0.0;
    let sums = segments.map(|length| {
        travelled += length;
        travelled
    });
    std::iter::once(0.0).chain(sums).collect()
}
