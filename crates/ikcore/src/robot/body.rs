//! Bodies of a robot: convex shapes fixed to its links.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::link_capsule::{LinkCapsule, MeshFit};
use crate::error::Result;
use crate::shape::Shape;

/// A convex shape fixed to a link.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Body {
    /// Name of the link that carries it.
    pub link: String,
    /// The shape, in the frame of the link.
    pub shape: Shape,
    /// Where it comes from.
    pub source: BodySource,
}

/// Where a body comes from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum BodySource {
    /// Given by [`with_capsules`](crate::Robot::with_capsules), or made along the links.
    Given,
    /// A sphere, box, cylinder or capsule of the file.
    Primitive,
    /// This mesh, as the file names it.
    Mesh(String),
    /// [Attached](crate::Robot::with_attached) to a link.
    Attached,
}

impl fmt::Display for BodySource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Given => write!(f, "given"),
            Self::Primitive => write!(f, "collision shape"),
            Self::Mesh(file) => write!(f, "mesh {file}"),
            Self::Attached => write!(f, "attached"),
        }
    }
}

impl Body {
    /// A capsule as a body.
    ///
    /// # Errors
    /// [`Error::NotFinite`](crate::Error::NotFinite), [`Error::OutOfRange`](crate::Error::OutOfRange) for a negative radius.
    pub(crate) fn from_capsule(capsule: LinkCapsule, source: BodySource) -> Result<Self> {
        let LinkCapsule { link, a, b, radius } = capsule;
        Ok(Self { link, shape: Shape::swept_ball(a, b, radius)?, source })
    }

    /// The capsule that holds it.
    fn capsule(&self) -> LinkCapsule {
        let (a, b, radius) = self.shape.enclosing_capsule();
        LinkCapsule { link: self.link.clone(), a, b, radius }
    }
}

/// The bodies of a robot, and the collision shapes that were not converted.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "StoredBodies")]
pub(crate) struct Bodies {
    list: Vec<Body>,
    /// The capsule that holds each body.
    #[serde(skip_serializing)]
    capsules: Vec<LinkCapsule>,
    /// Collision shapes without a body, for example "a mesh of link 'hand'".
    unread: Vec<String>,
    /// The meshes that capsules were fitted to.
    fits: Vec<MeshFit>,
}

/// What [`Bodies`] follow from.
#[derive(Deserialize)]
struct StoredBodies {
    list: Vec<Body>,
    unread: Vec<String>,
    fits: Vec<MeshFit>,
}

impl From<StoredBodies> for Bodies {
    fn from(stored: StoredBodies) -> Self {
        Self::new(stored.list, stored.unread, stored.fits)
    }
}

impl Bodies {
    /// These bodies; `unread` are the collision shapes without one, and `fits` say how well capsules follow meshes.
    pub fn new(list: Vec<Body>, unread: Vec<String>, fits: Vec<MeshFit>) -> Self {
        Self { capsules: list.iter().map(Body::capsule).collect(), list, unread, fits }
    }

    pub fn list(&self) -> &[Body] {
        &self.list
    }

    pub fn capsules(&self) -> &[LinkCapsule] {
        &self.capsules
    }

    pub fn unread(&self) -> &[String] {
        &self.unread
    }

    pub fn fits(&self) -> &[MeshFit] {
        &self.fits
    }

    /// Adds a body.
    pub fn push(&mut self, body: Body) {
        self.capsules.push(body.capsule());
        self.list.push(body);
    }
}
