"""Motions in time: state to state against ruckig, timings against toppra, polynomials against numpy."""

from __future__ import annotations

import logging
from typing import Any

import numpy as np

import beetle_ik as bik

from .. import arms
from ..attack import Attack, BrokenError, Case

RELATIVE = 1e-9  # excess over a limit that counts as rounding
ENDS = 1e-9  # rad
SAMPLES = 200  # a segment
SLOWER = 1.05  # a looser plan may take this much longer


def dense(motion: bik.Trajectory, order: int, samples: int = SAMPLES) -> np.ndarray:
    """Derivative of the motion by numpy, at many times of each segment: (segments, samples, n)."""
    powers = motion.coefficients
    for _ in range(order):
        powers = powers[:, :, 1:] * np.arange(1, powers.shape[2])
    widths = np.diff(motion.time)[:, None] * np.linspace(0.0, 1.0, samples)
    times = widths[:, :, None] ** np.arange(powers.shape[2])
    return np.einsum("stp,snp->stn", times, powers)


def check_rates(motion: bik.Trajectory, limits: dict[str, np.ndarray], slack: float = RELATIVE) -> None:
    """Checks velocity, acceleration and jerk of the polynomials at many times."""
    for order, kind in enumerate(("velocity", "acceleration", "jerk"), 1):
        if kind in limits:
            excess = (np.abs(dense(motion, order)) / limits[kind]).max(initial=0.0) - 1.0
            if not excess <= slack:
                raise BrokenError(f"the {kind} is beyond its limit", excess)


class StateToState(Attack):
    name = "state_to_state"
    promise = "Motions from state to state keep every limit, end exactly, and take no longer than those of ruckig"
    page = "motion"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Hard states are near each other, at their limits, or limits differ by orders of magnitude."""
        joints = []
        for _ in range(int(random.integers(1, 6))):
            spread = 3.0 if hard else 0.7
            velocity, acceleration, jerk = np.exp(random.uniform(-spread, spread, 3)) * (1.5, 5.0, 50.0)
            at = random.uniform(-2, 2)
            far = random.uniform(-2, 2) if not hard or random.random() < 0.5 else at + 10.0 ** random.uniform(-9, -1)
            factor = random.choice([0.0, 1.0, 0.999999, 0.5]) if hard else 0.5
            speeds = (
                velocity * factor * random.uniform(-1, 1, 2)
                if random.random() < 0.8
                else velocity * factor * random.choice([-1.0, 1.0], 2)
            )
            # What an acceleration may be at a speed: it must fade out before the limit.
            most = np.minimum(acceleration, np.sqrt(2 * jerk * np.maximum(0.0, velocity - np.abs(speeds))))
            rates = 0.99 * most * random.uniform(-1, 1, 2) * (random.random() < 0.7)
            joints.append(
                {
                    "from": tuple(map(float, (at, speeds[0], rates[0]))),
                    "to": tuple(map(float, (far, speeds[1], rates[1]))),
                    "limits": tuple(map(float, (velocity, acceleration, jerk))),
                }
            )
        return {"joints": joints}

    def program(self, case: Case) -> str:
        columns = [
            [list(column) for column in zip(*(joint[key] for joint in case["joints"]), strict=True)]
            for key in ("from", "to", "limits")
        ]
        (q0, v0, a0), (q1, v1, a1), (velocity, acceleration, jerk) = columns
        return (
            f"limits = bik.Limits(velocity={velocity}, acceleration={acceleration}, jerk={jerk})\n"
            f"motion = bik.state_to_state({q0}, {q1}, limits, qd0={v0}, qdd0={a0}, qd1={v1}, qdd1={a1})"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        motion = left["motion"]
        start, end, limits = (np.array([joint[key] for joint in case["joints"]]).T for key in ("from", "to", "limits"))
        kinds = dict(zip(("velocity", "acceleration", "jerk"), limits, strict=True))
        check_rates(motion, kinds, 1e-8)
        scale = np.array([1.0, limits[0].max(), limits[1].max()])[:, None]
        for what, state, row in (("start", start, 0), ("end", end, -1)):
            found = np.array([dense(motion, order, 2)[row, row] for order in range(3)])
            off = np.abs(found - state) / np.maximum(scale, 1.0)
            if off.max() > 1e-7:
                raise BrokenError(f"the motion misses its {what}", off.tolist())
        theirs = ruckig_duration(start, end, limits)
        if theirs is not None and motion.duration > theirs * (1 + 1e-6) + 1e-9:
            raise BrokenError("slower than ruckig", (motion.duration, theirs))
        return 1

    def judge_refusal(self, case: Case, error: Exception) -> None:
        same = all(joint["from"] == joint["to"] for joint in case["joints"])
        if not same and not isinstance(error, bik.InfeasibleError):
            raise BrokenError("a right pair of states is refused", error)


def ruckig_duration(start: np.ndarray, end: np.ndarray, limits: np.ndarray) -> float | None:
    """How long ruckig takes; None if it fails, or returns a motion that misses its end."""
    import ruckig

    given = ruckig.InputParameter(start.shape[1])
    given.current_position, given.current_velocity, given.current_acceleration = start.tolist()
    given.target_position, given.target_velocity, given.target_acceleration = end.tolist()
    given.max_velocity, given.max_acceleration, given.max_jerk = limits.tolist()
    theirs = ruckig.Trajectory(start.shape[1])
    try:
        if ruckig.Ruckig(start.shape[1]).calculate(given, theirs) != ruckig.Result.Working:
            return None
    except ruckig.RuckigError:
        return None
    if np.abs(np.array(theirs.at_time(theirs.duration)) - end).max() > 1e-8:
        return None
    times = np.linspace(0.0, theirs.duration, 2000)
    rates = np.abs(np.array([theirs.at_time(t)[1:] for t in times])).max(axis=0)
    return theirs.duration if (rates <= limits[:2] * (1 + 1e-9)).all() else None


class TimeOptimal(Attack):
    name = "time_optimal"
    promise = (
        "Time-optimal motions keep velocity, acceleration and jerk limits at every instant and are as fast as toppra's"
    )
    page = "limits"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Hard paths turn back, rest in some joints, have waypoints near each other, and very different limits."""
        n, k = int(random.integers(1, 8)), int(random.integers(2, 12))
        points = np.cumsum(random.normal(0.0, 0.5, (k, n)), axis=0)
        spread = 2.5 if hard else 0.5
        if hard:
            points[:, random.random(n) < 0.3] = 0.5
            if k > 3 and random.random() < 0.5:
                points[2] = points[1] + 10.0 ** random.uniform(-7, -2) * random.normal(size=n)
            if k > 3 and random.random() < 0.3:
                points[3] = points[1]
        limits = [tuple((np.exp(random.uniform(-spread, spread, 3)) * (1.5, 5.0, 50.0)).tolist()) for _ in range(n)]
        return {
            "points": [tuple(row) for row in points.tolist()],
            "limits": limits,
            "jerk": bool(random.random() < 0.3),
            "spline": str(random.choice(["natural", "natural", "clamped", "not-a-knot"])),
        }

    def program(self, case: Case) -> str:
        kinds = ("velocity", "acceleration", "jerk")[: 3 if case["jerk"] else 2]
        limits = ", ".join(
            f"{kind}={list(row)}" for kind, row in zip(kinds, zip(*case["limits"], strict=True), strict=False)
        )
        return (
            f"points = {case['points']}\nlimits = bik.Limits({limits})\n"
            f"motion = bik.time_optimal(points, limits, spline={case['spline']!r})"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        motion, points = left["motion"], np.array(case["points"])
        velocity, acceleration, jerk = np.array(case["limits"]).T
        limits = {"velocity": velocity, "acceleration": acceleration} | ({"jerk": jerk} if case["jerk"] else {})
        check_rates(motion, limits, 1e-7)
        if np.abs(motion.q[[0, -1]] - points[[0, -1]]).max() > ENDS * (1 + np.abs(points).max()):
            raise BrokenError("the motion misses its ends", motion.q[[0, -1]].tolist())
        if not case["jerk"] and case["spline"] == "natural":
            theirs = toppra_duration(points, velocity, acceleration)
            if theirs is not None and motion.duration > 1.01 * theirs:
                raise BrokenError("slower than toppra", (motion.duration, theirs))
        return 1

    def judge_refusal(self, case: Case, error: Exception) -> None:
        points = np.array(case["points"])
        if (np.abs(np.diff(points, axis=0)).max(axis=1) > 1e-9).all() and len(points) > 2:
            raise BrokenError("a right path is refused", error)


def toppra_duration(points: np.ndarray, velocity: np.ndarray, acceleration: np.ndarray) -> float | None:
    """How long toppra takes on the natural spline; None if it fails."""
    import toppra
    from toppra import algorithm, constraint

    logging.getLogger("toppra").setLevel(logging.CRITICAL)
    path = toppra.SplineInterpolator(np.linspace(0, 1, len(points)), points, bc_type="natural")
    grid = np.linspace(0, 1, 501)
    limits = [
        constraint.JointVelocityConstraint(np.column_stack((-velocity, velocity))),
        constraint.JointAccelerationConstraint(np.column_stack((-acceleration, acceleration))),
    ]
    _, speeds, _ = algorithm.TOPPRA(limits, path, gridpoints=grid).compute_parameterization(0, 0)
    return (
        None
        if speeds is None or np.isnan(speeds).any()
        else float(np.sum(2 * np.diff(grid) / (speeds[1:] + speeds[:-1])))
    )


class Trajectories(Attack):
    name = "trajectories"
    promise = "A trajectory is its polynomials: samples, largest rates, files and pickles agree with them"
    page = "motion"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """Hard ones have segments of very different length and rates."""
        n, k = int(random.integers(1, 5)), int(random.integers(2, 9))
        steps = 10.0 ** random.uniform(-5, 3, k - 1) if hard else random.uniform(0.1, 2.0, k - 1)
        rows = [
            {
                "step": float(step),
                "q": tuple(random.normal(size=n).tolist()),
                "qd": tuple(random.normal(size=n).tolist()),
                "qdd": tuple(random.normal(size=n).tolist()),
            }
            for step in [0.0, *steps]
        ]
        return {"rows": rows, "order": int(random.integers(0, 3))}

    def program(self, case: Case) -> str:
        time = np.cumsum([row["step"] for row in case["rows"]]).tolist()
        given = "".join(
            f", {name}={[list(row[name]) for row in case['rows']]}" for name in ("qd", "qdd")[: case["order"]]
        )
        return (
            f"import pickle\nq = {[list(row['q']) for row in case['rows']]}\n"
            f"motion = bik.Trajectory.from_samples({time}, q{given})\n"
            "motion.to_npz('motion.npz')\nmotion.to_csv('motion.csv')\n"
            "npz, csv = bik.Trajectory.from_npz('motion.npz'), bik.Trajectory.from_csv('motion.csv')\n"
            "most = motion.max_velocity(), motion.max_acceleration(), motion.max_jerk()\n"
            "copy = pickle.loads(pickle.dumps(motion))"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        motion = left["motion"]
        if not motion == left["npz"] == left["copy"]:
            raise BrokenError("a stored trajectory differs")
        off = np.abs(motion.q - left["csv"].q).max()
        powers = np.diff(motion.time)[:, None, None] ** np.arange(motion.coefficients.shape[2])
        if off > 1e-13 * np.abs(motion.coefficients * powers).max() or not np.array_equal(
            motion.time, left["csv"].time
        ):
            raise BrokenError("a trajectory written as CSV differs", off)
        for order, most in enumerate(left["most"], 1):
            sampled = np.abs(dense(motion, order)).max(axis=(0, 1)) if motion.coefficients.shape[2] > order else 0.0
            if not (sampled <= most * (1 + 1e-9) + 1e-12 * np.abs(motion.coefficients).max()).all():
                raise BrokenError(
                    f"the largest derivative {order} is too small", (most.tolist(), np.asarray(sampled).tolist())
                )
        for row, (start, width) in enumerate(zip(motion.time[:-1], np.diff(motion.time), strict=True)):
            at = np.array(motion.at(start + 0.3 * width)[:2])
            powers = (start + 0.3 * width - start) ** np.arange(motion.coefficients.shape[2])
            off = np.abs(at[0] - motion.coefficients[row] @ powers).max()
            if off > 1e-9 * (1 + np.abs(motion.coefficients[row] * powers).max()):
                raise BrokenError("a sample is not its polynomial", off)
        return len(case["rows"])

    def judge_refusal(self, case: Case, error: Exception) -> None:
        if (
            all(row["step"] > 1e-9 for row in case["rows"][1:])
            and case["rows"][0]["step"] == 0.0
            and len(case["rows"]) > 1
        ):
            raise BrokenError("right samples are refused", error)


class LooserPaths(Attack):
    name = "looser_paths"
    promise = (
        "A path that is followed is followed with wider tolerances, limits or speeds too, as quickly by an arm of six "
        "joints, and no point is called unreachable that has a configuration"
    )
    page = "planning"
    names = ("iiwa14", "panda", "ur5e", "kr210", "gen3", "ur10", "fr3")
    places = (0.0, 0.0, 0.0, 0.25, -0.25, 0.5, -0.5, 1.0, -1.0, 1 / 3, -1 / 6)  # of pi
    refusals = ()

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        """A line in joint space makes the path; a hard one passes round places, rests in joints and touches limits."""
        joints = None if random.random() < 0.7 else arms.easy_arm(random, int(random.integers(4, 8)))
        name = str(random.choice(self.names))
        robot = bik.Robot.named(name) if joints is None else bik.Robot.from_urdf(arms.urdf(joints))
        lower, upper = np.maximum(robot.lower, -3.2), np.minimum(robot.upper, 3.2)
        n = len(lower)
        first, last = (lower + (upper - lower) * random.random(n) for _ in range(2))
        if hard:
            round_ones = np.clip(np.pi * random.choice(self.places, (2, n)), lower, upper)
            first = np.where(random.random(n) < 0.7, round_ones[0], first)
            last = np.where(random.random(n) < 0.3, first, np.where(random.random(n) < 0.5, round_ones[1], last))
        last = first + float(random.choice([0.15, 0.4, 0.7])) * (last - first)
        if not np.abs(last - first).max() > 1e-3:
            last[0] = first[0] + (0.3 if first[0] + 0.3 < upper[0] else -0.3)
        widened = [random.random(6) < 0.5, np.arange(6) >= 3, np.ones(6, bool)][random.integers(3)]
        return {
            "name": name,
            "joints": None if joints is None else tuple(joints),
            "line": tuple(zip(first.tolist(), last.tolist(), strict=True)),
            "points": int(random.choice([40, 80])),
            "widened": tuple(map(bool, widened)),
            "ladder": str(random.choice(["tolerance", "tolerance", "window", "speed"])),
            "tightest": float(10.0 ** random.uniform(-3, -1)),
        }

    def program(self, case: Case) -> str:
        made = f"robot = bik.Robot.named({case['name']!r})\n"
        if case["joints"] is not None:
            made = arms.written(list(case["joints"]))
        first, last = (list(ends) for ends in zip(*case["line"], strict=True))
        ladder = {
            "tolerance": [[t if wide else 1e-4 for wide in case["widened"]] for t in (1e-4, 1e-3, 1e-2, 1e-1)],
            "window": [case["tightest"], 0.3, np.inf],
            "speed": [1.0, 2.0],
        }[case["ladder"]]
        return (
            f"{made}first, last = np.array({first}), np.array({last})\n"
            f"line = np.linspace(first, last, {case['points']})\n"
            "poses, low, high = robot.fk(line), line.min(axis=0), line.max(axis=0)\n\n\n"
            "def planned(tolerance=None, window=inf, speed=1.0):\n"
            "    lower, upper = np.maximum(robot.lower, low - window), np.minimum(robot.upper, high + window)\n"
            "    limits = bik.Limits(lower=lower, upper=upper, velocity=speed, acceleration=5.0 * speed)\n"
            "    task = tolerance and bik.tasks.Pose(tolerance=tolerance)\n"
            "    given = dict(limits=limits, task=task, stop=bik.Stop(max_evaluations=200))\n"
            "    try:\n"
            "        plan = bik.plan_along_path(robot, poses, **given)\n"
            "    except bik.InvalidInputError as error:\n"
            "        return False, inf, str(error)\n"
            "    return plan.success, plan.cost, plan.message\n\n\n"
            f"plans = [planned({case['ladder']}=value) for value in {ladder}]"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        """Plans of redundant arms are searched for, at random, and so not compared by their duration."""
        least, is_exact = np.inf, case["joints"] is None and len(case["line"]) == 6
        for success, cost, message in left["plans"]:
            if "cannot be reached" in message and "between points" not in message:
                raise BrokenError("a point that has a configuration is called unreachable", message)
            if not success and least < np.inf:
                raise BrokenError(f"no plan with a wider {case['ladder']}", message)
            if success and is_exact and cost > SLOWER * least:
                raise BrokenError(f"slower with a wider {case['ladder']}", (cost, least))
            least = min(least, cost if success else np.inf)
        return len(left["plans"])


ATTACKS = [StateToState(), TimeOptimal(), Trajectories(), LooserPaths()]
