//! The robot: immutable, validated once, shared between threads without locks.

use std::sync::{Arc, OnceLock};

use nalgebra::Matrix6xX;

use super::bodies::CollisionModel;
use super::builder::{ChainBuilder, Element};
use super::joint::Joint;
use crate::kinematics::chain::Chain;
use crate::kinematics::{Columns, Directions, FourColumns, Wrench};
use crate::starts::index::SeedIndex;

use crate::error::{Error, Result, require_finite};
use crate::math::four_frames::FourFrames;
use crate::math::quad::Quad;
use crate::math::{Frame, MAX_DOF, Pose, pose};
use crate::rng::LazyRng;

/// A robot arm: a serial chain from base to tip.
///
/// Joint vectors hold the independent joints in chain order (rad, m); mimic joints follow theirs. Poses are seen from
/// the robot's base.
#[derive(Debug, Clone)]
pub struct Robot {
    description: ChainBuilder,
    base: Pose,
    tool: Pose,
    chain: Arc<Chain>,
    collision: CollisionModel,
    /// Built when first asked for; copies that differ in base and tool share it.
    seed_index: Arc<OnceLock<SeedIndex>>,
    /// Found when first asked for.
    directions: OnceLock<Directions>,
}

impl PartialEq for Robot {
    /// The chain follows from the rest.
    fn eq(&self, other: &Self) -> bool {
        (&self.description, &self.base, &self.tool, &self.collision)
            == (&other.description, &other.base, &other.tool, &other.collision)
    }
}

impl Robot {
    pub(crate) fn new(description: ChainBuilder) -> Result<Self> {
        Self::assembled(description, Pose::identity(), Pose::identity(), CollisionModel::default())
    }

    pub(crate) fn assembled(
        description: ChainBuilder,
        base: Pose,
        tool: Pose,
        collision: CollisionModel,
    ) -> Result<Self> {
        description.validate()?;
        let chain = Arc::new(Chain::new(&description.elements, &base, &tool));
        let (seed_index, directions) = (Arc::default(), OnceLock::new());
        Ok(Self { description, base, tool, chain, collision, seed_index, directions })
    }

    /// The robot's name.
    pub fn name(&self) -> &str {
        &self.description.name
    }

    /// Degrees of freedom: the number of independent joints.
    pub fn dof(&self) -> usize {
        self.description.joints.len()
    }

    /// The independent joints, in the order of q.
    pub fn joints(&self) -> &[Joint] {
        &self.description.joints
    }

    /// Names of the links from base to tip.
    pub fn link_names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.chain.links.iter().map(|link| link.name.as_str())
    }

    /// What the chain is made of between its first link and its last, without base and tool.
    pub fn elements(&self) -> &[Element] {
        &self.description.elements
    }

    /// Pose of the chain's first link, seen from the robot's base.
    pub fn base(&self) -> &Pose {
        &self.base
    }

    /// Pose of the tool, seen from the tip link.
    pub fn tool(&self) -> &Pose {
        &self.tool
    }

    /// The same robot, standing at `base`.
    ///
    /// # Errors
    /// [`Error::NotFinite`] for NaN or infinity in the pose.
    pub fn with_base(&self, base: Pose) -> Result<Self> {
        let base = pose::checked("base", base)?;
        let robot = Self::assembled(self.description.clone(), base, self.tool, self.collision.clone())?;
        Ok(Self { seed_index: self.seed_index.clone(), ..robot })
    }

    /// The same robot, its tip moved by `tool` from the tip link.
    ///
    /// # Errors
    /// [`Error::NotFinite`] for NaN or infinity in the pose.
    pub fn with_tool(&self, tool: Pose) -> Result<Self> {
        let tool = pose::checked("tool", tool)?;
        let robot = Self::assembled(self.description.clone(), self.base, tool, self.collision.clone())?;
        Ok(Self { seed_index: self.seed_index.clone(), ..robot })
    }

    /// The same robot with other joint limits; `change` gets each joint with its index.
    ///
    /// # Errors
    /// [`Error::EmptyRange`] or [`Error::NegativeLimit`] for impossible limits.
    pub fn with_limits(&self, mut change: impl FnMut(usize, &mut Joint)) -> Result<Self> {
        let mut description = self.description.clone();
        for (index, joint) in description.joints.iter_mut().enumerate() {
            change(index, joint);
        }
        Self::assembled(description, self.base, self.tool, self.collision.clone())
    }

    /// Whether a whole turn of joint `joint` brings all that it moves back to where it was.
    pub fn repeats_every_turn(&self, joint: usize) -> bool {
        let driven = self.chain.motions.iter().filter(|motion| motion.joint == joint);
        let scales = driven.map(|motion| (motion.turn_scale, motion.slide_scale));
        self.joints()[joint].kind.turns() && scales.into_iter().all(|(turn, slide)| turn.fract() == 0.0 && slide == 0.0)
    }

    /// Err unless `q` has one finite entry per joint; `what` names it in the message.
    pub fn check(&self, what: &str, q: &[f64]) -> Result<()> {
        if q.len() != self.dof() {
            let expected = format!("{} joints", self.dof());
            let what = format!("{what} of robot '{}'", self.name());
            return Err(Error::WrongLength { what, expected, got: q.len() });
        }
        require_finite(what, q, |i| format!("joint '{}'", self.joints()[i].name))
    }

    /// Err unless `q` (n,) lies in the box from `lower` to `upper` (n,); `what` names it in the message.
    ///
    /// # Errors
    /// [`Error::OutsideLimits`] names the joint, its value and its limits.
    pub fn require_within(&self, what: &str, q: &[f64], lower: &[f64], upper: &[f64]) -> Result<()> {
        match (0..q.len()).find(|j| !(lower[*j] <= q[*j] && q[*j] <= upper[*j])) {
            None => Ok(()),
            Some(j) => Err(Error::OutsideLimits {
                what: what.into(),
                joint: self.joints()[j].name.clone(),
                value: q[j],
                lower: lower[j],
                upper: upper[j],
            }),
        }
    }

    /// Pose of the tip at `q` (n,) (rad, m).
    ///
    /// # Errors
    /// [`Error::WrongLength`] or [`Error::NotFinite`].
    pub fn fk(&self, q: &[f64]) -> Result<Pose> {
        self.check("joint angles", q)?;
        Ok(self.tip(q).into())
    }

    /// Geometric Jacobian at the tip, 6 x n: linear rows (m per rad or m), then angular, in the base's axes.
    ///
    /// # Errors
    /// [`Error::WrongLength`] or [`Error::NotFinite`].
    pub fn jacobian(&self, q: &[f64]) -> Result<Matrix6xX<f64>> {
        self.check("joint angles", q)?;
        let mut columns = [[0.0; 6]; MAX_DOF];
        self.tip_and_jacobian(q, &mut columns);
        Ok(Matrix6xX::from_iterator(q.len(), columns[..q.len()].iter().flatten().copied()))
    }

    /// Pose of every link at `q` (n,), base first, in the order of [`link_names`](Self::link_names).
    ///
    /// # Errors
    /// [`Error::WrongLength`] or [`Error::NotFinite`].
    pub fn link_poses(&self, q: &[f64]) -> Result<Vec<Pose>> {
        self.check("joint angles", q)?;
        Ok(self.chain.link_frames(q).into_iter().map(Pose::from).collect())
    }

    /// [`fk`](Self::fk) without the check: `q` has one finite entry per joint.
    #[inline]
    pub fn tip(&self, q: &[f64]) -> Frame {
        self.chain.tip(q)
    }

    /// Position of the tip (m) at `q`, which has one finite entry per joint.
    #[inline]
    pub fn tip_position(&self, q: &[f64]) -> [f64; 3] {
        self.chain.tip_position(q)
    }

    /// Hands the tip's positions (m) at configurations stored one after another to `visit`, in order; quicker than
    /// [`tip_position`](Self::tip_position) one by one, and the same bits (for joint angles below 8e5 rad).
    #[inline]
    pub fn tip_positions(&self, qs: &[f64], visit: impl FnMut([f64; 3])) {
        self.chain.tip_positions(qs, self.dof(), visit);
    }

    /// Tip and Jacobian in one pass, without the check: `q` has one finite entry per joint.
    #[inline]
    pub fn tip_and_jacobian(&self, q: &[f64], columns: &mut Columns) -> Frame {
        self.chain.jacobian(q, columns)
    }

    /// [`tip_and_jacobian`](Self::tip_and_jacobian) of four configurations side by side, to the same bits; `qs` and `columns` have one
    /// entry per joint.
    #[inline]
    pub fn tips_and_jacobians(&self, qs: &[Quad], columns: &mut FourColumns) -> FourFrames {
        self.chain.jacobian_four(qs, columns)
    }

    /// Tip and joint torques (N m, N for sliding joints) J'w in one pass, without a Jacobian; w is the `wrench` on the tip. `q`
    /// and `torques` have one entry per joint.
    #[inline]
    pub fn tip_and_torques(&self, q: &[f64], wrench: &dyn Fn(&Frame) -> Wrench, torques: &mut [f64]) -> Frame {
        self.chain.torques(q, wrench, torques)
    }

    /// `count` configurations drawn uniformly between the limits, one after another (count * n entries).
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for more than memory holds.
    pub fn random_configurations(&self, count: usize, rng: &mut LazyRng) -> Result<Vec<f64>> {
        let ranges: Vec<_> = self.joints().iter().map(Joint::sampling_range).collect();
        let mut qs = Vec::new();
        if qs.try_reserve_exact(count.saturating_mul(self.dof())).is_err() {
            return Err(Error::out_of_range("number of configurations", "small enough for memory", count as f64));
        }
        for _ in 0..count {
            qs.extend(ranges.iter().map(|(lower, upper)| rng.uniform_in(*lower, *upper)));
        }
        Ok(qs)
    }

    /// The same robot, taking up other room.
    pub(crate) fn with_collision(&self, collision: CollisionModel) -> Self {
        Self { collision, ..self.clone() }
    }

    pub(crate) fn collision(&self) -> &CollisionModel {
        &self.collision
    }

    pub(crate) fn description(&self) -> &ChainBuilder {
        &self.description
    }

    pub(crate) fn chain(&self) -> &Chain {
        &self.chain
    }

    /// In how many directions the tip can move at all.
    pub fn directions(&self) -> Directions {
        *self.directions.get_or_init(|| Directions::of(self))
    }

    pub(crate) fn seed_index(&self) -> &SeedIndex {
        self.seed_index.get_or_init(|| {
            let elements = &self.description.elements;
            let moving = elements.iter().filter(|element| matches!(element, Element::Moving { .. })).count();
            let chain = Chain::new(elements, &Pose::identity(), &Pose::identity());
            SeedIndex::new(&chain, moving, self.joints())
        })
    }
}
