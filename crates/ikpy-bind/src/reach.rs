//! `MapGrid` and `map_chunks`: poses and computation of reachability maps.

use ikcore::batch;
use ikcore::interrupt::checkpoint_at;
use ikcore::map::{self, MapLayout, MapOptions};
use ikcore::math::{Frame, Pose, pose};
use ikcore::stored::{from_bytes, to_bytes};
use numpy::{PyArray1, PyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::convert::{
    Numbers, array, copied, corners, count, counted, optional_count, own, rigid_matrices, shape_text, summary, table,
};
use crate::error::{invalid, raise};
use crate::monitor::{long_call, watched};
use crate::obstacle::read_surroundings;
use crate::pickling::{self, Reduced};
use crate::robot::PyRobot;
use crate::task::read_task;

/// Poses of a reachability map: cubic voxels, and orientations at the centre of each, numbered from 0.
///
/// `axis` is None, or the point (2,) (m) of a vertical axis; orientations then turn with the azimuth of the voxel about
/// this axis.
#[pyclass(name = "MapGrid", module = "beetle_ik._core", frozen, eq)]
#[derive(PartialEq)]
pub struct PyMapGrid {
    core: map::MapGrid,
}

#[pymethods]
impl PyMapGrid {
    /// Makes the grid of a map of `robot`; arguments as for `reachability` and `map_chunks`.
    #[new]
    #[pyo3(signature = (robot, *, voxel, directions, rolls, region=None, task=None, obstacles=None, margin=None, self_collision=None))]
    #[allow(clippy::too_many_arguments)]
    fn new(
        robot: &PyRobot,
        voxel: f64,
        directions: i128,
        rolls: i128,
        region: Option<&Bound<'_, PyAny>>,
        task: Option<&Bound<'_, PyAny>>,
        obstacles: Option<&Bound<'_, PyAny>>,
        margin: Option<f64>,
        self_collision: Option<bool>,
    ) -> PyResult<Self> {
        let layout = MapLayout {
            voxel,
            directions: count("directions", directions)?,
            rolls: count("rolls", rolls)?,
            region: region.map(|region| corners("region", region)).transpose()?,
        };
        let surroundings = read_surroundings(robot, obstacles, margin, self_collision)?;
        let options = MapOptions { task: read_task(task)?, surroundings, ..MapOptions::default() };
        Ok(Self { core: map::MapGrid::new(&robot.core, &layout, &options).map_err(raise)? })
    }

    /// The lower corner (3,) (m).
    #[getter]
    fn origin<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        copied(py, &self.core.voxels().origin())
    }

    /// Edge of a voxel (m).
    #[getter]
    fn voxel(&self) -> f64 {
        self.core.voxels().voxel()
    }

    /// Number of voxels along x, y and z.
    #[getter]
    fn shape(&self) -> [usize; 3] {
        self.core.voxels().shape()
    }

    /// Point (2,) (m) of the vertical axis about which orientations turn with the azimuth of the voxel; None without
    /// one.
    #[getter]
    fn axis<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.core.voxels().axis().map(|axis| copied(py, &axis))
    }

    /// Number of orientations of each voxel.
    #[getter]
    fn orientations(&self) -> usize {
        self.core.orientations().count()
    }

    /// Number of rolls of each direction.
    #[getter]
    fn rolls(&self) -> usize {
        self.core.orientations().rolls()
    }

    /// Number of bytes that hold a bit for each orientation of a voxel.
    #[getter]
    fn bytes(&self) -> usize {
        self.core.bytes()
    }

    /// Largest shape of a chunk; chunks at the upper ends may be smaller.
    #[getter]
    fn chunk_shape(&self) -> [usize; 3] {
        self.core.voxels().chunk_shape()
    }

    /// Number of chunks along x, y and z.
    #[getter]
    fn chunks(&self) -> [usize; 3] {
        self.core.voxels().chunks()
    }

    /// Returns the first voxel of chunk `number` and the one after its last, along x, y and z. Chunk numbers increase
    /// along z first.
    fn chunk(&self, number: i128) -> PyResult<[[usize; 2]; 3]> {
        self.core.voxels().chunk(count("number", number)?).map_err(raise)
    }

    /// Returns the poses (orientations, 4, 4) of the voxel (x, y, z).
    fn poses<'py>(&self, py: Python<'py>, voxel: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let voxels = self.core.voxels();
        let shape = voxels.shape();
        let given: Option<[usize; 3]> = voxel.extract().ok();
        let Some(voxel) = given.filter(|voxel| (0..3).all(|k| voxel[k] < shape[k])) else {
            let within = shape_text(&shape);
            return Err(invalid(format!(
                "voxel must be three whole numbers within shape {within}, got {}",
                summary(voxel)
            )));
        };
        let (place, azimuth) = (voxels.centre(voxel), voxels.azimuth(voxel));
        let count = self.core.orientations().count();
        let poses = (0..count).flat_map(|i| rows(&self.core.pose(place, azimuth, i)));
        table(py, poses.collect(), &[count, 4, 4]).map(own)
    }

    /// Returns the voxel and the nearest orientation of a pose (4, 4), or of each pose (n, 4, 4), as rows (x, y, z,
    /// orientation): (n, 4), with n = 1 for a single pose; -1 outside the map.
    #[allow(non_snake_case)]
    fn locate<'py>(&self, py: Python<'py>, T: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<i64>>> {
        let numbers = read_poses("T", T)?;
        let poses = rigid_matrices(numbers.as_slice()?)?;
        let found = long_call(py, || {
            let mut found = Vec::with_capacity(4 * poses.len());
            for (row, pose) in poses.iter().enumerate() {
                checkpoint_at(row)?;
                found.extend(match self.core.locate(&Frame::from(pose)) {
                    Some(([x, y, z], orientation)) => [x, y, z, orientation].map(|number| number as i64),
                    None => [-1; 4],
                });
            }
            Ok(found)
        })?;
        table(py, found, &[poses.len(), 4]).map(own)
    }

    fn __repr__(&self) -> String {
        let shape = shape_text(&self.core.voxels().shape());
        let orientations = counted(self.core.orientations().count(), "orientation");
        format!("<MapGrid: {shape} voxels of {} m, {orientations}>", self.voxel())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        pickling::restored_from::<Self>(py, (pickling::bytes(py, to_bytes("grid of a map", &self.core))?,))
    }

    /// Restores a pickled value.
    #[staticmethod]
    fn _restore(bytes: &[u8]) -> PyResult<Self> {
        Ok(Self { core: from_bytes("grid of a map", bytes).map_err(raise)? })
    }
}

/// Returns the row-major matrix of a frame.
fn rows(frame: &Frame) -> [f64; 16] {
    pose::rows(&Pose::from(*frame))
}

/// Reads poses (n, 4, 4).
fn read_poses<'py>(what: &str, value: &Bound<'py, PyAny>) -> PyResult<Numbers<'py>> {
    let numbers = array(what, value)?;
    match numbers.shape() {
        [4, 4] | [_, 4, 4] => Ok(numbers),
        shape => Err(invalid(format!("{what}: expected shape (4, 4) or (n, 4, 4), got {}", shape_text(shape)))),
    }
}

/// Results of a chunk: bits (x, y, z, bytes), and manipulability and clearance (x, y, z) or None.
type ChunkArrays<'py> =
    (Bound<'py, PyArrayDyn<u8>>, Option<Bound<'py, PyArrayDyn<f32>>>, Option<Bound<'py, PyArrayDyn<f32>>>);

/// Computes chunks of the reachability map of a robot. The bits of a chunk depend neither on the other chunks nor on
/// the number of threads.
///
/// Args:
///     robot, grid: the robot, and the poses of its map.
///     chunks: numbers of chunks.
///     task, obstacles, margin, self_collision, evaluations, quality, threads, progress: as for `reachability`. The
///         first four must be those of the grid.
///
/// Returns:
///     (reached, manipulability, clearance) for each chunk: (x, y, z, grid.bytes) uint8, a bit for each orientation,
///     the lowest first; then two arrays (x, y, z) float32 for the best configuration found, NaN where there is none,
///     or None without `quality`.
#[pyfunction]
#[pyo3(signature = (robot, grid, chunks, *, task=None, obstacles=None, margin=None, self_collision=None, evaluations=200, quality=false,
                    threads=None, progress=None))]
#[allow(clippy::too_many_arguments)]
pub fn map_chunks<'py>(
    py: Python<'py>,
    robot: &PyRobot,
    grid: &PyMapGrid,
    chunks: Vec<i128>,
    task: Option<&Bound<'_, PyAny>>,
    obstacles: Option<&Bound<'_, PyAny>>,
    margin: Option<f64>,
    self_collision: Option<bool>,
    evaluations: i128,
    quality: bool,
    threads: Option<i128>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<ChunkArrays<'py>>> {
    let chunks = chunks.into_iter().map(|number| count("chunks", number)).collect::<PyResult<Vec<usize>>>()?;
    let options = MapOptions {
        task: read_task(task)?,
        surroundings: read_surroundings(robot, obstacles, margin, self_collision)?,
        evaluations: count("evaluations", evaluations)?,
        quality,
    };
    let threads = optional_count("threads", threads)?;
    let (robot, grid) = (&*robot.core, &grid.core);
    let computed =
        watched(py, progress, |watcher| batch::map_chunks(robot, grid, &chunks, &options, threads, watcher))?;
    let arrays = |chunk: map::MapChunk| -> PyResult<ChunkArrays<'py>> {
        let [x, y, z] = chunk.shape;
        let measured = |values: Vec<f32>| quality.then(|| table(py, values, &[x, y, z])).transpose();
        let reached = table(py, chunk.reached, &[x, y, z, grid.bytes()])?;
        Ok((reached, measured(chunk.manipulability)?, measured(chunk.clearance)?))
    };
    computed.into_iter().map(arrays).collect()
}
