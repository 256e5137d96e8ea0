//! Bounds of the distance of joint torques from the parabolas through three of their values.
//!
//! Along a path q(s) the torque of a joint is a(s) d2s/dt2 + b(s) (ds/dt)^2 + g(s). Sizes of masses, levers and turn rates bound the third
//! Taylor coefficients of a, b and g at every point of an interval, from the base outwards for motions and inwards for forces, as the
//! Newton-Euler algorithm computes their values; no position of the arm is needed.

use crate::dynamics::Dynamics;
use crate::kinematics::chain::Transmission;
use crate::math::Frame;
use crate::math::majorant::Majorant;
use crate::math::vector3::norm;
use crate::robot::Robot;

/// The largest value of |x (x^2 - 1)| on \[-1, 1\]: the factor from a bound of the third coefficient to the largest distance from the parabola
/// through the values at both ends and in the middle.
const OFF_PARABOLA: f64 = 0.384_900_179_459_750_6;

/// Sizes of a stage and of what it carries.
#[derive(Debug, Clone, PartialEq)]
struct Stage {
    parent: usize,
    motion: Transmission,
    /// Constant distance (m) from the origin of the parent.
    lever: f64,
    mass: f64,
    /// Size of the first moment (kg m), and trace of the second (kg m^2).
    first: f64,
    second: f64,
}

/// Sizes of the masses of a robot, in the order of its stages.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TorqueBend {
    stages: Vec<Stage>,
    gravity: f64,
    /// Inertia of the rotor of each joint (kg m^2, kg).
    rotors: Vec<f64>,
}

/// Largest distances of a joint's torque from parabolas: of the holding torque, and of the factors of (ds/dt)^2 and d2s/dt2.
pub(crate) type Rest = [f64; 3];

/// Number of these factors in a call that needs holding torques alone.
pub(super) const HOLD: usize = 1;
/// The same with the factor of (ds/dt)^2.
pub(crate) const HOLD_AND_SQUARE: usize = 2;
/// The same with the factor of d2s/dt2 too.
pub(crate) const ALL_FACTORS: usize = 3;

/// Bounds on the motion of a frame and on the load on it.
#[derive(Debug, Clone, Copy)]
struct Motion {
    turn: Majorant,
    velocity: Majorant,
    axis: Majorant,
    lever: Majorant,
    mass: f64,
    first: Majorant,
    /// Force and moment per (ds/dt)^2, then per d2s/dt2.
    force: [Majorant; 2],
    moment: [Majorant; 2],
}

impl Motion {
    const REST: Self = Self {
        turn: Majorant::ZERO,
        velocity: Majorant::ZERO,
        axis: Majorant::ZERO,
        lever: Majorant::ZERO,
        mass: 0.0,
        first: Majorant::ZERO,
        force: [Majorant::ZERO; 2],
        moment: [Majorant::ZERO; 2],
    };
}

/// Scratch memory of [`TorqueBend::rests`].
#[derive(Debug, Clone)]
pub(crate) struct BendScratch(Vec<Motion>);

impl TorqueBend {
    pub(super) fn new(robot: &Robot, dynamics: &Dynamics) -> Self {
        let stage = |(i, (parent, frame, motion)): (usize, (usize, Frame, Transmission))| {
            let moments = dynamics.moments(i + 1);
            let second = (0..3).map(|k| moments.second[k][k]).sum();
            Stage {
                parent,
                motion,
                lever: norm(&frame.origin),
                mass: moments.mass,
                first: norm(&moments.first),
                second,
            }
        };
        let stages = robot.moving_elements().enumerate().map(stage).collect();
        let rotors = dynamics.drives().iter().map(|drive| drive.armature).collect();
        Self { stages, gravity: norm(&dynamics.gravity()), rotors }
    }

    pub(super) fn scratch(&self) -> BendScratch {
        BendScratch(vec![Motion::REST; self.stages.len() + 1])
    }

    /// Writes the first rests (n,) over an interval \[-1, 1\] on which the derivatives of the joints' positions have these majorants; `farthest`
    /// bounds the positions of slides (m).
    pub(super) fn rests<const FACTORS: usize>(
        &self,
        rates: impl Fn(usize) -> Majorant,
        farthest: impl Fn(usize) -> f64,
        BendScratch(motions): &mut BendScratch,
        rests: &mut [Rest],
    ) {
        motions[0] = Motion::REST;
        for (i, stage) in self.stages.iter().enumerate() {
            motions[i + 1] = stage.outward::<FACTORS>(&motions[stage.parent], &rates, &farthest);
        }
        for (joint, (rest, rotor)) in rests.iter_mut().zip(&self.rotors).enumerate() {
            let rate = rates(joint).scaled(rotor * OFF_PARABOLA);
            *rest = [0.0, rate.derivative().coefficient(3), rate.coefficient(3)];
        }
        for (i, stage) in self.stages.iter().enumerate().rev() {
            let motion = motions[i + 1];
            let by_stage = OFF_PARABOLA * stage.motion.scale().abs();
            let rest = &mut rests[stage.motion.joint];
            let slides = stage.motion.turn_scale == 0.0;
            let load = if slides { motion.force } else { motion.moment };
            for (rest, load) in rest[1..FACTORS].iter_mut().zip(&load) {
                *rest += by_stage * motion.axis.times(load).coefficient(3);
            }
            let weight = if slides { motion.axis.scaled(motion.mass) } else { motion.axis.times(&motion.first) };
            rest[0] += by_stage * self.gravity * weight.coefficient(3);
            motions[stage.parent].carry::<FACTORS>(&motion);
        }
    }
}

impl Stage {
    fn outward<const FACTORS: usize>(
        &self,
        parent: &Motion,
        rates: impl Fn(usize) -> Majorant,
        farthest: impl Fn(usize) -> f64,
    ) -> Motion {
        let rate = rates(self.motion.joint).scaled(self.motion.scale().abs());
        let axis = Majorant::carried(&parent.turn, 1.0, &Majorant::ZERO);
        let along = axis.times(&rate);
        let (turn, lever) = if self.motion.turn_scale == 0.0 {
            let slid = self.motion.slide_scale.abs() * farthest(self.motion.joint) + self.motion.slide_offset.abs();
            (parent.turn, Majorant::carried(&parent.turn, self.lever + slid, &along))
        } else {
            (parent.turn.plus(&along), Majorant::carried(&parent.turn, self.lever, &Majorant::ZERO))
        };
        let first = Majorant::carried(&turn, self.first, &Majorant::ZERO);
        if FACTORS == HOLD {
            return Motion { turn, axis, lever, mass: self.mass, first, ..Motion::REST };
        }
        let velocity = parent.velocity.plus(&lever.derivative());
        let point = Majorant::carried(&turn, 1.0, &Majorant::ZERO);
        let force = velocity.scaled(self.mass).plus(&first.derivative());
        let swing = |change: &Majorant| point.times(change).scaled(self.second);
        let of_point = point.derivative();
        let of_square = first.times(&velocity.derivative()).plus(&swing(&of_point.derivative()));
        let of_change =
            if FACTORS == ALL_FACTORS { first.times(&velocity).plus(&swing(&of_point)) } else { Majorant::ZERO };
        let [force, moment] = [[force.derivative(), force], [of_square, of_change]];
        Motion { turn, velocity, axis, lever, mass: self.mass, first, force, moment }
    }
}

impl Motion {
    /// Adds the load of a child.
    fn carry<const FACTORS: usize>(&mut self, child: &Self) {
        for k in 0..FACTORS - 1 {
            self.force[k] = self.force[k].plus(&child.force[k]);
            self.moment[k] = self.moment[k].plus(&child.moment[k]).plus(&child.lever.times(&child.force[k]));
        }
        self.first = self.first.plus(&child.first).plus(&child.lever.scaled(child.mass));
        self.mass += child.mass;
    }
}
