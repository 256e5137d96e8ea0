//! What the readers of mesh files share.

/// Corners and triangles of a file, or what is wrong with it.
pub(super) type Parsed = Result<Triangles, String>;

/// Corners (m) and the triangles between them.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Triangles {
    pub vertices: Vec<[f64; 3]>,
    pub faces: Vec<[u32; 3]>,
}

impl Triangles {
    /// Adds a polygon by indices of its corners, as a fan of triangles.
    pub fn add_polygon(&mut self, corners: &[u32]) {
        for i in 1..corners.len().saturating_sub(1) {
            self.faces.push([corners[0], corners[i], corners[i + 1]]);
        }
    }
}

/// Reads a finite number. The word is not in the error: a robot file may name any file as a mesh, and messages show none.
pub(super) fn number(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err("not a finite number".into()),
    }
}
