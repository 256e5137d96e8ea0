//! Joint direction that moves the tip least.

use nalgebra::{DMatrix, Dyn, OMatrix, SVD};

use crate::math::Columns;
use crate::objective::Point;
use crate::robot::Robot;
use crate::task::Tolerance;

/// Direction in joint space, and its effect on the tip.
pub(super) struct WeakDirection {
    /// Unit vector (n,) (rad, m).
    pub direction: Point,
    /// Change of the pose per unit of the direction, as a multiple of the tolerances.
    pub change: f64,
}

impl WeakDirection {
    /// Smallest singular value of the Jacobian at `q`, its rows divided by the tolerances, and the right singular vector.
    pub fn at(robot: &Robot, q: &[f64], tolerance: &Tolerance) -> Self {
        let mut columns = Columns::default();
        robot.tip_and_jacobian(q, &mut columns);
        let per = |row: usize| if row < 3 { tolerance.position } else { tolerance.rotation };
        // More rows than columns, so that the decomposition has a right vector for each joint.
        let scaled: OMatrix<f64, Dyn, Dyn> =
            DMatrix::from_fn(
                q.len().max(6),
                q.len(),
                |row, joint| {
                    if row < 6 { columns[joint][row] / per(row) } else { 0.0 }
                },
            );
        let decomposed = SVD::new(scaled, false, true);
        let (place, change) = decomposed.singular_values.argmin();
        let direction =
            decomposed.v_t.map_or_else(|| Point::from_elem(0.0, q.len()), |v| v.row(place).iter().copied().collect());
        Self { direction, change }
    }
}
