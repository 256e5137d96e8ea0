"""Obstacles, in the frame of the robot's base, and the clearance of a robot from them.

A plan keeps all link capsules of the robot clear of the obstacles:

    robot = bik.Robot.named("panda").with_capsules(radius=0.06)
    crate = bik.obstacles.Box(center=(0.5, 0, 0.2), size=(0.2, 0.6, 0.4))
    plan = bik.plan_point_to_point(robot, start_q=here, end=there, obstacles=[crate])
"""

from ._core import (
    Box,
    Capsule,
    ConvexMesh,
    Ellipse,
    Ellipsoid,
    Obstacle,
    Sphere,
    clearance,
)

__all__ = [
    "Box",
    "Capsule",
    "ConvexMesh",
    "Ellipse",
    "Ellipsoid",
    "Obstacle",
    "Sphere",
    "clearance",
]
