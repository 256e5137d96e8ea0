"""Torques that hold redundant arms up, with and without the goal LeastTorque.

    python benches/least_torque.py --poses 200 --out docs

Poses of random configurations of a Panda without and with 3 kg in its hand, and of random arms of seven joints whose
links have masses: `solve` from the configuration itself without a goal, with the goal, and with the goal and
`prefer="best"`. It writes `least_torque.csv`, which the site shows: medians of the largest share of a torque limit, of
the length of the vector of torques and of times. It needs no other library.
"""

import argparse
import csv
import time
from pathlib import Path

import numpy as np

import beetle_ik as bik

HEADER = ["arm", "call", "most loaded motor", "length of torques (N m)", "time (ms)"]
CALLS = {
    "without a goal": {},
    "LeastTorque": {"goals": bik.goals.LeastTorque()},
    "LeastTorque, best": {"goals": bik.goals.LeastTorque(), "prefer": "best"},
}


def main() -> None:
    """Measures all arms and writes the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--poses", type=int, default=200, help="poses of each arm (default: 200)")
    parser.add_argument("--out", type=Path, default=Path(), help="folder of the table")
    arguments = parser.parse_args()
    panda = bik.Robot.named("panda")
    rows = rows_of("Panda", [panda], arguments.poses)
    rows += rows_of("Panda, 3 kg", [panda.with_payload(3.0)], arguments.poses)
    rows += rows_of("20 random arms, 7 joints", [random_arm(seed) for seed in range(20)], -(-arguments.poses // 20))
    with (arguments.out / "least_torque.csv").open("w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([HEADER, *rows])


def rows_of(name: str, robots: list[bik.Robot], poses: int) -> list[list[str]]:
    """A row for each call."""
    rows = []
    for call, options in CALLS.items():
        found = [held(robot, q, options) for robot in robots for q in robot.random_configurations(poses, seed=1)]
        share, length, milliseconds = np.median(found, axis=0)
        rows.append([name, call, f"{100 * share:.0f} %", f"{length:.1f}", f"{milliseconds:.3f}"])
        print(*rows[-1], sep="; ")
    return rows


def held(robot: bik.Robot, q: np.ndarray, options: dict[str, object]) -> list[float]:
    """Largest share of a torque limit, length of the torques, time (ms)."""
    target = robot.fk(q)
    begun = time.perf_counter()
    solution = bik.solve(robot, target, start_q=q, **options)
    spent = 1e3 * (time.perf_counter() - begun)
    assert solution.success
    torques = robot.torques(solution.q)
    return [np.abs(torques / robot.torque_limit).max(), np.linalg.norm(torques), spent]


def random_arm(seed: int) -> bik.Robot:
    """Seven revolute joints, links of 0.1 to 0.4 m and 1 to 4 kg, motors that hold the stretched arm."""
    rng = np.random.default_rng(seed)
    lengths, masses = rng.uniform(0.1, 0.4, 7), rng.uniform(1.0, 4.0, 7)
    beyond = [9.81 * masses[j:] @ (np.cumsum(lengths[j:]) - lengths[j:] / 2) for j in range(7)]
    parts = ['<robot name="random"><link name="l0"/>']
    for j, (length, mass) in enumerate(zip(lengths, masses, strict=True), start=1):
        turn = rng.uniform(-np.pi, np.pi, 3)
        axis = rng.normal(size=3)
        place = "0 0 0" if j == 1 else f"{lengths[j - 2]} 0 0"
        inertia = mass * length**2 / 12
        parts.append(
            f'<link name="l{j}"><inertial><origin xyz="{length / 2} 0 0"/><mass value="{mass}"/>'
            f'<inertia ixx="{inertia / 20}" iyy="{inertia}" izz="{inertia}" ixy="0" ixz="0" iyz="0"/></inertial></link>'
            f'<joint name="j{j}" type="revolute">'
            f'<parent link="l{j - 1}"/><child link="l{j}"/><origin xyz="{place}" rpy="{" ".join(map(str, turn))}"/>'
            f'<axis xyz="{" ".join(map(str, axis))}"/>'
            f'<limit lower="-2.8" upper="2.8" velocity="2" effort="{1.33 * beyond[j - 1]}"/></joint>'
        )
    return bik.Robot.from_urdf("".join([*parts, "</robot>"]))


if __name__ == "__main__":
    main()
