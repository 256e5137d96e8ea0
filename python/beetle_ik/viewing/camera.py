"""From where a page and a recording are seen first."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import viser
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

FIELD = 0.8  # rad: the vertical field of view
_FROM = np.array([1.05, 0.9, 0.45])  # from where it looks, as a fraction of what it looks at
_ASIDE = np.array([-0.1, 0.12, 0.0])  # to the right of what it looks at: the controls cover that side of the page
_NEAR = 0.95  # of a recording, which has no controls
_NARROWEST = 0.3  # width over height of a window; a camera for a narrower one would be far away


class Camera:
    """The first camera of visitors. Upright windows look from farther away, so that the width fits."""

    def __init__(self, server: viser.ViserServer) -> None:
        """Waits for `show`."""
        self._server = server
        self._set: list[Array] = []

        @server.on_client_connect
        def _(client: viser.ClientHandle) -> None:
            seen, first = client.camera, server.initial_camera
            narrow = max(seen.image_width / max(seen.image_height, 1), _NARROWEST)
            if narrow < 1.0:
                seen.position = first.look_at + (first.position - first.look_at) / narrow

    def show(self, low: Array, high: Array, size: float) -> None:
        """Looks at a box with the corners `low` and `high` (3,), of which `size` (m) is to fit into the window."""
        look = 0.5 * (low + high) + _ASIDE * size
        self._aim(look, look + _FROM * size)

    @contextmanager
    def recording(self, low: Array, high: Array) -> Iterator[None]:
        """Looks at a box while it is recorded, unless the user chose another camera."""
        first: Any = self._server.initial_camera
        before = [first.look_at, first.position]
        if any(one is not other for one, other in zip(before, self._set, strict=True)):
            yield
            return
        look = 0.5 * (low + high)
        try:
            self._aim(look, look + _NEAR * float(np.linalg.norm(high - low)) * _FROM)
            yield
        finally:
            self._aim(*before)

    def _aim(self, look: Array, position: Array) -> None:
        first = self._server.initial_camera
        first.look_at, first.position, first.fov = look, position, FIELD
        self._set = [first.look_at, first.position]
