"""Every error that a docstring promises under `Raises:` has a row here: a call that raises it, and the exact message."""
# ruff: noqa: ARG005, E501 -- a row is a line, and not every call asks where it is made

import importlib
import inspect
import re
import sys
import types
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mistakes import Invalid, Limit, Unknown, Urdf
from pair_of_pandas import pair_of_pandas

import beetle_ik as bik

CORPUS = Path(__file__).parents[1] / "corpus"
Missing, Unsupported, Infeasible = bik.BeetleIkError, bik.UnsupportedLimit, bik.InfeasibleError
api: Any = bik  # wrong calls on purpose

LINK = '<link name="{}"/>'
JOINT = (
    '<joint name="{}" type="revolute"><parent link="{}"/><child link="{}"/>'
    '<limit lower="-1" upper="1" velocity="1" effort="1"/>{}</joint>'
)


def urdf(name: str, links: list[str], *joints: tuple[str, ...]) -> str:
    """A robot of these links, or texts of links, and joints: name, parent, child and what else."""
    parts = [link if "<" in link else LINK.format(link) for link in links]
    return f'<robot name="{name}">{"".join(parts + [JOINT.format(*joint) for joint in joints])}</robot>'


FORK = urdf("fork", ["base", "left", "right"], ("l", "base", "left", ""), ("r", "base", "right", ""))
MESH = '<link name="b"><collision><geometry><mesh filename="m.stl"/></geometry></collision></link>'
MJCF = """<mujoco><worldbody><body name="arm"><joint name="j" type="hinge"/><geom size="0.1"/></body></worldbody>
</mujoco>"""
OTHERS_SRDF = '<robot name="ur5"><disable_collisions link1="shoulder_link" link2="base_link"/></robot>'

PANDA, UR5, PLANAR = bik.Robot.named("panda"), bik.Robot.named("ur5e"), bik.Robot.planar([0.5, 0.4, 0.3])
PAIR = bik.Robot.from_urdf(pair_of_pandas(), tip=["left_tool", "right_tool"])
THICK, BARE = PANDA.with_capsules(radius=0.05), bik.Robot.named("iiwa14")
HELD = bik.Robot.from_urdf(
    urdf("held", ["base", "arm", "flap"], ("j", "base", "arm", ""), ("side", "base", "flap", "")), tip="arm"
)
MIMIC = bik.Robot.from_urdf(
    urdf("twin", ["base", "arm", "hand"], ("j", "base", "arm", ""), ("k", "arm", "hand", '<mimic joint="j"/>'))
)
Q = np.array([0.0, -0.5, 0.0, -2.0, 0.0, 1.5, 0.8])
UR5_Q = np.array([0.3, -1.2, 1.4, -0.8, -1.1, 0.5])
MEASURED_Q = UR5.random_configurations(40, seed=1)
MEASURED = UR5.fk(MEASURED_Q)[:, :3, 3]
ONE_Q = HELD.random_configurations(10, seed=1)
CALIBRATED = bik.calibrate(HELD, ONE_Q, HELD.fk(ONE_Q))
HERE = UR5.fk(UR5_Q)


def raised(height: float) -> np.ndarray:
    """The pose of the UR5e's tip, this much higher (m)."""
    pose = HERE.copy()
    pose[2, 3] += height
    return pose


LINE_UP = api.moves.Line(raised(0.1))
BEYOND, EDGE, ONWARD = Q + 9.5 * np.eye(7)[1], Q + 2.89 * np.eye(7)[0], np.eye(7)[0]
BALL = bik.obstacles.Sphere((2.0, 0.0, 0.0), 0.1)
RATED = bik.Limits(velocity=1.0, acceleration=2.0)
JERKY = bik.Limits(velocity=1.0, acceleration=2.0, jerk=10.0)
VARYING = bik.Limits(velocity=bik.Sinusoid(mean=1.0, amplitude=0.5, angular_frequency=1.0), acceleration=2.0)
SWELLING = bik.Limits(upper=bik.Sinusoid(mean=2.8, amplitude=0.1, angular_frequency=1.0), velocity=1.0)
CROSSED = bik.Limits(lower=1.0, upper=-1.0, velocity=1.0, acceleration=2.0)
WIDE = bik.Limits(lower=-50.0, upper=50.0)
WITHIN = bik.tasks.Position(region=((0.2, -0.3, 0.3), (0.6, 0.3, 0.7)))
REGION = ((-0.5, -0.5, 0.0), (0.5, 0.5, 0.0))
SLAB = bik.obstacles.Box((0, 0, 0), (0.4, 0.4, 0.2))
LINE, LINE_XY = [[0.4, 0.0, 0.5], [0.4, 0.1, 0.5]], [[0.8, 0.1, 0.0], [0.7, 0.3, 0.0]]
CIRCLE = bik.paths.circle(center=(0.4, 0.0, 0.5), diameter=0.1, duration=1.0)
MOTION = bik.Trajectory.from_samples([0.0, 1.0], np.array([Q, Q + 0.1]))
PLAN = bik.plan_point_to_point(PANDA, start_q=Q, end_q=Q + 0.1, limits=RATED)

NO_MASS = "robot 'ur5e' has no dynamics: no link has a mass: give them by robot.with_inertias({link: Inertia(link, mass, center, matrix)})"
NO_CAPSULES = (
    'has no capsules, so that nothing is known of the room it takes up: load its URDF with collision="fit", or give it '
    "capsules with with_capsules(radius=...) along its links or with_capsules([(link, a, b, radius), ...])"
)
FAR_OUTSIDE = "outside its limits [-1.7628, 1.7628] by 7.237 rad: move it inside; angles are in radians, and np.radians converts degrees"


def half_square(x: np.ndarray) -> float:
    return float(x @ x) / 2.0


def model_free(start: np.ndarray, **options: object) -> object:
    given: dict[str, Any] = {"dt": 0.1, "controller": bik.papers.ZNNBAS(), **options}
    return bik.track_model_free(bik.KinematicPlant(PANDA), CIRCLE, start, **given)


class Place:
    """Where a call is made: a folder of its own, and libraries that are there or not."""

    def __init__(self, folder: Path, patch: pytest.MonkeyPatch, viewers: list[bik.Viewer]) -> None:
        self.folder, self._patch, self._viewers = folder, patch, viewers

    def value(self, value: Any) -> Any:
        return value

    def path(self, name: str) -> Path:
        return self.folder / name

    def file(self, name: str, text: str) -> Path:
        self.path(name).write_text(text)
        return self.path(name)

    def without(self, library: str) -> "Place":
        self._patch.setitem(sys.modules, library, None)
        return self

    def needs(self, library: str) -> "Place":
        pytest.importorskip(library)
        return self

    def full(self) -> "Place":
        """A disk that takes no chunks."""

        def refuse(*_: object, **__: object) -> None:
            raise OSError(28, "No space left on device")

        self._patch.setattr(importlib.import_module("beetle_ik.chunked.store").Store, "write", refuse)
        return self

    def map(self) -> bik.ReachabilityMap:
        return bik.reachability(UR5, voxel=0.6, directions=4, rolls=1)

    def viewer(self, **values: object) -> bik.Viewer:
        self.needs("viser")
        if not self._viewers:
            self._viewers.append(bik.view(PANDA, Q, port=0))
        for name, value in values.items():
            setattr(self._viewers[0], name, value)
        return self._viewers[0]

    def robot_of_a_lost_mesh(self) -> bik.Robot:
        self.path("m.stl").write_bytes((CORPUS / "mesh" / "tetrahedron.stl").read_bytes())
        robot = bik.Robot.from_urdf(self.file("r.urdf", urdf("r", ["a", MESH], ("j", "a", "b", ""))))
        self.path("m.stl").unlink()
        return robot


Row = tuple[str, type[Exception], Callable[[Place], object], str]
ROWS: list[Row] = [
    ("ReachabilityMap.load", Invalid, lambda at: api.ReachabilityMap.load(at.file("map.npz", "no map")), '{folder}/map.npz: not an npz file'),
    ("ReachabilityMap.load", Invalid, lambda at: api.ReachabilityMap.load(CORPUS / "map" / "map.npz", robot=PANDA), "{corpus}/map/map.npz: the map is of robot 'dh', not of 'panda'"),
    ("Robot.collision_meshes", Invalid, lambda at: at.robot_of_a_lost_mesh().collision_meshes(), "cannot read '{folder}/m.stl': No such file or directory (os error 2)"),
    ("Robot.from_urdf", Urdf, lambda at: api.Robot.from_urdf("<robot"), 'URDF line 1: not XML: the document does not have a root node'),
    ("Robot.from_urdf", Urdf, lambda at: api.Robot.from_urdf('<robot name="r"><link name="a"/></robot>'), 'URDF line 1: <robot> has no <joint>: a chain needs at least one that moves'),
    ("Robot.from_urdf", Urdf, lambda at: api.Robot.from_urdf(FORK), "robot 'fork' ends in 2 links: say which one is the tip; leaves, by number of joints: left (1), right (1)"),
    ("Robot.from_urdf", Unknown, lambda at: api.Robot.from_urdf(FORK, tip="lefd"), "robot 'fork' has no link 'lefd' (did you mean 'left'?); its links: base, left, right"),
    ("Robot.from_mjcf", Missing, lambda at: api.Robot.from_mjcf(at.without("mujoco").file("a.xml", MJCF)), "a MuJoCo model needs mujoco: pip install 'beetle-ik[sim]'"),
    ("Robot.from_mjcf", Unknown, lambda at: api.Robot.from_mjcf(at.needs("mujoco").file("a.xml", MJCF), tip="hnd"), "no body or site 'hnd' in the MuJoCo model; bodies: world, arm"),
    ("Robot.from_mjcf", Invalid, lambda at: api.Robot.from_mjcf(at.needs("mujoco").file("a.xml", MJCF.replace("hinge", "ball"))), "MuJoCo model: joint 'j' is spherical, and a chain takes only revolute, continuous, prismatic, fixed and mimic joints: take base and tip on one side of it, a base from 'arm' on or a tip up to 'world'"),
    ("Robot.from_description", Missing, lambda at: api.Robot.from_description(at.without("robot_descriptions").value("ur5_description")), "the robot named 'ur5_description' needs robot_descriptions: pip install 'beetle-ik[robots]'"),
    ("Robot.from_description", Unknown, lambda at: api.Robot.from_description(at.needs("robot_descriptions").value("pnda_description")), "robot_descriptions has no robot named 'pnda_description'; did you mean panda_description or panda_mj_description or luna_description?"),
    ("Robot.named", Unknown, lambda at: api.Robot.named("pnda"), "no robot is named 'pnda' (did you mean 'panda'?); known robots: fr3, gen3, hydraulic3, iiwa14, iiwa7, kr210, kr210_yuan2016, panda, planar5, ur10, ur10e, ur3e, ur5, ur5e"),
    ("Robot.fk", Unknown, lambda at: PANDA.fk(Q, link="hnd"), "robot 'panda' has no link 'hnd'; its links: base, link_1, link_2, link_3, link_4, link_5, link_6, link_7, flange"),
    ("Robot.jacobian", Unknown, lambda at: PANDA.jacobian(Q, link="hnd"), "robot 'panda' has no link 'hnd'; its links: base, link_1, link_2, link_3, link_4, link_5, link_6, link_7, flange"),
    ("Robot.wrap", Limit, lambda at: PANDA.wrap([0.0, 0.0, 0.0, 0.5, 0.0, 1.0, 0.0]), "q: joint 'panda_joint4' at 0.5 is outside its limits [-3.0718, -0.0698] by 0.5698 rad: no whole turn brings it inside, the nearest is 0.5698 rad beyond; robot.clip(q) moves it to the limit, which changes the pose"),
    ("Robot.q_from", Unknown, lambda at: UR5.q_from({"elbow": 1.0}), f"robot 'ur5e' has no joint 'elbow' in q (did you mean 'elbow_joint'?); its joints: {', '.join(UR5.joint_names)}; ignore_extra=True leaves out values of other joints"),
    ("Robot.q_from", Invalid, lambda at: UR5.q_from(UR5.joint_names, [0.0]), "values: expected shape (6,) or (m, 6), one per name, got (1,)"),
    ("Inertia", Invalid, lambda at: api.Inertia("hand", -1.0), "inertia of link 'hand': the mass is -1 kg: it cannot be negative"),
    ("Robot.with_inertias", Unknown, lambda at: PANDA.with_inertias([api.Inertia("hnd", 1.0)]), "robot 'panda' has no link 'hnd'; its links: base, link_1, link_2, link_3, link_4, link_5, link_6, link_7, flange"),
    ("Robot.with_payload", Unknown, lambda at: PANDA.with_payload(1.0, link="hnd"), "robot 'panda' has no link 'hnd'; its links: base, link_1, link_2, link_3, link_4, link_5, link_6, link_7, flange"),
    ("Robot.with_payload", Invalid, lambda at: PANDA.with_payload(-1.0), "payload: the mass is -1 kg: it cannot be negative"),
    ("Robot.torques", Invalid, lambda at: UR5.torques(UR5_Q), NO_MASS),
    ("Robot.mass_matrix", Invalid, lambda at: UR5.mass_matrix(UR5_Q), NO_MASS),
    ("Robot.accelerations", Invalid, lambda at: UR5.accelerations(UR5_Q, UR5_Q, UR5_Q), NO_MASS),
    ("Robot.center_of_mass", Invalid, lambda at: UR5.center_of_mass(UR5_Q), NO_MASS),
    ("Trajectory.torques", Invalid, lambda at: MOTION.torques(UR5, 0.5), "robot 'ur5e' has 6 joints, and the trajectory 7 joints"),
    ("Plan.torques", Invalid, lambda at: bik.plan_point_to_point(UR5, start_q=UR5_Q, end_q=UR5_Q + 0.1, limits=RATED).torques(0.1), NO_MASS),
    ("Robot.with_held", Unknown, lambda at: HELD.with_held({"finger_joint1": 0.0}), "robot 'held' holds no joint 'finger_joint1'; joints that it holds: side"),
    ("Robot.with_held", Limit, lambda at: HELD.with_held({"side": 2.0}), "hold: joint 'side' at 2 is outside its limits [-1, 1] by 1.000 rad: move it inside"),
    ("Robot.with_attached", Unknown, lambda at: PANDA.with_attached("hnd", BALL), "robot 'panda' has no link 'hnd'; its links: base, link_1, link_2, link_3, link_4, link_5, link_6, link_7, flange"),
    ("Robot.with_collision_pairs", Unknown, lambda at: THICK.with_collision_pairs([("hnd", "link_1")]), "robot 'panda' has no link 'hnd'; its links: base, link_1, link_2, link_3, link_4, link_5, link_6, link_7, flange"),
    ("Robot.with_capsules", Unknown, lambda at: PANDA.with_capsules([("hnd", (0, 0, 0), (0, 0, 0.1), 0.05)]), "robot 'panda' has no link 'hnd'; its links: base, link_1, link_2, link_3, link_4, link_5, link_6, link_7, flange"),
    ("Robot.with_srdf", Urdf, lambda at: PANDA.with_srdf("<srdf/>"), 'SRDF line 1: the outermost element must be <robot>, found <srdf>'),
    ("Robot.with_srdf", Urdf, lambda at: PANDA.with_srdf(OTHERS_SRDF), "SRDF: it is for another robot: 'panda' has no link 'shoulder_link' and none of the pairs that it disables; its links: base, link_1, link_2, link_3, link_4, link_5, link_6, link_7, flange"),
    ("Scene", Invalid, lambda at: api.Scene([BALL, 1]), 'obstacle 1 must be made by bik.obstacles, such as Sphere or Box, got 1'),
    ("Scene", Invalid, lambda at: api.Scene(attached=[("hand", BALL)]), "attached 0 must be (link, shape, touch, name), got ('hand', obstacles.Sphere([2.0, 0.0, 0.0], 0.1))"),
    ("Scene.attach_to", Invalid, lambda at: api.Scene(attached=[("hnd", BALL, (), "part")]).attach_to(THICK), "attached object 'part': robot 'panda' has no link 'hnd'; its links: base, link_1, link_2, link_3, link_4, link_5, link_6, link_7, flange"),
    ("Scene.from_octomap", Invalid, lambda at: api.Scene.from_octomap(at.file("map.bt", "x")), "{folder}/map.bt: line 1: expected \"# Octomap OcTree binary file\" or \"# Octomap OcTree file\", got 'x': this is no .bt or .ot file"),
    ("obstacles.PointCloud.without_robot", Invalid, lambda at: api.obstacles.PointCloud([(0, 0, 0)], 0.1).without_robot(PANDA, Q), f"robot 'panda' {NO_CAPSULES}"),
    ("obstacles.PointCloud.without_robot", Invalid, lambda at: api.obstacles.PointCloud([(0, 0, 0)], 0.1).without_robot(THICK, Q[:6]), "joint angles of robot 'panda': expected 7 joints, got 6"),
    ("obstacles.Grid.without_robot", Invalid, lambda at: api.obstacles.Grid((0, 0, 0), 0.1, np.ones((1, 1, 1), bool)).without_robot(THICK, Q, padding=-1.0), 'padding must be zero or more and finite, got -1'),
    ("Scene.load", Invalid, lambda at: api.Scene.load(at.path("none.json")), "cannot read '{folder}/none.json': No such file or directory"),
    ("Scene.from_octomap", Invalid, lambda at: api.Scene.from_octomap(at.path("none.bt")), "cannot read '{folder}/none.bt': No such file or directory"),
    ("Scene.from_moveit", Invalid, lambda at: api.Scene.from_moveit(at.path("none.scene")), "cannot read '{folder}/none.scene': No such file or directory"),
    ("Scene.load", Invalid, lambda at: api.Scene.load(at.file("scene.json", "{}")), '{folder}/scene.json: expected a list of shapes, or an object with such a list as "obstacles"'),
    ("Scene.load", Invalid, lambda at: api.Scene.load(at.file("scene.json", '[{"type": "sphere"}]')), "{folder}/scene.json: obstacle 0 (sphere): the key 'center' is missing; keys: center, radius, touch"),
    ("Scene.from_moveit", Invalid, lambda at: api.Scene.from_moveit(at.needs("yaml").file("scene.yaml", "a: 1")), '{folder}/scene.yaml: expected a MoveIt planning scene: a mapping with "world", or the .scene text of RViz'),
    ("Scene.from_moveit", Invalid, lambda at: api.Scene.from_moveit(at.file("cell.scene", "cell\n* table\n")), "{folder}/cell.scene: line 2: expected the number of shapes of object 'table', and the file ends: it is not complete"),
    ("Scene.from_trimesh", Invalid, lambda at: api.Scene.from_trimesh(at.needs("trimesh").value(1)), 'geometry must be a trimesh.Trimesh or a trimesh.Scene, got 1'),
    ("best_base", Invalid, lambda at: api.best_base(UR5, np.full((1, 4, 4), np.nan), region=REGION), 'targets: expected finite poses (4, 4) or (n, 4, 4), got shape (1, 4, 4)'),
    ("best_base", Invalid, lambda at: api.best_base(UR5, np.array([np.eye(4), 2.0 * np.eye(4)]), region=REGION), 'targets: pose 1 is not a rigid transform: its last row is (0, 0, 0, 2), not (0, 0, 0, 1)'),
    ("best_base", Invalid, lambda at: api.best_base(PANDA, np.eye(4)[None], region=REGION, map=at.map()), "map is of robot 'ur5e', not of 'panda'"),
    ("interop.from_pinocchio", Unknown, lambda at: api.interop.from_pinocchio(api.interop.to_pinocchio(at.needs("pinocchio").value(PANDA)), tip="hnd"), "no frame 'hnd' in the Pinocchio model; frames: universe, base, panda_joint1, link_1, panda_joint2, link_2, panda_joint3, link_3, panda_joint4, link_4, panda_joint5, link_5, panda_joint6, link_6, panda_joint7, link_7, flange, tool"),
    ("interop.from_pinocchio", Invalid, lambda at: api.interop.from_pinocchio(at.needs("pinocchio").value(1)), 'model must be a Model, got 1'),
    ("interop.from_roboticstoolbox", Invalid, lambda at: api.interop.from_roboticstoolbox(at.needs("roboticstoolbox").value("puma")), "expected a robot or an ETS of the Robotics Toolbox, got 'puma'"),
    ("interop.to_dataframe", Missing, lambda at: api.interop.to_dataframe(at.without("pandas").value(MOTION)), 'a table needs pandas: pip install pandas'),
    ("interop.to_lerobot", Invalid, lambda at: api.interop.to_lerobot(MOTION, fps=0, task="wave"), 'fps must be positive, got 0'),
    ("interop.to_lerobot", Invalid, lambda at: api.interop.to_lerobot(MOTION, fps=30, task="wave", joint_names=["a"]), 'joint_names: expected 7, one per joint, got 1'),
    ("interop.to_moveit", Invalid, lambda at: api.interop.to_moveit(MOTION, dt=0.0), 'dt must be positive and finite, got 0'),
    ("interop.to_rosbag", Missing, lambda at: api.interop.to_rosbag(at.without("rosbags.rosbag2").value(MOTION), at.path("bag")), "a bag of ROS 2 needs rosbags: pip install 'beetle-ik[bags]'"),
    ("interop.to_rosbag", Invalid, lambda at: api.interop.to_rosbag(MOTION, at.path("bag"), stamp=-1.0), 'stamp must be a time in s, zero or more, got -1.0'),
    ("interop.to_rosbag", Invalid, lambda at: api.interop.to_rosbag(MOTION, at.path("bag"), topic="/a", states="/a"), "topic and states must differ, got '/a' for both"),
    ("interop.to_rosbag", OSError, lambda at: api.interop.to_rosbag(MOTION, at.path("none") / "bag"), "No such folder: '{folder}/none'"),
    ("interop.to_pinocchio", Invalid, lambda at: api.interop.to_pinocchio(at.needs("pinocchio").value(MIMIC)), "joint 'j' of robot 'twin' has mimic joints, which the conversion to Pinocchio does not support"),
    ("interop.to_roboticstoolbox", Invalid, lambda at: api.interop.to_roboticstoolbox(at.needs("roboticstoolbox").value(MIMIC)), "joint 'j' of robot 'twin' has mimic joints, which the conversion to the Robotics Toolbox does not support"),
    ("interop.to_ros", Invalid, lambda at: api.interop.to_ros(MOTION, dt=0.0), 'dt must be positive and finite, got 0'),
    ("interop.to_ros", Invalid, lambda at: api.interop.to_ros(MOTION, joint_names=["a"]), 'joint_names: expected 7, one per joint, got 1'),
    ("minimize", Invalid, lambda at: api.minimize(half_square, [0.0, 0.0], [1.0]), 'upper: expected 2 entries as in lower, got 1'),
    ("minimize", Invalid, lambda at: api.minimize(half_square, [0.0], [np.inf]), 'upper must be finite, but entry 0 is inf'),
    ("minimize", Invalid, lambda at: api.minimize(half_square, [1.0], [0.0]), 'lower[0] must be at most upper[0] = 0, got 1'),
    ("minimize", Invalid, lambda at: api.minimize(half_square, [0.0], [1.0], start=[2.0]), 'start[0] must be within [0, 1], got 2'),
    ("minimize", Invalid, lambda at: api.minimize(half_square, [0.0], [1.0], solver=api.papers.PSO(), stop=api.Stop(max_evaluations=3)), 'population must be at most max_evaluations = 3, got 40'),
    ("minimize", Invalid, lambda at: api.minimize(lambda x: "no", [0.0], [1.0]), "function must return a real number, got 'no'"),
    ("obstacles.clearance", Invalid, lambda at: api.obstacles.clearance(BARE, np.zeros(7), [BALL]), f"robot 'iiwa14' {NO_CAPSULES}"),
    ("obstacles.clearance", Invalid, lambda at: api.obstacles.clearance(THICK, Q, [1]), 'obstacle 0 must be made by bik.obstacles, such as Sphere or Box, got 1'),
    ("obstacles.nearest", Invalid, lambda at: api.obstacles.nearest(BARE, np.zeros(7), [BALL]), f"robot 'iiwa14' {NO_CAPSULES}"),
    ("obstacles.nearest", Invalid, lambda at: api.obstacles.nearest(THICK, Q, [1]), 'obstacle 0 must be made by bik.obstacles, such as Sphere or Box, got 1'),
    ("Limits", Limit, lambda at: api.Limits(tip_speed=0.0), "tip_speed is 0: it must be positive; None means no limit"),
    ("Limits", Invalid, lambda at: api.Limits(tip_speed={}), "tip_speed: the dict is empty; name one tip at least"),
    ("time_optimal", Unsupported, lambda at: api.time_optimal([[0.0], [1.0]], limits=api.Limits(acceleration=1.0, tip_speed=0.1)), "time_optimal cannot honour tip speed limits: give the robot whose tips they are, or leave out limits=Limits(tip_speed=...)"),
    ("Keep", Invalid, lambda at: api.Keep([0.0, 0.0]), "target: expected a pose (4, 4) or a position (3,), got shape (2,)"),
    ("Keep", Invalid, lambda at: api.Keep([0.0, np.nan, 0.0]), "target must be finite, but coordinate y is NaN"),
    ("Keep", Invalid, lambda at: api.Keep([0.0, 0.0, 0.3], api.tasks.Pointing()), "task Pointing needs a target pose (4, 4), got a position (3,)"),
    ("Keep", Invalid, lambda at: api.Keep([0.0, 0.0, 0.3], api.tasks.Position(level=1)), "what is kept comes before all targets, at every instant: leave out the level of its task, 1"),
    ("Keep", Invalid, lambda at: api.Keep([0.0, 0.0, 0.3], api.tasks.Position(tolerance=[np.inf] * 3)), "nothing would be kept: all tolerances of the task are infinite, or all its weights zero"),
    ("upright", Invalid, lambda at: api.upright(PANDA, axis=(0, 0, 0)), "the length of axis must be positive, got 0.0"),
    ("upright", Invalid, lambda at: api.upright(PANDA, direction=(0, 0, 0)), "the length of direction must be positive, got 0.0"),
    ("upright", Invalid, lambda at: api.upright(PANDA, tilt=0.0), "tilt must be positive, got 0.0"),
    ("upright", Invalid, lambda at: api.upright(PANDA, tilt=10.0), "tilt must be at most pi, at which any axis is allowed, got 10.0; np.radians converts degrees"),
    ("upright", Unknown, lambda at: api.upright(PANDA, tip="hand"), "robot 'panda' has no tip 'hand'; its tips: flange"),
    ("upright", Invalid, lambda at: api.upright(PAIR), "tip: robot 'pair_of_pandas' has several tips, name one of 'left_tool', 'right_tool'"),
    ("papers.planar_posture", Invalid, lambda at: api.papers.planar_posture(PANDA, (0.3, 0.2, 0.0)), "robot 'panda': a posture on circles needs an arm of joints that turn about z in one plane"),
    ("papers.planar_posture", Invalid, lambda at: api.papers.planar_posture(api.Robot.planar([1.0, 1.0]), (0.3, 0.2, 0.0)), "robot 'planar2': a posture on circles needs at least 3 links, got 2"),
    ("papers.planar_posture", Invalid, lambda at: api.papers.planar_posture(PLANAR, (0.3,)), 'target: expected shape (3,), got (1,)'),
    ("papers.planar_posture", Invalid, lambda at: api.papers.planar_posture(PLANAR, (np.nan, 0.2, 0.0)), 'target must be finite, but coordinate x is NaN'),
    ("plan_along_path", Invalid, lambda at: api.plan_along_path(PANDA, [[0.4, 0.0, 0.5]], limits=RATED), 'path: it needs at least 2 points, got 1'),
    ("plan_along_path", Invalid, lambda at: api.plan_along_path(PANDA, [[9.0, 0.0, 0.5], [9.0, 0.1, 0.5]], limits=RATED), 'points 0 to 1 of the path cannot be reached: the nearest configurations found within the limits stay up to 8.144 m away'),
    ("plan_along_path", Invalid, lambda at: api.plan_along_path(PLANAR, LINE_XY, limits=RATED, obstacles=[BALL]), f"robot 'planar3' {NO_CAPSULES}"),
    ("plan_along_path", Invalid, lambda at: api.plan_along_path(PLANAR, LINE_XY, method="tpbso", limits=RATED, breaks=True), 'leaving the path at breaks needs method="timed"'),
    ("plan_along_path", Limit, lambda at: api.plan_along_path(PANDA, LINE, limits=CROSSED), "joint 'panda_joint1': lower limit 1 is above upper limit -1"),
    ("plan_along_path", Unsupported, lambda at: api.plan_along_path(PANDA, LINE, limits=VARYING), 'method="timed" cannot honour time-varying velocity limits: give numbers'),
    ("plan_along_path", Unsupported, lambda at: api.plan_along_path(PANDA, LINE), 'method="timed" cannot honour infinite acceleration limits: joint \'panda_joint1\' could start at any speed; give acceleration limits'),
    ("plan_along_path", Unsupported, lambda at: api.plan_along_path(PLANAR, LINE_XY, method="tpbso", limits=JERKY), 'method="tpbso" cannot honour jerk limits: leave them out, and add them with plan.retime(limits)'),
    ("plan_batch", Invalid, lambda at: api.plan_batch(PANDA, [{"start_q": Q, "ende": Q}]), "problems[0]: 'ende' is no argument of a problem; its arguments: start, end, start_q, end_q, start_qd, start_slack, end_turns, approach, retreat, free_start, task, keep, limits, method, objective, obstacles, margin, self_collision, stop, seed"),
    ("plan_batch", Invalid, lambda at: api.plan_batch(PANDA, [{"start_q": Q, "end_q": Q[:2]}]), "problems[0]: end_q of robot 'panda': expected 7 joints, got 2"),
    ("plan_batch", Invalid, lambda at: api.plan_batch(PANDA, [{"start_q": Q * np.nan, "end_q": Q}]), "problems[0]: start_q must be finite, but joint 'panda_joint1' is NaN"),
    ("plan_moves", Invalid, lambda at: api.plan_moves(UR5, [], start_q=UR5_Q, limits=RATED), "the program: it has no moves: give at least one"),
    ("plan_moves", Invalid, lambda at: api.plan_moves(UR5, [api.moves.Wait(0.0)], start_q=UR5_Q, limits=RATED), "the program: it takes no time: all its moves end where the arm is"),
    ("plan_moves", Invalid, lambda at: api.plan_moves(UR5, [LINE_UP], start_q=UR5_Q[:2], limits=RATED), "start_q of robot 'ur5e': expected 6 joints, got 2"),
    ("plan_moves", Invalid, lambda at: api.plan_moves(UR5, [LINE_UP], start_q=UR5_Q * np.nan, limits=RATED), "start_q must be finite, but joint 'shoulder_pan_joint' is NaN"),
    ("plan_moves", Invalid, lambda at: api.plan_moves(UR5, [api.moves.Arc(raised(0.05)[:3, 3], raised(0.1))], start_q=UR5_Q, limits=RATED), "move 0: the three points of the arc are on a line: move via off it, or give a line"),
    ("plan_moves", Invalid, lambda at: api.plan_moves(UR5, [api.moves.Line(raised(0.05), blend=0.06), api.moves.Line(HERE)], start_q=UR5_Q, limits=RATED), "move 0: its blend of 0.06 m does not fit into move 0, which is 0.05000 m long: make the blend smaller"),
    ("plan_moves", Invalid, lambda at: api.plan_moves(UR5, [api.moves.Line(raised(0.05), blend=0.01), api.moves.Wait(1.0)], start_q=UR5_Q, limits=RATED), "move 0: its blend of 0.01 m leads into move 1, a wait, before which the arm stops: give no blend"),
    ("plan_moves", Invalid, lambda at: api.plan_moves(UR5, [api.moves.Joints(UR5_Q[:2])], start_q=UR5_Q, limits=RATED), "joint positions of move 0 of robot 'ur5e': expected 6 joints, got 2"),
    ("plan_moves", Invalid, lambda at: api.plan_moves(BARE, [LINE_UP], start_q=Q, limits=RATED, obstacles=[BALL]), f"robot 'iiwa14' {NO_CAPSULES}"),
    ("plan_moves", Invalid, lambda at: api.plan_moves(UR5, [LINE_UP], start_q=UR5_Q, limits=RATED, task=api.tasks.Orientation()), "the task of a program leaves the position free (task Orientation), but a line or an arc is a path of positions: ask for x, y and z, or give joint moves to configurations"),
    ("plan_moves", Invalid, lambda at: api.plan_moves(UR5, [LINE_UP], start_q=UR5_Q, limits=RATED, task=api.tasks.Position(region=[[-1.0] * 3, [1.0] * 3])), "the task of a program takes no region: the tip stays on its lines and arcs"),
    ("plan_moves", Invalid, lambda at: api.plan_moves(UR5, [LINE_UP], start_q=UR5_Q, limits=RATED, task=api.tasks.Pose(first="position")), "the task of a program takes no order of its parts ('position' first): the tip stays on its lines and arcs"),
    ("plan_moves", Invalid, lambda at: api.plan_moves(UR5, [LINE_UP], start_q=UR5_Q, limits=RATED, task=api.tasks.Pose(tolerance=[1e-6] * 6)), "tolerance[0] of the task must be at least the 1.000e-5 m to which a path is kept, got 0.000001"),
    ("plan_moves", Invalid, lambda at: api.plan_moves(PAIR, [LINE_UP], start_q=PAIR.random_configurations(1)[0], limits=RATED), "move 0: it names no tip of robot 'pair_of_pandas', which has several: name one of left_tool and right_tool"),
    ("plan_moves", Unknown, lambda at: api.plan_moves(UR5, [api.moves.Line(HERE, tip="tool")], start_q=UR5_Q, limits=RATED), "robot 'ur5e' has no tip 'tool'; its tips: link_6"),
    ("plan_moves", Limit, lambda at: api.plan_moves(UR5, [LINE_UP], start_q=UR5_Q, limits=CROSSED), "joint 'shoulder_pan_joint': lower limit 1 is above upper limit -1"),
    ("plan_moves", Unsupported, lambda at: api.plan_moves(UR5, [LINE_UP], start_q=UR5_Q), "plan_moves cannot honour infinite acceleration limits: joint 'shoulder_pan_joint' could start at any speed; give acceleration limits"),
    ("moves.Joints", Invalid, lambda at: api.moves.Joints(UR5_Q, tip="tool0", name="up"), "move 'up': it leads no tip to a pose, but names tip 'tool0': leave the tip out"),
    ("moves.Joints", Invalid, lambda at: api.moves.Joints(np.eye(3)), "q_or_pose: expected joint positions (n,) or a pose (4, 4), got shape (3, 3)"),
    ("moves.Wait", Invalid, lambda at: api.moves.Wait(-1.0), "time must be from 0 to 1000000 s, got -1"),
    ("moves.Line", Invalid, lambda at: api.moves.Line(HERE, speed=0.0, name="up"), "speed of move 'up' must be positive and finite, got 0"),
    ("moves.Line", Invalid, lambda at: api.moves.Line([0.0, 0.0]), "pose: expected shape (4, 4), got (2,)"),
    ("moves.Arc", Invalid, lambda at: api.moves.Arc([0.0, 0.0], np.eye(4)), "via: expected shape (3,), got (2,)"),
    ("plan_point_to_point", Invalid, lambda at: api.plan_point_to_point(PANDA, start_q=Q[:2], end_q=Q), "start_q of robot 'panda': expected 7 joints, got 2"),
    ("plan_point_to_point", Invalid, lambda at: api.plan_point_to_point(PANDA, start_q=Q * np.nan, end_q=Q), "start_q must be finite, but joint 'panda_joint1' is NaN"),
    ("plan_point_to_point", Invalid, lambda at: api.plan_point_to_point(PANDA, start_q=Q, end=[9.0, 0.0, 0.0]), 'end cannot be reached: the nearest configuration found stays 8.148 m away'),
    ("plan_point_to_point", Invalid, lambda at: api.plan_point_to_point(PANDA, start_q=Q, end_q=Q, keep=api.Keep([0.0, 0.0, 0.3])), "start_q: what is to be kept on the way does not hold there: distance 0.5227 m of at most 1.000e-6"),
    ("plan_point_to_point", Limit, lambda at: api.plan_point_to_point(PANDA, start_q=Q, end_q=Q, limits=CROSSED), "joint 'panda_joint1': lower limit 1 is above upper limit -1"),
    ("plan_point_to_point", Limit, lambda at: api.plan_point_to_point(PANDA, start_q=Q, end_q=BEYOND), f"end_q: joint 'panda_joint2' at 9 is {FAR_OUTSIDE}"),
    ("plan_point_to_point", Infeasible, lambda at: api.plan_point_to_point(PANDA, start_q=EDGE, end_q=Q, start_qd=ONWARD, limits=RATED), "infeasible: joint 'panda_joint1' would get to 3.140, beyond its upper limit 2.897: begin or end it slower, or farther from its limit"),
    ("plan_point_to_point", Unsupported, lambda at: api.plan_point_to_point(PANDA, start_q=Q, end_q=Q, limits=VARYING), 'method="minmax" cannot honour time-varying velocity limits: give numbers'),
    ("plan_point_to_point", Unsupported, lambda at: api.plan_point_to_point(PLANAR, start=(0.9, 0.2, 0.0), end=(0.2, 0.9, 0.0), method="tpbso", limits=JERKY), 'method="tpbso" cannot honour jerk limits: leave them out, and add them with plan.retime(limits)'),
    ("pose", Invalid, lambda at: api.pose(matrix=2.0 * np.eye(4)), 'matrix is not a rigid transform: its last row is (0, 0, 0, 2), not (0, 0, 0, 1)'),
    ("reachability", Invalid, lambda at: api.reachability(PAIR, voxel=0.2), 'reachability takes robots with one tip; this one has left_tool and right_tool: load the robot with one of them as tip='),
    ("reachability", Invalid, lambda at: api.reachability(api.Robot.planar([0.5, 0.4]), voxel=0.2), "the tip of robot 'planar2' moves in 2 directions, and a map of task Pose needs 3, as it reaches hardly any voxel's centre otherwise: give task=tasks.Position()"),
    ("reachability", Invalid, lambda at: api.reachability(PANDA, voxel=0.0), 'voxel must be positive and finite, got 0'),
    ("reachability", Invalid, lambda at: api.reachability(PANDA, voxel=0.4, directions=6, rolls=1, store=at.file("a.zarr", "no store")), "store: folder '{folder}/a.zarr' cannot be written: File exists"),
    ("reachability", OSError, lambda at: api.reachability(PLANAR, task=api.tasks.Position(), voxel=0.3, store=at.full().path("a.zarr")), '[Errno 28] No space left on device'),
    ("calibrate", Invalid, lambda at: api.calibrate(UR5, MEASURED_Q[:5], MEASURED[:5]), "5 measurements give 15 equations for 25 unknowns: measure 9 configurations or more, twice as many if you can, or fit fewer parts"),
    ("calibrate", Invalid, lambda at: api.calibrate(UR5, MEASURED_Q[[0] * 20], MEASURED[[0] * 20]), "all configurations are alike: move the arm between measurements, each joint over as much of its range as possible"),
    ("calibrate", Invalid, lambda at: api.calibrate(UR5, MEASURED_Q, 1e3 * MEASURED), "the measured positions spread 1000 times as far as the arm moves: lengths are in metres, and these look like millimetres; divide by 1000"),
    ("calibrate", Invalid, lambda at: api.calibrate(UR5, np.degrees(MEASURED_Q).clip(-300, 300), MEASURED), "joint 'shoulder_pan_joint' reaches 300.0 rad, far beyond its limits: angles are in radians, and these look like degrees"),
    ("calibrate", Invalid, lambda at: api.calibrate(UR5, MEASURED_Q, MEASURED[:, :2]), "measured: expected positions (m, 3), poses (m, 4, 4) or distances (m,), got (40, 2)"),
    ("calibrate", Invalid, lambda at: api.calibrate(UR5, MEASURED_Q, np.full((40, 3), np.nan)), "measurements must be finite, but row 0, entry 0 is NaN"),
    ("Calibration.to_urdf", Urdf, lambda at: CALIBRATED.to_urdf(FORK), "URDF: its chain of joints is not that of robot 'held': give the file that the robot was loaded from"),
    ("self_motion", Invalid, lambda at: api.self_motion(PANDA, np.eye(3)), 'target: expected a pose (4, 4) or a position (3,), got shape (3, 3)'),
    ("self_motion", Invalid, lambda at: api.self_motion(PANDA, np.full((4, 4), np.nan)), 'target must be finite, but entry (0, 0) is NaN'),
    ("self_motion", Invalid, lambda at: api.self_motion(UR5, UR5.fk(np.zeros(6))), "self_motion needs one joint more than the target: robot 'ur5e' has 6 joints, and this target takes 6"),
    ("solve", Invalid, lambda at: api.solve(PANDA, np.eye(3)), 'target: expected a pose (4, 4) or a position (3,), got shape (3, 3)'),
    ("solve", Invalid, lambda at: api.solve(PANDA, [np.nan, 0.0, 0.0]), 'target must be finite, but coordinate x is NaN'),
    ("solve", Invalid, lambda at: api.solve(PANDA, 2.0 * np.eye(4)), 'target is not a rigid transform: its last row is (0, 0, 0, 2), not (0, 0, 0, 1)'),
    ("solve", Limit, lambda at: api.solve(PANDA, [0.4, 0.0, 0.5], limits=api.Limits(lower=1.0, upper=-1.0)), "joint 'panda_joint1': lower limit 1 is above upper limit -1"),
    ("solve", Invalid, lambda at: api.solve(BARE, [0.4, 0.0, 0.5], obstacles=[BALL]), f"robot 'iiwa14' {NO_CAPSULES}"),
    ("solve_all", Invalid, lambda at: api.solve_all(PANDA, np.eye(3)), 'target: expected a pose (4, 4) or a position (3,), got shape (3, 3)'),
    ("solve_all", Invalid, lambda at: api.solve_all(PAIR, dict.fromkeys(PAIR.tips, np.eye(4)), task={"left_tool": api.tasks.Pose(level=1)}), "all solutions meet all targets, so levels from 0 to 1 have no effect: give all tasks one level, or solve for one configuration, which meets them in their order"),
    ("solve_all", Invalid, lambda at: api.solve_all(PANDA, [np.nan, 0.0, 0.0]), 'target must be finite, but coordinate x is NaN'),
    ("solve_all", Limit, lambda at: api.solve_all(PANDA, [0.4, 0.0, 0.5], limits=api.Limits(lower=1.0, upper=-1.0)), "joint 'panda_joint1': lower limit 1 is above upper limit -1"),
    ("solve_all", Invalid, lambda at: api.solve_all(PANDA, 2.0 * np.eye(4)), 'target is not a rigid transform: its last row is (0, 0, 0, 2), not (0, 0, 0, 1)'),
    ("solve_all", Invalid, lambda at: api.solve_all(UR5, UR5.fk(UR5_Q), turns=True, limits=WIDE), 'turns=True makes 132120576 configurations; at most 10000 are allowed: narrow the limits'),
    ("solve_batch", Invalid, lambda at: api.solve_batch(PANDA, np.eye(3)[None]), 'targets: expected poses (m, 4, 4) or positions (m, 3), got shape (1, 3, 3)'),
    ("solve_batch", Invalid, lambda at: api.solve_batch(PANDA, np.array([np.eye(4), np.full((4, 4), np.nan)])), 'row 1: target must be finite, but entry (0, 0) is NaN'),
    ("solve_batch", Limit, lambda at: api.solve_batch(PANDA, np.eye(4)[None], limits=api.Limits(lower=1.0, upper=-1.0)), "joint 'panda_joint1': lower limit 1 is above upper limit -1"),
    ("solve_batch", Invalid, lambda at: api.solve_batch(PANDA, np.array([np.eye(4), 2.0 * np.eye(4)])), 'row 1: target is not a rigid transform: its last row is (0, 0, 0, 2), not (0, 0, 0, 1)'),
    ("state_to_state", TypeError, lambda at: api.state_to_state([0.0], [1.0], limits=1.0), 'limits must be a Limits, such as Limits(velocity=1.5, acceleration=5.0), got 1.0'),
    ("state_to_state", Invalid, lambda at: api.state_to_state([0.0], [1.0, 2.0], limits=RATED), 'end_q: expected 1 joint, got 2'),
    ("state_to_state", Invalid, lambda at: api.state_to_state([np.nan], [1.0], limits=RATED), "start_q must be finite, but joint 'q1' is NaN"),
    ("state_to_state", Invalid, lambda at: api.state_to_state([0.0], [1.0], limits=api.Limits(velocity=0.0, acceleration=1.0)), "velocity limit of joint 'q1' must be positive, got 0"),
    ("state_to_state", Invalid, lambda at: api.state_to_state([0.0], [0.0], limits=RATED), 'trajectory: start_q and end_q, with their velocities and accelerations, are the same state: nothing moves'),
    ("state_to_state", Limit, lambda at: api.state_to_state([0.0], [1.0], limits=api.Limits(upper=0.5, velocity=1.0, acceleration=1.0)), "end_q: joint 'q1' at 1 is outside its limits [-inf, 0.5] by 0.5000 rad: robot.clip(q) moves it to the limit, which changes the pose"),
    ("state_to_state", Infeasible, lambda at: api.state_to_state([0.4], [0.2], start_qd=[2.0], limits=api.Limits(upper=0.5, velocity=3.0, acceleration=1.0)), "infeasible: joint 'q1' would get to 2.400, beyond its upper limit 0.5000: begin or end it slower, or farther from its limit"),
    ("state_to_state", Unsupported, lambda at: api.state_to_state([0.0], [1.0], limits=VARYING), 'state_to_state cannot honour time-varying velocity limits: give numbers'),
    ("time_optimal", Invalid, lambda at: api.time_optimal([[1.0], [1.0]], limits=RATED), 'path: all waypoints are the same: give at least two that differ'),
    ("time_optimal", Invalid, lambda at: api.time_optimal([[0.0], [1.0]], limits=RATED, tolerance=-1.0), "tolerance of joint 'q1' must be zero or more and finite, got -1"),
    ("time_optimal", Invalid, lambda at: api.time_optimal([[0.0]], limits=RATED), 'waypoints: expected at least 2, got 1'),
    ("time_optimal", Invalid, lambda at: api.time_optimal([[0.0], [np.nan]], limits=RATED), "waypoints must be finite, but joint 'q1' of row 1 is NaN"),
    ("time_optimal", Infeasible, lambda at: api.time_optimal([[0.0], [1.0]], limits=api.Limits(upper=0.5, velocity=1.0, acceleration=1.0)), "infeasible: the path takes joint 'q1' to 1, beyond its upper limit 0.5"),
    ("time_optimal", Unsupported, lambda at: api.time_optimal([[0.0], [1.0]], limits=VARYING), 'time_optimal cannot honour time-varying velocity limits: when a point of the path is passed is what it looks for; give numbers'),
    ("time_optimal", Unsupported, lambda at: api.time_optimal([[0.0], [1.0]], limits=api.Limits(velocity=1.0)), "time_optimal cannot honour infinite acceleration limits: joint 'q1' could start at any speed; give acceleration limits"),
    ("track", Invalid, lambda at: api.track(PANDA, CIRCLE, Q[:2], dt=0.1), "start_q of robot 'panda': expected 7 joints, got 2"),
    ("track", Invalid, lambda at: api.track(PANDA, CIRCLE, Q * np.nan, dt=0.1), "start_q must be finite, but joint 'panda_joint1' is NaN"),
    ("track", Invalid, lambda at: api.track(PANDA, CIRCLE, Q, dt=0.0), 'dt must be positive and finite, got 0'),
    ("track", Invalid, lambda at: api.track(api.Robot.planar([1.0]), CIRCLE, [0.0], dt=0.1), "joint 'joint_1' has neither a velocity nor an acceleration limit, so that nothing sets its pace: give limits=Limits(velocity=...), infinite where a joint may jump to any position in one tick"),
    ("track", Invalid, lambda at: api.track(PANDA, CIRCLE, Q, dt=0.1, keep=api.Keep([0.0, 0.0, 0.3])), "start_q: what is to be kept on the way does not hold there: distance 0.5227 m of at most 1.000e-6"),
    ("track", Limit, lambda at: api.track(PANDA, CIRCLE, BEYOND, dt=0.1), f"start_q: joint 'panda_joint2' at 9 is {FAR_OUTSIDE}"),
    ("track", Limit, lambda at: api.track(PANDA, CIRCLE, Q, dt=0.1, limits=api.Limits(velocity=-1.0)), 'velocity limit is -1: a limit cannot be negative'),
    ("track", Unsupported, lambda at: api.track(THICK, CIRCLE, Q, dt=0.1, limits=SWELLING, obstacles=[BALL]), 'tracking among obstacles cannot honour time-varying upper limits: limits that vary can carry the arm into an obstacle; give numbers, or leave the obstacles out'),
    ("track", Unsupported, lambda at: api.track(PANDA, CIRCLE, Q, dt=0.1, limits=SWELLING, keep=api.Keep(PANDA.fk(Q))), 'tracking with constraints cannot honour time-varying upper limits: limits that vary can carry the arm out of its tolerances; give numbers'),
    ("track", Unsupported, lambda at: api.track(PANDA, CIRCLE, Q, dt=0.1, limits=JERKY, task=WITHIN), 'a task with a region cannot honour acceleration limits: an arm that may not stop at once can be carried out of it; leave one of the two out'),
    ("track_model_free", Invalid, lambda at: model_free(Q[:2]), "start_q of robot 'panda': expected 7 joints, got 2"),
    ("track_model_free", Invalid, lambda at: model_free(Q * np.nan), "start_q must be finite, but joint 'panda_joint1' is NaN"),
    ("track_model_free", Invalid, lambda at: model_free(Q, dt=0.0), 'dt must be positive and finite, got 0'),
    ("track_model_free", Limit, lambda at: model_free(BEYOND, limits=api.Limits(upper=2.0)), "start_q: joint '1' at 9 is outside its limits [-inf, 2] by 7.000 rad: move it inside; angles are in radians, and np.radians converts degrees"),
    ("track_model_free", Limit, lambda at: model_free(Q, limits=api.Limits(velocity=-1.0)), 'velocity limit is -1: a limit cannot be negative'),
    ("track_model_free", Unsupported, lambda at: model_free(Q, limits=JERKY), 'track_model_free cannot honour acceleration limits: a controller keeps position and velocity limits; leave it out'),
    ("view", Missing, lambda at: api.view(at.without("viser").value(PANDA)), "the viewer needs viser: pip install 'beetle-ik[view]'"),
    ("view", Invalid, lambda at: api.view(PANDA, Q[:2], port=0), "joint angles of robot 'panda': expected 7 joints, got 2"),
    ("view", Invalid, lambda at: api.view(PANDA, port=70000), 'port must be a whole number from 0 to 65535, got 70000'),
    ("view", Limit, lambda at: api.view(PANDA, BEYOND, port=0), "q: joint 'panda_joint2' at 9 is outside its limits [-1.7628, 1.7628]"),
    ("vision.locate_arm", Invalid, lambda at: api.vision.locate_arm(np.zeros((9, 9)), PANDA, Q), "robot 'panda' is not a planar arm: all joints must rotate about z"),
    ("vision.locate_arm", Invalid, lambda at: api.vision.locate_arm(np.zeros(5), PLANAR, np.zeros(3)), 'image: expected shape (rows, columns), or (rows, columns, 3 or 4), of numbers, got (5,) of float64'),
    ("vision.locate_arm", Missing, lambda at: api.vision.locate_arm(np.zeros((9, 9)), at.without("skimage").value(PLANAR), np.zeros(3)), "locate_arm needs scikit-image: pip install 'beetle-ik[vision]'"),
    ("paths.on_surface", Invalid, lambda at: api.paths.on_surface(SLAB, [(0, 0, 0.1), (0, 0, 1.1)]), "points[1] is 1 m from the surface, farther than within=0.06: give a larger within=, or move it nearer"),
    ("paths.on_surface", Missing, lambda at: api.paths.on_surface(at.without("trimesh").value(SLAB), [(0, 0, 0.1), (0.1, 0, 0.1)]), "a line on a surface needs trimesh: pip install 'beetle-ik[surfaces]'"),
    ("paths.raster", Invalid, lambda at: api.paths.raster(SLAB, spacing=0.1, direction=(0, 0, 1)), "direction is along side= [0.0, 0.0, 1.0], from which the tool comes: rows run across it"),
    ("paths.raster", Missing, lambda at: api.paths.raster(at.without("trimesh").file("part.stl", ""), spacing=0.1, direction=(1, 0, 0)), "a surface from a file needs trimesh: pip install 'beetle-ik[surfaces]'"),
    ("paths.join", Missing, lambda at: api.paths.join(api.paths.raster(SLAB, spacing=0.1, direction=(1, 0, 0)), surface=at.without("trimesh").value(SLAB)), "a line on a surface needs trimesh: pip install 'beetle-ik[surfaces]'"),
    ("paths.join", Invalid, lambda at: api.paths.join([]), "seams: at least one is needed, got none"),
    ("paths.Seam.path", Invalid, lambda at: api.paths.raster(SLAB, spacing=0.1, direction=(1, 0, 0), side=(0, 0, 1))[0].path(0.0), "speed must be positive and finite, got 0"),
    ("paths.from_gcode", Invalid, lambda at: api.paths.from_gcode(at.file("part.nc", "G81 X1")), "{folder}/part.nc: line 1: G81 is not read: G0 to G3, G17 to G21, G90 and G91 are"),
    ("paths.GcodeProgram.path", Invalid, lambda at: api.paths.from_gcode("G0 X0 Y0 Z0\nG0 X1").path(0.0), "rapid_speed must be positive and finite, got 0"),
    ("Plan.retime", TypeError, lambda at: PLAN.retime(1.0), 'limits must be a Limits, such as Limits(velocity=1.5, acceleration=5.0), got 1.0'),
    ("Plan.retime", Infeasible, lambda at: PLAN.retime(api.Limits(upper=[0.05, 1.7, 2.8, -0.1, 2.8, 3.7, 2.8], velocity=1.0, acceleration=2.0)), "infeasible: the path of the plan leaves the limits: highest position of joint 'panda_joint1' is 0.1000 rad, allowed 0.05000 rad"),
    ("Plan.retime", Unsupported, lambda at: PLAN.retime(VARYING), 'retime cannot honour time-varying velocity limits: give numbers'),
    ("Viewer.q", Invalid, lambda at: at.viewer(q=Q[:2]), "joint angles of robot 'panda': expected 7 joints, got 2"),
    ("Viewer.q", Limit, lambda at: at.viewer(q=BEYOND), "q: joint 'panda_joint2' at 9 is outside its limits [-1.7628, 1.7628]"),
    ("Viewer.show", Invalid, lambda at: at.viewer().show(1), 'result must be a Trajectory, Plan, TrackResult, ModelFreeResult, Solution, SolutionSet or SelfMotion, got 1'),
    ("Viewer.show", Invalid, lambda at: at.viewer().show(api.solve(UR5, np.eye(4))), "result has 6 joints, and robot 'panda' has 7"),
    ("Viewer.record", OSError, lambda at: at.viewer().record(at.path("none") / "a.html", [0.1]), "[Errno 2] No such folder: '{folder}/none'"),
    ("Viewer.record", Invalid, lambda at: at.viewer().record(at.path("a.txt"), [0.1]), "file must end in .html (a page of its own) or .viser (played by another page), got '{folder}/a.txt'"),
]  # fmt: skip


@pytest.fixture(scope="module")
def viewers() -> Iterator[list[bik.Viewer]]:
    opened: list[bik.Viewer] = []
    yield opened
    for viewer in opened:
        viewer.close()


@pytest.mark.parametrize("row", ROWS, ids=[f"{row[0]}-{row[1].__name__}-{i}" for i, row in enumerate(ROWS)])
def test_a_promised_error_is_raised(
    row: Row, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, viewers: list[bik.Viewer]
) -> None:
    _, error, call, message = row
    with pytest.raises(error) as caught:
        call(Place(tmp_path, monkeypatch, viewers))
    told = str(caught.value).replace(str(tmp_path), "{folder}").replace(str(CORPUS), "{corpus}")
    assert told == message


def promised(name: str, thing: Any) -> Iterator[tuple[str, str]]:
    """The classes of errors that the docstring of a thing, and those of its members, list under `Raises:`."""
    text = (inspect.getdoc(thing) or "").partition("Raises:\n")[2]
    yield from ((name, error) for error in re.findall(r"^ {4}(\w+): ", text, re.MULTILINE))
    if inspect.isclass(thing):
        for member in (key for key in vars(thing) if not key.startswith("_")):
            kept = inspect.getattr_static(thing, member)
            plain = isinstance(kept, (property, types.GetSetDescriptorType))
            yield from promised(f"{name}.{member}", kept if plain else getattr(thing, member))


def test_every_promised_error_has_a_row() -> None:
    listed: set[tuple[str, str]] = set()
    for name in bik.__all__:
        thing = getattr(bik, name)
        if isinstance(thing, types.ModuleType):
            members = ((f"{name}.{member}", getattr(thing, member)) for member in thing.__all__)
            listed |= {error for member in members for error in promised(*member)}
        else:
            listed |= set(promised(name, thing))

    shown = {(name, error.__name__) for name, error, _, _ in ROWS}
    assert len(listed) > 60
    assert sorted(listed - shown) == []
    assert sorted(shown - listed) == []
