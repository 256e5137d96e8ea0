//! Linearization of four targets of one kind, side by side.

use super::criterion::Criterion;
use super::residual::orientation;
use super::target::Target;
use super::tip_error::SquaredError;
use crate::math::Frame;
use crate::math::arithmetic::{Arithmetic, Baseline, by_instructions};
use crate::math::box_step::ROWS;
use crate::math::f64x4::F64x4;
use crate::math::real::{Four, Real};
use crate::math::so3::Axes;
use crate::math::vec3::Vec3;
use crate::objective::{FourLinearizations, Score};
use crate::robot::Robot;

/// Residuals, their angular rows empty, and the squared distances of [`position`](super::residual::position), side by side.
#[inline(always)]
fn linearize_positions<A: Arithmetic>(wanted: &[F64x4; 3], tips: &[F64x4; 3], residual: &mut [F64x4; ROWS]) -> F64x4 {
    let missed = Vec3::<Four<A>>::of(tips) - Vec3::of(wanted);
    let [x, y, z] = missed.stored();
    *residual = [x, y, z, F64x4::ZERO, F64x4::ZERO, F64x4::ZERO];
    missed.dot(missed).stored()
}

/// Squared distances and squared angles of [`pose`](super::residual::pose), side by side, from the geometric Jacobians that stand in `columns`.
#[inline(always)]
fn linearize_poses<A: Arithmetic>(
    wanted: &Frame<F64x4>,
    tips: &Frame<F64x4>,
    residual: &mut [F64x4; ROWS],
    columns: &mut [[F64x4; ROWS]],
) -> (F64x4, F64x4) {
    let positions = linearize_positions::<A>(&wanted.origin, &tips.origin, residual);
    let rotations = orientation::linearize::<Four<A>>(&axes_of(wanted), &axes_of(tips), residual, columns);
    (positions, rotations.stored())
}

#[inline(always)]
fn axes_of<A: Arithmetic>(frames: &Frame<F64x4>) -> Axes<Four<A>> {
    let [x, y, z] = &frames.axes;
    [Vec3::of(x), Vec3::of(y), Vec3::of(z)]
}

by_instructions! {
    /// [`linearize_poses`] for the instructions of this machine.
    #[inline]
    fn linearize_poses_here(
        wanted: &Frame<F64x4>,
        tips: &Frame<F64x4>,
        residual: &mut [F64x4; ROWS],
        columns: &mut [[F64x4; ROWS]],
    ) -> (F64x4, F64x4) {
        linearize_poses::<A>(wanted, tips, residual, columns)
    }
}

impl Target {
    /// Whether targets of this kind can be [linearized side by side](Self::linearize_four).
    pub(crate) fn goes_side_by_side(&self, criterion: &Criterion) -> bool {
        matches!(self, Self::Position(_) | Self::Pose(_)) && !criterion.is_componentwise()
    }

    /// [`linearize`](Self::linearize) for four targets, all positions or all poses, to the same bits; `qs` has one entry per joint.
    pub(crate) fn linearize_four(
        targets: [&Self; 4],
        robot: &Robot,
        qs: &[F64x4],
        criterion: &Criterion,
        out: &mut FourLinearizations,
    ) -> [Score; 4] {
        let kind = std::mem::discriminant(targets[0]);
        debug_assert!(targets.iter().all(|target| std::mem::discriminant(*target) == kind), "targets of one kind");
        let FourLinearizations { residual, columns } = out;
        let columns = &mut columns[..qs.len()];
        let tips = robot.tips_and_jacobians(qs, columns);
        let places = targets.map(|target| target.position().unwrap_or_default());
        let squared: [SquaredError; 4] = if let [Self::Pose(a), Self::Pose(b), Self::Pose(c), Self::Pose(d)] = targets {
            let wanted = Frame::<F64x4>::of([a, b, c, d]);
            let (positions, rotations) = linearize_poses_here(&wanted, &tips, residual, columns);
            std::array::from_fn(|lane| SquaredError {
                position: Some(positions.0[lane]),
                rotation: Some(rotations.0[lane]),
            })
        } else {
            let wanted = std::array::from_fn(|k| F64x4(places.map(|place| place[k])));
            let positions = linearize_positions::<Baseline>(&wanted, &tips.origin, residual);
            columns.iter_mut().for_each(|column| column[3..].fill(F64x4::ZERO));
            positions.0.map(|position| SquaredError { position: Some(position), rotation: None })
        };
        squared.map(|error| criterion.assess_unweighted(error, error.sum()).score)
    }
}
