//! Masses of links, and friction of joints. What is wrong there keeps no file from loading, since kinematics needs none of it.

use nalgebra::Matrix3;
use roxmltree::Node;

use super::xml;
use crate::dynamics::Inertia;
use crate::error::{Error, Result, shortened};
use crate::math::pose;

/// Torque limit, friction and rotor of a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct JointLoad {
    /// Torque limit (N m, N); infinite where there is none. An effort of zero, with which nothing would move, stands for none.
    pub(super) effort: f64,
    pub(super) damping: f64,
    pub(super) friction: f64,
    /// Inertia of the rotor, of models of MuJoCo.
    pub(super) armature: f64,
}

impl Default for JointLoad {
    fn default() -> Self {
        Self { effort: f64::INFINITY, damping: 0.0, friction: 0.0, armature: 0.0 }
    }
}

/// Reads the inertia of a link; `None` without an element `inertial`. The error has the mass as a point, where only the matrix is
/// impossible.
pub(super) fn read(link: &str, node: Node) -> Result<Option<Inertia>, Box<(Error, Option<Inertia>)>> {
    let Some(inertial) = xml::children(node, "inertial").next() else { return Ok(None) };
    let owner = format!("<inertial> of link '{}'", shortened(link));
    let inertia = numbers(inertial, &owner).map_err(|error| Box::new((error, None)))?;
    let Some(problem) = inertia.fault() else { return Ok(Some(inertia)) };
    let point = Inertia::point(inertia.mass, inertia.center);
    let point = if point.fault().is_none() { Some(point) } else { None };
    Err(Box::new((xml::error_at(inertial, format!("{owner}: {problem}")), point)))
}

/// Reads mass, centre and inertia matrix, possible or not.
fn numbers(inertial: Node, owner: &str) -> Result<Inertia> {
    let (mut rpy, mut center) = ([0.0; 3], [0.0; 3]);
    if let Some(origin) = xml::children(inertial, "origin").next() {
        rpy = xml::vector(origin, "rpy", &format!("origin rpy of {owner}"))?.unwrap_or_default();
        center = xml::vector(origin, "xyz", &format!("origin xyz of {owner}"))?.unwrap_or_default();
    }
    let mass = required(child(inertial, "mass", owner)?, "value", owner)?;
    let tensor = child(inertial, "inertia", owner)?;
    let [xx, yy, zz] = ["ixx", "iyy", "izz"].map(|name| required(tensor, name, owner));
    let [xy, xz, yz] = ["ixy", "ixz", "iyz"].map(|name| xml::number(tensor, name, &format!("{name} of {owner}")));
    let [xy, xz, yz] = [xy?.unwrap_or(0.0), xz?.unwrap_or(0.0), yz?.unwrap_or(0.0)];
    let matrix = Matrix3::new(xx?, xy, xz, xy, yy?, yz, xz, yz, zz?);
    let rotation = pose::from_rpy(rpy, [0.0; 3]).rotation;
    Ok(Inertia::turned(mass, center, rotation.matrix(), &matrix))
}

fn child<'a, 'x: 'a>(inertial: Node<'a, 'x>, tag: &'a str, owner: &str) -> Result<Node<'a, 'x>> {
    let missing = || xml::error_at(inertial, format!("{owner} has no <{tag}>"));
    xml::children(inertial, tag).next().ok_or_else(missing)
}

fn required(node: Node, name: &str, owner: &str) -> Result<f64> {
    let tag = node.tag_name().name();
    xml::required(node, name, &format!("<{tag}> in {owner}"))?;
    Ok(xml::number(node, name, &format!("{name} of <{tag}> in {owner}"))?.unwrap_or_default())
}

/// Reads torque limit, friction and rotor of a joint.
pub(super) fn joint_load(joint: Node, owner: &str) -> Result<JointLoad> {
    let number = |tag: &str, name: &str| {
        let Some(node) = xml::children(joint, tag).next() else { return Ok(None) };
        match xml::number(node, name, &format!("{tag} {name} of {owner}"))? {
            Some(value) if value < 0.0 => {
                Err(xml::error_at(node, format!("{tag} {name} of {owner} is {value}: it cannot be negative")))
            }
            Some(value) if value.is_infinite() && tag == "dynamics" => {
                Err(xml::error_at(node, format!("{tag} {name} of {owner} must be finite, got {value}")))
            }
            value => Ok(value),
        }
    };
    let effort = number("limit", "effort")?.filter(|effort| *effort > 0.0);
    let rate = |name: &str| Ok(number("dynamics", name)?.unwrap_or(0.0));
    Ok(JointLoad {
        effort: effort.unwrap_or(f64::INFINITY),
        damping: rate("damping")?,
        friction: rate("friction")?,
        armature: rate("armature")?,
    })
}
