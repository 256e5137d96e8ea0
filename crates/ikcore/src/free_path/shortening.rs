//! Shortening of a clear path by leaving out points and taking shortcuts.

use super::rrt_connect::TreeSearch;
use crate::math::vector::point_between;
use crate::rng::LazyRng;
use crate::solver::Monitor;
use crate::timing::JointPolyline;

/// Whether a new stretch of points is shorter than an old one with the same ends.
pub(super) type Shortens<'f> = &'f dyn Fn(&[Vec<f64>], &[Vec<f64>]) -> bool;

impl TreeSearch<'_> {
    /// Shortens a path: leaves out unnecessary points, then tries random `shortcuts`. Takes only what `shortens` an old
    /// stretch of points by a new one with the same ends.
    pub(super) fn shorten(
        &mut self,
        path: JointPolyline,
        (shortens, shortcuts): (Shortens<'_>, usize),
        rng: &mut LazyRng,
        monitor: &mut dyn Monitor,
    ) -> JointPolyline {
        let mut points = self.with_longest_lines(path.0, shortens);
        for _ in 0..shortcuts {
            if points.len() < 3 || self.is_spent() || !monitor.keep_going() {
                break;
            }
            let (first, second, lines) = (rng.uniform(), rng.uniform(), (points.len() - 1) as f64);
            let (i, mut from) = along(&points, first.min(second) * lines);
            let (k, mut to) = along(&points, first.max(second) * lines);
            if i == k || !self.check.bring(&mut from) || !self.check.bring(&mut to) {
                continue;
            }
            let mut old = vec![from.clone()];
            old.extend_from_slice(&points[i + 1..=k]);
            old.push(to.clone());
            if shortens(&old, &[from.clone(), to.clone()]) && self.check.is_clear(&from, &to) {
                points.splice(i + 1..=k, [from, to]);
                points.dedup();
            }
        }
        JointPolyline(self.with_longest_lines(points, shortens))
    }

    /// Connects each point to the farthest one that a straight line can reach.
    fn with_longest_lines(&mut self, points: Vec<Vec<f64>>, shortens: Shortens<'_>) -> Vec<Vec<f64>> {
        let last = points.len() - 1;
        let (mut i, mut kept) = (0, vec![points[0].clone()]);
        while i < last {
            let is_shorter = |k: usize| shortens(&points[i..=k], &[points[i].clone(), points[k].clone()]);
            let mut ends = (i + 2..=last).rev();
            let farthest = ends
                .find(|k| !self.deadline.is_over() && is_shorter(*k) && self.check.is_clear(&points[i], &points[*k]));
            i = farthest.unwrap_or(i + 1);
            kept.push(points[i].clone());
        }
        kept.dedup();
        kept
    }
}

/// Returns the line on which `position` lies (counted in lines), and the point there.
pub(super) fn along(points: &[Vec<f64>], position: f64) -> (usize, Vec<f64>) {
    let line = (position as usize).min(points.len() - 2);
    let fraction = position - line as f64;
    (line, point_between(&points[line], &points[line + 1], fraction).collect())
}
