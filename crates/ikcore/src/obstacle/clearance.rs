//! The distance of an arm from everything around it.

use serde::{Deserialize, Serialize};

use super::contact::NearestContact;
use crate::wording::number;

/// The smallest distance at a configuration or on a motion, and the nearest two bodies.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(from = "Option<NearestContact>", into = "Option<NearestContact>")]
pub struct Clearance {
    /// Distance that all bodies keep (m), on a motion certified between samples too; infinite if nothing can touch.
    pub distance: f64,
    /// The nearest two bodies, where they are nearest; `None` if nothing can touch, or while only a bound is known.
    pub nearest: Option<NearestContact>,
}

impl Clearance {
    /// A certified bound (m).
    pub(crate) fn at_least(distance: f64) -> Self {
        Self { distance, nearest: None }
    }
}

impl From<Option<NearestContact>> for Clearance {
    fn from(nearest: Option<NearestContact>) -> Self {
        let distance = nearest.as_ref().map_or(f64::INFINITY, |nearest| nearest.contact.distance);
        Self { distance, nearest }
    }
}

impl From<Clearance> for Option<NearestContact> {
    fn from(clearance: Clearance) -> Self {
        clearance.nearest
    }
}

/// The end of a sentence: the clearance, if anything can touch, and that the mesh of this obstacle is not closed.
pub(crate) fn clear_in_words(clearance: Option<&Clearance>, open_mesh: Option<usize>) -> String {
    let clear = match clearance {
        Some(Clearance { distance, nearest }) if *distance < f64::INFINITY => {
            let at_least = if nearest.is_none() { "at least " } else { "" };
            let of = if open_mesh.is_none() { "everything" } else { "all surfaces" };
            format!(", {at_least}{} m clear of {of}", number(*distance))
        }
        _ => ", with nothing to touch".into(),
    };
    match open_mesh {
        None => clear,
        Some(i) => format!("{clear}; the mesh of obstacle {i} is open, so that its inside is unknown"),
    }
}
