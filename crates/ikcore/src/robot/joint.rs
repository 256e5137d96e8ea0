//! An independent joint: name, kind and limits.

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result, require_not_negative};
use crate::kinematics::JointCurve;
use crate::math::sampling_range;
use crate::message::{Message, Setting, message};
use crate::wording::{number, words};

/// Kind of motion of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum JointKind {
    /// Rotation between two limits (rad).
    Revolute,
    /// Rotation without limits (rad).
    Continuous,
    /// Translation between two limits (m).
    Prismatic,
}

words!("kind of a joint": JointKind { Revolute => "revolute", Continuous => "continuous", Prismatic => "prismatic" });

impl JointKind {
    /// True for joints that rotate, false for prismatic ones.
    pub fn turns(self) -> bool {
        self != Self::Prismatic
    }
}

/// An independent joint: one entry of q.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Joint {
    /// Its name, unique in the robot.
    pub name: String,
    /// Kind of motion.
    pub kind: JointKind,
    /// Lower position limit (rad or m); minus infinity if there is none.
    pub lower: f64,
    /// Upper position limit (rad or m); infinity if there is none.
    pub upper: f64,
    /// Velocity limit (rad/s or m/s); infinity where unknown, zero locks the joint.
    pub velocity: f64,
    /// The maker's acceleration limit (rad/s^2 or m/s^2); infinity where unknown. Only the rated limits use it.
    pub rated_acceleration: f64,
    /// The maker's jerk limit (rad/s^3 or m/s^3), likewise.
    pub rated_jerk: f64,
    /// The largest torque of its motor (N m, or N for a prismatic joint); infinity where unknown.
    pub rated_torque: f64,
    /// Viscous friction (N m s/rad, N s/m), with that of followers as this joint feels it.
    pub damping: f64,
    /// Dry friction (N m, N), likewise.
    pub friction: f64,
    /// Inertia of the rotor (kg m^2, kg), likewise.
    pub armature: f64,
}

/// Margin beyond a joint's limits (rad, m) in which its polynomial couplings stay valid: a start slightly outside is led inside.
const CURVE_SLACK: [f64; 2] = [0.2, 0.02];

/// Rounding beyond a limit, relative to the range of the joint: single precision, and six digits of a file.
const ROUNDING_OF_RANGE: f64 = 1e-6;
/// Smallest rounding (rad, m).
const LEAST_ROUNDING: f64 = 1e-9;

/// Excess over the limits of a joint that counts as rounding (rad, m).
pub(crate) fn limit_rounding(lower: f64, upper: f64) -> f64 {
    let range = if (upper - lower).is_finite() { upper - lower } else { 1.0 };
    (ROUNDING_OF_RANGE * range).max(LEAST_ROUNDING)
}

/// Play of joints that turn: 5 degrees, the calibration of a hobby servo (rad).
const TURNING_PLAY: f64 = 5.0 * std::f64::consts::PI / 180.0;
/// Play of joints that slide (m).
const SLIDING_PLAY: f64 = 5e-3;

/// Distance beyond a limit (rad, m) up to which a reading of a joint of this kind is taken as it is.
pub(crate) fn play(kind: Option<JointKind>) -> f64 {
    if kind.is_none_or(JointKind::turns) { TURNING_PLAY } else { SLIDING_PLAY }
}

/// Excess over a limit (rad, m) above which errors no longer suggest clipping.
const NEAR: [f64; 2] = [50.0 * std::f64::consts::PI / 180.0, 0.05];

/// Advice for a joint of this kind `beyond` its limit (rad, m).
pub(crate) fn way_inside(kind: Option<JointKind>, beyond: f64) -> Message {
    let [turning, sliding] = NEAR;
    let near = if kind.is_none_or(JointKind::turns) { turning } else { sliding };
    if beyond <= near { Setting::Clip.into() } else { "move it inside".into() }
}

/// The error for a joint of this kind (known where a robot is) outside its limits; `what` names the configuration.
pub(crate) fn outside_limits(
    what: impl Into<Message>,
    (joint, kind): (&str, Option<JointKind>),
    value: f64,
    [lower, upper]: [f64; 2],
    remedy: impl Into<Message>,
) -> Error {
    let beyond = number((lower - value).max(value - upper));
    let excess = message![format!("by {beyond} {}: ", position_unit(kind)), remedy];
    Error::OutsideLimits { what: what.into(), joint: joint.into(), value, lower, upper, excess }
}

/// Unit of the position of a joint; angles where the kind is not known.
pub(crate) fn position_unit(kind: Option<JointKind>) -> &'static str {
    if kind.is_none_or(JointKind::turns) { "rad" } else { "m" }
}

/// Half-width of the sampling range of an unlimited prismatic joint (m).
const UNLIMITED_SLIDE: f64 = 1.0;

impl Joint {
    /// A joint without limits.
    pub fn new(name: impl Into<String>, kind: JointKind) -> Self {
        let (lower, upper) = (f64::NEG_INFINITY, f64::INFINITY);
        let velocity = f64::INFINITY;
        let (rated_acceleration, rated_jerk, rated_torque) = (f64::INFINITY, f64::INFINITY, f64::INFINITY);
        let (damping, friction, armature) = (0.0, 0.0, 0.0);
        Self {
            name: name.into(),
            kind,
            lower,
            upper,
            velocity,
            rated_acceleration,
            rated_jerk,
            rated_torque,
            damping,
            friction,
            armature,
        }
    }

    /// Copy of the joint between these position limits (rad or m).
    pub fn with_range(self, lower: f64, upper: f64) -> Self {
        Self { lower, upper, ..self }
    }

    /// Copy of the joint with this velocity limit (rad/s or m/s).
    pub fn with_velocity(self, velocity: f64) -> Self {
        Self { velocity, ..self }
    }

    /// The finite range from which random configurations are drawn: one turn, or 2 m, wide on an open side. A limit beyond
    /// 1e6 turns (6.28e6 rad or m) counts as open.
    pub fn sampling_range(&self) -> (f64, f64) {
        self.sampling_range_within(self.lower, self.upper)
    }

    /// The middle of [`sampling_range`](Self::sampling_range) (rad or m).
    pub(crate) fn middle(&self) -> f64 {
        let (lower, upper) = self.sampling_range();
        0.5 * (lower + upper)
    }

    /// [`sampling_range`](Self::sampling_range) under other limits (rad or m).
    pub(crate) fn sampling_range_within(&self, lower: f64, upper: f64) -> (f64, f64) {
        let reach = if self.kind.turns() { std::f64::consts::PI } else { UNLIMITED_SLIDE };
        let (lower, upper) = sampling_range::opened(lower, upper);
        sampling_range::finite(lower, upper, reach)
    }

    /// The motion of a follower by this polynomial (coefficients by ascending powers).
    pub(crate) fn curve(&self, polynomial: &[f64; 5]) -> JointCurve {
        let slack = CURVE_SLACK[usize::from(!self.kind.turns())];
        JointCurve { coefficients: *polynomial, range: [self.lower - slack, self.upper + slack] }
    }

    /// Checks that the limits do not contradict each other.
    pub(super) fn validate(&self) -> Result<()> {
        let Self { lower, upper, velocity, .. } = *self;
        let limits = [
            ("lower", lower, lower < f64::INFINITY, "a number below infinity"),
            ("upper", upper, upper > f64::NEG_INFINITY, "a number above -infinity"),
            ("velocity", velocity, !velocity.is_nan(), "a number"),
        ];
        if let Some((side, value, _, requirement)) = limits.into_iter().find(|(_, _, valid, _)| !valid) {
            return Err(Error::out_of_range(format!("{side} limit of joint '{}'", self.name), requirement, value));
        }
        for (what, value) in [("damping", self.damping), ("friction", self.friction), ("armature", self.armature)] {
            require_not_negative(&format!("{what} of joint '{}'", self.name), value)?;
        }
        if !(self.rated_torque >= 0.0) {
            let what = format!("torque limit of joint '{}'", self.name);
            return Err(Error::out_of_range(what, "zero or more", self.rated_torque));
        }
        let joint = self.name.clone();
        if lower > upper {
            return Err(Error::EmptyRange { joint, lower, upper, time: None });
        }
        if velocity < 0.0 {
            return Err(Error::NegativeLimit { field: "velocity".into(), joint, value: velocity, time: 0.0 });
        }
        Ok(())
    }
}
