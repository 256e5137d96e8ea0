//! Constructors of `Robot`: URDF, Denavit-Hartenberg tables, planar arms, built-in robots.

use std::path::{Path, PathBuf};

use ikcore::Error;
use ikcore::load::{CollisionShapes, Dh, DhTable, UrdfOptions};
use ikcore::robot::{JointKind, Robot};
use ikcore::units;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyString};

use super::PyRobot;
use super::modified_copies::{per_joint, read_hold};
use crate::convert::{optional_text, path_or_text, rigid, summary, text, vector};
use crate::error::{invalid, raise};
use crate::monitor::on_a_thread;
use crate::python_calls;
use crate::units::doubt;

#[pymethods]
impl PyRobot {
    /// Makes a robot from a URDF file or a string of XML. Links and joints beside the chain are kept: see `all_link_names` and
    /// `held_joints`.
    ///
    /// Args:
    ///     path_or_xml: a file, or text that contains "<". A file of xacro is expanded by the package xacro, of the extra
    ///         "robots".
    ///     base: link whose frame is the reference frame; None: the root. It need not be an ancestor of `tip`.
    ///     tip: link at the end of the chain, or a list of several, for example ["left_tool", "right_tool"]; None: the
    ///         only leaf. With several tips, q holds the joints of one chain after another, shared joints once.
    ///     hold: values (rad, m) of joints beside the chain, for example {"finger_joint": 0.04}; the others are held at
    ///         zero, or at the limit nearest to zero.
    ///     srdf: an SRDF, file or text, whose disabled pairs of links are not tested against each other, see `with_srdf`.
    ///     collision: treatment of collision shapes. "primitives": spheres, cylinders, capsules and boxes become
    ///         capsules that enclose them; meshes are listed in `unread_collision_shapes`. "fit": in
    ///         addition, each mesh (STL, OBJ, DAE) becomes a few capsules that enclose it; `mesh_fits` gives their
    ///         quality. The fits are kept in the user's cache directory. "hulls": meshes become their convex hulls, and
    ///         the other shapes keep their form: closer than capsules, and slower. None: no shape is read.
    ///     package_dirs: folders that are searched first for `package://`, before the variables ROS_PACKAGE_PATH and
    ///         AMENT_PREFIX_PATH and the folders above the file.
    ///     trusted: whether a xacro file may do everything that xacro offers: execute any expression, read the
    ///         environment and any file. False: the file may come from anyone; whatever the page on robots does not
    ///         list is refused.
    ///
    /// Joints may be revolute, continuous, prismatic, fixed or mimic. Visuals and unknown tags are ignored, and so is
    /// `safety_controller`. A revolute or prismatic joint of the chain needs a `<limit>`; one without lower and upper is
    /// unlimited, and continuous if it turns. Velocity limits may be missing; zero locks the joint. Acceleration,
    /// deceleration (the smaller of both counts) and jerk of URDF 1.2 are in `rated_limits`.
    ///
    /// Raises:
    ///     UrdfError: not XML, no joint, a cycle, two roots, a zero axis, a joint without `<limit>`, or several leaves and
    ///         no `tip`.
    ///     UnknownNameError: no link of that name; the message lists them.
    #[staticmethod]
    #[pyo3(signature = (path_or_xml, *, base=None, tip=None, hold=None, srdf=None, collision=Some("primitives"),
                        package_dirs=None, trusted=false),
           text_signature = "(path_or_xml, *, base=None, tip=None, hold=None, srdf=None, collision='primitives', package_dirs=None, trusted=False)")]
    #[allow(clippy::too_many_arguments)]
    fn from_urdf(
        path_or_xml: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = optional_text)] base: Option<&str>,
        tip: Option<&Bound<'_, PyAny>>,
        hold: Option<&Bound<'_, PyAny>>,
        srdf: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = collision_name)] collision: Option<&str>,
        package_dirs: Option<&Bound<'_, PyAny>>,
        trusted: bool,
    ) -> PyResult<Self> {
        let py = path_or_xml.py();
        let mut source = path_or_text("path_or_xml", path_or_xml)?;
        let package_dirs = package_dirs.map_or(Ok(vec![]), read_folders)?;
        if Robot::names().any(|name| name == source) && !Path::new(&source).exists() {
            return Err(invalid(format!("there is no file '{source}'; Robot.named('{source}') is a built-in robot")));
        }
        let mut xacro = None;
        if is_xacro(&source) {
            xacro = Some(source.clone());
            source = python_calls::expand_xacro(py, &source, &package_dirs, trusted)?;
        }
        let options = UrdfOptions {
            base: base.map(str::to_owned),
            tips: tip.map_or(Ok(vec![]), read_tips)?,
            hold: hold.map_or(Ok(vec![]), read_hold)?,
            srdf: srdf.map(|srdf| path_or_text("srdf", srdf)).transpose()?,
            collision: read_collision(collision)?,
            package_dirs,
            directory: xacro.as_deref().and_then(|file| Path::new(file).parent()).map(Path::to_path_buf),
        };
        let expanded = xacro.map(|file| format!("{file}, expanded"));
        let in_file = move |error: Error| expanded.iter().fold(error, |error, file| error.in_urdf_file(file));
        let (robot, doubts) = on_a_thread(py, move || Robot::read_urdf(&source, &options).map_err(in_file))?;
        doubt(doubts)?;
        Ok(robot.into())
    }

    /// Makes a robot from a MuJoCo model, as compiled by MuJoCo. Joint positions equal MuJoCo's qpos. Needs the extra "sim".
    ///
    /// Args:
    ///     model: an MJCF file, text that contains "<", or a `mujoco.MjModel`.
    ///     base: body whose frame is the reference frame; None: "world".
    ///     tip: body or site at the end of the chain, or a list of several; None: the only leaf body.
    ///     hold, collision: as in `from_urdf`.
    ///     trusted: whether the model may use plugins, and files outside its folder. False: the model may come from
    ///         anyone.
    ///
    /// Hinges and slides keep their ranges; MuJoCo has no velocity limits. These equality constraints are followed: couplings of
    /// two joints by a polynomial, those of fixed tendons that are linear, locks, and whatever follows from these, such as a parallelogram.
    /// Joints beside the chain are held at their reference positions, where loops of a gripper are closed. A
    /// `UserWarning` names an equality that held joints do not keep. Geoms that collide become bodies, except
    /// ellipsoids, planes and height fields, which are listed in `unread_collision_shapes`.
    ///
    /// Raises:
    ///     BeetleIkError: MuJoCo is not installed.
    ///     UnknownNameError: no body or site of that name; the message lists them.
    ///     InvalidInputError: a model that MuJoCo cannot read, a ball or free joint on the chain, or an equality (connect,
    ///         weld, tendon) that joints of the chain do not keep.
    #[staticmethod]
    #[pyo3(signature = (model, *, base=None, tip=None, hold=None, collision=Some("primitives"), trusted=false),
           text_signature = "(model, *, base=None, tip=None, hold=None, collision='primitives', trusted=False)")]
    fn from_mjcf<'py>(
        model: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = optional_text)] base: Option<&str>,
        tip: Option<&Bound<'py, PyAny>>,
        hold: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = collision_name)] collision: Option<&str>,
        trusted: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        read_collision(collision)?;
        let tip = tip.map_or(Ok(vec![]), read_tips)?;
        python_calls::robot(model.py(), "mjcf", (model, base, tip, hold, collision, trusted))
    }

    /// Doubts limits that a MuJoCo model gives in degrees by default.
    fn _doubt_degrees(&self) -> PyResult<()> {
        doubt(units::of_converted_limits(&self.core))
    }

    /// Makes a robot by its name in the package example-robot-data, if that is installed, or robot_descriptions, for
    /// example "panda_description" or "panda_mj_description", which downloads it at first use. Needs the extra
    /// "robots".
    ///
    /// Args:
    ///     name: a name of robot_descriptions; of example-robot-data, that of a folder or of a URDF.
    ///     base, tip, hold: as in `from_urdf`.
    ///     srdf, collision: as in `from_urdf`; None: the default of that constructor. MuJoCo models take no SRDF.
    ///     trusted: as in `from_urdf` and `from_mjcf`.
    ///
    /// Raises:
    ///     BeetleIkError: robot_descriptions is not installed, or cannot download the description.
    ///     UnknownNameError: no description of that name; the message names the nearest.
    #[staticmethod]
    #[pyo3(signature = (name, *, base=None, tip=None, hold=None, srdf=None, collision=None, trusted=false))]
    fn from_description<'py>(
        name: &Bound<'py, PyAny>,
        base: Option<&Bound<'py, PyAny>>,
        tip: Option<&Bound<'py, PyAny>>,
        hold: Option<&Bound<'py, PyAny>>,
        srdf: Option<&Bound<'py, PyAny>>,
        collision: Option<&Bound<'py, PyAny>>,
        trusted: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let given = [("base", base), ("tip", tip), ("hold", hold), ("srdf", srdf), ("collision", collision)];
        let given = given.into_iter().filter_map(|(option, value)| Some((option, value?)));
        python_calls::robot(name.py(), "descriptions", (name, given.into_py_dict(name.py())?, trusted))
    }

    /// Makes a robot from Denavit-Hartenberg parameters, one row per joint.
    ///
    /// Args:
    ///     a, alpha, d: link length (m), twist (rad), offset (m), each (n,).
    ///     theta: constant offset of a revolute joint, or fixed angle of a prismatic joint (rad), (n,); None: zeros.
    ///     kinds: "revolute", "continuous" or "prismatic" for each joint; None: all revolute.
    ///     convention: "modified" (Craig: a and alpha of the previous link) or "standard".
    ///     lower, upper, velocity: limits (rad, m; rad/s, m/s), a number or (n,); None: no limit.
    ///     base, tool: poses (4, 4) before the first frame and after the last one.
    ///     name: the robot's name.
    #[staticmethod]
    #[pyo3(signature = (*, a, alpha, d, theta=None, kinds=None, convention="modified", lower=None, upper=None,
                        velocity=None, base=None, tool=None, name=None))]
    #[allow(clippy::too_many_arguments)]
    fn from_dh(
        a: &Bound<'_, PyAny>,
        alpha: &Bound<'_, PyAny>,
        d: &Bound<'_, PyAny>,
        theta: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = crate::convert::optional_texts)] kinds: Option<Vec<String>>,
        #[pyo3(from_py_with = text)] convention: &str,
        lower: Option<&Bound<'_, PyAny>>,
        upper: Option<&Bound<'_, PyAny>>,
        velocity: Option<&Bound<'_, PyAny>>,
        base: Option<&Bound<'_, PyAny>>,
        tool: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = optional_text)] name: Option<&str>,
    ) -> PyResult<Self> {
        let convention: Dh = convention.parse().map_err(raise)?;
        let mut table = DhTable::new(convention, vector("a", a)?, vector("alpha", alpha)?, vector("d", d)?);
        let n = table.a.len();
        if let Some(theta) = theta {
            table.theta = vector("theta", theta)?;
        }
        if let Some(kinds) = kinds {
            table.kinds =
                kinds.iter().map(|kind| kind.parse::<JointKind>()).collect::<Result<_, _>>().map_err(raise)?;
        }
        for (what, value, field) in [
            ("lower", lower, &mut table.lower),
            ("upper", upper, &mut table.upper),
            ("velocity", velocity, &mut table.velocity),
        ] {
            if let Some(value) = value {
                *field = per_joint(what, value, n)?;
            }
        }
        if let Some(base) = base {
            table.base = rigid("base", base)?;
        }
        if let Some(tool) = tool {
            table.tool = rigid("tool", tool)?;
        }
        let robot = Robot::from_dh(name.unwrap_or("dh"), &table).map_err(raise)?;
        let angles = [("alpha", &table.alpha), ("theta", &table.theta)];
        doubt(angles.into_iter().filter_map(|(what, angles)| units::of_dh_angles(what, angles)))?;
        doubt(units::of_limits(&robot).into_iter().chain(units::of_sizes(&robot)))?;
        Ok(robot.into())
    }

    /// Makes a planar arm of revolute joints in the x-y plane, with its base at the origin.
    ///
    /// Args:
    ///     lengths: link lengths (m), (n,).
    ///     lower, upper, velocity: limits (rad, rad/s), a number or (n,); None: -pi, pi and no velocity limit.
    #[staticmethod]
    #[pyo3(signature = (lengths, *, lower=None, upper=None, velocity=None))]
    fn planar(
        lengths: &Bound<'_, PyAny>,
        lower: Option<&Bound<'_, PyAny>>,
        upper: Option<&Bound<'_, PyAny>>,
        velocity: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let robot = Self::from(Robot::planar(&vector("lengths", lengths)?).map_err(raise)?);
        doubt(units::of_sizes(&robot.core))?;
        robot.with_limits(lower, upper, velocity)
    }

    /// Returns a built-in robot; `Robot.names()` lists them. Names of descriptions are found too, see `from_description`.
    ///
    /// Raises:
    ///     UnknownNameError: lists the names and suggests the nearest.
    #[staticmethod]
    fn named<'py>(name: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let py = name.py();
        let Ok(text) = name.extract::<String>() else {
            let (got, known) = (summary(name), Robot::names().collect::<Vec<_>>().join(", "));
            return Err(invalid(format!(
                "name must be the name of a built-in robot, got {got}; known robots: {known}"
            )));
        };
        match Robot::named(&text) {
            Ok(robot) => Ok(Bound::new(py, Self::from(robot))?.into_any()),
            Err(unknown) => python_calls::described(py, &text, unknown.to_string()),
        }
    }

    /// Returns the names of the built-in robots.
    #[staticmethod]
    fn names() -> Vec<&'static str> {
        Robot::names().collect()
    }
}

/// Whether a file is xacro: by its name or, since many end in ".urdf", by its content.
fn is_xacro(source: &str) -> bool {
    let file = Path::new(source);
    let contains_xacro = || std::fs::read_to_string(file).is_ok_and(|text| text.contains("<xacro:"));
    !source.contains('<') && file.is_file() && (source.ends_with(".xacro") || contains_xacro())
}

fn read_collision(name: Option<&str>) -> PyResult<CollisionShapes> {
    match name {
        None => Ok(CollisionShapes::Ignored),
        Some("primitives") => Ok(CollisionShapes::Primitives),
        Some("fit") => Ok(CollisionShapes::Fit),
        Some("hulls") => Ok(CollisionShapes::Hulls),
        Some(other) => Err(unknown_collision(&format!("'{other:.60}'"))),
    }
}

/// Reads `collision`. A value that is no text, for example `True`, gets the error that lists the names.
fn collision_name<'a>(value: &'a Bound<'_, PyAny>) -> PyResult<Option<&'a str>> {
    let readable = value.is_none() || value.is_instance_of::<PyString>();
    if readable { optional_text(value) } else { Err(unknown_collision(&summary(value))) }
}

fn unknown_collision(got: &str) -> PyErr {
    invalid(format!("collision must be one of 'primitives', 'fit', 'hulls' or None, got {got}"))
}

/// Reads one or several names of tips.
fn read_tips(value: &Bound<'_, PyAny>) -> PyResult<Vec<String>> {
    if value.is_instance_of::<PyString>() {
        return text(value).map(|name| vec![name.to_owned()]);
    }
    match value.extract::<Vec<String>>() {
        Ok(names) if !names.is_empty() => Ok(names),
        Ok(_) => Err(invalid("tip: the list is empty; name one link at least, or leave it out".into())),
        Err(_) => Err(invalid(format!("tip must be the name of a link, or a list of them, got {}", summary(value)))),
    }
}

/// Reads one or several folders.
fn read_folders(value: &Bound<'_, PyAny>) -> PyResult<Vec<String>> {
    let folders = match value.extract::<PathBuf>() {
        Ok(folder) => vec![folder],
        Err(_) => value
            .extract::<Vec<PathBuf>>()
            .map_err(|_| invalid(format!("package_dirs must be a list of folders, got {}", summary(value))))?,
    };
    Ok(folders.into_iter().map(|folder| folder.to_string_lossy().into_owned()).collect())
}
