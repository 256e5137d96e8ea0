//! Pieces at both ends of a motion from point to point, each from rest to rest.
//!
//! | file | what |
//! |---|---|
//! | `composed` | the motion of all pieces |
//! | `straight_tip` | joint motions with a straight line of the tip |
//! | `line_candidates` | the configurations of an end from which there is a clear one |
//! | `out_of_contact` | the way out of a contact at the start |

mod composed;
mod line_candidates;
mod out_of_contact;
mod straight_tip;

pub(crate) use composed::composed;
