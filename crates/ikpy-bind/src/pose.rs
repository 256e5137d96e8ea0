//! `pose`: a 4x4 matrix from a position and an orientation.

use ikcore::math::{Pose, pose as poses};
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::convert::{self, pose_array};
use crate::error::{invalid, raise};

/// Makes a pose (4, 4) from a position (3,) (m) and an orientation. The keyword names the form of the orientation.
///
/// Args:
///     position: (3,) (m).
///     xyzw, wxyz: quaternion (4,), of any nonzero length.
///     rpy: fixed-axis roll, pitch, yaw (rad): Rz(yaw) Ry(pitch) Rx(roll), as in URDF.
///     rotvec: rotation vector (rad).
///     matrix: rotation matrix (3, 3).
///
/// Without an orientation the axes are those of the base.
///
/// For example:
///
///     >>> bik.pose([0.4, 0.1, 0.3])
///     array([[1. , 0. , 0. , 0.4],
///            [0. , 1. , 0. , 0.1],
///            [0. , 0. , 1. , 0.3],
///            [0. , 0. , 0. , 1. ]])
#[pyfunction]
#[pyo3(
    signature = (position, *others, xyzw=None, wxyz=None, rpy=None, rotvec=None, matrix=None, **unknown),
    text_signature = "(position, *, xyzw=None, wxyz=None, rpy=None, rotvec=None, matrix=None)"
)]
#[allow(clippy::too_many_arguments)]
pub fn pose<'py>(
    position: &Bound<'py, PyAny>,
    others: &Bound<'py, PyTuple>,
    xyzw: Option<&Bound<'py, PyAny>>,
    wxyz: Option<&Bound<'py, PyAny>>,
    rpy: Option<&Bound<'py, PyAny>>,
    rotvec: Option<&Bound<'py, PyAny>>,
    matrix: Option<&Bound<'py, PyAny>>,
    unknown: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    const FORMS: &str = "xyzw= or wxyz= for a quaternion, rpy=, rotvec= or matrix=";
    if !others.is_empty() {
        return Err(invalid(format!("pose takes an orientation by keyword only, since orders differ: {FORMS}")));
    }
    if let Some(name) = unknown.and_then(|unknown| unknown.keys().iter().next()) {
        return Err(invalid(format!("pose has no argument '{name}'; orientations are {FORMS}")));
    }
    let finite = |name: &str, value| poses::finite(name, convert::point(name, value)?).map_err(raise);
    let position_xyz = finite("position", position)?;
    let given: Vec<(&str, &Bound<'py, PyAny>)> =
        [("xyzw", xyzw), ("wxyz", wxyz), ("rpy", rpy), ("rotvec", rotvec), ("matrix", matrix)]
            .into_iter()
            .filter_map(|(name, value)| value.map(|value| (name, value)))
            .collect();
    let made: Pose = match given[..] {
        [] => poses::translation(position_xyz[0], position_xyz[1], position_xyz[2]),
        [("xyzw", value)] => {
            let [x, y, z, w] = convert::entries("xyzw", value)?;
            poses::from_quaternion([x, y, z, w], position_xyz).map_err(raise)?
        }
        [("wxyz", value)] => {
            let [w, x, y, z] = convert::entries("wxyz", value)?;
            poses::from_quaternion([x, y, z, w], position_xyz).map_err(raise)?
        }
        [("rpy", value)] => poses::from_rpy(finite("rpy", value)?, position_xyz),
        [("rotvec", value)] => poses::from_rotation_vector(finite("rotvec", value)?, position_xyz),
        [("matrix", value)] => {
            poses::from_rotation_matrix("matrix", convert::matrix3("matrix", value)?, position_xyz).map_err(raise)?
        }
        _ => {
            let names = given.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
            return Err(invalid(format!("give one description of the orientation, got {names}")));
        }
    };
    pose_array(position.py(), &poses::checked("pose", made).map_err(raise)?)
}
