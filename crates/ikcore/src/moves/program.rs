//! A program of moves, as data, and its checks.

use crate::error::{Error, Result, require_finite, require_not_negative, require_positive};
use crate::math::{Pose, pose};
use crate::robot::Robot;
use crate::wording::joined;

/// Longest wait (s), as for pauses between motions.
const LONGEST_WAIT: f64 = 1e6;

/// One move of a program.
#[derive(Debug, Clone, PartialEq)]
pub struct Move {
    /// Kind of the move.
    pub kind: MoveKind,
    /// Radius (m) about the end of the move inside which the motion may round the corner to the next move. With zero, or less than the
    /// 1e-5 m that a path is kept to, it stops there.
    pub blend: f64,
    /// The tip that a line, an arc or a joint move to a pose leads, of a robot with several; joints that move other tips too stay where they
    /// are. `None`: the only tip.
    pub tip: Option<String>,
    /// Name in messages and reports.
    pub name: Option<String>,
}

/// Kinds of moves.
#[derive(Debug, Clone, PartialEq)]
pub enum MoveKind {
    /// All joints together to a goal, as fast as the limits allow.
    Joints(JointGoal),
    /// The tip along a straight line; its orientation turns uniformly with the length.
    Line {
        /// Pose at the end.
        pose: Pose,
        /// Speed of the tip (m/s). `None`: as fast as the limits allow.
        speed: Option<f64>,
    },
    /// The tip along an arc of a circle; its orientation turns uniformly with the length.
    Arc {
        /// A point (m) that the arc passes through.
        via: [f64; 3],
        /// Pose at the end.
        pose: Pose,
        /// Angle (rad) after which the arc ends, in place of the position of `pose`; one turn is a full circle.
        angle: Option<f64>,
        /// Speed of the tip (m/s). `None`: as fast as the limits allow.
        speed: Option<f64>,
    },
    /// Rest for this time (s).
    Wait(f64),
}

/// End of a joint move.
#[derive(Debug, Clone, PartialEq)]
pub enum JointGoal {
    /// At a configuration (n,) (rad, m).
    Configuration(Vec<f64>),
    /// At a pose of the tip; the planner chooses the configuration.
    Pose(Pose),
}

impl Move {
    /// This move, without blend, tip and name.
    pub fn new(kind: MoveKind) -> Self {
        Self { kind, blend: 0.0, tip: None, name: None }
    }

    /// Words for move `index` of a program, counted from 0.
    pub(super) fn named(&self, index: usize) -> String {
        match &self.name {
            None => format!("move {index}"),
            Some(name) => format!("move {index} '{name}'"),
        }
    }

    /// Whether the tip follows a curve.
    pub(super) fn is_cartesian(&self) -> bool {
        matches!(self.kind, MoveKind::Line { .. } | MoveKind::Arc { .. })
    }

    /// Whether it ends at a pose, and so leads one tip.
    fn leads_a_tip(&self) -> bool {
        self.is_cartesian() || matches!(self.kind, MoveKind::Joints(JointGoal::Pose(_)))
    }

    /// Requested speed of the tip (m/s).
    pub(super) fn speed(&self) -> Option<f64> {
        match self.kind {
            MoveKind::Line { speed, .. } | MoveKind::Arc { speed, .. } => speed,
            MoveKind::Joints(_) | MoveKind::Wait(_) => None,
        }
    }

    /// Checks all numbers but those that depend on the robot.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] and [`Error::NotFinite`] name the number.
    pub fn validate(&self) -> Result<()> {
        self.check_numbers(&self.name.as_ref().map_or(String::new(), |name| format!(" of move '{name}'")))?;
        self.refuse_superfluous_tip(|| self.name.as_ref().map_or("the move".into(), |name| format!("move '{name}'")))
    }

    fn refuse_superfluous_tip(&self, named: impl Fn() -> String) -> Result<()> {
        match &self.tip {
            Some(tip) if !self.leads_a_tip() => {
                let problem = format!("it leads no tip to a pose, but names tip '{tip}': leave the tip out");
                Err(Error::InvalidMove { what: named(), problem: problem.into() })
            }
            _ => Ok(()),
        }
    }

    /// Checks numbers and lengths.
    fn check(&self, named: &str, robot: &Robot) -> Result<()> {
        if let MoveKind::Joints(JointGoal::Configuration(q)) = &self.kind {
            robot.check(&format!("joint positions of {named}"), q)?;
        }
        self.check_numbers(&format!(" of {named}"))?;
        self.check_tip(named, robot)
    }

    /// Checks that a move to a pose leads one tip.
    fn check_tip(&self, named: &str, robot: &Robot) -> Result<()> {
        self.refuse_superfluous_tip(|| named.into())?;
        if let Some(tip) = &self.tip {
            return robot.tip_number(tip).map(|_| ());
        }
        if robot.tip_count() == 1 || !self.leads_a_tip() {
            return Ok(());
        }
        let (name, tips) = (robot.name(), joined(robot.tips()));
        let problem = format!("it names no tip of robot '{name}', which has several: name one of {tips}");
        Err(Error::InvalidMove { what: named.into(), problem: problem.into() })
    }

    /// Checks numbers; `of` says of which move, in messages.
    fn check_numbers(&self, of: &str) -> Result<()> {
        require_not_negative(&format!("blend{of}"), self.blend)?;
        match &self.kind {
            MoveKind::Joints(JointGoal::Configuration(q)) => {
                require_finite(format!("joint positions{of}"), q, |i| format!("entry {i}"))?;
            }
            MoveKind::Joints(JointGoal::Pose(goal)) | MoveKind::Line { pose: goal, .. } => {
                pose::checked(&format!("pose{of}"), *goal)?;
            }
            MoveKind::Arc { via, pose: goal, angle, .. } => {
                require_finite(format!("via{of}"), via, |i| format!("entry {i}"))?;
                pose::checked(&format!("pose{of}"), *goal)?;
                angle.map_or(Ok(()), |angle| require_positive(&format!("angle{of}"), angle))?;
            }
            MoveKind::Wait(seconds) if (0.0..=LONGEST_WAIT).contains(seconds) => {}
            MoveKind::Wait(seconds) => {
                let what = format!("time{of}");
                return Err(Error::out_of_range(what, format!("from 0 to {LONGEST_WAIT} s"), *seconds));
            }
        }
        self.speed().map_or(Ok(()), |speed| require_positive(&format!("speed{of}"), speed))
    }
}

/// Blend radius (m) below which a corner is a stop: lines and arcs are kept to no better than that.
const LEAST_BLEND: f64 = 1e-5;

/// The moves with those blends that count.
pub(super) fn with_blends_that_count(moves: &[Move]) -> Vec<Move> {
    let counted = |each: &Move| {
        let is_stop = (0.0..LEAST_BLEND).contains(&each.blend);
        Move { blend: if is_stop { 0.0 } else { each.blend }, ..each.clone() }
    };
    moves.iter().map(counted).collect()
}

/// Checks each move by itself, and that no blend leads into a wait or to another tip.
///
/// # Errors
/// [`Error::InvalidMove`] for a program without moves, for a blend before a wait or a move of another tip, and for a move whose tip is missing
/// or superfluous; [`Error::OutOfRange`], [`Error::NotFinite`], [`Error::WrongLength`] and [`Error::UnknownTip`].
pub(super) fn check_program(robot: &Robot, moves: &[Move]) -> Result<()> {
    if moves.is_empty() {
        let problem = "it has no moves: give at least one".into();
        return Err(Error::InvalidMove { what: "the program".into(), problem });
    }
    for (i, each) in moves.iter().enumerate() {
        each.check(&each.named(i), robot)?;
        let Some(next) = moves.get(i + 1).filter(|_| each.blend > 0.0) else { continue };
        let what_follows = match (&each.tip, &next.tip) {
            _ if matches!(next.kind, MoveKind::Wait(_)) => "a wait",
            (Some(one), Some(other)) if one != other => "a move of another tip",
            _ => continue,
        };
        let problem = format!(
            "its blend of {} m leads into {}, {what_follows}, before which the arm stops: give no blend",
            each.blend,
            next.named(i + 1)
        );
        return Err(Error::InvalidMove { what: each.named(i), problem: problem.into() });
    }
    Ok(())
}
