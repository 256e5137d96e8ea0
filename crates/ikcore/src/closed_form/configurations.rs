//! Configurations of an arm, made from the values of its axes.

use smallvec::SmallVec;

use crate::closed_form::branches::{MOST, MOST_JOINTS};

/// Values of the axes, those of an axis for all configurations side by side.
pub type AxisColumns = [[f64; MOST]; MOST_JOINTS];

/// Which joint drives each axis, and its factor on q.
#[derive(Debug, Clone)]
pub struct Drives {
    axes: SmallVec<[(usize, f64); MOST_JOINTS]>,
    /// Joint k drives axis k by its own value.
    is_plain: bool,
}

impl Drives {
    /// From the joint and the factor of each axis.
    pub fn new(of_axes: impl Iterator<Item = (usize, f64)>) -> Self {
        let axes: SmallVec<_> = of_axes.collect();
        let is_plain = axes.iter().enumerate().all(|(axis, drive)| *drive == (axis, 1.0));
        Self { axes, is_plain }
    }

    /// The joint that drives `axis`.
    pub fn joint(&self, axis: usize) -> usize {
        self.axes[axis].0
    }

    /// How many axes there are.
    pub fn len(&self) -> usize {
        self.axes.len()
    }

    /// Replaces the values of the axes by those of the joints.
    #[inline]
    pub fn joints_of(&self, values: &mut [f64; MOST_JOINTS]) {
        if !self.is_plain {
            let of_axes = *values;
            for (value, (joint, scale)) in of_axes.iter().zip(&self.axes) {
                values[*joint] = value / scale;
            }
        }
    }

    /// The limits of seven axes where the joints have the limits `lower` and `upper` (n,).
    pub fn of_axes(&self, lower: &[f64], upper: &[f64]) -> [[f64; 2]; MOST_JOINTS] {
        std::array::from_fn(|axis| {
            let (joint, scale) = self.axes[axis];
            let ends = [scale * lower[joint], scale * upper[joint]];
            [ends[0].min(ends[1]), ends[0].max(ends[1])]
        })
    }
}

/// Configurations of an arm, each at one of its whole turns. The values of a joint lie side by side.
#[derive(Debug, Clone)]
pub(crate) struct ArmConfigurations {
    columns: AxisColumns,
    count: usize,
    joints: usize,
    /// No solution is missing, and none stands for a family; false says nothing.
    pub is_all: bool,
}

impl ArmConfigurations {
    /// None.
    pub fn none() -> Self {
        Self { columns: AxisColumns::default(), count: 0, joints: 0, is_all: false }
    }

    /// Replaces all by those whose values of the axes `write` leaves in the first `count` places of each column.
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

    /// From the values of `joints` joints, one configuration after the other.
    pub fn of_sets(sets: &[[f64; MOST_JOINTS]], joints: usize) -> Self {
        let mut all = Self { columns: AxisColumns::default(), count: sets.len(), joints, is_all: false };
        for (place, set) in sets.iter().enumerate() {
            (0..joints).for_each(|j| all.columns[j][place] = set[j]);
        }
        all
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The values of each joint (rad, m), writable.
    pub fn columns_mut(&mut self) -> &mut [[f64; MOST]] {
        &mut self.columns[..self.joints]
    }

    /// The values of each joint (rad, m): the first [`Self::len`] count.
    pub fn columns(&self) -> &[[f64; MOST]] {
        &self.columns[..self.joints]
    }
}
