"""Plans of two arms among obstacles: a Baxter (14 joints) and two Pandas on a torso (16), on problems drawn by seed.

    python benches/two_arm_plans.py --problems 60

Both hands begin and end in the openings of a shelf, or behind the bars of a grid. The robots come from the package
`example-robot-data` (`make zoo` installs it). It prints, for each robot, how many problems were solved, and the times
of the processor: median, 95 % and worst. A problem without a way counts as not solved: ends are drawn, not planned to.
"""

# ruff: noqa: E402

import os

# Environment variables that numerical libraries read when they are loaded, so set before the first import.
for variable in ("OMP", "OPENBLAS", "MKL", "NUMEXPR", "RAYON"):
    os.environ[f"{variable}_NUM_THREADS"] = "1"

import argparse
import time
from pathlib import Path

import numpy as np
from peers.two_hands import two_arms_on_a_torso

import beetle_ik as bik

LIMITS = bik.Limits(velocity=2.0, acceleration=5.0)
MARGIN = 1e-3  # m
# Of each robot: where the scene begins in front of it, and the height of its middle (m).
PLACES = {"Baxter": (0.7, 0.15), "two Pandas on a torso": (0.5, 0.85)}


def main() -> None:
    """Measures both robots."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--problems", type=int, default=60, help="problems of each robot (default: 60)")
    parser.add_argument("--robots", type=Path, help="folder of example-robot-data (default: where it is installed)")
    arguments = parser.parse_args()
    for name, robot in robots(arguments.robots or installed()).items():
        times, solved = [], 0
        for seed in range(arguments.problems):
            scene, start, end = problem(robot, PLACES[name], seed)
            began = time.process_time()
            plan = bik.plan_point_to_point(
                robot, start_q=start, end_q=end, obstacles=scene, margin=MARGIN, limits=LIMITS
            )
            times.append(1e3 * (time.process_time() - began))
            solved += plan.success
        median, most = np.percentile(times, (50, 95))
        print(f"{name}: {solved} of {len(times)}, {median:.1f} ms, 95 % {most:.0f} ms, worst {max(times):.0f} ms")


def installed() -> Path:
    """Folder of the robots of example-robot-data."""
    import example_robot_data

    return Path(example_robot_data.getModelPath("panda_description/urdf/panda.urdf")) / "example-robot-data" / "robots"


def robots(folder: Path) -> dict[str, bik.Robot]:
    """Robots with two tips each, covered by capsules."""
    baxter, packages = folder / "baxter_description", str(folder.parent)
    return {
        "Baxter": bik.Robot.from_urdf(
            baxter / "urdf/baxter.urdf",
            tip=["left_gripper", "right_gripper"],
            srdf=baxter / "srdf/baxter_manipulation.srdf",
            collision="fit",
            package_dirs=packages,
        ),
        "two Pandas on a torso": bik.Robot.from_urdf(
            two_arms_on_a_torso(folder / "panda_description/urdf/panda.urdf"),
            tip=["left_panda_hand", "right_panda_hand"],
            collision="fit",
            package_dirs=packages,
        ),
    }


def problem(robot: bik.Robot, place: tuple[float, float], seed: int) -> tuple[bik.Scene, np.ndarray, np.ndarray]:
    """A scene and two clear configurations with both hands in it."""
    random = np.random.default_rng(seed)
    while True:
        x, z = np.array(place) + random.uniform(-0.05, 0.1, 2)
        scene = shelf(random, x, z) if seed % 2 else grid(random, x, z)
        start, end = (hands_within(robot, scene, (x, z), random) for _ in range(2))
        if start is not None and end is not None:
            return scene, start, end


def shelf(random: np.random.Generator, x: float, z: float) -> bik.Scene:
    """Boards and walls, three openings high and two wide."""
    depth, height = random.uniform(0.28, 0.4), random.uniform(0.28, 0.4)
    levels, walls = z + height * (np.arange(4) - 1.5), (-0.55, 0.0, 0.55)
    boards = [bik.obstacles.Box((x + depth / 2, 0, level), (depth, 1.1, 0.02)) for level in levels]
    boards += [bik.obstacles.Box((x + depth / 2, y, z), (depth, 0.02, 3 * height)) for y in walls]
    return bik.Scene([*boards, bik.obstacles.Box((x + depth, 0, z), (0.02, 1.1, 3 * height))])


def grid(random: np.random.Generator, x: float, z: float) -> bik.Scene:
    """Bars in front of the arms."""
    gap = random.uniform(0.3, 0.4)
    bars = [bik.obstacles.Box((x, y, z), (0.03, 0.03, 2.0)) for y in gap * np.arange(-3, 4)]
    return bik.Scene(bars + [bik.obstacles.Box((x, 0, z + gap * k), (0.03, 2.4, 0.03)) for k in (-2, -1, 0, 1, 2)])


def hands_within(
    robot: bik.Robot, scene: bik.Scene, place: tuple[float, float], random: np.random.Generator
) -> np.ndarray | None:
    """A clear configuration with both hands in openings of the scene."""
    x, z = place
    for _ in range(60):
        targets = {
            tip: np.array([x, 0.0, z]) + random.uniform((0.03, 0.1, -0.4), (0.2, 0.5, 0.4)) * (1.0, side, 1.0)
            for tip, side in zip(robot.tips, (1.0, -1.0), strict=True)
        }
        start = robot.random_configurations(1, seed=int(random.integers(2**31)))[0]
        stop = bik.Stop(max_evaluations=4000)
        solution = bik.solve(robot, targets, start_q=start, obstacles=scene, margin=4 * MARGIN, stop=stop)
        if solution.success:
            return solution.q
    return None


if __name__ == "__main__":
    main()
