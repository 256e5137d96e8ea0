//! Mesh files: STL, OBJ and COLLADA (DAE).
//!
//! `tests/rust/load/mesh_loader.rs` shows why the crate mesh-loader does not serve.

mod collada;
mod obj;
mod parsed;
mod stl;

use std::path::Path;

use nalgebra::Point3;

use crate::error::{Error, Result};
use crate::robot::LinkMesh;
use crate::shape::{Geometry, Shape};

/// Largest file (bytes); larger ones are rejected.
const LARGEST: u64 = 1 << 30;

/// Reads the mesh in a file, with its coordinates multiplied by `scale`. The name ends in .stl, .obj or .dae. Lengths of a
/// COLLADA file are converted to metres; its up axis is ignored, as in RViz.
///
/// # Errors
/// [`Error::Unreadable`] names the file and its problem.
pub fn read_mesh(path: &Path, scale: [f64; 3]) -> Result<Shape> {
    parse_mesh(&path.display().to_string(), &read_bytes(path)?, scale)
}

/// Reads the mesh of a link, in the frame of the link.
///
/// # Errors
/// As [`read_mesh`].
pub fn read_link_mesh(mesh: &LinkMesh) -> Result<Shape> {
    let shape = read_mesh(Path::new(&mesh.path), mesh.scale)?;
    let Geometry::Mesh(triangles) = shape.geometry() else { return Ok(shape) };
    let vertices = triangles.vertices().iter().map(|vertex| (mesh.origin * Point3::from(*vertex)).coords.into());
    Shape::mesh(vertices.collect(), triangles.faces().to_vec())
}

/// Reads the content of a mesh file.
pub(super) fn read_bytes(path: &Path) -> Result<Vec<u8>> {
    let name = path.display().to_string();
    let size = std::fs::metadata(path).map_err(|error| Error::unreadable(&name, error))?.len();
    if size > LARGEST {
        return Err(Error::unreadable(&name, format!("it has {size} bytes; meshes may have {LARGEST}")));
    }
    std::fs::read(path).map_err(|error| Error::unreadable(&name, error))
}

/// Parses the content of a mesh file, as [`read_mesh`] does; the ending of `name` gives the format.
///
/// # Errors
/// As [`read_mesh`].
pub fn parse_mesh(name: &str, bytes: &[u8], scale: [f64; 3]) -> Result<Shape> {
    let unreadable = |problem: String| Error::unreadable(name, problem);
    let ending = Path::new(name).extension().map(|ending| ending.to_string_lossy().to_lowercase());
    let parsed = match ending.as_deref() {
        Some("stl") => stl::parse(bytes),
        Some("obj") => obj::parse(&as_text(bytes).map_err(&unreadable)?),
        Some("dae") => collada::parse(&as_text(bytes).map_err(&unreadable)?),
        _ => Err("the name of a mesh file ends in .stl, .obj or .dae".into()),
    };
    let mut triangles = parsed.map_err(&unreadable)?;
    for vertex in &mut triangles.vertices {
        *vertex = std::array::from_fn(|k| scale[k] * vertex[k]);
    }
    if scale.iter().product::<f64>() < 0.0 {
        // Mirroring scales reverse the orientation of the triangles.
        triangles.faces.iter_mut().for_each(|face| face.swap(1, 2));
    }
    Shape::mesh(triangles.vertices, triangles.faces).map_err(|error| unreadable(error.to_string()))
}

fn as_text(bytes: &[u8]) -> std::result::Result<String, String> {
    // Lossy decoding, since comments may be in any encoding.
    Ok(String::from_utf8_lossy(bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes)).into_owned())
}

#[cfg(test)]
mod tests {
    use super::parsed::{Parsed, Triangles};
    use super::*;

    fn parsed(name: &str, text: &str) -> Parsed {
        let shape = parse_mesh(name, text.as_bytes(), [1.0; 3]).map_err(|error| error.to_string())?;
        let Geometry::Mesh(mesh) = shape.geometry() else { unreachable!() };
        Ok(Triangles { vertices: mesh.vertices().to_vec(), faces: mesh.faces().to_vec() })
    }

    const CORNERS: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 2.0, 3.0], [4.0, 5.0, 7.0]];

    #[test]
    fn stl_is_read_as_text_and_binary() {
        let text = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 2 3\nvertex 4 5 7\nendloop\nendfacet\nendsolid";
        assert_eq!(parsed("a.STL", text).unwrap(), Triangles { vertices: CORNERS.to_vec(), faces: vec![[0, 1, 2]] });
        // Binary file that begins like text.
        let mut binary = b"solid".to_vec();
        binary.resize(80, b' ');
        binary.extend(1_u32.to_le_bytes());
        binary.extend(
            [0.0_f32; 3].into_iter().chain(CORNERS.as_flattened().iter().map(|x| *x as f32)).flat_map(f32::to_le_bytes),
        );
        binary.extend([0, 0]);
        let shape = parse_mesh("a.stl", &binary, [1.0; 3]).unwrap();
        assert_eq!(shape, Shape::mesh(CORNERS.to_vec(), vec![[0, 1, 2]]).unwrap());
        let cut = parse_mesh("a.stl", &binary[..100], [1.0; 3]).unwrap_err().to_string();
        assert!(cut.starts_with("cannot read 'a.stl': "), "{cut}");
    }

    #[test]
    fn obj_polygons_become_triangles() {
        let text = "# a\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0\nvn 0 0 1\nv 0 1 0\nusemtl m\nf 1//1 2/3/4 3 -1\n";
        let Triangles { vertices, faces } = parsed("a.obj", text).unwrap();
        assert_eq!((vertices.len(), faces), (4, vec![[0, 1, 2], [0, 2, 3]]));
    }

    fn dae(asset: &str, scene: &str) -> String {
        format!(
            "<COLLADA xmlns=\"c\"><asset>{asset}</asset><library_geometries><geometry id=\"g\"><mesh><source id=\"s\">\
             <float_array id=\"a\">0 0 0 1 2 3 4 5 7</float_array><technique_common><accessor source=\"#a\" count=\"3\" \
             stride=\"3\"/></technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" source=\"#s\"/>\
             </vertices><polylist count=\"1\"><input semantic=\"NORMAL\" source=\"#n\" offset=\"1\"/><input \
             semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><vcount>3</vcount><p>0 9 1 9 2 9</p></polylist></mesh>\
             </geometry></library_geometries><library_visual_scenes><visual_scene id=\"w\">{scene}</visual_scene>\
             </library_visual_scenes><scene><instance_visual_scene url=\"#w\"/></scene></COLLADA>"
        )
    }

    #[test]
    fn collada_parts_are_placed_in_metres_as_often_as_they_occur() {
        let scene = "<node id=\"one\"><translate>10 0 0</translate><instance_geometry url=\"#g\"/></node><node><scale>2 2 2</scale>\
                     <node><rotate>0 0 1 90</rotate><instance_geometry url=\"#g\"/></node></node>";
        let text = dae("<unit meter=\"0.01\"/><up_axis>Y_UP</up_axis>", scene);
        let Triangles { vertices, faces } = parsed("a.dae", &text).unwrap();
        let expected = [
            [0.1, 0.0, 0.0],
            [0.11, 0.02, 0.03],
            [0.14, 0.05, 0.07],
            [0.0; 3],
            [-0.04, 0.02, 0.06],
            [-0.1, 0.08, 0.14],
        ];
        assert_eq!(faces, [[0, 1, 2], [3, 4, 5]]);
        assert!(
            vertices.as_flattened().iter().zip(expected.as_flattened()).all(|(x, y)| (x - y).abs() < 1e-15),
            "{vertices:?}"
        );
    }

    #[test]
    fn a_mirror_keeps_the_outside_outside() {
        let cube = Shape::cuboid([0.0; 3], [1.0; 3], None).unwrap().triangles();
        let text: String = cube.as_flattened().iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
        let text =
            text + &(0..12).map(|i| format!("f {} {} {}\n", 3 * i + 1, 3 * i + 2, 3 * i + 3)).collect::<String>();
        let mirrored = parse_mesh("a.obj", text.as_bytes(), [-1.0, 1.0, 2.0]).unwrap();
        let Geometry::Mesh(mesh) = mirrored.geometry() else { unreachable!() };
        assert!((mesh.volume() - 2.0).abs() < 1e-12 && mesh.is_closed());
    }

    #[test]
    fn broken_files_are_errors_that_name_the_place() {
        let message = |name: &str, text: &str| parsed(name, text).unwrap_err();
        let cases = [
            ("a.ply", "", "the name of a mesh file ends in .stl, .obj or .dae"),
            ("a.stl", "", "it is neither a text nor a binary STL file"),
            ("a.stl", "solid a\nvertex 1 2", "line 2: a vertex has three coordinates"),
            ("a.stl", "solid a\nvertex 1 2 x", "line 2: not a finite number"),
            ("a.stl", "solid a\nvertex 1 2 3\nendfacet", "line 3: a facet has three vertices"),
            ("a.stl", "solid a\nendsolid a", "a mesh needs at least one triangle, got none"),
            ("a.obj", "v 0 0 nan", "line 1: not a finite number"),
            ("a.obj", "v 0 0 0\nf 1 2 1", "line 2: a face names none of the 1 vertices before it"),
            ("a.obj", "v 0 0 0\nf 1 0 1", "line 2: a face names none of the 1 vertices before it"),
            ("a.obj", "v 0 0 0\nf 1 1", "line 2: a face has at least three corners"),
            ("a.dae", "<a/>", "its root is not <COLLADA>"),
            ("a.dae", &dae("<unit meter=\"0\"/>", ""), "its unit must be positive, got 0 m"),
            ("a.dae", &dae("", "<node><instance_geometry url=\"#h\"/></node>"), "nothing has the id that a url names"),
            ("a.dae", &dae("", "<node><instance_geometry/></node>"), "<instance_geometry> has no url"),
            ("a.dae", &dae("", "<node><matrix>1 0</matrix></node>"), "<matrix> has 2 numbers"),
            (
                "a.dae",
                &dae("", "<node id=\"n\"><instance_node url=\"#n\"/></node>"),
                "its scene has more than 100000 nodes, or is nested more than 64 times",
            ),
            (
                "a.dae",
                &dae("", "<node><instance_geometry url=\"#g\"/></node>").replace("0 9 1 9 2 9", "0 9 1 9 5 9"),
                "<polylist> names vertex 5 of 3",
            ),
            (
                "a.dae",
                &dae("", "<node><instance_geometry url=\"#g\"/></node>").replace("<vcount>3", "<vcount>4"),
                "<polylist> has fewer corners than <vcount> says",
            ),
        ];
        for (name, text, problem) in cases {
            assert_eq!(message(name, text), format!("cannot read '{name}': {problem}"));
        }
        let missing = read_mesh(Path::new("nowhere/a.stl"), [1.0; 3]).unwrap_err().to_string();
        assert!(missing.starts_with("cannot read 'nowhere/a.stl': "), "{missing}");
    }

    #[test]
    fn no_cut_or_changed_file_makes_the_readers_panic() {
        let mut rng = crate::rng::stream(1, 0);
        let whole = dae("<unit meter=\"1\"/>", "<node><instance_geometry url=\"#g\"/></node>").into_bytes();
        for _ in 0..3000 {
            let mut bytes = whole.clone();
            bytes.truncate(1 + rng.below(whole.len()));
            for _ in 0..3 {
                let place = rng.below(bytes.len());
                bytes[place] = b"0 9-<>/x\""[rng.below(9)];
            }
            for name in ["a.stl", "a.obj", "a.dae"] {
                let _ = parse_mesh(name, &bytes, [1.0; 3]);
            }
        }
    }
}
