//! Rest of an arm that comes no nearer to targets that stand still.
//!
//! Rule and filter decide tick by tick. An arm that is held by obstacles, by its limits or in a flat valley of the error could go to
//! and fro, creep, or start again and again. An arm that has made no progress for some time therefore settles: it brakes, and stays
//! at rest until its targets or its obstacles change, an obstacle drives it away, or a way back begins. An arm on its target settles
//! as well, and no longer drifts along its self-motion.

use super::progress::patience_factor;
use crate::limits::Limits;
use crate::task::{Assessment, Target, TargetRow};

/// Time without progress after which an arm settles (s).
const PATIENCE: f64 = 1.0;

/// Relative decrease of an error that counts as progress.
const NEARER: f64 = 0.02;
/// Decrease of an error that counts as progress, however large the error (m, rad).
const ENOUGH: f64 = 5e-3;

/// Relative change of the error, and motion of a target relative to the error, after which an arm no longer rests.
const NEW: f64 = 0.05;

/// Watch over one arm, with its state between ticks.
#[derive(Debug)]
pub(super) struct Settling {
    /// Time without progress after which this arm settles (s).
    patience: f64,
    /// Targets at the beginning of the watch; empty before it.
    targets: TargetRow,
    /// Lowest errors since then: of all targets, in position and in rotation.
    lowest: [f64; 3],
    /// Error after the last tick.
    error: f64,
    /// Time without progress of an arm that something holds (s).
    waited: f64,
    is_settled: bool,
    /// Error of the settled arm at rest; `None` while it brakes.
    error_at_rest: Option<f64>,
}

impl Settling {
    /// Watch over an arm with these limits.
    pub fn new(limits: &Limits) -> Self {
        Self {
            patience: PATIENCE * patience_factor(limits),
            targets: TargetRow::new(),
            lowest: [f64::INFINITY; 3],
            error: f64::INFINITY,
            waited: 0.0,
            is_settled: false,
            error_at_rest: None,
        }
    }

    /// Begins anew with the next tick.
    pub fn restart(&mut self) {
        self.targets.clear();
        (self.is_settled, self.error_at_rest) = (false, None);
    }

    /// Begins a tick with these targets. Returns whether the arm is settled.
    pub fn begin_tick(&mut self, targets: &[Target]) -> bool {
        let is_same = self.targets.len() == targets.len()
            && self
                .targets
                .iter()
                .zip(targets)
                .all(|(old, new)| old == new || old.distance_to(new) <= NEW * self.error);
        if !is_same {
            self.restart();
            self.targets.extend_from_slice(targets);
            (self.lowest, self.waited) = ([f64::INFINITY; 3], 0.0);
        }
        self.is_settled
    }

    /// Ends a tick of `dt` (s). `is_held`: something keeps the arm away, or it is on its target; `at_rest`: no joint moved.
    pub fn end_tick(&mut self, assessment: &Assessment, is_held: bool, at_rest: bool, dt: f64) {
        let error = if assessment.score.solved { 0.0 } else { assessment.score.value.sqrt() };
        self.error = error;
        if self.is_settled {
            self.error_at_rest = self.error_at_rest.or(at_rest.then_some(error));
            if self.error_at_rest.is_some_and(|rested| (error - rested).abs() > NEW * rested) {
                self.restart();
            }
        } else if self.comes_nearer(error, assessment) {
            self.waited = 0.0;
        } else if is_held {
            self.waited += dt;
            self.is_settled = self.waited >= self.patience;
        }
    }

    /// Notes new lowest errors. Returns whether one of them is progress.
    fn comes_nearer(&mut self, error: f64, assessment: &Assessment) -> bool {
        let part = |squared: Option<f64>| squared.map_or(f64::INFINITY, f64::sqrt);
        let errors = [error, part(assessment.error.position), part(assessment.error.rotation)];
        let mut is_nearer = false;
        for (lowest, error) in self.lowest.iter_mut().zip(errors) {
            if error < *lowest - (NEARER * *lowest).min(ENOUGH) {
                (*lowest, is_nearer) = (error, true);
            }
        }
        is_nearer
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::objective::Score;
    use crate::robot::Robot;
    use crate::task::SquaredError;

    const DT: f64 = 0.01;

    fn target(x: f64) -> [Target; 1] {
        [Target::Position([x, 0.0, 0.0])]
    }

    fn watch() -> Settling {
        Settling::new(&Limits::of(&Robot::named("panda").unwrap()))
    }

    /// Runs an arm with these errors in position to a target that stands still; returns the tick in which it is settled.
    fn settles(watch: &mut Settling, errors: impl Iterator<Item = f64>, is_held: bool) -> Option<usize> {
        errors.take(1000).position(|error| {
            let is_settled = watch.begin_tick(&target(1.0));
            tick(watch, error, is_held);
            is_settled
        })
    }

    fn tick(watch: &mut Settling, error: f64, is_held: bool) {
        let score = Score { value: error * error, solved: error == 0.0 };
        let error = SquaredError { position: Some(error * error), rotation: None };
        watch.end_tick(&Assessment { score, error }, is_held, true, DT);
    }

    #[test]
    fn an_arm_that_comes_no_nearer_settles_after_a_second() {
        let near = (99, 103);
        for error in [0.0, 0.2, 5.0] {
            let tick = settles(&mut watch(), std::iter::repeat(error), true).unwrap();
            assert!((near.0..=near.1).contains(&tick), "{error}: {tick}");
        }
        let to_and_fro = (0..).map(|tick| 0.2 + 0.05 * f64::from(tick % 40));
        assert!(settles(&mut watch(), to_and_fro, true).is_some());
        let creeping = (0..).map(|tick| 0.2 - 1e-5 * f64::from(tick));
        assert!(settles(&mut watch(), creeping, true).is_some());
    }

    #[test]
    fn one_that_comes_nearer_or_that_nothing_holds_does_not() {
        let nearer = (0..).map(|tick| 0.5 * 0.999_f64.powi(tick));
        assert_eq!(settles(&mut watch(), nearer, true), None);
        let far = (0..).map(|tick| 100.0 - 1e-3 * f64::from(tick) / 2.0 * 10.0);
        assert_eq!(settles(&mut watch(), far, true), None);
        assert_eq!(settles(&mut watch(), std::iter::repeat(0.2), false), None);
    }

    #[test]
    fn a_target_that_moves_and_a_push_end_the_rest() {
        let mut watch = watch();
        settles(&mut watch, std::iter::repeat(0.2), true).unwrap();
        assert!(watch.begin_tick(&target(1.009)), "5 % of the error is noise");
        assert!(!watch.begin_tick(&target(1.011)));
        tick(&mut watch, 0.2, true);
        settles(&mut watch, std::iter::repeat(0.2), true).unwrap();
        tick(&mut watch, 0.22, true);
        assert!(!watch.begin_tick(&target(1.0)));
    }
}
