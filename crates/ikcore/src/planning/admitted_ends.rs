//! The gate of a motion from point to point: its start and ends as the caller reads them.

use crate::error::Result;
use crate::limits::{JointOutside, Limits};
use crate::plan::{EndTurns, Endpoint, JointTurned, Plan, PointToPointMethod, PointToPointOptions};
use crate::robot::Robot;
use crate::timing::ConstantLimits;

/// Start and ends without rounding beyond the limits, and the joints of the start that are outside.
pub(super) struct AdmittedEnds {
    pub start: Endpoint,
    pub ends: Vec<Endpoint>,
    outside: Vec<JointOutside>,
}

impl AdmittedEnds {
    /// Takes the start within its slack. Ends outside the limits stay as they are: the planner passes them over or refuses them.
    ///
    /// # Errors
    /// [`Error::OutsideLimits`](crate::Error::OutsideLimits) for the start; those of the limits.
    pub fn read(robot: &Robot, start: &Endpoint, ends: &[Endpoint], options: &PointToPointOptions) -> Result<Self> {
        let constant = ConstantLimits::for_robot(robot, options.limits.as_ref(), options.method.named())?;
        let limits = constant.position_limits(robot)?;
        let mut admitted = Self { start: start.clone(), ends: vec![], outside: vec![] };
        if let Endpoint::Configuration(q) = start {
            let taken = limits.admit_start(Some(robot), "start_q", q, &options.start_slack)?;
            (admitted.start, admitted.outside) = (Endpoint::Configuration(taken.q), taken.outside);
        }
        admitted.ends = ends.iter().map(|end| without_rounding(robot, &limits, end)).collect();
        if joins_given_ends(options)
            && let Endpoint::Configuration(from) = &admitted.start
        {
            for end in &mut admitted.ends {
                if let Endpoint::Configuration(q) = end {
                    robot.turn_near([&constant.lower, &constant.upper], from, q);
                }
            }
        }
        Ok(admitted)
    }

    /// Notes in `plan`, to one of the ends as `given`, what the motion does with its start and end.
    pub fn note(self, robot: &Robot, given: &[Endpoint], plan: &mut Plan) {
        plan.start_outside = self.outside;
        let Some(Endpoint::Configuration(q)) = plan.chosen_end.and_then(|chosen| given.get(chosen)) else { return };
        let last = plan.trajectory.end();
        let turned = |j: &usize| {
            let period = robot.turn_period(*j).filter(|_| robot.joints()[*j].kind.turns());
            period.is_some_and(|period| (last[*j] - q[*j]).abs() > 0.5 * period)
        };
        let joint = |j: usize| JointTurned { joint: robot.joints()[j].name.clone(), value: last[j], given: q[j] };
        plan.end_turned = (0..last.len()).filter(turned).map(joint).collect();
    }
}

/// Whether a planner joins the ends as they are given, so that their whole turns are chosen before: one that joins pieces, and that
/// of the paper.
fn joins_given_ends(options: &PointToPointOptions) -> bool {
    options.end_turns == EndTurns::Nearest
        && (options.has_pieces() || matches!(options.method, PointToPointMethod::Tpbso(_)))
}

fn without_rounding(robot: &Robot, limits: &Limits, end: &Endpoint) -> Endpoint {
    match end {
        Endpoint::Configuration(q) => {
            limits.admit(Some(robot), "end_q", q).map_or(end.clone(), Endpoint::Configuration)
        }
        Endpoint::Targets { .. } => end.clone(),
    }
}
