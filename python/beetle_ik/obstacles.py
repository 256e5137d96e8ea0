"""Obstacles, in the frame of the robot's base, and the distance of a robot from them.

Solutions, tracks and plans keep all bodies of the robot clear of the obstacles:

    robot = bik.Robot.named("panda").with_capsules(radius=0.06)
    crate = bik.obstacles.Box(center=(0.5, 0, 0.2), size=(0.2, 0.6, 0.4))
    plan = bik.plan_point_to_point(robot, start_q=here, end=there, obstacles=[crate])

A `Scene` keeps obstacles together and saves them. `clearance` is the smallest distance at one configuration or many;
`nearest` also gives the two bodies, the nearest point, the normal, and the gradient with respect to the joints.
"""

from ._core import (
    Box,
    Capsule,
    ConvexMesh,
    Cylinder,
    Ellipse,
    Ellipsoid,
    Grid,
    HalfSpace,
    Mesh,
    Moving,
    Nearest,
    Obstacle,
    PointCloud,
    Sphere,
    clearance,
    nearest,
)

__all__ = [
    "Box",
    "Capsule",
    "ConvexMesh",
    "Cylinder",
    "Ellipse",
    "Ellipsoid",
    "Grid",
    "HalfSpace",
    "Mesh",
    "Moving",
    "Nearest",
    "Obstacle",
    "PointCloud",
    "Sphere",
    "clearance",
    "nearest",
]
