//! Arguments of `calibrate`.

use ikcore::calibration::{CameraPlace, Measured, Part, PinholeCamera};
use ikcore::robot::Robot;
use numpy::PyUntypedArrayMethods;
use pyo3::prelude::*;

use crate::convert::{Numbers, array, entries, point, rigid_matrices, shape_text};
use crate::error::{invalid, raise};

/// Keywords that define the kind of the measurements.
pub struct Kind<'a, 'py> {
    pub camera: Option<CameraPlace>,
    pub board: Option<&'a Bound<'py, PyAny>>,
    pub lens: Option<&'a Bound<'py, PyAny>>,
    pub center: Option<&'a Bound<'py, PyAny>>,
    pub plane: Option<&'a Bound<'py, PyAny>>,
}

/// Reads joint angles (m, n), or (m, 2, n) for pairs; also returns whether they are pairs.
pub fn read_rows(robot: &Robot, q: &Bound<'_, PyAny>) -> PyResult<(Vec<f64>, bool)> {
    let numbers = array("q", q)?;
    let n = robot.dof();
    match *numbers.shape() {
        [_, last] if last == n => Ok((numbers.as_slice()?.to_vec(), false)),
        [_, 2, last] if last == n => Ok((numbers.as_slice()?.to_vec(), true)),
        ref shape => Err(invalid(format!(
            "q of robot '{}': expected shape (m, {n}), or (m, 2, {n}) for distances between two positions, got {}",
            robot.name(),
            shape_text(shape)
        ))),
    }
}

/// Reads the parts to fit.
pub fn read_fit(fit: Option<Vec<String>>, camera: bool) -> PyResult<Vec<Part>> {
    match fit {
        None if camera => Ok(vec![Part::Tool, Part::Base]),
        None => Ok(Part::ALL.to_vec()),
        Some(words) => words.iter().map(|word| word.parse().map_err(raise)).collect(),
    }
}

/// Reads the measurements; their shape and the keywords define their kind.
pub fn read_measured(value: &Bound<'_, PyAny>, pairs: bool, kind: &Kind<'_, '_>) -> PyResult<Measured> {
    let numbers = array("measured", value)?;
    let shape = numbers.shape().to_vec();
    if kind.board.is_some() != kind.lens.is_some() {
        return Err(invalid("image points need both board= (k, 3) and lens=(fx, fy, cx, cy)".into()));
    }
    let others = [kind.camera.is_some(), kind.center.is_some(), kind.plane.is_some(), pairs];
    if others.into_iter().filter(|given| *given).count() > 1 {
        return Err(invalid(
            "camera=, center=, plane= and q (m, 2, n) are different measurements: give one of them".into(),
        ));
    }
    match (&shape[..], kind.camera, kind.board) {
        ([_, 4, 4], Some(camera), None) => {
            Ok(Measured::BoardPoses { poses: rigid_matrices(numbers.as_slice()?)?, camera })
        }
        ([_, points, 2], Some(camera), Some(board)) => read_pixels(&numbers, *points, camera, board, kind.lens),
        (_, Some(_), _) => {
            Err(expected("poses of a board (m, 4, 4), or image points (m, k, 2) with board= and lens=", &shape))
        }
        (_, None, Some(_)) => Err(invalid("image points need camera=\"fixed\" or camera=\"hand\"".into())),
        _ => read_without_camera(&numbers, &shape, pairs, kind),
    }
}

fn read_without_camera(numbers: &Numbers<'_>, shape: &[usize], pairs: bool, kind: &Kind<'_, '_>) -> PyResult<Measured> {
    let values = numbers.as_slice()?;
    match (shape, kind.center, kind.plane) {
        ([_], Some(center), _) => Ok(Measured::BallBar { distances: values.to_vec(), centre: point("center", center)? }),
        ([_], _, Some(plane)) => {
            let [x, y, z, height] = entries("plane", plane)?;
            Ok(Measured::Heights { heights: values.to_vec(), normal: [x, y, z], height })
        }
        (_, Some(_), _) => Err(expected("distances (m,) with center=", shape)),
        (_, _, Some(_)) => Err(expected("heights (m,) with plane=", shape)),
        ([_], ..) if pairs => Ok(Measured::Pairs(values.to_vec())),
        _ if pairs => Err(expected("distances (m,) with q (m, 2, n)", shape)),
        ([_], ..) => Err(invalid(
            "measured: distances need center=(x, y, z), heights above a plane plane=(nx, ny, nz, h), and distances between two positions q (m, 2, n)"
                .into(),
        )),
        ([_, 3], ..) => Ok(Measured::Positions(values.as_chunks::<3>().0.to_vec())),
        ([_, 4, 4], ..) => Ok(Measured::Poses(rigid_matrices(values)?)),
        _ => Err(expected("positions (m, 3), poses (m, 4, 4) or distances (m,)", shape)),
    }
}

fn read_pixels(
    numbers: &Numbers<'_>,
    points: usize,
    camera: CameraPlace,
    board: &Bound<'_, PyAny>,
    lens: Option<&Bound<'_, PyAny>>,
) -> PyResult<Measured> {
    let corners = array("board", board)?;
    if !matches!(corners.shape(), [_, 3]) {
        return Err(invalid(format!("board: expected shape (k, 3), got {}", shape_text(corners.shape()))));
    }
    let [fx, fy, cx, cy] = match lens {
        Some(lens) => entries("lens", lens)?,
        None => [1.0, 1.0, 0.0, 0.0],
    };
    let pixels = numbers.as_slice()?.as_chunks::<2>().0;
    Ok(Measured::Pixels {
        board: corners.as_slice()?.as_chunks::<3>().0.to_vec(),
        seen: pixels.chunks(points.max(1)).map(<[[f64; 2]]>::to_vec).collect(),
        lens: PinholeCamera { focal: [fx, fy], centre: [cx, cy] },
        camera,
    })
}

fn expected(what: &str, shape: &[usize]) -> PyErr {
    invalid(format!("measured: expected {what}, got {}", shape_text(shape)))
}

/// Reads standard deviations: a number, (length, angle) of poses, or a row for each measurement.
pub fn read_sigma(value: &Bound<'_, PyAny>, measured: &Measured) -> PyResult<Vec<[f64; 2]>> {
    let numbers = array("sigma", value)?;
    let (values, count) = (numbers.as_slice()?, measured.count());
    let rotations = measured.has_rotations();
    match (numbers.shape(), values) {
        // A number is enough for poses of a metre's reach: angles then have as many radians as lengths have metres.
        ([], [sigma]) => Ok(vec![[*sigma; 2]; count]),
        ([2], [length, angle]) if rotations => Ok(vec![[*length, *angle]; count]),
        ([rows], _) if *rows == count && !rotations => Ok(values.iter().map(|sigma| [*sigma; 2]).collect()),
        ([rows, 2], _) if *rows == count && rotations => Ok(values.as_chunks::<2>().0.to_vec()),
        (shape, _) => {
            let rows = if rotations { format!("(length, angle) or ({count}, 2)") } else { format!("({count},)") };
            Err(invalid(format!("sigma: expected a number or {rows}, got {}", shape_text(shape))))
        }
    }
}
