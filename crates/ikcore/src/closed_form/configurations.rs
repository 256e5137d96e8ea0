//! Arm configurations computed from axis values.

use smallvec::SmallVec;

use crate::closed_form::branches::{MOST, MOST_JOINTS};

/// Axis values by columns: each axis holds its values in all configurations.
pub type AxisColumns = [[f64; MOST]; MOST_JOINTS];

/// Map from each axis to the joint that drives it, and its factor on q.
#[derive(Debug, Clone)]
pub struct Drives {
    axes: SmallVec<[(usize, f64); MOST_JOINTS]>,
    /// True if joint k drives axis k with factor 1.
    is_plain: bool,
}

impl Drives {
    /// Builds the map from the joint and the factor of each axis.
    pub fn new(of_axes: impl Iterator<Item = (usize, f64)>) -> Self {
        let axes: SmallVec<_> = of_axes.collect();
        let is_plain = axes.iter().enumerate().all(|(axis, drive)| *drive == (axis, 1.0));
        Self { axes, is_plain }
    }

    /// Returns the joint that drives `axis`.
    pub fn joint(&self, axis: usize) -> usize {
        self.axes[axis].0
    }

    /// Returns the number of axes.
    pub fn len(&self) -> usize {
        self.axes.len()
    }

    /// Replaces axis values by joint values.
    #[inline]
    pub fn joints_of(&self, values: &mut [f64; MOST_JOINTS]) {
        if !self.is_plain {
            let of_axes = *values;
            for (value, (joint, scale)) in of_axes.iter().zip(&self.axes) {
                values[*joint] = value / scale;
            }
        }
    }

    /// Returns the limits of up to seven axes, given joint limits `lower` and `upper` (n,); those beyond the last axis are zero.
    pub fn of_axes(&self, lower: &[f64], upper: &[f64]) -> [[f64; 2]; MOST_JOINTS] {
        std::array::from_fn(|axis| {
            let Some(&(joint, scale)) = self.axes.get(axis) else { return [0.0; 2] };
            let ends = [scale * lower[joint], scale * upper[joint]];
            [ends[0].min(ends[1]), ends[0].max(ends[1])]
        })
    }
}

/// Configurations of an arm, stored by joint; each is listed at one of its whole turns.
#[derive(Debug, Clone)]
pub(crate) struct ArmConfigurations {
    columns: AxisColumns,
    count: usize,
    joints: usize,
    /// True if no solution is missing and none represents a family; false proves nothing.
    pub is_all: bool,
}

impl ArmConfigurations {
    /// Creates an empty set.
    pub fn none() -> Self {
        Self { columns: AxisColumns::default(), count: 0, joints: 0, is_all: false }
    }

    /// Replaces all configurations by `count` new ones, whose axis values `write` stores in the first places of each column.
    #[inline]
    pub fn replace(&mut self, drives: &Drives, count: usize, write: impl FnOnce(&mut AxisColumns)) {
        (self.count, self.joints, self.is_all) = (count, drives.axes.len(), false);
        write(&mut self.columns);
        if !drives.is_plain {
            let of_axes = self.columns;
            for (values, (joint, scale)) in of_axes.iter().zip(&drives.axes) {
                self.columns[*joint] = values.map(|value| value / scale);
            }
        }
    }

    /// Converts row-wise values of `joints` joints.
    pub fn of_sets(sets: &[[f64; MOST_JOINTS]], joints: usize) -> Self {
        let mut all = Self { columns: AxisColumns::default(), count: sets.len(), joints, is_all: false };
        for (place, set) in sets.iter().enumerate() {
            (0..joints).for_each(|j| all.columns[j][place] = set[j]);
        }
        all
    }

    /// Returns the number of configurations.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are no configurations.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Returns the values of each joint (rad, m), mutable.
    pub fn columns_mut(&mut self) -> &mut [[f64; MOST]] {
        &mut self.columns[..self.joints]
    }

    /// Returns the values of each joint (rad, m); the first [`Self::len`] are valid.
    pub fn columns(&self) -> &[[f64; MOST]] {
        &self.columns[..self.joints]
    }
}
