//! Points of a path without a configuration, for the error that names them.

use std::fmt;

use crate::along_path::tip_path::TipPath;
use crate::error::{Error, Result};
use crate::ik::{Solution, SolveOptions, solve};
use crate::interrupt::checkpoint;
use crate::message::{Message, Setting, message};
use crate::robot::{Joint, Robot};
use crate::solver::{Status, Stop, Unattended};
use crate::task::TipError;
use crate::wording::number;

/// Maximum number of points tried; of a longer path every second, third, ... point.
const MOST_POINTS: usize = 400;

/// Number of points taken of a path in time.
const POINTS_IN_TIME: usize = 100;

/// Maximum number of searches without a result; then the others are left out, for each takes some 10 ms.
const MOST_SEARCHES: usize = 16;

/// Distance (rad, m) at which a joint is at its limit.
const AT_LIMIT: f64 = 1e-6;

/// Points, and the least error of a configuration there.
#[derive(Debug, Default)]
struct Missed {
    ranges: Vec<[usize; 2]>,
    count: usize,
    farthest: Option<Farthest>,
}

/// The least error of the worst point, and the joints that are at a limit there.
#[derive(Debug)]
struct Farthest {
    error: TipError,
    at_limits: String,
}

impl Farthest {
    fn of(robot: &Robot, solution: Solution) -> Self {
        let at_limit = |(q, joint): (&f64, &Joint)| {
            let bounds = [joint.lower, joint.upper];
            let bound = bounds.into_iter().find(|bound| (q - bound).abs() <= AT_LIMIT)?;
            Some(format!("joint '{}' at its limit {}", joint.name, number(bound)))
        };
        let all: Vec<String> = solution.q.iter().zip(robot.joints()).filter_map(at_limit).collect();
        let at_limits = if all.is_empty() { String::new() } else { format!(", with {}", all.join(" and ")) };
        Self { error: solution.error, at_limits }
    }
}

impl fmt::Display for Farthest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} away{}", self.error, self.at_limits)
    }
}

impl Missed {
    /// Notes a point; one that is `stride` beyond the last one extends its range.
    fn add(&mut self, point: usize, stride: usize, found: Farthest) {
        self.count += 1;
        match self.ranges.last_mut() {
            Some([_, last]) if *last + stride == point => *last = point,
            _ => self.ranges.push([point, point]),
        }
        if self.farthest.as_ref().is_none_or(|farthest| found.error.position > farthest.error.position) {
            self.farthest = Some(found);
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
            Status::OutOfReach => proven.add(point, stride, Farthest::of(robot, solution)),
            _ => {
                open.add(point, stride, Farthest::of(robot, solution));
                searches += 1;
            }
        }
        if searches == MOST_SEARCHES {
            break;
        }
    }
    let tried = fractions.len().div_ceil(stride);
    let advice = match proven.count + open.count < tried {
        true => message!["; try ", Setting::Breaks],
        false => Message::default(),
    };
    let name = |missed: &Missed| match numbered.is_empty() {
        true => tip_path.point_in_words(fractions[missed.ranges[0][0]]),
        false => format!("{} of the path", words(&missed.ranges)),
    };
    Ok(match (&proven.farthest, &open.farthest) {
        (Some(farthest), _) => Some(unreachable(name(&proven), farthest, advice)),
        (None, Some(farthest)) => Some(not_found(&name(&open), farthest, advice)),
        (None, None) => None,
    })
}

/// Solves one point of the path alone.
///
/// # Errors
/// As [`missed_points`].
pub(crate) fn missed_at(robot: &Robot, tip_path: &TipPath, fraction: f64, seed: u64) -> Result<Option<Error>> {
    let solution = solve(robot, &tip_path.pose(fraction), &options(tip_path, seed), &mut Unattended)?;
    let (what, status) = (tip_path.point_in_words(fraction), solution.status);
    let found = Farthest::of(robot, solution);
    Ok(match status {
        Status::Solved => None,
        Status::OutOfReach => Some(unreachable(what, &found, Message::default())),
        _ => Some(not_found(&what, &found, Message::default())),
    })
}

fn options(tip_path: &TipPath, seed: u64) -> SolveOptions {
    SolveOptions { seed, task: tip_path.task().copied(), ..SolveOptions::default() }
}

fn unreachable(what: String, farthest: &Farthest, advice: Message) -> Error {
    let problem = format!("the nearest configurations found within the limits stay up to {farthest}");
    Error::Unreachable { what, problem: message![problem, advice] }
}

fn not_found(what: &str, farthest: &Farthest, advice: Message) -> Error {
    let evaluations = Stop::default().max_evaluations;
    let problem = format!(
        "the nearest of {evaluations} evaluations from many starts stay up to {farthest}, which proves nothing: try another seed, or \
         solve it with a larger budget"
    );
    Error::NotFound { what: format!("a configuration for {what}"), problem: message![problem, advice] }
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
