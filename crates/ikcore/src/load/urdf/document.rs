//! URDF text as a typed model: checked with roxmltree, reduced to links and joints, then read by urdf-rs.
//!
//! urdf-rs alone fails on unknown geometry, accepts NaN, skips words that are not numbers, and cannot distinguish a
//! missing limit from zero. So it gets a text with links and joints only, and every number written out.

use std::collections::{HashMap, HashSet};

use roxmltree::Node;

use super::link_capsules::{self, LinkCapsules};
use super::xml;
use crate::error::{Error, Result, suggestion};

/// The joint types of URDF.
const TYPES: [&str; 7] = ["revolute", "continuous", "prismatic", "fixed", "floating", "planar", "spherical"];

/// A checked URDF: numbers are finite (limits may be infinite), names unique. Its joints need not form a tree.
pub(super) struct Document {
    pub(super) model: urdf_rs::Robot,
    /// Line of each joint, in the order of the model.
    joint_lines: Vec<u32>,
    /// Collision shapes of each link, by name.
    pub(super) capsules: HashMap<String, LinkCapsules>,
}

impl Document {
    pub(super) fn parse(text: &str) -> Result<Self> {
        let text = xml::without_declaration(text);
        let parsed = roxmltree::Document::parse(&text).map_err(|error| xml::not_xml(&error))?;
        let root = parsed.root_element();
        if root.tag_name().name() != "robot" {
            let found = root.tag_name().name();
            return Err(xml::error_at(root, format!("the outermost element must be <robot>, found <{found}>")));
        }
        xml::refuse_xacro(root)?;
        let joint_lines = xml::children(root, "joint").map(xml::line).collect();
        let model = urdf_rs::read_from_string(&reduced(root)?)
            .map_err(|error| Error::Urdf { line: None, problem: error.to_string() })?;
        let links = xml::children(root, "link").filter_map(|link| Some((link.attribute("name")?, link)));
        let capsules = links.map(|(name, link)| (name.to_owned(), link_capsules::read(name, link))).collect();
        Ok(Self { model, joint_lines, capsules })
    }

    /// An error at a joint.
    pub(super) fn error_at(&self, joint: usize, problem: String) -> Error {
        Error::Urdf { line: self.joint_lines.get(joint).copied(), problem }
    }
}

/// The same robot with links and joints only, and with all numbers written out.
fn reduced(root: Node) -> Result<String> {
    if xml::children(root, "joint").next().is_none() {
        return Err(xml::error_at(root, "<robot> has no <joint>: a chain needs at least one that moves"));
    }
    let mut text = format!("<robot name=\"{}\">", escaped(xml::attribute(root, "name")?.unwrap_or("robot")));
    let mut names = HashSet::new();
    for link in xml::children(root, "link") {
        let name = new_name(link, "link", &mut names)?;
        text += &format!("<link name=\"{}\"/>", escaped(name));
    }
    names.clear();
    for joint in xml::children(root, "joint") {
        let name = new_name(joint, "joint", &mut names)?;
        text += &reduced_joint(joint, name)?;
    }
    Ok(text + "</robot>")
}

/// Returns the name of a link or joint, checked to be unique.
fn new_name<'a>(node: Node<'a, '_>, tag: &str, names: &mut HashSet<&'a str>) -> Result<&'a str> {
    let name = xml::required(node, "name", &format!("<{tag}>"))?;
    if names.insert(name) { Ok(name) } else { Err(xml::error_at(node, format!("a second {tag} is named '{name}'"))) }
}

fn reduced_joint(joint: Node, name: &str) -> Result<String> {
    let owner = format!("joint '{name}'");
    let kind = joint_type(joint, &owner)?;
    let link = |tag: &str| match xml::children(joint, tag).next() {
        Some(end) => xml::required(end, "link", &format!("<{tag}> of {owner}")).map(escaped),
        None => Err(xml::error_at(joint, format!("{owner} has no <{tag} link=\"...\"/>"))),
    };
    let (parent, child) = (link("parent")?, link("child")?);
    let [x, y, z] = vector(joint, "origin", "xyz", &owner)?.unwrap_or_default();
    let [roll, pitch, yaw] = rotation(joint, &owner)?;
    let [i, j, k] = vector(joint, "axis", "xyz", &owner)?.unwrap_or([1.0, 0.0, 0.0]);
    let (lower, upper) = match (number(joint, "limit", "lower", &owner)?, number(joint, "limit", "upper", &owner)?) {
        (None, None) => (f64::NEG_INFINITY, f64::INFINITY),
        (lower, upper) => (lower.unwrap_or(0.0), upper.unwrap_or(0.0)),
    };
    let velocity = number(joint, "limit", "velocity", &owner)?.unwrap_or(f64::INFINITY);
    let mimic = mimic(joint, &owner)?;
    Ok(format!(
        "<joint name=\"{name}\" type=\"{kind}\">\
         <origin xyz=\"{x} {y} {z}\" rpy=\"{roll} {pitch} {yaw}\"/><parent link=\"{parent}\"/><child link=\"{child}\"/>\
         <axis xyz=\"{i} {j} {k}\"/>\
         <limit lower=\"{lower}\" upper=\"{upper}\" velocity=\"{velocity}\"/>{mimic}</joint>",
        name = escaped(name),
    ))
}

fn joint_type<'a>(joint: Node<'a, '_>, owner: &str) -> Result<&'a str> {
    let kind = xml::required(joint, "type", owner)?;
    if TYPES.contains(&kind) {
        return Ok(kind);
    }
    let (hint, known) = (suggestion(kind, TYPES), TYPES.join(", "));
    Err(xml::error_at(joint, format!("{owner} has the unknown type '{kind}'{hint}; types: {known}")))
}

/// Roll, pitch and yaw (rad).
fn rotation(joint: Node, owner: &str) -> Result<[f64; 3]> {
    let rpy = vector(joint, "origin", "rpy", owner)?;
    match xml::children(joint, "origin").next() {
        Some(origin) if rpy.is_none() && origin.has_attribute("quat_xyzw") => {
            Err(xml::error_at(origin, format!("origin quat_xyzw of {owner} is not supported: write it as rpy")))
        }
        _ => Ok(rpy.unwrap_or_default()),
    }
}

/// Returns the `<mimic>` element of a joint, or an empty string.
fn mimic(joint: Node, owner: &str) -> Result<String> {
    let Some(mimic) = xml::children(joint, "mimic").next() else { return Ok(String::new()) };
    let master = escaped(xml::required(mimic, "joint", &format!("<mimic> of {owner}"))?);
    let finite = |attribute: &str, default: f64| match number(joint, "mimic", attribute, owner)? {
        Some(number) if number.is_infinite() => {
            Err(xml::error_at(mimic, format!("mimic {attribute} of {owner} must be finite, got '{number}'")))
        }
        number => Ok(number.unwrap_or(default)),
    };
    let (multiplier, offset) = (finite("multiplier", 1.0)?, finite("offset", 0.0)?);
    Ok(format!("<mimic joint=\"{master}\" multiplier=\"{multiplier}\" offset=\"{offset}\"/>"))
}

fn vector(joint: Node, tag: &str, attribute: &str, owner: &str) -> Result<Option<[f64; 3]>> {
    let Some(element) = xml::children(joint, tag).next() else { return Ok(None) };
    xml::vector(element, attribute, &format!("{tag} {attribute} of {owner}"))
}

fn number(joint: Node, tag: &str, attribute: &str, owner: &str) -> Result<Option<f64>> {
    let Some(element) = xml::children(joint, tag).next() else { return Ok(None) };
    xml::number(element, attribute, &format!("{tag} {attribute} of {owner}"))
}

/// Escapes text for an attribute value.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
