//! Connected pieces of a mesh, and the orientation of their triangles.
//!
//! Triangles are connected along edges. If every edge of a piece belongs to two triangles, the piece is a closed surface, and
//! the orientation of one triangle determines that of all others, whatever their order of corners. Coincident vertices are
//! merged, because STL files repeat them, and so are triangles on the same three vertices, because two-sided exports write
//! each triangle in both orientations. At an edge of more than two triangles (bodies that share an edge or a face) the given
//! orientations must cancel.

use std::collections::HashMap;

/// Marker of a triangle without a piece.
pub(super) const NO_PIECE: usize = usize::MAX;

/// Connected part of a mesh.
#[derive(Debug)]
pub(super) struct MeshPiece {
    /// Indices of its triangles.
    pub faces: Vec<u32>,
    /// True if the piece has no boundary.
    pub closed: bool,
    /// True if all triangles were given in one orientation.
    pub one_sided: bool,
}

/// Pieces of a mesh, and for each triangle +1 as given, -1 reversed, 0 if it repeats another triangle or belongs to a piece
/// with boundary.
#[derive(Debug)]
pub(super) struct MeshPieces {
    pub pieces: Vec<MeshPiece>,
    pub turns: Vec<i8>,
    /// Index of the piece of each triangle, or [`NO_PIECE`].
    pub of: Vec<usize>,
}

/// Edge of a triangle; `up` if it runs from the lower vertex index to the higher.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct HalfEdge {
    low: u32,
    high: u32,
    face: u32,
    up: bool,
}

impl MeshPieces {
    /// Finds the pieces, in the order of their first triangles. Triangles with two coincident corners belong to none.
    pub fn of(vertices: &[[f64; 3]], faces: &[[u32; 3]]) -> Self {
        let faces = welded(vertices, faces);
        let is_real = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
        let first = first_alike(&faces);
        let edges = sorted_edges(&faces, is_real);
        let mut sets = OrientedSets::new(faces.len());
        let mut defects = vec![Defects::default(); faces.len()];
        for edge in edges.chunk_by(|one, other| (one.low, one.high) == (other.low, other.high)) {
            let mut alone = edge.iter().filter(|half| first[half.face as usize].0 == half.face);
            let is_simple = match (alone.next(), alone.next(), alone.next()) {
                // Neighbours of equal orientation run along their edge in opposite directions.
                (Some(one), Some(other), None) => sets.join(one.face, other.face, one.up == other.up),
                _ => false,
            };
            edge.windows(2).for_each(|pair| _ = sets.join(pair[0].face, pair[1].face, false));
            let surplus: i32 = edge.iter().map(|half| if half.up { 1 } else { -1 }).sum();
            defects[edge[0].face as usize].branches |= !is_simple;
            defects[edge[0].face as usize].unbalanced |= surplus != 0;
        }
        gathered(&faces, &first, &mut sets, &defects, is_real)
    }
}

/// Defects of the edges of a piece.
#[derive(Clone, Copy, Default)]
struct Defects {
    /// Some edge belongs to one triangle, or to more than two.
    branches: bool,
    /// Some edge has more triangles in one direction than in the other.
    unbalanced: bool,
}

/// Merges coincident vertices: returns the faces with the first vertex at each position.
fn welded(vertices: &[[f64; 3]], faces: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut places: HashMap<[u64; 3], u32> = HashMap::with_capacity(vertices.len());
    let place: Vec<u32> = (0..vertices.len())
        // Adding zero maps -0 to 0.
        .map(|i| *places.entry(vertices[i].map(|x| (x + 0.0).to_bits())).or_insert(i as u32))
        .collect();
    faces.iter().map(|face| face.map(|i| place[i as usize])).collect()
}

/// Returns for each triangle the first one on the same vertices, and whether both have the same orientation.
fn first_alike(faces: &[[u32; 3]]) -> Vec<(u32, bool)> {
    let sorted = |i: usize| {
        let mut corners = faces[i];
        corners.sort_unstable();
        corners
    };
    // Even permutations keep the orientation.
    let is_even = |[a, b, c]: [u32; 3]| [a < b, b < c, c < a].iter().filter(|rises| **rises).count() == 2;
    let mut order: Vec<([u32; 3], u32)> = (0..faces.len()).map(|i| (sorted(i), i as u32)).collect();
    order.sort_unstable();
    let mut first = vec![(0, true); faces.len()];
    for alike in order.chunk_by(|one, other| one.0 == other.0) {
        let leader = alike[0].1;
        for (_, face) in alike {
            first[*face as usize] = (leader, is_even(faces[*face as usize]) == is_even(faces[leader as usize]));
        }
    }
    first
}

fn sorted_edges(faces: &[[u32; 3]], is_real: impl Fn(&[u32; 3]) -> bool) -> Vec<HalfEdge> {
    let mut edges = Vec::with_capacity(3 * faces.len());
    for (face, corners) in faces.iter().enumerate().filter(|(_, corners)| is_real(corners)) {
        let [a, b, c] = *corners;
        let half = |(from, to): (u32, u32)| {
            let (low, high) = (from.min(to), from.max(to));
            HalfEdge { low, high, face: face as u32, up: from < to }
        };
        edges.extend([(a, b), (b, c), (c, a)].map(half));
    }
    edges.sort_unstable();
    edges
}

/// Collects the pieces from the sets of connected triangles.
fn gathered(
    faces: &[[u32; 3]],
    first: &[(u32, bool)],
    sets: &mut OrientedSets,
    defects: &[Defects],
    is_real: impl Fn(&[u32; 3]) -> bool,
) -> MeshPieces {
    let mut number = vec![NO_PIECE; faces.len()];
    let mut pieces: Vec<MeshPiece> = vec![];
    let mut found: Vec<Defects> = vec![];
    for face in (0..faces.len()).filter(|face| is_real(&faces[*face])) {
        let (root, _) = sets.root(face as u32);
        let piece = &mut number[root as usize];
        if *piece == NO_PIECE {
            *piece = pieces.len();
            pieces.push(MeshPiece { faces: vec![], closed: false, one_sided: true });
            found.push(Defects::default());
        }
        pieces[*piece].faces.push(face as u32);
        found[*piece].branches |= defects[face].branches;
        found[*piece].unbalanced |= defects[face].unbalanced;
    }
    let mut turns = vec![0; faces.len()];
    for (piece, Defects { branches, unbalanced }) in pieces.iter_mut().zip(found) {
        piece.closed = !(branches && unbalanced);
        let (_, orientation) = sets.root(piece.faces[0]);
        for face in &piece.faces {
            let (leader, same) = first[*face as usize];
            let turned = !branches && sets.root(*face).1 != orientation;
            piece.one_sided &= branches || (same && (leader != *face || !turned));
            turns[*face as usize] = match (piece.closed, branches || leader == *face, turned) {
                (true, true, false) => 1,
                (true, true, true) => -1,
                _ => 0,
            };
        }
    }
    let of = (0..faces.len()).map(|face| number[sets.root(face as u32).0 as usize]).collect();
    MeshPieces { pieces, turns, of }
}

/// Disjoint sets of triangles, with the orientation of each triangle relative to the root.
struct OrientedSets {
    parent: Vec<(u32, bool)>,
}

impl OrientedSets {
    fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).map(|i| (i, false)).collect() }
    }

    /// Returns the root of the set of `face`, and whether `face` is reversed relative to the root.
    fn root(&mut self, face: u32) -> (u32, bool) {
        let (mut at, mut turned) = (face, false);
        while self.parent[at as usize].0 != at {
            let (parent, turn) = self.parent[at as usize];
            let (above, turn_above) = self.parent[parent as usize];
            // Path halving.
            self.parent[at as usize] = if parent == above { (parent, turn) } else { (above, turn != turn_above) };
            (at, turned) = (self.parent[at as usize].0, turned != self.parent[at as usize].1);
        }
        (at, turned)
    }

    /// Joins two sets with the given relative orientation; returns false if they are already joined with the opposite one.
    fn join(&mut self, one: u32, other: u32, turned: bool) -> bool {
        let ((one, turn), (other, turn_other)) = (self.root(one), self.root(other));
        if one == other {
            return (turn != turn_other) == turned;
        }
        self.parent[one.max(other) as usize] = (one.min(other), (turn != turn_other) != turned);
        true
    }
}
