//! Conversion of URDF collision shapes to bodies of a robot.

use std::path::{Path, PathBuf};

use nalgebra::Point3;

use super::document::Document;
use super::link_capsules::{Primitive, UrdfMesh};
use super::package::Packages;
use crate::error::{Error, Result, shortened};
use crate::load::cover_cache::covered_mesh;
use crate::load::mesh::read_mesh;
use crate::message::{Setting, message};
use crate::robot::{Bodies, Body, BodySource, LinkCapsule, LinkMesh, MeshFit, Robot};
use crate::shape::Geometry;

/// Treatment of the collision shapes of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CollisionShapes {
    /// Converts spheres, cylinders, capsules and boxes to enclosing capsules; lists meshes without reading them.
    #[default]
    Primitives,
    /// Reads meshes too, and covers each by few capsules.
    Fit,
    /// Converts meshes to their convex hulls; keeps spheres, cylinders, capsules and boxes as they are.
    Hulls,
    /// Ignores all collision shapes.
    Ignored,
}

/// Largest number of capsules for one mesh.
const MOST: usize = 6;

/// Returns the bodies of all links of `robot`.
pub(super) fn of(document: &Document, robot: &Robot, wanted: CollisionShapes, packages: &Packages) -> Result<Bodies> {
    let mut bodies = Bodies::default();
    if wanted == CollisionShapes::Ignored {
        return Ok(bodies);
    }
    for link in robot.all_link_names().filter_map(|name| document.capsules.get(name)) {
        for Primitive { capsule, exact } in &link.primitives {
            bodies.push(match wanted {
                CollisionShapes::Hulls => Body::new(capsule.link.clone(), exact.clone(), BodySource::Primitive),
                _ => Body::from_capsule(capsule.clone(), BodySource::Primitive)?,
            });
        }
        for shape in &link.unread {
            let path = shape.mesh.as_ref().map(|mesh| found(mesh, packages));
            if let (Some(mesh), Some(Ok(path))) = (&shape.mesh, &path)
                && packages.of_a_file()
            {
                bodies.note_mesh(mesh.at(path));
            }
            match (&shape.mesh, path) {
                (Some(mesh), Some(path)) if wanted != CollisionShapes::Primitives => {
                    add_mesh(&mut bodies, mesh, &path?, wanted)?;
                }
                _ => bodies.note_unread(shape.name.clone()),
            }
        }
    }
    Ok(bodies)
}

impl UrdfMesh {
    /// Returns the mesh as read from `path`.
    fn at(&self, path: &Path) -> LinkMesh {
        let path = path.display().to_string();
        LinkMesh { link: self.link.clone(), path, scale: self.scale, origin: self.origin }
    }
}

/// Adds the hull of a mesh, or the capsules that cover it.
fn add_mesh(bodies: &mut Bodies, mesh: &UrdfMesh, path: &Path, wanted: CollisionShapes) -> Result<()> {
    let hull = if wanted == CollisionShapes::Hulls { hull(mesh, path)? } else { None };
    if let Some(hull) = hull {
        bodies.push(hull);
        return Ok(());
    }
    let (capsules, fit) = fitted(mesh, path)?;
    capsules.into_iter().for_each(|body| bodies.push(body));
    bodies.note_fit(fit);
    Ok(())
}

/// Returns the convex hull of a mesh; `None` for a planar mesh, which has none.
fn hull(mesh: &UrdfMesh, path: &Path) -> Result<Option<Body>> {
    let UrdfMesh { link, file, scale, origin } = mesh;
    let shape = read_mesh(path, *scale)?;
    let Geometry::Mesh(triangles) = shape.geometry() else { return Ok(None) };
    let body = |shape| Body::new(link.clone(), shape, BodySource::Mesh(file.clone()));
    Ok(triangles.convex_hull(origin).map(body))
}

/// Returns capsules that cover a mesh, and the quality of the fit.
fn fitted(mesh: &UrdfMesh, path: &Path) -> Result<(Vec<Body>, MeshFit)> {
    let UrdfMesh { link, file, scale, origin } = mesh;
    let cover = covered_mesh(path, *scale, MOST)?;
    let bodies = cover.shapes.iter().map(|shape| {
        let (a, b, radius) = shape.enclosing_capsule();
        let [a, b] = [a, b].map(|end| (origin * Point3::from(end)).coords.into());
        Body::from_capsule(LinkCapsule { link: link.clone(), a, b, radius }, BodySource::Mesh(file.clone()))
    });
    let (volume_ratio, largest_distance) = (cover.volume_ratio, cover.largest_distance);
    let fit = MeshFit { link: link.clone(), file: file.clone(), volume_ratio, largest_distance };
    Ok((bodies.collect::<Result<_>>()?, fit))
}

/// Locates the file of a mesh.
fn found(mesh: &UrdfMesh, packages: &Packages) -> Result<PathBuf> {
    let UrdfMesh { link, file, .. } = mesh;
    packages.find(file).map_err(|looked| {
        let places = looked.iter().map(|place| place.display().to_string()).take(3).collect::<Vec<_>>().join(", ");
        let places = if places.is_empty() { "no folder" } else { &places };
        let problem = message![
            format!("the mesh '{}' of link '{link}' is not found: give package_dirs, or ", shortened(file)),
            Setting::Primitives,
            format!(" to do without; looked for {places}"),
        ];
        Error::Urdf { line: None, problem }
    })
}
