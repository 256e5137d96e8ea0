//! The one error type: every variant names the thing, its value, the bound it broke and what would be right.

use thiserror::Error;

/// `Result` with this crate's [`enum@Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Everything that a caller can get wrong.
///
/// Not having converged is no error: that is a [`Status`](crate::solver::Status) beside the best answer found.
#[non_exhaustive]
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Error {
    /// A number that must be finite is NaN or infinite.
    #[error("{what} must be finite, but {place} is {value}")]
    NotFinite {
        /// What was passed, such as "joint angles".
        what: String,
        /// Which entry, such as "entry 2" or "joint 'elbow'".
        place: String,
        /// The offending number.
        value: f64,
    },
    /// An array does not have the length it must have.
    #[error("{what}: expected {expected}, got {got}")]
    WrongLength {
        /// What was passed and to whom, such as "joint angles of robot 'iiwa14'".
        what: String,
        /// What was expected, such as "7 joints".
        expected: String,
        /// What came.
        got: usize,
    },
    /// A number lies outside the range that its meaning allows.
    #[error("{what} must be {requirement}, got {value}")]
    OutOfRange {
        /// The name of the argument.
        what: String,
        /// The allowed range in words, such as "positive".
        requirement: String,
        /// The offending number.
        value: f64,
    },
    /// A word that is none of the allowed ones.
    #[error("{what} must be one of {known}, got '{value}'")]
    UnknownOption {
        /// The name of the argument.
        what: String,
        /// What came.
        value: String,
        /// The allowed words, quoted and separated by commas.
        known: String,
    },
    /// No built-in robot has this name.
    #[error("no robot is named '{name}'{suggestion}; known robots: {known}")]
    UnknownRobot {
        /// The name asked for.
        name: String,
        /// ` (did you mean 'x'?)`, or empty.
        suggestion: String,
        /// All names, separated by commas.
        known: String,
    },
    /// No link of the robot has this name.
    #[error("robot '{robot}' has no link '{name}'{suggestion}; its links: {known}")]
    UnknownLink {
        /// The robot's name.
        robot: String,
        /// The link asked for.
        name: String,
        /// ` (did you mean 'x'?)`, or empty.
        suggestion: String,
        /// All links, separated by commas.
        known: String,
    },
    /// The tip was left open, but the tree of links ends in several places.
    #[error("robot '{robot}' ends in {count} links: say which one is the tip; leaves, by number of joints: {leaves}")]
    AmbiguousTip {
        /// The robot's name.
        robot: String,
        /// The number of leaf links.
        count: usize,
        /// The leaf links, each with the number of its joints, most joints first.
        leaves: String,
    },
    /// A description of a robot that cannot be one.
    #[error("robot '{robot}': {problem}")]
    InvalidRobot {
        /// The robot's name.
        robot: String,
        /// What is wrong and what would be right.
        problem: String,
    },
    /// A URDF that cannot be read.
    #[error("URDF{}: {problem}", .line.map(|l| format!(" line {l}")).unwrap_or_default())]
    Urdf {
        /// Line of the text, from 1, where known.
        line: Option<u32>,
        /// What is wrong and what would be right.
        problem: String,
    },
    /// A file that cannot be read.
    #[error("cannot read '{path}': {problem}")]
    Unreadable {
        /// The file.
        path: String,
        /// The operating system's reason.
        problem: String,
    },
    /// A lower limit above its upper limit.
    #[error("joint '{joint}': lower limit {lower} is above upper limit {upper}{}", .time.map(|t| format!(" at t = {t} s")).unwrap_or_default())]
    EmptyRange {
        /// The joint's name.
        joint: String,
        /// Its lower limit (rad or m).
        lower: f64,
        /// Its upper limit (rad or m).
        upper: f64,
        /// When, for limits that vary (s).
        time: Option<f64>,
    },
    /// A configuration outside the position limits.
    #[error("{what}: joint '{joint}' at {value} is outside its limits [{lower}, {upper}]")]
    OutsideLimits {
        /// What was passed, such as "start".
        what: String,
        /// The joint's name.
        joint: String,
        /// Its value (rad or m).
        value: f64,
        /// Its lower limit (rad or m).
        lower: f64,
        /// Its upper limit (rad or m).
        upper: f64,
    },
    /// A configuration that puts the tip outside its region.
    #[error("{what}: {coordinate} of the tip, {value} m, is outside its region ({lower}, {upper})")]
    OutsideRegion {
        /// What was passed, such as "start".
        what: String,
        /// The coordinate, in the base's frame.
        coordinate: String,
        /// Its value (m).
        value: f64,
        /// Its lower bound (m).
        lower: f64,
        /// Its upper bound (m).
        upper: f64,
    },
    /// An end of a motion that the robot does not reach.
    #[error("{what} cannot be reached: {problem}")]
    Unreachable {
        /// Which end, such as "start".
        what: String,
        /// By how much it is missed, and what would be right.
        problem: String,
    },
    /// A limit that is negative, at least for some time.
    #[error("{field} limit of joint '{joint}' is {value} at t = {time} s: a limit cannot be negative")]
    NegativeLimit {
        /// "velocity", "acceleration" or "jerk".
        field: String,
        /// The joint's name.
        joint: String,
        /// The limit's smallest value (rad/s or m/s, and so on).
        value: f64,
        /// The time at which it is reached (s).
        time: f64,
    },
    /// A limit that the method cannot keep. No method ignores one.
    #[error("{method} cannot honour {field} limits: {remedy}")]
    UnsupportedLimit {
        /// The field of the limits, such as "acceleration".
        field: String,
        /// What was asked to keep it.
        method: String,
        /// What to do instead.
        remedy: String,
    },
    /// Nothing satisfies what was asked.
    #[error("infeasible: {problem}")]
    Infeasible {
        /// What stands against what.
        problem: String,
    },
    /// A matrix that is not a rigid transform.
    #[error("{what} is not a rigid transform: {problem}")]
    NotRigid {
        /// What was passed, such as "target".
        what: String,
        /// By how much it fails.
        problem: String,
    },
    /// A position where a task needs a whole pose.
    #[error("task {task} needs a target pose (4, 4), got a position (3,)")]
    WrongTarget {
        /// The kind of task.
        task: String,
    },
    /// Options that do not go together.
    #[error("{problem}")]
    Contradiction {
        /// Which, and what would be right.
        problem: String,
    },
    /// An obstacle that cannot be one, or not for this robot.
    #[error("{problem}")]
    InvalidObstacle {
        /// What is wrong and what would be right.
        problem: String,
    },
    /// Nothing is known of the room that a robot takes up.
    #[error("robot '{robot}' {problem}: {remedy}")]
    NoCapsules {
        /// The robot's name.
        robot: String,
        /// What is missing.
        problem: String,
        /// How to give it capsules.
        remedy: String,
    },
    /// A start or end that touches something.
    #[error("{what}: link '{link}' is {depth} {other}")]
    InCollision {
        /// What was passed, such as "start".
        what: String,
        /// The link.
        link: String,
        /// What it is in, such as "obstacle 0 (Box)".
        other: String,
        /// How deep, such as "0.02 m inside".
        depth: String,
    },
    /// A joint that no limit slows down.
    #[error(
        "joint '{joint}' has neither a velocity nor an acceleration limit, so that nothing sets its pace: give \
         limits=Limits(velocity=...)"
    )]
    NoPace {
        /// The joint's name.
        joint: String,
    },
    /// A path without points, or one that cannot be followed in time.
    #[error("path: {problem}")]
    InvalidPath {
        /// What is wrong and what would be right.
        problem: String,
    },
    /// Times that do not increase.
    #[error("{what} must increase, but row {row} has {value} after {previous}")]
    NotIncreasing {
        /// What was passed, such as "path times".
        what: String,
        /// The first row, from 0, that is not later than the one before it.
        row: usize,
        /// The time of the row before (s).
        previous: f64,
        /// The time of this row (s).
        value: f64,
    },
    /// A joint motion that no robot could make.
    #[error("trajectory: {problem}")]
    InvalidTrajectory {
        /// What is wrong and what would be right.
        problem: String,
    },
    /// A mistake in one row of a batch.
    #[error("row {row}: {error}")]
    InRow {
        /// The row, from 0.
        row: usize,
        /// What is wrong with it.
        error: Box<Error>,
    },
    /// The operating system does not give as many threads.
    #[error("cannot start {threads} threads ({problem}): ask for fewer; threads=1 needs none")]
    NoThreads {
        /// How many were asked for.
        threads: usize,
        /// The operating system's reason.
        problem: String,
    },
    /// A call that comes before the one it needs.
    #[error("{call}: {remedy}")]
    OutOfTurn {
        /// What was called.
        call: String,
        /// What to call first.
        remedy: String,
    },
    /// A plant that does not answer with a position, right at the start.
    #[error("the plant {problem}")]
    PlantFailed {
        /// What it did, such as "raised ValueError: no".
        problem: String,
    },
    /// Stored bytes that are not what they should be.
    #[error("cannot restore {what}: {problem}")]
    Corrupt {
        /// What was to be restored.
        what: String,
        /// What is wrong with it.
        problem: String,
    },
}

impl Error {
    /// Shorthand for [`Error::UnknownOption`].
    pub(crate) fn unknown_option(what: &str, value: &str, known: &[&str]) -> Self {
        let known = known.iter().map(|name| format!("'{name}'")).collect::<Vec<_>>().join(", ");
        Self::UnknownOption { what: what.into(), value: shortened(value), known }
    }

    /// Shorthand for [`Error::OutOfRange`].
    pub(crate) fn out_of_range(what: impl Into<String>, requirement: &str, value: f64) -> Self {
        Self::OutOfRange { what: what.into(), requirement: requirement.into(), value }
    }
}

/// Err unless every entry is finite; `name(i)` says which one is not.
pub(crate) fn require_finite(what: &str, values: &[f64], name: impl Fn(usize) -> String) -> Result<()> {
    match values.iter().position(|v| !v.is_finite()) {
        None => Ok(()),
        Some(i) => Err(Error::NotFinite { what: what.into(), place: name(i), value: values[i] }),
    }
}

/// Err unless `value` is finite and above zero.
pub(crate) fn require_positive(what: &str, value: f64) -> Result<()> {
    if value.is_finite() && value > 0.0 { Ok(()) } else { Err(Error::out_of_range(what, "positive and finite", value)) }
}

/// Length up to which a message repeats a text (characters).
const ECHO_LENGTH: usize = 200;

/// A given text for a message, cut to a readable length.
pub(crate) fn shortened(text: &str) -> String {
    match text.char_indices().nth(ECHO_LENGTH) {
        None => text.into(),
        Some((end, _)) => format!("{}...", &text[..end]),
    }
}

/// ` (did you mean 'x'?)` for the candidate nearest to `name`, or nothing where none is near.
pub(crate) fn suggestion<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    let wanted = name.to_lowercase();
    candidates
        .into_iter()
        .map(|candidate| (strsim::jaro_winkler(&wanted, &candidate.to_lowercase()), candidate))
        .filter(|(similarity, _)| *similarity > 0.75)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| format!(" (did you mean '{candidate}'?)"))
        .unwrap_or_default()
}
