//! Plans along a path that keep clear of obstacles and of the arm itself.
//!
//! Each point of the path gets a layer of candidate postures; those that are not clear are left out. The cheapest
//! sequence of candidates, one in each layer, is smoothed along the self-motion, improved and timed as without obstacles
//! ([`timed`](super::timed)), and certified between the points too. Where the certificate fails, more clearance is kept
//! and the search goes on.
//!
//! | file | what |
//! |---|---|
//! | `clear_planner` | the planner |
//! | `postures` | candidate postures: branches, samples of the self-motion, motions from random starts |
//! | `passage` | whether a posture is clear, and whether the arm gets from one to the next |
//! | `price` | the cost of a step |
//! | `sequence` | the cheapest sequence through the layers |
//! | `smoothing` | shorter steps, by postures between |
//! | `dead_end` | why there is no clear motion |
//! | `path_end` | why the arm cannot follow a path any farther |
//! | `stretches` | the fewest stretches of a path that the arm follows without leaving it |

mod clear_planner;
mod dead_end;
mod passage;
mod path_end;
mod postures;
mod price;
mod sequence;
mod smoothing;
mod stretches;

pub(crate) use clear_planner::{along_path, along_stretch};
pub(crate) use stretches::{Stretch, Stretches, stretches};
