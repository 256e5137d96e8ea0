//! Input and result of a rule for one tick.

use crate::limits::Limits;
use crate::math::Frame;
use crate::objective::{Bounds, Point, Score};
use crate::rng::LazyRng;
use crate::robot::Robot;
use crate::solver::Monitor;
use crate::task::{Assessment, Criterion, Goals, SquaredError, Target, TargetMotion, TipAims, Twist};
use crate::tracking::kept_motion::KeptMotion;
use crate::tracking::limited_motion::LimitedMotion;
use crate::tracking::tick_aim::TickAim;

/// The input of a rule for one tick.
pub(in crate::tracking) struct Tick<'a> {
    pub robot: &'a Robot,
    /// The target, and its criterion; of several tips the first.
    pub target: &'a Target,
    pub criterion: &'a Criterion,
    /// Tasks and targets of several tips.
    pub tips: Option<TipAims<'a>>,
    /// Goals in the null space of the target.
    pub goals: &'a mut Goals,
    /// Velocity of the target at the end of the tick (m/s), if known.
    pub velocity: Option<[f64; 3]>,
    /// Target and its velocity at the end of the previous tick, if there was one.
    pub before: Option<(&'a Target, Option<[f64; 3]>)>,
    /// Whether a target has moved since the previous tick.
    pub moves: bool,
    /// Start of the tick (s).
    pub time: f64,
    /// Length of the tick (s).
    pub dt: f64,
    /// The limits that the box of the tick comes from.
    pub limits: &'a Limits,
    /// The velocity limits of the tick (n,) (rad/s, m/s).
    pub velocity_limit: &'a [f64],
    /// Steps, changes and limits of an arm under acceleration or jerk limits.
    pub limited: Option<&'a LimitedMotion>,
    /// What the arm keeps to.
    pub kept: Option<&'a mut KeptMotion>,
    /// Age of the target at the end of the tick, in ticks; `None` if it is the one of an earlier tick.
    pub sampled_ago: Option<f64>,
    /// The box of joint positions at the end of the tick.
    pub tick_box: &'a Bounds,
    /// The value accepted in the previous tick, if any.
    pub last_value: Option<f64>,
    pub rng: &'a mut LazyRng,
    pub monitor: &'a mut dyn Monitor,
}

impl<'a> Tick<'a> {
    /// What the tick is to achieve.
    pub(super) fn aim(&self) -> TickAim<'a> {
        let Self { target, criterion, tips, .. } = *self;
        tips.map_or(TickAim::Tip { target, criterion }, TickAim::Tips)
    }

    /// The position limits of the tick.
    pub(super) fn positions(&self) -> Bounds {
        let range = |j: usize| self.limits.position_range(j, self.time, self.time + self.dt).into();
        Bounds::from_ranges((0..self.velocity_limit.len()).map(range))
    }

    /// Motion of the target during the tick. Without a previous tick, the target has moved with its velocity or, if
    /// that is unknown, stood still.
    pub(super) fn motion(&self) -> TargetMotion {
        let Self { target: end, dt, velocity, .. } = *self;
        match (self.before, velocity) {
            (Some((begin, before)), _) => {
                let velocities = before.zip(velocity).map(|(before, velocity)| [before, velocity]);
                TargetMotion { begin: *begin, end: *end, velocities, dt }
            }
            (None, None) => TargetMotion { begin: *end, end: *end, velocities: None, dt },
            (None, Some(linear)) => {
                let begin = end.moved(&Twist { linear, angular: [0.0; 3] }, -dt);
                TargetMotion { begin, end: *end, velocities: Some([linear; 2]), dt }
            }
        }
    }
}

/// The configuration at the end of a tick, and the work spent on it.
#[derive(Debug, Clone)]
pub(in crate::tracking) struct TickResult {
    pub q: Point,
    pub assessment: Assessment,
    /// Tip position at `q` (m); NaN for several tips.
    pub position: [f64; 3],
    pub evaluations: usize,
    pub iterations: usize,
    /// The monitor asked to stop.
    pub interrupted: bool,
}

impl TickResult {
    /// A result at `q`, not assessed yet.
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
    pub(crate) fn assess(&mut self, robot: &Robot, aim: &TickAim<'_>) {
        match aim {
            TickAim::Tip { target, criterion } => self.set_tip(&robot.tip(&self.q), target, criterion),
            TickAim::Tips(_) => self.assessment = aim.assess(robot, &self.q),
        }
    }

    pub(super) fn value(&self) -> f64 {
        self.assessment.score.value
    }

    pub(super) fn is_solved(&self) -> bool {
        self.assessment.score.solved
    }
}
