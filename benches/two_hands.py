"""Both hands at once: `solve` with a target for each tip, beside mink, pink and placo.

    python benches/two_hands.py --pairs 1000 --slow 200 --out DIR

Baxter, Tiago and two Pandas on a torso get pairs of poses, both from one random configuration. Pinocchio judges the
answers: both poses within 1e-6 (m, rad), inside the limits. All libraries start in the middle of the joint ranges. The
robots come from the package `example-robot-data` (`make zoo` installs it). It writes `two_hands.csv`, which the site
shows.
"""

# ruff: noqa: E402

import os

# Environment variables that numerical libraries read when they are loaded, so set before the first import.
for variable in ("OMP", "OPENBLAS", "MKL", "NUMEXPR", "RAYON"):
    os.environ[f"{variable}_NUM_THREADS"] = "1"

import argparse
import csv
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from peers.two_hands import (
    BeetleIk,
    FromStart,
    Library,
    Mink,
    OneAfterTheOther,
    Pink,
    Placo,
    TwoHands,
    reduced,
    two_arms_on_a_torso,
)

LIBRARIES = [BeetleIk, OneAfterTheOther, FromStart, Mink, Pink, Placo]
FAST = (BeetleIk, OneAfterTheOther, FromStart)  # get every pair


@dataclass
class Measured:
    """Times of calls (ms), and the number of calls that met both poses."""

    times: list[float] = field(default_factory=list)
    met: int = 0


def main() -> None:
    """Measures all robots and writes the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", type=int, default=1000, help="pairs of poses for each robot (default: 1000)")
    parser.add_argument("--slow", type=int, default=200, help="of these for the other libraries (default: 200)")
    parser.add_argument("--robots", type=Path, help="folder of example-robot-data (default: where it is installed)")
    parser.add_argument("--out", type=Path, default=Path())
    arguments = parser.parse_args()
    lines = [["robot", "library", "both poses met", "median [ms]", "95 % [ms]"]]
    for rig in rigs(arguments.robots or installed()):
        for library, measured in measure(rig, arguments.pairs, arguments.slow).items():
            met = "" if library is OneAfterTheOther else f"{measured.met} / {len(measured.times)}"
            times = [f"{np.percentile(measured.times, share):.3g}" for share in (50, 95)]
            lines.append([rig.name, library.name, met, *times])
            print(*lines[-1], sep=", ", flush=True)
    arguments.out.mkdir(parents=True, exist_ok=True)
    with (arguments.out / "two_hands.csv").open("w", newline="") as file:
        csv.writer(file).writerows(lines)
    print(*(f"{library.name}: {library.settings}" for library in LIBRARIES), sep="\n")


def installed() -> Path:
    """Folder of the robots of example-robot-data."""
    import example_robot_data

    return Path(example_robot_data.getModelPath("panda_description/urdf/panda.urdf")) / "example-robot-data" / "robots"


def rigs(robots: Path) -> list[TwoHands]:
    """Robots of the benchmark."""
    pandas = two_arms_on_a_torso(robots / "panda_description/urdf/panda.urdf")
    return [
        reduced("Baxter", robots / "baxter_description/urdf/baxter.urdf", ("left_gripper", "right_gripper")),
        reduced(
            "Tiago, two arms",
            robots / "tiago_description/robots/tiago_dual.urdf",
            ("arm_left_tool_link", "arm_right_tool_link"),
        ),
        reduced("two Pandas on a torso", pandas, ("left_panda_hand", "right_panda_hand")),
    ]


def measure(rig: TwoHands, pairs: int, slow: int) -> dict[type[Library], Measured]:
    """Measures all libraries, alternating after every pair of poses."""
    lower, upper = rig.model.lowerPositionLimit, rig.model.upperPositionLimit
    libraries = {library: library(rig, 0.5 * (lower + upper)) for library in LIBRARIES}
    outcome = {library: Measured() for library in LIBRARIES}
    rng = np.random.default_rng(0)
    for number in range(pairs):
        wanted = rig.poses(rng.uniform(lower, upper))
        for kind, library in libraries.items():
            if number < slow or kind in FAST:
                begin = time.perf_counter()
                found = library.solve(wanted)
                outcome[kind].times.append(1e3 * (time.perf_counter() - begin))
                outcome[kind].met += found is not None and rig.is_met(found, wanted)
    return outcome


if __name__ == "__main__":
    main()
