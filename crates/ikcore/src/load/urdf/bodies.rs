//! Collision shapes of a URDF as bodies of a robot.

use std::path::PathBuf;

use nalgebra::Point3;

use super::document::Document;
use super::link_capsules::CollisionMesh;
use super::package::Packages;
use crate::error::{Error, Result, shortened};
use crate::load::cover_cache::covered_mesh;
use crate::robot::{Bodies, Body, BodySource, LinkCapsule, MeshFit, Robot};

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
    let (mut list, mut unread, mut fits) = (vec![], vec![], vec![]);
    if wanted == CollisionShapes::Ignored {
        return Ok(Bodies::default());
    }
    for link in robot.all_link_names().filter_map(|name| document.capsules.get(name)) {
        for capsule in &link.capsules {
            list.push(Body::from_capsule(capsule.clone(), BodySource::Primitive)?);
        }
        for shape in &link.unread {
            match &shape.mesh {
                Some(mesh) if wanted == CollisionShapes::Fit => {
                    let (bodies, fit) = fitted(mesh, packages)?;
                    list.extend(bodies);
                    fits.push(fit);
                }
                _ => unread.push(shape.name.clone()),
            }
        }
    }
    Ok(Bodies::new(list, unread, fits))
}

/// Capsules that cover a mesh, and how well.
fn fitted(mesh: &CollisionMesh, packages: &Packages) -> Result<(Vec<Body>, MeshFit)> {
    let CollisionMesh { link, file, scale, origin } = mesh;
    let cover = covered_mesh(&found(mesh, packages)?, *scale, MOST)?;
    let bodies = cover.shapes.iter().map(|shape| {
        let (a, b, radius) = shape.enclosing_capsule();
        let [a, b] = [a, b].map(|end| (origin * Point3::from(end)).coords.into());
        Body::from_capsule(LinkCapsule { link: link.clone(), a, b, radius }, BodySource::Mesh(file.clone()))
    });
    let (volume_ratio, largest_distance) = (cover.volume_ratio, cover.largest_distance);
    let fit = MeshFit { link: link.clone(), file: file.clone(), volume_ratio, largest_distance };
    Ok((bodies.collect::<Result<_>>()?, fit))
}

/// The file of a mesh.
fn found(mesh: &CollisionMesh, packages: &Packages) -> Result<PathBuf> {
    let CollisionMesh { link, file, .. } = mesh;
    packages.find(file).map_err(|looked| {
        let places = looked.iter().map(|place| place.display().to_string()).take(3).collect::<Vec<_>>().join(", ");
        let problem = format!(
            "the mesh '{}' of link '{link}' is not found: give package_dirs, or collision=\"primitives\" to do without; looked \
             for {}",
            shortened(file),
            if places.is_empty() { "no folder" } else { &places }
        );
        Error::Urdf { line: None, problem }
    })
}
