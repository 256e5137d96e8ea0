//! Centre of all masses, and its velocity per unit rate of each joint.

use smallvec::SmallVec;

use super::rigid_bodies::Dynamics;
use crate::math::Frame;
use crate::math::arithmetic::NoFma;
use crate::math::so3::cross;

/// First moment of all that each frame carries, about its origin, in base axes (kg m).
type Moments = SmallVec<[[f64; 3]; 36]>;

impl Dynamics {
    /// Returns the centre of all masses in base axes (m), those of frame 0 included, and adds its velocity per unit rate of each joint
    /// to the linear rows of `columns`. The `frames` are those of all stages.
    pub(crate) fn center_of_mass_and_rates(&self, frames: &[Frame], columns: &mut [[f64; 6]]) -> [f64; 3] {
        let moments = self.carried_moments(frames);
        let total = self.carried[0];
        for (i, body) in self.bodies.iter().enumerate() {
            let (motion, axis) = (&body.motion, &frames[i + 1].axes[2]);
            let swept = cross(axis, &moments[i + 1]);
            let Some(column) = columns.get_mut(motion.joint) else { continue };
            for k in 0..3 {
                let slid = motion.slide_scale * self.carried[i + 1] * axis[k];
                column[k] += (motion.turn_scale * swept[k] + slid) / total;
            }
        }
        moments[0].map(|moment| moment / total)
    }

    fn carried_moments(&self, frames: &[Frame]) -> Moments {
        let mut moments = Moments::from_elem(self.base.first, 1);
        let own = self.bodies.iter().zip(&frames[1..]);
        moments.extend(own.map(|(body, frame)| frame.turn::<NoFma>(&body.moments.first)));
        for (i, body) in self.bodies.iter().enumerate().rev() {
            let (moved, mass) = (moments[i + 1], self.carried[i + 1]);
            let (to, from) = (&frames[i + 1].origin, &frames[body.parent].origin);
            let parent = &mut moments[body.parent];
            (0..3).for_each(|k| parent[k] += moved[k] + mass * (to[k] - from[k]));
        }
        moments
    }
}
