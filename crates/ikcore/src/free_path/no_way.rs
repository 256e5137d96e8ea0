//! Says why there is no clear motion: which end is blocked, or how far the search came.

use super::end_pair::EndPair;
use crate::obstacle::{Contact, Scene};
use crate::wording::number;

/// Why none of `pairs` has two clear ends: everything keeps `kept` (m) at those that do.
pub(super) fn blocked_ends(scene: &Scene, pairs: &[EndPair], kept: f64) -> String {
    let is_clear = |q: &[f64]| scene.is_clear(q, kept);
    let start_is_blocked = !pairs.iter().any(|pair| is_clear(&pair.start));
    let name = if start_is_blocked { "start" } else { "end" };
    let nearest = |pair: &EndPair| {
        let q = if start_is_blocked { &pair.start } else { &pair.end };
        scene.nearest(q).ok().flatten()
    };
    let clearest = pairs.iter().filter_map(nearest).max_by(|one, other| one.distance.total_cmp(&other.distance));
    let found = clearest.map_or(String::new(), |contact| format!("; at the clearest one {}", contact.in_words(kept)));
    format!("{name}: no configuration was found that is clear of everything{found}")
}

/// How far the search came: this much was left between what it reached from both ends, after examining so many configurations; and what
/// is in the way of the straight motion.
pub(super) fn gap(left: f64, examined: usize, straight: Option<&Contact>, kept: f64) -> String {
    let came = if left.is_finite() {
        format!("what was reached from both ends stays {} rad apart", number(left))
    } else {
        "nothing was reached from either end".into()
    };
    let in_the_way =
        straight.map_or(String::new(), |contact| format!("; on the straight way {}", contact.in_words(kept)));
    format!("the way from start to end: after {examined} configurations {came}{in_the_way}")
}
