//! `calibrate` and its result.

mod arguments;
mod result;

use ikcore::calibration::{self, CalibrationOptions, SuggestionOptions};
use pyo3::prelude::*;

use crate::convert::count;
use crate::error::raise;
use crate::monitor::long_call;
use crate::obstacle::read_surroundings;
use crate::robot::PyRobot;

use arguments::{Kind, read_fit, read_measured, read_rows, read_sigma};
use result::{PyCalibration, PyIdentifiability};

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PyCalibration>()?;
    module.add_class::<PyIdentifiability>()?;
    module.add_function(wrap_pyfunction!(calibrate, module)?)
}

/// Finds the geometry of a robot as it is built from measurements, by weighted least squares.
///
/// Args:
///     robot: the model; its limits decide nothing.
///     q: joint angles as the controller reports them (m, n) (rad, m); for distances between two positions (m, 2, n).
///     measured: what was measured in each of the m configurations:
///
///         - positions of the tip (m, 3) (m), or poses (m, 4, 4), in any frame, such as a tracker's;
///         - with `camera`: poses of a board as the camera sees it (m, 4, 4), or with `board` and `lens` its image points (m, k, 2)
///           (pixels), NaN for a point that is not seen;
///         - with `center`: distances of the tip from a fixed point (m,) (m), as by a ball bar;
///         - with `plane`: heights of the tip above a plane (m,) (m), zero for contacts;
///         - with q (m, 2, n): distances between the tip's positions (m,) (m).
///     fit: what may differ from the model: "offsets" (the zero of each joint), "links" (the transform before each joint but the first),
///         "tool", "base". With a camera, "tool" and "base" mean the poses of camera and board. None: all; with a camera "tool" and
///         "base", which is hand-eye calibration.
///     sigma: standard deviation of the noise (m or pixels): a number, for poses also of angles (rad) or (length, angle), or one row per measurement, (m,)
///         or (m, 2). None: estimated from the residuals.
///     robust: whether measurements that do not belong with the others are found and left out.
///     camera: "fixed": beside the robot, the board on the tip; "hand": on the tip, the board beside the robot. None: no camera.
///     board: points of the board in its own frame (k, 3) (m).
///     lens: focal lengths and principal point (fx, fy, cx, cy) (pixels) of a camera without distortion.
///     center: fixed end of the ball bar (3,) (m), a guess in the frame of the robot's base.
///     plane: (nx, ny, nz, h), a guess: the plane of the points p with n . p = h (m) in the frame of the robot's base.
///     suggest: number of further configurations to suggest, those that would tell most (at most 100): inside the limits and, with a
///         camera, where it sees the board.
///     obstacles: what suggested configurations keep clear of, as the links of the arm keep clear of each other; an empty list checks the
///         links alone, None nothing.
///     margin: distance to keep (m); None: 0.001.
///     seed: seed of the candidates among which they are chosen; the same seed gives the same bits.
///
/// Returns:
///     A `Calibration`, whose `robot` is the arm as it is built.
///
/// Raises:
///     InvalidInputError: too few measurements, configurations that are all alike, millimetres for metres, degrees for radians, a mirrored
///         frame; wrong shape; NaN.
#[pyfunction]
#[pyo3(signature = (robot, q, measured, *, fit=None, sigma=None, robust=true, camera=None, board=None, lens=None, center=None, plane=None, suggest=0, obstacles=None, margin=None, seed=0))]
#[allow(clippy::too_many_arguments, reason = "keywords of Python")]
fn calibrate(
    py: Python<'_>,
    robot: &PyRobot,
    q: &Bound<'_, PyAny>,
    measured: &Bound<'_, PyAny>,
    #[pyo3(from_py_with = crate::convert::optional_texts)] fit: Option<Vec<String>>,
    sigma: Option<&Bound<'_, PyAny>>,
    robust: bool,
    #[pyo3(from_py_with = crate::convert::optional_text)] camera: Option<&str>,
    board: Option<&Bound<'_, PyAny>>,
    lens: Option<&Bound<'_, PyAny>>,
    center: Option<&Bound<'_, PyAny>>,
    plane: Option<&Bound<'_, PyAny>>,
    suggest: i128,
    obstacles: Option<&Bound<'_, PyAny>>,
    margin: Option<f64>,
    seed: i128,
) -> PyResult<PyCalibration> {
    let kind = Kind { camera: camera.map(str::parse).transpose().map_err(raise)?, board, lens, center, plane };
    let (qs, pairs) = read_rows(&robot.core, q)?;
    let measured = read_measured(measured, pairs, &kind)?;
    let sigma = sigma.map(|sigma| read_sigma(sigma, &measured)).transpose()?;
    let suggestion = SuggestionOptions {
        count: count("suggest", suggest)?,
        surroundings: read_surroundings(robot, obstacles, margin, None)?,
        seed: count("seed", seed)?,
    };
    let options = CalibrationOptions { fit: read_fit(fit, camera.is_some())?, sigma, robust, suggestion };
    let found = long_call(py, || calibration::calibrate(&robot.core, &qs, &measured, &options))?;
    PyCalibration::new(py, found, robot.core.dof(), pairs)
}
