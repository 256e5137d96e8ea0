"""Obstacle avoidance by the beetle, beside null-space avoidance: after the authors' paper of 2020."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

import beetle_ik as bik

from ...report import BLACK, Check, Column, Figure, Part, Section, Table, drawing, line, number
from ..experiment import Context
from .settings import IIWA, ON_CIRCLE, Array, circle, rms

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

TITLE = "A beetle among obstacles: after Khan, Li and Luo 2020"
ARM = IIWA.with_capsules(radius=0.06)
MARGIN = 0.03  # m
_INSIDE = 0.02  # m: depth by which the arm enters an obstacle that it ignores
_POINTS = 120
_FOLLOWED = 1e-4  # m
_FACTORS = (1, 10, 100, 1000)  # evaluations of the beetle over those of null-space avoidance

_TEXT = """
Two authors of this line of work wrote of obstacles before: A. H. Khan, S. Li and X. Luo, “Obstacle Avoidance and
Tracking Control of Redundant Robotic Manipulator: An RNN-Based Metaheuristic Approach”, *IEEE Transactions on
Industrial Informatics* 16(7), 2020. Only its abstract is at hand, so **nothing is reproduced here**, and no claim of it
is judged. The abstract says that a beetle's objective receives a penalty that rewards distance between arm and
obstacle, that distances are those of the geometry itself, and that the arm is an iiwa with seven joints.

We ran what this library makes of that idea: `solve(solver=BAS(), obstacles=)` adds to the squared error the squares of
the distances that are missing to the margin, and calls no point solved that is nearer. The tool goes round the circle
of Cheng et al., point by point, each solved from the one before; a ball stands where the elbow would pass. Beside it,
null-space avoidance: the default solver, whose solutions are pushed along the self-motion until they are clear. At each
point the beetle gets as many evaluations as that took, or 10, 100 or 1000 times
as many.

The points are solved one by one: nothing bounds the joint steps between them. Where null-space avoidance meets the
margin it steps aside at once; the beetle creeps along the margin.
"""


@dataclass(frozen=True)
class Round:
    """One round of the circle (k points)."""

    error: Array
    """Distance of the tool from the circle (k,) (m)."""
    clearance: Array
    """Smallest distance of the arm from the ball and from itself (k,) (m)."""
    evaluations: Array
    """Evaluations of the forward kinematics at each point (k,)."""
    step: Array
    """Largest joint step to each point (k,) (rad)."""


def obstacle(context: Context) -> Part:
    """Runs one round by each method."""
    points = circle(1.0).position(np.linspace(0.0, 1.0, _POINTS + 1))
    ball = _ball(points)
    free = _round(points, ball, lambda point, start, _: bik.solve(ARM, point, start_q=start))
    pushed = _round(
        points, ball, lambda point, start, _: bik.solve(ARM, point, start_q=start, obstacles=[ball], margin=MARGIN)
    )
    rounds = {"no obstacle known": free, "null space": pushed}
    for factor in context.each("khan2022: beetle among obstacles", context.pick(full=_FACTORS, short=_FACTORS[:2])):
        rounds[f"beetle, evaluations × {factor}"] = _beetle(points, ball, pushed.evaluations, factor, context.seed)
    section = Section(
        TITLE,
        [
            _TEXT,
            Figure(
                name="obstacle",
                title="The tool's error and the arm's distance on the way round",
                drawing=_draw(rounds),
                caption="After Khan, Li and Luo 2020, of which only the abstract is at hand.",
            ),
            _table(rounds),
        ],
    )
    equal = rounds[f"beetle, evaluations × {_FACTORS[0]}"]
    return section, [keeps_clear(pushed.error, pushed.clearance), is_farther(equal.error, pushed.error)]


def keeps_clear(errors: Array, distances: Array) -> Check:
    """Checks tool errors and smallest distances of null-space avoidance (k,) (m)."""
    return Check(
        statement="Null-space avoidance stays on the circle and keeps the margin.",
        rule=f"At each point the error is below {number(1e3 * _FOLLOWED, 1)} mm and the distance at least the margin.",
        measured=f"{number(1e3 * errors.max())} mm, {number(1e3 * distances.min())} mm",
        holds=bool((errors < _FOLLOWED).all() and (distances >= MARGIN).all()),
        section=TITLE,
    )


def is_farther(beetle: Array, null_space: Array) -> Check:
    """Checks tool errors at equal evaluations (k,) (m)."""
    return Check(
        statement="At equal evaluations the beetle is farther from the circle than null-space avoidance.",
        rule="The rms error of the beetle is the larger one.",
        measured=f"{number(1e3 * rms(beetle**2))} mm and {number(1e3 * rms(null_space**2))} mm",
        holds=rms(beetle**2) > rms(null_space**2),
        section=TITLE,
    )


def _round(points: Array, ball: bik.obstacles.Obstacle, solve: Callable[[Array, Array, int], bik.Solution]) -> Round:
    """Solves each point from the solution of the point before."""
    q, evaluations = [np.asarray(ON_CIRCLE)], []
    for i, point in enumerate(points):
        solution = solve(point, q[-1], i)
        q.append(np.asarray(solution.q))
        evaluations.append(solution.evaluations)
    tips = ARM.fk(q[1:])[:, :3, 3]
    clearance = np.asarray(bik.obstacles.clearance(ARM, q[1:], [ball]))
    step = np.abs(np.diff(q, axis=0)).max(axis=1)
    return Round(np.linalg.norm(tips - points, axis=1), clearance, np.array(evaluations), step)


def _beetle(points: Array, ball: bik.obstacles.Obstacle, evaluations: Array, factor: int, seed: int) -> Round:
    def solve(point: Array, start: Array, i: int) -> bik.Solution:
        stop = bik.Stop(max_evaluations=max(2, factor * int(evaluations[i])))
        return bik.solve(
            ARM, point, start_q=start, obstacles=[ball], margin=MARGIN, solver=bik.papers.BAS(variant="greedy"),
            stop=stop, position_tolerance=_FOLLOWED, seed=seed + i,
        )  # fmt: skip

    return _round(points, ball, solve)


def _ball(points: Array) -> bik.obstacles.Sphere:
    """Returns a ball beside the elbow of the arm half way round the circle."""
    q = np.asarray(ON_CIRCLE)
    for point in points[: len(points) // 2]:
        q = np.asarray(bik.solve(ARM, point, start_q=q).q)
    shoulder, elbow = ARM.link_poses(q)[[2, 4], :3, 3]
    sideways = np.cross(elbow - shoulder, points[len(points) // 2] - elbow)
    radius = 0.05
    apart = 0.06 + radius - _INSIDE
    return bik.obstacles.Sphere(elbow + apart * sideways / np.linalg.norm(sideways), radius)


def _table(rounds: dict[str, Round]) -> Table:
    return Table(
        name="beside_a_ball",
        title="One round beside the ball",
        columns=[
            Column(name="method"),
            Column(name="evaluations a point (mean)", digits=3),
            Column(name="tool off (rms)", unit="mm", digits=3),
            Column(name="tool off (largest)", unit="mm", digits=3),
            Column(name="smallest distance", unit="mm", digits=3),
            Column(name="points nearer than the margin"),
            Column(name="largest joint step", unit="rad", digits=3),
        ],
        rows=[
            [
                name,
                float(found.evaluations.mean()),
                1e3 * rms(found.error**2),
                1e3 * float(found.error.max()),
                1e3 * float(found.clearance.min()),
                int((found.clearance < MARGIN).sum()),
                float(found.step.max()),
            ]
            for name, found in rounds.items()
        ],
    )


def _draw(rounds: dict[str, Round]) -> Drawing:
    with drawing(3.4) as figure:
        left, right = figure.subplots(1, 2)
        for i, (name, found) in enumerate(rounds.items()):
            share = np.arange(len(found.error)) / (len(found.error) - 1)
            left.semilogy(share, 1e3 * np.maximum(found.error, 1e-13), label=name, **line(i))
            right.plot(share, 1e3 * found.clearance, **line(i))
        right.axhline(1e3 * MARGIN, color=BLACK, linewidth=0.8, linestyle=":")
        right.annotate("margin", (0.02, 1e3 * MARGIN), xytext=(0, 2), textcoords="offset points", fontsize="small")
        left.set(xlabel="share of the round", ylabel="tool error [mm]")
        right.set(xlabel="share of the round", ylabel="smallest distance [mm]")
        figure.legend(loc="outside lower center", ncols=3, fontsize="small")
    return figure
