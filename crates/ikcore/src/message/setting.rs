//! Settings that messages name.

use std::fmt;

/// Setting of a call, or advice about one. It has plain words here; an interface has its own spelling.
#[non_exhaustive]
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Setting {
    /// Limit of this kind: "velocity", "acceleration" or "jerk".
    Limit(&'static str),
    /// Budget of a search.
    Budget,
    /// Value of a function that is low enough.
    EnoughValue,
    /// Planner: "minmax", "timed" or "tpbso".
    Method(&'static str),
    /// Distance that a motion may leave its path by, of this value.
    Tolerance(String),
    /// Planner that has a solver of its own.
    MethodWithSolver,
    /// Part of a pose that comes first: "position" or "orientation".
    First(&'static str),
    /// Tip of a robot that has several.
    Tip,
    /// Link that carries a payload.
    CarryingLink,
    /// Common task of all tips.
    OneTask,
    /// Tasks of each of several tips.
    TaskOfEachTip,
    /// Preferred solution: "nearest" or "best".
    Prefer(&'static str),
    /// Weights of the joints: the cost of moving each.
    JointWeights,
    /// Solutions at all whole turns.
    AllTurns,
    /// Error for an invalid item of a batch.
    RaiseInvalid,
    /// Tracker that is stepped by its caller.
    Session,
    /// Time of a tracker.
    Clock,
    /// Approach from rest to a moving path.
    Ease,
    /// Way back of a tracked arm to a configuration on its target.
    Recover,
    /// Motion out of a contact first.
    FreeStart,
    /// Joint velocity at the start.
    StartVelocity,
    /// Configuration at the start.
    StartConfiguration,
    /// Values of other joints passed over.
    IgnoreExtra,
    /// Breaks of a path, at which the tool leaves it and goes on.
    Breaks,
    /// Distance beyond a limit in which a start is taken.
    StartSlack,
    /// Whole turns taken off, which brings a joint inside its limits.
    Wrap,
    /// Joint moved to its limit, which changes the pose.
    Clip,
    /// New timing of a plan.
    Retime,
    /// Distance to keep.
    Margin,
    /// Bodies that a margin is kept from.
    Surroundings,
    /// Region of a map.
    Region,
    /// Task of a map: of a position, and perhaps of a direction.
    MapTask {
        /// Whether a direction is possible.
        pointing: bool,
    },
    /// Collision shapes without meshes.
    Primitives,
    /// Collision shapes that are fitted to meshes.
    Fitted,
    /// Capsules along links or at ends that are given.
    GiveCapsules,
    /// Capsules that the robot has, and no other shapes.
    CapsulesAlone,
    /// Further capsules.
    MoreCapsules,
    /// Capsules of one radius along the links.
    CapsulesAlongLinks,
    /// Robot that carries what is attached to it in a scene.
    Attach,
    /// Removal of the robot's own points from an obstacle of this kind: "PointCloud" or "Grid".
    WithoutRobot(&'static str),
    /// Inertias of links, given to a robot.
    Inertias,
    /// Angles that are converted from degrees before a call.
    RadiansFromDegrees,
    /// Angles that a call takes in degrees.
    AnglesInDegrees,
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Limit(kind) => {
                let article = if *kind == "acceleration" { "an" } else { "a" };
                return write!(f, "{article} {kind} limit");
            }
            Self::Method(name) => return write!(f, "the method '{name}'"),
            Self::Tolerance(value) => return write!(f, "a tolerance of {value}"),
            Self::First(part) => return write!(f, "a task with the {part} first"),
            Self::Prefer(which) => return write!(f, "the preference '{which}'"),
            Self::Budget => "budget",
            Self::EnoughValue => "a value",
            Self::MethodWithSolver => "the method 'tpbso'",
            Self::Tip => "its tip",
            Self::CarryingLink => "the link",
            Self::OneTask => "one task for all tips",
            Self::TaskOfEachTip => "each of several tips has a task of its own",
            Self::JointWeights => "weights of joints",
            Self::AllTurns => "taking all whole turns",
            Self::RaiseInvalid => "make invalid items an error",
            Self::Session => "Session",
            Self::Clock => "its time",
            Self::Ease => "an eased start",
            Self::Recover => "recovery",
            Self::FreeStart => "free_start",
            Self::StartVelocity => "start velocity",
            Self::StartConfiguration => "it instead of a target",
            Self::IgnoreExtra => "ignoring extra names",
            Self::Breaks => "breaks, which let the tool leave the path there and go on",
            Self::StartSlack => "start slack",
            Self::Wrap => "whole turns taken off bring it inside",
            Self::Clip => "moving it to the limit changes the pose",
            Self::Retime => "a new timing of the plan",
            Self::Margin => "a margin",
            Self::Surroundings => "obstacles (perhaps none) or self-collision",
            Self::Region => "a region",
            Self::MapTask { pointing: true } => "a pointing or a position task",
            Self::MapTask { pointing: false } => "a position task",
            Self::Primitives => "primitive shapes alone",
            Self::Fitted => "shapes fitted to its meshes",
            Self::GiveCapsules => "give it capsules",
            Self::CapsulesAlone => "giving it the capsules that it has",
            Self::MoreCapsules => "giving it more of them",
            Self::CapsulesAlongLinks => "with_capsules_along_links",
            Self::Attach => "a robot that carries it",
            Self::WithoutRobot(_) => "without_robot",
            Self::Inertias => "its links inertias",
            Self::RadiansFromDegrees | Self::AnglesInDegrees => "convert degrees to radians",
        })
    }
}
