//! Tests of distances at every scale, from subnormal lengths to the largest numbers.

use nalgebra::Vector3;

use super::body_block::BodyBlock;
use super::checked_shape::{LARGEST, Shape};
use super::posed_body::PosedBody;
use super::test_shapes::SQUARES;
use crate::error::Result;
use crate::math::Frame;
use crate::math::arithmetic::by_instructions;
use crate::math::f64x4::F64x4;
use crate::rng::{self, LazyRng};

by_instructions! {
    fn clear(shape: &Shape, block: &BodyBlock, margin: f64) -> F64x4 {
        shape.clear_lanes::<A>(block, margin)
    }
}

/// Draws a length of any magnitude (m): a power of two, of ten, or neither.
fn length(rng: &mut LazyRng) -> f64 {
    let ends = [(-322.0, 307.0), (-12.0, 100.0), (-6.0, 6.0), (25.0, 35.0)][rng.below(4)];
    let exponent = rng.uniform_in(ends.0, ends.1);
    match rng.below(3) {
        0 => 10.0_f64.powf(exponent.round()),
        1 => (exponent * 10.0_f64.log2()).round().clamp(-1074.0, 1023.0).exp2(),
        _ => 10.0_f64.powf(exponent),
    }
}

fn corners(center: [f64; 3], half: f64) -> Vec<[f64; 3]> {
    (0..8)
        .map(|bits| std::array::from_fn(|k| if bits >> k & 1 == 0 { center[k] - half } else { center[k] + half }))
        .collect()
}

/// Returns bounded shapes about `center` that extend by `half` (m) along x on both sides.
fn bounded(center: [f64; 3], half: f64) -> Vec<Result<Shape>> {
    let at = |k: usize, by: f64| {
        let mut end = center;
        end[k] += by;
        end
    };
    vec![
        Shape::sphere(center, half),
        Shape::cuboid(center, [2.0 * half; 3], None),
        Shape::capsule(at(0, -0.5 * half), at(0, 0.5 * half), 0.5 * half),
        Shape::capsule(at(1, -half), at(1, half), half),
        Shape::cylinder(center, [0.0, half, 0.0], half, half),
        Shape::cylinder(center, [half, 0.0, 0.0], half, 2.0 * half),
        Shape::ellipsoid(center, [half, 0.3 * half, 2.0 * half], None),
        Shape::convex_mesh(&corners(center, half)),
    ]
}

/// Returns the same shapes and those that only obstacles can have: a mesh, a cloud, a grid, a half-space on the far side.
fn obstacles(center: [f64; 3], half: f64) -> Vec<Shape> {
    let squares = SQUARES.iter().map(|square| square.map(|corner| corner as u32));
    let faces = squares.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mut all = bounded(center, half);
    all.extend([
        Shape::mesh(corners(center, half), faces),
        Shape::point_cloud(vec![center], half),
        Shape::grid(center.map(|x| x - half), 2.0 * half, [1; 3], vec![true]),
        Shape::half_space([-half, 0.0, 0.0], half - center[0]),
    ]);
    // Invalid sizes are rejected.
    all.into_iter().filter_map(Result::ok).collect()
}

/// Calls `visit` with bodies about `center` that extend by `half` along x.
fn for_bodies(center: [f64; 3], half: f64, mut visit: impl FnMut(&PosedBody, &str)) {
    for shape in bounded(center, half).into_iter().filter_map(Result::ok) {
        let (a, b, radius) = shape.enclosing_capsule();
        let axis = [a.into(), b.into()];
        let is_capsule = ["Sphere", "Capsule"].contains(&shape.name());
        let solid = (!is_capsule).then_some((&shape, Frame::IDENTITY));
        visit(&PosedBody { axis: &axis, radius, solid }, shape.name());
    }
}

/// Returns the capsule of a body in four lanes.
fn block(body: &PosedBody) -> BodyBlock {
    let [a, b] = body.axis;
    BodyBlock {
        start: std::array::from_fn(|k| F64x4::splat(a[k])),
        along: std::array::from_fn(|k| F64x4::splat(b[k] - a[k])),
        radius: F64x4::splat(body.radius),
        spheres: a == b,
    }
}

#[test]
fn what_contains_a_body_is_near_at_every_size_and_place() {
    let mut rng = rng::stream(1, 0);
    let mut count = 0;
    for case in 0..300 {
        let far = if case % 4 == 0 { 0.0 } else { length(&mut rng) };
        let way =
            [Vector3::x(), Vector3::repeat(-1.0), Vector3::from_fn(|_, _| rng.uniform_in(-1.0, 1.0))][rng.below(3)];
        let center: [f64; 3] = (far * way).into();
        let (half, own) = (length(&mut rng), length(&mut rng));
        for shape in obstacles(center, half) {
            for_bodies(center, own, |body, name| {
                count += 1;
                let found = shape.distance_to_body(body, f64::INFINITY);
                let short = shape.distance_to_body(body, 1e-3);
                let what = || format!("{name} of {own:e} in {} of {half:e} at {center:?}", shape.name());
                assert!(found <= 0.0 && short <= 1e-12, "{}: {found:e} {short:e}", what());
                let lanes = clear(&shape, &block(body), 0.0);
                assert!(lanes.0 == [0.0; 4], "{}: {lanes:?}", what());
                for other in bounded(center, half).into_iter().filter_map(Result::ok) {
                    let (a, b, radius) = other.enclosing_capsule();
                    let placed =
                        PosedBody { axis: &[a.into(), b.into()], radius, solid: Some((&other, Frame::IDENTITY)) };
                    let found = placed.distance_to(body, f64::INFINITY);
                    assert!(found <= 0.0, "{}: {found:e} from {}", what(), other.name());
                }
            });
        }
    }
    assert!(count > 17_000, "{count}");
}

#[test]
fn no_distance_is_above_the_true_one_at_any_scale() {
    let mut rng = rng::stream(2, 0);
    let (mut finite, mut useful) = (0, 0);
    for case in 0..1200 {
        let aside = if case % 2 == 0 { 0.0 } else { length(&mut rng) };
        let (half, own, gap) = (length(&mut rng), length(&mut rng), length(&mut rng));
        let center = [half + own + gap, aside, -aside];
        // Allowance for the rounding of the centre's coordinate.
        let exact = center[0] - half - own + 4.0 * f64::EPSILON * center[0];
        if !exact.is_finite() {
            continue;
        }
        let most = [center[0], aside].into_iter().fold(1.0, f64::max);
        for shape in obstacles(center, half) {
            for_bodies([0.0, aside, -aside], own, |body, name| {
                finite += 1;
                let what = || format!("{name} of {own:e}, {} of {half:e}, {gap:e} apart, {aside:e}", shape.name());
                for enough in [f64::INFINITY, exact, 1e-3] {
                    let found = shape.distance_to_body(body, enough);
                    assert!(found <= exact, "{}: {found:e} for {exact:e}", what());
                    if most < LARGEST && enough == f64::INFINITY && !shape.is_huge() {
                        let lost = 2e-7 + 1e-11 * most;
                        let is_near = found >= exact - 4.0 * f64::EPSILON * center[0] - lost;
                        useful += usize::from(is_near);
                    }
                }
                let margin = exact * (1.0 + 1e-9) + 1e-300;
                if body.solid.is_none() && margin.is_finite() {
                    let lanes = clear(&shape, &block(body), margin);
                    assert!(lanes.0 == [0.0; 4], "{}: {lanes:?}", what());
                }
            });
        }
    }
    assert!(finite > 80_000 && useful > 10_000, "{finite} {useful}");
}
