//! The robot: joints with limits, links, base, tool and bodies. Immutable, validated once, shared without locks.
//!
//! Kernels are in [`kinematics`](crate::kinematics), files and named robots in [`load`](crate::load). Read [`Robot`] first.
//!
//! | file | what |
//! |---|---|
//! | `joint`, `description`, `builder` | from joints and elements to a robot |
//! | `off_chain` | links that branch off the chain, and held joints |
//! | `model`, `parts` | [`Robot`], and what determines one |
//! | `kinematics`, `batched` | kinematics of one configuration, and of many |
//! | `links` | kinematics of any link |
//! | `tips`, `tip_chain`, `arms` | several tips: the kinematics of each, their chains, what moves one alone |
//! | `body`, `link_capsule`, `bodies` | bodies on the links, and capsules around them |
//! | `attached` | things that a link carries |
//! | `pair_rule`, `pairs`, `pair_sampling` | links that are tested against each other |
//! | `upright_axis` | a vertical first axis |
//! | `mobile_base` | a robot on a base that moves |
//! | `measured_geometry` | a robot with other transforms and offsets, as a calibration finds them |
//! | `masses`, `dynamics` | masses of the links, payloads and gravity, folded into moving bodies |
//! | `torques` | torques, mass matrices and accelerations of one configuration, and of many |
//! | `manufacturing_errors` | a robot with random manufacturing errors |
//! | `stance` | named configurations |
//! | `visual` | how links look |
//! | `serialization` | robots as bytes |
//! | `named_values` | joint values by name |
//! | `wrapped` | the same posture at other whole turns |

mod arms;
mod attached;
mod batched;
mod bodies;
mod body;
mod builder;
mod description;
mod dynamics;
mod joint;
mod kinematics;
mod link_capsule;
mod links;
mod manufacturing_errors;
mod masses;
mod measured_geometry;
mod mobile_base;
mod model;
mod named_values;
mod off_chain;
mod pair_rule;
mod pair_sampling;
mod pairs;
mod parts;
mod serialization;
mod stance;
mod tip_chain;
mod tips;
mod torques;
mod upright_axis;
mod visual;
mod wrapped;

pub(crate) use arms::Choice;
pub(crate) use body::Bodies;
pub use body::{Body, BodySource};
pub use builder::ChainBuilder;
pub(crate) use description::require_supported;
pub use description::{Drive, Element};
pub use joint::{Joint, JointKind};
pub(crate) use joint::{limit_rounding, outside_limits, play, position_unit, way_inside};
pub use link_capsule::{LinkCapsule, LinkMesh, MeshFit};
pub use masses::LinkInertia;
pub(crate) use masses::{InertiaFault, Masses};
pub use mobile_base::{BaseLimits, MobileBase};
pub use model::Robot;
pub use stance::Stance;
pub use torques::Motions;
pub use upright_axis::UprightAxis;
pub use visual::{Visual, VisualShape};

pub use off_chain::HeldJoint;
pub(crate) use off_chain::{OffChain, OffChainLink};
