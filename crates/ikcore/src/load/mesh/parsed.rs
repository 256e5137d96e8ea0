//! Common result of the mesh file readers.

/// Vertices and triangles of a file, or a description of the problem.
pub(super) type Parsed = Result<Triangles, String>;

/// Vertices (m) and the triangles between them.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Triangles {
    pub vertices: Vec<[f64; 3]>,
    pub faces: Vec<[u32; 3]>,
}

impl Triangles {
    /// Adds a polygon, given by the indices of its corners, as a fan of triangles.
    pub fn add_polygon(&mut self, corners: &[u32]) {
        for i in 1..corners.len().saturating_sub(1) {
            self.faces.push([corners[0], corners[i], corners[i + 1]]);
        }
    }
}

/// Parses a finite number. The error omits the word: a robot file may name any file as a mesh, and messages must not reveal
/// its content.
pub(super) fn number(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err("not a finite number".into()),
    }
}
