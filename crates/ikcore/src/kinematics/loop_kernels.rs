//! Kernels for any number of stages, written as plain loops: for chains with a [rotation vector](super::rotation_vector) or a
//! [curve](super::joint_curve), and for chains longer than the compiled kernels.

use super::chain::Chain;
use super::torques::Wrench;
use crate::math::arithmetic::NoFma;
use crate::math::f64x4::F64x4;
use crate::math::{Columns, Frame, MAX_DOF};

/// Calls `visit(i, frame)` with the frame moved by each stage, from the base on, and returns the tip frame.
fn forward_pass(chain: &Chain, q: &[f64], mut visit: impl FnMut(usize, &Frame)) -> Frame {
    let vector = chain.vector.as_ref().map(|vector| (vector, vector.frames(&vector.phi(q))));
    let mut frame = Frame::IDENTITY;
    for (i, motion) in chain.motions[..chain.moving].iter().enumerate() {
        if let Some(curve) = chain.curves.at(i) {
            let q = q[motion.joint];
            frame = frame.then::<NoFma>(&curve.placed(&chain.stages.frame(i), q));
            visit(i, &curve.shown(&frame, q));
            continue;
        }
        let turned = vector.as_ref().and_then(|(vector, frames)| vector.own_stage(i).map(|own| frames[own]));
        let moved = turned.unwrap_or_else(|| {
            let (sine, cosine) = (motion.turn_scale * q[motion.joint] + motion.turn_offset).sin_cos();
            let stage = chain.stages.frame(i);
            let origin =
                stage.transform::<NoFma>(&[0.0, 0.0, motion.slide_scale * q[motion.joint] + motion.slide_offset]);
            Frame { origin, ..stage.turned::<NoFma>(sine, cosine) }
        });
        frame = frame.then::<NoFma>(&moved);
        visit(i, &frame);
    }
    frame.then::<NoFma>(&chain.tip)
}

pub(super) fn tip(chain: &Chain, q: &[f64]) -> Frame {
    forward_pass(chain, q, |_, _| ())
}

pub(super) fn tip_positions<const W: usize>(chain: &Chain, qs: &[f64]) -> [[f64; W]; 3] {
    let n = qs.len() / W;
    let points: [[f64; 3]; W] = std::array::from_fn(|w| tip(chain, &qs[w * n..(w + 1) * n]).origin);
    std::array::from_fn(|k| std::array::from_fn(|w| points[w][k]))
}

pub(super) fn jacobian(chain: &Chain, q: &[f64], columns: &mut Columns) -> Frame {
    let mut moved = [Frame::IDENTITY; MAX_DOF];
    let tip = forward_pass(chain, q, |i, frame| moved[i] = *frame);
    columns.fit(q.len());
    columns[..q.len()].fill([0.0; 6]);
    for (motion, frame) in chain.motions[..chain.moving].iter().zip(&moved) {
        motion.add_to_column(frame, &tip.origin, &mut columns[motion.joint]);
    }
    tip
}

pub(super) fn torques(chain: &Chain, q: &[f64], wrench: &dyn Fn(&Frame) -> Wrench, torques: &mut [f64]) -> Frame {
    let mut columns = Columns::default();
    let tip = jacobian(chain, q, &mut columns);
    let wrench = wrench(&tip);
    for (torque, column) in torques.iter_mut().zip(&*columns) {
        *torque = column.iter().zip(&wrench).map(|(c, w)| c * w).sum();
    }
    tip
}

pub(super) fn stage_frames(chain: &Chain, q: &[f64], reached: &mut [Frame]) {
    forward_pass(chain, q, |i, frame| reached[i + 1] = *frame);
}

pub(super) fn stage_frames_four(chain: &Chain, qs: &[F64x4], reached: &mut [Frame<F64x4>]) {
    for lane in 0..4 {
        let mut q = [0.0; MAX_DOF];
        q.iter_mut().zip(qs).for_each(|(q, lanes)| *q = lanes.0[lane]);
        forward_pass(chain, &q[..qs.len()], |i, frame| reached[i + 1].set_lane(lane, frame));
    }
}
