//! The terms of joint torques at points of a path.

use super::joint_path::JointPath;
use crate::constraint::{FourTorquePoints, JointTorques, TooHeavy};

/// Index of a point whose terms are known or requested.
pub(super) type Node = usize;

/// A point of a path: a piece, and the path parameter within it.
pub(super) type NodePlace = (usize, f64);

/// Points of a path, and the terms there: of those asked for, four at a time.
#[derive(Debug)]
pub(super) struct TorqueNodes<'a> {
    path: &'a JointPath,
    torques: &'a JointTorques,
    four: FourTorquePoints,
    /// Positions of the joints and their first two derivatives at a point.
    point: [Vec<f64>; 3],
    places: Vec<NodePlace>,
    /// By node, by term, by joint.
    terms: Vec<f64>,
}

/// Terms of all joints (n,) at a node.
#[derive(Debug, Clone, Copy)]
pub(super) struct NodeTerms<'a> {
    /// Torques that hold the arm.
    pub hold: &'a [f64],
    /// Factors of (ds/dt)^2.
    pub of_square: &'a [f64],
    /// Factors of d2s/dt2.
    pub of_change: &'a [f64],
}

/// Number of terms.
const TERMS: usize = 3;

impl<'a> TorqueNodes<'a> {
    pub(super) fn new(path: &'a JointPath, torques: &'a JointTorques) -> Self {
        let point = [(); 3].map(|()| vec![0.0; torques.dof()]);
        Self { path, torques, four: FourTorquePoints::new(torques), point, places: vec![], terms: vec![] }
    }

    /// A new node, whose terms are not known yet.
    pub(super) fn ask(&mut self, place: NodePlace) -> Node {
        self.places.push(place);
        self.places.len() - 1
    }

    /// The terms at a node, once found.
    #[inline]
    pub(super) fn terms(&self, node: Node) -> NodeTerms<'_> {
        let n = self.torques.dof();
        let (hold, others) = self.terms[TERMS * n * node..][..TERMS * n].split_at(n);
        let (of_square, of_change) = others.split_at(n);
        NodeTerms { hold, of_square, of_change }
    }

    /// Computes the terms of all requested nodes.
    ///
    /// # Errors
    /// The first place where a joint cannot hold the arm.
    pub(super) fn find(&mut self) -> Result<(), (NodePlace, TooHeavy)> {
        let n = self.torques.dof();
        let first = self.terms.len() / (TERMS * n);
        self.terms.resize(TERMS * n * self.places.len(), 0.0);
        for (four, rows) in
            self.places[first..].chunks(4).zip(self.terms[TERMS * n * first..].chunks_mut(4 * TERMS * n))
        {
            for lane in 0..4 {
                // Lanes beyond the last point repeat it.
                let (piece, from) = four[lane.min(four.len() - 1)];
                self.path.write(piece, from, self.point.each_mut().map(|row| &mut row[..]));
                self.four.set(lane, self.point.each_ref().map(|row| &row[..]));
            }
            let terms = self.four.terms(self.torques);
            for (lane, (row, place)) in rows.chunks_exact_mut(TERMS * n).zip(four).enumerate() {
                for (joint, of_joint) in terms.iter().enumerate() {
                    row[joint] = of_joint.hold.0[lane];
                    row[n + joint] = of_joint.of_square.0[lane];
                    row[2 * n + joint] = of_joint.of_change.0[lane];
                }
                if let Some(found) = self.torques.beyond(&row[..n]) {
                    return Err((*place, found));
                }
            }
        }
        Ok(())
    }
}
