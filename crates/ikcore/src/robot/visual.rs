//! Looks of the links of a robot. Nothing is computed with them.

use serde::{Deserialize, Serialize};

use crate::math::Pose;
use crate::shape::Shape;

/// A shape that a link shows, in one colour unless its file says otherwise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Visual {
    /// The link that carries it.
    pub link: String,
    /// Visual shape.
    pub shape: VisualShape,
    /// Red, green, blue and opacity, from 0 to 1.
    pub color: Option<[f64; 4]>,
}

/// Visual of a link.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum VisualShape {
    /// A sphere, box, cylinder or capsule, in the frame of the link.
    Solid(Shape),
    /// A mesh in a file, which is not read.
    Mesh {
        /// Path of the file; as the URDF names it if it was not found.
        path: String,
        /// Factors of its coordinates.
        scale: [f64; 3],
        /// Pose of the mesh in its link.
        origin: Pose,
    },
}
