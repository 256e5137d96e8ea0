//! Paths as bytes.

use std::any::Any;
use std::sync::Arc;

use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

use super::orientation::check_rotation;
use super::{Circle, Curve, Hypotrochoid, Path, Polyline, Rose, Samples};
use crate::error::{Error, Result, require_finite, require_positive};
use crate::stored;

/// The library's own curves. Their order is part of the stored form.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
enum StoredCurve {
    Circle(Circle),
    Hypotrochoid(Hypotrochoid),
    Polyline(Polyline),
    Rose(Rose),
    Samples(Samples),
}

impl StoredCurve {
    /// Returns the stored form of `curve`; `None` for a user's curve.
    fn of(curve: &dyn Curve) -> Option<Self> {
        let curve: &dyn Any = curve;
        let circle = || curve.downcast_ref().cloned().map(Self::Circle);
        let hypotrochoid = || curve.downcast_ref().cloned().map(Self::Hypotrochoid);
        let polyline = || curve.downcast_ref().cloned().map(Self::Polyline);
        let rose = || curve.downcast_ref().cloned().map(Self::Rose);
        let samples = || curve.downcast_ref().cloned().map(Self::Samples);
        circle().or_else(hypotrochoid).or_else(polyline).or_else(rose).or_else(samples)
    }

    fn curve(self) -> Arc<dyn Curve> {
        match self {
            Self::Circle(curve) => Arc::new(curve),
            Self::Hypotrochoid(curve) => Arc::new(curve),
            Self::Polyline(curve) => Arc::new(curve),
            Self::Rose(curve) => Arc::new(curve),
            Self::Samples(curve) => Arc::new(curve),
        }
    }
}

impl Path {
    /// Returns the path as bytes, for storing and for copying between processes.
    ///
    /// # Errors
    /// [`Error::InvalidPath`] for a user's curve: only the library's curves can be stored.
    pub fn to_bytes(&self) -> Result<Vec<u8>> {
        let Some(curve) = StoredCurve::of(&*self.curve) else {
            return Err(Error::InvalidPath {
                problem: "a curve of your own cannot be stored; store its samples".into(),
            });
        };
        stored::to_bytes("path", &(curve, self.orientation))
    }

    /// Returns the path stored by [`to_bytes`](Self::to_bytes).
    ///
    /// # Errors
    /// [`Error::Corrupt`] for bytes of another version, of another type, or damaged; [`Error::OutOfRange`],
    /// [`Error::NotFinite`] or [`Error::NotRigid`] for values that no path has.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let (curve, orientation): (StoredCurve, Option<Matrix3<f64>>) = stored::from_bytes("path", bytes)?;
        let curve = curve.curve();
        require_positive("duration of the stored path", curve.duration())?;
        for t in [0.0, curve.duration()] {
            require_finite("stored path", &curve.position(t), |i| format!("{} at t = {t} s", ["x", "y", "z"][i]))?;
        }
        if let Some(rotation) = &orientation {
            check_rotation("orientation of the stored path", rotation)?;
        }
        Ok(Self { curve, orientation })
    }
}
