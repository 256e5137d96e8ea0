//! A straight piece at an end of a motion.

use crate::error::{Error, Result, require_finite, require_positive};
use crate::math::Frame;
use crate::math::vector3::{direction, scaled};
use crate::obstacle::{Obstacle, Obstacles};
use crate::wording::words;

/// The frame of a direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LineFrame {
    /// The tip's own.
    #[default]
    Tip,
    /// The base's.
    Base,
}

words!("frame": LineFrame { Tip => "tip", Base => "base" });

/// A straight line of the tip with constant orientation, from rest to rest, before the end or after the start of a motion.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StraightLine {
    /// Length (m).
    pub distance: f64,
    /// Direction of the motion, of any length but zero; `None`: along z of the tip towards an end, against it from a start.
    pub direction: Option<[f64; 3]>,
    /// Frame of the direction.
    pub frame: LineFrame,
    /// Contacts that are allowed on this line alone.
    pub touch: Vec<LineContact>,
}

/// Links that may touch an obstacle.
#[derive(Debug, Clone, PartialEq)]
pub struct LineContact {
    /// Index of the obstacle; `None`: any.
    pub obstacle: Option<usize>,
    /// Names of the links.
    pub links: Vec<String>,
}

impl StraightLine {
    /// Checks the numbers; `what` names the line.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] or [`Error::NotFinite`].
    pub fn validate(&self, what: &str) -> Result<()> {
        require_positive(&format!("distance of {what}"), self.distance)?;
        let Some(direction) = &self.direction else { return Ok(()) };
        require_finite(format!("direction of {what}"), direction, |i| format!("entry {i}"))?;
        if direction.iter().all(|entry| *entry == 0.0) {
            return Err(Error::out_of_range(format!("the length of direction of {what}"), "positive", 0.0));
        }
        Ok(())
    }

    /// Checks that all `count` obstacles that it names exist.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub(crate) fn check_obstacles(&self, what: &str, count: usize) -> Result<()> {
        match self.touch.iter().filter_map(|contact| contact.obstacle).find(|obstacle| *obstacle >= count) {
            None => Ok(()),
            Some(obstacle) => {
                let requirement = format!("the index of one of the {count} obstacles");
                Err(Error::out_of_range(format!("obstacle in touch of {what}"), &requirement, obstacle as f64))
            }
        }
    }

    /// The displacement of the tip (m), seen from the base; `along_z` is the default direction.
    pub(crate) fn displacement(&self, tip: &Frame, along_z: f64) -> [f64; 3] {
        let of_tip = |v: [f64; 3]| std::array::from_fn(|k| (0..3).map(|axis| tip.axes[axis][k] * v[axis]).sum());
        let along: [f64; 3] = match (self.direction, self.frame) {
            (None, _) => of_tip([0.0, 0.0, along_z]),
            (Some(direction), LineFrame::Tip) => of_tip(direction),
            (Some(direction), LineFrame::Base) => direction,
        };
        scaled(&direction(&along), self.distance)
    }

    /// The obstacles with the contacts that are allowed on the line.
    pub(crate) fn obstacles(&self, obstacles: &[Obstacle]) -> Obstacles {
        let allowed = |i: usize| {
            let of_this =
                self.touch.iter().filter(move |contact| contact.obstacle.is_none_or(|obstacle| obstacle == i));
            of_this.flat_map(|contact| contact.links.iter().cloned())
        };
        let touched = |(i, obstacle): (usize, &Obstacle)| {
            let links = obstacle.touch().iter().cloned().chain(allowed(i)).collect();
            Obstacle::new(obstacle.shape.clone(), links)
        };
        obstacles.iter().enumerate().map(touched).collect()
    }
}
