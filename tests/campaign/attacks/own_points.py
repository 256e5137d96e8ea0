"""What is taken out of a cloud as the robot's own, against numpy."""

from __future__ import annotations

from typing import Any

import numpy as np

import beetle_ik as bik

from ..attack import Attack, BrokenError, Case

EXACT = 1e-9  # m: what is lost to rounding for capsules near the origin
ROBOTS = {"panda": 0.06, "ur5e": 0.05, "iiwa14": 0.07, "ur10e": 0.1}  # and the radius of their links (m)


def from_capsules(robot: bik.Robot, q: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Distances of points from the capsules of a robot."""
    frames = dict(zip(robot.all_link_names, robot.all_link_poses(q), strict=True))
    least = np.full(len(points), np.inf)
    for link, a, b, radius in robot.capsules:
        a, b = (frames[link][:3, :3] @ end + frames[link][:3, 3] for end in (a, b))
        along = b - a
        t = np.clip((points - a) @ along / max(along @ along, 1e-300), 0.0, 1.0)
        least = np.minimum(least, np.linalg.norm(points - a - t[:, None] * along, axis=1) - radius)
    return least


class OwnPoints(Attack):
    name = "own_points"
    promise = "The points within the padding of the robot, and no others, are taken out of a cloud"
    page = "scenes"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Hard points are round, twice there, on the surfaces and axes of the arm, or exactly at the padding."""
        name = str(random.choice(list(ROBOTS)))
        robot = bik.Robot.named(name).with_capsules(radius=ROBOTS[name])
        q = robot.random_configurations(1, seed=int(random.integers(2**31)))[0]
        q = np.round(q / (np.pi / 4)) * (np.pi / 4) if hard and random.random() < 0.5 else q
        radius, padding = (float(random.choice([0.0, 0.001, 0.01, 0.1])) for _ in range(2))
        points = list(random.uniform(-1.0, 1.0, (int(random.integers(0, 60)), 3)))
        frames = dict(zip(robot.all_link_names, robot.all_link_poses(q), strict=True))
        for link, a, b, size in robot.capsules:
            middle = frames[link] @ np.append(a + random.choice([0.0, 0.5, 1.0, random.random()]) * (b - a), 1.0)
            normal = random.normal(size=3) if random.random() < 0.5 else np.eye(3)[random.integers(3)]
            out = random.choice([0.0, size, size + radius + padding, size + 2 * (radius + padding) + 0.01])
            points.append(middle[:3] + out * normal / np.linalg.norm(normal))
        if hard:
            points += [np.round(point, 1) for point in points] + points[:3]
        return {
            "robot": name,
            "q": tuple(q.tolist()),
            "radius": radius,
            "padding": padding,
            "points": [tuple(point.tolist()) for point in points],
        }

    def program(self, case: Case) -> str:
        return (
            f"robot = bik.Robot.named({case['robot']!r}).with_capsules(radius={ROBOTS[case['robot']]})\n"
            f"q, points = {case['q']}, np.reshape({case['points']}, (-1, 3))\n"
            f"cloud = bik.obstacles.PointCloud(points, {case['radius']})\n"
            f"left = cloud.without_robot(robot, q, padding={case['padding']})\n"
            "kept, removed = left.points, left.removed\n"
            "clearance = bik.obstacles.clearance(robot.with_collision_pairs([]), q, [left])"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        away = from_capsules(left["robot"], np.array(case["q"]), left["points"]) - case["radius"] - case["padding"]
        if left["removed"] != len(left["points"]) - len(left["kept"]):
            raise BrokenError("the number of points removed is wrong", (left["removed"], len(left["kept"])))
        kept = {tuple(point) for point in left["kept"].tolist()}
        for point, beyond in zip(left["points"].tolist(), away, strict=True):
            if abs(beyond) > EXACT and (tuple(point) in kept) != (beyond > 0.0):
                raise BrokenError("a point is kept, or taken out, against the padding", (point, beyond))
        if left["clearance"] <= case["padding"]:
            raise BrokenError("what is left is within the padding", left["clearance"])
        return len(left["points"])


ATTACKS = [OwnPoints()]
