"""Tools of the viewer's page: plans, programs, sizes, files of scenes, slices of maps."""

import itertools
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from pair_of_pandas import pair_of_pandas
from viewer_turns import until

import beetle_ik as bik
from beetle_ik.viewing.incoming import Incoming
from beetle_ik.viewing.playback import _facts
from beetle_ik.viewing.sizes import grips, resized

PANDA = bik.Robot.named("panda").with_capsules(radius=0.06)
START = np.array([0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.8])
TABLE = bik.obstacles.Box((0.5, 0.0, 0.15), (0.5, 0.8, 0.1))
POST = bik.obstacles.Cylinder((0.45, 0.1, 0.5), (0, 0, 1), 0.03, 0.5)


@pytest.fixture
def viewer() -> Iterator[bik.Viewer]:
    with bik.view(PANDA, START, obstacles=[TABLE, POST], port=0) as viewer:
        yield viewer


def control(viewer: bik.Viewer, label: str) -> Any:
    handles = viewer.server.gui._gui_input_handle_from_uuid.values()
    return next(handle for handle in handles if getattr(handle, "label", None) == label)


def press(viewer: bik.Viewer, label: str) -> None:
    handle = control(viewer, label)
    for callback in handle._impl.update_cb:
        callback(SimpleNamespace(client_id=0, client=None, target=handle))


def text(viewer: bik.Viewer) -> str:
    return str(viewer._parts.report._text.content)


# --- plans ---


def test_a_plan_leads_around_the_obstacle_to_the_handle(viewer: bik.Viewer) -> None:
    viewer.follow = "off"
    target = bik.pose([0.3, 0.45, 0.45], matrix=PANDA.fk(START)[:3, :3])
    viewer.target = target
    press(viewer, "Plan to the handle")
    clear = []

    def arrives() -> bool:
        clear.append(bik.obstacles.clearance(PANDA, viewer.q, viewer.obstacles))
        return bool(np.abs(PANDA.fk(viewer.q) - target).max() < 1e-6)

    until(arrives)
    assert min(clear) >= 1e-3 - 1e-9
    np.testing.assert_allclose(viewer.target, target, atol=1e-12)


def test_a_plan_to_where_the_arm_is_says_what_to_do(viewer: bik.Viewer) -> None:
    press(viewer, "Plan to the handle")
    until(lambda: "the arm is at the handle already: choose &#x27;off&#x27;" in text(viewer))


def test_a_target_that_no_plan_reaches_is_said(viewer: bik.Viewer) -> None:
    viewer.follow = "off"
    viewer.target = (2.0, 0.0, 0.5)
    press(viewer, "Plan to the handle")
    until(lambda: "end cannot be reached" in text(viewer))
    np.testing.assert_array_equal(viewer.q, START)


# --- programs ---


def run(program: str) -> dict[str, Any]:
    made: dict[str, Any] = {}
    exec(compile(program, "copied", "exec"), made)
    return made


def test_a_copied_program_makes_what_the_page_shows(viewer: bik.Viewer) -> None:
    viewer.follow = "off"
    viewer.target = (0.3, 0.45, 0.45)
    made = run(viewer.to_python())
    np.testing.assert_allclose(made["q"], viewer.q, atol=1e-9)
    np.testing.assert_allclose(made["target"], viewer.target, atol=1e-8)
    assert made["scene"] == viewer.obstacles
    assert repr(made["robot"].capsules) == repr(PANDA.capsules)
    assert made["plan"].success
    assert ".with_capsules(radius=0.06)" in viewer.to_python()


def test_a_program_after_a_plan_begins_where_that_began(viewer: bik.Viewer) -> None:
    viewer.follow = "off"
    viewer.target = (0.3, 0.45, 0.45)
    press(viewer, "Plan to the handle")
    until(lambda: np.abs(viewer.q - START).max() > 0.1)
    np.testing.assert_allclose(run(viewer.to_python())["q"], START, atol=1e-9)
    viewer.q = START + 0.05
    assert f"q = {(START + 0.05).round(9).tolist()}" in viewer.to_python()


SHAPES = [
    bik.obstacles.Sphere((0.6, 0.1, 0.5), 0.1, touch=["link_1"]),
    bik.obstacles.Box((0.6, 0.1, 0.5), (0.1, 0.2, 0.3), bik.pose((0, 0, 0), rpy=(0.1, 0.2, 0.3))[:3, :3]),
    bik.obstacles.Capsule((0.6, 0.1, 0.5), (0.6, 0.3, 0.4), 0.05),
    bik.obstacles.Capsule((0.6, 0.1, 0.5), (0.6, 0.1, 0.5), 0.05),
    bik.obstacles.Cylinder((0.6, 0.1, 0.5), (0, 1, 1), 0.05, 0.3),
    bik.obstacles.Ellipsoid((0.6, 0.1, 0.5), (0.1, 0.2, 0.05)),
    bik.obstacles.HalfSpace((0, 0, 1), -0.1),
    bik.obstacles.ConvexMesh([(0.6, 0, 0.4), (0.7, 0, 0.4), (0.6, 0.1, 0.4), (0.6, 0, 0.5)]),
    bik.obstacles.Mesh([(0.6, 0, 0.4), (0.7, 0, 0.4), (0.6, 0.1, 0.4)], [(0, 1, 2)]),
    bik.obstacles.PointCloud([(0.6, 0, 0.4), (0.7, 0, 0.4)], 0.02),
]


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: type(shape).__name__)
def test_every_shape_is_written_out(shape: bik.obstacles.Obstacle) -> None:
    with bik.view(PANDA, START, obstacles=[shape], port=0) as viewer:
        program = viewer.to_python().partition("plan =")[0]
    (copied,) = run(program)["scene"]
    assert type(copied) is type(shape)
    np.testing.assert_allclose(copied.triangles, shape.triangles, atol=1e-7)
    assert list(copied.touch) == list(shape.touch)


def test_a_long_scene_is_loaded_by_the_program() -> None:
    cloud = bik.obstacles.PointCloud(np.random.default_rng(0).uniform(1.0, 2.0, (50, 3)), 0.01)
    with bik.view(PANDA, START, obstacles=[cloud], port=0) as viewer:
        assert 'scene = bik.Scene.load("scene.json")' in viewer.to_python()


def test_programs_know_tips_and_leave_a_place_for_other_robots() -> None:
    pair = bik.Robot.from_urdf(pair_of_pandas(), tip=["left_tool", "right_tool"])
    with bik.view(pair, port=0) as viewer:
        program = viewer.to_python()
    assert "robot = ...  # as you made " in program
    made = run(program.partition("plan =")[0])
    assert list(made["target"]) == pair.tips


# --- sizes ---


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: type(shape).__name__)
@pytest.mark.parametrize("distance", [0.25, 0.1, 0.0, -1.0])
def test_a_dragged_size_is_that_of_the_shape(shape: bik.obstacles.Obstacle, distance: float) -> None:
    for i, grip in enumerate(grips(shape)):
        assert np.linalg.norm(grip.along) == pytest.approx(1.0)
        made = resized(shape, i, distance)
        assert made.touch == shape.touch
        after = grips(made)
        assert after[i].distance == pytest.approx(max(distance, 0.002))
        np.testing.assert_allclose(after[i].middle, grip.middle, atol=1e-12)
        others = [k for k in range(len(after)) if k != i]
        assert [after[k].distance for k in others] == pytest.approx([grips(shape)[k].distance for k in others])
        assert type(resized(shape, i, grip.distance)) is type(shape)
        np.testing.assert_allclose(resized(shape, i, grip.distance).triangles, shape.triangles, atol=1e-9)


def test_an_arrow_on_an_obstacle_changes_its_size(viewer: bik.Viewer) -> None:
    obstacles = viewer._parts._quick[1]
    obstacles._choose(0)
    turn = bik.pose([0.5, 0.0, 0.2], rpy=[0.0, 0.0, 0.3])
    obstacles._move(0, turn)
    obstacles._resize(0, 1, turn[:3, 3] + 0.6 * turn[:3, 1])
    obstacles._resize(0, 7, turn[:3, 3])  # an arrow of a shape that is gone
    obstacles._move(0, bik.pose([0.1, 0.0, 0.0]) @ turn)
    box = viewer.obstacles[0]
    np.testing.assert_allclose(box.size, [0.5, 1.2, 0.1], atol=1e-12)
    np.testing.assert_allclose(box.rotation, turn[:3, :3], atol=1e-12)
    np.testing.assert_allclose(box.center, [0.6, 0.0, 0.2], atol=1e-12)
    arrows = [viewer.server.scene.get_handle_by_name(f"/obstacle_size/{k}") for k in range(3)]
    for arrow, grip in zip(arrows, grips(box), strict=True):
        np.testing.assert_allclose(arrow.position, grip.point, atol=1e-9)


# --- files of scenes ---


def test_a_scene_is_saved_and_loaded_as_a_file(viewer: bik.Viewer) -> None:
    sent: list[tuple[str, bytes]] = []
    client = SimpleNamespace(send_file_download=lambda name, content, **_: sent.append((name, content)))
    save, load = control(viewer, "Save scene"), control(viewer, "Load scene")
    save._impl.update_cb[0](SimpleNamespace(client_id=0, client=client, target=save))
    until(lambda: sent)
    viewer.obstacles = []
    uploaded = SimpleNamespace(value=SimpleNamespace(name=sent[0][0], content=sent[0][1]))
    load._impl.update_cb[0](SimpleNamespace(client_id=0, client=client, target=uploaded))
    until(lambda: viewer.obstacles == bik.Scene([TABLE, POST]))
    broken = SimpleNamespace(value=SimpleNamespace(name="<b>.json", content=b"{"))
    load._impl.update_cb[0](SimpleNamespace(client_id=0, client=client, target=broken))
    until(lambda: "&lt;b&gt;.json: not JSON: " in text(viewer))
    assert viewer.obstacles == bik.Scene([TABLE, POST])


def test_files_come_in_at_their_button_alone(viewer: bik.Viewer) -> None:
    from msgspec import msgpack

    incoming = Incoming()
    incoming.server = viewer.server

    def offered(label: str, size: int = 100, parts: int = 1) -> bool:
        fields = {"source_component_uuid": control(viewer, label)._impl.uuid, "transfer_uuid": "a", "filename": "b"}
        sizes = {"mime_type": "c", "part_count": parts, "size_bytes": size}
        return incoming.accepts(msgpack.encode({"type": "FileTransferStartUpload", **fields, **sizes}))

    assert offered("Load scene")
    assert not offered("keep clear")
    assert not offered("Load scene", size=10**9)
    assert not offered("Load scene", parts=10**6)
    assert not offered("Load scene", size=-1)


# --- limits and maps ---


def test_joints_at_their_limits_are_named(viewer: bik.Viewer) -> None:
    assert "joint limits" in text(viewer)
    q = START.copy()
    q[3] = PANDA.upper[3]
    viewer.q = q
    assert f"at its limit: {PANDA.joint_names[3]}" in text(viewer)
    assert text(viewer).count("position:absolute") == PANDA.dof


@pytest.fixture(scope="module")
def reached() -> bik.ReachabilityMap:
    return bik.reachability(bik.Robot.named("ur3e"), voxel=0.15, directions=3, rolls=2)


def test_a_slice_of_a_map_is_shown_where_it_is_asked_for(reached: bik.ReachabilityMap) -> None:
    with bik.view(bik.Robot.named("ur3e"), port=0) as viewer:
        viewer.show(reached)
        part, points = viewer._parts._reach, []
        for across, at in itertools.product("xyz", (-0.2, 0.0, 0.3, 9.0)):
            part._across.value = across
            part._cut()
            part._at.value = min(at, part._at.max)
            part._draw()
            axis, image = "xyz".index(across), viewer.server.scene.get_handle_by_name("/map")
            assert abs(image.position[axis] - part._at.value) <= 0.5 * reached.voxel + 1e-3
            layer = round((image.position[axis] - reached.origin[axis]) / reached.voxel - 0.5)
            seen = image.image[::12, ::12, 3] > 0
            np.testing.assert_array_equal(seen[::-1].T, np.take(reached.index, layer, axis=axis) > 0)
            points.append(seen.sum())
        assert max(points) > 10
        part._across.value = "all"
        part._cut()
        assert len(viewer.server.scene.get_handle_by_name("/map").points) == int((reached.index > 0).sum())
        part._hide()
        assert viewer.server.scene.get_handle_by_name("/map") is None


def test_the_facts_of_a_motion_are_told() -> None:
    points = np.array([[[0.0, 0.0, 0.0]], [[0.3, 0.0, 0.0]], [[0.3, 0.4, 0.0]]])
    told = [_facts(1.5, points, clearance) for clearance in (0.0123, np.nan, np.inf)]
    assert "1.50 s, the tip moves 0.700 m, clearance 12.3 mm at least<" in told[0]
    assert all("the tip moves 0.700 m<" in each for each in told[1:])
