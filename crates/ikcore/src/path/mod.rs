//! Reference paths for the tip: curves in space and time (one per file), a [`Path`] along any of them, its samples at
//! the ticks ([`Reference`]), and points without times ([`Waypoints`]). Joint motion is in `trajectory`, limits are in
//! `limits`.
//!
//! | curve | from |
//! |---|---|
//! | [`Circle`] | Cheng et al. 2020, eq. (14) |
//! | [`Hypotrochoid`] | Khan et al. 2022, eq. (20), corrected |
//! | [`Rose`] | r = a cos(k u) |
//! | [`Polyline`] | straight segments through given points; [`Polyline::letter_m`], [`Polyline::pentagram`] |
//! | [`Samples`] | measured or computed positions or poses |
//!
//! ```
//! use ikcore::path::{Circle, Path, Plane};
//!
//! let circle = Path::new(Circle::new(Plane::xy([0.3, 0.3, 1.0])?, 0.2, 30.0)?);
//! let reference = circle.sample(0.2)?;
//! assert_eq!(reference.len(), 151);
//! assert_eq!(reference.position(0), [0.4, 0.3, 1.0]);
//! # Ok::<(), ikcore::Error>(())
//! ```

mod circle;
mod curve;
mod hypotrochoid;
mod letter_m;
mod orientation;
mod pentagram;
mod plane;
mod polyline;
mod reference;
mod rose;
mod samples;
mod stored_path;
mod timed_path;
mod waypoints;

pub use circle::Circle;
pub use curve::Curve;
pub use hypotrochoid::Hypotrochoid;
pub use plane::Plane;
pub use polyline::Polyline;
pub use reference::Reference;
pub use rose::Rose;
pub use samples::Samples;
pub use timed_path::Path;
pub use waypoints::Waypoints;
