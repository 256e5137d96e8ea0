//! Arms with a spherical shoulder and a spherical wrist (SRS): their distance decides the elbow, and the arm angle the rotation of
//! the whole about the line between them.

use crate::closed_form::angle::Angle;
use crate::closed_form::angle_range::{AngleRange, may_hold};
use crate::closed_form::axis_chain::{AxisChain, AxisKind};
use crate::closed_form::branches::{Candidates, Doubt};
use crate::closed_form::orbit::about_z;
use crate::closed_form::structure::{EXACT, three_meet};
use crate::closed_form::subproblem::distance_to_point;
use crate::closed_form::vector::{Vector, add_scaled, cross, dot, norm, perpendicular, scaled, sub};
use crate::closed_form::wrist::{Pointing, Wrist};
use crate::math::Frame;
use crate::math::arithmetic::Baseline;

/// Squared distance of shoulder and wrist, as a multiple of its rounding, below which a pose within the tolerances of a caller may have
/// any line between them, and any arm angle.
const NO_LINE: f64 = 1e5;

/// An SRS arm, prepared.
#[derive(Debug, Clone, Copy)]
pub struct ArmAngle {
    shoulder: Vector,
    wrist: Vector,
    elbow_axis: Vector,
    elbow: Vector,
    pub(super) first: Wrist,
    pub(super) last: Wrist,
    /// The axes of the first and the last three joints.
    pub(super) axes: [[Vector; 3]; 2],
    /// Axis 1: at arm angle zero the elbow's axis is across the plane of axis 1 and the line from shoulder to wrist.
    upright: Vector,
    floor: f64,
}

/// A pose of an SRS arm, prepared for any arm angle.
#[derive(Debug, Clone, Copy)]
pub struct ArmAnglePose {
    /// z along the line from shoulder to wrist, y along the elbow's axis at arm angle zero.
    pub(super) frame: Frame,
    /// Where the last three joints point, seen from there.
    pub(super) last: Pointing,
    /// Only the first `count` count.
    elbows: [ElbowTurn; 2],
    count: usize,
    /// Joint 4 is free.
    pub(super) free: bool,
    /// Whether joint 4 may have other values.
    pub(super) doubt: Doubt,
}

impl ArmAnglePose {
    /// The values of joint 4 that its limits may hold.
    pub(super) fn elbows(&self, limits: &AngleRange) -> impl Iterator<Item = &ElbowTurn> {
        self.elbows[..self.count].iter().filter(|elbow| limits.may_hold(&elbow.q4))
    }
}

/// A value of joint 4.
#[derive(Debug, Clone, Copy)]
pub(super) struct ElbowTurn {
    q4: Angle,
    /// The rotation of the arm without that of its first three joints, seen from the line from shoulder to wrist.
    pub(super) from_line: Frame,
    /// Where the first three joints point, seen from there.
    pub(super) first: Pointing,
    /// From there to the last three joints.
    pub(super) to_wrist: Frame,
}

impl ElbowTurn {
    const NONE: Self = Self {
        q4: Angle::NONE,
        from_line: Frame::IDENTITY,
        first: Pointing { end: [0.0; 3], mark: [0.0; 3] },
        to_wrist: Frame::IDENTITY,
    };
}

impl ArmAngle {
    /// For chains whose first three and last three axes meet; `None` for others.
    pub fn new(chain: &AxisChain<7>) -> Option<Self> {
        if chain.joints.iter().any(|joint| joint.motion != AxisKind::Turns) {
            return None;
        }
        let size = chain.size();
        let [a, b, c, elbow, d, e, f] = &chain.joints;
        let shoulder = three_meet(&[*a, *b, *c], size, EXACT)?;
        let wrist = three_meet(&[*d, *e, *f], size, EXACT)?;
        let axes = [[a.axis, b.axis, c.axis], [d.axis, e.axis, f.axis]];
        Some(Self {
            shoulder,
            wrist,
            elbow_axis: elbow.axis,
            elbow: elbow.point,
            first: Wrist::new(&axes[0]),
            last: Wrist::new(&axes[1]),
            axes,
            upright: a.axis,
            floor: 1e-11 * size * size,
        })
    }

    /// Prepares the pose with the displacement `goal` for any arm angle.
    pub fn pose(&self, goal: &Frame) -> ArmAnglePose {
        let reached = sub(&goal.place::<Baseline>(&self.wrist), &self.shoulder);
        let (from_elbow, to_shoulder) = (sub(&self.wrist, &self.elbow), sub(&self.shoulder, &self.elbow));
        let square = dot(&reached, &reached);
        let mut q4 = distance_to_point(&self.elbow_axis, &from_elbow, &to_shoulder, square, self.floor);
        if square < NO_LINE * self.floor {
            q4.doubt = Doubt::Open;
        }
        let frame = self.frame(&reached, &self.across(&reached));
        let pointing = self.last.pointing(goal);
        let last = Pointing { end: frame.turn_back(&pointing.end), mark: frame.turn_back(&pointing.mark) };
        let mut pose =
            ArmAnglePose { frame, last, elbows: [ElbowTurn::NONE; 2], count: 0, free: q4.free, doubt: q4.doubt };
        for q4 in q4.iter() {
            let arm = sub(&q4.about(&self.elbow_axis, &from_elbow), &to_shoulder);
            let at_zero = self.frame(&arm, &self.elbow_axis);
            let [x, y, z] = &at_zero.axes;
            let turned = |v: &Vector| q4.back().about(&self.elbow_axis, v);
            let from_line = at_zero.inverse();
            pose.elbows[pose.count] = ElbowTurn {
                q4: *q4,
                from_line,
                first: self.first.pointing(&from_line),
                to_wrist: Frame { axes: [turned(x), turned(y), turned(z)], origin: [0.0; 3] },
            };
            pose.count += 1;
        }
        pose
    }

    /// All joint angles at an arm angle, as far as `ranges` may hold them.
    #[inline(always)]
    pub fn solve(&self, pose: &ArmAnglePose, arm_angle: Angle, ranges: &[AngleRange; 7], found: &mut Candidates) {
        let [a, b, c, of_elbow, d, e, f] = *ranges;
        let target = pose.frame.turned::<Baseline>(arm_angle.sin, arm_angle.cos);
        let back = |v: &Vector| about_z(arm_angle.back(), v);
        let seen = Pointing { end: back(&pose.last.end), mark: back(&pose.last.mark) };
        found.singular |= pose.free;
        found.doubt.add(pose.doubt);
        for ElbowTurn { q4, first, to_wrist, .. } in pose.elbows(&of_elbow) {
            let first = self.first.turns(&first.turned(&target), &[a, b, c]);
            // R567 = R4' R123' R.
            let last = self.last.turns(&seen.turned(to_wrist), &[d, e, f]);
            found.singular |= first.aligned || last.aligned;
            found.doubt.add(first.doubt.max(last.doubt));
            for [q1, q2, q3] in first.sets[..first.count].iter().filter(|set| may_hold(&[a, b, c], *set)) {
                for [q5, q6, q7] in last.sets[..last.count].iter().filter(|set| may_hold(&[d, e, f], *set)) {
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

    /// The frame with z along `line` and y near `across`.
    fn frame(&self, line: &Vector, across: &Vector) -> Frame {
        let size = norm(line);
        // With the wrist in the shoulder, any direction will do.
        let z = if size > 0.0 { scaled(line, 1.0 / size) } else { self.upright };
        let y = add_scaled(across, &z, -dot(across, &z));
        let length = norm(&y);
        let y = if length > 0.0 { scaled(&y, 1.0 / length) } else { perpendicular(&z) };
        Frame { axes: [cross(&y, &z), y, z], origin: [0.0; 3] }
    }
}
