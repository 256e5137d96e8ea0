//! Paths of one tip or several, sampled at the same times.

use super::record::Record;
use super::session::Session;
use super::step::Step;
use super::target_stream::Arrival;
use crate::error::{Error, Result};
use crate::path::Reference;
use crate::task::{NamedTask, Target, TargetRow};

/// Paths that are followed at the same time.
#[derive(Debug, Clone, Copy)]
pub struct TipPaths<'a> {
    /// Tasks of several tips, in the order of their paths; empty for a robot with one tip.
    pub tips: &'a [NamedTask],
    /// Reference paths, sampled at the same times.
    pub paths: &'a [Reference],
}

impl<'a> TipPaths<'a> {
    /// Checks that there is a path and that all are sampled at the same times. Returns the first.
    pub(super) fn first(&self) -> Result<&'a Reference> {
        let [first, others @ ..] = self.paths else {
            return Err(Error::WrongLength { what: "paths".into(), expected: "one at least".into(), got: 0 });
        };
        match others.iter().find(|path| path.len() != first.len() || path.dt() != first.dt()) {
            None => Ok(first),
            Some(other) => {
                let expected = format!("{} samples of {} s, as the first path has", first.len(), first.dt());
                Err(Error::WrongLength { what: "a path of several".into(), expected, got: other.len() })
            }
        }
    }

    /// Number of rows.
    pub(super) fn len(&self) -> usize {
        self.paths[0].len()
    }

    /// Time of row `i` (s).
    pub(super) fn time(&self, i: usize) -> f64 {
        self.paths[0].time(i)
    }

    /// Targets of row `i`: poses on paths with orientations, else positions.
    pub(super) fn targets(&self, i: usize) -> TargetRow {
        let target =
            |path: &Reference| path.pose(i).map_or(Target::Position(path.position(i)), |pose| Target::from(&pose));
        let mut targets = TargetRow::new();
        self.paths.iter().for_each(|path| targets.push(target(path)));
        targets
    }

    /// Targets of row `i` as an arrival.
    pub(super) fn arrival(&self, i: usize) -> Arrival {
        Arrival { tips: self.tips.to_vec(), targets: self.targets(i), velocity: self.paths[0].velocity(i), stamp: None }
    }

    /// Appends the result of the next tick to `record`.
    pub(super) fn push(&self, session: &Session, step: &Step, record: &mut Record) {
        let row = record.rows();
        let references = self.paths.iter().map(|path| path.position(row));
        record.push(&session.accepted(), self.paths[0].position(row), step);
        if !self.tips.is_empty() {
            record.tips.push(session.tip_positions(), references, session.tip_errors());
            record.position[row] = record.tips.positions[row * self.paths.len()];
        }
    }
}
