//! Visual shapes of a URDF.

use std::collections::HashMap;
use std::path::absolute;

use roxmltree::Node;

use super::link_capsules::{UrdfMesh, mesh, origin, primitive};
use super::package::Packages;
use super::xml;
use crate::robot::{Robot, Visual, VisualShape};

/// Reads the visual shapes of all links, with file names as written. Unreadable shapes are left out, since only pictures need
/// them.
pub(super) fn read(root: Node) -> Vec<Visual> {
    let named = |material: Node| Some((material.attribute("name")?.to_owned(), color(material)?));
    let materials: HashMap<_, _> = xml::children(root, "material").filter_map(named).collect();
    let mut visuals = vec![];
    for link in xml::children(root, "link") {
        for visual in xml::children(link, "visual") {
            let Some(shape) = shape_of(visual) else { continue };
            let material = xml::children(visual, "material").next();
            let color = material.and_then(|own| color(own).or_else(|| materials.get(own.attribute("name")?).copied()));
            visuals.push(Visual { link: link.attribute("name").unwrap_or_default().into(), shape, color });
        }
    }
    visuals
}

/// Returns the visual shapes of the links of `robot`, with their files located.
pub(super) fn of(visuals: &[Visual], robot: &Robot, packages: &Packages) -> Vec<Visual> {
    let links: Vec<&str> = robot.all_link_names().collect();
    let mut found: Vec<Visual> = visuals.iter().filter(|each| links.contains(&each.link.as_str())).cloned().collect();
    for visual in &mut found {
        if let VisualShape::Mesh { path, .. } = &mut visual.shape
            && let Ok(file) = packages.find(path)
        {
            *path = absolute(&file).unwrap_or(file).display().to_string();
        }
    }
    found
}

fn shape_of(visual: Node) -> Option<VisualShape> {
    let shape = xml::children(visual, "geometry").next()?.first_element_child()?;
    if let Some(UrdfMesh { file, scale, origin, .. }) = mesh("", visual, shape) {
        return Some(VisualShape::Mesh { path: file, scale, origin });
    }
    Some(VisualShape::Solid(primitive("", &origin(visual)?, shape)?.exact))
}

fn color(material: Node) -> Option<[f64; 4]> {
    let text = xml::children(material, "color").next()?.attribute("rgba")?;
    let numbers: Vec<f64> = text.split_whitespace().map_while(|word| word.parse().ok()).collect();
    let color = <[f64; 4]>::try_from(numbers).ok()?;
    color.iter().all(|part| (0.0..=1.0).contains(part)).then_some(color)
}
