//! Part of a region within the tolerances of a target: two boxes, one along the axes of the base, one along those of the target.
//!
//! The point of the region nearest to the target may be beyond a narrow tolerance although other points of the region are
//! within all of them. A search then aims at the nearest of those.

use super::band::AIMED_AT;
use super::criterion::Criterion;
use super::region::Region;
use super::target::Target;
use crate::math::box_step::ROWS;
use crate::math::so3::cross;
use crate::math::vector::dot;

/// Length (m) that rounding may add to a point on a face.
const ROUNDING: f64 = 1e-12;

/// Square of the sine between two faces below which they count as parallel.
const PARALLEL: f64 = 1e-12;

/// Points between two parallel faces: `low` <= `normal` . x <= `high`.
struct Slab {
    normal: [f64; 3],
    low: f64,
    high: f64,
}

/// FacePlane `normal` . x = `level`.
type FacePlane = ([f64; 3], f64);

impl Criterion {
    /// Position nearest to `target` in its region and within its tolerances, if the one nearest in the region alone is beyond
    /// them.
    pub(super) fn position_within_both(&self, region: &Region, target: &Target) -> Option<[f64; 3]> {
        let wanted = target.position()?;
        if region.contains(&wanted) {
            return None;
        }
        let band = self.band_of_position(target)?;
        let nearest = region.nearest(&wanted, 0.0);
        if band.iter().all(|slab| slab.holds(&nearest)) {
            return None;
        }
        self.nearest_within_both(region, target, &wanted)
    }

    /// Position nearest to `point` in the region and within the tolerances of `target`, a little inside both; `None` if there is
    /// none, or the tolerances are not along axes of the target.
    pub(super) fn nearest_within_both(&self, region: &Region, target: &Target, point: &[f64; 3]) -> Option<[f64; 3]> {
        let [a, b, c] = self.band_of_position(target)?;
        let [x, y, z] = std::array::from_fn(|k| {
            let mut normal = [0.0; 3];
            normal[k] = 1.0;
            let margin = self.margin().min(0.25 * (region.upper()[k] - region.lower()[k]));
            Slab { normal, low: region.lower()[k] + margin, high: region.upper()[k] - margin }
        });
        nearest(&[x, y, z, a, b, c], point)
    }

    /// Tolerances of the position along the axes of the target's frame, as far as a search aims at them.
    fn band_of_position(&self, target: &Target) -> Option<[Slab; 3]> {
        let components = self.components.as_ref()?;
        let (frame, tolerance) = (target.frame()?, components.tolerance?);
        Some(std::array::from_fn(|k| {
            let half = if components.weights[k] == 0.0 { f64::INFINITY } else { AIMED_AT * tolerance[k] };
            let middle = dot(&frame.axes[k], &frame.origin);
            Slab { normal: frame.axes[k], low: middle - half, high: middle + half }
        }))
    }

    /// The same criterion with no tolerance of position.
    pub(super) fn exact_in_position(&self) -> Self {
        let mut exact = *self;
        if let Some(tolerance) = exact.components.as_mut().and_then(|components| components.tolerance.as_mut()) {
            let position: &mut [f64] = &mut tolerance[..ROWS / 2];
            position.fill(0.0);
        }
        exact
    }
}

impl Slab {
    fn holds(&self, point: &[f64; 3]) -> bool {
        let at = dot(&self.normal, point);
        self.low - ROUNDING <= at && at <= self.high + ROUNDING
    }

    /// Faces at a finite distance.
    fn faces(&self) -> impl Iterator<Item = FacePlane> {
        [self.low, self.high].into_iter().filter(|level| level.is_finite()).map(|level| (self.normal, level))
    }
}

/// Point of all `slabs` nearest to `point`: its projection onto some vertex, edge or face, or `point` itself.
fn nearest(slabs: &[Slab; 6], point: &[f64; 3]) -> Option<[f64; 3]> {
    let faces: Vec<FacePlane> = slabs.iter().flat_map(Slab::faces).collect();
    let mut best: Option<(f64, [f64; 3])> = None;
    let mut consider = |at: [f64; 3]| {
        let away = (0..3).map(|k| (at[k] - point[k]).powi(2)).sum::<f64>();
        if best.is_none_or(|(least, _)| away < least) && slabs.iter().all(|slab| slab.holds(&at)) {
            best = Some((away, at));
        }
    };
    consider(*point);
    for (i, first) in faces.iter().enumerate() {
        consider(onto_plane(first, point));
        for (j, second) in faces.iter().enumerate().skip(i + 1) {
            let Some(on_line) = onto_line([first, second], point) else { continue };
            consider(on_line);
            faces.iter().skip(j + 1).filter_map(|third| corner([first, second, third])).for_each(&mut consider);
        }
    }
    best.map(|(_, at)| at)
}

fn onto_plane((normal, level): &FacePlane, point: &[f64; 3]) -> [f64; 3] {
    let beyond = dot(normal, point) - level;
    std::array::from_fn(|k| point[k] - beyond * normal[k])
}

/// Projects `point` onto the line in which two planes meet; `None` if they are parallel.
fn onto_line([(a, at_a), (b, at_b)]: [&FacePlane; 2], point: &[f64; 3]) -> Option<[f64; 3]> {
    let cosine = dot(a, b);
    let squared_sine = 1.0 - cosine * cosine;
    if squared_sine < PARALLEL {
        return None;
    }
    let (short_a, short_b) = (at_a - dot(a, point), at_b - dot(b, point));
    let along_a = (short_a - cosine * short_b) / squared_sine;
    let along_b = (short_b - cosine * short_a) / squared_sine;
    Some(std::array::from_fn(|k| point[k] + along_a * a[k] + along_b * b[k]))
}

/// Point in which three planes meet; `None` if it is at infinity.
fn corner([(a, at_a), (b, at_b), (c, at_c)]: [&FacePlane; 3]) -> Option<[f64; 3]> {
    let (over_a, over_b, over_c) = (cross(b, c), cross(c, a), cross(a, b));
    let volume = dot(a, &over_a);
    if volume * volume < PARALLEL {
        return None;
    }
    Some(std::array::from_fn(|k| (at_a * over_a[k] + at_b * over_b[k] + at_c * over_c[k]) / volume))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slab(normal: [f64; 3], low: f64, high: f64) -> Slab {
        Slab { normal, low, high }
    }

    #[test]
    fn the_nearest_point_of_two_boxes_is_on_both() {
        let (c, s) = (0.6, 0.8);
        let open = f64::INFINITY;
        let slabs = [
            slab([1.0, 0.0, 0.0], -open, 0.0),
            slab([0.0, 1.0, 0.0], -open, open),
            slab([0.0, 0.0, 1.0], -open, open),
            slab([c, s, 0.0], -open, open),
            slab([-s, c, 0.0], -0.1, 0.1),
            slab([0.0, 0.0, 1.0], -0.1, 0.1),
        ];
        // A rod along (0.6, 0.8) through (1, 0): its nearest point of x <= 0 to (1, 0) is on its lower side.
        let mut shifted = slabs;
        (shifted[4].low, shifted[4].high) = (-0.9, -0.7);
        let found = nearest(&shifted, &[1.0, 0.0, 0.0]).unwrap();
        assert!((found[0]).abs() < 1e-9 && (found[1] + 0.7 / c).abs() < 0.4, "{found:?}");
        assert!(shifted.iter().all(|slab| slab.holds(&found)));
        let mut apart = shifted;
        (apart[3].low, apart[3].high) = (2.0, 3.0);
        assert_eq!(nearest(&apart, &[1.0, 0.0, 0.0]), None);
    }
}
