//! The closed form of a robot's chain: its axes, and joint values from the values of the axes.

use smallvec::SmallVec;

use super::axis_chain::{AxisChain, JointAxis};
use super::branches::{BranchError, Branches, MOST};
use super::five_joints::FiveJoints;
use super::parameter_arcs::ParameterArcs;
use super::planar::Planar;
use super::redundant::{Parameter, Redundant};
use super::six::{ClosedForm, Structure};
use crate::kinematics::chain::{Chain, StageMotion};
use crate::math::Frame;
use crate::math::arithmetic::Baseline;

/// Most joints that a closed form has.
pub(crate) const MOST_JOINTS: usize = 7;

/// Why a chain has no closed form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NoClosedForm {
    /// Closed forms are not for this number of joints.
    Joints(usize),
    /// This joint drives several axes, or none.
    Drives {
        /// The joint.
        joint: usize,
        /// How many axes it drives.
        axes: usize,
    },
    /// The tip moves in this number of directions, fewer than six and than there are joints.
    Rank(usize),
    /// No method fits these joints.
    Joined,
    /// Joints slide, and no method fits.
    Sliding,
}

/// The closed form of a chain of three to seven joints.
#[derive(Debug, Clone)]
pub(crate) struct ClosedFormArm {
    method: Method,
    drives: Drives,
}

/// Which joint drives each axis, and its factor on q.
type Drives = SmallVec<[(usize, f64); MOST_JOINTS]>;

#[derive(Debug, Clone)]
enum Method {
    Planar(Box<Planar<3>>),
    Scara(Box<Planar<4>>),
    Five(Box<FiveJoints>),
    Six(Box<ClosedForm>),
    Seven(Box<Redundant>),
}

/// Configurations of an arm for one pose, each at one of its whole turns.
#[derive(Debug, Clone)]
pub(crate) struct ArmBranches {
    sets: [[f64; MOST_JOINTS]; MOST],
    errors: [BranchError; MOST],
    count: usize,
    joints: usize,
    /// A configuration that was no solution was near one: the pose may be reached within wide tolerances.
    pub nearly: bool,
    /// No configuration is missing; for a redundant arm, none at this value of the parameter.
    pub complete: bool,
    /// One configuration at least stands for a family, in which a joint is free.
    pub singular: bool,
    /// Evaluations of the forward kinematics.
    pub evaluations: usize,
}

/// All configurations of a redundant arm for one pose, as a function of one parameter.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PoseFamily<'a> {
    redundant: &'a Redundant,
    drives: &'a Drives,
    displacement: Frame,
}

impl ClosedFormArm {
    /// Decides the method for a chain of `joints` joints whose tip moves in `rank` directions.
    pub fn new(chain: &Chain, joints: usize, rank: usize) -> Result<Self, NoClosedForm> {
        if !(3..=MOST_JOINTS).contains(&joints) {
            return Err(NoClosedForm::Joints(joints));
        }
        let motions = &chain.motions[..chain.moving];
        for joint in 0..joints {
            let axes = motions.iter().filter(|motion| motion.joint == joint && scale_of(motion) != 0.0).count();
            if axes != 1 {
                return Err(NoClosedForm::Drives { joint, axes });
            }
        }
        if rank < joints.min(6) {
            return Err(NoClosedForm::Rank(rank));
        }
        let slides = motions.iter().any(|motion| motion.slide_scale != 0.0);
        let unsolved = if slides { NoClosedForm::Sliding } else { NoClosedForm::Joined };
        let drives = drives_of(chain);
        let method = method_of(chain, joints).ok_or(unsolved)?;
        Ok(Self { method, drives })
    }

    /// The structure in words, and how many solutions it allows. `joint_name` names a joint by its number.
    pub fn structure(&self, joint_name: impl Fn(usize) -> String) -> String {
        match &self.method {
            Method::Planar(_) => "planar; at most 2 solutions".into(),
            Method::Scara(_) => "SCARA; at most 2 solutions".into(),
            Method::Five(method) => format!("five joints, solved as six: {}", method.structure()),
            Method::Six(method) => method.structure().to_string(),
            Method::Seven(method) => match (method.parameter(), method.structure()) {
                (Parameter::Axis(axis), Some(structure)) => {
                    format!("{structure} for each value of joint '{}'", joint_name(self.drives[axis].0))
                }
                _ => "spherical shoulder and wrist; at most 8 solutions for each arm angle".into(),
            },
        }
    }

    /// Whether it takes no longer than a search: all but the general method for six joints.
    pub fn is_at_once(&self) -> bool {
        let general = match &self.method {
            Method::Planar(_) | Method::Scara(_) => false,
            Method::Five(method) => method.structure() == Structure::General,
            Method::Six(method) => method.structure() == Structure::General,
            Method::Seven(method) => method.structure() == Some(Structure::General),
        };
        !general
    }

    /// Whether an arm has more joints than a pose needs.
    pub fn is_redundant(&self) -> bool {
        matches!(self.method, Method::Seven(_))
    }

    /// All configurations that bring the tip of the chain to `target`; None for redundant arms.
    pub fn solve(&self, target: &Frame) -> Option<ArmBranches> {
        Some(match &self.method {
            Method::Planar(method) => ArmBranches::of(&method.solve(target), &self.drives),
            Method::Scara(method) => ArmBranches::of(&method.solve(target), &self.drives),
            Method::Five(method) => ArmBranches::of(&method.solve(target), &self.drives),
            Method::Six(method) => {
                let mut branches = ArmBranches::of(&method.solve(target), &self.drives);
                // Only zeros of a polynomial near the real axis would tell.
                branches.nearly |= method.structure() == Structure::General;
                branches
            }
            Method::Seven(_) => return None,
        })
    }

    /// The configurations of a redundant arm that bring the tip of the chain to `target`; None for other arms.
    pub fn family(&self, target: Frame) -> Option<PoseFamily<'_>> {
        match &self.method {
            Method::Seven(redundant) => {
                Some(PoseFamily { redundant, drives: &self.drives, displacement: redundant.displacement(&target) })
            }
            _ => None,
        }
    }
}

impl PoseFamily<'_> {
    /// The values of the parameter (rad, m) outside which no configuration is within the limits `lower` and `upper` (n,). What they
    /// leave is to be searched: not every value has a configuration within them.
    pub fn arcs(&self, lower: &[f64], upper: &[f64]) -> ParameterArcs {
        let limits = std::array::from_fn(|axis| {
            let (joint, scale) = self.drives[axis];
            let ends = [scale * lower[joint], scale * upper[joint]];
            [ends[0].min(ends[1]), ends[0].max(ends[1])]
        });
        self.redundant.arcs(&self.displacement, &limits)
    }

    /// Whether the parameter is the arm angle: then every branch exists at every value.
    pub fn is_by_arm_angle(&self) -> bool {
        self.redundant.parameter() == Parameter::ArmAngle
    }

    /// All configurations with the parameter at `value`.
    pub fn branches_at(&self, value: f64) -> ArmBranches {
        ArmBranches::of(&self.redundant.solve(&self.displacement, value), self.drives)
    }
}

impl ArmBranches {
    fn of<const N: usize>(branches: &Branches<N>, drives: &Drives) -> Self {
        let mut sets = [[0.0; MOST_JOINTS]; MOST];
        for (set, values) in sets.iter_mut().zip(branches.iter()) {
            for (value, (joint, scale)) in values.iter().zip(drives) {
                set[*joint] = value / scale;
            }
        }
        let mut errors = [BranchError::default(); MOST];
        errors[..branches.len()].copy_from_slice(branches.errors());
        let Branches { nearly, complete, singular, evaluations, .. } = *branches;
        Self { sets, errors, count: branches.len(), joints: N, nearly, complete, singular, evaluations }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.count
    }

    /// The configurations (n,) (rad, m), and by how much they miss the pose.
    pub fn iter(&self) -> impl Iterator<Item = (&[f64], BranchError)> {
        self.sets[..self.count].iter().zip(self.errors).map(|(set, error)| (&set[..self.joints], error))
    }
}

fn scale_of(motion: &StageMotion) -> f64 {
    motion.turn_scale + motion.slide_scale
}

fn drives_of(chain: &Chain) -> Drives {
    let driven = chain.motions[..chain.moving].iter().filter(|motion| scale_of(motion) != 0.0);
    driven.map(|motion| (motion.joint, scale_of(motion))).collect()
}

fn method_of(chain: &Chain, joints: usize) -> Option<Method> {
    Some(match joints {
        3 => Method::Planar(Box::new(Planar::new(&axes_of(chain))?)),
        4 => Method::Scara(Box::new(Planar::new(&axes_of(chain))?)),
        5 => Method::Five(Box::new(FiveJoints::new(&axes_of(chain))?)),
        6 => {
            let form = ClosedForm::new(&axes_of(chain));
            (form.structure() != Structure::Unsolved).then(|| Method::Six(Box::new(form)))?
        }
        _ => Method::Seven(Box::new(Redundant::new(&axes_of(chain))?)),
    })
}

/// The axes of a chain at q = 0. Stages that no joint moves are part of the chain between.
fn axes_of<const N: usize>(chain: &Chain) -> AxisChain<N> {
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
        let moved = Frame { origin: std::array::from_fn(|k| at.origin[k] + slide * at.axes[2][k]), ..at };
        at = moved.turned::<Baseline>(sine, cosine);
    }
    AxisChain { joints, tip: at.then::<Baseline>(&chain.tip) }
}
