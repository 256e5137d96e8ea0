//! Robots from URDF. [`read`] is the entry point: [`document`] parses and checks the text, [`tree`] finds the joints from
//! base to tip, and [`chain`] builds the robot from them ([`step`]: one joint), with mimic joints ([`mimic`]), links beside
//! the chain ([`off_chain`]) and collision shapes ([`link_capsules`], [`bodies`]), whose files [`package`] locates.
//! [`inertial`] reads masses and friction; [`visuals`] are for pictures; [`rewrite`] writes a calibrated geometry back. [`srdf`] adds the content of an SRDF.

mod bodies;
mod chain;
mod document;
mod inertial;
mod link_capsules;
mod mimic;
mod off_chain;
mod package;
mod read;
mod rewrite;
mod srdf;
mod step;
mod tree;
mod visuals;
mod xml;

pub use bodies::CollisionShapes;
pub use read::UrdfOptions;
