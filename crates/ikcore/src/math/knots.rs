//! Knots in time.

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result, require_finite};

/// Knot times (s), which start at zero and increase: the ends of the segments of a piecewise function of time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<f64>")]
pub struct Knots(Vec<f64>);

/// Validates knots again when they are deserialized.
impl TryFrom<Vec<f64>> for Knots {
    type Error = Error;

    fn try_from(times: Vec<f64>) -> Result<Self> {
        Self::new("knots", times)
    }
}

impl Knots {
    /// Validates the times (s); `what` names them in errors.
    ///
    /// # Errors
    /// [`Error::WrongLength`] for fewer than two, [`Error::NotFinite`], [`Error::OutOfRange`] if the first is not zero,
    /// [`Error::NotIncreasing`].
    pub fn new(what: &str, times: Vec<f64>) -> Result<Self> {
        if times.len() < 2 {
            return Err(Error::WrongLength { what: what.into(), expected: "at least 2".into(), got: times.len() });
        }
        require_finite(what, &times, |row| format!("row {row}"))?;
        if times[0] != 0.0 {
            return Err(Error::out_of_range(
                format!("{what}: row 0"),
                "0, where the clock starts (take the first time from all)",
                times[0],
            ));
        }
        match (1..times.len()).find(|&row| times[row] <= times[row - 1]) {
            None => Ok(Self(times)),
            Some(row) => {
                Err(Error::NotIncreasing { what: what.into(), row, previous: times[row - 1], value: times[row] })
            }
        }
    }

    /// Returns the knot times (s).
    pub fn times(&self) -> &[f64] {
        &self.0
    }

    /// Returns the number of segments: one less than the number of knots.
    pub fn segments(&self) -> usize {
        self.0.len() - 1
    }

    /// Returns the last knot (s).
    pub fn duration(&self) -> f64 {
        self.0[self.segments()]
    }

    /// Returns the duration of a segment (s).
    pub fn span(&self, segment: usize) -> f64 {
        self.0[segment + 1] - self.0[segment]
    }

    /// Finds the segment that contains time `t` (s, clamped to the knots), and the time since its start (s). A knot belongs
    /// to the segment that starts there.
    pub fn locate(&self, t: f64) -> (usize, f64) {
        let t = t.clamp(0.0, self.duration());
        let started = self.0.partition_point(|&knot| knot <= t);
        let segment = started.saturating_sub(1).min(self.segments() - 1);
        (segment, t - self.0[segment])
    }
}
