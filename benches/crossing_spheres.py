"""Rate at which a crossing sphere hits an arm that follows its target with `Tracker`.

    python benches/crossing_spheres.py --first 10000 --scenes 334 --out DIR

The scenes are those of `track_among_obstacles.py` in which a sphere crosses. An arm that is cornered or too slow is
hit: that is no broken promise, and this says how often. The distance of a capsule from a sphere has a formula, so that
thousands of scenes take minutes.
"""

# ruff: noqa: E402

import os

# Environment variables that numerical libraries read when they are loaded, so set before the first import.
for variable in ("OMP", "OPENBLAS", "MKL", "NUMEXPR", "RAYON"):
    os.environ[f"{variable}_NUM_THREADS"] = "1"

import argparse
import tempfile
from pathlib import Path

import numpy as np
from peers import clear_streams
from peers.clear_movers import Ours, OursSmooth, OursSmoother
from peers.clear_streams import DT, MARGIN, Scene
from peers.report import plain_section, write_table

import beetle_ik as bik

# Radii of the capsules along the links (m). With those of other arms the wrist of a UR10 would never be as clear of
# itself as a start must be.
RADII = {"ur10": 0.03}
COLUMNS = [
    "arm",
    "limits",
    "scenes",
    "scenes hit",
    "scenes below the margin",
    "deepest_mm",
    "ticks hit",
    "ticks",
    "numbers of these scenes",
]


def main() -> None:
    """Measures each arm and writes the table, again after each arm."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--first", type=int, default=10_000, help="number of the first scene (default: 10000)")
    parser.add_argument("--scenes", type=int, default=334, help="scenes of each arm (default: 334)")
    parser.add_argument("--arms", nargs="*", default=["ur10", "panda", "iiwa14"], help="names of the arms")
    parser.add_argument("--out", type=Path, default=Path("crossing_spheres"), help="where the results go")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    numbers = [n for n in range(arguments.first, arguments.first + 2 * arguments.scenes) if n // 2 % 2 == 1]
    lines = []
    with tempfile.TemporaryDirectory() as scratch:
        for arm in arguments.arms:
            robot = bik.Robot.named(arm).with_capsules(radius=RADII.get(arm, clear_streams.RADIUS))
            nearest: dict[str, list[np.ndarray]] = {}
            for number in numbers:
                scene = clear_streams.scene(robot, number)
                for mover in (Ours, OursSmooth, OursSmoother):
                    moved = mover(scene, Path(scratch), among=True)
                    targets = enumerate(scene.targets)
                    q = np.array([scene.start, *(moved.step(target, DT * tick) for tick, target in targets)])
                    nearest.setdefault(mover.name, []).append(from_sphere(scene, q, smooth=len(mover.limits) > 1))
            lines += [line(arm, limits, np.array(found), numbers) for limits, found in nearest.items()]
            print(*lines[-3:], sep="\n", flush=True)
            write_table(arguments.out / "crossing_spheres.csv", COLUMNS, lines)
    print(plain_section("Spheres that cross", COLUMNS, lines))


def from_sphere(scene: Scene, q: np.ndarray, *, smooth: bool) -> np.ndarray:
    """Smallest distance (m) of the moving sphere from the arm in each tick of `q` (k + 1, n)."""
    robot = scene.robot
    sphere = next(thing for thing in scene.things if thing.moves)
    instants = [(tick + s, at) for tick in range(len(q) - 1) for s, at in clear_streams.between(q, tick, smooth=smooth)]
    times, configurations = zip(*instants, strict=True)
    poses = dict(
        zip(robot.all_link_names, np.stack([robot.all_link_poses(q) for q in configurations], axis=1), strict=True)
    )
    center = np.array([sphere.center(DT * time) for time in times])
    least = np.full(len(times), np.inf)
    for link, a, b, radius in robot.capsules:
        first, last = (poses[link][:, :3, :3] @ end + poses[link][:, :3, 3] for end in (a, b))
        along = last - first
        share = np.einsum("ij,ij->i", center - first, along) / np.maximum(np.einsum("ij,ij->i", along, along), 1e-300)
        apart = np.linalg.norm(first + np.clip(share, 0.0, 1.0)[:, None] * along - center, axis=1)
        least = np.minimum(least, apart - radius - sphere.shape.radius)
    return least.reshape(len(q) - 1, -1).min(axis=1)


def line(arm: str, limits: str, nearest: np.ndarray, numbers: list[int]) -> list[str]:
    """Figures of one arm under some limits; `nearest` (scenes, ticks) in m."""
    least = nearest.min(axis=1)
    hit = np.flatnonzero(least < 0.0)
    return [
        *(arm, limits.removeprefix("beetle-ik, "), str(len(nearest)), str(len(hit))),
        *(str((least < MARGIN - 1e-6).sum()), f"{max(0.0, -1e3 * least.min()):.3g}"),
        *(str((nearest < 0.0).sum()), str(nearest.size), " ".join(str(numbers[i]) for i in hit)),
    ]


if __name__ == "__main__":
    main()
