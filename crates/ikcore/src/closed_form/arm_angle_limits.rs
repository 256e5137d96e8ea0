//! Arm angles of an SRS arm that the joint limits allow.
//!
//! As the arm angle turns, a vector carried by the first three joints describes a circle, and so does a vector before the
//! last three. A joint has a given angle where such a vector has a given component: at two arm angles at most (Shimizu,
//! Kakuya, Yoon, Kitagaki and Kosuge 2008 give the same for arms whose axes are at right angles).

use std::f64::consts::TAU;

use smallvec::SmallVec;

use crate::closed_form::angle::Angle;
use crate::closed_form::angle_range::{AngleRange, MOVED_BY_POLISHING};
use crate::closed_form::arm_angle::{ArmAngle, ArmAnglePose, ElbowSolution};
use crate::closed_form::branches::Doubt;
use crate::closed_form::orbit::about_z;
use crate::closed_form::parameter_arcs::Wave;
use crate::closed_form::wrist::Wrist;
use crate::math::Frame;
use crate::math::arithmetic::Baseline;
use crate::math::vector3::{Vector, dot};

/// Cosine of 0.001 rad: axes at a smaller angle are nearly aligned.
const ALIGNED_COSINE: f64 = 1.0 - 5e-7;

/// Parameter values (rad, m).
pub type Values = SmallVec<[f64; 64]>;

impl ArmAngle {
    /// Whether the limits of joints 2, 4 and 6 (rad) exclude every arm angle. Joints 2 and 6 each leave some arcs; if the
    /// arcs have no common arm angle, there is no configuration.
    pub fn is_excluded(&self, pose: &ArmAnglePose, limits: &[[f64; 2]; 7], of_elbow: &AngleRange) -> bool {
        // Margin for polishing, which may move a candidate from slightly outside to inside.
        let within = |wrist: &Wrist, [lower, upper]: [f64; 2], reached: &dyn Fn(Angle) -> Vector| {
            let (axis, cosine) = wrist.bending();
            let range = cosine.range([lower - MOVED_BY_POLISHING, upper + MOVED_BY_POLISHING]);
            Wave::of(|arm_angle| dot(&axis, &reached(Angle::by(arm_angle)))).arcs_between(range, 1e-5)
        };
        pose.doubt != Doubt::Anywhere
            && !pose.free
            && pose.elbows(of_elbow).all(|ElbowSolution { first, to_wrist, .. }| {
                let shoulder = within(&self.first, limits[1], &|arm_angle| {
                    pose.frame.turned::<Baseline>(arm_angle.sin, arm_angle.cos).turn::<Baseline>(&first.end)
                });
                let wrist = within(&self.last, limits[5], &|arm_angle| {
                    to_wrist.turn::<Baseline>(&about_z(arm_angle.back(), &pose.last.end))
                });
                !shoulder.meet(&wrist)
            })
    }

    /// Returns test values: if any arm angle (rad) has a configuration within limits, one of these has. They are the arm
    /// angles at which a joint reaches a limit, one between each two neighbours, and those at which shoulder or wrist are
    /// aligned. The test is not conclusive where an arm angle nearly aligns them, since the other joints turn fast there, or
    /// where joint 4 is nearly free.
    pub fn decisive(
        &self,
        pose: &ArmAnglePose,
        goal: &Frame,
        limits: &[[f64; 2]; 7],
        of_elbow: &AngleRange,
    ) -> Decisive {
        let (mut at_limits, mut aligned) = (Values::new(), Values::new());
        // A stretched elbow leaves its two values, and so all other joints, poorly determined.
        let mut is_sure = pose.doubt == Doubt::None;
        for ElbowSolution { from_line, to_wrist, .. } in pose.elbows(of_elbow) {
            let shoulder = |arm_angle: Angle, v: &Vector| {
                let line = pose.frame.turned::<Baseline>(arm_angle.sin, arm_angle.cos);
                line.turn::<Baseline>(&from_line.turn::<Baseline>(v))
            };
            let wrist = |arm_angle: Angle, v: &Vector| {
                let seen = pose.frame.turn_back(&goal.turn::<Baseline>(v));
                to_wrist.turn::<Baseline>(&about_z(arm_angle.back(), &seen))
            };
            add_at_limits(&self.axes[0], &limits[..3], &shoulder, &mut at_limits);
            add_at_limits(&self.axes[1], &limits[4..], &wrist, &mut at_limits);
            is_sure &= !add_aligned(&self.axes[0], &shoulder, &mut aligned);
            is_sure &= !add_aligned(&self.axes[1], &wrist, &mut aligned);
        }
        at_limits.sort_by(f64::total_cmp);
        let next = at_limits.iter().skip(1).copied().chain(at_limits.first().map(|first| first + TAU));
        let between: Values = at_limits.iter().zip(next).map(|(a, b)| 0.5 * (a + b)).collect();
        let anywhere = if at_limits.is_empty() { Some(0.0) } else { None };
        Decisive { values: aligned.into_iter().chain(between).chain(at_limits).chain(anywhere).collect(), is_sure }
    }
}

/// Parameter values that decide whether any configuration lies within limits.
#[derive(Debug, Clone)]
pub(crate) struct Decisive {
    /// Parameter values (rad, m).
    pub values: Values,
    /// True if the absence of a configuration at all of these values proves that there is none.
    pub is_sure: bool,
}

/// Adds the arm angles at which the first and the last of three axes are nearly aligned; returns whether there are any.
fn add_aligned([a, _, c]: &[Vector; 3], turned: &dyn Fn(Angle, &Vector) -> Vector, found: &mut Values) -> bool {
    let wave = Wave::of(|arm_angle| dot(a, &turned(Angle::by(arm_angle), c)));
    let before = found.len();
    found.extend(wave.extremes().into_iter().filter(|(_, cosine)| cosine.abs() > ALIGNED_COSINE).map(|(at, _)| at));
    found.len() > before
}

/// Adds the arm angles, in (-pi, pi], at which a joint of three is at a limit; `turned` returns a vector rotated by these
/// joints at an arm angle.
///
/// With axes a, b, c and R = rot(a, q1) rot(b, q2) rot(c, q3): (rot(a, q1) b)'R c = b'c, a'R c = a'rot(b, q2) c and a'R
/// rot(c, -q3) b = a'b.
fn add_at_limits(
    [a, b, c]: &[Vector; 3],
    limits: &[[f64; 2]],
    turned: &dyn Fn(Angle, &Vector) -> Vector,
    found: &mut Values,
) {
    let mut add = |seen_along: &Vector, v: &Vector, component: f64| {
        let wave = Wave::of(|arm_angle| dot(seen_along, &turned(Angle::by(arm_angle), v)));
        found.extend(wave.angles_at(component));
    };
    for (joint, range) in limits.iter().enumerate().filter(|(_, [lower, upper])| upper - lower < TAU) {
        for limit in range.map(Angle::by) {
            match joint {
                0 => add(&limit.about(a, b), c, dot(b, c)),
                1 => add(a, c, dot(a, &limit.about(b, c))),
                _ => add(a, &limit.back().about(c, b), dot(a, b)),
            }
        }
    }
}
