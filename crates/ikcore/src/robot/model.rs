//! The robot: immutable, validated once, shared between threads without locks.

use std::f64::consts::TAU;
use std::sync::{Arc, OnceLock};

use smallvec::SmallVec;

use super::body::Bodies;
use super::description::{Description, Element};
use super::joint::Joint;
use super::masses::Masses;
use super::off_chain::OffChain;
use super::pair_rule::PairRule;
use super::parts::Parts;
use super::stance::Stance;
use super::tip_chain::TipChains;
use super::visual::Visual;
use crate::bodies::BodyModel;
use crate::closed_form::{
    ArmBranches, ArmConfigurations, ClosedFormArm, NoClosedForm, PoseFamily, PositionArm, SEEDS, Seed,
};
use crate::dynamics::Dynamics;
use crate::error::{Error, Result, require_finite};
use crate::interrupt::checkpoint_at;
use crate::kinematics::chain::{Chain, Transmission};
use crate::kinematics::kernels::Kernels;
use crate::kinematics::link_tree::LinkTree;
use crate::kinematics::{Reach, TaskRank};
use crate::math::arithmetic::Baseline;
use crate::math::{Frame, Pose, pose};
use crate::rng::LazyRng;
use crate::starts::Starts;
use crate::starts::index::StartIndex;
use crate::wording::joined;

/// A robot: a serial chain from base to tip, or several to several [`tips`](Self::tips), and the links that branch off.
///
/// Joint vectors hold the independent joints in chain order (rad, m), those of several chains one chain after another, shared ones
/// once; mimic joints follow theirs, and joints beside the chains are held. Poses are in the frame of the robot's base.
#[derive(Debug, Clone)]
pub struct Robot {
    parts: Parts,
    /// The chain, folded from description, base and tool.
    chain: Arc<Chain>,
    /// The chains of a robot with several tips.
    tips: Arc<TipChains>,
    /// Tree of all links, folded at first use.
    tree: OnceLock<Arc<LinkTree>>,
    /// The kernels compiled for the chain's size and this machine.
    kernels: Kernels,
    /// The reach of the stretched links, without prismatic motion.
    reach_of_links: Reach,
    /// Pairs of links tested against each other, found at first use; copies that differ in base and tool share it.
    pairs: Arc<OnceLock<Vec<[usize; 2]>>>,
    /// The collision model, made at first use.
    body_model: Arc<OnceLock<Arc<BodyModel>>>,
    /// The smallest change of each joint that leaves the pose of every link unchanged.
    turn_periods: Vec<Option<f64>>,
    /// Built at first use; copies that differ in base and tool share it.
    start_index: Arc<OnceLock<StartIndex>>,
    /// Arms of the tips of a robot with several, made at first use; copies that differ in base share it.
    arms: Arc<OnceLock<Vec<Option<TipArm>>>>,
    /// Computed at first use.
    task_rank: OnceLock<TaskRank>,
    /// Closed form of the arm, found at first use; copies that differ in base and tool share it.
    closed_form: Arc<OnceLock<std::result::Result<ClosedFormArm, NoClosedForm>>>,
    /// Closed form for positions, found at first use; copies that differ in base and tool share it.
    position_arm: Arc<OnceLock<Option<PositionArm>>>,
    /// Bodies with their masses, or the reason why there are none; found at first use.
    dynamics: OnceLock<Arc<Result<Dynamics>>>,
}

/// The elements that move one of several tips alone, from the end of those that it shares with others.
#[derive(Debug)]
pub(crate) struct TipArm {
    pub robot: Robot,
    /// Its joints, as entries of q of the whole robot.
    pub joints: Vec<usize>,
}

impl PartialEq for Robot {
    /// Compares the fields that determine all others.
    fn eq(&self, other: &Self) -> bool {
        self.parts == other.parts
    }
}

impl Robot {
    pub(super) fn new(description: Description) -> Result<Self> {
        Self::assembled(Parts::of(description))
    }

    pub(super) fn assembled(parts: Parts) -> Result<Self> {
        parts.validate()?;
        TipChains::validate(&parts)?;
        let chain = parts.description.folded(&parts.base, &parts.tool);
        let tips = TipChains::of(&parts);
        Ok(Self {
            turn_periods: turn_periods(driving_motions(&chain, &tips), &parts.description.joints),
            tips: Arc::new(tips),
            parts,
            kernels: Kernels::for_chain(&chain),
            reach_of_links: Reach::of_links(&chain),
            chain: Arc::new(chain),
            tree: OnceLock::new(),
            pairs: Arc::default(),
            body_model: Arc::default(),
            start_index: Arc::default(),
            arms: Arc::default(),
            task_rank: OnceLock::new(),
            closed_form: Arc::default(),
            position_arm: Arc::default(),
            dynamics: OnceLock::new(),
        })
    }

    /// The robot's name.
    pub fn name(&self) -> &str {
        &self.parts.description.name
    }

    /// Degrees of freedom: the number of independent joints.
    pub fn dof(&self) -> usize {
        self.parts.description.joints.len()
    }

    /// The independent joints, in the order of q.
    pub fn joints(&self) -> &[Joint] {
        &self.parts.description.joints
    }

    /// Names of the links from base to tip.
    pub fn link_names(&self) -> impl Iterator<Item = &str> {
        self.parts.description.link_names()
    }

    /// Elements of the chain from its first link to its last, without base and tool.
    pub fn elements(&self) -> &[Element] {
        &self.parts.description.elements
    }

    /// Pose of the first link of the chain in the frame of the robot's base.
    pub fn base(&self) -> &Pose {
        &self.parts.base
    }

    /// Pose of the tool in the frame of the tip link.
    pub fn tool(&self) -> &Pose {
        &self.parts.tool
    }

    /// Copy of the robot with its base at `base`.
    ///
    /// # Errors
    /// [`Error::NotFinite`] for NaN or infinity in the pose.
    pub fn with_base(&self, base: Pose) -> Result<Self> {
        let base = pose::checked("base", base)?;
        let robot = Self::assembled(Parts { base, ..self.parts.clone() })?;
        Ok(Self { pairs: self.pairs.clone(), ..self.lend_to(robot) })
    }

    /// Copy of the robot with its tip at `tool`, relative to the tip link.
    ///
    /// # Errors
    /// [`Error::NotFinite`] for NaN or infinity in the pose; [`Error::SeveralTips`].
    pub fn with_tool(&self, tool: Pose) -> Result<Self> {
        let tool = pose::checked("tool", tool)?;
        self.require_one_tip("with_tool")?;
        let robot = Self::assembled(Parts { tool, ..self.parts.clone() })?;
        Ok(Self { pairs: self.pairs.clone(), ..self.lend_to(robot) })
    }

    /// Copy of the robot with other joint limits; `change` gets each joint with its index.
    ///
    /// # Errors
    /// [`Error::EmptyRange`] or [`Error::NegativeLimit`] for impossible limits.
    pub fn with_limits(&self, mut change: impl FnMut(usize, &mut Joint)) -> Result<Self> {
        let mut parts = self.parts.clone();
        for (index, joint) in parts.description.joints.iter_mut().enumerate() {
            change(index, joint);
        }
        Self::assembled(parts)
    }

    /// Whether a full turn of joint `joint` leaves the pose of every link unchanged.
    pub(crate) fn repeats_every_turn(&self, joint: usize) -> bool {
        repeats_every_turn(driving_motions(&self.chain, &self.tips), &self.joints()[joint], joint)
    }

    /// The smallest change of joint `joint` that leaves the pose of every link unchanged; None where there is none.
    pub(crate) fn turn_period(&self, joint: usize) -> Option<f64> {
        self.turn_periods[joint]
    }

    /// Checks that `q` has one finite entry per joint; `what` names it in the error.
    pub fn check(&self, what: &str, q: &[f64]) -> Result<()> {
        if q.len() != self.dof() {
            let expected = format!("{} joints{}", self.dof(), self.joints_among(q.len()));
            let what = format!("{what} of robot '{}'", self.name());
            return Err(Error::WrongLength { what: what.into(), expected, got: q.len() });
        }
        require_finite(what, q, |i| format!("joint '{}'", self.joints()[i].name))
    }

    /// Names the joints that are expected where `count` is too many: those of a gripper are often among them.
    fn joints_among(&self, count: usize) -> String {
        let held = self.held_joints();
        match (self.joints(), count) {
            (joints, count) if count == joints.len() + held.len() => {
                format!(" (without {}, held in place)", joined(held.iter().map(|held| held.joint.name.as_str())))
            }
            ([first, .., last], count) if count > self.dof() => format!(" ({} to {})", first.name, last.name),
            _ => String::new(),
        }
    }

    /// `count` configurations drawn uniformly between the limits, stored consecutively (count * n entries).
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if they would not fit into memory.
    pub fn random_configurations(&self, count: usize, rng: &mut LazyRng) -> Result<Vec<f64>> {
        let ranges = self.sampling_ranges();
        let mut qs = Vec::new();
        if qs.try_reserve_exact(count.saturating_mul(self.dof())).is_err() {
            return Err(Error::out_of_range("number of configurations", "small enough for memory", count as f64));
        }
        for row in 0..count {
            checkpoint_at(row)?;
            qs.extend(ranges.iter().map(|(lower, upper)| rng.uniform_in(*lower, *upper)));
        }
        Ok(qs)
    }

    /// Rank of the tip Jacobian by task, at non-singular configurations.
    pub fn task_rank(&self) -> TaskRank {
        *self.task_rank.get_or_init(|| TaskRank::of(&self.chain, &self.kernels, &self.sampling_ranges()))
    }

    /// Starts for a solve to `pose`. The first call on a robot builds its index; copies with another base or tool share
    /// it.
    pub fn starts_near_pose(&self, pose: &Frame) -> Starts<'_> {
        self.start_index().near_pose(&self.chain, pose)
    }

    /// Starts for a solve to `position` (m), at any orientation.
    pub fn starts_near_position(&self, position: &[f64; 3]) -> Starts<'_> {
        self.start_index().near_position(&self.chain, position)
    }

    /// The structure that the closed form of the inverse kinematics rests on and how many solutions it allows, or "none: " and
    /// the reason. Decided at the first call.
    pub fn closed_form(&self) -> String {
        let name = |joint: usize| self.joints()[joint].name.clone();
        match self.closed_form_or_reason() {
            Ok(form) => form.structure(name),
            Err(_) if self.tip_count() > 1 => "none: several tips; each arm uses its own".into(),
            Err(NoClosedForm::Joints(count)) => format!("none: {count} joints; closed forms are for 3 to 7"),
            Err(NoClosedForm::Drives { joint, axes }) => format!("none: joint '{}' drives {axes} axes", name(*joint)),
            Err(NoClosedForm::Rank(rank)) => format!("none: the tip moves in {rank} of 6 directions"),
            Err(NoClosedForm::Floating) => "none: the base floats".into(),
            Err(NoClosedForm::Curved) => "none: a joint follows another one by a polynomial".into(),
            Err(NoClosedForm::Joined) => "none: arms of 3 and 4 joints have one if they are planar or SCARAs".into(),
            Err(NoClosedForm::Sliding) => "none: no method fits these sliding joints".into(),
        }
    }

    /// All configurations that bring the tip to `pose`, limits aside; None without a closed form and for redundant arms.
    pub(crate) fn branches(&self, pose: &Frame) -> Option<ArmBranches> {
        self.closed_form_or_reason().as_ref().ok()?.solve(&self.at_flange(pose))
    }

    /// Whether the closed form can prove that a pose has no other solutions.
    pub(crate) fn proves_branches(&self) -> bool {
        self.closed_form_or_reason().as_ref().is_ok_and(ClosedFormArm::proves)
    }

    /// Finds likely branches, which forward kinematics has to confirm, at less cost where that is possible; none without a closed form
    /// and for redundant arms.
    #[inline]
    pub(crate) fn likely_branches(&self, pose: &Frame, found: &mut ArmConfigurations) {
        match self.closed_form_or_reason() {
            Ok(form) => form.likely(&self.at_flange(pose), found),
            Err(_) => *found = ArmConfigurations::none(),
        }
    }

    /// Finds configurations that bring the tip near `pose` where the structure of the closed form holds only nearly; returns false for
    /// other arms.
    #[inline]
    pub(crate) fn approximate_branches(&self, pose: &Frame, found: &mut ArmConfigurations) -> bool {
        self.closed_form_or_reason().as_ref().is_ok_and(|form| form.approximate(&self.at_flange(pose), found))
    }

    /// All configurations of a redundant arm that bring the tip to `pose`, by one parameter; None without a closed form and for arms
    /// that are not redundant.
    #[inline]
    pub(crate) fn family(&self, pose: &Frame) -> Option<PoseFamily<'_>> {
        let form = self.closed_form_or_reason().as_ref().ok()?;
        if form.is_redundant() { form.family(&self.at_flange(pose)) } else { None }
    }

    /// Whether the closed form takes no longer than a search; None without one.
    pub(crate) fn solves_at_once(&self) -> Option<bool> {
        self.closed_form_or_reason().as_ref().ok().map(ClosedFormArm::is_at_once)
    }

    /// Writes configurations at or near the position of `pose` within these limits, whose orientation is nearly nearest; the best
    /// come first. Returns false without a closed form for positions.
    pub(crate) fn position_seeds(
        &self,
        pose: &Frame,
        limits: [&[f64]; 2],
        found: &mut SmallVec<[Seed; SEEDS]>,
    ) -> bool {
        let arm = self.position_arm.get_or_init(|| {
            let chain = self.parts.description.folded(&Pose::identity(), &Pose::identity());
            if self.tip_count() == 1 { PositionArm::new(&chain, limits) } else { None }
        });
        let Some(arm) = arm else { return false };
        let target = Frame::from(self.base()).inverse().then::<Baseline>(pose);
        arm.seeds(&target, &Frame::from(self.tool()), limits, found);
        true
    }

    /// The pose of the flange, seen from the first link, that brings the tip to `pose`.
    fn at_flange(&self, pose: &Frame) -> Frame {
        let (base, tool) = (Frame::from(self.base()), Frame::from(self.tool()));
        base.inverse().then::<Baseline>(pose).then::<Baseline>(&tool.inverse())
    }

    fn closed_form_or_reason(&self) -> &std::result::Result<ClosedFormArm, NoClosedForm> {
        self.closed_form.get_or_init(|| {
            if self.tip_count() > 1 {
                return Err(NoClosedForm::Joints(self.dof()));
            }
            let chain = self.parts.description.folded(&Pose::identity(), &Pose::identity());
            let (lower, upper): (Vec<_>, Vec<_>) = self.sampling_ranges().into_iter().unzip();
            ClosedFormArm::new(&chain, [&lower, &upper], self.task_rank().pose)
        })
    }

    fn start_index(&self) -> &StartIndex {
        self.start_index.get_or_init(|| {
            let chain = self.parts.description.folded(&Pose::identity(), &Pose::identity());
            StartIndex::new(&chain, &self.kernels, &self.sampling_ranges())
        })
    }

    pub(super) fn sampling_ranges(&self) -> Vec<(f64, f64)> {
        self.joints().iter().map(Joint::sampling_range).collect()
    }

    /// Copy of the robot with other bodies.
    pub(crate) fn with_bodies(&self, bodies: Bodies) -> Self {
        let mut robot = self.clone();
        robot.parts.bodies = bodies;
        robot.pairs = Arc::default();
        robot.body_model = Arc::default();
        robot
    }

    /// Copy of the robot with another rule for the pairs of links that are tested against each other.
    pub(super) fn with_pair_rule(&self, pairs: PairRule) -> Self {
        let mut robot = self.clone();
        robot.parts.pairs = pairs;
        robot.pairs = Arc::default();
        robot.body_model = Arc::default();
        robot
    }

    /// Gives `robot`, which has the same chain, what was found of this one.
    fn lend_to(&self, robot: Self) -> Self {
        let (start_index, closed_form, arms) = (self.start_index.clone(), self.closed_form.clone(), self.arms.clone());
        let position_arm = self.position_arm.clone();
        Self { start_index, closed_form, position_arm, arms, ..robot }
    }

    /// Copy of the robot with these named configurations in place of others.
    pub(crate) fn with_stances(&self, stances: Vec<Stance>) -> Self {
        let mut robot = self.clone();
        robot.parts.stances = stances;
        robot
    }

    /// The visual shapes of a URDF.
    pub fn visuals(&self) -> &[Visual] {
        &self.parts.visuals
    }

    /// Copy of the robot with these visual shapes.
    pub(crate) fn with_visuals(&self, visuals: Vec<Visual>) -> Self {
        let mut robot = self.clone();
        robot.parts.visuals = visuals;
        robot
    }

    /// Copy of the robot with other masses.
    pub(crate) fn with_masses(&self, masses: Masses) -> Self {
        let mut robot = self.clone();
        robot.parts.masses = Arc::new(masses);
        robot.dynamics = OnceLock::new();
        robot
    }

    pub(super) fn found_dynamics(&self) -> &OnceLock<Arc<Result<Dynamics>>> {
        &self.dynamics
    }

    /// Bodies and pairs, prepared for distances; made at the first call, and shared with copies that have the same.
    pub(crate) fn body_model(&self) -> &Arc<BodyModel> {
        self.body_model.get_or_init(|| {
            let rest = self.frames(&vec![0.0; self.dof()]);
            Arc::new(BodyModel::new(self.carried_bodies(), &self.tested_bodies(), self.eight_stages(), rest))
        })
    }

    pub(super) fn found_pairs(&self) -> &OnceLock<Vec<[usize; 2]>> {
        &self.pairs
    }

    /// Copy of the robot with these branches, on which further tips are.
    pub(crate) fn with_branches(&self, off_chain: OffChain, tips: Vec<String>) -> Result<Self> {
        self.with_parts_beside_chain(Parts { off_chain: Arc::new(off_chain), tips, ..self.parts.clone() })
    }

    /// Copy of the robot with other branches.
    pub(crate) fn with_off_chain(&self, off_chain: OffChain) -> Result<Self> {
        self.with_parts_beside_chain(Parts { off_chain: Arc::new(off_chain), ..self.parts.clone() })
    }

    /// The robot of these parts, whose chain is that of this one.
    pub(super) fn with_parts_beside_chain(&self, parts: Parts) -> Result<Self> {
        Self::assembled(parts).map(|robot| self.lend_to(robot))
    }

    pub(super) fn parts(&self) -> &Parts {
        &self.parts
    }

    pub(super) fn tree(&self) -> &LinkTree {
        self.tree.get_or_init(|| Arc::new(self.parts.off_chain.folded(&self.parts.description, &self.chain)))
    }

    pub(super) fn tip_chains(&self) -> &TipChains {
        &self.tips
    }

    pub(super) fn found_arms(&self) -> &OnceLock<Vec<Option<TipArm>>> {
        &self.arms
    }

    pub(super) fn reach_of_links(&self) -> &Reach {
        &self.reach_of_links
    }

    #[inline]
    pub(super) fn chain(&self) -> &Chain {
        &self.chain
    }

    #[inline]
    pub(super) fn kernels(&self) -> &Kernels {
        &self.kernels
    }
}

/// The motions of the elements that move a tip.
fn driving_motions<'a>(chain: &'a Chain, tips: &'a TipChains) -> &'a [Transmission] {
    if tips.chains.is_empty() { &chain.motions[..chain.moving] } else { &tips.motions }
}

fn repeats_every_turn(motions: &[Transmission], joint: &Joint, number: usize) -> bool {
    let mut driven = motions.iter().filter(|motion| motion.joint == number);
    joint.kind.turns()
        && driven.all(|motion| motion.turn_scale.fract() == 0.0 && motion.slide_scale == 0.0 && motion.is_linear())
}

fn turn_periods(motions: &[Transmission], joints: &[Joint]) -> Vec<Option<f64>> {
    let period = |(number, joint): (usize, &Joint)| {
        let mut driven = motions.iter().filter(|motion| motion.joint == number);
        match (driven.next(), driven.next()) {
            (Some(only), None) if only.turn_scale != 0.0 && only.is_linear() => Some(TAU / only.turn_scale.abs()),
            _ => repeats_every_turn(motions, joint, number).then_some(TAU),
        }
    };
    joints.iter().enumerate().map(period).collect()
}
