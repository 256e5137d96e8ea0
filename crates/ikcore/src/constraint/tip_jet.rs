//! Velocity and turn rate of a tip over an interval of a joint motion, as Taylor polynomials and bounds of what they leave out.
//!
//! Along a chain, a vector r that is fixed in a body with the angular velocity w changes by r' = w x r. So the Taylor coefficients of axes,
//! levers and angular velocities follow from those of the joints, from the base outwards; and with the sizes in place of the vectors the same
//! recursion bounds the first coefficient left out, at every point of the interval.

use crate::kinematics::chain::Transmission;
use crate::math::Frame;
use crate::math::bernstein::bernstein;
use crate::math::vector3::{Vector, add_scaled, cross, dot, norm, sub};
use crate::robot::Robot;
use crate::trajectory::{Coefficients, derivative_bounds};

/// Number of Taylor coefficients of a velocity.
const ORDER: usize = 5;

/// Number of coefficients of the square of a velocity.
pub(crate) const SQUARE: usize = 2 * ORDER - 1;

/// Rounding of the coefficients of a square, relative to the sum of their sizes.
const ROUNDING: f64 = 1e-14;

/// A vector polynomial in x on \[-1, 1\], and a bound of its distance from the function that it approximates.
#[derive(Debug, Clone, Copy)]
pub(crate) struct VectorJet {
    powers: [Vector; ORDER],
    /// Largest distance.
    pub rest: f64,
    /// Bound of the size.
    pub size: f64,
}

/// Velocity and turn rate of a tip per unit of x on \[-1, 1\], to which an interval of a motion is mapped.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TipJet {
    /// Velocity of the origin (m).
    pub velocity: VectorJet,
    /// Angular velocity of the frame (rad).
    pub turn: VectorJet,
}

/// The moving elements that carry a tip, the innermost first: the number of the frame that each moves, and its motion.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TipElements {
    tip: usize,
    elements: Vec<(usize, Transmission)>,
}

impl VectorJet {
    /// The derivative.
    pub fn derivative(&self) -> Self {
        let mut powers = [[0.0; 3]; ORDER];
        for (k, power) in powers.iter_mut().take(ORDER - 1).enumerate() {
            *power = self.powers[k + 1].map(|entry| (k + 1) as f64 * entry);
        }
        let rest = ORDER as f64 * self.rest;
        let size = powers.iter().map(norm).sum::<f64>() + rest;
        Self { powers, rest, size }
    }

    /// The polynomial in the middle of the interval.
    pub fn middle(&self) -> Vector {
        self.powers[0]
    }

    /// The polynomial at an end of the interval, x = 1 or x = -1.
    pub fn end(&self, x: f64) -> Vector {
        self.powers.iter().rev().fold([0.0; 3], |sum, power| add_scaled(power, &sum, x))
    }

    /// The Bernstein coefficients of the polynomial times `scale` + `slope` x.
    pub fn control_points(&self, [scale, slope]: [f64; 2]) -> [Vector; ORDER + 1] {
        let of_axis = |axis: usize| {
            let mut powers = [0.0; ORDER + 1];
            for (k, power) in self.powers.iter().enumerate() {
                powers[k] += scale * power[axis];
                powers[k + 1] += slope * power[axis];
            }
            bernstein(&powers)
        };
        let by_axis = [of_axis(0), of_axis(1), of_axis(2)];
        std::array::from_fn(|i| by_axis.map(|of_axis| of_axis[i]))
    }

    /// Coefficients of the square of the polynomial, and their rounding.
    pub fn square(&self) -> ([f64; SQUARE], f64) {
        let mut square = [0.0; SQUARE];
        for (i, one) in self.powers.iter().enumerate() {
            for (k, other) in self.powers.iter().enumerate() {
                square[i + k] += dot(one, other);
            }
        }
        let rounding = ROUNDING * square.iter().map(|c| c.abs()).sum::<f64>();
        (square, rounding)
    }

    /// A bound of the size at every point of the interval, as tight as the interval is short.
    pub fn bound(&self) -> f64 {
        let (square, rounding) = self.square();
        let largest = bernstein(&square).into_iter().fold(0.0, f64::max);
        (largest + rounding).sqrt() + self.rest
    }
}

/// Coefficients of vectors, and bounds of their sizes with one more of them.
#[derive(Debug, Clone, Copy)]
struct Series {
    vectors: [Vector; ORDER],
    sizes: [f64; ORDER + 1],
}

/// Coefficients of numbers, and bounds of their sizes with one more of them.
struct Rates {
    numbers: [f64; ORDER],
    sizes: [f64; ORDER + 1],
}

impl Series {
    const ZERO: Self = Self { vectors: [[0.0; 3]; ORDER], sizes: [0.0; ORDER + 1] };

    /// A vector that a body with this angular velocity carries, in the middle of the interval, and a bound of its size over it. `more` is
    /// its rate of change in the body. Returns its derivative too.
    fn carried(turn: &Self, middle: Vector, size: f64, more: Option<&Self>) -> [Self; 2] {
        let [mut vector, mut change] = [Self::ZERO; 2];
        (vector.vectors[0], vector.sizes[0]) = (middle, size);
        for k in 0..=ORDER {
            let mut of_size = more.map_or(0.0, |more| more.sizes[k]);
            (0..=k).for_each(|i| of_size += turn.sizes[i] * vector.sizes[k - i]);
            change.sizes[k] = of_size;
            if k < ORDER {
                vector.sizes[k + 1] = of_size / (k + 1) as f64;
                let mut sum = more.map_or([0.0; 3], |more| more.vectors[k]);
                for i in 0..=k {
                    sum = add_scaled(&sum, &cross(&turn.vectors[i], &vector.vectors[k - i]), 1.0);
                }
                change.vectors[k] = sum;
                if k + 1 < ORDER {
                    vector.vectors[k + 1] = sum.map(|entry| entry / (k + 1) as f64);
                }
            }
        }
        [vector, change]
    }

    /// The product with `rates`.
    fn times(&self, rates: &Rates) -> Self {
        let mut product = Self::ZERO;
        for k in 0..=ORDER {
            for i in 0..=k {
                product.sizes[k] += rates.sizes[i] * self.sizes[k - i];
                if k < ORDER {
                    product.vectors[k] = add_scaled(&product.vectors[k], &self.vectors[k - i], rates.numbers[i]);
                }
            }
        }
        product
    }

    fn add(&mut self, other: &Self) {
        for (vector, more) in self.vectors.iter_mut().zip(&other.vectors) {
            *vector = add_scaled(vector, more, 1.0);
        }
        self.sizes.iter_mut().zip(&other.sizes).for_each(|(size, more)| *size += more);
    }

    fn jet(&self) -> VectorJet {
        VectorJet { powers: self.vectors, rest: self.sizes[ORDER], size: self.sizes[0] }
    }
}

impl Rates {
    /// The derivative of `scale` times a polynomial on \[-1, 1\].
    fn of(polynomial: &Coefficients, scale: f64) -> Self {
        let mut numbers = [0.0; ORDER];
        for (k, number) in numbers.iter_mut().enumerate() {
            *number = scale * (k + 1) as f64 * polynomial[k + 1];
        }
        Self { numbers, sizes: derivative_bounds(polynomial).map(|bound: f64| scale.abs() * bound) }
    }
}

/// The element of `robot` that has no Taylor polynomials here, as the beginning of a remedy.
pub(super) fn why_no_jets(robot: &Robot) -> String {
    match robot.curve_leader() {
        Some(joint) => format!("a joint follows joint '{}' by a polynomial; ", joint.name),
        None => "a base that floats turns by a rotation vector; ".into(),
    }
}

impl TipElements {
    /// The elements that carry tip number `tip`; `None` where a rotation vector or a polynomial coupling is among them.
    pub fn of(robot: &Robot, tip: usize) -> Option<Self> {
        let mut elements: Vec<(usize, Transmission)> =
            robot.carriers(robot.frame_of_tip(tip), 0).map(|(frame, motion)| (frame, *motion)).collect();
        elements.reverse();
        (elements.iter().all(|(_, motion)| motion.is_linear())).then_some(Self { tip, elements })
    }

    /// The motion of the tip while the joints follow these polynomials on \[-1, 1\], with the moving elements at `frames` in the middle.
    pub fn jet(&self, robot: &Robot, frames: &[Frame], joints: &[Coefficients]) -> TipJet {
        let [velocity, turn] = self.series(robot, frames, |motion| {
            let rates = Rates::of(&joints[motion.joint], motion.scale());
            // From the middle to an end a slide moves the origin by no more than its fastest rate.
            let slid = rates.sizes[0];
            (rates, slid)
        });
        TipJet { velocity: velocity.jet(), turn: turn.jet() }
    }

    /// Bounds of the acceleration of the tip (m/s^2) and of the change of its turn rate (rad/s^2) for joints of these largest velocities and
    /// accelerations, for `duration` (s) from where the moving elements are at `frames`.
    pub fn growth(
        &self,
        robot: &Robot,
        frames: &[Frame],
        largest: impl Fn(usize) -> [f64; 2],
        duration: f64,
    ) -> [f64; 2] {
        let [velocity, turn] = self.series(robot, frames, |motion| {
            let mut rates = Rates { numbers: [0.0; ORDER], sizes: [0.0; ORDER + 1] };
            let [rate, change] = largest(motion.joint).map(|largest| largest * motion.scale().abs());
            (rates.sizes[0], rates.sizes[1]) = (rate, change);
            (rates, rate * duration)
        });
        [velocity.sizes[1], turn.sizes[1]]
    }

    /// Bounds of the speed (m/s) and the turn speed (rad/s) of the tip for joints of these largest velocities and positions, with the moving elements
    /// at `frames` where all joints are zero.
    pub fn fastest(&self, robot: &Robot, frames: &[Frame], [velocity, position]: [&[f64]; 2]) -> [f64; 2] {
        let [linear, turn] = self.series(robot, frames, |motion| {
            let mut rates = Rates { numbers: [0.0; ORDER], sizes: [0.0; ORDER + 1] };
            rates.sizes[0] = velocity[motion.joint] * motion.scale().abs();
            (rates, position[motion.joint] * motion.scale().abs())
        });
        [linear.sizes[0], turn.sizes[0]]
    }

    /// Coefficients of the velocity and the turn rate of the tip, for elements of these rates, that slide by this distance at most.
    fn series(&self, robot: &Robot, frames: &[Frame], of: impl Fn(&Transmission) -> (Rates, f64)) -> [Series; 2] {
        let (mut turn, mut velocity) = (Series::ZERO, Series::ZERO);
        let mut before: Option<Vector> = None;
        for (frame, motion) in &self.elements {
            let Frame { axes: [_, _, axis], origin } = frames[*frame];
            let (rates, slid) = of(motion);
            let [axis, _] = Series::carried(&turn, axis, 1.0, None);
            let along = axis.times(&rates);
            let slides = motion.turn_scale == 0.0;
            let lever = before.map_or([0.0; 3], |before| sub(&origin, &before));
            let longest = norm(&lever) + if slides { slid } else { 0.0 };
            velocity.add(&Series::carried(&turn, lever, longest, slides.then_some(&along))[1]);
            if !slides {
                turn.add(&along);
            }
            before = Some(origin);
        }
        if let Some(before) = before {
            let lever = sub(&robot.tip_among(self.tip, frames).origin, &before);
            velocity.add(&Series::carried(&turn, lever, norm(&lever), None)[1]);
        }
        [velocity, turn]
    }
}
