//! Six revolute joints of general geometry: all solutions, at most sixteen.
//!
//! The loop equation E1 ... E6 = H, applied to the line of axis 2, reads
//!
//! E5 E6 H^-1 E1 (line 2) = E4^-1 E3^-1 (line 2).
//!
//! The fourteen functions of a line ([`line`]) turn this into fourteen equations. They are linear in the eight products of
//! (1, cos, sin) of q6 and q1, which are eliminated, and in the products of q3 and q4, whose coefficients are linear in cos
//! q5 and sin q5. The dialytic method ([`dialytic`]) leaves a determinant: a trigonometric polynomial in q5 of degree eight,
//! whose zeros on the unit circle, at most sixteen, are found together.
//!
//! Raghavan and Roth (1990) hide q3 instead and eliminate q1 and q2; Manocha and Canny (1994) solve for q3 as an eigenvalue.
//! Here the pose lies between the two eliminated angles, so that the determinant does not vanish identically for arms whose
//! neighbouring axes meet or are parallel. Sampled on the circle, the determinant is free of the spurious factor of their
//! methods, since its degree is known.

mod dialytic;
mod elimination;
mod line;

use crate::closed_form::angle::Angle;
use crate::closed_form::axis_chain::{JointAxis, reversed};
use crate::closed_form::subproblem::subproblem1;
use crate::closed_form::trigonometric::Polynomial;
use crate::math::Frame;
use crate::math::arithmetic::Baseline;
use crate::math::vector3::{Vector, perpendicular, scaled, sub};
use dialytic::{EQUATIONS, LoopCoefficients, PRODUCTS, determinant, null_pairs};
use elimination::{COLUMNS, Elimination, ROWS};
use line::LineFunctions;

/// Degree of the determinant in cosine and sine.
const DEGREE: usize = 8;
/// Number of samples of the determinant round the circle: enough for its degree and for the next coefficient.
const SAMPLES: usize = 20;
/// Largest noise, relative to the size of the polynomial, at which zeros are proven.
const NOISE: f64 = 1e-6;
/// Bound on the rounding error of the determinant, as a multiple of the coefficient beyond its degree.
const SAFETY: f64 = 30.0;

/// Rotations of the sample angles in [`General::spread`]; the second is about half a step.
const SPREAD: [Angle; 2] = [Angle::NONE, Angle { cos: 0.9889645119420956, sin: 0.1481526041591332 }];

/// Half-angle substitution cos q = (1 - x^2)/(1 + x^2), sin q = 2x/(1 + x^2): 1, cos and sin in powers of x, times 1 + x^2.
const HALF_ANGLE: [[f64; 3]; 3] = [[1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [0.0, 2.0, 0.0]];

/// Precomputed general arm.
#[derive(Debug, Clone)]
pub struct General {
    axes: [Vector; 6],
    /// Points on the axes, in units of the arm's size, relative to a point on axis 5.
    points: [Vector; 6],
    centre: Vector,
    size: f64,
    /// Line of axis 2 moved by joint 1: constant, cosine and sine parts.
    first: [LineFunctions; 3],
    /// Right side of the loop equation, turned back by q5: constant, cosine and sine parts; each column is a product of q3
    /// and q4 in powers of half-angle tangents.
    right: [[[f64; PRODUCTS]; ROWS]; 3],
    /// Right side in products of cosines and sines.
    products: [[f64; ROWS]; 9],
    circle: [Angle; SAMPLES],
    /// True if the chain is taken from tip to base, which hides q2.
    reversed: bool,
}

/// Statistics of the search for zeros.
#[derive(Debug, Clone, Copy)]
pub struct ZeroCount {
    /// Number of zeros that may be real angles; an upper bound on the number of branches.
    pub zeros: usize,
    /// True if all zeros were resolved and the determinant had the expected degree.
    pub sound: bool,
    /// Number of zeros shared by two branches.
    pub shared: usize,
}

/// Loop equation of one displacement.
struct LoopEquations {
    /// Displacement in coordinates about the centre, in units of the arm's size.
    goal: Frame,
    elimination: Elimination,
    /// Constant column of the left side.
    constant: [f64; ROWS],
    /// Six equations in the products of q3 and q4: constant, cos q5 and sin q5 parts.
    coefficients: [LoopCoefficients; 3],
}

impl General {
    /// Prepares any six revolute joints; `size` is a characteristic length of the arm (m).
    pub fn new(joints: &[JointAxis; 6], size: f64) -> Self {
        let axes = joints.map(|joint| joint.axis);
        let centre = joints[4].nearest_to(&joints[3].point);
        let points = joints.map(|joint| scaled(&sub(&joint.nearest_to(&centre), &centre), 1.0 / size));
        let second = LineFunctions::new(&axes[1], &points[1]);
        let back = |k: usize, line: &LineFunctions| line.turning(&scaled(&axes[k], -1.0), &points[k]);
        let mut right = [[[0.0; PRODUCTS]; ROWS]; 3];
        let mut products = [[0.0; ROWS]; 9];
        for (i, line) in back(2, &second).iter().enumerate() {
            for (j, line) in back(3, line).iter().enumerate() {
                products[3 * i + j] = line.numbers();
                let parts = line.turning(&scaled(&axes[4], -1.0), &[0.0; 3]);
                for (part, right) in parts.iter().zip(&mut right) {
                    let numbers = part.numbers();
                    for row in 0..ROWS {
                        for k in 0..PRODUCTS {
                            right[row][k] += numbers[row] * HALF_ANGLE[i][k / 3] * HALF_ANGLE[j][k % 3];
                        }
                    }
                }
            }
        }
        let step = std::f64::consts::TAU / SAMPLES as f64;
        Self {
            axes,
            points,
            centre,
            size,
            first: second.turning(&axes[0], &points[0]),
            right,
            products,
            circle: std::array::from_fn(|k| Angle::by(step * k as f64)),
            reversed: false,
        }
    }

    /// Prepares the same arm from tip to base.
    pub fn reversed(joints: &[JointAxis; 6], size: f64) -> Self {
        Self { reversed: true, ..Self::new(&reversed(joints), size) }
    }

    /// Calls `found` with candidates near all joint angles whose displacements make `goal`.
    pub fn solve(&self, goal: &Frame, mut found: impl FnMut([Angle; 6])) -> ZeroCount {
        let loops = self.loop_equations(goal);
        let (polynomial, beyond) = self.polynomial(&loops.coefficients);
        let noise = (SAFETY * beyond).max(1e-15 * polynomial.size());
        let mut value = |q5: Angle| determinant(&combined(&loops.coefficients, q5)) * (0.5 * SAMPLES as f64);
        let zeros = polynomial.zeros_by_samples::<{ 2 * DEGREE }>(noise, &mut value);
        let shared = zeros.iter().map(|q5| self.visit_pairs(&loops, *q5, &mut found) - 1).sum();
        let sound = zeros.settled && noise <= NOISE * polynomial.size();
        ZeroCount { zeros: zeros.possible, sound, shared }
    }

    /// Calls `found` with candidates at angles spread round the circle, zeros or not: for poses whose determinant is too
    /// small on a part of the circle to locate its zeros.
    pub fn spread(&self, goal: &Frame, mut found: impl FnMut([Angle; 6])) {
        let loops = self.loop_equations(goal);
        for turn in &self.circle {
            for part in SPREAD {
                self.visit_pairs(&loops, turn.and(part), &mut found);
            }
        }
    }

    /// Calls `found` with the candidates at q5, and returns their number.
    fn visit_pairs(&self, loops: &LoopEquations, q5: Angle, found: &mut impl FnMut([Angle; 6])) -> usize {
        let (pairs, count) = null_pairs(&combined(&loops.coefficients, q5));
        for [q3, q4] in &pairs[..count] {
            let mut all = self.remaining_joints(loops, [*q3, *q4, q5]);
            if self.reversed {
                all.reverse();
            }
            found(all);
        }
        count
    }

    /// Prepares the loop equation of a displacement.
    fn loop_equations(&self, goal: &Frame) -> LoopEquations {
        let goal = if self.reversed { goal.inverse() } else { *goal };
        // Coordinates about the centre, in units of the arm's size.
        let origin = scaled(&sub(&goal.transform::<Baseline>(&self.centre), &self.centre), 1.0 / self.size);
        let goal = Frame { origin, ..goal };
        let (left, constant) = self.left_side(&goal);
        let elimination = Elimination::new(left);
        let coefficients = self.coefficients(&elimination, &constant);
        LoopEquations { goal, elimination, constant, coefficients }
    }

    /// Evaluates E6 H^-1 E1 (line 2): the columns of the products of q6 and q1, and the constant column.
    fn left_side(&self, goal: &Frame) -> ([[f64; ROWS]; COLUMNS], [f64; ROWS]) {
        let back = goal.inverse();
        let mut columns = [[0.0; ROWS]; COLUMNS];
        let mut constant = [0.0; ROWS];
        for (j, line) in self.first.iter().enumerate() {
            for (i, line) in line.moved(&back).turning(&self.axes[5], &self.points[5]).iter().enumerate() {
                match 3 * i + j {
                    0 => constant = line.numbers(),
                    k => columns[k - 1] = line.numbers(),
                }
            }
        }
        (columns, constant)
    }

    /// Returns six equations in the products of q3 and q4: constant, cos q5 and sin q5 parts.
    fn coefficients(&self, elimination: &Elimination, constant: &[f64; ROWS]) -> [LoopCoefficients; 3] {
        let rows = elimination.annihilators();
        let mut equations = [[[0.0; PRODUCTS]; EQUATIONS]; 3];
        for (equations, right) in equations.iter_mut().zip(&self.right) {
            for (equation, row) in equations.iter_mut().zip(&rows) {
                for (factor, right) in row.iter().zip(right) {
                    (0..PRODUCTS).for_each(|k| equation[k] += factor * right[k]);
                }
            }
        }
        for (equation, row) in equations[0].iter_mut().zip(&rows) {
            let one: f64 = (0..ROWS).map(|k| row[k] * constant[k]).sum();
            (0..PRODUCTS).for_each(|k| equation[k] -= one * HALF_ANGLE[0][k / 3] * HALF_ANGLE[0][k % 3]);
        }
        equations
    }

    /// Returns the determinant as a polynomial in q5, and its next coefficient, which would be zero without rounding.
    fn polynomial(&self, equations: &[LoopCoefficients; 3]) -> (Polynomial<{ DEGREE + 1 }>, f64) {
        let (mut cosines, mut sines) = ([0.0; DEGREE + 2], [0.0; DEGREE + 2]);
        for (sample, q5) in self.circle.iter().enumerate() {
            let value = determinant(&combined(equations, *q5));
            for k in 0..DEGREE + 2 {
                let multiple = self.circle[sample * k % SAMPLES];
                cosines[k] += value * multiple.cos;
                sines[k] += value * multiple.sin;
            }
        }
        cosines[0] *= 0.5;
        let beyond = cosines[DEGREE + 1].hypot(sines[DEGREE + 1]);
        let within = |all: [f64; DEGREE + 2]| std::array::from_fn(|k| all[k]);
        (Polynomial { cosines: within(cosines), sines: within(sines) }, beyond)
    }

    /// Returns all joints, given q3, q4 and q5: q6 and q1 from the eliminated products, q2 from the remaining rotation.
    fn remaining_joints(&self, loops: &LoopEquations, [q3, q4, q5]: [Angle; 3]) -> [Angle; 6] {
        let LoopEquations { goal, elimination, constant, .. } = loops;
        let [h1, h2, h3, h4, h5, h6] = &self.axes;
        let mut right = [0.0; ROWS];
        for (i, a) in [1.0, q3.cos, q3.sin].iter().enumerate() {
            for (j, b) in [1.0, q4.cos, q4.sin].iter().enumerate() {
                (0..ROWS).for_each(|k| right[k] += a * b * self.products[3 * i + j][k]);
            }
        }
        let right = self.turned_back(q5, &right);
        let unknown = elimination.solve(std::array::from_fn(|k| right[k] - constant[k]));
        // Products have the index 3 i + j with i for q6 and j for q1; the constant one is left out.
        let q1 = Angle::towards(unknown[0], unknown[1]);
        let q6 = Angle::towards(unknown[2], unknown[5]);
        // Joint 2: E2 = E1^-1 H E6^-1 E5^-1 E4^-1 E3^-1, applied to a vector perpendicular to axis 2.
        let mark = perpendicular(h2);
        let mut v = mark;
        for (turn, axis) in [(q3, h3), (q4, h4), (q5, h5), (q6, h6)] {
            v = turn.back().about(axis, &v);
        }
        let q2 = subproblem1(h2, &mark, &q1.back().about(h1, &goal.turn::<Baseline>(&v)));
        [q1, q2, q3, q4, q5, q6]
    }

    /// Rotates the fourteen numbers by -q5 about axis 5, which runs through the centre.
    fn turned_back(&self, q5: Angle, numbers: &[f64; ROWS]) -> [f64; ROWS] {
        let mut turned = *numbers;
        for first in [0, 3, 8, 11] {
            let v = [numbers[first], numbers[first + 1], numbers[first + 2]];
            turned[first..first + 3].copy_from_slice(&q5.back().about(&self.axes[4], &v));
        }
        turned
    }
}

fn combined(equations: &[LoopCoefficients; 3], q5: Angle) -> LoopCoefficients {
    let [still, cosine, sine] = equations;
    std::array::from_fn(|i| std::array::from_fn(|k| still[i][k] + q5.cos * cosine[i][k] + q5.sin * sine[i][k]))
}
