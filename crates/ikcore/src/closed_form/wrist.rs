//! Spherical wrist: three revolute joints that produce a given rotation.

use crate::closed_form::angle::Angle;
use crate::closed_form::angle_range::AngleRange;
use crate::closed_form::branches::Doubt;
use crate::closed_form::orbit::{Orbit, about_z, seen};
use crate::closed_form::parameter_arcs::Wave;
use crate::closed_form::subproblem::{Angles, with_radicand};
use crate::math::Frame;
use crate::math::arithmetic::Baseline;
use crate::math::vector3::{Vector, across, cross, dot};

/// Sine of the angle between the outer axes below which they count as aligned: then only the sum or the difference of their
/// angles matters.
pub const ALIGNED: f64 = 1e-10;

/// Sine of that angle below which a pose within a caller's tolerances has a family of solutions, and rounding picks an
/// arbitrary member.
pub const NEARLY_ALIGNED: f64 = 1e-5;

/// Middle joint of a wrist (subproblem 4): angles q with outer' rot(axis, q) inner = outer' goal.
#[derive(Debug, Clone, Copy)]
pub struct Bend {
    outer: Vector,
    /// Coefficients of a cos q + b sin q + constant = outer' goal.
    a: f64,
    b: f64,
    constant: f64,
    /// Margins 1 - cos of the smallest angle between outer and goal, and 1 + cos of the largest.
    margins: [f64; 2],
    /// True if the axis is nearly parallel to an outer one, so that its joint has almost no effect and may be at any angle.
    is_idle: bool,
}

impl Bend {
    /// Prepares the rotation of `inner` about `axis`; all are unit vectors.
    pub fn new(outer: &Vector, axis: &Vector, inner: &Vector) -> Self {
        let across = cross(axis, inner);
        let (a, b) = (dot(&cross(axis, outer), &across), dot(outer, &across));
        let constant = dot(outer, axis) * dot(axis, inner);
        let radius = a.hypot(b);
        // Margins of rounding size are zero, so that no gap opens where the constant is exactly one.
        let margin = |m: f64| if m.abs() < 4e-16 { 0.0 } else { m };
        Self {
            outer: *outer,
            a,
            b,
            constant,
            margins: [margin(1.0 - (constant + radius)), margin(1.0 + (constant - radius))],
            is_idle: radius < NEARLY_ALIGNED,
        }
    }

    /// Returns the angles for a unit vector `goal`, and the sine of the angle between `outer` and `goal`.
    ///
    /// The radicand r^2 - (outer'goal - constant)^2 is the product of the distances of the cosine from both ends. Either
    /// distance is small if the wrist is straight; it is then computed from |outer x goal| instead of a cosine near one.
    #[inline(always)]
    pub fn angles(&self, goal: &Vector) -> (Angles<2>, f64) {
        let normal = cross(&self.outer, goal);
        self.angles_by(dot(&self.outer, goal), dot(&normal, &normal))
    }

    /// Returns the same as [`Self::angles`], given outer'goal and |outer x goal|^2.
    #[inline(always)]
    fn angles_by(&self, cosine: f64, square: f64) -> (Angles<2>, f64) {
        let (below_one, above_minus_one) = if cosine > 0.0 {
            (square / (1.0 + cosine), 1.0 + cosine)
        } else {
            (1.0 - cosine, square / (1.0 - cosine))
        };
        let radicand = (below_one - self.margins[0]) * (above_minus_one - self.margins[1]);
        let mut turns = with_radicand(self.a, self.b, cosine - self.constant, radicand);
        if self.is_idle {
            turns.doubt = Doubt::Anywhere;
        }
        (turns, square.sqrt())
    }
}

/// Spherical wrist whose neighbouring axes are not parallel.
#[derive(Debug, Clone, Copy)]
pub struct Wrist {
    /// Two unit vectors perpendicular to the first axis, and that axis.
    outer: [Vector; 3],
    bend: Bend,
    /// Last axis.
    end: Vector,
    /// Unit vector perpendicular to the last axis, called the mark.
    mark: Vector,
    /// Circles of the middle joint, in coordinates along `outer`: the mark, the third vector of the frame, and the last axis.
    inner: [Orbit; 3],
    /// True if the middle axis is perpendicular to both others: then the second solution follows from the first.
    square: bool,
}

/// Last axis of a wrist and the mark perpendicular to it, after a rotation.
#[derive(Debug, Clone, Copy)]
pub struct WristDirections {
    /// Last axis.
    pub end: Vector,
    /// Mark.
    pub mark: Vector,
}

impl WristDirections {
    /// Rotates both vectors by `frame`.
    #[inline(always)]
    pub fn turned(&self, frame: &Frame) -> Self {
        Self { end: frame.turn::<Baseline>(&self.end), mark: frame.turn::<Baseline>(&self.mark) }
    }
}

/// At most two solutions for the angles of a wrist.
#[derive(Debug, Clone, Copy)]
pub struct WristSolutions {
    /// Solutions; only the first `count` are valid.
    pub sets: [[Angle; 3]; 2],
    /// Number of solutions.
    pub count: usize,
    /// True if the outer axes are aligned: one solution represents a family.
    pub aligned: bool,
    /// Doubt whether the outer axes are nearly aligned, or the pose is nearly out of reach.
    pub doubt: Doubt,
    /// True if the pose is only just out of reach.
    pub near_miss: bool,
}

impl Wrist {
    /// Prepares a wrist from its axes, in order.
    pub fn new(axes: &[Vector; 3]) -> Self {
        let right_angle = |a: &Vector, b: &Vector| dot(a, b).abs() < 1e-12;
        let (outer, [mark, across_mark, end]) = (across(&axes[0]), across(&axes[2]));
        Self {
            outer,
            bend: Bend::new(&axes[0], &axes[1], &axes[2]),
            end,
            mark,
            inner: [mark, across_mark, end].map(|v| Orbit::of(&axes[1], &v).seen(&outer)),
            square: right_angle(&axes[0], &axes[1]) && right_angle(&axes[1], &axes[2]),
        }
    }

    /// Returns the first axis, and the cosine of its angle to the last axis as a function of the middle joint.
    pub fn bending(&self) -> (Vector, Wave) {
        let Bend { outer, a, b, constant, .. } = &self.bend;
        (*outer, Wave::new(*constant, *a, *b))
    }

    /// Returns the directions of the wrist after the rotation of `goal`.
    #[inline(always)]
    pub fn pointing(&self, goal: &Frame) -> WristDirections {
        WristDirections { end: goal.turn::<Baseline>(&self.end), mark: goal.turn::<Baseline>(&self.mark) }
    }

    /// Returns all angles whose product rot1 rot2 rot3, applied to the zero configuration, points the wrist to `goal`. A
    /// family is represented by the member deepest inside `ranges`.
    #[inline(always)]
    pub fn turns(&self, goal: &WristDirections, ranges: &[AngleRange; 3]) -> WristSolutions {
        let [x, y, z] = seen(&self.outer, &goal.end);
        let mark = seen(&self.outer, &goal.mark);
        let (bends, sine) = self.bend.angles_by(z, x * x + y * y);
        let mut found = WristSolutions {
            sets: [[Angle::NONE; 3]; 2],
            count: 0,
            aligned: sine < ALIGNED,
            doubt: bends.doubt,
            near_miss: bends.near_miss,
        };
        let wanted = if found.aligned { bends.len().min(1) } else { bends.len() };
        for q2 in &bends[..wanted] {
            found.sets[found.count] = if self.square && found.count == 1 {
                // Half a turn of the first joint turns the middle axis round; half a turn of the last makes up for it.
                let [q1, _, q3] = &found.sets[0];
                [q1.opposite(), *q2, q3.opposite()]
            } else {
                let [to_mark, to_across, to_end] = &self.inner;
                let (to_mark, to_across, to_end) = (to_mark.at(*q2), to_across.at(*q2), to_end.at(*q2));
                let towards = Angle::towards(to_end[0] * x + to_end[1] * y, to_end[0] * y - to_end[1] * x);
                let q1 = if found.aligned { Angle::NONE } else { towards };
                let left = about_z(q1.back(), &mark);
                [q1, *q2, Angle::towards(dot(&to_mark, &left), dot(&to_across, &left))]
            };
            found.count += 1;
        }
        if found.aligned && found.count > 0 {
            // Aligned outer joints turn about one line, in the same or the opposite sense.
            let ([_, q2, q3], sense) = (found.sets[0], 1.0_f64.copysign(z));
            let [q1, q3] = ranges[0].deepest_pair(&ranges[2], q3.signed(sense), sense);
            found.sets[0] = [q1, q2, q3];
        }
        if sine < NEARLY_ALIGNED {
            found.doubt = Doubt::Anywhere;
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vector3::{norm, sub, unit};

    fn rotation(axes: &[Vector; 3], turns: [Angle; 3]) -> Frame {
        axes.iter().zip(turns).fold(Frame::IDENTITY, |sum, (h, t)| sum.then::<Baseline>(&t.about_line(h, &[0.0; 3])))
    }

    #[test]
    fn right_angled_and_slanted_wrists_bent_by_any_angle() {
        let slanted = [[0.0, 0.0, 1.0], unit(&[0.0, 0.7, 0.7]), unit(&[0.3, 0.1, 0.9])];
        let equal = [[0.0, 0.0, 1.0], unit(&[0.0, 0.7, 0.7]), [0.0, 0.0, 1.0]];
        let square = [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        for axes in [square, slanted, equal] {
            let wrist = Wrist::new(&axes);
            for bend in [1.3, -0.4, 1e-3, 1e-6, 1e-9, -3e-8, 3.1, 0.0] {
                let goal = rotation(&axes, [Angle::by(0.7), Angle::by(bend), Angle::by(-1.9)]);
                let found = wrist.turns(&wrist.pointing(&goal), &[AngleRange::ANY; 3]);
                assert!(found.count >= 1, "{bend}");
                for set in &found.sets[..found.count] {
                    let reached = rotation(&axes, *set);
                    for k in 0..3 {
                        assert!(norm(&sub(&reached.axes[k], &goal.axes[k])) < 1e-14, "{axes:?} {bend}");
                    }
                }
            }
        }
    }
}
