//! Things that a link carries, such as a grasped part.

use std::sync::Arc;

use super::body::{Body, BodySource};
use super::model::Robot;
use super::off_chain::OffChainLink;
use super::pair_rule::PairRule;
use crate::error::{Error, Result};
use crate::message::with_article;
use crate::shape::Shape;

impl Robot {
    /// Copy of the robot with `shape`, in the frame of `link`, attached to that link, as a body of its own named `name`; without a
    /// name it is "attached", "attached_2" and so on.
    ///
    /// It is tested against obstacles and against the links of the robot but
    /// `link` itself, those that move with it, and those named in `touch`; and like any link without an SRDF
    /// ([`collision_pairs`](Self::collision_pairs)) not against those that it always touches or never meets.
    ///
    /// # Errors
    /// [`Error::UnknownLink`]; [`Error::InvalidObstacle`] for a shape that has no end, or is not convex;
    /// [`Error::InvalidRobot`] for a name that is taken.
    pub fn with_attached(&self, link: &str, shape: &Shape, touch: &[&str], name: Option<&str>) -> Result<Self> {
        let parent = self.link_number(link)?;
        touch.iter().try_for_each(|link| self.link_number(link).map(|_| ()))?;
        if !shape.can_be_carried() {
            let problem = format!(
                "{} cannot be attached: a Sphere, Box, Capsule, Cylinder, Ellipsoid or ConvexMesh can",
                with_article(shape.name())
            );
            return Err(Error::InvalidObstacle { problem });
        }
        let name = name.map_or_else(|| self.free_name(), str::to_owned);
        let mut parts = self.parts().clone();
        if let PairRule::Given(pairs) = &mut parts.pairs {
            let mut others: Vec<&str> = self.bodies().iter().map(|body| body.link.as_str()).collect();
            others.dedup();
            let moves = |other: &&str| {
                self.carrier_of_link(other).map(|(frame, _)| frame) != self.carrier_of_link(link).map(|p| p.0)
            };
            pairs.extend(others.into_iter().filter(moves).map(|other| [other.to_owned(), name.clone()]));
        }
        parts.may_touch.extend(touch.iter().map(|other| [name.clone(), (*other).to_owned()]));
        let mut touch: Vec<String> = touch.iter().map(|link| (*link).to_owned()).collect();
        touch.sort_unstable();
        touch.dedup();
        parts.bodies.push(Body { link: name.clone(), shape: shape.clone(), touch, source: BodySource::Attached });
        Arc::make_mut(&mut parts.off_chain).links.push(OffChainLink { name, parent, elements: vec![] });
        self.with_parts_beside_chain(parts)
    }

    /// The first of "attached", "attached_2" and so on that no link has.
    fn free_name(&self) -> String {
        let numbered = (2..).map(|i| format!("attached_{i}"));
        let mut names = std::iter::once("attached".to_owned()).chain(numbered);
        names.find(|name| self.link_number(name).is_err()).unwrap_or_default()
    }
}
