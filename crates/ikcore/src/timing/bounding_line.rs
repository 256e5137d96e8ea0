//! Lines that bound u = d2s/dt2 in the plane of x = (ds/dt)^2 and u.

/// A coefficient of u below this fraction of the largest counts as zero: its line would be so steep that it is mostly
/// rounding, and it hardly bounds u.
pub(super) const NEGLIGIBLE_SLOPE: f64 = 1e-9;

/// The line u = offset - slope x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Line {
    pub offset: f64,
    pub slope: f64,
}

impl Line {
    #[inline]
    pub(super) fn at(self, x: f64) -> f64 {
        self.offset - self.slope * x
    }
}
