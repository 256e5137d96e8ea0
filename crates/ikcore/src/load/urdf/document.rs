//! Parsed and checked URDF: links, joints, and collision and visual shapes; all other elements are ignored.

use std::collections::{HashMap, HashSet};

use roxmltree::Node;

use super::inertial::{self, JointLoad};
use super::link_capsules::{self, LinkCapsules};
use super::{visuals, xml};
use crate::error::{Error, Result, shortened, suggestion};
use crate::robot::{InertiaFault, LinkInertia, Visual};
use crate::units::{self, UnitDoubt};

/// Checked URDF: numbers are finite (limits may be infinite), names unique. Its joints need not form a tree.
pub(super) struct Document {
    pub(super) name: String,
    pub(super) links: Vec<String>,
    pub(super) joints: Vec<UrdfJoint>,
    /// Index of each joint, by name.
    joint_numbers: HashMap<String, usize>,
    /// Line of each joint.
    joint_lines: Vec<u32>,
    /// Collision shapes of each link, by name.
    pub(super) capsules: HashMap<String, LinkCapsules>,
    pub(super) visuals: Vec<Visual>,
    pub(super) inertias: Vec<LinkInertia>,
    /// Reasons why the dynamics of the file cannot be used.
    pub(super) faults: Vec<InertiaFault>,
}

/// Joint as described in the text, with the defaults of URDF filled in.
pub(super) struct UrdfJoint {
    pub(super) name: String,
    pub(super) kind: UrdfKind,
    pub(super) parent: String,
    pub(super) child: String,
    /// Translation of the joint origin (m).
    pub(super) xyz: [f64; 3],
    /// Fixed-axis roll, pitch and yaw (rad).
    pub(super) rpy: [f64; 3],
    pub(super) axis: [f64; 3],
    /// Position limits (rad, m).
    pub(super) range: (f64, f64),
    /// Velocity limit (rad/s, m/s).
    pub(super) velocity: f64,
    /// Rated acceleration and jerk (rad/s^2, m/s^2; rad/s^3, m/s^3): of URDF 1.2, infinite where they are missing.
    pub(super) rated: [f64; 2],
    /// Torque limit, friction and rotor.
    pub(super) load: JointLoad,
    /// Whether the joint has an element `limit`.
    pub(super) has_limit: bool,
    pub(super) mimic: Option<Mimic>,
}

/// Mimic relation: value = multiplier * value of the other joint + offset; with a polynomial, multiplier * its value + offset.
pub(super) struct Mimic {
    pub(super) joint: String,
    /// Coefficients by ascending powers of the value of the other joint, an extension of URDF for models of MuJoCo.
    pub(super) polynomial: Option<[f64; 5]>,
    pub(super) multiplier: f64,
    pub(super) offset: f64,
}

/// Joint types of URDF.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum UrdfKind {
    Revolute,
    Continuous,
    Prismatic,
    Fixed,
    Floating,
    Planar,
    Spherical,
}

impl UrdfKind {
    const NAMED: [(&str, Self); 7] = [
        ("revolute", Self::Revolute),
        ("continuous", Self::Continuous),
        ("prismatic", Self::Prismatic),
        ("fixed", Self::Fixed),
        ("floating", Self::Floating),
        ("planar", Self::Planar),
        ("spherical", Self::Spherical),
    ];

    /// Whether this kind of joint has exactly one axis.
    pub(super) fn moves_one_way(self) -> bool {
        matches!(self, Self::Revolute | Self::Continuous | Self::Prismatic)
    }
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
        if xml::children(root, "joint").next().is_none() {
            return Err(xml::error_at(root, "<robot> has no <joint>: a chain needs at least one that moves"));
        }
        let name = xml::attribute(root, "name")?.unwrap_or("robot").to_owned();
        let (mut names, mut links, mut capsules) = (HashSet::new(), vec![], HashMap::new());
        let (mut inertias, mut faults) = (vec![], vec![]);
        for link in xml::children(root, "link") {
            let name = new_name(link, "link", &mut names)?;
            links.push(name.to_owned());
            capsules.insert(name.to_owned(), link_capsules::read(name, link));
            match inertial::read(name, link) {
                Ok(inertia) => inertias.extend(inertia.map(|inertia| LinkInertia { link: name.to_owned(), inertia })),
                Err(fault) => {
                    let (error, point) = *fault;
                    faults.push(InertiaFault { owner: name.to_owned(), problem: error.to_string(), point });
                }
            }
        }
        names.clear();
        let mut joints = vec![];
        for joint in xml::children(root, "joint") {
            let name = new_name(joint, "joint", &mut names)?;
            joints.push(read_joint(joint, name, &mut faults)?);
        }
        let joint_lines = xml::lines(&text, xml::children(root, "joint"));
        let joint_numbers = joints.iter().enumerate().map(|(number, joint)| (joint.name.clone(), number)).collect();
        let visuals = visuals::read(root);
        Ok(Self { name, links, joints, joint_numbers, joint_lines, capsules, visuals, inertias, faults })
    }

    /// Returns the index of the joint with this name.
    pub(super) fn joint_number(&self, name: &str) -> Option<usize> {
        self.joint_numbers.get(name).copied()
    }

    /// Doubts the angles at which joints are placed.
    pub(super) fn doubt(&self) -> Option<UnitDoubt> {
        let of = |joint: &UrdfJoint| {
            units::of_rpy_in_file(&format!("rpy of the origin of joint '{}'", shortened(&joint.name)), joint.rpy)
        };
        self.joints.iter().filter(|joint| joint.rpy.iter().any(|angle| angle.abs() > units::MANY_TURNS)).find_map(of)
    }

    /// Creates an error located at a joint.
    pub(super) fn error_at(&self, joint: usize, problem: String) -> Error {
        Error::Urdf { line: self.joint_lines.get(joint).copied(), problem: problem.into() }
    }
}

/// Returns the name of a link or joint, checked to be unique.
fn new_name<'a>(node: Node<'a, '_>, tag: &str, names: &mut HashSet<&'a str>) -> Result<&'a str> {
    let name = xml::required(node, "name", &format!("<{tag}>"))?;
    if names.insert(name) { Ok(name) } else { Err(xml::error_at(node, format!("a second {tag} is named '{name}'"))) }
}

fn read_joint(joint: Node, name: &str, faults: &mut Vec<InertiaFault>) -> Result<UrdfJoint> {
    let owner = format!("joint '{}'", shortened(name));
    let kind = joint_kind(joint, &owner)?;
    let link = |tag: &str| match xml::children(joint, tag).next() {
        Some(end) => xml::required(end, "link", &format!("<{tag}> of {owner}")).map(str::to_owned),
        None => Err(xml::error_at(joint, format!("{owner} has no <{tag} link=\"...\"/>"))),
    };
    Ok(UrdfJoint {
        kind,
        parent: link("parent")?,
        child: link("child")?,
        xyz: vector(joint, "origin", "xyz", &owner)?.unwrap_or_default(),
        rpy: rotation(joint, &owner)?,
        axis: vector(joint, "axis", "xyz", &owner)?.unwrap_or([1.0, 0.0, 0.0]),
        range: match (number(joint, "limit", "lower", &owner)?, number(joint, "limit", "upper", &owner)?) {
            (None, None) => (f64::NEG_INFINITY, f64::INFINITY),
            (lower, upper) => (lower.unwrap_or(0.0), upper.unwrap_or(0.0)),
        },
        velocity: number(joint, "limit", "velocity", &owner)?.unwrap_or(f64::INFINITY),
        rated: rated(joint, &owner)?,
        load: inertial::joint_load(joint, &owner).unwrap_or_else(|error| {
            faults.push(InertiaFault { owner: owner.clone(), problem: error.to_string(), point: None });
            JointLoad::default()
        }),
        has_limit: xml::children(joint, "limit").next().is_some(),
        mimic: mimic(joint, &owner)?,
        name: name.into(),
    })
}

/// Returns the rated acceleration and jerk. A motion reversed is as good, so that the smaller of acceleration and deceleration holds
/// for both.
fn rated(joint: Node, owner: &str) -> Result<[f64; 2]> {
    let rate = |attribute: &str| match number(joint, "limit", attribute, owner)? {
        Some(value) if value < 0.0 => {
            let problem = format!("limit {attribute} of {owner} is {value}: a limit cannot be negative");
            Err(xml::error_at(joint, problem))
        }
        value => Ok(value.unwrap_or(f64::INFINITY)),
    };
    Ok([rate("acceleration")?.min(rate("deceleration")?), rate("jerk")?])
}

fn joint_kind(joint: Node, owner: &str) -> Result<UrdfKind> {
    let kind = xml::required(joint, "type", owner)?;
    if let Some((_, known)) = UrdfKind::NAMED.iter().find(|(name, _)| *name == kind) {
        return Ok(*known);
    }
    let names = UrdfKind::NAMED.map(|(name, _)| name);
    let (hint, known) = (suggestion(kind, names), names.join(", "));
    Err(xml::error_at(joint, format!("{owner} has the unknown type '{}'{hint}; types: {known}", shortened(kind))))
}

/// Returns roll, pitch and yaw (rad).
fn rotation(joint: Node, owner: &str) -> Result<[f64; 3]> {
    let rpy = vector(joint, "origin", "rpy", owner)?;
    match xml::children(joint, "origin").next() {
        Some(origin) if rpy.is_none() && origin.has_attribute("quat_xyzw") => {
            Err(xml::error_at(origin, format!("origin quat_xyzw of {owner} is not supported: write it as rpy")))
        }
        _ => Ok(rpy.unwrap_or_default()),
    }
}

/// Returns the mimic relation of a joint, if any.
fn mimic(joint: Node, owner: &str) -> Result<Option<Mimic>> {
    let Some(mimic) = xml::children(joint, "mimic").next() else { return Ok(None) };
    let master = xml::required(mimic, "joint", &format!("<mimic> of {owner}"))?;
    let finite = |attribute: &str, default: f64| match number(joint, "mimic", attribute, owner)? {
        Some(number) if number.is_infinite() => {
            Err(xml::error_at(mimic, format!("mimic {attribute} of {owner} must be finite, got '{number}'")))
        }
        number => Ok(number.unwrap_or(default)),
    };
    let (multiplier, offset) = (finite("multiplier", 1.0)?, finite("offset", 0.0)?);
    let polynomial = mimic.attribute("polynomial").map(|text| polynomial(mimic, text, owner)).transpose()?;
    Ok(Some(Mimic { joint: master.into(), polynomial, multiplier, offset }))
}

/// Reads up to five finite coefficients; missing ones are zero.
fn polynomial(mimic: Node, text: &str, owner: &str) -> Result<[f64; 5]> {
    let mut coefficients = [0.0; 5];
    let mut places = coefficients.iter_mut();
    for number in text.split_whitespace() {
        match (places.next(), number.parse::<f64>()) {
            (Some(place), Ok(value)) if value.is_finite() => *place = value,
            _ => {
                let shown = shortened(text);
                let problem = format!("mimic polynomial of {owner} must be one to five finite numbers, got '{shown}'");
                return Err(xml::error_at(mimic, problem));
            }
        }
    }
    Ok(coefficients)
}

fn vector(joint: Node, tag: &str, attribute: &str, owner: &str) -> Result<Option<[f64; 3]>> {
    let Some(element) = xml::children(joint, tag).next() else { return Ok(None) };
    xml::vector(element, attribute, &format!("{tag} {attribute} of {owner}"))
}

fn number(joint: Node, tag: &str, attribute: &str, owner: &str) -> Result<Option<f64>> {
    let Some(element) = xml::children(joint, tag).next() else { return Ok(None) };
    xml::number(element, attribute, &format!("{tag} {attribute} of {owner}"))
}
