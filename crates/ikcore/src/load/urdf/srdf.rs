//! SRDF, the companion of a URDF: pairs of links that need no collision test, and named configurations.

use std::collections::{HashMap, HashSet};

use roxmltree::Node;

use super::read::{is_text, read, text_of};
use super::xml;
use crate::error::{Error, Result, suggestion};
use crate::robot::{Robot, Stance};
use crate::wording::listed;

impl Robot {
    /// Applies an SRDF (a file, or its text, which contains `<`): disabled pairs of links are not tested against each other
    /// ([`collision_pairs`](Robot::collision_pairs)), and each `<group_state>` with values for all joints of the robot
    /// becomes one of its [`stances`](Robot::stances).
    ///
    /// All other links with bodies are tested, except pairs that always touch. Unknown link names are ignored. An SRDF that
    /// disables nothing leaves the pairs to be found by sampling.
    ///
    /// # Errors
    /// [`Error::Unreadable`]; [`Error::Srdf`] for text that is no SRDF, or an SRDF of another robot.
    pub fn with_srdf(&self, path_or_xml: &str) -> Result<Self> {
        let described = Srdf::read(path_or_xml, self).map_err(|error| of_srdf(path_or_xml, error))?;
        let robot = self.with_stances(described.stances(self));
        let disabled = described.disabled_pairs(self);
        Ok(if disabled.is_empty() { robot } else { robot.with_disabled_pairs(disabled) })
    }
}

/// The same error, of an SRDF, with its file.
fn of_srdf(path_or_xml: &str, error: Error) -> Error {
    match error {
        Error::Urdf { line, problem } | Error::Srdf { line, problem } => {
            let error = Error::Srdf { line, problem };
            if is_text(path_or_xml) {
                error
            } else {
                Error::InFile { path: path_or_xml.into(), error: Box::new(error) }
            }
        }
        Error::InFile { error, .. } => of_srdf(path_or_xml, *error),
        other => other,
    }
}

/// Relevant content of an SRDF.
struct Srdf {
    /// Pairs of links without a collision test.
    disabled: Vec<[String; 2]>,
    /// Links that are tested against no other link by default.
    alone: HashSet<String>,
    /// Pairs of links that are tested nevertheless.
    enabled: HashSet<[String; 2]>,
    states: Vec<(String, HashMap<String, f64>)>,
}

impl Srdf {
    fn read(path_or_xml: &str, robot: &Robot) -> Result<Self> {
        let described = Self::parse(&text_of(path_or_xml, read)?)?;
        described.require_same_robot(robot)?;
        Ok(described)
    }

    fn parse(text: &str) -> Result<Self> {
        let text = xml::without_declaration(text);
        let parsed = roxmltree::Document::parse(&text).map_err(|error| xml::not_xml(&error))?;
        let root = parsed.root_element();
        if root.tag_name().name() != "robot" {
            let found = root.tag_name().name();
            return Err(xml::error_at(root, format!("the outermost element must be <robot>, found <{found}>")));
        }
        xml::refuse_xacro(root)?;
        if let Some(joint) = xml::children(root, "joint").next() {
            return Err(xml::error_at(joint, "<robot> has a <joint>: this is a URDF"));
        }
        let alone = xml::children(root, "disable_default_collisions");
        let enabled = xml::children(root, "enable_collisions");
        Ok(Self {
            disabled: xml::children(root, "disable_collisions").map(pair).collect::<Result<_>>()?,
            alone: alone.map(|node| name(node, "link")).collect::<Result<_>>()?,
            enabled: enabled.map(pair).collect::<Result<_>>()?,
            states: xml::children(root, "group_state").map(state).collect::<Result<_>>()?,
        })
    }

    /// Returns an error if the SRDF disables pairs of links, and the robot has none of them.
    fn require_same_robot(&self, robot: &Robot) -> Result<()> {
        let known: HashSet<&str> = robot.all_link_names().collect();
        let both_known = |[one, other]: &[String; 2]| known.contains(one.as_str()) && known.contains(other.as_str());
        let Some([first, second]) = self.disabled.first().filter(|_| !self.disabled.iter().any(both_known)) else {
            return Ok(());
        };
        let unknown = if known.contains(first.as_str()) { second } else { first };
        let (hint, links) = (suggestion(unknown, robot.all_link_names()), listed(robot.all_link_names()));
        let problem = format!(
            "it is for another robot: '{}' has no link '{unknown}'{hint} and none of the pairs that it disables; its links: {links}",
            robot.name()
        );
        Err(Error::Srdf { line: None, problem: problem.into() })
    }

    /// Returns the disabled pairs; `disable_default_collisions` of a link disables it with all other links.
    fn disabled_pairs(&self, robot: &Robot) -> Vec<[String; 2]> {
        let mut disabled = self.disabled.clone();
        for link in &self.alone {
            let others = robot.all_link_names().filter(|other| other != link);
            disabled.extend(others.map(|other| [link.clone(), other.to_owned()]));
        }
        disabled.retain(|[one, other]| {
            let either_way = [[one.clone(), other.clone()], [other.clone(), one.clone()]];
            !either_way.iter().any(|pair| self.enabled.contains(pair))
        });
        disabled
    }

    /// Returns the states that define all independent joints of the robot.
    fn stances(&self, robot: &Robot) -> Vec<Stance> {
        let complete = self.states.iter().filter_map(|(name, values)| {
            let q = robot.joints().iter().map(|joint| values.get(&joint.name).copied());
            Some(Stance { name: name.clone(), q: q.collect::<Option<_>>()? })
        });
        complete.collect()
    }
}

fn name(node: Node, attribute: &str) -> Result<String> {
    let tag = node.tag_name().name();
    xml::required(node, attribute, &format!("<{tag}>")).map(str::to_owned)
}

fn pair(node: Node) -> Result<[String; 2]> {
    Ok([name(node, "link1")?, name(node, "link2")?])
}

/// Reads a name and the values of single-axis joints; other joints have several values and are ignored.
fn state(node: Node) -> Result<(String, HashMap<String, f64>)> {
    let mut values = HashMap::new();
    for joint in xml::children(node, "joint") {
        let owner = name(joint, "name")?;
        let value = xml::required(joint, "value", "<joint> of a <group_state>")?;
        if value.split_whitespace().count() == 1 {
            let what = format!("value of joint '{owner}'");
            let value = xml::number(joint, "value", &what)?.filter(|value| value.is_finite());
            values.insert(owner, value.ok_or_else(|| xml::error_at(joint, format!("{what} must be finite")))?);
        }
    }
    Ok((name(node, "name")?, values))
}
