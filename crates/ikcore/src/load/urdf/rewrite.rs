//! URDF of a calibrated robot: the text it came from, with other origins of the joints that changed and every other byte as it was.

use std::ops::Range;

use roxmltree::Node;

use super::chain;
use super::document::Document;
use super::read::{in_file, read_urdf, text_of};
use super::tree::{Tree, TreeStep};
use super::xml;
use crate::error::{Error, Result};
use crate::math::{Pose, pose};
use crate::robot::{Element, Robot};

/// Change of a transform (m, rad) that counts as none.
const UNCHANGED: f64 = 1e-12;

impl Robot {
    /// The URDF `path_or_xml`, which this robot was loaded from and calibrated since, with the geometry of this robot: `xyz` and `rpy` of
    /// the joints that differ are replaced, and nothing else. The zero of a joint becomes a part of its origin. Base and tool, which no
    /// URDF has, are left out.
    ///
    /// # Errors
    /// As [`from_urdf`](Self::from_urdf); [`Error::Urdf`] for the text of another robot; [`Error::SeveralTips`].
    pub fn urdf_with_geometry(&self, path_or_xml: &str) -> Result<String> {
        self.require_one_tip("writing a URDF")?;
        let text = text_of(path_or_xml, read_urdf)?;
        self.rewritten(&text).map_err(|error| in_file(path_or_xml, error))
    }

    fn rewritten(&self, text: &str) -> Result<String> {
        let document = Document::parse(text)?;
        let tree = Tree::new(&document)?;
        let names: Vec<&str> = self.link_names().collect();
        let [base, .., tip] = names[..] else { return Err(another(self)) };
        let link = |name| tree.link(name).map_err(|_| another(self));
        let (base, tip) = (link(base)?, link(tip)?);
        let path = tree.path(base, tip)?;
        let nominal = chain::build(&document, &tree, base, &[tip])?;
        let origins = new_origins(self, &nominal, &path)?;
        let changed =
            |(step, origin): (&TreeStep, Option<Pose>)| Some((document.joints[step.joint].name.as_str(), origin?));
        let changed: Vec<(&str, Pose)> = path.iter().zip(origins).filter_map(changed).collect();
        with_origins(text, &changed)
    }
}

fn another(robot: &Robot) -> Error {
    let problem = format!(
        "its chain of joints is not that of robot '{}': give the file that the robot was loaded from",
        robot.name()
    );
    Error::Urdf { line: None, problem: problem.into() }
}

/// New origin of each joint of the path; nothing where it is as before.
fn new_origins(robot: &Robot, nominal: &Robot, path: &[TreeStep]) -> Result<Vec<Option<Pose>>> {
    if robot.elements().len() != nominal.elements().len() {
        return Err(another(robot));
    }
    let mut origins = Vec::with_capacity(path.len());
    let mut step = StepChange::default();
    for (found, before) in robot.elements().iter().zip(nominal.elements()) {
        match (found, before) {
            (Element::Fixed(found), Element::Fixed(before)) => step.fixed = Some((*found, *before)),
            (
                Element::Moving { axis, turns, offset, .. },
                Element::Moving { axis: same, turns: kind, offset: zero, .. },
            ) if turns == kind && (axis - same).amax() < 1e-9 => {
                let by = offset - zero;
                let shift = by * axis;
                step.zero =
                    if *turns { pose::rotation(*axis, by) } else { pose::translation(shift.x, shift.y, shift.z) };
            }
            (Element::Link(name), Element::Link(same)) if name == same => {
                if let (Some(of), Some(change)) = (path.get(origins.len()), step.fixed.take()) {
                    origins.push(StepChange { fixed: Some(change), zero: step.zero }.origin(of.reversed));
                    step = StepChange::default();
                }
            }
            _ => return Err(another(robot)),
        }
    }
    Ok(origins)
}

/// Transforms of one joint.
struct StepChange {
    /// Its constant transform, now and before.
    fixed: Option<(Pose, Pose)>,
    /// Motion by which its zero has changed.
    zero: Pose,
}

impl Default for StepChange {
    fn default() -> Self {
        Self { fixed: None, zero: Pose::identity() }
    }
}

impl StepChange {
    /// The new origin; nothing if it is as before.
    fn origin(&self, reversed: bool) -> Option<Pose> {
        let (found, before) = self.fixed?;
        // From parent to child the motion follows the origin, from child to parent it comes before the inverse.
        let (found, before) = match reversed {
            false => (found * self.zero, before),
            true => ((self.zero * found).inverse(), before.inverse()),
        };
        let change = before.inverse() * found;
        let size = change.translation.vector.amax().max(change.rotation.scaled_axis().amax());
        (size > UNCHANGED).then_some(found)
    }
}

/// `text` with these origins of joints.
fn with_origins(text: &str, origins: &[(&str, Pose)]) -> Result<String> {
    let bare = xml::without_declaration(text);
    let parsed = roxmltree::Document::parse(&bare).map_err(|error| xml::not_xml(&error))?;
    let mut edits: Vec<(Range<usize>, String)> = vec![];
    for joint in xml::children(parsed.root_element(), "joint") {
        let of = |(name, _): &&(&str, Pose)| joint.attribute("name") == Some(*name);
        if let Some((_, origin)) = origins.iter().find(of) {
            edits.extend(edit(joint, origin, &bare));
        }
    }
    // Both texts end alike; only what comes before the body differs.
    let shift = text.len() as isize - bare.len() as isize;
    let mut written = text.to_owned();
    for (range, replacement) in edits.into_iter().rev() {
        let moved = |at: usize| at.saturating_add_signed(shift);
        written.replace_range(moved(range.start)..moved(range.end), &replacement);
    }
    Ok(written)
}

/// Bytes to replace, and by what.
fn edit(joint: Node, origin: &Pose, text: &str) -> Option<(Range<usize>, String)> {
    let [x, y, z] = origin.translation.vector.into();
    let (roll, pitch, yaw) = origin.rotation.euler_angles();
    let element = format!("<origin xyz=\"{x} {y} {z}\" rpy=\"{roll} {pitch} {yaw}\"/>");
    if let Some(old) = xml::children(joint, "origin").next() {
        return Some((old.range(), element));
    }
    // Without an origin it goes before the first element of the joint, on a line of its own like that one.
    let first = joint.first_element_child()?.range().start;
    let line = text[..first].rfind(['\n', '>']).map_or(0, |at| at + usize::from(text.as_bytes()[at] == b'>'));
    let space = &text[line..first];
    Some((first..first, format!("{element}{space}")))
}
