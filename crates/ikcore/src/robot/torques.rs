//! Torques, mass matrices and accelerations, in row-major arrays: one row is one configuration.

use std::cell::Cell;

use smallvec::SmallVec;

use super::model::Robot;
use crate::dynamics::{AppliedWrench, DynamicState, Dynamics, DynamicsScratch};
use crate::error::{Error, Result, require_finite};
use crate::interrupt::checkpoint_at;
use crate::kinematics::Wrench;
use crate::math::arithmetic::NoFma;
use crate::math::{Columns, Frame};

thread_local! {
    /// Scratch memory of the last call on this thread: to set up its eight kilobytes takes longer than the torques of one configuration.
    static IDLE: Cell<Option<Box<DynamicsScratch>>> = const { Cell::new(None) };
}

/// Motions (m, n) of a robot, row-major: where each joint is, how fast it moves, and how that changes.
#[derive(Debug, Clone, Copy)]
pub struct Motions<'a> {
    /// Positions (rad, m).
    pub q: &'a [f64],
    /// Velocities (rad/s, m/s); `None`: at rest.
    pub qd: Option<&'a [f64]>,
    /// Accelerations (rad/s^2, m/s^2); `None`: zero.
    pub qdd: Option<&'a [f64]>,
    /// Wrenches that the surroundings exert on the tips (N, N m), in the axes of the base: 6 for each tip, for all motions or for each.
    pub wrenches: Option<&'a [f64]>,
}

impl Robot {
    /// Scratch memory for the kernels of [`Dynamics`]. Its frames are written by [`write_frames`](Self::write_frames).
    pub(crate) fn dynamics_scratch(&self, dynamics: &Dynamics) -> DynamicsScratch {
        DynamicsScratch::new(dynamics, self.frame_buffer())
    }

    /// Returns what `work` does with scratch memory that is kept for the next call on this thread.
    fn with_scratch<R>(&self, dynamics: &Dynamics, work: impl FnOnce(&mut DynamicsScratch) -> R) -> R {
        let mut scratch = IDLE.take().unwrap_or_default();
        scratch.fit(dynamics, self.tree().frames());
        let result = work(&mut scratch);
        IDLE.set(Some(scratch));
        result
    }

    /// Joint torques (m, n) (N m, or N for prismatic joints) that cause the motions, friction included. At rest they hold the arm up.
    ///
    /// # Errors
    /// [`Error::NoDynamics`]; [`Error::WrongLength`] and [`Error::NotFinite`] name row and joint, [`Error::OutOfRange`] a torque that overflows.
    pub fn torques_all(&self, motions: &Motions) -> Result<Vec<f64>> {
        let dynamics = self.dynamics()?;
        let rows = self.rows_of("joint angles", motions.q)?;
        let wrenches = self.checked_wrenches(motions, rows.len())?;
        let length = motions.q.len();
        motions.qd.map_or(Ok(()), |qd| self.require_rows("joint velocities", qd, length))?;
        motions.qdd.map_or(Ok(()), |qdd| self.require_rows("joint accelerations", qdd, length))?;
        let is_held = motions.qd.is_none() && motions.qdd.is_none() && wrenches.is_empty();
        let rest: SmallVec<[f64; 16]> = SmallVec::from_elem(0.0, self.dof());
        let (tips, mut applied) = (self.tip_count(), vec![]);
        let mut torques = vec![0.0; length];
        self.with_scratch(dynamics, |scratch| {
            for (row, (q, torques)) in rows.zip(torques.chunks_exact_mut(self.dof())).enumerate() {
                checkpoint_at(row)?;
                self.write_frames(q, &mut scratch.frames);
                if is_held {
                    dynamics.holding(scratch, torques);
                    continue;
                }
                let state =
                    DynamicState { q, qd: row_or(&rest, motions.qd, row), qdd: row_or(&rest, motions.qdd, row) };
                applied.clear();
                let first = if wrenches.len() > tips { row * tips } else { 0 };
                for (tip, wrench) in wrenches.iter().skip(first).take(tips).enumerate() {
                    applied.push(self.applied_at_tip(tip, wrench, &scratch.frames));
                }
                dynamics.inverse(&state, &applied, scratch, torques);
            }
            self.require_in_range("torque", &torques)?;
            Ok(torques)
        })
    }

    /// Mass matrices (m, n, n) at `qs` (m, n), rotors included (kg m^2; rows and columns of prismatic joints kg m and kg).
    ///
    /// # Errors
    /// As [`torques_all`](Self::torques_all).
    pub fn mass_matrix_all(&self, qs: &[f64]) -> Result<Vec<f64>> {
        let dynamics = self.dynamics()?;
        let (rows, n) = (self.rows(qs)?, self.dof());
        let mut matrices = vec![0.0; qs.len() * n];
        self.with_scratch(dynamics, |scratch| {
            for (row, (q, matrix)) in rows.zip(matrices.chunks_exact_mut(n * n)).enumerate() {
                checkpoint_at(row)?;
                self.write_frames(q, &mut scratch.frames);
                dynamics.mass_matrix(scratch, matrix);
            }
            Ok(matrices)
        })
    }

    /// Joint accelerations (m, n) (rad/s^2, m/s^2) that the `torques` (m, n) cause at `qs` and `qds`, both (m, n): the inverse of
    /// [`torques_all`](Self::torques_all), friction included.
    ///
    /// # Errors
    /// As [`torques_all`](Self::torques_all); [`Error::SingularMassMatrix`] names row and joint.
    pub fn accelerations_all(&self, qs: &[f64], qds: &[f64], torques: &[f64]) -> Result<Vec<f64>> {
        let dynamics = self.dynamics()?;
        let rows = self.rows(qs)?;
        self.require_rows("joint velocities", qds, qs.len())?;
        self.require_rows("joint torques", torques, qs.len())?;
        let (n, mut accelerations) = (self.dof(), torques.to_vec());
        let each = rows.zip(qds.chunks_exact(n));
        self.with_scratch(dynamics, |scratch| {
            for (row, ((q, qd), out)) in each.zip(accelerations.chunks_exact_mut(n)).enumerate() {
                checkpoint_at(row)?;
                self.write_frames(q, &mut scratch.frames);
                dynamics.forward([q, qd], scratch, out).map_err(|joint| Error::SingularMassMatrix {
                    robot: self.name().into(),
                    row,
                    joint: self.joints()[joint].name.clone(),
                })?;
            }
            self.require_in_range("acceleration", &accelerations)?;
            Ok(accelerations)
        })
    }

    /// Centres of mass (m, 3) of all links at `qs` (m, n), in the frame of the base (m); links that stand still and payloads count.
    ///
    /// # Errors
    /// As [`torques_all`](Self::torques_all).
    pub fn center_of_mass_all(&self, qs: &[f64]) -> Result<Vec<f64>> {
        let dynamics = self.dynamics()?;
        let rows = self.rows(qs)?;
        let mut centers = Vec::with_capacity(3 * rows.len());
        self.with_scratch(dynamics, |scratch| {
            for (row, q) in rows.enumerate() {
                checkpoint_at(row)?;
                self.write_frames(q, &mut scratch.frames);
                centers.extend(dynamics.center_of_mass_and_rates(&scratch.frames, &mut []));
            }
            Ok(centers)
        })
    }

    /// A frame at the centre of mass in the axes of the base, and its Jacobian (n,), whose angular rows are zero. The robot has dynamics:
    /// the base is the centre of one that has none.
    pub(crate) fn center_of_mass_and_jacobian(&self, q: &[f64], columns: &mut Columns) -> Frame {
        columns.fit(q.len());
        columns[..q.len()].fill([0.0; 6]);
        self.frame_at_center_of_mass(q, &mut columns[..q.len()])
    }

    /// A frame at the centre of mass in the axes of the base; adds the velocity of the centre to `columns`.
    pub(crate) fn frame_at_center_of_mass(&self, q: &[f64], columns: &mut [[f64; 6]]) -> Frame {
        let Ok(dynamics) = self.dynamics() else { return Frame::IDENTITY };
        let origin = self.with_scratch(dynamics, |scratch| {
            self.write_frames(q, &mut scratch.frames);
            dynamics.center_of_mass_and_rates(&scratch.frames, columns)
        });
        Frame { origin, ..Frame::IDENTITY }
    }

    /// Checks that results (m, n) fit into numbers.
    fn require_in_range(&self, what: &str, results: &[f64]) -> Result<()> {
        let Some(i) = results.iter().position(|result| !result.is_finite()) else { return Ok(()) };
        let (row, joint) = (i / self.dof(), &self.joints()[i % self.dof()].name);
        let row = if results.len() > self.dof() { format!(", row {row},") } else { String::new() };
        let what = format!("{what} of joint '{joint}' of robot '{}'{row}", self.name());
        Err(Error::out_of_range(what, "a number that floats can hold: what causes it is too large", results[i]))
    }

    /// Checks that `values` has one complete and finite row for each of q, which has this length.
    fn require_rows(&self, what: &str, values: &[f64], length: usize) -> Result<()> {
        let rows = self.rows_of(what, values)?.len();
        if values.len() == length {
            return Ok(());
        }
        let what = format!("{what} of robot '{}'", self.name());
        let expected = format!("{} rows, as many as there are joint angles", length / self.dof());
        Err(Error::WrongLength { what: what.into(), expected, got: rows })
    }

    /// The wrenches of all tips, for all motions or for each of `rows`.
    fn checked_wrenches<'q>(&self, motions: &Motions<'q>, rows: usize) -> Result<&'q [Wrench]> {
        let Some(numbers) = motions.wrenches else { return Ok(&[]) };
        require_finite("wrench", numbers, |i| format!("entry {i}"))?;
        let (wrenches, rest) = numbers.as_chunks::<6>();
        let tips = self.tip_count();
        if rest.is_empty() && (wrenches.len() == tips || wrenches.len() == rows * tips) {
            return Ok(wrenches);
        }
        let expected = format!("{} numbers for all motions, or {} for {rows} motions", 6 * tips, 6 * tips * rows);
        Err(Error::WrongLength { what: "wrench".into(), expected, got: numbers.len() })
    }

    fn applied_at_tip(&self, tip: usize, wrench: &Wrench, frames: &[Frame]) -> AppliedWrench {
        let link = match self.tip_chains().chains.get(tip) {
            Some(chain) => chain.link,
            None => self.link_names().count() - 1,
        };
        let (frame, offset) = self.carrier_of_link_number(link);
        let place = offset.then::<NoFma>(&Frame::from(self.tool()));
        AppliedWrench { frame, point: frames[frame].transform::<NoFma>(&place.origin), wrench: *wrench }
    }
}

/// Row `row` of `values`; `rest`, which is as long, where there are none.
fn row_or<'a>(rest: &'a [f64], values: Option<&'a [f64]>, row: usize) -> &'a [f64] {
    let n = rest.len();
    values.map_or(rest, |values| &values[row * n..(row + 1) * n])
}
