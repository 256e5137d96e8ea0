//! Arm tables as in data sheets: one DH row per joint, lengths in m, angles in degrees.

use nalgebra::Vector3;

use crate::dynamics::Inertia;
use crate::error::Result;
use crate::load::dh::{Dh, DhTable};
use crate::math::pose;
use crate::robot::{ChainBuilder, JointKind, Robot};

/// Robot arm as a table.
pub(super) struct Arm {
    pub convention: Dh,
    /// Rotation of DH frame 0 about the x axis of the base (deg).
    pub base_roll: f64,
    /// Joint names of the maker's ROS descriptions.
    pub joint_names: &'static [&'static str],
    pub joints: &'static [DhRow],
    /// Distance of the flange from the last DH frame, along its z (m).
    pub flange: f64,
    /// Inertias of links; none where no source gives them.
    pub bodies: &'static [LinkBody],
}

/// Inertia of a link, in its DH frame: mass (kg), centre (m), and xx, xy, xz, yy, yz, zz of the inertia matrix about the centre (kg m^2).
pub(super) struct LinkBody {
    pub link: &'static str,
    pub mass: f64,
    pub center: [f64; 3],
    pub matrix: [f64; 6],
}

/// Joint with its DH parameters (m, deg) and limits.
pub(super) struct DhRow {
    a: f64,
    alpha: f64,
    d: f64,
    theta: f64,
    limits: JointRange,
}

/// Position and velocity limits of a joint (rad, rad/s), and its rated acceleration, jerk and torque (rad/s^2, rad/s^3, N m; infinite
/// if the maker publishes none).
#[derive(Clone, Copy)]
pub(super) struct JointRange {
    kind: JointKind,
    lower: f64,
    upper: f64,
    velocity: f64,
    acceleration: f64,
    jerk: f64,
    torque: f64,
}

impl JointRange {
    /// Adds the maker's acceleration and jerk limits (rad/s^2, rad/s^3).
    pub(super) const fn rated(self, acceleration: f64, jerk: f64) -> Self {
        Self { acceleration, jerk, ..self }
    }

    /// Adds the maker's torque limit (N m).
    pub(super) const fn torque(self, torque: f64) -> Self {
        Self { torque, ..self }
    }
}

/// Creates a row: a and d in m, alpha and theta in degrees.
pub(super) const fn row(a: f64, alpha: f64, d: f64, theta: f64, limits: JointRange) -> DhRow {
    DhRow { a, alpha, d, theta, limits }
}

/// Creates limits from values in rad and rad/s.
pub(super) const fn radians(lower: f64, upper: f64, velocity: f64) -> JointRange {
    let (acceleration, jerk, torque) = (f64::INFINITY, f64::INFINITY, f64::INFINITY);
    JointRange { kind: JointKind::Revolute, lower, upper, velocity, acceleration, jerk, torque }
}

/// Creates limits from values in degrees and degrees per second.
pub(super) const fn degrees(lower: f64, upper: f64, velocity: f64) -> JointRange {
    radians(lower.to_radians(), upper.to_radians(), velocity.to_radians())
}

/// Creates the limits of a continuous joint, with the speed in degrees per second.
pub(super) const fn endless(velocity: f64) -> JointRange {
    JointRange { kind: JointKind::Continuous, ..radians(f64::NEG_INFINITY, f64::INFINITY, velocity.to_radians()) }
}

impl LinkBody {
    fn inertia(&self) -> (&'static str, Inertia) {
        let [xx, xy, xz, yy, yz, zz] = self.matrix;
        let matrix = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        (self.link, Inertia { mass: self.mass, center: self.center, matrix })
    }
}

impl Arm {
    /// Builds the robot; its last link is `flange` if the table has one.
    pub(super) fn build(&self, name: &str) -> Result<Robot> {
        let column = |value: fn(&DhRow) -> f64| self.joints.iter().map(value).collect::<Vec<f64>>();
        let (a, alpha, d) = (column(|row| row.a), column(|row| row.alpha.to_radians()), column(|row| row.d));
        let table = DhTable {
            theta: column(|row| row.theta.to_radians()),
            kinds: self.joints.iter().map(|row| row.limits.kind).collect(),
            lower: column(|row| row.limits.lower),
            upper: column(|row| row.limits.upper),
            velocity: column(|row| row.limits.velocity),
            ..DhTable::new(self.convention, a, alpha, d)
        };
        let mut chain = ChainBuilder::new(name, "base");
        chain.fixed(pose::rotation(Vector3::x(), self.base_roll.to_radians()));
        table.append_to(&mut chain)?;
        for (index, (row, name)) in self.joints.iter().zip(self.joint_names).enumerate() {
            let joint = chain.joint_mut(index);
            joint.name = (*name).into();
            (joint.rated_acceleration, joint.rated_jerk) = (row.limits.acceleration, row.limits.jerk);
            joint.rated_torque = row.limits.torque;
        }
        if self.flange != 0.0 {
            chain.fixed(pose::translation(0.0, 0.0, self.flange));
            chain.link("flange");
        }
        let robot = chain.build()?;
        if self.bodies.is_empty() { Ok(robot) } else { robot.with_inertias(self.bodies.iter().map(LinkBody::inertia)) }
    }
}
