//! COLLADA (DAE) reader: geometries, placed by the nodes of a scene.
//!
//! Lengths are converted from the unit of the file, and its up axis is ignored: RViz does the same, coal ignores both.

use std::cell::Cell;
use std::collections::HashMap;

use nalgebra::{Matrix4, Point3, Rotation3, Unit, Vector3};
use roxmltree::{Document, Node};

use super::parsed::{Parsed, Triangles, number};

type Parse<T> = Result<T, String>;

/// Largest depth of a scene; deeper ones may contain themselves.
const DEEPEST: usize = 64;
/// Largest number of nodes; nodes may repeat other nodes, and these again others.
const MOST_NODES: usize = 100_000;

pub(super) fn parse(text: &str) -> Parsed {
    let document = Document::parse(text).map_err(|error| format!("not XML at {}", error.pos()))?;
    let file = File::of(&document)?;
    let mut read = Triangles::default();
    match file.scene() {
        Some(scene) => {
            for node in children(scene, "node") {
                file.add_node(node, &file.to_metres, &mut read, 0)?;
            }
        }
        // Files without a scene have their geometries at the origin.
        None => {
            for geometry in document.descendants().filter(|node| node.has_tag_name_any("geometry")) {
                file.add_geometry(geometry, &file.to_metres, &mut read)?;
            }
        }
    }
    Ok(read)
}

/// Access to elements by local name, since files differ in their namespaces.
trait LocalName {
    fn has_tag_name_any(&self, name: &str) -> bool;
}

impl LocalName for Node<'_, '_> {
    fn has_tag_name_any(&self, name: &str) -> bool {
        self.is_element() && self.tag_name().name() == name
    }
}

fn children<'a, 'i>(node: Node<'a, 'i>, name: &'static str) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(move |child| child.has_tag_name_any(name))
}

struct File<'a, 'i> {
    document: &'a Document<'i>,
    by_id: HashMap<&'a str, Node<'a, 'i>>,
    to_metres: Matrix4<f64>,
    /// Number of nodes visited.
    visited: Cell<usize>,
}

impl<'a, 'i> File<'a, 'i> {
    fn of(document: &'a Document<'i>) -> Parse<Self> {
        let root = document.root_element();
        if !root.has_tag_name_any("COLLADA") {
            return Err("its root is not <COLLADA>".into());
        }
        let with_id = document.descendants().filter_map(|node| Some((node.attribute("id")?, node)));
        let by_id = with_id.collect();
        let asset = children(root, "asset").next();
        let unit = asset.and_then(|asset| children(asset, "unit").next()).and_then(|unit| unit.attribute("meter"));
        let unit = unit.map_or(Ok(1.0), number)?;
        if unit <= 0.0 {
            return Err(format!("its unit must be positive, got {unit} m"));
        }
        Ok(Self { document, by_id, to_metres: Matrix4::new_scaling(unit), visited: Cell::new(0) })
    }

    /// Returns the element with a URL of the form "#part".
    fn named(&self, url: &str) -> Parse<Node<'a, 'i>> {
        let id = url.strip_prefix('#').ok_or("a url that is not in this file")?;
        self.by_id.get(id).copied().ok_or("nothing has the id that a url names".into())
    }

    fn scene(&self) -> Option<Node<'a, 'i>> {
        let root = self.document.root_element();
        let instance = children(root, "scene").flat_map(|scene| children(scene, "instance_visual_scene")).next();
        match instance.and_then(|instance| instance.attribute("url")) {
            Some(url) => self.named(url).ok(),
            None => self.document.descendants().find(|node| node.has_tag_name_any("visual_scene")),
        }
    }

    fn add_node(&self, node: Node<'a, 'i>, parent: &Matrix4<f64>, read: &mut Triangles, depth: usize) -> Parse<()> {
        self.visited.set(self.visited.get() + 1);
        if depth > DEEPEST || self.visited.get() > MOST_NODES {
            return Err(format!("its scene has more than {MOST_NODES} nodes, or is nested more than {DEEPEST} times"));
        }
        let mut place = *parent;
        for child in node.children() {
            place *= transform(child)?;
        }
        let url = |instance: Node<'a, 'i>| {
            instance.attribute("url").ok_or_else(|| format!("<{}> has no url", instance.tag_name().name()))
        };
        for child in node.children() {
            match child.tag_name().name() {
                "node" => self.add_node(child, &place, read, depth + 1)?,
                "instance_node" => self.add_node(self.named(url(child)?)?, &place, read, depth + 1)?,
                "instance_geometry" => self.add_geometry(self.named(url(child)?)?, &place, read)?,
                "instance_controller" => {
                    return Err("it has a skin or a morph (<instance_controller>), which only animations need".into());
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn add_geometry(&self, geometry: Node<'a, 'i>, place: &Matrix4<f64>, read: &mut Triangles) -> Parse<()> {
        for mesh in children(geometry, "mesh") {
            for primitive in mesh.children().filter(Node::is_element) {
                let faces = match primitive.tag_name().name() {
                    "triangles" | "polylist" | "polygons" | "tristrips" | "trifans" => primitive,
                    _ => continue,
                };
                self.add_primitive(faces, place, read)?;
            }
        }
        Ok(())
    }

    fn add_primitive(&self, primitive: Node<'a, 'i>, place: &Matrix4<f64>, read: &mut Triangles) -> Parse<()> {
        let mut stride = 0;
        let mut positions = None;
        for input in children(primitive, "input") {
            let offset = input.attribute("offset").map_or(Ok(0), str::parse::<usize>);
            let offset = offset.map_err(|_| "an <input> has an offset that is not a whole number".to_string())?;
            stride = stride.max(offset.checked_add(1).ok_or("an <input> has too large an offset")?);
            if input.attribute("semantic") == Some("VERTEX") {
                positions = input.attribute("source").map(|source| (source, offset));
            }
        }
        let name = primitive.tag_name().name();
        let (source, offset) = positions.ok_or_else(|| format!("<{name}> has no <input> of vertices"))?;
        let points = self.positions(source)?;
        let first = read.vertices.len() as u32;
        let placed = |point: &[f64; 3]| <[f64; 3]>::from(place.transform_point(&Point3::from(*point)).coords);
        read.vertices.extend(points.iter().map(placed));
        // Mirroring transforms reverse the orientation of the triangles.
        let mirrored = place.fixed_view::<3, 3>(0, 0).determinant() < 0.0;
        let mut add = |corners: &[u32]| {
            let from = read.faces.len();
            read.add_polygon(corners);
            if mirrored {
                read.faces[from..].iter_mut().for_each(|face| face.swap(1, 2));
            }
        };
        let counts = match children(primitive, "vcount").next() {
            Some(counts) => Some(whole_numbers(counts)?),
            None => None,
        };
        for list in children(primitive, "p").chain(children(primitive, "ph").flat_map(|ph| children(ph, "p"))) {
            let numbers = whole_numbers(list)?;
            let index = |chunk: &[usize]| match chunk.get(offset) {
                Some(index) if *index < points.len() => Ok(first + *index as u32),
                Some(index) => Err(format!("<{name}> names vertex {index} of {}", points.len())),
                None => Err(format!("<{name}> ends within a corner")),
            };
            let corners: Vec<u32> = numbers.chunks(stride).map(index).collect::<Parse<_>>()?;
            match name {
                "triangles" => corners.chunks_exact(3).for_each(&mut add),
                "tristrips" => {
                    for (i, w) in corners.windows(3).enumerate() {
                        if i % 2 == 0 { add(w) } else { add(&[w[1], w[0], w[2]]) }
                    }
                }
                "polylist" => {
                    let mut rest = &corners[..];
                    for count in counts.iter().flatten() {
                        let polygon = rest.get(..*count).ok_or("<polylist> has fewer corners than <vcount> says")?;
                        add(polygon);
                        rest = &rest[*count..];
                    }
                }
                _ => add(&corners),
            }
        }
        Ok(())
    }

    /// Returns the points of a `<vertices>` element.
    fn positions(&self, vertices: &str) -> Parse<Vec<[f64; 3]>> {
        let vertices = self.named(vertices)?;
        let input = children(vertices, "input").find(|input| input.attribute("semantic") == Some("POSITION"));
        let source = input.and_then(|input| input.attribute("source")).ok_or("<vertices> has no positions")?;
        let source = self.named(source)?;
        let array = children(source, "float_array").next().ok_or("a <source> has no <float_array>")?;
        let numbers: Vec<f64> = words(array).map(number).collect::<Parse<_>>()?;
        let accessor = source.descendants().find(|node| node.has_tag_name_any("accessor"));
        let stride = accessor.and_then(|accessor| accessor.attribute("stride")).map_or(Ok(3), str::parse::<usize>);
        match stride {
            Ok(stride @ 3..) => Ok(numbers.chunks_exact(stride).map(|point| [point[0], point[1], point[2]]).collect()),
            _ => Err("positions need a stride of at least three".into()),
        }
    }
}

/// Returns the transform of a child element of a node; the identity if the child is not a transform.
fn transform(child: Node) -> Parse<Matrix4<f64>> {
    let name = child.tag_name().name();
    if !matches!(name, "matrix" | "translate" | "scale" | "rotate" | "lookat" | "skew") {
        return Ok(Matrix4::identity());
    }
    let numbers: Vec<f64> = words(child).map(number).collect::<Parse<_>>()?;
    match (name, &numbers[..]) {
        ("matrix", entries) if entries.len() == 16 => Ok(Matrix4::from_row_slice(entries)),
        ("translate", [x, y, z]) => Ok(Matrix4::new_translation(&Vector3::new(*x, *y, *z))),
        ("scale", [x, y, z]) => Ok(Matrix4::new_nonuniform_scaling(&Vector3::new(*x, *y, *z))),
        ("rotate", [x, y, z, degrees]) => {
            let axis = Unit::try_new(Vector3::new(*x, *y, *z), 0.0);
            let turn = axis.map(|axis| Rotation3::from_axis_angle(&axis, degrees.to_radians()));
            Ok(turn.map_or_else(Matrix4::identity, |turn| turn.to_homogeneous()))
        }
        ("matrix" | "translate" | "scale" | "rotate", numbers) => {
            Err(format!("<{name}> has {} numbers", numbers.len()))
        }
        _ => Err(format!("<{name}> in a scene is not supported: use <matrix>")),
    }
}

fn words<'a>(node: Node<'a, '_>) -> impl Iterator<Item = &'a str> {
    node.text().unwrap_or_default().split_whitespace()
}

fn whole_numbers(node: Node) -> Parse<Vec<usize>> {
    let whole = |word: &str| word.parse::<usize>().map_err(|_| "an index that is no whole number".to_string());
    words(node).map(whole).collect()
}
