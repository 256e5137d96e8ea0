//! How the links of a robot look. Nothing is computed with it.

use serde::{Deserialize, Serialize};

use crate::math::Pose;
use crate::shape::Shape;

/// A shape that a link shows, in one colour unless its file says otherwise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Visual {
    /// The link that carries it.
    pub link: String,
    /// What is seen.
    pub shape: VisualShape,
    /// Red, green, blue and opacity, from 0 to 1.
    pub color: Option<[f64; 4]>,
}

/// What is seen of a link.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum VisualShape {
    /// A sphere, box, cylinder or capsule, in the frame of the link.
    Solid(Shape),
    /// A mesh in a file, which is not read.
    Mesh {
        /// Where the file was found; as the URDF names it where it was not.
        path: String,
        /// Factors of its coordinates.
        scale: [f64; 3],
        /// Pose of the mesh in its link.
        origin: Pose,
    },
}
