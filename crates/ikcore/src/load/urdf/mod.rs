//! Robots from URDF. [`read`] is the call, [`document`] checks the text and reduces it to links and joints, [`tree`]
//! finds the joints from base to tip, and [`chain`] builds the robot from them, with mimic joints ([`mimic`]) and
//! capsules around collision shapes ([`link_capsules`]).

mod chain;
mod document;
mod link_capsules;
mod mimic;
mod read;
mod tree;
mod xml;
