//! Robots from URDF: the text is checked and reduced ([`document`]), its joints form a tree ([`tree`]), and the way
//! through the tree from base to tip becomes a chain ([`chain`]) in which mimic joints follow ([`mimic`]) and links take
//! up the room of their collision shapes ([`link_capsules`]).

mod chain;
mod document;
mod link_capsules;
mod mimic;
mod read;
mod tree;
mod xml;
