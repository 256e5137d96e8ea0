"""The viewer in a real browser: the mouse, the text of the page, and the state in Python."""

import sys
import threading
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pair_of_pandas import pair_of_pandas
from viewer_turns import until

import beetle_ik as bik

sys.path.append(str(Path(__file__).parents[2] / "tools"))
from viewer_pictures import Visitor, chromium, draw, visits

pytest.importorskip("playwright", reason="playwright, which drives the browser, is not installed")
pytestmark = pytest.mark.skipif(chromium() is None, reason="no chromium or chrome on this machine")

START = np.array([0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.8])
TABLE = bik.obstacles.Box((0.5, 0.0, 0.15), (0.5, 0.8, 0.1))
MARGIN = 1e-3  # m, the library's own
REACHED = ("0.0 mm", "0.1 mm")  # the arm stops within 0.1 mm
NEARLY_ALL = 0.08  # m, of a drag by 0.1 m: a pixel is a few millimetres


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    from playwright.sync_api import Error

    with ExitStack() as stack:
        try:
            browser = stack.enter_context(visits())
        except Error as error:
            pytest.skip(f"the browser does not start: {error}")
        yield browser


@pytest.fixture(scope="module")
def viewer() -> Iterator[bik.Viewer]:
    with bik.view(bik.Robot.named("panda"), START, obstacles=[TABLE], port=0) as viewer:
        viewer.server.scene.configure_default_lights(cast_shadow=False)  # without a graphics card they take long
        yield viewer


@pytest.fixture(scope="module")
def visitor(browser: Any, viewer: bik.Viewer) -> Visitor:
    return Visitor(browser, viewer, width=900, height=420)


@pytest.fixture(autouse=True)
def _at_start(viewer: bik.Viewer) -> None:
    viewer.follow = "track"
    viewer.obstacles = [TABLE]
    viewer.q = START


def clearance(viewer: bik.Viewer) -> float:
    return float(bik.obstacles.clearance(viewer.robot, viewer.q, viewer.obstacles))


def test_the_page_tells_how_the_arm_stands(viewer: bik.Viewer, visitor: Visitor) -> None:
    visitor.until(lambda: visitor.text() == "at rest")
    assert float(visitor.text("clearance")) == pytest.approx(1e3 * clearance(viewer), abs=0.06)


def test_the_arm_follows_a_dragged_handle(viewer: bik.Viewer, visitor: Visitor) -> None:
    before = viewer.target
    visitor.drag("/target", 2, 0.1)
    visitor.until(lambda: (viewer.target - before)[:3, 3] @ before[:3, 2] > NEARLY_ALL)
    visitor.until(lambda: not viewer.moves and visitor.text().removeprefix("reached: ").startswith(REACHED))
    assert (viewer.target - before)[:3, 3] @ before[:3, 2] == pytest.approx(0.1, abs=0.02)
    np.testing.assert_allclose(viewer.robot.fk(viewer.q), viewer.target, atol=1e-4)
    assert float(visitor.text("clearance")) == pytest.approx(1e3 * clearance(viewer), abs=0.06)


def test_the_arm_stays_clear_of_what_the_handle_is_in(viewer: bik.Viewer, visitor: Visitor) -> None:
    seen: list[float] = []
    viewer.on_target(lambda _: seen.append(clearance(viewer)))
    viewer.target = (0.5, 0.0, 0.4)
    visitor.until(lambda: not viewer.moves)
    visitor.drag("/target", 2, 0.3)  # down to the table, and into it
    visitor.until(lambda: visitor.text().startswith("held by an obstacle"))
    assert viewer.target[2, 3] < 0.2
    assert len(seen) > 2
    assert min([*seen, clearance(viewer)]) >= MARGIN - 1e-6
    assert float(visitor.text("clearance")) >= 1e3 * MARGIN


def test_numbers_and_choices_of_the_page_move_the_arm(viewer: bik.Viewer, visitor: Visitor) -> None:
    visitor.open_tab("Joints")
    visitor.enter(0.5, lambda: viewer.q[0] == 0.5)
    np.testing.assert_allclose(viewer.target, viewer.robot.fk(viewer.q), atol=1e-12)
    visitor.open_tab("Target")


def test_obstacles_are_added_dragged_and_removed(viewer: bik.Viewer, visitor: Visitor) -> None:
    visitor.open_tab("Obstacles")
    visitor.press("Add sphere")
    visitor.until(lambda: len(viewer.obstacles) == 2)
    before = viewer.obstacles[1].center
    visitor.drag("/obstacle", 2, 0.15)
    visitor.until(lambda: viewer.obstacles[1].center[2] > before[2] + 0.1)
    visitor.until(lambda: not viewer.moves)
    assert clearance(viewer) >= MARGIN - 1e-6
    visitor.press("Remove")
    visitor.until(lambda: viewer.obstacles == bik.Scene([TABLE]))
    visitor.open_tab("Target")


def test_all_solutions_and_the_self_motion_are_shown(viewer: bik.Viewer, visitor: Visitor) -> None:
    visitor.open_tab("Postures")
    visitor.press("Show all solutions")
    visitor.page.wait_for_selector("text=/[0-9]+ solutions/")
    visitor.press("Find the self-motion")
    visitor.page.wait_for_selector("text=/self-motion curve/")
    target = viewer.target
    slider = visitor.page.get_by_role("slider").last
    slider.press("ArrowRight")
    visitor.until(lambda: np.abs(viewer.q - START).max() > 1e-3)
    np.testing.assert_allclose(viewer.robot.fk(viewer.q), target, atol=1e-6)
    visitor.press("Hide them")
    visitor.open_tab("Target")


def test_a_motion_is_played_and_paused(viewer: bik.Viewer, visitor: Visitor) -> None:
    motion = bik.Trajectory.from_samples([0.0, 60.0], [START, START + 0.1])
    viewer.show(motion)
    visitor.until(lambda: viewer.q[0] > START[0] + 1e-4)
    visitor.press("Pause")
    visitor.page.get_by_role("button", name="Play", exact=True).wait_for()
    paused = viewer.q
    draw(visitor.page, times=10)
    np.testing.assert_array_equal(viewer.q, paused)
    visitor.enter(30, lambda: np.abs(viewer.q - START - 0.05).max() < 1e-9)


def test_the_arm_plans_to_a_handle_it_does_not_follow(viewer: bik.Viewer, visitor: Visitor) -> None:
    viewer.follow = "off"
    visitor.drag("/target", 2, 0.1)
    visitor.until(lambda: np.abs(viewer.target - viewer.robot.fk(START)).max() > NEARLY_ALL)
    visitor.until(lambda: visitor.text() == "does not follow the handle")
    np.testing.assert_array_equal(viewer.q, START)
    visitor.press("Plan to the handle")
    visitor.until(lambda: np.abs(viewer.target - viewer.robot.fk(viewer.q)).max() < 1e-6)
    assert clearance(viewer) >= MARGIN - 1e-6


def test_the_state_of_the_page_is_copied_as_a_program(viewer: bik.Viewer, visitor: Visitor) -> None:
    visitor.press("Copy as Python")
    program = visitor.page.locator("textarea").last
    program.wait_for()
    assert program.input_value() == viewer.to_python()
    visitor.press("Copy")
    visitor.press("Copied")
    visitor.press("Close")


def test_a_scene_goes_to_a_file_and_comes_back(viewer: bik.Viewer, visitor: Visitor, tmp_path: Path) -> None:
    visitor.open_tab("Obstacles")
    with visitor.page.expect_download() as download:
        visitor.press("Save scene")
    download.value.save_as(tmp_path / "scene.json")
    assert bik.Scene.load(tmp_path / "scene.json") == viewer.obstacles
    viewer.obstacles = []
    with visitor.page.expect_file_chooser() as chooser:
        visitor.press("Load scene")
    chooser.value.set_files(tmp_path / "scene.json")
    visitor.until(lambda: viewer.obstacles == bik.Scene([TABLE]))
    visitor.open_tab("Target")


def test_an_arrow_on_the_chosen_obstacle_changes_its_size(viewer: bik.Viewer, visitor: Visitor) -> None:
    viewer.obstacles = [bik.obstacles.Box((0.4, 0.5, 0.4), (0.2, 0.2, 0.2))]
    visitor.open_tab("Obstacles")
    visitor.page.get_by_label("chosen").click()
    visitor.page.get_by_role("option", name="0 Box").click()
    visitor.until(lambda: viewer.server.scene.get_handle_by_name("/obstacle_size/2") is not None)
    visitor.drag("/obstacle_size/2", 0, 0.1)
    visitor.until(lambda: viewer.obstacles[0].size[2] > 0.2 + NEARLY_ALL)
    assert viewer.obstacles[0].size[:2].tolist() == [0.2, 0.2]
    np.testing.assert_allclose(viewer.obstacles[0].center, [0.4, 0.5, 0.4])
    visitor.open_tab("Target")


def test_an_upright_window_shows_the_arm_above_the_controls(browser: Any, viewer: bik.Viewer) -> None:
    visitor = Visitor(browser, viewer, width=390, height=844)
    visitor.settle()
    places = viewer.robot.all_link_poses(viewer.q)[:, :3, 3]

    def whole() -> bool:
        pixels = np.array([visitor.pixel(place) for place in places])
        return bool((pixels > 0).all() and (pixels[:, 0] < 390).all() and (pixels[:, 1] < 410).all())

    visitor.until(whole)
    visitor.page.close()


def test_a_visitor_may_leave_with_the_handle_in_the_hand(viewer: bik.Viewer, visitor: Visitor) -> None:
    visitor.page.mouse.move(*visitor.pixel(viewer.target[:3, 3]))
    visitor.page.mouse.down()
    left = threading.Event()
    viewer.server.on_client_disconnect(lambda _: left.set())
    visitor.page.close()  # the last test of this page: to open another takes seconds
    viewer.target = viewer.target[:3, 3] - [0.0, 0.0, 0.1]
    left.wait()
    until(lambda: not viewer.moves)
    assert viewer.outcome is not None
    assert viewer.outcome.success


def test_each_tip_has_a_handle_of_its_own(browser: Any) -> None:
    robot = bik.Robot.from_urdf(pair_of_pandas(), tip=["left_tool", "right_tool"])
    with bik.view(robot, port=0) as viewer:
        viewer.server.scene.configure_default_lights(cast_shadow=False)
        visitor = Visitor(browser, viewer, width=700, height=360)
        before = viewer.target
        visitor.drag("/target/left_tool", 2, 0.1)

        def moved() -> float:
            way = viewer.target["left_tool"][:3, 3] - before["left_tool"][:3, 3]
            return float(way @ before["left_tool"][:3, 2])

        def at_targets() -> bool:
            return np.allclose(robot.fk(viewer.q), list(viewer.target.values()), atol=1e-4)

        # The arm reaches places on the way before the last movement of the mouse arrives.
        visitor.until(lambda: moved() > 0.08 and at_targets() and visitor.text("left_tool").startswith(REACHED))
        assert moved() == pytest.approx(0.1, abs=0.02)
        np.testing.assert_array_equal(viewer.target["right_tool"], before["right_tool"])
        assert visitor.text("right_tool").startswith(REACHED)
