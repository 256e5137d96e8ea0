//! Reasons why no target leads an arm.

use serde::{Deserialize, Serialize};

use crate::message::{Message, Setting, message};
use crate::task::TipError;
use crate::wording::number;

/// Reason why no target leads the arm in a tick, so that it comes to rest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Idle {
    /// None has arrived yet.
    NoTarget,
    /// The arm was told to stop.
    Stopped,
    /// None has arrived for longer than this timeout (s).
    TimedOut(f64),
    /// The next one is overdue, and the arm has followed the motion of the last ones on.
    Ceased,
    /// The target of this tick is ignored: its stamp is not after that of the last one (s).
    Outdated {
        /// Stamp of the target.
        stamp: f64,
        /// Stamp of the last target that was taken, or the end of the tick in which it came without one.
        last: f64,
    },
}

impl Idle {
    /// Sentence on an arm that is `error` away from its last target, if it had one.
    pub(super) fn message(self, error: &TipError, limits: &str) -> Message {
        let has_target = !(error.position.is_nan() && error.rotation.is_nan());
        let away = if has_target { format!(", {error} away from the last target") } else { String::new() };
        match self {
            Self::Outdated { stamp, last } => {
                let (stamp, last) = (number(stamp), number(last));
                let why = format!("its stamp, {stamp} s, is not after that of the last one, {last} s");
                let away = if has_target { format!("; the arm is {error} away from the last one") } else { away };
                return message![
                    format!("this target is ignored: {why}{away}{limits}: "),
                    "leave stamp out, or give the time of measurement on the clock of the tracker, ",
                    Setting::Clock,
                    ", which advances by dt in each step",
                ];
            }
            Self::NoTarget => format!("no target yet{limits}: the arm comes to rest and waits for one"),
            Self::Ceased => {
                let follows = "the arm follows the motion of the last ones on, and then rests until the next one";
                format!("no new target{away}{limits}: {follows}")
            }
            Self::Stopped => format!("stopped by stop(){away}{limits}: the next target makes it go on"),
            Self::TimedOut(timeout) => {
                format!(
                    "no target for {} s{away}{limits}: the arm comes to rest and waits for the next one",
                    number(timeout)
                )
            }
        }
        .into()
    }
}
