"""Random programs of moves as plain data, and a judge of their motions by numpy and scipy alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

import beetle_ik as bik

Array = NDArray[np.float64]

ON_PATH = 1e-5
"""Largest distance of the tip from a line or an arc (m)."""
TURNED = 1e-4
"""Largest angle between the tip and the uniform turn (rad)."""
SPEED = 1e-3
# Beside a corner the length of the path and that of its spline differ a little.
SLOWER = 1.5e-3
"""Largest relative error of a speed asked for."""
STEP = 1e-6
"""Step of finite differences (s)."""

Turned = Callable[[Array, Rotation], Array]
"""What counts of the turns between orientations (m, 3, 3) and those due: angles (m,)."""


def whole(orientations: Array, due: Rotation) -> Array:
    return (Rotation.from_matrix(orientations) * due.inv()).magnitude()


def of_axis(axis: Array, tolerance: float = 0.0) -> Turned:
    """The angle between directions of an axis of the tip, beyond a tolerance; its spin is free."""
    unit = np.asarray(axis) / np.linalg.norm(axis)

    def turned(orientations: Array, due: Rotation) -> Array:
        between = np.linalg.norm(orientations @ unit - due.apply(unit), axis=1)
        return np.maximum(2.0 * np.arcsin(np.minimum(0.5 * between, 1.0)) - tolerance, 0.0)

    return turned


def of_vector(tolerance: Array) -> Turned:
    """The entries of the rotation vector in the axes of the target, beyond a tolerance each."""

    def turned(orientations: Array, due: Rotation) -> Array:
        vectors = (due.inv() * Rotation.from_matrix(orientations)).as_rotvec()
        return np.linalg.norm(np.maximum(np.abs(vectors) - tolerance, 0.0), axis=1)

    return turned


def nothing(orientations: Array, _: Rotation) -> Array:
    return np.zeros(len(orientations))


@dataclass
class Curve:
    """The curve of a line or an arc, by its length."""

    start: Array
    end: Array
    length: float
    at: Callable[[Array], Array]
    nearest: Callable[[Array], Array]

    def errors(self, poses: Array, turned: Turned = whole) -> tuple[Array, Array]:
        """Distances from the curve (m), and angles from the uniform turn (rad), as far as it counts."""
        s = self.nearest(poses[:, :3, 3])
        distances = np.linalg.norm(self.at(s) - poses[:, :3, 3], axis=1)
        turn = Rotation.from_matrix(self.end[:3, :3] @ self.start[:3, :3].T).as_rotvec()
        expected = Rotation.from_rotvec(np.outer(s / self.length, turn)) * Rotation.from_matrix(self.start[:3, :3])
        return distances, turned(poses[:, :3, :3], expected)


def line(start: Array, end: Array) -> Curve:
    way = end[:3, 3] - start[:3, 3]
    length = float(np.linalg.norm(way))

    def nearest(points: Array) -> Array:
        return np.clip((points - start[:3, 3]) @ way / length, 0.0, length)

    return Curve(start, end, length, lambda s: start[:3, 3] + np.outer(s / length, way), nearest)


def arc(start: Array, via: Array, end: Array, angle: float | None = None) -> Curve:
    a, b, c = start[:3, 3], np.asarray(via), end[:3, 3]
    # The centre is as far from all three points, and in their plane.
    normal = np.cross(b - a, c - a)
    rows = np.array([b - a, c - a, normal])
    right = np.array([(b @ b - a @ a) / 2, (c @ c - a @ a) / 2, normal @ a])
    centre = np.linalg.solve(rows, right)
    radius = float(np.linalg.norm(a - centre))
    x = (a - centre) / radius
    y = np.cross(normal / np.linalg.norm(normal), x)
    swept = float(np.arctan2((c - centre) @ y, (c - centre) @ x) % (2 * np.pi)) if angle is None else angle

    def at(s: Array) -> Array:
        phi = s / radius
        return centre + radius * (np.outer(np.cos(phi), x) + np.outer(np.sin(phi), y))

    def nearest(points: Array) -> Array:
        phi = np.arctan2((points - centre) @ y, (points - centre) @ x) % (2 * np.pi)
        beyond = phi > min(swept, 2 * np.pi) + 0.5 * max(2 * np.pi - swept, 0.0)
        return radius * np.where(beyond, 0.0, np.minimum(phi, swept))

    tip = end.copy()
    tip[:3, 3] = at(np.array([radius * swept]))[0]
    return Curve(start, tip, radius * swept, at, nearest)


def moves_of(program: list[dict[str, Any]]) -> list[bik.moves.Move]:
    """The program as the library takes it."""
    made = []
    for given in program:
        rest = dict(given)
        kind = rest.pop("kind")
        if kind == "joints":
            made.append(bik.moves.Joints(rest.pop("goal"), **rest))
        elif kind == "line":
            made.append(bik.moves.Line(rest.pop("pose"), **rest))
        elif kind == "arc":
            made.append(bik.moves.Arc(rest.pop("via"), rest.pop("pose"), **rest))
        else:
            made.append(bik.moves.Wait(rest.pop("seconds"), **rest))
    return made


def draw(robot: bik.Robot, start: Array, count: int, random: np.random.Generator) -> list[dict[str, Any]]:
    """A program of `count` moves that the arm probably makes, with round numbers as often as reals."""
    lower, upper = (np.clip(limit, -np.pi, np.pi) for limit in (robot.lower, robot.upper))
    program: list[dict[str, Any]] = []
    pose = robot.fk(start)
    for _ in range(count):
        kind = random.choice(["joints", "line", "line", "line", "arc", "wait"])
        if kind == "joints":
            q = start + 0.3 * random.uniform(lower - start, upper - start)
            blend = float(random.choice([0.0, 0.0, 0.01, 0.03]))
            if random.random() < 0.5:
                pose = robot.fk(q)
                program.append({"kind": "joints", "goal": pose, "blend": blend})
            else:
                q = np.round(q, 1) if random.random() < 0.5 else q
                q = np.clip(q, robot.lower, robot.upper)
                pose = robot.fk(q)
                program.append({"kind": "joints", "goal": q, "blend": blend})
            continue
        if kind == "wait":
            if program:
                program[-1].pop("blend", None)
            program.append({"kind": "wait", "seconds": float(random.choice([0.0, 0.5, random.uniform(0, 1)]))})
            continue
        radius = random.choice([0.05, 0.1, random.uniform(0.02, 0.2)])
        way = radius * unit(random)
        if random.random() < 0.4:
            way = radius * np.eye(3)[random.integers(3)] * random.choice([-1.0, 1.0])
        turn = np.zeros(3) if random.random() < 0.5 else 0.4 * random.random() * unit(random)
        goal = pose.copy()
        goal[:3, 3] += way
        goal[:3, :3] = Rotation.from_rotvec(turn).as_matrix() @ pose[:3, :3]
        speed = [None, 0.05, 0.1, 0.25, 1.0, float(random.uniform(0.01, 0.5))][random.integers(6)]
        blend = [0.0, 0.01, 0.2 * radius, 0.3 * radius][random.integers(4)]
        move: dict[str, Any] = {"kind": str(kind), "pose": goal, "speed": speed, "blend": float(blend)}
        if kind == "arc":
            move["via"] = pose[:3, 3] + 0.5 * way + 0.4 * np.cross(way, unit(random))
        program.append(move)
        pose = goal
    program[-1].pop("blend", None)
    return program


def unit(random: np.random.Generator) -> Array:
    vector = random.normal(size=3)
    return vector / np.linalg.norm(vector)


def faults(
    robot: bik.Robot,
    fk: Callable[[Array], Array],
    program: list[dict[str, Any]],
    plan: bik.Plan,
    limits: dict[str, Array],
    samples: int = 10_000,
    turned: Turned = whole,
) -> list[str]:
    """What is wrong with the motion of a program, in words; `turned` says what counts of orientations."""

    def misses(reached: Array, pose: Array) -> bool:
        angle = turned(reached[None, :3, :3], Rotation.from_matrix(pose[None, :3, :3]))[0]
        return bool(np.abs(reached[:3, 3] - pose[:3, 3]).max() > 1e-6 or angle > 2e-6)

    found: list[str] = []
    trajectory = plan.trajectory
    t = np.linspace(0.0, trajectory.duration, samples)
    q, qd, qdd = (np.asarray(rows) for rows in trajectory.at(t))
    slack = 1e-9 * np.maximum(1.0, np.abs(np.where(np.isfinite(robot.lower), robot.lower, 0.0)))
    if (q < robot.lower - slack).any() or (q > robot.upper + slack).any():
        found.append("a joint is outside its limits")
    for name, rows in (("velocity", qd), ("acceleration", qdd)):
        if (np.abs(rows) > limits[name] * (1 + 1e-9)).any():
            found.append(f"{name}: {np.max(np.abs(rows) / limits[name])} of the limit")
    if "jerk" in limits and (trajectory.max_jerk() > limits["jerk"] * (1 + 1e-6)).any():
        found.append(f"jerk: {np.max(trajectory.max_jerk() / limits['jerk'])} of the limit")
    poses = fk(q)
    inside = np.clip(t, STEP, trajectory.duration - STEP)
    ahead, behind = (fk(np.asarray(trajectory.at(inside + sign * STEP)[0]))[:, :3, 3] for sign in (1, -1))
    speeds = np.linalg.norm(ahead - behind, axis=1) / (2 * STEP)
    if np.abs(qd[[0, -1]]).max() > 1e-9:
        found.append("it does not begin and end at rest")
    start = fk(q[:1])[0]
    blend_before = 0.0
    now = 0.0
    for i, (move, report) in enumerate(zip(program, plan.moves, strict=True)):
        if abs(report.start - now) > 1e-9 or report.end < report.start:
            found.append(f"move {i} is reported from {report.start} to {report.end}, after {now}")
        now = report.end
        on = (t >= report.start) & (t <= report.end)
        blend = move.get("blend", 0.0)
        if move["kind"] == "joints":
            end = np.asarray(trajectory.at(report.end)[0])
            goal = move["goal"]
            pose = goal if goal.shape == (4, 4) else fk(goal[None])[0]
            reached = fk(end[None])[0]
            if blend > 0.0:
                if np.linalg.norm(reached[:3, 3] - pose[:3, 3]) > blend:
                    found.append(f"move {i} passes its end outside of the ball of its blend")
            elif goal.ndim == 1 and np.abs(end - goal).max() > 1e-9:
                found.append(f"move {i} ends at {end}, not at {goal}")
            elif misses(reached, pose):
                found.append(f"move {i} ends at another pose")
            start, blend_before = pose, blend
            continue
        if move["kind"] == "wait":
            if abs(report.end - report.start - move["seconds"]) > 1e-9 or np.abs(qd[on]).max(initial=0.0) > 1e-9:
                found.append(f"move {i} does not rest")
        else:
            curve = (
                line(start, move["pose"])
                if move["kind"] == "line"
                else arc(start, move["via"], move["pose"], move.get("angle"))
            )
            begin, end = curve.at(np.array([0.0, curve.length]))
            near = [np.linalg.norm(poses[:, :3, 3] - corner, axis=1) for corner in (begin, end)]
            on_curve = on & (near[0] >= blend_before) & (near[1] >= blend)
            distances, angles = curve.errors(poses, turned)
            if distances[on_curve].max(initial=0.0) > ON_PATH:
                found.append(f"move {i} is {distances[on_curve].max()} m off its path")
            if angles[on_curve].max(initial=0.0) > TURNED:
                found.append(f"move {i} is {angles[on_curve].max()} rad off its turn")
            strayed = (
                on & ~on_curve & (distances > ON_PATH) & (near[0] > blend_before + 1e-9) & (near[1] > blend + 1e-9)
            )
            if strayed.any():
                found.append(f"move {i} leaves the ball of its blend")
            if blend == 0.0 and misses(fk(np.asarray(trajectory.at(report.end)[0])[None])[0], curve.end):
                found.append(f"move {i} does not end at its pose")
            if move.get("speed") is not None:
                # A difference quotient across a change of acceleration is off by a little.
                on_speed = on_curve & (t > report.start + 2 * STEP) & (t < report.end - 2 * STEP)
                found.extend(speed_faults(i, move["speed"], t, speeds, on_speed, report))
            start, blend_before = curve.end, blend
            continue
        blend_before = 0.0
    return found


def speed_faults(
    i: int, asked: float, t: Array, speeds: Array, on_curve: NDArray[np.bool_], report: bik.MoveReport
) -> list[str]:
    found = []
    if speeds[on_curve].max(initial=0.0) > asked * (1 + SPEED):
        found.append(f"move {i} runs at {speeds[on_curve].max()} m/s, asked for {asked}")
    explained = np.zeros(len(t), dtype=bool)
    for bound in report.bound_by:
        explained |= (t >= bound.start) & (t <= bound.end)
    slow = on_curve & ~explained & (speeds < asked * (1 - SLOWER))
    if slow.any():
        found.append(f"move {i} runs at {speeds[slow].min()} m/s of {asked} at {t[slow][0]} s, for no reason given")
    return found
