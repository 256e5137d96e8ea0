"""Programs of moves: 200 random programs of ten moves on four arms, judged at 10,000 samples each.

    python benches/moves.py [programs per arm]

Prints for each arm how many programs were planned without a fault, how many were refused and why, and the time of a
program. The judge is that of the tests, by numpy and scipy.
"""

import sys
import time
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "python"))

from move_programs import draw, faults, moves_of

import beetle_ik as bik

ARMS = {
    "ur5e": [0.0, -1.5, 1.8, -1.9, -1.57, 0.3],
    "panda": [0.0, -0.6, 0.0, -2.2, 0.0, 1.8, 0.7],
    "iiwa14": [0.0, 0.6, 0.0, -1.5, 0.0, 0.9, 0.0],
    "kr210": [0.0, -0.6, 0.9, 0.0, 1.0, 0.0],
}
MOVES = 10
ACCELERATION = 5.0


def run(name: str, count: int) -> None:
    """Plans `count` programs of one arm, and prints how they came out."""
    robot = bik.Robot.named(name)
    limits = {"velocity": robot.velocity_limit, "acceleration": np.full(robot.dof, ACCELERATION)}
    outcomes: Counter[str] = Counter()
    times, wrong = [], []
    for seed in range(count):
        random = np.random.default_rng(seed)
        start = np.array(ARMS[name]) + random.uniform(-0.2, 0.2, robot.dof)
        program = draw(robot, start, MOVES, random)
        moves = moves_of(program)
        begin = time.perf_counter()
        try:
            plan = bik.plan_moves(robot, moves, start_q=start, limits=bik.Limits(acceleration=ACCELERATION))
        except bik.InvalidInputError as error:
            outcomes["refused: " + str(error).split(":")[1][:40]] += 1
            continue
        times.append(time.perf_counter() - begin)
        found = faults(robot, robot.fk, program, plan, limits)
        outcomes["faulty" if found or not plan.success else "planned"] += 1
        wrong += [f"  {seed}: {fault}" for fault in found[:2]]
    median, longest = 1e3 * np.median(times), 1e3 * max(times)
    print(f"{name}: {dict(outcomes)}; median {median:.1f} ms, at most {longest:.1f} ms")
    print("\n".join(wrong))


if __name__ == "__main__":
    programs = int(sys.argv[1]) if len(sys.argv) > 1 else 50
    for arm in ARMS:
        run(arm, programs)
