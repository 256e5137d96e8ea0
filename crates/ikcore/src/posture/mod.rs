//! Best posture of a planar arm for a tip position, by the published swarm and by differential evolution.
//!
//! The source is "Trajectory tracking of redundant manipulator based on PSO algorithm optimization", section 2.5: with the tip
//! at E, the first joint point is on the circle about the base, the last on the circle about E, with the link lengths as radii.
//! For other arms, and for poses, see [`Prefer::Best`](crate::ik::Prefer::Best).
//!
//! | file | what |
//! |---|---|
//! | `linkage` | joint points, their circles, the index of a posture |
//! | `circle_swarm` | particle swarm over joint points, as published |
//! | `best_posture` | the call, and differential evolution over the directions of the links |

mod best_posture;
mod circle_swarm;
mod linkage;

pub use best_posture::{Posture, PostureOptions, best_posture};
pub use circle_swarm::CircleSwarm;
pub use linkage::{Linkage, Measure, Rectangle};
