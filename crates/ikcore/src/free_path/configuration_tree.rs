//! A tree of configurations, each joined to its parent by a clear straight line.

/// Domain of a node that could not grow, relative to the diagonal of the joint ranges: only samples within it let the
/// node try again (dynamic domain: Yershova et al., ICRA 2005).
const DOMAIN: f64 = 0.3;
/// Factor of the domain after each success, and its inverse after each failure.
const ADAPTION: f64 = 1.0 + 1e-4;
/// The smallest domain, relative to the first.
const SMALLEST_DOMAIN: f64 = 0.25;

/// The tree. Distances are Euclidean in rad and m.
#[derive(Debug)]
pub(super) struct ConfigurationTree {
    joints: usize,
    /// The configurations, one after another.
    nodes: Vec<f64>,
    parents: Vec<Option<usize>>,
    domains: Vec<f64>,
    /// The domain after the first failure.
    first_domain: f64,
}

impl ConfigurationTree {
    /// Plants a tree with these roots between joint limits.
    pub fn rooted<'q>(ranges: &[(f64, f64)], roots: impl IntoIterator<Item = &'q [f64]>) -> Self {
        let diagonal = ranges.iter().map(|(lower, upper)| (upper - lower) * (upper - lower)).sum::<f64>().sqrt();
        let first_domain = DOMAIN * diagonal;
        let mut tree = Self { joints: ranges.len(), nodes: vec![], parents: vec![], domains: vec![], first_domain };
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
        self.domains.push(f64::INFINITY);
        self.len() - 1
    }

    /// The nearest node to `q`, and its distance; `None` in an empty tree.
    pub fn nearest(&self, q: &[f64]) -> Option<(usize, f64)> {
        let squared = |node: &[f64]| node.iter().zip(q).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
        let distances = self.nodes.chunks_exact(self.joints).map(squared).enumerate();
        let nearest = distances.min_by(|one, other| one.1.total_cmp(&other.1));
        nearest.map(|(node, squared)| (node, squared.sqrt()))
    }

    /// Whether a sample at `distance` is worth growing towards.
    pub fn is_in_domain(&self, node: usize, distance: f64) -> bool {
        distance <= self.domains[node]
    }

    /// Notes whether a node grew.
    pub fn note(&mut self, node: usize, grew: bool) {
        let domain = &mut self.domains[node];
        *domain = match (grew, domain.is_finite()) {
            (true, _) => *domain * ADAPTION,
            (false, true) => (*domain / ADAPTION).max(SMALLEST_DOMAIN * self.first_domain),
            (false, false) => self.first_domain,
        };
    }

    /// The configurations from the root to a node.
    pub fn path_from_root(&self, node: usize) -> Vec<Vec<f64>> {
        let line = std::iter::successors(Some(node), |node| self.parents[*node]);
        let mut path: Vec<Vec<f64>> = line.map(|node| self.node(node).to_vec()).collect();
        path.reverse();
        path
    }
}
