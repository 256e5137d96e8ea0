//! The duration with the barrier of speeds and of limits of joints, at four points of the clock at a time.

use super::constraints::{Constraints, RatePoint};
use crate::math::arithmetic::{Arithmetic, by_instructions};
use crate::math::banded::Band;
use crate::math::f64x4::F64x4;

/// Joints after which products are small enough to go into a sum of logarithms.
const TOGETHER: usize = 8;

/// All points of the clock, in groups of four: each lane of the arithmetic is a point.
#[derive(Debug)]
pub(super) struct GroupedPoints {
    groups: Vec<FourPoints>,
    /// By group, then by joint.
    rows: Vec<FourRows>,
    joints: usize,
}

/// Four points; lanes beyond the last point rest at y = 1, where they add nothing.
#[derive(Debug, Clone, Copy)]
struct FourPoints {
    intervals: [usize; 4],
    weights: [[F64x4; 3]; 3],
    at_rest: F64x4,
    share: F64x4,
    slowness: F64x4,
}

/// The limits of a joint at four points.
#[derive(Debug, Clone, Copy)]
struct FourRows {
    acceleration: [F64x4; 2],
    jerk: [F64x4; 3],
}

impl GroupedPoints {
    pub(super) fn new(constraints: &Constraints) -> Self {
        let points = &constraints.points;
        let joints = constraints.joints;
        let mut groups = Vec::with_capacity(points.len().div_ceil(4));
        let mut rows = Vec::with_capacity(groups.capacity() * joints);
        for (i, four) in points.chunks(4).enumerate() {
            groups.push(FourPoints::new(four));
            let of_points = &constraints.rows[4 * i * joints..(4 * i + four.len()) * joints];
            rows.extend((0..joints).map(|joint| {
                let row = |lane: usize| of_points.get(lane * joints + joint);
                FourRows {
                    acceleration: std::array::from_fn(|k| {
                        lanes(|lane| row(lane).map_or(0.0, |row| row.acceleration[k]))
                    }),
                    jerk: std::array::from_fn(|k| lanes(|lane| row(lane).map_or(0.0, |row| row.jerk[k]))),
                }
            }));
        }
        Self { groups, rows, joints }
    }

    fn all(&self) -> impl Iterator<Item = (&FourPoints, &[FourRows])> {
        self.groups.iter().zip(self.rows.chunks_exact(self.joints))
    }

    /// The duration with the barrier; `None` outside of the limits.
    pub(super) fn value(&self, coefficients: &[f64], barrier: f64) -> Option<f64> {
        value(self, coefficients, barrier)
    }

    /// The largest part of a room that a step takes, with the jerk limits linearised; at least `least`.
    pub(super) fn taken(&self, coefficients: &[f64], step: &[f64], least: f64) -> f64 {
        taken(self, coefficients, step, least)
    }

    /// Adds the gradient and the second derivatives of the duration with the barrier.
    pub(super) fn expand(&self, coefficients: &[f64], barrier: f64, gradient: &mut [f64], band: &mut Band) {
        expand(self, coefficients, barrier, gradient, band);
    }
}

by_instructions! {
    fn value(points: &GroupedPoints, coefficients: &[f64], barrier: f64) -> Option<f64> {
        let (mut duration, mut logarithms) = (F64x4::ZERO, Logarithms::default());
        for (four, rows) in points.all() {
            let (of_four, least) = four.value::<A>(coefficients, rows, &mut logarithms);
            if !least.0.iter().all(|least| *least > 0.0) {
                return None;
            }
            duration = A::add_x4(duration, of_four);
        }
        let value = duration.0.iter().sum::<f64>() - barrier * logarithms.sum();
        value.is_finite().then_some(value)
    }
}

by_instructions! {
    fn taken(points: &GroupedPoints, coefficients: &[f64], step: &[f64], least: f64) -> f64 {
        let mut taken = F64x4::splat(least);
        for (four, rows) in points.all() {
            taken = four.taken::<A>(coefficients, step, rows, taken);
        }
        taken.0.into_iter().fold(least, f64::max)
    }
}

by_instructions! {
    fn expand(points: &GroupedPoints, coefficients: &[f64], barrier: f64, gradient: &mut [f64], band: &mut Band) {
        let barrier = F64x4::splat(barrier);
        for (four, rows) in points.all() {
            four.expand::<A>(coefficients, barrier, rows).add_to::<A>(four, gradient, band);
        }
    }
}

impl FourPoints {
    fn new(points: &[RatePoint]) -> Self {
        let of = |value: &dyn Fn(&RatePoint) -> f64, rest: f64| lanes(|lane| points.get(lane).map_or(rest, value));
        let weight = |order: usize, k: usize| of(&|point| point.weights[order][k], 0.0);
        Self {
            intervals: std::array::from_fn(|lane| points[lane.min(points.len() - 1)].interval),
            weights: std::array::from_fn(|order| std::array::from_fn(|k| weight(order, k))),
            at_rest: of(&|_| 0.0, 1.0),
            share: of(&|point| point.share, 0.0),
            slowness: of(&|point| point.slowness, 0.0),
        }
    }

    /// y, y' and y'' at the points, for those that rest with the value `at_rest`.
    #[inline(always)]
    fn combined<A: Arithmetic>(&self, of: &[f64], at_rest: F64x4) -> [F64x4; 3] {
        let [i, j, k, l] = self.intervals;
        let [i, j, k, l] = [&of[i..i + 3], &of[j..j + 3], &of[k..k + 3], &of[l..l + 3]];
        let of = [F64x4([i[0], j[0], k[0], l[0]]), F64x4([i[1], j[1], k[1], l[1]]), F64x4([i[2], j[2], k[2], l[2]])];
        [
            A::add_x4(dot::<A>(&self.weights[0], &of), at_rest),
            dot::<A>(&self.weights[1], &of),
            dot::<A>(&self.weights[2], &of),
        ]
    }

    /// The duration, and the least room or y.
    #[inline(always)]
    fn value<A: Arithmetic>(
        &self,
        coefficients: &[f64],
        rows: &[FourRows],
        logarithms: &mut Logarithms,
    ) -> (F64x4, F64x4) {
        let one = F64x4::splat(1.0);
        let y = self.combined::<A>(coefficients, self.at_rest);
        let of_speed = A::mul_add_x4(-self.slowness, y[0], one);
        let squared_slow = A::div_x4(one, y[0]);
        let (mut least, mut product) = (below::<A>(of_speed, y[0]), of_speed);
        for rows in rows.chunks(TOGETHER) {
            for row in rows {
                let [a, b] = row.used::<A>(&y);
                let of_acceleration = A::mul_add_x4(-a, a, one);
                let of_jerk = A::mul_add_x4(-b, b, squared_slow);
                least = below::<A>(below::<A>(of_acceleration, of_jerk), least);
                product = A::mul_x4(product, A::mul_x4(of_acceleration, of_jerk));
            }
            product.0.iter().for_each(|product| logarithms.add(*product));
            product = one;
        }
        (A::mul_x4(self.share, A::sqrt_x4(squared_slow)), least)
    }

    /// The largest part of a room that a step takes, or `taken` if that is more.
    #[inline(always)]
    fn taken<A: Arithmetic>(&self, coefficients: &[f64], step: &[f64], rows: &[FourRows], taken: F64x4) -> F64x4 {
        let one = F64x4::splat(1.0);
        let (y, step) = (self.combined::<A>(coefficients, self.at_rest), self.combined::<A>(step, F64x4::ZERO));
        let squared_slow = A::div_x4(one, y[0]);
        let slow = A::sqrt_x4(squared_slow);
        let of_y = A::mul_x4(step[0], squared_slow);
        let slower = A::mul_x4(A::mul_x4(F64x4::splat(0.5), of_y), slow);
        let of_speed = A::div_x4(A::mul_x4(-self.slowness, step[0]), A::mul_add_x4(-self.slowness, y[0], one));
        let mut taken = above::<A>(above::<A>(taken, of_y), of_speed);
        for row in rows {
            let ([a, b], [da, db]) = (row.used::<A>(&y), row.used::<A>(&step));
            // The rooms 1 - a and 1 + a, then slow - b and slow + b: by one division each.
            let inverse = A::div_x4(one, A::mul_add_x4(-a, a, one));
            let [up, down] = [A::mul_x4(-da, A::add_x4(one, a)), A::mul_x4(da, A::sub_x4(one, a))];
            taken = above::<A>(taken, A::mul_x4(inverse, above::<A>(up, down)));
            let inverse = A::div_x4(one, A::mul_add_x4(-b, b, squared_slow));
            let up = A::mul_x4(-A::add_x4(slower, db), A::add_x4(slow, b));
            let down = A::mul_x4(A::sub_x4(db, slower), A::sub_x4(slow, b));
            taken = above::<A>(taken, A::mul_x4(inverse, above::<A>(up, down)));
        }
        taken
    }

    /// Derivatives of the duration with the barrier by y, y' and y''.
    #[inline(always)]
    fn expand<A: Arithmetic>(&self, coefficients: &[f64], barrier: F64x4, rows: &[FourRows]) -> FourDerivatives {
        let one = F64x4::splat(1.0);
        let y = self.combined::<A>(coefficients, self.at_rest);
        let squared_slow = A::div_x4(one, y[0]);
        let slow = A::sqrt_x4(squared_slow);
        // The derivative of 1 / sqrt(y).
        let slower = A::mul_x4(F64x4::splat(-0.5), A::mul_x4(slow, squared_slow));
        let mut barriers = FourDerivatives { gradient: [F64x4::ZERO; 3], curvature: [F64x4::ZERO; 6] };
        let (mut of_slow, mut of_slower, mut across) = (F64x4::ZERO, F64x4::ZERO, [F64x4::ZERO; 3]);
        for row in rows {
            let [a, b] = row.used::<A>(&y);
            // The rooms 1 - a and 1 + a: difference of their inverses, sum of the squares of these.
            let rooms = A::div_x4(F64x4::splat(2.0), A::mul_add_x4(-a, a, one));
            let difference = A::mul_x4(a, rooms);
            barriers.add_short::<A>([difference, A::mul_add_x4(difference, difference, rooms)], row.acceleration);
            // The rooms slow - b and slow + b: also the sum of their inverses, and the difference of the squares of these.
            let rooms = A::div_x4(F64x4::splat(2.0), A::mul_add_x4(-b, b, squared_slow));
            let [sum, difference] = [A::mul_x4(slow, rooms), A::mul_x4(b, rooms)];
            let squares = A::mul_x4(F64x4::splat(0.5), A::mul_add_x4(sum, sum, A::mul_x4(difference, difference)));
            barriers.add::<A>([difference, squares], row.jerk);
            of_slow = A::add_x4(of_slow, sum);
            of_slower = A::add_x4(of_slower, squares);
            let crossed = A::mul_x4(sum, difference);
            for k in 0..3 {
                across[k] = A::mul_add_x4(crossed, row.jerk[k], across[k]);
            }
        }
        let FourDerivatives { gradient, curvature } = &mut barriers;
        gradient[0] = A::mul_add_x4(-of_slow, slower, gradient[0]);
        let twice = A::mul_x4(F64x4::splat(2.0), across[0]);
        curvature[0] = A::mul_add_x4(slower, A::sub_x4(A::mul_x4(of_slower, slower), twice), curvature[0]);
        curvature[1] = A::mul_add_x4(-slower, across[1], curvature[1]);
        curvature[2] = A::mul_add_x4(-slower, across[2], curvature[2]);
        let inverse = A::div_x4(one, A::mul_add_x4(-self.slowness, y[0], one));
        barriers.add_short::<A>([-inverse, A::mul_x4(inverse, inverse)], [-self.slowness, F64x4::ZERO]);
        barriers.with_duration::<A>(barrier, A::mul_x4(self.share, slower), squared_slow)
    }
}

impl FourRows {
    /// The linear forms of the acceleration and of the jerk.
    #[inline(always)]
    fn used<A: Arithmetic>(&self, y: &[F64x4; 3]) -> [F64x4; 2] {
        let [a0, a1] = self.acceleration;
        [A::mul_add_x4(a0, y[0], A::mul_x4(a1, y[1])), dot::<A>(&self.jerk, y)]
    }
}

/// Derivatives by y, y' and y'' at four points.
#[derive(Debug, Clone, Copy)]
struct FourDerivatives {
    gradient: [F64x4; 3],
    /// (0, 0), (1, 0), (2, 0), (1, 1), (2, 1), (2, 2).
    curvature: [F64x4; 6],
}

impl FourDerivatives {
    /// Adds a barrier with these first and second derivatives by a linear form of y, y' and y''.
    #[inline(always)]
    fn add<A: Arithmetic>(&mut self, [first, second]: [F64x4; 2], [x, y, z]: [F64x4; 3]) {
        self.add_short::<A>([first, second], [x, y]);
        let of_z = A::mul_x4(second, z);
        self.gradient[2] = A::mul_add_x4(first, z, self.gradient[2]);
        self.curvature[2] = A::mul_add_x4(of_z, x, self.curvature[2]);
        self.curvature[4] = A::mul_add_x4(of_z, y, self.curvature[4]);
        self.curvature[5] = A::mul_add_x4(of_z, z, self.curvature[5]);
    }

    /// The same for a form of y and y'.
    #[inline(always)]
    fn add_short<A: Arithmetic>(&mut self, [first, second]: [F64x4; 2], [x, y]: [F64x4; 2]) {
        let [of_x, of_y] = [A::mul_x4(second, x), A::mul_x4(second, y)];
        self.gradient[0] = A::mul_add_x4(first, x, self.gradient[0]);
        self.gradient[1] = A::mul_add_x4(first, y, self.gradient[1]);
        self.curvature[0] = A::mul_add_x4(of_x, x, self.curvature[0]);
        self.curvature[1] = A::mul_add_x4(of_x, y, self.curvature[1]);
        self.curvature[3] = A::mul_add_x4(of_y, y, self.curvature[3]);
    }

    /// These times `barrier`, with the duration, whose derivative by y is `slope`.
    #[inline(always)]
    fn with_duration<A: Arithmetic>(mut self, barrier: F64x4, slope: F64x4, squared_slow: F64x4) -> Self {
        for k in 0..3 {
            self.gradient[k] = A::mul_x4(barrier, self.gradient[k]);
        }
        for k in 0..6 {
            self.curvature[k] = A::mul_x4(barrier, self.curvature[k]);
        }
        self.gradient[0] = A::add_x4(self.gradient[0], slope);
        let bent = A::mul_x4(F64x4::splat(-1.5), A::mul_x4(slope, squared_slow));
        self.curvature[0] = A::add_x4(self.curvature[0], bent);
        self
    }

    /// Adds the derivatives by the coefficients.
    #[inline(always)]
    fn add_to<A: Arithmetic>(&self, four: &FourPoints, gradient: &mut [f64], band: &mut Band) {
        let [xx, xy, xz, yy, yz, zz] = self.curvature;
        for i in 0..3 {
            let of_i = [four.weights[0][i], four.weights[1][i], four.weights[2][i]];
            let slope = dot::<A>(&self.gradient, &of_i);
            let turned =
                [dot::<A>(&[xx, xy, xz], &of_i), dot::<A>(&[xy, yy, yz], &of_i), dot::<A>(&[xz, yz, zz], &of_i)];
            for lane in 0..4 {
                gradient[four.intervals[lane] + i] += slope.0[lane];
            }
            for k in i..3 {
                let bent = dot::<A>(&turned, &[four.weights[0][k], four.weights[1][k], four.weights[2][k]]);
                for lane in 0..4 {
                    band[four.intervals[lane] + i][k - i] += bent.0[lane];
                }
            }
        }
    }
}

/// A sum of logarithms, of products: few logarithms of many factors.
#[derive(Debug)]
pub(super) struct Logarithms {
    sum: f64,
    product: f64,
}

impl Default for Logarithms {
    fn default() -> Self {
        Self { sum: 0.0, product: 1.0 }
    }
}

impl Logarithms {
    #[inline(always)]
    pub(super) fn add(&mut self, factor: f64) {
        self.product *= factor;
        if !(1e-100..1e100).contains(&self.product) {
            self.sum += self.product.ln();
            self.product = 1.0;
        }
    }

    pub(super) fn sum(&self) -> f64 {
        self.sum + self.product.ln()
    }
}

fn lanes(of: impl Fn(usize) -> f64) -> F64x4 {
    F64x4(std::array::from_fn(of))
}

#[inline(always)]
fn dot<A: Arithmetic>(a: &[F64x4; 3], b: &[F64x4; 3]) -> F64x4 {
    A::mul_add_x4(a[0], b[0], A::mul_add_x4(a[1], b[1], A::mul_x4(a[2], b[2])))
}

/// The smaller one; `b` if `a` is not a number.
#[inline(always)]
fn below<A: Arithmetic>(a: F64x4, b: F64x4) -> F64x4 {
    A::choose_below_x4(a, b, a, b)
}

/// The larger one; `a` if `b` is not a number.
#[inline(always)]
fn above<A: Arithmetic>(a: F64x4, b: F64x4) -> F64x4 {
    A::choose_below_x4(a, b, b, a)
}
