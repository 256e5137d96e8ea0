//! Moving bodies of a robot, in the order of their frames.

use super::inertia::Inertia;
use super::mass_moments::MassMoments;
use crate::kinematics::chain::Transmission;
use crate::kinematics::{CurvedStages, RotationVector};
use crate::math::so3::norm;

/// Friction and rotor of a joint, with those of its followers reflected.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointDrive {
    /// Viscous friction (N m s/rad, N s/m).
    pub damping: f64,
    /// Dry friction (N m, N), against the velocity.
    pub friction: f64,
    /// Inertia of the rotor, as the joint feels it (kg m^2, kg).
    pub armature: f64,
}

/// Everything that one stage carries.
#[derive(Debug, Clone)]
pub(crate) struct MovingBody {
    /// Index of the frame before the stage.
    pub parent: usize,
    pub motion: Transmission,
    /// Moments in the frame that the stage moves.
    pub moments: MassMoments,
}

/// Rigid bodies of a robot, gravity, friction and rotors.
///
/// Frame 0 is the base and frame i is moved by stage i - 1; the frames are those of [`Robot`](crate::robot::Robot), branches
/// included.
#[derive(Debug, Clone)]
pub struct Dynamics {
    /// Body of frame 0, which stands still.
    pub(super) base: MassMoments,
    /// Bodies of the frames from 1 on.
    pub(super) bodies: Vec<MovingBody>,
    /// Mass of all that each frame carries (kg).
    pub(super) carried: Vec<f64>,
    /// Acceleration of free fall in base axes (m/s^2).
    pub(super) gravity: [f64; 3],
    pub(super) drives: Vec<JointDrive>,
    pub(super) vector: Option<RotationVector>,
    /// First stages of polynomial couplings.
    pub(super) curves: CurvedStages,
}

impl Dynamics {
    pub(crate) fn new(
        base: MassMoments,
        bodies: Vec<MovingBody>,
        gravity: [f64; 3],
        drives: Vec<JointDrive>,
        (vector, curves): (Option<RotationVector>, CurvedStages),
    ) -> Self {
        let mut carried: Vec<f64> =
            std::iter::once(&base).chain(bodies.iter().map(|body| &body.moments)).map(|m| m.mass).collect();
        for (i, body) in bodies.iter().enumerate().rev() {
            carried[body.parent] += carried[i + 1];
        }
        Self { base, bodies, carried, gravity, drives, vector, curves }
    }

    /// Number of frames: one more than there are moving bodies.
    pub fn frames(&self) -> usize {
        self.bodies.len() + 1
    }

    /// Inertia of all that moves with frame `frame`, in its axes.
    pub fn inertia(&self, frame: usize) -> Inertia {
        frame.checked_sub(1).map_or(&self.base, |stage| &self.bodies[stage].moments).inertia()
    }

    /// Moments of all that moves with frame `frame` > 0, in that frame.
    pub(crate) fn moments(&self, frame: usize) -> &MassMoments {
        &self.bodies[frame - 1].moments
    }

    /// Index of the frame that frame `frame` > 0 moves on.
    pub fn parent(&self, frame: usize) -> usize {
        self.bodies[frame - 1].parent
    }

    /// Mass of all that frame `frame` carries (kg).
    pub fn carried_mass(&self, frame: usize) -> f64 {
        self.carried[frame]
    }

    /// Weight of all that moves (N).
    pub(crate) fn carried_weight(&self) -> f64 {
        let mass: f64 = self.bodies.iter().map(|body| body.moments.mass).sum();
        mass * norm(&self.gravity)
    }

    /// Returns the first joint that moves neither a mass nor a rotor: the mass matrix is singular everywhere.
    pub(crate) fn joint_without_mass(&self) -> Option<usize> {
        let moves = |(joint, drive): (usize, &JointDrive)| {
            let mut stages = self.bodies.iter().zip(&self.carried[1..]);
            drive.armature > 0.0
                || stages
                    .any(|(body, carried)| body.motion.joint == joint && body.motion.scale() != 0.0 && *carried > 0.0)
        };
        self.drives.iter().enumerate().find(|each| !moves(*each)).map(|(joint, _)| joint)
    }

    /// Acceleration of free fall in base axes (m/s^2).
    pub fn gravity(&self) -> [f64; 3] {
        self.gravity
    }

    /// Friction and rotor of each joint.
    pub fn drives(&self) -> &[JointDrive] {
        &self.drives
    }
}
