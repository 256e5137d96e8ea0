//! Robots whose geometry was measured.

use super::description::Element;
use super::model::Robot;
use crate::error::Result;
use crate::math::{Pose, pose};

impl Robot {
    /// Copy of the robot with other elements of its chain, base and tool. Joints, links, bodies and branches stay: the elements name the
    /// same links in the same order.
    ///
    /// # Errors
    /// [`Error::NotFinite`](crate::Error::NotFinite) for transforms; [`Error::SeveralTips`](crate::Error::SeveralTips).
    pub(crate) fn with_geometry(&self, elements: Vec<Element>, base: Pose, tool: Pose) -> Result<Self> {
        self.require_one_tip("calibration")?;
        let mut parts = self.parts().clone();
        parts.description.elements = elements;
        parts.base = pose::checked("base", base)?;
        parts.tool = pose::checked("tool", tool)?;
        Self::assembled(parts)
    }
}
