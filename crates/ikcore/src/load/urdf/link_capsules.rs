//! Collision shapes of a link: original, and as enclosing capsules.

use nalgebra::{Point3, Vector3};
use roxmltree::Node;

use super::xml;
use crate::math::{Pose, pose};
use crate::message::with_article;
use crate::robot::LinkCapsule;
use crate::shape::Shape;

/// Collision shapes of one link.
#[derive(Debug, Clone, Default)]
pub(super) struct LinkCapsules {
    pub(super) primitives: Vec<Primitive>,
    /// Shapes without a capsule.
    pub(super) unread: Vec<UnreadShape>,
}

/// Sphere, box, cylinder or capsule.
#[derive(Debug, Clone)]
pub(super) struct Primitive {
    /// Enclosing capsule.
    pub(super) capsule: LinkCapsule,
    /// Original shape.
    pub(super) exact: Shape,
}

/// Collision shape without a capsule.
#[derive(Debug, Clone)]
pub(super) struct UnreadShape {
    /// Description, for example "a mesh of link 'hand'".
    pub(super) name: String,
    pub(super) mesh: Option<UrdfMesh>,
}

/// Mesh of a link, in a file.
#[derive(Debug, Clone)]
pub(super) struct UrdfMesh {
    pub(super) link: String,
    /// File name as written in the URDF.
    pub(super) file: String,
    pub(super) scale: [f64; 3],
    /// Pose of the mesh in its link.
    pub(super) origin: Pose,
}

/// Reads the shapes of a link. Unreadable shapes are not an error, since most callers never need them.
pub(super) fn read(name: &str, link: Node) -> LinkCapsules {
    let mut read = LinkCapsules::default();
    for collision in xml::children(link, "collision") {
        let geometry = xml::children(collision, "geometry").next();
        let Some(shape) = geometry.and_then(|geometry| geometry.first_element_child()) else { continue };
        let tag = shape.tag_name().name();
        match origin(collision).and_then(|origin| primitive(name, &origin, shape)) {
            Some(primitive) => read.primitives.push(primitive),
            None => {
                let mesh = mesh(name, collision, shape);
                read.unread.push(UnreadShape { name: format!("{} of link '{name}'", with_article(tag)), mesh });
            }
        }
    }
    read
}

/// Reads a shape at `origin` in its link; `None` for unknown shapes, and for unreadable sizes.
pub(super) fn primitive(link: &str, origin: &Pose, shape: Node) -> Option<Primitive> {
    let (half, radius) = axis(shape)?;
    let [a, b] = [-1.0, 1.0].map(|sign| (origin * Point3::from(sign * half)).coords.into());
    let (center, turn) = (origin.translation.vector.into(), origin.rotation);
    let exact = match shape.tag_name().name() {
        "box" => Shape::cuboid(center, xml::vector(shape, "size", "size").ok()??, Some(*turn.matrix())),
        "cylinder" => Shape::cylinder(center, (turn * Vector3::z()).into(), radius, 2.0 * half.z),
        _ => Shape::swept_ball(a, b, radius),
    };
    Some(Primitive { capsule: LinkCapsule { link: link.into(), a, b, radius }, exact: exact.ok()? })
}

/// Reads a mesh and its pose; `None` for other shapes, and for a mesh with unreadable attributes.
pub(super) fn mesh(link: &str, element: Node, shape: Node) -> Option<UrdfMesh> {
    let file = shape.attribute("filename").filter(|_| shape.tag_name().name() == "mesh")?;
    let scale = xml::vector(shape, "scale", "scale").ok()?.unwrap_or([1.0; 3]);
    Some(UrdfMesh { link: link.into(), file: file.into(), scale, origin: origin(element)? })
}

/// Returns half of the axis, and the radius, of the capsule that encloses a shape at the origin; `None` for unknown shapes.
fn axis(shape: Node) -> Option<(Vector3<f64>, f64)> {
    let size = |name: &str| xml::number(shape, name, name).ok()?.filter(|size| *size > 0.0 && size.is_finite());
    match shape.tag_name().name() {
        "sphere" => Some((Vector3::zeros(), size("radius")?)),
        // Caps extend beyond the flat ends of a cylinder.
        "cylinder" | "capsule" => Some((Vector3::z() * 0.5 * size("length")?, size("radius")?)),
        "box" => {
            let edges = Vector3::from(xml::vector(shape, "size", "size").ok()??);
            if edges.min() <= 0.0 {
                return None;
            }
            // Axis along the longest edge; the radius reaches the corners of the cross-section.
            let along = edges.imax();
            let mut across = 0.5 * edges;
            across[along] = 0.0;
            let mut half = Vector3::zeros();
            half[along] = 0.5 * edges[along];
            Some((half, across.norm()))
        }
        _ => None,
    }
}

/// Reads the pose of the shape in its link; `None` if it is unreadable.
pub(super) fn origin(element: Node) -> Option<Pose> {
    let Some(origin) = xml::children(element, "origin").next() else { return Some(Pose::identity()) };
    let xyz = xml::vector(origin, "xyz", "xyz").ok()?.unwrap_or_default();
    let rpy = xml::vector(origin, "rpy", "rpy").ok()?;
    if rpy.is_none() && origin.has_attribute("quat_xyzw") {
        return None;
    }
    Some(pose::from_rpy(rpy.unwrap_or_default(), xyz))
}
