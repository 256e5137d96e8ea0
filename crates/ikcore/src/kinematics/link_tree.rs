//! Tree of all links of a robot: the links of the chain, and the links that branch off. Held joints are folded into constant
//! frames, so that most branches only add links to the stages of the chain; a mimic joint on a branch adds a stage of its
//! own.
//!
//! Frame 0 is the base and frame i is moved by stage i - 1 of the chain; the stages of the branches follow.

use nalgebra::Vector3;
use smallvec::SmallVec;

use super::chain::{Chain, LinkFrame, Transmission, basis_with_z_along};
use super::joint_curve::{CurvedStage, CurvedStages, JointCurve, restored};
use crate::math::arithmetic::NoFma;
use crate::math::f64x4::F64x4;
use crate::math::{Columns, Frame, Pose, STACK_DOF, pose};

/// Frames of all moving elements: STACK_DOF + 1 and a few more on the stack, more of them on the heap.
pub(crate) type FrameBuffer = SmallVec<[Frame; 36]>;

/// Moving element of a branch.
#[derive(Debug, Clone)]
struct BranchStage {
    /// Index of the parent frame.
    parent: usize,
    /// Constant frame relative to the parent, z along the axis.
    frame: Frame,
    motion: Transmission,
    curve: Option<BranchCurve>,
}

/// Stage of a curve.
#[derive(Debug, Clone)]
enum BranchCurve {
    First(CurvedStage),
    Second,
}

impl BranchStage {
    /// Returns the frame of the element with its joint at `value`, given the parent frame.
    fn moved(&self, value: f64, parent: &Frame) -> Frame {
        let Self { frame, motion, .. } = self;
        match &self.curve {
            None => {}
            Some(BranchCurve::First(curve)) => {
                return curve.shown(&parent.then::<NoFma>(&curve.placed(frame, value)), value);
            }
            Some(BranchCurve::Second) => return restored(parent),
        }
        let (sine, cosine) = (motion.turn_scale * value + motion.turn_offset).sin_cos();
        let origin = frame.transform::<NoFma>(&[0.0, 0.0, motion.slide_scale * value + motion.slide_offset]);
        parent.then::<NoFma>(&Frame { origin, ..frame.turned::<NoFma>(sine, cosine) })
    }
}

/// Links of a robot, and the stages of its branches.
#[derive(Debug, Clone)]
pub(crate) struct LinkTree {
    /// Number of stages of the chain.
    moving: usize,
    branches: Vec<BranchStage>,
    /// Links of the chain, then links of the branches; their `stages` is a frame index.
    pub links: Vec<LinkFrame>,
}

impl LinkTree {
    /// Returns the length of a frame buffer: at least the length that the kernels need.
    pub fn frames(&self) -> usize {
        (self.moving + 1 + self.branches.len()).max(STACK_DOF + 1)
    }

    /// Adds the frames of the branches to the frames of the chain at `q`.
    pub fn extend_frames(&self, q: &[f64], frames: &mut [Frame]) {
        for (i, stage) in self.branches.iter().enumerate() {
            frames[self.moving + 1 + i] = stage.moved(q[stage.motion.joint], &frames[stage.parent]);
        }
    }

    /// Adds the frames of the branches for four configurations, lane by lane, as [`extend_frames`](Self::extend_frames) does.
    pub fn extend_frames_four(&self, qs: &[F64x4], frames: &mut [Frame<F64x4>]) {
        for (i, stage) in self.branches.iter().enumerate() {
            for lane in 0..4 {
                let moved = stage.moved(qs[stage.motion.joint].0[lane], &frames[stage.parent].lane(lane));
                frames[self.moving + 1 + i].set_lane(lane, &moved);
            }
        }
    }

    /// Returns the frame of a link, with the stages at `frames`.
    pub fn link_frame(&self, link: usize, frames: &[Frame]) -> Frame {
        let LinkFrame { stages, offset } = &self.links[link];
        frames[*stages].then::<NoFma>(offset)
    }

    /// Iterates over the moving elements from frame `frame` inwards to its ancestor `below`: the index of the frame moved by
    /// each, and its motion.
    #[inline]
    pub fn carriers<'a>(
        &'a self,
        chain: &'a Chain,
        frame: usize,
        below: usize,
    ) -> impl Iterator<Item = (usize, &'a Transmission)> + use<'a> {
        let mut at = frame;
        std::iter::from_fn(move || {
            let moved = (at > below).then_some(at)?;
            at = self.parent(moved);
            let motion = match moved.checked_sub(self.moving + 1) {
                None => &chain.motions[moved - 1],
                Some(branch) => &self.branches[branch].motion,
            };
            Some((moved, motion))
        })
    }

    /// Iterates over all moving elements, in the order of their frames from index 1 on: parent frame, constant frame relative
    /// to it, and motion.
    pub fn stages<'a>(&'a self, chain: &'a Chain) -> impl Iterator<Item = (usize, Frame, Transmission)> + use<'a> {
        let of_chain = chain.moving_frames().zip(&chain.motions).enumerate();
        let of_chain = of_chain.map(|(parent, (frame, motion))| (parent, frame, *motion));
        of_chain.chain(self.branches.iter().map(|stage| (stage.parent, stage.frame, stage.motion)))
    }

    /// Returns the first stages of all curves, each with its number among [`stages`](Self::stages).
    pub fn curves(&self, chain: &Chain) -> CurvedStages {
        let mut curves = chain.curves.clone();
        for stage in &self.branches {
            if let Some(BranchCurve::First(curve)) = &stage.curve {
                curves.push(*curve);
            }
        }
        curves
    }

    /// Returns the parent of frame `frame` > 0.
    fn parent(&self, frame: usize) -> usize {
        match frame.checked_sub(self.moving + 1) {
            None => frame - 1,
            Some(branch) => self.branches[branch].parent,
        }
    }

    /// Returns the last common ancestor of two frames.
    #[inline]
    pub fn meeting(&self, one: usize, other: usize) -> usize {
        if one.max(other) <= self.moving {
            return one.min(other);
        }
        let (mut one, mut other) = (one, other);
        while one != other {
            // Parents have smaller indices than their children.
            (one, other) = (one.min(other), self.parent(one.max(other)));
        }
        one
    }

    /// Writes the geometric Jacobian of a link into `columns`, as [`jacobian`](super::jacobian) does for the tip, and returns
    /// the link frame.
    pub fn link_jacobian(&self, chain: &Chain, link: usize, frames: &[Frame], columns: &mut Columns) -> Frame {
        let frame = self.link_frame(link, frames);
        columns.fill([0.0; 6]);
        for (moved, motion) in self.carriers(chain, self.links[link].stages, 0) {
            motion.add_to_column(&frames[moved], &frame.origin, &mut columns[motion.joint]);
        }
        frame
    }
}

/// Builder that folds branches into a tree, link by link.
pub(crate) struct LinkTreeFolder {
    tree: LinkTree,
    /// Index of the current frame, and the constant transform since then.
    at: (usize, Pose),
}

impl LinkTreeFolder {
    /// Creates a tree with the links of `chain`.
    pub fn new(chain: &Chain) -> Self {
        let tree = LinkTree { moving: chain.moving, branches: vec![], links: chain.links.clone() };
        Self { tree, at: (0, Pose::identity()) }
    }

    /// Continues from a link.
    pub fn start_at(&mut self, link: usize) {
        let LinkFrame { stages, offset } = &self.tree.links[link];
        self.at = (*stages, Pose::from(*offset));
    }

    /// Appends a constant transform.
    pub fn fixed(&mut self, transform: &Pose) {
        self.at.1 *= transform;
    }

    /// Appends a motion about or along the unit vector `axis`.
    pub fn moving(&mut self, axis: &Vector3<f64>, motion: Transmission) {
        self.stage(axis, motion, None);
    }

    /// Appends a motion about or along the unit vector `axis`, along a curve.
    pub fn curved(&mut self, axis: &Vector3<f64>, joint: usize, turns: bool, curve: &JointCurve) {
        let first = CurvedStage::new(self.tree.moving + self.tree.branches.len(), *curve, turns);
        self.stage(axis, Transmission::curved(joint, turns, curve), Some(BranchCurve::First(first)));
        let (parent, aligned) = self.at;
        let (frame, motion, curve) = (Frame::IDENTITY, Transmission::NONE, Some(BranchCurve::Second));
        self.tree.branches.push(BranchStage { parent, frame, motion, curve });
        self.at = (parent + 1, aligned);
    }

    fn stage(&mut self, axis: &Vector3<f64>, motion: Transmission, curve: Option<BranchCurve>) {
        let aligned = pose::from_parts([0.0; 3], basis_with_z_along(axis));
        let (parent, constant) = self.at;
        self.tree.branches.push(BranchStage { parent, frame: Frame::from(&(constant * aligned)), motion, curve });
        self.at = (self.tree.moving + self.tree.branches.len(), aligned.inverse());
    }

    /// Adds a link at the current frame.
    pub fn link(&mut self) {
        let (stages, constant) = self.at;
        self.tree.links.push(LinkFrame { stages, offset: Frame::from(&constant) });
    }

    /// Returns the tree.
    pub fn finish(self) -> LinkTree {
        self.tree
    }
}
