//! Cubic splines that stay inside position limits.
//!
//! A spline through points inside the limits may swing a little beyond them between the points, e.g. where a joint rests at its limit and
//! then leaves it. A spline is inside the convex hull of its B-spline control points, so control points inside the limits keep all of it
//! inside, with its slope and curvature continuous as before: C. de Boor, "A Practical Guide to Splines", chapters IX and XI.

use super::joint_path::JointPath;

impl JointPath {
    /// The same spline with its control points moved inside these limits, where it leaves them; its ends stay where they are. A joint is
    /// displaced by at most the distance by which its control points were outside.
    pub(crate) fn inside(mut self, lower: &[f64], upper: &[f64]) -> Self {
        for joint in 0..self.joints().len() {
            let [lowest, highest] = self.range(joint);
            if lowest < lower[joint] || highest > upper[joint] {
                let moved = self.moved_inside(joint, lower[joint], upper[joint]);
                self.displace(joint, &moved);
            }
        }
        self
    }

    /// Displacements of the control points of a joint, one per break, that move it inside its limits.
    fn moved_inside(&self, joint: usize, lower: f64, upper: f64) -> Vec<f64> {
        let of_break = |i: usize| {
            let control = self.control_point(i, joint);
            control.clamp(lower, upper) - control
        };
        (0..=self.pieces()).map(of_break).collect()
    }

    /// The control point that belongs to break `i`: the value of the blossom at this break and its two neighbours.
    fn control_point(&self, i: usize, joint: usize) -> f64 {
        let [before, after] = self.lengths_beside(i);
        let [value, slope, curvature] =
            if i < self.pieces() { self.joint_at(i, 0.0, joint) } else { self.joint_at(i - 1, before, joint) };
        value + slope * (after - before) / 3.0 - curvature * before * after / 6.0
    }

    /// Lengths of the pieces before and after break `i`; zero outside the path, whose ends are knots of full multiplicity.
    fn lengths_beside(&self, i: usize) -> [f64; 2] {
        [i.checked_sub(1), (i < self.pieces()).then_some(i)].map(|piece| piece.map_or(0.0, |piece| self.length(piece)))
    }

    /// Adds the spline with these control points, and zero at its ends, to a joint.
    fn displace(&mut self, joint: usize, controls: &[f64]) {
        let beziers: Vec<[f64; 2]> =
            (0..self.pieces()).map(|piece| self.inner_bezier_points(piece, controls)).collect();
        let mut at_break = vec![0.0; controls.len()];
        for i in 1..self.pieces() {
            let [before, after] = self.lengths_beside(i);
            at_break[i] = (after * beziers[i - 1][1] + before * beziers[i][0]) / (before + after);
        }
        for (piece, [first, second]) in beziers.into_iter().enumerate() {
            let ([start, end], h) = ([at_break[piece], at_break[piece + 1]], self.length(piece));
            if [start, first, second, end] == [0.0; 4] {
                continue;
            }
            let powers = [
                start,
                3.0 * (first - start) / h,
                3.0 * (second - 2.0 * first + start) / (h * h),
                (end - 3.0 * (second - first) - start) / (h * h * h),
            ];
            self.add(piece, joint, powers);
        }
    }

    /// The two inner Bezier points of a piece of the spline with these control points.
    fn inner_bezier_points(&self, piece: usize, controls: &[f64]) -> [f64; 2] {
        let [before, length] = self.lengths_beside(piece);
        let [_, after] = self.lengths_beside(piece + 1);
        let (whole, [from, to]) = (before + length + after, [controls[piece], controls[piece + 1]]);
        [((length + after) * from + before * to) / whole, (after * from + (before + length) * to) / whole]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::cubic_spline::SplineEnds;
    use crate::rng;

    fn spline(rows: &[f64], knots: &[f64]) -> JointPath {
        JointPath::spline(vec!["a".into()], rows, Some(knots), SplineEnds::NotAKnot).unwrap()
    }

    #[test]
    fn splines_that_rest_at_a_limit_do_not_pass_it() {
        let mut rng = rng::stream(7, 0);
        for case in 0..200 {
            let mut at = 0.0;
            let mut knots = vec![0.0];
            let mut rows = vec![1.0];
            for i in 1..30 {
                at += rng.uniform_in(0.01, 1.0);
                knots.push(at);
                let rests = i % 10 < 5;
                rows.push(if rests { [1.0, 0.0][case % 2] } else { rng.uniform_in(0.0, 1.0) });
            }
            let path = spline(&rows, &knots);
            let inside = path.clone().inside(&[0.0], &[1.0]);
            let [lowest, highest] = inside.range(0);
            assert!(lowest > -1e-13 && highest < 1.0 + 1e-13, "case {case}: {lowest} to {highest}");
            assert!((1..inside.pieces()).all(|piece| !inside.has_curvature_jump_after(piece - 1)), "case {case}");
            let mut ends = [[0.0]; 2];
            inside.position(0.0, &mut ends[0]);
            inside.position(at, &mut ends[1]);
            assert!((ends[0][0] - rows[0]).abs() < 1e-13 && (ends[1][0] - rows[29]).abs() < 1e-12, "case {case}");
        }
    }

    #[test]
    fn splines_inside_their_limits_keep_their_bits() {
        let path = spline(&[0.1, 0.5, 0.2, 0.8, 0.3], &[0.0, 0.3, 0.5, 1.1, 1.2]);
        assert_eq!(path.clone().inside(&[-2.0], &[2.0]), path);
    }

    #[test]
    fn control_points_make_the_spline() {
        let path = spline(&[0.1, 0.5, 0.2, 0.8, 0.3], &[0.0, 0.3, 0.5, 1.1, 1.2]);
        let controls: Vec<f64> = (0..5).map(|i| path.control_point(i, 0)).collect();
        for piece in 0..4 {
            let h = path.length(piece);
            let [q, slope, curvature] = path.joint_at(piece, 0.0, 0);
            let expected = [q + h * slope / 3.0, q + 2.0 * h * slope / 3.0 + h * h * curvature / 6.0];
            for (found, expected) in path.inner_bezier_points(piece, &controls).iter().zip(expected) {
                assert!((found - expected).abs() < 1e-14, "piece {piece}: {found} and {expected}");
            }
        }
    }
}
