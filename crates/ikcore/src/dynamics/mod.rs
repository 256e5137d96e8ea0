//! Dynamics of a tree of rigid bodies as plain data: no names, limits or files, and no `Robot`.
//!
//! All vectors are in base axes, at frames that the kinematics has found; so any tree of stages is one loop. A body is its
//! mass, first moment and second moment about the origin of its frame, which add up over fixed joints.
//!
//! | file | contents |
//! |---|---|
//! | `inertia` | mass, centre and inertia matrix of a body, and which are possible |
//! | `mass_moments` | moments of a body, which add up |
//! | `rigid_bodies` | moving bodies of a robot, gravity, friction and rotors |
//! | `scratch`, `wide_vectors` | scratch memory and registers of the kernels |
//! | `inverse` | recursive Newton-Euler algorithm: the torques of a motion |
//! | `path_terms` | torques along a path, at four points at a time |
//! | `center_of_mass` | centre of all masses, and its Jacobian |
//! | `gravity` | torques that hold the bodies up |
//! | `holding_slope` | derivatives of those torques |
//! | `mass_matrix` | composite rigid body algorithm |
//! | `forward` | accelerations that torques cause |
//! | `rotation_vector_rate` | angular acceleration of a floating base |

mod center_of_mass;
mod forward;
mod gravity;
mod holding_slope;
mod inertia;
mod inverse;
mod mass_matrix;
mod mass_moments;
mod path_terms;
mod rigid_bodies;
mod rotation_vector_rate;
mod scratch;
mod wide_vectors;

pub use inertia::Inertia;
pub use inverse::{AppliedWrench, DynamicState};
pub(crate) use mass_moments::MassMoments;
pub(crate) use path_terms::{BodyOnPath, PathPoints, PathTerms};
pub(crate) use rigid_bodies::MovingBody;
pub use rigid_bodies::{Dynamics, JointDrive};
pub use scratch::DynamicsScratch;
