//! A rounded corner between two joint paths, of which at least one is no path of the tip.
//!
//! Each joint follows a quintic Bezier curve that meets both paths with their first and second derivative. Its parameter is a quintic of
//! the run's, which gives both paths their own rate.

use super::moving_tip::MovingTip;
use crate::math::so3::norm;
use crate::math::vector::distance;
use crate::math::vector3::sub;
use crate::objective::Point;
use crate::timing::{ConstantLimits, JointPath};

/// Length of the first and the last side of the control polygon, as a fraction of the rest of the path up to the corner.
const SIDE: f64 = 0.4;

/// Number of samples of a corner, and of the ways into and out of it.
const SAMPLES: usize = 64;
/// Number of halvings towards the crossing of a way and its ball.
const HALVINGS: usize = 30;

/// Factor by which a ball shrinks until the curve is inside the requested one.
const SHRINK: f64 = 0.7;
/// Maximum number of balls tried.
const SHRINKINGS: usize = 8;

/// A corner, and where it leaves the one path and enters the other.
#[derive(Debug)]
pub(super) struct JointCorner {
    /// Path parameter at which the path before is left.
    pub left: f64,
    /// Path parameter at which the path after is entered.
    pub entered: f64,
    /// Length in the parameter of the run.
    pub length: f64,
    /// Control points of each joint.
    controls: Vec<[f64; 6]>,
    /// Control values of the parameter of the curve.
    parameter: [f64; 6],
}

impl JointCorner {
    /// The corner from `before` to `after`, not earlier than `first` on the one nor later than `last` on the other, with all `tips` within
    /// `radius` (m). `None` where no curve that was tried is.
    pub fn between(
        tips: &[MovingTip<'_>],
        limits: &ConstantLimits,
        [before, after]: [&JointPath; 2],
        [first, last]: [f64; 2],
        radius: f64,
    ) -> Option<Self> {
        let [end, start] = [before.breaks()[before.pieces()], after.breaks()[0]];
        let mut q = Point::from_elem(0.0, after.joints().len());
        after.position(start, &mut q);
        let balls: Vec<Ball<'_>> = tips.iter().map(|tip| Ball { tip, center: tip.position(&q) }).collect();
        let mut ball = radius;
        for _ in 0..SHRINKINGS {
            let left = crossing(&balls, before, ball, [end, first]);
            let entered = crossing(&balls, after, ball, [start, last]);
            if end - left > 0.0 && entered - start > 0.0 {
                let found = Self::of([before, after], [left, entered], [end - left, entered - start]);
                if balls.iter().all(|ball| found.is_within(ball, limits, radius)) {
                    return Some(found);
                }
            }
            ball *= SHRINK;
        }
        None
    }

    fn of([before, after]: [&JointPath; 2], [left, entered]: [f64; 2], rests: [f64; 2]) -> Self {
        let [a, b] = rests.map(|rest| SIDE * rest);
        let ((i, from), (k, to)) = (before.locate(left), after.locate(entered));
        let of_joint = |joint: usize| {
            let [q0, d0, e0] = before.joint_at(i, from, joint);
            let [q1, d1, e1] = after.joint_at(k, to, joint);
            [
                q0,
                q0 + a * d0,
                q0 + 2.0 * a * d0 + 1.25 * a * a * e0,
                q1 - 2.0 * b * d1 + 1.25 * b * b * e1,
                q1 - b * d1,
                q1,
            ]
        };
        let controls = (0..before.joints().len()).map(of_joint).collect();
        // Rates of the curve's parameter with which both paths keep their own.
        let rates = [0.2 / a, 0.2 / b];
        let length = 2.0 / (rates[0] + rates[1]);
        let [begin, end] = rates.map(|rate| 0.2 * rate * length);
        Self { left, entered, length, controls, parameter: [0.0, begin, 2.0 * begin, 1.0 - 2.0 * end, 1.0 - end, 1.0] }
    }

    /// Writes the configuration at this fraction of the length.
    pub fn position(&self, fraction: f64, q: &mut [f64]) {
        let u = bezier(&self.parameter, fraction);
        for (q, controls) in q.iter_mut().zip(&self.controls) {
            *q = bezier(controls, u);
        }
    }

    /// Whether the tip stays in the ball, between samples too, and the joints inside their limits.
    fn is_within(&self, ball: &Ball<'_>, limits: &ConstantLimits, radius: f64) -> bool {
        let mut q = Point::from_elem(0.0, self.controls.len());
        let (mut before, mut largest, mut step) = (None::<[f64; 3]>, 0.0_f64, 0.0_f64);
        for i in 0..=SAMPLES {
            self.position(i as f64 / SAMPLES as f64, &mut q);
            if !limits.contain(&q) {
                return false;
            }
            let tip = ball.tip.position(&q);
            largest = largest.max(norm(&sub(&tip, &ball.center)));
            step = before.map_or(step, |before| step.max(distance(&tip, &before)));
            before = Some(tip);
        }
        // Between two samples the tip is nearer to one of them than about half of their distance; a quarter more for its bend.
        largest + 0.125 * step <= radius
    }
}

/// A ball about the place of a tip at a corner (m).
struct Ball<'a> {
    tip: &'a MovingTip<'a>,
    center: [f64; 3],
}

/// The parameter between `near`, at the corner, and `far`, up to which all tips stay within `radius` of their centers.
fn crossing(balls: &[Ball<'_>], path: &JointPath, radius: f64, [near, far]: [f64; 2]) -> f64 {
    let mut q = Point::from_elem(0.0, path.joints().len());
    let mut is_inside = |fraction: f64| {
        path.position(near + fraction * (far - near), &mut q);
        balls.iter().all(|Ball { tip, center }| norm(&sub(&tip.position(&q), center)) <= radius)
    };
    let Some(outside) = (1..=SAMPLES).map(|i| i as f64 / SAMPLES as f64).find(|fraction| !is_inside(*fraction)) else {
        return far;
    };
    let (mut inside, mut outside) = (outside - 1.0 / SAMPLES as f64, outside);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (inside + outside);
        if is_inside(middle) {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    near + inside * (far - near)
}

fn bezier(controls: &[f64; 6], u: f64) -> f64 {
    let mut points = *controls;
    for count in (1..6).rev() {
        for i in 0..count {
            points[i] += u * (points[i + 1] - points[i]);
        }
    }
    points[0]
}
