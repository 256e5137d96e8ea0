"""Time of poses that an arm cannot reach, beside those that it can: `solve_batch` in one thread, processor time.

Targets without a solution are configurations' positions with random orientations, as far as a long search finds none.
"""

import argparse
import time

import numpy as np

import beetle_ik as bik


def main() -> None:
    """Prints a row for each robot."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("robots", nargs="*", default=["ur5e", "kr210", "panda", "iiwa14"])
    parser.add_argument("--targets", type=int, default=2000)
    given = parser.parse_args()
    for name in given.robots:
        robot = bik.Robot.named(name)
        within = robot.fk(robot.random_configurations(given.targets))
        turned = within.copy()
        turned[:, :3, :3] = robot.fk(robot.random_configurations(given.targets, seed=1))[:, :3, :3]
        beyond = turned[~bik.solve_batch(robot, turned).success]
        reached, missed = microseconds(robot, within), microseconds(robot, beyond)
        status = bik.solve_batch(robot, beyond).status
        proven = (status == bik.Status.OUT_OF_REACH).mean()
        print(
            f"{name}: {reached:.2f} us a pose that is reached, {missed:.1f} us one that is not, {100 * proven:.0f} % "
            f"of them proven; half of each: {2 * reached / (reached + missed):.2f} of the rate",
            flush=True,
        )


def microseconds(robot: bik.Robot, targets: np.ndarray) -> float:
    """Returns the processor time of a target, the best of five runs."""
    best = np.inf
    for _ in range(5):
        began = time.process_time()
        bik.solve_batch(robot, targets, threads=1)
        best = min(best, time.process_time() - began)
    return 1e6 * best / len(targets)


if __name__ == "__main__":
    main()
