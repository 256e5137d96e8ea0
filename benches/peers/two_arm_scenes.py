"""Scenes for two arms, drawn by seed in the style of MotionBenchMaker, each with two clear configurations."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

import beetle_ik as bik

MARGIN = 1e-3  # m
AROUND = 0.02  # m: least distance between obstacles and a hidden way
CORNERS = 5  # of a hidden way
APART = 0.02  # rad, m: between samples of a hidden way

Problem = tuple[bik.Scene, np.ndarray, np.ndarray]
Boxes = list[bik.obstacles.Obstacle]
# Of each robot: where the scene begins in front of it, and the height of its middle (m).
Place = tuple[float, float]


def drawn(kind: str, robot: bik.Robot, place: Place, seed: int) -> Problem:
    """Draws the problem of a kind with this number."""
    random = np.random.default_rng([seed, list(KINDS).index(kind)])
    while True:
        problem = KINDS[kind](robot, place, random)
        if problem is not None:
            return problem


def shelf(robot: bik.Robot, place: Place, random: np.random.Generator) -> Problem | None:
    """Both hands from openings of a shelf to others: boards and walls, three openings high and two wide."""
    x, z = np.array(place) + random.uniform(-0.05, 0.1, 2)
    depth, height = random.uniform(0.28, 0.4), random.uniform(0.28, 0.4)
    levels, walls = z + height * (np.arange(4) - 1.5), (-0.55, 0.0, 0.55)
    boards: Boxes = [bik.obstacles.Box((x + depth / 2, 0, level), (depth, 1.1, 0.02)) for level in levels]
    boards += [bik.obstacles.Box((x + depth / 2, y, z), (depth, 0.02, 3 * height)) for y in walls]
    back = bik.obstacles.Box((x + depth, 0, z), (0.02, 1.1, 3 * height))
    return between_places(robot, bik.Scene([*boards, back]), [(x, 0.0, z)] * 2, random)


def cage(robot: bik.Robot, place: Place, random: np.random.Generator) -> Problem | None:
    """Both hands from gaps between bars to others."""
    x, z = np.array(place) + random.uniform(-0.05, 0.1, 2)
    gap = random.uniform(0.3, 0.4)
    bars: Boxes = [bik.obstacles.Box((x, y, z), (0.03, 0.03, 2.0)) for y in gap * np.arange(-3, 4)]
    bars += [bik.obstacles.Box((x, 0, z + gap * k), (0.03, 2.4, 0.03)) for k in (-2, -1, 0, 1, 2)]
    return between_places(robot, bik.Scene(bars), [(x, 0.0, z)] * 2, random)


def table(robot: bik.Robot, place: Place, random: np.random.Generator) -> Problem | None:
    """Both hands from between things on a table to below it, or the other way."""
    x, z = place[0] - 0.05, place[1] + random.uniform(-0.1, 0.1)
    things: Boxes = [bik.obstacles.Box((x + 0.4, 0, z), (0.8, 1.6, 0.04))]
    for _ in range(10):
        radius, height = random.uniform(0.02, 0.05), random.uniform(0.1, 0.35)
        foot = (random.uniform(x + 0.1, x + 0.7), random.uniform(-0.7, 0.7), z + 0.02 + height / 2)
        things.append(bik.obstacles.Cylinder(foot, (0, 0, 1), radius, height))
    heights = [z + 0.35, z - 0.35]
    random.shuffle(heights)
    return between_places(robot, bik.Scene(things), [(x, 0.0, height) for height in heights], random, 0.25)


def hidden_way(robot: bik.Robot, place: Place, random: np.random.Generator) -> Problem | None:
    """Boxes drawn around a way of four random straight lines, none of which touches it."""
    drawn = robot.random_configurations(400, seed=int(random.integers(2**31)))
    drawn = drawn[bik.obstacles.clearance(robot, drawn) > AROUND]
    corners, way = list(drawn[:1]), drawn[:1]
    for corner in drawn[1:]:
        line = along(corners[-1], corners[-1] + random.uniform(0.5, 1.0) * (corner - corners[-1]))
        if len(corners) < CORNERS and bik.obstacles.clearance(robot, line).min() > AROUND:
            corners.append(line[-1])
            way = np.concatenate([way, line])
    if len(corners) < CORNERS:
        return None
    boxes: Boxes = []
    for _ in range(300):
        at = np.array([place[0], 0.0, place[1]]) + random.uniform((-0.8, -1.0, -0.8), (0.5, 1.0, 0.8))
        box = bik.obstacles.Box(at, random.uniform(0.05, 0.3, 3))
        if bik.obstacles.clearance(robot, way[::8], [box]).min() > AROUND and bik.obstacles.clearance(robot, way, [box]).min() > AROUND:
            boxes.append(box)
    return bik.Scene(boxes), corners[0], corners[-1]


KINDS: dict[str, Callable[[bik.Robot, Place, np.random.Generator], Problem | None]] = {
    "shelf": shelf,
    "cage": cage,
    "table": table,
    "hidden way": hidden_way,
}


def between_places(
    robot: bik.Robot,
    scene: bik.Scene,
    middles: list[tuple[float, float, float]],
    random: np.random.Generator,
    height: float = 0.4,
) -> Problem | None:
    """Clear configurations with both hands around the first place and around the second."""
    ends = [hands_at(robot, scene, middle, height, random) for middle in middles]
    return None if ends[0] is None or ends[1] is None else (scene, ends[0], ends[1])


def hands_at(
    robot: bik.Robot,
    scene: bik.Scene,
    middle: tuple[float, float, float],
    height: float,
    random: np.random.Generator,
) -> np.ndarray | None:
    """A clear configuration with both hands behind a place, each on its side."""
    for _ in range(60):
        targets = {
            tip: middle + random.uniform((0.03, 0.1, -height), (0.2, 0.5, height)) * (1.0, side, 1.0)
            for tip, side in zip(robot.tips, (1.0, -1.0), strict=True)
        }
        start = robot.random_configurations(1, seed=int(random.integers(2**31)))[0]
        stop = bik.Stop(max_evaluations=4000)
        solution = bik.solve(robot, targets, start_q=start, obstacles=scene, margin=4 * MARGIN, stop=stop)
        if solution.success:
            return solution.q
    return None


def along(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Configurations on a straight line (m, n)."""
    count = 1 + int(np.abs(end - start).max() / APART)
    return start + np.linspace(0.0, 1.0, count + 1)[:, None] * (end - start)
