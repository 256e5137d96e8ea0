//! Modified copies of a robot: other tool, base, limits, capsules, a mobile base, or random errors.

use std::collections::BTreeMap;

use ikcore::rng;
use ikcore::robot::{BaseLimits, Joint, LinkCapsule, MobileBase};
use ikcore::units;
use pyo3::prelude::*;

use super::PyRobot;
use crate::convert::{count, path_or_text, point, rigid, scalar_or_vector, summary};
use crate::error::{invalid, raise};
use crate::obstacle::{PyObstacle, Touch, read_touch};
use crate::units::doubt;

#[pymethods]
impl PyRobot {
    /// Returns a copy with a tool: `tool` (4, 4) is the pose of the new tip in the frame of the tip link.
    fn with_tool(&self, tool: &Bound<'_, PyAny>) -> PyResult<Self> {
        let tool = rigid("tool", tool)?;
        doubt(units::of_offset(&self.core, "tool", &tool.translation.vector.into()))?;
        self.core.with_tool(tool).map(Self::from).map_err(raise)
    }

    /// Returns a copy placed elsewhere: `base` (4, 4) is the pose of its base link.
    fn with_base(&self, base: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.core.with_base(rigid("base", base)?).map(Self::from).map_err(raise)
    }

    /// Returns a copy with other limits, each a number or (n,) (rad, m; rad/s, m/s); None keeps the present ones.
    #[pyo3(signature = (*, lower=None, upper=None, velocity=None))]
    pub fn with_limits(
        &self,
        lower: Option<&Bound<'_, PyAny>>,
        upper: Option<&Bound<'_, PyAny>>,
        velocity: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let n = self.core.dof();
        let read = |what: &str, value: Option<&Bound<'_, PyAny>>| value.map(|v| per_joint(what, v, n)).transpose();
        let (lower, upper, velocity) = (read("lower", lower)?, read("upper", upper)?, read("velocity", velocity)?);
        let change = |i: usize, joint: &mut Joint| {
            joint.lower = lower.as_ref().map_or(joint.lower, |values| values[i]);
            joint.upper = upper.as_ref().map_or(joint.upper, |values| values[i]);
            joint.velocity = velocity.as_ref().map_or(joint.velocity, |values| values[i]);
        };
        let robot = self.core.with_limits(change).map_err(raise)?;
        let known = units::of_limits(&self.core);
        doubt(units::of_limits(&robot).into_iter().filter(|doubt| !known.contains(doubt)))?;
        Ok(robot.into())
    }

    /// Returns a copy on a mobile base, whose joints come first in `q`. Poses then refer to a new first link, "world",
    /// and the base pose of this robot becomes its mounting on the mobile base. In named configurations the base is at
    /// zero.
    ///
    /// Args:
    ///     kind: "planar": base_x, base_y (m) and base_yaw (rad). "floating": base_x, base_y, base_z (m) and base_rx, base_ry,
    ///         base_rz (rad), a rotation vector: no orientation is singular. Its velocity and acceleration are the rates of its entries.
    ///     lower: lower position limits, (3,) or (6,); finite, since random configurations and starts of searches are drawn from the
    ///         range. The yaw may be unlimited on both sides. The rotation vector has to stay shorter than 5.97 rad;
    ///         -pi and pi for each entry hold every orientation.
    ///     upper: upper position limits, likewise.
    ///     velocity: velocity limits, a number or one per joint (m/s, rad/s); None: unknown.
    ///     acceleration: acceleration limits for `rated_limits`, likewise (m/s^2, rad/s^2).
    #[pyo3(signature = (kind, *, lower=None, upper=None, velocity=None, acceleration=None))]
    fn with_mobile_base(
        &self,
        #[pyo3(from_py_with = crate::convert::text)] kind: &str,
        lower: Option<&Bound<'_, PyAny>>,
        upper: Option<&Bound<'_, PyAny>>,
        velocity: Option<&Bound<'_, PyAny>>,
        acceleration: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let base: MobileBase = kind.parse().map_err(raise)?;
        let joints = base.joint_names();
        let position = |what: &str, value: Option<&Bound<'_, PyAny>>| match value {
            Some(value) => scalar_or_vector(what, value).map(|(values, _)| values),
            None => Err(invalid(format!(
                "a {base} base needs {what}=({},), the limits of {}: configurations are drawn from the range",
                joints.len(),
                joints.join(", ")
            ))),
        };
        let rate = |what: &str, value: Option<&Bound<'_, PyAny>>| {
            value.map_or(Ok(vec![f64::INFINITY; joints.len()]), |value| per_joint(what, value, joints.len()))
        };
        let limits = BaseLimits {
            lower: position("lower", lower)?,
            upper: position("upper", upper)?,
            velocity: rate("velocity", velocity)?,
            acceleration: rate("acceleration", acceleration)?,
        };
        let robot = self.core.with_mobile_base(base, &limits).map_err(raise)?;
        doubt(units::of_limits(&robot))?;
        Ok(robot.into())
    }

    /// Returns a copy with other values (rad, m) of joints beside the chain, for example
    /// `with_held({"finger_joint": 0.04})`.
    ///
    /// Raises:
    ///     UnknownNameError: no held joint of that name; the message lists them.
    ///     LimitError: a value outside the limits of the joint.
    fn with_held(&self, hold: &Bound<'_, PyAny>) -> PyResult<Self> {
        let held = read_hold(hold)?;
        let held = held.iter().map(|(name, value)| (name.as_str(), *value));
        self.core.with_held(held).map(Self::from).map_err(raise)
    }

    /// Returns a copy that carries `shape`, in the frame of `link`, as a body of its own, for example a grasped part.
    ///
    /// Args:
    ///     link: the link that carries it.
    ///     shape: a Sphere, Box, Capsule, Cylinder, Ellipsoid or ConvexMesh of `bik.obstacles`.
    ///     touch: links that the shape may touch, besides those that move with `link`.
    ///     name: name of the body in messages and in `all_link_names`; None: "attached", "attached_2" and so on.
    ///
    /// Raises:
    ///     UnknownNameError: no link of that name; the message lists them.
    #[pyo3(signature = (link, shape, *, touch=None, name=None))]
    fn with_attached(
        &self,
        #[pyo3(from_py_with = crate::convert::text)] link: &str,
        shape: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = read_touch)] touch: Touch,
        #[pyo3(from_py_with = crate::convert::optional_text)] name: Option<&str>,
    ) -> PyResult<Self> {
        let shape = shape.cast::<PyObstacle>().map_err(|_| {
            invalid(format!("shape must be made by bik.obstacles, such as Sphere or Box, got {}", summary(shape)))
        })?;
        let (given, touch) = (&shape.get().core, touch.unwrap_or_default());
        let touch: Vec<&str> = touch.iter().chain(given.touch()).map(String::as_str).collect();
        let robot = self.core.with_attached(link, &given.shape, &touch, name).map_err(raise)?;
        doubt(units::of_sizes(&robot))?;
        Ok(robot.into())
    }

    /// Returns a copy that tests exactly these pairs of links against each other, each (link, link). To exclude a link:
    /// `robot.with_collision_pairs([pair for pair in robot.collision_pairs if "camera" not in pair])`.
    ///
    /// Raises:
    ///     UnknownNameError: no link of that name; the message lists them.
    fn with_collision_pairs(&self, pairs: &Bound<'_, PyAny>) -> PyResult<Self> {
        let pairs = pairs
            .extract::<Vec<(String, String)>>()
            .map_err(|_| invalid(format!("pairs must be a list of (link, link), got {}", summary(pairs))))?;
        let pairs = pairs.into_iter().map(|(one, other)| [one, other]).collect();
        self.core.with_collision_pairs(pairs).map(Self::from).map_err(raise)
    }

    /// Returns a copy with the disabled pairs and named states of an SRDF; `path_or_xml` is a file, or text that
    /// contains "<". Disabled pairs of links are not tested against each other, and states that give all joints of the
    /// robot become `stances`.
    ///
    /// Raises:
    ///     UrdfError: not an SRDF, or the SRDF of another robot.
    fn with_srdf(&self, path_or_xml: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.core.with_srdf(&path_or_text("path_or_xml", path_or_xml)?).map(Self::from).map_err(raise)
    }

    /// Returns a copy with collision capsules: one of `radius` (m) along each link, or the given ones, each (link, a,
    /// b, radius) with its axis from a (3,) to b (3,) in the frame of the link (m). Capsules along the links end at the
    /// tip, so set a tool first. The gap that a prismatic joint opens between two links is not covered.
    ///
    /// Raises:
    ///     UnknownNameError: no link of that name; the message lists them.
    #[pyo3(signature = (capsules=None, *, radius=None))]
    fn with_capsules(&self, capsules: Option<Vec<Bound<'_, PyAny>>>, radius: Option<f64>) -> PyResult<Self> {
        let robot = match (capsules, radius) {
            (Some(capsules), None) => {
                let capsules = capsules.iter().enumerate().map(|(i, capsule)| read_capsule(i, capsule));
                self.core.with_capsules(capsules.collect::<PyResult<_>>()?)
            }
            (None, Some(radius)) => self.core.with_capsules_along_links(radius),
            _ => return Err(invalid("with_capsules: give either radius= or a list of (link, a, b, radius)".into())),
        };
        let robot = robot.map_err(raise)?;
        doubt(units::of_sizes(&robot))?;
        Ok(robot.into())
    }

    /// Returns a copy with random manufacturing errors: each constant offset between two joints changes by up to `length`
    /// (m), and the zero of each revolute joint by up to `angle` (rad). Use it in a `KinematicPlant` to simulate an arm whose
    /// model is wrong.
    #[pyo3(signature = (*, length=0.0, angle=0.0, seed=0))]
    fn with_errors(&self, length: f64, angle: f64, seed: i128) -> PyResult<Self> {
        let mut rng = rng::stream(count("seed", seed)?, 0);
        self.core.with_errors(length, angle, &mut rng).map(Self::from).map_err(raise)
    }
}

/// Reads numbers for n joints: one for all, or one per joint.
pub fn per_joint(what: &str, value: &Bound<'_, PyAny>, n: usize) -> PyResult<Vec<f64>> {
    let (values, _) = scalar_or_vector(what, value)?;
    match values.len() {
        1 => Ok(vec![values[0]; n]),
        got if got == n => Ok(values),
        got => Err(invalid(format!("{what}: expected a number or {n} values (one per joint), got {got}"))),
    }
}

/// Reads values of joints by name.
pub fn read_hold(value: &Bound<'_, PyAny>) -> PyResult<Vec<(String, f64)>> {
    let wrong = || invalid(format!("hold must be a dict of joint names and values (rad, m), got {}", summary(value)));
    let held = value.extract::<BTreeMap<String, f64>>().map_err(|_| wrong())?;
    Ok(held.into_iter().collect())
}

/// Reads a capsule (link, a, b, radius).
fn read_capsule(i: usize, value: &Bound<'_, PyAny>) -> PyResult<LinkCapsule> {
    type Parts<'py> = (String, Bound<'py, PyAny>, Bound<'py, PyAny>, f64);
    let (link, a, b, radius) = value
        .extract::<Parts<'_>>()
        .map_err(|_| invalid(format!("capsule {i} must be (link, a, b, radius), got {}", summary(value))))?;
    let end = |name: &str, value: &Bound<'_, PyAny>| point(&format!("{name} of capsule {i}"), value);
    Ok(LinkCapsule { link, a: end("a", &a)?, b: end("b", &b)?, radius })
}
