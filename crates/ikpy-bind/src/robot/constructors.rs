//! Constructors of `Robot`: URDF, Denavit-Hartenberg tables, planar arms, built-in robots.

use std::path::PathBuf;

use ikcore::load::{Dh, DhTable};
use ikcore::robot::{JointKind, Robot};
use pyo3::prelude::*;

use super::PyRobot;
use super::modified_copies::per_joint;
use crate::convert::{rigid, summary, vector};
use crate::error::{invalid, raise};
use crate::monitor::on_a_thread;

#[pymethods]
impl PyRobot {
    /// Makes a robot from a URDF file or a string of XML.
    ///
    /// Args:
    ///     path_or_xml: a file, or text that contains "<".
    ///     base: link whose frame is the reference frame; None: the root. It need not be an ancestor of `tip`.
    ///     tip: link at the end of the chain; None: the only leaf.
    ///
    /// Joints may be revolute, continuous, prismatic, fixed or mimic. Collision spheres, cylinders, capsules and boxes become
    /// `capsules` that enclose them; visuals, meshes and unknown tags are ignored, and so is `safety_controller`. A missing
    /// velocity limit means infinite; zero locks the joint.
    ///
    /// Raises:
    ///     UrdfError: not XML, no joint, a cycle, two roots, a zero axis, or several leaves and no `tip`.
    ///     UnknownNameError: no link of that name; the message lists them.
    #[staticmethod]
    #[pyo3(signature = (path_or_xml, *, base=None, tip=None))]
    fn from_urdf(
        path_or_xml: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = crate::convert::optional_text)] base: Option<&str>,
        #[pyo3(from_py_with = crate::convert::optional_text)] tip: Option<&str>,
    ) -> PyResult<Self> {
        let source = match path_or_xml.extract::<String>() {
            Ok(text) => text,
            Err(_) => match path_or_xml.extract::<PathBuf>() {
                Ok(path) => path.to_string_lossy().into_owned(),
                Err(_) => {
                    let got = summary(path_or_xml);
                    return Err(invalid(format!("path_or_xml must be a path, or XML as text, got {got}")));
                }
            },
        };
        let [base, tip] = [base, tip].map(|link| link.map(str::to_owned));
        let robot = on_a_thread(path_or_xml.py(), move || Robot::from_urdf(&source, base.as_deref(), tip.as_deref()))?;
        Ok(Self::from(robot))
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
        #[pyo3(from_py_with = crate::convert::text)] convention: &str,
        lower: Option<&Bound<'_, PyAny>>,
        upper: Option<&Bound<'_, PyAny>>,
        velocity: Option<&Bound<'_, PyAny>>,
        base: Option<&Bound<'_, PyAny>>,
        tool: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = crate::convert::optional_text)] name: Option<&str>,
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
        Robot::from_dh(name.unwrap_or("dh"), &table).map(Self::from).map_err(raise)
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
        robot.with_limits(lower, upper, velocity)
    }

    /// Returns a built-in robot; `Robot.names()` lists them.
    ///
    /// Raises:
    ///     UnknownNameError: lists the names and suggests the nearest.
    #[staticmethod]
    fn named(name: &Bound<'_, PyAny>) -> PyResult<Self> {
        let Ok(text) = name.extract::<String>() else {
            let (got, known) = (summary(name), Robot::names().collect::<Vec<_>>().join(", "));
            return Err(invalid(format!(
                "name must be the name of a built-in robot, got {got}; known robots: {known}"
            )));
        };
        Robot::named(&text).map(Self::from).map_err(raise)
    }

    /// Returns the names of the built-in robots.
    #[staticmethod]
    fn names() -> Vec<&'static str> {
        Robot::names().collect()
    }
}
