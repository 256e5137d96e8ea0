//! Motion of the tip that counts, as rows of the Jacobian.

use std::ops::Range;

use crate::wording::words;

/// Motion of the tip that counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Motion {
    /// Velocities (m/s) and angular velocities (rad/s); the index depends on the unit of length.
    #[default]
    Pose,
    /// Velocities only.
    Position,
    /// Angular velocities only.
    Rotation,
}

words!("motion": Motion { Pose => "pose", Position => "position", Rotation => "rotation" });

impl Motion {
    /// Rows of the Jacobian that count.
    pub(super) fn rows(self) -> Range<usize> {
        match self {
            Self::Pose => 0..6,
            Self::Position => 0..3,
            Self::Rotation => 3..6,
        }
    }

    /// Sets the other rows to zero.
    pub(super) fn select(self, columns: &mut [[f64; 6]]) {
        let Range { start, end } = self.rows();
        for column in columns {
            column[..start].fill(0.0);
            column[end..].fill(0.0);
        }
    }
}
