//! Robots from URDF. [`read`] is the call, [`document`] checks the text and reduces it to links and joints, [`tree`]
//! finds the joints from base to tip, and [`chain`] builds the robot from them ([`step`]: one joint), with mimic joints ([`mimic`]), the
//! links beside the chain ([`off_chain`]) and capsules around collision shapes ([`link_capsules`], [`bodies`]), whose files
//! [`package`] finds. [`visuals`] are
//! for pictures. [`srdf`] adds what an SRDF says.

mod bodies;
mod chain;
mod document;
mod link_capsules;
mod mimic;
mod off_chain;
mod package;
mod read;
mod srdf;
mod step;
mod tree;
mod visuals;
mod xml;

pub use bodies::CollisionShapes;
pub use read::UrdfOptions;
