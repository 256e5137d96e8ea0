//! The path of the tip between two stops: lines, arcs and rounded corners, by its length.

use super::corner::Corner;
use super::leg::Leg;
use super::program::Move;
use crate::error::{Error, Result};
use crate::math::{Frame, Pose};
use crate::wording::number;

/// Excess of blends over the length of a move that counts as rounding, relative to the length.
pub(super) const ROUNDING: f64 = 1e-9;

/// Pieces shorter than this fraction of their move are left out: blends meet there.
const NEGLIGIBLE: f64 = 1e-6;

/// A part of the path.
#[derive(Debug, Clone)]
pub(super) struct ToolPiece {
    /// Index of its move; of the first of two for a corner.
    pub index: usize,
    /// Length (m) along that move at which it begins.
    pub from: f64,
    /// Length (m).
    pub length: f64,
    /// Largest speed of the tip (m/s).
    pub speed: Option<f64>,
    course: Course,
}

#[derive(Debug, Clone)]
enum Course {
    Leg(Leg),
    Corner(Corner),
}

impl ToolPiece {
    /// Whether it is a rounded corner.
    pub fn is_corner(&self) -> bool {
        matches!(self.course, Course::Corner(_))
    }

    /// Length (m) over which the tip turns by a radian.
    pub fn length_per_turn(&self) -> f64 {
        match &self.course {
            Course::Leg(leg) => {
                let bend = leg.at(0.0)[2].norm();
                1.0 / bend.max(leg.rate.norm()).max(f64::MIN_POSITIVE)
            }
            Course::Corner(_) => self.length,
        }
    }

    fn pose(&self, s: f64) -> Pose {
        match &self.course {
            Course::Leg(leg) => leg.pose(self.from + s),
            Course::Corner(corner) => {
                let (position, rotation) = corner.at(s);
                Pose::from_parts(position.into(), rotation)
            }
        }
    }
}

/// The path of the tip from one stop to the next.
#[derive(Debug, Clone)]
pub(super) struct ToolPath {
    /// Number of the tip.
    pub tip: usize,
    /// Its parts, in order.
    pub pieces: Vec<ToolPiece>,
    /// Length from the start to the begin of each piece, and the whole length (m).
    pub breaks: Vec<f64>,
}

impl ToolPath {
    /// The path of tip number `tip` along `legs`; `moves` is the whole program, of whose blends all but the last leg's count.
    ///
    /// # Errors
    /// [`Error::InvalidMove`] for blends that do not fit.
    pub fn along(tip: usize, legs: Vec<Leg>, moves: &[Move]) -> Result<Self> {
        let mut pieces = Vec::with_capacity(2 * legs.len());
        let mut entered = 0.0;
        for (i, leg) in legs.iter().enumerate() {
            let Some(next) = legs.get(i + 1) else {
                push_leg(&mut pieces, leg, entered, leg.length);
                break;
            };
            let radius = moves[leg.index].blend;
            let wrong = |problem: String| Error::InvalidMove {
                what: moves[leg.index].named(leg.index),
                problem: problem.into(),
            };
            let [cut, next_cut] = [leg, next].map(|leg| leg.length_within(radius));
            require_room(leg, [entered, cut], radius, moves, &wrong)?;
            require_room(next, [next_cut, 0.0], radius, moves, &wrong)?;
            let left = (leg.length - cut).max(entered);
            let corner = Corner::between(leg, left, next, next_cut, radius);
            push_leg(&mut pieces, leg, entered, left);
            let speed = leg.speed.zip(next.speed).map(|(before, after)| before.max(after));
            let (index, length) = (leg.index, corner.length());
            pieces.push(ToolPiece { index, from: left, length, speed, course: Course::Corner(corner) });
            entered = next_cut;
        }
        let mut breaks = vec![0.0];
        for piece in &pieces {
            breaks.push(breaks[breaks.len() - 1] + piece.length);
        }
        Ok(Self { tip, pieces, breaks })
    }

    /// Whole length (m).
    pub fn length(&self) -> f64 {
        self.breaks[self.pieces.len()]
    }

    /// The piece at the length `s`.
    pub fn piece_at(&self, s: f64) -> usize {
        self.breaks.partition_point(|begin| *begin <= s).clamp(1, self.pieces.len()) - 1
    }

    /// The move at the length `s`, and the length along that move.
    pub fn place_on_move(&self, s: f64) -> (usize, f64) {
        let i = self.piece_at(s);
        let piece = &self.pieces[i];
        (piece.index, piece.from + s - self.breaks[i])
    }

    /// Pose of the tip at the length `s`.
    pub fn pose(&self, s: f64) -> Frame {
        let piece = self.piece_at(s);
        Frame::from(&self.pieces[piece].pose(s - self.breaks[piece]))
    }

    /// Length at which each move ends: the middle of its corner, or the end of the path. In order of the moves.
    pub fn ends_of_moves(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let corners = self.pieces.iter().zip(&self.breaks).filter(|(piece, _)| piece.is_corner());
        let last = &self.pieces[self.pieces.len() - 1];
        // A corner that takes all of the last move ends the path.
        let last = last.index + usize::from(last.is_corner());
        corners.map(|(piece, begin)| (piece.index, begin + 0.5 * piece.length)).chain([(last, self.length())])
    }
}

fn push_leg(pieces: &mut Vec<ToolPiece>, leg: &Leg, from: f64, to: f64) {
    if to - from > NEGLIGIBLE * leg.length {
        let Leg { index, speed, .. } = *leg;
        pieces.push(ToolPiece { index, from, length: to - from, speed, course: Course::Leg(leg.clone()) });
    }
}

/// Checks that both blends of a leg fit into it.
fn require_room(
    leg: &Leg,
    [before, after]: [f64; 2],
    radius: f64,
    moves: &[Move],
    wrong: &impl Fn(String) -> Error,
) -> Result<()> {
    let (named, length) = (moves[leg.index].named(leg.index), leg.length);
    if leg.turns_on_the_spot() {
        return Err(wrong(format!(
            "its blend of {radius} m has no room, because {named} turns the tip on the spot: give no blend"
        )));
    }
    if before + after <= length * (1.0 + ROUNDING) {
        return Ok(());
    }
    let other = if before > 0.0 && after > 0.0 { ", with the blend at its other end," } else { "" };
    Err(wrong(format!(
        "its blend of {radius} m{other} does not fit into {named}, which is {} m long: make the blend smaller",
        number(length)
    )))
}
