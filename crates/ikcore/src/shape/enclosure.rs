//! Interior of a mesh: orients every triangle so that winding numbers show what the mesh encloses.
//!
//! Every closed piece is oriented outward, so that overlapping pieces add up and an inverted piece still has an interior. A
//! piece is the wall of a cavity only if it lies apart from all other pieces, inside the solid of one, and its original
//! orientation removes that solid; in doubt it is a solid.
//!
//! A piece provably encloses a volume if the winding numbers on both sides of its triangles are never negative, and no
//! triangle has the outside on both sides, as in two coincident layers of opposite orientation.

use nalgebra::Vector3;

use super::bounding_tree::Aabb;
use super::mesh_pieces::{MeshPiece, MeshPieces, NO_PIECE};
use super::segment_lanes::{TriangleLanes, to_triangle};
use super::triangle_surface::TriangleSurface;
use crate::math::arithmetic::NoFma;
use crate::math::real::{One, Real};
use crate::math::vec3::Vec3;

/// Interior of a mesh.
#[derive(Debug, Clone)]
pub(super) struct Enclosure {
    /// Weight of each triangle in winding numbers: +1 as given, -1 reversed, 0 if it belongs to no closed piece. Empty if all
    /// are 0.
    pub turns: Vec<i8>,
    /// True if every piece provably encloses a volume.
    pub certain: bool,
}

/// Distance below which two layers coincide, as a fraction of the mesh size: they may have been rounded to single precision.
const COINCIDENT: f64 = 1e-6;
/// Offset of a sample point from its triangle, as a fraction of the triangle's height.
const OFF_TRIANGLE: f64 = 1e-3;
/// Smallest offset, as a multiple of the rounding error of coordinates.
const ROUNDINGS: f64 = 32.0;
/// Number of sampled triangles of a mesh.
const SAMPLED: usize = 2048;
/// Smallest and largest number of sampled triangles of a piece.
const OF_A_PIECE: [usize; 2] = [3, 128];
/// Barycentric coordinates of the sample points: the middle of a triangle, and points near its corners.
const SAMPLES: [[f64; 3]; 4] = [[1.0 / 3.0; 3], [0.96, 0.03, 0.01], [0.01, 0.96, 0.03], [0.03, 0.01, 0.96]];

impl Enclosure {
    /// Finds the interior of `mesh`.
    pub fn of(mesh: &TriangleSurface) -> Self {
        let MeshPieces { pieces, mut turns, of } = MeshPieces::of(&mesh.vertices, &mesh.faces);
        let mut certain = !pieces.is_empty() && pieces.iter().all(|piece| piece.closed);
        // Original orientation of each piece: +1 is outward, 0 is mixed.
        let mut given = vec![0; pieces.len()];
        for (number, (piece, given)) in pieces.iter().zip(&mut given).enumerate() {
            let is_outward = signed_volume(mesh, piece, &turns) >= 0.0;
            if !is_outward {
                piece.faces.iter().for_each(|face| turns[*face as usize] *= -1);
            }
            *given = if piece.one_sided && is_outward { 1 } else { -i32::from(piece.one_sided) };
            let own = |face: usize| if of[face] == number { i32::from(turns[face]) } else { 0 };
            let [least, most] = OF_A_PIECE;
            certain = certain && encloses_for_certain(mesh, piece, own, (SAMPLED / pieces.len()).clamp(least, most));
        }
        for piece in cavities(mesh, (&pieces, &of), &given, &turns) {
            pieces[piece].faces.iter().for_each(|face| turns[*face as usize] *= -1);
        }
        if turns.iter().all(|turn| *turn == 0) {
            turns.clear();
        }
        Self { turns, certain }
    }
}

/// Returns the volume enclosed by a piece (m^3); negative if its triangles point inward.
fn signed_volume(mesh: &TriangleSurface, piece: &MeshPiece, turns: &[i8]) -> f64 {
    let [origin, ..] = mesh.triangle(piece.faces[0] as usize);
    let cone = |face: &u32| {
        let [a, b, c] = mesh.triangle(*face as usize).map(|corner| corner - origin);
        f64::from(turns[*face as usize]) * a.dot(&b.cross(&c)) / 6.0
    };
    piece.faces.iter().map(cone).sum()
}

/// Whether sampled winding numbers on both sides of the triangles of a piece are those of a body oriented outward; `own` is
/// the weight of each triangle of the piece.
fn encloses_for_certain(mesh: &TriangleSurface, piece: &MeshPiece, own: impl Fn(usize) -> i32, sampled: usize) -> bool {
    let sides = |face: u32| {
        let samples = SAMPLES.iter().filter_map(move |fractions| both_sides(mesh, face, fractions));
        samples.map(|points| points.map(|point| mesh.winding_number(&point, &own)))
    };
    let step = piece.faces.len().div_ceil(sampled);
    let mut some = piece.faces.iter().step_by(step).flat_map(|face| sides(*face)).peekable();
    some.peek().is_some() && some.all(|[one, other]| one >= 0 && other >= 0 && one + other > 0)
}

/// Returns points on both sides of a triangle at these barycentric coordinates; `None` if it has no area.
fn both_sides(mesh: &TriangleSurface, face: u32, fractions: &[f64; 3]) -> Option<[Vector3<f64>; 2]> {
    let [a, b, c] = mesh.triangle(face as usize);
    let at = fractions[0] * a + fractions[1] * b + fractions[2] * c;
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    let cross = (b - a).cross(&(c - a));
    let height = cross.norm() / longest;
    let Aabb { lower, upper } = mesh.tree.bounds();
    let rounding = ROUNDINGS * f64::EPSILON * lower.amax().max(upper.amax());
    let off = (OFF_TRIANGLE * height).min(COINCIDENT * (upper - lower).amax()).max(rounding);
    let normal = cross.try_normalize(0.0).filter(|_| height > rounding)?;
    Some([at + off * normal, at - off * normal])
}

/// Returns the pieces that are walls of cavities; `of` is the piece of each triangle, `given` the original orientation of
/// each piece, or 0.
fn cavities(mesh: &TriangleSurface, (pieces, of): (&[MeshPiece], &[usize]), given: &[i32], turns: &[i8]) -> Vec<usize> {
    let closed = |sign: i32| (0..pieces.len()).any(|i| pieces[i].closed && given[i] == sign);
    if !(closed(1) && closed(-1)) {
        return vec![];
    }
    let as_given = |face: usize| given.get(of[face]).map_or(0, |sign| sign * i32::from(turns[face]));
    let takes_away = |piece: &usize| {
        let mut samples = pieces[*piece].faces.iter().filter_map(|face| both_sides(mesh, *face, &SAMPLES[0]));
        let own = |face: usize| if of[face] == *piece { i32::from(turns[face]) } else { 0 };
        samples.next().is_some_and(|mut points| {
            points.sort_by_key(|point| mesh.winding_number(point, own));
            let [outside, inside] = points.map(|point| mesh.winding_number(&point, as_given));
            outside != 0 && inside == 0
        })
    };
    let candidates = (0..pieces.len()).filter(|i| pieces[*i].closed && given[*i] != 0);
    candidates
        .filter(takes_away)
        .filter(|i| pieces[*i].faces.iter().all(|face| !touches_others(mesh, of, *face)))
        .collect()
}

/// Whether a triangle touches a triangle of another piece; `of` is the piece of each triangle.
fn touches_others(mesh: &TriangleSurface, of: &[usize], face: u32) -> bool {
    let own = mesh.triangle(face as usize);
    let Aabb { lower, upper } = mesh.tree.bounds();
    let near = COINCIDENT * (upper - lower).amax();
    let middle = (own[0] + own[1] + own[2]) / 3.0;
    let reach = own.iter().map(|corner| (corner - middle).norm()).fold(0.0, f64::max) + near;
    let mut touches = false;
    mesh.tree.each_near(&[middle; 2], reach, &mut |other| {
        if ![of[face as usize], NO_PIECE].contains(&of[other]) && !touches {
            let corners = mesh.triangle(other);
            touches = an_edge_is_near(&own, &corners, near) || an_edge_is_near(&corners, &own, near);
        }
        reach
    });
    touches
}

/// Whether an edge of the first triangle is nearer than `near` (m) to the second.
fn an_edge_is_near([a, b, c]: &[Vector3<f64>; 3], [p, q, r]: &[Vector3<f64>; 3], near: f64) -> bool {
    let vector = |v: &Vector3<f64>| Vec3::<One<NoFma>>::splat(&(*v).into());
    let triangle = TriangleLanes::new(vector(p), vector(&(q - p)), vector(&(r - p)));
    let squared =
        |from: &Vector3<f64>, to: &Vector3<f64>| to_triangle(vector(from), vector(&(to - from)), &triangle).squared;
    // NaN counts as near.
    [(a, b), (b, c), (c, a)].into_iter().any(|(from, to)| !(squared(from, to).stored() > near * near))
}

#[cfg(test)]
mod tests {
    use super::super::test_shapes::{SQUARES, as_mesh, mesh_of};
    use super::*;
    use crate::rng::{self, LazyRng};

    type Corners = [[f64; 3]; 3];

    /// Axis-aligned box, by its lower and upper corners.
    #[derive(Debug, Clone, Copy)]
    struct Block {
        lower: [f64; 3],
        upper: [f64; 3],
    }

    impl Block {
        fn about(center: [f64; 3], half: f64) -> Self {
            Self { lower: center.map(|x| x - half), upper: center.map(|x| x + half) }
        }

        /// Returns the triangles of the box, whose squares are split along one diagonal or the other.
        fn triangles(&self, other_diagonal: bool) -> Vec<Corners> {
            let corner = |bits: usize| std::array::from_fn(|k| [self.lower, self.upper][bits >> k & 1][k]);
            let halves = SQUARES.into_iter().flat_map(|mut square| {
                square.rotate_left(usize::from(other_diagonal));
                let [a, b, c, d] = square.map(corner);
                [[a, b, c], [a, c, d]]
            });
            halves.collect()
        }

        fn holds(&self, p: &Vector3<f64>, margin: f64) -> bool {
            (0..3).all(|k| self.lower[k] - margin < p[k] && p[k] < self.upper[k] + margin)
        }

        /// Whether the box lies inside `other`, apart from its walls.
        fn is_within(&self, other: &Self) -> bool {
            (0..3).all(|k| other.lower[k] + 1e-3 < self.lower[k] && self.upper[k] < other.upper[k] - 1e-3)
        }
    }

    fn turned(triangles: Vec<Corners>) -> Vec<Corners> {
        triangles.into_iter().map(|[a, b, c]| [a, c, b]).collect()
    }

    /// Returns whether the mesh is closed, and which of these points on the x axis it encloses.
    fn judged(triangles: &[Corners], places: &[f64]) -> (bool, Vec<bool>) {
        let shape = mesh_of(triangles);
        let mesh = as_mesh(&shape);
        let enclosed = places.iter().map(|x| mesh.encloses(&Vector3::new(*x, 0.02, 0.03)));
        (mesh.is_closed(), enclosed.collect())
    }

    fn unit() -> Vec<Corners> {
        Block::about([0.0; 3], 0.5).triangles(false)
    }

    #[test]
    fn two_sided_and_turned_triangles_leave_the_inside() {
        let inside = (true, vec![true, false]);
        assert_eq!(judged(&unit(), &[0.0, 0.6]), inside);
        assert_eq!(judged(&turned(unit()), &[0.0, 0.6]), inside);
        let two_sided = [unit(), turned(unit())].concat();
        assert_eq!(judged(&two_sided, &[0.0, 0.6]), inside);
        // Two layers with separate corners, in any order and rounded to single precision.
        let mut moved: Vec<Corners> = Block::about([0.1, 0.2, 0.3], 0.5).triangles(false);
        moved.extend(
            turned(moved.clone()).into_iter().rev().map(|[a, b, c]| [c, a, b].map(|p| p.map(|x| f64::from(x as f32)))),
        );
        assert_eq!(judged(&moved, &[0.1, 0.7]), inside);
        for some in [1, 5, 0b101_0101_0101] {
            let flip =
                |(i, corners): (usize, Corners)| if some >> i & 1 == 1 { turned(vec![corners])[0] } else { corners };
            assert_eq!(judged(&unit().into_iter().enumerate().map(flip).collect::<Vec<_>>(), &[0.0, 0.6]), inside);
        }
        // Repeated triangles, and triangles without area.
        let mut more = [unit(), unit()[..3].to_vec()].concat();
        more.push([[0.5; 3], [0.5; 3], [-0.5; 3]]);
        assert_eq!(judged(&more, &[0.0, 0.6]), inside);
    }

    #[test]
    fn a_cavity_is_outside_only_where_that_is_certain() {
        let shell = |inner: f64| [unit(), turned(Block::about([0.0; 3], inner).triangles(false))].concat();
        for shell in [shell(0.4), turned(shell(0.4)), shell(0.4999)] {
            assert_eq!(judged(&shell, &[0.0, 0.49995, 0.6]), (true, vec![false, true, false]));
        }
        let island = [shell(0.4), Block::about([0.0; 3], 0.1).triangles(true)].concat();
        assert_eq!(judged(&island, &[0.0, 0.3, 0.45]), (true, vec![true, false, true]));
        let same_orientation = [unit(), Block::about([0.0; 3], 0.4).triangles(false)].concat();
        assert_eq!(judged(&same_orientation, &[0.0, 0.45]), (true, vec![true, true]));
        // Layers that coincide, or touch in a corner, are not walls of a cavity.
        let corner = Block { lower: [-0.4; 3], upper: [0.4, 0.4, 0.5] };
        for inner in [Block::about([0.0; 3], 0.5 - 1e-8), corner] {
            for diagonal in [false, true] {
                let both = [unit(), turned(inner.triangles(diagonal))].concat();
                assert_eq!(judged(&both, &[0.0]), (true, vec![true]), "{inner:?}");
            }
        }
    }

    #[test]
    fn parts_of_opposite_orientation_all_have_an_inside() {
        for distance in [0.7, 1.3, 2.0] {
            let other = turned(Block::about([distance, 0.0, 0.0], 0.5).triangles(true));
            let between = [0.0, 0.5 * distance, distance];
            let expected = vec![true, distance < 1.0, true];
            assert_eq!(judged(&[unit(), other].concat(), &between), (true, expected));
        }
    }

    #[test]
    fn parts_that_touch_keep_their_insides() {
        // Contact along a face, along an edge, and at a corner.
        for center in [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]] {
            let other = Block::about(center, 0.5);
            let both = mesh_of(&[unit(), other.triangles(false)].concat());
            assert!(as_mesh(&both).is_closed(), "{center:?}");
            for reversed in [false, true] {
                let other = if reversed { turned(other.triangles(false)) } else { other.triangles(false) };
                let both = mesh_of(&[unit(), other].concat());
                for inside in [[0.1, 0.2, 0.3].into(), Vector3::from(center).add_scalar(0.1)] {
                    assert!(as_mesh(&both).encloses(&inside), "{center:?} {reversed}");
                }
                assert!(!as_mesh(&both).encloses(&Vector3::new(-0.6, 0.0, 0.0)));
            }
        }
    }

    #[test]
    fn surfaces_without_a_certain_inside_are_not_closed() {
        let sheet: Vec<Corners> = unit()[..2].to_vec();
        let pillow = [sheet.clone(), turned(sheet.clone())].concat();
        let slanted = [sheet, turned(Block::about([0.0; 3], 0.5).triangles(true)[..2].to_vec())].concat();
        let without_a_side = unit()[2..].to_vec();
        let two_sided_bin = [without_a_side.clone(), turned(without_a_side.clone())].concat();
        let point = vec![[[0.5; 3]; 3]];
        for surface in [pillow.clone(), slanted, without_a_side, two_sided_bin, point] {
            assert_eq!(judged(&surface, &[0.0, -0.4]), (false, vec![false, false]), "{surface:?}");
        }
        // Two layers with different diagonals: neither is provably inside the other.
        let crossed = [unit(), turned(Block::about([0.0; 3], 0.5).triangles(true))].concat();
        assert!(!judged(&crossed, &[]).0);
        // A closed part beside an open surface still has an interior.
        let far = |corners: Corners| corners.map(|[x, y, z]| [x + 3.0, y, z]);
        let beside = [unit(), pillow.into_iter().map(far).collect()].concat();
        assert_eq!(judged(&beside, &[0.0, 2.6]), (false, vec![true, false]));
        // A corner in the middle of an edge, with and without a triangle that closes the gap.
        let [a, b, c] = unit()[0];
        let middle = std::array::from_fn(|k| 0.5 * (a[k] + b[k]));
        let mut split = unit();
        split.splice(..1, [[a, middle, c], [middle, b, c]]);
        assert_eq!(judged(&split, &[0.0]), (false, vec![false]));
        split.push([a, b, middle]);
        assert_eq!(judged(&split, &[0.0, 0.6]), (true, vec![true, false]));
    }

    #[test]
    fn no_point_of_a_body_is_outside_of_a_closed_mesh() {
        let mut rng = rng::stream(1, 0);
        let (mut closed, mut cavities) = (0, 0);
        for case in 0..600 {
            let round = case % 2 == 0;
            let place = |rng: &mut LazyRng| if round { rng.below(5) as f64 } else { rng.uniform_in(0.0, 4.0) };
            let mut parts: Vec<(Block, bool)> = vec![];
            let mut triangles = vec![];
            for _ in 0..=rng.below(4) {
                let (mut lower, mut upper) = ([0.0; 3], [0.0; 3]);
                for k in 0..3 {
                    let ends = [place(&mut rng), place(&mut rng)];
                    (lower[k], upper[k]) = (ends[0].min(ends[1]), ends[0].max(ends[1]) + if round { 1.0 } else { 0.1 });
                }
                if let Some((last, _)) = parts.last().filter(|_| rng.below(2) == 0) {
                    // Box inside the previous one.
                    lower = std::array::from_fn(|k| 0.8 * last.lower[k] + 0.2 * last.upper[k]);
                    upper = std::array::from_fn(|k| 0.2 * last.lower[k] + 0.8 * last.upper[k]);
                }
                let (block, outward) = (Block { lower, upper }, rng.below(2) == 0);
                parts.push((block, outward));
                let mut own = block.triangles(rng.below(2) == 0);
                if rng.below(6) == 0 {
                    own.extend(turned(own.clone()));
                }
                if rng.below(6) == 0 {
                    let turn = rng.below(own.len());
                    own[turn] = turned(vec![own[turn]])[0];
                }
                triangles.extend(if outward { own } else { turned(own) });
            }
            let shape = mesh_of(&triangles);
            let mesh = as_mesh(&shape);
            closed += usize::from(mesh.is_closed());
            assert!(round || mesh.is_closed(), "{parts:?}");
            for _ in 0..60 {
                let p = Vector3::from_fn(|_, _| rng.uniform_in(-0.5, 5.5));
                let is_near_a_wall = parts.iter().any(|(block, _)| block.holds(&p, 1e-3) != block.holds(&p, -1e-3));
                let is_inside = parts.iter().any(|(block, _)| block.holds(&p, 0.0));
                if is_near_a_wall {
                    continue;
                }
                assert!(is_inside || !mesh.encloses(&p), "{parts:?}: {p}");
                if is_inside && mesh.is_closed() && !mesh.encloses(&p) {
                    cavities += 1;
                    let walls = parts.iter().filter(|(block, _)| block.holds(&p, 0.0));
                    let is_cavity = walls
                        .clone()
                        .any(|(inner, one)| walls.clone().any(|(outer, other)| one != other && inner.is_within(outer)));
                    assert!(is_cavity, "{parts:?}: {p}");
                }
            }
        }
        assert!(closed > 350 && cavities > 20, "{closed} {cavities}");
    }
}
