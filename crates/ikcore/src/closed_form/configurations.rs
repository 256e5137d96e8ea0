//! ArmConfigurations of an arm, made from the values of its axes.

use smallvec::SmallVec;

use crate::closed_form::branches::MOST;

/// Most joints that a closed form has.
pub(crate) const MOST_JOINTS: usize = 7;

/// Values of the axes of sixteen configurations.
pub type Sets = [[f64; MOST_JOINTS]; MOST];

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

    /// The limits of seven axes where the joints have the limits `lower` and `upper` (n,).
    pub fn of_axes(&self, lower: &[f64], upper: &[f64]) -> [[f64; 2]; MOST_JOINTS] {
        std::array::from_fn(|axis| {
            let (joint, scale) = self.axes[axis];
            let ends = [scale * lower[joint], scale * upper[joint]];
            [ends[0].min(ends[1]), ends[0].max(ends[1])]
        })
    }
}

/// ArmConfigurations of an arm, each at one of its whole turns.
#[derive(Debug, Clone)]
pub(crate) struct ArmConfigurations {
    sets: Sets,
    count: usize,
    joints: usize,
}

impl ArmConfigurations {
    /// None.
    pub fn none() -> Self {
        Self { sets: Sets::default(), count: 0, joints: 0 }
    }

    /// From the values of the axes that `write` leaves in the first `count` sets.
    #[inline]
    pub fn new(drives: &Drives, count: usize, write: impl FnOnce(&mut Sets)) -> Self {
        let mut all = Self { sets: Sets::default(), count, joints: drives.axes.len() };
        write(&mut all.sets);
        if !drives.is_plain {
            for set in &mut all.sets[..count] {
                let values = *set;
                for (value, (joint, scale)) in values.iter().zip(&drives.axes) {
                    set[*joint] = value / scale;
                }
            }
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

    /// Each of them (n,) (rad, m).
    pub fn iter(&self) -> impl Iterator<Item = &[f64]> {
        self.sets[..self.count].iter().map(|set| &set[..self.joints])
    }
}
