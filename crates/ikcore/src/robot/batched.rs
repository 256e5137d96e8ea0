//! Kinematics of many configurations, in row-major arrays.

use super::model::Robot;
use crate::error::{Error, Result};
use crate::math::Columns;

impl Robot {
    /// Poses of the tip (m, 4, 4) at `qs` (m, n); both row-major.
    ///
    /// # Errors
    /// [`Error::WrongLength`] if the length of `qs` is not a multiple of n, [`Error::NotFinite`] names row and joint.
    pub fn fk_all(&self, qs: &[f64]) -> Result<Vec<f64>> {
        let rows = self.rows(qs)?;
        let mut poses = Vec::with_capacity(16 * rows.len());
        for q in rows {
            poses.extend(self.tip(q).rows());
        }
        Ok(poses)
    }

    /// Geometric Jacobians (m, 6, n) at `qs` (m, n); both row-major.
    ///
    /// # Errors
    /// As [`fk_all`](Self::fk_all).
    pub fn jacobian_all(&self, qs: &[f64]) -> Result<Vec<f64>> {
        let rows = self.rows(qs)?;
        let n = self.dof();
        let mut columns = Columns::default();
        let mut jacobians = Vec::with_capacity(6 * qs.len());
        for q in rows {
            self.tip_and_jacobian(q, &mut columns);
            for row in 0..6 {
                jacobians.extend(columns[..n].iter().map(|column| column[row]));
            }
        }
        Ok(jacobians)
    }

    /// The configurations within the position limits that are nearest to `qs` (m, n), row-major.
    ///
    /// # Errors
    /// As [`fk_all`](Self::fk_all).
    pub fn clip_all(&self, qs: &[f64]) -> Result<Vec<f64>> {
        let rows = self.rows(qs)?;
        Ok(rows
            .flat_map(|q| q.iter().zip(self.joints()).map(|(q, joint)| q.max(joint.lower).min(joint.upper)))
            .collect())
    }

    /// The rows of `qs`, checked to be complete and finite.
    pub(crate) fn rows<'q>(&self, qs: &'q [f64]) -> Result<std::slice::ChunksExact<'q, f64>> {
        self.rows_of("joint angles", qs)
    }

    /// The rows of values of all joints, checked to be complete and finite; `what` names them in the message.
    pub(super) fn rows_of<'q>(&self, what: &str, qs: &'q [f64]) -> Result<std::slice::ChunksExact<'q, f64>> {
        let n = self.dof();
        if !qs.len().is_multiple_of(n) {
            let what = format!("{what} of robot '{}'", self.name());
            return Err(Error::WrongLength {
                what: what.into(),
                expected: format!("rows of {n} joints"),
                got: qs.len(),
            });
        }
        if let Some(i) = qs.iter().position(|value| !value.is_finite()) {
            let place = format!("joint '{}' of configuration {}", self.joints()[i % n].name, i / n);
            return Err(Error::NotFinite { what: what.into(), place, value: qs[i] });
        }
        Ok(qs.chunks_exact(n))
    }
}
