//! `pose`: a 4x4 matrix from a position and an orientation.

use ikcore::math::{Pose, pose as poses};
use ikcore::units::{self, UnitDoubt};
use numpy::{PyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::convert::{self, own, pose_array};
use crate::error::{invalid, raise};
use crate::units::doubt;

/// Makes a pose (4, 4) from a position (3,) (m) and an orientation. The keyword names the form of the orientation.
///
/// Args:
///     position: (3,) (m); None: the origin, or the position of a `matrix` (4, 4).
///     xyzw, wxyz: quaternion (4,), of any nonzero length.
///     rpy: fixed-axis roll, pitch, yaw (rad): Rz(yaw) Ry(pitch) Rx(roll), as in URDF.
///     rotvec: rotation vector (rad).
///     matrix: rotation matrix (3, 3), or a pose (4, 4). Rounded ones are taken, as the nearest rotation: R'R may differ from the
///         identity by 0.002, as that of a matrix of three decimals does.
///     degrees: whether `rpy` and `rotvec` are in degrees.
///
/// Without an orientation the axes are those of the base.
///
/// Raises:
///     InvalidInputError: a matrix that is no rotation, a quaternion of length zero, or several orientations.
///
/// For example:
///
///     >>> bik.pose([0.4, 0.1, 0.3])
///     array([[1. , 0. , 0. , 0.4],
///            [0. , 1. , 0. , 0.1],
///            [0. , 0. , 1. , 0.3],
///            [0. , 0. , 0. , 1. ]])
///     >>> bik.pose([0.4, 0.1, 0.3], rpy=[180, 0, 90], degrees=True)[:3, 2].round(3) + 0.0
///     array([ 0.,  0., -1.])
#[pyfunction]
#[pyo3(
    signature = (position=None, *others, xyzw=None, wxyz=None, rpy=None, rotvec=None, matrix=None, degrees=false, **unknown),
    text_signature = "(position=None, *, xyzw=None, wxyz=None, rpy=None, rotvec=None, matrix=None, degrees=False)"
)]
#[allow(clippy::too_many_arguments)]
pub fn pose<'py>(
    py: Python<'py>,
    position: Option<&Bound<'py, PyAny>>,
    others: &Bound<'py, PyTuple>,
    xyzw: Option<&Bound<'py, PyAny>>,
    wxyz: Option<&Bound<'py, PyAny>>,
    rpy: Option<&Bound<'py, PyAny>>,
    rotvec: Option<&Bound<'py, PyAny>>,
    matrix: Option<&Bound<'py, PyAny>>,
    degrees: bool,
    unknown: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    const FORMS: &str = "xyzw= or wxyz= for a quaternion, rpy=, rotvec= or matrix=";
    if !others.is_empty() {
        return Err(invalid(format!("pose takes an orientation by keyword only, since orders differ: {FORMS}")));
    }
    if let Some(name) = unknown.and_then(|unknown| unknown.keys().iter().next()) {
        return Err(invalid(format!("pose has no argument '{name}'; orientations are {FORMS}")));
    }
    let given: Vec<(&str, &Bound<'py, PyAny>)> =
        [("xyzw", xyzw), ("wxyz", wxyz), ("rpy", rpy), ("rotvec", rotvec), ("matrix", matrix)]
            .into_iter()
            .filter_map(|(name, value)| value.map(|value| (name, value)))
            .collect();
    let place = position.map(|value| finite("position", value)).transpose()?;
    let [x, y, z] = place.unwrap_or_default();
    if degrees && !matches!(given[..], [("rpy" | "rotvec", _)]) {
        return Err(invalid("degrees=True belongs to rpy= or rotvec=: leave it out".into()));
    }
    let quaternion = |xyzw| poses::from_quaternion(xyzw, [x, y, z]).map_err(raise);
    let made: Pose = match given[..] {
        [] if position.is_some() => poses::translation(x, y, z),
        [] => return Err(invalid(format!("pose needs a position (3,) or an orientation: {FORMS}"))),
        [("xyzw", value)] => quaternion(convert::entries("xyzw", value)?)?,
        [("wxyz", value)] => {
            let [w, x, y, z] = convert::entries("wxyz", value)?;
            quaternion([x, y, z, w])?
        }
        [("rpy", value)] => poses::from_rpy(angles("rpy", value, degrees, units::of_rpy)?, [x, y, z]),
        [("rotvec", value)] => {
            poses::from_rotation_vector(angles("rotvec", value, degrees, units::of_rotation_vector)?, [x, y, z])
        }
        [("matrix", value)] => of_matrix(value, place)?,
        _ => {
            let names = given.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
            return Err(invalid(format!("give one description of the orientation, got {names}")));
        }
    };
    Ok(own(pose_array(py, &poses::checked("pose", made).map_err(raise)?)))
}

fn finite(name: &str, value: &Bound<'_, PyAny>) -> PyResult<[f64; 3]> {
    poses::finite(name, convert::point(name, value)?).map_err(raise)
}

/// Reads three angles (rad), or degrees if the caller says so.
fn angles(
    name: &str,
    value: &Bound<'_, PyAny>,
    degrees: bool,
    find: impl Fn(&str, [f64; 3]) -> Option<UnitDoubt>,
) -> PyResult<[f64; 3]> {
    let angles = finite(name, value)?;
    if degrees {
        return Ok(angles.map(f64::to_radians));
    }
    doubt(find(name, angles))?;
    Ok(angles)
}

/// Reads a rotation matrix (3, 3) or a pose (4, 4), whose position is that of the matrix unless `place` is given.
fn of_matrix(value: &Bound<'_, PyAny>, place: Option<[f64; 3]>) -> PyResult<Pose> {
    let numbers = convert::array("matrix", value)?;
    match (numbers.shape(), place) {
        ([4, 4], None) => convert::rigid("matrix", value),
        ([4, 4], Some(_)) => {
            Err(invalid("matrix (4, 4) has a position: leave out position, or give its rotation (3, 3)".into()))
        }
        _ => {
            let matrix = convert::matrix3("matrix", value)?;
            poses::from_rotation_matrix("matrix", matrix, place.unwrap_or_default()).map_err(raise)
        }
    }
}
