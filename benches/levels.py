"""Two hands of which one comes first, where both cannot be met: `solve` with levels, beside weights alone.

    python benches/levels.py --pairs 100

Two arms of seven joints on a torso that lifts and turns, and a body of 26 joints with three tips, get a pose that the
first tip has, and others beyond reach. It prints the time of a solve and the error of the first tip, with levels, with
all tasks at one level, and with a weight of a thousand for the first tip. It needs no other library.
"""

import argparse
import time

import numpy as np

import beetle_ik as bik
from beetle_ik.tasks import Pose

X, Y, Z = "1 0 0", "0 1 0", "0 0 1"


def main() -> None:
    """Measures both robots and prints the rows."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", type=int, default=100, help="targets of each robot (default: 100)")
    arguments = parser.parse_args()
    for robot in (two_arms(), body()):
        random = np.random.default_rng(1)
        first, *others = robot.tips
        tasks = {
            "levels": {tip: Pose(level=level) for level, tip in enumerate(robot.tips)},
            "one level": {},
            "a weight of 1000": {first: Pose(weights=[1e3] * 6)},
        }
        times, errors = ({name: [] for name in tasks} for _ in range(2))
        for q in robot.random_configurations(arguments.pairs, seed=2):
            targets = dict(zip(robot.tips, robot.fk(q), strict=True))
            for tip in others:
                targets[tip] = targets[tip].copy()
                targets[tip][:3, 3] += 2.0 * random.normal(size=3)
            for name, task in tasks.items():
                begun = time.perf_counter()
                found = bik.solve(robot, targets, task=task)
                times[name].append(1e3 * (time.perf_counter() - begun))
                errors[name].append(found.errors[first][0])
        for name in tasks:
            low, high = np.median(times[name]), max(times[name])
            off = f"first tip off by {np.median(errors[name]):.1e} m, worst {max(errors[name]):.1e} m"
            print(f"{robot.dof} joints, {name}: {low:.1f} ms, worst {high:.1f} ms; {off}")


def limb(name: str, parent: str, tip: str, joints: list[tuple[str, str]]) -> str:
    """A chain of revolute joints, each an axis and its place after the one before."""
    parts = []
    for i, (axis, xyz) in enumerate(joints):
        link = tip if i + 1 == len(joints) else f"{name}_{i}"
        parts.append(
            f"<link name='{link}'/><joint name='{name}_{i}' type='revolute'>"
            f"<parent link='{parent}'/><child link='{link}'/>"
            f"<origin xyz='{xyz}'/><axis xyz='{axis}'/><limit lower='-2' upper='2' velocity='2'/></joint>"
        )
        parent = link
    return "".join(parts)


def arm(name: str, parent: str, place: str) -> str:
    """An arm of seven joints."""
    steps = [(Y, "0 0 0.1"), (Z, "0 0 0.2"), (Y, "0 0 0.2"), (Z, "0 0 0.2"), (Y, "0 0 0.2"), (Z, "0 0 0.1")]
    return limb(name, parent, name, [(Z, place), *steps])


def two_arms() -> bik.Robot:
    """Two arms on a torso: 16 joints."""
    torso = (
        "<link name='floor'/><link name='column'/><joint name='lift' type='prismatic'><parent link='floor'/>"
        "<child link='column'/><axis xyz='0 0 1'/><limit lower='0' upper='0.4' velocity='1'/></joint>"
    ) + limb("yaw", "column", "chest", [(Z, "0 0 0.5")])
    arms = arm("left", "chest", "0 0.3 0") + arm("right", "chest", "0 -0.3 0")
    return bik.Robot.from_urdf(f"<robot name='pair'>{torso}{arms}</robot>", tip=["left", "right"])


def body() -> bik.Robot:
    """A body that stands on one foot, with the other foot and two hands as tips: 26 joints."""
    o = "0 0 0"
    right = [(X, "0 0 0.1"), (Y, o), (Y, "0 0 0.4"), (Y, "0 0 0.4"), (X, o), (Z, "0 0 0.05")]
    left = [(Z, "0 0.2 0"), (X, "0 0 -0.05"), (Y, o), (Y, "0 0 -0.4"), (Y, "0 0 -0.4"), (X, o)]
    limbs = limb("right", "floor", "pelvis", right) + limb("other", "pelvis", "foot", left)
    arms = arm("left", "pelvis", "0 0.3 0.4") + arm("hand", "pelvis", "0 -0.1 0.4")
    urdf = f"<robot name='body'><link name='floor'/>{limbs}{arms}</robot>"
    return bik.Robot.from_urdf(urdf, tip=["foot", "left", "hand"])


if __name__ == "__main__":
    main()
