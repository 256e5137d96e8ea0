//! The closed form of a robot's chain: its axes, and joint values from the angles of the axes.

use super::axis_chain::{AxisChain, JointAxis};
use super::branches::Branches;
use super::six::{ClosedForm, Structure};
use crate::kinematics::chain::{Chain, StageMotion};
use crate::math::Frame;
use crate::math::arithmetic::Baseline;

/// Why a chain has no closed form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NoClosedForm {
    /// It has this number of joints, not six.
    Joints(usize),
    /// This joint drives several axes, or none.
    Drives {
        /// The joint.
        joint: usize,
        /// How many axes it drives.
        axes: usize,
    },
    /// Its axes leave fewer than six directions to the tip.
    Rank(usize),
    /// Joints slide, and no method fits.
    Sliding,
}

/// The closed form of a chain of six joints.
#[derive(Debug, Clone)]
pub(crate) struct ClosedFormArm {
    form: ClosedForm,
    /// Which joint drives each axis, and its factor on q.
    drives: [(usize, f64); 6],
}

/// Configurations of an arm for one pose, each at one of its whole turns.
#[derive(Debug, Clone)]
pub(crate) struct ArmBranches {
    /// The configurations (rad, m).
    pub qs: Vec<[f64; 6]>,
    /// No configuration is missing.
    pub complete: bool,
    /// One configuration at least stands for a family, in which a joint is free.
    pub singular: bool,
    /// Evaluations of the forward kinematics.
    pub evaluations: usize,
}

impl ClosedFormArm {
    /// Decides the method for a chain of `joints` joints whose tip moves in `rank` directions.
    pub fn new(chain: &Chain, joints: usize, rank: usize) -> Result<Self, NoClosedForm> {
        if joints != 6 {
            return Err(NoClosedForm::Joints(joints));
        }
        let motions = &chain.motions[..chain.moving];
        for joint in 0..6 {
            let axes = motions.iter().filter(|motion| motion.joint == joint && scale_of(motion) != 0.0).count();
            if axes != 1 {
                return Err(NoClosedForm::Drives { joint, axes });
            }
        }
        if rank < 6 {
            return Err(NoClosedForm::Rank(rank));
        }
        let (axes, drives) = axes_of(chain);
        let form = ClosedForm::new(&axes);
        match form.structure() {
            Structure::Unsolved => Err(NoClosedForm::Sliding),
            _ => Ok(Self { form, drives }),
        }
    }

    /// The structure in words, and how many solutions it allows.
    pub fn structure(&self) -> String {
        self.form.structure().to_string()
    }

    /// All configurations that bring the tip of the chain to `target`.
    pub fn solve(&self, target: &Frame) -> ArmBranches {
        let branches: Branches<6> = self.form.solve(target);
        let qs = branches.iter().map(|values| {
            let mut q = [0.0; 6];
            for (value, (joint, scale)) in values.iter().zip(&self.drives) {
                q[*joint] = value / scale;
            }
            q
        });
        ArmBranches {
            qs: qs.collect(),
            complete: branches.complete,
            singular: branches.singular,
            evaluations: branches.evaluations,
        }
    }
}

fn scale_of(motion: &StageMotion) -> f64 {
    motion.turn_scale + motion.slide_scale
}

/// The axes of a chain at q = 0 and what drives them. Stages that no joint moves are part of the chain between.
fn axes_of(chain: &Chain) -> (AxisChain<6>, [(usize, f64); 6]) {
    let mut at = Frame::IDENTITY;
    let mut joints = [JointAxis::sliding([0.0, 0.0, 1.0]); 6];
    let mut drives = [(0, 1.0); 6];
    let mut axis = 0;
    for (frame, motion) in chain.moving_frames().zip(&chain.motions) {
        at = at.then::<Baseline>(&frame);
        if scale_of(motion) != 0.0 {
            let turns = motion.turn_scale != 0.0;
            joints[axis] =
                if turns { JointAxis::turning(at.axes[2], at.origin) } else { JointAxis::sliding(at.axes[2]) };
            drives[axis] = (motion.joint, scale_of(motion));
            axis += 1;
        }
        let (sine, cosine) = motion.turn_offset.sin_cos();
        let slide = motion.slide_offset;
        let moved = Frame { origin: std::array::from_fn(|k| at.origin[k] + slide * at.axes[2][k]), ..at };
        at = moved.turned::<Baseline>(sine, cosine);
    }
    (AxisChain { joints, tip: at.then::<Baseline>(&chain.tip) }, drives)
}
