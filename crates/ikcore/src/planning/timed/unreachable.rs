//! The points of a path that no configuration reaches, for the error that names them.

use crate::error::{Error, Result};
use crate::ik::{SolveOptions, solve};
use crate::interrupt::checkpoint;
use crate::planning::tip_path::TipPath;
use crate::robot::Robot;
use crate::solver::{Status, Stop, Unattended};
use crate::task::TipError;

/// Points that are tried at the most; a longer path is tried at every second, third, ... point.
const MOST_POINTS: usize = 400;

/// Evaluations for each point: some milliseconds.
const EVALUATIONS: usize = 5000;

/// Tries each given point of the path alone, without the motion that leads to it. Returns the error that names those out
/// of reach, None where each is reached or where the path has no numbered points.
///
/// # Errors
/// None in practice: the targets are those of a checked path.
pub(in crate::planning) fn unreachable_points(robot: &Robot, tip_path: &TipPath, seed: u64) -> Result<Option<Error>> {
    let points = tip_path.numbered_points();
    let stop = Stop { max_evaluations: EVALUATIONS, ..Stop::default() };
    let options = SolveOptions { stop, seed, task: tip_path.task().copied(), ..SolveOptions::default() };
    let mut missed: Vec<[usize; 2]> = vec![];
    let mut farthest: Option<TipError> = None;
    let stride = points.len().div_ceil(MOST_POINTS).max(1);
    for (point, share) in points.iter().enumerate().step_by(stride) {
        checkpoint()?;
        let solution = solve(robot, &tip_path.pose(*share), &options, &mut Unattended)?;
        if solution.status == Status::Solved {
            continue;
        }
        match missed.last_mut() {
            Some([_, last]) if *last + stride == point => *last = point,
            _ => missed.push([point, point]),
        }
        if farthest.as_ref().is_none_or(|farthest| solution.error.position > farthest.position) {
            farthest = Some(solution.error);
        }
    }
    Ok(farthest.map(|farthest| Error::Unreachable {
        what: format!("{} of the path", words(&missed)),
        problem: format!("the nearest configurations found within the limits stay up to {farthest} away"),
    }))
}

/// The ranges in words: "point 3", "points 3 to 5 and 9".
fn words(ranges: &[[usize; 2]]) -> String {
    let range =
        |[first, last]: &[usize; 2]| if first == last { first.to_string() } else { format!("{first} to {last}") };
    let all: Vec<String> = ranges.iter().map(range).collect();
    match &ranges {
        [[first, last]] if first == last => format!("point {first}"),
        _ => format!("points {}", all.join(" and ")),
    }
}
