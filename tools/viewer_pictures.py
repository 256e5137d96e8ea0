"""Draws the pictures of `docs/viewer.md`: python tools/viewer_pictures.py docs/images.

Drives a headless Chromium as a visitor of the page would; the tests of the viewer use the same visitor.
"""

import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import NDArray

import beetle_ik as bik

Array = NDArray[np.float64]

_SOFTWARE = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
_GRIP = 0.5  # where an arrow of a handle is taken, as a fraction of the size of the handle
_MOVES = 8  # of the mouse, in a drag
_DELIVERY = 100  # ms: messages to a page are sent a few times a second or more often
_PATIENCE = 20_000  # ms: a page takes seconds to appear where other programs run


def chromium() -> str | None:
    """Returns the browser of the system, if there is one."""
    return next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)


class Visitor:
    """Someone who looks at a viewer and uses it, with a mouse."""

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
        self._dismiss_warning()

    def _dismiss_warning(self) -> None:
        """Closes the note that this browser draws without a graphics card."""
        note = self.page.locator(".mantine-Notification-root", has_text="Software WebGL")
        if note.count():
            note.locator("button").click()
            note.wait_for(state="detached")

    def until(self, happened: Callable[[], object]) -> None:
        """Waits until something has happened.

        Raises:
            TimeoutError: it has not.
        """
        for _ in range(_PATIENCE // 20):
            if happened():
                return
            self.page.wait_for_timeout(20)
        raise TimeoutError(f"still {self.text()!r}, {self.viewer.outcome}")

    def settle(self) -> None:
        """Waits until the page has drawn what it was sent."""
        self.page.wait_for_timeout(_DELIVERY)
        self.page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")

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
        """Returns where on the page a point (3,) of the scene is (2,)."""
        import viser.transforms

        camera = self.viewer.server.get_clients()[self._client].camera
        seen = viser.transforms.SO3(camera.wxyz).as_matrix().T @ (point - camera.position)
        focal = 0.5 * camera.image_height / np.tan(0.5 * camera.fov)
        center = 0.5 * np.array([camera.image_width, camera.image_height])
        return np.asarray(center + focal * seen[:2] / seen[2])

    def drag(self, name: str, axis: int, distance: float) -> None:
        """Drags an arrow of a handle, such as "/target", by a distance along its axis (m)."""
        self.settle()  # until the handle is where the server put it
        handle: Any = self.viewer.server.scene.get_handle_by_name(name)
        place = bik.pose(handle.position, wxyz=handle.wxyz)
        along = place[:3, axis]
        grip = place[:3, 3] + _GRIP * handle.scale * along
        self.page.mouse.move(*self.pixel(grip))
        self.settle()  # until the arrow lights up
        self.page.mouse.down()
        for i in range(1, _MOVES + 1):
            self.page.mouse.move(*self.pixel(grip + distance * i / _MOVES * along))
            self.page.wait_for_timeout(20)
        self.page.mouse.up()


@contextmanager
def visits() -> Iterator[Any]:
    """Yields a headless browser, which draws without a graphics card."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium(), args=_SOFTWARE)
        yield browser
        browser.close()
