//! `Robot::from_urdf`: from a file or its text to a robot.

use std::string::FromUtf8Error;

use super::chain;
use super::document::Document;
use super::tree::Tree;
use crate::error::{Error, Result, shortened};
use crate::robot::Robot;

impl Robot {
    /// Reads a robot from a URDF file, or from the XML itself (a string that contains `<`).
    ///
    /// `base` and `tip` are link names. `None` means the root, and the only leaf below `base`. `base` need not be an
    /// ancestor of `tip`: joints passed from child to parent move by -q. Poses are in the frame of `base`.
    ///
    /// The independent joints are in chain order. A mimic joint on the chain follows its master, and its limits narrow
    /// the master's; a master that is not on the chain becomes an independent joint at the position of its first mimic
    /// joint. Only joints on the chain, and masters, are checked: an unsupported gripper does not prevent loading an
    /// arm.
    ///
    /// Limits: a revolute or prismatic joint with neither `lower` nor `upper` is unlimited (URDF's default of zero for
    /// both would lock it); if one is given, the other is zero, as URDF specifies. Without `velocity` the speed is
    /// unlimited; an explicit zero locks the joint. Soft limits (`<safety_controller>`) are ignored.
    ///
    /// Collision shapes of the links on the chain become [capsules](Robot::capsules) that enclose them: exact for
    /// spheres, with protruding caps for cylinders and boxes. Meshes are not read; [`Robot::unread_collision_shapes`]
    /// names them.
    ///
    /// # Errors
    /// [`Error::Unreadable`] for a file; [`Error::Urdf`], with the line where there is one, for text that is no URDF;
    /// [`Error::UnknownLink`] and [`Error::AmbiguousTip`] for base and tip; those of
    /// [`ChainBuilder::build`](crate::robot::ChainBuilder::build) for impossible limits.
    pub fn from_urdf(path_or_xml: &str, base: Option<&str>, tip: Option<&str>) -> Result<Self> {
        let document = if path_or_xml.contains('<') {
            Document::parse(path_or_xml)?
        } else {
            Document::parse(&read(path_or_xml)?)?
        };
        let tree = Tree::new(&document)?;
        let base = match base {
            Some(name) => tree.link(name)?,
            None => tree.root(),
        };
        let tip = match tip {
            Some(name) => tree.link(name)?,
            None => tree.only_leaf_below(base)?,
        };
        chain::build(&document, base, &tree.path(base, tip)?)
    }
}

fn read(path: &str) -> Result<String> {
    let bytes =
        std::fs::read(path).map_err(|error| Error::Unreadable { path: shortened(path), problem: error.to_string() })?;
    let text = String::from_utf8(bytes).map_err(|error| not_utf8(&error))?;
    if let Some(stem) = path.strip_suffix(".xacro") {
        let stem = stem.strip_suffix(".urdf").unwrap_or(stem);
        let problem = format!("'{path}' is a xacro file: run `xacro {path} > {stem}.urdf` and load the result");
        return Err(Error::Urdf { line: None, problem });
    }
    Ok(text)
}

fn not_utf8(error: &FromUtf8Error) -> Error {
    let (bytes, valid) = (error.as_bytes(), error.utf8_error().valid_up_to());
    let line = 1 + bytes[..valid].iter().filter(|byte| **byte == b'\n').count();
    let problem = format!("byte 0x{:02x} is not UTF-8; save the file with the encoding UTF-8", bytes[valid]);
    Error::Urdf { line: u32::try_from(line).ok(), problem }
}
