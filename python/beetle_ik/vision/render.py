"""Synthetic images of planar arms, for tests and examples."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInputError, Robot
from ..calls.arguments import require_count
from ..installed.needs import library
from .camera import Camera, check_planar, checked, distance_to_links, numbers


def render(
    robot: Robot,
    q: ArrayLike,
    *,
    camera: Camera | None = None,
    shape: tuple[int, int] = (256, 256),
    noise: float = 0.0,
    seed: int = 0,
) -> NDArray[np.float64]:
    """Renders an image (rows, columns) of the arm at `q` (n,): 1 on its links, 0 elsewhere, blurred over one pixel.

    Args:
        robot: a planar arm.
        q: (n,) (rad).
        camera: None: 80 pixels per metre, the base at the centre of 256 by 256 pixels.
        shape: rows and columns.
        noise: standard deviation of the noise on each pixel.
        seed: seed of the noise.
    """
    check_planar(robot)
    camera = checked(camera)
    if numbers("shape", shape).shape != (2,) or min(shape) < 1:
        raise InvalidInputError(f"shape must be rows and columns, got {shape!r:.60}")
    numbers("noise", noise)
    require_count("seed", seed)
    rows, columns = np.mgrid[: shape[0], : shape[1]]
    pixels = np.stack((columns.ravel(), rows.ravel()), axis=1).astype(float)
    inside = camera.half_width - distance_to_links(pixels, camera.joint_points(robot, q))
    picture = np.clip(inside + 0.5, 0.0, 1.0).reshape(shape)
    return np.asarray(picture + noise * np.random.default_rng(seed).standard_normal(shape))


def outline(
    robot: Robot, q: ArrayLike, *, camera: Camera | None = None, margin: float = 0.0, points: int = 300
) -> NDArray[np.float64]:
    """Returns the closed outline of the arm at `q` (n,), `margin` pixels outside: (points, 2), column and row."""
    library("skimage", "scikit-image", "a picture", extra="vision")
    check_planar(robot)
    numbers("margin", margin)
    require_count("points", points)
    from skimage.measure import find_contours

    camera = checked(camera)
    joints = camera.joint_points(robot, q)
    reach = camera.half_width + margin + 3.0
    low = np.floor(joints.min(axis=0) - reach).astype(int)
    columns, rows = (np.arange(size) for size in np.ceil(joints.max(axis=0) + reach).astype(int) - low)
    grid = np.stack(np.meshgrid(columns, rows), axis=2).reshape(-1, 2) + low
    inside = camera.half_width + margin - distance_to_links(grid.astype(float), joints)
    contours = find_contours(inside.reshape(len(rows), len(columns)), 0.0)
    longest = max(contours, key=len)[:, ::-1] + low
    return evenly(longest, points)


def evenly(curve: NDArray[np.float64], points: int) -> NDArray[np.float64]:
    """Resamples a curve (k, 2) at `points` places, evenly spaced by length."""
    length = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=1))))
    places = np.linspace(0.0, length[-1], points)
    return np.stack([np.interp(places, length, coordinate) for coordinate in curve.T], axis=1)
