"""Motions along seams and over surfaces: times, durations and distances from the path.

    python benches/seams.py --repeats 3

Seams of 2,000 poses where two pipes meet, with the torch free to spin, on arms with six and seven joints; walls of a
vase of 5,000 poses and of as many directions. Each motion is judged by forward kinematics at 5,000 instants.
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import numpy as np

import beetle_ik as bik

INSTANTS = 5000


def frames(points: np.ndarray, tool: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Poses (k, 4, 4) at points, with the z axis along `tool` and the x axis near `along`."""
    tool = tool / np.linalg.norm(tool, axis=1, keepdims=True)
    along = along - np.sum(along * tool, axis=1, keepdims=True) * tool
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    poses = np.tile(np.eye(4), (len(points), 1, 1))
    poses[:, :3, :] = np.stack([along, np.cross(tool, along), tool, points], axis=2)
    return poses


def pipe_seam(at: np.ndarray, count: int, main: float = 0.10, branch: float = 0.05) -> np.ndarray:
    """Poses along the seam of a branch pipe on a main one, with the torch between both normals."""
    angle = np.linspace(0.0, 2 * np.pi, count)
    x, y = branch * np.cos(angle), branch * np.sin(angle)
    z = np.sqrt(main**2 - x**2)
    of_main = np.column_stack([x, 0 * y, z]) / main
    of_branch = np.column_stack([np.cos(angle), np.sin(angle), 0 * z])
    return frames(at + np.column_stack([x, y, z]), -(of_main + of_branch), np.cross(of_main, of_branch))


def vase(at: np.ndarray, count: int, layers: int = 40) -> np.ndarray:
    """Poses along a helix over the wall of a vase, with the tool leaning with the wall, downwards."""
    turn = np.linspace(0.0, 2 * np.pi * layers, count)
    height = np.linspace(0.0, 0.20, count)
    radius = 0.06 + 0.02 * np.sin(2 * np.pi * height / 0.2)
    slope = 0.02 * 2 * np.pi / 0.2 * np.cos(2 * np.pi * height / 0.2)
    out = np.column_stack([np.cos(turn), np.sin(turn), 0 * turn])
    wall = slope[:, None] * out + np.array([0.0, 0.0, 1.0])
    return frames(
        at + radius[:, None] * out + height[:, None] * np.array([0, 0, 1.0]), -wall, np.tile([1.0, 0, 0], (count, 1))
    )


def cases() -> dict[str, tuple[bik.Robot, np.ndarray, dict[str, Any]]]:
    """Robot, poses and keywords of each case."""
    torch = bik.pose([0.0, 0.0, 0.15])
    ur5e, panda = (bik.Robot.named(name).with_tool(torch) for name in ("ur5e", "panda"))
    panda = panda.with_capsules(radius=0.04)
    printer = bik.Robot.named("ur5e").with_tool(bik.pose([0.0, 0.0, 0.10]))
    free = {"task": bik.tasks.Pointing(), "limits": bik.Limits(acceleration=5.0)}
    seam, higher = (pipe_seam(np.array([0.45, 0.0, z]), 2000) for z in (0.0, 0.2))
    solid = bik.obstacles
    around = [
        solid.Box(center=(0.85, 0.0, 0.45), size=(0.1, 0.6, 0.3)),
        solid.Box(center=(0.25, 0.35, 0.5), size=(0.06, 0.06, 1.0)),
    ]
    walls = vase(np.array([0.45, 0.0, 0.05]), 5000)
    return {
        "seam, six joints": (ur5e, seam, free),
        "seam, seven joints, among obstacles": (panda, higher, free | {"obstacles": around, "self_collision": False}),
        "vase, whole poses": (printer, walls, {"limits": bik.Limits(acceleration=5.0)}),
        "vase, directions": (printer, walls, free),
    }


def farthest(robot: bik.Robot, poses: np.ndarray, motion: bik.Trajectory) -> float:
    """Largest distance (m) of the tip from the polyline through the poses, at many instants."""
    q = motion.at(np.linspace(0, motion.duration, INSTANTS))[0]
    tips = robot.fk(q)[:, :3, 3]
    points = poses[:, :3, 3]
    starts, steps = points[:-1], np.diff(points, axis=0)
    worst = 0.0
    for tip in tips:
        share = np.clip(np.sum((tip - starts) * steps, axis=1) / np.maximum(np.sum(steps**2, axis=1), 1e-30), 0, 1)
        worst = max(worst, float(np.sqrt(np.min(np.sum((starts + share[:, None] * steps - tip) ** 2, axis=1)))))
    return worst


def main() -> None:
    """Plans each case and prints the figures."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--repeats", type=int, default=3, help="plans of each case; the median time is printed")
    options.add_argument("--only", default="", help="part of the name of the cases to run")
    given = options.parse_args()
    for name, (robot, poses, keywords) in cases().items():
        if given.only not in name:
            continue
        spent = []
        for _ in range(given.repeats):
            start = time.process_time()
            plan = bik.plan_along_path(robot, poses, **keywords)
            spent.append(time.process_time() - start)
        off = farthest(robot, poses, plan.trajectory)
        spent_ms = 1e3 * np.median(spent)
        print(f"{name}: {spent_ms:.0f} ms, {plan.trajectory.duration:.3f} s, {1e3 * off:.4f} mm off, {plan.success}")
        if not plan.success:
            print(f"  {plan.message}")


if __name__ == "__main__":
    main()
