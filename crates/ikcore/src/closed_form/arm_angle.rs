//! Arms with a spherical shoulder and a spherical wrist (SRS): their distance decides the elbow, and the arm angle the rotation of
//! the whole about the line between them.

use crate::closed_form::angle::Angle;
use crate::closed_form::axis_chain::{AxisChain, AxisMotion};
use crate::closed_form::branches::Candidates;
use crate::closed_form::structure::{EXACT, three_meet};
use crate::closed_form::subproblem::distance_to_point;
use crate::closed_form::vector::{Vector, add_scaled, cross, dot, norm, perpendicular, scaled, sub};
use crate::closed_form::wrist::{Pointing, Wrist};
use crate::math::Frame;
use crate::math::arithmetic::Baseline;

/// An SRS arm, prepared.
#[derive(Debug, Clone, Copy)]
pub struct ArmAngle {
    shoulder: Vector,
    wrist: Vector,
    elbow_axis: Vector,
    elbow: Vector,
    first: Wrist,
    last: Wrist,
    /// Axis 1: at arm angle zero the elbow's axis is across the plane of axis 1 and the line from shoulder to wrist.
    upright: Vector,
    floor: f64,
}

impl ArmAngle {
    /// For chains whose first three and last three axes meet; `None` for others.
    pub fn new(chain: &AxisChain<7>) -> Option<Self> {
        if chain.joints.iter().any(|joint| joint.motion != AxisMotion::Turns) {
            return None;
        }
        let size = chain.size();
        let [a, b, c, elbow, d, e, f] = &chain.joints;
        let shoulder = three_meet(&[*a, *b, *c], size, EXACT)?;
        let wrist = three_meet(&[*d, *e, *f], size, EXACT)?;
        Some(Self {
            shoulder,
            wrist,
            elbow_axis: elbow.axis,
            elbow: elbow.point,
            first: Wrist::new(&[a.axis, b.axis, c.axis]),
            last: Wrist::new(&[d.axis, e.axis, f.axis]),
            upright: a.axis,
            floor: 1e-11 * size * size,
        })
    }

    /// All joint angles whose displacements make `goal` at an arm angle.
    #[inline]
    pub fn solve(&self, goal: &Frame, arm_angle: Angle, found: &mut Candidates<7>) {
        let reached = sub(&goal.place::<Baseline>(&self.wrist), &self.shoulder);
        let (from_elbow, to_shoulder) = (sub(&self.wrist, &self.elbow), sub(&self.shoulder, &self.elbow));
        let square = dot(&reached, &reached);
        let q4 = distance_to_point(&self.elbow_axis, &from_elbow, &to_shoulder, square, self.floor);
        let pointing = self.last.pointing(goal);
        let target = self.frame(&reached, &self.across(&reached), arm_angle);
        found.singular |= q4.free;
        for q4 in q4.iter() {
            let arm = sub(&q4.about(&self.elbow_axis, &from_elbow), &to_shoulder);
            let shoulder = rotation(&target, &self.frame(&arm, &self.elbow_axis, Angle::NONE));
            let first = self.first.turns(&self.first.pointing(&shoulder));
            // R567 = R4' R123' R.
            let left = |v: &Vector| q4.back().about(&self.elbow_axis, &shoulder.turn_back(v));
            let last = self.last.turns(&Pointing { end: left(&pointing.end), mark: left(&pointing.mark) });
            found.singular |= first.aligned || last.aligned;
            for [q1, q2, q3] in &first.sets[..first.count] {
                for [q5, q6, q7] in &last.sets[..last.count] {
                    found.push(&[*q1, *q2, *q3, *q4, *q5, *q6, *q7]);
                }
            }
        }
    }

    /// The direction of the elbow's axis at arm angle zero.
    fn across(&self, reached: &Vector) -> Vector {
        let across = cross(&self.upright, reached);
        if norm(&across) > 1e-9 * norm(reached) { across } else { perpendicular(&self.upright) }
    }

    /// The frame with z along `line` and y near `across`, turned about z.
    fn frame(&self, line: &Vector, across: &Vector, angle: Angle) -> Frame {
        let size = norm(line);
        // With the wrist in the shoulder, any direction will do.
        let z = if size > 0.0 { scaled(line, 1.0 / size) } else { self.upright };
        let y = add_scaled(across, &z, -dot(across, &z));
        let length = norm(&y);
        let y = if length > 0.0 { scaled(&y, 1.0 / length) } else { perpendicular(&z) };
        Frame { axes: [cross(&y, &z), y, z], origin: [0.0; 3] }.turned::<Baseline>(angle.sin, angle.cos)
    }
}

/// to from'.
fn rotation(to: &Frame, from: &Frame) -> Frame {
    to.then::<Baseline>(&from.inverse())
}
