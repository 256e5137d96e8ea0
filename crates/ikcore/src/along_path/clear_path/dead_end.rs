//! Obstructions of a path without a clear motion.

use super::passage::Passage;
use super::postures::are_all;
use super::sequence::Unreached;
use crate::objective::Point;
use crate::obstacle::{Blocked, ClearSpace, Contact, NearestContact, Sensed};

/// Postures at the points of a path, clear or not.
pub(super) struct Layers<'a> {
    pub fractions: &'a [f64],
    pub postures: &'a [Vec<Point>],
}

impl Layers<'_> {
    /// Names the obstruction of a path: the first point without a clear posture, or else the point that no clear motion
    /// reaches. Also returns what was measured of the robot itself, if that is the obstruction.
    pub fn obstruction(
        &self,
        passage: &Passage<'_>,
        space: &ClearSpace<'_>,
        dead_end: &Unreached,
    ) -> (String, Option<Sensed>) {
        let is_blocked = |i: &usize| !self.postures[*i].iter().any(|q| passage.is_clear(self.fractions[*i], q));
        match (0..self.fractions.len()).find(is_blocked) {
            Some(layer) => self.blocked(passage, space, layer),
            None => {
                let place = passage.problem.tip_path.point_in_words(self.fractions[dead_end.layer]);
                let count = self.clear(passage, dead_end.layer);
                let what = format!(
                    "{place}: {count} of {} postures tried there are clear, but no clear motion that was found leads to them",
                    self.postures[dead_end.layer].len()
                );
                (what, None)
            }
        }
    }

    fn clear(&self, passage: &Passage<'_>, layer: usize) -> usize {
        self.postures[layer].iter().filter(|q| passage.is_clear(self.fractions[layer], q)).count()
    }

    /// Names the obstruction at a point without a clear posture.
    fn blocked(&self, passage: &Passage<'_>, space: &ClearSpace<'_>, layer: usize) -> (String, Option<Sensed>) {
        let tip_path = passage.problem.tip_path;
        let (fraction, postures) = (self.fractions[layer], &self.postures[layer]);
        let said = |contact: &Contact| contact.in_words(space.margin());
        let hands = if tip_path.fixes_pose() { vec![passage.problem.robot.frame_of_tip(0)] } else { vec![] };
        let hopeless = postures.first().and_then(|q| space.blocked_at(q, &hands));
        let own_points = match &hopeless {
            Some(Blocked::Base(contact)) => contact.measured(),
            _ => None,
        };
        let what = match hopeless {
            Some(Blocked::Hand(contact)) => {
                format!("{} whatever the arm does: the hand itself is in the way", said(&contact))
            }
            Some(Blocked::Base(contact)) if own_points.is_some() => {
                format!("{}, and no joint moves it", said(&contact))
            }
            Some(Blocked::Base(contact)) => {
                format!("{}, and no joint moves it; {}", said(&contact), contact.remedy())
            }
            None => match least_deep(space, postures) {
                Some(nearest) => {
                    let (said, count) = (said(&nearest.contact), postures.len());
                    match (are_all(passage, fraction), count) {
                        (true, 1) => format!("{said} in the only posture inside the limits"),
                        (true, _) => format!("{said} in the best of {count} postures, and there are no others"),
                        _ => format!("{said} in the best of {count} postures tried, and others may exist"),
                    }
                }
                None => "no posture was found".into(),
            },
        };
        (format!("{}: {what}", tip_path.point_in_words(fraction)), own_points)
    }
}

fn least_deep(space: &ClearSpace<'_>, postures: &[Point]) -> Option<NearestContact> {
    let nearest = postures.iter().filter_map(|q| space.clearance(q).nearest);
    nearest.max_by(|one, other| one.contact.distance.total_cmp(&other.contact.distance))
}
