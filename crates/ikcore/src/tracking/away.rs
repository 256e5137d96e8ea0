//! Report on an arm that cannot come nearer to its target.

use serde::{Deserialize, Serialize};

use crate::message::{Message, Setting, message};
use crate::task::TipError;

/// Obstruction that keeps an arm away from its target: joints at their limits or, without any, a singular configuration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Away {
    /// State of the way to the target.
    pub way: Way,
    /// Joints held at their lower and upper limits, one bit each; those that equal limits lock, at both.
    pub held: [u64; 2],
}

/// A way to the target of an arm that its rule cannot bring nearer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Way {
    /// No configuration on the target is known.
    Unknown,
    /// One is known, but the arm is near enough to its target to keep its own.
    Spared,
    /// One is known, but recovery is switched off.
    Declined,
    /// One is known, but the straight way of the joints to it is not clear or would part tips that are held.
    Blocked,
    /// The arm is on its way to one.
    Taken,
}

impl Away {
    /// Sentence on an arm that is `error` away; `joint` names a joint.
    pub(super) fn message(&self, error: &TipError, limits: &str, joint: impl Fn(usize) -> String) -> Message {
        if self.way == Way::Taken {
            let text = "on the way to a configuration on the target, by a motion of the joints, ";
            return format!("{text}{error} away{limits}").into();
        }
        let holder = self.holder(joint);
        let holds = format!("{holder} {error} away{limits}; ");
        match self.way {
            Way::Unknown => {
                let advice = "widen the limits or the tolerance, or move the target into reach";
                format!(
                    "no nearer than in the tick before, {error} away{limits}: {holder}, and no configuration on the target is \
                     known: {advice}"
                )
                .into()
            }
            Way::Spared => format!(
                "{holds}another configuration reaches the target, but for less than 1 mm or mrad the arm keeps its own: plan a \
                 motion to the other one, or widen the tolerance"
            )
            .into(),
            Way::Declined => message![
                holds,
                "the target is in reach: ",
                Setting::Recover,
                " lets the arm go to a configuration on it"
            ],
            Way::Blocked | Way::Taken => format!("{holds}{}: plan a motion", Self::NO_WAY).into(),
        }
    }

    /// Sentence for an arm without a straight line of the joints that is clear, keeps constraints and torques, and can be followed.
    pub(super) const NO_WAY: &str = "the target is in reach, but no straight way of the joints to it was found";

    /// Names the joints or the singularity that hold the arm, as the beginning of a sentence.
    fn holder(&self, joint: impl Fn(usize) -> String) -> String {
        let [lower, upper] = self.held;
        let place = |j: usize| match [lower, upper].map(|held| held >> j & 1 == 1) {
            [true, true] => Some(["locked by equal limits"; 2]),
            [true, false] => Some(["at its lower limit", "lower"]),
            [false, true] => Some(["at its upper limit", "upper"]),
            [false, false] => None,
        };
        let held = (0..u64::BITS as usize).filter_map(|j| place(j).map(|place| (joint(j), place)));
        match held.collect::<Vec<_>>().as_slice() {
            [] => "a singular configuration holds the arm".into(),
            [(joint, [place, _])] => format!("joint '{joint}', {place}, holds the arm"),
            several => {
                let each = several.iter().map(|(joint, [_, side])| format!("'{joint}' ({side})"));
                format!("joints at their limits, {}, hold the arm", each.collect::<Vec<_>>().join(", "))
            }
        }
    }
}
