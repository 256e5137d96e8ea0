//! Error type of the crate: mistakes of a caller, with names, values and advice as data.
//!
//! | file | what |
//! |---|---|
//! | `checks` | checks of numbers that many calls share |
//! | `text` | values and names as messages quote them |
//! | `worded` | an error in the words of another language |

mod checks;
mod text;
mod worded;

use thiserror::Error;

use crate::message::Message;

pub(crate) use checks::{
    require_at_least_one, require_factor, require_finite, require_fraction, require_not_negative, require_positive,
    require_proper_fraction,
};
pub(crate) use text::{given, shortened, suggestion};

/// `Result` type with this crate's [`enum@Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Mistakes of a caller.
///
/// A search that does not converge is not an error: it has a [`Status`](crate::solver::Status) next to the best result
/// found.
#[non_exhaustive]
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Error {
    /// The computation was interrupted; see [`interruptible`](crate::interrupt::interruptible).
    #[error("interrupted before the end")]
    Interrupted,
    /// A number that must be finite is NaN or infinite.
    #[error("{what} must be finite, but {place} is {value}")]
    NotFinite {
        /// Name of the argument, for example "joint angles".
        what: Message,
        /// Name of the entry, for example "entry 2" or "joint 'elbow'".
        place: String,
        /// The offending number.
        value: f64,
    },
    /// An array has the wrong length.
    #[error("{what}: expected {expected}, got {got}")]
    WrongLength {
        /// Name of the argument and its robot, for example "joint angles of robot 'iiwa14'".
        what: Message,
        /// Expected length, for example "7 joints".
        expected: String,
        /// Length that was given.
        got: usize,
    },
    /// A number is outside its allowed range.
    #[error("{what} must be {requirement}, got {}", given(*.value))]
    OutOfRange {
        /// The name of the argument.
        what: Message,
        /// Allowed range in words, for example "positive".
        requirement: Message,
        /// The offending number.
        value: f64,
    },
    /// A word that is not among the allowed ones.
    #[error("{what} must be one of {known}, got '{value}'")]
    UnknownOption {
        /// The name of the argument.
        what: String,
        /// The value that was given.
        value: String,
        /// The allowed words, quoted and separated by commas.
        known: String,
    },
    /// No built-in robot has this name.
    #[error("no robot is named '{name}'{suggestion}; known robots: {known}")]
    UnknownRobot {
        /// The requested name.
        name: String,
        /// Text ` (did you mean 'x'?)`, or empty.
        suggestion: String,
        /// All names, separated by commas.
        known: String,
    },
    /// No link of the robot has this name.
    #[error("robot '{robot}' has no link '{name}'{suggestion}; its links: {known}")]
    UnknownLink {
        /// The robot's name.
        robot: String,
        /// The requested link.
        name: String,
        /// Text ` (did you mean 'x'?)`, or empty.
        suggestion: String,
        /// All links, separated by commas.
        known: String,
    },
    /// No tip of the robot has this name.
    #[error("robot '{robot}' has no tip '{name}'{suggestion}; its tips: {known}")]
    UnknownTip {
        /// The robot's name.
        robot: String,
        /// The requested tip.
        name: String,
        /// Text ` (did you mean 'x'?)`, or empty.
        suggestion: String,
        /// All tips, separated by commas.
        known: String,
    },
    /// A value was given for a joint that q does not contain.
    #[error("robot '{robot}' has no joint '{name}' in q{problem}; its joints: {joints}; {remedy}")]
    UnknownJoint {
        /// The robot's name.
        robot: String,
        /// The given name.
        name: String,
        /// Text ` (did you mean 'x'?)`, the reason why the joint is not in q, or empty.
        problem: String,
        /// All joints of q, separated by commas.
        joints: String,
        /// How to pass over values of other joints.
        remedy: Message,
    },
    /// A call that takes robots with one tip got one with several.
    #[error("{call} takes robots with one tip; this one has {tips}: {remedy}")]
    SeveralTips {
        /// Name of the call.
        call: Message,
        /// Names of the tips.
        tips: String,
        /// The remedy.
        remedy: Message,
    },
    /// No joint that the robot holds has this name.
    #[error("robot '{robot}' holds no joint '{name}'{problem}; joints that it holds: {}", if .held.is_empty() { "none" } else { .held })]
    NotHeld {
        /// The robot's name.
        robot: String,
        /// The requested joint.
        name: String,
        /// Text ` (did you mean 'x'?)`, the reason why the joint is not held, or empty.
        problem: String,
        /// All held joints, separated by commas.
        held: String,
    },
    /// No tip was given, but the tree of links has several leaves.
    #[error("robot '{robot}' ends in {count} links: say which one is the tip; leaves, by number of joints: {leaves}")]
    AmbiguousTip {
        /// The robot's name.
        robot: String,
        /// The number of leaf links.
        count: usize,
        /// The leaf links, each with the number of its joints, most joints first.
        leaves: String,
    },
    /// An invalid description of a robot.
    #[error("robot '{robot}': {problem}")]
    InvalidRobot {
        /// The robot's name.
        robot: String,
        /// Description of the problem, with advice.
        problem: Message,
    },
    /// A call that needs masses got a robot whose masses are unknown or impossible.
    #[error("robot '{robot}' has no dynamics: {problem}")]
    NoDynamics {
        /// The robot's name.
        robot: String,
        /// The reason, with advice.
        problem: Message,
    },
    /// Accelerations are not determined: some joints can move without moving mass.
    #[error(
        "configuration {row}: the mass matrix of robot '{robot}' is singular: joint '{joint}' and those before it can move without moving mass"
    )]
    SingularMassMatrix {
        /// The robot's name.
        robot: String,
        /// Index of the configuration.
        row: usize,
        /// The joint's name.
        joint: String,
    },
    /// An inertia that no body has.
    #[error("{what}: {problem}")]
    ImpossibleInertia {
        /// Name of the argument.
        what: Message,
        /// The reason.
        problem: String,
    },
    /// A URDF that cannot be read.
    #[error("URDF{}: {problem}", .line.map(|l| format!(" line {l}")).unwrap_or_default())]
    Urdf {
        /// Line of the text, from 1, where known.
        line: Option<u32>,
        /// Description of the problem, with advice.
        problem: Message,
    },
    /// An SRDF that cannot be read, or one of another robot.
    #[error("SRDF{}: {problem}", .line.map(|l| format!(" line {l}")).unwrap_or_default())]
    Srdf {
        /// Line of the text, from 1, where known.
        line: Option<u32>,
        /// Description of the problem, with advice.
        problem: Message,
    },
    /// A file that cannot be read.
    #[error("cannot read '{path}': {problem}")]
    Unreadable {
        /// Path of the file.
        path: String,
        /// The operating system's reason.
        problem: String,
    },
    /// A lower limit above its upper limit.
    #[error("joint '{joint}': lower limit {} is above upper limit {}{}", given(*.lower), given(*.upper), .time.map(|t| format!(" at t = {t} s")).unwrap_or_default())]
    EmptyRange {
        /// The joint's name.
        joint: String,
        /// Lower limit of the joint (rad or m).
        lower: f64,
        /// Upper limit of the joint (rad or m).
        upper: f64,
        /// Time of the violation, for limits that vary (s).
        time: Option<f64>,
    },
    /// A configuration outside the position limits.
    #[error("{what}: joint '{joint}' at {} is outside its limits [{}, {}] {excess}", given(*.value), given(*.lower), given(*.upper))]
    OutsideLimits {
        /// Name of the argument, for example "start_q".
        what: Message,
        /// The joint's name.
        joint: String,
        /// Value of the joint (rad or m).
        value: f64,
        /// Lower limit of the joint (rad or m).
        lower: f64,
        /// Upper limit of the joint (rad or m).
        upper: f64,
        /// Excess over the nearer limit, and what brings the joint inside.
        excess: Message,
    },
    /// A configuration that puts the tip outside its region.
    #[error("{what}: {coordinate} of the tip, {value} m, is outside its region ({lower}, {upper})")]
    OutsideRegion {
        /// Name of the argument, for example "start_q".
        what: String,
        /// The coordinate, in the base's frame.
        coordinate: String,
        /// Value of the coordinate (m).
        value: f64,
        /// Lower bound of the region (m).
        lower: f64,
        /// Upper bound of the region (m).
        upper: f64,
    },
    /// The start or end of a motion is out of reach.
    #[error("{what} cannot be reached: {problem}")]
    Unreachable {
        /// Name of the end, for example "start".
        what: String,
        /// Shortfall, with advice.
        problem: Message,
    },
    /// A move of a program that contradicts itself or its neighbours.
    #[error("{what}: {problem}")]
    InvalidMove {
        /// The move, for example "move 2 'down'".
        what: String,
        /// Description of the problem, with advice.
        problem: Message,
    },
    /// A search found nothing, which does not prove that nothing exists.
    #[error("{what} was not found: {problem}")]
    NotFound {
        /// Object of the search, for example "a motion past point 3 of the path".
        what: String,
        /// Distance by which the search failed, and advice.
        problem: Message,
    },
    /// Several ends were given for a motion, and none of them is usable.
    #[error("none of the {count} ends can be reached: {problems}")]
    NoUsableEnd {
        /// The number of ends.
        count: usize,
        /// Problem of each end, separated by semicolons.
        problems: Message,
    },
    /// A limit is negative, at least for some time.
    #[error("{field} limit of joint '{joint}' is {value} at t = {time} s: a limit cannot be negative")]
    NegativeLimit {
        /// Field of the limit: "velocity", "acceleration" or "jerk".
        field: String,
        /// The joint's name.
        joint: String,
        /// Smallest value of the limit (rad/s or m/s, and so on).
        value: f64,
        /// Time of the smallest value (s).
        time: f64,
    },
    /// A limit that the method does not support. No method silently ignores a limit.
    #[error("{method} cannot honour {field} limits: {remedy}")]
    UnsupportedLimit {
        /// Field of the limits, for example "acceleration".
        field: String,
        /// Method that rejects the limit.
        method: Message,
        /// Advice to the caller.
        remedy: Message,
    },
    /// No motion satisfies the request.
    #[error("infeasible: {problem}")]
    Infeasible {
        /// The conflicting requirements.
        problem: Message,
    },
    /// Measurements that cannot be right, or do not suffice.
    #[error("{problem}")]
    InvalidMeasurement {
        /// Description of the problem, with advice.
        problem: Message,
    },
    /// A matrix that is not a rigid transform.
    #[error("{what} is not a rigid transform: {problem}")]
    NotRigid {
        /// Name of the argument, for example "target".
        what: String,
        /// Size of the deviation.
        problem: String,
    },
    /// A position was given, but the task needs a whole pose.
    #[error("task {task} needs a target pose (4, 4), got a position (3,)")]
    WrongTarget {
        /// The kind of task.
        task: String,
    },
    /// Options that contradict each other.
    #[error("{problem}")]
    Contradiction {
        /// Contradictory options, with advice.
        problem: Message,
    },
    /// An invalid obstacle, or one that this robot does not support.
    #[error("{problem}")]
    InvalidObstacle {
        /// Description of the problem, with advice.
        problem: String,
    },
    /// The robot has no capsules, so its shape is unknown.
    #[error("robot '{robot}' {problem}: {remedy}")]
    NoCapsules {
        /// The robot's name.
        robot: String,
        /// Description of the problem, with advice.
        problem: String,
        /// Advice on adding capsules to the robot.
        remedy: Message,
    },
    /// A start or end in collision.
    #[error("{what}: link '{link}' is {depth} {other}{remedy}")]
    InCollision {
        /// Name of the argument, for example "start_q".
        what: String,
        /// Name of the link.
        link: String,
        /// Name of the other body, for example "obstacle 0 (Box)".
        other: String,
        /// Penetration depth, for example "0.02 m inside".
        depth: String,
        /// Advice on allowing the contact, after a semicolon; empty if a joint moves the link.
        remedy: Message,
    },
    /// Joints with neither a velocity nor an acceleration limit.
    #[error("{problem}: {remedy}")]
    NoPace {
        /// The joints and what they lack.
        problem: String,
        /// The remedy.
        remedy: Message,
    },
    /// A path without points, or one that cannot be followed in time.
    #[error("path: {problem}")]
    InvalidPath {
        /// Description of the problem, with advice.
        problem: String,
    },
    /// Times that do not increase.
    #[error("{what} must increase, but row {row} has {value} after {previous}")]
    NotIncreasing {
        /// Name of the argument, for example "path times".
        what: String,
        /// The first row, from 0, that is not later than the one before it.
        row: usize,
        /// The time of the row before (s).
        previous: f64,
        /// The time of this row (s).
        value: f64,
    },
    /// An invalid joint motion.
    #[error("trajectory: {problem}")]
    InvalidTrajectory {
        /// Description of the problem, with advice.
        problem: String,
    },
    /// A mistake in one row of a batch.
    #[error("row {row}: {error}")]
    InRow {
        /// Index of the row, from 0.
        row: usize,
        /// Mistake in the row.
        error: Box<Error>,
    },
    /// A mistake in one problem of a batch of plans.
    #[error("problems[{index}]: {error}")]
    InProblem {
        /// Index of the problem, from 0.
        index: usize,
        /// Mistake in the problem.
        error: Box<Error>,
    },
    /// A mistake in a file.
    #[error("{path}: {error}")]
    InFile {
        /// Path of the file, as given.
        path: String,
        /// Mistake in the file.
        error: Box<Error>,
    },
    /// The operating system cannot start this many threads.
    #[error("cannot start {threads} threads ({problem}): ask for fewer; a single one needs none")]
    NoThreads {
        /// The number of threads requested.
        threads: usize,
        /// The operating system's reason.
        problem: String,
    },
    /// A call that must come after another one.
    #[error("{call}: {remedy}")]
    OutOfTurn {
        /// Name of the call.
        call: String,
        /// The call that must come first.
        remedy: String,
    },
    /// A plant that fails at the start.
    #[error("the plant {problem}")]
    PlantFailed {
        /// Description of the failure, for example "raised ValueError: no".
        problem: String,
    },
    /// Corrupt stored bytes.
    #[error("cannot restore {what}: {problem}")]
    Corrupt {
        /// The object to be restored.
        what: String,
        /// Reason why the bytes are rejected.
        problem: String,
    },
}

impl Error {
    /// Creates an [`Error::UnknownOption`].
    pub(crate) fn unknown_option(what: &str, value: &str, known: &[&str]) -> Self {
        let known = known.iter().map(|name| format!("'{name}'")).collect::<Vec<_>>().join(", ");
        Self::UnknownOption { what: what.into(), value: shortened(value), known }
    }

    /// Creates an [`Error::OutOfRange`].
    pub(crate) fn out_of_range(what: impl Into<Message>, requirement: impl Into<Message>, value: f64) -> Self {
        Self::OutOfRange { what: what.into(), requirement: requirement.into(), value }
    }

    /// Returns [`Error::Unreadable`], with the path cut to a readable length.
    pub(crate) fn unreadable(path: &str, problem: impl ToString) -> Self {
        Self::Unreadable { path: shortened(path), problem: problem.to_string() }
    }

    /// Names the file of a URDF that cannot be read; other errors stay as they are.
    pub fn in_urdf_file(self, path: &str) -> Self {
        match self {
            Self::Urdf { .. } => Self::InFile { path: path.into(), error: Box::new(self) },
            other => other,
        }
    }
}
