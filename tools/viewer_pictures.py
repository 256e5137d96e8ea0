"""Draws the pictures of `docs/viewer.md`: python tools/viewer_pictures.py docs/images.

Needs the extras `view` and `zoo`, playwright and Chromium. The tests of the viewer use the same visitor of the page.
"""

import argparse
import shutil
import sysconfig
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import beetle_ik as bik

Array = NDArray[np.float64]

_SOFTWARE = [
    "--no-sandbox",
    "--disable-dev-shm-usage",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
]
_WIDTH, _HEIGHT = 1050, 660  # pixels of the pictures
_REDRAWS = 10  # redraws until full resolution
_GRIP = 0.5  # grip on an arrow, as a fraction of the size of the handle
_MOVES = 8  # mouse moves in a drag
_DELIVERY = 6  # frames: longest delay of a message to a page
_FRAMES = 3000  # most frames until an event
_PATIENCE = 120_000  # ms: a page takes long to appear beside other programs


def chromium() -> str | None:
    """Returns the system's browser, if there is one."""
    return next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)


def hide_notes(page: Any) -> None:
    """Hides notes of viser; the first is about drawing without a graphics card."""
    page.add_style_tag(content=".mantine-Notification-root { display: none }")


def draw(page: Any, *, times: int = 1) -> None:
    """Has a page draw so many frames."""
    for _ in range(times):
        page.evaluate("new Promise(requestAnimationFrame)")


class Visitor:
    """A user of a viewer, with a mouse."""

    def __init__(self, browser: Any, viewer: bik.Viewer, *, width: int = 800, height: int = 500) -> None:
        """Opens the page, and waits until it shows the state of the arm."""
        known = set(viewer.server.get_clients())
        self.viewer = viewer
        self.page = browser.new_page(viewport={"width": width, "height": height})
        self.page.set_default_timeout(_PATIENCE)
        self.page.goto(viewer.url)
        self.page.wait_for_selector("[data-beetle-ik=status]")
        self.until(lambda: set(viewer.server.get_clients()) - known)
        (self._client,) = set(viewer.server.get_clients()) - known
        hide_notes(self.page)

    def until(self, happened: Callable[[], object]) -> None:
        """Waits until `happened` returns something true.

        Raises:
            TimeoutError: it did not happen in time.
        """
        for _ in range(_FRAMES):
            if happened():
                return
            draw(self.page)
        raise TimeoutError(f"still {self.text()!r}, {self.viewer.outcome}")

    def picture(self, file: Path) -> None:
        """Writes a picture of the page once everything is drawn, and closes the page."""
        for _ in range(_REDRAWS):
            self.settle()
        self.page.mouse.move(1, 1)
        self.page.screenshot(path=file)
        self.page.close()

    def settle(self) -> None:
        """Waits until the page has drawn the messages sent so far."""
        self.viewer.server.flush()
        draw(self.page, times=_DELIVERY)

    def text(self, what: str = "status") -> str:
        """Returns a text of the page: "status" or "clearance"."""
        return str(self.page.inner_text(f"[data-beetle-ik={what}]"))

    def open_tab(self, name: str) -> None:
        """Opens one of the tabs."""
        self.page.get_by_role("tab", name=name).click()

    def press(self, name: str) -> None:
        """Presses a button."""
        self.page.get_by_role("button", name=name, exact=True).click()

    def pixel(self, point: Array) -> Array:
        """Returns the pixel (2,) of a point (3,) of the scene."""
        import viser.transforms

        camera = self.viewer.server.get_clients()[self._client].camera
        seen = viser.transforms.SO3(camera.wxyz).as_matrix().T @ (point - camera.position)
        focal = 0.5 * camera.image_height / np.tan(0.5 * camera.fov)
        center = 0.5 * np.array([camera.image_width, camera.image_height])
        return np.asarray(center + focal * seen[:2] / seen[2])

    def enter(self, number: float, happened: Callable[[], object]) -> None:
        """Types a number into the first visible field, until it has taken effect.

        Earlier messages of the server may arrive while the number is typed, and replace it.
        """
        field = self.page.locator("input[type=text]:visible").first

        def typed() -> object:
            if not happened():
                field.fill(str(number))
                field.press("Enter")
                self.settle()
            return happened()

        self.until(typed)

    def drag(self, name: str, axis: int, distance: float) -> None:
        """Drags an arrow of a handle, for example "/target", by a distance along its axis (m)."""
        self.settle()  # waits for the handle to arrive
        handle: Any = self.viewer.server.scene.get_handle_by_name(name)
        place = bik.pose(handle.position, wxyz=handle.wxyz)
        along = place[:3, axis]
        grip = place[:3, 3] + _GRIP * handle.scale * along
        self.page.mouse.move(*self.pixel(grip))
        self.settle()  # waits for the arrow to light up
        self.page.mouse.down()
        for i in range(1, _MOVES + 1):
            self.page.mouse.move(*self.pixel(grip + distance * i / _MOVES * along))
            draw(self.page)
        self.page.mouse.up()


@contextmanager
def visits() -> Iterator[Any]:
    """Yields a headless browser, which draws without a graphics card."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium(), args=_SOFTWARE)
        yield browser
        browser.close()


ROBOTS = Path(sysconfig.get_path("purelib"), "cmeel.prefix", "share", "example-robot-data", "robots")
START = np.array([0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.8])


def panda() -> bik.Robot:
    """Returns the Panda of `docs/viewer.md`."""
    return bik.Robot.named("panda").with_capsules(radius=0.06)


def dragged(browser: Any, file: Path) -> None:
    """Pictures an arm beside a box, after its handle was dragged."""
    board = bik.obstacles.Box((0.5, 0.0, 0.1), (0.4, 1.0, 0.02))
    box = bik.obstacles.Box((0.5, 0.25, 0.23), (0.2, 0.15, 0.24))
    with bik.view(panda(), START, obstacles=[board, box], port=0) as viewer:
        visitor = Visitor(browser, viewer, width=_WIDTH, height=_HEIGHT)
        visitor.drag("/target", 2, 0.2)
        visitor.until(lambda: not viewer.moves)
        visitor.picture(file)


def solved(browser: Any, file: Path) -> None:
    """Pictures all solutions of a pose."""
    robot = bik.Robot.named("ur5").with_capsules(radius=0.05)
    target = bik.pose([0.45, -0.3, 0.5], rpy=[np.pi / 2, 0.0, 1.0])
    with bik.view(robot, bik.solve(robot, target, obstacles=[]).q, port=0) as viewer:
        visitor = Visitor(browser, viewer, width=_WIDTH, height=_HEIGHT)
        visitor.open_tab("Postures")
        visitor.press("Show all solutions")
        visitor.page.get_by_label("velocity ellipsoid").check()
        visitor.picture(file)


def played(browser: Any, file: Path) -> None:
    """Pictures a plan around a post, in the middle of its motion."""
    robot = panda()
    post = bik.obstacles.Box((0.5, 0.0, 0.25), (0.06, 0.06, 0.5))
    ends = [START + side * np.array([0.7, 0, 0, 0, 0, 0, 0]) for side in (-1, 1)]
    limits = bik.Limits(acceleration=5.0)
    plan = bik.plan_point_to_point(robot, start_q=ends[0], end_q=ends[1], obstacles=[post], limits=limits)
    with bik.view(robot, START, port=0) as viewer:
        visitor = Visitor(browser, viewer, width=_WIDTH, height=_HEIGHT)
        viewer.show(plan)
        visitor.press("Pause")
        visitor.settle()
        middle = visitor.page.locator("input[type=text]:visible").first
        middle.fill(f"{0.5 * plan.trajectory.duration:.2f}")
        middle.press("Enter")
        visitor.until(lambda: not viewer.moves)
        visitor.picture(file)


def loaded(browser: Any, file: Path) -> None:
    """Pictures the loads of the motors of an arm that holds 3 kg far out."""
    robot = bik.Robot.named("panda").with_payload(3.0)
    with bik.view(robot, [0.0, 0.9, 0.0, -1.1, 0.0, 2.0, 0.8], port=0) as viewer:
        visitor = Visitor(browser, viewer, width=_WIDTH, height=_HEIGHT)
        visitor.open_tab("Joints")
        visitor.picture(file)


def mapped(browser: Any, file: Path) -> None:
    """Pictures a slice of a reachability map."""
    robot = bik.Robot.named("ur5e")
    with bik.view(robot, START[:6], port=0) as viewer:
        viewer.show(bik.reachability(robot, voxel=0.05))
        Visitor(browser, viewer, width=_WIDTH, height=_HEIGHT).picture(file)


def paired(browser: Any, file: Path) -> None:
    """Pictures a robot with two arms, after one of its handles was dragged."""
    file_of_robot = ROBOTS / "baxter_description/urdf/baxter.urdf"
    robot = bik.Robot.from_urdf(file_of_robot, tip=["left_hand_link", "right_hand_link"], collision="hulls")
    with bik.view(robot, port=0) as viewer:
        visitor = Visitor(browser, viewer, width=_WIDTH, height=_HEIGHT)
        visitor.drag("/target/left_hand_link", 2, -0.15)
        visitor.until(lambda: not viewer.moves)
        visitor.picture(file)


def main() -> None:
    """Writes the pictures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=Path)
    out: Path = parser.parse_args().out
    with visits() as browser:
        for draw in (dragged, solved, played, loaded, mapped, paired):
            draw(browser, out / f"viewer_{draw.__name__}.png")


if __name__ == "__main__":
    main()
