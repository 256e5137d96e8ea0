"""Ctrl-C ends any call: every public callable is interrupted in the middle, or listed with the reason why it is short.

A signal comes for every 10 ms of computing, and its handler raises when the call looks for signals the third time. At
most 100 come between two looks.
"""

import itertools
import math
import sys
import tempfile
import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from iiwa_circle import IIWA, START
from interrupts import MOST, interrupted
from test_every_call import CALLS, MADE_BY_THE_LIBRARY

import beetle_ik as bik
from beetle_ik import distributed

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no timer sends signals on Windows")

ENDLESS = bik.Stop(max_evaluations=10**12, max_iterations=10**12)
CAPSULES = IIWA.with_capsules(radius=0.05)
UR5 = bik.Robot.named("ur5")
PANDA = bik.Robot.named("panda")
PLANAR = bik.Robot.planar([0.5] * 3)
INSIDE_SHOULDER = [0.0, 0.0, 0.36]
FAST = bik.Limits(velocity=1.0, acceleration=5.0)
ENCLOSED = {"start_q": [1.57, 1.0, 0, 0, 0, 0, 0], "end_q": [-1.57, 1.0, 0, 0, 0, 0, 0], "limits": FAST}
CIRCLE = bik.paths.circle((0.3, 0.3, 1.0), diameter=0.2, duration=1000.0)
ORIENTED = CIRCLE.with_orientation(np.eye(3))


def rows(count: int, n: int = 7) -> np.ndarray:
    return np.zeros((count, n))


def waves(knots: int) -> Callable[[], bik.Trajectory]:
    t = np.arange(knots) * 1e-3
    q, qd, qdd = (wave[:, None] * np.ones((1, 2)) for wave in (np.sin(t), np.cos(t), -np.sin(t)))
    return lambda: bik.Trajectory.from_samples(t, q, qd=qd, qdd=qdd)


def urdf(links: int) -> str:
    joints = "".join(
        f'<link name="l{i}"/><joint name="j{i}" type="fixed"><parent link="l{i - 1}"/><child link="l{i}"/></joint>'
        for i in range(1, links)
    )
    turning = '<joint name="turn" type="continuous"><parent link="base"/><child link="l0"/></joint>'
    return f'<robot name="long"><link name="base"/><link name="l0"/>{turning}{joints}</robot>'


def walled_in() -> list[bik.obstacles.Box]:
    """Walls that leave a gap around the base, too narrow to pass: the search for a way does not end."""
    sides = [bik.obstacles.Box((x, 0.0, 1.0), size=(2.0, 0.02, 2.0)) for x in (-1.12, 1.12)]
    return [*sides, bik.obstacles.Box((0.0, 0.0, 1.62), size=(0.24, 0.02, 2.0))]


def table() -> dict[str, Callable[[], Callable[[], object]]]:
    """For each call a function that prepares its input, and returns the long call."""
    far = bik.paths.circle((5.0, 5.0, 5.0), diameter=0.2, duration=3600.0)
    slow = bik.papers.BAS(explorations=10**9)
    return {
        "Path.position": lambda: with_times(CIRCLE.position),
        "Path.velocity": lambda: with_times(CIRCLE.velocity),
        "Path.pose": lambda: with_times(ORIENTED.pose, 1_500_000),
        "Path.sample": lambda: lambda: CIRCLE.sample(1.2e-4),
        "Robot.fk": lambda: with_rows(IIWA.fk, 2_000_000),
        "Robot.clip": lambda: with_rows(IIWA.clip, 4_000_000),
        "Robot.wrap": lambda: with_rows(IIWA.wrap, 2_000_000),
        "Robot.jacobian": lambda: with_rows(IIWA.jacobian, 800_000),
        "Robot.torques": lambda: with_rows(PANDA.torques, 1_600_000),
        "Robot.mass_matrix": lambda: with_rows(PANDA.mass_matrix, 400_000),
        "Robot.accelerations": lambda: with_rows(lambda q: PANDA.accelerations(q, q, q), 300_000),
        "Robot.center_of_mass": lambda: with_rows(PANDA.center_of_mass, 2_000_000),
        "Trajectory.torques": lambda: torques_of_waves(),
        "Robot.manipulability": lambda: with_rows(IIWA.manipulability, 1_000_000),
        "Robot.random_configurations": lambda: lambda: IIWA.random_configurations(10_000_000),
        "Robot.collision_meshes": lambda: with_mesh(300_000),
        "Robot.from_urdf": lambda: with_text(urdf(60_000)),
        "Tracker.step": lambda: with_target(bik.Tracker(IIWA, START, dt=0.1, solver=slow)),
        "Trajectory.at": lambda: with_times(waves(100_000)().at, 6_000_000),
        "Trajectory.sample": lambda: sampled(waves(100_000)()),
        "Trajectory.from_samples": lambda: waves(3_000_000),
        "distributed.reachability": lambda: lambda: distributed.reachability(None, IIWA, voxel=0.02, threads=2),
        "distributed.solve_batch": lambda: (
            lambda: distributed.solve_batch(None, IIWA, [INSIDE_SHOULDER] * 9, stop=ENDLESS, threads=2)
        ),
        "ReachabilityMap.query": lambda: posed_query(1_000_000),
        "best_base": lambda: lambda: bik.best_base(UR5, UR5.fk(rows(1, 6)), region=[(-1, -1, 0), (1, 1, 0)]),
        "reachability": lambda: lambda: bik.reachability(UR5, voxel=0.02, directions=200, threads=2),
        "calibrate": lambda: measured(60_000),
        "minimize": lambda: (
            lambda: bik.minimize(np.sum, [-1] * 9, [1] * 9, solver=bik.papers.PSO(stall_generations=None), stop=ENDLESS)
        ),
        "obstacles.ConvexMesh": lambda: hull(45_000),
        "obstacles.Grid": lambda: occupied(300),
        "obstacles.Mesh": lambda: soup(1_000_000),
        "obstacles.PointCloud": lambda: cloud(3_000_000),
        "obstacles.PointCloud.without_robot": lambda: without_robot(cloud(400_000)()),
        "obstacles.Grid.without_robot": lambda: without_robot(occupied(120)()),
        "obstacles.clearance": lambda: with_rows(lambda q: bik.obstacles.clearance(CAPSULES, q), 400_000),
        "paths.from_samples": lambda: posed(500_000),
        "plan_along_path": lambda: lambda: bik.plan_along_path(IIWA, CIRCLE, limits=FAST, stop=ENDLESS),
        "plan_batch": lambda: (
            lambda: bik.plan_batch(CAPSULES, [ENCLOSED] * 3, obstacles=walled_in(), stop=ENDLESS, threads=2)
        ),
        "plan_point_to_point": lambda: (
            lambda: bik.plan_point_to_point(CAPSULES, **ENCLOSED, obstacles=walled_in(), stop=ENDLESS)
        ),
        "plan_moves": lambda: (
            lambda: bik.plan_moves(
                CAPSULES,
                [bik.moves.Joints(ENCLOSED["end_q"])],
                start_q=ENCLOSED["start_q"],
                limits=FAST,
                obstacles=walled_in(),
                stop=ENDLESS,
            )
        ),
        "papers.planar_posture": lambda: (
            lambda: bik.papers.planar_posture(
                PLANAR, [0.5, 0.5, 0.0], swarm=bik.papers.CircleSwarm(population=1000, generations=10**6)
            )
        ),
        "self_motion": lambda: lambda: bik.self_motion(IIWA, IIWA.fk(START), spacing=1e-3),
        "solve": lambda: lambda: bik.solve(IIWA, INSIDE_SHOULDER, stop=ENDLESS),
        "solve_all": lambda: lambda: bik.solve_all(IIWA, [0.5, 0.0, 0.6], limit=10**9, stop=ENDLESS),
        "solve_batch": lambda: lambda: bik.solve_batch(IIWA, [INSIDE_SHOULDER] * 9, stop=ENDLESS, threads=2),
        "Viewer.record": lambda: recorded(bik.view(IIWA, port=0)),
        "Viewer.wait": lambda: beside_work(bik.view(IIWA, port=0).wait),
        "view": lambda: beside_work(lambda: bik.view(IIWA, port=0, block=True)),
        "time_optimal": lambda: waypoints(100_000),
        "track": lambda: (
            lambda: bik.track(IIWA, far, START, dt=0.01, solver=bik.papers.BAS(), position_tolerance=1e-12)
        ),
        "track_model_free": lambda: (
            lambda: bik.track_model_free(
                bik.KinematicPlant(IIWA), CIRCLE, START, dt=5e-4, controller=bik.papers.ZNNBAS()
            )
        ),
    }


def beside_work(call: Callable[[], object]) -> Callable[[], object]:
    """A call that only waits, while a thread computes: signals come for that."""

    def both() -> None:
        ended = threading.Event()
        worker = threading.Thread(target=lambda: all(not ended.is_set() for _ in itertools.repeat(None)))
        worker.start()
        try:
            call()
        finally:
            ended.set()
            worker.join()

    return both


def recorded(viewer: bik.Viewer) -> Callable[[], object]:
    return lambda: viewer.record("motion.viser", itertools.repeat(0.0))


def with_rows(call: Callable[[np.ndarray], object], count: int) -> Callable[[], object]:
    q = rows(count)
    return lambda: call(q)


def with_times(call: Callable[[np.ndarray], object], count: int = 3_000_000) -> Callable[[], object]:
    t = np.linspace(0.0, 50.0, count)
    return lambda: call(t)


def measured(count: int) -> Callable[[], object]:
    q = IIWA.random_configurations(count)
    poses = IIWA.fk(q)
    return lambda: bik.calibrate(IIWA, q, poses)


def with_text(text: str) -> Callable[[], object]:
    return lambda: bik.Robot.from_urdf(text)


def with_mesh(count: int) -> Callable[[], object]:
    folder = tempfile.TemporaryDirectory()
    triangles = np.zeros(count, [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    triangles["corners"] = np.random.default_rng(0).random((count, 3, 3))
    (Path(folder.name) / "link.stl").write_bytes(bytes(80) + count.to_bytes(4, "little") + triangles.tobytes())
    collision = "<link name='l0'><collision><geometry><mesh filename='link.stl'/></geometry></collision></link>"
    file = Path(folder.name) / "arm.urdf"
    file.write_text(urdf(1).replace('<link name="l0"/>', collision))
    robot = bik.Robot.from_urdf(file)

    def call() -> object:
        with folder:
            return robot.collision_meshes()

    return call


def with_target(tracker: bik.Tracker) -> Callable[[], object]:
    return lambda: tracker.step([5.0, 5.0, 5.0])


def sampled(motion: bik.Trajectory) -> Callable[[], object]:
    return lambda: motion.sample(1.5e-5)


def hull(count: int) -> Callable[[], object]:
    points = np.random.default_rng(0).standard_normal((count, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    return lambda: bik.obstacles.ConvexMesh(points)


def occupied(count: int) -> Callable[[], object]:
    voxels = np.random.default_rng(0).random((count, count, count)) < 0.3
    return lambda: bik.obstacles.Grid([0, 0, 0], 0.01, voxels)


def soup(count: int) -> Callable[[], object]:
    corners = np.random.default_rng(0).random((3 * count, 3))
    faces = np.arange(3 * count).reshape(count, 3)
    return lambda: bik.obstacles.Mesh(corners, faces)


def cloud(count: int) -> Callable[[], object]:
    points = np.random.default_rng(0).random((count, 3))
    return lambda: bik.obstacles.PointCloud(points, 0.01)


def without_robot(seen: object) -> Callable[[], object]:
    return lambda: [seen.without_robot(CAPSULES, np.zeros(CAPSULES.dof), padding=1.0) for _ in range(20)]


def posed(count: int) -> Callable[[], object]:
    time, poses = np.arange(count) * 1e-3, np.tile(np.eye(4), (count, 1, 1))
    poses[:, 0, 3] = time
    return lambda: bik.paths.from_samples(time, poses)


def posed_query(count: int) -> Callable[[], object]:
    found, poses = bik.reachability(PLANAR, voxel=0.5), np.tile(np.eye(4), (count, 1, 1))
    return lambda: found.query(poses)


def torques_of_waves() -> Callable[[], object]:
    arm = bik.Robot.planar([0.5, 0.4])
    heavy = arm.with_inertias([bik.Inertia(link, 1.0, (-0.1, 0, 0)) for link in arm.link_names[1:]])
    return with_times(lambda t: waves(1000)().torques(heavy, t), 1_000_000)


def waypoints(count: int) -> Callable[[], object]:
    q = np.cumsum(np.random.default_rng(0).standard_normal((count, 12)), axis=0)
    return lambda: bik.time_optimal(q, FAST)


PLANNED = "a plan has at most some thousand knots"
CONSTANT = "its work does not grow with any argument"
ONE = "one configuration of at most 64 joints"
COPIES = "as fast as its arrays are copied"
PYTHON = "Python and matplotlib, which the interpreter interrupts"
SHORT: dict[str, str] = {
    **dict.fromkeys(MADE_BY_THE_LIBRARY, "made by other calls"),
    **dict.fromkeys(
        [
            "papers.APPS", "papers.APPS.paper", "papers.BAS", "papers.PSO", "papers.QPSO", "papers.TPBSO",
            "papers.ZNNBAS", "papers.ZNNBAS.session", "papers.BeeColony", "papers.BeetleSwarm", "BroydenBAS",
            "BroydenBAS.session", "papers.CircleSwarm", "DifferentialEvolution", "papers.Firefly", "papers.Genetic",
            "JacobianTranspose", "KinematicPlant", "LevenbergMarquardt", "MultiStart", "NewtonRaphson",
            "Path.with_orientation", "Sinusoid", "Stop", "WeightedPseudoInverse", "show_versions", "tasks.Orientation",
            "tasks.Pointing", "tasks.Pose", "tasks.Position", "goals.Centring", "goals.Clearance", "goals.LeastTorque",
            "goals.LinkManipulability", "goals.Manipulability", "goals.Posture", "paths.circle", "paths.from_function",
            "paths.hypotrochoid", "paths.letter_m", "paths.pentagram", "paths.rose", "obstacles.Box",
            "obstacles.Capsule", "obstacles.Cylinder", "obstacles.Ellipse", "obstacles.Ellipsoid",
            "obstacles.HalfSpace", "obstacles.Moving", "obstacles.Sphere",
            "Inertia", "filters.LowPass", "filters.OneEuro", "StraightLine", "Keep", "upright", "moves.Arc",
            "moves.Joints", "moves.Line", "moves.Wait",
        ],
        CONSTANT,
    ),
    **dict.fromkeys(
        [
            "ControlSession.command", "ControlSession.observe", "KinematicPlant.move", "Limits", "Robot.from_dh",
            "Robot.planar", "Robot.named", "Robot.names", "Robot.link_poses", "Robot.with_tool", "Robot.with_base",
            "Robot.with_limits", "Robot.with_capsules", "Robot.with_errors", "Robot.manipulability_gradient",
            "Robot.link_manipulability", "Robot.velocity_ellipsoid", "Tracker", "Tracker.reset", "Tracker.stop", "pose",
            "state_to_state", "obstacles.nearest", "Robot.all_link_poses", "Robot.q_from", "Robot.with_held",
            "Robot.with_attached",
            "Robot.with_gravity", "Robot.with_inertias", "Robot.with_payload",
            "Robot.with_collision_pairs", "Robot.with_mobile_base", "Robot.with_srdf",
        ],
        ONE,
    ),
    **dict.fromkeys(
        ["InverseReachabilityMap.query", "InverseReachabilityMap.on_floor", "InverseReachabilityMap.plot",
         "ReachabilityMap.inverse", "ReachabilityMap.plot", "ReachabilityMap.poses", "ReachabilityMap.reached",
         "paths.GcodeProgram.path", "paths.GcodeProgram.seams", "paths.Seam.path", "paths.from_gcode", "paths.join",
         "paths.on_surface", "paths.raster"],
        "Python and numpy, which the interpreter interrupts",
    ),
    "Plan.retime": PLANNED,
    "Plan.torques": "as Trajectory.torques",
    **dict.fromkeys(
        ["Trajectory.max_velocity", "Trajectory.max_acceleration", "Trajectory.max_jerk"],
        "looks at a segment for nanoseconds: 12 ms for 1,500,000 of two joints",
    ),
    "Calibration.to_urdf": "reads a text once, as from_urdf",
    **dict.fromkeys(["Viewer.close", "Viewer.on_target", "Viewer.show", "Viewer.to_python"], "hands over to a thread"),
    **dict.fromkeys(
        ["ReachabilityMap.load", "ReachabilityMap.to_npz", "Trajectory", "Trajectory.then", "Trajectory.to_npz",
         "Trajectory.from_npz", "paths.polyline"],
        COPIES,
    ),
    **dict.fromkeys(
        [
            "Robot.from_mjcf", "Robot.from_description", "Scene", "Scene.load", "Scene.save", "Scene.from_moveit",
            "Scene.from_trimesh", "Scene.from_octomap", "Scene.attach_to",
            "ModelFreeResult.plot", "Plan.plot", "TrackResult.plot", "Trajectory.plot", "Trajectory.to_csv",
            "Trajectory.from_csv", "plot.animation", "plot.calibration", "plot.model_free", "plot.plan", "plot.robot",
            "plot.saturation",
            "plot.track", "plot.trajectory",
        ],
        PYTHON,
    ),
}  # fmt: skip
LONG = table()
WAITING = ("Viewer.wait", "view")  # as many signals come as the other thread computes


def test_every_public_call_is_in_one_table() -> None:
    assert set(LONG) | set(SHORT) == set(CALLS)
    assert not set(LONG) & set(SHORT)


@pytest.mark.parametrize("name", LONG)
def test_a_long_call_looks_for_signals(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    call = LONG[name]()
    with pytest.raises(KeyboardInterrupt), interrupted(most=math.inf if name in WAITING else MOST):
        call()
    assert bik.solve(IIWA, [0.4, 0.3, 0.9]).success


@pytest.mark.parametrize("task", [None, bik.tasks.Pointing()], ids=["pose", "pointing"])
def test_a_plan_without_a_clear_posture_looks_for_signals(task: bik.tasks.Task | None) -> None:
    with pytest.raises(KeyboardInterrupt), interrupted():
        bik.plan_along_path(CAPSULES, ORIENTED, task=task, limits=FAST, obstacles=[], margin=1.0)


def test_a_search_for_a_clear_solution_looks_for_signals() -> None:
    rng = np.random.default_rng(0)
    places = [(rng.uniform(-0.8, 0.8, 3), rng.uniform(0.05, 0.2, 3)) for _ in range(1000)]
    # No joint moves the first capsule: what it touches would end the search at once.
    boxes = [bik.obstacles.Box(center, size, touch=["link_1"]) for center, size in places]
    target = CAPSULES.fk([0.1, 0.5, 0.1, -1.4, 0.1, 1.0, 0.3])
    with pytest.raises(KeyboardInterrupt), interrupted():
        bik.solve(CAPSULES, target, task=bik.tasks.Pointing(), obstacles=boxes, margin=0.3, stop=ENDLESS)
