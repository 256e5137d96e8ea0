//! Arms with a spherical shoulder and a spherical wrist (SRS): the shoulder-wrist distance determines the elbow (subproblem
//! 3), and the arm angle rotates the arm about the shoulder-wrist line.

use crate::closed_form::angle::Angle;
use crate::closed_form::angle_range::{AngleRange, may_hold};
use crate::closed_form::axis_chain::{AxisChain, AxisKind};
use crate::closed_form::branches::{Candidates, Doubt};
use crate::closed_form::orbit::about_z;
use crate::closed_form::structure::{EXACT, three_meet};
use crate::closed_form::subproblem::subproblem3;
use crate::closed_form::wrist::{Wrist, WristDirections};
use crate::math::Frame;
use crate::math::arithmetic::Baseline;
use crate::math::vector3::{Vector, add_scaled, cross, dot, norm, perpendicular, scaled, sub};

/// Squared shoulder-wrist distance, as a multiple of its rounding error, below which the direction of the shoulder-wrist
/// line, and so the arm angle, is arbitrary within a caller's tolerances.
const NO_LINE: f64 = 1e5;

/// Precomputed SRS arm.
#[derive(Debug, Clone, Copy)]
pub struct ArmAngle {
    shoulder: Vector,
    wrist: Vector,
    elbow_axis: Vector,
    elbow: Vector,
    pub(super) first: Wrist,
    pub(super) last: Wrist,
    /// Axes of the first and the last three joints.
    pub(super) axes: [[Vector; 3]; 2],
    /// Axis 1: at arm angle zero the elbow axis is perpendicular to the plane of axis 1 and the shoulder-wrist line.
    upright: Vector,
    floor: f64,
}

/// Pose of an SRS arm, precomputed for any arm angle.
#[derive(Debug, Clone, Copy)]
pub struct ArmAnglePose {
    /// Frame with z along the shoulder-wrist line and y along the elbow axis at arm angle zero.
    pub(super) frame: Frame,
    /// Direction of the last three joints, expressed in `frame`.
    pub(super) last: WristDirections,
    /// Solutions for joint 4; only the first `count` are valid.
    elbows: [ElbowSolution; 2],
    count: usize,
    /// True if joint 4 is free.
    pub(super) free: bool,
    /// Doubt about further values of joint 4.
    pub(super) doubt: Doubt,
}

impl ArmAnglePose {
    /// Returns the values of joint 4 that may lie within its limits.
    pub(super) fn elbows(&self, limits: &AngleRange) -> impl Iterator<Item = &ElbowSolution> {
        self.elbows[..self.count].iter().filter(|elbow| limits.may_hold(&elbow.q4))
    }
}

/// One solution for joint 4.
#[derive(Debug, Clone, Copy)]
pub(super) struct ElbowSolution {
    q4: Angle,
    /// Rotation of the arm without its first three joints, expressed in the frame of the shoulder-wrist line.
    pub(super) from_line: Frame,
    /// Direction of the first three joints, in the same frame.
    pub(super) first: WristDirections,
    /// Rotation from that frame to the last three joints.
    pub(super) to_wrist: Frame,
}

impl ElbowSolution {
    const NONE: Self = Self {
        q4: Angle::NONE,
        from_line: Frame::IDENTITY,
        first: WristDirections { end: [0.0; 3], mark: [0.0; 3] },
        to_wrist: Frame::IDENTITY,
    };
}

impl ArmAngle {
    /// Returns the arm if its first three axes meet in a point, and its last three; `None` otherwise.
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

    /// Prepares the pose with displacement `goal` for any arm angle.
    pub fn pose(&self, goal: &Frame) -> ArmAnglePose {
        let reached = sub(&goal.transform::<Baseline>(&self.wrist), &self.shoulder);
        let (from_elbow, to_shoulder) = (sub(&self.wrist, &self.elbow), sub(&self.shoulder, &self.elbow));
        let square = dot(&reached, &reached);
        let mut q4 = subproblem3(&self.elbow_axis, &from_elbow, &to_shoulder, square, self.floor);
        if square < NO_LINE * self.floor {
            q4.doubt = Doubt::Anywhere;
        }
        let frame = self.frame(&reached, &self.across(&reached));
        let pointing = self.last.pointing(goal);
        let last = WristDirections { end: frame.turn_back(&pointing.end), mark: frame.turn_back(&pointing.mark) };
        let mut pose =
            ArmAnglePose { frame, last, elbows: [ElbowSolution::NONE; 2], count: 0, free: q4.free, doubt: q4.doubt };
        for q4 in q4.iter() {
            let arm = sub(&q4.about(&self.elbow_axis, &from_elbow), &to_shoulder);
            let at_zero = self.frame(&arm, &self.elbow_axis);
            let [x, y, z] = &at_zero.axes;
            let turned = |v: &Vector| q4.back().about(&self.elbow_axis, v);
            let from_line = at_zero.inverse();
            pose.elbows[pose.count] = ElbowSolution {
                q4: *q4,
                from_line,
                first: self.first.pointing(&from_line),
                to_wrist: Frame { axes: [turned(x), turned(y), turned(z)], origin: [0.0; 3] },
            };
            pose.count += 1;
        }
        pose
    }

    /// Adds all joint angles at an arm angle that may lie within `ranges`.
    #[inline(always)]
    pub fn solve(&self, pose: &ArmAnglePose, arm_angle: Angle, ranges: &[AngleRange; 7], found: &mut Candidates) {
        let [a, b, c, of_elbow, d, e, f] = *ranges;
        let target = pose.frame.turned::<Baseline>(arm_angle.sin, arm_angle.cos);
        let back = |v: &Vector| about_z(arm_angle.back(), v);
        let seen = WristDirections { end: back(&pose.last.end), mark: back(&pose.last.mark) };
        found.singular |= pose.free;
        found.doubt.add(pose.doubt);
        for ElbowSolution { q4, first, to_wrist, .. } in pose.elbows(&of_elbow) {
            let first = self.first.turns(&first.turned(&target), &[a, b, c]);
            // Rotation of the wrist: R567 = R4' R123' R.
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

    /// Returns the direction of the elbow axis at arm angle zero.
    fn across(&self, reached: &Vector) -> Vector {
        let across = cross(&self.upright, reached);
        if norm(&across) > 1e-9 * norm(reached) { across } else { perpendicular(&self.upright) }
    }

    /// Returns the frame with z along `line` and y near `across`.
    fn frame(&self, line: &Vector, across: &Vector) -> Frame {
        let size = norm(line);
        // A wrist that coincides with the shoulder leaves the direction arbitrary.
        let z = if size > 0.0 { scaled(line, 1.0 / size) } else { self.upright };
        let y = add_scaled(across, &z, -dot(across, &z));
        let length = norm(&y);
        let y = if length > 0.0 { scaled(&y, 1.0 / length) } else { perpendicular(&z) };
        Frame { axes: [cross(&y, &z), y, z], origin: [0.0; 3] }
    }
}
