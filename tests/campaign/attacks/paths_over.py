"""Lines on surfaces and moves of G-code, against numpy."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..attack import Attack, BrokenError, Case

ROUNDED = 1e-9  # m
STEP = 0.02  # m


def sheet(random: np.random.Generator, hard: bool) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces of a grid with heights: flat, folded, or rough."""
    n = int(random.integers(2, 8))
    x, y = np.meshgrid(np.linspace(0.0, 0.5, n), np.linspace(0.0, 0.5, n))
    z = random.choice([np.zeros_like(x), 0.2 * np.abs(x - 0.25), 0.1 * x * y, 0.02 * random.random(x.shape)])
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = (corner[:, None] + np.array([[[0, 1, n + 1]], [[0, n + 1, n]]])).reshape(-1, 3)
    vertices = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    if hard:
        turned = random.random(len(faces)) < 0.3
        faces[turned] = faces[turned, ::-1]
        vertices, faces = vertices[faces].reshape(-1, 3), np.arange(3 * len(faces)).reshape(-1, 3)
    return vertices, faces


def distances(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Distances (k,) of points from the nearest triangle: to its plane where the foot is inside, else to its edges."""
    a, b, c = (triangles[None, :, i] for i in range(3))
    p = points[:, None]
    normal = np.cross(b - a, c - a)
    height = ((p - a) * normal).sum(axis=2) / np.linalg.norm(normal, axis=2)
    inside = np.ones(height.shape, dtype=bool)
    to_edges = np.full(height.shape, np.inf)
    for start, end in ((a, b), (b, c), (c, a)):
        inside &= (np.cross(end - start, p - start) * normal).sum(axis=2) >= 0.0
        share = np.clip(((p - start) * (end - start)).sum(axis=2) / ((end - start) ** 2).sum(axis=2), 0.0, 1.0)
        to_edges = np.minimum(to_edges, np.linalg.norm(p - start - share[..., None] * (end - start), axis=2))
    return np.where(inside, np.abs(height), to_edges).min(axis=1)


class SurfaceLine(Attack):
    name = "surface_line"
    promise = "A line on a surface keeps its standoff along the tool's axis, and its frames are rotations"
    page = "surfaces"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Hard lines go through vertices and along edges, stand still and turn back; faces wind at random."""
        vertices, faces = sheet(random, hard)
        count = int(random.integers(2, 7))
        points = random.uniform(0.0, 0.5, (count, 3)) * [1.0, 1.0, 0.1]
        if hard:
            points = np.concatenate([points, vertices[random.integers(len(vertices), size=3)], points[:1], points[:1]])
        return {
            "vertices": tuple(map(tuple, vertices.tolist())),
            "faces": tuple(map(tuple, faces.tolist())),
            "points": [tuple(point) for point in points.tolist()],
            "standoff": float(random.choice([0.0, 0.01, 0.1])),
            "rounding": float(random.choice([0.0, 0.01, 0.1])),
            "closed": bool(random.random() < 0.3),
        }

    def program(self, case: Case) -> str:
        options = f"standoff={case['standoff']}, rounding={case['rounding']}, closed={case['closed']}, within=1.0"
        return (
            f"surface = ({case['vertices']}, {case['faces']})\n"
            f"seam = bik.paths.on_surface(surface, {case['points']}, step={STEP}, {options})\n"
            "poses, distance = seam.poses, seam.distance"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        poses = left["poses"]
        turns = poses[:, :3, :3]
        if np.abs(turns @ turns.transpose(0, 2, 1) - np.eye(3)).max() > 1e-9 or np.linalg.det(turns).min() < 0.0:
            raise BrokenError("a frame is no rotation", turns[0].tolist())
        touched = poses[:, :3, 3] + case["standoff"] * poses[:, :3, 2]
        off = distances(touched, np.array(case["vertices"])[np.array(case["faces"])])
        if off.max() > ROUNDED:
            raise BrokenError("the tool points beside the surface", off.max())
        if case["closed"] and not np.array_equal(poses[0], poses[-1]):
            raise BrokenError("a closed line does not end in its first pose", poses[[0, -1]].tolist())
        return len(poses)


class Gcode(Attack):
    name = "gcode_moves"
    promise = "Moves of a program go through the points of its lines and arcs"
    page = "surfaces"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Moves are (kind, x, y, z, part of a circle): rounded numbers, often zero, in any unit and mode."""
        moves = []
        for _ in range(int(random.integers(1, 12))):
            to = np.round(random.choice([0.0, 1.0, -2.5, random.uniform(-9, 9)], 3), 3)
            share = float(random.choice([0.25, 0.5, 0.9] if hard else [0.1, 0.4]))
            moves.append((int(random.integers(4)), *to.tolist(), share))
        inches, relative = bool(random.random() < 0.5), bool(random.random() < 0.5)
        return {"moves": moves, "inches": inches, "relative": relative, "plane": int(random.choice([17, 18, 19]))}

    def program(self, case: Case) -> str:
        return f"text = {written(case)!r}\nprogram = bik.paths.from_gcode(text, tolerance=1e-6)\nposes = program.poses"

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        ends, lengths = expected(case)
        program = left["program"]
        at = [program.poses[0, :3, 3], *(program.poses[move.last, :3, 3] for move in program.moves)]
        if len(at) != len(ends) or np.abs(np.array(at) - ends).max() > ROUNDED:
            raise BrokenError("a move ends at another point", (np.array(at).tolist(), ends.tolist()))
        steps = np.linalg.norm(np.diff(left["poses"][:, :3, 3], axis=0), axis=1)
        for move, length in zip(program.moves, lengths, strict=True):
            travelled = steps[move.first : move.last].sum()
            if abs(travelled - length) > 2e-3 * length + 1e-6:
                raise BrokenError("a move has another length", (move, travelled, length))
        return len(ends)


def walked(case: Case) -> list[tuple[int, np.ndarray, np.ndarray, float]]:
    """Kind, start, end, and for arcs the part of a circle, of each move, in units of the program."""
    axes = {17: [0, 1], 18: [2, 0], 19: [1, 2]}[case["plane"]]
    at, moves = np.zeros(3), []
    for kind, *to, share in case["moves"]:
        end = np.array(to)
        if kind > 1 and np.hypot(*(end - at)[axes]) < 0.01:
            kind = 1
        moves.append((kind, at, end, share))
        at = end
    return [move for move in moves if not np.array_equal(move[1], move[2])]


def written(case: Case) -> str:
    axes = {17: [0, 1], 18: [2, 0], 19: [1, 2]}[case["plane"]]
    lines = [
        f"G{20 if case['inches'] else 21} G{case['plane']}",
        "G0 X0 Y0 Z0",
        f"G{91 if case['relative'] else 90} F600",
    ]
    for kind, start, end, share in walked(case):
        to = end - start if case["relative"] else end
        words = [f"G{kind}", *(f"{letter}{value:.9f}" for letter, value in zip("XYZ", to, strict=True))]
        if kind > 1:
            chord = (end - start)[axes]
            radius = 0.5 * np.hypot(*chord) / math.sin(math.pi * share)
            words.append(f"R{math.copysign(radius, 0.5 - share):.12f}")
        lines.append(" ".join(words))
    return "\n".join(lines)


def expected(case: Case) -> tuple[np.ndarray, list[float]]:
    """Points (k, 3) (m) at the ends of moves, and their lengths (m)."""
    axes = {17: [0, 1], 18: [2, 0], 19: [1, 2]}[case["plane"]]
    unit = 0.0254 if case["inches"] else 1e-3
    ends, lengths = [np.zeros(3)], []
    for kind, start, end, share in walked(case):
        way = end - start
        along = float(np.linalg.norm(way))
        if kind > 1:
            chord = float(np.hypot(*way[axes]))
            arc = math.tau * share * 0.5 * chord / math.sin(math.pi * share)
            along = math.hypot(arc, math.sqrt(max(along**2 - chord**2, 0.0)))
        ends.append(end)
        lengths.append(unit * along)
    return unit * np.array(ends), lengths


ATTACKS = [SurfaceLine(), Gcode()]
