//! Constructor `Robot::from_urdf`: from a file or its text to a robot.

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::string::FromUtf8Error;

use super::bodies::{self, CollisionShapes};
use super::chain;
use super::document::Document;
use super::package::Packages;
use super::tree::Tree;
use super::visuals;
use crate::error::{Error, Result};
use crate::robot::Robot;
use crate::units::{self, UnitDoubt};

/// Options for loading a URDF.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct UrdfOptions {
    /// Link at the start of the chain; `None` means the root.
    pub base: Option<String>,
    /// Links at the ends of the chains, one for a robot with one tip; empty means the only leaf below the base.
    pub tips: Vec<String>,
    /// Values of joints beside the chain (rad, m); joints not listed are held at zero or at the limit nearest to zero.
    pub hold: Vec<(String, f64)>,
    /// Treatment of the collision shapes.
    pub collision: CollisionShapes,
    /// Folders with packages, searched first for `package://`; then `ROS_PACKAGE_PATH`, `AMENT_PREFIX_PATH` and the folders
    /// above the file are searched.
    pub package_dirs: Vec<String>,
    /// Folder that relative mesh names refer to; `None` means the folder of the file.
    pub directory: Option<PathBuf>,
    /// SRDF, as a file or text, for [`with_srdf`](Robot::with_srdf).
    pub srdf: Option<String>,
}

impl Robot {
    /// Reads a robot from a URDF file, or from the XML itself (a string that contains `<`).
    ///
    /// `base` and `tip` are link names. `None` means the root, and the only leaf below `base`. `base` need not be an ancestor
    /// of `tip`: joints passed from child to parent move by -q. Poses are in the frame of `base`.
    ///
    /// The independent joints are in chain order. A mimic joint on the chain follows its master, and its limits narrow the
    /// master's; a master that is not on the chain becomes an independent joint at the position of its first mimic joint.
    /// Only joints on the chain, and masters, are checked: an unsupported gripper does not prevent loading an arm.
    ///
    /// The links beside the chain are kept ([`all_link_names`](Robot::all_link_names)), and their joints
    /// [held](Robot::held_joints) at zero or at the limit nearest to zero; mimic joints beside the chain follow their
    /// masters. Floating, planar and spherical joints beside the chain stay in their origin.
    ///
    /// A revolute or prismatic joint of the chain needs a `<limit>`, as URDF specifies. With neither `lower` nor `upper` it is
    /// unlimited (URDF's default of zero for both would lock it), a revolute one continuous; if one is given, the other is zero,
    /// as URDF specifies. Without `velocity` the speed is unlimited; an explicit zero locks the joint. `acceleration`,
    /// `deceleration` and `jerk` of URDF 1.2 are rated limits ([`Limits::rated`](crate::limits::Limits::rated)); of acceleration
    /// and deceleration the smaller one counts. Soft limits (`<safety_controller>`) are ignored.
    ///
    /// Collision shapes of all links become enclosing capsules ([`Robot::bodies`]): exact for spheres, with protruding caps
    /// for cylinders and boxes. Meshes are read only with [`CollisionShapes::Fit`] or [`CollisionShapes::Hulls`];
    /// [`Robot::unread_collision_shapes`] lists the rest.
    ///
    /// # Errors
    /// [`Error::Unreadable`] for a file; [`Error::Urdf`], with the line where there is one, for text that is no URDF, which an
    /// [`Error::InFile`] holds if it is that of a file; [`Error::UnknownLink`] and [`Error::AmbiguousTip`] for base and tip; the errors of
    /// [`ChainBuilder::build`](crate::robot::ChainBuilder::build) for impossible limits.
    pub fn from_urdf(path_or_xml: &str, base: Option<&str>, tip: Option<&str>) -> Result<Self> {
        let tips = tip.into_iter().map(str::to_owned).collect();
        let options = UrdfOptions { base: base.map(str::to_owned), tips, ..UrdfOptions::default() };
        Self::from_urdf_with(path_or_xml, &options)
    }

    /// Reads a robot as [`from_urdf`](Self::from_urdf) does, with further options. With several tips the independent joints
    /// are those of all chains, one chain after another, shared joints once.
    ///
    /// # Errors
    /// Errors of [`from_urdf`](Self::from_urdf), [`with_held`](Self::with_held) and [`with_srdf`](Self::with_srdf).
    pub fn from_urdf_with(path_or_xml: &str, options: &UrdfOptions) -> Result<Self> {
        Self::read_urdf(path_or_xml, options).map(|(robot, _)| robot)
    }

    /// Reads a robot as [`from_urdf_with`](Self::from_urdf_with) does, and returns with it what looks like degrees or millimetres
    /// in the file.
    ///
    /// # Errors
    /// Errors of [`from_urdf_with`](Self::from_urdf_with).
    pub fn read_urdf(path_or_xml: &str, options: &UrdfOptions) -> Result<(Self, Vec<UnitDoubt>)> {
        let text = text_of(path_or_xml, read_urdf)?;
        let (robot, doubts) = described(&text, path_or_xml, options).map_err(|error| in_file(path_or_xml, error))?;
        let robot = match &options.srdf {
            None => robot,
            Some(srdf) => robot.with_srdf(srdf)?,
        };
        Ok((robot, doubts))
    }
}

/// The robot of a text, without SRDF; `path_or_xml` says which folder meshes are beside.
fn described(text: &str, path_or_xml: &str, options: &UrdfOptions) -> Result<(Robot, Vec<UnitDoubt>)> {
    let document = Document::parse(text)?;
    let tree = Tree::new(&document)?;
    let base = match &options.base {
        Some(name) => tree.link(name)?,
        None => tree.root(),
    };
    let tips = match &options.tips[..] {
        [] => vec![tree.only_leaf_below(base)?],
        names => names.iter().map(|name| tree.link(name)).collect::<Result<_>>()?,
    };
    let robot = chain::build(&document, &tree, base, &tips)?;
    let folder = Path::new(path_or_xml).parent().filter(|_| !is_text(path_or_xml));
    let packages = Packages::new(&options.package_dirs, options.directory.as_deref().or(folder));
    let robot = robot.with_bodies(bodies::of(&document, &robot, options.collision, &packages)?);
    let visuals = visuals::of(&document.visuals, &robot, &packages);
    let robot = robot.with_visuals(visuals);
    let robot = match &options.hold[..] {
        [] => robot,
        hold => robot.with_held(hold.iter().map(|(joint, value)| (joint.as_str(), *value)))?,
    };
    let doubts = units::of_limits(&robot).into_iter().chain(units::of_sizes(&robot)).chain(document.doubt());
    let doubts = doubts.collect();
    Ok((robot, doubts))
}

/// Whether this is the text of a file rather than its path.
pub(super) fn is_text(path_or_xml: &str) -> bool {
    path_or_xml.contains('<')
}

/// Returns the text itself if it contains `<`, otherwise the content of the file.
pub(super) fn text_of(path_or_xml: &str, read: impl Fn(&str) -> Result<String>) -> Result<Cow<'_, str>> {
    if is_text(path_or_xml) { Ok(Cow::Borrowed(path_or_xml)) } else { read(path_or_xml).map(Cow::Owned) }
}

/// Names the file of a URDF that was given by its path.
pub(super) fn in_file(path_or_xml: &str, error: Error) -> Error {
    if is_text(path_or_xml) { error } else { error.in_urdf_file(path_or_xml) }
}

pub(super) fn read(path: &str) -> Result<String> {
    let bytes = std::fs::read(path).map_err(|error| Error::unreadable(path, error))?;
    String::from_utf8(bytes).map_err(|error| not_utf8(&error).in_urdf_file(path))
}

pub(super) fn read_urdf(path: &str) -> Result<String> {
    let text = read(path)?;
    if let Some(stem) = path.strip_suffix(".xacro") {
        let stem = stem.strip_suffix(".urdf").unwrap_or(stem);
        let problem = format!("'{path}' is a xacro file: run `xacro {path} > {stem}.urdf` and load the result");
        return Err(Error::Urdf { line: None, problem: problem.into() });
    }
    Ok(text)
}

fn not_utf8(error: &FromUtf8Error) -> Error {
    let (bytes, valid) = (error.as_bytes(), error.utf8_error().valid_up_to());
    let line = 1 + bytes[..valid].iter().filter(|byte| **byte == b'\n').count();
    let problem = format!("byte 0x{:02x} is not UTF-8; save the file with the encoding UTF-8", bytes[valid]);
    Error::Urdf { line: u32::try_from(line).ok(), problem: problem.into() }
}
