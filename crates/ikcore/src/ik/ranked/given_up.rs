//! Status of a pose of which one part is met and the other given up.

use crate::solver::Status;
use crate::task::{CheckedTask, First, SquaredError, Target};

/// Status at an `error` beyond the tolerances: what is given up, if the part that comes first for a robot with `dof` joints is met.
pub(crate) fn given_up(task: &CheckedTask, target: &Target, dof: usize, error: &SquaredError) -> Option<Status> {
    let (alone, status) = match task.comes_first(target, dof)? {
        First::Position => (SquaredError { rotation: None, ..*error }, Status::RotationGivenUp),
        First::Orientation => (SquaredError { position: None, ..*error }, Status::PositionGivenUp),
    };
    alone.within(&task.criterion.tolerance).then_some(status)
}
