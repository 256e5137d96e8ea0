//! Bodies of a robot: convex shapes fixed to its links.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::link_capsule::{LinkCapsule, LinkMesh, MeshFit};
use crate::error::Result;
use crate::shape::{Geometry, Shape};

/// A convex shape fixed to a link.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Body {
    /// Name of the link that carries it.
    pub link: String,
    /// The shape, in the frame of the link.
    pub shape: Shape,
    /// Names of other links that it may touch.
    pub touch: Vec<String>,
    /// Its origin.
    pub source: BodySource,
}

/// Origin of a body.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum BodySource {
    /// Given by [`with_capsules`](crate::robot::Robot::with_capsules), or made along the links.
    Given,
    /// A sphere, box, cylinder or capsule of the file.
    Primitive,
    /// This mesh, as the file names it.
    Mesh(String),
    /// [Attached](crate::robot::Robot::with_attached) to a link.
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
    /// A body that may touch no other link.
    pub(crate) fn new(link: String, shape: Shape, source: BodySource) -> Self {
        Self { link, shape, touch: vec![], source }
    }

    /// A capsule as a body.
    ///
    /// # Errors
    /// [`Error::NotFinite`](crate::Error::NotFinite), [`Error::OutOfRange`](crate::Error::OutOfRange) for a negative radius.
    pub(crate) fn from_capsule(capsule: LinkCapsule, source: BodySource) -> Result<Self> {
        let LinkCapsule { link, a, b, radius } = capsule;
        Ok(Self::new(link, Shape::swept_ball(a, b, radius)?, source))
    }

    /// Whether it is a sphere or capsule, and so the capsule that holds it.
    pub(crate) fn is_capsule(&self) -> bool {
        matches!(self.shape.geometry(), Geometry::Sphere { .. } | Geometry::Capsule { .. })
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
    /// The meshes whose files were found.
    meshes: Vec<LinkMesh>,
}

/// Stored form of [`Bodies`].
#[derive(Deserialize)]
struct StoredBodies {
    list: Vec<Body>,
    unread: Vec<String>,
    fits: Vec<MeshFit>,
    meshes: Vec<LinkMesh>,
}

impl From<StoredBodies> for Bodies {
    fn from(stored: StoredBodies) -> Self {
        let StoredBodies { list, unread, fits, meshes } = stored;
        Self { unread, fits, meshes, ..Self::new(list) }
    }
}

impl Bodies {
    /// These bodies, not from a file.
    pub fn new(list: Vec<Body>) -> Self {
        let capsules = list.iter().map(Body::capsule).collect();
        Self { list, capsules, ..Self::default() }
    }

    /// Notes a collision shape that does not become a body.
    pub fn note_unread(&mut self, name: String) {
        self.unread.push(name);
    }

    /// Notes how well capsules follow a mesh.
    pub fn note_fit(&mut self, fit: MeshFit) {
        self.fits.push(fit);
    }

    /// Notes a mesh whose file was found.
    pub fn note_mesh(&mut self, mesh: LinkMesh) {
        self.meshes.push(mesh);
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

    pub fn meshes(&self) -> &[LinkMesh] {
        &self.meshes
    }

    /// Adds a body.
    pub fn push(&mut self, body: Body) {
        self.capsules.push(body.capsule());
        self.list.push(body);
    }
}
