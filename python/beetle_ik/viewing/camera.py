"""First view of a page and of a recording."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import viser
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

FIELD = 0.8  # rad: the vertical field of view
_FROM = np.array([1.05, 0.9, 0.45])  # viewpoint relative to the target, as a fraction of its size
_ASIDE = np.array([-0.1, 0.12, 0.0])  # shift of the view to the right: the controls cover that side
_MARGIN, _ASPECT = 1.08, 1.3  # recording: distance over the least one, width over height of narrow frames
_UPRIGHT, _BELOW = 0.75, 0.24  # upright window: distance, and height of the arm above the middle
_SAME = 1e-3  # m: two camera positions nearer than this are one
_NARROWEST = 0.3  # width over height of a window; a camera for a narrower one would be far away


class Camera:
    """The first camera of visitors.

    It is `server.initial_camera`, unless the window of a visitor is upright. Then the controls cover the lower half:
    the camera looks from farther away, so that the width fits, and below the arm, which appears in the upper half.
    """

    def __init__(self, server: viser.ViserServer, low: Array, high: Array, size: float) -> None:
        """Looks at a box with the corners `low` and `high` (3,), of which `size` (m) must fit into the window."""
        self._server = server
        self._middle, self._size = 0.5 * (low + high), size
        look = self._middle + _ASIDE * size
        self._aim(look, look + _FROM * size)
        server.on_client_connect(self._visited)

    @contextmanager
    def recording(self, boxes: Array) -> Iterator[None]:
        """Looks at boxes (k, 2, 3) while they are recorded, from near: a recording has no controls."""
        if self._chosen:
            yield
            return
        first = self._server.initial_camera
        before = (first.look_at, first.position)
        try:
            look = 0.5 * (boxes[:, 0].min(axis=0) + boxes[:, 1].max(axis=0))
            self._aim(look, look + _fitting(_corners(boxes) - look))
            yield
        finally:
            self._aim(*before)

    @property
    def _chosen(self) -> bool:
        """Whether the user chose another camera."""
        first = self._server.initial_camera
        return first.look_at is not self._set[0] or first.position is not self._set[1]

    def _aim(self, look: Array, position: Array) -> None:
        first = self._server.initial_camera
        first.look_at, first.position, first.fov = look, position, FIELD
        self._set = (first.look_at, first.position)

    def _visited(self, client: viser.ClientHandle) -> None:
        self._turn(client.camera)

        # Repeats the view: a page that is slow to appear takes the first camera after it was sent another.
        @client.camera.on_update
        def _(seen: viser.CameraHandle) -> None:
            if np.allclose(seen.position, self._server.initial_camera.position, atol=_SAME):
                self._turn(seen)

    def _turn(self, seen: viser.CameraHandle) -> None:
        narrow = max(seen.image_width / max(seen.image_height, 1), _NARROWEST)
        if narrow >= 1.0 or self._chosen:
            return
        away = _UPRIGHT * self._size / narrow * _FROM
        below = _BELOW * 2.0 * float(np.linalg.norm(away)) * np.tan(0.5 * FIELD)
        look = self._middle - [0.0, 0.0, below]
        seen.position = look + away  # viser moves it along with the position
        seen.look_at = look


def _corners(boxes: Array) -> Array:
    """Returns the corners (8 k, 3) of boxes (k, 2, 3)."""
    choices = np.indices((2, 2, 2)).reshape(3, -1).T
    return boxes[:, choices, np.arange(3)].reshape(-1, 3)


def _fitting(points: Array) -> Array:
    """Returns the viewpoint (3,) from which points (k, 3) about the origin fill the window."""
    toward = _FROM / np.linalg.norm(_FROM)
    right = np.cross([0.0, 0.0, 1.0], toward)
    right /= np.linalg.norm(right)
    across = np.maximum(np.abs(points @ np.cross(toward, right)), np.abs(points @ right) / _ASPECT)
    distance = float(np.max(points @ toward + across / np.tan(0.5 * FIELD)))
    return np.asarray(_MARGIN * distance * toward)
