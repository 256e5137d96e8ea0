//! Reasons why there is no clear motion: a blocked end, or the gap left by the search.

use super::end_pair::EndPair;
use crate::constraint::Keep;
use crate::obstacle::{Contact, Scene, Sensed};
use crate::robot::Robot;
use crate::timing::ConstantLimits;
use crate::wording::number;

/// Names the obstruction where none of `pairs` has two clear ends, which keep `kept` (m) from everything.
///
/// Also returns what was measured of the robot itself, if that blocks the start.
pub(super) fn blocked_ends(scene: &Scene, pairs: &[EndPair], kept: f64) -> (String, Option<Sensed>) {
    let is_clear = |q: &[f64]| scene.is_clear(q, kept);
    let start_is_blocked = !pairs.iter().any(|pair| is_clear(&pair.start));
    let name = if start_is_blocked { "start" } else { "end" };
    let nearest = |pair: &EndPair| {
        let q = if start_is_blocked { &pair.start } else { &pair.end };
        scene.nearest(q).ok().flatten()
    };
    let clearest = pairs.iter().filter_map(nearest).max_by(|one, other| one.distance.total_cmp(&other.distance));
    let own_points = clearest.as_ref().filter(|_| start_is_blocked).and_then(Contact::measured);
    let found = clearest.map_or(String::new(), |contact| format!("; at the clearest one {}", contact.in_words(kept)));
    (format!("{name}: no configuration was found that is clear of everything{found}"), own_points)
}

/// Names the constraint that is broken where none of `pairs` has two ends within all of them; `None` if some have.
pub(super) fn broken_ends(pairs: &[EndPair], keeps: &[Keep], robot: &Robot) -> Option<String> {
    let broken = |q: &[f64]| keeps.iter().find_map(|keep| keep.broken_at(robot, q));
    let at_starts = pairs.iter().map(|pair| broken(&pair.start)).collect::<Option<Vec<String>>>();
    let (name, all) = match at_starts {
        Some(all) => ("start", all),
        None => ("end", pairs.iter().map(|pair| broken(&pair.end)).collect::<Option<Vec<String>>>()?),
    };
    let first = all.first()?;
    Some(format!("{name}: no configuration was found at which holds what is to be kept; there {first}"))
}

/// Names the joint that cannot hold the arm where none of `pairs` has two ends at which all can; `None` if some have.
pub(super) fn heavy_ends(pairs: &[EndPair], limits: &ConstantLimits) -> Option<String> {
    let at_starts = pairs.iter().map(|pair| limits.too_heavy(&pair.start)).collect::<Option<Vec<String>>>();
    let (name, all) = match at_starts {
        Some(all) => ("start", all),
        None => ("end", pairs.iter().map(|pair| limits.too_heavy(&pair.end)).collect::<Option<Vec<String>>>()?),
    };
    let first = all.first()?;
    Some(format!("{name}: no configuration was found at which the joints can hold the arm; there {first}"))
}

/// Describes the gap `left` between the trees from both ends after `examined` configurations, and what is wrong with the
/// straight motion.
pub(super) fn gap(left: f64, examined: usize, straight: Option<String>) -> String {
    let came = if left.is_finite() {
        format!("what was reached from both ends stays {} rad apart", number(left))
    } else {
        "nothing was reached from either end".into()
    };
    let in_the_way = straight.map_or(String::new(), |wrong| format!("; on the straight way {wrong}"));
    format!("the way from start to end: none found in {examined} configurations; {came}{in_the_way}")
}
