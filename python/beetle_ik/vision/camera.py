"""The mapping from the plane of the arm to the image."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Real

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInputError, Robot
from ..calls.arguments import require


@dataclass(frozen=True, kw_only=True)
class Camera:
    """A camera that looks perpendicularly at the x-y plane: x to the right, y up."""

    pixels_per_metre: float = 80.0
    """Scale of the image (pixels per metre)."""
    origin: tuple[float, float] = (128.0, 128.0)
    """Column and row of (0, 0, 0) (pixels)."""
    link_width: float = 0.2
    """Visible width of the links (m); their ends are round."""

    def __post_init__(self) -> None:
        """Checks the options."""
        for name in ("pixels_per_metre", "link_width"):
            number = getattr(self, name)
            if not isinstance(number, Real) or not 0.0 < float(number) < np.inf:
                raise InvalidInputError(f"{name} must be positive and finite, got {number!r:.60}")
        if numbers("origin", self.origin).shape != (2,):
            raise InvalidInputError(f"origin must be column and row, got {self.origin!r:.60}")

    @property
    def half_width(self) -> float:
        """Half the width of a link (pixels)."""
        return 0.5 * self.link_width * self.pixels_per_metre

    def joint_points(self, robot: Robot, q: ArrayLike) -> NDArray[np.float64]:
        """Returns the ends of the links at `q` (n,) in the image: (links + 1, 2), column and row (pixels)."""
        points = robot.link_poses(q)[1:, :2, 3]
        return np.asarray(self.origin) + self.pixels_per_metre * points * [1.0, -1.0]


def checked(camera: Camera | None) -> Camera:
    """Returns the camera, or the default one for None."""
    camera = Camera() if camera is None else camera
    require("camera", camera, Camera)
    return camera


def numbers(name: str, values: object) -> NDArray[np.float64]:
    """Returns finite numbers as an array.

    Raises:
        InvalidInputError: another value; the message names the argument.
    """
    try:
        array = np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise InvalidInputError(f"{name} must be numbers, got {values!r:.60}") from None
    if not np.isfinite(array).all():
        raise InvalidInputError(f"{name} must be finite, got {values!r:.60}")
    return array


def check_planar(robot: Robot) -> None:
    """Raises an error unless the robot moves in the x-y plane."""
    require("robot", robot, Robot)
    q = np.clip(np.full(robot.dof, 0.3), robot.lower, robot.upper)
    out_of_plane = np.abs(robot.jacobian(q)[2:5]).max()
    if "prismatic" in robot.joint_kinds or out_of_plane > 1e-9:
        raise InvalidInputError(f"robot '{robot.name}' is not a planar arm: all joints must rotate about z")


def distance_to_links(points: NDArray[np.float64], joints: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the distances (k,) of `points` (k, 2) from the nearest link between `joints` (links + 1, 2)."""
    begin, along = joints[:-1], np.diff(joints, axis=0)
    offset = points[:, None, :] - begin
    share = np.clip(np.sum(offset * along, axis=2) / np.maximum(np.sum(along**2, axis=1), 1e-12), 0.0, 1.0)
    return np.asarray(np.linalg.norm(offset - share[..., None] * along, axis=2).min(axis=1))
