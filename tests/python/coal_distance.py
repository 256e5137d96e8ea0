"""Distances of a robot by coal, an independent library."""

from typing import Any

import numpy as np
import pytest

import beetle_ik as bik


def distance_by_coal(arm: bik.Robot, q: np.ndarray, scene: bik.Scene) -> float:
    """Smallest distance of the links from the boxes of a scene, and from each other."""
    coal = pytest.importorskip("coal")
    request = coal.DistanceRequest()
    request.gjk_tolerance = 1e-9

    def apart(one: tuple[Any, Any], other: tuple[Any, Any]) -> float:
        return float(coal.distance(one[0], one[1], other[0], other[1], request, coal.DistanceResult()))

    place = dict(zip(arm.all_link_names, arm.all_link_poses(q), strict=True))
    links: list[tuple[str, tuple[Any, Any]]] = []
    for link, a, b, radius in arm.capsules:
        ends = [place[link][:3, :3] @ end + place[link][:3, 3] for end in (a, b)]
        length = float(np.linalg.norm(ends[1] - ends[0]))
        z = (ends[1] - ends[0]) / length
        x = np.cross(z, np.eye(3)[np.argmin(np.abs(z))])
        x /= np.linalg.norm(x)
        turn = np.column_stack((x, np.cross(z, x), z))
        links.append((link, (coal.Capsule(radius, length), coal.Transform3s(turn, sum(ends) / 2))))
    things = [(coal.Box(*box.size), coal.Transform3s(box.rotation, box.center)) for box in scene]  # type: ignore[attr-defined]
    pairs = {frozenset(pair) for pair in arm.collision_pairs}
    least = min(apart(body, thing) for _, body in links for thing in things)
    return min([least, *(apart(a, b) for i, (m, a) in enumerate(links) for n, b in links[:i] if {m, n} in pairs)])
