"""Inverse and forward dynamics, mass matrix and gravity of a Panda from Python, beside Pinocchio: microseconds a call.

Both are called in turn, a thousand calls each, so that a busy machine disturbs both; the least of many turns counts.
"""

import argparse
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pinocchio

import beetle_ik as bik

ROBOTS = Path(sys.prefix, "lib", f"python{sys.version_info.major}.{sys.version_info.minor}", "site-packages")
PANDA = "cmeel.prefix/share/example-robot-data/robots/panda_description/urdf/panda.urdf"


def turn(call: Callable[[], object], calls: int) -> float:
    """Seconds a call."""
    start = time.perf_counter()
    for _ in range(calls):
        call()
    return (time.perf_counter() - start) / calls


def main() -> None:
    """Prints the table."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--urdf", type=Path, default=ROBOTS / PANDA)
    options.add_argument("--tip", default="panda_link8")
    options.add_argument("--turns", type=int, default=50)
    given = options.parse_args()
    robot = bik.Robot.from_urdf(given.urdf, tip=given.tip)
    whole = pinocchio.buildModelFromUrdf(str(given.urdf))
    beside = [whole.getJointId(name) for name in whole.names[1:] if name not in robot.joint_names]
    model = pinocchio.buildReducedModel(whole, beside, pinocchio.neutral(whole))
    data = model.createData()
    rng = np.random.default_rng(0)
    q = robot.random_configurations(1)[0]
    qd, qdd = rng.normal(size=robot.dof), rng.normal(size=robot.dof)
    torques = robot.torques(q, qd, qdd)
    rows = {
        "inverse dynamics": (lambda: robot.torques(q, qd, qdd), lambda: pinocchio.rnea(model, data, q, qd, qdd)),
        "gravity": (lambda: robot.torques(q), lambda: pinocchio.computeGeneralizedGravity(model, data, q)),
        "mass matrix": (lambda: robot.mass_matrix(q), lambda: pinocchio.crba(model, data, q)),
        "forward dynamics": (
            lambda: robot.accelerations(q, qd, torques),
            lambda: pinocchio.aba(model, data, q, qd, torques),
        ),
    }
    print("| | beetle-ik [us] | Pinocchio [us] | ratio |\n|---|---:|---:|---:|")
    for name, (ours, theirs) in rows.items():
        times = np.array([[turn(call, 1000) for call in (ours, theirs)] for _ in range(given.turns)])
        one, other = 1e6 * times.min(axis=0)
        print(f"| {name} | {one:.2f} | {other:.2f} | {one / other:.2f} |")
    many = robot.random_configurations(100_000)
    least = min(turn(lambda: robot.torques(many, many, many), 1) for _ in range(5))
    print(f"\nInverse dynamics of 100,000 configurations at once: {1e6 * least / len(many):.3f} us each")


if __name__ == "__main__":
    main()
