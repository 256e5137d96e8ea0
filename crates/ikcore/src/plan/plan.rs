//! The result of a planner.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::collision_checks::least_clearance;
use super::cost::Cost;
use super::move_report::MoveReport;
use super::path_break::Break;
use super::planar_arm::Orientations;
use crate::constraint::Keep;
use crate::error::{Error, Result};
use crate::limits::JointOutside;
use crate::message::{Message, Setting, message};
use crate::obstacle::{Clearance, ClearanceSweep, Sensed, Surroundings, clear_in_words};
use crate::robot::Robot;
use crate::solver::Status;
use crate::stored::from_bytes;
use crate::timing::{ConstantLimits, JointPath, Violation};
use crate::trajectory::Trajectory;
use crate::wording::number;

/// A planned motion and the outcome of the search for it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// The best motion that keeps all limits, or the one that violates them least.
    pub trajectory: Trajectory,
    /// Quantity that was minimised.
    pub objective: Cost,
    /// Value of the objective on the trajectory (s, rad or m).
    pub cost: f64,
    /// Improvements of the search, in the order of evaluations.
    pub history: Vec<Improvement>,
    /// The clearance on the trajectory, or a bound of it; `None` without obstacles. [`least_clearance`](Self::least_clearance) finds
    /// the smallest distance.
    #[serde(with = "stored_clearance")]
    pub clearance: Option<Clearance>,
    /// Reason why no clear motion was found, if none was.
    pub obstruction: Option<String>,
    /// Kind of measurement that shows the robot itself, if that is the obstruction.
    pub own_points: Option<Sensed>,
    /// Index of the end that was taken, of those given; `None` for motions along a path.
    pub chosen_end: Option<usize>,
    /// Joints that begin outside their limits, and are led inside.
    pub start_outside: Vec<JointOutside>,
    /// Joints that end at another whole turn than the end configuration has.
    pub end_turned: Vec<JointTurned>,
    /// Way out of a contact at the start, if there was one.
    pub freed: Option<Freed>,
    /// Constraints at every instant of the motion. [`kept`](Self::kept) finds the largest errors.
    pub keeps: Vec<Keep>,
    /// Surroundings that the whole motion keeps clear of, if any.
    pub surroundings: Option<Surroundings>,
    /// Surroundings that it keeps clear of but for what its straight ends may touch, if they may touch anything.
    pub surroundings_but_for_touch: Option<Surroundings>,
    /// Largest distance (m) of the tip from its path, at its points and between them; `None` for point-to-point plans.
    pub accuracy: Option<f64>,
    /// Positions of the path (m), joined by straight lines; `None` for point-to-point plans.
    pub reference: Option<Vec<[f64; 3]>>,
    /// The orientations chosen for the free links of a planar arm, at every point of the path, from the last link
    /// inwards; empty for other arms.
    pub redundancy: Vec<Orientations>,
    /// The joint paths whose timing was optimised, each from rest to rest; empty if the trajectory is the only record of
    /// its path.
    pub path: Vec<JointPath>,
    /// The largest acceleration of a joint without an acceleration limit; `None` if all joints have one.
    pub peak: Option<Peak>,
    /// The moves of a program, in order; empty for other plans.
    pub moves: Vec<MoveReport>,
    /// Places where the tool leaves its path; empty where it does not.
    pub breaks: Vec<Break>,
    /// Bounds that the trajectory violates; empty for a plan that succeeded.
    pub violations: Vec<Violation>,
    /// [`Status::Solved`] for a trajectory without violations; else why the search ended.
    pub status: Status,
    /// Evaluations of the planner's cost.
    pub evaluations: usize,
    /// Time taken.
    pub elapsed: Duration,
}

/// The way out of a contact at the start of a plan.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Freed {
    /// The smallest distance at the start (m), below the margin; negative by the depth of an overlap.
    pub clearance: f64,
    /// Time after which the margin is kept (s).
    pub until: f64,
}

/// A joint that ends at another whole turn than the end configuration has.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JointTurned {
    /// Name of the joint.
    pub joint: String,
    /// Value at the end (rad).
    pub value: f64,
    /// Value in the end configuration (rad).
    pub given: f64,
}

/// The largest acceleration of a plan that no limit bounds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Peak {
    /// Name of the joint.
    pub joint: String,
    /// Acceleration (rad/s^2, m/s^2).
    pub acceleration: f64,
    /// The unit, "rad/s^2" or "m/s^2".
    pub unit: String,
}

/// An improvement during a search.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Improvement {
    /// Evaluations up to and including this one.
    pub evaluations: usize,
    /// The lowest cost from then on; it includes penalties as long as the plan violates limits.
    pub cost: f64,
}

/// Advice where a path leads into collision.
const ADVICE_ALONG_PATH: &str =
    "move the path or what is in the way, lower the margin, leave a part of the poses free by a task";

/// Number of violations that a message lists.
const NAMED_IN_MESSAGE: usize = 3;

impl Plan {
    /// A solved plan of a motion of which only the value `cost` of its `objective` is known.
    pub(crate) fn of(trajectory: Trajectory, objective: Cost, cost: f64) -> Self {
        Self {
            trajectory,
            objective,
            cost,
            history: vec![],
            clearance: None,
            obstruction: None,
            own_points: None,
            chosen_end: None,
            start_outside: vec![],
            end_turned: vec![],
            freed: None,
            keeps: vec![],
            surroundings: None,
            surroundings_but_for_touch: None,
            accuracy: None,
            reference: None,
            redundancy: vec![],
            path: vec![],
            moves: vec![],
            breaks: vec![],
            peak: None,
            violations: vec![],
            status: Status::Solved,
            evaluations: 0,
            elapsed: Duration::ZERO,
        }
    }

    /// The plan that [`to_bytes`](crate::stored::to_bytes) stored.
    ///
    /// # Errors
    /// [`Error::Corrupt`] for bytes of another version, damaged ones, those of something else, or values that no plan has.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let plan: Self = from_bytes("plan", bytes)?;
        if plan.redundancy.windows(2).any(|points| points[0].len() != points[1].len()) {
            let problem = "its points have different numbers of redundant links".into();
            return Err(Error::Corrupt { what: "plan".into(), problem });
        }
        Ok(plan)
    }

    /// Notes the largest acceleration of joints that have no acceleration limit in `limits`.
    pub(crate) fn name_peak(&mut self, limits: &ConstantLimits) {
        let reached = self.trajectory.max_acceleration();
        let unlimited = (0..limits.dof()).filter(|j| limits.acceleration[*j].is_infinite());
        let highest = unlimited.max_by(|i, k| reached[*i].total_cmp(&reached[*k]));
        self.peak = highest.map(|j| Peak {
            joint: limits.joint_name(j).into(),
            acceleration: reached[j],
            unit: limits.acceleration_unit(j).into(),
        });
    }

    /// The smallest clearance on the trajectory; `None` without obstacles. `robot` is the robot of the plan.
    ///
    /// # Errors
    /// Those of [`Surroundings::clear_space`] for another robot.
    pub fn least_clearance(&self, robot: &Robot) -> Result<Option<Clearance>> {
        let known = Ok(self.clearance.clone());
        let (Some(Clearance { distance, nearest: None }), Some(surroundings)) = (&self.clearance, &self.surroundings)
        else {
            return known;
        };
        let Some(space) = surroundings.clear_space(robot)? else { return known };
        let least = least_clearance(&mut ClearanceSweep::new(space.scene()), &self.trajectory, Some(*distance))?;
        least.map_or(known, |(clearance, _)| Ok(Some(clearance)))
    }

    /// Returns the outcome and advice, as a sentence.
    pub fn message(&self) -> Message {
        if let Some(obstruction) = &self.obstruction {
            let advice = if self.reference.is_some() {
                message![ADVICE_ALONG_PATH, ", or ", Setting::Breaks]
            } else {
                self.advice()
            };
            return match self.own_points {
                Some(measured) => message![format!("no clear plan for {obstruction}; "), measured.advice()],
                None => message![format!("no clear plan for {obstruction}; "), advice],
            };
        }
        let cost = format!("{} of {} {}", self.objective.noun(), number(self.cost), self.objective.unit());
        match self.status {
            Status::Solved => format!(
                "planned with {cost}{}{}{}{}{}{}",
                self.clearance_in_words(),
                self.breaks_in_words(),
                self.freed_in_words(),
                JointOutside::in_words(&self.start_outside, "begins"),
                self.turned_in_words(),
                self.peak_in_words()
            )
            .into(),
            Status::Interrupted if self.violations.is_empty() => {
                message![format!("stopped with {cost}: "), self.status.advice()]
            }
            _ => message![
                format!("no plan keeps everything; the least violating one breaks: {}; ", self.broken()),
                self.advice(),
            ],
        }
    }

    /// Clearance of a certified motion, in words.
    fn clearance_in_words(&self) -> String {
        let clear = |around: &Surroundings| clear_in_words(self.clearance.as_ref(), around.first_open_mesh());
        match (&self.surroundings, &self.surroundings_but_for_touch) {
            (Some(around), _) => clear(around),
            // What is left out of a motion that begins in a contact has words of its own.
            (None, Some(around)) if self.freed.is_none() => {
                format!("{}; what its straight ends may touch is left out", clear(around))
            }
            _ => String::new(),
        }
    }

    fn breaks_in_words(&self) -> String {
        match &self.breaks[..] {
            [] => String::new(),
            [only] => format!("; the tool leaves the path once: {}", only.reason),
            [first, ..] => {
                format!("; the tool leaves the path {} times, the first time: {}", self.breaks.len(), first.reason)
            }
        }
    }

    fn freed_in_words(&self) -> String {
        self.freed.map_or_else(String::new, |Freed { clearance, until }| {
            let (clearance, until) = (number(clearance), number(until));
            format!("; it begins with a clearance of {clearance} m and keeps the margin after {until} s")
        })
    }

    fn turned_in_words(&self) -> String {
        let joint = |JointTurned { joint, value, given }: &JointTurned| {
            let turns = format!("at {} in place of {}, whole turns apart", number(*value), number(*given));
            format!("; joint '{joint}' goes the short way and ends {turns}")
        };
        self.end_turned.iter().map(joint).collect()
    }

    fn peak_in_words(&self) -> String {
        self.peak.as_ref().map_or_else(String::new, |Peak { joint, acceleration, unit }| {
            let acceleration = number(*acceleration);
            format!("; without an acceleration limit joint '{joint}' accelerates with up to {acceleration} {unit}")
        })
    }

    fn advice(&self) -> Message {
        let more = match (self.accuracy, &self.clearance) {
            (None, None) => " or wider limits".into(),
            (None, Some(_)) => ", a smaller margin, ends that are clear or wider limits".into(),
            (Some(_), _) => {
                message![", wider limits, a larger accuracy, or for ", Setting::Method("tpbso"), " denser points"]
            }
        };
        message!["try another seed, a larger ", Setting::Budget, more]
    }

    fn broken(&self) -> String {
        let mut named: Vec<String> = self.violations.iter().take(NAMED_IN_MESSAGE).map(Violation::to_string).collect();
        if let Some(more @ 1..) = self.violations.len().checked_sub(NAMED_IN_MESSAGE) {
            named.push(format!("and {more} more"));
        }
        named.join("; ")
    }
}

/// A clearance as two options: the distance, and the nearest bodies.
mod stored_clearance {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use crate::obstacle::{Clearance, NearestContact};

    pub fn serialize<S: Serializer>(clearance: &Option<Clearance>, serializer: S) -> Result<S::Ok, S::Error> {
        let (distance, nearest) = clearance.as_ref().map(|known| (known.distance, &known.nearest)).unzip();
        (distance, nearest.and_then(Option::as_ref)).serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Clearance>, D::Error> {
        let (distance, nearest): (Option<f64>, Option<NearestContact>) = Deserialize::deserialize(deserializer)?;
        Ok(distance.map(|distance| Clearance { distance, nearest }))
    }
}
