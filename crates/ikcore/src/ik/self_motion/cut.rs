//! Clips a traced curve to the joint limits.

use smallvec::SmallVec;

use super::curve_walk::CurvePoint;
use super::trace::TracedCurve;
use super::wrapped_limits::WrappedLimits;
use crate::math::MAX_DOF;
use crate::math::hermite::Cubic;
use crate::math::vector::distance;
use crate::objective::Point;

/// Part of a curve within the limits, whole turns aside.
#[derive(Debug, Clone, Default)]
pub(super) struct CurvePart {
    pub points: Vec<Point>,
    /// Whether the part is a whole closed curve: the last point is followed by the first.
    pub closed: bool,
    /// Whether the first and the last point are where the curve leaves the limits, not where tracing ended.
    pub cut: [bool; 2],
}

/// Returns the parts of a curve within the limits, in order.
pub(super) fn parts(curve: &TracedCurve, limits: &WrappedLimits<'_>) -> Vec<CurvePart> {
    let points = &curve.points;
    let steps = if curve.closed { points.len() } else { points.len().saturating_sub(1) };
    let mut parts: Vec<CurvePart> = Vec::new();
    let mut open = false;
    for k in 0..steps {
        let (begin, end) = (&points[k], &points[(k + 1) % points.len()]);
        let ways = ways(limits, begin, end);
        let pieces = limits.pieces(&ways);
        let ends_inside = pieces.last().is_some_and(|[_, to]| *to == 1.0);
        for [from, to] in pieces {
            if !(from == 0.0 && open) {
                let point = if from == 0.0 { begin.q.clone() } else { at(&ways, from) };
                parts.push(CurvePart { points: vec![point], closed: false, cut: [from > 0.0, false] });
            }
            if let Some(part) = parts.last_mut() {
                part.points.push(if to == 1.0 { end.q.clone() } else { at(&ways, to) });
                part.cut[1] = to < 1.0;
            }
            open = false;
        }
        open = ends_inside;
    }
    if curve.closed && open {
        join_ends(&mut parts, points);
    }
    parts
}

/// Joins the last part of a closed curve with the first if the first point of the curve is within the limits.
fn join_ends(parts: &mut Vec<CurvePart>, points: &[CurvePoint]) {
    let begins_inside = parts.first().is_some_and(|first| !first.cut[0] && first.points[0] == points[0].q);
    if !begins_inside {
        return;
    }
    if parts.len() == 1 && parts[0].points.len() > points.len() {
        parts[0].points.pop();
        parts[0].closed = true;
        return;
    }
    if let Some(mut last) = parts.pop()
        && !parts.is_empty()
    {
        last.points.pop();
        last.points.append(&mut parts[0].points);
        last.cut[1] = parts[0].cut[1];
        parts[0] = last;
    }
}

/// Cubics of the joints over a step, each starting near the middle of its limits.
fn ways(limits: &WrappedLimits<'_>, begin: &CurvePoint, end: &CurvePoint) -> SmallVec<[Cubic; MAX_DOF]> {
    let there = limits.apart(&end.q, &begin.q);
    let length = distance(&there, &Point::from_elem(0.0, there.len()));
    (0..there.len())
        .map(|j| {
            let from = limits.near_middle(j, begin.q[j]);
            Cubic::new([from, from + there[j]], [length * begin.along[j], length * end.along[j]])
        })
        .collect()
}

fn at(ways: &[Cubic], fraction: f64) -> Point {
    ways.iter().map(|way| way.at(fraction)).collect()
}
