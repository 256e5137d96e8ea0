//! Bodies of a robot: read, given explicitly or generated along the links.

use super::body::{Bodies, Body, BodySource};
use super::link_capsule::{LinkCapsule, LinkMesh, MeshFit};
use super::model::Robot;
use crate::bodies::CarriedBody;
use crate::error::{Error, Result, require_finite};
use crate::kinematics::chain::LinkFrame;
use crate::math::arithmetic::NoFma;
use crate::math::vector::distance;
use crate::message::Setting;

/// Shorter segments count as points (m).
const SHORTEST: f64 = 1e-9;

impl Robot {
    /// The bodies on the links; none unless given, attached or read from the collision shapes of a file.
    pub fn bodies(&self) -> &[Body] {
        self.parts().bodies.list()
    }

    /// A capsule around each body, in the order of [`bodies`](Self::bodies). Spheres and capsules are their own.
    pub fn capsules(&self) -> &[LinkCapsule] {
        self.parts().bodies.capsules()
    }

    /// Collision shapes of a URDF that were not converted to a capsule, for example "a mesh of link 'hand'". Add
    /// capsules for them by [`with_capsules`](Self::with_capsules).
    pub fn unread_collision_shapes(&self) -> &[String] {
        self.parts().bodies.unread()
    }

    /// The meshes of a URDF that capsules were fitted to, with how well they follow them.
    pub fn mesh_fits(&self) -> &[MeshFit] {
        self.parts().bodies.fits()
    }

    /// The collision meshes of a URDF file whose files were found, read or not.
    pub fn meshes(&self) -> &[LinkMesh] {
        self.parts().bodies.meshes()
    }

    /// Copy of the robot with these capsules and no others.
    ///
    /// # Errors
    /// [`Error::UnknownLink`], [`Error::NotFinite`], [`Error::OutOfRange`] for a negative radius.
    pub fn with_capsules(&self, capsules: Vec<LinkCapsule>) -> Result<Self> {
        for (i, capsule) in capsules.iter().enumerate() {
            self.link_number(&capsule.link)?;
            let ends = [capsule.a, capsule.b];
            require_finite(format!("capsule {i} of link '{}'", capsule.link), ends.as_flattened(), |k| {
                format!("coordinate {} of end {}", ["x", "y", "z"][k % 3], ["a", "b"][k / 3])
            })?;
            checked_radius(&format!("radius of capsule {i} of link '{}'", capsule.link), capsule.radius)?;
        }
        self.with_capsules_as_bodies(capsules)
    }

    /// Copy of the robot with a capsule of this `radius` (m) along every link: from the preceding joint, through the
    /// frames of its links, to the axis of the next joint; the last capsule ends at the tip. The gap that a prismatic
    /// joint opens between two links is not covered.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a negative radius; [`Error::InvalidRobot`] if nothing between two joints has a name;
    /// [`Error::SeveralTips`].
    pub fn with_capsules_along_links(&self, radius: f64) -> Result<Self> {
        checked_radius("radius", radius)?;
        self.require_one_tip(Setting::CapsulesAlongLinks)?;
        let chain = self.chain();
        let moving = chain.moving;
        let mut capsules = vec![];
        for body in 0..=moving {
            // Everything that moves with this body, from its own joint's frame.
            let links = chain.links.iter().zip(self.link_names());
            let links: Vec<(&LinkFrame, &str)> = links.filter(|(link, _)| link.stages == body).collect();
            let joint = (body > 0).then_some([0.0; 3]);
            let end = if body < moving { chain.stages.frame(body).origin } else { chain.tip.origin };
            let places = joint.into_iter().chain(links.iter().map(|(link, _)| link.offset.origin)).chain([end]);
            let places: Vec<[f64; 3]> = places.collect();
            for ends in places.windows(2).filter(|ends| distance(&ends[0], &ends[1]) > SHORTEST) {
                let Some((carrier, name)) = links.first() else { return Err(self.nameless(body)) };
                let from_link = carrier.offset.inverse();
                let [a, b] = [ends[0], ends[1]].map(|end| from_link.transform::<NoFma>(&end));
                capsules.push(LinkCapsule { link: (*name).into(), a, b, radius });
            }
        }
        self.with_capsules_as_bodies(capsules)
    }

    /// The bodies, each in the frame of the moving element that carries it.
    pub(super) fn carried_bodies(&self) -> Vec<CarriedBody> {
        let numbers = self.link_numbers();
        let bodies = self.capsules().iter().zip(self.bodies()).filter_map(|(capsule, body)| {
            let carrier = self.carrier_of_link_number(*numbers.get(capsule.link.as_str())?);
            let solid = (!body.is_capsule()).then_some(&body.shape);
            Some(CarriedBody::new(&capsule.link, carrier, [capsule.a, capsule.b], capsule.radius, solid))
        });
        bodies.collect()
    }

    fn with_capsules_as_bodies(&self, capsules: Vec<LinkCapsule>) -> Result<Self> {
        let bodies = capsules.into_iter().map(|capsule| Body::from_capsule(capsule, BodySource::Given));
        Ok(self.with_bodies(Bodies::new(bodies.collect::<Result<_>>()?)))
    }

    fn nameless(&self, body: usize) -> Error {
        let problem = format!(
            "no link is named between moving elements {} and {}, so that none can carry a capsule: name one there",
            body,
            body + 1
        );
        Error::InvalidRobot { robot: self.name().into(), problem: problem.into() }
    }
}

fn checked_radius(what: &str, radius: f64) -> Result<()> {
    let valid = radius.is_finite() && radius >= 0.0;
    if valid { Ok(()) } else { Err(Error::out_of_range(what, "zero or more and finite", radius)) }
}
