//! Second look at orientations without a solution, from solutions of nearby orientations.
//!
//! The solutions of a voxel form a few smooth sheets, so a solution of one orientation is a good start for its neighbours. All
//! starts come from the same ring, so that the bits of a chunk do not depend on other chunks.

use super::map_chunk::RingResult;
use super::map_grid::MapGrid;
use super::map_test::{MapRobots, MapTest, OrientationResult, solved};
use super::rings::Ring;
use crate::error::Result;
use crate::ik::SolveContext;
use crate::solver::Monitor;

/// Number of neighbours of an orientation that starts are taken from.
const NEAR: usize = 12;

/// Largest index difference of neighbours: neighbours of a spread set have similar heights.
const WINDOW: usize = 2048;

/// Largest number of descents per orientation and round.
const DESCENTS: usize = 8;

/// Largest number of rounds; each after the first starts from the results of the one before.
const ROUNDS: usize = 4;

/// Descents from nearby solutions.
pub(super) struct SecondLook<'a> {
    own: SolveContext<'a>,
    /// Solve context with the first joint free to turn, if azimuths are equivalent.
    turning: Option<SolveContext<'a>>,
    /// Indices of the neighbours of each orientation, the nearest first.
    near: Vec<Vec<u32>>,
}

impl<'a> SecondLook<'a> {
    /// Second look with the robots and the grid of a map.
    ///
    /// # Errors
    /// None in practice: the options of the map have been checked.
    pub fn new(robots: &'a MapRobots, grid: &MapGrid) -> Result<Self> {
        let MapRobots { own, turning, brief, .. } = robots;
        let turning = turning.as_ref().map(|(_, robot)| SolveContext::new(robot, brief)).transpose()?;
        Ok(Self { own: SolveContext::new(own, brief)?, turning, near: near_orientations(grid) })
    }

    /// Completes the results `all` for the orientations of a ring.
    pub fn complete(
        &self,
        test: &MapTest<'_>,
        ring: &Ring,
        all: &mut [OrientationResult],
        result: &mut RingResult,
        monitor: &mut dyn Monitor,
    ) {
        let mut fresh: Vec<bool> = all.iter().map(|seen| seen.reached != 0).collect();
        for _ in 0..ROUNDS {
            let mut found_now = vec![false; all.len()];
            for i in 0..all.len() {
                let near_fresh = self.near[i].iter().any(|other| fresh[*other as usize]);
                if all[i].is_excluded || !near_fresh || !monitor.keep_going() {
                    continue;
                }
                let before = all[i].reached;
                let look = NeighbourDescent { second: self, test, ring, i };
                all[i] = look.at(all, result, monitor);
                found_now[i] = all[i].reached != before;
            }
            if !found_now.contains(&true) {
                return;
            }
            fresh = found_now;
        }
    }
}

/// Second look at orientation number `i` of a ring.
struct NeighbourDescent<'l, 'a> {
    second: &'l SecondLook<'a>,
    test: &'l MapTest<'a>,
    ring: &'l Ring,
    i: usize,
}

impl NeighbourDescent<'_, '_> {
    /// Descends to the orientation from nearby solutions, and returns its updated results.
    fn at(&self, all: &[OrientationResult], result: &mut RingResult, monitor: &mut dyn Monitor) -> OrientationResult {
        let Self { test, ring, i, .. } = *self;
        let pose = test.grid.pose(ring.point, test.azimuth(ring), i);
        let mut found = test.found(ring, all[i].clone(), result);
        if found.seen.reached == 0 {
            let context = self.second.turning.as_ref().unwrap_or(&self.second.own);
            for start in self.starts(all).take(DESCENTS) {
                if let Some(solution) = solved(context, &pose, Some(&self.inside(start, None)), 0, monitor) {
                    found.take(&solution.q);
                }
                if found.seen.reached != 0 {
                    break;
                }
            }
        }
        let Some((axis, _)) = &test.turning else { return found.seen };
        if found.seen.reached == 0 || found.is_everywhere() {
            return found.seen;
        }
        for (index, azimuth) in ring.azimuths.iter().enumerate() {
            let range = test.ranges[axis.joint];
            let holds = |start: &&Vec<f64>| range.holds(start[axis.joint] + azimuth * axis.per_turn);
            for start in self.starts(all).filter(holds).take(DESCENTS) {
                if found.seen.reached >> index & 1 == 1 {
                    break;
                }
                let turned = axis.turned(&pose, *azimuth);
                let inside = self.inside(start, Some(*azimuth));
                if let Some(solution) = solved(&self.second.own, &turned, Some(&inside), 0, monitor) {
                    found.take_at(index, &solution.q);
                }
            }
        }
        found.seen
    }

    /// Solutions of the nearby orientations.
    fn starts<'s>(&self, all: &'s [OrientationResult]) -> impl Iterator<Item = &'s Vec<f64>> {
        self.second.near[self.i].iter().flat_map(move |other| &all[*other as usize].solutions)
    }

    /// Moves a start inside the limits; without an azimuth, the first joint is free to turn.
    fn inside(&self, start: &[f64], azimuth: Option<f64>) -> Vec<f64> {
        let turning = self.test.turning.as_ref().map(|(axis, _)| *axis);
        let bring = |(j, value): (usize, &f64)| match (turning, azimuth) {
            (Some(axis), None) if axis.joint == j => *value,
            (Some(axis), Some(azimuth)) if axis.joint == j => {
                self.test.ranges[j].brought_inside(value + azimuth * axis.per_turn)
            }
            _ => self.test.ranges[j].brought_inside(*value),
        };
        start.iter().enumerate().map(bring).collect()
    }
}

/// Indices of the neighbours of each orientation of a grid, the nearest first.
fn near_orientations(grid: &MapGrid) -> Vec<Vec<u32>> {
    let count = grid.orientations().count();
    let axes: Vec<_> = (0..count).map(|i| grid.orientations().axes(i)).collect();
    // Trace of the rotation between two orientations: 1 + 2 cos(angle).
    let nearness = |i: usize, other: usize| -> f64 {
        axes[i].iter().flatten().zip(axes[other].iter().flatten()).map(|(a, b)| a * b).sum()
    };
    let near = |i: usize| {
        let window = i.saturating_sub(WINDOW)..(i + WINDOW).min(count);
        let mut others: Vec<(f64, u32)> =
            window.filter(|other| *other != i).map(|other| (nearness(i, other), other as u32)).collect();
        let order = |a: &(f64, u32), b: &(f64, u32)| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1));
        if others.len() > NEAR {
            others.select_nth_unstable_by(NEAR, order);
            others.truncate(NEAR);
        }
        others.sort_unstable_by(order);
        others.into_iter().map(|(_, other)| other).collect()
    };
    (0..count).map(near).collect()
}
