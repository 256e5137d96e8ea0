//! Trajectory planning by beetle swarm optimisation (Wang et al. 2019).

use super::{AlongPathOptions, End, Plan, PointToPointOptions};
use crate::error::{Error, Result};
use crate::path::Reference;
use crate::robot::Robot;
use crate::solver::Monitor;

pub(super) fn point_to_point(
    _robot: &Robot,
    _start: &End,
    _end: &End,
    _options: &PointToPointOptions,
    _monitor: &mut dyn Monitor,
) -> Result<Plan> {
    Err(Error::unknown_option("method", "tpbso", &[]))
}

pub(super) fn along_path(
    _robot: &Robot,
    _path: &Reference,
    _options: &AlongPathOptions,
    _monitor: &mut dyn Monitor,
) -> Result<Plan> {
    Err(Error::unknown_option("method", "tpbso", &[]))
}
