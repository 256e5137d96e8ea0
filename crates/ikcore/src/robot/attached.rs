//! Things that a link carries, such as a grasped part.

use std::sync::Arc;

use nalgebra::{Point3, Vector3};

use super::link_capsule::LinkCapsule;
use super::model::Robot;
use super::off_chain::OffChainLink;
use super::pair_rule::PairRule;
use crate::error::{Error, Result};
use crate::math::Pose;
use crate::shape::{Geometry, Shape};

impl Robot {
    /// The same robot with `shape`, in the frame of `link`, attached to that link, as a body of its own named `name`; without a
    /// name it is "attached", "attached_2" and so on.
    ///
    /// The body is the capsule that encloses the shape. It is tested against obstacles and against the links of the robot but
    /// `link` itself, those that move with it, and those named in `touch`; and like any link without an SRDF
    /// ([`collision_pairs`](Self::collision_pairs)) not against those that it always touches or never meets.
    ///
    /// # Errors
    /// [`Error::UnknownLink`]; [`Error::InvalidObstacle`] for a shape that has no end, or is not convex;
    /// [`Error::InvalidRobot`] for a name that is taken.
    pub fn with_attached(&self, link: &str, shape: &Shape, touch: &[&str], name: Option<&str>) -> Result<Self> {
        let parent = self.link_number(link)?;
        touch.iter().try_for_each(|link| self.link_number(link).map(|_| ()))?;
        let (a, b, radius) = enclosing_capsule(shape).ok_or_else(|| Error::InvalidObstacle {
            problem: format!(
                "a {} cannot be attached: a Sphere, Box, Capsule, Cylinder, Ellipsoid or ConvexMesh can",
                shape.name()
            ),
        })?;
        let name = name.map_or_else(|| self.free_name(), str::to_owned);
        let mut parts = self.parts().clone();
        if let PairRule::Given(pairs) = &mut parts.pairs {
            let mut others: Vec<&str> = self.capsules().iter().map(|capsule| capsule.link.as_str()).collect();
            others.dedup();
            let moves = |other: &&str| {
                self.place_of_link(other).map(|(frame, _)| frame) != self.place_of_link(link).map(|p| p.0)
            };
            pairs.extend(others.into_iter().filter(moves).map(|other| [other.to_owned(), name.clone()]));
        }
        parts.may_touch.extend(touch.iter().map(|other| [name.clone(), (*other).to_owned()]));
        parts.bodies.capsules.push(LinkCapsule { link: name.clone(), a, b, radius });
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

/// Ends and radius of a capsule that holds a bounded convex shape.
fn enclosing_capsule(shape: &Shape) -> Option<([f64; 3], [f64; 3], f64)> {
    match shape.geometry() {
        Geometry::Sphere { center, radius } => Some((*center, *center, *radius)),
        Geometry::Capsule { a, b, radius } => Some((*a, *b, *radius)),
        Geometry::Cylinder { center, axis, radius, length } => {
            let end = |side: f64| std::array::from_fn(|k| center[k] + side * length * axis[k]);
            Some((end(-0.5), end(0.5), *radius))
        }
        // Along the longest edge; the radius reaches the corners of the cross-section.
        Geometry::Box { pose, size } => {
            Some(along_longest(pose, &(0.5 * Vector3::from(*size)), |across| across.norm()))
        }
        Geometry::Ellipsoid { pose, semi_axes } => {
            Some(along_longest(pose, &Vector3::from(*semi_axes), |across| across.amax()))
        }
        Geometry::ConvexMesh(hull) => {
            let points = hull.points().iter().map(|point| Vector3::from(*point));
            let middle = points.clone().sum::<Vector3<f64>>() / hull.points().len() as f64;
            let farthest = points.clone().map(|point| point - middle).max_by(|a, b| a.norm().total_cmp(&b.norm()))?;
            let axis = farthest.normalize();
            let along = points.clone().map(|point| (point - middle).dot(&axis));
            let (low, high) = along.fold((0.0_f64, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
            let radius = points.map(|point| (point - middle).cross(&axis).norm()).fold(0.0, f64::max);
            Some(((middle + low * axis).into(), (middle + high * axis).into(), radius))
        }
        _ => None,
    }
}

/// The capsule along the longest of three half extents, with the radius that `reach` gives of the other two.
fn along_longest(pose: &Pose, half: &Vector3<f64>, reach: impl Fn(&Vector3<f64>) -> f64) -> ([f64; 3], [f64; 3], f64) {
    let longest = half.imax();
    let (mut axis, mut across) = (Vector3::zeros(), *half);
    axis[longest] = half[longest];
    across[longest] = 0.0;
    let end = |side: f64| (pose * Point3::from(side * axis)).coords.into();
    (end(-1.0), end(1.0), reach(&across))
}
