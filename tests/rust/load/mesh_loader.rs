//! The crate mesh-loader beside our reader of meshes: an oracle for plain files, and what it gets wrong in others. A new version
//! that passes the second part in another way may replace ours.

use ikcore::load::parse_mesh;
use ikcore::shape::Geometry;
use mesh_loader::Loader;

type Triangles = Vec<[[f64; 3]; 3]>;

fn ours(name: &str, bytes: &[u8]) -> Triangles {
    let shape = parse_mesh(name, bytes, [1.0; 3]).unwrap();
    let Geometry::Mesh(mesh) = shape.geometry() else { panic!("no mesh") };
    mesh.faces().iter().map(|face| face.map(|corner| mesh.vertices()[corner as usize])).collect()
}

fn theirs(name: &str, bytes: &[u8]) -> std::io::Result<Triangles> {
    let scene = Loader::default().merge_meshes(true).load_from_slice(bytes, name)?;
    let mesh = &scene.meshes[0];
    let corner = |corner: u32| mesh.vertices[corner as usize].map(f64::from);
    Ok(mesh.faces.iter().map(|face| face.map(corner)).collect())
}

/// The largest difference of coordinates of triangles in the same order.
fn difference(a: &Triangles, b: &Triangles) -> f64 {
    assert_eq!(a.len(), b.len());
    let coordinates = |triangles: &Triangles| triangles.as_flattened().as_flattened().to_vec();
    coordinates(a).iter().zip(coordinates(b)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

const SOLID: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0.1\nvertex 1 2 3\nvertex 4 5 7\nendloop\nendfacet\nendsolid a\n";

fn binary_stl() -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend(1_u32.to_le_bytes());
    bytes.extend(
        [0.0_f32, 0.0, 1.0, 0.0, 0.0, 0.1, 1.0, 2.0, 3.0, 4.0, 5.0, 7.0].into_iter().flat_map(f32::to_le_bytes),
    );
    bytes.extend([0, 0]);
    bytes
}

/// One triangle in centimetres, with these nodes as its scene.
fn collada(nodes: &str) -> String {
    let params = ["X", "Y", "Z"].map(|name| format!("<param name=\"{name}\" type=\"float\"/>")).concat();
    format!(
        "<COLLADA version=\"1.4.1\"><asset><unit meter=\"0.01\"/></asset><library_geometries><geometry id=\"g\"><mesh><source \
         id=\"s\"><float_array id=\"a\" count=\"9\">0 0 10 100 200 300 400 500 700</float_array><technique_common><accessor \
         source=\"#a\" count=\"3\" stride=\"3\">{params}</accessor></technique_common></source><vertices id=\"v\"><input \
         semantic=\"POSITION\" source=\"#s\"/></vertices><polylist count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" \
         offset=\"0\"/><vcount>3</vcount><p>0 1 2</p></polylist></mesh></geometry></library_geometries><library_visual_scenes>\
         <visual_scene id=\"w\">{nodes}</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#w\"/></scene>\
         </COLLADA>"
    )
}

/// A node with this transform.
fn node(id: &str, transform: &str) -> String {
    format!("<node id=\"{id}\">{transform}<instance_geometry url=\"#g\"/></node>")
}

#[test]
fn both_read_the_same_from_plain_files() {
    let turned = format!("<node id=\"n\"><scale>2 2 2</scale>{}</node>", node("m", "<rotate>0 0 1 90</rotate>"));
    let files = [
        ("a.stl", SOLID.as_bytes().to_vec()),
        ("a.stl", binary_stl()),
        ("a.dae", collada(&node("n", "")).into_bytes()),
        ("a.dae", collada(&turned).into_bytes()),
    ];
    for (name, bytes) in files {
        let off = difference(&ours(name, &bytes), &theirs(name, &bytes).unwrap());
        assert!(off < 2e-6, "{name}: {off}");
    }
}

#[test]
fn mesh_loader_leaves_displacements_in_the_unit_of_the_file() {
    let moved = collada(&node("n", "<translate>10 0 0</translate>"));
    let [ours, theirs] = [ours("a.dae", moved.as_bytes()), theirs("a.dae", moved.as_bytes()).unwrap()];
    assert_eq!((ours[0][0][0], theirs[0][0][0]), (0.1, 10.0));
}

#[test]
fn mesh_loader_keeps_one_of_two_parts_of_a_kind() {
    let twice = collada(&(node("n", "<translate>10 0 0</translate>") + &node("m", "")));
    assert_eq!((ours("a.dae", twice.as_bytes()).len(), theirs("a.dae", twice.as_bytes()).unwrap().len()), (2, 1));
}

#[test]
fn mesh_loader_turns_mirrored_parts_inside_out() {
    let mirrored = collada(&node("n", "<scale>-1 1 1</scale>"));
    let [ours, theirs] = [ours("a.dae", mirrored.as_bytes()), theirs("a.dae", mirrored.as_bytes()).unwrap()];
    let [a, b, c] = theirs[0];
    assert!(difference(&ours, &vec![[a, c, b]]) < 1e-6);
}

#[test]
fn mesh_loader_panics_or_is_silent_where_ours_names_the_fault() {
    let plain = collada(&node("n", ""));
    let params = plain.find("<param").unwrap()..plain.find("</accessor>").unwrap();
    let nameless = [&plain[..params.start], &plain[params.end..]].concat();
    for changed in [plain.replace("<p>0 1 2", "<p>0 1 5"), nameless] {
        assert!(std::panic::catch_unwind(|| theirs("a.dae", changed.as_bytes())).is_err());
        _ = parse_mesh("a.dae", changed.as_bytes(), [1.0; 3]);
    }
    let silent = [
        ("a.stl", SOLID.replace("1 2 3", "1 2 nan"), "line 5: not a finite number"),
        ("a.stl", SOLID.replace("1 2 3", "1 2 1e400"), "line 5: not a finite number"),
        ("a.dae", plain.replace("url=\"#g\"", "url=\"#h\""), "nothing has the id that a url names"),
    ];
    for (name, text, problem) in silent {
        assert!(theirs(name, text.as_bytes()).is_ok());
        let error = parse_mesh(name, text.as_bytes(), [1.0; 3]).unwrap_err().to_string();
        assert_eq!(error, format!("cannot read '{name}': {problem}"));
    }
}
