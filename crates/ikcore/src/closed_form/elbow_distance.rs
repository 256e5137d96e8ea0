//! The distance between shoulder and wrist, which determines joint 4 of an arm with seven joints: the values of the parameter that
//! the limits of joint 4 leave.

use crate::closed_form::axis_chain::{AxisChain, AxisMotion};
use crate::closed_form::orbit::Orbit;
use crate::closed_form::parameter_arcs::{ParameterArcs, Wave};
use crate::closed_form::structure::{EXACT, Pair, three_meet};
use crate::closed_form::vector::{Vector, dot, scaled, sub};
use crate::math::Frame;
use crate::math::arithmetic::Baseline;

/// Shoulder and a point on axes 5 and 6, prepared.
#[derive(Debug, Clone, Copy)]
pub struct ElbowDistance {
    shoulder: Vector,
    wrist: Vector,
    /// Their squared distance, by joint 4.
    by_joint_4: Wave,
    /// The circle of the wrist as joint 7 is turned back.
    circle: Orbit,
}

impl ElbowDistance {
    /// `None` unless the first three axes meet, and axes 5 and 6.
    pub fn of(chain: &AxisChain<7>) -> Option<Self> {
        if chain.joints.iter().any(|joint| joint.motion != AxisMotion::Turns) {
            return None;
        }
        let size = chain.size();
        let shoulder = three_meet(&chain.joints[..3], size, EXACT)?;
        let Pair::Meet(wrist) = Pair::of(&chain.joints[4], &chain.joints[5], size, EXACT) else { return None };
        let [.., elbow, _, _, last] = &chain.joints;
        let square = |q: f64| squared_distance(&elbow.displacement(q).place::<Baseline>(&wrist), &shoulder);
        let circle = Orbit::of(&scaled(&last.axis, -1.0), &sub(&wrist, &last.point)).moved(&last.point);
        Some(Self { shoulder, wrist, by_joint_4: Wave::of(square), circle })
    }

    /// Smallest and largest squared distance within the limits of joint 4 (rad).
    pub fn range(&self, limits: [f64; 2]) -> [f64; 2] {
        self.by_joint_4.range(limits)
    }

    /// All arm angles of a spherical wrist, or none.
    pub fn arm_angles(&self, goal: &Frame, range: [f64; 2]) -> ParameterArcs {
        let square = squared_distance(&goal.place::<Baseline>(&self.wrist), &self.shoulder);
        Wave::new(square, 0.0, 0.0).arcs_between(range)
    }

    /// The values of joint 7 at which the squared distance is within `range`.
    pub fn last_angles(&self, goal: &Frame, range: [f64; 2]) -> ParameterArcs {
        let Orbit { centre, cosine, sine } = &self.circle;
        let shoulder = goal.turn_back(&sub(&self.shoulder, &goal.origin));
        let way = sub(centre, &shoulder);
        let wave = Wave::new(dot(&way, &way) + dot(cosine, cosine), 2.0 * dot(&way, cosine), 2.0 * dot(&way, sine));
        wave.arcs_between(range)
    }
}

fn squared_distance(a: &Vector, b: &Vector) -> f64 {
    let way = sub(a, b);
    dot(&way, &way)
}
