//! Options that messages name.

use std::fmt;

/// An option, or what to do with one. It has plain words here; an interface has its own spelling.
#[non_exhaustive]
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Setting {
    /// A limit of this kind: "velocity", "acceleration" or "jerk".
    Limit(&'static str),
    /// The budget of a search.
    Budget,
    /// A planner: "minmax", "timed" or "tpbso".
    Method(&'static str),
    /// The planner that has a solver of its own.
    MethodWithSolver,
    /// The tip of a robot that has several.
    Tip,
    /// One task for all tips.
    OneTask,
    /// A task for each of several tips.
    TaskOfEachTip,
    /// Which solution is preferred: "nearest" or "best".
    Prefer(&'static str),
    /// Each solution at all whole turns.
    AllTurns,
    /// An error for an invalid item of a batch.
    RaiseInvalid,
    /// The approach from rest to a moving path.
    Ease,
    /// A motion out of a contact first.
    FreeStart,
    /// The joint velocity at the start.
    StartVelocity,
    /// The configuration at the start.
    StartConfiguration,
    /// A new timing of a plan.
    Retime,
    /// The distance to keep.
    Margin,
    /// What a margin is kept from.
    Surroundings,
    /// The region of a map.
    Region,
    /// A task that a map can have: of a position, and perhaps of a direction.
    MapTask {
        /// Whether a direction is possible.
        pointing: bool,
    },
    /// Folders that hold the packages of meshes.
    PackageFolders,
    /// Collision shapes without meshes.
    Primitives,
    /// Collision shapes that are fitted to meshes.
    Fitted,
    /// Capsules along links or at ends that are given.
    GiveCapsules,
    /// The capsules that the robot has, and no other shapes.
    CapsulesAlone,
    /// More capsules.
    MoreCapsules,
    /// Capsules of one radius along the links.
    CapsulesAlongLinks,
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Limit(kind) => {
                let article = if *kind == "acceleration" { "an" } else { "a" };
                return write!(f, "{article} {kind} limit");
            }
            Self::Method(name) => return write!(f, "the method '{name}'"),
            Self::Prefer(which) => return write!(f, "the preference '{which}'"),
            Self::Budget => "budget",
            Self::MethodWithSolver => "the method 'tpbso'",
            Self::Tip => "its tip",
            Self::OneTask => "one task for all tips",
            Self::TaskOfEachTip => "each of several tips has a task of its own",
            Self::AllTurns => "taking all whole turns",
            Self::RaiseInvalid => "make invalid items an error",
            Self::Ease => "an eased start",
            Self::FreeStart => "free_start",
            Self::StartVelocity => "start velocity",
            Self::StartConfiguration => "it instead of a target",
            Self::Retime => "a new timing of the plan",
            Self::Margin => "a margin",
            Self::Surroundings => "obstacles (perhaps none) or self-collision",
            Self::Region => "a region",
            Self::MapTask { pointing: true } => "a pointing or a position task",
            Self::MapTask { pointing: false } => "a position task",
            Self::PackageFolders => "the folders of its package",
            Self::Primitives => "primitive shapes alone",
            Self::Fitted => "shapes fitted to its meshes",
            Self::GiveCapsules => "give it capsules",
            Self::CapsulesAlone => "giving it the capsules that it has",
            Self::MoreCapsules => "giving it more of them",
            Self::CapsulesAlongLinks => "with_capsules_along_links",
        })
    }
}
