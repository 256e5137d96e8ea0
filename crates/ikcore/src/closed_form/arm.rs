//! Closed form of a robot's chain: extracts the joint axes, solves, and converts axis values to joint values.

use super::arm_branches::ArmBranches;
use super::axis_chain::{AxisChain, JointAxis};
use super::branches::MOST_JOINTS;
use super::configurations::{ArmConfigurations, Drives};
use super::five_joints::FiveJoints;
use super::planar::Planar;
use super::pose_family::PoseFamily;
use super::redundant::{Parameter, Redundant};
use super::six::{ClosedForm, Structure};
use super::structure::are_sharp;
use crate::kinematics::chain::{Chain, Transmission};
use crate::math::Frame;
use crate::math::arithmetic::Baseline;
use crate::math::vector3::add_scaled;

/// Reason why a chain has no closed form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NoClosedForm {
    /// No closed form exists for this number of joints.
    Joints(usize),
    /// A joint drives several axes, or none.
    Drives {
        /// Index of the joint.
        joint: usize,
        /// Number of axes that the joint drives.
        axes: usize,
    },
    /// The tip moves in this many directions: fewer than six, and fewer than the number of joints.
    Rank(usize),
    /// No method fits the geometry of these joints.
    Joined,
    /// The chain has prismatic joints, and no method fits.
    Sliding,
    /// The base floats.
    Floating,
    /// A joint follows another one by a polynomial.
    Curved,
}

/// Closed form of a chain of three to seven joints.
#[derive(Debug, Clone)]
pub(crate) struct ClosedFormArm {
    method: Method,
    drives: Drives,
    is_sharp: bool,
}

#[derive(Debug, Clone)]
enum Method {
    Planar(Box<Planar<3>>),
    Scara(Box<Planar<4>>),
    Five(Box<FiveJoints>),
    Six(Box<ClosedForm>),
    Seven(Box<Redundant>),
}

impl ClosedFormArm {
    /// Selects the method for a chain with these joint limits whose tip moves in `rank` directions.
    pub fn new(chain: &Chain, [lower, upper]: [&[f64]; 2], rank: usize) -> Result<Self, NoClosedForm> {
        let joints = lower.len();
        if !(3..=MOST_JOINTS).contains(&joints) {
            return Err(NoClosedForm::Joints(joints));
        }
        if !chain.curves.is_empty() {
            return Err(NoClosedForm::Curved);
        }
        let motions = &chain.motions[..chain.moving];
        for joint in 0..joints {
            let axes = motions.iter().filter(|motion| motion.joint == joint && scale_of(motion) != 0.0).count();
            if axes != 1 {
                return Err(NoClosedForm::Drives { joint, axes });
            }
        }
        if chain.vector.is_some() {
            return Err(NoClosedForm::Floating);
        }
        if rank < joints.min(6) {
            return Err(NoClosedForm::Rank(rank));
        }
        let slides = motions.iter().any(|motion| motion.slide_scale != 0.0);
        let unsolved = if slides { NoClosedForm::Sliding } else { NoClosedForm::Joined };
        let drives = drives_of(chain);
        let method = match joints {
            3 => Planar::new(&axes_of(chain)).map(|planar| Method::Planar(Box::new(planar))),
            4 => Planar::new(&axes_of(chain)).map(|scara| Method::Scara(Box::new(scara))),
            5 => FiveJoints::new(&axes_of(chain)).map(|five| Method::Five(Box::new(five))),
            6 => {
                let form = ClosedForm::new(&axes_of(chain));
                (form.structure() != Structure::Unsolved).then(|| Method::Six(Box::new(form)))
            }
            _ => Redundant::new(&axes_of(chain), &drives, [lower, upper]).map(|arm| Method::Seven(Box::new(arm))),
        };
        let method = method.ok_or(unsolved)?;
        let all = axes_of::<MOST_JOINTS>(chain);
        let is_sharp = are_sharp(&all.joints[..joints], all.size());
        Ok(Self { method, drives, is_sharp })
    }

    /// Describes the structure and the number of solutions in words. `joint_name` maps a joint index to its name.
    pub fn structure(&self, joint_name: impl Fn(usize) -> String) -> String {
        match &self.method {
            Method::Planar(_) => "planar; at most 2 solutions".into(),
            Method::Scara(_) => "SCARA; at most 2 solutions".into(),
            Method::Five(method) => format!("five joints, solved as six: {}", method.structure()),
            Method::Six(method) => method.structure().to_string(),
            Method::Seven(method) => match (method.parameter(), method.structure()) {
                (Parameter::Axis(axis), Some(structure)) => {
                    format!("{structure} for each value of joint '{}'", joint_name(self.drives.joint(axis)))
                }
                _ => "spherical shoulder and wrist; at most 8 solutions for each arm angle".into(),
            },
        }
    }

    /// Whether solving takes no longer than a numerical search: true of all methods but the general one for six joints.
    pub fn is_at_once(&self) -> bool {
        let general = match &self.method {
            Method::Planar(_) | Method::Scara(_) => false,
            Method::Five(method) => method.structure() == Structure::General,
            Method::Six(method) => method.structure() == Structure::General,
            Method::Seven(method) => method.structure() == Some(Structure::General),
        };
        !general
    }

    /// Whether the method can prove that a pose has no other solutions.
    pub fn proves(&self) -> bool {
        let method_proves = match &self.method {
            Method::Planar(_) | Method::Scara(_) | Method::Seven(_) => true,
            Method::Five(method) => method.structure().is_exact(),
            Method::Six(method) => method.structure().is_exact(),
        };
        method_proves && self.is_sharp
    }

    /// Whether the arm has more joints than a pose needs.
    pub fn is_redundant(&self) -> bool {
        matches!(self.method, Method::Seven(_))
    }

    /// Returns all configurations that bring the tip of the chain to `target`; `None` for redundant arms.
    pub fn solve(&self, target: &Frame) -> Option<ArmBranches> {
        Some(match &self.method {
            Method::Planar(method) => ArmBranches::of(&method.solve(target), &self.drives),
            Method::Scara(method) => ArmBranches::of(&method.solve(target), &self.drives),
            Method::Five(method) => ArmBranches::of(&method.solve(target), &self.drives),
            Method::Six(method) => ArmBranches::of(&method.solve(target), &self.drives),
            Method::Seven(_) => return None,
        })
    }

    /// Finds configurations that bring the tip of the chain to `target`, to be confirmed by forward kinematics; cheaper than
    /// [`Self::solve`] where possible. Finds none for redundant arms.
    #[inline]
    pub fn likely(&self, target: &Frame, found: &mut ArmConfigurations) {
        match &self.method {
            Method::Six(method) if method.structure().is_exact() => {
                method.likely(target, &self.drives, found);
                found.is_all &= self.is_sharp;
            }
            _ => *found = self.solve(target).map_or_else(ArmConfigurations::none, |found| found.configurations()),
        }
    }

    /// Finds configurations that bring the tip near `target`, for an arm whose structure holds only approximately. Returns
    /// false, and finds nothing, for exact and for redundant arms.
    #[inline]
    pub fn approximate(&self, target: &Frame, found: &mut ArmConfigurations) -> bool {
        match &self.method {
            Method::Six(method) if method.structure().is_nearly() => {
                method.likely(target, &self.drives, found);
                true
            }
            _ => false,
        }
    }

    /// Returns the configurations of a redundant arm that bring the tip of the chain to `target`; `None` for other arms.
    #[inline]
    pub fn family(&self, target: &Frame) -> Option<PoseFamily<'_>> {
        match &self.method {
            Method::Seven(method) => Some(PoseFamily::new(method, target)),
            _ => None,
        }
    }
}

fn scale_of(motion: &Transmission) -> f64 {
    motion.turn_scale + motion.slide_scale
}

pub(super) fn drives_of(chain: &Chain) -> Drives {
    let driven = chain.motions[..chain.moving].iter().filter(|motion| scale_of(motion) != 0.0);
    Drives::new(driven.map(|motion| (motion.joint, scale_of(motion))))
}

/// Returns the axes of a chain at q = 0. Stages that no joint moves become part of the fixed transforms.
pub(super) fn axes_of<const N: usize>(chain: &Chain) -> AxisChain<N> {
    let mut at = Frame::IDENTITY;
    let mut joints = [JointAxis::sliding([0.0, 0.0, 1.0]); N];
    let mut axis = 0;
    for (frame, motion) in chain.moving_frames().zip(&chain.motions) {
        at = at.then::<Baseline>(&frame);
        if scale_of(motion) != 0.0 {
            let turns = motion.turn_scale != 0.0;
            joints[axis] =
                if turns { JointAxis::turning(at.axes[2], at.origin) } else { JointAxis::sliding(at.axes[2]) };
            axis += 1;
        }
        let (sine, cosine) = motion.turn_offset.sin_cos();
        let slide = motion.slide_offset;
        let moved = Frame { origin: add_scaled(&at.origin, &at.axes[2], slide), ..at };
        at = moved.turned::<Baseline>(sine, cosine);
    }
    AxisChain { joints, tip: at.then::<Baseline>(&chain.tip) }
}
