"""Defaults for robots whose models lack bodies, speeds or a configuration."""

import numpy as np
from numpy.typing import NDArray

from .._core import Obstacle, Robot, clearance
from ..calls.text import counted

_THICKNESS = 0.04  # radius of capsules, as a fraction of the length of the arm
_THINNEST = 0.005  # m
_SPEED = 2.0  # rad/s, m/s: speed of joints without a velocity limit
_CANDIDATES = 200
_CLEAR = 0.002  # m
_FLOOR = 1e-9  # m: links farther below the base would be in the floor of most robots
_SINGULAR = 0.3  # manipulability below this fraction of the median counts as singular


def shown(robot: Robot, *, has_meshes: bool) -> tuple[Robot, list[str]]:
    """Returns the robot with bodies and velocity limits, and a sentence for each addition or gap."""
    notes = []
    unread = counted(len(robot.unread_collision_shapes), "collision shape")
    if robot.unread_collision_shapes and robot.bodies and has_meshes:
        robot = robot.with_capsules(list(robot.capsules))
        notes.append(f'{unread} not read, and not kept clear: Robot.from_urdf(..., collision="fit") reads them')
    elif robot.unread_collision_shapes or not robot.bodies:
        lacking = f"{unread} not read" if robot.unread_collision_shapes else "no bodies in the model"
        radius = max(_THICKNESS * length(robot), _THINNEST)
        added = robot.with_capsules(radius=radius).capsules if len(robot.tips) == 1 else []
        places = "capsules along the links"
        if not added:  # several tips, or links without length as in gantries
            origin = np.zeros(3)
            places, added = "balls at the joints", [(link, origin, origin, radius) for link in robot.all_link_names]
        robot = robot.with_capsules([*robot.capsules, *added])
        notes.append(f"{lacking}: {places}, of radius {1e3 * radius:.0f} mm, take their place")
    speed = robot.velocity_limit
    for unknown, what in ((np.isinf(speed), "without a velocity limit"), (speed == 0, "with a velocity limit of 0")):
        if unknown.any():
            speed = np.where(unknown, _SPEED, speed)
            notes.append(f"{counted(int(unknown.sum()), 'joint')} {what}: here {_SPEED:g} rad/s or m/s")
    if np.any(speed != robot.velocity_limit):
        robot = robot.with_limits(velocity=speed)
    return robot, notes


def length(robot: Robot) -> float:
    """Returns the length of the (first) chain (m) from joint to joint, with joints in the middle of their ranges."""
    q = middle(robot)
    origins = np.vstack((robot.link_poses(q)[:, :3, 3], robot.fk(q).reshape(-1, 4, 4)[0, :3, 3]))
    return float(np.linalg.norm(np.diff(origins, axis=0), axis=1).sum())


def middle(robot: Robot) -> NDArray[np.float64]:
    """Returns the middle of the joint limits (n,); zero, or the limit nearest to it, for joints without both."""
    both = np.isfinite(robot.lower) & np.isfinite(robot.upper)
    with np.errstate(invalid="ignore"):
        return robot.clip(np.where(both, 0.5 * (robot.lower + robot.upper), 0.0))


def configuration(robot: Robot, obstacles: list[Obstacle]) -> NDArray[np.float64]:
    """Returns a start configuration (n,): the stance "ready", or a clear one near the middle, not singular."""
    if "ready" in robot.stances:
        return robot.stances["ready"]
    center = middle(robot)
    candidates = np.vstack((center, 0.5 * (center + robot.random_configurations(_CANDIDATES, seed=0))))
    agility = robot.manipulability(candidates) if len(robot.tips) == 1 else np.ones(len(candidates))
    good = (agility > _SINGULAR * np.median(agility)) & (clearance(robot, candidates, obstacles) > _CLEAR)
    heights = np.array([robot.link_poses(q)[:, 2, 3] for q in candidates])
    above = good & (heights.min(axis=1) >= heights[:, 0] - _FLOOR)
    kept = above if above.any() else good
    if not kept.any():
        return center
    away = np.linalg.norm(candidates - center, axis=1)
    return np.asarray(candidates[np.where(kept, away, np.inf).argmin()])
