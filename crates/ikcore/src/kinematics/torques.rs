//! Joint torques that balance a wrench at the tip: J'w without forming the Jacobian J.

use super::chain::Chain;
use super::forward_pass::forward_pass;
use crate::math::Frame;
use crate::math::arithmetic::Arithmetic;
use crate::math::vector3::sub;

/// Force (N) and moment (N m) at the tip, in base axes.
pub type Wrench = [f64; 6];

/// Writes the joint torques J'w into `torques`, with w = wrench(tip), and returns the tip frame. A revolute joint takes the
/// moment about its axis, a prismatic joint the force along its axis.
#[inline(always)]
pub(super) fn torques<A: Arithmetic, const N: usize, const L: usize>(
    chain: &Chain,
    q: &[f64],
    wrench: &dyn Fn(&Frame) -> Wrench,
    torques: &mut [f64],
) -> Frame {
    let (mut axes, mut origins) = ([[0.0; 3]; N], [[0.0; 3]; N]);
    let tip = Frame::from(forward_pass::<A, N, L>(chain, q, |i, frame| {
        axes[i] = frame.axes[2].vector();
        origins[i] = frame.origin.vector();
    }));
    let [fx, fy, fz, mx, my, mz] = wrench(&tip);
    torques.fill(0.0);
    for (i, motion) in chain.motions[..N].iter().enumerate() {
        let [lx, ly, lz] = sub(&tip.origin, &origins[i]);
        let [ax, ay, az] = axes[i];
        let about = [
            A::mul_add(ly, fz, A::mul_add(-lz, fy, mx)),
            A::mul_add(lz, fx, A::mul_add(-lx, fz, my)),
            A::mul_add(lx, fy, A::mul_add(-ly, fx, mz)),
        ];
        let turning = A::mul_add(ax, about[0], A::mul_add(ay, about[1], az * about[2]));
        let sliding = A::mul_add(ax, fx, A::mul_add(ay, fy, az * fz));
        // Torques are summed, since several stages may share a joint (mimics).
        torques[motion.joint] += A::mul_add(motion.turn_scale, turning, motion.slide_scale * sliding);
    }
    tip
}
