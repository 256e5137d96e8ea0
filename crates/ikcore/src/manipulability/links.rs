//! Indices of all links' tips, and their sum: the tracking indices SM_i and SM of "Trajectory tracking of redundant manipulator
//! based on PSO algorithm optimization", eq. (15) and (16).

use std::f64::consts::PI;

use super::gradient;
use super::index::Manipulability;
use crate::math::Columns;
use crate::math::MAX_DOF;
use crate::robot::Robot;

/// Indices of all moving links, base to tip.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkIndices {
    values: [f64; MAX_DOF],
    count: usize,
}

impl LinkIndices {
    /// Index of each moving link; the last is the tip's. Zero for links with fewer joints before them than the rank.
    pub fn values(&self) -> &[f64] {
        &self.values[..self.count]
    }

    /// Sum of the indices, eq. (16).
    pub fn sum(&self) -> f64 {
        self.values().iter().sum()
    }
}

impl Manipulability {
    /// Indices SM_i = k_m w_i of eq. (15) at `q`, which has one finite entry per joint: w_i is the index of the tip of link i
    /// moved by the joints before it, k_m w_i the area or volume of its ellipsoid.
    pub fn link_indices(&self, robot: &Robot, q: &[f64]) -> LinkIndices {
        let screws = robot.screws(q);
        let mut indices = LinkIndices { values: [0.0; MAX_DOF], count: screws.len() };
        for (i, link) in screws.iter().enumerate() {
            let mut columns = Columns::default();
            columns.fit(q.len());
            for screw in &screws[..=i] {
                let element = screw.column(&link.end);
                columns[screw.joint].iter_mut().zip(element).for_each(|(sum, entry)| *sum += entry);
            }
            indices.values[i] = self.unit_ball() * self.index_of(&mut columns[..q.len()]);
        }
        indices
    }

    /// Returns SM = sum of SM_i at `q`, and writes its gradient (n,) to `out`. `q` and `out` have one entry per joint.
    pub fn overall_gradient(&self, robot: &Robot, q: &[f64], out: &mut [f64]) -> f64 {
        let screws = robot.screws(q);
        out.fill(0.0);
        let sum: f64 = (1..=screws.len()).map(|i| gradient::add(self, &screws[..i], &screws[i - 1].end, out)).sum();
        out.iter_mut().for_each(|entry| *entry *= self.unit_ball());
        self.unit_ball() * sum
    }

    /// Volume k_m of the unit ball in m dimensions, m the rank; pi in the plane. See eq. (15).
    pub fn unit_ball(&self) -> f64 {
        // Recurrence V_m = V_{m-2} 2 pi / m, from V_0 = 1 and V_1 = 2.
        let m = self.rank();
        let (first, from) = if m.is_multiple_of(2) { (1.0, 2) } else { (2.0, 3) };
        (from..=m).step_by(2).fold(first, |volume, m| volume * 2.0 * PI / m as f64)
    }
}
