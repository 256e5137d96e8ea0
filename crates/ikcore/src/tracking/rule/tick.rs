//! Input and result of a rule for one tick.

use smallvec::SmallVec;

use crate::math::Frame;
use crate::objective::{Bounds, Differentiable, Point, Score};
use crate::problem::Problem;
use crate::rng::LazyRng;
use crate::robot::Robot;
use crate::solver::{Evaluator, LevenbergMarquardt, Monitor, Status, Stop, run};
use crate::task::{Aims, Assessment, CheckedTask, Criterion, First, Goals, SquaredError, Target, TargetSegment};
use crate::tracking::step_context::StepContext;
use crate::tracking::target_stream::TargetStream;

/// Evaluation budget of a descent by levels in one tick, even while a way back is looked for: the lowest level is not left alone. The
/// next tick continues.
pub(super) const BY_LEVELS: usize = 400;

/// Evaluation budget of a descent to a configuration within the tolerances.
const INTO_BAND: usize = 30;

/// Input of a rule for one tick.
pub(in crate::tracking) struct Tick<'a> {
    pub context: StepContext<'a>,
    /// Target and criterion of the only tip; of several tips, those of the first.
    pub target: &'a Target,
    pub criterion: &'a Criterion,
    /// Goals in the null space of the targets.
    pub goals: &'a mut Goals,
    /// Targets received so far.
    pub targets: &'a TargetStream,
    /// Largest evaluation budget of a descent, beside the rule's own: less while a way back takes its part of the tick.
    pub most_evaluations: usize,
    /// Age of the new targets at the end of the tick, in ticks; `None` if none arrived in this tick.
    pub sampled_ago: Option<f64>,
    pub rng: &'a mut LazyRng,
    pub monitor: &'a mut dyn Monitor,
}

impl Tick<'_> {
    /// Box of joint positions at the end of the tick.
    pub(super) fn bounds(&self) -> &Bounds {
        &self.context.tick_box.bounds
    }

    /// Whether the joints that cost least have time to make the motion alone: they have weights, and the target stands still.
    pub(super) fn takes_its_time(&self) -> bool {
        self.bounds().weights().is_some() && self.targets.stand()
    }

    /// Target pose, and the part of it that comes first where the whole cannot be met.
    pub(super) fn ranked(&self) -> Option<(Frame, First)> {
        let StepContext { robot, aims, .. } = self.context;
        let (Target::Pose(pose), [task]) = (self.target, aims.tasks) else { return None };
        let first = if robot.tip_count() == 1 { task.comes_first(self.target, robot.dof()) } else { None };
        Some((*pose, first?))
    }

    /// Whether the targets of several tips have an order.
    pub(super) fn has_levels(&self) -> bool {
        self.context.aims.has_levels(self.context.robot)
    }

    /// Largest fraction of the way from `from` to `to` (n,) that the box allows all joints, at most 1.
    pub(super) fn fraction_within(&self, from: &[f64], to: &[f64]) -> f64 {
        let [lower, upper] = self.context.ends();
        let fraction = |j: usize| {
            let way = to[j] - from[j];
            let room = if way > 0.0 { upper[j] } else { lower[j] } - from[j];
            if way == 0.0 { 1.0 } else { room / way }
        };
        (0..from.len()).map(fraction).fold(1.0, f64::min)
    }

    /// Motion of the first target during the tick.
    pub(super) fn motion(&self) -> TargetSegment {
        self.targets.motion(*self.target, self.context.dt)
    }

    /// Configuration in `bounds` one gradient step of the null-space goals from `q`; `None` without goals.
    pub(super) fn preferred(&mut self, q: &Point) -> Option<Point> {
        if self.goals.is_empty() {
            return None;
        }
        let mut preferred = q.clone();
        self.goals.cost(self.context.robot, None, q, &mut preferred);
        self.bounds().steepest(&mut preferred);
        preferred.iter_mut().zip(q).for_each(|(preferred, q)| *preferred = q - self.context.dt * *preferred);
        self.bounds().clip(&mut preferred);
        Some(preferred)
    }

    /// Moves `found` within the tolerances, if some configuration in `bounds` near it is; returns whether that succeeds.
    pub(super) fn descend_into_band(&mut self, found: &mut TickResult, bounds: &Bounds) -> bool {
        let StepContext { robot, aims, .. } = self.context;
        if !aims.iter().any(|(task, _)| task.criterion.has_band()) {
            return false;
        }
        let aimed = |(task, _): (&CheckedTask, &Target)| {
            let mut task = task.clone();
            task.criterion = if task.criterion.has_band() { task.criterion.beyond_tolerance() } else { task.criterion };
            task
        };
        let tasks: SmallVec<[CheckedTask; 1]> = aims.iter().map(aimed).collect();
        let mut problem = Problem::new(robot, Aims { tasks: &tasks, targets: aims.targets });
        let objective: &mut dyn Differentiable = &mut problem;
        let stop = Stop { max_evaluations: INTO_BAND, ..Stop::default() };
        let mut evaluator = Evaluator::new(objective, bounds, stop, self.rng, self.monitor);
        run(&LevenbergMarquardt::default(), &mut evaluator, &found.q);
        found.evaluations += evaluator.evaluations() + 1;
        found.iterations += evaluator.iterations();
        let is_within = evaluator.best().solved;
        if is_within {
            found.q.copy_from_slice(&evaluator.best().x);
        }
        is_within
    }

    /// Lowers the error from `found` within `bounds` by Levenberg-Marquardt, whatever the weights of the joints. The result is not
    /// assessed.
    pub(super) fn descend(&mut self, found: &mut TickResult, bounds: &Bounds, stop: Stop) {
        let StepContext { robot, aims, .. } = self.context;
        let mut problem = Problem::new(robot, aims);
        let objective: &mut dyn Differentiable = &mut problem;
        let bounds = bounds.without_weights();
        let mut evaluator = Evaluator::new(objective, &bounds, stop, self.rng, self.monitor);
        let status = run(&LevenbergMarquardt::default(), &mut evaluator, &found.q);
        found.evaluations += evaluator.evaluations();
        found.iterations += evaluator.iterations();
        found.interrupted = status == Status::Interrupted;
        found.q.copy_from_slice(&evaluator.best().x);
    }
}

/// Configuration at the end of a tick, and the work spent on it.
#[derive(Debug, Clone)]
pub(in crate::tracking) struct TickResult {
    pub q: Point,
    pub assessment: Assessment,
    /// Tip position at `q` (m); NaN for several tips.
    pub position: [f64; 3],
    pub evaluations: usize,
    pub iterations: usize,
    /// Whether the monitor asked to stop.
    pub interrupted: bool,
}

impl TickResult {
    /// Result at `q`, not yet assessed.
    pub(crate) fn at(q: &[f64]) -> Self {
        let score = Score { value: f64::INFINITY, solved: false };
        let assessment = Assessment { score, error: SquaredError { position: None, rotation: None } };
        let (q, position) = (Point::from_slice(q), [f64::NAN; 3]);
        Self { q, assessment, position, evaluations: 0, iterations: 0, interrupted: false }
    }

    /// Sets assessment and position from the tip at `q`.
    pub(crate) fn set_tip(&mut self, tip: &Frame, target: &Target, criterion: &Criterion) {
        (self.assessment, self.position) = (target.assess_tip(tip, criterion), tip.origin);
    }

    /// Assesses `q`.
    pub(crate) fn assess(&mut self, robot: &Robot, aims: &Aims<'_>) {
        match aims.only(robot) {
            Some((target, criterion)) => self.set_tip(&robot.tip(&self.q), target, criterion),
            None => self.assessment = aims.assess(robot, &self.q),
        }
    }

    pub(super) fn value(&self) -> f64 {
        self.assessment.score.value
    }

    pub(super) fn is_solved(&self) -> bool {
        self.assessment.score.solved
    }
}
