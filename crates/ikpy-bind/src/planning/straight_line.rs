//! `StraightLine`, and reading of `approach` and `retreat`.

use ikcore::planning::{LineContact, LineFrame, StraightLine};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyString};

use crate::convert::{point, summary};
use crate::error::{invalid, raise};
use crate::hash::content_hash;
use crate::options::{NewArguments, Shown, keywords, list_text};

/// A straight line of the tip with constant orientation at an end of a motion, as `approach=` or `retreat=` of
/// `plan_point_to_point`.
///
/// Args:
///     distance: length (m).
///     direction: (3,), direction of the motion, of any nonzero length; None: along the tip's z axis towards the end, against
///         it from the start.
///     frame: frame of the direction, "tip" or "base".
///     touch: contacts that are allowed on this line alone, for example of a hand that closes on a part: names of links
///         that may touch any obstacle, or a dict from the index of an obstacle to the names of links that may touch
///         it.
#[pyclass(name = "StraightLine", module = "beetle_ik", frozen, eq)]
#[derive(Debug, PartialEq)]
pub struct PyStraightLine(StraightLine);

#[pymethods]
impl PyStraightLine {
    #[new]
    #[pyo3(signature = (distance, *, direction=None, frame="tip", touch=None))]
    fn new(
        distance: f64,
        direction: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = crate::convert::text)] frame: &str,
        touch: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let line = StraightLine {
            distance,
            direction: direction.map(|direction| point("direction", direction)).transpose()?,
            frame: frame.parse::<LineFrame>().map_err(raise)?,
            touch: touch.map_or(Ok(vec![]), read_contacts)?,
        };
        line.validate("StraightLine").map_err(raise)?;
        Ok(Self(line))
    }

    /// Length (m).
    #[getter]
    fn distance(&self) -> f64 {
        self.0.distance
    }

    /// Direction of the motion (3,); None: along the tip's z axis.
    #[getter]
    fn direction(&self) -> Option<[f64; 3]> {
        self.0.direction
    }

    /// Frame of the direction, "tip" or "base".
    #[getter]
    fn frame(&self) -> &'static str {
        self.0.frame.name()
    }

    /// Contacts that are allowed on this line alone: names of links, or a dict from the index of an obstacle to names of links.
    #[getter]
    fn touch<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match &self.0.touch[..] {
            [LineContact { obstacle: None, links }] => Ok(PyList::new(py, links)?.into_any()),
            contacts => {
                let by_obstacle = PyDict::new(py);
                for LineContact { obstacle, links } in contacts {
                    by_obstacle.set_item(obstacle, links)?;
                }
                Ok(by_obstacle.into_any())
            }
        }
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let StraightLine { distance, direction, frame, .. } = &self.0;
        let direction = direction.map_or_else(|| "None".into(), |direction| list_text(&direction));
        let touch = self.touch(py)?.repr()?;
        Ok(format!("StraightLine({}, direction={direction}, frame='{frame}', touch={touch})", distance.text()))
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }

    fn __getnewargs_ex__<'py>(slf: &Bound<'py, Self>) -> PyResult<NewArguments<'py>> {
        keywords(slf, &["distance", "direction", "frame", "touch"])
    }
}

/// Reads names of links, or a dict from indices of obstacles to names of links.
fn read_contacts(touch: &Bound<'_, PyAny>) -> PyResult<Vec<LineContact>> {
    let wrong = || {
        let got = summary(touch);
        invalid(format!(
            "touch must be a list of link names, or a dict from the index of an obstacle to such a list, got {got}"
        ))
    };
    let names = |links: &Bound<'_, PyAny>| match links.cast::<PyString>() {
        Ok(_) => Err(wrong()),
        Err(_) => links.extract::<Vec<String>>().map_err(|_| wrong()),
    };
    let Ok(by_obstacle) = touch.cast::<PyDict>() else {
        let links = names(touch)?;
        return Ok(if links.is_empty() { vec![] } else { vec![LineContact { obstacle: None, links }] });
    };
    let contact = |(obstacle, links): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        Ok(LineContact { obstacle: Some(obstacle.extract::<usize>().map_err(|_| wrong())?), links: names(&links)? })
    };
    by_obstacle.into_iter().map(contact).collect()
}

/// Reads `approach` or `retreat`: a length (m) or a `StraightLine`.
pub fn read_line(name: &str, value: Option<&Bound<'_, PyAny>>) -> PyResult<Option<StraightLine>> {
    let Some(value) = value else { return Ok(None) };
    if let Ok(line) = value.cast::<PyStraightLine>() {
        return Ok(Some(line.get().0.clone()));
    }
    match value.extract::<f64>() {
        Ok(distance) => Ok(Some(StraightLine { distance, ..StraightLine::default() })),
        Err(_) => Err(invalid(format!("{name} must be a length (m) or a StraightLine, got {}", summary(value)))),
    }
}
