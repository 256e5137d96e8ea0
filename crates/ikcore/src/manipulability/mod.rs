//! Manipulability: Yoshikawa's index, its exact gradient, the ellipsoid of tip velocities, and the index of every link.
//!
//! Unit joint speeds, |q'| = 1, give the tip velocities in an ellipsoid whose semi-axes are the singular values of the
//! Jacobian. Their product is Yoshikawa's index w = sqrt(det(J J')) (1985).
//!
//! | file | what |
//! |---|---|
//! | `motion` | [`Motion`]: velocities, angular velocities or both |
//! | `index` | [`Manipulability`]: the index |
//! | `gram` | the index away from singularities, without singular values |
//! | `gradient` | its gradient |
//! | `links` | the index of the end of every link, and its gradient |
//! | `ellipsoid` | [`Ellipsoid`]: semi-axes, condition, isotropy |

mod ellipsoid;
mod gradient;
mod gram;
mod index;
mod links;
mod motion;

pub use ellipsoid::Ellipsoid;
pub use index::{Manipulability, manipulability, manipulability_all};
pub use links::LinkIndices;
pub use motion::Motion;
