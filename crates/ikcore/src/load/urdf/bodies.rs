//! Collision shapes of a URDF as bodies of a robot.

use nalgebra::Point3;

use super::document::Document;
use super::link_capsules::CollisionMesh;
use super::package::Packages;
use crate::error::{Error, Result, shortened};
use crate::load::cover_cache::covered_mesh;
use crate::robot::{Bodies, LinkCapsule, MeshFit, Robot};
use crate::shape::Geometry;

/// What becomes of the collision shapes of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CollisionShapes {
    /// Spheres, cylinders, capsules and boxes become capsules that enclose them; meshes are named and not read.
    #[default]
    Primitives,
    /// Meshes are read too, and covered by few capsules.
    Fit,
    /// Nothing is read.
    Ignored,
}

/// Most capsules for one mesh.
const MOST: usize = 6;

/// The bodies of all links of `robot`.
pub(super) fn of(document: &Document, robot: &Robot, wanted: CollisionShapes, packages: &Packages) -> Result<Bodies> {
    let mut bodies = Bodies::default();
    if wanted == CollisionShapes::Ignored {
        return Ok(bodies);
    }
    for link in robot.all_link_names().filter_map(|name| document.capsules.get(name)) {
        bodies.capsules.extend(link.capsules.iter().cloned());
        for unread in &link.unread {
            match &unread.mesh {
                Some(mesh) if wanted == CollisionShapes::Fit => fit(&mut bodies, mesh, packages)?,
                _ => bodies.unread.push(unread.name.clone()),
            }
        }
    }
    Ok(bodies)
}

/// Adds the cover of a mesh.
fn fit(bodies: &mut Bodies, mesh: &CollisionMesh, packages: &Packages) -> Result<()> {
    let CollisionMesh { link, file, scale, origin } = mesh;
    let path = packages.find(file).map_err(|looked| {
        let places = looked.iter().map(|place| place.display().to_string()).take(3).collect::<Vec<_>>().join(", ");
        let problem = format!(
            "the mesh '{}' of link '{link}' is not found: give package_dirs, or collision=\"primitives\" to do without; looked \
             for {}",
            shortened(file),
            if places.is_empty() { "no folder" } else { &places }
        );
        Error::Urdf { line: None, problem }
    })?;
    let cover = covered_mesh(&path, *scale, MOST)?;
    for shape in &cover.shapes {
        let (a, b, radius) = match shape.geometry() {
            Geometry::Sphere { center, radius } => (center, center, *radius),
            Geometry::Capsule { a, b, radius } => (a, b, *radius),
            _ => continue, // a cover has no others
        };
        let [a, b] = [a, b].map(|end| (origin * Point3::from(*end)).coords.into());
        bodies.capsules.push(LinkCapsule { link: link.clone(), a, b, radius });
    }
    bodies.fits.push(MeshFit {
        link: link.clone(),
        file: file.clone(),
        volume_ratio: cover.volume_ratio,
        largest_distance: cover.largest_distance,
    });
    Ok(())
}
