//! Distances of segments, for one number or in SIMD lanes.

use crate::math::real::Real;
use crate::math::vec3::Vec3;

/// Squared distance (m^2) below which a segment may cross a surface: zero up to rounding.
pub(super) const TOUCHING: f64 = 1e-24;

/// Nearest point of a segment, by its fraction.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearestFraction<R> {
    /// Squared distance (m^2).
    pub squared: R,
    /// Fraction of the segment's length.
    pub fraction: R,
}

impl<R: Real> NearestFraction<R> {
    /// Returns the nearer of two results.
    #[inline(always)]
    pub fn or(self, other: Self) -> Self {
        Self {
            squared: other.squared.choose_below(self.squared, other.squared, self.squared),
            fraction: other.squared.choose_below(self.squared, other.fraction, self.fraction),
        }
    }
}

#[inline(always)]
pub(super) fn clamp_fraction<R: Real>(fraction: R) -> R {
    fraction.larger(R::splat(0.0)).smaller(R::splat(1.0))
}

/// Returns numerator / denominator, or 0 where the denominator is not positive.
#[inline(always)]
fn fraction_of<R: Real>(numerator: R, denominator: R) -> R {
    let zero = R::splat(0.0);
    let safe = zero.choose_below(denominator, denominator, R::splat(1.0));
    clamp_fraction(zero.choose_below(denominator, numerator / safe, zero))
}

/// Finds the point of the segment from `a` along `u` nearest to a point.
#[inline(always)]
pub(super) fn to_point<R: Real>(a: Vec3<R>, u: Vec3<R>, point: Vec3<R>) -> NearestFraction<R> {
    let w = point - a;
    let fraction = fraction_of(w.dot(u), u.dot(u));
    let apart = u.mul_add(-fraction, w);
    NearestFraction { squared: apart.dot(apart), fraction }
}

/// Finds the point of the segment from `p` along `u` nearest to the segment from `q` along `v`.
#[inline(always)]
pub(super) fn to_segment<R: Real>(p: Vec3<R>, u: Vec3<R>, q: Vec3<R>, v: Vec3<R>) -> NearestFraction<R> {
    let w = p - q;
    let (uu, uv, vv, uw, vw) = (u.dot(u), u.dot(v), v.dot(v), u.dot(w), v.dot(w));
    // Alternating projection: the best point of one for the best point of the other, clamped; the second pass settles the
    // clamps.
    let s = fraction_of(uv * vw - vv * uw, uu * vv - uv * uv);
    let t = fraction_of(uv * s + vw, vv);
    let s = fraction_of(uv * t - uw, uu);
    let t = fraction_of(uv * s + vw, vv);
    let apart = v.mul_add(-t, u.mul_add(s, w));
    let crossing = NearestFraction { squared: apart.dot(apart), fraction: s };
    // Nearly parallel segments are nearest at an end, where the division above is inaccurate.
    let start = NearestFraction { squared: to_point(q, v, p).squared, fraction: R::splat(0.0) };
    let end = NearestFraction { squared: to_point(q, v, p + u).squared, fraction: R::splat(1.0) };
    crossing.or(start).or(end).or(to_point(p, u, q)).or(to_point(p, u, q + v))
}

/// Returns the signed distance by which `x` exceeds the interval [-h, h].
#[inline(always)]
pub(super) fn excess<R: Real>(x: R, h: R) -> R {
    (x - h).larger(R::splat(0.0)) + (x + h).smaller(R::splat(0.0))
}

/// Returns the vector from the nearest point of the box to the point at `fraction` of the segment.
#[inline(always)]
fn beyond_box<R: Real>(a: Vec3<R>, u: Vec3<R>, half: Vec3<R>, fraction: R) -> Vec3<R> {
    let at = u.mul_add(fraction, a);
    Vec3 { x: excess(at.x, half.x), y: excess(at.y, half.y), z: excess(at.z, half.z) }
}

/// Bracket of the minimum of the squared distance along a segment: the ends where it falls and rises, and half its slopes
/// there.
#[derive(Clone, Copy)]
struct Bracket<R> {
    left: R,
    left_slope: R,
    right: R,
    right_slope: R,
}

impl<R: Real> Bracket<R> {
    /// Narrows the bracket by the slope at `fraction`.
    #[inline(always)]
    fn narrowed(self, fraction: R, slope: R) -> Self {
        let zero = R::splat(0.0);
        // Values outside the unit interval leave the bracket unchanged.
        let falls = slope.choose_below(zero, fraction, R::splat(-1.0));
        let rises = slope.choose_below(zero, R::splat(2.0), fraction);
        Self {
            left: self.left.larger(falls),
            left_slope: self.left.choose_below(falls, slope, self.left_slope),
            right: self.right.smaller(rises),
            right_slope: rises.choose_below(self.right, slope, self.right_slope),
        }
    }
}

/// Finds the point of the segment from `a` along `u` nearest to an axis-aligned box about the origin with these half edges.
/// Exact, since the squared distance is a parabola between the points where the segment crosses a plane of the box.
#[inline(always)]
pub(super) fn to_box<R: Real>(a: Vec3<R>, u: Vec3<R>, half: Vec3<R>) -> NearestFraction<R> {
    let (zero, one) = (R::splat(0.0), R::splat(1.0));
    let [first, last] = [u.dot(beyond_box(a, u, half, zero)), u.dot(beyond_box(a, u, half, one))];
    let mut bracket = Bracket { left: zero, left_slope: first, right: one, right_slope: last };
    macro_rules! cross_planes {
        ($axis:ident) => {
            let safe = u.$axis.choose_equal(zero, one, u.$axis);
            for plane in [half.$axis, -half.$axis] {
                let fraction = clamp_fraction((plane - a.$axis) / safe);
                bracket = bracket.narrowed(fraction, u.dot(beyond_box(a, u, half, fraction)));
            }
        };
    }
    cross_planes!(x);
    cross_planes!(y);
    cross_planes!(z);
    let rise = bracket.right_slope - bracket.left_slope;
    let width = bracket.right - bracket.left;
    let fraction = bracket.left - bracket.left_slope * width / zero.choose_below(rise, rise, one);
    let fraction = zero.choose_below(bracket.right_slope, fraction, bracket.right);
    let fraction = clamp_fraction(bracket.left_slope.choose_below(zero, fraction, bracket.left));
    let beyond = beyond_box(a, u, half, fraction);
    NearestFraction { squared: beyond.dot(beyond), fraction }
}

/// Triangle, prepared for distances.
#[derive(Clone, Copy)]
pub(super) struct TriangleLanes<R> {
    corner: Vec3<R>,
    edges: [Vec3<R>; 2],
    normal: Vec3<R>,
    /// Squared length of the normal.
    squared: R,
}

impl<R: Real> TriangleLanes<R> {
    /// Prepares the triangle with a corner at `corner` and edges `ab` and `ac` from there.
    #[inline(always)]
    pub fn new(corner: Vec3<R>, ab: Vec3<R>, ac: Vec3<R>) -> Self {
        let normal = ab.cross(ac);
        Self { corner, edges: [ab, ac], normal, squared: normal.dot(normal) }
    }

    /// Returns the squared distance of the point p + fraction u from the plane if it projects into the triangle, else
    /// `otherwise`.
    #[inline(always)]
    fn faced(&self, p: Vec3<R>, u: Vec3<R>, fraction: R, otherwise: R) -> R {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let [ab, ac] = self.edges;
        let w = u.mul_add(fraction, p) - self.corner;
        let height = w.dot(self.normal);
        // Barycentric coordinates, times the square of twice the area.
        let (beta, gamma) = (self.normal.dot(w.cross(ac)), self.normal.dot(ab.cross(w)));
        let lowest = beta.smaller(gamma).smaller(self.squared - beta - gamma);
        let safe = zero.choose_below(self.squared, self.squared, one);
        let inside = lowest.choose_below(zero, otherwise, height * height / safe);
        zero.choose_below(self.squared, inside, otherwise)
    }
}

/// Finds the point of the segment from `p` along `u` nearest to a triangle: an end of the segment, a point near an edge of
/// the triangle, or the intersection.
#[inline(always)]
pub(super) fn to_triangle<R: Real>(p: Vec3<R>, u: Vec3<R>, triangle: &TriangleLanes<R>) -> NearestFraction<R> {
    let (zero, one) = (R::splat(0.0), R::splat(1.0));
    let (a, [ab, ac]) = (triangle.corner, triangle.edges);
    let edges = to_segment(p, u, a, ab).or(to_segment(p, u, a, ac)).or(to_segment(p, u, a + ab, ac - ab));
    // Intersection of the segment with the plane.
    let (start, end) = ((p - a).dot(triangle.normal), (p + u - a).dot(triangle.normal));
    let fall = start - end;
    let through = clamp_fraction(start / fall.choose_equal(zero, one, fall));
    let crossing = (start * end).choose_below(zero, through, zero);
    let mut nearest = edges;
    for fraction in [zero, one, crossing] {
        nearest = nearest.or(NearestFraction { squared: triangle.faced(p, u, fraction, nearest.squared), fraction });
    }
    nearest
}

/// Returns the squared distance of a point from a triangle.
#[inline(always)]
pub(super) fn point_to_triangle<R: Real>(p: Vec3<R>, triangle: &TriangleLanes<R>) -> R {
    let (a, [ab, ac]) = (triangle.corner, triangle.edges);
    let edges = to_point(a, ab, p).squared.smaller(to_point(a, ac, p).squared);
    let edges = edges.smaller(to_point(a + ab, ac - ab, p).squared);
    triangle.faced(p, p, R::splat(0.0), edges)
}
