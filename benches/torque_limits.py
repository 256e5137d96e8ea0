"""Motions of a Panda within its torques: timing beside toppra, and planning with a payload, judged by Pinocchio.

    python benches/torque_limits.py --paths 40
    python benches/torque_limits.py --data DIR --payloads 0 3 5

Splines of 151 points, within random fractions of the torque limits, are timed by both; Pinocchio says what torques the
motions take at 10,000 instants. With `--data` (the folder of MotionBenchmaker's `panda.json` and `robots/`) plans from
start to goal follow, with velocities and torques of the data sheet. Where one is refused, Pinocchio says what it takes
to hold the arm at its ends.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio
from dynamics import PANDA, ROBOTS
from peers.clear import MotionBenchArm

import beetle_ik as bik

ACCELERATION = np.array([15, 7.5, 10, 12.5, 15, 20, 20])
TORQUE = np.array([87.0, 87, 87, 87, 12, 12, 12])
POINTS = 151


class Judge:
    """Torques of a robot by Pinocchio."""

    def __init__(self, urdf: Path, robot: bik.Robot, payload: float) -> None:
        """Reads the robot again, and hangs a point mass on its last link."""
        whole = pinocchio.buildModelFromUrdf(str(urdf))
        beside = [whole.getJointId(name) for name in whole.names[1:] if name not in robot.joint_names]
        self.model = pinocchio.buildReducedModel(whole, beside, pinocchio.neutral(whole))
        at = self.model.frames[self.model.getFrameId(robot.link_names[-1])]
        carried = pinocchio.Inertia(payload, np.zeros(3), np.zeros((3, 3)))
        self.model.appendBodyToJoint(at.parentJoint, carried, at.placement)
        self.data = self.model.createData()

    def torques(self, *state: np.ndarray) -> np.ndarray:
        """Torques (n,) at position, velocity and acceleration."""
        still = np.zeros(self.model.nv)
        return pinocchio.rnea(self.model, self.data, *state, *[still] * (3 - len(state))).copy()

    def largest_share(self, motion: bik.Trajectory, limit: np.ndarray, instants: int = 10_000) -> float:
        """Largest part of a limit at many instants."""
        states = zip(*motion.at(np.linspace(0, motion.duration, instants)), strict=True)
        return max(float(np.max(np.abs(self.torques(*state)) / limit)) for state in states)


def cpu(call: Any) -> tuple[Any, float]:
    """Result and processor time (ms) of a call."""
    start = time.process_time()
    result = call()
    return result, 1e3 * (time.process_time() - start)


def toppra_motion(fine: np.ndarray, velocity: np.ndarray, torque: np.ndarray, robot: bik.Robot) -> Any:
    """The motion of toppra through these points, with as many grid points."""
    import toppra
    from toppra import algorithm, constraint

    toppra.setup_logging("ERROR")
    at = np.linspace(0, 1, len(fine))
    limits = [
        constraint.JointVelocityConstraint(np.stack([-velocity, velocity], 1)),
        constraint.JointAccelerationConstraint(np.stack([-ACCELERATION, ACCELERATION], 1)),
        constraint.JointTorqueConstraint(robot.torques, np.stack([-torque, torque], 1), np.zeros(robot.dof)),
    ]
    path = toppra.SplineInterpolator(at, fine)
    return algorithm.TOPPRA(limits, path, gridpoints=at, parametrizer="ParametrizeConstAccel").compute_trajectory()


def time_paths(count: int) -> None:
    """Prints durations relative to toppra's, largest parts of torque limits, and times."""
    urdf = ROBOTS / PANDA
    robot = bik.Robot.from_urdf(urdf, tip="panda_link8").with_payload(2.0)
    judge = Judge(urdf, robot, 2.0)
    rng = np.random.default_rng(0)
    from toppra import SplineInterpolator

    rows, refused = [], 0
    while len(rows) + refused < count:
        corners = rng.uniform(0.6 * robot.lower, 0.6 * robot.upper, size=(5, robot.dof))
        fine = SplineInterpolator(np.linspace(0, 1, 5), corners)(np.linspace(0, 1, POINTS))
        torque = robot.torque_limit * rng.choice([1.0, 0.8, 0.6])
        if np.any(fine < robot.lower) or np.any(fine > robot.upper):
            continue
        limits = bik.Limits(velocity=robot.velocity_limit, acceleration=ACCELERATION, torque=torque)
        try:
            ours, spent = cpu(lambda fine=fine, limits=limits: bik.time_optimal(fine, limits, robot=robot))
        except bik.InfeasibleError:
            refused += 1
            continue
        free = bik.Limits(velocity=robot.velocity_limit, acceleration=ACCELERATION)
        _, without = cpu(lambda fine=fine, free=free: bik.time_optimal(fine, free, robot=robot))
        call = lambda fine=fine, torque=torque: toppra_motion(fine, robot.velocity_limit, torque, robot)  # noqa: E731
        theirs, others = cpu(call)
        instants = np.linspace(0, theirs.duration, 10_000)
        shares = [np.max(np.abs(judge.torques(theirs(t), theirs(t, 1), theirs(t, 2))) / torque) for t in instants]
        rows.append(
            [ours.duration / theirs.duration, judge.largest_share(ours, torque), max(shares), spent, without, others]
        )
    table = np.array(rows)
    print(f"{len(rows)} paths, {refused} refused because a joint cannot hold the arm on them")
    print(f"duration over toppra's: median {np.median(table[:, 0]):.4f}, largest {table[:, 0].max():.4f}")
    print(f"largest part of a torque limit: {table[:, 1].max():.9f}, toppra's {table[:, 2].max():.4f}")
    spent, without, others = np.median(table[:, 3:], axis=0)
    print(f"median: {spent:.2f} ms, without torque limits {without:.2f}, toppra {others:.2f}")


def plan(folder: Path, payload: float, every: int) -> None:
    """Prints how many problems are planned with a payload, what the judge says, and the times."""
    arm = MotionBenchArm(folder, "panda")
    robot = arm.robot.with_payload(payload)
    judge = Judge(arm.urdf, robot, payload)
    limits = bik.Limits(acceleration=ACCELERATION, torque=TORQUE)
    free = bik.Limits(acceleration=ACCELERATION)
    times, without, largest, refused = [], [], 0.0, []
    problems = arm.problems()[::every]
    for problem in problems:
        ends = {"start_q": problem["start"], "end_q": problem["goal"], "obstacles": arm.scene(problem), "margin": 0.0}
        _, spent = cpu(lambda ends=ends: bik.plan_point_to_point(robot, limits=free, **ends))
        without.append(spent)
        try:
            found, spent = cpu(lambda ends=ends: bik.plan_point_to_point(robot, limits=limits, **ends))
        except bik.BeetleIkError as error:
            found, reason = None, str(error)
        else:
            reason = found.message
        if found is not None and found.success:
            times.append(spent)
            largest = max(largest, judge.largest_share(found.trajectory, TORQUE, 5000))
            continue
        held = max(
            np.max(np.abs(judge.torques(np.asarray(end))) / TORQUE) for end in (problem["start"], problem["goal"])
        )
        refused.append((held, f"    holding an end takes {held:.4f} of a limit: {reason}"))
    print(f"\n{payload:g} kg: {len(times)} of {len(problems)} planned, largest part of a limit {largest:.9f}")
    print(f"  median {np.median(times):.2f} ms, 99th percentile {np.percentile(times, 99):.2f}, ", end="")
    print(f"worst {max(times):.1f}; without torque limits median {np.median(without):.2f} ms")
    confirmed = sum(held > 1 for held, _ in refused)
    print(f"  {len(refused)} refused, {confirmed} of them at an end that the judge cannot hold either")
    print(*[text for held, text in refused if held <= 1], sep="\n")


def main() -> None:
    """Times paths, or plans with payloads."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--paths", type=int, default=0, help="number of random splines")
    options.add_argument("--data", type=Path, help="folder of MotionBenchMaker's problems")
    options.add_argument("--payloads", type=float, nargs="+", default=[3.0, 5.0], help="masses in the hand (kg)")
    options.add_argument("--every", type=int, default=1, help="take one of so many problems")
    given = options.parse_args()
    if given.paths:
        time_paths(given.paths)
    for payload in given.payloads if given.data else []:
        plan(given.data, payload, given.every)


if __name__ == "__main__":
    main()
