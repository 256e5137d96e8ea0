//! A tree of configurations, each joined to its parent by a clear straight line.

use smallvec::SmallVec;

use crate::math::STACK_DOF;
use crate::math::nearest_by_lane::{Distance, LANES, LaneRow, nearest_by_lane};
use crate::math::vector::distance;
use crate::rng::LazyRng;

/// The tree. Distances are Euclidean in rad and m.
#[derive(Debug)]
pub(super) struct ConfigurationTree {
    joints: usize,
    /// The configurations, one after another.
    nodes: Vec<f64>,
    /// The same in single precision, eight in a block of one row for each joint: what a search for the nearest reads.
    blocks: Vec<LaneRow>,
    parents: Vec<Option<usize>>,
    /// Number of times that each node was picked by [`little_tried`](Self::little_tried).
    tries: Vec<u32>,
}

/// Squared distance from a configuration.
struct FromConfiguration<'q>(&'q [f32]);

impl Distance for FromConfiguration<'_> {
    #[inline(always)]
    fn of(&self, block: &[LaneRow]) -> LaneRow {
        let mut sums = [0.0; LANES];
        for (row, q) in block.iter().zip(self.0) {
            for (sum, value) in sums.iter_mut().zip(row) {
                *sum += (value - q) * (value - q);
            }
        }
        sums
    }
}

impl ConfigurationTree {
    /// Plants a tree of configurations of `joints` joints with these roots.
    pub fn rooted<'q>(joints: usize, roots: impl IntoIterator<Item = &'q [f64]>) -> Self {
        let mut tree = Self { joints, nodes: vec![], blocks: vec![], parents: vec![], tries: vec![] };
        roots.into_iter().for_each(|root| _ = tree.add(root, None));
        tree
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.parents.len()
    }

    /// The configuration of a node.
    pub fn node(&self, node: usize) -> &[f64] {
        &self.nodes[self.joints * node..self.joints * (node + 1)]
    }

    /// Adds a configuration; returns its number.
    pub fn add(&mut self, q: &[f64], parent: Option<usize>) -> usize {
        let (block, lane) = (self.len() / LANES, self.len() % LANES);
        // Places without a node are infinitely far from everything.
        self.blocks.resize((block + 1) * self.joints, [f32::INFINITY; LANES]);
        for (row, q) in self.blocks[block * self.joints..].iter_mut().zip(q) {
            row[lane] = *q as f32;
        }
        self.nodes.extend_from_slice(q);
        self.parents.push(parent);
        self.tries.push(0);
        self.len() - 1
    }

    /// The nearest node to `q`, up to rounding in single precision, and its distance; `None` in an empty tree.
    pub fn nearest(&self, q: &[f64]) -> Option<(usize, f64)> {
        if self.parents.is_empty() {
            return None;
        }
        let single: SmallVec<[f32; STACK_DOF]> = q.iter().map(|q| *q as f32).collect();
        let blocks = 0..self.len().div_ceil(LANES);
        let [nearest, ..] = nearest_by_lane(&self.blocks, self.joints, blocks, &FromConfiguration(&single));
        Some((nearest, distance(self.node(nearest), q)))
    }

    /// Picks the less often picked of two random nodes.
    pub fn little_tried(&mut self, rng: &mut LazyRng) -> usize {
        let [one, other] = rng.pair_below(self.len());
        let node = if self.tries[one] <= self.tries[other] { one } else { other };
        self.tries[node] += 1;
        node
    }

    /// The configurations from the root to a node.
    pub fn path_from_root(&self, node: usize) -> Vec<Vec<f64>> {
        let line = std::iter::successors(Some(node), |node| self.parents[*node]);
        let mut path: Vec<Vec<f64>> = line.map(|node| self.node(node).to_vec()).collect();
        path.reverse();
        path
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng;

    #[test]
    fn no_node_is_tried_much_less_often_than_others() {
        let mut tree = ConfigurationTree::rooted(1, (0..50).map(|_| &[0.0][..]));
        let mut rng = rng::stream(1, 0);
        (0..5000).for_each(|_| _ = tree.little_tried(&mut rng));
        assert!(tree.tries.iter().all(|tries| (90..=110).contains(tries)), "{:?}", tree.tries);
    }

    #[test]
    fn the_nearest_node_is_that_of_the_least_distance() {
        let mut rng = rng::stream(2, 0);
        for joints in 1..=17 {
            let mut drawn = vec![0.0; 21 * joints];
            rng.symmetric(&mut drawn);
            let (q, nodes) = drawn.split_at(joints);
            let tree = ConfigurationTree::rooted(joints, nodes.chunks_exact(joints));
            let distance = |node: &[f64]| node.iter().zip(q).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
            let (nearest, least) = tree.nearest(q).unwrap();
            assert!((distance(tree.node(nearest)) - least).abs() < 1e-14);
            assert!((0..tree.len()).all(|node| distance(tree.node(node)) > least - 1e-6)); // single precision
        }
    }
}
