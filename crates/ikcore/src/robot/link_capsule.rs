//! Capsules and meshes fixed to the links of a robot.

use serde::{Deserialize, Serialize};

use crate::math::Pose;

/// A capsule: all points within `radius` (m) of the segment from `a` to `b`, in the frame of the link (m).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LinkCapsule {
    /// Name of the link that carries it.
    pub link: String,
    /// One end of the axis (m).
    pub a: [f64; 3],
    /// The other end (m); equal to `a` for a sphere.
    pub b: [f64; 3],
    /// Radius (m); zero for a thin rod.
    pub radius: f64,
}

/// Quality of the capsules fitted to a mesh. They hold all of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeshFit {
    /// The link that carries it.
    pub link: String,
    /// The mesh, as the URDF names it.
    pub file: String,
    /// Volume of the capsules over that of the mesh; NaN for a mesh that is not closed.
    pub volume_ratio: f64,
    /// No point of the capsules is farther than this from the mesh (m).
    pub largest_distance: f64,
}

/// A collision mesh of a link, in a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LinkMesh {
    /// The link that carries it.
    pub link: String,
    /// Path of the file.
    pub path: String,
    /// Factors of its coordinates.
    pub scale: [f64; 3],
    /// Pose of the mesh in its link.
    pub origin: Pose,
}
