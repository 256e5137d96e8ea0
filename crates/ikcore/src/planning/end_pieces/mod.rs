//! Pieces at both ends of a motion from point to point, each from rest to rest.
//!
//! | file | what |
//! |---|---|
//! | `composed` | the motion of all pieces |
//! | `straight_line` | [`StraightLine`]: direction, length and allowed contacts of a straight piece |
//! | `straight_tip` | joint motions with a straight line of the tip |
//! | `line_candidates` | the configurations of an end from which there is a clear one |
//! | `out_of_contact` | the way out of a contact at the start |
//! | `piece_space` | what the pieces keep clear of |

mod composed;
mod line_candidates;
mod out_of_contact;
mod piece_space;
mod straight_line;
mod straight_tip;

pub(super) use composed::composed;
pub use straight_line::{LineContact, LineFrame, StraightLine};
