//! Cubic splines: the smoothest curve through waypoints.

use std::str::FromStr;

use super::joint_path::{JointPath, check_waypoints};
use crate::error::{Error, Result, require_finite};

/// What a spline does at its two ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SplineEnds {
    /// No curvature.
    #[default]
    Natural,
    /// The first two pieces are one cubic, and the last two.
    NotAKnot,
    /// No slope: the joints leave and arrive in the path parameter as they do in time.
    Clamped,
}

impl FromStr for SplineEnds {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self> {
        match name {
            "natural" => Ok(Self::Natural),
            "not-a-knot" => Ok(Self::NotAKnot),
            "clamped" => Ok(Self::Clamped),
            _ => Err(Error::unknown_option("spline", name, &["natural", "not-a-knot", "clamped", "polyline"])),
        }
    }
}

/// The curvature at an end from the two next to it: q''_end = slope_share secant + near q''_1 + far q''_2.
struct EndRule {
    secant_share: f64,
    near: f64,
    far: f64,
}

impl SplineEnds {
    /// The rule for an end whose piece has length `h`, the piece after it `next`, if there is one. `sign` is 1 at the
    /// beginning and -1 at the end.
    fn rule(self, h: f64, next: Option<f64>, rows: usize, sign: f64) -> EndRule {
        match (self, next) {
            (Self::Clamped, _) => EndRule { secant_share: sign * 3.0 / h, near: -0.5, far: 0.0 },
            // Three points: both conditions say that the curve is one parabola.
            (Self::NotAKnot, Some(_)) if rows == 3 => EndRule { secant_share: 0.0, near: 1.0, far: 0.0 },
            (Self::NotAKnot, Some(next)) => EndRule { secant_share: 0.0, near: 1.0 + h / next, far: -h / next },
            _ => EndRule { secant_share: 0.0, near: 0.0, far: 0.0 },
        }
    }
}

impl JointPath {
    /// The cubic spline of `joints` (names) through `waypoints` (rad or m; one row of all joints a point) at the path
    /// parameters `knots`; None: uniform in \[0, 1\].
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::NotFinite`], [`Error::InvalidPath`] where a waypoint repeats the one before it,
    /// [`Error::NotIncreasing`] for knots.
    pub fn spline(joints: Vec<String>, waypoints: &[f64], knots: Option<&[f64]>, ends: SplineEnds) -> Result<Self> {
        let rows = check_waypoints(&joints, waypoints)?;
        let breaks = match knots {
            None => (0..rows).map(|row| row as f64 / (rows - 1) as f64).collect(),
            Some(knots) => check_knots(knots, rows)?,
        };
        let n = joints.len();
        let spans: Vec<f64> = breaks.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let secants: Vec<f64> = (0..(rows - 1) * n).map(|i| (waypoints[i + n] - waypoints[i]) / spans[i / n]).collect();
        let bends = curvatures(&spans, &secants, n, ends);
        let mut coefficients = Vec::with_capacity(4 * secants.len());
        for (piece, h) in spans.iter().enumerate() {
            let of_piece = piece * n..(piece + 1) * n;
            coefficients.extend_from_slice(&waypoints[of_piece.clone()]);
            coefficients.extend(of_piece.clone().map(|i| secants[i] - h * (2.0 * bends[i] + bends[i + n]) / 6.0));
            coefficients.extend(of_piece.clone().map(|i| 0.5 * bends[i]));
            coefficients.extend(of_piece.map(|i| (bends[i + n] - bends[i]) / (6.0 * h)));
        }
        Ok(Self::from_parts(joints, breaks, coefficients))
    }
}

fn check_knots(knots: &[f64], rows: usize) -> Result<Vec<f64>> {
    if knots.len() != rows {
        let expected = format!("{rows} (one per waypoint)");
        return Err(Error::WrongLength { what: "knots".into(), expected, got: knots.len() });
    }
    require_finite("knots", knots, |row| format!("row {row}"))?;
    match (1..rows).find(|&row| knots[row] <= knots[row - 1]) {
        None => Ok(knots.to_vec()),
        Some(row) => {
            let (previous, value) = (knots[row - 1], knots[row]);
            Err(Error::NotIncreasing { what: "knots".into(), row, previous, value })
        }
    }
}

/// Second derivatives at all knots, row by row: a tridiagonal system of equal slopes on both sides of each inner knot,
/// h_(i-1) q''_(i-1) + 2 (h_(i-1) + h_i) q''_i + h_i q''_(i+1) = 6 (secant_i - secant_(i-1)).
fn curvatures(h: &[f64], secants: &[f64], n: usize, ends: SplineEnds) -> Vec<f64> {
    let last = h.len();
    let mut bends = vec![0.0; (last + 1) * n];
    if last == 1 {
        if ends == SplineEnds::Clamped {
            for j in 0..n {
                (bends[j], bends[n + j]) = (6.0 * secants[j] / h[0], -6.0 * secants[j] / h[0]);
            }
        }
        return bends;
    }
    let first_rule = ends.rule(h[0], h.get(1).copied(), last + 1, 1.0);
    let last_rule = ends.rule(h[last - 1], h.get(last.wrapping_sub(2)).copied(), last + 1, -1.0);
    // What is left above the diagonal after elimination, and the right side in place of the solution.
    let mut above = vec![0.0; last];
    for i in 1..last {
        let (mut below, mut diagonal, mut next) = (h[i - 1], 2.0 * (h[i - 1] + h[i]), h[i]);
        let (mut first_share, mut last_share) = (0.0, 0.0);
        if i == 1 {
            diagonal += below * first_rule.near;
            next += below * first_rule.far;
            first_share = below * first_rule.secant_share;
            below = 0.0;
        }
        if i == last - 1 {
            diagonal += h[i] * last_rule.near;
            below += h[i] * last_rule.far;
            last_share = h[i] * last_rule.secant_share;
        }
        let pivot = diagonal - below * above[i - 1];
        above[i] = next / pivot;
        for j in 0..n {
            let [before, after] = [secants[(i - 1) * n + j], secants[i * n + j]];
            let right = 6.0 * (after - before) - first_share * before - last_share * after;
            bends[i * n + j] = (right - below * bends[(i - 1) * n + j]) / pivot;
        }
    }
    for i in (1..last - 1).rev() {
        for j in 0..n {
            bends[i * n + j] -= above[i] * bends[(i + 1) * n + j];
        }
    }
    for j in 0..n {
        let at = |row: usize| bends[row * n + j];
        let [near_first, far_first] = [at(1), at(2.min(last - 1))];
        let [near_last, far_last] = [at(last - 1), at(last.saturating_sub(2).max(1))];
        bends[j] = first_rule.secant_share * secants[j] + first_rule.near * near_first + first_rule.far * far_first;
        bends[last * n + j] = last_rule.secant_share * secants[(last - 1) * n + j]
            + last_rule.near * near_last
            + last_rule.far * far_last;
    }
    bends
}
