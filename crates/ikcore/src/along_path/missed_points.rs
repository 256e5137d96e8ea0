//! The points of a path for which no configuration is found, for the error that names them.

use crate::along_path::tip_path::TipPath;
use crate::error::{Error, Result};
use crate::ik::{SolveOptions, solve};
use crate::interrupt::checkpoint;
use crate::robot::Robot;
use crate::solver::{Status, Stop, Unattended};
use crate::task::TipError;

/// Points that are tried at the most; of a longer path every second, third, ... point.
const MOST_POINTS: usize = 400;

/// Points of a path in time.
const POINTS_IN_TIME: usize = 100;

/// Searches that may end without a result before the others are left out: each takes some 10 ms.
const MOST_SEARCHES: usize = 16;

/// Points, and how near configurations come to them.
#[derive(Debug, Default)]
struct Missed {
    ranges: Vec<[usize; 2]>,
    farthest: Option<TipError>,
}

impl Missed {
    /// Notes a point; one that is `stride` beyond the last one extends its range.
    fn add(&mut self, point: usize, stride: usize, error: TipError) {
        match self.ranges.last_mut() {
            Some([_, last]) if *last + stride == point => *last = point,
            _ => self.ranges.push([point, point]),
        }
        if self.farthest.as_ref().is_none_or(|farthest| error.position > farthest.position) {
            self.farthest = Some(error);
        }
    }
}

/// Solves each point of the path alone, as [`solve`] does, without the motion that leads to it.
///
/// Returns [`Error::Unreachable`] with those that are proven to be out of reach, or else [`Error::NotFound`] with those for which no
/// configuration was found; `None` where there are no such points.
///
/// # Errors
/// None in practice: the targets are those of a checked path.
pub(crate) fn missed_points(robot: &Robot, tip_path: &TipPath, seed: u64) -> Result<Option<Error>> {
    let numbered = tip_path.numbered_points();
    let in_time = if numbered.is_empty() { tip_path.knots(POINTS_IN_TIME) } else { vec![] };
    let fractions = if numbered.is_empty() { &in_time } else { numbered };
    let options = options(tip_path, seed);
    let (mut proven, mut open, mut searches) = (Missed::default(), Missed::default(), 0);
    let stride = fractions.len().div_ceil(MOST_POINTS).max(1);
    for (point, fraction) in fractions.iter().enumerate().step_by(stride) {
        checkpoint()?;
        let solution = solve(robot, &tip_path.pose(*fraction), &options, &mut Unattended)?;
        match solution.status {
            Status::Solved => {}
            Status::OutOfReach => proven.add(point, stride, solution.error),
            _ => {
                open.add(point, stride, solution.error);
                searches += 1;
            }
        }
        if searches == MOST_SEARCHES {
            break;
        }
    }
    let name = |missed: &Missed| match numbered.is_empty() {
        true => tip_path.place(fractions[missed.ranges[0][0]]),
        false => format!("{} of the path", words(&missed.ranges)),
    };
    Ok(match (&proven.farthest, &open.farthest) {
        (Some(farthest), _) => Some(unreachable(name(&proven), farthest)),
        (None, Some(farthest)) => Some(not_found(&name(&open), farthest)),
        (None, None) => None,
    })
}

/// The same for one place on the path.
///
/// # Errors
/// As [`missed_points`].
pub(crate) fn missed_at(robot: &Robot, tip_path: &TipPath, fraction: f64, seed: u64) -> Result<Option<Error>> {
    let solution = solve(robot, &tip_path.pose(fraction), &options(tip_path, seed), &mut Unattended)?;
    let (what, error) = (tip_path.place(fraction), solution.error);
    Ok(match solution.status {
        Status::Solved => None,
        Status::OutOfReach => Some(unreachable(what, &error)),
        _ => Some(not_found(&what, &error)),
    })
}

fn options(tip_path: &TipPath, seed: u64) -> SolveOptions {
    SolveOptions { seed, task: tip_path.task().copied(), ..SolveOptions::default() }
}

fn unreachable(what: String, farthest: &TipError) -> Error {
    let problem = format!("the nearest configurations found within the limits stay up to {farthest} away");
    Error::Unreachable { what, problem: problem.into() }
}

fn not_found(what: &str, farthest: &TipError) -> Error {
    let evaluations = Stop::default().max_evaluations;
    let problem = format!(
        "the nearest of {evaluations} evaluations from many starts stay up to {farthest} away, which proves nothing: try another seed, or \
         solve it with a larger budget"
    );
    Error::NotFound { what: format!("a configuration for {what}"), problem: problem.into() }
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
