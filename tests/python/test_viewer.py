"""The viewer without a browser: its state, its threads, its errors."""

import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Collection, Iterator
from itertools import count
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from pair_of_pandas import pair_of_pandas
from typer.testing import CliRunner
from viewer_turns import until

import beetle_ik as bik
from beetle_ik.cli.app import app
from beetle_ik.viewing import address, postures, start
from beetle_ik.viewing.arm import Arm
from beetle_ik.viewing.checks import motion_of
from beetle_ik.viewing.displaced import displaced
from beetle_ik.viewing.looks import looks
from beetle_ik.viewing.worker import Request, Worker

PANDA = bik.Robot.named("panda").with_capsules(radius=0.06)
TIP = PANDA.tips[0]
START = np.array([0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.8])
BELOW = bik.pose([0.0, 0.0, -0.15]) @ PANDA.fk(START)
TABLE = bik.obstacles.Box((0.5, 0.0, 0.15), (0.5, 0.8, 0.1))
MARGIN = 1e-3  # m, the library's own
TICKS = 1000  # until an arm rests


@pytest.fixture
def viewer() -> Iterator[bik.Viewer]:
    with bik.view(PANDA, START, port=0) as viewer:
        yield viewer


def settle(viewer: bik.Viewer) -> None:
    until(lambda: not viewer.moves)


def ticks(arm: Arm) -> Iterator[float]:
    """Clearances of the ticks until the arm rests."""
    for _ in range(TICKS):
        moves = arm.advance()
        yield float(bik.obstacles.clearance(arm.robot, arm.q, arm.obstacles))
        if not moves:
            return
    raise AssertionError("the arm never rests")


# --- the arm ---


@pytest.mark.parametrize("follow", ["track", "solve"])
def test_the_arm_reaches_its_target(follow: str) -> None:
    arm = Arm(PANDA, START, [TABLE])
    arm.follow = follow  # type: ignore[assignment]
    arm.aim(TIP, BELOW)
    assert min(ticks(arm)) >= MARGIN - 1e-9
    assert arm.outcome is not None
    assert arm.outcome.success
    np.testing.assert_allclose(PANDA.fk(arm.q), BELOW, atol=1e-6)


def test_the_arm_keeps_within_its_velocity_limits() -> None:
    arm = Arm(PANDA, START, [])
    arm.aim(TIP, BELOW)
    before = START
    while arm.advance():
        assert (np.abs(arm.q - before) <= PANDA.velocity_limit / 60 + 1e-12).all()
        before = arm.q


def test_the_arm_stays_clear_of_an_obstacle_at_its_target() -> None:
    arm = Arm(PANDA, START, [TABLE])
    arm.aim(TIP, bik.pose([0.0, 0.0, -0.45]) @ PANDA.fk(START))  # in the table
    assert min(ticks(arm)) >= MARGIN - 1e-9
    assert arm.outcome is not None
    assert arm.outcome.status is bik.Status.HELD_BY_OBSTACLE


def test_the_arm_yields_to_an_obstacle_moved_into_it() -> None:
    arm = Arm(PANDA, START, [])
    arm.obstacles = [bik.obstacles.Sphere(PANDA.fk(START)[:3, 3], 0.1)]
    assert bik.obstacles.clearance(PANDA, START, arm.obstacles) < -0.1
    *_, last = ticks(arm)
    assert last >= MARGIN - 1e-9


def test_without_clearance_the_arm_goes_through() -> None:
    arm = Arm(PANDA, START, [TABLE])
    arm.keeps_clear = False
    arm.aim(TIP, bik.pose([0.0, 0.0, -0.45]) @ PANDA.fk(START))
    assert min(ticks(arm)) < 0.0
    assert arm.outcome is not None
    assert arm.outcome.success


def test_an_arm_that_was_put_into_an_obstacle_rests_there() -> None:
    through = bik.solve(PANDA, bik.pose([0.0, 0.0, -0.45]) @ PANDA.fk(START)).q
    arm = Arm(PANDA, START, [TABLE])
    arm.put(through)
    assert not arm.advance()
    assert arm.q is through
    np.testing.assert_array_equal(arm.targets[TIP], PANDA.fk(through))


def test_a_target_out_of_reach_is_approached_and_ends() -> None:
    arm = Arm(PANDA, START, [])
    arm.part = "position"
    arm.aim(TIP, bik.pose([2.0, 0.0, 0.333]))
    list(ticks(arm))
    assert arm.outcome is not None
    assert not arm.outcome.success
    assert np.linalg.norm(PANDA.fk(arm.q)[:3, 3] - arm.targets[TIP][:3, 3]) < 1.2  # its reach is 0.85 m


def test_an_approach_that_touches_an_obstacle_is_not_made() -> None:
    beyond = [1.5, 0.0, 0.4]
    wall = bik.obstacles.Box((0.7, 0.0, 0.5), (0.02, 2.0, 2.0))
    arm = Arm(PANDA, START, [wall])
    arm.part, arm.follow = "position", "solve"
    arm.aim(TIP, bik.pose(beyond))
    assert bik.solve(PANDA, beyond, start_q=START, obstacles=[wall]).status is bik.Status.OUT_OF_REACH
    assert min(ticks(arm)) >= MARGIN
    assert arm.stays
    arm.keeps_clear = False
    list(ticks(arm))
    assert not arm.stays


def test_an_arm_that_hunts_about_a_posture_comes_to_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    def hunting(_: Arm) -> SimpleNamespace:  # the null space beside a singular posture
        return SimpleNamespace(
            q=START + 0.01 * (-1) ** next(turns),
            qd=np.zeros(7),
            position_error=0.01,
            rotation_error=0.0,
            success=False,
        )

    turns = count()
    monkeypatch.setattr(Arm, "_track", hunting)
    arm = Arm(PANDA, START, [])
    arm.aim(TIP, BELOW)
    list(ticks(arm))
    assert next(turns) < 100


def test_solve_stays_out_of_an_obstacle() -> None:
    arm = Arm(PANDA, START, [TABLE])
    arm.aim(TIP, bik.pose([0.0, 0.0, -0.45]) @ PANDA.fk(START))
    arm.solve()
    assert arm.q is START
    assert arm.outcome is not None
    assert arm.outcome.status is bik.Status.IN_COLLISION


def test_pointing_leaves_the_turn_about_the_axis_free() -> None:
    arm = Arm(PANDA, START, [])
    arm.part = "pointing"
    turned = bik.pose([0, 0, 0], rpy=[0, 0, 3.0])
    arm.aim(TIP, PANDA.fk(START) @ turned)
    list(ticks(arm))
    assert arm.outcome is not None
    assert arm.outcome.success
    assert np.abs(arm.q - START).max() < 1e-6


# --- several tips ---

PAIR = bik.Robot.from_urdf(pair_of_pandas(), tip=["left_tool", "right_tool"])


@pytest.fixture
def pair() -> Iterator[bik.Viewer]:
    with bik.view(PAIR, port=0) as viewer:
        yield viewer


def test_an_arm_with_several_tips_begins_where_it_is_told(pair: bik.Viewer) -> None:
    q = PAIR.random_configurations(1, seed=0)[0]
    pair.q = q
    np.testing.assert_array_equal(pair.q, q)
    with pytest.raises(bik.InvalidInputError, match=r"^q must be one configuration \(16,\), got shape \(1, 16\)$"):
        pair.q = q[None]


def test_each_tip_has_a_target(pair: bik.Viewer) -> None:
    assert pair.follow == "track"
    before = pair.target
    assert list(before) == PAIR.tips
    pair.target = {"left_tool": before["left_tool"][:3, 3] + [0.0, 0.0, 0.1]}
    settle(pair)
    left, right = PAIR.fk(pair.q)
    np.testing.assert_allclose(left[:3, 3], before["left_tool"][:3, 3] + [0.0, 0.0, 0.1], atol=1e-5)
    np.testing.assert_allclose(right, before["right_tool"], atol=1e-5)
    for tip in PAIR.tips:
        assert pair.server.scene.get_handle_by_name(f"/target/{tip}") is not None


@pytest.mark.parametrize(
    ("name", "value", "told"),
    [
        ("target", np.eye(4), "target must be a dict with the tips 'left_tool', 'right_tool' as keys, got array([["),
        ("target", {"left": np.eye(4)}, "target: no tip is named 'left'; tips: 'left_tool', 'right_tool'"),
        ("target", {"left_tool": [1]}, "target of 'left_tool' must be a pose (4, 4) or a position (3,), got [1]"),
    ],
)
def test_targets_of_tips_are_refused_by_name(pair: bik.Viewer, name: str, value: object, told: str) -> None:
    with pytest.raises(bik.InvalidInputError) as refused:
        setattr(pair, name, value)
    assert str(refused.value).startswith(told)


def test_results_for_several_tips_are_shown(pair: bik.Viewer) -> None:
    q = pair.q
    plan = bik.plan_point_to_point(PAIR, start_q=q, end_q=PAIR.clip(0.8 * q), limits=bik.Limits(acceleration=5.0))
    pair.show(plan)
    until(lambda: np.abs(pair.q - q).max() > 0.05)
    pair.show(bik.solve(PAIR, dict(zip(PAIR.tips, PAIR.fk(q), strict=True)), start_q=q))
    np.testing.assert_allclose(pair.q, q, atol=1e-6)


def test_several_tips_without_bodies_get_balls() -> None:
    robot, notes = start.shown(PAIR.with_capsules([]), has_meshes=False)
    assert notes[0].startswith("no bodies in the model: balls at the joints, of radius ")
    q = start.configuration(robot, [])
    assert bik.obstacles.clearance(robot, q) > 0.0
    assert {body.link for body in robot.bodies} == set(robot.all_link_names)


# --- how links look ---

RED = """<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="0.01"/></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><phong>
<diffuse><color>1 0 0 1</color></diffuse></phong></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh><source id="s">
<float_array id="a" count="9">0 0 0 10 0 0 0 20 0</float_array><technique_common>
<accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
<triangles count="1" material="m"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w"><node><instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="m" target="#m"/></technique_common></bind_material></instance_geometry></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#w"/></scene></COLLADA>"""


def looking(folder: Path, visual: str, collision: str = "") -> bik.Robot:
    """Returns an arm whose link "arm" looks so."""
    (folder / "red.dae").write_text(RED)
    (folder / "plain.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (folder / "broken.stl").write_text("no mesh")
    shape = f"<collision>{collision}</collision>" if collision else ""
    file = folder / "arm.urdf"
    file.write_text(
        f"""<robot name="r"><material name="blue"><color rgba="0 0 1 0.5"/></material><link name="base"/>
        <link name="arm"><visual>{visual}</visual>{shape}</link>
        <joint name="j" type="continuous"><parent link="base"/><child link="arm"/></joint></robot>"""
    )
    return bik.Robot.from_urdf(file)


def test_a_mesh_is_shown_in_metres_at_its_place_with_its_material(tmp_path: Path) -> None:
    place = "<origin xyz='0 0 1' rpy='0 0 1.5707963267948966'/>"
    mesh = "<geometry><mesh filename='red.dae' scale='2 1 1'/></geometry><material name='blue'/>"
    ((link, scene),), notes = looks(looking(tmp_path, place + mesh))
    assert (link, notes) == ("arm", [])
    np.testing.assert_allclose(scene.bounds, [[-0.2, 0.0, 1.0], [0.0, 0.2, 1.0]], atol=1e-12)
    (part,) = scene.geometry.values()
    assert part.visual.material.main_color.tolist() == [255, 0, 0, 255]


def test_shapes_without_a_material_have_that_of_the_urdf(tmp_path: Path) -> None:
    for shape in ("<mesh filename='plain.obj'/>", "<box size='1 1 1'/>"):
        visual = f"<geometry>{shape}</geometry><material name='blue'/>"
        ((_, scene),), _ = looks(looking(tmp_path, visual))
        (part,) = scene.geometry.values()
        assert part.visual.material.main_color.tolist() == [0, 0, 255, 128]
        assert part.visual.material.alphaMode == "BLEND"


def test_files_that_are_missing_or_broken_are_named(tmp_path: Path) -> None:
    seen, notes = looks(looking(tmp_path, "<geometry><mesh filename='gone.stl'/></geometry>"))
    assert (seen, notes) == ([], ["1 file of visual meshes not found, such as gone.stl"])
    seen, notes = looks(looking(tmp_path, "<geometry><mesh filename='broken.stl'/></geometry>"))
    assert seen == []
    assert notes[0].startswith(f"cannot read '{tmp_path / 'broken.stl'}': ")


def test_a_collision_mesh_takes_the_place_of_a_visual_one(tmp_path: Path) -> None:
    mesh = "<geometry><mesh filename='plain.obj'/></geometry>"
    ((link, scene),), _ = looks(looking(tmp_path, "<geometry><mesh filename='gone.stl'/></geometry>", mesh))
    assert link == "arm"
    np.testing.assert_allclose(scene.bounds, [[0, 0, 0], [1, 1, 0]])


def test_bodies_around_meshes_are_hidden_and_attached_ones_are_not(tmp_path: Path) -> None:
    mesh = "<geometry><mesh filename='plain.obj'/></geometry>"
    robot = looking(tmp_path, mesh, "<geometry><sphere radius='1'/></geometry>")
    robot = robot.with_attached("arm", bik.obstacles.Sphere((0, 0, 1), 0.1))
    with bik.view(robot, port=0) as viewer:
        shown = viewer.server.scene.get_handle_by_name
        cover, attached = shown("/robot/arm/cover_0"), shown("/robot/attached/body_0")
        assert shown("/robot/arm/look_0") is not None
        assert cover is not None
        assert not cover.visible
        assert attached is not None
        assert attached.visible


# --- where it begins ---


@pytest.mark.parametrize("name", bik.Robot.names())
def test_every_robot_begins_inside_its_limits_and_clear(name: str) -> None:
    robot, notes = start.shown(bik.Robot.named(name), has_meshes=False)
    q = start.configuration(robot, [])
    assert (robot.clip(q) == q).all()
    assert bik.obstacles.clearance(robot, q) > 0.0
    assert robot.manipulability(q) > 0.0
    assert notes[0].startswith("no bodies in the model: capsules along the links, of radius ")


def test_joints_without_a_velocity_limit_get_one() -> None:
    robot, notes = start.shown(bik.Robot.planar([1, 1]), has_meshes=False)
    assert robot.velocity_limit.tolist() == [2.0, 2.0]
    assert notes[-1] == "2 joints without a velocity limit: here 2 rad/s or m/s"


def test_shapes_that_were_not_read_are_named() -> None:
    body = "<collision><geometry><{}/></geometry></collision>"
    urdf = f"""<robot name="r"><link name="base">{body.format("sphere radius='0.1'")}</link>
    <link name="tip">{body.format("mesh filename='no.stl'")}</link>
    <joint name="j" type="continuous"><origin xyz="0 0 0.5"/><parent link="base"/><child link="tip"/></joint></robot>"""
    robot, notes = start.shown(bik.Robot.from_urdf(urdf), has_meshes=False)
    assert notes[0].startswith("1 collision shape not read: capsules along the links, of radius 20 mm, take")
    assert bik.obstacles.clearance(robot, [0.0]) == np.inf
    _, notes = start.shown(bik.Robot.from_urdf(urdf), has_meshes=True)
    assert notes[0].startswith("1 collision shape not read, and not kept clear: Robot.from_urdf(..., coll")


SHAPES = [
    bik.obstacles.Sphere((0.6, 0.1, 0.5), 0.1, touch=["link_1"]),
    bik.obstacles.Box((0.6, 0.1, 0.5), (0.1, 0.2, 0.3), bik.pose((0, 0, 0), rpy=(0.1, 0.2, 0.3))[:3, :3]),
    bik.obstacles.Capsule((0.6, 0.1, 0.5), (0.6, 0.3, 0.4), 0.05),
    bik.obstacles.Cylinder((0.6, 0.1, 0.5), (0, 1, 1), 0.05, 0.3),
    bik.obstacles.Ellipsoid((0.6, 0.1, 0.5), (0.1, 0.2, 0.05)),
    bik.obstacles.HalfSpace((0.1, 0.2, 1.0), 0.1),
    bik.obstacles.ConvexMesh([(0.6, 0, 0.4), (0.7, 0, 0.4), (0.6, 0.1, 0.4), (0.6, 0, 0.5)]),
    bik.obstacles.Mesh([(0.6, 0, 0.4), (0.7, 0, 0.4), (0.6, 0.1, 0.4)], [(0, 1, 2)]),
    bik.obstacles.PointCloud([(0.6, 0, 0.4), (0.7, 0, 0.4)], 0.02),
]


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: type(shape).__name__)
def test_an_obstacle_moved_with_the_base_is_as_far_as_before(shape: bik.obstacles.Obstacle) -> None:
    by = bik.pose([0.3, -0.2, 0.1], rpy=[0.4, -0.7, 1.1])
    moved = displaced(shape, by)
    assert moved is not None
    assert moved.touch == shape.touch
    q = PANDA.random_configurations(20, seed=1)
    before = bik.obstacles.clearance(PANDA.with_collision_pairs([]), q, [shape])
    after = bik.obstacles.clearance(PANDA.with_base(by).with_collision_pairs([]), q, [moved])
    np.testing.assert_allclose(after, before, atol=2e-8)


def test_a_grid_and_an_ellipse_stay() -> None:
    assert displaced(bik.obstacles.Grid((0, 0, 0), 0.1, [[[True]]]), np.eye(4)) is None
    assert displaced(bik.obstacles.Ellipse((0, 0), (1, 2)), np.eye(4)) is None


# --- the thread ---


def test_the_newest_request_of_a_source_is_carried_out() -> None:
    done: list[str] = []
    worked = threading.Event()

    def work(requests: Collection[Request]) -> bool:
        for request in requests:
            request()
        worked.set()
        return False

    worker = Worker(work, 0.01)
    for source, word in (("a", "old"), ("b", "kept"), ("a", "new")):
        worker.ask(source, lambda word=word: done.append(word))  # type: ignore[misc]
    worker.start()
    worked.wait()
    worker.close()
    assert done == ["kept", "new"]


def test_a_closed_viewer_leaves_no_thread() -> None:
    before = set(threading.enumerate())
    viewer = bik.view(PANDA, START, port=0)
    viewer.target = BELOW
    viewer.close()
    viewer.close()
    assert set(threading.enumerate()) <= before
    assert repr(viewer) == "<Viewer of 'panda', closed>"
    assert viewer.q.shape == (7,)
    with pytest.raises(bik.BeetleIkError, match=r"the viewer of 'panda' is closed: bik.view opens another one"):
        viewer.q = START


def test_closing_does_not_wait_for_a_search(viewer: bik.Viewer, monkeypatch: pytest.MonkeyPatch) -> None:
    begun, closed, ended = threading.Event(), threading.Event(), threading.Event()

    def search(*_: object, **__: object) -> list[bik.SelfMotion]:
        begun.set()
        closed.wait()
        ended.set()
        return []

    monkeypatch.setattr(postures, "self_motion", search)
    viewer._turns.ask("page", viewer._parts._postures._find_self_motion)
    begun.wait()
    viewer.close()
    assert not ended.is_set()
    closed.set()
    ended.wait()


def test_a_callback_may_set_and_close(viewer: bik.Viewer) -> None:
    seen: list[np.ndarray] = []

    def once(target: np.ndarray) -> None:
        seen.append(target)
        viewer.q = START
        viewer.close()

    viewer.on_target(once)
    viewer.target = BELOW
    viewer.wait()
    np.testing.assert_allclose(seen[0], BELOW, atol=1e-15)


def test_an_error_of_a_callback_is_logged(viewer: bik.Viewer, caplog: pytest.LogCaptureFixture) -> None:
    viewer.on_target(lambda _: 1 / 0)
    viewer.target = BELOW
    settle(viewer)
    until(lambda: caplog.records)
    assert caplog.records[0].getMessage() == "an error in the viewer of 'panda'"
    viewer.q = START  # the thread lives
    np.testing.assert_array_equal(viewer.q, START)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows sends no SIGINT to a single process")
def test_ctrl_c_ends_a_viewer_that_blocks() -> None:
    # Jobs in the background of a shell begin with SIGINT ignored, and so do their children.
    program = """
import signal
import beetle_ik as bik
signal.signal(signal.SIGINT, signal.default_int_handler)
wait = bik.Viewer.wait
bik.Viewer.wait = lambda viewer: print("waits", flush=True) or wait(viewer)
bik.view(bik.Robot.named("panda"), port=0, block=True)
"""
    running = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert running.stdout is not None
    assert b"waits\n" in running.stdout
    running.send_signal(signal.SIGINT)
    try:
        _, errors = running.communicate()
    finally:
        running.kill()
    assert errors.decode().strip().endswith("KeyboardInterrupt")


# --- what Python sets and reads ---


def test_python_reads_what_it_sets(viewer: bik.Viewer) -> None:
    q = START + 0.1
    viewer.q = q
    np.testing.assert_array_equal(viewer.q, q)
    np.testing.assert_allclose(viewer.target, PANDA.fk(q), atol=1e-15)
    viewer.target = (0.5, 0.1, 0.5)
    np.testing.assert_allclose(viewer.target, bik.pose((0.5, 0.1, 0.5), matrix=PANDA.fk(q)[:3, :3]), atol=1e-15)
    settle(viewer)
    np.testing.assert_allclose(PANDA.fk(viewer.q), viewer.target, atol=1e-6)
    viewer.obstacles = [TABLE]
    assert viewer.obstacles == bik.Scene([TABLE])


def test_an_arm_that_does_not_follow_is_moved_from_outside(viewer: bik.Viewer) -> None:
    home = viewer.target
    viewer.follow = "off"
    outside = np.full(7, 9.0)  # measured, say
    viewer.q = outside
    np.testing.assert_array_equal(viewer.q, outside)
    np.testing.assert_array_equal(viewer.target, home)
    viewer.follow = "track"
    settle(viewer)
    assert (PANDA.clip(viewer.q) == viewer.q).all()


@pytest.mark.parametrize(
    ("name", "value", "told"),
    [
        ("q", np.full(7, 9.0), "q: joint 'panda_joint1' at 9 is outside its limits [-2.8973, 2.8973]"),
        ("q", [START], "q must be one configuration (7,), got shape (1, 7)"),
        ("target", np.eye(3), "target must be a pose (4, 4) or a position (3,), got array([["),
        ("target", np.diag([1, 1, 2, 1]), "target: matrix is not a rigid transform: "),
        ("target", (0, 0, np.nan), "target: position must be finite, but entry 2 is NaN"),
        ("follow", "fly", "follow must be one of 'track', 'solve', 'off', got 'fly'"),
        ("obstacles", [1], "obstacle 0 must be made by bik.obstacles, such as Sphere or Box, got 1"),
    ],
)
def test_what_cannot_be_set_is_refused_by_name(viewer: bik.Viewer, name: str, value: object, told: str) -> None:
    with pytest.raises(bik.InvalidInputError) as refused:
        setattr(viewer, name, value)
    assert str(refused.value).startswith(told)


def test_results_are_shown(viewer: bik.Viewer) -> None:
    solutions = bik.solve_all(PANDA, BELOW)
    for result in (solutions, solutions[0], bik.self_motion(PANDA, BELOW)[0]):
        viewer.show(result)
        np.testing.assert_allclose(PANDA.fk(viewer.q), BELOW, atol=1e-6)
    plan = bik.plan_point_to_point(
        PANDA, start_q=START, end=BELOW, obstacles=[TABLE], limits=bik.Limits(acceleration=5.0)
    )
    line = bik.paths.polyline([PANDA.fk(START)[:3, 3], BELOW[:3, 3]], duration=1.0)
    track = bik.track(PANDA, line, START, dt=0.1)
    free = bik.track_model_free(bik.KinematicPlant(PANDA), line, START, dt=0.1)
    for moving in (plan, track, free, plan.trajectory):
        viewer.q = START
        viewer.show(moving)
        motion = motion_of(moving)
        assert motion is not None
        end = motion.at(motion.duration)[0]
        until(lambda end=end: np.abs(viewer.q - end).max() < 0.2 * np.abs(START - end).max())
    assert viewer.obstacles == bik.Scene([TABLE])


def test_a_map_is_shown_as_a_cloud(viewer: bik.Viewer) -> None:
    region = [(0.2, 0.2, 0.2), (0.6, 0.6, 0.6)]
    viewer.show(bik.reachability(viewer.robot, voxel=0.2, directions=4, rolls=1, region=region))
    other = bik.reachability(bik.Robot.named("ur5e"), voxel=0.2, directions=4, rolls=1, region=region)
    with pytest.raises(bik.InvalidInputError) as raised:
        viewer.show(other)
    assert str(raised.value) == f"result is a map of robot 'ur5e', not of '{viewer.robot.name}'"


def test_results_without_anything_to_show_change_nothing(viewer: bik.Viewer) -> None:
    with pytest.raises(bik.InvalidInputError, match="result has 6 joints, and robot 'panda' has 7"):
        viewer.show(bik.solve(bik.Robot.named("ur5"), np.eye(4)))
    viewer.show(bik.solve_all(PANDA, [3.0, 0.0, 0.0]))  # none: the page says why
    np.testing.assert_array_equal(viewer.q, START)
    with pytest.raises(bik.InvalidInputError, match=r"result must be a Trajectory, Plan, TrackResult, .*, got 1"):
        viewer.show(1)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "path", [bik.paths.circle((0.3, 0.3, 0.5), 0.2, 1.0), np.zeros((5, 3)), np.tile(np.eye(4), (3, 1, 1))]
)
def test_a_path_is_drawn(path: object) -> None:
    with bik.view(PANDA, START, path=path, port=0) as viewer:  # type: ignore[arg-type]
        assert viewer.server.scene.get_handle_by_name("/path") is not None


def test_a_notebook_shows_the_page_inline(viewer: bik.Viewer) -> None:
    assert viewer._repr_html_().startswith(f'<iframe src="{viewer.url}" ')


# --- where it is served ---


def test_a_port_in_use_gives_way_to_the_next(viewer: bik.Viewer) -> None:
    port = int(viewer.url.rpartition(":")[2])
    with bik.view(PANDA, START, port=port) as second:
        assert int(second.url.rpartition(":")[2]) > port
        second.q = START + 0.1
        np.testing.assert_array_equal(viewer.q, START)


def test_a_port_that_may_not_be_used_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(socket.socket, "bind", refuse)
    with pytest.raises(bik.InvalidInputError, match="port 80 cannot be used: Permission denied; ports from 1024 on"):
        address.free_port("127.0.0.1", 80)


@pytest.mark.parametrize(
    ("host", "port", "told"),
    [
        ("192.0.2.1", 8080, "host '192.0.2.1' is not an address of this machine; 127.0.0.1: only this machine"),
        ("", 8080, "host is empty: 127.0.0.1 is this machine"),
        ("127.0.0.1", 65536, "port must be a whole number from 0 to 65535, got 65536"),
        ("127.0.0.1", "http", "port must be a whole number from 0 to 65535, got 'http'"),
    ],
)
def test_a_wrong_address_is_refused(host: str, port: int, told: str) -> None:
    with pytest.raises(bik.InvalidInputError) as refused:
        bik.view(PANDA, host=host, port=port)
    assert str(refused.value).startswith(told)


def test_without_viser_an_error_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "viser", None)
    with pytest.raises(bik.BeetleIkError, match=r"the viewer needs viser: pip install 'beetle-ik\[view\]'"):
        bik.view(PANDA)


# --- the command line ---


def test_the_command_serves_until_it_is_interrupted(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    served: list[bik.Viewer] = []

    def interrupted(viewer: bik.Viewer) -> None:
        served.append(viewer)
        viewer.close()
        raise KeyboardInterrupt

    monkeypatch.setattr(bik.Viewer, "wait", interrupted)
    bik.Scene([TABLE]).save(tmp_path / "scene.json")
    command = ["view", "panda", "--port", "0", "--link-radius", "0.06", "--scene", str(tmp_path / "scene.json")]
    assert CliRunner().invoke(app, [*command, "--start-q", ",".join(map(str, START))]).exit_code == 0
    assert served[0].obstacles == bik.Scene([TABLE])
    np.testing.assert_array_equal(served[0].q, START)


def test_the_command_shows_a_file_whose_meshes_are_missing(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(bik.Viewer, "wait", bik.Viewer.close)
    file = tmp_path / "arm.urdf"
    file.write_text(
        """<robot name="r"><link name="base"/><link name="tip"><collision><geometry><mesh filename="no.stl"/></geometry>
        </collision></link><joint name="j" type="continuous"><origin xyz="0 0 0.5"/><parent link="base"/>
        <child link="tip"/></joint></robot>"""
    )
    done = CliRunner().invoke(app, ["view", str(file), "--port", "0"])
    assert done.exit_code == 0
    assert done.stderr.startswith("Without its meshes: ")
    assert "no.stl" in done.stderr
