//! Bounding volume hierarchy over the pieces of a shape. Each node holds four boxes, one per SIMD lane; each leaf holds four
//! pieces.

use nalgebra::Vector3;

use crate::math::arithmetic::Arithmetic;
use crate::math::f64x4::F64x4;
use crate::math::real::{Four, Real};
use crate::math::vec3::Vec3;

/// Axis-aligned box (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Aabb {
    pub lower: Vector3<f64>,
    pub upper: Vector3<f64>,
}

impl Aabb {
    /// Returns the smallest box around `points`.
    pub fn around(points: impl IntoIterator<Item = Vector3<f64>>) -> Self {
        let empty = Self { lower: Vector3::repeat(f64::INFINITY), upper: Vector3::repeat(f64::NEG_INFINITY) };
        points.into_iter().fold(empty, |all, p| Self { lower: all.lower.inf(&p), upper: all.upper.sup(&p) })
    }

    fn is_empty(&self) -> bool {
        self.lower.x > self.upper.x
    }

    fn with(self, other: &Self) -> Self {
        Self { lower: self.lower.inf(&other.lower), upper: self.upper.sup(&other.upper) }
    }
}

/// Marker of an empty lane.
pub(super) const NONE: u32 = u32::MAX;
/// Bit of a child index that marks a leaf.
const LEAF: u32 = 1 << 31;
/// Length (m) below which a segment has no direction.
const SHORTEST: f64 = 1e-100;
/// Stack size of a search: each level leaves three children waiting, and a tree of 2^31 pieces has at most 16 levels.
const STACK: usize = 64;

/// Node with four boxes and their children.
#[derive(Debug, Clone)]
struct Node {
    center: [F64x4; 3],
    half: [F64x4; 3],
    child: [u32; 4],
}

/// Up to four pieces of a shape: their data, one piece per SIMD lane, and their indices or [`NONE`].
#[derive(Debug, Clone)]
pub(super) struct Leaf<L> {
    pub lanes: L,
    pieces: [u32; 4],
}

/// Bounding volume hierarchy.
#[derive(Debug, Clone)]
pub(super) struct BoundingTree<L> {
    nodes: Vec<Node>,
    leaves: Vec<Leaf<L>>,
    root: u32,
    bounds: Aabb,
}

/// Segment, prepared for comparison with boxes.
pub(super) struct SegmentQuery {
    center: [f64; 3],
    half: [f64; 3],
    /// Unit vectors perpendicular to the segment and to one coordinate axis; zero if the segment is along that axis.
    across: [[f64; 3]; 3],
    /// True for a point, whose distance from a box is exact without the vectors above.
    is_point: bool,
}

impl SegmentQuery {
    pub fn new([a, b]: &[Vector3<f64>; 2]) -> Self {
        let along = b - a;
        let across = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| {
            let normal = along.cross(&axis);
            normal.try_normalize(1e-9 * along.norm()).unwrap_or_default().into()
        });
        let center = (0.5 * (a + b)).into();
        // Directions from lengths whose squares underflow would be arbitrary.
        Self { center, half: (0.5 * along.abs()).into(), across, is_point: along.amax() < SHORTEST }
    }
}

impl Node {
    const EMPTY: Self = Self { center: [F64x4::ZERO; 3], half: [F64x4::ZERO; 3], child: [NONE; 4] };
}

impl<L> BoundingTree<L> {
    /// Builds a tree over the boxes of pieces. `lanes_of` gathers the data of four pieces; empty lanes repeat the first
    /// piece.
    pub fn new(boxes: &[Aabb], lanes_of: impl Fn([usize; 4]) -> L) -> Self {
        if boxes.is_empty() {
            return Self { nodes: vec![Node::EMPTY], leaves: vec![], root: 0, bounds: Aabb::around([]) };
        }
        let mut items: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut build = Build { boxes, nodes: vec![], blocks: vec![] };
        let (root, bounds) = build.subtree(&mut items);
        let leaf = |pieces: [u32; 4]| {
            let lanes = lanes_of(pieces.map(|piece| if piece == NONE { pieces[0] } else { piece } as usize));
            Leaf { lanes, pieces }
        };
        Self { nodes: build.nodes, leaves: build.blocks.into_iter().map(leaf).collect(), root, bounds }
    }

    /// Returns the tree of some of the pieces, in the same leaves, which takes a fraction of the time of a new tree. `numbers`
    /// has the new index of each piece, or [`NONE`]; `box_of` and `lanes_of` take new indices.
    pub fn of_some(&self, numbers: &[u32], box_of: impl Fn(usize) -> Aabb, lanes_of: impl Fn([usize; 4]) -> L) -> Self {
        if self.root & LEAF != 0 {
            let kept = numbers.iter().filter(|number| **number != NONE).count();
            return Self::new(&(0..kept).map(box_of).collect::<Vec<_>>(), lanes_of);
        }
        let mut leaves = vec![];
        let mut of_leaf = |leaf: &Leaf<L>| {
            let pieces = leaf.pieces.map(|piece| numbers.get(piece as usize).copied().unwrap_or(NONE));
            let first = pieces.into_iter().find(|piece| *piece != NONE)?;
            let full = pieces.map(|piece| if piece == NONE { first } else { piece } as usize);
            leaves.push(Leaf { lanes: lanes_of(full), pieces });
            Some(((leaves.len() as u32 - 1) | LEAF, full.iter().fold(Aabb::around([]), |all, i| all.with(&box_of(*i)))))
        };
        let (mut nodes, mut bounds) = (self.nodes.clone(), vec![Aabb::around([]); self.nodes.len()]);
        // The children of a node are behind it.
        for index in (0..nodes.len()).rev() {
            for lane in 0..4 {
                let kept = match nodes[index].child[lane] {
                    NONE => continue,
                    leaf if leaf & LEAF != 0 => of_leaf(&self.leaves[(leaf & !LEAF) as usize]),
                    node => (!bounds[node as usize].is_empty()).then_some((node, bounds[node as usize])),
                };
                nodes[index].child[lane] = kept.map_or(NONE, |(child, _)| child);
                if let Some((_, of_child)) = kept {
                    nodes[index].set_box(lane, &of_child);
                    bounds[index] = bounds[index].with(&of_child);
                }
            }
        }
        Self { nodes, leaves, root: self.root, bounds: bounds[0] }
    }

    /// Returns the bounding box of the whole tree.
    pub fn bounds(&self) -> &Aabb {
        &self.bounds
    }

    /// Visits leaves that may hold pieces within the square root of `bound` of the segment, nearest boxes first. `visit`
    /// takes a leaf and the bound, and returns the new bound.
    #[inline(always)]
    pub fn search<A: Arithmetic>(
        &self,
        query: &SegmentQuery,
        mut bound: f64,
        mut visit: impl FnMut(&Leaf<L>, f64) -> f64,
    ) {
        let mut stack = [(0.0, 0_u32); STACK];
        stack[0] = (0.0, self.root);
        let mut waiting = 1;
        while waiting > 0 {
            waiting -= 1;
            let (nearest, item) = stack[waiting];
            // Boxes at exactly the bound may still hold a piece at the bound.
            if nearest > bound {
                continue;
            }
            if item & LEAF != 0 {
                bound = visit(&self.leaves[(item & !LEAF) as usize], bound);
                continue;
            }
            let node = &self.nodes[item as usize];
            let distances = node.squared_distances::<A>(query).0;
            let first = waiting;
            for lane in 0..4 {
                if distances[lane] <= bound && node.child[lane] != NONE {
                    // Insertion sort, nearest on top.
                    let mut place = waiting;
                    while place > first && stack[place - 1].0 < distances[lane] {
                        stack[place] = stack[place - 1];
                        place -= 1;
                    }
                    stack[place] = (distances[lane], node.child[lane]);
                    waiting += 1;
                }
            }
        }
    }

    /// Visits the pieces of leaves whose boxes contain `point` in the projection along x, and reach at or beyond its x.
    pub fn along_x(&self, point: &Vector3<f64>, mut visit: impl FnMut(usize)) {
        let mut stack = [0_u32; STACK];
        stack[0] = self.root;
        let mut waiting = 1;
        while waiting > 0 {
            waiting -= 1;
            let item = stack[waiting];
            if item & LEAF != 0 {
                self.leaves[(item & !LEAF) as usize].pieces().for_each(&mut visit);
                continue;
            }
            let node = &self.nodes[item as usize];
            for lane in 0..4 {
                let beside = |k: usize| (node.center[k].0[lane] - point[k]).abs() > node.half[k].0[lane];
                let behind = node.center[0].0[lane] + node.half[0].0[lane] < point.x;
                if node.child[lane] != NONE && !(behind || beside(1) || beside(2)) {
                    stack[waiting] = node.child[lane];
                    waiting += 1;
                }
            }
        }
    }
}

impl<L> Leaf<L> {
    /// Returns the index of the piece in a lane; `None` for an empty lane.
    #[inline(always)]
    pub fn piece(&self, lane: usize) -> Option<usize> {
        (self.pieces[lane] != NONE).then_some(self.pieces[lane] as usize)
    }

    /// Returns the indices of all pieces.
    #[inline(always)]
    pub fn pieces(&self) -> impl Iterator<Item = usize> {
        (0..4).filter_map(|lane| self.piece(lane))
    }
}

impl Node {
    fn set_box(&mut self, lane: usize, bounds: &Aabb) {
        let (center, half) = (0.5 * (bounds.lower + bounds.upper), 0.5 * (bounds.upper - bounds.lower));
        for k in 0..3 {
            self.center[k].0[lane] = center[k];
            // Half extents are enlarged, since the rounded centre must still leave both sides covered.
            self.half[k].0[lane] = half[k] * (1.0 + 1e-15) + 1e-15 * center[k].abs();
        }
    }

    /// Returns lower bounds on the squared distances of a segment from the four boxes; exact for a point.
    #[inline(always)]
    fn squared_distances<A: Arithmetic>(&self, query: &SegmentQuery) -> F64x4 {
        let offset = Vec3::<Four<A>>::of(&self.center) - Vec3::splat(&query.center);
        let half = Vec3::<Four<A>>::of(&self.half);
        let own = Vec3::splat(&query.half);
        let x = gap(offset.x, half.x + own.x);
        let y = gap(offset.y, half.y + own.y);
        let z = gap(offset.z, half.z + own.z);
        let mut squared = x * x + y * y + z * z;
        if !query.is_point {
            for normal in &query.across {
                let across = Vec3::<Four<A>>::splat(normal);
                let reach = Vec3::<Four<A>>::splat(&[normal[0].abs(), normal[1].abs(), normal[2].abs()]);
                let apart = gap(across.dot(offset), reach.dot(half));
                squared = squared.larger(apart * apart);
            }
        }
        squared.stored()
    }
}

/// Returns the distance between an interval of half-width `half` and a value at `offset` from its middle, or 0 inside.
#[inline(always)]
fn gap<R: Real>(offset: R, half: R) -> R {
    (offset.larger(-offset) - half).larger(R::splat(0.0))
}

struct Build<'a> {
    boxes: &'a [Aabb],
    nodes: Vec<Node>,
    blocks: Vec<[u32; 4]>,
}

impl Build<'_> {
    /// Builds the subtree of `items`; returns its child index and box.
    fn subtree(&mut self, items: &mut [u32]) -> (u32, Aabb) {
        if items.len() <= 4 {
            let block = std::array::from_fn(|lane| items.get(lane).copied().unwrap_or(NONE));
            self.blocks.push(block);
            let bounds = items.iter().fold(Aabb::around([]), |all, i| all.with(&self.boxes[*i as usize]));
            return ((self.blocks.len() - 1) as u32 | LEAF, bounds);
        }
        let index = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        let mut whole = Aabb::around([]);
        let (left, right) = self.halves(items);
        let mut lane = 0;
        for half in [left, right] {
            let (first, second) = if half.len() > 4 { self.halves(half) } else { (half, &mut [][..]) };
            for quarter in [first, second] {
                if quarter.is_empty() {
                    continue;
                }
                let (child, bounds) = self.subtree(quarter);
                let node = &mut self.nodes[index];
                node.child[lane] = child;
                node.set_box(lane, &bounds);
                whole = whole.with(&bounds);
                lane += 1;
            }
        }
        (index as u32, whole)
    }

    /// Splits at the median along the longest extent; the first half fills whole leaves.
    fn halves<'i>(&self, items: &'i mut [u32]) -> (&'i mut [u32], &'i mut [u32]) {
        let middle = |i: u32| self.boxes[i as usize].lower + self.boxes[i as usize].upper;
        let spread = Aabb::around(items.iter().map(|i| middle(*i)));
        let axis = (spread.upper - spread.lower).imax();
        let at = (items.len() / 2).next_multiple_of(4);
        items.select_nth_unstable_by(at.min(items.len() - 1), |i, j| middle(*i)[axis].total_cmp(&middle(*j)[axis]));
        items.split_at_mut(at.min(items.len()))
    }
}
