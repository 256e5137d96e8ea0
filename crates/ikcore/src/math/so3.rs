//! Rotation vectors.
