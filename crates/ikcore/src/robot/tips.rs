//! The tips of a robot, and the kinematics of each.

use super::model::Robot;
use super::tip_chain::{TipChain, first_tip};
use crate::error::{Error, Result, shortened, suggestion};
use crate::kinematics::{Reach, Screws, TaskRank};
use crate::math::Columns;
use crate::math::arithmetic::NoFma;
use crate::math::{Frame, MAX_DOF};
use crate::message::{Message, Setting, message};
use crate::wording::{joined, listed};

impl Robot {
    /// Names of the tips' links: one for a chain.
    pub fn tips(&self) -> impl Iterator<Item = &str> + Clone {
        std::iter::once(first_tip(self.parts())).chain(self.parts().tips.iter().map(String::as_str))
    }

    /// Number of tips.
    #[inline]
    pub fn tip_count(&self) -> usize {
        1 + self.parts().tips.len()
    }

    /// Number of the tip of this name.
    ///
    /// # Errors
    /// [`Error::UnknownTip`].
    pub fn tip_number(&self, name: &str) -> Result<usize> {
        self.tips().position(|tip| tip == name).ok_or_else(|| Error::UnknownTip {
            robot: self.name().into(),
            name: shortened(name),
            suggestion: suggestion(name, self.tips()),
            known: listed(self.tips()),
        })
    }

    /// Names of the links from the base to each tip.
    pub fn links_to_tips(&self) -> Vec<Vec<&str>> {
        let names: Vec<&str> = self.all_link_names().collect();
        match &self.tip_chains().chains[..] {
            [] => vec![self.link_names().collect()],
            chains => chains.iter().map(|chain| chain.links.iter().map(|link| names[*link]).collect()).collect(),
        }
    }

    /// Err if the robot has several tips, which `call` does not take.
    ///
    /// # Errors
    /// [`Error::SeveralTips`].
    pub fn require_one_tip(&self, call: impl Into<Message>) -> Result<()> {
        match self.parts().tips[..] {
            [] => Ok(()),
            _ => {
                let remedy = message!["load the robot with one of them as ", Setting::Tip];
                Err(Error::SeveralTips { call: call.into(), tips: joined(self.tips()), remedy })
            }
        }
    }

    /// Poses of all tips (m, tips, 4, 4) at `qs` (m, n); both row-major.
    ///
    /// # Errors
    /// As [`fk_all`](Self::fk_all).
    pub fn tips_fk_all(&self, qs: &[f64]) -> Result<Vec<f64>> {
        let rows = self.rows(qs)?;
        let mut poses = Vec::with_capacity(16 * self.tip_count() * rows.len());
        for q in rows {
            (0..self.tip_count()).for_each(|tip| poses.extend(self.tip_of(tip, q).rows()));
        }
        Ok(poses)
    }

    /// Geometric Jacobians of all tips (m, tips, 6, n) at `qs` (m, n); both row-major.
    ///
    /// # Errors
    /// As [`fk_all`](Self::fk_all).
    pub fn tips_jacobian_all(&self, qs: &[f64]) -> Result<Vec<f64>> {
        let rows = self.rows(qs)?;
        let mut columns = Columns::default();
        let mut jacobians = Vec::with_capacity(6 * self.tip_count() * qs.len());
        for q in rows {
            for tip in 0..self.tip_count() {
                self.tip_and_jacobian_of(tip, q, &mut columns);
                for row in 0..6 {
                    jacobians.extend(columns[..q.len()].iter().map(|column| column[row]));
                }
            }
        }
        Ok(jacobians)
    }

    /// Frame of tip number `tip` at `q`, which has one finite entry per joint.
    #[inline]
    pub(crate) fn tip_of(&self, tip: usize, q: &[f64]) -> Frame {
        match self.tip_chain(tip) {
            None => self.tip(q),
            Some(TipChain { whole, .. }) => (whole.kernels.tip)(&whole.chain, q),
        }
    }

    /// Frame of tip number `tip`, with the moving elements at `frames`.
    pub(crate) fn tip_among(&self, tip: usize, frames: &[Frame]) -> Frame {
        match self.tip_chain(tip) {
            None => frames[self.chain().moving].then::<NoFma>(&self.chain().tip),
            Some(TipChain { link, .. }) => self.tree().link_frame(*link, frames),
        }
    }

    /// Writes the Jacobian of tip number `tip` and returns its frame. `q` has one finite entry per joint.
    #[inline]
    pub(crate) fn tip_and_jacobian_of(&self, tip: usize, q: &[f64], columns: &mut Columns) -> Frame {
        match self.tip_chain(tip) {
            None => self.tip_and_jacobian(q, columns),
            Some(TipChain { whole, .. }) => {
                // The kernel writes the columns of the first joints, and adds to the others.
                columns.fit(q.len());
                columns[..q.len()].fill([0.0; 6]);
                (whole.kernels.jacobian)(&whole.chain, q, columns)
            }
        }
    }

    /// Bounds on the positions that tip number `tip` can reach between these joint limits.
    pub(crate) fn reach_of(&self, tip: usize, lower: &[f64], upper: &[f64]) -> Reach {
        match self.tip_chain(tip) {
            None => self.reach(lower, upper),
            Some(TipChain { whole, reach_of_links, .. }) => reach_of_links.with_slides(&whole.chain, lower, upper),
        }
    }

    /// Rank of the Jacobian of tip number `tip` by task, at non-singular configurations.
    pub(crate) fn task_rank_of(&self, tip: usize) -> TaskRank {
        match self.tip_chain(tip) {
            None => self.task_rank(),
            Some(TipChain { whole, .. }) => TaskRank::of(&whole.chain, &whole.kernels, &self.sampling_ranges()),
        }
    }

    /// Screws of the elements that move tip number `tip` at `q`, which has one finite entry per joint.
    pub(crate) fn screws_of(&self, tip: usize, q: &[f64]) -> Screws {
        let Some(TipChain { whole, .. }) = self.tip_chain(tip) else { return self.screws(q) };
        let mut reached = [Frame::IDENTITY; MAX_DOF + 1];
        (whole.kernels.stage_frames)(&whole.chain, q, &mut reached);
        Screws::of(&whole.chain, &reached)
    }

    /// The frame at `q` that the arm of tip number `tip` begins at: what joints of other tips move it by.
    pub(crate) fn stem_of(&self, tip: usize, q: &[f64]) -> Option<Frame> {
        self.tip_chain(tip).map(|TipChain { stem, .. }| (stem.kernels.tip)(&stem.chain, q))
    }

    /// Number of the frame that carries tip number `tip`.
    pub(crate) fn frame_of_tip(&self, tip: usize) -> usize {
        self.tip_chain(tip).map_or(self.chain().moving, |TipChain { link, .. }| self.carrier_of_link_number(*link).0)
    }

    /// The chain to tip number `tip`; None for a robot with one.
    #[inline]
    fn tip_chain(&self, tip: usize) -> Option<&TipChain> {
        self.tip_chains().chains.get(tip)
    }
}
