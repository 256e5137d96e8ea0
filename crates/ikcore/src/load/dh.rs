//! Robots from Denavit-Hartenberg tables, in both conventions.

use nalgebra::Vector3;

use crate::error::{Error, Result, require_finite};
use crate::math::{Pose, pose};
use crate::robot::{ChainBuilder, Drive, Joint, JointKind, Robot};
use crate::wording::words;

/// Convention of a Denavit-Hartenberg table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dh {
    /// Standard convention (Denavit and Hartenberg 1955): frame i at the far end of link i, A_i = Rz(theta) Tz(d) Tx(a)
    /// Rx(alpha).
    Standard,
    /// Modified convention (Craig 1986): frame i on joint i, A_i = Rx(alpha) Tx(a) Rz(theta) Tz(d), with alpha_{i-1} and
    /// a_{i-1} in row i.
    Modified,
}

words!("convention": Dh { Modified => "modified", Standard => "standard" });

/// Denavit-Hartenberg table: every list has one entry per joint.
#[derive(Debug, Clone, PartialEq)]
pub struct DhTable {
    /// Convention of the table.
    pub convention: Dh,
    /// Link lengths (m).
    pub a: Vec<f64>,
    /// Link twists (rad).
    pub alpha: Vec<f64>,
    /// Link offsets (m); added to q of a prismatic joint.
    pub d: Vec<f64>,
    /// Joint angles (rad): added to q of a revolute joint, the fixed angle of a prismatic joint.
    pub theta: Vec<f64>,
    /// Kinds of the joints.
    pub kinds: Vec<JointKind>,
    /// Lower position limits (rad or m).
    pub lower: Vec<f64>,
    /// Upper position limits (rad or m).
    pub upper: Vec<f64>,
    /// Velocity limits (rad/s or m/s).
    pub velocity: Vec<f64>,
    /// Pose of frame 0 in the frame of the robot's base.
    pub base: Pose,
    /// Pose of the tool in the last frame.
    pub tool: Pose,
}

impl DhTable {
    /// Creates a table of revolute joints without limits, angle offsets, base or tool. [`Robot::from_dh`] checks the lengths.
    pub fn new(convention: Dh, a: Vec<f64>, alpha: Vec<f64>, d: Vec<f64>) -> Self {
        let n = a.len();
        Self {
            convention,
            a,
            alpha,
            d,
            theta: vec![0.0; n],
            kinds: vec![JointKind::Revolute; n],
            lower: vec![f64::NEG_INFINITY; n],
            upper: vec![f64::INFINITY; n],
            velocity: vec![f64::INFINITY; n],
            base: Pose::identity(),
            tool: Pose::identity(),
        }
    }

    /// Appends joints `joint_1` to `joint_n` and links `link_1` to `link_n`, each in its DH frame.
    pub(super) fn append_to(&self, chain: &mut ChainBuilder) -> Result<()> {
        self.check(chain.name())?;
        for i in 0..self.a.len() {
            let kind = self.kinds[i];
            let joint = Joint::new(format!("joint_{}", i + 1), kind).with_range(self.lower[i], self.upper[i]);
            let joint = chain.add_joint(joint.with_velocity(self.velocity[i]));
            let along_x = pose::translation(self.a[i], 0.0, 0.0) * pose::rotation(Vector3::x(), self.alpha[i]);
            // Rotation about and translation along one axis commute, so the joint motion goes first and the constant one
            // after.
            let (offset, constant) = match kind {
                JointKind::Prismatic => (self.d[i], pose::rotation(Vector3::z(), self.theta[i])),
                JointKind::Revolute | JointKind::Continuous => (self.theta[i], pose::translation(0.0, 0.0, self.d[i])),
            };
            let (before, after) = match self.convention {
                Dh::Standard => (Pose::identity(), constant * along_x),
                Dh::Modified => (along_x, constant),
            };
            chain.fixed(before);
            chain.moving(joint, kind, Vector3::z(), Drive { scale: 1.0, offset });
            chain.fixed(after);
            chain.link(format!("link_{}", i + 1));
        }
        Ok(())
    }

    /// Checks that all lists have the length of `a`, and that lengths and angles are finite.
    fn check(&self, robot: &str) -> Result<()> {
        let n = self.a.len();
        let lengths = [
            ("alpha", self.alpha.len()),
            ("d", self.d.len()),
            ("theta", self.theta.len()),
            ("kinds", self.kinds.len()),
            ("lower", self.lower.len()),
            ("upper", self.upper.len()),
            ("velocity", self.velocity.len()),
        ];
        if let Some((column, got)) = lengths.into_iter().find(|(_, length)| *length != n) {
            let what = format!("{column} in the DH table of robot '{robot}'");
            return Err(Error::WrongLength { what: what.into(), expected: format!("{n} entries, as in a"), got });
        }
        for (column, values) in [("a", &self.a), ("alpha", &self.alpha), ("d", &self.d), ("theta", &self.theta)] {
            let what = format!("{column} in the DH table of robot '{robot}'");
            require_finite(&what, values, |i| format!("entry {i}"))?;
        }
        Ok(())
    }
}

impl Robot {
    /// Builds a robot from its Denavit-Hartenberg table. Joints are named `joint_1` and so on; links `base`, `link_1` and so
    /// on.
    ///
    /// # Errors
    /// [`Error::WrongLength`] if a list differs in length from `a`; [`Error::NotFinite`] for lengths and angles; the errors
    /// of [`ChainBuilder::build`].
    pub fn from_dh(name: &str, table: &DhTable) -> Result<Self> {
        let mut chain = ChainBuilder::new(name, "base");
        table.append_to(&mut chain)?;
        chain.build()?.with_base(table.base)?.with_tool(table.tool)
    }
}
