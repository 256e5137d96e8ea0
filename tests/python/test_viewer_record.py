"""Recordings of the viewer: the contents of the file, and its playback in a browser."""

import sys
from collections.abc import Iterator
from itertools import repeat
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from viewer_turns import until

import beetle_ik as bik
from beetle_ik.viewing import write_player
from beetle_ik.viewing.camera import FIELD, _corners, _fitting

sys.path.append(str(Path(__file__).parents[2] / "tools"))
from check_site import served
from viewer_pictures import chromium, draw, hide_notes, visits

ROBOT = bik.Robot.named("panda").with_capsules(radius=0.06)
START = np.array([0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.8])
MOTION = bik.Trajectory.from_samples([0.0, 1.01], [START, START + 0.3])
PATIENCE = 120_000  # ms: without a graphics card, and where other programs run, a page draws slowly
BALL = bik.obstacles.Sphere((0.7, 0.0, 0.5), 0.1)


@pytest.fixture
def viewer() -> Iterator[bik.Viewer]:
    with bik.view(ROBOT, START, port=0) as viewer:
        yield viewer


def read(file: Path) -> tuple[float, list[tuple[float, dict[str, Any]]]]:
    """Duration and messages of a recording, with their times."""
    import msgspec
    import zstandard

    content = zstandard.ZstdDecompressor().decompress(file.read_bytes()[8:])
    head = msgspec.msgpack.decode(content[8 : 8 + int.from_bytes(content[:8], "little")])
    return head["durationSeconds"], head["messages"]


def placed(messages: list[tuple[float, dict[str, Any]]], node: str) -> dict[float, list[float]]:
    """Positions of a node by their times."""
    moved = (each for each in messages if each[1]["type"] == "SetPositionMessage" and each[1]["name"] == node)
    return {round(time, 9): message["position"] for time, message in moved}


def test_a_motion_is_recorded_from_start_to_end(viewer: bik.Viewer, tmp_path: Path) -> None:
    viewer.show(MOTION)
    viewer.record(tmp_path / "motion.viser")
    duration, messages = read(tmp_path / "motion.viser")
    assert duration == pytest.approx(1.01 + 0.7)
    ways = placed(messages, "/robot/link_7")
    assert len(ways) == 32  # 30 a second, and both ends
    for at, position in ways.items():
        place = ROBOT.all_link_poses(MOTION.at(at)[0])[ROBOT.all_link_names.index("link_7")]
        np.testing.assert_allclose(position, place[:3, 3], atol=1e-6)


def test_a_scene_without_motion_is_recorded_as_it_is(viewer: bik.Viewer, tmp_path: Path) -> None:
    viewer.record(tmp_path / "still.viser")
    duration, messages = read(tmp_path / "still.viser")
    assert duration == 0.0
    assert placed(messages, "/robot/link_7").keys() == {0.0}
    kinds = {message["type"] for _, message in messages}
    assert "MeshMessage" in kinds
    assert not any("Gui" in kind for kind in kinds)


def test_a_recording_leaves_the_arm_where_it_was(viewer: bik.Viewer, tmp_path: Path) -> None:
    viewer.show(MOTION)
    viewer.q = START - 0.1
    target = viewer.target
    viewer.record(tmp_path / "motion.viser")
    np.testing.assert_array_equal(viewer.q, START - 0.1)
    np.testing.assert_array_equal(viewer.target, target)
    viewer.show(MOTION)
    viewer.record(tmp_path / "motion.viser")
    first = viewer.q
    until(lambda: not np.array_equal(viewer.q, first))


def test_a_chosen_camera_is_recorded_and_any_other_comes_near(viewer: bik.Viewer, tmp_path: Path) -> None:
    def positions() -> list[list[float]]:
        viewer.record(tmp_path / "still.viser")
        _, messages = read(tmp_path / "still.viser")
        return [list(message["position"]) for _, message in messages if message["type"] == "SetCameraPositionMessage"]

    far = viewer.server.initial_camera.position.copy()
    (near,) = positions()
    assert np.linalg.norm(near) < np.linalg.norm(far)
    np.testing.assert_array_equal(viewer.server.initial_camera.position, far)
    viewer.server.initial_camera.position = (1.0, 2.0, 3.0)
    assert positions() == [[1.0, 2.0, 3.0]]


def test_what_is_recorded_fills_the_picture_and_fits_into_it() -> None:
    random = np.random.default_rng(4)
    for _ in range(20):
        boxes = np.sort(random.uniform(-1, 1, (3, 2, 3)), axis=1)
        points = _corners(boxes) - 0.5 * (boxes[:, 0].min(axis=0) + boxes[:, 1].max(axis=0))
        position = _fitting(points)
        toward = position / np.linalg.norm(position)
        right = np.cross([0, 0, 1], toward) / np.linalg.norm(np.cross([0, 0, 1], toward))
        depth = np.linalg.norm(position) - points @ toward
        up = np.abs(points @ np.cross(toward, right)) / depth / np.tan(0.5 * FIELD)
        beside = np.abs(points @ right) / depth / np.tan(0.5 * FIELD) / 1.3
        assert 0.7 < max(up.max(), beside.max()) <= 1.0


def test_handles_are_hidden_in_recordings_alone(viewer: bik.Viewer, tmp_path: Path) -> None:
    viewer.record(tmp_path / "still.viser")
    _, messages = read(tmp_path / "still.viser")
    visible = {m["name"]: m["visible"] for _, m in messages if m["type"] == "SetSceneNodeVisibilityMessage"}
    assert not visible["/target"]
    assert viewer.server.scene.get_handle_by_name("/target").visible


def test_the_arm_dodges_between_frames_without_a_clock(viewer: bik.Viewer, tmp_path: Path) -> None:
    def approach() -> Iterator[float]:
        viewer.q = START
        for x in np.linspace(0.7, 0.45, 50):
            viewer.obstacles = [bik.obstacles.Sphere((x, 0.1, 0.5), 0.1)]
            yield 0.03
        yield 2.0
        assert bik.obstacles.clearance(viewer.robot, viewer.q, viewer.obstacles) >= 1e-3 - 1e-9
        assert np.abs(viewer.q - START).max() > 1e-3
        assert not viewer.moves

    ways = []
    for name in ("first.viser", "second.viser"):
        viewer.record(tmp_path / name, approach())
        ways.append(placed(read(tmp_path / name)[1], "/robot/link_7"))
    assert ways[0] == ways[1]
    assert len(ways[0]) > 10


def test_a_motion_shown_in_frames_is_played(viewer: bik.Viewer, tmp_path: Path) -> None:
    def frames() -> Iterator[float]:
        viewer.show(MOTION)
        yield from repeat(0.1, 5)
        np.testing.assert_allclose(viewer.q, MOTION.at(0.5)[0], atol=1e-9)

    viewer.record(tmp_path / "played.viser", frames())


@pytest.mark.parametrize(
    ("frames", "told"),
    [
        ([0.1, -0.1], "frames must yield seconds, at least 0, got -0.1 as number 1"),
        ([None], "frames must yield seconds, at least 0, got None as number 0"),
        ([float("inf")], "frames must yield seconds, at least 0, got inf as number 0"),
        (repeat(10.0), "frames last longer than 600 s, or are more than 100000: is there no end to them?"),
        (5, "frames must be"),
    ],
)
def test_frames_that_are_no_seconds_are_refused(viewer: bik.Viewer, tmp_path: Path, frames: Any, told: str) -> None:
    with pytest.raises(bik.InvalidInputError) as refused:
        viewer.record(tmp_path / "none.html", frames)
    assert str(refused.value).startswith(told)
    assert not list(tmp_path.iterdir())
    viewer.record(tmp_path / "after.html")  # nothing is left behind
    assert not viewer.server._websock_server._record_handles


def test_files_that_are_no_recordings_are_refused(viewer: bik.Viewer, tmp_path: Path) -> None:
    with pytest.raises(bik.InvalidInputError, match=r"file must end in \.html \(a page of its own\) or \.viser"):
        viewer.record("motion.mp4")
    with pytest.raises(bik.InvalidInputError, match=r"file must end in \.html, got 'player\.js'"):
        write_player("player.js")
    with pytest.raises(FileNotFoundError):
        viewer.record(tmp_path / "none" / "motion.html")
    with pytest.raises(bik.InvalidInputError, match="file must be a path"):
        viewer.record(5)  # type: ignore[arg-type]


def test_a_closed_viewer_records_nothing(tmp_path: Path) -> None:
    viewer = bik.view(ROBOT, START, port=0)
    viewer.close()
    with pytest.raises(bik.BeetleIkError, match="is closed"):
        viewer.record(tmp_path / "motion.html")


def test_frames_do_not_record(viewer: bik.Viewer, tmp_path: Path) -> None:
    def frames() -> Iterator[float]:
        viewer.record(tmp_path / "inner.html")
        yield 0.1

    with pytest.raises(bik.BeetleIkError, match="frames must not record"):
        viewer.record(tmp_path / "outer.html", frames())


# --- in a browser ---


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    pytest.importorskip("playwright", reason="playwright, which drives the browser, is not installed")
    if chromium() is None:
        pytest.skip("no chromium or chrome on this machine")
    with visits() as browser:
        yield browser


@pytest.fixture(scope="module")
def recordings(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("recordings")
    with bik.view(ROBOT, START, obstacles=[BALL], port=0) as viewer:
        viewer.server.scene.configure_default_lights(cast_shadow=False)  # without a graphics card they take long
        viewer.show(MOTION)
        viewer.record(folder / "motion.html")
        viewer.record(folder / "motion.viser")
    write_player(folder / "player.html")
    return folder


def colours(page: Any) -> int:
    """How many colours a page shows above its time bar."""
    from io import BytesIO

    from PIL import Image

    size = page.viewport_size
    clip = {"x": 0, "y": 0, "width": size["width"], "height": size["height"] - 60}
    picture = Image.open(BytesIO(page.screenshot(clip=clip, timeout=PATIENCE))).convert("RGB")
    return len(picture.getcolors(maxcolors=picture.width * picture.height))


def plays(browser: Any, address: str, *, width: int = 320, height: int = 240) -> None:
    complaints: list[str] = []
    page = browser.new_page(viewport={"width": width, "height": height})
    page.set_default_timeout(PATIENCE)
    page.on("console", lambda message: complaints.append(message.text) if message.type == "error" else None)
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.goto(address)
    clock = page.locator("input[type=text], input:not([type])").first
    clock.wait_for()
    hide_notes(page)
    first = clock.input_value()
    while clock.input_value() == first or colours(page) <= 100:
        draw(page)
    page.close()
    assert not complaints


@pytest.mark.parametrize(("width", "height"), [(320, 240), (240, 400)])
def test_a_browser_plays_a_recorded_page_without_server(
    browser: Any, recordings: Path, width: int, height: int
) -> None:
    assert (recordings / "motion.html").stat().st_size < 3e6
    plays(browser, (recordings / "motion.html").as_uri(), width=width, height=height)


def test_a_player_plays_recordings_of_its_site_alone(browser: Any, recordings: Path) -> None:
    with served(recordings) as site, served(recordings) as elsewhere:
        plays(browser, f"{site}/player.html?playbackPath=motion.viser")
        page = browser.new_page()
        refused: list[str] = []
        page.on("console", lambda message: refused.append(message.text))
        page.goto(f"{site}/player.html?playbackPath={elsewhere}/motion.viser")
        while not any("Content Security Policy" in text for text in refused):
            draw(page)
        page.close()
