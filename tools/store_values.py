"""Pickles one value of each kind, with its attributes beside it, to tests/python/stored/VERSION/.

Run this once for each minor version, when it is released: tests then hold later versions to reading its files, or to
refusing them by name.
"""

import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np

import beetle_ik as bik

FOLDER = Path(__file__).parents[1] / "tests" / "python" / "stored"


def values() -> dict[str, object]:
    """Returns values by name, small and quick to compute."""
    robot = bik.Robot.named("panda").with_capsules(radius=0.05)
    start = np.array([0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8])
    target = robot.fk(start + 0.1)
    sphere = bik.obstacles.Sphere([0.3, 0.6, 0.5], 0.1)
    limits = bik.Limits(velocity=1.0, acceleration=5.0)
    circle = bik.paths.circle(robot.fk(start)[:3, 3] - [0.05, 0.0, 0.0], diameter=0.1, duration=1.0)
    planar = bik.Robot.planar([1.0, 1.0, 1.0])
    plant = bik.KinematicPlant(robot)
    waypoints = np.array([start, start + 0.2, start - 0.1])
    return {
        "robot": robot.with_tool(bik.pose([0.0, 0.0, 0.1])),
        "planar_robot": planar,
        "limits": limits,
        "falling_limits": bik.Limits(velocity=bik.Sinusoid(mean=2.0, amplitude=0.1, angular_frequency=1.0)),
        "stop": bik.Stop(max_evaluations=100, max_time=0.5),
        "solver": bik.MultiStart(bik.papers.PSO(population=20)),
        "sphere": sphere,
        "box": bik.obstacles.Box([0.1, 0.2, 0.3], [1.0, 2.0, 3.0]),
        "task": bik.tasks.Position(tolerance=[1e-4, 1e-4, 1e-3]),
        "solution": bik.solve(robot, target, start_q=start, solver=bik.LevenbergMarquardt()),
        "solutions": bik.solve_all(
            bik.Robot.named("ur5e"), bik.Robot.named("ur5e").fk([0.1, -1.0, 1.2, 0.3, 0.5, 0.7])
        ),
        "batch": bik.solve_batch(robot, np.array([target, target])),
        "path": circle,
        "polyline": bik.paths.polyline([[0.0, 0.0, 1.0], [0.1, 0.0, 1.0], [0.1, 0.2, 1.0]], duration=2.0),
        "track": bik.track(robot, circle, start, dt=0.05),
        "model_free": bik.track_model_free(plant, circle, start, dt=0.05),
        "plan": bik.plan_point_to_point(robot, start_q=start, end_q=start + 0.3, limits=limits, obstacles=[sphere]),
        "trajectory": bik.time_optimal(
            waypoints, bik.Limits(velocity=np.ones(7), acceleration=np.full(7, 5.0)), gridpoints=30
        ),
        "minimum": bik.minimize(lambda x: float(x @ x), [-1.0, -1.0], [1.0, 1.0], solver=bik.papers.PSO(), seed=1),
        "posture": bik.papers.planar_posture(bik.Robot.planar([1.0] * 5), [1.0, 1.0, 0.0]),
        "status": bik.Status.SOLVED,
    }


def attributes(value: object) -> dict[str, Any]:
    """Returns the public attributes that JSON can hold."""
    held = {}
    for name in dir(value):
        if name.startswith("_") or name == "elapsed":
            continue
        plain = as_plain(getattr(value, name))
        if plain is not None:
            held[name] = plain
    return held


def as_plain(value: object) -> Any:
    """Returns the value for JSON; None for other values and long arrays."""
    if isinstance(value, np.ndarray) and value.size <= 100:
        return [[str(number) for number in value.ravel()], list(value.shape)]
    return value if isinstance(value, (bool, float, int, str)) and value == value else None


def main() -> None:
    """Writes the files of this version."""
    folder = FOLDER / bik.__version__
    folder.mkdir(parents=True, exist_ok=True)
    kept = {}
    for name, value in values().items():
        (folder / f"{name}.pickle").write_bytes(pickle.dumps(value))
        kept[name] = attributes(value)
    (folder / "attributes.json").write_text(json.dumps(kept, indent=0, sort_keys=True) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
