//! Kinematics of any link: those of the chain, and those that branch off it.

use super::joint::{Joint, outside_limits};
use super::model::Robot;
use std::collections::HashMap;

use super::off_chain::HeldJoint;
use crate::error::{Error, Result, shortened, suggestion};
use crate::kinematics::CurvedStages;
use crate::kinematics::chain::{LinkFrame, StageAxis, Transmission};
use crate::kinematics::eight_frames::EightStages;
use crate::kinematics::link_tree::FrameBuffer;
use crate::math::Columns;
use crate::math::arithmetic::NoFma;
use crate::math::f64x4::F64x4;
use crate::math::{Frame, Pose};
use crate::wording::listed;

impl Robot {
    /// Names of all links: those of the chain, base to tip, then those that branch off it, parents first.
    pub fn all_link_names(&self) -> impl Iterator<Item = &str> {
        self.link_names().chain(self.parts().off_chain.links.iter().map(|link| link.name.as_str()))
    }

    /// The joints beside the chain, with the values at which they are held.
    pub fn held_joints(&self) -> &[HeldJoint] {
        &self.parts().off_chain.held
    }

    /// Copy of the robot with some of its held joints elsewhere, each (name, value in rad or m).
    ///
    /// # Errors
    /// [`Error::NotHeld`], [`Error::NotFinite`], [`Error::OutsideLimits`].
    pub fn with_held<'a>(&self, held: impl IntoIterator<Item = (&'a str, f64)>) -> Result<Self> {
        let mut off_chain = (*self.parts().off_chain).clone();
        for (name, value) in held {
            let joint = off_chain.held.iter_mut().find(|held| held.joint.name == name);
            let joint = joint.ok_or_else(|| self.not_held(name))?;
            let (lower, upper) = (joint.joint.lower, joint.joint.upper);
            if value.is_finite() && !(lower..=upper).contains(&value) {
                let named = (name, Some(joint.joint.kind));
                return Err(outside_limits("hold", named, value, [lower, upper], "move it inside"));
            }
            joint.value = value;
        }
        self.with_off_chain(off_chain)
    }

    fn not_held(&self, name: &str) -> Error {
        let held = || self.held_joints().iter().map(|held| held.joint.name.as_str());
        let problem = match self.joints().iter().position(|joint| joint.name == name) {
            Some(entry) => format!(" (it is entry {entry} of q)"),
            None => suggestion(name, held()),
        };
        Error::NotHeld { robot: self.name().into(), name: shortened(name), problem, held: listed(held()) }
    }

    /// Pose of link `link` at `q` (n,). That of the tip link is without the tool.
    ///
    /// # Errors
    /// [`Error::UnknownLink`], and those of [`fk`](Self::fk).
    pub fn link_fk(&self, link: &str, q: &[f64]) -> Result<Pose> {
        self.check("joint angles", q)?;
        let link = self.link_number(link)?;
        Ok(self.tree().link_frame(link, &self.frames(q)).into())
    }

    /// Poses of link `link` (m, 4, 4) at `qs` (m, n); both row-major.
    ///
    /// # Errors
    /// [`Error::UnknownLink`], and those of [`fk_all`](Self::fk_all).
    pub fn link_fk_all(&self, link: &str, qs: &[f64]) -> Result<Vec<f64>> {
        let n = self.rows(qs)?.len();
        let LinkFrame { stages, offset } = &self.tree().links[self.link_number(link)?];
        let mut poses = Vec::with_capacity(16 * n);
        let mut append = |frame: &Frame| poses.extend(frame.then::<NoFma>(offset).rows());
        let mut lanes = vec![F64x4::ZERO; self.dof()];
        let mut four = self.frame_buffer_four();
        let groups = qs.chunks_exact(4 * self.dof());
        let rest = groups.remainder();
        for group in groups {
            for (i, value) in group.iter().enumerate() {
                lanes[i % self.dof()].0[i / self.dof()] = *value;
            }
            self.write_frames_four(&lanes, &mut four);
            (0..4).for_each(|lane| append(&four[*stages].lane(lane)));
        }
        let mut frames = self.frame_buffer();
        for q in rest.chunks_exact(self.dof()) {
            self.write_frames(q, &mut frames);
            append(&frames[*stages]);
        }
        Ok(poses)
    }

    /// Geometric Jacobians of link `link` (m, 6, n) at `qs` (m, n), both row-major; columns of joints that do not move the
    /// link are zero.
    ///
    /// # Errors
    /// [`Error::UnknownLink`], and those of [`fk_all`](Self::fk_all).
    pub fn link_jacobian_all(&self, link: &str, qs: &[f64]) -> Result<Vec<f64>> {
        let link = self.link_number(link)?;
        let mut frames = self.frame_buffer();
        let mut columns = Columns::default();
        columns.fit(self.dof());
        let mut jacobians = Vec::with_capacity(6 * qs.len());
        for q in self.rows(qs)? {
            self.write_frames(q, &mut frames);
            self.tree().link_jacobian(self.chain(), link, &frames, &mut columns);
            for row in 0..6 {
                jacobians.extend(columns[..self.dof()].iter().map(|column| column[row]));
            }
        }
        Ok(jacobians)
    }

    /// Pose of every link at `q` (n,), in the order of [`all_link_names`](Self::all_link_names).
    ///
    /// # Errors
    /// Those of [`fk`](Self::fk).
    pub fn all_link_poses(&self, q: &[f64]) -> Result<Vec<Pose>> {
        self.check("joint angles", q)?;
        let frames = self.frames(q);
        Ok((0..self.tree().links.len()).map(|link| self.tree().link_frame(link, &frames).into()).collect())
    }

    /// Number of a link in [`all_link_names`](Self::all_link_names).
    ///
    /// # Errors
    /// [`Error::UnknownLink`].
    pub(crate) fn link_number(&self, name: &str) -> Result<usize> {
        self.all_link_names().position(|link| link == name).ok_or_else(|| Error::UnknownLink {
            robot: self.name().into(),
            name: shortened(name),
            suggestion: suggestion(name, self.all_link_names()),
            known: listed(self.all_link_names()),
        })
    }

    /// Number of the frame that carries a link, and the constant frame of the link there.
    pub(crate) fn carrier_of_link(&self, link: &str) -> Option<(usize, Frame)> {
        Some(self.carrier_of_link_number(self.link_number(link).ok()?))
    }

    /// [`carrier_of_link`](Self::carrier_of_link) by number.
    pub(crate) fn carrier_of_link_number(&self, link: usize) -> (usize, Frame) {
        let LinkFrame { stages, offset } = &self.tree().links[link];
        (*stages, *offset)
    }

    /// Numbers of all links, by name.
    pub(super) fn link_numbers(&self) -> HashMap<&str, usize> {
        self.all_link_names().enumerate().map(|(number, name)| (name, number)).collect()
    }

    /// Number of the link that a link is attached to; `None` for the base link.
    pub(super) fn parent_link(&self, link: usize) -> Option<usize> {
        match link.checked_sub(self.chain().links.len()) {
            None => link.checked_sub(1),
            Some(beside) => Some(self.parts().off_chain.links[beside].parent),
        }
    }

    /// The frames of all moving elements at `q`: 0 is the base, then those of the chain, then those of the branches.
    pub(super) fn frames(&self, q: &[f64]) -> FrameBuffer {
        let mut frames = self.frame_buffer();
        self.write_frames(q, &mut frames);
        frames
    }

    /// Room for [`write_frames`](Self::write_frames).
    #[inline]
    pub(crate) fn frame_buffer(&self) -> FrameBuffer {
        FrameBuffer::from_elem(Frame::IDENTITY, self.tree().frames())
    }

    /// Room for [`write_frames_four`](Self::write_frames_four).
    pub(crate) fn frame_buffer_four(&self) -> Vec<Frame<F64x4>> {
        vec![Frame::of([&Frame::IDENTITY; 4]); self.tree().frames()]
    }

    /// The moving elements between a frame and one below that carries it, the outermost first: the number of the frame that each
    /// moves, and its motion.
    #[inline]
    pub(crate) fn carriers(&self, frame: usize, below: usize) -> impl Iterator<Item = (usize, &Transmission)> {
        self.tree().carriers(self.chain(), frame, below)
    }

    /// All moving elements, in the order of their frames from number 1 on: the number of the frame that each starts from, its constant
    /// frame there, and its motion.
    pub(crate) fn moving_elements(&self) -> impl Iterator<Item = (usize, Frame, Transmission)> {
        self.tree().stages(self.chain())
    }

    /// The first elements of polynomial couplings, each with its number among [`moving_elements`](Self::moving_elements).
    pub(crate) fn curves(&self) -> CurvedStages {
        self.tree().curves(self.chain())
    }

    /// The first joint that another one follows by a polynomial.
    pub(crate) fn curve_leader(&self) -> Option<&Joint> {
        let (.., motion) = self.moving_elements().find(|(.., motion)| motion.axis == StageAxis::OfCurve)?;
        self.joints().get(motion.joint)
    }

    /// Err for a robot with a joint that follows another one by a polynomial; `what` names what is not computed for those.
    ///
    /// # Errors
    /// [`Error::Contradiction`] names the joint that leads.
    pub fn require_linear_couplings(&self, what: &str) -> Result<()> {
        let Some(Joint { name, .. }) = self.curve_leader() else { return Ok(()) };
        let problem = format!("{what} cannot be computed where a joint follows another one, '{name}', by a polynomial");
        Err(Error::Contradiction { problem: problem.into() })
    }

    /// The moving elements, for eight configurations at once.
    pub(crate) fn eight_stages(&self) -> EightStages {
        EightStages::new(self.moving_elements(), self.chain().vector.clone(), self.curves())
    }

    /// Number of the last frame that carries both of these.
    #[inline]
    pub(crate) fn meeting_frame(&self, one: usize, other: usize) -> usize {
        self.tree().meeting(one, other)
    }

    /// Writes the frames of all moving elements at `q`.
    #[inline]
    pub(crate) fn write_frames(&self, q: &[f64], frames: &mut [Frame]) {
        self.write_stage_frames(q, frames);
        self.tree().extend_frames(q, frames);
    }

    /// [`write_frames`](Self::write_frames) for four configurations at once, bit-identical; `qs` has one entry per joint, and
    /// `frames` is as long as [`frame_buffer`](Self::frame_buffer).
    pub(crate) fn write_frames_four(&self, qs: &[F64x4], frames: &mut [Frame<F64x4>]) {
        (self.kernels().stage_frames_four)(self.chain(), qs, frames);
        self.tree().extend_frames_four(qs, frames);
    }
}
