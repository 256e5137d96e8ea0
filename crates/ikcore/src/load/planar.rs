//! Planar arms.

use std::f64::consts::PI;

use nalgebra::Vector3;

use crate::error::{Error, Result, require_positive};
use crate::math::pose;
use crate::robot::{ChainBuilder, Drive, Joint, JointKind, Robot};

impl Robot {
    /// Builds an arm of revolute joints about z in the x-y plane, with the first joint at the origin, stretched along x at q
    /// = 0.
    ///
    /// `lengths` (n,) are the link lengths (m). Position limits are +-pi rad, velocity is unlimited. Link `link_i` has its
    /// frame at joint i; the last frame is `tip`.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a length that is not positive and finite; [`Error::WrongLength`] without links.
    pub fn planar(lengths: &[f64]) -> Result<Self> {
        if lengths.is_empty() {
            let (what, expected) = ("lengths of a planar arm".into(), "at least 1".into());
            return Err(Error::WrongLength { what, expected, got: 0 });
        }
        let mut chain = ChainBuilder::new(format!("planar{}", lengths.len()), "base");
        for (i, &length) in lengths.iter().enumerate() {
            require_positive(&format!("length {i} of a planar arm"), length)?;
            let joint = Joint::new(format!("joint_{}", i + 1), JointKind::Revolute).with_range(-PI, PI);
            let joint = chain.add_joint(joint);
            chain.moving(joint, JointKind::Revolute, Vector3::z(), Drive::DIRECT);
            chain.link(format!("link_{}", i + 1));
            chain.fixed(pose::translation(length, 0.0, 0.0));
        }
        chain.link("tip");
        chain.build()
    }
}
