//! One tick: what a rule is given, and what it returns.

use crate::limits::Limits;
use crate::math::Frame;
use crate::objective::{Bounds, Point, Score};
use crate::rng::LazyRng;
use crate::robot::Robot;
use crate::solver::Monitor;
use crate::task::{Assessment, Criterion, Goals, SquaredError, Target, TargetMotion, Twist};

/// One tick, as a rule sees it.
pub(in crate::tracking) struct Tick<'a> {
    pub robot: &'a Robot,
    pub target: &'a Target,
    pub criterion: &'a Criterion,
    /// Goals in the null space of the target.
    pub goals: &'a mut Goals,
    /// The velocity of the target at the end of the tick (m/s), if it is known.
    pub velocity: Option<[f64; 3]>,
    /// The target and its velocity at the end of the tick before, if there was one.
    pub before: Option<&'a (Target, Option<[f64; 3]>)>,
    /// When the tick begins (s).
    pub time: f64,
    /// Length of the tick (s).
    pub dt: f64,
    /// The limits that the tick's box comes from.
    pub limits: &'a Limits,
    /// The velocity limits of the tick (n,) (rad/s, m/s).
    pub velocity_limit: &'a [f64],
    /// Where the tick may end.
    pub tick_box: &'a Bounds,
    /// The value accepted in the tick before, if any.
    pub last_value: Option<f64>,
    pub rng: &'a mut LazyRng,
    pub monitor: &'a mut dyn Monitor,
}

impl Tick<'_> {
    /// How the target moves during the tick. Where nothing is known of the tick before, it has moved with its velocity, or
    /// stood still.
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

/// Where a rule ends the tick, and what it took to get there.
#[derive(Debug, Clone)]
pub(in crate::tracking) struct TickResult {
    pub q: Point,
    pub assessment: Assessment,
    /// Position of the tip there (m).
    pub position: [f64; 3],
    pub evaluations: usize,
    pub iterations: usize,
    /// The monitor asked to stop.
    pub interrupted: bool,
}

impl TickResult {
    /// At `q`, with nothing known of it yet.
    pub(super) fn at(q: &[f64]) -> Self {
        let score = Score { value: f64::INFINITY, solved: false };
        let assessment = Assessment { score, error: SquaredError { position: None, rotation: None } };
        let (q, position) = (Point::from_slice(q), [f64::NAN; 3]);
        Self { q, assessment, position, evaluations: 0, iterations: 0, interrupted: false }
    }

    /// Takes over the tip at `q`.
    pub(crate) fn set_tip(&mut self, tip: &Frame, target: &Target, criterion: &Criterion) {
        (self.assessment, self.position) = (target.assess_tip(tip, criterion), tip.origin);
    }

    pub(super) fn value(&self) -> f64 {
        self.assessment.score.value
    }

    pub(super) fn is_solved(&self) -> bool {
        self.assessment.score.solved
    }
}
