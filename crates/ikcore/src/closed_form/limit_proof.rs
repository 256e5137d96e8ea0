//! Proof by branch and bound that joint limits exclude every value of the parameter of a seven-joint arm, its first or last
//! joint.
//!
//! The other six joints are A to F: A, B and C carry a point to its position in the pose, and the axes of D, E and F meet
//! there. On an interval of the parameter each joint stays on arcs, bounded by known lever arms and rotation angles. If every
//! branch has a joint whose arc lies outside its limits, the interval has no solution; otherwise it is halved.

use std::f64::consts::PI;

use crate::closed_form::arm_angle_limits::Values;
use crate::closed_form::axis_chain::{AxisChain, reversed};
use crate::closed_form::enclosure::{Arc, Ball, Harmonic, distance};
use crate::closed_form::orbit::Orbit;
use crate::closed_form::parameter_arcs::ParameterArcs;
use crate::closed_form::structure::{EXACT, Pair, three_meet};
use crate::math::Frame;
use crate::math::arithmetic::Baseline;
use crate::math::vector3::{Vector, across, add, cross, dot, norm, scaled, sub};

/// Pose error (m, rad) that the proof covers: larger than the tolerances of a caller, and than rounding.
const POSE_ERROR: f64 = 2e-5;

/// Slack beyond the joint limits (rad) that counts as inside.
const SLACK: f64 = 1e-4;

/// Extension of the parameter arcs at both ends (rad): the shift of the ends by a pose error of [`POSE_ERROR`]. Near a fold the
/// other joints turn fast.
const FOLD_MARGIN: f64 = 1e-3;

/// Longest interval of the parameter (rad) that is examined whole.
const LONGEST: f64 = 0.4;

/// Half the length (rad) of the shortest interval that is still halved.
const SHORTEST: f64 = 0.002;

/// Largest number of intervals.
const MOST_INTERVALS: usize = 300;

/// Convergence radius of descents from a parameter value (rad).
const CONVERGENCE_RADIUS: f64 = 0.02;

/// Precomputed arm. Joints are in the order parameter, A, B, C, D, E, F.
#[derive(Debug, Clone, Copy)]
pub struct LimitProof {
    axes: [Vector; 7],
    /// Point on the axis of the parameter.
    parameter: Vector,
    /// Intersection of the axes of A and B.
    root: Vector,
    /// Intersection of the axes of D, E and F.
    centre: Vector,
    /// Vectors from the root to a point on the axis of C, and on to the centre.
    links: [Vector; 2],
    /// Squared distance from root to centre, as a function of C.
    distance: Harmonic,
    /// Cosine of the angle between the axes of D and F, as a function of E.
    bend: Harmonic,
    /// Unit vectors perpendicular to the axes of D and F.
    across: [[Vector; 2]; 2],
    /// True if the parameter is the last joint: the chain is taken from tip to base.
    reversed: bool,
    /// Displacement of the centre (m) by a pose error of [`POSE_ERROR`].
    off: f64,
}

/// Quantities that move with the parameter, for one pose and its limits.
struct PoseMotion<'a> {
    arm: &'a LimitProof,
    limits: [Arc; 7],
    /// Vector from the root to the centre.
    centre: Orbit,
    /// Squared length of that vector, and its component along the axis of A.
    distance: Harmonic,
    height: Harmonic,
    /// Axis of F.
    end: Orbit,
    /// Axis of F in the pose, and unit vectors perpendicular to it.
    end_axis: Vector,
    end_across: [Vector; 2],
}

impl LimitProof {
    /// Prepares the proof for the first joint as parameter, or the last; `None` unless three axes meet at the other end, and
    /// the two axes next to the parameter's.
    pub fn new(chain: &AxisChain<7>, by_first: bool) -> Option<Self> {
        let size = chain.size();
        let joints = if by_first { chain.joints } else { reversed(&chain.joints) };
        let centre = three_meet(&joints[4..], size, EXACT)?;
        let Pair::Meet(root) = Pair::of(&joints[1], &joints[2], size, EXACT) else { return None };
        let axes = joints.map(|joint| joint.axis);
        let [.., c, d, e, f] = &axes;
        let links = [sub(&joints[3].point, &root), sub(&centre, &joints[3].point)];
        Some(Self {
            parameter: joints[0].point,
            root,
            centre,
            distance: Harmonic::squared_distance(&Orbit::of(c, &links[1]), &scaled(&links[0], -1.0)),
            bend: Harmonic::along(d, &Orbit::of(e, f)),
            across: [d, f].map(|axis| [across(axis)[0], across(axis)[1]]),
            reversed: !by_first,
            off: POSE_ERROR * (1.0 + size + norm(&chain.tip.origin)),
            links,
            axes,
        })
    }

    /// Returns the first `most` values of the parameter on `arcs` near which a configuration may lie within limits; an empty
    /// list proves that there is none. Offers the midpoint of each open interval to `visit`, and stops where `visit` returns
    /// true: that value is then the last.
    pub fn open_values(
        &self,
        goal: &Frame,
        arcs: &ParameterArcs,
        limits: &[[f64; 2]; 7],
        most: usize,
        visit: &mut dyn FnMut(f64) -> bool,
    ) -> Values {
        let motion = PoseMotion::new(self, goal, limits);
        let mut open = BranchAndBound { values: Values::new(), most, left: MOST_INTERVALS, visit };
        for [first, last] in arcs.iter().map(|[first, last]| [first - FOLD_MARGIN, last + FOLD_MARGIN]) {
            let count = ((last - first) / LONGEST).ceil().max(1.0);
            let length = (last - first) / count;
            for start in (0..count as usize).map(|k| first + length * k as f64) {
                motion.add_open(&Arc::between([start, start + length]), &mut open);
            }
        }
        open.values
    }
}

/// State of the branch and bound.
struct BranchAndBound<'v> {
    values: Values,
    /// Number of values wanted, and of intervals that may still be examined.
    most: usize,
    left: usize,
    /// Returns true to stop at this value.
    visit: &'v mut dyn FnMut(f64) -> bool,
}

impl BranchAndBound<'_> {
    /// Whether there are enough values, or `part` lies within reach of one.
    fn covers(&self, part: &Arc) -> bool {
        let near = |value: &f64| (part.middle - value).abs() + part.half < CONVERGENCE_RADIUS;
        self.values.len() >= self.most || self.values.last().is_some_and(near)
    }
}

impl<'a> PoseMotion<'a> {
    fn new(arm: &'a LimitProof, goal: &Frame, limits: &[[f64; 2]; 7]) -> Self {
        let goal = if arm.reversed { goal.inverse() } else { *goal };
        let limits = std::array::from_fn(|k| Arc::between(limits[if arm.reversed { 6 - k } else { k }]).wider(SLACK));
        // Turning the parameter joint forward turns the pose backward for the other joints.
        let back = scaled(&arm.axes[0], -1.0);
        let centre = Orbit::of(&back, &sub(&goal.transform::<Baseline>(&arm.centre), &arm.parameter));
        let centre = centre.moved(&sub(&arm.parameter, &arm.root));
        let end_axis = goal.turn::<Baseline>(&arm.axes[6]);
        Self {
            arm,
            limits,
            distance: Harmonic::squared_distance(&centre, &[0.0; 3]),
            height: Harmonic::along(&arm.axes[1], &centre),
            centre,
            end: Orbit::of(&back, &end_axis),
            end_axis,
            end_across: arm.across[1].map(|v| goal.turn::<Baseline>(&v)),
        }
    }

    /// Adds values in `part` near which a configuration may lie within limits. Once the budget of intervals is spent, all
    /// remaining ones count as open.
    fn add_open(&self, part: &Arc, open: &mut BranchAndBound<'_>) {
        if open.covers(part) {
            return;
        }
        let is_last = part.half <= SHORTEST || open.left == 0;
        open.left = open.left.saturating_sub(1);
        if !self.may_hold(part) {
            return;
        }
        if (open.visit)(part.middle) {
            open.values.push(part.middle);
            open.most = open.values.len();
        } else if is_last {
            open.values.push(part.middle);
        } else {
            part.halves().iter().for_each(|half| self.add_open(half, open));
        }
    }

    /// Whether a branch may lie within limits with the parameter in `part`.
    fn may_hold(&self, part: &Arc) -> bool {
        let (turn, off) = (part.turn(), self.arm.off);
        let reached = Ball { middle: self.centre.at(turn), radius: part.half * norm(&self.centre.sine) + off };
        let slack = 2.0 * off * (norm(&reached.middle) + reached.radius);
        let elbows = self.arm.distance.arcs(self.distance.range_near(turn, part.half, slack), 0.0);
        elbows.into_iter().flatten().filter_map(|arc| arc.within(&self.limits[3])).any(|elbow| {
            self.arms(part, &reached, &elbow).into_iter().flatten().any(|arm| self.wrist_may_hold(part, &arm))
        })
    }

    /// Returns the arcs of A, B and C within limits, given the arc of C: rotA rotB u = `reached`, where u leads from the root
    /// to the centre before A and B turn.
    fn arms(&self, part: &Arc, reached: &Ball, elbow: &Arc) -> [Option<[Arc; 3]>; 2] {
        let LimitProof { axes: [_, a, b, c, ..], links: [upper, fore], off, .. } = self.arm;
        let u = Ball { middle: add(upper, &elbow.turn().about(c, fore)), radius: elbow.half * distance(c, fore) };
        let (slant, along, lever) = (dot(a, b), dot(b, &u.middle), distance(b, &u.middle));
        let constant = slant * along;
        let height_by_b =
            Harmonic { constant, cosine: dot(a, &u.middle) - constant, sine: dot(a, &cross(b, &u.middle)) };
        let height = self.height.range_near(part.turn(), part.half, off + slant.abs() * u.radius);
        let doubt = u.radius / lever;
        let Some(arcs) = height_by_b.arcs(height, if doubt < 1.0 { doubt } else { 1.0 }) else { return [None; 2] };
        // Derivative b'(u x du/dq4) with du/dq4 = c x rotC fore; zero if b and u are perpendicular to c.
        let by_elbow = norm(fore) * (dot(b, c).abs() * (norm(&u.middle) + u.radius) + dot(c, &u.middle).abs());
        let error = u.azimuth_error(b).min(elbow.half * by_elbow / u.least_distance(b).powi(2));
        arcs.map(|arc| {
            let second = arc.wider(error).within(&self.limits[2])?;
            let turned = u.turned(b, second.turn(), second.half);
            // Derivative a'(v x dv/dqB) with dv/dqB = b x v.
            let by_b =
                slant.abs() * dot(&u.middle, &u.middle) + (dot(a, &turned.middle).abs() + turned.radius) * along.abs();
            let nearest = turned.least_distance(a);
            let error = turned.azimuth_error(a).min((second.half * by_b / nearest + u.radius) / nearest);
            let (from, to) = (cross(a, &turned.middle), cross(a, &reached.middle));
            let middle = dot(a, &cross(&from, &to)).atan2(dot(&from, &to));
            let first = Arc { middle, half: error + reached.azimuth_error(a) }.within(&self.limits[1])?;
            Some([first, second, *elbow])
        })
    }

    /// Whether D, E and F may lie within limits with the other joints on these arcs.
    fn wrist_may_hold(&self, part: &Arc, arm: &[Arc; 3]) -> bool {
        let LimitProof { axes: [_, a, b, c, d, e, f], bend, .. } = self.arm;
        let mut end = Ball { middle: self.end.at(part.turn()), radius: part.half * norm(&self.end.sine) + POSE_ERROR };
        for (axis, arc) in [a, b, c].into_iter().zip(arm) {
            end = end.turned(axis, arc.turn().back(), arc.half);
        }
        let cosine = dot(d, &end.middle);
        let spread = end.radius * (distance(d, &end.middle) + 0.5 * end.radius);
        let cosines = [cosine - spread, cosine + spread];
        // Bound on the rotation of the bent axis about the other one as E turns: zero in a wrist with right angles.
        let squared_sine = 1.0 - cosines[0].abs().max(cosines[1].abs()).powi(2);
        let skew = dot(d, e).abs() + dot(e, f).abs();
        let error = |bend: &Arc| if squared_sine > 0.0 { bend.half * skew / squared_sine } else { PI };
        let bends = bend.arcs(cosines, 0.0);
        bends.into_iter().flatten().filter_map(|arc| arc.within(&self.limits[5])).any(|bend| {
            self.fourth_may_hold(&bend, &end, error(&bend)) && self.last_may_hold(part, arm, &bend, error(&bend))
        })
    }

    /// Whether D, which turns the bent axis of F to `end`, may lie within limits.
    fn fourth_may_hold(&self, bend: &Arc, end: &Ball, error: f64) -> bool {
        let LimitProof { axes: [_, _, _, _, d, e, f], across: [across, _], .. } = self.arm;
        let middle = azimuth(across, &end.middle) - azimuth(across, &bend.turn().about(e, f));
        Arc { middle, half: error + end.azimuth_error(d) }.within(&self.limits[4]).is_some()
    }

    /// Whether F may lie within limits: it turns the axis of D, expressed in the tip frame, to the bent one.
    fn last_may_hold(&self, part: &Arc, arm: &[Arc; 3], bend: &Arc, error: f64) -> bool {
        if self.limits[6].is_all() {
            return true;
        }
        let LimitProof { axes: [p, a, b, c, d, e, _], across: [_, across], .. } = self.arm;
        let mut seen = Ball { middle: *d, radius: POSE_ERROR };
        for (axis, arc) in [(c, &arm[2]), (b, &arm[1]), (a, &arm[0]), (p, part)] {
            seen = seen.turned(axis, arc.turn(), arc.half);
        }
        let middle = azimuth(across, &bend.turn().back().about(e, d)) - azimuth(&self.end_across, &seen.middle);
        Arc { middle, half: error + seen.azimuth_error(&self.end_axis) }.within(&self.limits[6]).is_some()
    }
}

/// Returns the azimuth of `v` about an axis, given two unit vectors perpendicular to it.
fn azimuth([x, y]: &[Vector; 2], v: &Vector) -> f64 {
    dot(y, v).atan2(dot(x, v))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_form::elbow_distance::ElbowDistance;
    use crate::closed_form::seven_joint_arms::{GEN3, PANDA, XARM7, iiwa14_of_urdf, random_angles};
    use crate::rng;

    fn arms() -> [([[f64; 4]; 7], bool); 4] {
        [(PANDA, false), (XARM7, false), (GEN3, true), (iiwa14_of_urdf(), true)]
    }

    /// Returns the arm with its tip frame set to the identity, and its proof.
    fn prepared((rows, by_first): ([[f64; 4]; 7], bool)) -> (AxisChain<7>, LimitProof) {
        let chain = AxisChain { tip: Frame::IDENTITY, ..AxisChain::of_rows(&rows) };
        (chain, LimitProof::new(&chain, by_first).expect("its axes meet"))
    }

    #[test]
    fn no_interval_around_a_configuration_is_excluded() {
        let mut rng = rng::stream(5, 0);
        for arm in arms() {
            let (chain, proof) = prepared(arm);
            for q in random_angles(20_000) {
                let [width, half] = [0, 1].map(|_| rng.uniform_in(-9.0, 0.0).exp());
                let mut limits =
                    q.map(|q| [q - width * rng.uniform_in(0.0, 1.0), q + width * rng.uniform_in(0.0, 1.0)]);
                let free = rng.uniform_in(0.0, 8.0) as usize;
                limits.iter_mut().take(free).for_each(|limits| *limits = [-4.0, 4.0]);
                let value = if arm.1 { q[0] } else { q[6] };
                let part = Arc { middle: value + half * rng.uniform_in(-1.0, 1.0), half };
                let goal = chain.tip_at(&q);
                assert!(PoseMotion::new(&proof, &goal, &limits).may_hold(&part), "{q:?} {limits:?} {part:?}");
                let open = proof.open_values(&goal, &ParameterArcs::CIRCLE, &limits, 1, &mut |_| false);
                assert!(!open.is_empty(), "{q:?} {limits:?}");
            }
        }
    }

    #[test]
    fn round_angles_at_limits_are_not_excluded() {
        let mut rng = rng::stream(6, 0);
        for arm in arms() {
            let (chain, proof) = prepared(arm);
            for mut q in random_angles(20_000) {
                for q in &mut q {
                    let off = if rng.uniform_in(0.0, 1.0) < 0.5 { 0.0 } else { rng.uniform_in(-30.0, -4.0).exp() };
                    let round = off + 0.5 * PI * rng.uniform_in(-2.5, 2.5).round();
                    *q = if rng.uniform_in(0.0, 1.0) < 0.4 { round } else { *q };
                }
                let limits = q.map(|q| match rng.uniform_in(0.0, 4.0) as usize {
                    0 => [q, q],
                    1 => [q, q + rng.uniform_in(0.0, 2.0)],
                    2 => [q - rng.uniform_in(0.0, 2.0), q],
                    _ => [q - rng.uniform_in(0.0, 1.0), q + rng.uniform_in(0.0, 1.0)],
                });
                let parameter = if arm.1 { 0 } else { 6 };
                let goal = chain.tip_at(&q);
                let part = Arc { middle: q[parameter], half: 0.0 };
                assert!(PoseMotion::new(&proof, &goal, &limits).may_hold(&part), "{q:?} {limits:?}");
                let distance = if arm.1 { ElbowDistance::by_first(&chain) } else { ElbowDistance::by_last(&chain) }
                    .expect("it has one");
                let arcs = distance.angles(&goal, distance.range(limits[3])).within(limits[parameter]);
                assert!(!arcs.is_empty(), "{q:?} {limits:?}");
                let open = proof.open_values(&goal, &arcs, &limits, 1, &mut |_| false);
                assert!(!open.is_empty(), "{q:?} {limits:?} {arcs:?}");
            }
        }
    }

    #[test]
    fn limits_apart_from_all_configurations_are_excluded() {
        for arm in arms() {
            let (chain, proof) = prepared(arm);
            let [mut excluded, mut empty] = [0; 2];
            for q in random_angles(300) {
                let mut limits = [[-2.9, 2.9]; 7];
                (limits[1], limits[5]) = ([q[1] + 0.5, q[1] + 1.0], [q[5] - 1.0, q[5] - 0.7]);
                let goal = chain.tip_at(&q);
                let open = proof.open_values(&goal, &ParameterArcs::CIRCLE, &limits, 1, &mut |_| false);
                excluded += usize::from(open.is_empty());
                empty += 1;
            }
            assert!(excluded > 100, "{excluded} of {empty}");
        }
    }
}
