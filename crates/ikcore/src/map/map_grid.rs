//! Poses of a map: voxels, and the orientations at the centre of each.

use serde::{Deserialize, Serialize};

use super::map_options::MapOptions;
use super::orientation_set::{OrientationSet, turned};
use super::voxel_grid::VoxelGrid;
use crate::error::{Error, Result, require_finite, require_positive};
use crate::kinematics::Reach;
use crate::math::Frame;
use crate::math::vector3::direction;
use crate::message::{Setting, message};
use crate::robot::Robot;
use crate::task::{Task, TaskKind};
use crate::wording::number;

/// Largest number of orientations of a voxel.
const MOST_ORIENTATIONS: usize = 1 << 20;

/// Largest deviation of the entries of a normal along an axis.
const ALONG: f64 = 1e-9;

/// Extent and resolution of a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapLayout {
    /// Edge of the voxels (m).
    pub voxel: f64,
    /// Number of directions of the axis of the tip.
    pub directions: usize,
    /// Number of rolls about each direction.
    pub rolls: usize,
    /// Opposite corners of a box (m), which is extended to whole voxels. `None` means the reach of the tip.
    pub region: Option<[[f64; 3]; 2]>,
}

/// Poses of a map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MapGrid {
    voxels: VoxelGrid,
    orientations: OrientationSet,
    /// Whether azimuths differ only by the limits of the first joint.
    azimuths_alike: bool,
}

impl MapGrid {
    /// Grid of poses for a map of `robot` with these options.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] or [`Error::NotFinite`] for a wrong layout; [`Error::Contradiction`] for a task that maps do not
    /// support, a tip that moves in too few directions, and without a region, a tip with infinite reach.
    pub fn new(robot: &Robot, layout: &MapLayout, options: &MapOptions) -> Result<Self> {
        robot.require_one_tip("reachability")?;
        options.validate()?;
        layout.validate()?;
        let with_tool = options.task.map_or(Ok(None), |task| task.robot(robot))?;
        let robot = with_tool.as_ref().unwrap_or(robot);
        let axis = robot.upright_axis();
        let (lower, upper): (Vec<f64>, Vec<f64>) =
            robot.joints().iter().map(|joint| (joint.lower, joint.upper)).unzip();
        let reach = robot.reach(&lower, &upper);
        let orientations = orientations(robot, &reach, layout, options.task.as_ref())?;
        let [x, y] = axis.map_or([0.0; 2], |axis| axis.point);
        let mut anchor = [x, y, 0.0];
        let plane = reach.normal.map(|normal| plane_of(robot, normal)).transpose()?;
        if let Some(k) = plane {
            // The plane is in the middle of a layer of voxels.
            anchor[k] = reach.center[k] - 0.5 * layout.voxel;
        }
        let corners = match layout.region {
            Some([a, b]) => [std::array::from_fn(|k| a[k].min(b[k])), std::array::from_fn(|k| a[k].max(b[k]))],
            None if reach.radius.is_finite() => [-1.0, 1.0].map(|side: f64| {
                std::array::from_fn(|k| reach.center[k] + if plane == Some(k) { 0.0 } else { side * reach.radius })
            }),
            None => {
                let problem = message!["a joint slides without limits, so the map needs ", Setting::Region];
                return Err(Error::Contradiction { problem });
            }
        };
        let azimuths_alike = axis.is_some() && options.treat_azimuths_alike();
        let voxels = VoxelGrid::new(corners, layout.voxel, anchor, [axis.is_some(), azimuths_alike])?;
        Ok(Self { voxels, orientations, azimuths_alike })
    }

    /// Voxels of the map.
    pub fn voxels(&self) -> &VoxelGrid {
        &self.voxels
    }

    /// Orientations at each voxel.
    pub fn orientations(&self) -> &OrientationSet {
        &self.orientations
    }

    pub(super) fn treats_azimuths_alike(&self) -> bool {
        self.azimuths_alike
    }

    /// Number of bytes for the bits of one voxel.
    pub fn bytes(&self) -> usize {
        self.orientations.count().div_ceil(8)
    }

    /// Pose of orientation `i` at `point` (m), rotated to `azimuth` (rad) about z.
    pub fn pose(&self, point: [f64; 3], azimuth: f64, i: usize) -> Frame {
        Frame { axes: turned(&self.orientations.axes(i), azimuth), origin: point }
    }

    /// Returns the voxel that contains a pose, and the nearest orientation there; `None` outside the map.
    pub fn locate(&self, pose: &Frame) -> Option<([usize; 3], usize)> {
        let voxel = self.voxels.voxel_at(&pose.origin)?;
        let turned_back = turned(&pose.axes, -self.voxels.azimuth(voxel));
        Some((voxel, self.orientations.nearest(&turned_back)?))
    }
}

impl MapLayout {
    fn validate(&self) -> Result<()> {
        let Self { voxel, directions, rolls, region } = self;
        require_positive("voxel", *voxel)?;
        for (what, count) in [("directions", *directions), ("rolls", *rolls)] {
            if !(1..=MOST_ORIENTATIONS).contains(&count) {
                return Err(Error::out_of_range(what, "from 1 to 1048576", count as f64));
            }
        }
        if directions.saturating_mul(*rolls) > MOST_ORIENTATIONS {
            let count = directions.saturating_mul(*rolls) as f64;
            return Err(Error::out_of_range("directions times rolls", "at most 1048576", count));
        }
        let corners = region.iter().flatten().flatten().copied().collect::<Vec<f64>>();
        require_finite("region", &corners, |i| format!("entry {} of corner {}", i % 3, i / 3))
    }
}

/// Orientations that the tip of `robot` can have almost anywhere.
fn orientations(robot: &Robot, reach: &Reach, layout: &MapLayout, task: Option<&Task>) -> Result<OrientationSet> {
    let rank = robot.task_rank();
    let plane = usize::from(reach.normal.is_some());
    let kind = task.map_or(TaskKind::Pose, |task| task.kind);
    let (moves, needs, set) = match (kind, reach.fixed_direction) {
        (TaskKind::Position, _) => (rank.position, 3 - plane, OrientationSet::single()),
        (TaskKind::Pointing { axis }, _) => {
            (rank.pose, 5, OrientationSet::spread(layout.directions, 1, direction(&axis)))
        }
        (_, Some(fixed)) => (rank.pose, 4 - plane, OrientationSet::fixed(layout.rolls, fixed.base, fixed.tip)),
        (_, None) => (rank.pose, 6, OrientationSet::spread(layout.directions, layout.rolls, [0.0, 0.0, 1.0])),
    };
    if moves >= needs {
        return Ok(set);
    }
    let name = robot.name();
    let less = Setting::MapTask { pointing: moves >= 5 };
    let remedy = if matches!(kind, TaskKind::Position) { "it has no map".into() } else { message!["give ", less] };
    let problem = format!(
        "the tip of robot '{name}' moves in {moves} directions, and a map of task {} needs {needs}, as it reaches hardly \
         any voxel's centre otherwise: ",
        kind.name()
    );
    let problem = message![problem, remedy];
    Err(Error::Contradiction { problem })
}

/// Axis parallel to `normal`.
fn plane_of(robot: &Robot, normal: [f64; 3]) -> Result<usize> {
    (0..3).find(|k| normal[*k].abs() > 1.0 - ALONG).ok_or_else(|| {
        let name = robot.name();
        let [x, y, z] = normal.map(number);
        let problem = format!(
            "the tip of robot '{name}' moves in a plane across ({x}, {y}, {z}), in which no layer of voxels lies: turn its \
             base by with_base"
        );
        Error::Contradiction { problem: problem.into() }
    })
}
