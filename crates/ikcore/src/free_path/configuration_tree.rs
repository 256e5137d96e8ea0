//! A tree of configurations, each joined to its parent by a clear straight line.

use crate::rng::LazyRng;

/// Number of sums that a distance is split into: one would wait for each addition.
const SUMS: usize = 4;

/// The tree. Distances are Euclidean in rad and m.
#[derive(Debug)]
pub(super) struct ConfigurationTree {
    joints: usize,
    /// The configurations, one after another.
    nodes: Vec<f64>,
    parents: Vec<Option<usize>>,
    /// Number of times that each node was picked by [`little_tried`](Self::little_tried).
    tries: Vec<u32>,
}

impl ConfigurationTree {
    /// Plants a tree of configurations of `joints` joints with these roots.
    pub fn rooted<'q>(joints: usize, roots: impl IntoIterator<Item = &'q [f64]>) -> Self {
        let mut tree = Self { joints, nodes: vec![], parents: vec![], tries: vec![] };
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
        self.nodes.extend_from_slice(q);
        self.parents.push(parent);
        self.tries.push(0);
        self.len() - 1
    }

    /// The nearest node to `q`, and its distance; `None` in an empty tree.
    pub fn nearest(&self, q: &[f64]) -> Option<(usize, f64)> {
        let distances = self.nodes.chunks_exact(self.joints).map(|node| squared_distance(node, q)).enumerate();
        let nearest = distances.min_by(|one, other| one.1.total_cmp(&other.1));
        nearest.map(|(node, squared)| (node, squared.sqrt()))
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

/// The squared distance of two configurations.
fn squared_distance(one: &[f64], other: &[f64]) -> f64 {
    let mut sums = [0.0; SUMS];
    let (one, other) = (one.chunks(SUMS), other.chunks(SUMS));
    for (a, b) in one.zip(other) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += (a - b) * (a - b);
        }
    }
    sums.iter().sum()
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
            assert!((0..tree.len()).all(|node| distance(tree.node(node)) > least - 1e-14));
        }
    }
}
