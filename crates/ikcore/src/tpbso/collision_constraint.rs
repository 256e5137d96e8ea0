//! Collisions of a motion, tested at samples during the search.

use crate::obstacle::{ClearSpace, Obstacle};
use crate::plan::PlanarArm;
use crate::robot::Robot;
use crate::shape::Geometry;

/// Obstacles and links that a motion must stay clear of.
#[derive(Debug, Clone)]
pub(super) struct CollisionTest<'a> {
    space: &'a ClearSpace<'a>,
    /// For a planar arm of lines among ellipses: the exact test of section 4, several times faster than distances.
    flat: Option<(PlanarArm, Vec<UnitDisc>)>,
}

/// An ellipse, given by the map onto the unit disc.
#[derive(Debug, Clone, Copy)]
struct UnitDisc {
    center: [f64; 2],
    /// cos and sin of its angle.
    direction: [f64; 2],
    semi_axes: [f64; 2],
}

/// Distance that the search adds to the margin, relative to the length of the arm, because the arm may come closer
/// between two samples. Without it, 9 to 20 of 20 plans graze an obstacle that their samples miss.
const ALLOWANCE: f64 = 0.005;

impl<'a> CollisionTest<'a> {
    /// The constraint of staying in `space`.
    pub(super) fn new(space: &'a ClearSpace<'a>, robot: &Robot) -> Self {
        let arm = if robot.capsules().is_empty() { PlanarArm::of(space.robot()) } else { None };
        let flat = arm.and_then(|arm| {
            let kept = space.margin() + ALLOWANCE * arm.lengths().iter().sum::<f64>();
            let discs: Option<Vec<_>> = space.obstacles().iter().map(|obstacle| UnitDisc::of(obstacle, kept)).collect();
            Some((arm, discs?))
        });
        Self { space, flat }
    }

    /// Number of contacts between links and ellipses at `q`; for other shapes 1 if there is any contact: g_3 of eq.
    /// (15) at one instant.
    pub(super) fn touching(&self, q: &[f64]) -> f64 {
        let Some((arm, discs)) = &self.flat else {
            return if self.space.holds(q) { 0.0 } else { 1.0 };
        };
        let mut corners = arm.corners(q);
        let mut from = corners.next().unwrap_or_default();
        let mut touching = 0.0;
        for to in corners {
            touching += discs.iter().filter(|disc| disc.meets(from, to)).count() as f64;
            from = to;
        }
        touching
    }
}

impl UnitDisc {
    /// The ellipse of `obstacle` grown by `kept` (m); None for any other shape, or one that some links may touch.
    fn of(obstacle: &Obstacle, kept: f64) -> Option<Self> {
        match *obstacle.shape.geometry() {
            Geometry::Ellipse { center, semi_axes, angle } if obstacle.touch().is_empty() => {
                let semi_axes = semi_axes.map(|semi_axis| semi_axis + kept);
                Some(Self { center, direction: [angle.cos(), angle.sin()], semi_axes })
            }
            _ => None,
        }
    }

    fn map(&self, point: [f64; 2]) -> [f64; 2] {
        let [x, y] = [point[0] - self.center[0], point[1] - self.center[1]];
        let [cosine, sine] = self.direction;
        [(cosine * x + sine * y) / self.semi_axes[0], (cosine * y - sine * x) / self.semi_axes[1]]
    }

    /// Whether the segment from `a` to `b` intersects the ellipse; exact, since the map keeps lines straight.
    fn meets(&self, a: [f64; 2], b: [f64; 2]) -> bool {
        let (a, b) = (self.map(a), self.map(b));
        let along = [b[0] - a[0], b[1] - a[1]];
        let squared = along[0] * along[0] + along[1] * along[1];
        let fraction = if squared > 0.0 { -(a[0] * along[0] + a[1] * along[1]) / squared } else { 0.0 };
        let fraction = fraction.clamp(0.0, 1.0);
        let nearest = [a[0] + fraction * along[0], a[1] + fraction * along[1]];
        nearest[0] * nearest[0] + nearest[1] * nearest[1] < 1.0
    }
}
