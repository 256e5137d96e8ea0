//! Dynamics of a tree of rigid bodies as plain data: no names, limits or files, and no `Robot`.
//!
//! All vectors are in base axes, at frames that the kinematics has found; so any tree of stages is one loop. A body is its
//! mass, first moment and second moment about the origin of its frame, which add up over fixed joints.
//!
//! | file | contents |
//! |---|---|
//! | `inertia` | mass, centre and inertia matrix of a body, and which are possible |
//! | `mass_moments` | moments of a body, which add up |
//! | `bodies` | moving bodies of a robot, gravity, friction and rotors |
//! | `inverse` | recursive Newton-Euler algorithm: the torques of a motion |
//! | `rotation_vector_rate` | angular acceleration of a floating base |

mod bodies;
mod inertia;
mod inverse;
mod mass_moments;
mod rotation_vector_rate;

pub(crate) use bodies::MovingBody;
pub use bodies::{Dynamics, JointDrive};
pub use inertia::Inertia;
pub use inverse::{AppliedWrench, DynamicsScratch, MotionState};
pub(crate) use mass_moments::MassMoments;
