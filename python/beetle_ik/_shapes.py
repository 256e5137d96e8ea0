"""Obstacles and the room that links take up, in pictures."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from ._core import Capsule

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ._core import Obstacle, Robot

_IN_SPACE = "#E69F00"
_FROM_ABOVE = "#F3D58C"
_LINKS = "#56B4E9"


def draw_obstacles(axes: Any, obstacles: Iterable[Obstacle]) -> NDArray[np.float64]:
    """Shades the surfaces of `obstacles` into 3-D axes, or seen from above into flat ones; returns corners (k, 3)."""
    from matplotlib.collections import PolyCollection
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection  # type: ignore[import-untyped, unused-ignore]

    corners = [np.empty((0, 3))]
    for obstacle in obstacles:
        triangles = obstacle.triangles
        corners.append(triangles.reshape(-1, 3))
        if axes.name == "3d":
            axes.add_collection3d(Poly3DCollection(triangles, facecolor=_IN_SPACE, alpha=0.35, linewidth=0))
        else:
            axes.add_collection(PolyCollection(list(triangles[:, :, :2]), facecolor=_FROM_ABOVE, linewidth=0, zorder=0))
    return np.vstack(corners)


def draw_capsules(axes: Any, robot: Robot, q: ArrayLike) -> None:
    """The room that the links take up at `q` (n,), translucent, in 3-D axes."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection  # type: ignore[import-untyped, unused-ignore]

    poses = dict(zip(robot.link_names, robot.link_poses(q), strict=True))
    for link, a, b, radius in robot.capsules:
        if radius > 0.0:
            rotation, origin = poses[link][:3, :3], poses[link][:3, 3]
            surface = Capsule(rotation @ a + origin, rotation @ b + origin, radius).triangles
            axes.add_collection3d(Poly3DCollection(surface, facecolor=_LINKS, alpha=0.12, linewidth=0))
