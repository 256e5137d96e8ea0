//! Bounds on the distance of a tip from the straight line between its positions at both ends of a joint motion.

use smallvec::SmallVec;

use crate::kinematics::chain::Transmission;
use crate::math::Frame;
use crate::obstacle::sagitta_along;
use crate::robot::Robot;
use crate::task::Subject;

/// Bounds of a joint motion from one configuration to another.
#[derive(Debug, Clone, Copy)]
pub(super) struct TipBend {
    /// Distance (m) of the origin from the straight line between both places.
    pub point: f64,
    /// Distance of the end of a unit vector, carried along, from the straight line between both places.
    pub direction: f64,
    /// Angle (rad) that all joints turn the frame by in all, on the straight line between both configurations ...
    pub turn: f64,
    /// ... and off it.
    pub turn_off_line: f64,
    /// Whether all joints stay on that line.
    pub is_straight: bool,
}

/// Moving elements between the frame that a subject is seen from and its own, the outermost first: the number of the frame that each
/// moves, and its motion.
type Carriers<'a> = SmallVec<[(usize, &'a Transmission); 32]>;

/// The moving elements that change how a subject is seen.
///
/// A pair of tips is a chain from one tip to the other: in the frame of the first, its own joints move everything behind them, and
/// those that carry both move nothing.
fn carriers<'a>(robot: &'a Robot, subject: &Subject) -> Carriers<'a> {
    match *subject {
        Subject::Tip(of) => robot.carriers(robot.frame_of_tip(of), 0).collect(),
        Subject::Pair { from, of } => {
            let (base, end) = (robot.frame_of_tip(from), robot.frame_of_tip(of));
            let meeting = robot.meeting_frame(base, end);
            let mut all: Carriers<'a> = robot.carriers(end, meeting).collect();
            let own: Carriers<'a> = robot.carriers(base, meeting).collect();
            all.extend(own.into_iter().rev());
            all
        }
        // `Keep` takes none.
        Subject::CenterOfMass => Carriers::new(),
    }
}

impl TipBend {
    /// Bounds for the frame of `subject` with its origin at `origin` (m, in the base) and the moving elements at `frames`, while the
    /// joints change by `change` (rad, m) and get off the straight line by `off_line` at most.
    pub fn of(
        robot: &Robot,
        subject: &Subject,
        (origin, frames): (&[f64; 3], &[Frame]),
        [change, off_line]: [&[f64]; 2],
    ) -> Self {
        let carriers = carriers(robot, subject);
        let turned = |reach: &[f64]| carriers.iter().map(|(_, motion)| motion.travel(reach)[0]).sum::<f64>();
        let (turn, turn_off_line) = (turned(change), turned(off_line));
        // Along a straight line in joint space a unit vector v changes by v' = w x v, with |w| <= turn, and |w'| <= turn^2 / 2, so
        // that |v''| <= turn^2 for directions that turn about one axis alone, and no more in general: see `sagitta_along`.
        // Polynomial couplings add their second derivatives to w'.
        let bent: f64 = carriers.iter().map(|(_, motion)| motion.bent(change)[0]).sum();
        let direction = (turn * turn + bent) / 8.0 + turn_off_line;
        let point = sagitta_along(carriers.iter().copied(), frames, origin, [change, off_line]);
        let is_straight = off_line.iter().all(|off| *off == 0.0);
        Self { point, direction, turn, turn_off_line, is_straight }
    }
}
