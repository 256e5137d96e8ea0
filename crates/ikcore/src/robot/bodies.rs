//! The room that a robot takes up: capsules fixed to its links.

use serde::{Deserialize, Serialize};

use super::model::Robot;
use crate::error::{Error, Result, require_finite, suggestion};
use crate::kinematics::chain::{LinkFrame, Motion};
use crate::kinematics::forward::StageFrames;
use crate::math::arithmetic::Separate;
use crate::math::vector::distance;
use crate::math::{Frame, MAX_DOF};

/// All points within `radius` (m) of the segment from `a` to `b`, which are given in the frame of the link (m).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LinkCapsule {
    /// Name of the link that carries it.
    pub link: String,
    /// One end of the axis (m).
    pub a: [f64; 3],
    /// The other end (m); equal to `a` for a sphere.
    pub b: [f64; 3],
    /// Radius (m); zero for a thin rod.
    pub radius: f64,
}

/// The capsules of a robot, and what of its description could not become one.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct CollisionModel {
    pub capsules: Vec<LinkCapsule>,
    /// Collision shapes that were passed over, such as "a mesh of link 'hand'".
    pub unread: Vec<String>,
}

/// Shorter segments count as points (m).
const SHORTEST: f64 = 1e-9;

impl Robot {
    /// The room that the links take up; none unless given or fitted to a URDF's collision shapes.
    pub fn capsules(&self) -> &[LinkCapsule] {
        &self.collision().capsules
    }

    /// Collision shapes of a URDF that became no capsule, such as "a mesh of link 'hand'": without
    /// [`with_capsules`](Self::with_capsules) they would be missing.
    pub fn unread_collision_shapes(&self) -> &[String] {
        &self.collision().unread
    }

    /// The same robot, its links taking up these capsules and nothing else.
    ///
    /// # Errors
    /// [`Error::UnknownLink`], [`Error::NotFinite`], [`Error::OutOfRange`] for a negative radius.
    pub fn with_capsules(&self, capsules: Vec<LinkCapsule>) -> Result<Self> {
        for (i, capsule) in capsules.iter().enumerate() {
            if !self.link_names().any(|name| name == capsule.link) {
                return Err(Error::UnknownLink {
                    robot: self.name().into(),
                    name: capsule.link.clone(),
                    suggestion: suggestion(&capsule.link, self.link_names()),
                    known: self.link_names().collect::<Vec<_>>().join(", "),
                });
            }
            let ends = [capsule.a, capsule.b];
            require_finite(&format!("capsule {i} of link '{}'", capsule.link), ends.as_flattened(), |k| {
                format!("coordinate {} of end {}", ["x", "y", "z"][k % 3], ["a", "b"][k / 3])
            })?;
            checked_radius(&format!("radius of capsule {i} of link '{}'", capsule.link), capsule.radius)?;
        }
        Ok(self.with_collision(CollisionModel { capsules, unread: vec![] }))
    }

    /// The same robot with a capsule of this `radius` (m) along every link: from where the joint before it holds it,
    /// over the frames of its links, to the axis of the next joint; the last one ends at the tip. The way that a
    /// sliding joint leaves open between two links is part of neither.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a negative radius; [`Error::InvalidRobot`] where nothing between two joints has a name.
    pub fn with_capsules_along_links(&self, radius: f64) -> Result<Self> {
        checked_radius("radius", radius)?;
        let chain = self.chain();
        let moving = chain.moving;
        let mut capsules = vec![];
        for body in 0..=moving {
            // Everything that moves with this body, from its own joint's frame.
            let frames: Vec<&LinkFrame> = chain.links.iter().filter(|link| link.stages == body).collect();
            let joint = (body > 0).then_some([0.0; 3]);
            let end = if body < moving { chain.stages.frame(body).origin } else { chain.tip.origin };
            let places = joint.into_iter().chain(frames.iter().map(|link| link.offset.origin)).chain([end]);
            let places: Vec<[f64; 3]> = places.collect();
            for ends in places.windows(2).filter(|ends| distance(&ends[0], &ends[1]) > SHORTEST) {
                let Some(carrier) = frames.first() else { return Err(self.nameless(body)) };
                let from_link = carrier.offset.inverse();
                let [a, b] = [ends[0], ends[1]].map(|end| from_link.place::<Separate>(&end));
                capsules.push(LinkCapsule { link: carrier.name.clone(), a, b, radius });
            }
        }
        Ok(self.with_collision(CollisionModel { capsules, unread: vec![] }))
    }

    fn nameless(&self, body: usize) -> Error {
        let problem = format!(
            "no link is named between moving elements {} and {}, so that none can carry a capsule: name one there",
            body,
            body + 1
        );
        Error::InvalidRobot { robot: self.name().into(), problem }
    }

    /// After how many moving elements a link sits, and its frame from there.
    pub(crate) fn place_of_link(&self, link: &str) -> Option<(usize, Frame)> {
        let found = self.chain().links.iter().find(|frame| frame.name == link)?;
        Some((found.stages, found.offset))
    }

    /// The frames reached after 0, 1, 2, ... moving elements; the z axis of each but the first is the element's axis.
    pub(crate) fn write_stage_frames(&self, q: &[f64], frames: &mut [Frame; MAX_DOF + 1]) {
        let frames: &mut StageFrames = frames;
        (self.chain().kernels.stage_frames)(self.chain(), q, frames);
    }

    /// By how much moving element `stage` turns (rad) and slides (m) when each joint changes by up to `reach`.
    #[inline]
    pub(crate) fn stage_travel(&self, stage: usize, reach: &[f64]) -> [f64; 2] {
        let Motion { joint, turn_scale, slide_scale, .. } = self.chain().motions[stage];
        [turn_scale.abs() * reach[joint], slide_scale.abs() * reach[joint]]
    }
}

fn checked_radius(what: &str, radius: f64) -> Result<()> {
    let valid = radius.is_finite() && radius >= 0.0;
    if valid { Ok(()) } else { Err(Error::out_of_range(what, "zero or more and finite", radius)) }
}
