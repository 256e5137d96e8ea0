//! The free orientations of a planar arm's links along a path: section III-A of Wang et al. (2019), eq. (7).

use std::f64::consts::{PI, TAU};

use smallvec::SmallVec;

use crate::error::{Error, Result};
use crate::math::cubic_spline::CubicSpline;
use crate::path::Waypoints;
use crate::plan::{ELBOW_LINKS, Elbow, Orientation, Orientations, PlanarArm, PlanarTarget, wrapped};
use crate::task::Target;
use crate::wording::number;

/// Nodes in \[0, 1\] that define each free orientation along the path: the paper's x_phi.
pub(super) const NODES: usize = 5;

/// A planar arm along the points of a path.
#[derive(Debug, Clone)]
pub(super) struct Redundancy {
    arm: PlanarArm,
    elbow: Elbow,
    targets: Vec<PlanarTarget>,
    nodes: CubicSpline,
}

impl Redundancy {
    /// The free orientations of `arm` along `path`.
    ///
    /// # Errors
    /// [`Error::Unreachable`] for a point outside the plane or reach of the arm, or a path of poses for an arm of two
    /// links.
    pub(super) fn new(arm: PlanarArm, path: &Waypoints, elbow: Elbow) -> Result<Self> {
        let nodes = CubicSpline::natural((0..NODES).map(|i| i as f64 / (NODES - 1) as f64).collect());
        let targets = (0..path.len()).map(|i| planar_target(&arm, path, i)).collect::<Result<Vec<_>>>()?;
        Ok(Self { arm, elbow, targets, nodes })
    }

    /// The target of the tip at point `i` of the path.
    pub(super) fn target(&self, i: usize) -> &PlanarTarget {
        &self.targets[i]
    }

    /// Number of points of the path.
    pub(super) fn points(&self) -> usize {
        self.targets.len()
    }

    /// Number of orientations that are free.
    pub(super) fn links(&self) -> usize {
        self.arm.dof() - ELBOW_LINKS - usize::from(self.targets[0].orientation.is_some())
    }

    /// Writes the joint angles at point `i`, wrapped; returns the free orientations. `x` holds [`NODES`] values per
    /// free link, from the last link inwards, `curvatures` the second derivatives of their splines.
    ///
    /// # Errors
    /// The infeasible cosine of eq. (1), if there is no configuration.
    pub(super) fn configuration(
        &self,
        i: usize,
        x: &[f64],
        curvatures: &[f64],
        q: &mut [f64],
    ) -> Result<Orientations, f64> {
        let PlanarTarget { mut position, orientation } = self.targets[i];
        let mut link = self.arm.dof() - 1;
        let mut absolute: SmallVec<[f64; 8]> = SmallVec::new();
        if let Some(given) = orientation {
            position = self.arm.start_of(link, position, given);
            absolute.push(given);
            link -= 1;
        }
        let mut free = Orientations::new();
        let u = i as f64 / (self.targets.len() - 1) as f64;
        for (values, curvatures) in x.chunks_exact(NODES).zip(curvatures.chunks_exact(NODES)) {
            // Clamped: between its nodes the spline may leave [0, 1].
            let fraction = self.nodes.at(u, values, curvatures).clamp(0.0, 1.0);
            let (middle, half) = self.arm.orientation_range(position, link).ok_or(OUT_OF_REACH)?;
            let value = middle - half + 2.0 * half * fraction; // eq. (7)
            position = self.arm.start_of(link, position, value);
            free.push(Orientation { value, lowest: middle - half, highest: middle + half });
            absolute.push(value);
            link -= 1;
        }
        absolute.reverse();
        self.arm.solve(self.targets[i].position, &absolute, self.elbow, q)?;
        Ok(free)
    }

    /// The value x_phi of each free link, from the last one inwards, at the first point of the path in configuration
    /// `q`.
    ///
    /// # Errors
    /// [`Error::InvalidPath`] if the tip is elsewhere at `q`.
    pub(super) fn fractions_of(&self, q: &[f64]) -> Result<Vec<f64>> {
        let PlanarTarget { mut position, orientation } = self.targets[0];
        let tip = self.arm.corners(q).last().unwrap_or(position);
        let absolute = self.arm.orientations(q);
        let mut link = self.arm.dof() - 1;
        let turned = orientation.map_or(0.0, |wanted| wrapped(absolute[link] - wanted).abs());
        let missed = (tip[0] - position[0]).hypot(tip[1] - position[1]);
        if missed > START_TOLERANCE || turned > START_TOLERANCE {
            let problem = format!(
                "start_q puts the tip {} m and {} rad from the first point; it must be there",
                number(missed),
                number(turned)
            );
            return Err(Error::InvalidPath { problem });
        }
        if let Some(given) = orientation {
            position = self.arm.start_of(link, position, given);
            link -= 1;
        }
        let mut fractions = vec![];
        for _ in 0..self.links() {
            let (middle, half) = self.arm.orientation_range(position, link).unwrap_or((absolute[link], PI));
            fractions
                .push((0.5 + wrapped(absolute[link] - middle) / (2.0 * half.max(f64::MIN_POSITIVE))).clamp(0.0, 1.0));
            position = self.arm.start_of(link, position, absolute[link]);
            link -= 1;
        }
        Ok(fractions)
    }

    /// Writes the second derivatives of the splines through the nodes `x`.
    pub(super) fn curvatures(&self, x: &[f64], curvatures: &mut [f64]) {
        for (values, curvatures) in x.chunks_exact(NODES).zip(curvatures.chunks_exact_mut(NODES)) {
            self.nodes.curvatures(values, curvatures);
        }
    }
}

/// Tolerance for a given start on the path (m, rad).
const START_TOLERANCE: f64 = 1e-6;

/// Replaces the cosine if the triangle does not exist.
const OUT_OF_REACH: f64 = 2.0;

fn planar_target(arm: &PlanarArm, path: &Waypoints, i: usize) -> Result<PlanarTarget> {
    let target = match path.pose(i) {
        Some(pose) => Target::from(&pose),
        None => Target::Position(path.position(i)),
    };
    let unreachable =
        |problem: String| Error::Unreachable { what: format!("point {i} of the path"), problem: problem.into() };
    let beside = || unreachable("it lies beside the plane that the arm moves in".into());
    let planar = arm.planar_target(&target).ok_or_else(beside)?;
    let held = usize::from(planar.orientation.is_some());
    if arm.dof() < ELBOW_LINKS + held {
        return Err(unreachable("an arm of two links cannot choose its orientation".into()));
    }
    match arm.problem(&planar) {
        None => Ok(planar),
        Some(problem) => Err(unreachable(problem)),
    }
}

/// `angle` shifted by whole turns to be nearest to `other`.
pub(super) fn nearest_turn(angle: f64, other: f64) -> f64 {
    angle + TAU * ((other - angle) / TAU).round()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::Robot;

    #[test]
    fn fractions_of_a_configuration_lead_back_to_it() {
        let robot = Robot::planar(&[1.0, 0.8, 0.6, 0.4]).unwrap();
        let arm = PlanarArm::of(&robot).unwrap();
        let q = [0.3, 0.7, -0.4, 0.5];
        let tip = robot.tip_position(&q);
        let points = Waypoints::new(vec![tip, [tip[0] - 0.1, tip[1], tip[2]]], None).unwrap();
        let elbow = arm.elbow(&q);
        let redundancy = Redundancy::new(arm, &points, elbow).unwrap();
        let nodes: Vec<f64> =
            redundancy.fractions_of(&q).unwrap().into_iter().flat_map(|fraction| [fraction; NODES]).collect();
        let mut curvatures = vec![1.0; nodes.len()];
        redundancy.curvatures(&nodes, &mut curvatures);
        let mut found = [0.0; 4];
        let free = redundancy.configuration(0, &nodes, &curvatures, &mut found).unwrap();
        assert!(q.iter().zip(found).all(|(q, found)| (q - found).abs() < 1e-9), "{found:?}");
        assert_eq!(free.len(), redundancy.links());
        assert!(free.iter().all(|free| free.lowest <= free.value && free.value <= free.highest), "{free:?}");
        let error = redundancy.fractions_of(&[0.0; 4]).unwrap_err().to_string();
        assert!(error.contains("start_q puts the tip"), "{error}");
    }
}
