//! Shoulder-wrist distance, which determines joint 4 of a seven-joint arm: bounds the parameter by the limits of joint 4.
//!
//! If the first three axes meet, the wrist is a point on axes 5 and 6 that turns about axis 7; if the last three meet, the
//! shoulder is a point on axes 2 and 3 that turns about axis 1.

use crate::closed_form::axis_chain::{AxisChain, AxisKind};
use crate::closed_form::orbit::Orbit;
use crate::closed_form::parameter_arcs::{ParameterArcs, Wave};
use crate::closed_form::structure::{EXACT, Pair, three_meet};
use crate::math::Frame;
use crate::math::arithmetic::Baseline;
use crate::math::vector3::{Vector, dot, scaled, sub};

/// Precomputed shoulder and wrist.
#[derive(Debug, Clone, Copy)]
pub struct ElbowDistance {
    shoulder: Vector,
    wrist: Vector,
    /// Squared shoulder-wrist distance as a function of joint 4.
    by_joint_4: Wave,
    /// Circle of the wrist as joint 7 turns backwards, or of the shoulder as joint 1 turns.
    circle: Orbit,
    /// True if the parameter is joint 1 instead of joint 7.
    by_first: bool,
}

impl ElbowDistance {
    /// Prepares joint 7 or the arm angle as parameter; `None` unless the first three axes meet, and axes 5 and 6.
    pub fn by_last(chain: &AxisChain<7>) -> Option<Self> {
        let size = chain.size();
        let shoulder = three_meet(&chain.joints[..3], size, EXACT)?;
        let Pair::Meet(wrist) = Pair::of(&chain.joints[4], &chain.joints[5], size, EXACT) else { return None };
        let last = &chain.joints[6];
        let circle = Orbit::of(&scaled(&last.axis, -1.0), &sub(&wrist, &last.point)).moved(&last.point);
        Self::of(chain, [shoulder, wrist], circle, false)
    }

    /// Prepares joint 1 as parameter; `None` unless the last three axes meet, and axes 2 and 3.
    pub fn by_first(chain: &AxisChain<7>) -> Option<Self> {
        let size = chain.size();
        let wrist = three_meet(&chain.joints[4..], size, EXACT)?;
        let Pair::Meet(shoulder) = Pair::of(&chain.joints[1], &chain.joints[2], size, EXACT) else { return None };
        let first = &chain.joints[0];
        let circle = Orbit::of(&first.axis, &sub(&shoulder, &first.point)).moved(&first.point);
        Self::of(chain, [shoulder, wrist], circle, true)
    }

    fn of(chain: &AxisChain<7>, [shoulder, wrist]: [Vector; 2], circle: Orbit, by_first: bool) -> Option<Self> {
        let turns = chain.joints.iter().all(|joint| joint.motion == AxisKind::Turns);
        let elbow = &chain.joints[3];
        let square = |q: f64| squared_distance(&elbow.displacement(q).transform::<Baseline>(&wrist), &shoulder);
        turns.then(|| Self { shoulder, wrist, by_joint_4: Wave::of(square), circle, by_first })
    }

    /// Returns the smallest and the largest squared distance within the limits of joint 4 (rad).
    pub fn range(&self, limits: [f64; 2]) -> [f64; 2] {
        self.by_joint_4.range(limits)
    }

    /// Returns all arm angles of a spherical wrist, or none.
    pub fn arm_angles(&self, goal: &Frame, range: [f64; 2]) -> ParameterArcs {
        let square = squared_distance(&goal.transform::<Baseline>(&self.wrist), &self.shoulder);
        Wave::new(square, 0.0, 0.0).arcs_between(range, self.slack())
    }

    /// Returns the values of joint 7, or of joint 1, at which the squared distance lies within `range`.
    pub fn angles(&self, goal: &Frame, range: [f64; 2]) -> ParameterArcs {
        let Orbit { centre, cosine, sine } = &self.circle;
        let other = if self.by_first {
            goal.transform::<Baseline>(&self.wrist)
        } else {
            goal.turn_back(&sub(&self.shoulder, &goal.origin))
        };
        let way = sub(centre, &other);
        let wave = Wave::new(dot(&way, &way) + dot(cosine, cosine), 2.0 * dot(&way, cosine), 2.0 * dot(&way, sine));
        wave.arcs_between(range, self.slack())
    }

    /// Returns the change of the squared distance by poses within a caller's tolerances, for shoulder and wrist near each
    /// other.
    fn slack(&self) -> f64 {
        let [(_, longest), _] = self.by_joint_4.extremes();
        1e-7 * longest
    }
}

fn squared_distance(a: &Vector, b: &Vector) -> f64 {
    let way = sub(a, b);
    dot(&way, &way)
}
