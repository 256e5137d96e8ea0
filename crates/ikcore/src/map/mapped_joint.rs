//! Limits of a joint up to whole turns.

/// Excess over a limit (rad, m) that counts as rounding: the joint is at its limit.
const AT_LIMIT: f64 = 1e-9;

/// Limits of a joint, and the smallest change that leaves the pose unchanged.
#[derive(Debug, Clone, Copy)]
pub(super) struct MappedJoint {
    pub lower: f64,
    pub upper: f64,
    pub period: Option<f64>,
}

impl MappedJoint {
    /// Whether a value is inside the limits, whole turns aside.
    #[inline]
    pub fn holds(&self, value: f64) -> bool {
        let (lower, upper) = (self.lower - AT_LIMIT, self.upper + AT_LIMIT);
        match self.period {
            None => lower <= value && value <= upper,
            Some(period) => upper - lower >= period || value + period * ((lower - value) / period).ceil() <= upper,
        }
    }

    /// Shifts a value by whole turns into the limits if possible, and clamps it otherwise.
    pub fn brought_inside(&self, value: f64) -> f64 {
        let turned = match self.period {
            Some(period) if value < self.lower || value > self.upper => {
                value + period * ((self.lower - AT_LIMIT - value) / period).ceil()
            }
            _ => value,
        };
        turned.clamp(self.lower, self.upper)
    }
}

#[cfg(test)]
mod tests {
    use super::MappedJoint;

    #[test]
    fn a_value_is_brought_inside_by_whole_turns_or_to_a_limit() {
        let joint = MappedJoint { lower: -1.0, upper: 2.0, period: Some(4.0) };
        for (value, inside) in [(0.5, 0.5), (4.5, 0.5), (-7.5, 0.5), (2.0, 2.0), (-1.0, -1.0), (3.0, -1.0), (6.5, 2.0)]
        {
            assert_eq!(joint.brought_inside(value), inside, "{value}");
        }
        let slides = MappedJoint { period: None, ..joint };
        assert_eq!([-5.0, 5.0].map(|value| slides.brought_inside(value)), [-1.0, 2.0]);
    }
}
