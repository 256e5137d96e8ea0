//! Best posture of a planar arm, by the published swarm or by differential evolution over the headings of all links but the
//! last two, which close the linkage on either side.

use std::f64::consts::PI;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::circle_swarm::{CircleSwarm, FoundPosture};
use super::linkage::{Linkage, Measure, Rectangle};
use crate::error::Result;
use crate::ik::{SolveOptions, solve};
use crate::math::vector::distance;
use crate::message::{Message, message};
use crate::objective::{Bounds, Objective, Score};
use crate::rng;
use crate::robot::Robot;
use crate::solver::{DifferentialEvolution, Evaluator, Monitor, Status, Stop, Stopwatch, run};
use crate::task::{Target, TipError};

/// Options of [`best_posture`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PostureOptions {
    /// Measure of a posture.
    pub measure: Measure,
    /// Region of the joint points. `None` means unrestricted.
    pub region: Option<Rectangle>,
    /// Options of the published swarm. `None` means differential evolution.
    pub swarm: Option<CircleSwarm>,
    /// Seed of the random draws; the same seed gives the same bits.
    pub seed: u64,
}

/// Best posture found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Posture {
    /// Configuration (n,) (rad); without a posture, one with the tip as near as possible.
    pub q: Vec<f64>,
    /// Index of the posture; NaN if there is none.
    pub index: f64,
    /// Best index after each generation of the swarm; empty for differential evolution.
    pub history: Vec<f64>,
    /// Status: [`Status::Solved`]; [`Status::Interrupted`] with the best posture so far; or the reason for having none.
    pub status: Status,
    /// Errors of the tip at `q`.
    pub error: TipError,
    /// Number of postures whose index was computed.
    pub evaluations: usize,
    /// Time taken.
    pub elapsed: Duration,
}

impl Posture {
    /// Returns a sentence on the outcome, with advice.
    pub fn message(&self) -> Message {
        match self.status {
            Status::Solved => format!("the best of {} postures, index {:.6}", self.evaluations, self.index).into(),
            Status::OutOfReach => {
                format!("no posture: the tip stays {} away; move the target nearer", self.error).into()
            }
            Status::Interrupted => message!["interrupted: ", Status::Interrupted.advice()],
            _ => "no posture found inside the region and the joint limits: widen them".into(),
        }
    }
}

/// Evaluations of differential evolution per link.
const EVALUATIONS_A_LINK: usize = 2500;

/// Finds the best posture of the planar arm `robot` with its tip at `target` (m).
///
/// # Errors
/// As [`Linkage::new`] and [`CircleSwarm::validate`]; [`Error::NotFinite`](crate::Error::NotFinite) for the target. A
/// target that cannot be reached is a status, not an error.
pub fn best_posture(
    robot: &Robot,
    target: &[f64; 3],
    options: &PostureOptions,
    monitor: &mut dyn Monitor,
) -> Result<Posture> {
    robot.require_one_tip("best_posture")?;
    let stopwatch = Stopwatch::start();
    Target::Position(*target).validate()?;
    options.swarm.map_or(Ok(()), |swarm| swarm.validate())?;
    let linkage = Linkage::new(robot, target, options.measure, options.region)?;
    let found = match options.swarm {
        Some(swarm) => swarm.search(&linkage, &mut rng::stream(options.seed, 0), monitor),
        None => evolve(&linkage, options.seed, monitor),
    };
    let posture = |q: Vec<f64>, index, history, status, evaluations| {
        let tip = robot.tip_position(&q);
        let error = TipError { position: distance(&tip, target), rotation: f64::NAN };
        Posture { q, index, history, status, error, evaluations, elapsed: stopwatch.elapsed() }
    };
    if let Some(FoundPosture { q, index, history, evaluations, status }) = found {
        return Ok(posture(q, index, history, status, evaluations));
    }
    let nearest = solve(robot, &Target::Position(*target), &SolveOptions::default(), monitor)?;
    let status = match nearest.status {
        Status::Solved => Status::Stalled, // within reach, but not in a permitted posture
        status => status,
    };
    Ok(posture(nearest.q.to_vec(), f64::NAN, vec![], status, nearest.evaluations))
}

/// Searches by differential evolution; `None` if no posture was found.
fn evolve(linkage: &Linkage, seed: u64, monitor: &mut dyn Monitor) -> Option<FoundPosture> {
    let links = linkage.links();
    let mut objective = ClosedLinkage { linkage, q: vec![0.0; links], best: None, evaluations: 0 };
    let bounds = Bounds::from_ranges((2..links).map(|_| (-PI, PI)));
    let stop = Stop { max_evaluations: EVALUATIONS_A_LINK * links, ..Stop::default() };
    let mut rng = rng::stream(seed, 0);
    let x0 = vec![0.0; links - 2];
    let mut evaluator = Evaluator::new(&mut objective, &bounds, stop, &mut rng, monitor);
    let status = match run(&DifferentialEvolution::default(), &mut evaluator, &x0) {
        Status::Interrupted => Status::Interrupted,
        _ => Status::Solved,
    };
    let ClosedLinkage { best, evaluations, .. } = objective;
    best.map(|(index, q)| FoundPosture { q, index, history: vec![], evaluations, status })
}

/// Negative index as a function of the headings of all links but the last two, which close the linkage on the better side.
struct ClosedLinkage<'a> {
    linkage: &'a Linkage,
    q: Vec<f64>,
    best: Option<(f64, Vec<f64>)>,
    evaluations: usize,
}

impl Objective for ClosedLinkage<'_> {
    fn dimension(&self) -> usize {
        self.linkage.links() - 2
    }

    fn evaluate(&mut self, headings: &[f64]) -> Score {
        let mut value = f64::INFINITY;
        for side in [1.0, -1.0] {
            let Some(points) = self.linkage.close(headings, side) else { continue };
            let Some(index) = self.linkage.index(&points, &mut self.q) else { continue };
            self.evaluations += 1;
            value = value.min(-index);
            if self.best.as_ref().is_none_or(|(best, _)| index > *best) {
                self.best = Some((index, self.q.clone()));
            }
        }
        Score { value, solved: false }
    }
}
