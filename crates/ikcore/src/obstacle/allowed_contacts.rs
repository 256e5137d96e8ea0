//! Allowed contacts of bodies and obstacles.

use super::obstacles::{Obstacle, Obstacles};
use crate::bodies::CarriedBody;
use crate::error::{Error, Result, shortened, suggestion};
use crate::robot::Robot;
use crate::wording::listed;

/// Pairs of an obstacle and a body that are not compared, such as a floor and the base that stands on it, or an empty cloud and
/// any body.
#[derive(Debug, Clone, Default)]
pub(super) struct AllowedContacts {
    /// Obstacle and body, sorted.
    pairs: Vec<[usize; 2]>,
}

impl AllowedContacts {
    /// Contacts of `bodies` of `robot` that the obstacles name ([`Obstacle::touch`](super::Obstacle::touch)).
    ///
    /// # Errors
    /// [`Error::InvalidObstacle`] for the name of no link, or of a link without a body, and for an obstacle that every body may
    /// touch.
    pub fn new(robot: &Robot, bodies: &[CarriedBody], obstacles: &Obstacles) -> Result<Self> {
        let mut pairs = vec![];
        for (obstacle, entry) in obstacles.iter().enumerate() {
            // Nothing touches a cloud without points.
            let empty = if entry.shape.is_empty() { 0..bodies.len() } else { 0..0 };
            pairs.extend(empty.map(|body| [obstacle, body]));
            let first = pairs.len();
            for link in entry.touch() {
                let before = pairs.len();
                let of_link = (0..bodies.len()).filter(|body| bodies[*body].link == *link);
                pairs.extend(of_link.map(|body| [obstacle, body]));
                if pairs.len() == before {
                    return Err(no_body(robot, bodies, link, &format!("obstacle {obstacle} ({})", entry.shape.name())));
                }
            }
            if pairs.len() - first == bodies.len() {
                return Err(untested(obstacle, entry));
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        Ok(Self { pairs })
    }

    /// Whether no contact is allowed.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// Whether a body may touch an obstacle.
    #[inline]
    pub fn allow(&self, body: usize, obstacle: usize) -> bool {
        !self.is_empty() && self.pairs.binary_search(&[obstacle, body]).is_ok()
    }
}

/// The error for an obstacle that is compared with nothing. An answer "clear" would claim more than was tested.
fn untested(obstacle: usize, entry: &Obstacle) -> Error {
    let name = entry.shape.name();
    Error::InvalidObstacle {
        problem: format!(
            "obstacle {obstacle} ({name}) may be touched by every link with a body, so that nothing would be tested against it: \
             leave out the links of its touch that must stay clear, or the obstacle"
        ),
    }
}

fn no_body(robot: &Robot, bodies: &[CarriedBody], link: &str, obstacle: &str) -> Error {
    let mut known: Vec<&str> = bodies.iter().map(|body| body.link.as_str()).collect();
    known.dedup();
    let (name, meant) = (shortened(link), suggestion(link, known.iter().copied()));
    let lacks = match robot.carrier_of_link(link) {
        Some(_) => format!("link '{name}' of robot '{}' has no body", robot.name()),
        None => format!("robot '{}' has no link '{name}'{meant}", robot.name()),
    };
    let known = listed(known);
    Error::InvalidObstacle { problem: format!("touch of {obstacle}: {lacks}; links with bodies: {known}") }
}
