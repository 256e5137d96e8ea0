//! The motion of the tip that counts: rows of the Jacobian.

use std::ops::Range;

use crate::wording::words;

/// The motion of the tip that counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Motion {
    /// Velocities (m/s) and angular velocities (rad/s); the index depends on the unit of length.
    #[default]
    Pose,
    /// Velocities alone.
    Position,
    /// Angular velocities alone.
    Rotation,
}

words!("motion": Motion { Pose => "pose", Position => "position", Rotation => "rotation" });

impl Motion {
    /// The rows that count.
    pub(super) fn rows(self) -> Range<usize> {
        match self {
            Self::Pose => 0..6,
            Self::Position => 0..3,
            Self::Rotation => 3..6,
        }
    }

    /// Sets the rows that do not count to zero.
    pub(super) fn select(self, columns: &mut [[f64; 6]]) {
        let Range { start, end } = self.rows();
        for column in columns {
            column[..start].fill(0.0);
            column[end..].fill(0.0);
        }
    }
}
