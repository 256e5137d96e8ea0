"""Motions within torques, judged by Pinocchio: timing of four arms beside toppra, and plans of a Panda with a payload.

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
# So many keep torques to some 0.5 %.
FINE = 9601
# The largest part of a torque limit in a motion that counts as within it.
KEPT = 1.005

# URDF, tip, payload (kg) and acceleration limits; none of them has friction that toppra would have to know of.
FOLDER = PANDA.partition("panda_description")[0]
ARMS = {
    "Panda": (PANDA, "panda_link8", 2.0, ACCELERATION),
    "UR5": (f"{FOLDER}ur_description/urdf/ur5_joint_limited_robot.urdf", "tool0", 5.0, 10.0),
    "UR10": (f"{FOLDER}ur_description/urdf/ur10_joint_limited_robot.urdf", "tool0", 10.0, 8.0),
    "UR3": (f"{FOLDER}ur_description/urdf/ur3_joint_limited_robot.urdf", "tool0", 3.0, 12.0),
}


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


def toppra_motion(fine: np.ndarray, limits: bik.Limits, robot: bik.Robot, gridpoints: int = POINTS) -> Any:
    """The motion of toppra through these points."""
    import toppra
    from toppra import algorithm, constraint

    toppra.setup_logging("ERROR")
    at = np.linspace(0, 1, len(fine))
    velocity, acceleration, torque = (
        np.stack([-each, each], 1) for each in (limits.velocity, limits.acceleration, limits.torque)
    )
    kept = [
        constraint.JointVelocityConstraint(velocity),
        constraint.JointAccelerationConstraint(acceleration),
        constraint.JointTorqueConstraint(robot.torques, torque, np.zeros(robot.dof)),
    ]
    path, grid = toppra.SplineInterpolator(at, fine), np.linspace(0, 1, gridpoints)
    return algorithm.TOPPRA(kept, path, gridpoints=grid, parametrizer="ParametrizeConstAccel").compute_trajectory()


def time_paths(name: str, count: int) -> None:
    """Prints durations of an arm relative to toppra's, largest parts of torque limits, and times."""
    from toppra import SplineInterpolator

    file, tip, payload, acceleration = ARMS[name]
    robot = bik.Robot.from_urdf(ROBOTS / file, tip=tip).with_payload(payload)
    judge = Judge(ROBOTS / file, robot, payload)
    lower, upper = robot.lower, robot.upper
    free = bik.Limits(velocity=robot.velocity_limit, acceleration=np.full(robot.dof, acceleration))
    rng = np.random.default_rng(0)
    rows, refused, unsolved = [], 0, 0
    while len(rows) + refused + unsolved < count:
        corners = rng.uniform(0.6 * lower, 0.6 * upper, size=(5, robot.dof))
        fine = SplineInterpolator(np.linspace(0, 1, 5), corners)(np.linspace(0, 1, POINTS))
        torque = robot.torque_limit * rng.choice([1.0, 0.8, 0.6])
        if np.any(fine < lower) or np.any(fine > upper):
            continue
        limits = bik.Limits(velocity=free.velocity, acceleration=free.acceleration, torque=torque)
        try:
            ours, spent = cpu(lambda fine=fine, limits=limits: bik.time_optimal(fine, limits, robot=robot))
        except bik.InfeasibleError:
            refused += 1
            continue
        _, without = cpu(lambda fine=fine: bik.time_optimal(fine, free, robot=robot))
        theirs, others = cpu(lambda fine=fine, limits=limits: toppra_motion(fine, limits, robot))
        if theirs is None:
            unsolved += 1
            continue
        instants = np.linspace(0, theirs.duration, 1000)
        shares = [np.max(np.abs(judge.torques(theirs(t), theirs(t, 1), theirs(t, 2))) / torque) for t in instants]
        ratios = [ours.duration / each.duration for each in (theirs, toppra_motion(fine, limits, robot, FINE))]
        rows.append([*ratios, judge.largest_share(ours, torque), max(shares), spent, without, others])
    table = np.array(rows)
    print(f"{name}: {len(rows)} paths; {refused} refused because a joint cannot hold the arm, {unsolved} not by toppra")
    for points, ratio in zip((POINTS, FINE), table.T, strict=False):
        print(f"  duration over toppra's of {points} points: median {np.median(ratio):.4f}, largest {ratio.max():.4f}")
    fair = table[table[:, 3] <= KEPT, 0]
    if len(fair):
        print(f"  where that of {POINTS} keeps torques to 0.5 % ({len(fair)} paths): largest {fair.max():.4f}")
    print(f"  largest part of a limit: {table[:, 2].max():.9f}, toppra's of {POINTS} points {table[:, 3].max():.4f}")
    spent, without, others = np.median(table[:, 4:], axis=0)
    print(f"  median: {spent:.2f} ms, without torque limits {without:.2f}, toppra {others:.2f}", flush=True)


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
    options.add_argument("--paths", type=int, default=0, help="number of random splines of each arm")
    options.add_argument("--data", type=Path, help="folder of MotionBenchMaker's problems")
    options.add_argument("--payloads", type=float, nargs="+", default=[3.0, 5.0], help="masses in the hand (kg)")
    options.add_argument("--every", type=int, default=1, help="take one of so many problems")
    given = options.parse_args()
    for name in ARMS if given.paths else []:
        time_paths(name, given.paths)
    for payload in given.payloads if given.data else []:
        plan(given.data, payload, given.every)


if __name__ == "__main__":
    main()
