"""Every public call with each argument wrong in many ways: no panic, and a message that names the argument.

Calls are taken from `__all__` and arguments from signatures, so that new ones cannot be forgotten.
"""

import inspect
import re
import sys
from collections.abc import Callable, Iterator
from operator import attrgetter
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest
from iiwa_circle import IIWA, START

import beetle_ik as bik
from beetle_ik import distributed

WRONG: dict[str, Any] = {
    "NaN": np.nan,
    "infinite": -np.inf,
    "None": None,
    "a word": "nonsense",
    "no word": "",
    "an object": object(),
    "a module": np,
    "nothing": [],
    "a ragged list": [[1.0], [1.0, 2.0]],
    "NaNs": [np.nan] * 3,
    "three dimensions": np.zeros((2, 3, 5)),
    "huge": 10**30,
    "negative": -1,
    "complex": 1j,
}
# What messages say for an argument whose name is not a word of them.
WORDS = {
    "q": "joint angles",
    "t": "time",
    "time": "times",
    "name": "named",
    "path_or_xml": "cannot read|URDF",
    "srdf": "SRDF|cannot read|srdf",
    "lengths": "length \\d",
    "capsules": "with_capsules",
    "kinds": "kind",
    "positions_or_poses": "points|poses",
    "semi_axes": "semi-axes",
    "start_q": "start",
    "q_or_pose": "joint positions",
    "seconds": "time",
    "waypoints_q": "waypoints?",
    "start_speed": "speed at the start",
    "end_speed": "speed at the end",
    "qd": "velocity samples|velocities",
    "qdd": "accelerations",
    "measured": "measurements?|pose \\d+",
    "sigma": "standard deviation",
    "center": "centre",
    "suggest": "suggested",
    "fit": "part of a calibration|fitted",
}

URDF = """<robot name="r"><link name="base"/><link name="tip"/><joint name="turn" type="continuous">
<parent link="base"/><child link="tip"/></joint></robot>"""
MJCF = """<mujoco><worldbody><body name="base"><body name="tip"><joint/><geom size="1"/></body></body></worldbody>
</mujoco>"""
ARM = IIWA.with_capsules(radius=0.05)
PLANAR = bik.Robot.planar([1, 1, 1])
ONE_JOINT = bik.Robot.from_urdf(URDF)
LINE = bik.paths.polyline([(0.3, 0.3, 1.0), (0.3, 0.31, 1.0)], duration=0.2)
TABLE = bik.obstacles.Box((0, 0, 0), (0.4, 0.4, 0.2))
MOTION = bik.Trajectory.from_samples([0.0, 1.0], [[0.0, 0.0], [1.0, 1.0]])
LIMITS = bik.Limits(velocity=1.0, acceleration=2.0)
QUICK = {"stop": bik.Stop(max_evaluations=100)}
PLACED = {"center": (0, 0, 0), "duration": 1.0}
TICKS = {"start_q": START, "dt": 0.1}
PLAN = bik.plan_point_to_point(PLANAR, start_q=[0, 0, 0], end_q=[0.1, 0.1, 0.1], limits=LIMITS)
WEIGHTED = bik.Robot.named("panda")
WEIGHED_PLAN = bik.plan_point_to_point(
    WEIGHTED, start_q=[0, -0.5, 0, -2.0, 0, 1.5, 0.8], end_q=[0.1, -0.5, 0, -2.0, 0, 1.5, 0.8], limits=LIMITS
)
TRACK = bik.track(ARM, LINE, START, dt=0.1)
MODEL_FREE = bik.track_model_free(bik.KinematicPlant(ARM), LINE, START, dt=0.1)
ASKED, IDLE = (bik.papers.ZNNBAS().session(**TICKS) for _ in range(2))
ASKED.command((0.3, 0.3, 1.0))
VIEWER = bik.view(ARM, port=0)
FLAT = PLANAR.with_capsules(radius=0.05)
MAP = bik.reachability(FLAT, voxel=0.5, rolls=2)

TURNS = np.linspace(0.0, 3.0, 9)[:, None]
MEASURED_Q = PLANAR.random_configurations(20)
CALIBRATION = bik.calibrate(PLANAR, MEASURED_Q, PLANAR.fk(MEASURED_Q))

# What a call needs besides the argument that is wrong; "." stands for the instance that a method is called on.
NEEDED: dict[str, dict[str, Any]] = {
    "ControlSession.command": {".": IDLE, "target": (0.3, 0.3, 1.0)},
    "ControlSession.observe": {".": ASKED, "position": (0.3, 0.3, 1.0)},
    "BroydenBAS.session": {".": bik.BroydenBAS(), **TICKS},
    "KinematicPlant": {"robot": ARM},
    "KinematicPlant.move": {".": bik.KinematicPlant(ARM), "q": START},
    "ModelFreeResult.": {".": MODEL_FREE},
    "MultiStart": {"solver": bik.papers.BAS()},
    "Calibration.": {".": CALIBRATION},
    "Calibration.to_urdf": {".": bik.calibrate(ONE_JOINT, TURNS, ONE_JOINT.fk(TURNS)), "path_or_xml": URDF},
    "Path.": {".": LINE},
    "Path.pose": {".": LINE.with_orientation(np.eye(3)), "t": 0.0},
    "Path.position": {"t": 0.0},
    "Path.sample": {"dt": 0.1},
    "Path.velocity": {"t": 0.0},
    "Path.with_orientation": {"orientation": np.eye(3)},
    "Plan.": {".": PLAN},
    "Plan.retime": {"limits": LIMITS},
    "InverseReachabilityMap.": {".": MAP.inverse()},
    "InverseReachabilityMap.on_floor": {"x": 0.0, "y": 0.0},
    "InverseReachabilityMap.query": {"base": np.eye(4)},
    "ReachabilityMap.": {".": MAP},
    "ReachabilityMap.load": {"file": "reached.npz"},
    "ReachabilityMap.poses": {"voxel": (0, 0, 0)},
    "ReachabilityMap.query": {"T": np.eye(4)},
    "ReachabilityMap.reached": {"voxel": (0, 0, 0)},
    "ReachabilityMap.to_npz": {"file": "map.npz"},
    "Robot.": {".": ARM, "q": START},
    "Robot.from_dh": {"a": [0, 1], "alpha": [0, 0], "d": [0, 0]},
    "Robot.from_urdf": {"path_or_xml": URDF},
    "Robot.from_description": {"name": "arm_description"},
    "Robot.from_mjcf": {"model": MJCF},
    "Robot.named": {"name": "iiwa14"},
    "Robot.planar": {"lengths": [1, 1]},
    "Robot.random_configurations": {"m": 3},
    "Robot.q_from": {"names": ARM.joint_names, "values": START},
    "Robot.with_attached": {"link": "link_7", "shape": bik.obstacles.Sphere((0, 0, 0), 0.1)},
    "Robot.with_base": {"base": np.eye(4)},
    "Robot.with_capsules": {"radius": 0.05},
    "Robot.with_collision_pairs": {"pairs": []},
    "Robot.with_held": {"hold": {}},
    "Robot.with_gravity": {"gravity": (0, 0, -9.81)},
    "Robot.with_inertias": {"inertias": []},
    "Robot.with_payload": {"mass": 1.0},
    "Robot.accelerations": {".": WEIGHTED, "q": START, "qd": START, "torques": START},
    "Robot.torques": {".": WEIGHTED},
    "Robot.mass_matrix": {".": WEIGHTED},
    "Robot.center_of_mass": {".": WEIGHTED},
    "Inertia": {"link": "hand", "mass": 1.0},
    "Plan.torques": {".": WEIGHED_PLAN, "t": 0.0},
    "Trajectory.torques": {".": WEIGHED_PLAN.trajectory, "robot": WEIGHTED, "t": 0.0},
    "Robot.with_mobile_base": {"kind": "planar", "lower": [-1, -1, -3], "upper": [1, 1, 3]},
    "Robot.with_srdf": {"path_or_xml": "<robot/>"},
    "Robot.with_tool": {"tool": np.eye(4)},
    "Scene.": {".": bik.Scene()},
    "Scene.attach_to": {"robot": ARM},
    "Scene.from_moveit": {"file": "scene.yaml"},
    "Scene.from_octomap": {"file": "map.bt"},
    "Scene.from_trimesh": {"geometry": SimpleNamespace(vertices=np.eye(3), faces=[[0, 1, 2]], is_watertight=False)},
    "Scene.load": {"file": "scene.json"},
    "Scene.save": {"file": "saved.json"},
    "Sinusoid": {"mean": 1.0, "amplitude": 0.1, "angular_frequency": 1.0},
    "TrackResult.": {".": TRACK},
    "Keep": {"target": (0.3, 0.3, 1.0)},
    "StraightLine": {"distance": 0.1},
    "upright": {"robot": ARM},
    "Tracker": {"robot": ARM, **TICKS},
    "Tracker.reset": {".": bik.Tracker(ARM, **TICKS), "q": START},
    "Tracker.step": {".": bik.Tracker(ARM, **TICKS), "target": (0.3, 0.3, 1.0)},
    "Tracker.stop": {".": bik.Tracker(ARM, **TICKS)},
    "Viewer.": {".": VIEWER},
    "Viewer.on_target": {"callback": len},
    "Viewer.record": {"file": "motion.viser"},
    "Viewer.show": {"result": TRACK},
    "Trajectory": {"time": [0, 1], "coefficients": np.zeros((1, 2, 2))},
    "Trajectory.": {".": MOTION},
    "Trajectory.at": {"t": 0.0},
    "Trajectory.from_csv": {"file": "motion.csv"},
    "Trajectory.from_npz": {"file": "motion.npz"},
    "Trajectory.from_samples": {"time": [0, 1], "q": [[0, 0], [1, 1]]},
    "Trajectory.sample": {"dt": 0.5},
    "Trajectory.then": {"motion": bik.Trajectory.from_samples([0.0, 1.0], [[1.0, 1.0], [0.0, 0.0]])},
    "Trajectory.to_csv": {"file": "written.csv"},
    "Trajectory.to_npz": {"file": "written.npz"},
    "papers.ZNNBAS.session": {".": bik.papers.ZNNBAS(), **TICKS},
    "distributed.reachability": {"client": None, "robot": FLAT, "voxel": 1.0, "threads": 1},
    "distributed.solve_batch": {"client": None, "robot": ARM, "targets": [(0.3, 0.3, 1.0)], "threads": 1, **QUICK},
    "best_base": {"robot": FLAT, "targets": FLAT.fk([[0.1, 0.2, 0.3]]), "region": [(-1, -1, 0), (1, 1, 0)], "map": MAP},
    "calibrate": {"robot": FLAT, "q": MEASURED_Q, "measured": PLANAR.fk(MEASURED_Q)},
    "filters.LowPass": {"cutoff": 5.0},
    "goals.Posture": {"posture": START},
    "minimize": {"function": np.sum, "lower": [-1, -1], "upper": [1, 1], "solver": bik.papers.BAS(), **QUICK},
    "obstacles.Grid.without_robot": {".": bik.obstacles.Grid((9, 9, 9), 0.1, [[[True]]]), "robot": ARM, "q": START},
    "obstacles.PointCloud.without_robot": {".": bik.obstacles.PointCloud([(9, 9, 9)], 0.1), "robot": ARM, "q": START},
    "obstacles.Box": {"center": (0, 0, 0), "size": (1, 1, 1)},
    "obstacles.Capsule": {"a": (0, 0, 0), "b": (1, 0, 0), "radius": 0.1},
    "obstacles.ConvexMesh": {"points": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]},
    "obstacles.Cylinder": {"center": (0, 0, 0), "axis": (0, 0, 1), "radius": 0.1, "length": 1.0},
    "obstacles.Ellipse": {"center": (0, 0), "semi_axes": (1, 1)},
    "obstacles.Ellipsoid": {"center": (0, 0, 0), "semi_axes": (1, 1, 1)},
    "obstacles.Grid": {"origin": (0, 0, 0), "voxel": 0.1, "occupied": [[[True]]]},
    "obstacles.HalfSpace": {"normal": (0, 0, 1), "offset": -1.0},
    "obstacles.Mesh": {"vertices": [(0, 0, 0), (1, 0, 0), (0, 1, 0)], "faces": [(0, 1, 2)]},
    "obstacles.PointCloud": {"points": [(0, 0, 0), (1, 0, 0)], "radius": 0.1},
    "obstacles.Moving": {"shape": bik.obstacles.Sphere((0, 0, 0), 0.1), "velocity": (0, 0, 0)},
    "obstacles.Sphere": {"center": (0, 0, 0), "radius": 0.1},
    "obstacles.clearance": {"robot": ARM, "q": START},
    "obstacles.nearest": {"robot": ARM, "q": START},
    "paths.circle": {**PLACED, "diameter": 0.1},
    "paths.from_function": {"function": lambda t: (t, 0, 0), "duration": 1.0},
    "paths.from_gcode": {"file": "G0 X0 Y0 Z0\nG0 X1"},
    "paths.GcodeProgram.": {".": bik.paths.from_gcode("G0 X0 Y0 Z0\nG0 X1")},
    "paths.GcodeProgram.path": {"rapid_speed": 0.1},
    "paths.Seam.": {".": bik.paths.raster(TABLE, spacing=0.1, direction=(1, 0, 0), side=(0, 0, 1))[0]},
    "paths.Seam.path": {"speed": 0.1},
    "paths.join": {"seams": bik.paths.raster(TABLE, spacing=0.1, direction=(1, 0, 0), side=(0, 0, 1))},
    "paths.on_surface": {"surface": TABLE, "points": [(0, 0, 0.1), (0.1, 0, 0.1)]},
    "paths.raster": {"surface": TABLE, "spacing": 0.1, "direction": (1, 0, 0), "side": (0, 0, 1)},
    "paths.from_samples": {"time": [0, 1], "positions_or_poses": [(0, 0, 0), (1, 0, 0)]},
    "paths.hypotrochoid": {**PLACED, "outer_radius": 0.3, "inner_radius": 0.1, "distance": 0.1},
    "paths.letter_m": {**PLACED, "width": 0.1, "height": 0.1},
    "paths.pentagram": {**PLACED, "radius": 0.1},
    "paths.polyline": {"points": [(0, 0, 0), (1, 0, 0)], "duration": 1.0},
    "paths.rose": {**PLACED, "radius": 0.1, "k": 3},
    "plan_along_path": {"robot": ARM, "path": LINE, "limits": LIMITS, **QUICK},
    "moves.Arc": {"via": (0, 0, 0), "pose": np.eye(4)},
    "moves.Joints": {"q_or_pose": START},
    "moves.Line": {"pose": np.eye(4)},
    "moves.Wait": {"seconds": 1.0},
    "plan_moves": {"robot": ARM, "moves": [bik.moves.Wait(1.0)], "start_q": START, "limits": LIMITS},
    "plan_batch": {"robot": PLANAR, "problems": [{"start": (1, 1, 0), "end": (1, 1.5, 0)}], "limits": LIMITS, **QUICK},
    "plan_point_to_point": {"robot": PLANAR, "start": (1, 1, 0), "end": (1, 1.5, 0), "limits": LIMITS, **QUICK},
    "papers.planar_posture": {"robot": PLANAR, "target": (1, 1, 0), "swarm": bik.papers.CircleSwarm()},
    "plot.animation": {"result": PLAN},
    "plot.calibration": {"result": CALIBRATION},
    "plot.model_free": {"result": MODEL_FREE},
    "plot.plan": {"plan": PLAN},
    "plot.robot": {"robot": ARM, "q": START},
    "plot.saturation": {"trajectory": MOTION, "limits": LIMITS},
    "plot.track": {"result": TRACK},
    "plot.trajectory": {"trajectory": MOTION},
    "pose": {"position": (0, 0, 0)},
    "reachability": {"robot": FLAT, "voxel": 0.5, "rolls": 2},
    "self_motion": {"robot": ARM, "target": bik.pose((0.3, 0.3, 1.0), rpy=(0, 1, 0)), "spacing": 0.2},
    "solve": {"robot": ARM, "target": (0.3, 0.3, 1.0), **QUICK},
    "solve_all": {"robot": ARM, "target": (0.3, 0.3, 1.0), "limit": 2, **QUICK},
    "solve_batch": {"robot": ARM, "targets": [(0.3, 0.3, 1.0)], "threads": 1, **QUICK},
    "state_to_state": {"start_q": [0, 0], "end_q": [1, 1], "limits": LIMITS},
    "time_optimal": {"waypoints_q": [[0, 0], [1, 1]], "limits": LIMITS},
    "track": {"robot": ARM, "path": LINE, **TICKS},
    "track_model_free": {"plant": bik.KinematicPlant(ARM), "path": LINE, **TICKS},
    "view": {"robot": ARM, "port": 0},
}
# A right call would change what the others are called on, or leave a film that nobody looks at.
ONLY_WRONG = ("ControlSession.command", "ControlSession.observe", "plot.animation")
MODULES = {"": bik, "tasks.": bik.tasks, "goals.": bik.goals, "paths.": bik.paths, "obstacles.": bik.obstacles}
MODULES["moves."] = bik.moves
MODULES |= {"papers.": bik.papers, "plot.": bik.plot, "filters.": bik.filters, "distributed.": distributed}


def public(prefix: str, module: ModuleType) -> Iterator[tuple[str, Callable[..., object]]]:
    """Functions, classes and their methods; methods bound to the instance in the table."""
    for name in module.__all__:
        thing = getattr(module, name)
        if isinstance(thing, ModuleType) or not callable(thing):
            continue
        if not isinstance(thing, type):
            yield prefix + name, thing
            continue
        if issubclass(thing, bik.BeetleIkError | bik.UnitsWarning | bik.Status):
            continue
        if name not in ("Goal", "Move", "Obstacle", "Task"):
            yield prefix + name, thing
        for method in vars(thing):
            if not method.startswith("_") and callable(getattr(thing, method)):
                full = f"{prefix}{name}.{method}"
                yield full, getattr(needed(full).get(".", thing), method)


def needed(name: str) -> dict[str, Any]:
    owner = name[: name.rfind(".") + 1]
    return {**NEEDED.get(owner, {}), **NEEDED.get(name, {})}


CALLS = {name: call for prefix, module in MODULES.items() for name, call in public(prefix, module)}
MADE_BY_THE_LIBRARY = [
    "BasePlacement",
    "BatchPlan",
    "BatchSolution",
    "Body",
    "Break",
    "Calibration",
    "ControlSession",
    "Identifiability",
    "InverseReachabilityMap",
    "Minimum",
    "ModelFreeResult",
    "MoveReport",
    "Path",
    "Plan",
    "ReachabilityMap",
    "Robot",
    "SelfMotion",
    "Solution",
    "SolutionSet",
    "SpeedBound",
    "Step",
    "TrackResult",
    "VelocityEllipsoid",
    "Viewer",
    "Violation",
    "distributed.BatchArrays",
    "papers.PlanarPosture",
    "paths.GcodeMove",
    "paths.GcodeProgram",
    "paths.Seam",
    "obstacles.Nearest",
]


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.fixture(autouse=True)
def _with_one_description(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Puts a package robot_descriptions of one robot in place of the real one, which downloads."""
    (tmp_path / "arm.urdf").write_text(URDF)
    package, names, arm = (ModuleType(f"robot_descriptions{end}") for end in ("", "._descriptions", ".arm_description"))
    names.DESCRIPTIONS = {"arm_description": []}  # type: ignore[attr-defined]
    arm.URDF_PATH = str(tmp_path / "arm.urdf")  # type: ignore[attr-defined]
    for module in (package, names, arm):
        monkeypatch.setitem(sys.modules, module.__name__, module)
    MOTION.to_csv("motion.csv")
    MOTION.to_npz("motion.npz")
    MAP.to_npz("reached.npz")
    bik.Scene().save("scene.json")
    Path("scene.yaml").write_text("world: {}")
    Path("map.bt").write_text("# Octomap OcTree binary file\nid OcTree\nsize 0\nres 0.1\ndata\n")


def refusal(call: Callable[..., object], arguments: dict[str, Any]) -> str | None:
    """What an exception of the right kind says, with its notes; None where there is none."""
    try:
        made = call(**arguments)
        if isinstance(made, bik.Viewer):
            made.close()
    except (bik.BeetleIkError, TypeError, ValueError, FileNotFoundError) as error:
        return "\n".join([str(error), *getattr(error, "__notes__", [])])
    return None


def arguments_of(name: str) -> list[str]:
    return list(inspect.signature(CALLS[name]).parameters)


WITH_ARGUMENTS = [name for name in CALLS if name not in MADE_BY_THE_LIBRARY and arguments_of(name)]


def test_the_table_has_no_call_that_is_gone() -> None:
    assert {name for name in NEEDED if not name.endswith(".")} <= set(CALLS)


@pytest.mark.parametrize("name", MADE_BY_THE_LIBRARY)
def test_results_cannot_be_made_by_hand(name: str) -> None:
    with pytest.raises(TypeError, match=name.rpartition(".")[2]):
        attrgetter(name)(bik)()


@pytest.mark.parametrize("name", [name for name in WITH_ARGUMENTS if name not in ONLY_WRONG])
def test_required_arguments_are_sufficient(name: str) -> None:
    arguments = {key: value for key, value in needed(name).items() if key in arguments_of(name)}
    assert refusal(CALLS[name], arguments) is None


@pytest.mark.parametrize("name", WITH_ARGUMENTS)
def test_wrong_arguments_are_named(name: str) -> None:
    names = arguments_of(name)
    right = {key: value for key, value in needed(name).items() if key in names}
    for argument in names:
        told = {kind: refusal(CALLS[name], {**right, argument: value}) for kind, value in WRONG.items()}
        word = rf"(?<!\w)({argument}|{WORDS.get(argument, argument)})(?!\w)"
        nameless = {kind: text for kind, text in told.items() if text is not None and not re.search(word, text)}
        assert not nameless, f"{name}({argument}=...) is not named"
        assert told["an object"] is not None, f"{name}({argument}=...) takes any object"


@pytest.mark.parametrize("name", [name for name in CALLS if name not in MADE_BY_THE_LIBRARY])
def test_unknown_options_are_refused(name: str) -> None:
    told = refusal(CALLS[name], {**{k: v for k, v in needed(name).items() if k != "."}, "no_such_option": 1})
    assert told is not None
    assert re.search(r"no_such_option|takes no (keyword )?arguments|unexpected keyword", told), told
